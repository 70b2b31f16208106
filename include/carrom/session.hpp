// SPDX-License-Identifier: BSD-3-Clause
// The processes that simulate together: one or many MPI ranks. No MPI header is needed.
//
// Make it before any other object of the library, and destroy it last. "Collective" in these
// headers means: every rank of the session makes the same calls in the same order, with equal
// arguments where not said otherwise. All calls come from the thread that made the session.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <carrom/errors.hpp>

namespace carrom {

class Session {
public:
    /// Starts MPI, or takes part in a run of MPI that the program has started: then all its ranks
    /// take part. If the session started MPI, it also ends it. Throws InputError where MPI has
    /// ended, or was started without MPI_THREAD_FUNNELED. **Collective** over all processes of the
    /// program.
    ///
    /// Where it starts MPI, the session changes the process. A rank without memory then ends all
    /// ranks with code 3. SIGXFSZ is ignored. HDF5 closes no files at exit: close your own. If MPI
    /// was already running, it changes none of these. It never sets how OpenMP's threads wait: set
    /// OMP_WAIT_POLICY=passive before the program starts, where other programs use its cores.
    Session();

    /// Takes part with the ranks of one communicator, which the program gives as its Fortran
    /// number: `Session session(MPI_Comm_c2f(comm))`. It is duplicated. MPI must run.
    /// **Collective** over its ranks.
    explicit Session(int fortran_communicator);

    ~Session(); ///< **Collective.** Simulations and files of this session must be gone.
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    int rank() const; ///< of this process: 0 to size() - 1
    int size() const; ///< number of ranks
    bool is_root() const { return rank() == 0; }

    /// The name and version of the MPI library, also before MPI runs. A communicator of another
    /// library cannot be taken.
    static std::string mpi_library();

    /// Runs `body` on every rank and returns an exit code for main: what it returns, the largest of
    /// any rank. InputError and CollectiveError become their codes, and rank 0 prints the text to
    /// standard error. Any other exception ends all ranks with code 70. **Collective.**
    int run(const std::function<int()>& body) const;

    struct State; ///< the library's own
    State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

} // namespace carrom
