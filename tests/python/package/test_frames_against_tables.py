# SPDX-License-Identifier: BSD-3-Clause
"""Tables of a run against numpy's evaluation of the frames that it has stored."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from conftest import PERIODIC

import carrom

Array = npt.NDArray[np.float64]

SIZE, N_SMALL, N_LARGE, STEPS = 24.0, 60, 20, 100
WAVENUMBER, OVERLAP, POINTS = 3.0, 0.5, 8
LAGS = [*range(1, 9), *range(10, 17, 2), *range(20, 33, 4), *range(40, 65, 8), 80, 96]
N_X, N_Y, SAMPLES = 3, 2, 10


@pytest.fixture(scope="module")
def recorded(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    """A mixture with a frame in double precision at each sample."""
    scene = {
        "box": {"size": SIZE, **PERIODIC},
        "discs": {
            "speed": 0.5,
            "species": [
                {"count": N_SMALL, "radius": 0.7, "mass": 1},
                {"count": N_LARGE, "radius": 1, "mass": 2},
            ],
        },
        "time": {"steps": STEPS, "method": "event-driven"},
        "output": {
            "trajectory": {"every_steps": 1, "precision": "double"},
            "measurements": {
                "quantities": ["profiles", "correlations"],
                "every_steps": 1,
                "correlation_points": POINTS,
                "correlation_wavenumber": WAVENUMBER,
                "overlap_distance": OVERLAP,
                "profile_columns": N_X,
                "profile_rows": N_Y,
                "profile_samples": SAMPLES,
            },
        },
    }
    return carrom.run(scene, threads=1, folder=tmp_path_factory.mktemp("runs") / "recorded")


def from_centre_of_mass(numbers: Array, masses: Array) -> Array:
    mean = (numbers * masses[None, :, None]).sum(axis=1, keepdims=True) / masses.sum()
    return numbers - mean


def correlations_of(x: Array, v: Array, lag: int) -> dict[str, float]:
    """At origins that are multiples of the spacing of the lag's level."""
    spacing = 1
    while POINTS * spacing < lag:
        spacing *= 2
    first = np.arange(0, len(x) - lag, spacing)
    way = x[first + lag] - x[first]
    squares = (way**2).sum(axis=2)
    overlap = (squares < OVERLAP**2).mean(axis=1)
    return {
        "count": len(first),
        "squares": squares.mean(),
        "velocities": (v[first + lag] * v[first]).sum(axis=2).mean(),
        "scattering": np.cos(WAVENUMBER * way).mean(),
        "alpha_2": (squares**2).mean() / (2 * squares.mean() ** 2) - 1,
        "overlap": overlap.mean(),
        "chi_4": x.shape[1] * overlap.var(),
    }


def test_correlations_are_those_of_frames(recorded: carrom.Run) -> None:
    frames = list(recorded.frames)
    masses = frames[0].mass
    x = from_centre_of_mass(np.array([f.x + f.image * SIZE for f in frames]), masses)
    v = from_centre_of_mass(np.array([f.v for f in frames]), masses)
    for name, discs in (
        ("correlations", slice(None)),
        ("correlations_1", slice(N_SMALL)),
        ("correlations_2", slice(N_SMALL, None)),
    ):
        table = recorded.tables[name]
        assert table["steps"].tolist() == LAGS
        for row in table:
            expected = correlations_of(x[:, discs], v[:, discs], int(row["steps"]))
            for column, value in expected.items():
                assert row[column] == pytest.approx(value, rel=1e-12, abs=1e-12), (name, column)


def thermal_of(samples: list[tuple[np.ndarray, np.ndarray]]) -> dict[str, float]:
    """Sums over samples (masses, velocities) of a cell, about each sample's own mean velocity.

    A mean velocity of n discs takes the share 1 / n of squares and 3 / n - 2 / n^2 of cubes, which
    are given back: docs/reference/measurements.md.
    """
    sums = dict.fromkeys(("pairs", "threes", "xx", "xy", "yy", "heat_x", "heat_y"), 0.0)
    for m, v in samples:
        n = len(m)
        if n < 2:
            continue
        c = v - (m[:, None] * v).sum(axis=0) / m.sum()
        sums["pairs"] += n
        for name, product in (
            ("xx", c[:, 0] ** 2),
            ("xy", c[:, 0] * c[:, 1]),
            ("yy", c[:, 1] ** 2),
        ):
            sums[name] += n / (n - 1) * (m * product).sum()
        if n < 3:
            continue
        sums["threes"] += n
        energies = m * (c**2).sum(axis=1) / 2
        for name, along in (("heat_x", c[:, 0]), ("heat_y", c[:, 1])):
            sums[name] += n**2 / ((n - 1) * (n - 2)) * (energies * along).sum()
    return sums


def test_profiles_are_those_of_frames(recorded: carrom.Run) -> None:
    table = recorded.tables["profiles"]
    area = SAMPLES * SIZE**2 / (N_X * N_Y)
    assert len(table) == N_X * N_Y * (STEPS // SAMPLES)
    for row in table:
        last = int(row["to_step"])
        half = np.array([SIZE / N_X, SIZE / N_Y]) / 2
        samples = []
        for frame in recorded.frames[last - SAMPLES + 1 : last + 1]:
            inside = (np.abs(frame.x - [row["x"], row["y"]]) <= half).all(axis=1)
            samples.append((frame.mass[inside], frame.v[inside]))
        m = np.concatenate([masses for masses, _ in samples])
        v = np.concatenate([velocities for _, velocities in samples])
        mean = (m[:, None] * v).sum(axis=0) / m.sum()
        sums = thermal_of(samples)
        per_pair, per_three = len(m) / sums["pairs"], len(m) / sums["threes"]
        expected = {
            "count": len(m),
            "density": len(m) / area,
            "vx": mean[0],
            "vy": mean[1],
            "temperature": (sums["xx"] + sums["yy"]) / (2 * sums["pairs"]),
            "xx": per_pair * sums["xx"] / area,
            "xy": per_pair * sums["xy"] / area,
            "yy": per_pair * sums["yy"] / area,
            "heat_x": per_three * sums["heat_x"] / area,
            "heat_y": per_three * sums["heat_y"] / area,
        }
        for column, value in expected.items():
            assert row[column] == pytest.approx(value, rel=1e-12, abs=1e-12), column
