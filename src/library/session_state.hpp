// SPDX-License-Identifier: BSD-3-Clause
// The State of a Session.
#pragma once

#include <memory>

#include <carrom/session.hpp>

#include "parallel/communicator.hpp"
#include "parallel/meeting.hpp"
#include "parallel/mpi.hpp"

namespace carrom {

struct Session::State {
    std::unique_ptr<Mpi> mpi; ///< set if the session has started MPI; destroyed last
    Communicator ranks;
    Communicator ends = duplicate_of(ranks); ///< used when ranks agree on the end of Session::run
};

inline const Communicator& ranks_of(const Session& session) { return session.state().ranks; }

} // namespace carrom
