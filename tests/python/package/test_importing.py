# SPDX-License-Identifier: BSD-3-Clause
"""Discs from files of other programs: each format goes round to its last digit, and wrong files are
named with the line or the frame.
"""

from __future__ import annotations

import os
import subprocess
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from conftest import PERIODIC

import carrom
from carrom.errors import CarromError, FileError
from carrom.importing import Choice, import_discs, read_discs
from carrom.importing.command import main

RADII, MASSES = np.array([0.5, 0.3]), np.array([1.0, 2.5])
Table = npt.NDArray[np.float64]


def gas_of_two(method: str = "event-driven") -> dict[str, Any]:
    species = [
        {"count": 30, "radius": 0.5, "mass": 1.0},
        {"count": 20, "radius": 0.3, "mass": 2.5},
    ]
    return {
        "box": {"size": [20.5, 12.25], **PERIODIC},
        "discs": {"species": species, "seed": 5},
        "time": {"steps": 20, "method": method},
        "output": {"trajectory": {"every_steps": 10, "precision": "double"}},
    }


@pytest.fixture(scope="module")
def source(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    """A run of two species, whose frames go round."""
    return carrom.run(gas_of_two(), folder=tmp_path_factory.mktemp("source"), program=program)


def converted(program: Path, path: Path, kind: str) -> str:
    done = subprocess.run(
        [str(program), "convert", str(path), "--to", kind],
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout


def table(program: Path, path: Path) -> Table:
    """x, y, vx, vy of a checkpoint, as the program writes them."""
    lines = converted(program, path, "csv").splitlines()[1:]
    return np.array([[float(word) for word in line.split(",")[2:6]] for line in lines])


def wanted(source: carrom.Run, step: int = 20) -> Table:
    frame = next(frame for frame in source.frames if frame.step == step)
    return np.column_stack([frame.x, frame.v])


def trajectory(source: carrom.Run) -> Path:
    return Path(source.folder) / "trajectory.h5"


def taken(program: Path, file: Path, **choice: Any) -> Table:
    output = file.with_suffix(".h5")
    scene = import_discs(file, output, Choice(**choice), program=program).scene
    begin = file.with_suffix(".toml")
    begin.write_text(scene + "\n[time]\nsteps = 1\n", encoding="ascii")
    carrom.run(str(begin), folder=file.with_suffix(".run"), overwrite=True, program=program)
    return table(program, output)


def test_xyz_of_the_program_goes_round(program: Path, source: carrom.Run, tmp_path: Path) -> None:
    text = converted(program, trajectory(source), "xyz")
    file = tmp_path / "discs.xyz"
    file.write_text(text, encoding="ascii")
    for choice, step in (({}, 20), ({"frame": 0}, 0), ({"frame": -2}, 10), ({"step": 10}, 10)):
        assert np.array_equal(taken(program, file, **choice), wanted(source, step))
    discs = read_discs(file)
    assert np.array_equal(discs.columns["radius"], np.repeat(RADII, [30, 20]))
    assert np.array_equal(discs.columns["mass"], np.repeat(MASSES, [30, 20]))
    assert discs.box is not None
    assert discs.box.size == (20.5, 12.25)
    assert discs.box.periodic == (True, True)
    # The way back: the program writes the same frame from the import.
    import_discs(file, tmp_path / "discs.h5", program=program)
    again = converted(program, tmp_path / "discs.h5", "xyz").splitlines()[2:]
    first = [line.split()[:13] for line in text.splitlines()[-50:]]  # without images
    assert [line.split() for line in again] == first


def test_csv_and_lines_of_the_program_go_round(
    program: Path, source: carrom.Run, tmp_path: Path
) -> None:
    names = {"H": 0.5, "He": 0.3}
    for kind in ("csv", "text"):
        file = tmp_path / f"discs.{kind}"
        file.write_text(converted(program, trajectory(source), kind), encoding="ascii")
        for step in (10, 20):
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # the program's own columns are all known
                discs = taken(program, file, step=step, box=(20.5, 12.25), periodic="xy",
                              radius={"": 0.3})  # fmt: skip
            assert np.array_equal(discs, wanted(source, step))
    rows = converted(program, trajectory(source), "csv").splitlines()
    rows = [rows[0] + ",species", *(row + (",H" if i < 30 else ",He")
                                    for i, row in enumerate(rows[-50:]))]  # fmt: skip
    file.write_text("\n".join(rows) + "\n", encoding="ascii")
    discs = read_discs(file, Choice(box=(20.5, 12.25), periodic="xy", radius=names))
    assert np.array_equal(discs.columns["radius"], np.repeat(RADII, [30, 20]))


def test_gsd_goes_round_to_single_precision(
    program: Path, source: carrom.Run, tmp_path: Path
) -> None:
    pytest.importorskip("gsd.hoomd")
    file = carrom.to_gsd(source, tmp_path / "discs.gsd")
    half = np.array([20.5, 12.25]) / 2
    for step in (10, 20):
        discs = taken(program, file, step=step)
        frame = wanted(source, step)
        stored = (frame[:, :2] - half).astype(np.float32).astype(float) + half
        assert np.array_equal(discs[:, :2], stored)
        assert np.array_equal(discs[:, 2:], frame[:, 2:].astype(np.float32).astype(float))
    assert np.array_equal(read_discs(file).columns["radius"],
                          np.repeat(RADII.astype(np.float32).astype(float), [30, 20]))  # fmt: skip


def dump_of(frame: Table, *, origin: tuple[float, float] = (0, 0), sides: str = "pp pp pp",
            bounds: str = "BOX BOUNDS ", names: str = "id type x y z vx vy vz radius mass",
            tilt: str = "") -> str:  # fmt: skip
    """A dump as LAMMPS writes it, in no order of ids; 17 digits go round."""
    x0, y0 = origin
    text = (
        f"ITEM: TIMESTEP\n20\nITEM: NUMBER OF ATOMS\n{len(frame)}\nITEM: {bounds}{sides}\n"
        f"{x0!r} {x0 + 20.5!r}{tilt}\n{y0!r} {y0 + 12.25!r}{tilt}\n-0.5 0.5{tilt}\n"
        f"ITEM: ATOMS {names}\n"
    )
    for k in reversed(range(len(frame))):
        x, y, vx, vy = frame[k].tolist()
        kind = 0 if k < 30 else 1
        text += (
            f"{k + 1} {kind + 1} {x + x0!r} {y + y0!r} 0 {vx!r} {vy!r} 0 "
            f"{RADII[kind]} {MASSES[kind]}\n"
        )
    return text


def test_lammps_dumps_go_round(program: Path, source: carrom.Run, tmp_path: Path) -> None:
    file = tmp_path / "dump.lammpstrj"
    frame = wanted(source)
    file.write_text(dump_of(wanted(source, 10)) + dump_of(frame), encoding="ascii")
    assert np.array_equal(taken(program, file), frame)
    assert np.array_equal(taken(program, file, frame=0), wanted(source, 10))
    # A box with another origin: positions are right to a rounding of their own size.
    file.write_text(dump_of(frame, origin=(-10.25, -6.125)), encoding="ascii")
    assert np.allclose(taken(program, file), frame, rtol=0, atol=1e-14)
    file.write_text(dump_of(frame, bounds="BOX BOUNDS xy xz yz ", tilt=" 0.0"), encoding="ascii")
    assert np.array_equal(taken(program, file), frame)


def test_lammps_data_goes_round(program: Path, source: carrom.Run, tmp_path: Path) -> None:
    frame = wanted(source)
    kinds = np.repeat([0, 1], [30, 20])
    head = "# two species\n\n50 atoms\n2 atom types\n"
    head += "0 20.5 xlo xhi\n0 12.25 ylo yhi\n-1 1 zlo zhi\n"
    speeds = "\nVelocities\n\n" + "".join(
        f"{k + 1} {vx!r} {vy!r} 0\n" for k, (vx, vy) in enumerate(frame[:, 2:].tolist())
    )
    atomic = "\nMasses\n\n1 1\n2 2.5\n\nAtoms # atomic\n\n" + "".join(
        f"{k + 1} {kinds[k] + 1} {x!r} {y!r} 0 0 0 0\n"
        for k, (x, y) in enumerate(frame[:, :2].tolist())
    )
    file = tmp_path / "discs.data"
    file.write_text(head + atomic + speeds, encoding="ascii")
    assert np.array_equal(taken(program, file, radius={"1": 0.5, "2": 0.3}), frame)
    assert np.array_equal(read_discs(file, Choice(radius={"": 0.3})).columns["mass"], MASSES[kinds])
    sphere = "\nAtoms # sphere\n\n" + "".join(
        f"{k + 1} {kinds[k] + 1} {2 * RADII[kinds[k]]} 1.5 {x!r} {y!r} 0\n"
        for k, (x, y) in enumerate(frame[:, :2].tolist())
    )
    file.write_text(head + sphere + speeds, encoding="ascii")
    discs = read_discs(file)
    assert np.allclose(discs.columns["mass"], 1.5 * 4 / 3 * np.pi * RADII[kinds] ** 3, rtol=1e-15)


def test_rows_of_teaching_programs(program: Path, tmp_path: Path) -> None:
    file = tmp_path / "rows.txt"
    file.write_text("# x y vx vy r m\n-4 -4 0.5 0 1 1\n\n4 3 0 -0.25 0.5 2\n", encoding="ascii")
    discs = taken(program, file, box=(10, 10), origin="centre", time_step=0.5)
    assert discs.tolist() == [[1, 1, 0.25, 0], [9, 8, 0, -0.125]]
    file.write_text("1, 1, 0.5, 0, 1, 1\n8, 8, 0, 0, 1, 1\n", encoding="ascii")
    assert taken(program, file, box=(10, 10)).tolist() == [[1, 1, 0.5, 0], [8, 8, 0, 0]]


def test_kinds_become_species(program: Path, tmp_path: Path) -> None:
    """Types that alternate are sorted, so that each is one species."""
    file = tmp_path / "rows.csv"
    rows = "".join(f"{2 * k + 1},2,{'ab'[k % 2]},{0.5 if k % 2 else 0.25}\n" for k in range(8))
    file.write_text("x,y,type,radius\n" + rows, encoding="ascii")
    scene = import_discs(file, tmp_path / "a.h5", Choice(box=(16, 4)), program=program).scene
    assert scene.count("count = 4") == 2
    assert [row[0] for row in table(program, tmp_path / "a.h5")] == [1, 5, 9, 13, 3, 7, 11, 15]


def test_places_beyond_a_periodic_side_are_wrapped(tmp_path: Path) -> None:
    file = tmp_path / "rows.txt"
    file.write_text("-0.25 10 0 0 0.5 1\n20.25 5 0 0 0.5 1\n", encoding="ascii")
    discs = read_discs(file, Choice(box=(20, 10), periodic="xy"))
    assert discs.columns["x"].tolist() == [19.75, 0.25]
    assert discs.columns["y"].tolist() == [0, 5]


GOOD = "1 1 0 0 0.5 1\n5 5 0 0 0.5 1\n8 8 0 0 0.5 1\n"
XYZ = '2\nLattice="{}" Properties=species:S:1:pos:R:3:radius:R:1{}\nA 1 1 0 0.5\nA 5 5 {} 0.5\n'
SPHERES = """LAMMPS data

2 atoms
1 atom types
0 10 xlo xhi
0 10 ylo yhi
-0.5 0.5 zlo zhi

Atoms # sphere

1 1 1.0 2.0 2 2 0
2 1 1.0 {} 5 5 0
"""
BAD = {
    "empty": ("", ": is empty"),
    "nan": (GOOD.replace("5 5 0", "5 nan 0"), ":2: y is not finite"),
    "word": (GOOD.replace("8 8 0", "8 8 z"), ":3: 'z' is no number"),
    "short": (GOOD.replace("8 8 0 0", "8 8 0"), ":3: 5 words, but a line has 6"),
    "outside": (GOOD.replace("8 8", "9.75 8"), ":3: the disc is not inside the walls along x"),
    "overlap": (GOOD.replace("8 8", "5.25 5"), "line 2 and line 3 (by 0.75)"),
    "radius": (GOOD.replace("0.5 1\n8", "0 1\n8"), ":2: the radius must be greater than 0"),
    "mass": (GOOD.replace("0.5 1\n8", "0.5 -1\n8"), ":2: the mass must be greater than 0"),
    "twice": ("x,y,r,id\n1,1,.5,3\n5,5,.5,3\n", ":3: another disc has the same id"),
    "prose": ("Dear all\nhere are the discs\n", ":1: is none of the formats"),
    "course": ("2\n10\n1\n5\nprint\n", ": is a scene of the course"),
    "tilt": (XYZ.format("10 0 0 1 10 0 0 0 1", "", 0), ":2: the box is tilted"),
    "deep": (XYZ.format("10 0 0 0 10 0 0 0 1", "", 3), ":4: z differs"),
    "count": ("3\n" + XYZ.format("10 0 0 0 10 0 0 0 1", "", 0)[2:],
              ":4: frame 0 ends after 2 of 3 discs"),
    "many": ("3000000000\n" + XYZ.format("10 0 0 0 10 0 0 0 1", "", 0)[2:],
             ":1: announces 3000000000 discs"),
    "density": (SPHERES.format("nought"), ":12: 'nought' is no number"),
    "pbc": (XYZ.format("10 0 0 0 10 0 0 0 1", ' pbc="T"', 0), ":2: pbc has three words"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_files_end_with_code_2_and_the_line(
    program: Path, tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text, message = BAD[name]
    file, output = tmp_path / "bad.txt", tmp_path / "out.h5"
    file.write_text(text, encoding="ascii")
    output.write_bytes(b"of somebody else")
    words = [str(file), "-o", str(output)]
    words += [] if text[1:2] == "\n" else ["--box", "10"]
    assert main(words) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert message in printed.err
    assert printed.err.startswith(str(file)), printed.err
    assert len(printed.err.splitlines()) == 1
    assert output.read_bytes() == b"of somebody else"


@pytest.mark.parametrize("time", ["0", "-1", "nan", "inf"])
def test_a_step_takes_time(tmp_path: Path, time: str, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "rows").write_text(GOOD, encoding="ascii")
    words = [str(tmp_path / "rows"), "-o", str(tmp_path / "out.h5"), "--box", "10"]
    assert main([*words, f"--time-step={time}"]) == 2
    assert capsys.readouterr().err == "--time-step is above 0 and finite\n"
    assert not (tmp_path / "out.h5").exists()


def test_bad_dumps(source: carrom.Run, tmp_path: Path) -> None:
    frame = wanted(source)
    good = dump_of(frame)
    tilted = dump_of(frame, bounds="BOX BOUNDS xy xz yz ", tilt=" 0.5")
    for text, message in (
        (dump_of(frame, sides="pp ss pp"), ":5: a boundary 'ss'"),
        (tilted, ":6: the box is tilted"),
        (good.replace("id type x y", "id type q w"), ":9: has no columns x and y"),
        (good[:-40], "words, but a line has 10"),
        (good + good[:300], ": frame 1 ends after "),
        (good.replace("ITEM: ATOMS", "ITEM: BONDS"), ":9: an ITEM that LAMMPS has not"),
        (good.replace("NUMBER OF ATOMS\n50", "NUMBER OF ATOMS\n-5"), ":4: -5 discs"),
        (good.replace("\n0 20.5\n", "\n0 nan\n"), ":6: expected the lower and the upper end"),
    ):
        file = tmp_path / "dump.txt"
        file.write_text(text, encoding="ascii")
        with pytest.raises(FileError) as caught:
            read_discs(file)
        assert message in str(caught.value), message
    file.write_text(good, encoding="ascii")
    with pytest.raises(FileError, match="has no frame of step 7; its steps are 20"):
        read_discs(file, Choice(step=7))
    with pytest.raises(FileError, match="has no frame 3; frames are 0 to 0"):
        read_discs(file, Choice(frame=3))


def test_formats_by_another_name(program: Path, source: carrom.Run, tmp_path: Path) -> None:
    """The begin of a file decides. Where the format is named, another one is an error."""
    file = tmp_path / "discs.csv"
    file.write_text(dump_of(wanted(source)), encoding="ascii")
    assert read_discs(file).count == 50
    for kind in ("xyz", "rows", "lammps-data", "gsd"):
        with pytest.raises((CarromError, ValueError)):
            read_discs(file, Choice(format=kind, box=(20.5, 12.25)))
    with pytest.raises(FileError, match=r"is an HDF5 file; discs.from takes"):
        read_discs(trajectory(source))
    noise = tmp_path / "noise.gsd"
    noise.write_bytes(bytes(range(256)) * 40)
    with pytest.raises(FileError, match="is none of the formats"):
        read_discs(noise)
    pytest.importorskip("gsd.hoomd")
    noise.write_bytes(b"\xdf\x65" * 2000)
    with pytest.raises(FileError, match="cannot be read as GSD"):
        read_discs(noise)


def test_no_file_of_a_run_is_replaced(
    program: Path, source: carrom.Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "rows.txt"
    file.write_text(GOOD, encoding="ascii")
    before = trajectory(source).read_bytes()
    for output, message in (
        (trajectory(source), "is a file of the run in"),
        (file, "is the file to import"),
    ):
        assert main([str(file), "-o", str(output), "--box", "10"]) == 2
        assert message in capsys.readouterr().err
    assert main([str(tmp_path / "nowhere.txt"), "-o", str(file)]) == 2
    assert "nowhere.txt: No such file" in capsys.readouterr().err
    assert file.read_text(encoding="ascii") == GOOD
    assert trajectory(source).read_bytes() == before
    for _ in range(2):  # an earlier import is replaced
        assert main([str(file), "-o", str(tmp_path / "discs.h5"), "--box", "10"]) == 0


def test_10_gb_do_not_fill_the_memory(tmp_path: Path) -> None:
    """Sparse files, which take no room on the disk."""
    for begin, message in (
        (b"1 1 0 0 .5 1\n", "is none of the formats"),
        (b"1 1 0 0 .5 1\n" * 10000, "has 10 GB; rows are read up to"),
        (b"2\n\nA 1 1 0\nA 5 5 0\n" + b" \n" * 40000, "a line of more than 65535 characters"),
        (b"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + b"\n" * 70000, "is no number of discs"),
    ):
        file = tmp_path / "large"
        file.write_bytes(begin)
        os.truncate(file, 10_000_000_000)
        with pytest.raises(FileError) as caught:
            read_discs(file, Choice(box=(10, 10), radius={"": 0.5}))
        assert message in str(caught.value)
        file.unlink()
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(FileError, match="is not a plain file"):
        read_discs(pipe)
