// SPDX-License-Identifier: BSD-3-Clause
// "profiles": density, velocity, temperature relative to the local mean, the pressure tensor and
// the flow of heat, on a grid of cells, averaged over successive blocks of time.
//
// Kinetic parts are sampled. The other parts sum over all collisions: each cell gets a share of
// impulse times distance, by the length of the line of centres in it, so that forces across grid
// lines are right. Cost: a pass over discs and cells a sample, some 100 instructions a collision.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "dynamics/species.hpp"
#include "engine/engine.hpp"
#include "measure/field_means.hpp"
#include "measure/field_sums.hpp"
#include "measure/hdf5_key.hpp"
#include "measure/measurement.hpp"
#include "measure/speeds.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

constexpr QuantitySetting profile_columns{"profile_columns", 10}, profile_rows{"profile_rows", 10},
    profile_samples{"profile_samples", 10}, profile_species{"profile_species", 0};
constexpr double most_rows = 1e6; ///< a table has at most this many rows

std::size_t n_cells_of(const MeasurementOutput& output) {
    return static_cast<std::size_t>(profile_columns.of(output) * profile_rows.of(output));
}

void check_grid(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const MeasurementOutput& output = *scene.measurements;
    const std::size_t n_cells = n_cells_of(output);
    if (n_cells > scene.n_discs)
        draft.refuse({profile_columns.key_name(), profile_rows.key_name(), quantities_key},
                     fmt::format("a grid of {} cells for \"profiles\" is more than the {} discs; "
                                 "try: smaller '{}' or '{}'",
                                 n_cells, scene.n_discs, profile_columns.key_name(),
                                 profile_rows.key_name()));
    const double n_blocks = static_cast<double>(scene.steps - output.from_step) /
                            static_cast<double>(output.every_steps) / profile_samples.of(output);
    if (n_blocks * static_cast<double>(n_cells) > most_rows)
        draft.refuse(
            {profile_samples.key_name(), quantities_key},
            fmt::format("{:.0f} blocks of {} cells are over a million rows; try: a larger '{}'",
                        n_blocks, n_cells, profile_samples.key_name()));
}

/// Suggests settings with which `steps` steps after the first sample complete a block.
std::string remedy_for_short_run(const MeasurementOutput& output, std::int64_t steps) {
    const std::string samples = profile_samples.key_name();
    const auto intervals = static_cast<std::int64_t>(profile_samples.of(output)) - 1;
    if (steps == 0) return "a smaller output.measurements.from_step";
    if (steps >= output.every_steps)
        return fmt::format("{} = {} or less", samples, steps / output.every_steps + 1);
    if (steps < intervals)
        return fmt::format("{} = {} or less with every_steps = 1", samples, steps + 1);
    return fmt::format("output.measurements.every_steps = {} or less", steps / intervals);
}

/// Warns if the run completes no block. This is not an error, because a restart may complete one.
void warn_without_blocks(const SceneDraft& draft) {
    const MeasurementOutput& output = *draft.scene.measurements;
    const std::int64_t steps = draft.scene.steps - output.from_step;
    const double needed = (profile_samples.of(output) - 1) *
                          static_cast<double>(output.every_steps);
    if (draft.scene.steps == 0 || steps < 0 || needed <= static_cast<double>(steps)) return;
    draft.scene.warnings.push_back(
        fmt::format("no table of profiles: its first block takes {:.0f} steps, and from step {} to "
                    "the last one are {}; try: {}",
                    needed, output.from_step, steps, remedy_for_short_run(output, steps)));
}

/// A block's last step, the number of steps with its collisions, and the box's mean edges.
struct BlockHead {
    double to_step = 0, steps = 0, x_low = 0, x_high = 0, y_low = 0, y_high = 0;
};

class Profiles : public Measurement, public PairFollower {
public:
    explicit Profiles(MeasuredRun& run)
        : Measurement(run), n_x_(static_cast<std::size_t>(profile_columns.of(run.output))),
          n_y_(static_cast<std::size_t>(profile_rows.of(run.output))),
          per_block_(static_cast<std::uint64_t>(profile_samples.of(run.output))),
          n_kinds_(std::max<std::size_t>(
              profile_species.of(run.output) != 0 ? run.scene.effects.species.size() : 1, 1)),
          species_(run.system.species_table()), sample_(0, 1, 1), sums_(0, 1, 1) {
        for (const Boundary& side : run.scene.effects.boundaries)
            are_sides_moving_ = are_sides_moving_ || side.speed != 0 || side.amplitude != 0;
        for (const Species& one : run.scene.effects.species) {
            have_masses_ = have_masses_ || one.mass != 1;
            ends_.push_back((ends_.empty() ? 0 : ends_.back()) + one.count);
        }
    }
    ~Profiles() override { run_.system.engine().followers_of_pairs().forget(*this); }

    void begin() override {
        speed_ = std::max(usual_speed(run_), driven_speed(run_.scene));
        follow();
    }

    void take(std::span<const PairEvent> events) override {
        PlacedGrid grid(n_x_, n_y_, {0, run_.scene.box.x, 0, run_.scene.box.y});
        for (const PairEvent& event : events) {
            if (are_sides_moving_) [[unlikely]]
                grid = {n_x_, n_y_,
                        extent_at(run_.scene.effects, run_.scene.box,
                                  event.steps_since(0, run_.scene.micro_steps))};
            add(event, grid);
        }
    }

    bool has_velocities() const override { return true; }
    void sample(const SampledState& state) override {
        const Extent& box = state.box;
        const double time = run_.system.clock(), unit = run_.system.velocity_unit();
        const double per_x = static_cast<double>(n_x_) / (box.x_high - box.x_low),
                     per_y = static_cast<double>(n_y_) / (box.y_high - box.y_low);
        const auto place = [](double x, std::size_t n) { // a disc on an edge is in an outer cell
            return static_cast<std::size_t>(std::clamp<std::int64_t>(
                static_cast<std::int64_t>(x), 0, static_cast<std::int64_t>(n) - 1));
        };
        const VelocityChange later = change_until_half_way(run_);
        for (const DiscState& disc : state.inside) {
            std::size_t cell = place((disc.y_at(time) - box.y_low) * per_y, n_y_) * n_x_ +
                               place((disc.x_at(time) - box.x_low) * per_x, n_x_);
            if (n_kinds_ > 1) cell += kind_of(disc.id) * n_cells();
            sample_.add_disc(cell, have_masses_ ? species_.of(disc.id).mass : 1,
                             disc.vx * unit + later.x, disc.vy * unit + later.y);
        }
        take_sample();
        if (!state.is_first) head_.steps += static_cast<double>(run_.output.every_steps);
        head_.x_low += box.x_low, head_.x_high += box.x_high;
        head_.y_low += box.y_low, head_.y_high += box.y_high;
        if (++n_samples_ == per_block_) end_block();
    }

    void keep(KeptNumbers& kept) override {
        kept.same(n_x_), kept.same(n_y_), kept.same(per_block_), kept.same(n_kinds_);
        kept(speed_), kept(n_samples_);
        for (double* number : numbers_of(head_)) kept(*number);
        kept(means_), kept(heads_), kept(blocks_);
        std::vector<std::uint64_t> words;
        if (!kept.is_restored()) words = sums_.joined_words(run_.ranks);
        kept(words);
        if (!kept.is_restored() || !kept.is_right()) return;
        if (means_.size() != n_fields() * n_sample_moments ||
            blocks_.size() != heads_.size() / 6 * n_fields() * n_block_numbers)
            return kept.refuse();
        follow();
        FieldSums all = sums_;
        if (!all.add_words(words)) return kept.refuse();
        if (run_.ranks.is_root()) sums_ = std::move(all);
    }

    std::vector<MeasuredTable> tables() const override {
        std::vector<MeasuredTable> all = {table_of("profiles", 0, n_cells())};
        for (std::size_t kind = 0; n_kinds_ > 1 && kind < n_kinds_; ++kind)
            all.push_back(
                table_of(fmt::format("profiles_{}", kind + 1), (kind + 1) * n_cells(), n_cells()));
        all.push_back(table_of("profiles_total", n_fields() - 1, 1));
        return all;
    }

private:
    static std::array<double*, 6> numbers_of(BlockHead& head) {
        return {&head.to_step, &head.steps, &head.x_low, &head.x_high, &head.y_low, &head.y_high};
    }
    std::size_t n_cells() const { return n_x_ * n_y_; }
    /// Number of fields in a block: cells, cells of each species with its own table, and the box.
    std::size_t n_fields() const { return n_cells() * (n_kinds_ > 1 ? n_kinds_ + 1 : 1) + 1; }

    std::size_t kind_of(DiscId id) const {
        if (n_kinds_ == 1) return 0;
        return static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), id) -
                                        ends_.begin());
    }

    FieldSums no_sums(std::size_t n) const {
        return {n, std::max(speed_, 0x1p-200), run_.scene.radius};
    }

    /// Empties the sums and adds all later collisions to them. **Collective.**
    void follow() {
        sums_ = sample_ = no_sums(n_kinds_ * n_cells());
        means_.resize(n_fields() * n_sample_moments);
        run_.system.engine().followers_of_pairs().forget(*this);
        run_.system.engine().followers_of_pairs().add(*this);
    }

    std::size_t cell_of(std::int64_t column, std::int64_t row) const {
        const auto within = [](std::int64_t place, std::size_t size, bool is_periodic) {
            const auto n = static_cast<std::int64_t>(size);
            if (place >= 0 && place < n) [[likely]]
                return static_cast<std::size_t>(place);
            return static_cast<std::size_t>(
                is_periodic ? ((place % n) + n) % n : std::clamp<std::int64_t>(place, 0, n - 1));
        };
        return within(row, n_y_, run_.scene.effects.is_periodic_y()) * n_x_ +
               within(column, n_x_, run_.scene.effects.is_periodic_x());
    }

    /// The terms of a collision for the stress and the flow of energy. The energy transferred from
    /// p to q is taken as the mean of the energy that q gains and the energy that p loses.
    ContactTerms terms_of(const PairEvent& event) const {
        const Pair impulse = {event.ix, event.iy};
        Pair velocity = Pair{event.p_vx, event.p_vy} + Pair{event.q_vx, event.q_vy};
        if (have_masses_) [[unlikely]]
            velocity += impulse *
                        (1 / (2 * species_.of(event.q).mass) - 1 / (2 * species_.of(event.p).mass));
        return sums_.terms_of(impulse, Pair{event.dx, event.dy}, velocity);
    }

    /// Adds a collision. Usually the whole line between the centres of both discs is in one cell.
    void add(const PairEvent& event, const PlacedGrid& grid) {
        const Pair from = Pair{event.x, event.y} * grid.per_length + grid.origin,
                   length = Pair{event.dx, event.dy} * grid.per_length, to = from + length;
        const PairOfCells cell = cell_at(from);
        const std::size_t to_right = static_cast<std::size_t>(cell[0]) - 1,
                          upwards = static_cast<std::size_t>(cell[1]) - 1; // huge if below row 1
        const ContactTerms terms = terms_of(event);
        if (are_same(cell, cell_at(to)) && to_right < n_x_ && upwards < n_y_ && n_kinds_ == 1)
            [[likely]]
            sums_.add_contact(upwards * n_x_ + to_right, terms);
        else
            add_parts(event, FieldSums::units_of(terms), from, length);
    }

    /// Divides a collision's terms among the cells on its line, and equally between both species.
    [[gnu::noinline]] void add_parts(const PairEvent& event, const ContactUnits& whole, Pair from,
                                     Pair length) {
        ContactUnits rest = whole;
        const std::size_t p = kind_of(event.p) * n_cells(), q = kind_of(event.q) * n_cells();
        const auto add_part = [&](std::int64_t column, std::int64_t row, ContactUnits part) {
            const std::size_t cell = cell_of(column, row);
            if (p == q) return sums_.add_contact(p + cell, part);
            ContactUnits half{};
            for (std::size_t k = 0; k < part.size(); ++k) {
                half[k] = part[k] / 2;
                part[k] -= half[k];
            }
            sums_.add_contact(p + cell, part);
            sums_.add_contact(q + cell, half);
        };
        for_each_part_of_line(from[0] - 1, from[1] - 1, length[0], length[1],
                              [&](std::int64_t column, std::int64_t row, double begin, double to) {
                                  if (to == 1) return add_part(column, row, rest);
                                  ContactUnits part{};
                                  for (std::size_t k = 0; k < part.size(); ++k) {
                                      part[k] = static_cast<std::int64_t>(
                                          static_cast<double>(whole[k]) * (to - begin));
                                      rest[k] -= part[k];
                                  }
                                  add_part(column, row, part);
                              });
    }

    /// Calls `act` with the sums and the cell of each field, in the order of `blocks_`: each cell
    /// with all discs, each cell with each species if these are separate, and the whole box.
    template <class Act> void for_each_field(const FieldSums& sums, const Act& act) const {
        const auto visit = [&act](const FieldSums& of) {
            for (std::size_t cell = 0; cell < of.size(); ++cell) act(of, cell);
        };
        visit(sums.over_species(n_kinds_));
        if (n_kinds_ > 1) visit(sums);
        visit(sums.total());
    }

    /// Adds this rank's discs to `sums_`, and the sample of all ranks to `means_`. **Collective.**
    void take_sample() {
        sums_.add_discs(sample_);
        sample_.join_discs(run_.ranks);
        std::size_t field = 0;
        for_each_field(sample_, [&](const FieldSums& of, std::size_t cell) {
            add_sample(of, cell, SampleSums(&means_[n_sample_moments * field++], n_sample_moments));
        });
        sample_.clear_discs();
    }

    /// **Collective.**
    void end_block() {
        FieldSums sums = no_sums(sums_.size());
        sums.add_words(sums_.joined_words(run_.ranks));
        sums_.clear();
        const double* next = means_.data();
        for_each_field(sums, [&](const FieldSums& of, std::size_t cell) {
            blocks_.push_back(static_cast<double>(of.count(cell)));
            for (std::size_t k = 0; k < n_field_moments; ++k)
                blocks_.push_back(of.value(cell, static_cast<FieldMoment>(k)));
            blocks_.insert(blocks_.end(), next, next + n_sample_moments);
            next += n_sample_moments;
        });
        std::fill(means_.begin(), means_.end(), 0.0);
        head_.to_step = static_cast<double>(run_.system.step());
        for (double* edge : {&head_.x_low, &head_.x_high, &head_.y_low, &head_.y_high})
            *edge /= static_cast<double>(per_block_);
        for (double* number : numbers_of(head_)) heads_.push_back(*number);
        head_ = {};
        n_samples_ = 0;
    }

    MeasuredTable table_of(std::string name, std::size_t first, std::size_t n) const;

    std::size_t n_x_, n_y_;
    std::uint64_t per_block_;
    std::size_t n_kinds_; ///< number of kinds of discs: 1 unless species have separate tables
    SpeciesTable species_;
    std::vector<DiscId> ends_; ///< for each species, the id after its last one
    bool are_sides_moving_ = false, have_masses_ = false;
    double speed_ = 0;
    std::uint64_t n_samples_ = 0; ///< this and the next four members belong to the unfinished block
    BlockHead head_;              ///< head of the unfinished block; its edges are sums over samples
    FieldSums sample_;            ///< sums over the present sample, one kind after another
    FieldSums sums_;              ///< this rank's sums over the block, one kind after another
    std::vector<double> means_;   ///< sample moments of each field
    std::vector<double> heads_;   ///< heads of finished blocks
    std::vector<double> blocks_;  ///< count and moments of each field in finished blocks
};

/// The table of `n` fields from `first` on, for each block. The last field is the whole box.
MeasuredTable Profiles::table_of(std::string name, std::size_t first, std::size_t n) const {
    const bool is_grid = n == n_cells() && first + n < n_fields();
    const std::string where = is_grid ? fmt::format("on a grid of {} by {} cells; x, y: their "
                                                    "centres in the box as it is on average",
                                                    n_x_, n_y_)
                                      : "over the whole box";
    MeasuredTable table{
        std::move(name),
        {fmt::format("means over {} samples up to to_step, {}", per_block_, where),
         "in_pairs: discs in samples with two or more in the cell, the weight of temperature; "
         "density: discs per area; vx, vy: of the centre of mass; temperature: kT about that, with "
         "its degrees of freedom given back; xx, xy, yy: kinetic part of the pressure tensor; "
         "heat_x, heat_y: flow of heat; contact_*: collisions' parts, shared along the line of "
         "centres",
         "lengths in the scene's unit, times in steps; nan without discs or time"},
        {"to_step"},
        {}};
    if (is_grid) table.columns.insert(table.columns.end(), {"x", "y"});
    table.columns.insert(table.columns.end(),
                         {"count", "in_pairs", "density", "vx", "vy", "temperature", "xx", "xy",
                          "yy", "contact_xx", "contact_xy", "contact_yy", "heat_x", "heat_y",
                          "contact_heat_x", "contact_heat_y"});
    for (std::size_t block = 0; 6 * block < heads_.size(); ++block) {
        BlockHead head;
        const std::array<double*, 6> numbers = numbers_of(head);
        for (std::size_t k = 0; k < 6; ++k) *numbers[k] = heads_[6 * block + k];
        const double width = (head.x_high - head.x_low) / static_cast<double>(n_x_),
                     height = (head.y_high - head.y_low) / static_cast<double>(n_y_);
        const std::span<const double> cells(
            blocks_.data() + n_block_numbers * (block * n_fields() + first), n_block_numbers * n);
        const double kT = common_temperature(cells),
                     area = width * height * static_cast<double>(is_grid ? 1 : n_cells());
        for (std::size_t cell = 0; cell < n; ++cell) {
            std::vector<double>& row = table.rows.emplace_back(std::vector{head.to_step});
            const auto column = static_cast<double>(cell % n_x_),
                       line = static_cast<double>(cell / n_x_);
            if (is_grid) row.push_back(head.x_low + (column + 0.5) * width - run_.scene.origin.x);
            if (is_grid) row.push_back(head.y_low + (line + 0.5) * height - run_.scene.origin.y);
            const BlockNumbers numbers_of_cell(cells.data() + n_block_numbers * cell,
                                               n_block_numbers);
            const std::vector<double> fields = fields_of(
                numbers_of_cell, kT, static_cast<double>(per_block_), head.steps, area);
            row.insert(row.end(), fields.begin(), fields.end());
        }
    }
    return table;
}

Key grid_key(const QuantitySetting& setting, std::string_view help) {
    return setting.integer("1", help).within({1, 10000});
}

} // namespace

MeasuredQuantity profiles_quantity() {
    return {
        {.name = "profiles",
         .help = "Density, velocity, temperature and pressure tensor on a grid, block by block.",
         .needs_lasting_sides = true,
         .keys = {grid_key(profile_columns, "Cells of \"profiles\" along x."),
                  grid_key(profile_rows, "Cells of \"profiles\" along y."),
                  profile_samples
                      .integer("samples", "Samples that a block of \"profiles\" averages.")
                      .within({1, largest_steps}),
                  profile_species
                      .integer("1", "1: \"profiles\" has tables of each species as well.")
                      .within({0, 1}),
                  hdf5_key()},
         .follows_collisions = true,
         .check = check_grid,
         .check_times = warn_without_blocks},
        make_measurement<Profiles>,
        {"profiles_total"}};
}

} // namespace carrom
