// SPDX-License-Identifier: BSD-3-Clause
// Marks the functions that kernels call for a pair of discs. A compiler for GPUs needs a keyword
// before each of them; for other compilers the macro is empty. These functions are inline, and take
// and return plain data.
#pragma once

#ifdef __CUDACC__
#define CARROM_DEVICE __host__ __device__
#else
#define CARROM_DEVICE
#endif
