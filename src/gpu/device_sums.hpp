// SPDX-License-Identifier: BSD-3-Clause
// Sums on a device that do not depend on the order of terms. A term is a whole number of units
// (core/exact_sum.hpp), and its pieces of 32 bits are added to up to four integers. So threads add
// in any order, without carries between the integers; the host combines the pieces.
//
// Threads that all add to the same integers would wait for each other. So there are many copies,
// the stripes, and a thread's number decides which one it uses.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "core/device.hpp"
#include "dynamics/encounter.hpp"
#include "engine/stress_sums.hpp"
#include "gpu/atomics.hpp"

namespace carrom {

/// The pieces of one sum, the lowest first. They cannot overflow before 2^31 terms.
struct SumPieces {
    std::uint64_t piece[4] = {};
};

/// Adds terms to the pieces of a sum, with the same result as ExactSum::add for the same scale.
class DeviceSum {
public:
    CARROM_DEVICE DeviceSum(SumPieces& pieces, double scale) : pieces_(pieces), scale_(scale) {}

    CARROM_DEVICE double scale() const { return scale_; }
    CARROM_DEVICE void add_units(std::int64_t units) {
        if (units == 0) return;
        carrom::add(pieces_.piece[0], static_cast<std::uint64_t>(units) & 0xffffffff);
        // The sign is in the highest piece
        carrom::add(pieces_.piece[1], static_cast<std::uint64_t>(units >> 32));
    }
    CARROM_DEVICE void add(double term) {
        const double scaled = term * scale_; // exact, because the scale is a power of two
        if (std::fabs(scaled) < 0x1p62)
            add_units(static_cast<std::int64_t>(scaled));
        else
            add_large(scaled);
    }

private:
    /// Adds a large number. It is whole, so it can be cut into pieces exactly.
    CARROM_DEVICE void add_large(double scaled) {
        double rest = std::fabs(scaled);
        for (int k = 3; k >= 0; --k) {
            const double unit = k == 3 ? 0x1p96 : k == 2 ? 0x1p64 : k == 1 ? 0x1p32 : 1;
            const double part = std::trunc(rest / unit);
            rest -= part * unit;
            const auto whole = static_cast<std::uint64_t>(part);
            carrom::add(pieces_.piece[k], scaled < 0 ? 0 - whole : whole);
        }
    }

    SumPieces& pieces_;
    double scale_;
};

struct StressPieces {
    SumPieces xx, xy, yy, energy;
};

/// Replaces StressSums in kernels: it has the members that kernels use.
struct DeviceStress {
    CARROM_DEVICE DeviceStress(StressPieces& pieces, double scale)
        : xx(pieces.xx, scale), xy(pieces.xy, scale), yy(pieces.yy, scale),
          energy(pieces.energy, scale) {}

    DeviceSum xx, xy, yy, energy;
};

/// Replaces StressTerms: each term is added immediately.
struct DeviceTerms {
    CARROM_DEVICE void add(double ix, double iy, const Separation& to, DeviceStress& sums) const {
        add_impulse(sums, ix, iy, to);
    }
};

/// Adds the sums of all stripes to `sums`.
inline void add_stripes(std::span<const StressPieces> stripes, StressSums& sums) {
    __extension__ typedef __int128 Wide; // NOLINT: nvcc accepts the extension in this form only
    const auto add = [&](ExactSum& sum, SumPieces StressPieces::* pieces) {
        Wide total = 0;
        for (const StressPieces& stripe : stripes)
            for (int k = 0; k < 4; ++k) // pieces can be negative
                total += static_cast<Wide>(static_cast<std::int64_t>((stripe.*pieces).piece[k]))
                         << (32 * k);
        sum.add_words(static_cast<std::uint64_t>(total), static_cast<std::uint64_t>(total >> 64));
    };
    add(sums.xx, &StressPieces::xx);
    add(sums.xy, &StressPieces::xy);
    add(sums.yy, &StressPieces::yy);
    add(sums.energy, &StressPieces::energy);
}

} // namespace carrom
