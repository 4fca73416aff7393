// Whether the CUDA back end of this program can run.
#pragma once

namespace gvom::test {

/// False, and says so loudly, if there is no usable GPU. With GVOM_REQUIRE_GPU=1 in the environment that is
/// a failure of the test.
bool has_gpu();

}  // namespace gvom::test
