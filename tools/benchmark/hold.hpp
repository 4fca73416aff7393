// For who starts many programs on a GPU, one after the other: gpu-check.
#pragma once

#include <tl/expected.hpp>

#include "tools/benchmark/failure.hpp"

namespace gvom::bench {

/// Opens the GPU, says on standard output what it is and how long that took, and holds it until standard
/// input ends: as long, the driver keeps it ready, and other programs open it sooner. Error: there is no
/// usable GPU, in the driver's words.
tl::expected<void, Failure> hold_gpu();

}  // namespace gvom::bench
