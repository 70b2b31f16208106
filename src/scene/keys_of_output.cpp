// SPDX-License-Identifier: BSD-3-Clause
// The keys of [output]. None of them changes a bit of the result.
#include "scene/key_members.hpp"
#include "scene/limits.hpp"

namespace carrom {

namespace {

constexpr Range every{1, largest_steps};
constexpr Range at_least_one{.low = 1}; ///< word

Need quantity(std::string text, bool (*holds)(const MeasurementOutput&)) {
    return {"without " + std::move(text) + " among 'output.measurements.quantities'",
            [holds](const Scene& s) { return s.measurements && holds(*s.measurements); }};
}

Key trajectory_precision() {
    Key key{.name = "output.trajectory.precision", .help = "Of the numbers in the file."};
    key.kind = Kind::choice;
    key.words = {"single", "double"};
    key.get = [](const Scene& s) {
        return Value{std::string(s.trajectory->is_single ? "single" : "double")};
    };
    key.set = [](Scene& s, const Value& value) {
        s.trajectory->is_single = std::get<std::string>(value.data) == "single";
    };
    key.is_same = [](const Scene& a, const Scene& b) {
        return a.trajectory->is_single == b.trajectory->is_single;
    };
    return key;
}

std::vector<Key> keys_of_checkpoints() {
    return {
        key({.name = "output.text",
             .help = "Lines of discs on standard output: none, those of steps 0 and S, or all."},
            [](auto& s) -> auto& { return s.text_output; }),
        key({.name = "output.checkpoint.folder",
             .help = "The folder for checkpoints; made where there is none.",
             .is_required = true},
            [](auto& s) -> auto& { return s.checkpoint->folder; }),
        key({.name = "output.checkpoint.every_steps",
             .unit = "steps",
             .help = "Time from checkpoint to checkpoint.",
             .fallback = "none",
             .range = every},
            [](auto& s) -> auto& { return s.checkpoint->every_steps; }),
        key({.name = "output.checkpoint.every_minutes",
             .unit = "minutes",
             .help = "And after this much wall time without one.",
             .fallback = "none",
             .range = {.low = 0, .excludes_low = true}},
            [](auto& s) -> auto& { return s.checkpoint->every_minutes; }),
        key({.name = "output.checkpoint.at_end", .help = "And at the last step."},
            [](auto& s) -> auto& { return s.checkpoint->at_end; }),
        key({.name = "output.checkpoint.keep",
             .unit = "files",
             .help = "How many to keep; older ones are removed once a newer one is on disk.",
             .range = {1, 1e6}},
            [](auto& s) -> auto& { return s.checkpoint->keep; }),
    };
}

std::vector<Key> keys_of_recordings() {
    using Output = TrajectoryOutput;
    const std::vector<std::pair<std::string_view, bool Output::*>> fields = {
        {"position", &Output::has_position},
        {"velocity", &Output::has_velocity},
        {"collisions", &Output::has_collisions},
        {"angular_velocity", &Output::has_angular_velocity}};
    return {
        key({.name = "output.trajectory.file",
             .help = "One H5MD file of frames.",
             .is_required = true},
            [](auto& s) -> auto& { return s.trajectory->file; }),
        key({.name = "output.trajectory.every_steps",
             .unit = "steps",
             .help = "Time from frame to frame.",
             .range = every},
            [](auto& s) -> auto& { return s.trajectory->every_steps; }),
        flags_key(
            {.name = "output.trajectory.fields",
             .help = "What a frame has of each disc; collisions are its two counters.",
             .fallback = "position, velocity; angular_velocity of rough discs",
             .range = at_least_one},
            [](auto& s) -> auto& { return *s.trajectory; }, fields),
        trajectory_precision(),
        key({.name = "output.trajectory.compression",
             .unit = "1",
             .help = "From 0, none, to 9, smallest.",
             .range = {0, 9}},
            [](auto& s) -> auto& { return s.trajectory->compression; }),
        key({.name = "output.collisions.file",
             .help = "One HDF5 file of every collision.",
             .is_required = true},
            [](auto& s) -> auto& { return s.collisions->file; }),
    };
}

/// The distance is worked out where it is not named.
Key largest_distance() {
    Key distance = key(
        {.name = "output.measurements.largest_distance",
         .unit = "length",
         .help = "Reach of the radial distribution; at most half the box of centres.",
         .fallback = "5 diameters",
         .range = {.low = 0, .excludes_low = true},
         .need = quantity("\"radial_distribution\"",
                          [](const auto& m) { return m.radial_distribution; })},
        [](auto& s) -> auto& { return s.measurements->largest_distance; });
    distance.get = [](const Scene& s) {
        const MeasurementOutput& output = *s.measurements;
        return output.is_distance_default ? Value{} : value_of(output.largest_distance);
    };
    return distance;
}

std::vector<Key> keys_of_measurements() {
    using Output = MeasurementOutput;
    const std::vector<std::pair<std::string_view, bool Output::*>> quantities = {
        {"wall_pressure", &Output::wall_pressure},
        {"radial_distribution", &Output::radial_distribution},
        {"velocities", &Output::velocities},
        {"density", &Output::density},
        {"displacement", &Output::displacement}};
    return {
        key({.name = "output.measurements.folder",
             .help = "The folder for the tables.",
             .is_required = true},
            [](auto& s) -> auto& { return s.measurements->folder; }),
        flags_key(
            {.name = "output.measurements.quantities",
             .help = "What is measured.",
             .range = at_least_one,
             .is_required = true},
            [](auto& s) -> auto& { return *s.measurements; }, quantities),
        key({.name = "output.measurements.every_steps",
             .unit = "steps",
             .help = "Time from sample to sample.",
             .range = every},
            [](auto& s) -> auto& { return s.measurements->every_steps; }),
        key({.name = "output.measurements.from_step",
             .unit = "steps",
             .help = "Step of the first sample: leave out the time of equilibration.",
             .range = {0, largest_steps}},
            [](auto& s) -> auto& { return s.measurements->from_step; }),
        key({.name = "output.measurements.bins",
             .unit = "1",
             .help = "Bins of each table of distances, velocities or places.",
             .range = {1, 10000},
             .need = quantity("\"radial_distribution\", \"velocities\" or \"density\"",
                              [](const Output& m) {
                                  return m.radial_distribution || m.velocities || m.density;
                              })},
            [](auto& s) -> auto& { return s.measurements->bins; }),
        largest_distance(),
        key({.name = "output.measurements.largest_velocity",
             .unit = "length/step",
             .help = "Largest component in the table of velocities.",
             .fallback = "5 standard deviations",
             .range = {.low = 0, .excludes_low = true},
             .need = quantity("\"velocities\"", [](const auto& m) { return m.velocities; })},
            [](auto& s) -> auto& { return s.measurements->largest_velocity; }),
    };
}

} // namespace

std::vector<Key> keys_of_output() {
    std::vector<Key> all;
    for (const auto& part : {keys_of_checkpoints(), keys_of_recordings(), keys_of_measurements()})
        all.insert(all.end(), part.begin(), part.end());
    for (Key& one : all) one.is_physical = false;
    return all;
}

} // namespace carrom
