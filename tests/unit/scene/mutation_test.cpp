// SPDX-License-Identifier: BSD-3-Clause
// Thousands of damaged inputs: each gives a scene or an InputError.
#include "catch.hpp"

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/disc_reader.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

class Damage {
public:
    explicit Damage(std::uint64_t seed) : engine_(seed) {}

    std::string operator()(std::string text) {
        for (std::size_t n = 1 + below(4); n > 0; --n) text = once(std::move(text));
        return text;
    }

private:
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

    std::string once(std::string text) {
        static const std::vector<std::string> pieces = {
            "nan", "inf", "-",  "1e999",     "\n",   "=",   "[",
            "]",   "[[",  "\"", "'''",       "#",    "\0x", "99999999999999999999",
            ".",   "e",   "0x", "\xff\xfe",  "true", "{",   "}",
            ",",   " ",   "\r", "1979-05-27"};
        if (text.empty()) return pieces[below(pieces.size())];
        const std::size_t at = below(text.size());
        switch (below(6)) {
        case 0: text[at] = static_cast<char>(below(256)); return text;
        case 1: return text.erase(at, 1 + below(8));
        case 2: return text.insert(at, pieces[below(pieces.size())]);
        case 3: {
            // A separate statement, because arguments may be evaluated in any order.
            const std::string copy = text.substr(at, 1 + below(30));
            return text.insert(below(text.size()), copy);
        }
        case 4:
            return below(10) == 0 ? text.substr(0, at)
                                  : text.insert(at, 1, static_cast<char>('0' + below(10)));
        default: std::swap(text[at], text[below(text.size())]); return text;
        }
    }

    std::mt19937_64 engine_;
};

/// Reads a damaged text to its end; anything but SceneParameters or an InputError fails the test.
bool is_refused(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {}) {
    const auto problems = test::problems_of([&] {
        std::istringstream stream(text);
        const SceneParameters scene = read_scene(read_scene_text(stream, name), overrides);
        if (!scene.reads_disc_lines()) return;
        DiscReader reader(stream, scene);
        std::vector<InputDisc> chunk;
        while (reader.read(chunk, 2)) {
        }
        if (auto found = reader.problems(); !found.empty()) throw InputError(found);
    });
    for (const Problem& problem : problems) CHECK_FALSE(problem.text.empty());
    return !problems.empty();
}

const std::string toml =
    "[box]\nsize = 100.5\n[discs]\ncount = 50\nradius = 1\ngenerator = \"lattice\"\nspeed = 0.5\n"
    "velocities = 'uniform'\nseed = 5\n[[discs.streams]]\nregion = [0, 0, 1, 1]\nvelocity = [1, "
    "0]\n"
    "[time]\nsteps = 10\nmicro_steps = 2\nsync_every = 16\nmethod = "
    "\"time-stepped\"\n[output]\ntext = \"ends\"\n";
const std::string listed = "[box]\nsize = 1e1\n[discs]\nradius = 1.0\nlist = [[2, 2, 0, 1.5], "
                           "[5.5, 5, -1, 0],\n  [8, 8, 0, 0]]\n"
                           "[time]\nsteps = 10\n";
const std::string legacy =
    "4\n10\n0.5\n40\nprint\n2 9 1 0 0.25\n0 2 5 0.25 0\n\n3 2 8 0 0\n1 8 5 -0.25 0\n";

} // namespace

TEST_CASE("damaged TOML scenes give a scene or problems") {
    for (const std::string& text : {toml, listed}) {
        REQUIRE_FALSE(is_refused(text, "s.toml"));
        Damage damage(17);
        int n_refused = 0;
        for (int i = 0; i < 1000; ++i) n_refused += is_refused(damage(text), "s.toml");
        CHECK(n_refused > 500);
        CHECK(n_refused < 1000);
    }
}

TEST_CASE("damaged legacy texts give a scene or problems") {
    REQUIRE_FALSE(is_refused(legacy, "t.in"));
    Damage damage(19);
    int n_refused = 0;
    for (int i = 0; i < 2000; ++i) n_refused += is_refused(damage(legacy), "t.in");
    CHECK(n_refused > 1000);
    CHECK(n_refused < 2000);
}

TEST_CASE("damaged overrides give a scene or problems") {
    Damage damage(23);
    int n_refused = 0;
    const std::vector<std::string> good = {
        "box.size=50",      "discs.list=[[1,2,3,4]]", "time.method=time-stepped",
        "discs.streams=[]", "discs.file='d'",         "time.steps=5"};
    for (int i = 0; i < 2000; ++i)
        n_refused += is_refused(i % 2 == 0 ? toml : legacy, i % 2 == 0 ? "s.toml" : "t.in",
                                {damage(good[static_cast<std::size_t>(i) % 6])});
    CHECK(n_refused > 500);
}
