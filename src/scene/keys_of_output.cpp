// SPDX-License-Identifier: BSD-3-Clause
// The keys of [output]. None of them changes a bit of the result.
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/quantity.hpp"

namespace carrom {

namespace {

constexpr Range every{1, largest_steps};
constexpr Range at_least_one{.low = 1}; ///< range of the number of words in a list

/// Makes a key whose value is a word. `word_of` returns the word, or "" if none; `take` stores it.
Key choice(std::string name, std::string_view help, std::vector<std::string_view> words,
           std::string (*word_of)(const SceneParameters&),
           void (*take)(SceneParameters&, const std::string&)) {
    Key key = named_key(std::move(name), "", help);
    key.kind = Kind::choice;
    key.words = std::move(words);
    key.get = [word_of](const SceneParameters& s) {
        const std::string word = word_of(s);
        return word.empty() ? Value{} : Value{word};
    };
    key.set = [take](SceneParameters& s, const Value& value) {
        take(s, std::get<std::string>(value.data));
    };
    return key;
}

Key collision_log() {
    Key key = named_key("output.collisions", "", "Whether every collision is recorded.");
    key.kind = Kind::flag;
    key.fallback = "false";
    key.get = [](const SceneParameters& s) { return Value{s.collisions.has_value()}; };
    key.set = [](SceneParameters& s, const Value& value) {
        if (std::get<bool>(value.data)) s.collisions.emplace();
    };
    return key;
}

std::vector<Key> keys_of_checkpoints() {
    return {
        key("output.text", "",
            "Lines of discs on standard output: none, those of steps 0 and S, or all.",
            [](auto& s) -> auto& { return s.text_output; }),
        key("output.folder", "", "Where all that the run writes has its place; -o sets it too.",
            [](auto& s) -> auto& { return s.folder; })
            .by_default("none"),
        key("output.averages_from_step", "steps",
            "Step that the averages of summary and report begin at: leave out equilibration.",
            [](auto& s) -> auto& { return s.averages_from; })
            .within({0, largest_steps}),
        key("output.checkpoint.every_steps", "steps", "Time from checkpoint to checkpoint.",
            [](auto& s) -> auto& { return s.checkpoint->every_steps; })
            .by_default("none")
            .within(every),
        key("output.checkpoint.every_minutes", "minutes",
            "And after this much wall time without one.",
            [](auto& s) -> auto& { return s.checkpoint->every_minutes; })
            .by_default("none")
            .within({.low = 0, .excludes_low = true}),
        key("output.checkpoint.at_end", "", "And at the last step.",
            [](auto& s) -> auto& { return s.checkpoint->at_end; }),
        key("output.checkpoint.keep", "files",
            "How many to keep; older ones are removed once a newer one is on disk.",
            [](auto& s) -> auto& { return s.checkpoint->keep; })
            .within({1, 1e6}),
        key("output.checkpoint.transfers", "",
            "How ranks write: each its own discs, or some for all (for parallel file systems).",
            [](auto& s) -> auto& { return s.checkpoint->transfers; }),
    };
}

std::vector<Key> keys_of_recordings() {
    using Output = TrajectoryOutput;
    std::vector<Flag<Output>> fields = {{"position", &Output::has_position},
                                        {"velocity", &Output::has_velocity},
                                        {"collisions", &Output::has_collisions}};
    for (std::size_t k = 0; k < computed_field_table.size(); ++k)
        fields.push_back({computed_field_table[k].name,
                          [k](Output& output) -> bool& { return output.computed[k]; }});
    fields.push_back({"image", &Output::has_image});
    for (std::size_t k = 0; k < n_side_columns; ++k)
        fields.push_back({side_column_table[k].shown,
                          [k](Output& output) -> bool& { return output.columns.flags[k]; }});
    return {
        key("output.trajectory.every_steps", "steps", "Time from frame to frame.",
            [](auto& s) -> auto& { return s.trajectory->every_steps; })
            .within(every),
        key("output.trajectory.frames_per_decade", "frames",
            "Number of frames while the step grows tenfold, from every_steps on; 0: frames at "
            "regular steps.",
            [](auto& s) -> auto& { return s.trajectory->frames_per_decade; })
            .within({0, 1000}),
        flags_key(
            "output.trajectory.fields", "",
            "What a frame has of each disc; collisions are its two counters, neighbours Voronoi's "
            "(of the radical tessellation where radii differ), image the box lengths that it has "
            "flown.",
            [](auto& s) -> auto& { return *s.trajectory; }, fields)
            .by_default("position, velocity; image in periodic boxes; angular_velocity of rough "
                        "discs; direction of active ones; swapped_radius of those that swap")
            .within(at_least_one),
        choice(
            "output.trajectory.precision", "Precision of the numbers in the file.",
            {"single", "double"},
            [](const SceneParameters& s) {
                return std::string(s.trajectory->is_single ? "single" : "double");
            },
            [](SceneParameters& s, const std::string& word) {
                s.trajectory->is_single = word == "single";
            }),
        collision_log(),
        choice(
            "output.units.length", "Unit of lengths that HDF5 files name; no number depends on it.",
            {"m", "cm", "mm", "um", "nm", "pm"},
            [](const SceneParameters& s) { return s.length_unit; },
            [](SceneParameters& s, const std::string& word) { s.length_unit = word; })
            .by_default("none"),
        choice(
            "output.units.time", "And of steps.", {"s", "ms", "us", "ns", "ps", "fs"},
            [](const SceneParameters& s) { return s.time_unit; },
            [](SceneParameters& s, const std::string& word) { s.time_unit = word; })
            .by_default("none"),
    };
}

Key measured_quantities() {
    Key key = named_key(std::string(quantities_key), "", "What is measured.");
    key.kind = Kind::words;
    for (const Quantity& quantity : declared_quantities()) key.words.push_back(quantity.name);
    key.get = [](const SceneParameters& s) {
        Values words;
        for (const std::string& quantity : s.measurements->quantities) words.push_back({quantity});
        return Value{std::move(words)};
    };
    key.set = [](SceneParameters& s, const Value& value) {
        s.measurements->quantities.clear();
        for (const Value& word : std::get<Values>(value.data))
            if (!word.is_nothing())
                s.measurements->quantities.push_back(std::get<std::string>(word.data));
    };
    return std::move(key).within(at_least_one).required();
}

std::vector<Key> keys_of_measurements() {
    std::vector<Key> all = {
        measured_quantities(),
        key("output.measurements.every_steps", "steps", "Time from sample to sample.",
            [](auto& s) -> auto& { return s.measurements->every_steps; })
            .within(every),
        key("output.measurements.from_step", "steps",
            "Step of the first sample: leave out the time of equilibration.",
            [](auto& s) -> auto& { return s.measurements->from_step; })
            .within({0, largest_steps}),
    };
    const std::vector<Key> of_quantities = keys_of_quantities();
    all.insert(all.end(), of_quantities.begin(), of_quantities.end());
    return all;
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
