// FNV-1a, 64 bits: the same number for the same text, on every machine.
#pragma once

#include <cstdint>
#include <string_view>

namespace gvom::services {

class TextHash {
 public:
  void add(std::string_view text) {
    for (const char c : text) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace gvom::services
