# SPDX-License-Identifier: BSD-3-Clause
"""`carrom.Simulation` against the program: the same bits however it is called, and what is refused.

Needs the extension: the variable CARROM_CORE, `build-python/` of the checkout, or a wheel.
"""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PERIODIC, gas, measured

import carrom

pytestmark = pytest.mark.usefixtures("extension")


def equal_tables(tables: Any, wanted: Any) -> None:
    assert set(tables) == set(wanted)
    for name in wanted:
        assert tables[name].dtype == wanted[name].dtype, name
        ours = tables[name].remarks  # in files the scene's name precedes these remarks
        assert ours
        assert ours == wanted[name].remarks[-len(ours) :], name
        for column in wanted[name].columns:  # where both have nan they are equal
            np.testing.assert_array_equal(tables[name][column], wanted[name][column])


SCENES = {
    "walls": measured(),
    "periodic": measured(**PERIODIC),
    "time-stepped": measured("time-stepped"),
    "falling": measured() | {"effects": {"gravity": {"y": -0.001}}},
}


@pytest.mark.parametrize("name", SCENES)
def test_the_bits_are_those_of_the_program(program: Path, tmp_path: Path, name: str) -> None:
    run = carrom.run(SCENES[name], threads=1, folder=tmp_path / "run")
    frame = run.checkpoints[-1]
    for threads in (1, 2, 3):
        sim = carrom.Simulation(SCENES[name], threads=threads)
        sim.run(40)
        assert sim.state_hash == run.state_hash
        assert np.array_equal(sim.positions, frame.x)
        assert np.array_equal(sim.velocities, frame.v)
        assert np.array_equal(sim.pair_collisions, frame.pair_collisions)
        assert np.array_equal(sim.wall_collisions, frame.wall_collisions)
        equal_tables(sim.tables, run.tables)
        for average, wanted in carrom.quantities(run).items():
            if average in sim.averages:
                assert sim.averages[average].value == pytest.approx(wanted.value, rel=1e-14)


@pytest.mark.parametrize("name", SCENES)
def test_single_steps_and_copies_and_checkpoints_change_nothing(name: str, tmp_path: Path) -> None:
    whole = carrom.Simulation(SCENES[name], threads=1)
    whole.run(40)
    single = carrom.Simulation(SCENES[name], threads=2)
    twin = None
    for step in range(40):
        if step == 17:
            twin = single.copy()
            assert single.checkpoint(tmp_path / "c.h5") == tmp_path / "c.h5"
        single.run(1)
        assert single.step == step + 1
        _ = single.positions, single.totals
    assert twin is not None
    assert twin.step == 17
    twin.run(23)
    later = carrom.Simulation(tmp_path / "c.h5", threads=1)
    assert later.step == 17
    later.run(23)
    for other in (single, twin, later):
        assert other.state_hash == whole.state_hash
        equal_tables(other.tables, whole.tables)
        assert other.averages["Z"].value == whole.averages["Z"].value


def test_the_program_goes_on_from_its_checkpoint(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=30)
    sim = carrom.Simulation(scene)
    sim.run(10)
    sim.checkpoint(tmp_path / "c.h5")
    sim.run(20)
    command = [str(program), "run", "--restart", str(tmp_path / "c.h5"), "-o", str(tmp_path / "r")]
    subprocess.run(command, check=True, capture_output=True)
    assert carrom.open(tmp_path / "r").state_hash == sim.state_hash
    again = carrom.Simulation(carrom.Checkpoint(tmp_path / "c.h5"), time__steps=15)
    assert (again.step, again.last_step) == (10, 15)


@pytest.mark.parametrize("box", [{}, PERIODIC])
def test_turned_round_it_comes_back(box: dict[str, Any]) -> None:
    sim = carrom.Simulation(gas(steps=1000, **box))
    start = sim.positions
    sim.run(8)
    there = sim.collisions
    assert there > 20
    sim.velocities = -sim.velocities
    assert sim.averages.first_step == 8
    sim.run(8)
    assert sim.collisions == 2 * there
    assert np.abs(sim.positions - start).max() < 1e-8


def test_what_is_changed_is_a_function_of_arrays_alone() -> None:
    """The same arrays at the same step give the same bits, on any threads and after any calls."""
    hashes = set()
    for threads, cuts in ((1, [8]), (3, [1, 2, 5]), (2, [4, 4])):
        sim = carrom.Simulation(gas(steps=40, **PERIODIC), threads=threads)
        for cut in cuts:
            sim.run(cut)
        rng = np.random.default_rng(4)
        sim.velocities = rng.normal(0, 0.3, (60, 2))
        sim.run(10)
        positions = sim.positions.copy()
        positions[3] = positions[3] + 1e-6
        sim.positions = positions
        sim.run(20)
        hashes.add(sim.state_hash)
    assert len(hashes) == 1


def test_setting_what_is_there_changes_no_bit() -> None:
    sim = carrom.Simulation(measured(**PERIODIC))
    sim.run(13)
    before = sim.state_hash
    sim.change(positions=sim.positions, velocities=sim.velocities, spins=sim.spins)
    assert sim.state_hash == before
    assert sim.averages.first_step == 0


def test_swaps_of_positions_keep_the_energy() -> None:
    sim = carrom.Simulation(gas(steps=100))
    sim.run(5)
    energy, positions = sim.energy, sim.positions.copy()
    positions[[1, 2]] = positions[[2, 1]]
    sim.positions = positions
    assert np.array_equal(sim.positions, positions)
    sim.run(20)
    assert sim.energy == pytest.approx(energy, rel=1e-12)
    assert sim.totals["overlapping_pairs"] == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: {"velocities": s.velocities * np.nan}, "disc 0: has a number that is not"),
        (lambda s: {"positions": s.positions + 100}, "outside of the box"),
        (lambda s: {"positions": s.positions * 0 + 10}, "1770 pairs of discs overlap"),
        (lambda s: {"spins": s.spins + 1}, "only rough discs turn"),
    ],
)
def test_what_cannot_be_is_refused(change: Any, message: str) -> None:
    sim = carrom.Simulation(gas(steps=50))
    sim.run(3)
    before = sim.state_hash
    with pytest.raises(carrom.SceneError, match=message):
        sim.change(**change(sim))
    assert sim.state_hash == before
    sim.run(3)


def test_overlaps_are_refused_in_the_time_stepped_method_too() -> None:
    """It allows those that its own steps leave, but no new ones."""
    scene = gas(steps=50)
    scene["time"] |= {"method": "time-stepped", "micro_steps": 64}
    sim = carrom.Simulation(scene)
    sim.run(3)
    positions = sim.positions.copy()
    positions[4] = positions[5] + 0.01
    with pytest.raises(carrom.SceneError, match=r"^change: .* would overlap, the deepest by"):
        sim.positions = positions
    assert sim.step == 3


def test_arrays_of_another_shape_are_refused() -> None:
    sim = carrom.Simulation(gas())
    with pytest.raises(ValueError, match=r"velocities have the shape \(60, 2\), not \(2, 60\)"):
        sim.velocities = sim.velocities.T
    with pytest.raises(ValueError, match="read-only"):
        sim.positions[0] = 3
