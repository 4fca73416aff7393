#pragma once

#include <string>

namespace gvom::bench {

/// "CPU model, N cores", as the kernel says it.
std::string machine();

}  // namespace gvom::bench
