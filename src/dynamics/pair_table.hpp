// SPDX-License-Identifier: BSD-3-Clause
// The coefficients of contacts that depend on the species of both discs: one set for each pair of
// rows of `discs.species`, and a common set for all other pairs.
//
// Rows are in order of id, so a disc's row follows from its id. The table is indexed by rows and
// not by Species, because equal discs of two rows form one Species but may be of different
// materials.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/device.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

/// The coefficients of the contact law for discs of two rows of `discs.species`.
struct PairFactors {
    double normal = 1;     ///< normal impulse relative to an elastic contact, (1 + e) / 2
    double tangential = 0; ///< tangential impulse over sliding velocity if surfaces stick, for
                           ///< masses of 1; 0 if smooth
    double friction = 0;   ///< coefficient of Coulomb's friction

    static PairFactors of(double restitution, double tangential_restitution, double friction,
                          double inertia) {
        return {(1 + restitution) / 2, (1 + tangential_restitution) / 2 * (inertia / (1 + inertia)),
                friction};
    }
    /// The factors of all pairs without a row of their own.
    static PairFactors common(const ContactEffect& contact) {
        return of(contact.restitution, contact.tangential_restitution, contact.friction,
                  contact.inertia);
    }
};

/// Finds factors in a table that another object owns; plain data. Empty if the scene names no
/// pairs.
class PairView {
public:
    PairView() = default;
    /// `ends[k]` is the id after the last disc of row k, of `n` rows; `factors` has n^2 elements.
    PairView(const DiscId* ends, const PairFactors* factors, std::size_t n)
        : ends_(ends), factors_(factors), n_(n) {}

    CARROM_DEVICE bool are_any() const { return factors_ != nullptr; }
    /// The factors of the pair; they are the same for (p, q) and (q, p).
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

/// Owns a table of factors; copies share its memory.
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
