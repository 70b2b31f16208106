// SPDX-License-Identifier: BSD-3-Clause
// How ranks learn that one of them has failed: either every rank throws, or none does.
//
// This is for set-up, input and output, not for the step. Price when all is well: one
// reduction.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Throws CollectiveError on every rank, with text and code of the lowest rank that is not `ok`, if
/// there is one. If the other ranks do not come, because they wait for the failed rank in an
/// operation that it has left, it prints its text after `patience_seconds` and aborts all ranks
/// with its code. **Collective.**
void agree(const Communicator& communicator, bool ok, const std::string& text,
           ExitCode code = ExitCode::collective_failure, double patience_seconds = 30);

/// Throws InputError with the problems of all ranks, in rank order, on every rank, if any rank has
/// one. If there are more than `most` problems, the last one is the number of those left out.
/// **Collective.**
void agree_on_problems(const Communicator& communicator, const std::vector<Problem>& problems,
                       std::size_t most = 1000);

/// Lets rank 0 work alone. If it throws InputError, every rank does. **Collective.**
void let_root(const Communicator& communicator, const std::function<void()>& work);

} // namespace carrom
