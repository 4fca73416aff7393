// A sentence of several parts, put together without allocating.
#pragma once

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "ipc/messages.hpp"

namespace gvom::services {

/// As long as Health's reason; what is beyond is cut.
class Words {
 public:
  /// Appends a part as by printf, after "; " if it is not the first.
  [[gnu::format(printf, 2, 3)]] void add(const char* format, ...) {
    if (length_ > 0) length_ += put("; ");
    std::va_list arguments;
    va_start(arguments, format);
    const int wanted = std::vsnprintf(text_.data() + length_, text_.size() - length_, format, arguments);
    va_end(arguments);
    if (wanted > 0) length_ = std::min(length_ + static_cast<std::size_t>(wanted), text_.size() - 1);
  }

  [[nodiscard]] bool empty() const { return length_ == 0; }
  [[nodiscard]] std::string_view text() const { return {text_.data(), length_}; }

 private:
  std::size_t put(const char* plain) {
    const int wanted = std::snprintf(text_.data() + length_, text_.size() - length_, "%s", plain);
    return std::min(static_cast<std::size_t>(wanted), text_.size() - 1 - length_);
  }

  std::array<char, sizeof(ipc::Health::reason)> text_{};
  std::size_t length_ = 0;
};

}  // namespace gvom::services
