// Keeps this process's memory from being swapped out.
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace gvom::services {

/// Locks every page that is there, and each later one when it is first touched (those only where the limit on
/// locked memory is infinite: a finite one would make later allocations fail). The error says why not, and
/// what to set.
tl::expected<void, std::string> lock_memory();

}  // namespace gvom::services
