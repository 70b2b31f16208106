// SPDX-License-Identifier: BSD-3-Clause
// Marks the functions on the way of a pair of discs: a compiler for GPUs needs a word before
// each of them, and for others it is empty. They are inline, and take and return plain data.
#pragma once

#ifdef __CUDACC__
#define CARROM_DEVICE __host__ __device__
#else
#define CARROM_DEVICE
#endif
