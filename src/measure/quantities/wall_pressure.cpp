// SPDX-License-Identifier: BSD-3-Clause
// "wall_pressure": the momentum that discs give to each side of the box, summed over all
// collisions and divided by length and time.
#include "measure/wall_sums.hpp"

namespace carrom {

namespace {

class WallPressure : public WallMeasurement {
public:
    explicit WallPressure(MeasuredRun& run) : WallMeasurement(run), since_last_(1) {}

    void take(std::span<const WallEvent> events) override {
        for (const WallEvent& event : events) {
            if (!event.is_at_side()) continue;
            since_last_.add(event.side, event.normal);
            counts_[event.side] += event.is_lasting ? 0 : 1;
        }
    }

    void sample(const SampledState& state) override {
        if (state.is_first) return;
        run_.ranks.sum(std::span<std::uint64_t>(counts_));
        const std::array<double, 4> impulses = since_last_.values(run_.ranks);
        given_.insert(given_.end(), impulses.begin(), impulses.end());
        for (std::size_t side = 0; side < 4; ++side) collisions_[side] += counts_[side];
        clear();
    }

    void keep(KeptNumbers& kept) override {
        kept(speed_scale_), kept(collisions_), kept(given_);
        std::vector<std::uint64_t> pending; ///< sums over all ranks since the last sample
        if (!kept.is_restored()) {
            std::array<std::uint64_t, 4> counts = counts_;
            run_.ranks.sum(std::span<std::uint64_t>(counts));
            const std::vector<std::uint64_t> words = since_last_.words(run_.ranks);
            for (std::size_t side = 0; side < 4; ++side)
                pending.insert(pending.end(), {words[2 * side], words[2 * side + 1], counts[side]});
        }
        kept(pending);
        if (!kept.is_restored()) return;
        follow();
        if (pending.size() != 12) return kept.refuse();
        if (!run_.ranks.is_root()) return;
        std::vector<std::uint64_t> words;
        for (std::size_t side = 0; side < 4; ++side) {
            words.insert(words.end(), {pending[3 * side], pending[3 * side + 1]});
            counts_[side] = pending[3 * side + 2];
        }
        since_last_.add_words(words.data());
    }

private:
    void clear() override {
        // This bound exceeds the sums of any run; the resolution is 2^-62 of a typical speed.
        since_last_ = WallSums(speed_scale_ * 0x1p62);
        counts_.fill(0);
    }

    MeasuredTable history() const override {
        MeasuredTable table{
            "wall_pressure_history",
            {"impulse that each side was given between two steps, over its length and "
             "that time (nan: a periodic side); masses of 1, times in steps"},
            {"from_step", "to_step", "left", "right", "bottom", "top"},
            {}};
        table.rows = rows_over_time(run_, given_, 4);
        return table;
    }

    MeasuredTable means_of(const MeasuredTable& history) const override {
        MeasuredTable table{
            "wall_pressure",
            {"mean pressure on each side with one standard error (from joined intervals of the "
             "history; nan where there are too few), and collisions with it"},
            {"left", "right", "bottom", "top", "left_error", "right_error", "bottom_error",
             "top_error", "left_collisions", "right_collisions", "bottom_collisions",
             "top_collisions"},
            {}};
        std::vector<double> row, errors, counts;
        for (const MeanAndError& side : means_over_time(history.rows)) {
            row.push_back(side.mean);
            errors.push_back(side.error);
        }
        for (const std::uint64_t n : collisions_) counts.push_back(static_cast<double>(n));
        for (const auto* part : {&errors, &counts})
            row.insert(row.end(), part->begin(), part->end());
        table.rows.push_back(std::move(row));
        return table;
    }

    std::array<std::uint64_t, 4> collisions_{};
    WallSums since_last_; ///< this rank's sums since the last sample
    std::array<std::uint64_t, 4> counts_{};
};

bool measures_wall_pressure(const SceneParameters& s) { return measures(s, "wall_pressure"); }

} // namespace

MeasuredQuantity wall_pressure_quantity() {
    return {{.name = "wall_pressure",
             .help = "Pressure on each side of the box, from all collisions with it.",
             .has_history = true,
             .follows_collisions = true,
             .rules = rules_of_walls<measures_wall_pressure>("\"wall_pressure\"")},
            make_measurement<WallPressure>,
            {"wall_pressure_history"}};
}

} // namespace carrom
