// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace carrom {

namespace {

/// Largest number of rounds that adjust the blocks' shares, in the first window and in later ones.
/// The rounds end earlier if the block with the most work has at most `even_enough` times the mean
/// work. A round with 128 blocks takes 40 us on one thread.
constexpr int first_rounds = 10, later_rounds = 4;
constexpr double even_enough = 1.08;

/// Returns the first column or row in (first, end] from which on `is_beyond` holds. It is
/// assumed to hold at `end`.
template <class Claim> int first_beyond(int first, int end, const Claim& is_beyond) {
    while (end - first > 1) {
        const int middle = first + (end - first) / 2;
        (is_beyond(middle) ? end : first) = middle;
    }
    return end;
}

/// Cuts a rectangle across the longer side of the part that contains discs, so that about `share`
/// of the work is below the cut. Returns false if there is no work, or if all of it is in one cell.
bool cut_longer(const CellBlock& part, double share, const CellSums& sums, bool& by_column,
                int& cut) {
    const double wanted = share * static_cast<double>(sums.in(part));
    if (!(wanted > 0)) return false;
    const CellBlock full = sums.occupied(part);
    by_column = full.n_columns() >= full.n_rows();
    const int first = by_column ? full.first_column : full.first_row,
              end = by_column ? full.end_column : full.end_row;
    if (end - first < 2) return false;
    const auto below = [&](int at) {
        CellBlock lower = full;
        (by_column ? lower.end_column : lower.end_row) = at;
        return static_cast<double>(sums.in(lower));
    };
    const int high = first_beyond(first, end, [&](int at) { return below(at) > wanted; });
    const int nearest = wanted - below(high - 1) <= below(high) - wanted ? high - 1 : high;
    cut = std::clamp(nearest, first + 1, end - 1);
    return true;
}

} // namespace

std::uint64_t CellSums::in(const CellBlock& part) const {
    const auto below = [&](int column, int row) { return sums_[place(column, row)]; };
    return below(part.end_column, part.end_row) - below(part.first_column, part.end_row) -
           below(part.end_column, part.first_row) + below(part.first_column, part.first_row);
}

CellBlock CellSums::occupied(CellBlock part) const {
    const std::uint64_t all = in(part);
    const auto tighten = [&](int CellBlock::* first, int CellBlock::* end) {
        const auto until = [&](int at) {
            CellBlock lower = part;
            lower.*end = at;
            return in(lower);
        };
        const int low = part.*first, high = part.*end;
        part.*end = first_beyond(low, high, [&](int at) { return until(at) == all; });
        part.*first = first_beyond(low, part.*end, [&](int at) { return until(at) > 0; }) - 1;
    };
    tighten(&CellBlock::first_column, &CellBlock::end_column);
    tighten(&CellBlock::first_row, &CellBlock::end_row);
    return part;
}

void BlockCuts::cut_evenly(const CellBlock& cells, int block_columns, int block_rows) {
    const auto parts = [](int n_cells, int each) { return (n_cells + each - 1) / each; };
    cut(cells, 1, [&](const CellBlock& part, std::size_t, std::size_t, Cut& cut) {
        const int n_columns = parts(part.n_columns(), block_columns),
                  n_rows = parts(part.n_rows(), block_rows);
        if (n_columns == 1 && n_rows == 1) return false;
        cut.is_by_column = n_columns >= n_rows;
        cut.at = cut.is_by_column ? part.first_column + n_columns / 2 * block_columns
                                  : part.first_row + n_rows / 2 * block_rows;
        return true;
    });
}

void BlockCuts::cut_by_work(const CellBlock& cells, const CutNeeds& needs, const CellSums& sums) {
    // Discs hardly move in a window, so the shares found for the last window are nearly right.
    const bool is_first = shares_.size() != needs.n_blocks;
    if (is_first) shares_.assign(needs.n_blocks, 1);
    const int n_rounds = is_first ? first_rounds : later_rounds;
    std::vector<double> shares = shares_;
    const auto cut_as = [&](const std::vector<double>& wanted) {
        cut(cells, wanted.size(),
            [&](const CellBlock& part, std::size_t first, std::size_t end, Cut& cut) {
                if (end - first < 2) return false;
                cut.middle = first + (end - first) / 2;
                const double* const of = wanted.data();
                const double lower = std::accumulate(of + first, of + cut.middle, 0.0),
                             upper = std::accumulate(of + cut.middle, of + end, 0.0);
                return cut_longer(part, lower / (lower + upper), sums, cut.is_by_column, cut.at);
            });
    };
    // Only the work in own cells is known. The halo around them is assumed to have the same work
    // per area.
    const auto work_with_halo = [&](const CellBlock& block) {
        const CellBlock seen = block.widened(needs.halo).within(needs.frame),
                        known = seen.within(cells);
        return static_cast<double>(sums.in(known)) * seen.area() / known.area();
    };
    const auto weigh = [&] {
        work_.clear();
        for (const CellBlock& block : blocks_) work_.push_back(work_with_halo(block));
    };
    double least = std::numeric_limits<double>::infinity();
    bool is_best = false;
    for (int round = 0; round < n_rounds && least > even_enough; ++round) {
        cut_as(shares);
        weigh();
        const double most = *std::max_element(work_.begin(), work_.end()),
                     mean = std::accumulate(work_.begin(), work_.end(), 0.0) /
                            static_cast<double>(work_.size());
        is_best = most < least * mean;
        if (is_best) {
            least = most / mean;
            shares_ = shares;
        }
        // The square root damps the change. With the full ratio, shares would overshoot in each
        // round, because the halos also change with the cuts.
        for (std::size_t k = 0; k < work_.size(); ++k)
            shares[numbers_[k]] *= std::sqrt(std::clamp(mean / std::max(work_[k], 1.0), 0.5, 2.0));
    }
    if (is_best) return;
    cut_as(shares_);
    weigh();
}

void BlockCuts::cut(const CellBlock& cells, std::size_t n_blocks, const Decision& decide) {
    blocks_.clear();
    numbers_.clear();
    nodes_.clear();
    work_.clear();
    add(cells, 0, n_blocks, decide);
}

std::size_t BlockCuts::add(const CellBlock& part, std::size_t first, std::size_t end,
                           const Decision& decide) {
    const std::size_t place = nodes_.size();
    Node node;
    nodes_.push_back(node);
    if (Cut cut; decide(part, first, end, cut)) {
        node.is_block = false;
        node.is_cut_by_column = cut.is_by_column;
        node.cut = cut.at;
        CellBlock lower = part, upper = part;
        (cut.is_by_column ? lower.end_column : lower.end_row) = cut.at;
        (cut.is_by_column ? upper.first_column : upper.first_row) = cut.at;
        node.lower = add(lower, first, cut.middle, decide);
        node.upper = add(upper, cut.middle, end, decide);
    } else {
        node.lower = blocks_.size();
        blocks_.push_back(part);
        numbers_.push_back(first);
    }
    nodes_[place] = node;
    return place;
}

std::size_t BlockCuts::block_of(int column, int row) const {
    const Node* node = &nodes_.front();
    while (!node->is_block)
        node = &nodes_[(node->is_cut_by_column ? column : row) < node->cut ? node->lower
                                                                           : node->upper];
    return node->lower;
}

} // namespace carrom
