// What differs between two arrays that should be the same, in words: enough of it to find the cause without
// a second run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/common/npy.hpp"

namespace gvom::compare {

/// An array in memory, as in a file of NumPy's: C order, elements without gaps.
struct ArrayView {
  std::vector<npy::Field> fields;  ///< One without a name, or those of a record.
  std::vector<std::size_t> shape;
  const void* data;
};

template <typename T>
ArrayView view_of(std::vector<std::size_t> shape, const T* values) {
  return {{{"", npy::type_code<T>()}}, std::move(shape), values};
}
inline ArrayView view_of(const npy::Array& array) {
  return {array.fields, array.shape, array.data.data()};
}

/// When two values are the same.
enum class Same {
  bytes,   ///< Byte for byte.
  values,  ///< Likewise, but any NaN is any other.
};

/// Values that differ and are told one by one.
inline constexpr std::size_t kTold = 10;

/// Empty if nothing differs. Else "NAME: 12 of 65536 differ", or how the arrays differ in type or shape, and
/// a line for each of the first `kTold` values: its index, the expected and the found one, floats with their
/// bits. Lists (of one dimension) of another length are compared as far as both reach.
std::string difference(const std::string& name, const ArrayView& expected, const ArrayView& found,
                       Same same = Same::bytes);

}  // namespace gvom::compare
