// SPDX-License-Identifier: BSD-3-Clause
// Finds the candidates of a window: every contact that falls into it, once, filed under its
// micro-step.
//
// A prediction is a function of two stored states. It stays good until one of them is rewritten, so
// after a micro-step only the discs that were hit are predicted again. Threads own columns of cells
// and keep lists of their own; nothing depends on the lists' order. Price: some 30 single-precision
// tests a disc and window, a double one for each survivor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "core/disc_state.hpp"
#include "dynamics/all_dynamics.hpp"
#include "time_stepped/candidate.hpp"
#include "time_stepped/large_discs.hpp"
#include "time_stepped/window.hpp"

namespace carrom {

/// The candidates of one micro-step, in sections by the time of prediction. A
/// section's `seen` is the last of the window's states that existed then.
struct MicroStepList {
    struct Section {
        WindowState seen = 0; ///< the last state of any disc at that time
        std::size_t begin = 0;
    };
    Candidates candidates;
    std::vector<Section> sections;

    void add(const Candidate& candidate, WindowState seen);
    /// Removes candidates of which a disc has been hit since the prediction; `states`
    /// is indexed by disc. The rest is not in sections any more.
    void drop_stale(std::span<const WindowState> states);
    /// Empties the list, and reserves room for `n_expected` candidates.
    void begin(std::size_t n_expected) {
        candidates.clear();
        candidates.reserve(n_expected);
        sections.clear();
    }
};

/// One thread's lists and scratch space.
struct SearchLists {
    std::vector<MicroStepList> by_micro; ///< from the window's first micro-step on
    std::size_t most_candidates = 0;     ///< the most that any of the lists has had
    std::vector<DiscPair> pairs;         ///< only the first n_pairs count
    std::size_t n_pairs = 0;

    /// Moves the candidates that are still current out of the list.
    Candidates take(std::size_t bucket, std::span<const WindowState> states);
};

template <class Dynamics> class Search {
public:
    /// Cells fit discs up to `usual_radius`; larger ones search around themselves.
    Search(const Dynamics& dynamics, int n_threads, double usual_radius);
    double usual_radius() const { return usual_radius_; }
    /// Lists the large discs. The grid must have been built for the next window, and have set no
    /// discs apart yet.
    void list_large(const Population& population, const CellGrid& grid);
    /// Replaces the dynamics after a sync, because images that move are elsewhere then.
    void change_dynamics(const Dynamics& dynamics) { dynamics_ = dynamics; }

    /// Predicts all contacts in `window`. The grid must have been built for it.
    /// `reach` is that of discs of the usual radius that the grid has not set apart.
    void predict_all(const Population& population, const CellGrid& grid, const Window& window,
                     double reach);

    /// Predicts the contacts of the discs `hit` by micro-step `from` - 1 (own or halo;
    /// `wall` stands for none) for the window's micro-steps from `from` on. The grid
    /// and `states`, by disc, must be up to date. `reach` is as
    /// in predict_all.
    void predict_again(const Population& population, const CellGrid& grid, const Window& window,
                       int from, double reach, std::span<const LocalIndex> hit,
                       std::span<const WindowState> states);

    /// Returns the candidates of micro-step m that are still current; `states` is indexed by disc.
    Candidates collect(const Window& window, int m, std::span<const WindowState> states);

private:
    struct Bounds;

    void predict_column(const Population&, const CellGrid&, const Window&, const Bounds&,
                        int column, SearchLists&) const;
    void predict_apart(const Population&, const CellGrid&, const Window&, const Bounds&,
                       double reach, std::uint32_t k, SearchLists&) const;
    void predict_large(const Population&, const CellGrid&, const Window&, const Bounds&,
                       double reach, std::uint32_t k, SearchLists&) const;
    void find_pairs_around(const Population&, const CellGrid&, const Bounds&, float from,
                           double reach, std::span<const LocalIndex> hit, SearchLists&) const;
    void find_pairs_with_large(const Population&, const CellGrid&, const Bounds&, float from,
                               double reach, LocalIndex index, SearchLists&) const;
    float half_reach(const CellGrid&, double reach, double radius) const;
    bool is_large(const DiscState& disc) const {
        if constexpr (Dynamics::has_species)
            return large_.size() > 0 &&
                   dynamics_.species_table().of(disc.id).radius > usual_radius_;
        return false;
    }
    void predict_pair(const Population&, const Window&, int from, LocalIndex a, LocalIndex b,
                      SearchLists&) const;
    void predict_wall(const Population&, const Window&, int from, LocalIndex index,
                      SearchLists&) const;

    Dynamics dynamics_;
    int n_threads_;
    double usual_radius_;
    LargeDiscs large_;
    std::vector<SearchLists> lists_; ///< by thread
};

#define CARROM_DECLARE(Dynamics) extern template class Search<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DECLARE)
#undef CARROM_DECLARE

} // namespace carrom
