# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that freud, MDAnalysis, ASE, OVITO and gsd compute are those that Carrom has measured.

Two scenes: a periodic gas that flows through its sides many times, and a gas between walls. The
references are the tables and the report of the program, or counts over all pairs.
"""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import PERIODIC

import carrom

REACH, BINS = 6.0, 24
EVERY, STEPS = 10, 300
Array = npt.NDArray[Any]


def scene_of(**box: Any) -> dict[str, Any]:
    return {
        "box": {"size": [40, 30], **box},
        "discs": {"count": 300, "packing": 0.4},
        "time": {"steps": STEPS, "method": "event-driven"},
        "output": {
            "trajectory": {"every_steps": EVERY, "precision": "double"},
            "measurements": {
                "quantities": ["radial_distribution", "displacement", "thermo"],
                "every_steps": EVERY,
                "bins": BINS,
                "largest_distance": REACH,
            },
        },
    }


@pytest.fixture(scope="module")
def periodic(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    return carrom.run(scene_of(**PERIODIC), folder=tmp_path_factory.mktemp("periodic") / "run")


@pytest.fixture(scope="module")
def walled(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    return carrom.run(scene_of(), folder=tmp_path_factory.mktemp("walled") / "run")


@pytest.fixture(scope="module")
def channel(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    """Periodic along x, walls along y."""
    sides = {side: {"kind": "periodic"} for side in ("left", "right")}
    return carrom.run(scene_of(**sides), folder=tmp_path_factory.mktemp("channel") / "run")


def edges() -> Array:
    return np.linspace(0, REACH, BINS + 1)


def ideal(run: carrom.Run) -> Array:
    """Expected pairs of an ideal gas, over all frames."""
    return np.sum([frame.ideal_pairs(edges()) for frame in run.frames], axis=0)


def freud_pairs(run: carrom.Run, walls: str | None) -> Array:
    """Pairs by distance over all frames, from freud's neighbour lists in double precision."""
    freud = pytest.importorskip("freud", reason="freud is not installed")
    counts = np.zeros(BINS, dtype=np.int64)
    for box, points in run.frames.to_freud(walls=walls):
        query = freud.locality.AABBQuery(box, points)
        found = query.query(points, {"r_max": REACH, "exclude_ii": True}).toNeighborList()
        counts += np.histogram(found.distances, edges())[0]
    return counts / 2


def close_counts(pairs: Array, table: carrom.Table) -> None:
    """The same pairs, but for those within single precision of the edge of a bin."""
    assert np.sum(table["pairs"]) > 10_000
    assert pairs == pytest.approx(table["pairs"], abs=3)


@pytest.mark.parametrize("which", ["periodic", "walled", "channel"])
def test_g_of_freud_is_that_of_the_table(which: str, request: pytest.FixtureRequest) -> None:
    run: carrom.Run = request.getfixturevalue(which)
    table = run.tables["radial_distribution"]
    pairs = freud_pairs(run, None if which == "periodic" else "apart")
    close_counts(pairs, table)
    filled = table["pairs"] > 100
    g = pairs[filled] / ideal(run)[filled]
    assert g == pytest.approx(table["g"][filled], rel=0.02)
    exact = table["pairs"] / ideal(run)
    assert exact == pytest.approx(table["g"], rel=1e-9)


def test_rdf_of_freud_needs_no_factor_between_periodic_sides(periodic: carrom.Run) -> None:
    freud = pytest.importorskip("freud", reason="freud is not installed")
    rdf = freud.density.RDF(bins=BINS, r_max=REACH, normalization_mode="finite_size")
    for system in periodic.frames.to_freud():
        rdf.compute(system, reset=False)
    table = periodic.tables["radial_distribution"]
    filled = table["pairs"] > 100
    assert rdf.rdf[filled] == pytest.approx(table["g"][filled], rel=0.02)


@pytest.mark.parametrize("which", ["periodic", "walled"])
def test_rdf_of_mdanalysis_counts_the_same_pairs(
    which: str, request: pytest.FixtureRequest
) -> None:
    pytest.importorskip("MDAnalysis", reason="MDAnalysis is not installed")
    from MDAnalysis.analysis.rdf import InterRDF

    run: carrom.Run = request.getfixturevalue(which)
    universe = run.frames.to_mdanalysis(walls=None if which == "periodic" else "apart")
    discs = universe.atoms
    rdf = InterRDF(
        discs, discs, nbins=BINS, range=(0, REACH), norm="none", exclusion_block=(1, 1)
    ).run()
    close_counts(rdf.results.count / 2, run.tables["radial_distribution"])


def test_rdf_of_mdanalysis_with_the_factor_of_the_page(periodic: carrom.Run) -> None:
    pytest.importorskip("MDAnalysis", reason="MDAnalysis is not installed")
    from MDAnalysis.analysis.rdf import InterRDF

    universe = periodic.frames.to_mdanalysis()
    discs = universe.atoms
    rdf = InterRDF(discs, discs, nbins=BINS, range=(0, REACH), exclusion_block=(1, 1)).run()
    g = rdf.results.rdf * 2 * rdf.results.bins / universe.dimensions[2]
    table = periodic.tables["radial_distribution"]
    filled = table["pairs"] > 100
    assert g[filled] == pytest.approx(table["g"][filled], rel=0.02)


def test_msd_of_mdanalysis_is_that_of_the_table(periodic: carrom.Run) -> None:
    """Discs fly through the sides, so that wrapped positions would give another result."""
    pytest.importorskip("MDAnalysis", reason="MDAnalysis is not installed")
    from MDAnalysis.analysis.msd import EinsteinMSD

    assert max(np.abs(periodic.frames[-1].image).max(axis=0)) >= 2
    universe = periodic.frames.to_mdanalysis()
    msd = EinsteinMSD(universe, msd_type="xy", fft=False).run().results.timeseries
    flown = np.stack([frame.x + frame.image * frame.box for frame in periodic.frames])
    for lag in (1, 7, len(flown) - 1):
        steps = flown[lag:] - flown[:-lag]
        assert msd[lag] == pytest.approx(np.mean(np.sum(steps**2, axis=2)), rel=1e-5)
    since_start = periodic.tables["displacement"]
    assert msd[-1] == pytest.approx(since_start["sum"][-1], rel=1e-4)
    wrapped = periodic.frames.to_mdanalysis(unwrapped=False)
    wrong = EinsteinMSD(wrapped, msd_type="xy", fft=False).run().results.timeseries
    assert np.max(np.abs(wrong[1:] / msd[1:] - 1)) > 0.2


def test_msd_of_freud_is_that_of_the_table(periodic: carrom.Run) -> None:
    freud = pytest.importorskip("freud", reason="freud is not installed")
    frames = periodic.frames
    box, _ = frames[0].to_freud()
    x = np.stack([np.pad(frame.x - frame.box / 2, ((0, 0), (0, 1))) for frame in frames])
    images = np.stack([np.pad(frame.image, ((0, 0), (0, 1))) for frame in frames])
    msd = freud.msd.MSD(box, mode="direct").compute(x, images).msd
    since_start = periodic.tables["displacement"]
    assert msd[-1] == pytest.approx(since_start["sum"][-1], rel=1e-4)


def test_images_that_are_missing_are_an_error(program: Path, tmp_path: Path) -> None:
    pytest.importorskip("MDAnalysis", reason="MDAnalysis is not installed")
    scene = scene_of(**PERIODIC)
    scene["output"] = {"checkpoint": {"every_steps": 1, "keep": 9}}
    scene["time"]["steps"] = 2
    run = carrom.run(scene, folder=tmp_path / "run")
    with pytest.raises(carrom.NoDataError, match=r"needs the field image.*unwrapped=False"):
        carrom.adapters.to_mdanalysis(run.checkpoints)
    wrapped = carrom.adapters.to_mdanalysis(run.checkpoints, unwrapped=False)
    assert len(wrapped.trajectory) == 2


@pytest.mark.parametrize(
    ("package", "call"),
    [
        ("freud", lambda run, path: run.frames[0].to_freud()),
        ("freud", lambda run, path: run.frames.to_freud()),
        ("MDAnalysis", lambda run, path: run.frames.to_mdanalysis()),
        ("gsd", lambda run, path: carrom.to_gsd(run, path / "run.gsd")),
    ],
)
def test_walls_are_refused_where_a_box_would_be_repeated(
    walled: carrom.Run, tmp_path: Path, package: str, call: Any
) -> None:
    pytest.importorskip(package, reason=f"{package} is not installed")
    with pytest.raises(ValueError, match=r'box has walls.*radial_distribution.*walls="apart"'):
        call(walled, tmp_path)
    assert not list(tmp_path.glob("*.gsd"))
    with pytest.raises(ValueError, match=r'walls is None or "apart"'):
        walled.frames[0].to_freud(walls="near")


def all_pairs(frame: carrom.Frame, reach: float) -> int:
    """Pairs within a distance, by all pairs and nearest images."""
    gaps = frame.x[:, None].astype(float) - frame.x[None]
    for axis, is_periodic in enumerate(frame.periodic):
        if is_periodic:
            gaps[..., axis] -= frame.box[axis] * np.round(gaps[..., axis] / frame.box[axis])
    return int(np.count_nonzero(np.triu(np.hypot(gaps[..., 0], gaps[..., 1]) < reach, 1)))


@pytest.mark.parametrize("which", ["periodic", "walled"])
def test_ase_has_neighbours_and_energy(which: str, request: pytest.FixtureRequest) -> None:
    pytest.importorskip("ase", reason="ASE is not installed")
    from ase.neighborlist import neighbor_list

    run: carrom.Run = request.getfixturevalue(which)
    frame = run.frames[-1]
    atoms = frame.to_ase()
    assert len(neighbor_list("i", atoms, 3.0)) == 2 * all_pairs(frame, 3.0)
    assert atoms.get_kinetic_energy() == pytest.approx(run.thermo["energy"][-1], rel=1e-6)


@pytest.mark.parametrize("which", ["periodic", "walled"])
def test_ovito_has_neighbours_and_energy(which: str, request: pytest.FixtureRequest) -> None:
    pytest.importorskip("ovito.data", reason="OVITO is not installed")
    from ovito.data import CutoffNeighborFinder

    run: carrom.Run = request.getfixturevalue(which)
    frame = run.frames[-1]
    data = frame.to_ovito()
    finder = CutoffNeighborFinder(3.0, data)
    found = sum(1 for disc in range(frame.n_discs) for _ in finder.find(disc))
    assert found == 2 * all_pairs(frame, 3.0)
    energy = 0.5 * np.sum(data.particles["Mass"][:, None] * data.particles["Velocity"][:] ** 2)
    assert energy == pytest.approx(run.thermo["energy"][-1], rel=1e-6)


@pytest.mark.parametrize("which", ["periodic", "walled"])
def test_gsd_has_neighbours_energy_and_the_log(
    which: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    hoomd = pytest.importorskip("gsd.hoomd", reason="gsd is not installed")
    run: carrom.Run = request.getfixturevalue(which)
    walls = None if which == "periodic" else "apart"
    path = carrom.to_gsd(run, tmp_path / "run.gsd", walls=walls)
    with hoomd.open(path) as file:
        last = file[-1]
        particles = last.particles
        edges_of_box = last.configuration.box[:2].astype(float)
        gaps = (particles.position[:, None] - particles.position[None])[..., :2].astype(float)
        gaps -= edges_of_box * np.round(gaps / edges_of_box)
        near = np.hypot(gaps[..., 0], gaps[..., 1]) < 3.0
        assert np.count_nonzero(np.triu(near, 1)) == all_pairs(run.frames[-1], 3.0)
        energy = 0.5 * np.sum(particles.mass[:, None] * particles.velocity.astype(float) ** 2)
        assert energy == pytest.approx(run.thermo["energy"][-1], rel=1e-5)
        for moment, frame in zip(file, run.frames):
            row = run.thermo[run.thermo["step"] == frame.step][0]
            assert moment.log["carrom/kinetic_energy"][0] == pytest.approx(
                frame.kinetic_energy, rel=1e-12
            )
            assert moment.log["carrom/temperature"][0] == row["temperature"]
            assert moment.log["carrom/time"][0] == frame.step
    values = hoomd.read_log(path)
    assert np.array_equal(values["log/carrom/energy"].ravel(), run.thermo["energy"])


def test_ase_reads_the_velocities_of_extended_xyz(
    program: Path, periodic: carrom.Run, tmp_path: Path
) -> None:
    pytest.importorskip("ase", reason="ASE is not installed")
    import ase.io

    file = tmp_path / "last.xyz"
    source = periodic.checkpoints[-1]
    command = [str(program), "convert", str(source.path), "--to", "xyz", "--output", str(file)]
    subprocess.run(command, check=True)
    atoms = ase.io.read(file, format="extxyz")
    assert atoms.get_velocities()[:, :2] == pytest.approx(source.v, rel=1e-12)
    assert atoms.get_kinetic_energy() == pytest.approx(source.kinetic_energy, rel=1e-12)
    assert np.array_equal(atoms.get_masses(), source.mass)


def test_ideal_pairs_refuse_what_does_not_fit(walled: carrom.Run, periodic: carrom.Run) -> None:
    for run, most in ((walled, 30), (periodic, 15)):
        with pytest.raises(ValueError, match="shorter side"):
            run.frames[0].ideal_pairs([0, most + 0.1])
