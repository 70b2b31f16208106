// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "catch.hpp"
#include <unistd.h>

#include "run/files/data_output.hpp"
#include "run/files/report_file.hpp"

namespace carrom {

namespace {

/// A folder that is removed at the end with its contents.
class ScratchFolder {
public:
    ScratchFolder() { std::filesystem::create_directory(path_); }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    auto n_files() const { return std::distance(std::filesystem::directory_iterator(path_), {}); }

private:
    std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                  ("carrom_test_" + std::to_string(::getpid()));
};

std::string content(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TEST_CASE("a report replaces the file that was there and leaves nothing beside it") {
    const ScratchFolder folder;
    const std::string path = folder.file("report.json");
    CHECK(write_whole_file(path, "first, and longer\n").empty());
    CHECK(write_whole_file(path, "second\n").empty());
    CHECK(content(path) == "second\n");
    CHECK(folder.n_files() == 1);
}

TEST_CASE("places that cannot take a report are found out without a trace") {
    const ScratchFolder folder;
    CHECK(write_problem_of_file(folder.file("report.json")).text.empty());
    CHECK(folder.n_files() == 0);
    CHECK(write_problem_of_file(folder.file("nowhere/report.json")).text.find("No such file") !=
          std::string::npos);
    CHECK(write_problem_of_file(folder.file(".")).text.find("directory") != std::string::npos);
    CHECK(write_problem_of_file("/dev/null").text.find("not a plain file") != std::string::npos);
    CHECK(write_whole_file(folder.file("nowhere/report.json"), "x").find("No such file") !=
          std::string::npos);
}

TEST_CASE("files and links beside a report are left as they are") {
    const ScratchFolder folder;
    const std::string path = folder.file("report.json"), pid = std::to_string(::getpid());
    const std::string victim = folder.file("victim"), left_over = path + ".partial";
    CHECK(write_whole_file(victim, "precious\n").empty());
    CHECK(write_whole_file(left_over, "of another run\n").empty());
    for (const char* number : {"0", "1"})
        std::filesystem::create_symlink(victim, path + '.' + pid + '-' + number + ".partial");
    CHECK(write_problem_of_file(path).text.empty());
    CHECK(write_whole_file(path, "numbers\n").empty());
    CHECK(content(path) == "numbers\n");
    CHECK(content(victim) == "precious\n");
    CHECK(content(left_over) == "of another run\n");
    CHECK(folder.n_files() == 5);
}

TEST_CASE("a file for data is emptied only when it is opened") {
    const ScratchFolder folder;
    const std::string path = folder.file("lines.txt");
    CHECK(write_problem_of_stream(path).text.empty());
    CHECK(folder.n_files() == 0);
    CHECK(write_whole_file(path, "old\n").empty());
    CHECK(write_problem_of_stream(path).text.empty());
    CHECK(content(path) == "old\n");
    CHECK(write_problem_of_stream(folder.file(".")).text.find("cannot be written") !=
          std::string::npos);
    // a wrong path is no failure of the disk
    CHECK_FALSE(write_problem_of_stream(folder.file(".")).is_failure);
    DataOutput output(path);
    output.buffer().append(std::string("new\n"));
    output.flush_if_full();
    CHECK(content(path).empty());
    output.flush();
    output.close();
    CHECK(content(path) == "new\n");
    CHECK(output.failure().empty());
}

TEST_CASE("a full disk is remembered, not fatal") {
    if (!std::filesystem::exists("/dev/full")) return;
    DataOutput output("/dev/full");
    output.buffer().append(std::string("lost\n"));
    output.flush();
    CHECK(output.failure() == "cannot write to /dev/full: No space left on device");
    output.buffer().append(std::string("more\n"));
    output.flush();
    output.close();
    CHECK(output.failure() == "cannot write to /dev/full: No space left on device");
}

} // namespace carrom
