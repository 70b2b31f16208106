// SPDX-License-Identifier: BSD-3-Clause
// The layout of a box whose rows of images slide along x. The shift is not a whole number of cells,
// so a ghost and its disc have different positions within their cells. Therefore each ghost is
// sorted into cells by its own position.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "event_driven/box_layout.hpp"

namespace carrom {

namespace {

/// A disc, or a ghost of one, in a cell of the layout.
struct Entry {
    std::uint32_t cell = 0, listed = 0;
    Image image;
};

/// Lists the entries of one disc in the layout: the disc itself and its ghosts.
class Places {
public:
    Places(const BoxCells& cells, const Periods& periods, double time)
        : cells_(cells), periods_(periods), offset_(periods.offset_at(time)), time_(time) {}

    std::uint32_t column_length() const {
        return static_cast<std::uint32_t>(cells_.n_rows + 2 * cells_.n_above) + 1;
    }
    std::size_t n_starts() const {
        return static_cast<std::size_t>(cells_.n_columns + 2 * cells_.n_beside) * column_length();
    }

    void list(const DiscState& disc, Image home, std::size_t listed,
              std::vector<Entry>& entries) const {
        const Shift shift = periods_.shift_of(home, time_);
        const double x = disc.x_at(time_) + shift.x, y = disc.y_at(time_) + shift.y;
        const int row = std::clamp(static_cast<int>(std::floor(y / cells_.height)), 0,
                                   cells_.n_rows - 1);
        const int farthest = cells_.n_above / cells_.n_rows + 1;
        for (int up = -farthest; up <= farthest; ++up) {
            const int ghost_row = row + up * cells_.n_rows;
            if (ghost_row < -cells_.n_above || ghost_row >= cells_.n_rows + cells_.n_above)
                continue;
            list_row(x + up * offset_, {0, up}, ghost_row, listed, entries);
        }
    }

private:
    /// Lists all images in one row of cells, from the first column of the layout on.
    void list_row(double place, Image image, int row, std::size_t listed,
                  std::vector<Entry>& entries) const {
        auto column = static_cast<int>(std::floor(place / cells_.width));
        if (image.y == 0) column = std::clamp(column, 0, cells_.n_columns - 1);
        while (column >= -cells_.n_beside) column -= cells_.n_columns, --image.x;
        while (column < -cells_.n_beside) column += cells_.n_columns, ++image.x;
        for (; column < cells_.n_columns + cells_.n_beside; column += cells_.n_columns, ++image.x) {
            const auto cell = static_cast<std::uint32_t>(column + cells_.n_beside) *
                                  column_length() +
                              static_cast<std::uint32_t>(row + cells_.n_above);
            entries.push_back({cell, static_cast<std::uint32_t>(listed), image});
        }
    }

    const BoxCells& cells_;
    const Periods& periods_;
    double offset_, time_;
};

} // namespace

void BoxLayout::lay_sliding(std::span<const DiscState> discs, std::size_t n_own,
                            const BoxCells& cells, const Periods& periods, double time) {
    const Places places(cells, periods, time);
    std::vector<Entry> entries;
    for (std::size_t k = 0; k < listed_.size(); ++k) {
        const DiscState& disc = discs[listed_[k]];
        places.list(disc, listed_[k] < n_own ? image_of(disc) : periods.home(disc, time), k,
                    entries);
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
    starts_.assign(places.n_starts(), 0);
    for (const Entry& entry : entries)
        if (entry.cell + 1 < starts_.size()) ++starts_[entry.cell + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    indices_.resize(entries.size());
    std::vector<std::uint32_t> slot_of(listed_.size()); // for each listed disc, its own slot
    for (std::uint32_t slot = 0; slot < entries.size(); ++slot) {
        indices_[slot] = listed_[entries[slot].listed];
        if (entries[slot].image == Image{}) slot_of[entries[slot].listed] = slot;
    }
    ghosts_.clear();
    ghost_at_.assign(entries.size(), none);
    first_ghost_.assign(entries.size(), none);
    for (std::uint32_t slot = 0; slot < entries.size(); ++slot) {
        if (entries[slot].image == Image{}) continue;
        const Shift shift = periods.shift_of(entries[slot].image, time);
        const std::uint32_t disc = slot_of[entries[slot].listed];
        ghosts_.push_back({slot, disc, first_ghost_[disc], entries[slot].image,
                           static_cast<float>(shift.x / cells.width),
                           static_cast<float>(shift.y / cells.width)});
        first_ghost_[disc] = ghost_at_[slot] = static_cast<std::uint32_t>(ghosts_.size() - 1);
    }
}

} // namespace carrom
