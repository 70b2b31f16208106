// SPDX-License-Identifier: BSD-3-Clause
// The checks of [discs] that involve more than one key.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/box_text.hpp"
#include "lattices/lattice.hpp"
#include "lattices/triangular.hpp"
#include "scene/disc_groups.hpp"
#include "scene/frozen_discs.hpp"
#include "scene/limits.hpp"
#include "scene/scene_draft.hpp"
#include "scene/size_checks.hpp"
#include "scene/start_region.hpp"

namespace carrom {

namespace {

/// The keys that can define radii.
constexpr std::array<std::string_view, 6> size_keys = {"discs.radius",  "discs.radius.distribution",
                                                       "discs.packing", "discs.species",
                                                       "discs.list",    "discs.columns"};

std::string body_problem(double radius, double mass) {
    std::string text = column_problem(DiscColumn::radius, radius);
    return text.empty() ? column_problem(DiscColumn::mass, mass) : text;
}

std::string number_problem(const SceneParameters& scene, SideColumn column, double number) {
    std::string text = column_problem(disc_column_of(column), number);
    if (!text.empty() || !info_of(column).is_of_dynamics ||
        side_columns_of(scene.effects).has(column))
        return text;
    return fmt::format("a {} has no meaning here: {}", info_of(column).name, info_of(column).needs);
}

void check_species(const SceneDraft& draft) {
    draft.refuse_rows("discs.species", [&](const Numbers& n, std::size_t) -> std::string {
        if (std::isnan(n[0])) return {}; // reported before (species_counts.cpp, disc_groups.cpp)
        if (!(n[0] >= 1 && n[0] <= static_cast<double>(largest_count)) || n[0] != std::floor(n[0]))
            return fmt::format("its count must be a whole number from 1 to {}, not {}",
                               largest_count, n[0]);
        return body_problem(n[1], n[2]);
    });
    bool lists_bodies = false;
    draft.for_each_row("discs.list", [&](const Numbers& n, std::size_t, const Place&) {
        lists_bodies = lists_bodies || n.size() >= 6;
    });
    draft.refuse_rows("discs.list", [&](const Numbers& n, std::size_t) -> std::string {
        if (!lists_bodies) return {};
        if (n.size() < 6) return "other rows have six numbers, [x, y, vx, vy, radius, mass]";
        return body_problem(n[4], n[5]);
    });
    const bool has_column_of_radii = has_column(draft.scene, DiscColumn::radius);
    if (draft.settings.has("discs.species") && (lists_bodies || has_column_of_radii))
        draft.refuse({"discs.species"}, fmt::format("'discs.species' has no meaning where '{}' "
                                                    "name radii",
                                                    lists_bodies ? "discs.list" : "discs.columns"));
}

/// Checks the numbers in side columns (core/side_columns.hpp) of `discs.list` and `discs.species`.
void check_numbers(const SceneDraft& draft) {
    BySideColumn<bool> are_given;
    for (const SideColumn column : given_side_columns)
        are_given[column] = has_column(draft.scene, disc_column_of(column));
    draft.refuse_rows("discs.list", [&](const Numbers& n, std::size_t) -> std::string {
        if (n.size() % 2 == 0 || n.size() < 5) return {};
        are_given[SideColumn::spin] = true;
        return number_problem(draft.scene, SideColumn::spin, n.back());
    });
    draft.refuse_rows("discs.species", [&](const Numbers& n, std::size_t) {
        std::string text;
        for (const SideColumn column : given_side_columns) {
            const double number = n[3 + static_cast<std::size_t>(column)];
            if (number == 0 || !text.empty()) continue;
            text = are_given[column]
                       ? fmt::format("its {} is given by 'discs.list' or 'discs.columns' already",
                                     info_of(column).name)
                       : number_problem(draft.scene, column, number);
        }
        return text;
    });
}

/// Finds the number of discs from `discs.count`, a list, species or groups. If several of them give
/// it, they must agree.
void fill_count(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    std::uint64_t n_in_species = 0;
    for (const Species& one : scene.effects.species) n_in_species += one.count;
    std::uint64_t n_in_groups = 0;
    for (const DiscGroup& one : scene.groups) n_in_groups += one.count;
    const std::pair<std::string_view, std::uint64_t> sources[] = {
        {"discs.list", scene.listed_discs.size()},
        {"discs.species", n_in_species},
        {"discs.groups", n_in_groups}};
    std::string known_from = "discs.count";
    for (const auto& [key, n] : sources) {
        if (!draft.settings.has(key)) continue;
        if (n == 0 && draft.settings.is_right(key))
            draft.refuse({key}, fmt::format("'{}' is empty", key));
        else if (n > largest_count)
            draft.refuse({key}, fmt::format("'{}' has {} discs; at most {} are possible", key, n,
                                            largest_count));
        else if (n > 0 && scene.n_discs > 0 && n != scene.n_discs)
            draft.refuse({key}, fmt::format("'{}' has {} discs, but '{}' has {}", key, n,
                                            known_from, scene.n_discs));
        if (draft.settings.has("discs.count") || scene.n_discs > 0) continue;
        scene.n_discs = n;
        known_from = key;
    }
}

/// Checks that rounding of positions in the box is small compared with `smallest_radius`. If it is
/// not, the event-driven method only warns, unless `scene.accuracy` is set.
void check_width(const SceneDraft& draft, double smallest_radius) {
    SceneParameters& scene = draft.scene;
    const double l = scene.box.longest(), r = smallest_radius;
    if (l / r > largest_box_in_radii && !scene.are_points) {
        const std::string text = fmt::format("discs of radius {} in a box of side {}: it is {:.4g} "
                                             "radii wide, and above {:.0e} positions "
                                             "are too coarse for contacts with walls",
                                             r, l, l / r, largest_box_in_radii);
        if (scene.method == Method::event_driven && !scene.accuracy)
            scene.warnings.push_back(text);
        else
            draft.refuse_first(size_keys, text + "; take larger discs or a smaller box (method = "
                                                 "\"event-driven\" only warns)");
    }
    if (scene.precision == Precision::single &&
        (r < smallest_single_size || l > largest_single_size))
        draft.refuse_first(size_keys,
                           "precision = \"single\" takes lengths from 2^-40 to 2^40 only");
}

/// Checks that the discs are not too large or too many for the box.
void check_sizes(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const auto& species = scene.effects.species;
    double smallest = scene.radius;
    for (const Species& one : species) smallest = std::min(smallest, one.radius);
    const double r = scene.radius;
    const double densest = species.empty() ? largest_packing : 1;
    if (scene.box.shortest() < 2 * r)
        draft.refuse_first(size_keys,
                           fmt::format("a disc of radius {} does not fit into a box of {}: "
                                       "{} < 2 r",
                                       r, sides_text(scene.box),
                                       scene.box.is_square() ? "L" : "the shorter one"));
    else if (scene.packing() > densest)
        draft.refuse_first(size_keys,
                           fmt::format("{} discs of radius {} cannot fit into a box of {}: "
                                       "they would cover {:.4g} of it, and no packing "
                                       "covers more than {}",
                                       scene.n_discs, r, sides_text(scene.box), scene.packing(),
                                       densest));
    check_width(draft, smallest);
}

/// Warns of masses so different that sums over discs lose the contributions of light discs, because
/// sums are multiples of a unit that is proportional to the largest mass (core/exact_sum.hpp).
void warn_of_lost_masses(const SceneDraft& draft) {
    constexpr double most = 1e8;
    SceneParameters& scene = draft.scene;
    if (scene.effects.species.empty()) return;
    const auto [lightest, heaviest] = std::ranges::minmax(scene.effects.species, {},
                                                          &Species::mass);
    if (!(heaviest.mass > most * lightest.mass)) return;
    scene.warnings.push_back(fmt::format(
        "the heaviest disc has {:.3g} times the mass of the lightest; beyond {:g} times kT, P and "
        "Z lose what light discs add, and flights and collisions stay exact; try: a mass of {:.3g}",
        heaviest.mass / lightest.mass, most, most * lightest.mass));
}

/// Checks settings for discs of radius 0 (points). They need the event-driven method, and if there
/// are several, the contact kind "none", because two points never meet.
void check_points(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (!scene.are_points) return;
    const char* const contact = scene.n_discs > 1 && scene.effects.contact.kind != ContactKind::none
                                    ? "effects.contact.kind = \"none\""
                                    : "";
    const char* const method = scene.method != Method::event_driven
                                   ? "time.method = \"event-driven\""
                                   : "";
    if (*contact == 0 && *method == 0) return;
    draft.refuse({"discs.radius"},
                 fmt::format("discs of radius 0 are points: two points never meet, and only the "
                             "event-driven method has them; try: {}{}{}, or a radius above 0",
                             contact, *contact != 0 && *method != 0 ? " and " : "", method));
}

/// Computes the radius, or all radii of a distribution. Returns true if the discs may fit.
bool fill_sizes(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const Settings& settings = draft.settings;
    const std::size_t n_problems = draft.problems.size();
    const bool has_radius = settings.has("discs.radius");
    if (scene.box == Box() || scene.n_discs == 0) return false;
    for (const std::string_view key : size_keys) {
        const bool may_have_wrong_rows = key == "discs.list" && scene.effects.species.empty();
        if (settings.has(key) && !settings.is_right(key) && !may_have_wrong_rows) return false;
    }
    if (settings.has("discs.groups") && !settings.is_right("discs.groups")) return false;
    const bool has_packing = settings.has("discs.packing");
    if (has_packing && has_radius) return false;
    const double packing = has_packing
                               ? std::get<double>(settings.find("discs.packing")->value.data)
                               : 0;
    if (scene.sizes) {
        if (!check_distribution(draft)) return false;
        scene.effects.species = species_of_sizes(*scene.sizes, scene.n_discs,
                                                 packing * scene.area());
        for (const Species* one : {&scene.effects.species.front(), &scene.effects.species.back()})
            if (const std::string text = body_problem(one->radius, one->mass); !text.empty()) {
                draft.refuse_first(size_keys, "of the distribution of radii " + text);
                return false;
            }
    } else if (has_packing && !scene.has_shares) {
        scene.radius = radius_of_packing(scene, packing);
    }
    for (const Species& one : scene.effects.species)
        scene.radius = std::max(scene.radius, one.radius);
    if (scene.are_points) scene.radius = point_radius(scene.box);
    if (scene.radius == 0) return false;
    check_points(draft);
    check_sizes(draft);
    warn_of_lost_masses(draft);
    return draft.problems.size() == n_problems;
}

/// Checks that a triangular lattice fits the periodic box, and that discs do not overlap on it.
void check_triangular(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    // rules.cpp reports walls
    if (!scene.effects.is_periodic_x() || !scene.effects.is_periodic_y()) return;
    const auto lattice = triangular_lattice(scene.n_discs, scene.box);
    if (!lattice)
        return draft.refuse(
            {"discs.generator"},
            fmt::format("no triangular lattice of {} discs fits a box of {}: columns times an even "
                        "number of rows, with edges in the ratio of columns to rows sqrt(3) / 2; "
                        "nearest: {}",
                        scene.n_discs, sides_text(scene.box),
                        nearest_triangular(scene.n_discs, scene.box)));
    const double nearest = lattice->nearest();
    if (2 * scene.radius <= nearest * (1 + 0x1p-40)) return;
    draft.refuse_first(
        size_keys, fmt::format("discs of radius {} overlap on the triangular lattice of {} x {} "
                               "sites in a box of {}: r is at most {:.10g} there",
                               scene.radius, lattice->columns, lattice->rows, sides_text(scene.box),
                               nearest / 2));
}

/// Checks initial positions. Above a packing of 0.5 a lattice replaces random ones, except in
/// regions and groups.
void check_generator(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    check_regions(draft);
    check_groups(draft);
    check_freezing(draft);
    if (scene.generator == Generator::random && !has_regions(scene) && scene.groups.empty() &&
        scene.packing() > largest_random_packing * (1 + 1e-12)) {
        scene.generator = Generator::lattice;
        scene.warnings.push_back(
            fmt::format("random insertion stalls above a packing fraction of {}; the {} discs "
                        "(packing fraction {:.4g}) start from a shaken lattice; "
                        "discs.generator = \"compressed\" makes a random start",
                        largest_random_packing, scene.n_discs, scene.packing()));
    }
    if (scene.generator == Generator::triangular) check_triangular(draft);
    if (scene.generator == Generator::lattice && !scene.effects.fixed_bodies.are_any() &&
        !widest_lattice(scene.n_discs, scene.box, scene.radius))
        draft.refuse_first(
            size_keys,
            fmt::format("no lattice of {} discs of radius {} fits into a box of {}{}",
                        scene.n_discs, scene.radius, sides_text(scene.box),
                        scene.effects.species.empty()
                            ? "; try discs.generator = \"compressed\" or \"triangular\""
                            : " (a lattice has room for the largest disc everywhere); try "
                              "discs.generator = \"compressed\""));
}

/// Checks the root mean square speed of the lightest discs at `discs.temperature`, because they are
/// the fastest on average.
void check_temperature(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (!scene.temperature || *scene.temperature == 0) return;
    double lightest = scene.effects.species.empty() ? 1 : INFINITY;
    for (const Species& one : scene.effects.species) lightest = std::min(lightest, one.mass);
    if (!column_problem(DiscColumn::mass, lightest).empty()) return; // reported already
    const double speed = std::sqrt(2 * (*scene.temperature / lightest));
    std::string text = speed_problem(speed, scene);
    if (!(speed >= smallest_size && speed <= 0x1p-8 * largest_size))
        text = fmt::format("discs of mass {} would have a speed of {:.4g}, outside 2^-250 to 2^242",
                           lightest, speed);
    if (!text.empty()) draft.refuse({"discs.temperature"}, "'discs.temperature': " + text);
}

void check_velocities(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (scene.generator == Generator::legacy && scene.seed > 0xFFFFFFFFu)
        draft.refuse({"discs.seed"}, fmt::format("'discs.seed' must be from 0 to 4294967295 with "
                                                 "discs.generator = \"legacy\", not {}",
                                                 scene.seed));
    if (const std::string text = speed_problem(scene.speed, scene);
        !text.empty() && (scene.generator != Generator::file || scene.draws_velocities))
        draft.refuse({"discs.speed"}, "'discs.speed': " + text);
    check_temperature(draft);
    draft.refuse_rows("discs.streams", [&scene](const Numbers& n, std::size_t) {
        std::string text;
        const bool is_finite = std::all_of(n.begin(), n.begin() + 4,
                                           [](double x) { return std::isfinite(x); });
        if (!is_finite || !(n[0] < n[2] && n[1] < n[3]))
            text = "its region must be finite, with x0 < x1 and y0 < y1";
        for (const double v : {n[4], n[5]})
            for (const std::string& fault : {velocity_problem(v), speed_problem(v, scene)})
                if (!fault.empty()) text += (text.empty() ? "" : "; ") + fault;
        return text;
    });
}

/// Whether radii are in a file that has not been read, or that has wrong lines.
bool are_radii_unknown(const SceneDraft& draft) {
    return has_column(draft.scene, DiscColumn::radius) &&
           (!draft.columns || !draft.columns->is_whole);
}

} // namespace

bool check_discs(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const bool is_legacy_text = scene.lines_before_discs > 0;
    if (scene.generator == Generator::file && !is_legacy_text &&
        !draft.settings.has("discs.file") && !draft.settings.has("discs.list") &&
        !draft.settings.has("discs.from"))
        draft.refuse({"discs.generator"}, "discs.generator is \"file\", but there is no "
                                          "'discs.file', 'discs.list' or 'discs.from'");
    const std::size_t n_problems = draft.problems.size();
    check_columns(draft);
    check_rivals_of_sizes(draft);
    check_species(draft);
    const bool are_species_right = draft.problems.size() == n_problems;
    fill_count(draft);
    const bool is_right = fill_sizes(draft) && are_species_right;
    check_rows_of_list(draft);
    check_numbers(draft);
    check_velocities(draft);
    const bool comes_later = scene.n_discs == 0 && draft.problems.size() == n_problems &&
                             (!scene.discs_file.empty() || !scene.discs_from.empty());
    if (comes_later) return false; // the number of discs is in a file that is read later
    if (!is_right) {
        scene.radius = 0;
        if (!are_radii_unknown(draft)) scene.box = {};
        return false;
    }
    const SpeciesTable species(scene.effects.species, scene.radius);
    draft.refuse_rows("discs.list", [&](const Numbers&, std::size_t id) {
        return disc_problem(scene.listed_discs[id], scene, species.of(id).radius);
    });
    check_generator(draft);
    return true;
}

} // namespace carrom
