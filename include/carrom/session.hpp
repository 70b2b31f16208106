// SPDX-License-Identifier: BSD-3-Clause
// The processes that simulate together: one or many MPI ranks. No MPI header is needed.
//
// Make the session before any other object of the library, and destroy it last. "Collective" in
// these headers means that every rank of the session makes the same calls in the same order, with
// equal arguments unless stated otherwise. Make all calls from the thread that made the session.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <carrom/errors.hpp>

namespace carrom {

class Session {
public:
    /// Starts MPI. If the program has started MPI already, all its ranks take part in the session.
    /// A session that started MPI also ends it. Throws InputError if MPI has ended, or was started
    /// without MPI_THREAD_FUNNELED. **Collective** over all processes of the program.
    ///
    /// A session that starts MPI changes the process: a rank that runs out of memory ends all ranks
    /// with code 3, SIGXFSZ is ignored, and HDF5 closes no files at exit, so close yours. A session
    /// in a running MPI changes none of these. No session sets how OpenMP's threads wait. If other
    /// programs use the same cores, set OMP_WAIT_POLICY=passive before the program starts.
    Session();

    /// Makes a session from the ranks of a communicator, which is given by its Fortran handle:
    /// `Session session(MPI_Comm_c2f(comm))`. MPI must be running. The communicator is duplicated.
    /// **Collective** over the communicator's ranks.
    explicit Session(int fortran_communicator);

    ~Session(); ///< **Collective.** Destroy all simulations and files of this session first.
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    int rank() const; ///< rank of this process, 0 to size() - 1
    int size() const; ///< number of ranks
    bool is_root() const { return rank() == 0; }

    /// Name and version of the MPI library; may be called before MPI starts. Communicators of
    /// another MPI library cannot be used.
    static std::string mpi_library();

    /// If any rank has a problem, every rank throws InputError with the problems of all ranks, in
    /// order of rank. A program can thus check its own data before a collective call, which no rank
    /// then makes alone. **Collective.**
    void agree_on(const std::vector<Problem>& problems) const;

    /// Runs `body` on every rank and returns the largest exit code of all ranks, for main. A rank's
    /// code is the result of `body`, or the code of an InputError or CollectiveError, which rank 0
    /// prints to standard error. Any other exception ends all ranks with code 70. **Collective.**
    int run(const std::function<int()>& body) const;

    struct State; ///< used by the library only
    State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

} // namespace carrom
