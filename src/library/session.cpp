// SPDX-License-Identifier: BSD-3-Clause
#include <exception>

#include "io/start_io.hpp"
#include "library/session_state.hpp"
#include "parallel/agreement.hpp"
#include "parallel/meeting.hpp"

namespace carrom {

namespace {

void join() {
    if (!has_mpi_started())
        throw InputError({{"Session", 0, "MPI does not run; start it before its communicators"}});
    if (has_mpi_ended())
        throw InputError({{"Session", 0, "MPI has ended; it starts once in a process"}});
    join_mpi();
}

std::unique_ptr<Mpi> start() {
    start_io();
    return std::make_unique<Mpi>();
}

} // namespace

Session::Session() {
    if (has_mpi_started()) {
        join();
        state_.reset(new State{nullptr, Communicator::world()});
    } else {
        std::unique_ptr<Mpi> mpi = start();
        state_.reset(new State{std::move(mpi), Communicator::world()});
    }
}

Session::Session(int fortran_communicator) {
    join();
    state_.reset(new State{nullptr, Communicator::of_fortran(fortran_communicator)});
}

Session::~Session() {
    // The program may have ended MPI itself; then no messages can be sent
    if (!has_mpi_ended()) Departure(state_->ranks).leave();
}

std::string Session::mpi_library() { return mpi_version(); }

int Session::rank() const { return state_->ranks.rank(); }
int Session::size() const { return state_->ranks.size(); }

void Session::agree_on(const std::vector<Problem>& problems) const {
    meet(state_->ranks, "Session::agree_on");
    agree_on_problems(state_->ranks, problems);
}

int Session::run(const std::function<int()>& body) const {
    Departure departure(state_->ranks);
    return run_on_all(state_->ends, [&](const Communicator&) {
        try {
            const int code = body();
            departure.leave();
            return code;
        } catch (const std::exception& error) { // other ranks may wait for this one
            departure.leave(error.what());
            throw;
        }
    });
}

} // namespace carrom
