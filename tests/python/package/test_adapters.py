# SPDX-License-Identifier: BSD-3-Clause
"""freud, MDAnalysis, ASE, OVITO and gsd get what is in the files; each with the real package."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import PERIODIC, gas

import carrom

SPECIES = [{"count": 10, "radius": 1.0, "mass": 4}, {"count": 40, "radius": 0.5}]


@pytest.fixture(scope="module")
def mixture(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    scene = gas(**PERIODIC) | {"discs": {"species": SPECIES}}
    scene["output"] = {"trajectory": {"every_steps": 5}}
    return carrom.run(scene, folder=tmp_path_factory.mktemp("mixture") / "run")


def neighbours(frame: carrom.Frame, reach: float) -> int:
    """Pairs within a distance, by all pairs and nearest images."""
    x = frame.x.astype(float)
    gaps = x[:, None] - x[None]
    for axis, is_periodic in enumerate(frame.periodic):
        if is_periodic:
            gaps[..., axis] -= frame.box[axis] * np.round(gaps[..., axis] / frame.box[axis])
    near = np.hypot(gaps[..., 0], gaps[..., 1]) < reach
    return int(np.count_nonzero(np.triu(near, 1)))


@pytest.mark.parametrize("which", ["mixture", "run"])
def test_freud_finds_the_neighbours(which: str, request: pytest.FixtureRequest) -> None:
    """Between walls that are apart there are no neighbours across the sides."""
    freud = pytest.importorskip("freud", reason="freud is not installed")
    source: carrom.Run = request.getfixturevalue(which)
    walls = None if which == "mixture" else "apart"
    box, points = source.frames[-1].to_freud(walls=walls)
    assert box.is2D
    query = freud.locality.AABBQuery(box, points).query(points, {"r_max": 3.0, "exclude_ii": True})
    assert len(query.toNeighborList()) == 2 * neighbours(source.frames[-1], 3.0)
    assert len(source.frames.to_freud(walls=walls)) == 5


def test_mdanalysis_has_the_frames(mixture: carrom.Run) -> None:
    pytest.importorskip("MDAnalysis", reason="MDAnalysis is not installed")
    frames = mixture.frames
    universe = frames.to_mdanalysis()
    assert universe.trajectory.dt == 5
    assert [moment.time for moment in universe.trajectory] == [0, 5, 10, 15, 20]
    for moment, frame in zip(universe.trajectory, frames):
        flown = (frame.x + frame.image * frame.box).astype(np.float32)
        assert np.array_equal(moment.positions[:, :2], flown)
        assert np.array_equal(moment.velocities[:, :2], frame.v)
        assert moment.dimensions.tolist() == [20, 20, 20, 90, 90, 90]
    assert universe.atoms.radii.tolist() == [1.0] * 10 + [0.5] * 40
    assert universe.atoms.masses.tolist() == [4.0] * 10 + [1.0] * 40
    assert universe.atoms.types.tolist() == ["1"] * 10 + ["2"] * 40
    assert len(universe.select_atoms("type 2")) == 40
    wrapped = frames.to_mdanalysis(unwrapped=False)
    for moment, frame in zip(wrapped.trajectory, frames):
        assert np.array_equal(moment.positions[:, :2], frame.x)
    alone = mixture.checkpoints[-1].to_mdanalysis()
    assert [moment.time for moment in alone.trajectory] == [20]
    with pytest.raises(ValueError, match="not equally far apart"):
        carrom.adapters.to_mdanalysis([frames[0], frames[1], frames[3]])


@pytest.mark.parametrize("which", ["mixture", "run"])
def test_mdanalysis_finds_the_neighbours(which: str, request: pytest.FixtureRequest) -> None:
    """Also between walls, and as many as counting all pairs gives, in its RDF too."""
    pytest.importorskip("MDAnalysis", reason="MDAnalysis is not installed")
    from MDAnalysis.analysis.rdf import InterRDF
    from MDAnalysis.lib.distances import self_capped_distance

    source: carrom.Run = request.getfixturevalue(which)
    universe = source.frames[-1].to_mdanalysis(walls=None if which == "mixture" else "apart")
    wanted = neighbours(source.frames[-1], 3.0)
    pairs = self_capped_distance(
        universe.atoms.positions, 3.0, box=universe.dimensions, return_distances=False
    )
    assert len(pairs) == wanted
    discs = universe.atoms
    rdf = InterRDF(discs, discs, nbins=3, range=(0, 3.0), norm="none", exclusion_block=(1, 1))
    assert rdf.run().results.count.sum() == 2 * wanted


def test_ase_has_the_discs(mixture: carrom.Run) -> None:
    pytest.importorskip("ase", reason="ASE is not installed")
    frame = mixture.checkpoints[-1]
    atoms = frame.to_ase()
    assert np.array_equal(atoms.positions[:, :2], frame.x)
    assert atoms.get_velocities()[:, :2] == pytest.approx(frame.v, rel=1e-15)
    assert atoms.get_kinetic_energy() == pytest.approx(frame.kinetic_energy, rel=1e-14)
    assert atoms.cell.lengths().tolist() == [20, 20, 1]
    assert atoms.pbc.tolist() == [True, True, False]
    assert np.array_equal(atoms.get_masses(), frame.mass)
    assert np.array_equal(atoms.get_array("radius"), frame.radius)
    assert atoms.info == {"step": 20, "time": 20.0}
    assert len(mixture.frames.to_ase()) == 5


def test_ovito_has_discs_to_scale(mixture: carrom.Run) -> None:
    pytest.importorskip("ovito", reason="OVITO is not installed")
    pipeline = mixture.frames.to_ovito()
    assert pipeline.num_frames == 5
    for number, frame in enumerate(mixture.frames):
        data = pipeline.compute(number)
        assert np.array_equal(data.particles.positions[:, :2], frame.x)
        assert data.attributes["Timestep"] == frame.step
    assert data.cell.is2D
    assert tuple(data.cell.pbc) == (True, True, False)
    assert np.array_equal(data.particles["Radius"], frame.radius.astype(np.float32))
    assert [kind.radius for kind in data.particles.particle_types.types] == [1.0, 0.5]
    assert [kind.name for kind in data.particles.particle_types.types] == ["species 1", "species 2"]
    alone = mixture.checkpoints[-1].to_ovito()
    assert np.array_equal(alone.particles.positions[:, :2], mixture.checkpoints[-1].x)


def test_gsd_has_the_frames(mixture: carrom.Run, tmp_path: Path) -> None:
    hoomd = pytest.importorskip("gsd.hoomd", reason="gsd is not installed")
    path = carrom.to_gsd(mixture, tmp_path / "t.gsd")
    with hoomd.open(path) as file:
        assert [moment.configuration.step for moment in file] == [0, 5, 10, 15, 20]
        for moment, frame in zip(file, mixture.frames):
            centred = (frame.x - frame.box / 2).astype(np.float32)
            assert np.array_equal(moment.particles.position[:, :2], centred)
            assert np.array_equal(moment.particles.velocity[:, :2], frame.v)
            assert moment.configuration.dimensions == 2
            assert moment.configuration.box.tolist() == [20, 20, 0, 0, 0, 0]
        assert moment.particles.diameter.tolist() == [2.0] * 10 + [1.0] * 40
        assert moment.particles.mass.tolist() == [4.0] * 10 + [1.0] * 40
        assert moment.particles.typeid.tolist() == [0] * 10 + [1] * 40


@pytest.mark.parametrize(
    ("method", "package"),
    [("freud", "freud-analysis"), ("mdanalysis", "MDAnalysis"), ("ase", "ase"), ("ovito", "ovito")],
)
def test_a_missing_package_says_how_to_get_it(
    run: carrom.Run, monkeypatch: pytest.MonkeyPatch, method: str, package: str
) -> None:
    for name in ("freud", "MDAnalysis", "ase", "ovito", "ovito.data"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(carrom.MissingPackageError, match=f"pip install {package}"):
        getattr(run.frames[0], f"to_{method}")()


def test_a_library_of_the_system_that_ovito_lacks_is_named(
    run: carrom.Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "ovito").mkdir()
    lacking = "raise ImportError('libEGL.so.1: cannot open shared object file')\n"
    (tmp_path / "ovito/__init__.py").write_text("")
    for name in ("data", "pipeline"):
        (tmp_path / f"ovito/{name}.py").write_text(lacking)
    for name in [name for name in sys.modules if name.split(".")[0] == "ovito"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.syspath_prepend(str(tmp_path))
    for source in (run.frames[0], run.frames):
        with pytest.raises(carrom.MissingPackageError, match=r"libEGL.*apt-get install libegl1"):
            source.to_ovito()  # type: ignore[attr-defined]


def test_a_field_that_is_missing_is_named(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=2)
    scene["output"] = {"trajectory": {"every_steps": 1, "fields": ["velocity"]}}
    frame = carrom.run(scene, folder=tmp_path / "run").frames[0]
    wanted = "frames have no position, only velocity; output.trajectory.fields"
    for method, package in (("freud", "freud"), ("mdanalysis", "MDAnalysis"), ("ase", "ase")):
        if importlib.util.find_spec(package) is not None:
            with pytest.raises(carrom.NoDataError, match=f"to_{method} needs .*{wanted}"):
                getattr(frame, f"to_{method}")()
    with pytest.raises(carrom.NoDataError, match=wanted):
        frame.x  # noqa: B018
