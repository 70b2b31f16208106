// SPDX-License-Identifier: BSD-3-Clause
// Whatever is written over a file after a commit, rolling back gives the bytes of that commit, also
// when the journal or the rolling back was cut short.
#include "io/undo_journal.hpp"

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "catch.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "io/files.hpp"

using namespace carrom;

namespace {

class TestFolder {
public:
    TestFolder() : path_("/tmp/carrom_journal_test_" + std::to_string(::getpid())) {
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() { std::filesystem::remove_all(path_); }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    std::string file(const char* name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

std::string noise(std::size_t size, std::mt19937& random) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    return bytes;
}

/// Writes over random ranges, most of them inside the first `size` bytes, as a driver does.
void scribble(const std::string& path, UndoJournal& journal, std::size_t size, int n_writes,
              std::mt19937& random) {
    const Descriptor file(path, O_RDWR);
    for (int k = 0; k < n_writes; ++k) {
        const std::string bytes = noise(1 + random() % 9000, random);
        const std::uint64_t place = random() % (size + 3000);
        journal.keep(file.number(), place, bytes.size());
        file.write(std::as_bytes(std::span(bytes)), place);
    }
}

} // namespace

TEST_CASE("rolling back gives the bytes of the last commit") {
    const TestFolder folder;
    const std::string path = folder.file("a");
    std::mt19937 random(3210);
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{4095},
                                   std::size_t{4096}, std::size_t{4097}, std::size_t{50001}}) {
        const std::string good = noise(size, random);
        write(path, good);
        UndoJournal journal(path);
        journal.commit(size);
        scribble(path, journal, size, 30, random);
        CHECK(bytes_of(path) != good);
        roll_back(path);
        CHECK((bytes_of(path) == good ||
               size == 0)); // a journal that has nothing to keep cuts nothing off
        roll_back(path);
        CHECK((bytes_of(path) == good || size == 0));
        CHECK(!std::filesystem::exists(path + ".undo"));
    }
}

TEST_CASE("a later commit is what counts") {
    const TestFolder folder;
    const std::string path = folder.file("a");
    std::mt19937 random(1);
    write(path, noise(20000, random));
    UndoJournal journal(path);
    journal.commit(20000);
    scribble(path, journal, 20000, 5, random);
    const std::string good = bytes_of(path);
    journal.commit(good.size());
    CHECK(!std::filesystem::exists(path + ".undo"));
    scribble(path, journal, good.size(), 5, random);
    roll_back(path);
    CHECK(bytes_of(path) == good);
}

TEST_CASE("a journal that was cut short puts back what it has, and a damaged record ends it") {
    const TestFolder folder;
    const std::string path = folder.file("a");
    std::mt19937 random(2);
    const std::string good = noise(6 * 4096, random);
    write(path, good);
    UndoJournal journal(path);
    journal.commit(good.size());
    {
        const Descriptor file(path, O_RDWR);
        for (std::uint64_t block = 0; block < 3; ++block) {
            journal.keep(file.number(), block * 4096, 1);
            file.write(std::as_bytes(std::span("x", 1)), block * 4096);
        }
        journal.keep(file.number(), 4 * 4096,
                     1); // kept, and the process is killed before it writes
    }
    const std::string whole_journal = bytes_of(path + ".undo"), damaged = bytes_of(path);
    write(path + ".undo", whole_journal.substr(0, whole_journal.size() - 100));
    roll_back(path);
    CHECK(bytes_of(path) == good);

    write(path, damaged);
    std::string flipped = whole_journal;
    flipped[flipped.size() / 2 + 500] ^= 1; // in the third of four records
    write(path + ".undo", flipped);
    roll_back(path);
    CHECK(bytes_of(path).substr(0, 2 * 4096) == good.substr(0, 2 * 4096));
    CHECK(bytes_of(path).size() == good.size());
}
