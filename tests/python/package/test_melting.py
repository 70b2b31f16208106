# SPDX-License-Identifier: BSD-3-Clause
"""Order in dense discs: `carrom.melting` against freud on the same frames, tables and sums.

A crystal of 12 by 12 discs near melting, and a dense liquid of 300. freud works in single
precision.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import PERIODIC

import carrom
from carrom import melting, melting_neighbourhoods, melting_parts

pytest.importorskip("scipy.spatial", reason="scipy is not installed")

Array = npt.NDArray[Any]
FRAMES, EVERY = 16, 20


def scene_of(size: list[float], discs: dict[str, Any], every: int = EVERY) -> dict[str, Any]:
    return {
        "box": {"size": size, **PERIODIC},
        "discs": discs | {"speed": 0.05, "seed": 5},
        "time": {"steps": every * FRAMES, "method": "event-driven"},
        "output": {
            "trajectory": {
                "every_steps": every,
                "precision": "double",
                "fields": ["position", "psi6"],
            },
            "measurements": {
                "quantities": ["structure_factor", "psi6"],
                "every_steps": every,
                "largest_wavenumber": 8.0,
            },
        },
    }


@pytest.fixture(scope="module")
def crystal(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    """Rows along x, of discs with the diameter 1 at a packing of 0.74."""
    spacing = math.sqrt(math.pi / (2 * math.sqrt(3) * 0.74))
    size = [12 * spacing, 12 * spacing * math.sqrt(3) / 2]
    discs = {"count": 144, "packing": 0.74, "generator": "triangular"}
    folder = tmp_path_factory.mktemp("crystal") / "run"
    return carrom.run(scene_of(size, discs), threads=1, folder=folder)


@pytest.fixture(scope="module")
def liquid(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    discs = {"count": 300, "packing": 0.66, "generator": "compressed"}
    folder = tmp_path_factory.mktemp("liquid") / "run"
    return carrom.run(scene_of([24.0, 20.0], discs), threads=1, folder=folder)


@pytest.fixture(params=["crystal", "liquid"])
def dense(request: pytest.FixtureRequest) -> carrom.Run:
    run: carrom.Run = request.getfixturevalue(request.param)
    return run


def freud_module() -> Any:
    return pytest.importorskip("freud", reason="freud is not installed")


def freud_psi6(frame: carrom.Frame) -> Array:
    freud = freud_module()
    system = frame.to_freud()
    voronoi = freud.locality.Voronoi()
    voronoi.compute(system)
    hexatic = freud.order.Hexatic(k=6)
    hexatic.compute(system, neighbors=voronoi.nlist)
    order: Array = hexatic.particle_order
    return order


def test_orientation_is_that_of_freud(dense: carrom.Run) -> None:
    for frame in dense.frames[::5]:
        mean = freud_psi6(frame).mean()
        found = melting.orientation(frame)
        assert found.order == pytest.approx(abs(mean), abs=1e-4)
        assert found.angle == pytest.approx(np.angle(mean) / 6, abs=1e-4)


def test_rows_of_a_crystal_are_where_it_begins(crystal: carrom.Run) -> None:
    assert melting.orientation(crystal.frames[0]) == pytest.approx((0, 1), abs=1e-9)
    first = melting.positional_order(crystal.frames[0], reach=5.0, bins=100)
    spacing = melting.lattice_constant(crystal.frames[0])
    rows = np.flatnonzero(first.value)
    assert np.array_equal(rows, (np.arange(1, 5) * spacing / 0.05).astype(int))
    assert np.isnan(first.error).all()  # a single frame gives no error


def test_pairs_along_rows_are_those_of_freud(dense: carrom.Run) -> None:
    """freud counts pairs on a grid that is turned by an angle for each disc."""
    freud = freud_module()
    reach, bins, width = 4.0, 40, 0.4
    for frame in dense.frames[::5]:
        found = melting.positional_order(frame, reach, bins, width)
        n = frame.n_discs
        counts = np.zeros(bins)
        for row in range(3):
            pmft = freud.pmft.PMFTXY(x_max=reach, y_max=width / 2, bins=(2 * bins, 1))
            angles = np.full(n, melting.orientation(frame).angle + row * math.pi / 3)
            pmft.compute(frame.to_freud(), query_orientations=angles)
            both_ways = np.asarray(pmft.bin_counts).reshape(2 * bins)
            counts += both_ways[bins:] + both_ways[:bins][::-1]
        ideal = 3 * n * (n - 1) / float(np.prod(frame.box)) * 2 * width * reach / bins
        # Single precision moves a few pairs of 300 discs across an edge.
        assert np.abs(found.value * ideal - counts).sum() <= 12
        assert counts.sum() > 1000


def test_structure_map_is_the_sum_over_discs(dense: carrom.Run) -> None:
    frame = dense.frames[-1]
    found = melting.structure_map(frame)
    i, j = len(found.kx) // 3, len(found.ky) // 2
    phases = frame.x @ np.array([found.kx[i], found.ky[j]])
    expected = abs(np.exp(1j * phases).sum()) ** 2 / frame.n_discs
    assert found.s[i, j] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    for waves, edge in ((found.kx, frame.box[0]), (found.ky, frame.box[1])):
        numbers = waves * edge / (2 * np.pi)
        assert numbers == pytest.approx(np.round(numbers), abs=1e-9)


def test_structure_map_has_the_peak_of_the_table(crystal: carrom.Run) -> None:
    peak = crystal.tables["structure_factor_peak"][0]
    direction = math.atan2(peak["ky"], peak["kx"])
    found = melting.structure_map(crystal.frames, direction=direction)
    i, j = np.unravel_index(np.argmax(found.s), found.s.shape)
    assert (found.kx[i], found.ky[j]) == pytest.approx((peak["kx"], peak["ky"]))
    assert found.s[i, j] == pytest.approx(peak["S"], rel=1e-9)


def test_structure_map_stands_over_the_first_peak(crystal: carrom.Run) -> None:
    found = melting.structure_map(crystal.frames)
    i, j = np.unravel_index(np.argmax(found.s), found.s.shape)
    length = 4 * math.pi / (math.sqrt(3) * melting.lattice_constant(crystal.frames[0]))
    assert math.hypot(found.kx[i], found.ky[j]) == pytest.approx(length)
    assert found.s[i, j] > 0.2 * 144


def test_cells_are_those_of_freud(dense: carrom.Run) -> None:
    freud = freud_module()
    frame = dense.frames[-1]
    voronoi = freud.locality.Voronoi()
    voronoi.compute(frame.to_freud())
    expected = np.pi * frame.radius**2 / voronoi.volumes
    found = melting.cell_packing(frame)
    assert found == pytest.approx(expected, rel=1e-4)
    assert np.sum(np.pi * frame.radius**2 / found) == pytest.approx(np.prod(frame.box), rel=1e-12)


def test_cells_need_equal_radii(program: Path, tmp_path: Path) -> None:
    scene = scene_of([10.0, 10.0], {"species": [{"count": 9, "radius": r} for r in (0.4, 0.5)]})
    frame = carrom.run(scene, threads=1, folder=tmp_path / "mixed").frames[0]
    with pytest.raises(ValueError, match="radii differ"):
        melting.cell_packing(frame)
    areas = melting.local_packing(frame, 5.0, points=4)
    assert np.all(np.abs(areas * 25 - np.round(areas * 25 / 0.01) * 0.01) < 1e-9)


def test_circles_are_those_of_freud(dense: carrom.Run) -> None:
    freud = freud_module()
    radius = 3.0
    frame = dense.frames[-1]
    found = melting.local_packing(frame, radius, points=200)[0]
    points = melting_neighbourhoods.grid(frame, 200)
    box, discs = frame.to_freud()
    query = freud.locality.AABBQuery(box, discs)
    centred = np.column_stack([points - frame.box / 2, np.zeros(len(points))])
    pairs = query.query(centred, {"r_max": radius}).toNeighborList()
    expected = np.bincount(pairs.query_point_indices, minlength=len(points))
    counts = found * radius**2 / frame.radius[0] ** 2
    # Single precision can move a disc of a circle's edge.
    assert np.abs(counts - expected).max() <= 1 + 1e-6
    assert np.abs(counts - expected).sum() <= 4
    assert found.mean() == pytest.approx(frame.packing, rel=0.02)


def test_blocks_have_the_moments_of_the_history(dense: carrom.Run) -> None:
    """The box as a whole against the table, and parts against sums of freud's psi6."""
    whole, quarters = melting.block_order(dense.frames, parts=(1, 2))
    history = dense.tables["psi6_history"]["psi6"]
    n = dense.frames.n_discs
    assert whole.discs == n
    assert whole.order.value == pytest.approx(history.mean(), rel=1e-6)
    assert whole.square.value == pytest.approx((history**2).mean(), rel=1e-6)
    assert whole.susceptibility.value == pytest.approx(n * history.var(), rel=1e-3)
    ratio = (history**4).mean() / (history**2).mean() ** 2
    assert whole.cumulant.value == pytest.approx(1 - ratio / 2, rel=1e-6)
    squares = []
    for frame in dense.frames:
        psi6, box = freud_psi6(frame), frame.box
        for i in range(2):
            for j in range(2):
                inside = np.all(frame.x // (box / 2) % 2 == [i, j], axis=1)
                squares.append(abs(psi6[inside].mean()) ** 2)
    assert quarters.square.value == pytest.approx(np.mean(squares), rel=1e-3)
    assert quarters.discs == n / 4
    assert quarters.square.error > 0


def test_errors_of_g6_follow_the_scatter(liquid: carrom.Run) -> None:
    """Of samples that do not depend on each other an error is their scatter over the root of n."""
    table = liquid.tables["psi6_correlation"]
    far = table["from"] > 2
    edges = np.append(table["from"], table["to"][-1])
    samples = []
    for frame in liquid.frames:
        apart = frame.x[:, None] - frame.x
        apart -= frame.box * np.round(apart / frame.box)
        r = np.hypot(apart[..., 0], apart[..., 1])
        products = (np.conj(frame.psi6[:, None]) * frame.psi6).real
        pairs = np.maximum(1, np.histogram(r, edges)[0])
        samples.append(np.histogram(r, edges, weights=products)[0] / pairs)
    scatter = np.std(samples, axis=0, ddof=1) / math.sqrt(len(samples))
    ratio = table["g6_error"][far] / scatter[far]
    assert 0.7 < np.sqrt(np.mean(ratio**2)) < 2.5


def test_decay_finds_the_power() -> None:
    r = np.linspace(0.5, 30, 500)
    found = melting.decay(r, 3 * r**-0.25, (2, 20))
    assert found == pytest.approx((0.25, 0), abs=1e-9)
    comb = r ** (-1 / 3) * np.exp(-(np.sin(np.pi * r) ** 2) * 9)
    assert melting.decay(r, comb, (2.5, 28.5), spacing=1).value == pytest.approx(1 / 3, abs=0.01)
    with pytest.raises(ValueError, match="fewer than three"):
        melting.decay(r, comb, (3, 3.1))


def test_waves_are_sums_over_all_pairs(crystal: carrom.Run) -> None:
    """Against all pairs, in bins about the distances of rows; cells blur only their edges."""
    frame = crystal.frames[-1]
    spacing, n = melting.lattice_constant(frame), frame.n_discs
    apart = frame.x[:, None] - frame.x
    apart -= frame.box * np.round(apart / frame.box)
    bins = (np.hypot(apart[..., 0], apart[..., 1]) / spacing - 0.5).astype(int) - n * np.eye(n)
    k = 4 * math.pi / (math.sqrt(3) * spacing)
    waves = [k * np.array([math.cos(a), math.sin(a)]) for a in np.pi / 6 * np.array([1, 3, 5])]
    products = {
        "wave": np.mean([np.cos(apart @ wave) for wave in waves], axis=0),
        "bond": (np.conj(frame.psi6[:, None]) * frame.psi6).real,
    }
    for name, found in (
        ("wave", melting.wave_correlation(frame, reach=5.0)),
        ("bond", melting.bond_correlation(frame, reach=5.0)),
    ):
        assert len(found.r) == 4
        for row in range(4):
            expected = products[name][bins == row].mean()
            assert found.value[row] == pytest.approx(expected, abs=0.02), (name, row)
            assert found.r[row] == pytest.approx((row + 1) * spacing)


def test_errors_are_those_of_the_scatter() -> None:
    rng = np.random.default_rng(3)
    samples = rng.normal(size=(64, 2000))
    value, error = melting_parts.jackknife(samples, lambda mean: mean)
    assert np.sqrt(np.mean(error**2)) == pytest.approx(1 / 8, rel=0.05)
    assert np.std(value) == pytest.approx(1 / 8, rel=0.1)


def test_walls_and_lacking_fields_are_errors(program: Path, tmp_path: Path) -> None:
    scene = scene_of([24.0, 20.0], {"count": 20, "packing": 0.1})
    del scene["output"]["measurements"]
    scene["output"]["trajectory"]["fields"] = ["position"]
    periodic = carrom.run(scene, threads=1, folder=tmp_path / "periodic")
    with pytest.raises(carrom.NoDataError, match="psi6"):
        melting.orientation(periodic.frames[0])
    for radius in (-1.0, 11.0):
        with pytest.raises(ValueError, match="at most half"):
            melting.local_packing(periodic.frames[0], radius)
    with pytest.raises(carrom.NoDataError, match="at least one"):
        melting.block_order([])
    scene["box"] = {"size": [24.0, 20.0]}
    walled = carrom.run(scene, threads=1, folder=tmp_path / "walled")
    with pytest.raises(ValueError, match="periodic all round"):
        melting.cell_packing(walled.frames[0])
