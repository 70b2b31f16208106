// SPDX-License-Identifier: BSD-3-Clause
#include "scene/key.hpp"

#include <algorithm>

#include "scene/boundaries/boundary.hpp"

namespace carrom {

namespace {

template <class T> const T* find(const std::vector<T>& all, std::string_view name) {
    for (const T& one : all)
        if (one.name == name) return &one;
    return nullptr;
}

} // namespace

const std::vector<Key>& keys() {
    static const std::vector<Key> all = [] {
        std::vector<Key> list = keys_of_discs();
        const auto add = [&list](const std::vector<Key>& part) {
            list.insert(list.end(), part.begin(), part.end());
        };
        add(keys_of_time());
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
