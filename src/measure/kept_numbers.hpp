// SPDX-License-Identifier: BSD-3-Clause
// The data of a measurement in a checkpoint: words of 64 bits. One function of the measurement both
// stores and restores its numbers, so that the order is the same.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace carrom {

class KeptNumbers {
public:
    /// Starts an empty list, to which numbers are then stored.
    KeptNumbers() = default;
    /// Restores numbers from stored words, which must outlive this object.
    explicit KeptNumbers(std::span<const std::int64_t> words)
        : is_restored_(true), stored_(words) {}

    bool is_restored() const { return is_restored_; }

    /// Stores or restores a number, a vector or an array of numbers, or a string.
    template <class T> void operator()(T& value) {
        if constexpr (requires { value.resize(1); }) {
            std::int64_t size = static_cast<std::int64_t>(value.size());
            word(size);
            if (is_restored_) {
                if (size < 0 || static_cast<std::uint64_t>(size) > stored_.size() - next_)
                    size = fail();
                value.resize(static_cast<std::size_t>(size));
            }
            for (auto& item : value) (*this)(item);
        } else if constexpr (requires { value.begin(); }) {
            for (auto& item : value) (*this)(item);
        } else if constexpr (sizeof(T) == 8) {
            std::int64_t bits = std::bit_cast<std::int64_t>(value);
            word(bits);
            value = std::bit_cast<T>(bits);
        } else {
            static_assert(std::is_integral_v<T>);
            std::int64_t bits = value;
            word(bits);
            value = static_cast<T>(bits);
        }
    }
    /// Stores or restores a part of the list, which begins with its length; `keep` stores or
    /// restores the numbers of the part. A part is not a list of its own, because copying it would
    /// double the memory.
    template <class Keep> void part(const Keep& keep) {
        std::int64_t size = 0;
        const std::size_t begin = words_.size() + 1;
        word(size);
        if (!is_restored_) {
            keep(*this);
            words_[begin - 1] = static_cast<std::int64_t>(words_.size() - begin);
            return;
        }
        if (size < 0 || static_cast<std::uint64_t>(size) > stored_.size() - next_) size = fail();
        KeptNumbers its(stored_.subspan(next_, static_cast<std::size_t>(size)));
        next_ += static_cast<std::size_t>(size);
        keep(its);
        if (!its.is_right() || !its.is_at_end()) refuse();
    }
    /// Stores a setting on which the sums depend, or compares it with the stored one. If they
    /// differ, `is_right` becomes false, because the stored sums are then useless.
    template <class T> void same(const T& value) {
        T found = value;
        (*this)(found);
        if (found != value) is_other_ = true;
    }

    /// False if stored words are missing, are invalid or belong to other settings.
    bool is_right() const { return !is_other_; }
    bool is_at_end() const { return next_ == stored_.size(); }
    void refuse() { is_other_ = true; }

    std::vector<std::int64_t> take_words() { return std::move(words_); }

private:
    std::int64_t fail() {
        is_other_ = true;
        next_ = stored_.size();
        return 0;
    }
    void word(std::int64_t& value) {
        if (!is_restored_)
            words_.push_back(value);
        else if (next_ < stored_.size())
            value = stored_[next_++];
        else
            value = fail();
    }

    bool is_restored_ = false, is_other_ = false;
    std::vector<std::int64_t> words_;
    std::span<const std::int64_t> stored_;
    std::size_t next_ = 0;
};

} // namespace carrom
