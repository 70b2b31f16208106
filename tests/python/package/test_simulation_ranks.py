# SPDX-License-Identifier: BSD-3-Clause
"""`carrom.Simulation` on two ranks: mistakes of one rank, the end, and the script of a page."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from conftest import PERIODIC, gas

import carrom

pytestmark = pytest.mark.usefixtures("extension")

SOURCE = Path(os.environ.get("CARROM_SOURCE_DIR", str(Path(__file__).parents[3])))


def on_two_ranks(code: str, folder: Path) -> list[str]:
    """Run a script on two ranks, and return the lines that they print."""
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    try:
        launcher = carrom.program.find_launcher()
    except carrom.ProgramNotFoundError as error:
        pytest.skip(str(error))
    package = str(Path(carrom.__file__).parents[1])
    environment = carrom.launching.environment(99) | {"PYTHONPATH": package}
    (folder / "ranks.py").write_text(textwrap.dedent(code), encoding="utf-8")
    command = [launcher, "-n", "2", sys.executable, "ranks.py"]
    done = subprocess.run(
        command, capture_output=True, text=True, env=environment, cwd=folder, timeout=300
    )
    if "two MPI libraries" in done.stderr:
        pytest.skip("mpi4py is of another MPI library")
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


ONE_WRONG_ARRAY = f"""
import numpy as np
from mpi4py import MPI
import carrom

comm = MPI.COMM_WORLD
sim = carrom.Simulation({gas(steps=100, **PERIODIC)!r}, threads=1, comm=comm)
sim.run(3)
before = sim.state_hash
good = -sim.velocities
nan = good * np.nan
wrong = [good[:5], good + 1j, None, np.ma.masked_less(good, 0), "fast", [[1, 2], [3]], nan]
for rank in (0, 1):
    for values in wrong:
        try:
            sim.velocities = values if comm.rank == rank else good
        except (TypeError, ValueError) as error:
            heard = comm.allgather((type(error).__name__, str(error)))
            assert heard[0] == heard[1], heard
            if comm.rank == 0:
                print(heard[0][0], str(error).splitlines()[0], flush=True)
        else:
            raise SystemExit("no error")
        assert sim.state_hash == before
sim.velocities = good
sim.run(3)
alone = carrom.Simulation({gas(steps=100, **PERIODIC)!r}, threads=1, comm=MPI.COMM_SELF)
alone.run(3)
alone.velocities = -alone.velocities
alone.run(3)
assert sim.state_hash == alone.state_hash
"""


def test_one_wrong_array_is_an_error_of_all_ranks(tmp_path: Path) -> None:
    lines = on_two_ranks(ONE_WRONG_ARRAY, tmp_path)
    assert len(lines) == 14
    for rank in (0, 1):
        of_rank = lines[7 * rank : 7 * rank + 7]
        assert of_rank[0] == (
            f"ValueError velocities have the shape (60, 2), not (5, 2) (on rank {rank})"
        )
        assert of_rank[1].startswith("TypeError velocities are real numbers, not complex128 (on")
        assert of_rank[2] == f"TypeError velocities are real numbers, not None (on rank {rank})"
        assert of_rank[3].startswith("ValueError velocities have masked elements")
        assert of_rank[4].startswith("TypeError velocities are real numbers, not <U4")
        assert of_rank[5].startswith("ValueError velocities have the shape (60, 2), and rows")
        assert re.match(r"SceneError disc \d+: has a number that is not finite", of_rank[6])


ONE_WRONG_RUN = f"""
from mpi4py import MPI
import carrom

comm = MPI.COMM_WORLD
sim = carrom.Simulation({gas(steps=10)!r}, threads=1, comm=comm)
for rank in (0, 1):
    for steps in (2.5, "2", -1, 11):
        try:
            sim.run(steps if comm.rank == rank else 2)
        except (TypeError, carrom.SceneError) as error:
            heard = comm.allgather((type(error).__name__, str(error)))
            assert heard[0] == heard[1], heard
            if comm.rank == 0:
                print(heard[0][0], str(error), flush=True)
        else:
            raise SystemExit("no error")
        assert sim.step == 0
try:
    sim.run(2 + comm.rank)
except carrom.SceneError as error:
    if comm.rank == 0:
        print(error, flush=True)
for rank in (0, 1):
    try:
        sim.checkpoint("." if comm.rank == rank else "c.h5")
    except carrom.FileError as error:
        if comm.rank == 0:
            print(error, flush=True)
sim.run(10)
"""


def test_one_wrong_number_of_steps_or_path_is_an_error_of_all_ranks(tmp_path: Path) -> None:
    lines = on_two_ranks(ONE_WRONG_RUN, tmp_path)
    assert len(lines) == 11, lines
    of_rank_0, of_rank_1 = lines[:4], lines[4:8]
    assert of_rank_0 == [
        "TypeError run takes a whole number of steps, not 2.5 (on rank 0)",
        "TypeError run takes a whole number of steps, not '2' (on rank 0)",
        "SceneError run(-1) would end at step -1, and the scene goes from step 0 to "
        "time.steps = 10 (on rank 0)",
        "SceneError run(11) would end at step 11, and the scene goes from step 0 to "
        "time.steps = 10 (on rank 0)",
    ]
    assert of_rank_1 == [line.replace("rank 0", "rank 1") for line in of_rank_0]
    assert "different" in lines[8]
    for rank in (0, 1):
        assert lines[9 + rank] == f".: is not a plain file (on rank {rank})"


ONE_WRONG_SCENE = f"""
from mpi4py import MPI
import carrom

comm = MPI.COMM_WORLD
scene = {gas(steps=10)!r}
sim = carrom.Simulation(scene, threads=1, comm=comm)
sim.checkpoint("c.h5")
wrong = [(scene, 0), (scene, "2"), (None, 1), ("no = [toml", 1), ("c.h5", 1),
         ({{"box": {{"size": object()}}}}, 1), (scene | {{"discs": {{"count": 1.5}}}}, 1)]
for rank in (0, 1):
    for one, threads in wrong:
        mine = (one, threads) if comm.rank == rank else (scene, 1)
        try:
            carrom.Simulation(mine[0], threads=mine[1], comm=comm)
        except Exception as error:
            heard = comm.gather(f"{{type(error).__name__}} {{error}}".splitlines()[0])
            if comm.rank == 0:
                print(*heard, sep="|", flush=True)
        else:
            raise SystemExit("no error")
sim.run(10)
"""


def test_one_wrong_scene_is_an_error_of_all_ranks(tmp_path: Path) -> None:
    lines = [line.split("|") for line in on_two_ranks(ONE_WRONG_SCENE, tmp_path)]
    assert len(lines) == 14, lines
    for rank in (0, 1):
        words = [(line[rank], line[1 - rank]) for line in lines[7 * rank : 7 * rank + 7]]
        assert words[0][0] == "ValueError threads must be at least 1, not 0"
        for here, there in (*words[:3], words[5]):  # the others are read by the library
            assert here in there
            assert there.endswith(f"(on rank {rank})")
        here, there = words[4]
        assert here.endswith(f"rank {1 - rank} begins with a scene, and this one with a checkpoint")
        assert there.endswith(f"rank {rank} begins with a checkpoint, and this one with a scene")


ENDS = f"""
from mpi4py import MPI
import carrom

comm = MPI.COMM_WORLD
with carrom.Simulation({gas()!r}, threads=1, comm=comm) as sim:
    sim.run(2)
    twin = sim.copy()
twin.run(3)
twin.close()
for _ in range(300):  # MPI has some thousand communicators at most
    with carrom.Simulation({gas(count=4)!r}, threads=1, comm=comm) as sim:
        sim.run(1)
sim = carrom.Simulation({gas()!r}, threads=1, comm=comm)
sim.run(5)
steps = comm.gather((sim.step, repr(twin)))
if comm.rank == 0:
    print(steps)
"""


def test_ranks_close_together(tmp_path: Path) -> None:
    closed = (5, "<Simulation of 60 discs, closed>")
    assert on_two_ranks(ENDS, tmp_path) == [repr([closed, closed])]


def test_the_script_of_the_page_runs_on_two_ranks(tmp_path: Path) -> None:
    text = (SOURCE / "docs/how-to/python-loop.md").read_text(encoding="utf-8")
    section = text[text.index("## Several ranks") :]
    script, printed = re.search(
        r"^```python\n(.*?)^```.*?^```text\n(.*?)^```", section, re.M | re.S
    ).groups()  # type: ignore[union-attr]
    assert "mpiexec -n 2 python3 ranks.py" in section
    assert on_two_ranks(script, tmp_path) == printed.splitlines()
