// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/agreement.hpp"

#include <algorithm>
#include <cstdint>

#include "core/printable.hpp"
#include "parallel/exchange.hpp"
#include "parallel/handle.hpp"

namespace carrom {

namespace {

/// The numbers of a problem. Its place and text are sent separately, in one array of characters.
struct PackedProblem {
    std::int64_t line = 0;
    std::uint64_t place_length = 0;
    std::uint64_t text_length = 0;
};

/// Returns all ranks' items on every rank, in rank order.
template <Message T>
std::vector<T> concatenate(const Communicator& communicator, std::vector<T> mine) {
    std::vector<std::vector<T>> out(static_cast<std::size_t>(communicator.size()));
    out.front() = std::move(mine);
    std::vector<T> all = send_to_owners(communicator, out).items;
    communicator.broadcast(all);
    return all;
}

} // namespace

void agree(const Communicator& communicator, bool ok, const std::string& text, ExitCode code,
           double patience_seconds) {
    Communicator::Handle& handle = communicator.handle();
    ++handle.traffic.collectives;
    if (handle.is_alone()) {
        if (!ok) throw CollectiveError(printable(text, true), code);
        return;
    }
    const int mine = ok ? handle.size : handle.rank;
    int failing = mine, agreed_code = static_cast<int>(code);
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(&mine, &failing, 1, MPI_INT, MPI_MIN, handle.comm, &request);
    if (ok)
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    else
        wait_or_abort(request, text, patience_seconds, agreed_code);
    if (failing == handle.size) return;
    std::string agreed_text = text;
    communicator.broadcast(agreed_text, failing);
    communicator.broadcast(agreed_code, failing);
    throw CollectiveError(printable(agreed_text, true), static_cast<ExitCode>(agreed_code));
}

void agree_on_problems(const Communicator& communicator, const std::vector<Problem>& problems,
                       std::size_t most) {
    const std::uint64_t total = communicator.sum(std::uint64_t{problems.size()});
    if (total == 0) return;

    const std::uint64_t before = communicator.sum_before(problems.size());
    const std::size_t room = most > before ? most - before : 0;
    std::vector<PackedProblem> packed;
    std::vector<char> letters;
    for (std::size_t k = 0; k < std::min(room, problems.size()); ++k) {
        const Problem& problem = problems[k];
        packed.push_back({problem.line, problem.place.size(), problem.text.size()});
        letters.insert(letters.end(), problem.place.begin(), problem.place.end());
        letters.insert(letters.end(), problem.text.begin(), problem.text.end());
    }
    letters = concatenate(communicator, std::move(letters));

    std::vector<Problem> agreed;
    auto next = letters.cbegin();
    const auto take = [&next](std::uint64_t length) {
        const auto first = next;
        next += static_cast<std::ptrdiff_t>(length);
        return std::string(first, next);
    };
    for (const PackedProblem& problem : concatenate(communicator, std::move(packed))) {
        const std::string place = take(problem.place_length);
        agreed.push_back({place, problem.line, take(problem.text_length)});
    }
    if (agreed.size() < total)
        agreed.push_back({"", 0, std::to_string(total - agreed.size()) + " more problems"});
    throw InputError(std::move(agreed));
}

void let_root(const Communicator& communicator, const std::function<void()>& work) {
    std::vector<Problem> problems;
    if (communicator.is_root()) {
        try {
            work();
        } catch (const InputError& error) {
            problems = error.problems();
        }
    }
    agree_on_problems(communicator, problems);
}

} // namespace carrom
