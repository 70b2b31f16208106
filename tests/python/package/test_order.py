# SPDX-License-Identifier: BSD-3-Clause
"""psi6, neighbours and structure factors of the program against SciPy, freud and NumPy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import PERIODIC, gas

import carrom

Numbers = npt.NDArray[Any]

BOXES: dict[str, dict[str, Any]] = {
    "walls": {},
    "periodic along x": {side: PERIODIC[side] for side in ("left", "right")},
    "periodic": PERIODIC,
}


def ordered(folder: Path, box: dict[str, Any], quantities: list[str]) -> carrom.Run:
    """A gas, measured at the steps of its frames."""
    scene = gas(count=300, steps=40, **box)
    scene["discs"]["speed"] = 0.5
    scene["output"] = {
        "trajectory": {
            "every_steps": 10,
            "precision": "double",
            "fields": ["position", "psi6", "neighbours"],
        },
        "measurements": {"quantities": quantities, "every_steps": 10, "bins": 40},
    }
    return carrom.run(scene, threads=1, folder=folder)


def with_images(x: Numbers, size: float, periodic: tuple[bool, bool]) -> Numbers:
    """Points and, behind them, their images: shifted ones, and reflected ones at walls."""
    images = [x]
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            image = x.copy()
            for axis, k in enumerate((i, j)):
                if periodic[axis]:
                    image[:, axis] += k * size
                elif k != 0:
                    image[:, axis] = (1 + k) * size - image[:, axis]
            if (i, j) != (0, 0):
                images.append(image)
    return np.concatenate(images)


def bonds(x: Numbers, size: float, periodic: tuple[bool, bool]) -> tuple[Numbers, Numbers]:
    """psi6 and numbers of neighbours by SciPy's Voronoi diagram."""
    spatial = pytest.importorskip("scipy.spatial", reason="SciPy is not installed")
    n = len(x)
    points = with_images(x, size, periodic)
    # A reflected point stands for the wall; a point that is only shifted along a periodic axis is a
    # disc.
    is_disc = np.concatenate(
        [
            np.full(n, all(periodic[a] or k == 0 for a, k in enumerate((i, j))))
            for i, j in [(0, 0)]
            + [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
        ]
    )
    sums, counts = np.zeros(n, dtype=complex), np.zeros(n, dtype=int)
    for pair in spatial.Voronoi(points).ridge_points:
        for a, b in (pair, pair[::-1]):
            if a < n and is_disc[b]:
                dx, dy = points[b] - points[a]
                sums[a] += np.exp(6j * np.arctan2(dy, dx))
                counts[a] += 1
    return sums / np.maximum(counts, 1), counts


@pytest.mark.parametrize("name", BOXES)
def test_psi6_is_that_of_scipy(program: Path, tmp_path: Path, name: str) -> None:
    run = ordered(tmp_path / "run", BOXES[name], ["psi6"])
    size, periodic = float(run.frames[0].box[0]), run.frames[0].periodic
    tables, history = run.tables, run.tables["psi6_history"]
    n_neighbours, moduli = np.zeros(13, dtype=int), np.zeros(40, dtype=int)
    pairs, products = np.zeros(40, dtype=int), np.zeros(40)
    reach = tables["psi6_correlation"]["to"][-1]
    for k, frame in enumerate(run.frames):
        psi6, counts = bonds(frame.x, size, periodic)
        assert frame.neighbours.tolist() == counts.tolist()
        assert frame.psi6 == pytest.approx(psi6, abs=1e-12)
        n_neighbours += np.bincount(counts, minlength=13)
        moduli += np.histogram(np.abs(psi6), bins=40, range=(0, 1 + 1e-12))[0]
        assert history["psi6"][k] == pytest.approx(abs(np.mean(psi6)), abs=1e-12)
        assert history["real"][k] == pytest.approx(np.mean(psi6).real, abs=1e-12)
        assert history["imaginary"][k] == pytest.approx(np.mean(psi6).imag, abs=1e-12)
        assert history["local"][k] == pytest.approx(np.mean(np.abs(psi6)), abs=1e-12)
        assert history["fivefold"][k] == pytest.approx(np.mean(counts == 5), abs=1e-15)
        first, second = np.triu_indices(len(psi6), 1)
        apart = frame.x[first] - frame.x[second]
        apart -= np.where(periodic, size * np.round(apart / size), 0)
        bins = np.floor(np.hypot(*apart.T) / reach * 40).astype(int)
        near = bins < 40
        pairs += np.bincount(bins[near], minlength=40)
        values = (np.conj(psi6[first]) * psi6[second]).real[near]
        products += np.bincount(bins[near], weights=values, minlength=40)
    assert tables["neighbours"]["count"].tolist() == n_neighbours.tolist()
    assert tables["psi6_distribution"]["count"].tolist() == moduli.tolist()
    assert tables["psi6_correlation"]["pairs"].tolist() == pairs.tolist()
    assert tables["psi6_correlation"]["g6"] * pairs == pytest.approx(products, abs=1e-9)


def test_psi6_is_that_of_freud(program: Path, tmp_path: Path) -> None:
    freud = pytest.importorskip("freud", reason="freud is not installed")
    run = ordered(tmp_path / "run", PERIODIC, ["psi6"])
    for k, frame in enumerate(run.frames):
        box, points = frame.to_freud()
        voronoi = freud.locality.Voronoi().compute((box, points))
        order = freud.order.Hexatic(k=6).compute((box, points), neighbors=voronoi.nlist)
        mean = abs(np.mean(order.particle_order))
        assert run.tables["psi6_history"]["psi6"][k] == pytest.approx(mean, abs=2e-5)  # floats


def test_structure_factor_is_the_sum_over_discs(program: Path, tmp_path: Path) -> None:
    run = ordered(tmp_path / "run", PERIODIC, ["structure_factor"])
    size = float(run.frames[0].box[0])
    table, peak = run.tables["structure_factor"], run.tables["structure_factor_peak"]
    largest = table["to"][-1]
    assert largest == pytest.approx(2 * np.pi / run.frames[0].radius[0])
    n_most = int(largest * size / (2 * np.pi)) + 1
    n, m = np.meshgrid(np.arange(-n_most, n_most + 1), np.arange(n_most + 1), indexing="ij")
    wanted = ((m > 0) | (n > 0)) & (2 * np.pi / size * np.hypot(n, m) <= largest)
    k = 2 * np.pi / size * np.stack([n[wanted], m[wanted]], axis=1)
    s = np.mean(
        [np.abs(np.exp(1j * frame.x @ k.T).sum(axis=0)) ** 2 / 300 for frame in run.frames], axis=0
    )
    bins = np.minimum((np.hypot(*k.T) / largest * 40).astype(int), 39)
    counts = np.bincount(bins, minlength=40)
    sums = np.bincount(bins, weights=s, minlength=40)
    assert table["count"].tolist() == counts.tolist()
    assert np.all(np.isnan(table["S"]) == (counts == 0))
    assert table["S"][counts > 0] == pytest.approx((sums / np.maximum(counts, 1))[counts > 0])
    assert peak["S"][0] == pytest.approx(np.max(s))
    assert peak["k"][0] == pytest.approx(np.hypot(*k[np.argmax(s)]))


def test_partial_structure_factors_are_sums_over_species(program: Path, tmp_path: Path) -> None:
    species = [{"count": 100, "radius": 0.35}, {"count": 80, "radius": 0.2, "mass": 0.5}]
    scene = {
        "box": {"size": 20, **PERIODIC},
        "discs": {"species": species, "speed": 0.5},
        "time": {"steps": 40, "method": "event-driven"},
        "output": {
            "trajectory": {"every_steps": 10, "precision": "double", "fields": ["position"]},
            "measurements": {
                "quantities": ["partial_structure_factor"],
                "every_steps": 10,
                "bins": 15,
                "largest_wavenumber": 6,
            },
        },
    }
    run = carrom.run(scene, threads=1, folder=tmp_path / "run")
    table = run.tables["partial_structure_factor"]
    n, m = np.meshgrid(np.arange(-20, 21), np.arange(21), indexing="ij")
    wanted = ((m > 0) | (n > 0)) & (2 * np.pi / 20 * np.hypot(n, m) <= 6)
    k = 2 * np.pi / 20 * np.stack([n[wanted], m[wanted]], axis=1)
    bins = np.minimum((np.hypot(*k.T) / 6 * 15).astype(int), 14)
    counts = np.bincount(bins, minlength=15)
    assert table["count"].tolist() == counts.tolist()
    parts = (slice(0, 100), slice(100, 180))
    modes = [[np.exp(1j * f.x[part] @ k.T).sum(axis=0) for part in parts] for f in run.frames]
    for a, b in ((0, 0), (0, 1), (1, 1)):
        s = np.mean([(mode[a] * np.conj(mode[b])).real / 180 for mode in modes], axis=0)
        sums = np.bincount(bins, weights=s, minlength=15)
        found = table[f"S_{a + 1}_{b + 1}"]
        assert found[counts > 0] == pytest.approx((sums / np.maximum(counts, 1))[counts > 0])
