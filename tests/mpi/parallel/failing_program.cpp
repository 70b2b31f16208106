// SPDX-License-Identifier: BSD-3-Clause
// Fails in the way that its argument names: on all ranks, on rank 0, or on the last one while the
// others wait for it.
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <mpi.h>

#include "core/errors.hpp"
#include "parallel/agreement.hpp"
#include "parallel/mpi.hpp"

namespace {

bool is_abort_stuck = false; ///< as if a signal interrupts MPI's own bookkeeping

constexpr double patience_seconds = 1;

/// Delays a rank that leaves by an exception, as a slow disk does while files are removed.
struct LateLeaver {
    ~LateLeaver() {
        if (is_late) std::this_thread::sleep_for(std::chrono::seconds(10));
    }
    bool is_late;
};

int fail_as(const std::string& kind, const carrom::Communicator& communicator) {
    const bool is_last = communicator.rank() + 1 == communicator.size();
    const carrom::InputError input_error({{"scene.toml", 7, "the radius is negative"}});
    if (kind == "input_error") throw input_error;
    if (kind == "collective_error")
        carrom::agree(communicator, !is_last, "the disk is full", carrom::ExitCode::output_failure);
    if (kind == "late_leaver") {
        const LateLeaver leaver{is_last};
        carrom::agree(communicator, !communicator.is_root(), "the disk is full",
                      carrom::ExitCode::output_failure);
    }
    if (kind == "exception" && communicator.is_root()) throw std::runtime_error("out of luck");
    if (kind == "broken_invariant") carrom::ensure(!communicator.is_root(), "two is not three");
    if (kind == "mpi_error") {
        std::string text;
        communicator.broadcast(text, communicator.size());
    }
    if (kind == "different_codes") return communicator.rank() == 1 ? 5 : 0;
    if (kind == "lone_disagreement" && is_last)
        carrom::agree(communicator, false, "the disk is full", carrom::ExitCode::output_failure,
                      patience_seconds);
    if (kind == "no_memory" && is_last)
        return static_cast<int>(std::vector<double>(std::size_t{1} << 59).size());
    if (kind == "stuck_abort" && is_last) {
        is_abort_stuck = true;
        std::signal(SIGALRM, [](int) { carrom::abort_from_signal("the disk is full\n", 4); });
        std::raise(SIGALRM);
    }
    if (kind == "lone_exception" && is_last) throw std::runtime_error("out of luck");
    if (kind == "lone_broken_invariant") carrom::ensure(!is_last, "two is not three");
    if (kind == "lone_input_error" && is_last) throw input_error;
    communicator.barrier();
    return 0;
}

} // namespace

/// Replaces MPI's own function.
extern "C" int MPI_Abort(MPI_Comm communicator, int code) {
    while (is_abort_stuck) std::this_thread::sleep_for(std::chrono::seconds(1));
    return PMPI_Abort(communicator, code);
}

int main(int argc, char** argv) {
    carrom::Mpi mpi(argc, argv);
    const std::string kind = argc > 1 ? argv[1] : "";
    const auto body = [&kind](const carrom::Communicator& communicator) {
        return fail_as(kind, communicator);
    };
    return carrom::run_on_all(carrom::Communicator::world(), body, patience_seconds);
}
