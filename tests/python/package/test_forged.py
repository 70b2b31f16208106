# SPDX-License-Identifier: BSD-3-Clause
"""Files that somebody has made, or rewritten: the program never calls them whole.

Each is a real file with one thing changed by h5py, so it has no checksums, or wrong ones.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import carrom

DISCS = "particles/discs"
Change = Callable[[Any], None]


def asked(program: Path, *words: str | Path) -> tuple[int, str, int]:
    """The program's exit code, what it printed, and the MB of memory that it took at most."""
    pipe, end = os.pipe()
    child = subprocess.Popen([program, *words], stdout=end, stderr=end)
    os.close(end)
    with os.fdopen(pipe, errors="replace") as text:
        printed = text.read()
    _, status, usage = os.wait4(child.pid, 0)  # includes the processes that it has started
    child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode, printed, usage.ru_maxrss // 1024


def rewritten(
    run: carrom.Run,
    path: Path,
    change: Change = lambda file: None,
    name: str = "trajectory.h5",
) -> Path:
    """A recording as one file without Carrom's checksums, as h5repack makes it."""
    with h5py.File(Path(str(run.folder)) / name) as old, h5py.File(path, "w") as new:

        def take(name: str, item: Any) -> None:
            if isinstance(item, h5py.Group):
                group = new.require_group(name)
            else:
                group = new.create_dataset(name, data=item[()], dtype=item.dtype)
            for key, value in item.attrs.items():
                group.attrs.create(key, value, dtype=item.attrs.get_id(key).dtype)

        old.visititems(take)
        for group in ("recording", "scene"):
            new.pop(f"carrom/{group}", None)
        change(new)
    return path


def put(name: str, place: Any, value: float) -> Change:
    def change(file: Any) -> None:
        file[name][place] = value

    return change


def no_discs(file: Any) -> None:
    for name in ("position", "velocity", "collisions"):
        values = file[f"{DISCS}/{name}/value"][()]
        del file[f"{DISCS}/{name}/value"]
        file[f"{DISCS}/{name}/value"] = values[:, :0]


def from_scene(path: Path, tmp_path: Path) -> Path:
    scene = tmp_path / "from.toml"
    scene.write_text(
        f'[box]\nsize = 20\n[discs]\nradius = 0.6\nfrom = "{path}"\n'
        '[time]\nsteps = 1\nmethod = "event-driven"\n'
    )
    return scene


def test_a_file_without_checksums_is_not_whole(
    run: carrom.Run, program: Path, tmp_path: Path
) -> None:
    code, text, _ = asked(program, "verify", rewritten(run, tmp_path / "plain.h5"))
    assert code == 5, text
    assert "no checksums" in text
    assert "whole" not in text
    code, text, _ = asked(program, "info", tmp_path / "plain.h5")
    assert code == 0, text


@pytest.mark.parametrize(
    ("name", "place", "value"),
    [
        (f"{DISCS}/position/value", (2, 7, 0), np.nan),
        (f"{DISCS}/position/value", (2, 7, 1), np.inf),
        (f"{DISCS}/position/value", (2, 7, 0), -3.0),
        (f"{DISCS}/velocity/value", (1, 0, 0), np.nan),
        ("parameters/radius", (), np.nan),
        ("parameters/radius", (), 0.0),
        (f"{DISCS}/box/edges/value", (0, 0), np.nan),
        (f"{DISCS}/box/edges/value", (4, 1), np.inf),
        (f"{DISCS}/box/edges/step", 2, 1),
        (f"{DISCS}/radius", 3, np.nan),
        (f"{DISCS}/mass", 3, -1.0),
    ],
)
def test_numbers_that_no_run_has_are_errors(
    run: carrom.Run, program: Path, tmp_path: Path, name: str, place: Any, value: float
) -> None:
    path = rewritten(run, tmp_path / "forged.h5", put(name, place, value))
    code, text, _ = asked(program, "verify", path)
    assert code == 2, text
    assert str(path) in text


@pytest.mark.parametrize(
    ("name", "value"),
    [("impulse", np.nan), ("time", np.nan), ("time", np.inf), ("p", 60), ("q", 10**9)],
)
def test_collisions_that_no_run_has_are_errors(
    run: carrom.Run, program: Path, tmp_path: Path, name: str, value: float
) -> None:
    path = rewritten(run, tmp_path / "log.h5", name="collisions.h5")
    code, text, _ = asked(program, "verify", path)
    assert code == 5, text
    assert "discs exist" in text
    with h5py.File(path, "a") as file:
        file[f"carrom/collisions/{name}"][-1] = value
    code, text, _ = asked(program, "verify", path)
    assert code == 2, text
    assert str(path) in text


def test_discs_that_cannot_be_are_no_start(run: carrom.Run, program: Path, tmp_path: Path) -> None:
    """No discs at all, a place that is no number, and all discs at one point."""
    x = f"{DISCS}/position/value"
    changes: list[tuple[Change, str]] = [
        (no_discs, "no discs"),
        (put(x, (-1, 3, 0), np.nan), ""),
        (put(x, (-1, 3, 0), 1e300), ""),
        (put(x, (-1, slice(None)), 10.0), "overlap"),
    ]
    for change, words in changes:
        path = rewritten(run, tmp_path / "forged.h5", change)
        code, text, _ = asked(program, "run", from_scene(path, tmp_path), "--quiet")
        assert code == 2, text
        assert words in text
    code, text, _ = asked(program, "verify", rewritten(run, tmp_path / "none.h5", no_discs))
    assert code == 2, text


def test_a_recording_without_its_list_of_segments_is_damaged(
    run: carrom.Run, program: Path, tmp_path: Path
) -> None:
    path = tmp_path / "trajectory.h5"
    path.write_bytes(run.frames.path.read_bytes())
    (tmp_path / "trajectory").symlink_to(run.frames.path.parent / "trajectory")
    assert asked(program, "verify", path)[0] == 0
    with h5py.File(path, "a") as file:
        del file["carrom/recording"]
    code, text, _ = asked(program, "verify", path)
    assert code in (2, 5), text
    assert "whole" not in text.replace("whole run", "")


@pytest.mark.parametrize("name", ["carrom/measurements/sums", "carrom/averages"])
def test_a_chunk_of_gigabytes_takes_no_memory(
    run: carrom.Run, program: Path, tmp_path: Path, name: str
) -> None:
    path = tmp_path / "forged.h5"
    path.write_bytes(run.checkpoints[-1].path.read_bytes())
    with h5py.File(path, "a") as file:
        values = file[name][()]
        del file[name]
        chunks = (2**32 // values.itemsize - 1,)
        made = file.create_dataset(
            name, values.shape, values.dtype, maxshape=(None,), chunks=chunks, compression=1
        )
        assert made.chunks == chunks
    for command in ("info", "verify", "convert"):
        words = ["--to", "csv", "--output", str(tmp_path / "out.csv")]
        code, text, memory = asked(program, command, path, *(words if command == "convert" else []))
        assert code == 2, f"{command}: {text}"
        assert memory < 300, f"{command} took {memory} MB"


def test_open_compares_checksums(run: carrom.Run, tmp_path: Path) -> None:
    """A changed number is seen by no reader of HDF5, and a file without checksums is a warning."""
    whole = Path(str(run.folder))
    shutil.copytree(whole, tmp_path / "copy")
    files = {
        "frames": Path("trajectory/0001.h5"),
        "collisions": Path("collisions/0001.h5"),
        "checkpoints": run.checkpoints[-1].path.relative_to(whole),
    }
    numbers = {
        "frames": "particles/discs/position/value",
        "collisions": "carrom/collisions/time",
        "checkpoints": "carrom/discs/x",
    }
    readers = {
        "frames": lambda opened: opened.frames[-1].x,
        "collisions": lambda opened: opened.collisions,
        "checkpoints": lambda opened: opened.checkpoints[-1].x,
    }
    for name, file in files.items():
        with h5py.File(whole / file) as stored:
            place = stored[numbers[name]].id.get_offset()
        data = bytearray((whole / file).read_bytes())
        data[place + 1] ^= 1
        (tmp_path / "copy" / file).write_bytes(data)
        with pytest.raises(carrom.FileError, match="damaged"):
            readers[name](carrom.open(tmp_path / "copy"))
        readers[name](carrom.open(tmp_path / "copy", check=False))
        readers[name](carrom.open(whole))
        top = file if name == "checkpoints" else Path(f"{file.parent}.h5")
        with pytest.raises(carrom.FileError, match="damaged"):
            carrom.open(tmp_path / "copy" / top)
    rewritten = tmp_path / "copy/rewritten.h5"  # beside its segments
    with h5py.File(whole / "trajectory.h5") as old, h5py.File(rewritten, "w") as new:
        for part in ("h5md", "parameters", "particles"):
            old.copy(part, new, expand_external=True)
    with pytest.warns(UserWarning, match="no checksums"):
        assert len(carrom.open(rewritten).frames) == 5


def test_open_without_the_program_warns(run: carrom.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CARROM", "/nowhere/carrom")
    with pytest.warns(UserWarning, match="without comparing checksums"):
        assert len(carrom.open(str(run.folder)).frames) == 5


POSITIONS = f"{DISCS}/position/value"


def with_storage_elsewhere(file: Any, place: Path, how: str) -> None:
    """Bring the positions of a recording from another file, in each way that HDF5 has."""
    shape = file[POSITIONS].shape
    del file[POSITIONS]
    if how == "external":
        file.create_dataset(POSITIONS, shape, "f8", external=[(str(place), 0, h5py.h5f.UNLIMITED)])
    elif how == "link":
        file[POSITIONS] = h5py.ExternalLink(str(place), "/x")
    else:
        layout = h5py.VirtualLayout(shape, "f8")
        layout[...] = h5py.VirtualSource(str(place), "x", shape)
        file.create_virtual_dataset(POSITIONS, layout)


@pytest.mark.parametrize("how", ["external", "link", "virtual", "part", "up"])
@pytest.mark.parametrize("kind", ["pipe", "file"])
def test_numbers_in_files_of_others_are_refused(
    run: carrom.Run, program: Path, tmp_path: Path, how: str, kind: str
) -> None:
    """A pipe would make every reader wait, and a file's bytes would become positions."""
    place = tmp_path / "elsewhere" / "secret"
    place.parent.mkdir()
    if kind == "pipe":
        os.mkfifo(place)
    else:
        place.write_bytes(b"precious" * 10000)
    path = tmp_path / "run/trajectory.h5"
    path.parent.mkdir()

    def change(file: Any) -> None:
        if how == "part":  # a segment where it may be, whose own numbers are elsewhere
            (path.parent / "trajectory").mkdir()
            shape = file[POSITIONS].shape
            with h5py.File(path.parent / "trajectory/0001.h5", "w") as part:
                external = [(str(place), 0, h5py.h5f.UNLIMITED)]
                part.create_dataset("x", shape, "f8", external=external)
            with_storage_elsewhere(file, Path("trajectory/0001.h5"), "virtual")
        elif how == "up":
            with_storage_elsewhere(file, Path("x/../../elsewhere/secret"), "virtual")
        else:
            with_storage_elsewhere(file, place, how)

    rewritten(run, path, change)
    for words in (
        ["info", path],
        ["verify", path],
        ["convert", path, "--to", "csv", "--output", tmp_path / "out.csv"],
        ["diff", path, run.frames.path],
        ["run", from_scene(path, tmp_path), "--quiet"],
    ):
        code, text, _ = asked(program, *words)
        assert code == 2, f"{words[0]}: {text}"
        assert str(path) in text
        assert "waited" not in text
    assert not (tmp_path / "out.csv").exists()
    for check in (False, True):
        with pytest.raises(carrom.FileError, match=r"elsewhere|kind|another file|below|damaged"):
            print(carrom.open(path, check=check).frames[-1].x)
    with pytest.raises(carrom.FileError):
        print(carrom.open(path.parent, check=False).frames[-1].x)


def test_pipes_in_the_place_of_files_of_a_run(run: carrom.Run, tmp_path: Path) -> None:
    shutil.copytree(Path(str(run.folder)), tmp_path / "copy")
    copy = carrom.open(tmp_path / "copy", check=False)
    assert copy.tables["thermo"] is not None
    paths = [path for path in (tmp_path / "copy").rglob("*") if path.is_file()]
    for path in paths:
        path.unlink()
        os.mkfifo(path)
    for reader in (
        lambda: copy.report,
        lambda: copy.scene,
        lambda: copy.state_hash,
        lambda: copy.tables["thermo"],
        lambda: copy.frames,
        lambda: copy.checkpoints[-1],
        lambda: copy.collisions,
        lambda: copy.lines,
        lambda: carrom.read_lines(tmp_path / "copy/lines.txt"),
        lambda: carrom.open(tmp_path / "copy/trajectory.h5", check=False),
        lambda: carrom.run(tmp_path / "copy/scene.toml"),
    ):
        with pytest.raises(carrom.CarromError):
            reader()


@pytest.mark.parametrize("text", ["[" * 100_000, '{"a":' * 100_000, "1" * 10_000])
def test_reports_nested_without_end_are_no_reports(
    run: carrom.Run, tmp_path: Path, text: str
) -> None:
    shutil.copytree(Path(str(run.folder)), tmp_path / "copy")
    (tmp_path / "copy/report.json").write_text(text)
    with pytest.raises(carrom.FileError, match=r"report\.json"):
        print(carrom.open(tmp_path / "copy", check=False).report)


def test_a_heap_without_end_is_damage(run: carrom.Run, tmp_path: Path) -> None:
    """HDF5 up to 2.0 loops where free room in a global heap has no size."""
    shutil.copytree(Path(str(run.folder)), tmp_path / "copy")
    path = tmp_path / "copy/trajectory.h5"
    content = path.read_bytes()
    heap = content.index(b"GCOL")
    for begin in (heap + 16, heap + 24):
        for end in (heap + 4096, len(content)):
            path.write_bytes(content[:begin] + bytes(end - begin) + content[end:])
            code = (
                f"import carrom\nfor check in (False, True):\n"
                f"    try: carrom.open({str(path)!r}, check=check).frames[-1].x\n"
                f"    except carrom.FileError: print('damaged')\n"
            )
            done = subprocess.run(
                [sys.executable, "-c", code], capture_output=True, text=True, timeout=60
            )
            assert done.stdout == "damaged\ndamaged\n", done.stderr
