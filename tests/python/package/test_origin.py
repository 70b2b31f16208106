# SPDX-License-Identifier: BSD-3-Clause
"""`box.origin` in Python: frames, simulations, pictures, adapters and imports.

The reference is the same scene in coordinates from the corner. Boxes are powers of two long, so
that sums are exact.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PERIODIC

import carrom
from carrom.importing.importer import Choice, import_discs, read_discs
from carrom.watch.picture import picture
from carrom.watch.walls import walls_at

HALF = np.array([16.0, 8.0])


def scene(origin: Any = None, **others: Any) -> dict[str, Any]:
    by = np.zeros(2) if origin is None else HALF
    corner, top = (np.array([1.0, 1.0]) - by).tolist(), (np.array([14.0, 15.0]) - by).tolist()
    pin = (np.array([20.0, 8.0]) - by).tolist()
    box = {"size": [32, 16], **others}
    return {
        "box": box if origin is None else {**box, "origin": origin},
        "discs": {"count": 30, "radius": 0.5, "region": [*corner, *top]},
        "time": {"steps": 20, "method": "event-driven"},
        "effects": {"obstacles": {"discs": [[*pin, 1.0]]}},
        "output": {"trajectory": {"every_steps": 5}},
    }


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory, program: Path) -> list[carrom.Run]:
    folder = tmp_path_factory.mktemp("origin")
    return [
        carrom.run(scene(origin), folder=folder / name, progress=False)
        for name, origin in (("corner", None), ("centre", "centre"))
    ]


def test_frames(both: list[carrom.Run]) -> None:
    corner, centre = both
    assert corner.report["state_hash"] == centre.report["state_hash"]
    assert centre.report["origin"] == HALF.tolist()
    for frame, other in zip(corner.frames, centre.frames):
        assert other.x.dtype == frame.x.dtype == np.float32
        # float32 positions; the sum rounds once more
        np.testing.assert_allclose(other.x, frame.x - HALF, rtol=0, atol=2e-6)
        np.testing.assert_array_equal(other.v, frame.v)
        np.testing.assert_array_equal(other.corner, -HALF)
        np.testing.assert_array_equal(frame.corner, [0, 0])
        assert other.x.min() < 0
        assert other.present.all()
    np.testing.assert_allclose(centre.frames.x, corner.frames.x - HALF, rtol=0, atol=2e-6)
    assert other._repr_html_().count("<circle") == 30


def test_checkpoints(both: list[carrom.Run]) -> None:
    one, other = (run.checkpoints[-1] for run in both)
    np.testing.assert_array_equal(other.x, one.x - HALF)
    np.testing.assert_array_equal(other.corner, -HALF)
    assert other.present.all()


@pytest.mark.usefixtures("extension")
def test_simulation() -> None:
    corner, centre = (
        carrom.Simulation({**scene(origin), "output": {}}) for origin in (None, "centre")
    )
    for sim in (corner, centre):
        sim.run(10)
    np.testing.assert_array_equal(centre.positions, corner.positions - HALF)
    np.testing.assert_array_equal(centre.frame.x, centre.positions)
    np.testing.assert_array_equal(centre.corner, -HALF)
    assert centre.frame.present.all()
    assert centre.report["origin"] == HALF.tolist()
    assert "origin" not in corner.report
    assert centre.state_hash == corner.state_hash
    before = centre.state_hash
    centre.positions = centre.positions  # nothing changes, so all bits stay
    assert centre.state_hash == before
    places = corner.positions.copy()
    places[3] = [28.25, 3.5]
    corner.positions, centre.positions = places, places - HALF
    np.testing.assert_array_equal(centre.positions, places - HALF)
    for sim in (corner, centre):
        sim.run(10)
    assert centre.state_hash == corner.state_hash
    places = centre.positions.copy()
    places[0] = [16.25, 0]
    with pytest.raises(carrom.SceneError, match=r"at \(16.25, 0\) lies outside .*\[-16, 16\]"):
        centre.positions = places
    places[0] = [4.25, 0.5]
    with pytest.raises(carrom.SceneError, match=r"at \(4.25, 0.5\) overlaps fixed disc 1"):
        centre.positions = places
    copy = centre.copy()
    np.testing.assert_array_equal(copy.positions, centre.positions)


@pytest.mark.usefixtures("extension")
def test_bits_stay_where_the_sum_rounds() -> None:
    """A disc that is not moved keeps places that its coordinates cannot tell."""
    settings = {**scene("centre"), "output": {}}
    settings["box"]["origin"] = [0.1, 9.7]
    settings["discs"]["region"] = [0.9, -8.7, 13.9, 5.3]
    settings["effects"] = {}
    sim = carrom.Simulation(settings)
    sim.run(7)
    before = sim.state_hash
    sim.positions = sim.positions
    assert sim.state_hash == before
    places = sim.positions.copy()
    places[0] = [20, 0.5]
    sim.positions = places
    np.testing.assert_allclose(sim.positions, places, rtol=0, atol=2**-48)
    np.testing.assert_array_equal(sim.positions[1:], places[1:])


def test_picture(both: list[carrom.Run]) -> None:
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    matplotlib.use("Agg")
    from carrom import plot

    ax = plot.frame(both[1])
    assert ax.get_xlim() == (-16, 16)
    assert ax.get_ylim() == (-8, 8)
    discs = ax.collections[-1]
    np.testing.assert_array_equal(discs.get_offsets(), both[1].frames[-1].x)
    (sides,) = [patch for patch in ax.patches if not patch.get_fill()]
    assert sides.get_xy() == (-16, -8)
    (pin,) = ax.collections[0].get_paths()
    np.testing.assert_allclose(pin.get_extents().get_points().mean(axis=0), [4, 0], atol=1e-9)
    matplotlib.pyplot.close("all")


def test_watcher(both: list[carrom.Run]) -> None:
    corner, centre = (run.frames[-1] for run in both)
    about, numbers = picture(centre, "speed", None)
    other, same = picture(corner, "speed", None)
    assert about["walls"] == [-16, -8, 16, 8]
    assert about["view"] == [-16, -8, 16, 8]
    assert other["walls"] == [0, 0, 32, 16]
    # both count from the view's corner
    np.testing.assert_allclose(np.frombuffer(numbers, "<f4"), np.frombuffer(same, "<f4"), atol=4e-6)
    moving = scene("centre", right={"kind": "moving", "speed": 0.5})
    walls = walls_at(moving, [42, 16], 20, centre.corner)
    assert walls.places == (-16, -8, 26, 8)
    assert walls.room == (-16, -8, 26, 8)


def test_freud(both: list[carrom.Run]) -> None:
    pytest.importorskip("freud", reason="freud is not installed")
    (_, one), (_, other) = (run.frames[-1].to_freud(walls="apart") for run in both)
    np.testing.assert_allclose(one, other, atol=4e-6)


def test_ase(both: list[carrom.Run]) -> None:
    pytest.importorskip("ase", reason="ase is not installed")
    atoms = both[1].frames[-1].to_ase()
    np.testing.assert_array_equal(atoms.get_celldisp().ravel(), [-16, -8, 0])
    np.testing.assert_array_equal(atoms.positions[:, :2], both[1].frames[-1].x)


def test_periodic_order(tmp_path: Path, program: Path) -> None:
    """Melting and g6 do not depend on where (0, 0) is."""
    pytest.importorskip("scipy", reason="scipy is not installed")
    from carrom.melting_parts import present

    settings = scene("centre", **PERIODIC)
    run = carrom.run(settings, folder=tmp_path / "run", progress=False)
    inside = present(run.frames[-1])
    assert np.all((inside >= 0) & (inside < run.frames[-1].box))
    np.testing.assert_allclose(inside, run.frames[-1].x + HALF, atol=4e-6)


XYZ = """2
Lattice="20 0 0 0 10 0 0 0 1" Origin="-10 -5 0" Properties=species:S:1:pos:R:3:velo:R:3 pbc="T F F"
A -8 0 0 0 0.5 0
A 13 2.25 0 0 -0.5 0
"""


def test_import(tmp_path: Path, program: Path) -> None:
    """With `keep_origin` places stay, but for those beyond a periodic side."""
    source = tmp_path / "gas.xyz"
    source.write_text(XYZ, encoding="utf-8")
    choice = Choice(radius={"": 1.0})
    np.testing.assert_array_equal(read_discs(source, choice).columns["x"], [2, 3])
    choice.keep_origin = True
    np.testing.assert_array_equal(read_discs(source, choice).columns["x"], [-8, -7])
    made = import_discs(source, tmp_path / "gas.h5", choice)
    assert made.scene.startswith('[box]\nsize = [20.0, 10.0]\norigin = "centre"\n')
    text = made.scene + '\n[time]\nsteps = 0\nmethod = "event-driven"\n'
    (tmp_path / "gas.toml").write_text(text, encoding="utf-8")
    run = carrom.run(tmp_path / "gas.toml", folder=tmp_path / "run", progress=False)
    np.testing.assert_array_equal(run.checkpoints[-1].x, [[-8, 0], [-7, 2.25]])
