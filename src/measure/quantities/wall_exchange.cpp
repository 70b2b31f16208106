// SPDX-License-Identifier: BSD-3-Clause
// "wall_exchange": the energy, and the momentum along the side, that each side of the box gives to
// the discs, summed over all collisions and divided by length and time. Between walls with
// different temperatures the energy is the flow of heat. Between sliding walls the momentum is the
// shear stress.
#include <array>
#include <string>

#include <fmt/format.h>

#include "measure/wall_sums.hpp"

namespace carrom {

namespace {

constexpr std::array side_words{"left", "right", "bottom", "top"};
constexpr std::array part_words{"heat", "shear"};

class WallExchange : public WallMeasurement {
public:
    explicit WallExchange(MeasuredRun& run)
        : WallMeasurement(run), since_last_{WallSums(1), WallSums(1)} {}

    void take(std::span<const WallEvent> events) override {
        for (const WallEvent& event : events) {
            if (!event.is_at_side()) continue;
            since_last_[0].add(event.side, event.energy);
            since_last_[1].add(event.side, event.along);
        }
    }

    void sample(const SampledState& state) override {
        if (state.is_first) return;
        for (const WallSums& part : since_last_) {
            const std::array<double, 4> sums = part.values(run_.ranks);
            given_.insert(given_.end(), sums.begin(), sums.end());
        }
        clear();
    }

    void keep(KeptNumbers& kept) override {
        kept(speed_scale_), kept(given_);
        std::array<std::vector<std::uint64_t>, 2> pending;
        for (std::size_t part = 0; part < 2 && !kept.is_restored(); ++part)
            pending[part] = since_last_[part].words(run_.ranks);
        for (std::vector<std::uint64_t>& words : pending) kept(words);
        if (!kept.is_restored()) return;
        follow();
        for (std::size_t part = 0; part < 2; ++part) {
            if (pending[part].size() != 8) return kept.refuse();
            if (run_.ranks.is_root()) since_last_[part].add_words(pending[part].data());
        }
    }

private:
    void clear() override {
        // No sum exceeds these bounds. The resolution is 2^-62 speed_scale_^2 for the energy and
        // 2^-62 speed_scale_ for the momentum.
        since_last_ = {WallSums(speed_scale_ * speed_scale_ * 0x1p62),
                       WallSums(speed_scale_ * 0x1p62)};
    }

    MeasuredTable history() const override {
        MeasuredTable table{
            "wall_exchange_history",
            {"heat: kinetic energy that a side has given to the discs between two steps, work of "
             "moving walls with it; shear: momentum along the side; over its length and that time "
             "(nan: a periodic side)",
             "masses of 1, times in steps; spins do not count"},
            {"from_step", "to_step"},
            {}};
        for (const char* part : part_words)
            for (const char* side : side_words)
                table.columns.push_back(fmt::format("{}_{}", side, part));
        table.rows = rows_over_time(run_, given_, 8);
        return table;
    }

    MeasuredTable means_of(const MeasuredTable& history) const override {
        MeasuredTable table{
            "wall_exchange",
            {"means over the history with one standard error (nan where intervals are too few)"},
            {},
            {{}}};
        const std::vector<MeanAndError> means = means_over_time(history.rows);
        for (std::size_t n = 0; n < means.size(); ++n) {
            const std::string& name = history.columns[2 + n];
            table.columns.insert(table.columns.end(), {name, name + "_error"});
            table.rows[0].insert(table.rows[0].end(), {means[n].mean, means[n].error});
        }
        return table;
    }

    std::array<WallSums, 2> since_last_; ///< this rank's heat and shear since the last sample
};

bool measures_exchange(const SceneParameters& s) { return measures(s, "wall_exchange"); }

} // namespace

MeasuredQuantity wall_exchange_quantity() {
    return {{.name = "wall_exchange",
             .help = "Energy and momentum along it that each side gives to the discs.",
             .has_history = true,
             .follows_collisions = true,
             .rules = rules_of_walls<measures_exchange>("\"wall_exchange\"")},
            make_measurement<WallExchange>,
            {"wall_exchange_history"}};
}

} // namespace carrom
