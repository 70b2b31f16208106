// SPDX-License-Identifier: BSD-3-Clause
// Lists the keys of [discs], some of which other files declare, and size and origin of [box].
#include <algorithm>

#include "scene/disc_columns.hpp"
#include "scene/disc_groups.hpp"
#include "scene/frozen_discs.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/species_rows.hpp"
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
/// Whether initial velocities are random: discs are generated, or listed together with a speed or a
/// temperature.
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
                      [](const SceneParameters& s) {
                          return s.generator == Generator::compressed ||
                                 std::ranges::count(s.groups, Generator::compressed,
                                                    &DiscGroup::generator) > 0;
                      },
                      true};
const Need seeded{
    "where discs are listed with their velocities",
    [](const SceneParameters& s) { return s.generator != Generator::file || s.draws_velocities; },
    true};
/// Rows are [x, y] or [x, y, vx, vy]; radius and mass, the spin, or all three may follow vy.
/// The order of rows gives the ids.
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

Key origin_key() {
    Key origin =
        key("box.origin", "length",
            "The point that has the coordinates (0, 0) in all places that a scene names "
            "and that outputs show: the middle of the box, or [x, y] from its lower left "
            "corner.",
            [](auto& s) -> auto& { return s.origin; })
            .by_default("the lower left corner")
            .advises({{"center", "\"centre\""}, {"middle", "\"centre\""}, {"corner", "[0, 0]"}});
    origin.words = {"centre"};
    origin.compare = [](const SceneParameters& a, const SceneParameters& b) {
        return a.origin == b.origin;
    };
    return origin;
}

/// A radius of 0 means points. Computations use a small radius for them (see point_radius).
Key radius_key() {
    Key radius =
        key("discs.radius", "length",
            "r, the radius of a disc; or give 'discs.packing'. 0: points, which meet walls and "
            "obstacles and not each other.",
            [](auto& s) -> auto& { return s.radius; })
            .within({smallest_length, largest_size, false, true, "0 is for points"})
            .needs(equal_discs)
            .required()
            .unless({"discs.packing", "discs.species", "discs.radius.distribution",
                     "discs.radius.mean", "discs.radius.polydispersity"});
    radius.get = [](const SceneParameters& s) { return Value{s.are_points ? 0 : s.radius}; };
    radius.set = [](SceneParameters& s, const Value& value) {
        s.radius = std::get<double>(value.data);
        s.are_points = s.radius == 0;
    };
    return radius;
}

/// Defines the radius, or the number of discs, by a packing fraction, which is not stored itself.
Key packing_key() {
    Key key =
        named_key("discs.packing", "1",
                  "Packing fraction, N pi r^2 over the box's area; sets the radius, or the "
                  "number of discs if species have shares.")
            .by_default("none")
            .within({0, largest_packing, true, false, "equal discs cover no more of the plane"})
            .needs({"where 'discs.species' has counts, or 'discs.list' or 'discs.columns' name "
                    "radii",
                    [](const SceneParameters& s) { return s.has_shares || equal_discs.holds(s); }})
            .excludes({"discs.radius"});
    key.get = [](const SceneParameters&) { return Value{}; };
    key.set = [](SceneParameters&, const Value&) {};
    return key;
}

/// The key of N, the number of discs. N is 0 until a file of discs is read, if only the file has N.
Key count_key() {
    Key count = key("discs.count", "discs",
                    "N, the number of discs; a list, a file, species or groups give it too.",
                    [](auto& s) -> auto& { return s.n_discs; })
                    .within({1, static_cast<double>(largest_count)})
                    .required()
                    .unless({"discs.list", "discs.file", "discs.species", "discs.groups",
                             "discs.from"});
    count.get = [](const SceneParameters& s) {
        return s.n_discs == 0 || !s.groups.empty() ? Value{} : value_of(s.n_discs);
    };
    return count;
}

Key compression_rate_key() {
    return key("discs.growth_rate", "1",
               "How fast the largest diameter grows, over the root mean square speed. Slow growth "
               "jams later.",
               [](auto& s) -> auto& { return s.compression_rate; })
        .within({1e-6, 0.2})
        .needs(compressed);
}

} // namespace

/// Keys for discs from another run.
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

/// With a list of discs the speed is written even if it is the default, because its presence means
/// that velocities are drawn.
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
        compression_rate_key(),
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
            "walls stand at x = 0 and Lx, y = 0 and Ly, unless 'box.origin' moves x and y.",
            [](auto& s) -> auto& { return s.box; })
            .within(lengths)
            .required(),
        origin_key(),
        count_key(),
        radius_key(),
        packing_key(),
        species_key(),
        groups_key(),
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
    for (Key& one : keys_of_freezing()) all.push_back(std::move(one));
    for (Key& one : keys_of_other_runs()) all.push_back(std::move(one));
    return all;
}

} // namespace carrom
