// SPDX-License-Identifier: BSD-3-Clause
#include "scene/compare.hpp"

#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "scene/disc_columns.hpp"

namespace carrom {

namespace {

bool operator==(const Stream& a, const Stream& b) {
    return a.x_low == b.x_low && a.y_low == b.y_low && a.x_high == b.x_high &&
           a.y_high == b.y_high && a.vx == b.vx && a.vy == b.vy;
}

bool same_streams(const std::vector<Stream>& a, const std::vector<Stream>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(a[i] == b[i])) return false;
    return true;
}

std::string_view name_of(Method method) {
    return method == Method::time_stepped ? "\"one\"" : "\"all\"";
}

std::string_view name_of(Precision precision) {
    return precision == Precision::single ? "\"single\"" : "\"double\"";
}

std::string_view name_of(Arithmetic arithmetic) {
    return arithmetic == Arithmetic::naive ? "\"naive\"" : "\"stable\"";
}

std::string_view name_of(Generator generator) {
    switch (generator) {
    case Generator::random: return "\"random\"";
    case Generator::lattice: return "\"lattice\"";
    case Generator::legacy: return "\"legacy\"";
    case Generator::file: return "\"file\"";
    }
    return "";
}

std::string_view name_of(VelocityKind kind) {
    return kind == VelocityKind::maxwell ? "\"maxwell\"" : "\"uniform\"";
}

std::string shown(const std::optional<double>& number) {
    return number ? fmt::format("{}", *number) : "not set";
}

class Comparison {
public:
    template <class Value>
    void compare(std::string_view key, const Value& there, const Value& here) {
        if (!(there == here))
            differences.push_back(fmt::format("'{}' is {} there and {} here", key, there, here));
    }
    void compare_list(std::string_view key, bool is_same) {
        if (!is_same) differences.push_back(fmt::format("'{}' is another list there", key));
    }

    std::vector<std::string> differences;
};

std::string_view name_of(ContactKind kind) {
    switch (kind) {
    case ContactKind::elastic: return "\"elastic\"";
    case ContactKind::none: return "\"none\"";
    case ContactKind::restitution: return "\"restitution\"";
    case ContactKind::rough: return "\"rough\"";
    }
    return "";
}

std::string_view name_of(BoundaryKind kind) {
    switch (kind) {
    case BoundaryKind::fixed: return "\"wall\"";
    case BoundaryKind::thermal: return "\"thermal\"";
    case BoundaryKind::moving: return "\"moving\"";
    case BoundaryKind::open: return "\"open\"";
    case BoundaryKind::periodic: return "\"periodic\"";
    }
    return "";
}

void compare_effects(Comparison& c, const Effects& there, const Effects& here) {
    c.compare("effects.contact.kind", name_of(there.contact.kind), name_of(here.contact.kind));
    c.compare("effects.contact.restitution", there.contact.restitution, here.contact.restitution);
    c.compare("effects.contact.tangential_restitution", there.contact.tangential_restitution,
              here.contact.tangential_restitution);
    c.compare("effects.contact.friction", there.contact.friction, here.contact.friction);
    c.compare("effects.contact.moment_of_inertia", there.contact.inertia, here.contact.inertia);
    c.compare("effects.contact.contact_time", there.contact.contact_time,
              here.contact.contact_time);
    for (std::size_t k = 0; k < boundary_names.size(); ++k) {
        const Boundary &a = there.boundaries[k], &b = here.boundaries[k];
        const std::string table = std::string("box.") + boundary_names[k];
        c.compare(table + ".kind", name_of(a.kind), name_of(b.kind));
        c.compare(table + ".restitution", a.restitution, b.restitution);
        c.compare(table + ".temperature", a.temperature, b.temperature);
        c.compare(table + ".speed", a.speed, b.speed);
    }
    c.compare("effects.gravity.x", there.gravity.x, here.gravity.x);
    c.compare("effects.gravity.y", there.gravity.y, here.gravity.y);
    c.compare("effects.drag.rate", there.drag, here.drag);
    c.compare("effects.thermal.seed", there.thermal_seed, here.thermal_seed);
    c.compare_list("effects.obstacles.discs", there.obstacles.discs == here.obstacles.discs);
    c.compare_list("effects.obstacles.segments",
                   there.obstacles.segments == here.obstacles.segments);
    c.compare("effects.obstacles.restitution", there.obstacles.restitution,
              here.obstacles.restitution);
}

} // namespace

std::vector<std::string> physical_differences(const Scene& there, const Scene& here) {
    Comparison c;
    c.compare("box.size", there.box_size, here.box_size);
    c.compare("discs.count", there.n_discs, here.n_discs);
    c.compare("discs.radius", there.radius, here.radius);
    c.compare_list("discs.species", there.effects.species == here.effects.species);
    c.compare("discs.generator", name_of(there.generator), name_of(here.generator));
    c.compare("discs.file", there.discs_file, here.discs_file);
    c.compare_list("discs.list", there.listed_discs == here.listed_discs);
    c.compare_list("discs.columns", there.disc_columns == here.disc_columns);
    const bool are_listed = !has_column(there, DiscColumn::spin) &&
                            !has_column(here,
                                        DiscColumn::spin); // checkpoints do not have those of files
    if (are_listed && there.spins != here.spins)
        c.differences.push_back("discs begin with other spins there");
    const bool speeds = here.generator == Generator::random || here.generator == Generator::lattice;
    if (there.generator == here.generator && speeds) {
        c.compare("discs.speed", there.speed, here.speed);
        c.compare("discs.velocities", name_of(there.velocities), name_of(here.velocities));
    }
    if (there.generator == here.generator && here.generator != Generator::file) {
        c.compare("discs.seed", there.seed, here.seed);
        c.compare_list("discs.streams", same_streams(there.streams, here.streams));
    }
    c.compare("time.method", name_of(there.method), name_of(here.method));
    c.compare("time.micro_steps", there.micro_steps, here.micro_steps);
    c.compare("time.sync_every", there.sync_every, here.sync_every);
    c.compare("time.precision", name_of(there.precision), name_of(here.precision));
    c.compare("time.arithmetic", name_of(there.arithmetic), name_of(here.arithmetic));
    c.compare("time.contraction", there.contraction, here.contraction);
    compare_effects(c, there.effects, here.effects);
    c.compare("time.accuracy", shown(there.accuracy), shown(here.accuracy));
    return c.differences;
}

} // namespace carrom
