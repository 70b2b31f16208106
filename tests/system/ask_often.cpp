// SPDX-License-Identifier: BSD-3-Clause
// The exit code of the program for a file in which each bit is flipped in turn. Starting the
// program for each bit would take a hundred times as long.
//   ask_often FILE WORD... <places       WORD...: a command line of the program, as "verify FILE"
// Each line of standard input is a byte and a bit of FILE. The answer is a line with the exit code;
// a signal is negative.
//
// One process tests a batch of bits, and opens files without the child processes in which the
// program inspects them. Each bit for which the code is not 2 is tested again in a process of its
// own, exactly as in the program. All bits of a batch are tested again if its process cannot read
// the undamaged file at the end, because HDF5 may have kept something of a damaged one in memory.
#include <algorithm>
#include <exception>
#include <functional>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/shell/command_line.hpp"
#include "apps/shell/standard_streams.hpp"
#include "io/files.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"

using namespace carrom;

namespace {

constexpr unsigned patience_seconds = 100; ///< limit for one answer
constexpr rlim_t most_memory = rlim_t{4} << 30;
constexpr int not_asked = 1000, found = static_cast<int>(ExitCode::bad_input);
constexpr std::size_t batch_size = 256;

bool is_in_batch = false;

struct Place {
    std::uint64_t byte = 0;
    unsigned bit = 0;
    std::byte whole{}; ///< the undamaged byte
};

std::vector<Place> read_places(const Descriptor& file) {
    std::vector<Place> places;
    for (Place place; std::cin >> place.byte >> place.bit;) {
        if (file.read(std::span(&place.whole, 1), place.byte) != 1)
            throw FileError("has no such byte");
        places.push_back(place);
    }
    return places;
}

void write_at(const Descriptor& file, const Place& place, std::byte value) {
    file.write(std::span(&value, 1), place.byte);
}

int answer(const Action& action) {
    ::alarm(patience_seconds);
    return run_on_all(Communicator::world(), [&action](const Communicator& ranks) {
        const ExitCode code = action.act(ranks);
        finish_standard_output();
        return static_cast<int>(code);
    });
}

/// Calls `act` in a process of its own; returns that process's status.
template <class Act> int in_child(const Act& act) {
    const pid_t child = ::fork();
    if (child == 0) {
        for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
            ::dup2(::open("/dev/null", O_WRONLY), stream);
        act();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

/// The code of each bit, in memory that processes share.
class Answers {
public:
    Answers(const std::vector<Place>& places, const Descriptor& file, const Action& action)
        : places_(places), file_(file), action_(action) {
        void* const shared = ::mmap(nullptr, (places.size() + 1) * sizeof(int),
                                    PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (shared == MAP_FAILED) fail_with_errno("no memory for answers");
        codes_ = {static_cast<int*>(shared), places.size()};
        std::fill(codes_.begin(), codes_.end(), not_asked);
    }

    std::span<const int> all() {
        for (std::size_t first = 0; first < places_.size();) {
            std::size_t end = std::min(first + batch_size, places_.size());
            if (!ask_batch(first, end)) {
                // The bits before a crash are tested once more; the bit that crashes is tested
                // alone.
                const auto begin = codes_.begin() + static_cast<std::ptrdiff_t>(first);
                end = first +
                      static_cast<std::size_t>(std::find(begin, codes_.end(), not_asked) - begin);
                if (end == first || !ask_batch(first, end)) {
                    end = std::max(end, first + 1);
                    std::fill_n(begin, end - first, not_asked);
                }
            }
            for (; first < end; ++first)
                if (codes_[first] != found) ask_alone(first);
        }
        return codes_;
    }
    std::size_t n_alone = 0; ///< number of bits that were tested in processes of their own

private:
    void ask(std::size_t k) {
        const Place& place = places_[k];
        write_at(file_, place, place.whole ^ (std::byte{1} << place.bit));
        const int code = answer(action_);
        write_at(file_, place, place.whole);
        codes_[k] = code;
    }

    /// Whether a process has tested the whole batch, and could read the undamaged file at the end.
    bool ask_batch(std::size_t first, std::size_t end) {
        const int status = in_child([&] { answer_batch(first, end); });
        for (std::size_t k = first; k < end; ++k) write_at(file_, places_[k], places_[k].whole);
        return status == 0;
    }

    void answer_batch(std::size_t first, std::size_t end) {
        is_in_batch = true;
        rlimit limit{};
        ::getrlimit(RLIMIT_AS, &limit);
        limit.rlim_cur = std::min(limit.rlim_max, most_memory);
        ::setrlimit(RLIMIT_AS, &limit);
        for (std::size_t k = first; k < end; ++k) ask(k);
        if (answer(action_) != 0) ::_exit(1);
    }

    void ask_alone(std::size_t k) {
        ++n_alone;
        codes_[k] = not_asked;
        const int status = in_child([&] { ask(k); });
        write_at(file_, places_[k], places_[k].whole);
        if (codes_[k] == not_asked)
            codes_[k] = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    const std::vector<Place>& places_;
    const Descriptor& file_;
    const Action& action_;
    std::span<int> codes_;
};

} // namespace

// The linker redirects calls of `inspect_in_child_first` to the second of these functions; the
// first one is the program's own (`--wrap`). In a unity build calls are not redirected, which is
// only slower.
#define INSPECT "_ZN6carrom22inspect_in_child_firstERKSt8functionIFvvEE"
void inspect_as_program(const std::function<void()>& inspect) asm("__real_" INSPECT);
void inspect_for_batch(const std::function<void()>& inspect) asm("__wrap_" INSPECT);

void inspect_for_batch(const std::function<void()>& inspect) {
    if (!is_in_batch) return inspect_as_program(inspect);
    try {
        inspect();
    } catch (const FileError&) {
        throw;
    } catch (...) {
        throw FileError("is damaged");
    }
}

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    start_io();
    const Mpi mpi(argc, argv, Mpi::Start::under_launcher);
    const std::string path = argv[1];
    argv[1] = argv[0]; // the program's own name must come first
    const Action action = parse_command_line(argc - 1, argv + 1);
    try {
        const Descriptor file(path, O_RDWR);
        const std::vector<Place> places = read_places(file);
        Answers answers(places, file, action);
        for (const int code : answers.all()) std::cout << code << '\n';
        std::cerr << places.size() << " bits, " << answers.n_alone << " asked alone\n";
    } catch (const std::exception& error) {
        std::cerr << path << ": " << error.what() << '\n';
        return 1;
    }
    return 0;
}
