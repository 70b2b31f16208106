// SPDX-License-Identifier: BSD-3-Clause
#include "checked_effects.hpp"

#include <algorithm>

namespace carrom {

namespace {

/// Refuses `key` where it is set, for want of what would make use of it.
void refuse_without(const Check& check, std::string_view key, std::string_view needed) {
    if (const Setting* setting = check.settings.find(key))
        check.refuse(*setting, fmt::format("'{}' has no meaning without {}", key, needed));
}

std::optional<double> number_within(const Check& check, std::string_view key, double low, double high) {
    const auto number = finite_number(check, key);
    if (!number || (*number >= low && *number <= high)) return number;
    check.refuse(*check.settings.find(key), fmt::format("'{}' must be from {} to {}, not {}", key, low, high, *number));
    return std::nullopt;
}

/// Between syncs a disc is as good as touched by the sync: a contact time as long would leave no dissipation at all.
void fill_contact_time(const Check& check) {
    constexpr std::string_view key = "effects.contact.contact_time";
    ContactEffect& contact = check.scene.effects.contact;
    const double longest = static_cast<double>(check.scene.sync_every) / static_cast<double>(check.scene.micro_steps) / 4;
    contact.contact_time = std::min(contact.contact_time, longest);
    const auto time = finite_number(check, key);
    if (!time) return;
    contact.contact_time = *time;
    if (!(*time > 0 && *time <= longest))
        check.refuse(*check.settings.find(key),
                     fmt::format("'{}' must be greater than 0 and at most {} steps, a quarter of the time between syncs ('time.sync_every'), not {}",
                                 key, longest, *time));
}

void fill_contact(const Check& check) {
    static constexpr Choices<ContactKind, 3> kinds = {
        {{"elastic", ContactKind::elastic}, {"none", ContactKind::none}, {"restitution", ContactKind::restitution}}};
    ContactEffect& contact = check.scene.effects.contact;
    if (const auto kind = choice(check, "effects.contact.kind", kinds)) contact.kind = *kind;
    if (contact.kind != ContactKind::restitution) {
        constexpr std::string_view needed = "effects.contact.kind = \"restitution\"";
        refuse_without(check, "effects.contact.restitution", needed);
        refuse_without(check, "effects.contact.contact_time", needed);
        return;
    }
    check.refuse_missing("effects.contact.restitution", "what is left of the normal relative velocity of two discs, from 0 to 1");
    if (const auto restitution = number_within(check, "effects.contact.restitution", 0, 1)) contact.restitution = *restitution;
    fill_contact_time(check);
}

} // namespace

void fill_effects(const Check& check) {
    fill_contact(check);
    if (!check.scene.effects.are_any()) return;
    for (const std::string_view key : {"time.precision", "time.arithmetic", "time.accuracy"}) {
        const Setting* setting = check.settings.find(key);
        const bool is_default = setting && std::holds_alternative<std::string>(setting->value) &&
                                check.scene.precision == Precision::double_ && check.scene.arithmetic == Arithmetic::stable;
        if (setting && !is_default) check.refuse(*setting, fmt::format("'{}' is for scenes without effects, and this one has '[effects]'", key));
    }
}

} // namespace carrom
