// SPDX-License-Identifier: BSD-3-Clause
// What two touching discs do to each other (dynamics/law.hpp).
#include <cmath>

#include <fmt/format.h>

#include "scene/disc_columns.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

const Need lossy_pairs{"without effects.contact.kind = \"restitution\" or \"rough\"",
                       [](const SceneParameters& s) { return are_pairs_lossy(s.effects); }};
const Need rough{"without effects.contact.kind = \"rough\"", [](const SceneParameters& s) {
                     return s.effects.contact.kind == ContactKind::rough;
                 }};
const Need loss_or_gravity{"without discs, walls or obstacles of restitution, a wall that "
                           "oscillates, or gravity",
                           [](const SceneParameters& s) { return lose_energy_or_fall(s.effects); }};
constexpr Range shares{0, 1};

std::vector<Key> keys_of_contact() {
    return {
        key("effects.contact.kind", "",
            "None: discs pass through each other. Restitution: they lose energy. Rough: "
            "they turn and rub, too.",
            [](auto& s) -> auto& { return s.effects.contact.kind; })
            .advises({{"inelastic", "\"restitution\""},
                      {"granular", "\"restitution\" or \"rough\""},
                      {"hertz", "\"restitution\"; discs are hard, and contacts take no time"},
                      {"soft", "\"restitution\"; discs are hard, and contacts take no time"},
                      {"smooth", "\"elastic\" or \"restitution\""},
                      {"frictional", "\"rough\""},
                      {"ideal", "\"none\""}}),
        key("effects.contact.restitution", "1",
            "e, the share of the normal relative velocity that is left.",
            [](auto& s) -> auto& { return s.effects.contact.restitution; })
            .within(shares)
            .needs(lossy_pairs)
            .required(),
        key("effects.contact.tangential_restitution", "1",
            "Share of the sliding velocity that is reversed where surfaces stick, from -1 (smooth) "
            "to 1.",
            [](auto& s) -> auto& { return s.effects.contact.tangential_restitution; })
            .within({-1, 1})
            .needs(rough)
            .required(),
        key("effects.contact.friction", "1", "Coulomb's coefficient; surfaces slide beyond it.",
            [](auto& s) -> auto& { return s.effects.contact.friction; })
            .by_default("no limit")
            .within({0, 1e6})
            .needs(rough),
        key("effects.contact.moment_of_inertia", "m r^2",
            "Moment of inertia of a disc; a uniform one has 0.5.",
            [](auto& s) -> auto& { return s.effects.contact.inertia; })
            .within({1e-6, 1})
            .needs(rough),
        key("effects.contact.contact_time", "steps",
            "A disc that has collided this recently collides elastically, under the event-driven "
            "method. At most a quarter of the time between syncs.",
            [](auto& s) -> auto& { return s.effects.contact.contact_time; })
            .by_default("while two discs close in by a millionth of the sum of their radii, or a "
                        "disc and a wall by a ten-thousandth of the radius")
            .within({.low = 0, .excludes_low = true})
            .needs(loss_or_gravity),
    };
}

std::vector<Rule> rules_of_contacts() {
    return {
        rule("several species", "effects.contact.kind = \"none\"",
             "this version does not have both", {"effects.contact.kind"},
             [](const SceneParameters& s) {
                 return has_species(s) && s.effects.contact.kind == ContactKind::none;
             }),
        rule("spins in discs.columns", "discs that are not rough",
             "spins have no meaning without effects.contact.kind = \"rough\"", {"discs.columns"},
             [](const SceneParameters& s) {
                 return has_column(s, disc_column_of(SideColumn::spin)) && !is_rough(s);
             }),
    };
}

/// A disc does not remember its last collision over a sync, so a contact time must be short
/// compared with the time between syncs.
void check_contact_time(const SceneDraft& draft) {
    limit_contact_time(draft, steps_between_syncs(draft.scene) / 4,
                       "a quarter of the time between syncs ('time.sync_every')");
}

std::string summary_of_contacts(const Effects& effects) {
    const ContactEffect& contact = effects.contact;
    switch (contact.kind) {
    case ContactKind::elastic: return {};
    case ContactKind::none: return "discs pass through each other";
    case ContactKind::restitution:
        return fmt::format("restitution {:g} of pairs", contact.restitution);
    case ContactKind::rough:
        return fmt::format("rough discs of restitution {:g}, tangential {:g}{}",
                           contact.restitution, contact.tangential_restitution,
                           std::isfinite(contact.friction)
                               ? fmt::format(", friction {:g}", contact.friction)
                               : "");
    }
    return {};
}

/// Whether collisions take energy, that of spins included. They do not if surfaces are elastic and
/// either do not rub, or stick without losing energy.
bool take_energy(const ContactEffect& contact) {
    if (contact.kind == ContactKind::restitution) return true;
    const bool keeps_slip = contact.tangential_restitution == -1 ||
                            (contact.tangential_restitution == 1 && std::isinf(contact.friction));
    return contact.kind == ContactKind::rough && !(contact.restitution == 1 && keeps_slip);
}

} // namespace

namespace effects {

EffectDeclaration contact() {
    return {.tables = {{"effects.contact", "What happens when two discs touch."}},
            .keys = keys_of_contact(),
            .rules = rules_of_contacts(),
            .check_times = check_contact_time,
            .summary = summary_of_contacts,
            .allowance =
                [](const Effects& e) {
                    return CheckAllowance{.collisions_take_energy = take_energy(e.contact)};
                },
            .energy = [](const Effects& e) -> std::optional<OtherEnergy> {
                if (!e.have_spins()) return std::nullopt;
                return OtherEnergy{
                    .name = "rotational_energy",
                    .words = "of spin",
                    .value = &Totals::rotational_energy,
                    .of_disc = [](const ShownDisc& disc, const Effects& at, const Box&) {
                        const double speed = disc.spin * disc.has.radius;
                        return 0.5 * at.contact.inertia * disc.has.mass * speed * speed;
                    }};
            },
            .lets_discs_rest = are_pairs_lossy,
            .runs_on_gpu = [](const Effects& e) { return e.contact.kind != ContactKind::rough; }};
}

} // namespace effects

} // namespace carrom
