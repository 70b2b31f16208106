// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_cuts.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

std::uint64_t discs_in(const CellBlock& part, const CellCount& count) {
    std::uint64_t n = 0;
    for (int column = part.first_column; column < part.end_column; ++column)
        n += count(column, part.first_row, part.end_row);
    return n;
}

/// The discs that the run of a block sees, and what they cost.
struct Cost {
    double n_seen = 0, work = 0;
};

Cost cost_of(const CellBlock& part, const CellBlock& cells, const CutNeeds& needs,
             const CellCount& count) {
    const CellBlock seen{std::max(cells.first_column, part.first_column - needs.halo),
                         std::min(cells.end_column, part.end_column + needs.halo),
                         std::max(cells.first_row, part.first_row - needs.halo),
                         std::min(cells.end_row, part.end_row + needs.halo)};
    const auto n = static_cast<double>(discs_in(seen, count));
    const double area = static_cast<double>(seen.n_columns()) * seen.n_rows();
    return {n, n * (needs.work_per_disc + needs.work_per_crowding * n / area)};
}

/// Returns the cut between `first` and `end` that has about `wanted` discs below it, if
/// `below(cut)` counts them.
template <class Below> int cut_at(int first, int end, double wanted, const Below& below) {
    int low = first, high = end;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        (static_cast<double>(below(middle)) <= wanted ? low : high) = middle;
    }
    if (high >= end || low <= first) return low <= first ? high : low;
    const double missing = wanted - static_cast<double>(below(low)),
                 more = static_cast<double>(below(high)) - wanted;
    return missing <= more ? low : high;
}

/// Cuts the longer side, so that `share` of the discs are below the cut.
bool cut_longer(const CellBlock& part, double share, int least, const CellCount& count,
                bool& by_column, int& cut) {
    by_column = part.n_columns() >= part.n_rows();
    const int first = by_column ? part.first_column : part.first_row,
              end = by_column ? part.end_column : part.end_row;
    if (end - first < 2 * std::max(1, least)) return false;
    const auto below = [&](int at) {
        CellBlock lower = part;
        (by_column ? lower.end_column : lower.end_row) = at;
        return discs_in(lower, count);
    };
    const double wanted = share * static_cast<double>(discs_in(part, count));
    cut = std::clamp(cut_at(first, end, wanted, below), first + std::max(1, least),
                     end - std::max(1, least));
    return true;
}

} // namespace

std::uint64_t pairs_in_cells(const CellBlock& cells, const CellCount& count) {
    std::uint64_t pairs = 0;
    for (int column = cells.first_column; column < cells.end_column; ++column)
        for (int row = cells.first_row; row < cells.end_row; ++row) {
            const std::uint64_t n = count(column, row, row + 1);
            pairs += n > 0 ? n * (n - 1) : 0;
        }
    return pairs;
}

void BlockCuts::cut_evenly(const CellBlock& cells, int block_columns, int block_rows) {
    const auto parts = [](int n_cells, int each) { return (n_cells + each - 1) / each; };
    cut(cells, [&](const CellBlock& part, bool& by_column, int& cut) {
        const int n_columns = parts(part.n_columns(), block_columns),
                  n_rows = parts(part.n_rows(), block_rows);
        if (n_columns == 1 && n_rows == 1) return false;
        by_column = n_columns >= n_rows;
        cut = by_column ? part.first_column + n_columns / 2 * block_columns
                        : part.first_row + n_rows / 2 * block_rows;
        return true;
    });
}

void BlockCuts::cut_by_work(const CellBlock& cells, const CutNeeds& needs, const CellCount& count) {
    const auto cut_until = [&](double most_work) {
        double all = 0;
        cut(cells, [&](const CellBlock& part, bool& by_column, int& cut) {
            const Cost cost = cost_of(part, cells, needs, count);
            const double n_parts = std::ceil(
                std::max(cost.work / most_work, cost.n_seen / needs.most_seen));
            // Many parts are halved. Three become one and two.
            const double share = std::floor(n_parts / 2) / n_parts;
            if (n_parts > 1 && cut_longer(part, share, needs.least, count, by_column, cut))
                return true;
            all += cost.work;
            return false;
        });
        return all;
    };
    // The more blocks there are, the more halo all of them have, so the limit is found in steps.
    double work = cost_of(cells, cells, needs, count).work;
    const auto n = static_cast<double>(needs.n_blocks);
    for (int round = 0; round < 3; ++round) work = cut_until(std::max(work / n, 1e-300));
}

bool BlockCuts::is_uneven(double ratio, const CellCount& count) const {
    std::uint64_t most = 0, all = 0;
    for (const CellBlock& block : blocks_) {
        const std::uint64_t n = discs_in(block, count);
        most = std::max(most, n);
        all += n;
    }
    return static_cast<double>(most) * static_cast<double>(blocks_.size()) >
           ratio * static_cast<double>(all);
}

void BlockCuts::cut(const CellBlock& cells, const Decision& decide) {
    blocks_.clear();
    nodes_.clear();
    add(cells, decide);
}

std::size_t BlockCuts::add(const CellBlock& part, const Decision& decide) {
    const std::size_t place = nodes_.size();
    Node node;
    nodes_.push_back(node);
    if (decide(part, node.is_cut_by_column, node.cut)) {
        node.is_block = false;
        CellBlock lower = part, upper = part;
        (node.is_cut_by_column ? lower.end_column : lower.end_row) = node.cut;
        (node.is_cut_by_column ? upper.first_column : upper.first_row) = node.cut;
        node.lower = add(lower, decide);
        node.upper = add(upper, decide);
    } else {
        node.lower = blocks_.size();
        blocks_.push_back(part);
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
