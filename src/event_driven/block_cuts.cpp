// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_cuts.hpp"

#include <algorithm>
#include <numeric>

namespace carrom {

namespace {

/// Of the fullest block to the mean one. Below it cuts by number gain less than they cost, and
/// blocks of few discs differ as much by chance.
constexpr double crowded = 1.5;

std::vector<int> even_cuts(int first, int end, int each) {
    std::vector<int> cuts;
    for (int cut = first; cut < end; cut += each) cuts.push_back(cut);
    cuts.push_back(end);
    return cuts;
}

std::size_t part_of(const std::vector<int>& cuts, int cell) {
    const auto behind = std::upper_bound(cuts.begin() + 1, cuts.end() - 1, cell);
    return static_cast<std::size_t>(behind - cuts.begin()) - 1;
}

void shift(std::vector<int>& cuts, int by) {
    for (int& cut : cuts) cut += by;
}

} // namespace

std::vector<int> cuts_by_weight(const std::vector<std::uint64_t>& weights, int n_parts, int least) {
    const int n = static_cast<int>(weights.size());
    n_parts = std::clamp(n_parts, 1, std::max(1, n / std::max(1, least)));
    const std::uint64_t total = std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
    std::vector<int> cuts{0};
    double before = 0; // of the weights below `at`
    int at = 0;
    for (int part = 1; part < n_parts; ++part) {
        const int lowest = cuts.back() + least, highest = n - (n_parts - part) * least;
        const double wanted = static_cast<double>(total) * part / n_parts;
        for (; at < highest; ++at) {
            const auto weight = static_cast<double>(weights[static_cast<std::size_t>(at)]);
            // A weight across the border goes to the side on which more of it lies.
            if (at >= lowest && before + weight / 2 >= wanted) break;
            before += weight;
        }
        cuts.push_back(at);
    }
    cuts.push_back(n);
    return cuts;
}

std::uint64_t pairs_in_cells(const CellBlock& cells, const CellCount& count) {
    std::uint64_t pairs = 0;
    for (int column = cells.first_column; column < cells.end_column; ++column)
        for (int row = cells.first_row; row < cells.end_row; ++row) {
            const std::uint64_t n = count(column, row, row + 1);
            pairs += n * (n - 1);
        }
    return pairs;
}

void BlockCuts::cut(const CellBlock& cells, int block_columns, int block_rows, int least,
                    const CellCount& count) {
    columns_ = even_cuts(cells.first_column, cells.end_column, block_columns);
    rows_.assign(columns_.size() - 1, even_cuts(cells.first_row, cells.end_row, block_rows));
    if (n_blocks() == 1) return;
    std::uint64_t fullest = 0, total = 0;
    for (std::size_t k = 0; k < n_blocks(); ++k) {
        const CellBlock part = block(k);
        std::uint64_t n = 0;
        for (int column = part.first_column; column < part.end_column; ++column)
            n += count(column, part.first_row, part.end_row);
        fullest = std::max(fullest, n);
        total += n;
    }
    const double mean = static_cast<double>(total) / static_cast<double>(n_blocks());
    if (static_cast<double>(fullest) <= crowded * mean) return;

    const int n_block_columns = static_cast<int>(rows_.size()),
              n_block_rows = static_cast<int>(n_rows());
    std::vector<std::uint64_t> weights;
    for (int column = cells.first_column; column < cells.end_column; ++column)
        weights.push_back(count(column, cells.first_row, cells.end_row));
    columns_ = cuts_by_weight(weights, n_block_columns, least);
    shift(columns_, cells.first_column);
    rows_.resize(columns_.size() - 1);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        weights.assign(static_cast<std::size_t>(cells.end_row - cells.first_row), 0);
        for (int row = cells.first_row; row < cells.end_row; ++row)
            for (int column = columns_[k]; column < columns_[k + 1]; ++column)
                weights[static_cast<std::size_t>(row - cells.first_row)] += count(column, row,
                                                                                  row + 1);
        rows_[k] = cuts_by_weight(weights, n_block_rows, least);
        shift(rows_[k], cells.first_row);
    }
}

CellBlock BlockCuts::block(std::size_t k) const {
    const std::size_t column = k / n_rows(), row = k % n_rows();
    return {columns_[column], columns_[column + 1], rows_[column][row], rows_[column][row + 1]};
}

std::size_t BlockCuts::block_of(int column, int row) const {
    const std::size_t k = part_of(columns_, column);
    return k * n_rows() + part_of(rows_[k], row);
}

} // namespace carrom
