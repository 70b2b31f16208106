// SPDX-License-Identifier: BSD-3-Clause
// Marks functions that GPU kernels may call. Compilers for GPUs need a keyword before each such
// function; for other compilers the macro is empty. These functions are inline, and their arguments
// and results are plain data.
#pragma once

#ifdef __CUDACC__
#define CARROM_DEVICE __host__ __device__
#else
#define CARROM_DEVICE
#endif
