// SPDX-License-Identifier: BSD-3-Clause
#include <carrom/scene.hpp>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "initial_state/scene_input.hpp"
#include "library/checked_source.hpp"
#include "library/session_state.hpp"
#include "parallel/agreement.hpp"
#include "parallel/meeting.hpp"
#include "run/start/scene_source.hpp"
#include "scene/read_scene.hpp"
#include "simulation/first_discs.hpp"

namespace carrom {

namespace {

constexpr std::size_t longest_list = std::size_t{1} << 26;

SceneText text_of(const Scene::Source& source) {
    return {source.name, source.text, source.lines_before_discs, source.discs_follow, {}};
}

} // namespace

Scene Scene::from_file(const Session& session, const std::string& path) {
    const Communicator& ranks = ranks_of(session);
    meet(ranks, "Scene::from_file", hash_of_argument(path));
    SceneText text;
    let_root(ranks, [&] {
        std::ifstream file = open_input(path);
        text = read_scene_text(file, path);
    });
    broadcast(text, ranks);
    Scene scene;
    scene.source_ = {text.name, text.text, text.lines_before_discs, text.discs_follow, {}};
    return scene;
}

Scene Scene::from_text(std::string_view text, const std::string& name) {
    if (!name.ends_with(".toml"))
        throw InputError({{name, 0, "the name of a scene's TOML text must end in .toml"}});
    Scene scene;
    scene.source_.name = name;
    if (!text.empty()) scene.source_.text = text;
    return scene;
}

Scene& Scene::set(std::string_view key, std::string_view value) {
    std::string setting = fmt::format("{}={}", key, value);
    // Line breaks become spaces, because files have one setting per line
    std::replace(setting.begin(), setting.end(), '\n', ' ');
    source_.settings.push_back(std::move(setting));
    return *this;
}

Scene& Scene::set_number(std::string_view key, double value) {
    return set(key, fmt::format("{}", value));
}

Scene& Scene::set_discs(std::span<const Disc> discs) {
    std::vector<Disc> sorted(discs.begin(), discs.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Disc& a, const Disc& b) { return a.id < b.id; });
    const bool has_spins = std::any_of(sorted.begin(), sorted.end(),
                                       [](const Disc& disc) { return disc.spin != 0; });
    std::string list = "[";
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        const Disc& disc = sorted[k];
        if (disc.id != k)
            throw InputError({{"discs.list", 0,
                               fmt::format("ids must be 0 to {}, once each; {} is {}",
                                           sorted.size() - 1, disc.id < k ? disc.id : k,
                                           disc.id < k ? "there twice" : "missing")}});
        list += fmt::format("{}[{}, {}, {}, {}", k == 0 ? "" : ", ", disc.x, disc.y, disc.vx,
                            disc.vy);
        list += has_spins ? fmt::format(", {}]", disc.spin) : "]";
    }
    list += ']';
    if (list.size() > longest_list)
        throw InputError({{"discs.list", 0,
                           fmt::format("{} discs are more than 64 MiB of text; write them to a "
                                       "file and set discs.file",
                                       sorted.size())}});
    return set("discs.list", list);
}

SceneFacts Scene::check() const {
    return facts_of(
        with_named_keys([&] { return read_scene(text_of(source_), source_.settings); }));
}

SceneFacts facts_of(const SceneParameters& scene) {
    SceneFacts facts;
    facts.box = scene.box;
    facts.x_low = 0 - scene.origin.x;
    facts.y_low = 0 - scene.origin.y;
    facts.radius = scene.radius;
    facts.packing = scene.packing();
    facts.n_discs = scene.n_discs;
    facts.steps = scene.steps;
    facts.micro_steps = scene.micro_steps;
    facts.exchanges_radii = scene.effects.swap.is_on();
    facts.is_event_driven = scene.method == Method::event_driven;
    facts.is_periodic_x = scene.effects.is_periodic_x();
    facts.is_periodic_y = scene.effects.is_periodic_y();
    facts.warnings = scene.warnings;
    return facts;
}

namespace {

/// Throws if ranks have different scenes, which would leave some ranks waiting. **Collective.**
void check_same_on_all(const Scene::Source& source, const Communicator& ranks) {
    std::string all = source.name + '\0' + source.text;
    for (const std::string& setting : source.settings) all += '\0' + setting;
    std::uint64_t first = std::hash<std::string>{}(all);
    const std::uint64_t mine = first;
    ranks.broadcast(first);
    std::vector<Problem> problems;
    if (first != mine)
        problems.push_back(
            {source.name, 0,
             fmt::format("rank {} has another scene or other settings than rank 0", ranks.rank())});
    agree_on_problems(ranks, problems);
}

} // namespace

FirstState first_state(const Scene& scene, const Communicator& ranks, const Tuning& tuning) {
    check_same_on_all(scene.source(), ranks);
    SceneSource source{text_of(scene.source()), nullptr};
    let_root(ranks, [&] {
        if (!source.text.discs_follow) return;
        source.stream = std::make_unique<std::ifstream>(open_input(source.text.name));
        read_scene_text(*source.stream, source.text.name); // moves the stream to the first disc
    });
    FirstState first;
    first.scene = with_named_keys(
        [&] { return read_with_files(source, scene.source().settings, ranks); });
    first.discs = first_discs_and_frozen(first.scene, source.stream.get(), ranks, tuning);
    return first;
}

} // namespace carrom
