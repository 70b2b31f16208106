// SPDX-License-Identifier: BSD-3-Clause
// Files of discs that all ranks read at the same time, compared with the texts they were made from.
// Error messages are compared with those of a single reader.
#include "catch.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "initial_state/listed_discs.hpp"
#include "parallel/communicator.hpp"
#include "parallel/exchange.hpp"
#include "scene/disc_reader.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

using Texts = std::vector<std::string>;
using Discs = std::vector<InputDisc>;

const Communicator& ranks() {
    static const Communicator world = Communicator::world();
    return world;
}

/// A file that rank 0 writes, and removes at the end. **Collective.**
class ListFile {
public:
    explicit ListFile(const std::string& text)
        : name_(fmt::format("listed_discs_{}.txt", ranks().size())) {
        if (ranks().is_root()) std::ofstream(name_, std::ios::binary) << text;
        ranks().barrier();
    }
    ~ListFile() {
        ranks().barrier();
        if (ranks().is_root()) std::filesystem::remove(name_);
    }
    const std::string& name() const { return name_; }

private:
    std::string name_;
};

SceneParameters scene_of(const std::string& file, std::size_t n_discs) {
    return read_scene(fmt::format("[box]\nsize = 1000\n[discs]\ncount = {}\nradius = 0.5\n"
                                  "file = \"{}\"\n[time]\nsteps = 1\n",
                                  n_discs, file),
                      "scene.toml");
}

/// A line for each of n discs, in an order that mixes the ranks' shares of ids in all parts of the
/// file.
Texts lines_of(std::size_t n) {
    Texts lines;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t id = k * 7 % n;
        lines.push_back(fmt::format("{} {} {} 0.25 {}", id, 1 + 2 * (id % 400), 1 + 2 * (id / 400),
                                    0.125 * static_cast<double>(id % 5)));
    }
    return lines;
}

std::string joined(const Texts& lines, const std::string& end) {
    std::string text;
    for (const std::string& line : lines) text += line + end;
    return text;
}

/// All discs on every rank, by id. Each rank must have read the ids of its share.
Discs read_all(const std::string& text, std::size_t n_discs) {
    const ListFile file(text);
    const SceneParameters scene = scene_of(file.name(), n_discs);
    std::ifstream lines;
    if (ranks().is_root()) lines.open(file.name());
    const Discs mine = read_listed_discs(scene, &lines, ranks(), 2);
    const Slab share = share_of(scene, ranks());
    CHECK(std::ranges::all_of(mine, [&](const InputDisc& disc) {
        return disc.id >= share.begin && disc.id < share.end;
    }));
    std::vector<Discs> out(static_cast<std::size_t>(ranks().size()), mine);
    Discs all = send_to_owners(ranks(), out).items;
    std::ranges::sort(all, {}, &InputDisc::id);
    return all;
}

Discs discs_in(const Texts& lines) {
    Discs discs(lines.size());
    for (const std::string& line : lines) {
        InputDisc disc{};
        std::istringstream words(line);
        words >> disc.id >> disc.x >> disc.y >> disc.vx >> disc.vy;
        discs.at(disc.id) = disc;
    }
    return discs;
}

Texts texts_of(const std::vector<Problem>& problems) {
    Texts texts;
    for (const Problem& problem : problems)
        texts.push_back(fmt::format("{}:{}: {}", problem.place, problem.line, problem.text));
    return texts;
}

Texts problems_on_all(const std::string& text, std::size_t n_discs) {
    try {
        read_all(text, n_discs);
    } catch (const InputError& error) {
        return texts_of(error.problems());
    }
    return {};
}

Texts problems_of_one_reader(const std::string& text, std::size_t n_discs) {
    std::istringstream lines(text);
    const std::string name = fmt::format("listed_discs_{}.txt", ranks().size());
    return texts_of(disc_line_problems(lines, scene_of(name, n_discs)));
}

} // namespace

TEST_CASE("files of discs are read by all ranks, whatever separates their lines") {
    for (const std::size_t n : {1u, 2u, 3u, 10u, 1009u, 150001u}) {
        const Texts lines = lines_of(n);
        const Discs expected = discs_in(lines);
        std::string last_without_end = joined(lines, "\n");
        last_without_end.pop_back();
        INFO(n << " discs");
        CHECK(read_all(joined(lines, "\n"), n) == expected);
        if (n > 2000) continue;
        CHECK(read_all(last_without_end, n) == expected);
        CHECK(read_all(joined(lines, "\r\n"), n) == expected);
        CHECK(read_all(joined(lines, "\n\n \n"), n) == expected);
        CHECK(read_all("\xEF\xBB\xBF" + joined(lines, "\n"), n) == expected);
        CHECK(read_all(joined(lines, "\n") + std::string(1000, '\n'), n) == expected);
        CHECK(read_all(joined(lines, std::string(90, ' ') + "\n"), n) == expected);
    }
}

TEST_CASE("a fault in any part of a file gives the messages of one reader") {
    constexpr std::size_t n = 200;
    const Texts lines = lines_of(n);
    const Texts wrong = {"",
                         "x",
                         "5 1 1 0",
                         "7 1 1 0 0",
                         "200 1 1 0 0",
                         "9 1 1 zero 0",
                         "\xEF\xBB\xBF" + lines[3],
                         std::string(5000, '1')};
    for (std::size_t place = 0; place < n; place += 13) {
        for (const std::string& line : wrong) {
            Texts with_fault = lines;
            with_fault[place] = line;
            const std::string text = joined(with_fault, "\n");
            const Texts expected = problems_of_one_reader(text, n);
            INFO("line " << place << ": " << line.substr(0, 20));
            CHECK(problems_on_all(text, n) == expected);
            // A byte order mark is allowed in the first line, and a line may be unchanged.
            if (!line.starts_with("\xEF") && line != lines[place]) CHECK(!expected.empty());
        }
    }
}

TEST_CASE("files with too many lines are refused as by one reader") {
    Texts lines = lines_of(100);
    for (int k = 0; k < 200; ++k) lines.push_back(lines[static_cast<std::size_t>(k % 100)]);
    const std::string text = joined(lines, "\n");
    const Texts expected = problems_of_one_reader(text, 100);
    CHECK(!expected.empty());
    CHECK(problems_on_all(text, 100) == expected);
}
