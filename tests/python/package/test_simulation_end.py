# SPDX-License-Identifier: BSD-3-Clause
"""`close()` and `with`: what they free, and what stays usable."""

from __future__ import annotations

import contextlib
import ctypes
import os
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PERIODIC, gas, measured

import carrom

pytestmark = pytest.mark.usefixtures("extension")

USES: list[Any] = [
    lambda s, _: s.run(1),
    lambda s, _: s.positions,
    lambda s, _: setattr(s, "velocities", np.zeros((60, 2))),
    lambda s, _: s.averages,
    lambda s, _: s.tables,
    lambda s, _: s.report,
    lambda s, _: s.step,
    lambda s, _: s.box,
    lambda s, _: s.local,
    lambda s, _: s.frame,
    lambda s, _: s.copy(),
    lambda s, _: s.every(1, print),
    lambda s, path: s.checkpoint(path / "c.h5"),
    lambda s, _: s.__enter__(),
]


def test_a_closed_simulation_says_so(tmp_path: Path) -> None:
    sim = carrom.Simulation(gas())
    sim.run(3)
    positions, frame, averages, tables = sim.positions, sim.frame, sim.averages, sim.tables
    sim.close()
    sim.close()
    for use in USES:
        with pytest.raises(carrom.CarromError, match="the simulation is closed; begin a new"):
            use(sim, tmp_path)
    assert not list(tmp_path.iterdir())
    assert repr(sim) == "<Simulation of 60 discs, closed>"
    assert "closed" in sim._repr_html_()
    assert np.array_equal(frame.x, positions)
    assert averages.steps == 3
    assert not tables
    assert sim.masses.sum() == sim.n_discs == 60
    assert sim.corner.tolist() == [0, 0]


def test_with_closes_at_the_end_and_after_an_error() -> None:
    with carrom.Simulation(measured(**PERIODIC)) as sim:
        sim.run(4)
        twin = sim.copy()
    with pytest.raises(carrom.CarromError, match="is closed"):
        sim.run(1)
    twin.run(4)  # a copy is independent
    whole = carrom.Simulation(measured(**PERIODIC))
    whole.run(8)
    assert twin.state_hash == whole.state_hash
    twin.every(1, lambda s: 1 / 0)
    with pytest.raises(ZeroDivisionError), twin:
        twin.run(1)
    with pytest.raises(carrom.CarromError, match="is closed"):
        twin.run(1)


def test_an_action_cannot_close_its_simulation() -> None:
    sim = carrom.Simulation(gas())
    closing = sim.every(2, lambda s: s.close())
    with pytest.raises(carrom.CarromError, match="an action cannot close the simulation"):
        sim.run(5)
    assert sim.step == 2
    sim.forget(closing)
    sim.run(3)
    sim.close()


def resident_bytes() -> int:
    """Bytes of this process, after the C library has given back what is free."""
    with contextlib.suppress(AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
    pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


def test_close_frees_the_discs_and_the_actions() -> None:
    """Half of the 114 bytes a disc at least, although the object and a cycle of it live on."""
    scene = gas(count=200_000) | {"box": {"size": 2000}}
    scene["discs"]["generator"] = "lattice"
    carrom.Simulation(scene, threads=1).close()  # libraries and buffers of the first use
    sim = carrom.Simulation(scene, threads=1)

    class Action:
        def __call__(self, _: object) -> None:
            pass

    action = Action()
    alive = weakref.ref(action)
    sim.every(1, action)
    del action
    before = resident_bytes()
    sim.close()
    assert before - resident_bytes() > 200_000 * 57
    assert alive() is None
