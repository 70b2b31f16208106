// SPDX-License-Identifier: BSD-3-Clause
// A vector of numbers or plain structs that does not fill new elements with zeros. The one thread
// that resizes would fill them while other threads wait, and all memory would be placed near its
// processor. Without filling, each thread is the first to write the elements that it uses.
#pragma once

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace carrom {

template <class T> struct RawAllocator : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    template <class U> struct rebind {
        using other = RawAllocator<U>;
    };
    /// Does nothing, because the caller writes every element before reading it.
    template <class U> void construct(U*) {}
    template <class U, class... Arguments> void construct(U* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
};

/// `resize(n)` leaves new elements undefined; `resize(n, value)` sets each to `value`.
template <class T> using RawVector = std::vector<T, RawAllocator<T>>;

} // namespace carrom
