// The char fields of messages: always terminated when written, never trusted to be when read.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace gvom::ipc {

/// Copies as much of `text` as fits before the terminating zero, and zeros the rest.
template <std::size_t N>
void set_text(char (&field)[N], std::string_view text) {
  std::memset(field, 0, N);
  std::copy_n(text.begin(), std::min(text.size(), N - 1), field);
}

template <std::size_t N>
std::string_view text_of(const char (&field)[N]) {
  return {field, ::strnlen(field, N)};
}

}  // namespace gvom::ipc
