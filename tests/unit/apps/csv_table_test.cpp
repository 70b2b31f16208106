// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <sys/resource.h>

#include "core/errors.hpp"
#include "run/files/csv_table.hpp"

using namespace carrom;

namespace {

constexpr const char* header = "key,number";

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// As long as it exists, a write beyond `size` bytes of any file is an error.
class Limit {
public:
    explicit Limit(rlim_t size) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit small{size, old_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~Limit() {
        setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, before_);
    }
    Limit(const Limit&) = delete;
    Limit& operator=(const Limit&) = delete;

private:
    rlimit old_{};
    void (*before_)(int);
};

/// A file that only this test uses, removed before and afterwards.
class OwnFile {
public:
    explicit OwnFile(std::string path) : path_(std::move(path)) { std::filesystem::remove(path_); }
    ~OwnFile() { std::filesystem::remove(path_); }
    OwnFile(const OwnFile&) = delete;
    OwnFile& operator=(const OwnFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

} // namespace

TEST_CASE("a table that a disk has no room for ends with a whole line, with code 4") {
    const OwnFile file("full_table.csv");
    CsvTable table(file.path(), header);
    table.append("a,1");
    const Limit limit(text_of(file.path()).size() + 2);
    try {
        table.append("b,2");
        FAIL("a line went to a disk without room");
    } catch (const CollectiveError& error) {
        CHECK(error.code() == ExitCode::output_failure);
    }
    CHECK(text_of(file.path()) == "key,number\na,1\n");
}

TEST_CASE("a table is a new file, and there only with its first line") {
    const OwnFile file("new_table.csv");
    {
        CsvTable table(file.path(), header);
        CHECK_FALSE(std::filesystem::exists(file.path()));
        table.append("a,1");
        CHECK(text_of(file.path()) == "key,number\na,1\n");
    }
    CHECK_THROWS_AS(CsvTable(file.path(), header), InputError);
    CHECK(text_of(file.path()) == "key,number\na,1\n");
    CHECK_THROWS_AS(CsvTable("nowhere/table.csv", header), InputError);
    CHECK_THROWS_AS(CsvTable("/dev/null", header), InputError);
}

TEST_CASE("a table does not write over a file that has come meanwhile") {
    const OwnFile file("late_table.csv");
    CsvTable table(file.path(), header);
    std::ofstream(file.path()) << "another one";
    CHECK_THROWS_AS(table.append("a,1"), CollectiveError);
    CHECK(text_of(file.path()) == "another one");
}
