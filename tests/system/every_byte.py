# SPDX-License-Identifier: BSD-3-Clause
"""Damage each page and each bit of a run's files, and ask everything that reads them.

`every_byte.py PROGRAM SCENE (sample|all) [TABLE.csv]`, in an empty folder. Damage must be found: no
reader may call a damaged file whole, go on from it with other numbers, or crash. `sample` zeroes
all pages, and flips bits beside the names of links and in the headers of groups; `all` flips every
bit that is not one of a long run of zeros. TABLE.csv gets one line for each kind of damage.
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

PAGE = 4096
LONGEST_RUN = 64  # zeros beyond these are room that no structure uses
MARKS = (b"carrom", b"run\0", b"checksums", b"particles", b"TREE", b"SNOD", b"HEAP", b"OHDR")
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

    def __init__(self, path: str, scene: str) -> None:
        self.path, self.scene = path, scene

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
    words = [program.scene]
    for setting in (
        "discs.count=12",
        "discs.packing=0.4",
        "discs.speed=100",
        "output.text=none",
        "output.trajectory.every_steps=1",
        "output.collisions=true",
        "output.checkpoint.every_steps=2",
        'output.measurements.quantities=["velocities"]',
        "output.measurements.every_steps=2",
    ):
        words += ["--set", setting]
    code, text = program.run(*words, "--steps", "4", "-o", str(ORIGINAL))
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
            places |= {match.start(), match.start() + 9}
    return sorted(places & set(used(data)))


def bits(data: bytes, places: list[int], step: int) -> Iterator[tuple[str, bytes]]:
    for count, place in enumerate(places):
        for bit in range(count % step, 8, step):
            damaged = bytearray(data)
            damaged[place] ^= 1 << bit
            yield f"bit {bit} of byte {place}", bytes(damaged)


def readers(program: Program, kind: str, wanted: str) -> dict[str, tuple[tuple[int, ...], str]]:
    """What each reader ended with: its allowed codes, and what is wrong, if anything is."""
    top = FILES[kind]
    if "segment" in kind:
        top = top.split("/", maxsplit=1)[0] + ".h5"
    path = str(WORK / top)
    found: dict[str, tuple[tuple[int, ...], str]] = {}

    def note(name: str, allowed: tuple[int, ...], words: tuple[str, ...]) -> int:
        code, text = program.ask(*words)
        wrong = "" if code in allowed else f"{name} ended with {code}: {text[-300:]}"
        found[name] = (allowed, wrong)
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
    code = note("--resume", (0, 2), ("run", "-o", str(WORK), "--resume", "--steps", "6", *quiet))
    if code == 0 and hash_of(str(WORK)) != wanted:
        found["--resume"] = ((0, 2), "--resume went on with other discs")
    shutil.rmtree("other", ignore_errors=True)
    return found


def main() -> int:
    program = Program(sys.argv[1], sys.argv[2])
    is_all = sys.argv[3] == "all"
    wanted = make_original(program)
    counts: Counter[tuple[str, str, str]] = Counter()
    failures: list[str] = []
    for kind, name in FILES.items():
        data = (ORIGINAL / name).read_bytes()
        flips = bits(data, used(data), 1) if is_all else bits(data, sampled(data), 8)
        for number, (what, damaged) in enumerate(itertools.chain(pages(data), flips)):
            shutil.rmtree(WORK, ignore_errors=True)
            shutil.copytree(ORIGINAL, WORK)
            (WORK / name).write_bytes(damaged)
            is_page = what.startswith("page")
            if is_page or number % 50 == 0 or (not is_all and number % 4 == 0):
                answers = readers(program, kind, wanted)
            else:
                top = name.split("/", maxsplit=1)[0] + ".h5" if "segment" in kind else name
                code, text = program.ask("verify", str(WORK / top))
                answers = {"verify": ((2,), "" if code == 2 else f"verify: {code}: {text}")}
            for reader, (_, wrong) in answers.items():
                damage = "page of zeros" if is_page else "bit flipped"
                counts[kind, damage, reader] += 1
                if wrong:
                    failures.append(f"{kind}, {what}: {wrong}")
                    print(f"FAILED: {failures[-1]}", flush=True)
    if len(sys.argv) > 4:
        with open(sys.argv[4], "w", encoding="ascii", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["file", "damage", "reader", "trials"])
            table.writerows([*key, count] for key, count in sorted(counts.items()))
    print(f"{sum(counts.values())} answers, {len(failures)} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    sys.exit(main())
