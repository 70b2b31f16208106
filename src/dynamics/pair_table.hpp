// SPDX-License-Identifier: BSD-3-Clause
// The numbers of contacts that depend on the species of both discs: one set for each pair of rows
// of `discs.species`, and a common set for all other pairs.
//
// Rows come in the order of ids, so a disc's row follows from its id. The table goes by rows and
// not by Species, because equal discs of two rows are one Species, and may be of two materials
// here.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/device.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

/// What a law computes with, for one pair of rows.
struct PairFactors {
    double normal = 1;     ///< (1 + e) / 2: the impulse in units of that of an elastic contact
    double tangential = 0; ///< the share of the sliding velocity that an impulse takes where
                           ///< surfaces stick, over 2; 0 for smooth discs
    double friction = 0;   ///< Coulomb's

    static PairFactors of(double restitution, double tangential_restitution, double friction,
                          double inertia) {
        return {(1 + restitution) / 2, (1 + tangential_restitution) / 2 * (inertia / (1 + inertia)),
                friction};
    }
    /// The numbers of all pairs that no row names.
    static PairFactors common(const ContactEffect& contact) {
        return of(contact.restitution, contact.tangential_restitution, contact.friction,
                  contact.inertia);
    }
};

/// Looks up factors in a table that something else owns; plain data. Empty if the scene names no
/// pairs.
class PairView {
public:
    PairView() = default;
    /// `ends[k]` is the id after the last disc of row k, of `n` rows; `factors` has n^2 elements.
    PairView(const DiscId* ends, const PairFactors* factors, std::size_t n)
        : ends_(ends), factors_(factors), n_(n) {}

    CARROM_DEVICE bool are_any() const { return factors_ != nullptr; }
    /// The factors of the pair; (p, q) and (q, p) have the same.
    CARROM_DEVICE const PairFactors& of(DiscId p, DiscId q) const {
        return factors_[row_of(p) * n_ + row_of(q)];
    }

private:
    CARROM_DEVICE std::size_t row_of(DiscId id) const {
        std::size_t row = 0;
        while (row + 1 < n_ && id >= ends_[row]) ++row;
        return row;
    }

    const DiscId* ends_ = nullptr;
    const PairFactors* factors_ = nullptr;
    std::size_t n_ = 0;
};

/// Copies share their memory.
class PairTable {
public:
    explicit PairTable(const ContactEffect& contact);

    PairView view() const {
        return table_ ? PairView(table_->ends.data(), table_->factors.data(), table_->ends.size())
                      : PairView();
    }

private:
    struct Table {
        std::vector<DiscId> ends;
        std::vector<PairFactors> factors;
    };
    std::shared_ptr<const Table> table_; ///< null if the scene names no pairs
};

} // namespace carrom
