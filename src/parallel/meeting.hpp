// SPDX-License-Identifier: BSD-3-Clause
// Ranks meet before a call that all of them must make, and compare what they call. So if a rank
// calls another function or has left, the result is an error message instead of a hang. Cost: one
// small reduction for each call.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "parallel/communicator.hpp"

namespace carrom {

/// A hash of an argument. `meet` compares the hashes of all ranks, to detect different arguments.
std::uint64_t hash_of_argument(std::string_view text);

/// Returns when all ranks have reached the same call. Throws InputError on every rank if calls or
/// arguments differ, or if MPI has ended. If a rank has departed, all ranks abort with a message
/// (code 70) after ten seconds. **Collective.**
void meet(const Communicator& communicator, std::string_view call, std::uint64_t argument = 0);

/// Informs the other ranks that this rank leaves. The destructor waits until they leave, too.
class Departure {
public:
    /// `communicator` must outlive this.
    explicit Departure(const Communicator& communicator);
    /// Waits until every other rank has called `leave` or has begun to destroy its own Departure.
    /// **Collective.**
    ~Departure();
    Departure(const Departure&) = delete;
    Departure& operator=(const Departure&) = delete;

    /// From now on this rank makes no collective call. Ranks that wait for it print `reason`. Not
    /// collective.
    void leave(const std::string& reason = {});

private:
    struct Messages;
    const Communicator& communicator_;
    std::unique_ptr<Messages> messages_;
};

/// A communicator with the same ranks, whose messages do not mix with those of the original. Ranks
/// that have called Departure::leave use it to agree on the end of a run, because other ranks may
/// still wait in calls that use the original.
Communicator duplicate_of(const Communicator& communicator);

} // namespace carrom
