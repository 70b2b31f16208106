// SPDX-License-Identifier: BSD-3-Clause
// "obstacle_forces": the force and the torque of discs on each obstacle and on the wall of a round
// box, summed over all collisions. Column `push` over the wall's length is the pressure on it.
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "dynamics/container.hpp"
#include "measure/speeds.hpp"
#include "measure/wall_sums.hpp"

namespace carrom {

namespace {

constexpr std::size_t most_obstacles = 10'000;
constexpr std::size_t n_force_parts = 5;
constexpr std::array<const char*, n_force_parts> force_words{"fx", "fy", "torque", "push", "power"};

class ObstacleForces : public Measurement, public WallFollower {
public:
    explicit ObstacleForces(MeasuredRun& run)
        : Measurement(run), rows_(rows_of(run.scene.effects.fixed_bodies, run.scene.box)) {}
    ~ObstacleForces() override { followers().forget(*this); }

    void begin() override {
        speed_scale_ = std::max(usual_speed(run_), driven_speed(run_.scene));
        follow();
    }

    void take(std::span<const WallEvent> events) override {
        for (const WallEvent& event : events) {
            if (event.is_at_side()) continue;
            ExactSum* const sums = &since_last_[n_force_parts * event.body];
            sums[0].add(-event.ix);
            sums[1].add(-event.iy);
            sums[2].add(event.torque);
            sums[3].add(event.normal);
            sums[4].add(event.energy);
        }
    }

    void sample(const SampledState& state) override {
        if (state.is_first) return;
        for (const ExactSum& mine : since_last_) {
            ExactSum sum = mine;
            run_.ranks.sum(sum);
            given_.push_back(sum.value());
        }
        clear();
    }

    void keep(KeptNumbers& kept) override {
        kept(speed_scale_), kept(given_);
        std::vector<std::uint64_t> pending;
        if (!kept.is_restored())
            for (const ExactSum& mine : since_last_) {
                ExactSum sum = mine;
                run_.ranks.sum(sum);
                pending.insert(pending.end(), {sum.low_word(), sum.high_word()});
            }
        kept(pending);
        if (!kept.is_restored()) return;
        follow();
        if (pending.size() != 2 * since_last_.size()) return kept.refuse();
        if (!run_.ranks.is_root()) return;
        for (std::size_t k = 0; k < since_last_.size(); ++k)
            since_last_[k].add_words(pending[2 * k], pending[2 * k + 1]);
    }

    std::vector<MeasuredTable> tables() const override {
        if (given_.empty()) return {};
        return {means(), history()};
    }

private:
    /// The quantity force_words[part] for obstacle `row`: its mean per step over an interval.
    double rate_of(std::size_t interval, std::size_t row, std::size_t part) const {
        return given_[(interval * rows_.size() + row) * n_force_parts + part] /
               static_cast<double>(run_.output.every_steps);
    }
    std::size_t n_intervals() const { return given_.size() / (n_force_parts * rows_.size()); }

    MeasuredTable means() const {
        MeasuredTable table{"obstacle_forces",
                            {"forces of the discs on each obstacle, and torques about its centre "
                             "(x, y), with one standard error (nan where intervals are too few)",
                             "push: what discs press on its faces, all directions added up; power: "
                             "energy of motion that it gives to them",
                             "masses of 1, times in steps; spins do not count in power",
                             obstacles_text()},
                            {"obstacle", "x", "y", "length"},
                            {}};
        for (const char* part : force_words)
            table.columns.insert(table.columns.end(), {part, fmt::format("{}_error", part)});
        for (std::size_t row = 0; row < rows_.size(); ++row) {
            std::vector<std::vector<double>> over_time;
            for (std::size_t k = 0; k < n_intervals(); ++k) {
                over_time.push_back({0, 0}); // the two steps, which `means_over_time` skips
                for (std::size_t part = 0; part < n_force_parts; ++part)
                    over_time.back().push_back(rate_of(k, row, part));
            }
            const BodyRow& one = rows_[row];
            table.rows.push_back({static_cast<double>(row + 1), one.x - run_.scene.origin.x,
                                  one.y - run_.scene.origin.y, one.length});
            for (const MeanAndError& mean : means_over_time(over_time))
                table.rows.back().insert(table.rows.back().end(), {mean.mean, mean.error});
        }
        return table;
    }

    MeasuredTable history() const {
        MeasuredTable table{
            "obstacle_forces_history",
            {"the same between two steps of the run, for one obstacle after the other"},
            {"from_step", "to_step", "obstacle"},
            {}};
        for (const char* part : force_words) table.columns.emplace_back(part);
        for (std::size_t k = 0; k < n_intervals(); ++k)
            for (std::size_t row = 0; row < rows_.size(); ++row) {
                const double from = run_.step_of(k),
                             to = from + static_cast<double>(run_.output.every_steps);
                table.rows.push_back({from, to, static_cast<double>(row + 1)});
                for (std::size_t part = 0; part < n_force_parts; ++part)
                    table.rows.back().push_back(rate_of(k, row, part));
            }
        return table;
    }

    Followers<WallEvent>& followers() const { return run_.system.engine().followers_of_walls(); }

    void follow() {
        clear();
        followers().forget(*this);
        followers().add(*this);
    }

    void clear() {
        // These bounds exceed the sums of any run. The resolution is 2^-62 times a typical impulse;
        // for torque also times the box length, and for power also times the typical speed.
        const double impulse = speed_scale_ * 0x1p62;
        const std::array<double, n_force_parts> bounds{
            impulse, impulse, impulse * run_.scene.box.longest(), impulse, impulse * speed_scale_};
        since_last_.clear();
        for (std::size_t row = 0; row < rows_.size(); ++row)
            for (const double bound : bounds) since_last_.emplace_back(bound);
    }

    /// Text that states with which obstacle number each kind of fixed body begins.
    std::string obstacles_text() const {
        std::string text;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (k > 0 && rows_[k].kind == rows_[k - 1].kind) continue;
            text += fmt::format("{}{} is {}", text.empty() ? "obstacle " : ", ", k + 1,
                                rows_[k].name());
        }
        return text;
    }

    std::vector<BodyRow> rows_;
    double speed_scale_ = 0;           ///< typical speed, which defines the units of sums
    std::vector<ExactSum> since_last_; ///< this rank's sums for each obstacle in this interval
    std::vector<double> given_;        ///< sums over all ranks, by interval and obstacle
};

bool measures_forces(const SceneParameters& s) { return measures(s, "obstacle_forces"); }

} // namespace

MeasuredQuantity obstacle_forces_quantity() {
    return {{.name = "obstacle_forces",
             .help = "Force and torque of discs on each obstacle, and on the wall of a box.shape.",
             .has_history = true,
             .rules = {{.one = "\"obstacle_forces\"",
                        .other = "a box without obstacles",
                        .why = "there is nothing to push",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                return measures_forces(s) && !s.effects.fixed_bodies.are_any();
                            }},
                       {.one = "\"obstacle_forces\"",
                        .other = "more than 10,000 obstacles",
                        .why = "its tables have a row for each of them",
                        .keys = {quantities_key},
                        .is_broken =
                            [](const SceneParameters& s) {
                                const FixedBodyList& o = s.effects.fixed_bodies;
                                return measures_forces(s) && o.discs.size() + o.segments.size() +
                                                                     o.polygons.size() +
                                                                     o.arcs.size() >
                                                                 most_obstacles;
                            }}}},
            make_measurement<ObstacleForces>,
            {"obstacle_forces_history"}};
}

} // namespace carrom
