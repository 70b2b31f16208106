// SPDX-License-Identifier: BSD-3-Clause
// A folder is replaced by another folder during a write. The write must not create a file in the
// other folder.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "checkpoint_tools.hpp"
#include "io/files.hpp"

using namespace carrom;
using test::TestFolder;
namespace fs = std::filesystem;

namespace {

std::string text_of(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

TEST_CASE("files: a held folder keeps its files when another folder takes its name") {
    const Communicator world = Communicator::world();
    const TestFolder test(world);
    if (!world.is_root()) return;
    const std::string run = test.file("run"), moved = test.file("moved");
    fs::create_directories(run + "/deep");
    auto held = std::make_unique<HeldFolder>(run);
    replace_file(run + "/deep/a", "mine");
    replace_file(run + "//b", "mine"); // paths in scenes may have two slashes
    CHECK(text_of(run + "/deep/a") == "mine");
    CHECK(text_of(run + "/b") == "mine");

    const auto replace = [&] {
        fs::rename(run, moved);
        fs::create_directories(run + "/deep");
        std::ofstream(run + "/deep/a") << "another's";
    };
    // In the first call the folder is replaced after the new file is written, in the second one
    // before the call.
    CHECK_THROWS_AS(replace_file(run + "/deep/a",
                                 [&](const std::string& beside) {
                                     std::ofstream(beside) << "newer";
                                     replace();
                                 }),
                    FileError);
    CHECK_THROWS_AS(replace_file(run + "/deep/a", "newest"), FileError);
    CHECK(text_of(run + "/deep/a") == "another's");
    CHECK(text_of(moved + "/deep/a") == "newer");
    CHECK(std::distance(fs::directory_iterator(run + "/deep"), {}) == 1);

    held.reset();
    replace_file(run + "/deep/a", "after the run");
    CHECK(text_of(run + "/deep/a") == "after the run");
}
