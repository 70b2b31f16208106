// SPDX-License-Identifier: BSD-3-Clause
// Gives access to the State of a public object, unless the object was moved from.
#pragma once

#include <memory>
#include <string>

#include "core/errors.hpp"

namespace carrom {

/// Throws InputError if the object has no State because it was moved from. `name` is its class.
template <class State>
State& live_part(const std::unique_ptr<State>& state, const std::string& name) {
    if (!state)
        throw InputError({{name, 0, "was moved from; use the object that it was moved to"}});
    return *state;
}

} // namespace carrom
