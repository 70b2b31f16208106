// SPDX-License-Identifier: BSD-3-Clause
#include "scene/key.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "scene/boundaries/boundary.hpp"

namespace carrom {

namespace {

template <class T> const T* find(const std::vector<T>& all, std::string_view name) {
    for (const T& one : all)
        if (one.name == name) return &one;
    return nullptr;
}

} // namespace

Dimension dimension_of(std::string_view unit) {
    Dimension all;
    int sign = 1;
    while (!unit.empty()) {
        const std::size_t end = std::min(unit.find_first_of(" /"), unit.size());
        const std::string_view factor = unit.substr(0, end),
                               word = factor.substr(0, factor.find('^'));
        const int power = sign * (word.size() < factor.size() ? factor.back() - '0' : 1);
        if (word == "length") all.length += power;
        if (word == "step" || word == "steps") all.time += power;
        if (word == "mass") all.mass += power;
        if (end < unit.size() && unit[end] == '/') sign = -1;
        unit.remove_prefix(std::min(end + 1, unit.size()));
    }
    return all;
}

Effects per_micro_step(const SceneParameters& scene) {
    static const std::vector<Key> of_effects = keys_of_effects();
    const auto k = static_cast<double>(scene.micro_steps);
    SceneParameters scaled;
    scaled.effects = scene.effects;
    for (const Key& key : of_effects) {
        const int time = key.dimension().time;
        if (key.kind != Kind::number || time == 0) continue;
        double unit = 1;
        for (int i = 0; i < std::abs(time); ++i) unit *= k;
        const Value value = key.get(scaled);
        const double* const number = std::get_if<double>(&value.data);
        if (number) key.set(scaled, {time > 0 ? *number * unit : *number / unit});
    }
    return std::move(scaled.effects);
}

const std::vector<Key>& keys() {
    static const std::vector<Key> all = [] {
        std::vector<Key> list = keys_of_discs();
        const auto add = [&list](const std::vector<Key>& part) {
            list.insert(list.end(), part.begin(), part.end());
        };
        add(keys_of_time());
        add(keys_of_machine());
        add(keys_of_sizes());
        add(keys_of_effects());
        add(keys_of_output());
        return list;
    }();
    return all;
}

const std::vector<Table>& tables() {
    static const std::vector<Table> all = [] {
        std::vector<Table> list = {
            {"box", "The box that discs move in."},
            {"discs", "How many discs there are, and how they begin."},
            {"discs.radius", "Radii that follow a distribution, in place of one radius.",
             [](const SceneParameters& s) { return s.sizes.has_value(); },
             [](SceneParameters& s) { s.sizes.emplace(); }},
            {"time", "How long, and by which method."},
            {"time.stop", "What ends a run before its last step. It is checked at the end of each "
                          "step with a sync, and the report says what ended the run."},
            {"machine", "What steps the discs; no key of machine changes a bit of the result."},
            {"box.left", "One side of the box. `[box.right]`, `[box.bottom]` and `[box.top]` have "
                         "the same keys."},
            {.name = "box.right", .is_like_another = true},
            {.name = "box.bottom", .is_like_another = true},
            {.name = "box.top", .is_like_another = true},
            {"effects", ""},
            {"output", "What a run writes; no key of output changes a bit of the result."},
            {"output.checkpoint", "When and where the state is stored.",
             [](const SceneParameters& s) { return s.checkpoint.has_value(); },
             [](SceneParameters& s) { s.checkpoint.emplace(); }},
            {"output.trajectory", "Frames in one file.",
             [](const SceneParameters& s) { return s.trajectory.has_value(); },
             [](SceneParameters& s) { s.trajectory.emplace(); }},
            {"output.units", "Units of the numbers in HDF5 files."},
            {"output.measurements", "What is sampled as the run goes on.",
             [](const SceneParameters& s) { return s.measurements.has_value(); },
             [](SceneParameters& s) { s.measurements.emplace(); }},
        };
        const auto next = std::find_if(list.begin(), list.end(),
                                       [](const Table& one) { return one.name == "output"; });
        std::vector<Table> of_effects;
        for (const EffectDeclaration& effect : all_effects())
            of_effects.insert(of_effects.end(), effect.tables.begin(), effect.tables.end());
        for (const BoundaryDeclaration& kind : all_boundaries())
            of_effects.insert(of_effects.end(), kind.tables.begin(), kind.tables.end());
        list.insert(next, of_effects.begin(), of_effects.end());
        return list;
    }();
    return all;
}

const Key* find_key(std::string_view name) { return find(keys(), name); }

const Table* find_table(std::string_view name) { return find(tables(), name); }

} // namespace carrom
