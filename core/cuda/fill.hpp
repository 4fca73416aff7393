#pragma once

#include <cstdint>

#include "core/format/platform.hpp"

namespace gvom::cuda {

/// For each element of an array: gives it a value.
template <class T>
struct Fill {
  T* to;
  T value;
  GVOM_HD void operator()(std::int32_t i) const { to[i] = value; }
};

}  // namespace gvom::cuda
