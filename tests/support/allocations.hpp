// Counts what this program allocates, in all threads. A program that links it has its own malloc.
#pragma once

#include <cstdint>

namespace gvom::test {

/// By malloc, calloc and realloc, which operator new and Eigen call too, since the program began.
std::uint64_t allocations();

/// Says SKIPPED and returns false under AddressSanitizer, whose own malloc must stay.
bool counts_allocations();

}  // namespace gvom::test
