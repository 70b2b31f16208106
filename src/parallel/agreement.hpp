// SPDX-License-Identifier: BSD-3-Clause
// Functions by which ranks learn that one of them has failed: either every rank throws, or none
// does.
//
// Use them for set-up, input and output, but not in steps. Cost without a failure: one reduction.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// If any rank is not `ok`, throws CollectiveError on every rank, with the text and code of the
/// lowest such rank. Other ranks may still be waiting for the failed rank in another operation. If
/// they do not arrive here within `patience_seconds`, the failed rank prints its text and aborts
/// all ranks with its code. **Collective.**
void agree(const Communicator& communicator, bool ok, const std::string& text,
           ExitCode code = ExitCode::collective_failure, double patience_seconds = 30);

/// Throws InputError with the problems of all ranks, in rank order, on
/// every rank, if any rank has one. If there are more than `most` problems,
/// the last one gives the number of omitted problems. **Collective.**
void agree_on_problems(const Communicator& communicator, const std::vector<Problem>& problems,
                       std::size_t most = 1000);

/// Calls `work` on rank 0 only. If it throws InputError, every rank throws InputError.
/// **Collective.**
void let_root(const Communicator& communicator, const std::function<void()>& work);

} // namespace carrom
