// SPDX-License-Identifier: BSD-3-Clause
// Compiled for the precompiled headers alone: CMake makes them where a source of the target uses
// them, and the mains do not.
