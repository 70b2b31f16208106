// SPDX-License-Identifier: BSD-3-Clause
// What a scene asks for beyond free flight, elastic pairs and four elastic walls. Plain numbers: what they do is said where
// it is done (effect_law.hpp and its policies).
#pragma once

#include <string>

namespace carrom {

/// What two discs that touch do to each other.
enum class ContactKind { elastic, none, restitution };

struct ContactEffect {
    ContactKind kind = ContactKind::elastic;
    double restitution = 1;      ///< what is left of the normal relative velocity, 0 to 1
    double contact_time = 0.001; ///< a disc that has collided within this time collides elastically; rule "all" only

    friend bool operator==(const ContactEffect&, const ContactEffect&) = default;
};

/// Times in steps in a scene, in micro-steps in a law.
struct Effects {
    ContactEffect contact;

    bool are_any() const { return contact.kind != ContactKind::elastic; }
    friend bool operator==(const Effects&, const Effects&) = default;
};

/// The same effects with the micro-step, 1/K of a step, as the unit of time.
Effects per_micro_step(const Effects& effects, double micro_steps);

/// One line for a summary, as in "contact restitution 0.9"; empty where there are none.
std::string description(const Effects& effects);

} // namespace carrom
