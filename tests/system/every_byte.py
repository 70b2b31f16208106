# SPDX-License-Identifier: BSD-3-Clause
"""Damage each page and each bit of a run's files, and ask everything that reads them.

`every_byte.py PROGRAM ASK_OFTEN (sample|bytes|bits) TABLE.csv`, in an empty folder.

Damage must be found: no reader may call a damaged file whole, go on from it with other numbers, or
crash. Each share zeroes all pages. `sample` flips bits beside the names of links and in the headers
of groups, `bytes` one bit of every byte that is in no long run of zeros, `bits` all bits of these
bytes. `verify` judges every trial (ASK_OFTEN asks it about bits), the others judge all pages and
some of the bits. Python's readers are among them where the package `carrom` and h5py can be
imported. TABLE.csv gets one line for each kind of damage.
"""

from __future__ import annotations

import csv
import itertools
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

try:
    import carrom
except ImportError:
    carrom = None

PAGE = 4096
LONGEST_RUN = 64  # zeros beyond these are room that no structure uses
MARKS = (b"carrom", b"run\0", b"checksums", b"particles", b"TREE", b"SNOD", b"HEAP", b"OHDR")
EVERY = {"sample": 31, "bytes": 199, "bits": 997}  # one bit in this many is tested with all readers
SMALL = """[box]
size = 20
[discs]
count = 12
packing = 0.4
speed = 2
[time]
method = "event-driven"
[output]
text = "none"
collisions = true
[output.trajectory]
every_steps = 1
[output.checkpoint]
every_steps = 2
[output.measurements]
quantities = ["velocities"]
every_steps = 2
bins = 4
"""
ORIGINAL, WORK = Path("original"), Path("work")
CHECKPOINT = "checkpoints/checkpoint-000000000004.h5"
FILES = {
    "checkpoint": CHECKPOINT,
    "index of a trajectory": "trajectory.h5",
    "segment of a trajectory": "trajectory/0001.h5",
    "index of a log": "collisions.h5",
    "segment of a log": "collisions/0001.h5",
}


class Program:
    """The program; `ask` returns its exit code, negative for a signal, and what it printed."""

    def __init__(self, path: str) -> None:
        self.path = path

    def ask(self, *words: str) -> tuple[int, str]:
        done = subprocess.run(
            [self.path, *words],
            capture_output=True,
            text=True,
            timeout=100,
            stdin=subprocess.DEVNULL,
            errors="replace",
        )
        return done.returncode, done.stdout + done.stderr

    def run(self, *words: str) -> tuple[int, str]:
        return self.ask("run", *words, "--quiet", "--threads", "1")


def make_original(program: Program) -> str:
    """A small run with all its files; returns the state hash of two steps more."""
    scene = Path("small.toml")
    scene.write_text(SMALL, encoding="ascii")
    code, text = program.run(str(scene), "--steps", "4", "-o", str(ORIGINAL))
    assert code == 0, text
    shutil.copytree(ORIGINAL, "further")
    code, text = program.run("-o", "further", "--resume", "--steps", "6")
    assert code == 0, text
    return hash_of("further")


def hash_of(folder: str) -> str:
    found = re.search(r'"state_hash": "([^"]*)"', (Path(folder) / "report.json").read_text())
    return found.group(1) if found else ""


def pages(data: bytes) -> Iterator[tuple[str, bytes]]:
    """The bytes with each page zeroed that is not zero already."""
    for begin in range(0, len(data), PAGE):
        end = min(begin + PAGE, len(data))
        if any(data[begin:end]):
            yield f"page {begin // PAGE}", data[:begin] + bytes(end - begin) + data[end:]


def used(data: bytes) -> list[int]:
    """The places of bytes that are in no long run of zeros."""
    unused = set(
        itertools.chain.from_iterable(
            range(*match.span()) for match in re.finditer(rb"\0{%d,}" % LONGEST_RUN, data)
        )
    )
    return [place for place in range(len(data)) if place not in unused]


def sampled(data: bytes) -> list[int]:
    """Some bytes at each name of a link and in each group's header."""
    places = {0, len(data) // 2, len(data) - 1}
    for mark in MARKS:
        for match in itertools.islice(re.finditer(re.escape(mark), data), 3):
            # With a damaged type of message, HDF5 1.10 finds the links of a group only at a second
            # call.
            places |= {match.start(), match.start() + 9, max(0, match.start() - 17)}
    return sorted(places & set(used(data)))


def bits(data: bytes, share: str) -> list[tuple[int, int]]:
    """The bits to flip: each is a byte and a number from 0 to 7."""
    if share == "bytes":
        return [(place, place % 8) for place in used(data)]
    places = sampled(data) if share == "sample" else used(data)
    return [(place, bit) for place in places for bit in range(8)]


def flipped(data: bytes, place: int, bit: int) -> bytes:
    damaged = bytearray(data)
    damaged[place] ^= 1 << bit
    return bytes(damaged)


def joining(name: str) -> str:
    """The file that readers open for a segment; other files as they are."""
    folder = name.split("/", maxsplit=1)[0]
    return name if folder in (name, "checkpoints") else f"{folder}.h5"


def read_by_python(path: Path) -> str:
    """Read all that Python can. Returns what is wrong: damage must be a FileError."""
    try:
        run = carrom.open(path)
        _ = [run.frames.x, *(point.x for point in run.checkpoints)]
        _ = run.collisions
    except carrom.FileError:
        return ""
    except carrom.NoDataError:
        return "python has read it"
    except Exception as error:
        return f"python ended with {error!r}"
    return "python has read it"


def readers(program: Program, kind: str, wanted: str) -> dict[str, str]:
    """What is wrong with how each reader ended, in words; empty where nothing is."""
    path = str(WORK / joining(FILES[kind]))
    found: dict[str, str] = {}

    def note(name: str, allowed: tuple[int, ...], words: tuple[str, ...]) -> int:
        code, text = program.ask(*words)
        found[name] = "" if code in allowed else f"{name} ended with {code}: {text[-300:]}"
        return code

    note("verify", (2,), ("verify", path))
    note("info", (2,) if "segment" not in kind else (0, 2), ("info", path))
    note("convert", (2,), ("convert", path, "--to", "csv", "--output", "out.csv"))
    quiet = ("--quiet", "--threads", "1")
    if kind == "checkpoint":
        note("--restart", (2,), ("run", "--restart", path, "--steps", "6", "-o", "other", *quiet))
    if "log" not in kind:
        scene = Path("from.toml")
        scene.write_text(
            f'[box]\nsize = 1000\n[discs]\nradius = 1\nfrom = "{Path(path).absolute()}"\n'
            '[time]\nsteps = 1\nmethod = "event-driven"\n',
            encoding="ascii",
        )
        note("discs.from", (2,), ("run", str(scene), "--set", "output.text=none", *quiet))
    if carrom is not None:
        found["python"] = read_by_python(Path(path))
    code = note("--resume", (0, 2), ("run", "-o", str(WORK), "--resume", "--steps", "6", *quiet))
    if code == 0 and hash_of(str(WORK)) != wanted:
        found["--resume"] = "--resume went on with other discs"
    shutil.rmtree("other", ignore_errors=True)
    return found


def main() -> int:
    program, ask_often, share, table_path = Program(sys.argv[1]), *sys.argv[2:5]
    wanted = make_original(program)
    counts: Counter[tuple[str, str, str]] = Counter()
    failures: list[str] = []

    def take(kind: str, damage: str, what: str, answers: dict[str, str]) -> None:
        for reader, wrong in answers.items():
            counts[kind, damage, reader] += 1
            if wrong:
                failures.append(f"{kind}, {what}: {wrong}")
                print(f"FAILED: {failures[-1]}", flush=True)

    def damage_and_read(kind: str, damaged: bytes) -> dict[str, str]:
        shutil.rmtree(WORK, ignore_errors=True)
        shutil.copytree(ORIGINAL, WORK)
        (WORK / FILES[kind]).write_bytes(damaged)
        return readers(program, kind, wanted)

    for kind, name in FILES.items():
        data = (ORIGINAL / name).read_bytes()
        for what, damaged in pages(data):
            take(kind, "page of zeros", what, damage_and_read(kind, damaged))
        flips = bits(data, share)
        for place, bit in flips[:: EVERY[share]]:
            found = damage_and_read(kind, flipped(data, place, bit))
            del found["verify"]  # `verify` tests all bits below
            take(kind, "bit flipped", f"bit {bit} of byte {place}", found)
        shutil.rmtree(WORK, ignore_errors=True)
        shutil.copytree(ORIGINAL, WORK)
        asked = subprocess.run(
            [ask_often, str(WORK / name), "verify", str(WORK / joining(name))],
            input="".join(f"{place} {bit}\n" for place, bit in flips),
            capture_output=True,
            text=True,
            check=True,
        )
        codes = asked.stdout.split()
        assert len(codes) == len(flips) and (WORK / name).read_bytes() == data
        for (place, bit), code in zip(flips, codes):
            wrong = "" if code == "2" else f"verify ended with {code}"
            take(kind, "bit flipped", f"bit {bit} of byte {place}", {"verify": wrong})
        print(f"{kind}: {asked.stderr.strip()}", flush=True)
    with open(table_path, "w", encoding="ascii", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["file", "damage", "reader", "trials"])
        table.writerows([*key, count] for key, count in sorted(counts.items()))
    print("Python's readers were asked" if carrom else "Python's readers were not asked: no h5py")
    print(f"{sum(counts.values())} answers, {len(failures)} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    sys.exit(main())
