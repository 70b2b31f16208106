// SPDX-License-Identifier: BSD-3-Clause
// Contacts that last from sync to sync (dynamics/contact_impulses.hpp).
//
// Every rank gathers all discs, in order of id, and computes the same impulses. This takes about
// 500 bytes per disc of the run on each rank. The iteration begins with impulses of the previous
// sync, so checkpoints store them, with 32 bytes per contact. While a heap is at rest, its states
// and impulses are bitwise the same at each sync. Then a sync only compares them and computes none.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "dynamics/contact_impulses.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

constexpr std::size_t numbers_of_contact = 4; ///< stored in a checkpoint for each contact

class LastingContacts final : public SyncEffect {
public:
    explicit LastingContacts(const SceneParameters& scene)
        : impulses_(scene.box, per_micro_step(scene),
                    SpeciesTable(scene.effects.species, scene.radius),
                    static_cast<double>(scene.sync_every)) {}

    void act(const SyncDiscs& at) override {
        std::vector<HeapDisc> mine = discs_of(at);
        const bool has_changed = mine != mine_ || kept_ != kept_before_;
        if (at.largest_over_ranks(has_changed ? 1 : 0) > 0) {
            mine_ = std::move(mine);
            gather(at);
            kept_before_ = kept_;
            forces_ = impulses_.act(after_, kept_);
        }
        set_velocities(at);
        note(at);
    }

    std::vector<std::int64_t> kept() const override {
        std::vector<std::int64_t> numbers;
        numbers.reserve(numbers_of_contact * kept_.size());
        for (const KeptImpulse& one : kept_)
            numbers.insert(numbers.end(), {static_cast<std::int64_t>(one.a), one.b,
                                           std::bit_cast<std::int64_t>(one.normal),
                                           std::bit_cast<std::int64_t>(one.tangential)});
        return numbers;
    }
    void go_on(std::span<const std::int64_t> kept) override {
        kept_.clear();
        for (std::size_t k = 0; k + numbers_of_contact <= kept.size(); k += numbers_of_contact)
            kept_.push_back({static_cast<DiscId>(kept[k]), kept[k + 1],
                             std::bit_cast<double>(kept[k + 2]),
                             std::bit_cast<double>(kept[k + 3])});
    }

private:
    /// The discs of this rank in order of id, because `at.discs` is sorted again as cells change.
    static std::vector<HeapDisc> discs_of(const SyncDiscs& at) {
        std::vector<HeapDisc> mine;
        for (std::size_t i = 0; i < at.discs.size(); ++i) {
            const DiscState& disc = at.discs[i];
            if (disc.has_departed()) continue;
            mine.push_back(
                {disc.id, disc.x, disc.y, disc.vx, disc.vy, at.spins.empty() ? 0 : at.spins[i]});
        }
        sort_by_id(mine);
        return mine;
    }
    static void sort_by_id(std::vector<HeapDisc>& discs) {
        std::sort(discs.begin(), discs.end(),
                  [](const HeapDisc& a, const HeapDisc& b) { return a.id < b.id; });
    }
    void gather(const SyncDiscs& at) {
        const std::vector<std::byte> bytes = at.gather_over_ranks(std::as_bytes(std::span(mine_)));
        after_.resize(bytes.size() / sizeof(HeapDisc));
        if (!after_.empty()) std::memcpy(after_.data(), bytes.data(), bytes.size());
        sort_by_id(after_);
    }

    void set_velocities(const SyncDiscs& at) const {
        for (std::size_t i = 0; i < at.discs.size(); ++i) {
            DiscState& disc = at.discs[i];
            if (disc.has_departed()) continue;
            const auto found = std::lower_bound(
                after_.begin(), after_.end(), disc.id,
                [](const HeapDisc& one, DiscId id) { return one.id < id; });
            disc.vx = found->vx;
            disc.vy = found->vy;
            if (!at.spins.empty()) at.spins[i] = found->spin;
        }
    }

    void note(const SyncDiscs& at) const {
        if (at.record_wall)
            for (const WallImpulse& wall : forces_.walls)
                if (wall.normal > 0) at.record_wall(wall);
        if (at.record_pair)
            for (const PairImpulse& pair : forces_.pairs) at.record_pair(pair);
    }

    ContactImpulses impulses_;
    std::vector<KeptImpulse> kept_;
    // The result of the last sync is kept, because the next sync uses it again if it begins with
    // the same states and impulses.
    /// Discs of this rank before the sync, and all discs after it
    std::vector<HeapDisc> mine_, after_;
    std::vector<KeptImpulse> kept_before_;
    LastingForces forces_;
};

bool has_lasting(const SceneParameters& s) { return s.effects.lasting_speed > 0; }

std::vector<Key> keys_of_lasting_contacts() {
    return {
        key("effects.lasting_contacts.speed", "length/step",
            "Discs that approach each other, a wall or an obstacle more slowly than this at a sync "
            "press each other until the next one, and do not bounce. Needs gravity, and discs with "
            "a restitution or rough ones.",
            [](auto& s) -> auto& { return s.effects.lasting_speed; })
            .within({.low = 0}),
    };
}

std::vector<Rule> rules_of_lasting_contacts() {
    const std::string_view lasting = "contacts that last";
    const RuleKeys keys = {"effects.lasting_contacts.speed"};
    return {
        rule(lasting, "no gravity", "nothing presses discs on each other; set effects.gravity",
             keys,
             [](const SceneParameters& s) { return has_lasting(s) && !s.effects.gravity.is_on(); }),
        rule(lasting, "elastic discs, or discs that pass through each other",
             "these never come to rest; take effects.contact.kind = \"restitution\" or \"rough\"",
             keys,
             [](const SceneParameters& s) {
                 const ContactKind kind = s.effects.contact.kind;
                 return has_lasting(s) &&
                        (kind == ContactKind::elastic || kind == ContactKind::none);
             }),
        rule(lasting, "drag or a thermostat",
             "contacts that last need discs that gravity alone presses until the next sync", keys,
             [](const SceneParameters& s) {
                 return has_lasting(s) && (s.effects.drag != 0 || s.effects.thermostat.is_on());
             }),
        rule(lasting, "growing discs, walls that move, or sheared or thermal sides",
             "contacts that last need discs and sides that can lie still", keys,
             [](const SceneParameters& s) {
                 return has_lasting(s) && (has_growing_discs(s) || s.effects.are_sheared() ||
                                           !are_walls_at_rest(s.effects) ||
                                           has_boundary(s.effects, BoundaryKind::thermal));
             }),
    };
}

double smallest_radius_of(const SceneParameters& scene) {
    if (scene.effects.species.empty()) return scene.radius;
    double smallest = scene.effects.species.front().radius;
    for (const Species& one : scene.effects.species) smallest = std::min(smallest, one.radius);
    return smallest;
}

double pull_of(const SceneParameters& scene) {
    return std::hypot(scene.effects.gravity.x, scene.effects.gravity.y);
}

/// The height to which a disc at rest hops between two syncs.
double hop_of(const SceneParameters& scene) {
    const double time = steps_between_syncs(scene);
    return pull_of(scene) * time * time / 8;
}

/// Halves the default time between syncs until the hops of discs at rest are at most a hundredth of
/// the smallest radius high.
void shorten_sync_for_hops(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (!has_lasting(scene) || draft.settings.has("time.sync_every")) return;
    double radius = smallest_radius_of(scene);
    if (const Setting* packing = draft.settings.find("discs.packing");
        packing && !packing->is_wrong && radius == 0 && !scene.sizes && scene.n_discs > 0)
        radius = radius_of_packing(scene, std::get<double>(packing->value.data));
    while (radius > 0 && scene.sync_every > 1 && hop_of(scene) > 0.01 * radius)
        scene.sync_every /= 2;
}

/// Whether discs at rest hop by at most a twentieth of the smallest radius; reports higher hops.
bool check_hops(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const double radius = smallest_radius_of(scene);
    if (!(hop_of(scene) > 0.05 * radius)) return true;
    // gravity.cpp reports discs that fall by more than half the longer edge between syncs; such a
    // fall is four times the height of a hop. It tests each axis alone, so an oblique fall may be
    // sqrt(2) times as long.
    if (hop_of(scene) > std::numbers::sqrt2 / 8 * scene.box.longest()) return false;
    const double most = std::floor(std::sqrt(0.05 * radius / hop_of(scene)) *
                                   static_cast<double>(scene.sync_every));
    draft.refuse({"effects.lasting_contacts.speed", "time.sync_every"},
                 fmt::format("discs at rest fly up by {:.2g} from sync to sync, which is more than "
                             "a twentieth of the smallest radius; {}",
                             hop_of(scene),
                             most >= 1 ? fmt::format("time.sync_every = {} or less will do", most)
                                       : "take more time.micro_steps"));
    return false;
}

/// Checks the speed below which contacts last. If it is too small, discs at rest keep bouncing. If
/// it is too large, discs need partners that are far away, and discs do not bounce in real impacts.
void check_speed(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const double radius = smallest_radius_of(scene), time = steps_between_syncs(scene);
    const double speed = scene.effects.lasting_speed, gained = pull_of(scene) * time,
                 fallen = std::sqrt(2 * pull_of(scene) * radius);
    const std::string remedy = fmt::format("take some {:.1g}", 2 * gained);
    if (speed * time > 2 * radius)
        draft.refuse(
            {"effects.lasting_contacts.speed"},
            fmt::format("discs would look for partners {:.2g} away, which is more than the "
                        "smallest diameter; {}",
                        speed * time, remedy));
    else if (speed < gained)
        scene.warnings.push_back(
            fmt::format("effects.lasting_contacts.speed = {:g} is less than the {:.2g} that "
                        "gravity adds between "
                        "two syncs, so discs at rest bounce on and the run is slow; {}",
                        speed, gained, remedy));
    else if (speed > 2 * fallen)
        scene.warnings.push_back(fmt::format(
            "effects.lasting_contacts.speed = {:g} is more than twice the speed {:.2g} that a disc "
            "has after a fall by the smallest radius: such impacts lose all of their normal "
            "velocity; {}",
            speed, fallen, remedy));
}

/// Warns if forces are not sampled at syncs, because lasting contacts act only at syncs.
void check_samples_of_forces(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (!scene.measurements) return;
    const MeasurementOutput& samples = *scene.measurements;
    const std::int64_t steps = scene.sync_every / std::gcd(scene.sync_every, scene.micro_steps);
    if (samples.every_steps % steps == 0 && samples.from_step % steps == 0) return;
    for (const char* name : {"wall_pressure", "wall_exchange", "pressure", "thermo"}) {
        if (!samples.measures(name)) continue;
        scene.warnings.push_back(fmt::format(
            "rows of \"{}\" have the forces of lasting contacts unevenly, because samples are not "
            "taken at syncs; let output.measurements.every_steps and from_step be multiples of {}",
            name, steps));
        return;
    }
}

/// Warns of very different masses, because the iteration over contacts transfers the weight of a
/// heavy disc only slowly through light discs.
void warn_of_unlike_masses(const SceneDraft& draft) {
    constexpr double most = 100;
    SceneParameters& scene = draft.scene;
    if (scene.effects.species.empty()) return;
    const auto [lightest, heaviest] = std::ranges::minmax(scene.effects.species, {},
                                                          &Species::mass);
    if (heaviest.mass <= most * lightest.mass) return;
    scene.warnings.push_back(fmt::format(
        "the heaviest disc has {:.3g} times the mass of the lightest, and effects.lasting_contacts "
        "are exact to about {:g} times: heavy discs may rest some hundredths of a radius too high "
        "on light ones",
        heaviest.mass / lightest.mass, most));
}

void check_heap(const SceneDraft& draft) {
    if (!has_lasting(draft.scene) || !(smallest_radius_of(draft.scene) > 0)) return;
    if (!draft.knows_syncs() || pull_of(draft.scene) == 0) return; // already reported
    if (check_hops(draft)) check_speed(draft);
    warn_of_unlike_masses(draft);
    check_samples_of_forces(draft);
}

} // namespace

namespace effects {

EffectDeclaration lasting_contacts() {
    return {.tables = {{"effects.lasting_contacts", "Slow contacts that last from sync to sync."}},
            .keys = keys_of_lasting_contacts(),
            .rules = rules_of_lasting_contacts(),
            .derive = shorten_sync_for_hops,
            .check_room = check_heap,
            .summary =
                [](const Effects& e) {
                    return e.lasting_speed > 0
                               ? fmt::format("contacts slower than {:g} last", e.lasting_speed)
                               : "";
                },
            .allowance =
                [](const Effects& e) {
                    return CheckAllowance{.collisions_take_energy = e.lasting_speed > 0,
                                          .acts_at_syncs = e.lasting_speed > 0};
                },
            .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
                if (!has_lasting(s)) return nullptr;
                return std::make_unique<LastingContacts>(s);
            },
            .at_end =
                [](std::span<const std::int64_t> kept) {
                    return std::vector<EndNumber>{
                        {"lasting_contacts", "contacts",
                         "last at the end, of pairs and with walls and obstacles",
                         kept.size() / numbers_of_contact}};
                },
            .reason_without_z =
                [](const Effects& e) {
                    return std::string(
                        e.lasting_speed > 0
                            ? "no Z, because discs at rest have a pressure but no temperature"
                            : "");
                }};
}

} // namespace effects

} // namespace carrom
