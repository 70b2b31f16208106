// SPDX-License-Identifier: BSD-3-Clause
// How contacts with sides and fixed bodies depend on the species of the disc: coefficients for some
// rows of `discs.species`, and the common coefficients of the surface for all other discs.
//
// A disc's row follows from its id, as in pair_table.hpp. If a surface has no rows, a bounce costs
// only one more test of a pointer.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/rubbing.hpp"

namespace carrom {

/// The coefficients of a surface for discs of one species.
struct SurfaceNumbers {
    double restitution = 1;
    Surface surface{};

    bool is_lossy() const { return restitution < 1; }
    bool rubs() const { return surface.rubs(); }
};

/// The coefficients of a side, or of the fixed bodies (SurfaceContacts), for discs without a row of
/// their own.
SurfaceNumbers common_numbers(const Effects& effects, std::size_t surface);
/// The coefficients for discs that `row` of this surface names.
SurfaceNumbers numbers_of(const Effects& effects, std::size_t surface, const SurfaceContact& row);
/// Whether the surface rubs discs of any species.
bool does_rub(const Effects& effects, std::size_t surface);

/// The coefficients of one surface for all species; copies share their memory.
class SurfaceTable {
public:
    struct Factors {
        double restitution = 1;
        Rubbing rubbing{};
    };

    SurfaceTable() = default;
    SurfaceTable(const Effects& effects, std::size_t surface);

    const Factors& of(DiscId id) const {
        if (!rows_) [[likely]]
            return common_;
        std::size_t row = 0;
        while (row + 1 < rows_->size() && id >= (*rows_)[row].end) ++row;
        return (*rows_)[row].factors;
    }

private:
    struct Row {
        DiscId end; ///< the id after the last disc of the row
        Factors factors;
    };

    Factors common_;
    std::shared_ptr<const std::vector<Row>> rows_; ///< null if the scene names no rows
};

} // namespace carrom
