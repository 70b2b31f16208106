// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <sys/resource.h>

#include "apps/csv_table.hpp"
#include "core/errors.hpp"

using namespace carrom;

namespace {

const CsvTable::Layout layout{"key,number,origin", 1, 1, "here"};

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// While it is there no file grows beyond `size` bytes: a write beyond is an error.
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

/// A file of this test's own, gone before and after.
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

TEST_CASE("A table that a disk has no room for ends with a whole line, with code 4, and is gone on "
          "with") {
    const OwnFile file("full_table.csv");
    const std::string& path = file.path();
    {
        CsvTable table(path, layout);
        table.append("a", "1");
        const Limit limit(text_of(path).size() + 4);
        try {
            table.append("b", "2");
            FAIL("a line went to a disk without room");
        } catch (const CollectiveError& error) {
            CHECK(error.code() == ExitCode::output_failure);
        }
        CHECK_FALSE(table.has("b"));
        CHECK(text_of(path) == "key,number,origin\na,1,here\n");
    }
    CsvTable table(path, layout);
    CHECK((table.has("a") && !table.has("b")));
    table.append("b", "2");
    CHECK(text_of(path) == "key,number,origin\na,1,here\nb,2,here\n");
}

TEST_CASE("A table drops half a line and half a header, and nothing else") {
    const OwnFile file("cut_table.csv");
    const std::string& path = file.path();
    const std::string whole = "key,number,origin\na,1,here\nb,2,there\n";
    for (std::size_t size = 0; size <= whole.size(); ++size) {
        std::ofstream(path, std::ios::binary) << whole.substr(0, size);
        const CsvTable table(path, layout);
        CAPTURE(size);
        const bool has_a = size >= 27, has_b = size == whole.size();
        CHECK((table.has("a") == has_a && table.has("b") == has_b));
        CHECK(table.n_foreign() == (has_b ? 1 : 0));
    }
    for (const std::string text :
         {"something else", "key,number,origin,more\na,1,here\n", "key,number,origin\na,1\n"}) {
        std::ofstream(path, std::ios::binary) << text;
        CHECK_THROWS_AS(CsvTable(path, layout), InputError);
        CHECK(text_of(path) == text);
    }
}
