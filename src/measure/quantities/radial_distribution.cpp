// SPDX-License-Identifier: BSD-3-Clause
// "radial_distribution": g(r), from the distances of all pairs at each sample.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/kept_blocks.hpp"
#include "measure/pair_reach.hpp"
#include "measure/table_parts.hpp"
#include "simulation/disc_statistics.hpp"
#include "statistics/pair_distances.hpp"

namespace carrom {

namespace {

/// The species whose pairs are counted separately: the scene's species, or a single one if discs
/// are equal or have more than eight species.
std::vector<Species> species_apart(const SceneParameters& scene) {
    constexpr std::size_t most = 8;
    const std::vector<Species>& species = scene.effects.species;
    if (species.empty() || species.size() > most) return {{scene.n_discs, scene.radius, 1}};
    return species;
}

class RadialDistribution : public Measurement {
public:
    explicit RadialDistribution(MeasuredRun& run)
        : Measurement(run), largest_distance_(largest_distance_setting.of(run.output)),
          pairs_(n_bins_of(run) * n_pair_kinds(species_apart(run.scene).size()), 0),
          ideal_pairs_(pairs_.size(), 0), blocks_(n_bins_of(run) * n_curves(run.scene)) {}

    bool moves_discs() const override { return true; }

    void sample(const SampledState& state) override {
        const std::size_t n = n_bins_of(run_);
        const double width = largest_distance_ / static_cast<double>(n);
        std::vector<std::uint64_t> pairs(pairs_.size(), 0);
        const std::vector<Species> species = species_apart(run_.scene);
        std::vector<DiscId> species_ends;
        for (const Species& one : species)
            species_ends.push_back((species_ends.empty() ? 0 : species_ends.back()) + one.count);
        count_pair_distances(run_.system, width, species_ends, pairs);
        std::vector<std::uint64_t> now(pairs.size(), 0);
        add_over(run_.ranks, std::move(pairs), now);
        std::vector<double> ideal_now(now.size(), 0);
        const std::vector<double>& shares = ideal_shares(state.box, n, width);
        for (std::size_t second = 0; second < species.size(); ++second) {
            for (std::size_t first = 0; first <= second; ++first) {
                const auto n_first = static_cast<double>(species[first].count),
                           n_second = static_cast<double>(species[second].count);
                const double all = first == second ? 0.5 * n_first * (n_first - 1)
                                                   : n_first * n_second;
                for (std::size_t k = 0; k < n; ++k)
                    ideal_now[pair_kind(first, second) * n + k] = all * shares[k];
            }
        }
        for (std::size_t k = 0; k < now.size(); ++k) {
            pairs_[k] += now[k];
            ideal_pairs_[k] += ideal_now[k];
        }
        blocks_.add(ratios(with_all(numbers_of(now)), with_all(ideal_now)));
    }

    void keep(KeptNumbers& kept) override {
        keep_largest_distance(kept, run_, largest_distance_);
        kept.same(pairs_.size());
        kept(pairs_), kept(ideal_pairs_);
        keep_blocks(kept, blocks_);
    }

    std::vector<MeasuredTable> tables() const override {
        MeasuredTable table{"radial_distribution",
                            {"g: pairs at a distance from `from` to `to`, over those that as many "
                             "discs without size would have, anywhere in the box that centres have",
                             "distances in the scene's unit of length; pairs: of all samples; "
                             "g_error: one standard error, nan where samples are too few"},
                            {"from", "to", "pairs", "g", "g_error"},
                            {}};
        const std::size_t n_species = species_apart(run_.scene).size(), n = n_bins_of(run_);
        if (n_species > 1)
            table.remarks.push_back(
                "pairs_a_b, g_a_b: of a disc of species a and one of species b, "
                "species counted from 1 in the order of ids");
        for (std::size_t b = 1; b <= n_species && n_species > 1; ++b)
            for (std::size_t a = 1; a <= b; ++a)
                for (const char* what : {"pairs_{}_{}", "g_{}_{}", "g_{}_{}_error"})
                    table.columns.push_back(fmt::format(fmt::runtime(what), a, b));
        const std::vector<double> pairs = with_all(numbers_of(pairs_)),
                                  g = ratios(pairs, with_all(ideal_pairs_)),
                                  errors = errors_of(blocks_, run_.counts.n_samples);
        for (std::size_t k = 0; k < n; ++k) {
            std::vector<double> row = {edge(0, largest_distance_, k, n),
                                       edge(0, largest_distance_, k + 1, n)};
            for (std::size_t place = k; place < g.size(); place += n)
                row.insert(row.end(), {pairs[place], g[place], errors[place]});
            table.rows.push_back(std::move(row));
        }
        return {std::move(table)};
    }

private:
    /// The share of pairs of independent points in each bin. It is recomputed if the box changes.
    const std::vector<double>& ideal_shares(const Extent& box, std::size_t n, double width) {
        const Box size = box.size();
        if (shares_.size() == n && size == box_of_shares_) return shares_;
        shares_.clear();
        box_of_shares_ = size;
        for (std::size_t k = 0; k < n; ++k)
            shares_.push_back(ideal_share(size, static_cast<double>(k) * width,
                                          static_cast<double>(k + 1) * width));
        return shares_;
    }
    /// The share of pairs of independent points with distances from `inner` to `outer`, in the part
    /// of the box that centres can reach.
    double ideal_share(const Box& box, double inner, double outer) const {
        const double a = box.x - 2 * run_.scene.radius, b = box.y - 2 * run_.scene.radius;
        const bool goes_round_x = run_.scene.effects.is_periodic_x(),
                   goes_round_y = run_.scene.effects.is_periodic_y();
        const BoxShape shape = run_.scene.effects.fixed_bodies.shape;
        if (shape == BoxShape::stadium)
            return share_of_ideal_pairs_in_stadium(std::fabs(a - b), std::min(a, b) / 2, inner,
                                                   outer);
        const auto share = [&](double distance) {
            if (shape == BoxShape::round)
                return share_of_ideal_pairs_in_circle(std::min(a, b) / 2, distance);
            if (goes_round_x && goes_round_y)
                return share_of_ideal_pairs_around(run_.scene.box.area(), distance);
            if (goes_round_x || goes_round_y)
                return share_of_ideal_pairs_around_x(goes_round_x ? run_.scene.box.x
                                                                  : run_.scene.box.y,
                                                     goes_round_x ? b : a, distance);
            return share_of_ideal_pairs(a, b, distance);
        };
        return share(outer) - share(inner);
    }

    /// Number of curves: one for each kind of pairs and, if there are several, one for all pairs.
    static std::size_t n_curves(const SceneParameters& scene) {
        const std::size_t n_kinds = n_pair_kinds(species_apart(scene).size());
        return n_kinds > 1 ? n_kinds + 1 : 1;
    }
    /// The bins of each kind, preceded by their sums over all kinds if there are several kinds.
    std::vector<double> with_all(const std::vector<double>& of_kinds) const {
        const std::size_t n = n_bins_of(run_);
        if (of_kinds.size() == n) return of_kinds;
        std::vector<double> curves(n, 0);
        for (std::size_t k = 0; k < of_kinds.size(); ++k) curves[k % n] += of_kinds[k];
        curves.insert(curves.end(), of_kinds.begin(), of_kinds.end());
        return curves;
    }
    static std::vector<double> numbers_of(const std::vector<std::uint64_t>& counts) {
        return {counts.begin(), counts.end()};
    }
    /// Not inlined, because GCC 12 would otherwise warn, wrongly, about a `delete`.
    [[gnu::noinline]] static std::vector<double> ratios(const std::vector<double>& pairs,
                                                        const std::vector<double>& ideal_pairs) {
        std::vector<double> g(pairs.size(), 0);
        for (std::size_t k = 0; k < g.size(); ++k)
            if (ideal_pairs[k] > 0) g[k] = pairs[k] / ideal_pairs[k];
        return g;
    }

    double largest_distance_;
    std::vector<double> shares_;
    Box box_of_shares_;
    /// Counts of pairs: all bins of one kind of pairs (pair_distances.hpp), then of the next kind
    std::vector<std::uint64_t> pairs_;
    std::vector<double> ideal_pairs_; ///< expected counts if discs were independent points
    VectorBlocks blocks_;             ///< samples of g, all curves one after the other
};

} // namespace

MeasuredQuantity radial_distribution_quantity() {
    return {{.name = "radial_distribution",
             .help = "g(r): how many pairs of discs there are at each distance; by species, too.",
             .keys = {bins_key(), largest_distance_key()},
             .rules = {{.one = "\"radial_distribution\" of growing discs",
                        .other = "a wall",
                        .why = "centres have less and less room between walls; it needs a box that "
                               "is periodic all round",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "radial_distribution") &&
                                       s.effects.growth != 0 &&
                                       !(s.effects.is_periodic_x() && s.effects.is_periodic_y());
                            }},
                       {.one = "\"radial_distribution\"",
                        .other = "an open side",
                        .why = "with open sides velocities and densities alone are measured",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "radial_distribution") &&
                                       s.effects.have_open_boundaries();
                            }},
                       {.one = "\"radial_distribution\" of several species",
                        .other = "a wall",
                        .why = "centres of large discs have less room between walls; it needs a "
                               "box that is periodic all round",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures(s, "radial_distribution") &&
                                       !s.effects.species.empty() &&
                                       !(s.effects.is_periodic_x() && s.effects.is_periodic_y());
                            }}},
             .check = check_largest_distance},
            make_measurement<RadialDistribution>};
}

} // namespace carrom
