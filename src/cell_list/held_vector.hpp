// SPDX-License-Identifier: BSD-3-Clause
// A SIMD vector whose lanes are all equal, for members of structs. Vectors of SVE have no fixed
// size and cannot be members, so on SVE machines this type stores the number and copies it to all
// lanes at each use. On other machines it stores the vector, which saves instructions.
//
// This file is compiled once for each instruction set, as are the filters that include it.
#if defined(CARROM_HELD_VECTOR) == defined(HWY_TARGET_TOGGLE)
#ifdef CARROM_HELD_VECTOR
#undef CARROM_HELD_VECTOR
#else
#define CARROM_HELD_VECTOR
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace carrom::HWY_NAMESPACE {

#if HWY_HAVE_SCALABLE
template <class D> using HeldVector = hwy::HWY_NAMESPACE::TFromD<D>;
template <class D> HWY_INLINE HeldVector<D> hold(D, HeldVector<D> number) { return number; }
template <class D> HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> vector_of(D d, HeldVector<D> number) {
    return hwy::HWY_NAMESPACE::Set(d, number);
}
#else
template <class D> using HeldVector = hwy::HWY_NAMESPACE::Vec<D>;
template <class D> HWY_INLINE HeldVector<D> hold(D d, hwy::HWY_NAMESPACE::TFromD<D> number) {
    return hwy::HWY_NAMESPACE::Set(d, number);
}
template <class D> HWY_INLINE HeldVector<D> vector_of(D, HeldVector<D> vector) { return vector; }
#endif

} // namespace carrom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
