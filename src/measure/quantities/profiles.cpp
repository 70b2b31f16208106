// SPDX-License-Identifier: BSD-3-Clause
// "profiles": density, velocity, kinetic stress and temperature about the local mean, on a grid of
// cells, averaged over one block of time after another.
//
// A rank adds its own discs to exact sums; ranks are joined at the end of a block only. So the
// sums over all cells are those of all discs, to the last bit. Price: a pass over the discs at each
// sample, and 112 bytes a cell on each rank.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/exact_sum.hpp"
#include "measure/measurement.hpp"
#include "measure/speeds.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

constexpr QuantitySetting profile_columns{"profile_columns", 10}, profile_rows{"profile_rows", 10},
    profile_samples{"profile_samples", 10};
constexpr double most_rows = 1e6; ///< of the table

std::size_t n_cells_of(const MeasurementOutput& output) {
    return static_cast<std::size_t>(profile_columns.of(output) * profile_rows.of(output));
}

void check_grid(const Check& check) {
    const Scene& scene = check.scene;
    const MeasurementOutput& output = *scene.measurements;
    const std::size_t n_cells = n_cells_of(output);
    if (n_cells > scene.n_discs)
        check.refuse({profile_columns.key_name(), profile_rows.key_name(), quantities_key},
                     fmt::format("a grid of {} cells for \"profiles\" is more than the {} discs; "
                                 "try: smaller '{}' or '{}'",
                                 n_cells, scene.n_discs, profile_columns.key_name(),
                                 profile_rows.key_name()));
    const double n_blocks = static_cast<double>(scene.steps - output.from_step) /
                            static_cast<double>(output.every_steps) / profile_samples.of(output);
    if (n_blocks * static_cast<double>(n_cells) > most_rows)
        check.refuse({profile_samples.key_name(), quantities_key},
                     fmt::format("{:.0f} blocks of {} cells are more than a million rows; try: a "
                                 "larger '{}'",
                                 n_blocks, n_cells, profile_samples.key_name()));
}

enum Moment { mass, momentum_x, momentum_y, flux_xx, flux_xy, flux_yy, n_moments };

class Profiles : public Measurement {
public:
    explicit Profiles(MeasuredRun& run)
        : Measurement(run), n_x_(static_cast<std::size_t>(profile_columns.of(run.output))),
          n_y_(static_cast<std::size_t>(profile_rows.of(run.output))),
          per_block_(static_cast<std::uint64_t>(profile_samples.of(run.output))) {
        DiscId end = 0;
        for (const Species& one : run.scene.effects.species) ends_.push_back(end += one.count);
    }

    void begin() override {
        speed_ = std::max(usual_speed(run_), driven_speed(run_.scene));
        clear();
    }

    void sample(const SampledState& state) override {
        const double time = run_.simulation.clock(), unit = run_.simulation.velocity_unit();
        const double per_x = static_cast<double>(n_x_) / (state.box.x_high - state.box.x_low),
                     per_y = static_cast<double>(n_y_) / (state.box.y_high - state.box.y_low);
        const auto place = [](double x, std::size_t n) { // the edges belong to the last cells
            return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(n - 1)));
        };
        for (const Disc& disc : state.inside) {
            const std::size_t cell = place((disc.y_at(time) - state.box.y_low) * per_y, n_y_) *
                                         n_x_ +
                                     place((disc.x_at(time) - state.box.x_low) * per_x, n_x_);
            const double m = mass_of(disc.id), vx = disc.vx * unit, vy = disc.vy * unit;
            ++counts_[cell];
            ExactSum* const sums = &sums_[n_moments * cell];
            const double terms[] = {m, m * vx, m * vy, m * vx * vx, m * vx * vy, m * vy * vy};
            for (std::size_t k = 0; k < n_moments; ++k) sums[k].add(terms[k]);
        }
        area_ += (state.box.x_high - state.box.x_low) * (state.box.y_high - state.box.y_low);
        if (++n_samples_ == per_block_) end_block();
    }

    void keep(KeptNumbers& kept) override {
        kept.same(n_x_), kept.same(n_y_), kept.same(per_block_);
        kept(speed_), kept(n_samples_), kept(area_), kept(blocks_);
        std::vector<std::uint64_t> words;
        if (!kept.is_restored()) words = joined_words();
        kept(words);
        if (!kept.is_restored()) return;
        clear_sums();
        if (words.size() != words_per_cell * n_x_ * n_y_) return kept.refuse();
        if (run_.ranks.is_root()) add_words(words, counts_, sums_);
    }

    std::vector<MeasuredTable> tables() const override {
        MeasuredTable table{
            "profiles",
            {fmt::format("means over {} samples up to to_step, on a grid of {} by {} cells; x, y: "
                         "their centres{}",
                         per_block_, n_x_, n_y_,
                         are_sides_moving() ? ", as shares of the box's sides" : ""),
             "density: discs per area; vx, vy: of the centre of mass; xx, xy, yy: kinetic part of "
             "the pressure tensor, about that; temperature: kT, likewise; nan without discs",
             "lengths in the scene's unit, times in steps"},
            {"to_step", "x", "y", "count", "density", "vx", "vy", "temperature", "xx", "xy", "yy"},
            {}};
        const double width = are_sides_moving() ? 1 : run_.scene.box.x,
                     height = are_sides_moving() ? 1 : run_.scene.box.y;
        const std::size_t n_cells = n_x_ * n_y_;
        for (std::size_t k = 0; k < blocks_.size() / numbers_per_cell; ++k) {
            const double* const of = blocks_.data() + numbers_per_cell * k;
            const std::size_t cell = k % n_cells;
            const double samples = static_cast<double>(per_block_), area = of[1] / samples;
            const double n = of[0], m = of[2 + mass];
            const double vx = of[2 + momentum_x] / m, vy = of[2 + momentum_y] / m;
            const double xx = of[2 + flux_xx] - m * vx * vx, xy = of[2 + flux_xy] - m * vx * vy,
                         yy = of[2 + flux_yy] - m * vy * vy;
            const double per_area = 1 / (samples * area);
            table.rows.push_back(
                {run_.step_of((k / n_cells + 1) * per_block_ - 1),
                 (static_cast<double>(cell % n_x_) + 0.5) * width / static_cast<double>(n_x_),
                 (static_cast<double>(cell / n_x_) + 0.5) * height / static_cast<double>(n_y_), n,
                 n * per_area, vx, vy, (xx + yy) / (2 * n), xx * per_area, xy * per_area,
                 yy * per_area});
        }
        return {std::move(table)};
    }

private:
    static constexpr std::size_t numbers_per_cell = 2 + n_moments,
                                 words_per_cell = 1 + 4 * n_moments;

    bool are_sides_moving() const {
        const auto& sides = run_.scene.effects.boundaries;
        return std::any_of(sides.begin(), sides.end(), [](const Boundary& side) {
            return side.speed != 0 || side.amplitude != 0;
        });
    }

    double mass_of(DiscId id) const {
        if (ends_.empty()) return 1;
        const auto found = std::upper_bound(ends_.begin(), ends_.end(), id);
        return run_.scene.effects.species[static_cast<std::size_t>(found - ends_.begin())].mass;
    }

    void clear() {
        n_samples_ = 0;
        area_ = 0;
        clear_sums();
    }

    /// A bound that no sum comes to: 2^62 discs' samples of 2^20 times the usual speed.
    void clear_sums() {
        const double speed = std::max(speed_, 1.0) * 0x1p20;
        counts_.assign(n_x_ * n_y_, 0);
        sums_.assign(n_moments * n_x_ * n_y_, ExactSum(speed * speed * 0x1p30));
    }

    /// Counts and sums of all ranks: of each sum four words of 32 bits, so that carries stay apart.
    std::vector<std::uint64_t> joined_words() const {
        std::vector<std::uint64_t> words;
        words.reserve(words_per_cell * counts_.size());
        for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
            words.push_back(counts_[cell]);
            for (std::size_t k = 0; k < n_moments; ++k) {
                const ExactSum& sum = sums_[n_moments * cell + k];
                for (const std::uint64_t word : {sum.low_word(), sum.high_word()}) {
                    words.push_back(word & 0xffffffff);
                    words.push_back(word >> 32);
                }
            }
        }
        run_.ranks.sum(std::span(words));
        return words;
    }

    static void add_words(const std::vector<std::uint64_t>& words,
                          std::vector<std::uint64_t>& counts, std::vector<ExactSum>& sums) {
        const std::uint64_t* next = words.data();
        for (std::size_t cell = 0; cell < counts.size(); ++cell) {
            counts[cell] += *next++;
            for (std::size_t k = 0; k < n_moments; ++k, next += 4) {
                ExactSum& sum = sums[n_moments * cell + k];
                sum.add_words(next[0], 0);
                sum.add_words(next[1] << 32, next[1] >> 32);
                sum.add_words(0, next[2]);
                sum.add_words(0, next[3] << 32);
            }
        }
    }

    void end_block() {
        const std::vector<std::uint64_t> words = joined_words();
        const double area = area_ / static_cast<double>(counts_.size());
        clear();
        add_words(words, counts_, sums_);
        for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
            blocks_.push_back(static_cast<double>(counts_[cell]));
            blocks_.push_back(area);
            for (std::size_t k = 0; k < n_moments; ++k)
                blocks_.push_back(sums_[n_moments * cell + k].value());
        }
        clear();
    }

    std::size_t n_x_, n_y_;
    std::uint64_t per_block_;
    std::vector<DiscId> ends_; ///< of the ids of each species
    double speed_ = 0;
    std::uint64_t n_samples_ = 0; ///< of the block that has begun
    double area_ = 0;             ///< of the box, over these
    std::vector<std::uint64_t> counts_;
    std::vector<ExactSum> sums_; ///< of this rank
    std::vector<double> blocks_; ///< of each cell: count, area over all samples, moments
};

Key grid_key(const QuantitySetting& setting, std::string_view help) {
    return setting.integer("1", help).within({1, 10000});
}

} // namespace

MeasuredQuantity profiles_quantity() {
    return {{.name = "profiles",
             .help = "Density, velocity, temperature and kinetic stress on a grid, block by block.",
             .keys = {grid_key(profile_columns, "Cells of \"profiles\" along x."),
                      grid_key(profile_rows, "Cells of \"profiles\" along y."),
                      profile_samples
                          .integer("samples", "Samples that a block of \"profiles\" averages.")
                          .within({1, largest_steps})},
             .check = check_grid},
            make_measurement<Profiles>};
}

} // namespace carrom
