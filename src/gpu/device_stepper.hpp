// SPDX-License-Identifier: BSD-3-Clause
// The implementation of Stepper (stepper.hpp). It owns the device's memory and starts the kernels
// in order.
//
// Bytes per disc: 64 for its state, 64 for a second copy while discs are sorted, 8 for its cell and
// its place in the cell, and about 10 for the table of cells. Between two sorts the second copy is
// free, and its memory holds the next events and lists.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "gpu/kernels.hpp"
#include "gpu/stepper.hpp"

namespace carrom {

template <class OfMotion, class Machine> class DeviceStepper final : public Stepper {
    using D = DeviceDynamics<OfMotion>;
    using Memory = typename Machine::Memory;

public:
    DeviceStepper(const OfMotion& motion, const SpeciesTable& species, std::uint32_t n)
        : n_(n), world_(D(motion)), discs_(allocate<DiscState>(n)), spare_(allocate<DiscState>(n)),
          cell_(allocate<std::uint32_t>(n)), place_(allocate<std::uint32_t>(n)),
          counters_(allocate<DeviceCounters>(1)),
          stripes_(allocate<StressPieces>(World<D>::n_stripes)) {
        world_.n = n;
        world_.cell = as<std::uint32_t>(cell_);
        world_.counters = as<DeviceCounters>(counters_);
        world_.stripes = as<StressPieces>(stripes_);
        const DeviceCounters none;
        Machine::copy_to_device(counters_.get(), &none, sizeof none);
        Machine::zero(stripes_.get(), sizeof(StressPieces) * World<D>::n_stripes);
        if constexpr (OfMotion::has_species)
            world_.dynamics.look_up_species_in(
                species.copied_by([&](const auto* from, std::size_t n_of_them) {
                    return copy_of_table(from, n_of_them);
                }));
        point_at_discs();
    }

    void put(std::span<const DiscState> discs) override {
        Machine::copy_to_device(discs_.get(), discs.data(), discs.size_bytes());
    }
    void get(std::span<DiscState> discs) override {
        Machine::copy_to_host(discs.data(), discs_.get(), discs.size_bytes());
    }

    DeviceOutcome run(const DeviceWindow& window) override {
        begin(window, false);
        sort(window.reach);
        Machine::for_each(n_, Predict<D>{world_});
        for (int m = window.window.first_micro; m < window.window.end_micro(); ++m)
            run_micro_step(m, m + 1 == window.window.end_micro());
        const DeviceCounters counters = read_counters();
        return {static_cast<int>(counters.n_micro), counters.squared_speed.value(),
                counters.n_candidates, counters.n_kept};
    }

    double restart(double time, bool ends_flights, const DeviceWindow& window) override {
        begin(window, true);
        Machine::for_each(n_, Restart<D>{world_, time, ends_flights});
        return read_counters().squared_speed.value();
    }

    void take_stress(StressSums& sums) override {
        constexpr std::size_t n_bytes = sizeof(StressPieces) * World<D>::n_stripes;
        std::vector<StressPieces> stripes(World<D>::n_stripes);
        Machine::copy_to_host(stripes.data(), stripes_.get(), n_bytes);
        Machine::zero(stripes_.get(), n_bytes);
        add_stripes(stripes, sums);
    }

private:
    template <class T> static Memory allocate(std::size_t n) {
        return Machine::allocate(n * sizeof(T));
    }
    template <class T> static T* as(const Memory& memory) { return static_cast<T*>(memory.get()); }
    template <class T> const T* copy_of_table(const T* from, std::size_t n) {
        tables_.push_back(allocate<T>(n));
        Machine::copy_to_device(tables_.back().get(), from, n * sizeof(T));
        return as<T>(tables_.back());
    }

    DeviceCounters read_counters() const {
        DeviceCounters counters;
        Machine::copy_to_host(&counters, counters_.get(), sizeof counters);
        return counters;
    }

    /// Passes the window's data to the kernels and starts the reset of the counters, without
    /// waiting for the device.
    void begin(const DeviceWindow& window, bool forgets_speed) {
        world_.window = window.window;
        world_.squared_window_speed = window.speed * window.speed;
        world_.flown = window.flown;
        world_.stress_scale = window.stress_scale;
        Machine::for_each(1, Begin<D>{world_, forgets_speed});
    }

    /// Sorts the discs into cells for the given reach.
    void sort(double reach) {
        Periods periods;
        if constexpr (D::is_periodic) periods = world_.dynamics.periods();
        world_.cells = cells_for(world_.dynamics.box(), periods, reach, n_);
        const std::uint32_t n_cells = world_.cells.n_cells();
        if (n_cells + 1 > most_cells_) {
            most_cells_ = n_cells + 1 + n_cells / 8;
            begins_.reset(); // freed first, so that memory never holds old and new cells together
            begins_ = allocate<std::uint32_t>(most_cells_);
        }
        world_.cells.begins = as<std::uint32_t>(begins_);
        Machine::zero(begins_.get(), sizeof(std::uint32_t) * (n_cells + 1));
        const PutIntoCells<D> put{world_, world_.cells.begins, as<std::uint32_t>(place_)};
        Machine::for_each(n_, put);
        Machine::sum_before(world_.cells.begins, n_cells + 1, scratch_);
        Machine::for_each(n_, Scatter<D>{put, as<DiscState>(spare_)});
        std::swap(discs_, spare_);
        point_at_discs();
    }

    /// Uses the memory of the free copy of states for the arrays of a window.
    void point_at_discs() {
        world_.discs = as<DiscState>(discs_);
        auto* next = static_cast<std::byte*>(spare_.get());
        const auto carve = [&]<class T>(T*& array) {
            array = reinterpret_cast<T*>(next);
            next += sizeof(T) * n_;
        };
        carve(world_.time); // the widest numbers come first, so that all are aligned
        carve(world_.partner);
        carve(world_.is_listed);
        carve(world_.active);
        carve(world_.changed);
        carve(world_.waiting[0]);
        carve(world_.waiting[1]);
        carve(world_.image_x);
        carve(world_.image_y);
        carve(world_.micro);
        carve(world_.taken);
    }

    void run_micro_step(int m, bool is_last) {
        const DeviceCounters* counters = world_.counters;
        const auto n_eights = static_cast<std::uint32_t>((std::uint64_t{n_} + 7) / 8);
        static_assert(Collect<D>::at_once == 8);
        Machine::for_each(n_eights, Collect<D>{world_, m});
        Machine::for_each_of(&counters->n_active, n_, Match<D>{world_, m});
        const Waiting<D> waiting{world_, m};
        for (int round = 0; round < rounds_of_all; ++round) Machine::run_round(waiting, round, n_);
        Machine::finish_rounds(waiting, rounds_of_all);
        Machine::for_each_of(&counters->n_active, n_, Carry<D>{world_, m});
        if (!is_last) {
            Machine::for_each_of(&counters->n_active, n_, Mark<D>{world_, m});
            Machine::for_each_of(&counters->n_changed, n_, Renew<D>{world_, m});
        }
        Machine::for_each(1, EndMicroStep<D>{world_});
    }

    std::uint32_t n_;
    World<D> world_;
    Memory discs_, spare_, cell_, place_, counters_, stripes_, begins_;
    std::vector<Memory> tables_;
    typename Machine::Scratch scratch_;
    std::uint32_t most_cells_ = 0;
};

} // namespace carrom
