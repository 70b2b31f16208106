// SPDX-License-Identifier: BSD-3-Clause
// Marks the functions on the way of a pair of discs: a compiler for GPUs needs a word before
// each of them, and here it is empty. They are inline, and take and return plain data.
#pragma once

#define CARROM_DEVICE
