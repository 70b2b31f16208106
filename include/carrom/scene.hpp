// SPDX-License-Identifier: BSD-3-Clause
// The keys of a scene (docs/reference/keys.md), which describe what is simulated. They are read
// from a file or from TOML text, or set one by one. A copy of a Scene has its own copy of the text
// and is independent.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <carrom/box.hpp>
#include <carrom/disc.hpp>

namespace carrom {

class Session;

/// Facts that follow from a checked scene. Lengths are in the scene's unit.
struct SceneFacts {
    Box box;
    double x_low = 0, y_low = 0; ///< coordinates of the lower left corner; 0 without `box.origin`
    double radius = 0;           ///< radius of the largest disc
    double packing = 0;          ///< share of the box's area that discs cover
    std::uint64_t n_discs = 0;
    std::int64_t steps = 0;       ///< number of the last step
    std::int64_t micro_steps = 1; ///< micro-steps per step
    /// Whether the method is event-driven; otherwise it is time-stepped
    bool is_event_driven = false;
    /// Whether the left and right sides (x) or the bottom and top sides (y) are periodic
    bool is_periodic_x = false, is_periodic_y = false;
    bool exchanges_radii = false; ///< whether discs exchange their radii (`effects.swap`)
    /// One line for each setting that is allowed but often a mistake
    std::vector<std::string> warnings;
};

class Scene {
public:
    /// Makes a scene without keys; add them by `set`. Not collective.
    Scene() = default;

    /// Makes a scene from a file, which is TOML if its name ends in `.toml`, else legacy text. Rank
    /// 0 reads it. Throws InputError if it cannot be read. **Collective.**
    static Scene from_file(const Session& session, const std::string& path);

    /// Makes a scene from TOML text. `name`, which must end in `.toml`, appears in messages;
    /// relative paths in the scene start from the folder of `name`. Not collective.
    static Scene from_text(std::string_view text, const std::string& name = "scene.toml");

    /// Sets a key, as `--set key=value` of `carrom run` does: `set("time.steps", 100)`. A value
    /// that is given as text is a word or any TOML value: `set("discs.streams", "[{region = [0, 0,
    /// 1, 1], velocity = [1, 0]}]")`. Replaces an older value, and removes keys that exclude this
    /// one. `check` tests the value later. Not collective: every rank must set the same values.
    /// Returns this scene.
    Scene& set(std::string_view key, std::string_view value);
    Scene& set(std::string_view key, const char* value) {
        return set(key, std::string_view(value));
    }
    template <class Number>
        requires std::integral<Number> || std::floating_point<Number>
    Scene& set(std::string_view key, Number value) {
        if constexpr (std::same_as<Number, bool>)
            return set(key, value ? std::string_view("true") : std::string_view("false"));
        else if constexpr (std::integral<Number>)
            return set(key, std::string_view(std::to_string(value)));
        else
            return set_number(key, static_cast<double>(value));
    }

    /// Sets the discs at the start, in any order: ids 0 to N - 1 once each, with positions,
    /// velocities, and spins if any of them is not 0. Every rank must set the same discs. They
    /// become the scene's `discs.list`, so files of the run contain them as text of some 80 bytes a
    /// disc, at most 64 MiB. For more discs use `discs.file` or a generator. Throws InputError for
    /// wrong ids. Not collective.
    Scene& set_discs(std::span<const Disc> discs);

    /// Checks every key. Throws InputError with all problems. Reads no files. Not collective.
    SceneFacts check() const;

    struct Source {
        std::string name = "scene.toml";
        /// The scene's text, which is never empty
        std::string text = "# made by a program; its settings are all\n";
        std::int64_t lines_before_discs = 0; ///< number of lines of legacy text before the discs
        bool discs_follow = false;           ///< whether discs follow `text`, a legacy header
        std::vector<std::string> settings;   ///< "key=value", in the order they were set
    };
    const Source& source() const { return source_; }

private:
    Scene& set_number(std::string_view key, double value);

    Source source_;
};

} // namespace carrom
