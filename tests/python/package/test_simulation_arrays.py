# SPDX-License-Identifier: BSD-3-Clause
"""What is assigned to a `carrom.Simulation`: arrays of all kinds, and names that nobody has."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import PERIODIC, gas

import carrom

pytestmark = pytest.mark.usefixtures("extension")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("velocity", r"no attribute velocity; did you mean velocities\?"),
        ("position", r"did you mean positions\?"),
        ("temperature", "positions, spins, velocities can be set"),
        ("radii", "radii cannot be set; positions, spins, velocities can"),
        ("box", "box cannot be set"),
        ("last_step", "last_step cannot be set"),
        ("step", "step cannot be set"),
        ("run", "run cannot be set"),
    ],
)
def test_a_wrong_assignment_is_an_error_not_nothing(name: str, message: str) -> None:
    sim = carrom.Simulation(gas())
    with pytest.raises(AttributeError, match=message):
        setattr(sim, name, 1.0)
    assert sim.step == 0


def test_facts_cannot_be_written_to() -> None:
    sim = carrom.Simulation(gas())
    for array in (sim.box, sim.radii, sim.masses, sim.species, sim.positions, sim.images):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 3


@pytest.mark.parametrize("name", ["positions", "velocities", "spins"])
def test_none_is_no_array(name: str) -> None:
    """A function that forgets to return its array gives None."""
    sim = carrom.Simulation(gas())
    with pytest.raises(TypeError, match=f"{name} are real numbers, not None"):
        setattr(sim, name, None)
    assert sim.report["changes"] == {}


KINDS: dict[str, Any] = {
    "other bytes first": lambda v: v.astype(">f8"),
    "long": lambda v: v.astype(np.longdouble),
    "every second row": lambda v: np.repeat(v, 2, axis=0)[::2],
    "columns turned": lambda v: np.ascontiguousarray(v[:, ::-1])[:, ::-1],
    "read-only": lambda v: np.frombuffer(v.tobytes()).reshape(-1, 2),
    "unaligned": lambda v: np.frombuffer(b"-" + v.tobytes(), np.float64, offset=1).reshape(-1, 2),
    "a generator's list": lambda v: [tuple(row) for row in v],
}


@pytest.mark.parametrize("kind", KINDS)
def test_arrays_however_they_lie_in_memory(kind: str) -> None:
    sim = carrom.Simulation(gas())
    wanted = np.random.default_rng(3).normal(0, 0.3, (60, 2))
    sim.velocities = KINDS[kind](wanted)
    assert np.array_equal(sim.velocities, wanted)


def test_a_given_array_is_copied() -> None:
    sim = carrom.Simulation(gas())
    given = np.array(sim.velocities[::-1])
    sim.velocities = given
    kept = given.copy()
    given[:] = np.nan
    sim.run(0)
    assert np.array_equal(sim.velocities, kept)


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (np.zeros((60, 2), dtype=object), TypeError),
        (np.zeros(60, dtype=[("x", float), ("y", float)]), TypeError),
        (np.zeros((60, 2), dtype="M8[s]"), TypeError),
        (np.zeros((60, 2, 1)), ValueError),
        (np.zeros((0, 2)), ValueError),
        ([[1, 2], [3]], ValueError),
        ("velocities", TypeError),
        ({"x": 1}, TypeError),
    ],
)
def test_no_array_of_numbers_is_refused(values: Any, error: type[Exception]) -> None:
    sim = carrom.Simulation(gas())
    before = sim.state_hash
    with pytest.raises(error):
        sim.velocities = values
    assert sim.state_hash == before


def test_places_at_the_far_edge_of_a_period_are_outside_of_it() -> None:
    """`np.mod` gives the box itself for small negative numbers; the message says so."""
    sim = carrom.Simulation(gas(**PERIODIC))
    positions = sim.positions.copy()
    positions[0, 0] = np.mod(-1e-18, 20)
    with pytest.raises(carrom.SceneError, match=r"outside of the box, \[0, 20\) x \[0, 20\)"):
        sim.positions = positions
