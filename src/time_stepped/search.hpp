// SPDX-License-Identifier: BSD-3-Clause
// Finds the candidates of a window: every contact in it, once, sorted by micro-step.
//
// A prediction is a function of two stored states, and is valid until one of them changes. So
// after a micro-step only the discs that collided are predicted again. Each thread owns columns of
// cells and has its own lists; no result depends on the order of the lists. Cost: some 30 tests in
// single precision per disc and window, and one in double precision for each pair that passes them.
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

/// The candidates of one micro-step, in sections by the time of prediction. The `seen` of a section
/// is the number (WindowState) of the latest state that any disc had at this time.
struct MicroStepList {
    struct Section {
        WindowState seen = 0; ///< number of the latest state of any disc at the prediction
        std::size_t begin = 0;
    };
    Candidates candidates;
    std::vector<Section> sections;

    void add(const Candidate& candidate, WindowState seen);
    /// Removes candidates with a disc that has collided since the prediction; `states` is indexed
    /// by disc. Afterwards there are no sections.
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
    std::vector<MicroStepList> by_micro; ///< one list for each micro-step of the window
    std::size_t most_candidates = 0;     ///< the largest number of candidates in a list so far
    std::vector<DiscPair> pairs;         ///< pairs, of which only the first n_pairs count
    std::size_t n_pairs = 0;

    /// Returns the candidates of list `bucket` that are still valid. The list is empty afterwards.
    Candidates take(std::size_t bucket, std::span<const WindowState> states);
};

template <class Dynamics> class Search {
public:
    /// Cells are made for discs up to `usual_radius`; larger discs are searched separately.
    Search(const Dynamics& dynamics, int n_threads, double usual_radius);
    double usual_radius() const { return usual_radius_; }
    /// Lists the large discs. Call it after the grid has been built for the next window, and before
    /// CellGrid::set_apart.
    void list_large(const Population& population, const CellGrid& grid);
    /// Replaces the dynamics after a sync, because moving images then have other positions.
    void change_dynamics(const Dynamics& dynamics) { dynamics_ = dynamics; }

    /// Predicts all contacts in `window`, for which the grid must have been built. `reach` is the
    /// reach of discs up to the usual radius, without those that the grid has set apart.
    void predict_all(const Population& population, const CellGrid& grid, const Window& window,
                     double reach);

    /// Predicts the contacts of the own and halo discs in `hit`, which collided in micro-step
    /// `from` - 1, for the window's micro-steps from `from` on. Entries `wall_index` are skipped.
    /// The grid and `states`, indexed by disc, must be up to date. `reach` is as in predict_all.
    void predict_again(const Population& population, const CellGrid& grid, const Window& window,
                       int from, double reach, std::span<const LocalIndex> hit,
                       std::span<const WindowState> states);

    /// Returns the candidates of micro-step m that are still valid; `states` is indexed by disc.
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
    std::vector<SearchLists> lists_; ///< lists of each thread
};

#define CARROM_DECLARE(Dynamics) extern template class Search<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DECLARE)
#undef CARROM_DECLARE

} // namespace carrom
