# SPDX-License-Identifier: BSD-3-Clause
"""Equations of state: theory against theory, and Z against the virial of the log."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import PERIODIC, gas

import carrom


def test_theories_agree_where_both_hold() -> None:
    packings = np.array([0.0, 0.1, 0.2, 0.3, 0.4])
    assert carrom.henderson(packings) == pytest.approx(carrom.virial_equation(packings), rel=3e-3)
    assert carrom.henderson(0.0) == carrom.virial_equation(0.0) == 1
    slope = (carrom.virial_equation(1e-6) - 1) / 1e-6
    assert slope == pytest.approx(2, rel=1e-5)  # the second virial coefficient of discs


def test_virial_equation_is_that_of_other_fits() -> None:
    """Liu, arXiv:2010.10624, and Luding, Phys. Rev. E 63, 042201 (2001)."""
    eta = np.linspace(0, 0.6, 25)
    liu = (1 + eta**2 / 8 + eta**3 / 18 - 4 * eta**4 / 21) / (1 - eta) ** 2
    contact = (1 - 7 * eta / 16) / (1 - eta) ** 2 - eta**3 / 16 / (8 * (1 - eta) ** 4)
    assert carrom.virial_equation(eta) == pytest.approx(liu, rel=1e-3)
    assert carrom.virial_equation(eta) == pytest.approx(1 + 2 * eta * contact, rel=1e-3)


def test_compressibility_is_that_of_the_virial(program: Path, tmp_path: Path) -> None:
    """Z from the frequency of collisions against the sum of impulses, which needs no theory."""
    scene = gas(count=400, steps=300, **PERIODIC) | {"output": {"collisions": True}}
    run = carrom.run(scene, folder=tmp_path / "run", discs__speed=1)
    z, error = carrom.compressibility(run)
    frame = run.checkpoints[-1]
    energy = frame.kinetic_energy - np.sum(frame.v.sum(axis=0) ** 2) / (2 * frame.n_discs)
    impulses = float(np.sum(run.collisions["impulse"]))
    virial = 1 + 2 * frame.radius[0] * impulses / (2 * energy * 300)
    assert z == pytest.approx(virial, rel=0.01)
    assert 0 < error < 0.02
    assert abs(z - carrom.henderson(0.3)) < 4 * error + 0.01


def test_compressibility_between_walls_is_that_of_the_gas(program: Path, tmp_path: Path) -> None:
    run = carrom.run(gas(count=400, steps=200), folder=tmp_path / "run")
    z, error = carrom.compressibility(run)
    assert abs(z / carrom.henderson(0.3) - 1) < 0.03
    assert 0 < error < 0.02


def test_averages_that_a_scene_does_not_have_are_errors(program: Path, tmp_path: Path) -> None:
    half = {side: PERIODIC[side] for side in ("left", "right")}
    run = carrom.run(gas(steps=2, **half), folder=tmp_path / "half")
    with pytest.raises(carrom.NoDataError, match="the report has no virial_pressure"):
        carrom.average(run, "virial_pressure")
    start = carrom.run(gas(steps=0), folder=tmp_path / "start")
    with pytest.raises(carrom.NoDataError, match="the report has no compressibility"):
        carrom.compressibility(start)
    with pytest.raises(carrom.NoDataError, match="the report has no mean_speed"):
        carrom.average(start, "mean_speed")


def test_arrays_and_lists_are_taken() -> None:
    for function in (carrom.henderson, carrom.virial_equation):
        wanted = [function(0.1), function(0.5)]
        assert isinstance(wanted[0], float)
        for packing in ([0.1, 0.5], (0.1, 0.5), np.array([0.1, 0.5])):
            assert function(packing).tolist() == wanted


def test_quantities_are_those_of_the_report(run: carrom.Run) -> None:
    def has_value(entry: object) -> bool:
        return isinstance(entry, dict) and entry["value"] is not None

    found = carrom.quantities(run)
    report = run.report
    tensor = {f"pressure_{part}": entry for part, entry in report["pressure_tensor"].items()}
    names = ("temperature", "pressure", "compressibility")
    averages = {name: report[name] for name in names} | tensor | report["averages"]
    assert set(found) == {name for name, entry in averages.items() if has_value(entry)}
    assert {"temperature", "pressure", "pressure_xy", "mean_speed"} <= set(found)
    for name, (value, _) in found.items():
        assert value == averages[name]["value"]
        assert carrom.average(run, name).value == value
    with pytest.raises(
        carrom.NoDataError, match=r"no presure of this scene; it has .*wall_pressure"
    ):
        carrom.average(run, "presure")
