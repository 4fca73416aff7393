#pragma once

namespace gvom::test {

/// Starts a kernel that writes where no memory is. Every CUDA call of this process fails from then on.
void break_device();

}  // namespace gvom::test
