// SPDX-License-Identifier: BSD-3-Clause
// Start and end of a parallel run, so that no failure on any rank leaves the others waiting
// (docs/understanding/architecture.md).
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "parallel/communicator.hpp"

namespace carrom {

/// Until `Mpi` ends, all ranks end with code 3 and a message if a library calls `exit`, as OpenMP's
/// and MPI's do where they have too little memory. To be called by a program before `Mpi` begins.
void guard_exit();

/// Holds MPI open. Only the thread that made it talks to other ranks (MPI_THREAD_FUNNELED,
/// checked). From then on an MPI error or a failed `ensure` prints rank and text and aborts all
/// ranks; where memory runs out, on any thread, the code is 3. One per program.
class Mpi {
public:
    enum class Start {
        always,
        under_launcher ///< otherwise `Communicator::world()` is this process alone
    };

    Mpi(int& argc, char**& argv, Start start = Start::always);
    /// For programs that do not pass their arguments to MPI.
    Mpi();
    ~Mpi();
    Mpi(const Mpi&) = delete;
    Mpi& operator=(const Mpi&) = delete;
};

/// Whether MPI has been started; true after its end as well.
bool has_mpi_started();
/// Whether MPI has come to its end. It cannot be started again.
bool has_mpi_ended();

/// Takes part in a run of MPI that another part of the program has started: a failed `ensure`
/// aborts all ranks from now on. Throws InputError where threads are not allowed
/// (MPI_THREAD_FUNNELED).
void join_mpi();

/// The library's name and version, "Open MPI v4.1.4". Needs no started MPI.
std::string mpi_version();

/// Prints `text` as it is and ends all ranks with `code`: for handlers of signals that end the
/// program. Should MPI not come to an end within ten seconds, this process does, with `code`.
[[noreturn]] void abort_from_signal(std::string_view text, int code);

/// Runs `body` on every rank and turns what it throws into an exit code: the program's only try and
/// catch. InputError: rank 0 prints each problem on a line of standard error, 2. CollectiveError:
/// rank 0 prints it, its code. Anything else: prints rank and text, aborts all ranks. All ranks
/// return the largest code of any. Where the other ranks do not come to the same end within
/// `patience_seconds`, a CollectiveError aborts them with its code, an InputError with 70.
/// **Collective.**
int run_on_all(const Communicator& communicator,
               const std::function<int(const Communicator&)>& body, double patience_seconds = 30);

} // namespace carrom
