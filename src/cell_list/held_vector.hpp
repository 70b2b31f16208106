// SPDX-License-Identifier: BSD-3-Clause
// A number in every lane of a vector, as a member of a struct. Vectors of SVE have no fixed size,
// so they cannot be members. On such machines this type holds the number, and spreads it over the
// lanes where it is used. On all others it holds the vector, which saves instructions.
//
// Like the filters that include it, this file is compiled once per instruction set.
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
