// SPDX-License-Identifier: BSD-3-Clause
// Converts a simulation's results to Python's dictionaries and numpy's arrays.
#include "parts.hpp"

namespace carrom::python {

namespace {

nb::dict estimate_of(const Estimate& estimate, const Averages& averages) {
    nb::dict result;
    result["value"] = estimate.value;
    result["error"] = estimate.error;
    result["correlation_time"] = estimate.correlation_time;
    result["independent_samples"] = estimate.independent_samples;
    result["without_error"] = reason_without_error(estimate, averages);
    return result;
}

template <class Number, class Read>
nb::object filled(std::vector<std::size_t> shape, const Read& read) {
    Number* numbers = nullptr;
    std::size_t size = 1;
    for (const std::size_t length : shape) size *= length;
    nb::object array = new_array(std::move(shape), numbers);
    const nb::gil_scoped_release others_run;
    read(std::span<Number>(numbers, size));
    return array;
}

} // namespace

nb::object ids_of(const Core& core) {
    const std::vector<Disc> discs = core.simulation.discs();
    std::int64_t* ids = nullptr;
    nb::object array = new_array({discs.size()}, ids);
    for (std::size_t i = 0; i < discs.size(); ++i) ids[i] = static_cast<std::int64_t>(discs[i].id);
    return array;
}

nb::object positions_of(const Core& core) {
    return filled<double>({core.simulation.scene().n_discs, 2},
                          [&](std::span<double> xy) { core.simulation.read_positions(xy); });
}

nb::object velocities_of(const Core& core) {
    return filled<double>({core.simulation.scene().n_discs, 2},
                          [&](std::span<double> xy) { core.simulation.read_velocities(xy); });
}

nb::object spins_of(const Core& core) {
    return filled<double>({core.simulation.scene().n_discs},
                          [&](std::span<double> spins) { core.simulation.read_spins(spins); });
}

nb::object directions_of(const Core& core) {
    return filled<double>({core.simulation.scene().n_discs}, [&](std::span<double> angles) {
        core.simulation.read_directions(angles);
    });
}

nb::object collisions_of(const Core& core) {
    return filled<std::int64_t>(
        {core.simulation.scene().n_discs, 2},
        [&](std::span<std::int64_t> counts) { core.simulation.read_collisions(counts); });
}

nb::object images_of(const Core& core) {
    return filled<std::int32_t>(
        {core.simulation.scene().n_discs, 2},
        [&](std::span<std::int32_t> lengths) { core.simulation.read_images(lengths); });
}

nb::tuple kinds_of(const Core& core) {
    const std::vector<DiscKind> kinds = core.simulation.kinds();
    double *radii = nullptr, *masses = nullptr;
    std::int64_t* species = nullptr;
    nb::object radius = new_array({kinds.size()}, radii), mass = new_array({kinds.size()}, masses),
               number = new_array({kinds.size()}, species);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        radii[i] = kinds[i].radius;
        masses[i] = kinds[i].mass;
        species[i] = kinds[i].species;
    }
    return nb::make_tuple(radius, mass, number);
}

nb::dict facts_of(const Core& core) {
    const SceneFacts& facts = core.simulation.scene();
    nb::dict result;
    result["box"] = nb::make_tuple(facts.box.x, facts.box.y);
    result["corner"] = nb::make_tuple(facts.x_low, facts.y_low);
    result["radius"] = facts.radius;
    result["packing"] = facts.packing;
    result["n_discs"] = facts.n_discs;
    result["steps"] = facts.steps;
    result["micro_steps"] = facts.micro_steps;
    result["exchanges_radii"] = facts.exchanges_radii;
    result["method"] = facts.is_event_driven ? "event-driven" : "time-stepped";
    result["periodic"] = nb::make_tuple(facts.is_periodic_x, facts.is_periodic_y);
    return result;
}

nb::dict totals_of(const Core& core) {
    Totals totals;
    {
        const nb::gil_scoped_release others_run;
        totals = core.simulation.totals();
    }
    nb::dict result;
    result["discs"] = totals.n_discs;
    result["wall_collisions"] = totals.wall_collisions;
    result["pair_collisions"] = totals.pair_collisions;
    result["overlapping_pairs"] = totals.overlapping_pairs;
    result["kinetic_energy"] = totals.kinetic_energy;
    result["rotational_energy"] = totals.rotational_energy;
    result["potential_energy"] = totals.potential_energy;
    result["momentum"] = nb::make_tuple(totals.momentum_x, totals.momentum_y);
    result["departed"] = std::vector<std::uint64_t>(totals.departed.begin(), totals.departed.end());
    result["state_hash"] = to_string(totals.hash);
    return result;
}

nb::dict averages_of(const Core& core) {
    Averages averages;
    {
        const nb::gil_scoped_release others_run;
        averages = core.simulation.averages();
    }
    nb::dict result, of;
    for (const auto& [name, estimate] : {std::pair{"temperature", averages.temperature},
                                         {"pressure", averages.pressure},
                                         {"compressibility", averages.compressibility},
                                         {"pressure_xx", averages.pressure_tensor.xx},
                                         {"pressure_xy", averages.pressure_tensor.xy},
                                         {"pressure_yy", averages.pressure_tensor.yy},
                                         {"collision_frequency", averages.collision_frequency},
                                         {"mean_free_time", averages.mean_free_time},
                                         {"wall_pressure", averages.wall_pressure},
                                         {"virial_pressure", averages.virial_pressure},
                                         {"mean_speed", averages.mean_speed},
                                         {"speed_kurtosis", averages.speed_kurtosis}})
        of[name] = estimate_of(estimate, averages);
    result["first_step"] = averages.first_step;
    result["steps"] = averages.steps;
    result["blocks"] = averages.n_blocks;
    result["averages"] = of;
    return result;
}

nb::list tables_of(const Core& core) {
    nb::list result;
    for (const MeasuredTable& table : core.simulation.measurements()) {
        double* numbers = nullptr;
        const std::size_t width = table.columns.size();
        nb::object rows = new_array({table.rows.size(), width}, numbers);
        for (std::size_t i = 0; i < table.rows.size(); ++i)
            for (std::size_t k = 0; k < width; ++k) numbers[i * width + k] = table.rows[i][k];
        result.append(nb::make_tuple(table.name, table.columns, rows, table.remarks));
    }
    return result;
}

} // namespace carrom::python
