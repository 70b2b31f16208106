// SPDX-License-Identifier: BSD-3-Clause
// The module carrom._core, which carrom/simulation.py wraps in a class for users.
#include "parts.hpp"

#include <exception>

namespace carrom::python {

namespace {

/// Python's function (lines, exit code) that makes the exception for an error of the library.
nb::object& error_maker() {
    static auto* maker = new nb::object; // never destroyed: Python ends before destructors run
    return *maker;
}

void raise(const std::vector<std::string>& lines, ExitCode code) {
    const nb::object error = error_maker()(lines, static_cast<int>(code));
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

void translate(const std::exception_ptr& thrown, void* /*nothing*/) {
    try {
        std::rethrow_exception(thrown);
    } catch (const InputError& error) {
        std::vector<std::string> lines;
        for (const Problem& problem : error.problems()) lines.push_back(to_string(problem));
        raise(lines, ExitCode::bad_input);
    } catch (const CollectiveError& error) {
        raise({error.what()}, error.code());
    }
}

template <class Call> auto without_lock(const Call& call) {
    const nb::gil_scoped_release others_run;
    return call();
}

/// The docstring of a property that is an array for all discs, filled only for this rank's discs.
std::string of_own_discs(const char* what) {
    return std::string(what) + "; 0 at ids of other ranks' discs.";
}

std::vector<std::string> taken_lines(Core& core) {
    std::vector<std::string> lines;
    lines.swap(*core.lines);
    return lines;
}

/// Adds properties for numbers and arrays. Each access to an array makes a new array.
void add_properties(nb::class_<Core>& core) {
    core.def_prop_ro(
            "step", [](const Core& core) { return core.simulation.step(); },
            "Steps since the scene's start.")
        .def_prop_ro(
            "rank", [](const Core& core) { return core.session->rank(); }, "This rank's number.")
        .def_prop_ro(
            "ranks", [](const Core& core) { return core.session->size(); }, "The number of ranks.")
        .def_prop_ro("facts", facts_of, "Facts of the scene, by name.")
        .def_prop_ro(
            "box",
            [](const Core& core) {
                const Box box = core.simulation.box();
                return nb::make_tuple(box.x, box.y);
            },
            "Sides of the box along x and y, lengths.")
        .def_prop_ro("kinds", kinds_of, "Radii (N,), lengths; masses (N,); species (N,), int64.")
        .def_prop_ro("ids", ids_of, "Ids of this rank's discs, (n,), int64, ascending.")
        .def_prop_ro("positions", positions_of, of_own_discs("(N, 2), lengths").c_str())
        .def_prop_ro("velocities", velocities_of, of_own_discs("(N, 2), lengths per step").c_str())
        .def_prop_ro("spins", spins_of, of_own_discs("(N,), radians per step").c_str())
        .def_prop_ro("directions", directions_of, of_own_discs("(N,), radians").c_str())
        .def_prop_ro("collisions", collisions_of,
                     of_own_discs("(N, 2), int64: with walls, with discs").c_str())
        .def_prop_ro("images", images_of,
                     "(N, 2), int32: box lengths flown through periodic sides; 0 at ids of other "
                     "ranks' shares. Collective.")
        .def_prop_ro("totals", totals_of, "Sums over all discs, by name. Collective.")
        .def_prop_ro("averages", averages_of, "Averages and their errors, by name. Collective.")
        .def_prop_ro("tables", tables_of,
                     "Measurements so far: (name, columns, rows (n, columns), remarks) of each.");
}

void add_methods(nb::class_<Core>& core) {
    using namespace nb::literals;
    core.def("taken_lines", taken_lines, "Return the lines printed since the last call.")
        .def(
            "advance",
            [](Core& core, std::int64_t steps) {
                without_lock([&] { core.simulation.advance(steps); });
            },
            "steps"_a, "Move forward, without Python's lock. Collective.")
        .def(
            "restart_averages",
            [](Core& core) { without_lock([&] { core.simulation.restart_averages(); }); },
            "Forget what has been averaged. Collective.")
        .def("agree_on", agree_on, "problems"_a,
             "Raise the problems of all ranks on each rank, if any rank has one. Collective.")
        .def("change", change, "positions"_a.none(), "velocities"_a.none(), "spins"_a.none(),
             "Give this rank's discs other numbers, taken from arrays of all discs. Collective.")
        .def(
            "write_checkpoint",
            [](const Core& core, const std::string& path) {
                without_lock([&] { core.simulation.write_checkpoint(path); });
            },
            "path"_a, "Write the state as a whole file or not at all. Collective.")
        .def(
            "copy",
            [](const Core& core) {
                return Core{core.session, std::make_shared<std::vector<std::string>>(),
                            without_lock([&] { return core.simulation.copy(); })};
            },
            "Return an independent simulation of the same state. Collective.");
}

} // namespace

} // namespace carrom::python

NB_MODULE(_core, module) {
    using namespace carrom::python;
    using namespace nb::literals;
    nb::register_exception_translator(translate);
    module.doc() = "The library in this process. `carrom.Simulation` is what users call.\n\n"
                   "\"Collective\": all ranks of the simulation's communicator make the call.";
    module.def(
        "make_errors_by", [](nb::object maker) { error_maker() = std::move(maker); }, "maker"_a,
        "Take the function (lines, exit code) that makes exceptions.");
    module.def("end_session", end_session, "is_forked"_a,
               "End MPI with the last simulation; a forked process leaves it to its parent.");
    module.def("mpi_library", carrom::Session::mpi_library,
               "Return name and version of the MPI library.");
    module.def("new", new_core, "text"_a, "is_file"_a, "settings"_a, "threads"_a,
               "communicator"_a.none(),
               "Begin with a scene, TOML text or the path of a file, and settings KEY=VALUE on "
               "top. 0 threads: the usual number. Collective.");
    module.def("from_checkpoint", core_from_checkpoint, "path"_a, "settings"_a, "threads"_a,
               "communicator"_a.none(), "Go on from a checkpoint's file or folder. Collective.");
    nb::class_<Core> core(module, "Core",
                          "A simulation. Arrays are new ones, in the order of ids.");
    add_properties(core);
    add_methods(core);
}
