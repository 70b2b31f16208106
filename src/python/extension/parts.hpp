// SPDX-License-Identifier: BSD-3-Clause
// The parts of the extension: a simulation of the library, and the conversion of its results to
// Python.
//
// This layer is thin on purpose. The functions that a user calls, with their checks and texts, are
// in carrom/simulation.py. Only what needs C++ is here: calls that release Python's lock, arrays
// that are filled without a copy, and errors with the library's problems line by line.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <carrom/carrom.hpp>

namespace carrom::python {

namespace nb = nanobind;

/// Numbers of all discs, of shape (N, 2) or (N,), row after row (numpy's C order).
template <class Number> using Rows = nb::ndarray<Number, nb::c_contig, nb::device::cpu>;
using GivenPairs = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using GivenNumbers = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

/// A simulation with its session, and the lines that it has printed.
struct Core {
    std::shared_ptr<Session> session; ///< destroyed after the simulation
    std::shared_ptr<std::vector<std::string>> lines;
    Simulation simulation;
};

/// The session of all MPI ranks, which the first call makes and later calls share; or a session of
/// the ranks of one communicator, given by its Fortran number.
std::shared_ptr<Session> session_of(std::optional<int> communicator);
/// Releases the session of all MPI ranks, so that MPI ends when no simulation uses the session any
/// more. If `is_forked`, this process never ends MPI, because MPI belongs to its parent process.
void end_session(bool is_forked);

/// A new numpy array that owns its numbers.
template <class Number> nb::object new_array(std::vector<std::size_t> shape, Number*& numbers) {
    std::size_t size = 1;
    for (const std::size_t length : shape) size *= length;
    numbers = new Number[size]();
    nb::capsule owner(numbers, [](void* place) noexcept { delete[] static_cast<Number*>(place); });
    return nb::cast(nb::ndarray<nb::numpy, Number>(numbers, shape.size(), shape.data(), owner));
}

nb::dict totals_of(const Core& core);
nb::dict averages_of(const Core& core);
nb::list tables_of(const Core& core);
nb::dict facts_of(const Core& core);
nb::tuple kinds_of(const Core& core);
/// The ids of this rank's discs, (n,), in ascending order.
nb::object ids_of(const Core& core);
nb::object positions_of(const Core& core);
nb::object velocities_of(const Core& core);
nb::object spins_of(const Core& core);
nb::object directions_of(const Core& core);
nb::object collisions_of(const Core& core);
nb::object images_of(const Core& core);

Core new_core(const std::string& text, bool is_file, const std::vector<std::string>& settings,
              int threads, std::optional<int> communicator);
Core core_from_checkpoint(const std::string& path, const std::vector<std::string>& settings,
                          int threads, std::optional<int> communicator);
/// Throws InputError with the problems of all ranks, if any rank has one. **Collective.**
void agree_on(const Core& core, const std::vector<std::string>& problems);
void change(Core& core, std::optional<GivenPairs> positions, std::optional<GivenPairs> velocities,
            std::optional<GivenNumbers> spins);

} // namespace carrom::python
