// SPDX-License-Identifier: BSD-3-Clause
// The module carrom._core, which carrom/simulation.py makes a class for users of.
#include "parts.hpp"

#include <exception>

namespace carrom::python {

namespace {

/// Python's function (lines, exit code) that makes the exception for an error of the library.
nb::object& error_maker() {
    static auto* maker = new nb::object; // lives as long as the process: Python ends first
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

std::vector<std::string> taken_lines(Core& core) {
    std::vector<std::string> lines;
    lines.swap(*core.lines);
    return lines;
}

} // namespace

} // namespace carrom::python

NB_MODULE(_core, module) {
    using namespace carrom::python;
    using namespace nb::literals;
    nb::register_exception_translator(translate);
    module.def("make_errors_by", [](nb::object maker) { error_maker() = std::move(maker); });
    module.def("end_session", end_session);
    module.def("mpi_library", carrom::Session::mpi_library);
    module.def("new", new_core, "text"_a, "is_file"_a, "settings"_a, "threads"_a,
               "communicator"_a.none());
    module.def("from_checkpoint", core_from_checkpoint, "path"_a, "settings"_a, "threads"_a,
               "communicator"_a.none());
    nb::class_<Core>(module, "Core")
        .def_prop_ro("step", [](const Core& core) { return core.simulation.step(); })
        .def_prop_ro("rank", [](const Core& core) { return core.session->rank(); })
        .def_prop_ro("ranks", [](const Core& core) { return core.session->size(); })
        .def_prop_ro("facts", facts_of)
        .def_prop_ro("kinds", kinds_of)
        .def_prop_ro("ids", ids_of)
        .def_prop_ro("positions", positions_of)
        .def_prop_ro("velocities", velocities_of)
        .def_prop_ro("spins", spins_of)
        .def_prop_ro("collisions", collisions_of)
        .def_prop_ro("totals", totals_of)
        .def_prop_ro("averages", averages_of)
        .def_prop_ro("tables", tables_of)
        .def("taken_lines", taken_lines)
        .def("advance",
             [](Core& core, std::int64_t steps) {
                 without_lock([&] { core.simulation.advance(steps); });
             })
        .def("restart_averages",
             [](Core& core) { without_lock([&] { core.simulation.restart_averages(); }); })
        .def("change", change, "positions"_a.none(), "velocities"_a.none(), "spins"_a.none())
        .def("write_checkpoint",
             [](const Core& core, const std::string& path) {
                 without_lock([&] { core.simulation.write_checkpoint(path); });
             })
        .def("copy", [](const Core& core) {
            return Core{core.session, std::make_shared<std::vector<std::string>>(),
                        without_lock([&] { return core.simulation.copy(); })};
        });
}
