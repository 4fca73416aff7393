// What the planner says to people.
#pragma once

#include <string>

namespace gvom::planner {

/// As printf into `why`, cut after 200 characters. Allocates nothing if `why` has room for them.
[[gnu::format(printf, 2, 3)]] void say(std::string& why, const char* format, ...);

inline constexpr std::size_t kLongestWhy = 200;

}  // namespace gvom::planner
