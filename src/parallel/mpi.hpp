// SPDX-License-Identifier: BSD-3-Clause
// Starts and ends a parallel run such that no failure of a rank leaves the other ranks waiting
// (docs/understanding/architecture.md).
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "parallel/communicator.hpp"

namespace carrom {

/// After this call and until `Mpi` is destroyed, a call of `exit` by a library ends all ranks with
/// code 3 and a message. OpenMP and MPI call `exit` if they have too little memory. A program must
/// call guard_exit before it constructs `Mpi`.
void guard_exit();

/// The constructor starts MPI and the destructor ends it. Only the thread that has constructed it
/// may call MPI; a library without MPI_THREAD_FUNNELED is an error. In between, an MPI error or a
/// failed `ensure` prints rank and text and aborts all ranks; if a thread runs out of memory, all
/// ranks abort with code 3. A program constructs one object.
class Mpi {
public:
    enum class Start {
        always,
        under_launcher ///< without a launcher `Communicator::world()` is this process alone
    };

    Mpi(int& argc, char**& argv, Start start = Start::always);
    /// For programs that do not pass their arguments to MPI.
    Mpi();
    ~Mpi();
    Mpi(const Mpi&) = delete;
    Mpi& operator=(const Mpi&) = delete;
};

/// Whether MPI has been started; also true after its end.
bool has_mpi_started();
/// Whether MPI has ended. It cannot be started again.
bool has_mpi_ended();

/// Uses an MPI that another part of the program has started. From now on a failed `ensure` aborts
/// all ranks. Throws InputError if MPI was started without MPI_THREAD_FUNNELED.
void join_mpi();

/// The library's name and version, such as "Open MPI v4.1.4". MPI need not be started.
std::string mpi_version();

/// Prints `text` unchanged and ends all ranks with `code`. For handlers of signals that end the
/// program. If MPI does not end within ten seconds, this process ends itself with `code`.
[[noreturn]] void abort_from_signal(std::string_view text, int code);

/// Runs `body` on every rank and turns exceptions into the exit code of the program. After an
/// InputError rank 0 prints each problem on a line of standard error; the code is 2. After a
/// CollectiveError rank 0 prints it; the code is the error's. After any other exception the rank
/// prints its number and the text, and aborts all ranks. All ranks return the largest code. If
/// other ranks do not reach the same end within `patience_seconds` after an error, all ranks abort:
/// after a CollectiveError with the code of the error, after an InputError with 70. **Collective.**
int run_on_all(const Communicator& communicator,
               const std::function<int(const Communicator&)>& body, double patience_seconds = 30);

} // namespace carrom
