// Marks functions that a GPU back end compiles for the device too.
#pragma once

#ifdef __CUDACC__
#define GVOM_HD __host__ __device__
#else
#define GVOM_HD
#endif
