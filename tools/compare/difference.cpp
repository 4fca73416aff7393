#include "tools/compare/difference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace gvom::compare {

namespace {

template <typename T>
T read(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

std::size_t size_of(const npy::Field& field) {
  return static_cast<std::size_t>(field.type.back() - '0');
}

bool is_nan(const npy::Field& field, const std::byte* at) {
  if (field.type[1] != 'f') return false;
  return size_of(field) == 4 ? std::isnan(read<float>(at)) : std::isnan(read<double>(at));
}

std::string float_words(const npy::Field& field, const std::byte* at) {
  char words[64];
  if (size_of(field) == 4)
    std::snprintf(words, sizeof(words), "%.9g = 0x%08x", static_cast<double>(read<float>(at)),
                  read<std::uint32_t>(at));
  else
    std::snprintf(words, sizeof(words), "%.17g = 0x%016llx", read<double>(at),
                  static_cast<unsigned long long>(read<std::uint64_t>(at)));
  return words;
}

// Little-endian, as all types of npy.hpp.
std::string whole_words(const npy::Field& field, const std::byte* at) {
  std::uint64_t bits = 0;
  const std::size_t size = size_of(field);
  std::memcpy(&bits, at, size);
  if (field.type[1] == 'u') return std::to_string(bits);
  const std::size_t above = 64 - 8 * size;
  return std::to_string(static_cast<std::int64_t>(bits << above) >> above);
}

std::string list(const std::vector<std::size_t>& numbers) {
  std::string all;
  for (const std::size_t number : numbers) all += (all.empty() ? "" : ", ") + std::to_string(number);
  return "[" + all + "]";
}

std::string types(const ArrayView& array) {
  return npy::Array{array.shape, array.fields, {}}.describe_type();
}

std::size_t count_of(const ArrayView& array) {
  return npy::Array{array.shape, array.fields, {}}.element_count();
}

// Two arrays of the same fields, element by element.
class Elements {
 public:
  Elements(const ArrayView& expected, const ArrayView& found, Same same)
      : expected_(expected), found_(found), same_(same) {
    for (const npy::Field& field : expected.fields) size_ += size_of(field);
  }

  /// Lines of the first that differ, of the `count` that both have; how many there are.
  std::size_t compare(std::size_t count, std::string& lines) const {
    if (count == 0 || std::memcmp(expected_.data, found_.data, count * size_) == 0) return 0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (are_same(at(expected_, i), at(found_, i))) continue;
      if (differing++ < kTold)
        lines += "\n  " + list(index(i)) + ": expected " + words(at(expected_, i)) + ", found " +
                 words(at(found_, i));
    }
    return differing;
  }

 private:
  [[nodiscard]] const std::byte* at(const ArrayView& array, std::size_t i) const {
    return static_cast<const std::byte*>(array.data) + i * size_;
  }

  [[nodiscard]] bool are_same(const std::byte* a, const std::byte* b) const {
    if (std::memcmp(a, b, size_) == 0) return true;
    if (same_ == Same::bytes) return false;
    for (const npy::Field& field : expected_.fields) {
      const std::size_t size = size_of(field);
      if (std::memcmp(a, b, size) != 0 && !(is_nan(field, a) && is_nan(field, b))) return false;
      a += size;
      b += size;
    }
    return true;
  }

  [[nodiscard]] std::vector<std::size_t> index(std::size_t i) const {
    std::vector<std::size_t> all(expected_.shape.size());
    for (std::size_t axis = all.size(); axis-- > 0; i /= expected_.shape[axis])
      all[axis] = axis == 0 ? i : i % expected_.shape[axis];
    return all;
  }

  [[nodiscard]] std::string words(const std::byte* at) const {
    std::string all;
    for (const npy::Field& field : expected_.fields) {
      if (!all.empty()) all += " ";
      if (!field.name.empty()) all += field.name + " ";
      all += field.type[1] == 'f' ? float_words(field, at) : whole_words(field, at);
      at += size_of(field);
    }
    return all;
  }

  const ArrayView& expected_;
  const ArrayView& found_;
  Same same_;
  std::size_t size_ = 0;
};

}  // namespace

std::string difference(const std::string& name, const ArrayView& expected, const ArrayView& found,
                       Same same) {
  if (expected.fields != found.fields)
    return name + ": type is " + types(found) + ", expected " + types(expected);
  std::string shapes;
  if (expected.shape != found.shape) {
    shapes = ": shape is " + list(found.shape) + ", expected " + list(expected.shape);
    if (expected.shape.size() != 1 || found.shape.size() != 1) return name + shapes;
  }
  const std::size_t count = std::min(count_of(expected), count_of(found));
  std::string lines;
  const std::size_t differing = Elements(expected, found, same).compare(count, lines);
  if (differing == 0) return shapes.empty() ? "" : name + shapes + "; the same as far as both reach";
  return name + shapes + ": " + std::to_string(differing) + " of " + std::to_string(count) + " differ" +
         lines;
}

}  // namespace gvom::compare
