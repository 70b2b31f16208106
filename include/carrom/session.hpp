// SPDX-License-Identifier: BSD-3-Clause
// The processes that simulate together: one or many MPI ranks. No MPI header is needed.
//
// Make it before any other object of the library, and destroy it last. "Collective" in these
// headers means that every rank of the session makes the same calls in the same order, with equal
// arguments unless stated otherwise. All calls come from the thread that made the session.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <carrom/errors.hpp>

namespace carrom {

class Session {
public:
    /// Starts MPI. If the program has started MPI already, all its ranks take part in the session.
    /// A session that started MPI also ends it. Throws InputError if MPI has ended, or was started
    /// without MPI_THREAD_FUNNELED. **Collective** over all processes of the program.
    ///
    /// A session that starts MPI changes the process. A rank without memory then ends all ranks
    /// with code 3. SIGXFSZ is ignored. HDF5 closes no files at exit, so close your own. If MPI was
    /// already running, nothing of this changes. A session never sets how OpenMP's threads wait. If
    /// other programs use the same cores, set OMP_WAIT_POLICY=passive before the program starts.
    Session();

    /// Makes a session of the ranks of one communicator, which the program gives as its Fortran
    /// number: `Session session(MPI_Comm_c2f(comm))`. The communicator is duplicated. MPI must run.
    /// **Collective** over its ranks.
    explicit Session(int fortran_communicator);

    ~Session(); ///< **Collective.** Destroy all simulations and files of this session before.
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    int rank() const; ///< rank of this process, 0 to size() - 1
    int size() const; ///< number of ranks
    bool is_root() const { return rank() == 0; }

    /// The name and version of the MPI library, also before MPI runs. Communicators of another
    /// library cannot be used.
    static std::string mpi_library();

    /// Runs `body` on every rank and returns an exit code for main, the largest of all ranks. It is
    /// the result of `body`, or the code of an InputError or CollectiveError, whose text rank 0
    /// prints to standard error. Any other exception ends all ranks with code 70. **Collective.**
    int run(const std::function<int()>& body) const;

    struct State; ///< used by the library only
    State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

} // namespace carrom
