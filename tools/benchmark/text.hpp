// Text as printf makes it.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace gvom::bench {

template <class... Values>
std::string text(const char* format, Values... values) {
  std::string line(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(line.data(), line.size() + 1, format, values...);
  return line;
}

}  // namespace gvom::bench
