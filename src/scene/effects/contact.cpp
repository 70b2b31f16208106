// SPDX-License-Identifier: BSD-3-Clause
// The collision of two discs (dynamics/law.hpp).
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "scene/contact_rows.hpp"
#include "scene/disc_columns.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"
#include "scene/species_rows.hpp"

namespace carrom {

namespace {

const Need lossy_pairs{"without effects.contact.kind = \"restitution\" or \"rough\"",
                       [](const SceneParameters& s) { return are_pairs_lossy(s.effects); }};
const Need rough{"without effects.contact.kind = \"rough\"", [](const SceneParameters& s) {
                     return s.effects.contact.kind == ContactKind::rough;
                 }};
const Need loss_or_fall{
    "without collisions that take or give energy, or a force that discs fall in",
    [](const SceneParameters& s) { return lose_energy_or_fall(s.effects); }};
const Need rows_of_lossy_discs{
    "without 'discs.species' and effects.contact.kind = \"restitution\" or \"rough\"",
    [](const SceneParameters& s) {
        return are_pairs_lossy(s.effects) && !s.effects.contact.rows.empty();
    }};
constexpr Range shares{0, 1};
constexpr std::size_t most_rows = 100; ///< most rows of species; tables have most_rows^2 pairs

/// The indices of the numbers in a row of `effects.contact.pairs`.
namespace pair_row {
constexpr std::size_t first = 0, second = 1, restitution = 2;
} // namespace pair_row

Key key_of_pairs() {
    std::vector<Field> fields = {{"species", "[i, j]", 2, 2}};
    for (const Field& one : contact_fields()) fields.push_back(one);
    Key pairs = key("effects.contact.pairs", "1, 1, 1, 1",
                    "Other numbers for contacts between discs of two rows of 'discs.species', "
                    "counted from 1; the order of the two does not matter. Numbers that a row "
                    "leaves out are those of all pairs.",
                    [](auto& s) -> auto& { return s.effects.contact.pairs; })
                    .by_default("none")
                    .needs(rows_of_lossy_discs)
                    .with_rows(fields);
    pairs.compare = [](const SceneParameters& a, const SceneParameters& b) {
        return a.effects.contact.pairs == b.effects.contact.pairs;
    };
    return pairs;
}

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
        key_of_pairs(),
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
            .needs(loss_or_fall),
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

std::string problem_of_pair(const Numbers& row, std::size_t n_rows, bool are_rough) {
    for (const std::size_t place : {pair_row::first, pair_row::second})
        if (!is_species_row(row[place], n_rows))
            return fmt::format("its species must be rows of 'discs.species', from 1 to {}, not {}",
                               n_rows, row[place]);
    return problem_of_contact_numbers(row, pair_row::restitution,
                                      are_rough ? "" : "effects.contact.kind = \"rough\"");
}

void check_pairs(const SceneDraft& draft) {
    const std::optional<std::size_t> n_rows = count_species_rows(draft);
    if (!n_rows || !draft.settings.has("effects.contact.pairs")) return;
    if (*n_rows > most_rows)
        return draft.refuse({"effects.contact.pairs"},
                            fmt::format("'effects.contact.pairs' takes {} rows of 'discs.species' "
                                        "at most, and there are {}",
                                        most_rows, *n_rows));
    std::map<std::pair<double, double>, std::size_t> known;
    draft.refuse_rows("effects.contact.pairs", [&](const Numbers& row, std::size_t k) {
        const std::string text = problem_of_pair(row, *n_rows, is_rough(draft.scene));
        if (!text.empty()) return text;
        const auto [found, is_new] = known.emplace(
            std::minmax(row[pair_row::first], row[pair_row::second]), k + 1);
        return is_new ? "" : fmt::format("row {} has this pair already", found->second);
    });
}

/// Checks that the contact time is short compared with the time between syncs, because a sync
/// deletes the time of a disc's last collision.
void check_contact_time(const SceneDraft& draft) {
    limit_contact_time(draft, steps_between_syncs(draft.scene) / 4,
                       "a quarter of the time between syncs ('time.sync_every')");
}

std::string summary_of_contacts(const Effects& effects) {
    const ContactEffect& contact = effects.contact;
    const std::string others = contact.pairs.empty() ? ""
                                                     : fmt::format(", with {} of other numbers",
                                                                   contact.pairs.size());
    switch (contact.kind) {
    case ContactKind::elastic: return {};
    case ContactKind::none: return "discs pass through each other";
    case ContactKind::restitution:
        return fmt::format("restitution {:g} of pairs{}", contact.restitution, others);
    case ContactKind::rough:
        return fmt::format(
            "rough discs of restitution {:g}, tangential {:g}{}{}", contact.restitution,
            contact.tangential_restitution,
            std::isfinite(contact.friction) ? fmt::format(", friction {:g}", contact.friction) : "",
            others);
    }
    return {};
}

/// Whether collisions may reduce the sum of kinetic and rotational energy. Rough discs of
/// restitution 1 conserve it if they slide without friction, or if each collision reverses all of
/// the sliding velocity.
bool take_energy(const ContactEffect& contact) {
    if (contact.kind == ContactKind::restitution) return true;
    if (contact.kind != ContactKind::rough) return false;
    const auto keeps_all = [](double restitution, double tangential, double friction) {
        const bool keeps_slip = tangential == -1 || (tangential == 1 && std::isinf(friction));
        return restitution == 1 && keeps_slip;
    };
    const auto number_of = [](double given, double common) {
        return std::isnan(given) ? common : given;
    };
    return !keeps_all(contact.restitution, contact.tangential_restitution, contact.friction) ||
           !std::ranges::all_of(contact.pairs, [&](const ContactPair& pair) {
               return keeps_all(
                   number_of(pair.restitution, contact.restitution),
                   number_of(pair.tangential_restitution, contact.tangential_restitution),
                   number_of(pair.friction, contact.friction));
           });
}

} // namespace

namespace effects {

EffectDeclaration contact() {
    return {.tables = {{"effects.contact", "What happens when two discs touch."}},
            .keys = keys_of_contact(),
            .rules = rules_of_contacts(),
            .check_times = check_contact_time,
            .check_room = check_pairs,
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
            .runs_on_gpu =
                [](const Effects& e) {
                    return e.contact.kind != ContactKind::rough && e.contact.pairs.empty();
                }};
}

} // namespace effects

} // namespace carrom
