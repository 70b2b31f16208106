// SPDX-License-Identifier: BSD-3-Clause
// Constant pressure: Monte Carlo moves change the volume at syncs, as in simulations at constant N,
// P and T (W. W. Wood, J. Chem. Phys. 48, 415 (1968)).
//
// The box keeps its edges, and all radii are multiplied by one factor s. In units of the discs, the
// box and the positions in it become smaller or larger together. The positions in units of the box
// and the volume V = A / (s^2 <d^2>), with the box's area A and the mean <d^2> of the squared
// diameters in the scene, have the weight
//     V^N exp(-p V),   p = P <d^2> / kT,   if no two discs overlap.
// The structure of hard discs does not depend on temperature. So the moves do not change
// velocities, in units of the box, and the result does not depend on kT.
//
// At a sync the closest pair limits how far radii can grow. The limit is a minimum over pairs, so
// all ranks find the same one. With the discs at rest the weight is a function of V alone, so the
// `n_moves` moves of a sync take almost no time. Each move draws a new volume V' uniformly from a
// range about the present one, and accepts it with the probability min(1, exp(-p (V' - V)) (V' /
// V)^N) (Metropolis). The range of s is divided into cells whose ends differ by a factor of 1.1.
// During a sync s stays in its cell, so that only pairs closer than the largest diameter in the
// cell must be known. The cells of even and odd syncs are shifted by half a cell. So each sync
// conserves the distribution exactly, and V can reach any value.
//
// With `axes = "each"` the ratio of the sides changes as well, at a constant area: x positions are
// multiplied by a factor t, and y positions are divided by it. In units of the discs, the two sides
// then change independently. The weight dLx dLy V^N exp(-p V) is that of V times a uniform
// distribution of ln(Lx / Ly). So a sync draws ln Lx uniformly from the range in which no discs
// overlap, within a cell like those of s (Gibbs sampling). Within a cell only discs near each other
// limit the range, and it is the same for a move and its reverse. Sides stay between half and twice
// their length in the scene, because in a fluid no force keeps their ratio near any value.
//
// Only + - * / and sqrt are used. The logarithm of V' / V is computed by a series, and a random
// number with an exponential distribution decides if a move is accepted. Cost: a halo exchange and
// a pass over pairs that are near each other, every `time.sync_every` micro-steps.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "scene/effects/effect.hpp"
#include "scene/effects/sync_times.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

template <>
inline constexpr std::array words_of<BarostatAxes>{Word{"together", BarostatAxes::together},
                                                   Word{"each", BarostatAxes::each}};

namespace {

constexpr int n_moves = 64;
constexpr double cell_ratio = 1.1; ///< ratio of the upper to the lower end of a cell of s
/// Ratio of the upper to the lower end of a cell of the side along x
constexpr double stretch_ratio = 1.1;

/// ln(a / b) for ratios from 2/3 to 3/2, by the series of 2 artanh((a - b) / (a + b)).
double log_ratio(double a, double b) {
    const double z = (a - b) / (a + b), square = z * z;
    double sum = 0;
    for (int k = 25; k >= 1; k -= 2) sum = sum * square + 1.0 / k;
    return 2 * z * sum;
}

double mean_squared_diameter(const SceneParameters& scene) {
    if (scene.effects.species.empty()) return 4 * scene.radius * scene.radius;
    double sum = 0;
    for (const Species& one : scene.effects.species)
        sum += static_cast<double>(one.count) * 4 * one.radius * one.radius;
    return sum / static_cast<double>(scene.n_discs);
}

struct Cell {
    double low = 1, high = 1;
};

/// The cell [c, c * ratio) that contains `value`; the cells differ between even and odd syncs.
Cell cell_of(double value, double ratio, std::int64_t n_syncs) {
    double low = n_syncs % 2 == 0 ? 1 : std::sqrt(ratio);
    while (value < low) low /= ratio;
    while (value >= low * ratio) low *= ratio;
    return {low, low * ratio};
}

class VolumeMoves final : public SyncEffect, public SizeChange, public ShapeChange {
public:
    explicit VolumeMoves(const SceneParameters& scene)
        : barostat_(scene.effects.barostat), n_discs_(static_cast<double>(scene.n_discs)),
          volume_of_scene_(scene.box.area() / mean_squared_diameter(scene)),
          shortest_(4 * (1 + 1e-6) * scene.radius), box_of_scene_(scene.box), box_(scene.box) {}

    void act(const SyncDiscs& /*at*/) override {}
    SizeChange* sizes() override { return this; }
    ShapeChange* shape() override { return moves_each_axis() ? this : nullptr; }

    std::vector<std::int64_t> kept() const override {
        std::vector<std::int64_t> numbers = {std::bit_cast<std::int64_t>(size_)};
        if (moves_each_axis())
            for (const double side : {box_.x, box_.y})
                numbers.push_back(std::bit_cast<std::int64_t>(side));
        return numbers;
    }
    void go_on(std::span<const std::int64_t> kept) override {
        if (kept.empty()) return;
        size_ = std::bit_cast<double>(kept[0]);
        if (kept.size() == 3)
            box_ = {std::bit_cast<double>(kept[1]), std::bit_cast<double>(kept[2])};
    }

    double size() const override { return size_; }
    double largest_at(std::int64_t n_syncs) const override {
        return std::min(cell_at(n_syncs).high, most_size());
    }

    void change(std::int64_t n_syncs, double room) override {
        const Cell cell = cell_at(n_syncs);
        const double least = volume_at(std::min({room, cell.high, most_size()})),
                     most = volume_at(cell.low), range = range_in(cell);
        DiscRandom random = random_at(n_syncs, no_disc);
        const double before = volume_at(size_);
        double volume = before;
        for (int k = 0; k < n_moves; ++k) {
            const double next = volume + range * (2 * random.uniform() - 1),
                         limit = random_exponential(random);
            if (next < least || next > most) continue;
            const double cost = barostat_.pressure * (next - volume) -
                                n_discs_ * log_ratio(next, volume);
            if (limit >= cost) volume = next;
        }
        if (volume != before) size_ = std::sqrt(volume_of_scene_ / volume);
    }

    Box box() const override { return box_; }
    double largest_stretch() const override { return stretch_ratio; }

    /// Draws Lx with a density proportional to 1 / Lx, so that ln Lx is uniform: a uniform Lx is
    /// accepted with the probability `least` / Lx, and otherwise it is drawn again.
    void stretch(std::int64_t n_syncs, const StretchRange& room) override {
        const double area = box_of_scene_.area(), widest = area / shortest_side(),
                     unit = box_of_scene_.x;
        const Cell cell = cell_of(box_.x / unit, stretch_ratio, n_syncs);
        const double least = std::max({cell.low * unit, box_.x * room.least, shortest_side(),
                                       barostat_.shortest_side() * unit}),
                     most = std::min({cell.high * unit, box_.x * room.most, widest,
                                      barostat_.longest_side() * unit});
        DiscRandom random = random_at(n_syncs, other_no_disc);
        double next = 0;
        do next = least + (most - least) * random.uniform();
        while (random.uniform() * next > least);
        if (next >= least && next <= most) box_ = {next, area / next};
    }

private:
    /// Ids that no disc has, so that the random numbers differ from those of another effect with
    /// the same seed.
    static constexpr DiscId no_disc = ~DiscId{0}, other_no_disc = no_disc - 1;

    bool moves_each_axis() const { return barostat_.axes == BarostatAxes::each; }
    DiscRandom random_at(std::int64_t n_syncs, DiscId id) const {
        return {barostat_.seed, Purpose::sync, id, static_cast<std::uint64_t>(n_syncs)};
    }
    double volume_at(double size) const { return volume_of_scene_ / (size * size); }
    /// Each side of a periodic box must be slightly longer than four radii.
    double shortest_side() const { return shortest_ * size_; }
    double most_size() const { return box_.shortest() / shortest_; }
    Cell cell_at(std::int64_t n_syncs) const { return cell_of(size_, cell_ratio, n_syncs); }

    /// The largest change of V in a move: a few times V / (N (Z - 1)), by which V can typically
    /// shrink until the closest pair touches. It is the same throughout the cell, so that a move
    /// and its reverse are proposed with the same probability.
    double range_in(const Cell& cell) const {
        const double volume = volume_at(cell.high),
                     excess = std::max(barostat_.pressure * volume / n_discs_ - 1,
                                       1 / std::sqrt(n_discs_));
        return volume * std::min(0.2, 4 / (n_discs_ * excess));
    }

    Barostat barostat_;
    double n_discs_, volume_of_scene_;
    double shortest_; ///< the shortest side that the box may have at s = 1
    Box box_of_scene_, box_;
    double size_ = 1;
};

std::vector<Key> keys_of_barostat() {
    return {
        key("effects.barostat.pressure", "1",
            "P d^2 / kT, with the mean d^2 of the squared diameters: the pressure at which moves "
            "of the volume keep discs. The box stays as it is, and all radii change by one factor "
            "at syncs. 0: none.",
            [](auto& s) -> auto& { return s.effects.barostat.pressure; })
            .within({0, 1e6}),
        key("effects.barostat.axes", "",
            "together: the box keeps the ratio of its sides. each: in units of the discs each side "
            "has moves of its own; the box keeps its area, and its sides stay within half and "
            "twice their length. Take it for crystals: a fluid gives no ratio.",
            [](auto& s) -> auto& { return s.effects.barostat.axes; }),
        key("effects.barostat.seed", "1", "Seed of the random numbers of the barostat.",
            [](auto& s) -> auto& { return s.effects.barostat.seed; })
            .within({.low = 0})
            .seed(),
    };
}

std::vector<Rule> rules_of_barostat() {
    const RuleKeys keys = {"effects.barostat.pressure"};
    const std::string_view constant = "constant pressure";
    return {
        rule(constant, "time.method = \"time-stepped\"",
             "radii stay there; take time.method = \"event-driven\"", keys,
             [](const SceneParameters& s) { return has_barostat(s) && is_time_stepped(s); }),
        rule(constant, "growing discs", "both change the radii; take one of them", keys,
             [](const SceneParameters& s) { return has_barostat(s) && has_growing_discs(s); }),
        rule(constant, "discs that lose energy, are rough, active, or pass through each other",
             "volumes are weighted for elastic discs in equilibrium", keys,
             [](const SceneParameters& s) {
                 return has_barostat(s) && (s.effects.contact.kind != ContactKind::elastic ||
                                            s.effects.activity.is_on());
             }),
        rule(constant, "forces, drag or obstacles",
             "discs need straight flights in an empty box, which can change as a whole", keys,
             [](const SceneParameters& s) {
                 return has_barostat(s) && (!s.effects.are_flights_free() || has_fixed_bodies(s) ||
                                            s.effects.field.is_on());
             }),
        rule("effects.barostat.axes = \"each\"", "no effects.barostat.pressure",
             "nothing moves the sides then; set effects.barostat.pressure",
             {"effects.barostat.axes"},
             [](const SceneParameters& s) {
                 return s.effects.barostat.axes == BarostatAxes::each && !has_barostat(s);
             }),
        rule(constant, "sides that are not all periodic, or sheared",
             "the volume needs a box without sides; make all four sides periodic", keys,
             [](const SceneParameters& s) {
                 return has_barostat(s) && (!is_periodic_all_round(s) || s.effects.are_sheared());
             }),
    };
}

} // namespace

namespace effects {

EffectDeclaration barostat() {
    return {.tables = {{"effects.barostat", "What keeps discs at a pressure."}},
            .keys = keys_of_barostat(),
            .rules = rules_of_barostat(),
            .derive =
                [](const SceneDraft& draft) {
                    if (has_barostat(draft.scene)) sync_in_each_step(draft);
                },
            .check_times =
                [](const SceneDraft& draft) {
                    if (has_barostat(draft.scene))
                        warn_of_no_sync(draft, "the barostat never acts: it would");
                },
            .summary =
                [](const Effects& e) {
                    const bool each = e.barostat.axes == BarostatAxes::each;
                    return e.barostat.is_on()
                               ? fmt::format("volume moves at P d^2 / kT = {:g}{}",
                                             e.barostat.pressure, each ? ", each axis alone" : "")
                               : "";
                },
            .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
                if (!s.effects.barostat.is_on()) return nullptr;
                return std::make_unique<VolumeMoves>(s);
            }};
}

} // namespace effects

} // namespace carrom
