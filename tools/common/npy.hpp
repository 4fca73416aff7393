// NumPy's .npy files: plain arrays and arrays of records, little-endian, C order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::npy {

/// One member of a record. `type` is NumPy's code with byte order, e.g. "<f4". A plain array has one
/// field without a name.
struct Field {
  std::string name;
  std::string type;

  bool operator==(const Field& other) const { return name == other.name && type == other.type; }
};

/// NumPy's type code of T: uint8_t, int8_t, (u)int16..64_t, float, double.
template <typename T>
const char* type_code();

template <>
inline const char* type_code<std::uint8_t>() {
  return "|u1";
}
template <>
inline const char* type_code<std::int8_t>() {
  return "|i1";
}
template <>
inline const char* type_code<std::uint16_t>() {
  return "<u2";
}
template <>
inline const char* type_code<std::int16_t>() {
  return "<i2";
}
template <>
inline const char* type_code<std::uint32_t>() {
  return "<u4";
}
template <>
inline const char* type_code<std::int32_t>() {
  return "<i4";
}
template <>
inline const char* type_code<std::uint64_t>() {
  return "<u8";
}
template <>
inline const char* type_code<std::int64_t>() {
  return "<i8";
}
template <>
inline const char* type_code<float>() {
  return "<f4";
}
template <>
inline const char* type_code<double>() {
  return "<f8";
}

/// An array as it lies in a file.
struct Array {
  std::vector<std::size_t> shape;
  std::vector<Field> fields;
  std::vector<std::byte> data;

  /// Product of the shape: 1 for a scalar.
  [[nodiscard]] std::size_t element_count() const;

  /// The values of a plain array of T; an error that names both types if it holds something else.
  template <typename T>
  [[nodiscard]] tl::expected<std::vector<T>, std::string> values() const {
    if (fields != std::vector<Field>{{"", type_code<T>()}})
      return tl::unexpected("holds " + describe_type() + ", expected " + type_code<T>());
    std::vector<T> out(element_count());
    if (!out.empty()) std::memcpy(out.data(), data.data(), out.size() * sizeof(T));
    return out;
  }

  /// The elements of an array of records whose packed layout is T's; an error if fields or size differ.
  template <typename T>
  [[nodiscard]] tl::expected<std::vector<T>, std::string> records(const std::vector<Field>& expected) const {
    if (fields != expected || data.size() != element_count() * sizeof(T))
      return tl::unexpected("holds records of " + describe_type() + ", not the expected ones");
    std::vector<T> out(element_count());
    if (!out.empty()) std::memcpy(out.data(), data.data(), data.size());
    return out;
  }

  /// The fields in words, for messages: "<f4" or "x <i4, y <i4".
  [[nodiscard]] std::string describe_type() const;
};

/// Writes `data`, elements of `fields` (one without a name: a plain array) packed without gaps, in C order.
/// Errors name the path and the reason.
tl::expected<void, std::string> write_npy_bytes(const std::string& path,
                                                const std::vector<std::size_t>& shape,
                                                const std::vector<Field>& fields, const void* data);

/// Writes a plain array, e.g. `write_npy("height.npy", {n_y, n_x}, height.data())`.
template <typename T>
tl::expected<void, std::string> write_npy(const std::string& path, const std::vector<std::size_t>& shape,
                                          const T* data) {
  return write_npy_bytes(path, shape, {{"", type_code<T>()}}, data);
}

/// Writes a one-dimensional array of records, e.g. `{{"x", "<i4"}, {"hits", "<u4"}}`. T must have no
/// padding; an error if its size is not the sum of the fields' sizes.
tl::expected<void, std::string> write_npy_records(const std::string& path, const std::vector<Field>& fields,
                                                  std::size_t count, std::size_t record_size,
                                                  const void* data);

template <typename T>
tl::expected<void, std::string> write_npy_records(const std::string& path, const std::vector<Field>& fields,
                                                  const std::vector<T>& records) {
  return write_npy_records(path, fields, records.size(), sizeof(T), records.data());
}

/// Reads format versions 1 to 3, little-endian, C order. Errors name the path and the reason.
tl::expected<Array, std::string> read_npy(const std::string& path);

}  // namespace gvom::npy
