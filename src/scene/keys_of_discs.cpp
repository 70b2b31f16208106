// SPDX-License-Identifier: BSD-3-Clause
// The keys of [box] without its sides, and of [discs].
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/disc_columns.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/start_region.hpp"

namespace carrom {

namespace {

constexpr Range lengths{smallest_length, largest_size};

const Need equal_discs{"where 'discs.species', 'discs.list' or 'discs.columns' name radii",
                       [](const SceneParameters& s) {
                           return s.effects.species.empty() && !has_column(s, DiscColumn::radius);
                       }};
const Need listed{"without discs.generator = \"file\"",
                  [](const SceneParameters& s) { return s.generator == Generator::file; }, true};
/// Velocities of discs whose places are generated, or listed beside a speed or a temperature.
bool are_drawn(const SceneParameters& s) {
    return s.generator == Generator::file ? s.draws_velocities : s.generator != Generator::legacy;
}

const Need speeds{"with discs.generator = \"legacy\"", are_drawn, true};
const Need kinds_of_velocities{
    "with discs.generator = \"legacy\", or where discs are listed and neither 'discs.speed' nor "
    "'discs.temperature' draws their velocities",
    [](const SceneParameters& s) {
        return are_drawn(s) ||
               (s.generator == Generator::file && s.velocities == VelocityKind::reversed);
    },
    true};
const Need compressed{"without discs.generator = \"compressed\"",
                      [](const SceneParameters& s) { return s.generator == Generator::compressed; },
                      true};
const Need seeded{
    "where discs are listed with their velocities",
    [](const SceneParameters& s) { return s.generator != Generator::file || s.draws_velocities; },
    true};
const Need not_legacy{"with discs.generator = \"legacy\"",
                      [](const SceneParameters& s) { return s.generator != Generator::legacy; },
                      true};

/// Rows [x, y], or [x, y, vx, vy] and then radius and mass, or the spin, or all three. Ids are
/// their order.
void set_list(SceneParameters& scene, const Value& value) {
    bool have_spins = false;
    std::vector<NumberRun> spins;
    for (const Value& row : std::get<Values>(value.data)) {
        Numbers n = row.is_nothing() ? Numbers(4) : std::get<Numbers>(row.data);
        n.resize(std::max<std::size_t>(n.size(), 4));
        scene.listed_discs.push_back({scene.listed_discs.size(), n[0], n[1], n[2], n[3]});
        if (n.size() >= 6) add_species(scene.effects.species, {1, n[4], n[5]});
        have_spins = have_spins || n.size() % 2 == 1;
        add_numbers(spins, 1, n.size() % 2 == 1 ? n.back() : 0);
    }
    if (have_spins) scene.first_numbers[SideColumn::spin] = spins;
}

/// Columns that a list cannot hold are written in `discs.species`.
bool are_species_listed(const SceneParameters& scene) {
    return std::any_of(
        given_side_columns.begin(), given_side_columns.end(), [&](SideColumn column) {
            return column != SideColumn::spin && !scene.first_numbers[column].empty();
        });
}

Value get_list(const SceneParameters& scene) {
    if (scene.listed_discs.empty()) return {};
    const SpeciesTable species(scene.effects.species, scene.radius);
    Values rows;
    const bool are_whole = !are_species_listed(scene);
    for (const InputDisc& disc : scene.listed_discs) {
        Numbers row{disc.x, disc.y, disc.vx, disc.vy};
        const SizeAndMass& body = species.of(disc.id);
        if (are_whole && !scene.effects.species.empty())
            row.insert(row.end(), {body.radius, body.mass});
        if (are_whole && !scene.first_numbers[SideColumn::spin].empty())
            row.push_back(first_number(scene, SideColumn::spin, disc.id));
        rows.push_back({std::move(row)});
    }
    return {std::move(rows)};
}

/// The place of a column's number in rows of species, after count, radius and mass.
constexpr std::size_t place_of(SideColumn column) { return 3 + static_cast<std::size_t>(column); }

/// The place of a region in rows of species.
constexpr std::size_t place_of_region = 3 + n_given_columns;

/// Appends `count` discs with the region of the row `n`; as a new run only if it is another one.
void add_region(std::vector<RegionRun>& runs, std::uint64_t count, const Numbers& n) {
    const double* const r = &n[place_of_region];
    std::optional<StartRegion> region;
    if (!std::isnan(r[0])) region = StartRegion{r[0], r[1], r[2], r[3]};
    const DiscId end = (runs.empty() ? 0 : runs.back().end) + count;
    if (!runs.empty() && runs.back().region == region)
        runs.back().end = end;
    else
        runs.push_back({end, region});
}

void set_species(SceneParameters& scene, const Value& value) {
    FirstNumbers numbers;
    std::vector<RegionRun> regions;
    for (const Value& row : std::get<Values>(value.data)) {
        if (row.is_nothing()) continue;
        const Numbers& n = std::get<Numbers>(row.data);
        if (!(n[0] >= 1 && n[0] <= static_cast<double>(largest_count))) continue;
        add_species(scene.effects.species, {static_cast<std::uint64_t>(n[0]), n[1], n[2]});
        for (const SideColumn column : given_side_columns)
            add_numbers(numbers[column], static_cast<std::uint64_t>(n[0]), n[place_of(column)]);
        add_region(regions, static_cast<std::uint64_t>(n[0]), n);
    }
    if (std::ranges::any_of(regions, [](const RegionRun& run) { return run.region.has_value(); }))
        scene.regions = regions;
    for (const SideColumn column : given_side_columns) {
        const std::vector<NumberRun>& runs = numbers[column];
        if (runs.size() > 1 || (runs.size() == 1 && runs[0].number != 0))
            scene.first_numbers[column] = runs;
    }
}

Value get_species(const SceneParameters& scene) {
    const auto& species = scene.effects.species;
    if (species.empty() || scene.sizes || has_column(scene, DiscColumn::radius) ||
        (!scene.listed_discs.empty() && !are_species_listed(scene)))
        return {};
    FirstNumbers numbers;
    for (const SideColumn column : given_side_columns)
        if (!has_column(scene, disc_column_of(column)))
            numbers[column] = scene.first_numbers[column];
    BySideColumn<std::size_t> next; // by column
    auto region = scene.regions.begin();
    Values rows;
    DiscId first = 0;
    for (const Species& one : species) {
        for (const DiscId last = first + one.count; first < last;) {
            DiscId end = last;
            Numbers row{0, one.radius, one.mass};
            for (const SideColumn column : given_side_columns) {
                const std::vector<NumberRun>& runs = numbers[column];
                std::size_t& run = next[column];
                while (run < runs.size() && runs[run].end <= first) ++run;
                if (run < runs.size()) end = std::min(end, runs[run].end);
                row.push_back(run < runs.size() ? runs[run].number : 0);
            }
            while (region != scene.regions.end() && region->end <= first) ++region;
            row.resize(place_of_region + 4, std::numeric_limits<double>::quiet_NaN());
            if (region != scene.regions.end()) {
                end = std::min(end, region->end);
                if (const auto& r = region->region)
                    std::ranges::copy(std::array{r->x_low, r->y_low, r->x_high, r->y_high},
                                      row.begin() + place_of_region);
            }
            row[0] = static_cast<double>(end - first);
            rows.push_back({std::move(row)});
            first = end;
        }
    }
    return {std::move(rows)};
}

Key list_key() {
    Key key =
        named_key("discs.list", "length, length/step",
                  "The discs themselves; ids count from 0. Radius and mass, then spin, may follow.")
            .by_default("none")
            .needs(listed)
            .with_rows({{"", "[x, y], [x, y, vx, vy] or [x, y, vx, vy, radius, mass]", 2, 7}});
    key.get = get_list;
    key.set = set_list;
    key.compare = [](const SceneParameters& a, const SceneParameters& b) {
        return a.listed_discs == b.listed_discs;
    };
    return key;
}

Key species_key() {
    std::vector<Field> fields = {{"count", ""}, {"radius", ""}, {"mass", "", 1, 1, 1.0}};
    for (const SideColumn column : given_side_columns)
        fields.push_back({info_of(column).name, "", 1, 1, 0.0});
    fields.push_back(
        {"region", "[x0, y0, x1, y1]", 4, 4, std::numeric_limits<double>::quiet_NaN()});
    Key key = named_key("discs.species", "discs, length, mass, 1/step, radians",
                        "Species of discs in the order of ids, in place of one radius.")
                  .by_default("none")
                  .needs(not_legacy)
                  .formerly("discs.classes")
                  .with_rows(fields);
    key.get = get_species;
    key.set = set_species;
    key.compare = [](const SceneParameters& a, const SceneParameters& b) {
        return a.effects.species == b.effects.species && a.regions == b.regions;
    };
    return key;
}

/// A way to ask for a radius. The reader computes the radius, and the scene does not keep the key.
Key packing_key() {
    Key key = named_key("discs.packing", "1",
                        "Packing fraction, N pi r^2 over the box's area; sets the radius.")
                  .by_default("none")
                  .within(
                      {0, largest_packing, true, false, "equal discs cover no more of the plane"})
                  .needs(equal_discs)
                  .excludes({"discs.radius"});
    key.get = [](const SceneParameters&) { return Value{}; };
    key.set = [](SceneParameters&, const Value&) {};
    return key;
}

/// Unknown before the file of `discs.file` or `discs.from` is read.
Key count_key() {
    Key count = key("discs.count", "discs",
                    "N, the number of discs; a list, a file or species give it too.",
                    [](auto& s) -> auto& { return s.n_discs; })
                    .within({1, static_cast<double>(largest_count)})
                    .required()
                    .unless({"discs.list", "discs.file", "discs.species", "discs.from"});
    count.get = [](const SceneParameters& s) {
        return s.n_discs == 0 ? Value{} : value_of(s.n_discs);
    };
    return count;
}

Key growth_rate_key() {
    return key("discs.growth_rate", "1",
               "How fast the largest diameter grows, over the root mean square speed. Slow growth "
               "jams later.",
               [](auto& s) -> auto& { return s.growth_rate; })
        .within({1e-6, 0.2})
        .needs(compressed);
}

} // namespace

/// Discs from another run.
std::vector<Key> keys_of_other_runs() {
    return {
        key("discs.from", "",
            "Checkpoint or trajectory of another run, from the scene's folder, to begin from.",
            [](auto& s) -> auto& { return s.discs_from; })
            .by_default("none")
            .needs(listed)
            .excludes({"discs.list", "discs.file"})
            .not_physical(),
        key("discs.from_step", "steps", "Step of the frame of 'discs.from' to take.",
            [](auto& s) -> auto& { return s.discs_from_step; })
            .by_default("the last frame")
            .within({0, largest_steps})
            .needs({"without 'discs.from'",
                    [](const SceneParameters& s) { return !s.discs_from.empty(); }})
            .not_physical(),
    };
}

/// Beside a list it is written even where it is the default, because it draws velocities there.
Key speed_key() {
    Key speed = key("discs.speed", "length/step",
                    "Root mean square of the speeds at the start; the heavier count more, by their "
                    "mass. Beside listed discs it draws their velocities.",
                    [](auto& s) -> auto& { return s.speed; })
                    .within({smallest_size, 0x1p-8 * largest_size, false, true})
                    .needs(speeds);
    speed.get = [](const SceneParameters& s) {
        return s.temperature ? Value{} : value_of(s.speed);
    };
    speed.compare = [](const SceneParameters& a, const SceneParameters& b) {
        return a.speed == b.speed && a.draws_velocities == b.draws_velocities;
    };
    return speed;
}

std::vector<Key> keys_of_speeds() {
    return {
        speed_key(),
        key("discs.temperature", "mass length^2/step^2",
            "kT at the start, in place of the speed: the kinetic energy over N. Beside listed "
            "discs it draws their velocities.",
            [](auto& s) -> auto& { return s.temperature; })
            .by_default("from 'discs.speed'")
            .within({.low = 0})
            .needs(speeds)
            .excludes({"discs.speed"}),
        key("discs.velocities", "",
            "Maxwell distribution, or isotropic with speeds uniform up to sqrt(3) times "
            "their root mean square. Reversed: listed velocities and spins, turned round.",
            [](auto& s) -> auto& { return s.velocities; })
            .needs(kinds_of_velocities),
    };
}

std::vector<Key> keys_of_generation() {
    return {
        growth_rate_key(),
        region_key(),
        key("discs.seed", "1", "The same seed gives the same discs on any number of ranks.",
            [](auto& s) -> auto& { return s.seed; })
            .within({.low = 0})
            .needs(seeded)
            .seed(),
        key("discs.streams", "length, length/step",
            "Adds a velocity to discs inside a region, beyond the one that is drawn.",
            [](auto& s) -> auto& { return s.streams; })
            .needs(seeded)
            .with_rows({{"region", "[x0, y0, x1, y1]", 4, 4}, {"velocity", "[vx, vy]", 2, 2}}),
    };
}

std::vector<Key> keys_of_discs() {
    std::vector<Key> all = {
        key("box.size", "length",
            "L, the side of a square box, or [Lx, Ly], the edges of a rectangle; "
            "walls stand at x = 0 and Lx, y = 0 and Ly.",
            [](auto& s) -> auto& { return s.box; })
            .within(lengths)
            .required(),
        count_key(),
        key("discs.radius", "length", "r, the radius of a disc; or give 'discs.packing'.",
            [](auto& s) -> auto& { return s.radius; })
            .within(
                {smallest_length, largest_size, false, false,
                 "discs have a size; for points take one that is small against their distances"})
            .needs(equal_discs)
            .required()
            .unless({"discs.packing", "discs.species", "discs.radius.distribution",
                     "discs.radius.mean", "discs.radius.polydispersity"}),
        packing_key(),
        species_key(),
        key("discs.generator", "",
            "Random: uniform without overlaps. Lattice: shaken. Triangular: the lattice that a "
            "periodic box repeats. Compressed: a random gas whose discs grow. Legacy: C `rand`. "
            "File: discs are listed.",
            [](auto& s) -> auto& { return s.generator; })
            .by_default("\"random\"; \"file\" with a list or file of discs"),
        list_key(),
        key("discs.file", "",
            "File of lines `id x y vx vy`, from the scene's folder. Ids are 0 to N-1. Lines "
            "without "
            "ids are numbered from 0; a first line may name other columns; `#` begins a comment.",
            [](auto& s) -> auto& { return s.discs_file; })
            .by_default("none")
            .needs(listed)
            .excludes({"discs.list"}),
        key("discs.columns", "",
            "Columns of the file behind `id x y vx vy`, in their order; or all of them, with x and "
            "y among them. Mass needs radius.",
            [](auto& s) -> auto& { return s.disc_columns; })
            .needs(listed)
            .excludes({"discs.list"}),
    };
    for (Key& one : keys_of_speeds()) all.push_back(std::move(one));
    for (Key& one : keys_of_generation()) all.push_back(std::move(one));
    for (Key& one : keys_of_other_runs()) all.push_back(std::move(one));
    return all;
}

} // namespace carrom
