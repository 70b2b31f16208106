// SPDX-License-Identifier: BSD-3-Clause
// A field constant in time (dynamics/external_field.hpp) acts by kicks at syncs: half a kick, a
// flight from sync to sync, half a kick (G. Strang, SIAM J. Numer. Anal. 5, 506 (1968)). Half a
// kick is v -= (t / 2) grad V / m, with the position at the sync and the time t between syncs.
//
// The map is symplectic and reversible, so free discs conserve an energy that differs from m v^2 /
// 2 + V by a fraction of at most (w t)^2 / 4, with w^2 = V'' / m, and energy does not drift. In a
// trap the disc stays exactly on an ellipse, with the frequency w (1 + (w t)^2 / 24 + ...). Outputs
// at a sync contain the state between the two half kicks. At other times they contain the velocity
// in flight, which is accurate only midway between two syncs.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "scene/effects/effect.hpp"
#include "scene/grid_file.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

template <>
inline constexpr std::array words_of<FieldKind>{
    Word{"none", FieldKind::none}, Word{"trap", FieldKind::trap}, Word{"sine", FieldKind::sine},
    Word{"grid", FieldKind::grid}};

namespace {

constexpr std::size_t most_values = std::size_t{1} << 18, most_strengths = 4096;
/// Largest w t (see above) where the field curves most: for the default time between syncs, without
/// a warning, and without an error. Beyond the last one, orbits differ completely from true ones.
constexpr double usual_turn = 0.05, large_turn = 0.5, largest_turn = 1;

class FieldAtSyncs final : public SyncEffect {
public:
    explicit FieldAtSyncs(const SceneParameters& scene)
        : field_(per_micro_step(scene).field), box_(scene.box),
          half_(0.5 * static_cast<double>(scene.sync_every)) {}

    void act(const SyncDiscs& at) override { kick(at); }
    bool begins() const override { return true; }
    void begin(const SyncDiscs& at) override { kick(at); }

private:
    void kick(const SyncDiscs& at) const {
        at.in_parts([&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                DiscState& disc = at.discs[i];
                if (disc.has_departed()) continue;
                const FieldPoint point = field_.at(disc.x, disc.y, box_);
                const double factor = half_ * field_.strength_of(disc.id) /
                                      at.species.of(disc.id).mass;
                disc.vx -= factor * point.slope_x;
                disc.vy -= factor * point.slope_y;
            }
        });
    }

    ExternalField field_;
    Box box_;
    double half_; ///< half of the time between syncs
};

using FieldKinds = std::initializer_list<FieldKind>;

Need field_kinds(std::string text, FieldKinds kinds) {
    return {"without effects.field.kind = " + std::move(text),
            [all = std::vector(kinds)](const SceneParameters& s) {
                return std::find(all.begin(), all.end(), s.effects.field.kind) != all.end();
            }};
}

/// Stores the values of all rows, or no value if a row is wrong. Other checks report wrong rows.
void take_rows_of_field(FieldValues& values, const Values& rows) {
    values = {};
    for (const Value& row : rows) {
        const auto* numbers = std::get_if<Numbers>(&row.data);
        if (!numbers || (values.rows > 0 && numbers->size() != values.columns)) {
            values = {};
            return;
        }
        values.columns = numbers->size();
        values.rows += 1;
        values.numbers.insert(values.numbers.end(), numbers->begin(), numbers->end());
    }
}

Values rows_of_field(const FieldValues& values) {
    Values rows;
    for (std::size_t row = 0; row < values.rows; ++row) {
        const auto begin = values.numbers.begin() +
                           static_cast<std::ptrdiff_t>(row * values.columns);
        rows.push_back({Numbers(begin, begin + static_cast<std::ptrdiff_t>(values.columns))});
    }
    return rows;
}

Key key_of_file() {
    Key declared =
        key("effects.field.file", "",
            "A text file of numbers: one row for each y, the first at the bottom, and columns "
            "along x. "
            "n of them are L / n apart along periodic sides, and L / (n - 1) between walls. "
            "262144 numbers at most; relative to the scene.",
            [](auto& s) -> auto& { return s.effects.field.file; })
            .by_default("none")
            .needs(field_kinds("\"grid\"", {FieldKind::grid}))
            .unless({"effects.field.values"})
            .required()
            .not_physical();
    declared.get = [](const SceneParameters& s) {
        const std::string& file = s.effects.field.file;
        return file.empty() ? Value{} : Value{file};
    };
    return declared;
}

Key key_of_values() {
    Key declared = named_key(
                       "effects.field.values", "1",
                       "The numbers themselves, one row for each y. A run stores those of its "
                       "file here, so that a restart needs no file.")
                       .with_rows({{"", "[V, V, ...]", 1, most_values}})
                       .by_default("those of the file")
                       .needs(field_kinds("\"grid\"", {FieldKind::grid}));
    declared.get = [](const SceneParameters& s) {
        const FieldValues& values = s.effects.field.values;
        return values.numbers.empty() ? Value{} : Value{rows_of_field(values)};
    };
    declared.set = [](SceneParameters& s, const Value& value) {
        take_rows_of_field(s.effects.field.values, std::get<Values>(value.data));
    };
    return declared;
}

Key key_of_strengths() {
    Key declared = named_key("effects.field.strengths", "1",
                             "How strongly each species feels the potential, in the order of "
                             "species; 0 is not at all, and -1 turns it over.")
                       .with_rows({{"", "[strength, ...]", 1, most_strengths}})
                       .by_default("1 for all")
                       .needs(field_kinds("another word than \"none\"",
                                          {FieldKind::trap, FieldKind::sine, FieldKind::grid}));
    declared.is_one_row = true;
    declared.get = [](const SceneParameters& s) {
        const std::vector<double>& all = s.effects.field.strengths;
        return all.empty() ? Value{} : Value{Values{{Numbers(all.begin(), all.end())}}};
    };
    declared.set = [](SceneParameters& s, const Value& value) {
        const Values& rows = std::get<Values>(value.data);
        const auto* numbers = rows.empty() ? nullptr : std::get_if<Numbers>(&rows.front().data);
        if (numbers) s.effects.field.strengths.assign(numbers->begin(), numbers->end());
    };
    return declared;
}

std::vector<Key> keys_of_field() {
    const Need trap = field_kinds("\"trap\"", {FieldKind::trap}),
               sine = field_kinds("\"sine\"", {FieldKind::sine});
    return {
        key("effects.field.kind", "",
            "A potential V that acts by kicks at syncs. Trap: stiffness_x (x - x0)^2 / 2 and the "
            "same along y. Sine: amplitude sin(2 pi waves x / Lx + phase) with x from the left "
            "side, "
            "or along y from the bottom. Grid: "
            "amplitude times the cubic spline through numbers.",
            [](auto& s) -> auto& { return s.effects.field.kind; })
            .advises({{"harmonic", "\"trap\""},
                      {"cosine", "\"sine\" with a phase of 1.5707963267948966"},
                      {"periodic", "\"sine\""},
                      {"file", "\"grid\""},
                      {"table", "\"grid\""}}),
        key("effects.field.stiffness_x", "mass/step^2", "Force for each length from the centre.",
            [](auto& s) -> auto& { return s.effects.field.stiffness_x; })
            .needs(trap),
        key("effects.field.stiffness_y", "mass/step^2", "The same along y.",
            [](auto& s) -> auto& { return s.effects.field.stiffness_y; })
            .needs(trap),
        key("effects.field.centre_x", "length", "Where the trap has its centre.",
            [](auto& s) -> auto& { return s.effects.field.centre_x; })
            .by_default("the middle of the box")
            .place_along(Axis::x)
            .needs(trap),
        key("effects.field.centre_y", "length", "The same along y.",
            [](auto& s) -> auto& { return s.effects.field.centre_y; })
            .by_default("the middle of the box")
            .place_along(Axis::y)
            .needs(trap),
        key("effects.field.amplitude", "mass length^2/step^2",
            "Energy of the sine's crest, or of a number of 1 on the grid.",
            [](auto& s) -> auto& { return s.effects.field.amplitude; })
            .needs(field_kinds("\"sine\" or \"grid\"", {FieldKind::sine, FieldKind::grid}))
            .required(),
        key("effects.field.axis", "", "Along which the sine changes.",
            [](auto& s) -> auto& { return s.effects.field.axis; })
            .needs(sine),
        key("effects.field.waves", "1", "How many waves of the sine the box holds.",
            [](auto& s) -> auto& { return s.effects.field.waves; })
            .within({1, 1e6})
            .needs(sine),
        key("effects.field.phase", "radians", "Phase of the sine at the left side, or the bottom.",
            [](auto& s) -> auto& { return s.effects.field.phase; })
            .within({-100, 100})
            .needs(sine),
        key_of_file(),
        key_of_values(),
        key_of_strengths(),
    };
}

bool has_field(const SceneParameters& s) { return s.effects.field.is_on(); }

bool is_trap(const SceneParameters& s) { return s.effects.field.kind == FieldKind::trap; }

std::vector<Rule> rules_of_field() {
    constexpr std::string_view why = "a trap has one centre, and a periodic box has no middle; "
                                     "take walls, or effects.field.kind = \"sine\"";
    return {
        rule("a trap along x", "periodic sides left and right", why, {"effects.field.stiffness_x"},
             [](const SceneParameters& s) {
                 return is_trap(s) && s.effects.field.stiffness_x != 0 && s.effects.is_periodic_x();
             }),
        rule("a trap along y", "periodic sides bottom and top", why, {"effects.field.stiffness_y"},
             [](const SceneParameters& s) {
                 return is_trap(s) && s.effects.field.stiffness_y != 0 && s.effects.is_periodic_y();
             }),
        rule("a field", "sheared sides", "images of a disc would be at other places of the field",
             {"effects.field.kind"},
             [](const SceneParameters& s) { return has_field(s) && s.effects.are_sheared(); }),
        rule("a field", "contacts that last",
             "these need discs that one constant force presses until the next sync",
             {"effects.lasting_contacts.speed"},
             [](const SceneParameters& s) { return has_field(s) && s.effects.lasting_speed > 0; }),
    };
}

/// The product w t (see the top of this file) for the lightest disc where the field curves most.
double turn_between_syncs(const SceneParameters& scene) {
    const ExternalField& field = scene.effects.field;
    double lightest = scene.effects.species.empty() ? 1 : scene.effects.species.front().mass;
    for (const Species& one : scene.effects.species) lightest = std::min(lightest, one.mass);
    const double curvature = field.largest_curvature(scene.box) * field.largest_strength();
    return std::sqrt(curvature / lightest) * steps_between_syncs(scene);
}

void prepare_field(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    ExternalField& field = scene.effects.field;
    if (!field.is_on() || scene.box == Box()) return;
    if (field.kind == FieldKind::grid)
        field.spline = FieldSpline(field.values, scene.effects.is_periodic_x(),
                                   scene.effects.is_periodic_y());
    if (draft.settings.has("time.sync_every")) return;
    while (scene.sync_every > 1 && turn_between_syncs(scene) > usual_turn) scene.sync_every /= 2;
}

void check_rows_of_field(const SceneDraft& draft) {
    std::size_t columns = 0, n = 0;
    draft.for_each_row("effects.field.values", [&](const Numbers& row, std::size_t, const Place&) {
        if (columns == 0) columns = row.size();
        n += row.size();
    });
    draft.refuse_rows("effects.field.values", [&](const Numbers& row, std::size_t) -> std::string {
        return row.size() == columns
                   ? ""
                   : fmt::format("{} numbers, and the first row has {}", row.size(), columns);
    });
    if (n > most_values)
        draft.refuse(
            {"effects.field.values"},
            fmt::format("'effects.field.values' has {} numbers; {} at most", n, most_values));
}

void check_strengths(const SceneDraft& draft) {
    ExternalField& field = draft.scene.effects.field;
    const std::vector<Species>& species = draft.scene.effects.species;
    if (field.strengths.empty()) return;
    const std::size_t n = std::max<std::size_t>(1, species.size());
    if (field.strengths.size() != n)
        return draft.refuse({"effects.field.strengths"},
                            fmt::format("'effects.field.strengths' has {} numbers, and the scene "
                                        "has {} species",
                                        field.strengths.size(), n));
    field.ends.clear();
    DiscId end = 0;
    for (const Species& one : species) field.ends.push_back(end += one.count);
    if (species.empty()) field.ends.push_back(draft.scene.n_discs);
}

void check_field(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (!has_field(scene)) return;
    check_strengths(draft);
    if (!draft.knows_syncs()) return;
    const double turn = turn_between_syncs(scene);
    if (!(turn > large_turn)) return;
    const double most = std::floor(static_cast<double>(scene.sync_every) * usual_turn / turn);
    const std::string remedy = most >= 1 ? fmt::format("try: time.sync_every = {}", most)
                                         : "take more time.micro_steps";
    if (turn > largest_turn)
        return draft.refuse({"effects.field.kind"},
                            fmt::format("discs turn in the field by {:.2g} radians from sync to "
                                        "sync, where it curves most; 1 at most, and {} by default; "
                                        "{}",
                                        turn, usual_turn, remedy));
    scene.warnings.push_back(
        fmt::format("discs turn in effects.field by {:.2g} radians from sync to sync, so that "
                    "their energy is right to {:.0f} % alone; {}",
                    turn, 25 * turn * turn, remedy));
}

std::vector<std::string> settings_of_field_file(const SceneParameters& scene) {
    const ExternalField& field = scene.effects.field;
    if (field.kind != FieldKind::grid || field.file.empty() || !field.values.numbers.empty())
        return {};
    const auto path = std::filesystem::path(scene.name).parent_path() / field.file;
    return {"effects.field.values=" + read_rows(path.string(), most_values)};
}

std::string summary_of_field(const Effects& effects) {
    const ExternalField& field = effects.field;
    switch (field.kind) {
    case FieldKind::none: return {};
    case FieldKind::trap:
        return fmt::format("a trap of stiffness ({:g}, {:g})", field.stiffness_x,
                           field.stiffness_y);
    case FieldKind::sine:
        return fmt::format("a sine of amplitude {:g} along {}", field.amplitude,
                           field.axis == Axis::x ? "x" : "y");
    default:
        return fmt::format("a potential on a grid of {} by {}", field.values.columns,
                           field.values.rows);
    }
}

double energy_in_field(const ShownDisc& disc, const Effects& effects, const Box& box) {
    const ExternalField& field = effects.field;
    return field.strength_of(disc.id) * field.at(disc.x, disc.y, box).energy;
}

} // namespace

namespace effects {

EffectDeclaration field() {
    return {.tables = {{"effects.field", "A potential that stands still."}},
            .keys = keys_of_field(),
            .rules = rules_of_field(),
            .derive = prepare_field,
            .settings_of_file = settings_of_field_file,
            .check_times = check_rows_of_field,
            .check_room = check_field,
            .summary = summary_of_field,
            .allowance =
                [](const Effects& e) {
                    return CheckAllowance{.acts_at_syncs = e.field.is_on(),
                                          .acts_before_flights = e.field.is_on()};
                },
            .energy = [](const Effects& e) -> std::optional<OtherEnergy> {
                if (!e.field.is_on()) return std::nullopt;
                return OtherEnergy{.name = "potential_energy",
                                   .words = "in the field",
                                   .value = &Totals::potential_energy,
                                   .of_disc = energy_in_field,
                                   .is_of_syncs = true};
            },
            .lets_discs_rest = [](const Effects& e) { return e.field.is_on(); },
            .usual_speed =
                [](const SceneParameters& s) {
                    return std::sqrt(2 * s.effects.field.depth(s.box) *
                                     s.effects.field.largest_strength());
                },
            .at_syncs = [](const SceneParameters& s) -> std::unique_ptr<SyncEffect> {
                if (!has_field(s)) return nullptr;
                return std::make_unique<FieldAtSyncs>(s);
            },
            .common_motion =
                [](const Effects& e, Axis axis) {
                    return CommonMotion{.is_stopped = e.field.acts_along(axis)};
                },
            .reason_without_z =
                [](const Effects& e) {
                    return std::string(e.field.is_on()
                                           ? "no Z, because the density differs from place to place"
                                           : "");
                }};
}

} // namespace effects

} // namespace carrom
