# SPDX-License-Identifier: BSD-3-Clause
"""Averages of `carrom.Simulation`: errors cover the scatter, or there is a reason for none."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PERIODIC, gas

import carrom

pytestmark = pytest.mark.usefixtures("extension")

TOO_SHORT = (
    "too short: an error takes 16 steps and 32 collisions; speeds and single components of the "
    "pressure take 32 collisions of each disc"
)


def endless(**box: Any) -> dict[str, Any]:
    """A scene that does not say at which step it ends."""
    scene = gas(**box)
    del scene["time"]["steps"]
    return scene


def test_without_time_steps_errors_come_after_some_collisions() -> None:
    sim = carrom.Simulation(endless())
    sim.run(15)
    assert math.isnan(sim.averages["Z"].error)
    assert sim.averages["Z"].without_error == TOO_SHORT
    sim.run(1)
    assert 0 < sim.averages["Z"].error < sim.averages["Z"].value
    assert sim.averages["Z"].without_error == ""
    assert sim.averages["mean_speed"].without_error == TOO_SHORT
    sim.run(184)  # a disc collides once a step
    assert sim.averages["mean_speed"].error > 0
    assert sim.averages["kT"].without_error == "conserved"
    sim.velocities = -sim.velocities  # averages begin anew
    sim.run(40)
    assert sim.averages.first_step == 200
    assert sim.averages["P"].error > 0


@pytest.mark.parametrize("steps", [16, 50, 200])
@pytest.mark.parametrize("box", [{}, PERIODIC])
def test_errors_cover_the_scatter_between_seeds(steps: int, box: dict[str, Any]) -> None:
    names = ("Z", "P", "collision_frequency", "pressure_xy", "mean_speed", "speed_kurtosis")
    found: dict[str, list[carrom.Measured]] = {name: [] for name in names}
    for seed in range(1, 101):
        sim = carrom.Simulation(endless(**box), threads=1, discs__seed=seed)
        sim.run(steps)
        for name in names:
            found[name].append(sim.averages[name])
    for name, measured in found.items():
        values, errors = np.array(measured).T
        if np.isnan(errors).mean() > 0.1:
            assert steps == 16, name
            assert {one.without_error for one in measured} <= {TOO_SHORT, ""}, name
            continue
        claimed = math.sqrt(np.nanmean(errors**2))
        assert 0.25 < values.std(ddof=1) / claimed < 1.35, (name, steps)


def test_with_time_steps_the_reason_is_the_number_of_blocks(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=10_000)
    sim = carrom.Simulation(scene)
    assert sim.averages["Z"].without_error.startswith("nothing is averaged")
    sim.run(100)
    reason = "the 100 averaged steps make 1 block, and an error takes 4"
    assert sim.averages["Z"].without_error == reason
    assert sim.report["compressibility"]["without_error"] == reason
    run = carrom.run(gas(steps=2), folder=tmp_path / "run")
    assert carrom.compressibility(run).without_error == (
        "the 2 averaged steps make 2 blocks, and an error takes 4"
    )
    sim.run(300)
    assert sim.averages["Z"].without_error == ""
    assert sim.averages["Z"].error > 0


def test_the_reason_is_printed() -> None:
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    sim = carrom.Simulation(endless())
    sim.run(3)
    measured = sim.averages["Z"]
    value, error = measured
    assert repr(measured) == f"Measured(value={value!r}, error=nan ({TOO_SHORT}))"
    assert repr(carrom.Measured(2.0, 0.5)) == "Measured(value=2.0, error=0.5)"
    assert math.isnan(error)
    for same in (pickle.loads(pickle.dumps(measured)), copy.copy(measured)):
        assert same.without_error == TOO_SHORT
        assert same[0] == value
    table = sim.averages.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert table.loc["pressure", "without_error"] == TOO_SHORT
    assert TOO_SHORT in sim.averages._repr_html_()
