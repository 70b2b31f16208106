// SPDX-License-Identifier: BSD-3-Clause
// Functions by which ranks learn that one of them has failed: either every rank throws, or none
// does.
//
// They are for set-up, input and output, not for the step. Price without a failure: one reduction.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Throws CollectiveError on every rank, with text and code of the lowest rank that is not `ok`, if
/// there is one. Other ranks may wait for the failed rank in an operation that it has left. If they
/// do not arrive here within `patience_seconds`, the failed rank prints its text and aborts all
/// ranks with its code. **Collective.**
void agree(const Communicator& communicator, bool ok, const std::string& text,
           ExitCode code = ExitCode::collective_failure, double patience_seconds = 30);

/// Throws InputError with the problems of all ranks, in rank order, on
/// every rank, if any rank has one. If there are more than `most` problems,
/// the last one gives the number of omitted problems. **Collective.**
void agree_on_problems(const Communicator& communicator, const std::vector<Problem>& problems,
                       std::size_t most = 1000);

/// Lets rank 0 work alone. If it throws InputError, every rank does. **Collective.**
void let_root(const Communicator& communicator, const std::function<void()>& work);

} // namespace carrom
