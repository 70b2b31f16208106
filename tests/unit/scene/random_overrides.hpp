// SPDX-License-Identifier: BSD-3-Clause
// Random scenes drawn from the table of keys, as settings on top of an empty box.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "dynamics/effects.hpp"
#include "scene/key.hpp"

namespace carrom::test {

using Texts = std::vector<std::string>;

class Draw {
public:
    explicit Draw(std::uint64_t seed) : engine_(seed) {}

    std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
    double share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    std::string value(const Key& key) {
        switch (key.kind) {
        case Kind::number: return std::to_string(number(key));
        case Kind::integer: return std::to_string(integer(key));
        case Kind::flag: return below(2) == 0 ? "true" : "false";
        case Kind::text: return "\"a \\\"b\\\" \\\\ c\\t" + std::to_string(below(9)) + "\"";
        case Kind::choice: return '"' + std::string(key.words[below(key.words.size())]) + '"';
        case Kind::words: return words(key);
        case Kind::point:
            return below(2) == 0 ? "\"centre\"" : "[-3.5, " + std::to_string(share()) + ']';
        default: return "";
        }
    }
    std::string rows(const std::string& name) {
        std::string list;
        for (std::size_t i = 0, n = 1 + below(3); i < n; ++i) {
            const std::string x = std::to_string(10 + 80 * share()),
                              y = std::to_string(10 + 80 * share());
            if (name == "discs.region") return "[1, 2, " + x + ", " + y + ']';
            if (name == "effects.field.strengths") return "[0.5]";
            list += name == "discs.streams"
                        ? "{region = [1, 2, " + x + ", " + y + "], velocity = [-0.0, " + y + "]}, "
                    : name == "discs.species"
                        ? "{count = 2, radius = " + std::to_string(0.5 + share()) +
                              ", mass = " + x + spin() + region(x, y) + "}, "
                    : name == "discs.groups"
                        ? "{count = 3, temperature = " + std::to_string(share()) + region(x, y) +
                              (below(2) == 0 ? ", generator = \"compressed\"" : "") +
                              (below(4) == 0 ? ", freeze = true" : "") + "}, "
                    : name == "discs.list" ? '[' + x + ", " + y + ", -0.0, 1e-7], "
                    : name.ends_with("segments") || name == "discs.freeze"
                        ? "[1, 2, " + x + ", " + y + "], "
                    : name.ends_with("polygons") ? "[1, 2, " + x + ", " + y + ", 1, " + y + "], "
                                                 : '[' + x + ", " + y + ", 3], ";
        }
        return '[' + list + ']';
    }

private:
    double number(const Key& key) {
        const double low = std::isfinite(key.range.low) ? std::max(key.range.low, 1e-3) : -1;
        const double high = std::min(key.range.high, 1.0);
        return low + (high - low) * share();
    }
    std::int64_t integer(const Key& key) {
        const auto low = static_cast<std::int64_t>(std::max(key.range.low, 0.0));
        return low + static_cast<std::int64_t>(below(key.range.high < 10 ? 9 : 40));
    }
    std::string words(const Key& key) {
        std::string list;
        for (const std::string_view word : key.words)
            if (below(2) == 0) list += '"' + std::string(word) + "\", ";
        return '[' + list + ']';
    }
    std::string region(const std::string& x, const std::string& y) {
        return below(4) == 0 ? ", region = [0, 0, " + x + ", " + y + "]" : "";
    }
    std::string spin() { return below(2) == 0 ? ", spin = " + std::to_string(share()) : ""; }

    std::mt19937_64 engine_;
};

/// Some scenes are complete only when a file has been read, or when frozen discs are known.
inline bool is_found_later(const Key& key) {
    return key.name.starts_with("discs.from") || key.name == "discs.frozen";
}

inline const std::string box = "[box]\nsize = 100\n[time]\nsteps = 10\n";

inline const std::string two_species =
    "discs.species=[{count = 2, radius = 1}, {count = 3, radius = 0.5}]";

/// Adds, to some scenes, fields or discs that exchange sizes: keys that are only allowed together.
inline void add_fields(Draw& draw, Texts& texts) {
    if (draw.below(8) == 0)
        texts.insert(texts.end(), {"effects.gravity.amplitude_y=0.01", "effects.gravity.period=50",
                                   "time.sync_every=1"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(), {"effects.field.kind=trap", "effects.field.stiffness_y=0.01",
                                   "time.sync_every=1"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(), {"effects.field.kind=sine", "effects.field.amplitude=0.01",
                                   "time.sync_every=1"});
    if (draw.below(8) == 0) texts.insert(texts.end(), {two_species, "effects.swap.rounds=2"});
}

/// Adds inlets and effects that need several species to some scenes.
inline void add_mixtures(Draw& draw, Texts& texts) {
    if (draw.below(8) == 0) {
        const std::string side = std::string("box.") + boundary_names[draw.below(4)];
        texts.insert(texts.end(), {side + ".kind=open", side + ".inlet.rate=0.1",
                                   side + ".inlet.temperature=0.01"});
    }
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {two_species, "effects.contact.kind=restitution",
                      "effects.contact.restitution=0.9",
                      "effects.contact.pairs=[{species = [1, 2], restitution = 0.5}]"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {two_species, "output.folder=a", "output.measurements.every_steps=1",
                      "output.measurements.quantities=[\"profiles\"]",
                      "output.measurements.profile_species=1"});
}

/// Adds quantities, with the keys that belong to them, and periodic and sheared sides to some
/// scenes.
inline void add_quantities_and_periods(Draw& draw, Texts& texts) {
    if (draw.below(8) == 0) // with keys of these quantities, and with periodic sides
        texts.insert(texts.end(), {"box.left.kind=periodic", "box.right.kind=periodic",
                                   "box.bottom.kind=periodic", "box.top.kind=periodic",
                                   "output.folder=a", "output.measurements.every_steps=1",
                                   "output.measurements.quantities=[\"structure_factor\", "
                                   "\"diffusion\", \"correlations\"]",
                                   "output.measurements.correlation_points=8"});
    if (draw.below(8) == 0) // without quantities that are allowed only in few scenes
        texts.insert(texts.end(), {"output.folder=a", "output.measurements.every_steps=1",
                                   "output.measurements.quantities=[\"profiles\"]"});
    if (draw.below(8) == 0) // both sides are sheared; the flow goes through the other two
        texts.insert(texts.end(),
                     {"box.left.kind=periodic", "box.right.kind=periodic",
                      "box.bottom.kind=sheared", "box.top.kind=sheared", "effects.shear.rate=0.1"});
}

inline const std::string measured = "output.measurements.quantities=";

/// Settings with which keys that begin with a name have a meaning.
struct Companions {
    std::string_view begin;
    Texts texts;
};
inline const Companions companions[] = {
    {"output.measurements.largest_distance", {measured + "[\"radial_distribution\"]"}},
    {"output.measurements.largest_velocity", {measured + "[\"velocities\"]"}},
    {"output.measurements.profile_s",
     {measured + "[\"profiles\"]", "output.measurements.profile_columns=1",
      "output.measurements.profile_rows=1", two_species}},
    {"discs.radius.largest",
     {"discs.count=20", "discs.radius.mean=1", "discs.radius.polydispersity=0.1",
      "discs.radius.largest=1.25"}},
    {"effects.obstacles.friction",
     {"effects.obstacles.discs=[[50, 50, 3]]", "effects.obstacles.tangential_restitution=0.5"}},
    {"discs.columns", {"discs.generator=\"file\"", "discs.file=\"a\""}},
    {"effects.swap", {"effects.swap.rounds=2", two_species}},
    {"effects.thermostat.strength", {"effects.thermostat.kind=kicks"}},
    {"effects.field.file", {"effects.field.kind=grid", "effects.field.amplitude=0.01"}},
    {"effects.field.values", {"effects.field.kind=grid", "effects.field.amplitude=0.01"}},
    {"box.left.speed", {"box.left.kind=moving"}},
    {"box.right.speed", {"box.right.kind=moving"}},
    {"box.bottom.speed", {"box.bottom.kind=moving"}},
    {"box.top.speed", {"box.top.kind=moving"}}};

/// A short scene with a key of `companions`; empty for other keys.
inline Texts scene_with_companions(Draw& draw, const Key& key) {
    for (const Companions& one : companions) {
        if (!key.name.starts_with(one.begin)) continue;
        Texts texts = one.texts;
        if (texts.back().starts_with(key.name)) return texts;
        if (texts.back() != two_species)
            texts.insert(texts.end(), {"discs.count=20", "discs.radius=1"});
        if (key.name.starts_with("output."))
            texts.insert(texts.end(), {"output.folder=a", "output.measurements.every_steps=1"});
        texts.push_back("time.sync_every=1");
        texts.push_back(key.name + '=' + (key.has_rows() ? draw.rows(key.name) : draw.value(key)));
        return texts;
    }
    return {};
}

/// A short scene with a key that only few scenes may have; empty for other keys.
inline Texts scene_with(Draw& draw, const Key& key) {
    if (key.name == "time.stop.departed")
        return {"discs.count=20", "discs.radius=1", "box.left.kind=open",
                key.name + '=' + draw.value(key)};
    if (key.name.starts_with("time.") && !key.has_rows()) // a scene without effects
        return {"discs.count=20", "discs.radius=1",
                draw.below(2) == 0 ? "time.arithmetic=naive" : "time.method=time-stepped",
                key.name + '=' + draw.value(key)};
    if (key.name.ends_with(".contacts"))
        return {two_species, "effects.obstacles.discs=[[50, 50, 3]]",
                key.name + "=[{species = 2, restitution = 0." + std::to_string(1 + draw.below(9)) +
                    "}, {species = 1, tangential_restitution = 0.5, friction = 0.25}]"};
    const std::string end = ".inlet.species";
    if (!key.name.ends_with(end)) return scene_with_companions(draw, key);
    const std::string side = key.name.substr(0, key.name.size() - end.size());
    return {two_species, side + ".kind=open", side + ".inlet.rate=0.1",
            side + ".inlet.temperature=0.01", key.name + "=1"};
}

/// Settings with one of the ways to make discs, features that need several keys, the wanted key,
/// and about one other key in 32 (in 64 beside a wanted key). Most values are valid or nearly so.
inline Texts random_overrides(Draw& draw, const Key* wanted = nullptr) {
    if (Texts texts = wanted ? scene_with(draw, *wanted) : Texts(); !texts.empty()) return texts;
    Texts texts = {"time.method=event-driven"};
    const std::string source[] = {"discs.list", "discs.species", "discs.groups"};
    if (const std::size_t way = draw.below(6); way < 3)
        texts.push_back(source[way] + '=' + draw.rows(source[way]));
    if (texts.back().starts_with(source[2]))
        texts.push_back("discs.radius=1");
    else if (texts.size() == 1)
        texts.insert(texts.end(), {"discs.count=20", "discs.radius=1"});
    if (draw.below(3) == 0)
        texts.insert(texts.end(), {"effects.contact.kind=rough", "effects.contact.restitution=0.9",
                                   "effects.contact.tangential_restitution=0.5"});
    const auto any_side = [&draw] { return std::string("box.") + boundary_names[draw.below(4)]; };
    if (draw.below(4) == 0) {
        const std::string side = any_side();
        texts.insert(texts.end(), {side + ".kind=thermal", side + ".temperature=0.1"});
    }
    if (draw.below(3) == 0) {
        const std::string side = any_side();
        texts.insert(texts.end(),
                     {side + ".kind=oscillating", side + ".amplitude=0.5", side + ".period=3"});
        if (draw.below(2) == 0) texts.push_back(side + ".phase=3.5");
    }
    if (draw.below(12) == 0)
        texts.insert(texts.end(), {"box.top.kind=moving", "box.top.speed=0.01"});
    if (draw.below(4) == 0)
        texts.insert(texts.end(),
                     {"effects.thermostat.kind=langevin", "effects.thermostat.rate=0.01",
                      "effects.thermostat.temperature=0.01"});
    if (texts.back().ends_with("temperature=0.01") && draw.below(2) == 0)
        texts.push_back(draw.below(2) == 0 ? "effects.activity.speed=0.01"
                                           : "effects.activity.force=0.01");
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {"effects.gravity.y=-0.01", "effects.contact.kind=restitution",
                      "effects.contact.restitution=0.9", "effects.lasting_contacts.speed=0.05"});
    add_fields(draw, texts);
    add_mixtures(draw, texts);
    if (draw.below(4) == 0) texts.push_back("time.arithmetic=naive");
    add_quantities_and_periods(draw, texts);
    const std::size_t one_in = wanted ? 64 : 32;
    for (const Key& key : keys()) {
        if (key.name == "box.size" || (&key != wanted && draw.below(one_in) != 0)) continue;
        if (std::ranges::find(source, key.name) != std::end(source)) continue;
        if (is_found_later(key)) continue;
        texts.push_back(key.name + '=' + (key.has_rows() ? draw.rows(key.name) : draw.value(key)));
    }
    return texts;
}

} // namespace carrom::test
