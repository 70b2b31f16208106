// SPDX-License-Identifier: BSD-3-Clause
// Compiled only for the precompiled headers. CMake makes them if a source of the target uses them,
// which the mains do not.
