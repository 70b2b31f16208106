// SPDX-License-Identifier: BSD-3-Clause
// Lines of discs: written and read back, in chunks, and with each kind of error.
#include "catch.hpp"

#include <algorithm>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "problems_of.hpp"
#include "scene/disc_reader.hpp"
#include "scene/line_reader.hpp"

using namespace carrom;
using test::mentions;
using test::places_of;

namespace {

using Texts = std::vector<std::string>;

SceneParameters scene_of(std::uint64_t n_discs) {
    SceneParameters scene;
    scene.name = "t.in";
    scene.lines_before_discs = 5;
    scene.generator = Generator::file;
    scene.box = 10;
    scene.radius = 1;
    scene.n_discs = n_discs;
    return scene;
}

struct Outcome {
    std::vector<InputDisc> discs;
    std::vector<Problem> problems;
};

/// Calls the parts in the wrong order, as threads may do.
void in_three_parts(std::size_t n, const std::function<void(std::size_t, std::size_t)>& work) {
    for (std::size_t k = 3; k-- > 0;) work(n * k / 3, n * (k + 1) / 3);
}

Outcome read_all(const std::string& text, const SceneParameters& scene,
                 std::size_t chunk_size = 1000) {
    std::istringstream stream(text);
    DiscReader reader(stream, scene);
    Outcome outcome;
    std::vector<InputDisc> chunk;
    while (reader.read(chunk, chunk_size, in_three_parts)) {
        CHECK(chunk.size() <= chunk_size);
        outcome.discs.insert(outcome.discs.end(), chunk.begin(), chunk.end());
    }
    outcome.problems = reader.problems();
    return outcome;
}

} // namespace

TEST_CASE("discs come back bit for bit, in any order of ids and any chunks") {
    std::mt19937_64 engine(11);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    std::vector<InputDisc> discs;
    for (DiscId id = 0; id < 20000; ++id)
        discs.push_back({id, uniform(1, 9), uniform(1, 9), uniform(-5, 5), uniform(-1e-9, 1e-9)});
    std::shuffle(discs.begin(), discs.end(), engine);
    std::string text = "\n";
    for (const InputDisc& d : discs)
        text += fmt::format("{} {:.17g} {:.17g}\t{:.17g}  {:.17g}\r\n\n", d.id, d.x, d.y, d.vx,
                            d.vy);
    for (const std::size_t chunk_size :
         {std::size_t{1}, std::size_t{7}, std::size_t{20000}, std::size_t{100000}}) {
        const Outcome outcome = read_all(text, scene_of(20000), chunk_size);
        CHECK(outcome.problems.empty());
        CHECK(outcome.discs == discs);
    }
}

TEST_CASE("each wrong line is one problem, and the good ones are still read") {
    const std::string text = "0 5 5 0 0\n"     // 6
                             "1 5 5 0\n"       // line 7: too few numbers
                             "2 5 5 0 0 7\n"   // line 8: a word too many
                             "3 5 five 0 0\n"  // 9
                             "4 nan 5 0 0\n"   // 10
                             "5 5 5 inf 0\n"   // 11
                             "0 5 5 0 0\n"     // line 12: an id that occurs twice
                             "99 5 5 0 0\n"    // line 13: an id out of range
                             "-1 5 5 0 0\n"    // 14
                             "x 5 5 0 0\n"     // 15
                             "6 0.999 5 0 0\n" // line 16: outside of the box
                             "7 5 9.001 0 0\n" // line 17: outside of the box
                             "1.0 5 5 0 0\n"   // 18
                             "8 5 5 1e100 0\n" // line 19: too fast
                             "99999999999999999999999 5 5 0 0\n"; // 20
    const Outcome outcome = read_all(text, scene_of(12));
    CHECK(outcome.discs == std::vector<InputDisc>{{0, 5, 5, 0, 0}});
    Texts places;
    for (int line = 7; line <= 20; ++line) places.push_back(fmt::format("t.in:{}", line));
    places.push_back("t.in");
    CHECK(places_of(outcome.problems) == places);
    CHECK(mentions(outcome.problems, "3 of 12 discs are missing: 9-11"));
}

TEST_CASE("a file of discs counts its lines from its own start and is named with its folder") {
    SceneParameters scene = scene_of(1);
    scene.name = "folder/s.toml";
    scene.discs_file = "d.txt";
    CHECK(places_of(read_all("\n0 5 5\n", scene).problems) == Texts{"folder/d.txt:2"});
}

TEST_CASE("discs of another run have no lines, so problems name the discs") {
    SceneParameters scene = scene_of(4);
    scene.name = "folder/s.toml";
    scene.lines_before_discs = 0;
    scene.discs_from = "c.h5";
    const Outcome outcome = read_all("0 5 5 0 0\n1 nan 5 0 0\n2 5 0.5 0 0\n3 5 5 0 inf\n", scene);
    CHECK(places_of(outcome.problems) == Texts{"folder/c.h5", "folder/c.h5", "folder/c.h5"});
    CHECK(mentions(outcome.problems, "disc 1: the position nan is not a finite number"));
    CHECK(mentions(outcome.problems, "disc 2 at (5, 0.5) is not inside the box"));
    CHECK(mentions(outcome.problems, "disc 3: the velocity inf is not a finite number"));
    std::string text;
    for (int i = 0; i < 30; ++i) text += fmt::format("{} 0 0 0 0\n", i);
    scene.n_discs = 30;
    CHECK(read_all(text, scene).problems.back().text == "and 10 more discs with problems");
}

TEST_CASE("of many problems the first 20 are listed and the rest are counted") {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += fmt::format("{} 0 0 0 0\n", i);
    const Outcome outcome = read_all(text, scene_of(1000));
    CHECK(outcome.problems.size() == 21);
    CHECK(outcome.problems.back().text == "and 980 more lines with problems");
}

TEST_CASE("missing ids are summed up as ranges") {
    CHECK(read_all("", scene_of(7)).problems ==
          std::vector<Problem>{{"t.in", 0, "7 of 7 discs are missing: 0-6"}});
    CHECK(read_all("0 5 5 0 0\n2 5 5 0 0\n", scene_of(3)).problems ==
          std::vector<Problem>{{"t.in", 0, "1 of 3 discs is missing: 1"}});
    CHECK(read_all("1 5 5 0 0\n3 5 5 0 0\n", scene_of(7)).problems ==
          std::vector<Problem>{{"t.in", 0, "5 of 7 discs are missing: 0, 2, 4-6"}});
    std::string text;
    for (int i = 1; i < 100; i += 2) text += fmt::format("{} 5 5 0 0\n", i);
    CHECK(read_all(text, scene_of(100)).problems ==
          std::vector<Problem>{
              {"t.in", 0, "50 of 100 discs are missing: 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, ..."}});
}

TEST_CASE("a centre may be off the range of centres by the rounding of L, not more") {
    SceneParameters scene = scene_of(1);
    scene.radius = 0.1;
    const double high = scene.box.x - scene.radius;
    const auto n_problems = [&](double x) {
        return read_all(fmt::format("0 {:.17g} 5 0 0\n", x), scene).problems.size();
    };
    CHECK(n_problems(0.1) == 0);
    CHECK(n_problems(high) == 0);
    CHECK(n_problems(std::nextafter(high, 20)) == 0);
    CHECK(n_problems(std::nextafter(0.1, 0)) == 0);
    CHECK(n_problems(high + 1e-14) == 1);
    CHECK(n_problems(0.1 - 1e-14) == 1);
    scene.radius = 5;
    CHECK(n_problems(5) == 0); // a disc of radius L/2 just fits
}

TEST_CASE("lines are cut, not swallowed, when they have no end") {
    const std::string text = "0 5 5 0 0\n" + std::string(3'000'000, '7') + "\n1 5 5 0 0\n" +
                             std::string(5000, ' ');
    const Outcome outcome = read_all(text, scene_of(2));
    CHECK(outcome.discs.size() == 2);
    CHECK(places_of(outcome.problems) == Texts{"t.in:7", "t.in:9"});
}

TEST_CASE("all that is wrong with a line is told") {
    const Outcome outcome = read_all("0 five 5 0 six 7\n1 nan 5 inf 0\n", scene_of(2));
    CHECK(places_of(outcome.problems) == Texts{"t.in:6", "t.in:7"});
    CHECK(mentions(outcome.problems,
                   "'five' is not a number; 'six' is not a number; '7' after the 5 numbers"));
    CHECK(mentions(outcome.problems,
                   "the position nan is not a finite number; the velocity inf is not"));
}

TEST_CASE("a line that does not end, and lines that are never right, end the reading") {
    struct Endless : std::streambuf {
        explicit Endless(std::string text) : text_(std::move(text)) {}
        int_type underflow() override {
            n_blocks += 1;
            setg(text_.data(), text_.data(), text_.data() + text_.size());
            return traits_type::to_int_type(text_[0]);
        }
        std::string text_;
        std::size_t n_blocks = 0;
    };
    const auto problems_with = [](Endless& source) {
        std::istream stream(&source);
        const SceneParameters scene = scene_of(2);
        DiscReader reader(stream, scene);
        std::vector<InputDisc> chunk;
        while (reader.read(chunk, 1000)) {
        }
        return reader.problems();
    };
    Endless zeros(std::string(1 << 16, '\0'));
    CHECK(mentions(problems_with(zeros), "does not end"));
    CHECK(zeros.n_blocks <= (LineReader::most_skipped >> 16) + 16);
    std::string lines;
    for (int i = 0; i < 1000; ++i) lines += "y\n";
    Endless words(lines);
    CHECK(mentions(problems_with(words), "it was not read beyond them"));
    CHECK(words.n_blocks <= DiscReader::most_wrong_lines / 1000 + 1000);
}

TEST_CASE("a file of discs may begin with a mark of the byte order") {
    SceneParameters scene = scene_of(1);
    scene.discs_file = "d.txt";
    CHECK(read_all("\xef\xbb\xbf"
                   "0 5 5 0 0\n",
                   scene)
              .problems.empty());
}

TEST_CASE("the line reader agrees with getline on any lengths of lines") {
    std::mt19937_64 engine(3);
    std::string text;
    for (int i = 0; i < 3000; ++i) text += std::string(engine() % 4097, 'a') + '\n';
    text += "last";
    std::istringstream stream(text), plain(text);
    LineReader reader(stream, 0);
    std::string_view line;
    std::string expected;
    std::int64_t n_lines = 0;
    bool all_equal = true;
    while (std::getline(plain, expected)) {
        all_equal = all_equal && reader.next(line) && line == expected && !reader.is_cut() &&
                    reader.line_number() == ++n_lines;
    }
    CHECK(all_equal);
    CHECK_FALSE(reader.next(line));
}

TEST_CASE("lines of a scene that is wrong itself are looked at as far as it is known") {
    const auto places = [](const std::string& text, const SceneParameters& scene) {
        std::istringstream stream(text);
        return places_of(disc_line_problems(stream, scene));
    };
    const std::string text = "0 3 3 1\n1 99 7 0 0\n1 4 4 4 4\n7 4 4 0 0\n4294967293 4 4 0 "
                             "0\n4294967294 4 4 0 0\nx 1 1 1 1\n3 nan 4 0 0\n";
    SceneParameters scene = scene_of(5);
    CHECK(places(text, scene) == Texts{"t.in:6", "t.in:7", "t.in:8", "t.in:9", "t.in:10", "t.in:11",
                                       "t.in:12", "t.in:13", "t.in"});
    scene.n_discs = 0; // with an unknown number of discs, no id is missing
    CHECK(places(text, scene) ==
          Texts{"t.in:6", "t.in:7", "t.in:8", "t.in:11", "t.in:12", "t.in:13"});
    scene.box = {};
    scene.radius = 0; // without a valid box, any finite position is accepted
    CHECK(places(text, scene) == Texts{"t.in:6", "t.in:8", "t.in:11", "t.in:12", "t.in:13"});
    CHECK(places("1 4 4 0 0\n0 3 3 0 0\n", scene).empty());
}
