# SPDX-License-Identifier: BSD-3-Clause
"""What Python reads is what h5py and the program's own text output say, bit for bit."""

from __future__ import annotations

import csv
import pickle
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from conftest import PERIODIC, Lines, Scene, gas

import carrom

Converted = Callable[[Path], Lines]
ROUGH = {
    "contact": {
        "kind": "rough",
        "restitution": 0.9,
        "tangential_restitution": 0.5,
        "friction": 0.3,
    }
}
SPECIES = [{"count": 5, "radius": 1.0, "mass": 4}, {"count": 20, "radius": 0.5}]

SCENES: dict[str, Scene] = {
    "plain": gas(),
    "time-stepped": gas() | {"time": {"steps": 20, "method": "time-stepped", "micro_steps": 4}},
    "periodic": gas(**PERIODIC) | {"discs": {"count": 60, "packing": 0.3, "speed": 9}},
    "gravity": gas(steps=20) | {"effects": {"gravity": {"y": -0.01}}},
    "drag": gas() | {"effects": {"drag": {"rate": 0.02}}},
    "rough": gas() | {"effects": ROUGH},
    "species": gas(**PERIODIC) | {"discs": {"species": SPECIES}},
    "sizes": gas(**PERIODIC)
    | {"discs": {"count": 25, "packing": 0.3, "radius": {"polydispersity": 0.2}}},
    "open": gas(right={"kind": "open"}),
    "rectangle": gas(size=[40, 10]),
    "periodic rectangle": gas(size=[8, 50], **PERIODIC),
}

SCENES["gravity"]["time"]["sync_every"] = 16


@pytest.fixture(scope="module", params=list(SCENES))
def recorded(
    request: pytest.FixtureRequest, program: Path, tmp_path_factory: pytest.TempPathFactory
) -> carrom.Run:
    output = {"trajectory": {"every_steps": 5, "precision": "double"}, "text": "every_step"}
    scene = SCENES[request.param] | {"output": output}
    return carrom.run(scene, folder=tmp_path_factory.mktemp("recorded") / request.param)


def state(frame: carrom.Frame) -> Any:
    return np.hstack([frame.x, frame.v])


def same_bits(a: Any, b: Any) -> bool:
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def test_frames_are_the_lines_of_the_run(recorded: carrom.Run) -> None:
    assert recorded.frames.steps.tolist() == [0, 5, 10, 15, 20]
    assert recorded.frames.x.shape == (5, recorded.frames.n_discs, 2)
    for frame in recorded.frames:
        assert same_bits(state(frame), recorded.lines[frame.step])


def test_a_checkpoint_is_the_last_lines_of_the_run(
    recorded: carrom.Run, converted: Converted
) -> None:
    """Computed here from the stored columns, by the program from its states."""
    checkpoint = recorded.checkpoints[-1]
    assert checkpoint.step == 20
    assert same_bits(state(checkpoint), recorded.lines[20])
    assert same_bits(state(checkpoint), converted(checkpoint.path)[20])
    assert checkpoint.state_hash == recorded.report["state_hash"]
    assert checkpoint.method == recorded.report["method"]


def test_counters_and_spins_are_those_of_the_table(
    recorded: carrom.Run, program: Path, tmp_path: Path
) -> None:
    checkpoint = recorded.checkpoints[-1]
    command = [program, "convert", checkpoint.path, "--to", "csv", "--output", tmp_path / "c.csv"]
    subprocess.run(command, check=True)
    with open(tmp_path / "c.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for name in ("wall_collisions", "pair_collisions"):
        assert getattr(checkpoint, name).tolist() == [int(row[name]) for row in rows]
    if "rough" in str(recorded.folder):
        spins = [float(row["angular_velocity"]) for row in rows]
        assert checkpoint.spin.tolist() == spins
        assert recorded.frames[-1].spin.tolist() == spins
        assert np.count_nonzero(spins) > 0
    else:
        with pytest.raises(carrom.NoDataError, match=r"no angular_velocity, only position"):
            _ = recorded.frames[-1].spin


def test_bodies_are_those_of_the_scene(recorded: carrom.Run) -> None:
    with h5py.File(recorded.frames.path) as file:
        discs = file["particles/discs"]
        stored = [discs[name][:] for name in ("radius", "mass", "species")]
    for frame in (recorded.frames[0], recorded.checkpoints[-1]):
        for ours, theirs in zip((frame.radius, frame.mass, frame.species), stored):
            assert np.array_equal(ours, theirs)
        if "species" in str(recorded.folder):
            assert frame.radius.tolist() == [1.0] * 5 + [0.5] * 20
            assert frame.mass.tolist() == [4.0] * 5 + [1.0] * 20
            assert frame.species.tolist() == [0] * 5 + [1] * 20
        else:
            assert np.pi * np.sum(frame.radius**2) == pytest.approx(0.3 * 400)


def test_boxes_and_sides_are_those_of_the_scene(recorded: carrom.Run) -> None:
    is_periodic = "left" in recorded.scene["box"]
    for frame in (recorded.frames[0], recorded.checkpoints[-1]):
        assert frame.box.tolist() == np.broadcast_to(recorded.scene["box"]["size"], 2).tolist()
        assert frame.periodic == (is_periodic, is_periodic)


def test_departed_discs_are_told_apart(recorded: carrom.Run) -> None:
    frame, checkpoint = recorded.frames[-1], recorded.checkpoints[-1]
    n_departed = sum(recorded.report["departed"])
    assert np.array_equal(frame.present, checkpoint.present)
    assert np.count_nonzero(~frame.present) == n_departed
    assert (n_departed > 0) == ("open" in str(recorded.folder))


def test_energy_is_that_of_the_report(recorded: carrom.Run) -> None:
    energy = recorded.checkpoints[-1].kinetic_energy
    assert energy == pytest.approx(recorded.report["kinetic_energy"], rel=1e-13)


def test_single_precision_is_read_as_it_is(run: carrom.Run, converted: Converted) -> None:
    path = run.frames.path
    assert path is not None
    lines = converted(path)
    with h5py.File(path) as file:
        for number, frame in enumerate(run.frames):
            stored = file["particles/discs/position/value"][number, :, :2]
            assert frame.x.dtype == np.float32
            assert same_bits(frame.x, stored)
            assert np.array_equal(frame.x.astype(float), lines[frame.step][:, :2])
            assert np.array_equal(frame.v.astype(float), lines[frame.step][:, 2:])
            assert np.array_equal(frame.x, run.lines[frame.step][:, :2].astype(np.float32))
            counters = file["particles/discs/collisions/value"][number]
            assert np.array_equal(frame.wall_collisions, counters[:, 0])
            assert np.array_equal(frame.pair_collisions, counters[:, 1])


def test_collisions_are_those_of_the_table(run: carrom.Run, program: Path, tmp_path: Path) -> None:
    path = Path(str(run.folder)) / "collisions.h5"
    command = [program, "convert", path, "--to", "csv", "--output", tmp_path / "c.csv"]
    subprocess.run(command, check=True)
    with open(tmp_path / "c.csv", newline="") as file:
        rows = [tuple(row) for row in csv.reader(file)]
    table = run.collisions
    assert table.columns == rows[0]
    kinds = (int, float, int, int, float)
    wanted = [tuple(k(w) for k, w in zip(kinds, row)) for row in rows[1:]]
    assert table.tolist() == wanted
    pairs = np.count_nonzero(table["q"] >= 0)
    assert (pairs, len(table) - pairs) == (
        run.report["pair_collisions"],
        run.report["wall_collisions"],
    )
    part = run.collisions_between(3, 7)
    assert part.tolist() == [row for row in wanted if 3 <= row[0] <= 7]
    assert carrom.open(path).collisions.tolist() == wanted


def test_tables_are_those_of_the_report(run: carrom.Run) -> None:
    assert set(run.tables) == set(run.report["measurements"])
    for name, table in run.tables.items():
        stored = run.report["measurements"][name]
        assert set(table.columns) == set(stored) - {"remarks"}
        for column in table.columns:
            values = [np.nan if value is None else value for value in stored[column]]
            assert np.array_equal(table[column], values, equal_nan=table[column].dtype.kind == "f")
    assert run.tables["radial_distribution"]["pairs"].dtype == np.int64
    assert "samples" in " ".join(run.tables["displacement"].remarks)
    with pytest.raises(KeyError, match="has no table 'speed'; it has displacement"):
        _ = run.tables["speed"]
    assert run.tables.get("speed") is None


def test_thermo_has_the_energy_of_the_checkpoints(run: carrom.Run) -> None:
    thermo = run.thermo
    assert thermo["step"].tolist() == list(range(0, 21, 2))
    for checkpoint in run.checkpoints:
        energy = np.sum(checkpoint.v**2) / 2
        assert thermo["energy"][checkpoint.step // 2] == pytest.approx(energy, rel=1e-12)
    assert np.all(thermo["collision_rate"][1:] >= 0)


def test_frames_are_a_sequence(run: carrom.Run) -> None:
    frames = run.frames
    assert len(frames) == 5
    assert frames.at(10).step == frames[2].step == frames[-3].step == 10
    assert frames[1:4:2].steps.tolist() == [5, 15]
    assert [frame.step for frame in frames[::-1]] == [20, 15, 10, 5, 0]
    assert frames[1:][0].step == 5
    with pytest.raises(IndexError, match="no frame 5; there are 5"):
        _ = frames[5]
    with pytest.raises(carrom.NoDataError, match="no frame of step 11; there are 5, of steps 0 to"):
        frames.at(11)
    copy = pickle.loads(pickle.dumps(frames[1:]))
    assert np.array_equal(copy[0].x, frames[1].x)


def test_strips_have_equally_many_discs(run: carrom.Run) -> None:
    frame = run.frames[-1]
    strips = frame.strips(4)
    assert np.bincount(strips).tolist() == [15] * 4
    assert frame.x[strips == 0, 0].max() <= frame.x[strips == 1, 0].min()


def test_every_file_opens_alone(run: carrom.Run) -> None:
    folder = Path(str(run.folder))
    trajectory = carrom.open(folder / "trajectory.h5")
    assert len(trajectory.frames) == 5
    assert trajectory.scene["discs"]["count"] == 60
    checkpoint = carrom.open(run.checkpoints[-1].path)
    assert len(checkpoint.checkpoints) == 1
    assert checkpoint.scene["time"]["method"] == "event-driven"
    assert [c.step for c in run.checkpoints] == [10, 20]
    assert [c.step for c in run.checkpoints[1:]] == [20]
    for nothing in ("report", "collisions", "lines"):
        with pytest.raises(carrom.NoDataError):
            getattr(checkpoint, nothing)
    assert len(checkpoint.frames) == 0
    with pytest.raises(IndexError, match="asks for them"):
        _ = checkpoint.frames[0]
    with pytest.raises(carrom.NoDataError, match="only a folder"):
        checkpoint.resume()


def test_recordings_of_several_pieces_are_one(program: Path, tmp_path: Path) -> None:
    scene = gas() | {"output": {"trajectory": {"every_steps": 2}, "collisions": True}}
    whole = carrom.run(scene, folder=tmp_path / "whole")
    run = carrom.run(scene, folder=tmp_path / "pieces", steps=7)
    assert not run.frames.steps.tolist()[-1] > 6
    for last in (12, 20):
        run = carrom.resume(tmp_path / "pieces", steps=last)
    with h5py.File(tmp_path / "pieces/trajectory.h5") as file:
        assert file["particles/discs/position/value"].is_virtual
    assert run.frames.steps.tolist() == whole.frames.steps.tolist()
    assert same_bits(run.frames.x, whole.frames.x)
    assert run.collisions.tolist() == whole.collisions.tolist()


def test_a_recording_without_its_pieces_is_an_error(run: carrom.Run, tmp_path: Path) -> None:
    """HDF5 alone would show numbers that nobody wrote."""
    shutil.copy(Path(str(run.folder)) / "trajectory.h5", tmp_path)
    with h5py.File(tmp_path / "trajectory.h5") as file:
        assert np.isnan(file["particles/discs/position/value"][:, :, :2]).all()
    with pytest.raises(carrom.FileError, match=r"copy the folder trajectory/ together"):
        carrom.open(tmp_path / "trajectory.h5")


def test_what_is_no_run_is_an_error(run: carrom.Run, tmp_path: Path) -> None:
    with pytest.raises(carrom.FileError, match="is no run of carrom"):
        carrom.open(tmp_path)
    with pytest.raises(carrom.FileError, match="there is no such file"):
        carrom.open(tmp_path / "nowhere.h5")
    (tmp_path / "text.h5").write_text("text")
    with pytest.raises(carrom.FileError, match="is no HDF5 file"):
        carrom.open(tmp_path / "text.h5")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1
    with pytest.raises(carrom.FileError, match="holds nothing that carrom writes"):
        carrom.open(tmp_path / "other.h5")
    with h5py.File(tmp_path / "like.h5", "w") as file:
        file["particles/discs/box/edges"] = 1
    with pytest.raises(carrom.FileError, match=r"like\.h5: "):
        carrom.open(tmp_path / "like.h5")
    half = run.checkpoints[-1].path.read_bytes()[:9000]
    (tmp_path / "half.h5").write_bytes(half)
    with pytest.raises(carrom.FileError, match=r"half\.h5"):
        carrom.open(tmp_path / "half.h5")


def test_damaged_metadata_is_a_file_error(run: carrom.Run, tmp_path: Path) -> None:
    """Each header of an object in turn, as a disk may lose it."""
    whole = run.checkpoints[-1].path.read_bytes()
    headers = [match.start() for match in re.finditer(b"OHDR", whole)]
    assert len(headers) > 5
    for begin in headers:
        damaged = tmp_path / f"{begin}.h5"
        damaged.write_bytes(whole[: begin + 6] + b"\x99" * 8 + whole[begin + 14 :])
        with pytest.raises(carrom.FileError, match=damaged.name):
            carrom.open(damaged)


def test_a_run_of_one_frame(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=0) | {"output": {"trajectory": {"every_steps": 1}}}
    run = carrom.run(scene, folder=tmp_path / "one")
    assert run.frames.steps.tolist() == [0]
    assert run.frames.x.shape == (1, 60, 2)
    assert run.is_finished


def test_a_run_is_read_while_it_goes_on(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=50_000_000) | {"output": {"trajectory": {"every_steps": 1000}}}
    (tmp_path / "scene.toml").write_text(carrom.to_toml(scene))
    command = [program, "run", tmp_path / "scene.toml", "-o", tmp_path / "run", "--quiet"]
    child = subprocess.Popen(command)
    try:
        while not (tmp_path / "run/trajectory.h5").exists():
            assert child.poll() is None
        run = carrom.open(tmp_path / "run")
        before = run.frames
        assert not run.is_finished
        with pytest.raises(carrom.NoDataError, match="writes it at the end"):
            _ = run.report
        while len(run.frames) < max(2, len(before) + 1):
            assert child.poll() is None
        frames = run.frames
        assert frames.steps.tolist() == list(range(0, 1000 * len(frames), 1000))
        assert np.all(frames[-1].x > 0)
        energies = [frame.kinetic_energy for frame in frames]
        assert energies == pytest.approx([energies[0]] * len(frames), rel=1e-6)
    finally:
        child.kill()
        child.wait()
    assert len(carrom.open(tmp_path / "run").frames) >= len(frames)


def test_verify_finds_each_damage(recorded: carrom.Run, tmp_path: Path) -> None:
    whole = max((recorded.folder / "checkpoints").glob("*.h5"))
    carrom.verify(whole)
    data = bytearray(whole.read_bytes())
    data[len(data) // 2] ^= 1
    damaged = tmp_path / "damaged.h5"
    damaged.write_bytes(data)
    with pytest.raises(carrom.FileError, match="is damaged"):
        carrom.verify(damaged)
    shutil.copytree(recorded.folder, tmp_path / "copy")
    with h5py.File(tmp_path / "copy" / "trajectory.h5", "a") as file:
        del file["carrom/recording"]
    with pytest.raises(carrom.FileError, match=r"no checksums|damaged"):
        carrom.verify(tmp_path / "copy" / "trajectory.h5")


def test_active_discs_have_directions_in_frames_and_checkpoints(tmp_path: Path) -> None:
    scene = gas(**PERIODIC)
    scene["discs"]["temperature"] = 0.01
    scene["time"]["sync_every"] = 1
    scene["effects"] = {
        "thermostat": {"kind": "langevin", "rate": 0.1, "temperature": 0.01},
        "activity": {"speed": 0.1, "rotational_diffusion": 0.05},
    }
    scene["output"] = {"trajectory": {"every_steps": 10, "precision": "double"}}
    run = carrom.run(scene, folder=tmp_path / "active", progress=False)
    first, last = run.frames[0].direction, run.frames[-1].direction
    assert first.shape == (60,)
    assert np.abs(first).max() <= np.pi
    assert len(np.unique(first)) == 60
    assert np.all(first != last)
    assert run.checkpoints[-1].direction.tolist() == last.tolist()
    axes = carrom.plot.frame(run, 20, colour="direction")
    drawn = next(one for one in axes.collections if one.get_array() is not None)
    assert drawn.get_clim() == (-np.pi, np.pi)
    plain = carrom.run(gas(), folder=tmp_path / "plain", progress=False)
    with pytest.raises(carrom.NoDataError, match="no direction"):
        _ = plain.checkpoints[-1].direction


def test_discs_that_swap_have_the_radii_of_their_step(tmp_path: Path) -> None:
    scene = gas(**PERIODIC)
    radii = np.linspace(0.2, 0.4, 12)
    scene["discs"] = {"species": [{"count": 5, "radius": float(radius)} for radius in radii]}
    scene["effects"] = {"swap": {"rounds": 4}}
    scene["output"] = {"trajectory": {"every_steps": 10, "precision": "double"}}
    run = carrom.run(scene, folder=tmp_path / "swap", progress=False)
    first, last = run.frames[0].radius, run.frames[-1].radius
    assert first.tolist() == np.repeat(radii, 5).tolist()
    assert np.sum(first != last) > 10
    assert sorted(first) == sorted(last)
    assert run.checkpoints[-1].radius.tolist() == last.tolist()
    assert run.checkpoints[-1].packing == pytest.approx(run.frames[0].packing)
