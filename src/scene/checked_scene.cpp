// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_scene.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include "scene/check.hpp"
#include "scene/checked_effects.hpp"
#include "scene/checked_measurements.hpp"
#include "scene/checked_species.hpp"
#include "scene/lattice.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

/// A length, from 2^-230 to 2^250.
std::optional<double> size_number(const Check& check, std::string_view key) {
    const auto number = finite_number(check, key);
    if (!number) return std::nullopt;
    if (*number >= smallest_length && *number <= largest_size) return number;
    check.refuse(*check.settings.find(key),
                 !(*number > 0) ? fmt::format("'{}' must be greater than 0, not {}", key, *number)
                 : *number < smallest_length
                     ? fmt::format("'{}' = {} is too small (at least 2^-230)", key, *number)
                     : fmt::format("'{}' = {} is too large (at most 2^250)", key, *number));
    return std::nullopt;
}

/// Discs that the scene itself lists; their ids are their order.
void fill_listed_discs(const Check& check) {
    const Setting* list = check.settings.find("discs.list");
    if (!list) return;
    for (const Row& row : std::get<std::vector<Row>>(list->value)) {
        const auto& n = row.numbers;
        const DiscId id = check.scene.listed_discs.size();
        check.scene.listed_discs.push_back(n.empty() ? InputDisc{id}
                                                     : InputDisc{id, n[0], n[1], n[2], n[3]});
    }
}

void check_listed_discs(const Check& check) {
    const Setting* list = check.settings.find("discs.list");
    if (!list) return;
    const auto& rows = std::get<std::vector<Row>>(list->value);
    const SpeciesTable species_table(check.scene.effects.species, check.scene.radius);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].numbers.empty()) continue;
        if (const std::string text = disc_problem(check.scene.listed_discs[i], check.scene,
                                                  species_table.of(i).radius);
            !text.empty())
            add_problem(check.problems, rows[i].place,
                        fmt::format("row {} of 'discs.list': {}", i + 1, text));
    }
}

void fill_generator(const Check& check) {
    static constexpr Choices<Generator, 4> generators = {{{"random", Generator::random},
                                                          {"lattice", Generator::lattice},
                                                          {"legacy", Generator::legacy},
                                                          {"file", Generator::file}}};
    const Setting* file = check.settings.find("discs.file");
    const Setting* list = check.settings.find("discs.list");
    const Setting* generator = check.settings.find("discs.generator");
    if (file) check.scene.discs_file = std::get<std::string>(file->value);
    if (file && list) check.refuse(*list, "'discs.list' and 'discs.file' exclude each other");
    check.scene.generator = file || list ? Generator::file : Generator::random;
    if (generator) {
        const auto chosen = choice(check, "discs.generator", generators);
        if (!chosen) return;
        check.scene.generator = *chosen;
    }
    std::string_view name;
    for (const auto& [word, value] : generators)
        if (value == check.scene.generator) name = word;
    for (const Setting& setting : check.settings.all())
        if (!has_meaning_for(name, setting.key))
            check.refuse(setting,
                         fmt::format("'{}' has no meaning where {}", setting.key,
                                     name == "file"
                                         ? "discs are listed"
                                         : fmt::format("discs.generator is \"{}\"", name)));
    const bool is_legacy_text = check.scene.lines_before_discs > 0;
    if (name == "file" && !is_legacy_text && !check.settings.is_mentioned("discs.file") &&
        !check.settings.is_mentioned("discs.list"))
        check.refuse(
            *generator,
            "discs.generator is \"file\", but there is no 'discs.file' and no 'discs.list'");
    if (file && check.scene.discs_file.empty()) check.refuse(*file, "'discs.file' is empty");
}

/// The number of discs; it stays 0 after a problem.
void fill_count(const Check& check) {
    const auto count = whole_number(check, "discs.count", 1,
                                    static_cast<std::int64_t>(largest_count));
    const Setting* list = check.settings.find("discs.list");
    const std::size_t n_listed = list ? std::get<std::vector<Row>>(list->value).size() : 0;
    if (count) check.scene.n_discs = static_cast<std::uint64_t>(*count);
    if (const Setting* species = check.settings.find("discs.species")) {
        std::uint64_t n = 0;
        for (const Species& one : check.scene.effects.species) n += one.count;
        if (!check.settings.is_mentioned("discs.count")) check.scene.n_discs = n;
        if (n > largest_count)
            check.refuse(*species,
                         fmt::format("'discs.species' have {} discs; at most {} are possible", n,
                                     largest_count));
        else if (n > 0 && count && n != check.scene.n_discs)
            check.refuse(
                *species,
                fmt::format("'discs.species' have {} discs, but 'discs.count' is {}", n, *count));
        else if (n > 0 && list && n != n_listed)
            check.refuse(
                *list,
                fmt::format("'discs.list' has {} discs, but 'discs.species' have {}", n_listed, n));
        if (!list) return;
    }
    if (!list) {
        check.refuse_missing("discs.count", "the number of discs");
        return;
    }
    if (!check.settings.is_mentioned("discs.count")) {
        check.scene.n_discs = n_listed;
        if (n_listed == 0) check.refuse(*list, "'discs.list' is empty");
    } else if (count && n_listed != check.scene.n_discs) {
        check.refuse(*list, fmt::format("'discs.list' has {} discs, but 'discs.count' is {}",
                                        n_listed, *count));
    }
}

/// Whether the discs can fit at all. `radius_setting` gave the radius, or the packing it was taken
/// from.
bool check_sizes(const Check& check, const Setting& radius_setting) {
    Scene& scene = check.scene;
    const auto& species = scene.effects.species;
    double r = scene.radius;
    const double l = scene.box_size, densest = species.empty() ? largest_packing : 1;
    const std::size_t n_problems = check.problems.size();
    if (l < 2 * r) {
        check.refuse(
            radius_setting,
            fmt::format("a disc of radius {} does not fit into a box of side {}: L < 2 r", r, l));
    } else if (scene.packing() > densest) {
        check.refuse(radius_setting, fmt::format("{} discs of radius {} cannot fit into a box of "
                                                 "side {}: they would cover {:.4g} of it, "
                                                 "and no packing covers more than {}",
                                                 scene.n_discs, r, l, scene.packing(), densest));
    }
    for (const Species& one : species) r = std::min(r, one.radius);
    if (l / r > largest_box_in_radii) {
        const std::string text = fmt::format("discs of radius {} in a box of side {}: it is {:.4g} "
                                             "radii wide, and above {:.0e} positions "
                                             "are too coarse for contacts with walls",
                                             r, l, l / r, largest_box_in_radii);
        if (scene.method == Method::event_driven)
            scene.warnings.push_back(text);
        else
            check.refuse(
                radius_setting,
                text +
                    "; take larger discs or a smaller box (method = \"event-driven\" only warns)");
    }
    if (scene.precision == Precision::single &&
        (r < smallest_single_size || l > largest_single_size))
        check.refuse(radius_setting,
                     "precision = \"single\" takes lengths from 2^-40 to 2^40 only");
    return check.problems.size() == n_problems;
}

/// Box and radius; a packing asks for the radius that gives it. True if the discs may fit.
bool fill_sizes(const Check& check) {
    Scene& scene = check.scene;
    const Setting* radius = check.settings.find("discs.radius");
    const Setting* packing = check.settings.find("discs.packing");
    const Setting* species = species_setting(check);
    if (!check.settings.is_mentioned("discs.packing") && !species)
        check.refuse_missing(
            "discs.radius",
            "give a radius, or 'discs.packing' for the share of the box the discs cover");
    if (radius && packing)
        check.refuse(*packing, "'discs.radius' and 'discs.packing' exclude each other");
    check.refuse_missing("box.size", "the side of the box");
    const auto box = size_number(check, "box.size");
    const auto given_radius = size_number(check, "discs.radius");
    auto share = finite_number(check, "discs.packing");
    if (share && !(*share > 0 && *share <= largest_packing)) {
        check.refuse(*packing, fmt::format("'discs.packing' must be greater than 0 and at most {}, "
                                           "not {}: equal discs cover no more of the plane",
                                           largest_packing, *share));
        share.reset();
    }
    if (species) {
        if (!box || scene.n_discs == 0 || radius || packing) return false;
        scene.box_size = *box;
        if (are_species_unknown(check)) return false;
        for (const Species& one : scene.effects.species)
            scene.radius = std::max(scene.radius, one.radius);
        return scene.radius > 0 && check_sizes(check, *species);
    }
    if (!box || scene.n_discs == 0 || (radius && packing) || (!given_radius && !share))
        return false;
    scene.box_size = *box;
    scene.radius = given_radius ? *given_radius
                                : *box * std::sqrt(*share / (static_cast<double>(scene.n_discs) *
                                                             std::numbers::pi));
    return check_sizes(check, given_radius ? *radius : *packing);
}

/// Random insertion stalls above a packing of about 0.54: denser requests start from a lattice.
void check_generator(const Check& check) {
    Scene& scene = check.scene;
    if (scene.generator == Generator::random &&
        scene.packing() > largest_random_packing * (1 + 1e-12)) {
        scene.generator = Generator::lattice;
        scene.warnings.push_back(fmt::format(
            "random insertion stalls above a packing of {}; the {} discs (packing {:.4g}) "
            "start from a shaken lattice",
            largest_random_packing, scene.n_discs, scene.packing()));
    }
    if (scene.generator == Generator::lattice &&
        !widest_lattice(scene.n_discs, scene.box_size, scene.radius)) {
        const Setting* setting = check.settings.find("discs.radius");
        if (!setting) setting = check.settings.find("discs.packing");
        if (!setting) setting = species_setting(check);
        check.refuse(
            *setting,
            fmt::format("no lattice of {} discs of radius {} fits into a box of side {}{}",
                        scene.n_discs, scene.radius, scene.box_size,
                        scene.effects.species.empty()
                            ? ""
                            : " (a lattice has room for the largest disc everywhere); list them"));
    }
}

void fill_velocities(const Check& check) {
    static constexpr Choices<VelocityKind, 2> kinds = {
        {{"maxwell", VelocityKind::maxwell}, {"uniform", VelocityKind::uniform}}};
    if (const auto kind = choice(check, "discs.velocities", kinds)) check.scene.velocities = *kind;
    if (const auto speed = finite_number(check, "discs.speed")) {
        const bool is_sane = *speed == 0 ||
                             (*speed >= smallest_size && *speed <= 0x1p-8 * largest_size);
        if (!is_sane)
            check.refuse(
                *check.settings.find("discs.speed"),
                fmt::format("'discs.speed' must be 0, or from 2^-250 to 2^242, not {}", *speed));
        check.scene.speed = *speed;
    }
    const std::int64_t largest_seed = check.scene.generator == Generator::legacy ? 0xFFFFFFFFll
                                                                                 : INT64_MAX;
    if (const auto seed = whole_number(check, "discs.seed", 0, largest_seed))
        check.scene.seed = static_cast<std::uint64_t>(*seed);
}

void fill_streams(const Check& check) {
    const Setting* streams = check.settings.find("discs.streams");
    if (!streams) return;
    for (const StreamRows& row : std::get<std::vector<StreamRows>>(streams->value)) {
        const auto refuse = [&](const std::string& text) {
            add_problem(check.problems, row.place, fmt::format("stream {}: {}", row.number, text));
        };
        const Stream stream{row.region[0], row.region[1],   row.region[2],
                            row.region[3], row.velocity[0], row.velocity[1]};
        const bool is_finite = std::isfinite(stream.x_low) && std::isfinite(stream.y_low) &&
                               std::isfinite(stream.x_high) && std::isfinite(stream.y_high);
        if (!is_finite || !(stream.x_low < stream.x_high && stream.y_low < stream.y_high))
            refuse("its region must be finite, with x0 < x1 and y0 < y1");
        for (const double component : row.velocity)
            if (const std::string text = velocity_problem(component); !text.empty()) refuse(text);
        check.scene.streams.push_back(stream);
    }
}

/// The knobs of the accuracy study.
void fill_arithmetic(const Check& check) {
    static constexpr Choices<Precision, 2> precisions = {
        {{"double", Precision::double_}, {"single", Precision::single}}};
    static constexpr Choices<Arithmetic, 2> arithmetics = {
        {{"stable", Arithmetic::stable}, {"naive", Arithmetic::naive}}};
    Scene& scene = check.scene;
    if (const auto precision = choice(check, "time.precision", precisions))
        scene.precision = *precision;
    if (const auto arithmetic = choice(check, "time.arithmetic", arithmetics))
        scene.arithmetic = *arithmetic;
    const Setting* contraction = check.settings.find("time.contraction");
    if (contraction) scene.contraction = std::get<bool>(contraction->value);
    if (contraction && scene.arithmetic == Arithmetic::stable)
        check.refuse(*contraction,
                     "'time.contraction' has no meaning without time.arithmetic = \"naive\"");
    if (scene.precision == Precision::single && scene.sync_every > longest_single_sync)
        check.refuse(*check.settings.find("time.precision"),
                     fmt::format("precision = \"single\" counts micro-steps up to {} between "
                                 "syncs; 'time.sync_every' is {}",
                                 longest_single_sync, scene.sync_every));
}

void fill_time(const Check& check) {
    static constexpr Choices<Method, 2> methods = {
        {{"time-stepped", Method::time_stepped}, {"event-driven", Method::event_driven}}};
    Scene& scene = check.scene;
    if (const auto method = choice(check, "time.method", methods)) scene.method = *method;
    check.refuse_missing("time.steps", "how many steps to run");
    if (const auto steps = whole_number(check, "time.steps", 0, largest_steps))
        scene.steps = *steps;
    if (const auto micro = whole_number(check, "time.micro_steps", 1, largest_steps))
        scene.micro_steps = *micro;
    if (const auto sync = whole_number(check, "time.sync_every", 1, std::int64_t{1} << 30))
        scene.sync_every = *sync;
    if (scene.steps > largest_steps / scene.micro_steps)
        check.refuse(*check.settings.find("time.steps"),
                     fmt::format("{} steps of {} micro-steps are more than 2^53 micro-steps",
                                 scene.steps, scene.micro_steps));
    if (!std::has_single_bit(static_cast<std::uint64_t>(scene.micro_steps)))
        scene.warnings.push_back(fmt::format(
            "time.micro_steps = {} is not a power of two: velocities are rounded when they are "
            "divided by it",
            scene.micro_steps));
    fill_arithmetic(check);
    if (const auto accuracy = finite_number(check, "time.accuracy")) {
        if (!(*accuracy > 0))
            check.refuse(*check.settings.find("time.accuracy"),
                         fmt::format("'time.accuracy' must be greater than 0, not {}", *accuracy));
        scene.accuracy = *accuracy;
        for (const std::string_view key : {"time.method", "time.micro_steps", "time.precision",
                                           "time.arithmetic", "time.contraction"})
            if (const Setting* setting = check.settings.find(key))
                check.refuse(
                    *setting,
                    fmt::format("'{}' is what 'time.accuracy' chooses: give one of them", key));
    }
}

void fill_trajectory(const Check& check) {
    static constexpr Choices<bool, 2> precisions = {{{"single", true}, {"double", false}}};
    if (!has_table(check, "output.trajectory")) return;
    TrajectoryOutput& output = check.scene.trajectory.emplace();
    output.file = check.scene.folder + "/trajectory.h5";
    if (const auto every = whole_number(check, "output.trajectory.every_steps", 1, largest_steps))
        output.every_steps = *every;
    if (const auto is_single = choice(check, "output.trajectory.precision", precisions))
        output.is_single = *is_single;
    const bool are_rough = check.scene.effects.contact.kind == ContactKind::rough;
    output.has_angular_velocity = are_rough;
    const Setting* fields = check.settings.find("output.trajectory.fields");
    if (!fields) return;
    output.has_position = output.has_velocity = output.has_collisions =
        output.has_angular_velocity = false;
    if (std::get<std::vector<std::string>>(fields->value).empty())
        check.refuse(*fields, "a trajectory needs at least one field");
    for (const std::string& field : std::get<std::vector<std::string>>(fields->value)) {
        if (field == "position")
            output.has_position = true;
        else if (field == "velocity")
            output.has_velocity = true;
        else if (field == "collisions")
            output.has_collisions = true;
        else if (field == "angular_velocity" && are_rough)
            output.has_angular_velocity = true;
        else if (field == "angular_velocity")
            check.refuse(
                *fields,
                "\"angular_velocity\" needs discs that turn, effects.contact.kind = \"rough\"");
        else
            check.refuse(*fields,
                         fmt::format("a field of a trajectory is \"position\", \"velocity\", "
                                     "\"collisions\" or \"angular_velocity\", not {}",
                                     quoted(field)));
    }
}

void fill_checkpoint(const Check& check) {
    CheckpointOutput& output = check.scene.checkpoint.emplace();
    output.folder = check.scene.folder + "/checkpoints";
    output.every_steps = whole_number(check, "output.checkpoint.every_steps", 1, largest_steps);
    output.every_minutes = finite_number(check, "output.checkpoint.every_minutes");
    if (output.every_minutes && !(*output.every_minutes > 0))
        check.refuse(*check.settings.find("output.checkpoint.every_minutes"),
                     fmt::format("'output.checkpoint.every_minutes' must be greater than 0, not {}",
                                 *output.every_minutes));
    if (const auto keep = whole_number(check, "output.checkpoint.keep", 1, 1000000))
        output.keep = *keep;
    if (const Setting* at_end = check.settings.find("output.checkpoint.at_end"))
        output.at_end = std::get<bool>(at_end->value);
}

void fill_output(const Check& check) {
    static constexpr Choices<TextOutput, 3> outputs = {{{"none", TextOutput::none},
                                                        {"ends", TextOutput::first_and_last},
                                                        {"every_step", TextOutput::every_step}}};
    if (const auto output = choice(check, "output.text", outputs))
        check.scene.text_output = *output;
    const Setting* collisions = check.settings.find("output.collisions");
    const bool has_log = collisions && std::get<bool>(collisions->value);
    bool needs_folder = has_log || check.settings.is_mentioned("output.folder");
    for (const char* table : {"output.checkpoint", "output.trajectory", "output.measurements"})
        needs_folder |= has_table(check, table);
    if (!needs_folder) return;
    check.scene.folder = destination(check, "output.folder",
                                     "the folder for what the run writes; -o FOLDER sets it too");
    fill_checkpoint(check);
    fill_trajectory(check);
    if (has_log) check.scene.collisions = CollisionOutput{check.scene.folder + "/collisions.h5"};
    fill_measurements(check);
}

} // namespace

void fill_scene(Scene& scene, const Settings& settings, Problems& problems,
                const DiscColumns* columns) {
    const Check check{scene, settings, problems, columns};
    fill_time(check);
    fill_species(check);
    fill_effects(check);
    fill_first_spins(check);
    fill_output(check);
    fill_generator(check);
    fill_velocities(check);
    fill_streams(check);
    fill_listed_discs(check);
    fill_count(check);
    if (fill_sizes(check)) {
        check_listed_discs(check);
        check_generator(check);
        check_room_for_effects(check);
        check_measured_box(check);
    } else {
        scene.radius = 0;
        if (!are_species_unknown(check)) scene.box_size = 0; // unknown
    }
}

} // namespace carrom
