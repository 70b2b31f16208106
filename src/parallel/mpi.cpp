// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/mpi.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <thread>

#include <mpi.h>
#include <unistd.h>

#include "core/errors.hpp"
#include "core/printable.hpp"
#include "parallel/handle.hpp"
#include "parallel/launcher.hpp"

namespace carrom {

namespace {

constexpr int abort_code = 70;

int world_rank = 0;          // stored, so that any thread can print it without calling MPI
bool is_mpi_running = false; // stored for signal handlers

/// The cause of an exit of this process.
enum class Exit { regular, of_library, of_abort };
std::atomic<Exit> exit_now = Exit::regular;
std::atomic<int> abort_code_now = 0;

/// Ends all ranks, or only this process if MPI is not running.
[[noreturn]] void end_all(int code) {
    abort_code_now = code;
    exit_now = Exit::of_abort;
    if (is_mpi_running) MPI_Abort(MPI_COMM_WORLD, code);
    std::_Exit(code);
}

[[noreturn]] void abort_all(const char* kind, std::string_view text, int code = abort_code) {
    std::fflush(stdout);
    std::fprintf(stderr, "carrom: %s on rank %d: %.*s\n", kind, world_rank,
                 // no allocation, because there may be no memory left
                 static_cast<int>(text.size()), text.data());
    std::fflush(stderr);
    end_all(code);
}

void on_failure(std::string_view text, const char* file, int line) {
    abort_all("internal error", std::string(text) + " (" + file + ':' + std::to_string(line) + ')');
}

/// Runs at the exit of the process, to detect that a library has called `exit`. Libraries of OpenMP
/// and MPI do so with the codes 1 and 2, which in Carrom mean a difference and a wrong input.
void end_after_library() {
    if (exit_now == Exit::regular) return;
    // MPI has not been finalised: Carrom aborts, or a library has called `exit`
    if (exit_now == Exit::of_abort) std::_Exit(abort_code_now);
    abort_all("error",
              "MPI's or OpenMP's library has ended the program, perhaps with a message above; "
              "limits of memory or of threads (ulimit -v, ulimit -u), or settings such as "
              "OMP_STACKSIZE and GOMP_CPU_AFFINITY, may not fit this machine",
              static_cast<int>(ExitCode::collective_failure));
}

/// Aborts all ranks, because exceptions must not leave a parallel region.
void on_no_memory() {
    abort_all("out of memory", "take fewer discs, or more ranks on more nodes",
              static_cast<int>(ExitCode::collective_failure));
}

void on_mpi_error(MPI_Comm*, int* code,
                  ...) { // NOLINT(cert-dcl50-cpp): MPI prescribes the ellipsis
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(*code, text.data(), &length);
    abort_all("MPI error", std::string_view(text.data(), static_cast<std::size_t>(length)));
}

struct Outcome {
    int code = 0;
    std::string text;            ///< text of an error of all ranks; empty if the body returned
    int code_alone = abort_code; ///< the code if other ranks do not reach the same end in time
};

Outcome run(const Communicator& communicator, const std::function<int(const Communicator&)>& body) {
    try {
        return {body(communicator), ""};
    } catch (const InputError& error) {
        return {static_cast<int>(ExitCode::bad_input), error.what()};
    } catch (const CollectiveError& error) {
        // All ranks have agreed on this error, so a late rank is only slow, for example because its
        // disk stalls.
        const int code = static_cast<int>(error.code());
        return {code, error.what(), code};
    } catch (const std::exception& error) {
        abort_all("unexpected error", printable(error.what()));
    } catch (...) {
        abort_all("unexpected error", "an exception of unknown type");
    }
}

/// The largest code of all ranks. Waits without limit after a return, and for
/// `patience_seconds` after an error.
int agreed_code(const Communicator& communicator, const Outcome& outcome, double patience_seconds) {
    if (communicator.handle().is_alone()) return outcome.code;
    int largest = outcome.code;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(&outcome.code, &largest, 1, MPI_INT, MPI_MAX, communicator.handle().comm,
                   &request);
    wait_or_abort(request, outcome.text, patience_seconds, outcome.code_alone);
    return largest;
}

/// Sets parameters of Open MPI unless the user has set them.
void choose_settings() {
    // Open MPI's own MPI-IO hangs in a collective write to a full disk; its ROMIO returns the
    // error.
    setenv("OMPI_MCA_io", "^ompio", 0);
    // Without a launcher Open MPI starts a daemon for further processes, which Carrom never starts.
    // The daemon takes 0.4 s. Open MPI 5 and MPICH start none.
    if (has_launcher()) return;
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    // Processes without a launcher would all make a folder of the same name for shared data, which
    // they do not need. If two start at the same time, one of them would fail.
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
    // Processes without a launcher send no messages, so they need no fast network. Where its
    // libraries are installed, initialising them takes 0.2 s.
    setenv("OMPI_MCA_pml", "ob1", 0);
}

void start_mpi(int* argc, char*** argv) {
    choose_settings();
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    is_mpi_running = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &world_rank);
    set_failure_handler(on_failure);
    std::set_new_handler(on_no_memory);
    if (provided < MPI_THREAD_FUNNELED)
        abort_all("error", "this MPI library does not allow threads");
    abort_on_errors_of(MPI_COMM_WORLD); // duplicates inherit the handler
    abort_on_errors_of(MPI_COMM_SELF);
}

} // namespace

void abort_from_mistake(std::string_view text) { abort_all("error", text); }

void abort_on_errors_of(MPI_Comm comm) {
    MPI_Errhandler handler = MPI_ERRHANDLER_NULL;
    MPI_Comm_create_errhandler(on_mpi_error, &handler);
    MPI_Comm_set_errhandler(comm, handler);
    MPI_Errhandler_free(&handler);
}

void guard_exit() {
    if (std::atexit(end_after_library) == 0) exit_now = Exit::of_library;
}

bool has_mpi_started() {
    int has_started = 0;
    MPI_Initialized(&has_started);
    return has_started != 0;
}

bool has_mpi_ended() {
    int has_ended = 0;
    MPI_Finalized(&has_ended);
    return has_ended != 0;
}

void join_mpi() {
    int provided = MPI_THREAD_SINGLE;
    MPI_Query_thread(&provided);
    if (provided < MPI_THREAD_FUNNELED)
        throw InputError({{"MPI", 0,
                           "was started without threads; start it with MPI_Init_thread and "
                           "MPI_THREAD_FUNNELED or more"}});
    is_mpi_running = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &world_rank);
    set_failure_handler(on_failure);
}

std::string mpi_version() {
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
    int length = 0;
    MPI_Get_library_version(text.data(), &length);
    std::string name(text.data(), static_cast<std::size_t>(length));
    name.resize(std::min(name.find_first_of(",\n"), name.size())); // the rest is not needed
    std::replace(name.begin(), name.end(), '\t', ' ');
    return name;
}

void wait_or_abort(MPI_Request& request, const std::string& failure, double patience_seconds,
                   int code) {
    int is_done = 0;
    const auto start = std::chrono::steady_clock::now();
    const std::chrono::duration<double> patience(patience_seconds);
    auto pause = std::chrono::microseconds(1);
    while (MPI_Test(&request, &is_done, MPI_STATUS_IGNORE) == MPI_SUCCESS && is_done == 0) {
        if (!failure.empty() && std::chrono::steady_clock::now() - start > patience)
            abort_all("error that other ranks did not meet", printable(failure, true), code);
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, std::chrono::microseconds(2000));
    }
}

void abort_from_signal(std::string_view text, int code) {
    static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
    static std::atomic<int> last_code; // atomic, because any thread may run the handler
    last_code = code;
    std::signal(SIGALRM, [](int) { std::_Exit(last_code); });
    sigset_t alarms; // a handler of SIGALRM that calls this runs with SIGALRM blocked
    ::sigemptyset(&alarms);
    ::sigaddset(&alarms, SIGALRM);
    ::sigprocmask(SIG_UNBLOCK, &alarms, nullptr);
    ::alarm(10);
    end_all(code);
}

Mpi::Mpi(int& argc, char**& argv, Start start) {
    set_failure_handler(on_failure);
    std::set_new_handler(on_no_memory);
    if (start == Start::under_launcher && !has_launcher()) return;
    start_mpi(&argc, &argv);
}
Mpi::Mpi() { start_mpi(nullptr, nullptr); }

Mpi::~Mpi() {
    // Another part of the program may have ended MPI
    if (is_mpi_running && !has_mpi_ended()) MPI_Finalize();
    is_mpi_running = false;
    exit_now = Exit::regular;
}

int run_on_all(const Communicator& communicator,
               const std::function<int(const Communicator&)>& body, double patience_seconds) {
    const Outcome outcome = run(communicator, body);
    // Rank 0 prints for all ranks. If it has no error, a rank with an error prints it later.
    if (communicator.is_root() && !outcome.text.empty()) {
        std::fflush(stdout);
        std::fprintf(stderr, "%s\n", printable(outcome.text, true).c_str());
        std::fflush(stderr);
    }
    return agreed_code(communicator, outcome, patience_seconds);
}

} // namespace carrom
