// SPDX-License-Identifier: BSD-3-Clause
// After an agreement either all ranks throw the same error, or no rank throws. How runs end is
// tested with failing_program.
#include "parallel/agreement.hpp"

#include "catch.hpp"

using carrom::Communicator;
using carrom::ExitCode;
using carrom::Problem;

namespace {

/// The error that `agree` throws, as "code text"; empty if there is none.
std::string agreed(const Communicator& world, bool ok) {
    try {
        carrom::agree(world, ok, "rank " + std::to_string(world.rank()),
                      world.rank() == 1 ? ExitCode::output_failure : ExitCode::collective_failure);
    } catch (const carrom::CollectiveError& error) {
        return std::to_string(static_cast<int>(error.code())) + ' ' + error.what();
    }
    return "";
}

std::vector<Problem> agreed_problems(const Communicator& world, const std::vector<Problem>& mine,
                                     std::size_t most) {
    try {
        carrom::agree_on_problems(world, mine, most);
    } catch (const carrom::InputError& error) {
        return error.problems();
    }
    return {};
}

} // namespace

TEST_CASE("ranks that are all well agree without a word") {
    const Communicator world = Communicator::world();
    CHECK(agreed(world, true).empty());
    CHECK(world.traffic().collectives == 1);
    CHECK(agreed_problems(world, {}, 1000).empty());
}

TEST_CASE("every rank throws the text and code of the lowest failing one") {
    const Communicator world = Communicator::world();
    for (int failing = 0; failing < world.size(); ++failing) {
        const std::string expected = (failing == 1 ? "4 rank " : "3 rank ") +
                                     std::to_string(failing);
        CHECK(agreed(world, world.rank() != failing) == expected);
        CHECK(agreed(world, world.rank() < failing) == expected);
    }
}

TEST_CASE("problems of all ranks reach every rank in rank order") {
    const Communicator world = Communicator::world(16);
    std::vector<Problem> mine, all;
    for (int rank = 0; rank < world.size(); ++rank)
        for (int k = 0; k < (rank + 2) % 3; ++k) {
            const Problem problem = {k == 0 ? "" : "file " + std::to_string(rank), k * 10,
                                     "text\n" + std::to_string(k)};
            all.push_back(problem);
            if (rank == world.rank()) mine.push_back(problem);
        }
    CHECK(agreed_problems(world, mine, 1000) == all);
}

TEST_CASE("too many problems are cut short and counted") {
    const Communicator world = Communicator::world();
    const std::vector<Problem> mine(5, Problem{"a file", world.rank() + 1, "is wrong"});
    const std::vector<Problem> problems = agreed_problems(world, mine, 3);
    const std::string rest = std::to_string(5 * world.size() - 3) + " more problems";
    CHECK(problems == std::vector<Problem>{{"a file", 1, "is wrong"},
                                           {"a file", 1, "is wrong"},
                                           {"a file", 1, "is wrong"},
                                           {"", 0, rest}});
}
