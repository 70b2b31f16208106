# SPDX-License-Identifier: BSD-3-Clause
"""How `carrom.Simulation` is used: actions, errors, results, threads, interrupts, MPI."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import PERIODIC, gas, measured

import carrom

pytestmark = pytest.mark.usefixtures("extension")


def test_actions_come_in_order_at_their_steps() -> None:
    sim = carrom.Simulation(gas(steps=100))
    seen: list[tuple[str, int]] = []
    sim.every(10, lambda s: seen.append(("ten", s.step)))
    fours = sim.every(4, lambda s: seen.append(("four", s.step)))
    sim.run(21)
    assert seen == [
        ("four", 4), ("four", 8), ("ten", 10), ("four", 12), ("four", 16), ("ten", 20), ("four", 20)
    ]  # fmt: skip
    sim.forget(fours)
    sim.run(9)
    assert seen[7:] == [("ten", 30)]
    plain = carrom.Simulation(gas(steps=100))
    plain.run(30)
    assert sim.state_hash == plain.state_hash


def test_an_error_in_an_action_stops_the_run_at_its_step() -> None:
    sim = carrom.Simulation(gas(steps=100))

    @sim.every(7)  # type: ignore[misc]
    def fails(s: carrom.Simulation) -> None:
        raise ZeroDivisionError(f"at {s.step}")

    with pytest.raises(ZeroDivisionError, match="at 7") as caught:
        sim.run(50)
    assert any(entry.name == "fails" for entry in caught.traceback)
    assert sim.step == 7
    sim.forget(fails)
    sim.every(2, lambda s: s.run(1))
    with pytest.raises(carrom.CarromError, match="cannot run the simulation that calls it"):
        sim.run(5)
    assert sim.step == 8


def test_wrong_scenes_have_all_problems_of_the_program(program: Path, tmp_path: Path) -> None:
    wrong = {"box": {"size": -1}, "discs": {"count": 3}, "time": {"steps": "many"}}
    with pytest.raises(carrom.SceneError) as caught:
        carrom.Simulation(wrong)
    with pytest.raises(carrom.InputError) as wanted:
        carrom.run(wrong, folder=tmp_path / "run")
    ours = caught.value.lines
    theirs = [line.split(": ", 1)[1] for line in wanted.value.lines if "input.toml" in line]
    assert len(theirs) >= 3
    assert set(theirs) <= set(ours)
    with pytest.raises(carrom.SceneError, match=r"did you mean discs__seed=3\?"):
        carrom.Simulation(gas(), seed=3)
    with pytest.raises(carrom.SceneError, match=r"time\.steps = 20"):
        carrom.Simulation(gas()).run(21)
    with pytest.raises(carrom.SceneError, match="nowhere"):
        carrom.Simulation(tmp_path / "nowhere.toml")
    (tmp_path / "bad.h5").write_bytes(b"no checkpoint")
    with pytest.raises(carrom.InputError, match=r"bad\.h5"):
        carrom.Simulation(tmp_path / "bad.h5")


def test_scenes_come_in_all_forms(tmp_path: Path) -> None:
    scene = gas()
    text = carrom.to_toml(scene)
    (tmp_path / "scene.toml").write_text(text)
    hashes = set()
    for given in (scene, text, tmp_path / "scene.toml", str(tmp_path / "scene.toml")):
        sim = carrom.Simulation(given, discs__seed=5)
        sim.run(20)
        hashes.add(sim.state_hash)
    assert len(hashes) == 1
    del scene["time"]["steps"]
    assert carrom.Simulation(scene).last_step == 1_000_000


def test_a_frame_goes_where_frames_go() -> None:
    species = [{"count": 10, "radius": 1.0, "mass": 4}, {"count": 40, "radius": 0.5}]
    sim = carrom.Simulation(gas(**PERIODIC) | {"discs": {"species": species}})
    sim.run(5)
    frame = sim.frame
    positions = sim.positions
    sim.run(5)
    assert frame.step == 5
    assert np.array_equal(frame.x, positions)
    assert not np.array_equal(frame.x, sim.positions)
    assert frame.radius.tolist() == sim.radii.tolist() == [1.0] * 10 + [0.5] * 40
    assert frame.mass.tolist() == sim.masses.tolist() == [4.0] * 10 + [1.0] * 40
    assert sim.species.tolist() == [0] * 10 + [1] * 40
    assert frame.periodic == (True, True)
    assert frame.present.all()
    assert sim.frame.kinetic_energy == pytest.approx(sim.energy, rel=1e-12)
    assert "circle" in frame._repr_html_()
    assert "state hash" in sim._repr_html_()


def test_averages_and_tables_while_it_goes_on() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    sim = carrom.Simulation(measured(**PERIODIC))
    assert sim.tables["thermo"]["step"].tolist() == [0]
    with pytest.raises(carrom.NoDataError, match=r"there are .*thermo"):
        sim.tables["nothing"]
    sim.run(20)
    assert sim.tables["thermo"]["step"].tolist() == [0, 4, 8, 12, 16, 20]
    assert sim.averages["Z"].value == sim.averages["compressibility"].value
    assert sim.averages["Z"].value > 1
    assert "nothing" not in sim.averages
    frame = sim.averages.to_pandas()
    assert frame.loc["temperature", "value"] == sim.averages["kT"].value
    assert set(sim.tables.to_pandas()) == set(sim.tables)
    sim.restart_averages()
    assert math.isnan(sim.averages["Z"].value)


def test_other_threads_of_python_run_meanwhile() -> None:
    """A thread that counts gets on while one call to the library lasts some seconds."""
    sim = carrom.Simulation(gas(count=2000, steps=10**6) | {"box": {"size": 200}}, threads=1)
    counts = [0]
    is_over = threading.Event()

    def count() -> None:
        while not is_over.is_set():
            counts[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    begin = time.monotonic()
    while time.monotonic() - begin < 1:
        sim._core.advance(50)
    is_over.set()
    counter.join()
    assert counts[0] > 20
    errors: list[Exception] = []

    def use() -> None:
        try:
            sim.run(1)
        except carrom.CarromError as error:
            errors.append(error)

    other = threading.Thread(target=use)
    other.start()
    other.join()
    assert "belongs to the thread" in str(errors[0])


def run_python(code: str, *arguments: str) -> str:
    environment = os.environ | {"PYTHONPATH": str(Path(carrom.__file__).parents[1])}
    command = [sys.executable, "-c", textwrap.dedent(code), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_ctrl_c_leaves_a_usable_simulation() -> None:
    out = run_python(
        f"""
        import os, signal, threading
        import carrom

        scene = {gas(steps=10**6)!r}
        sim = carrom.Simulation(scene, threads=1)
        sim.run(1)
        threading.Timer(0.5, os.kill, (os.getpid(), signal.{signal.SIGINT.name})).start()
        try:
            sim.run(10**6 - 1)
        except KeyboardInterrupt:
            stopped = sim.step
        sim.run(10)
        whole = carrom.Simulation(scene, threads=2)
        whole.run(stopped + 10)
        print(1 < stopped < 10**6 - 10, sim.step == stopped + 10)
        print(sim.state_hash == whole.state_hash)
        """
    )
    assert out.split() == ["True"] * 3


def test_a_process_ends_well_with_simulations_alive() -> None:
    out = run_python(
        f"""
        import carrom
        sim = carrom.Simulation({gas()!r})
        keep = [sim, sim.copy()]
        sim.run(3)
        print(sim)
        """
    )
    assert out == "<Simulation of 60 discs, step 3 of 20>\n"


def test_a_missing_extension_says_how_to_get_it(tmp_path: Path) -> None:
    out = run_python(
        """
        import os, sys
        os.environ["CARROM_CORE"] = sys.argv[1]
        import carrom
        try:
            carrom.Simulation({"box": {"size": 3}})
        except carrom.MissingPackageError as error:
            print(error)
        """,
        str(tmp_path / "none.so"),
    )
    assert "needs the extension" in out
    assert "-DCARROM_PYTHON=ON" in out
    assert "none.so" in out


def test_a_communicator_of_mpi4py() -> None:
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    out = run_python(
        f"""
        import carrom
        from mpi4py import MPI

        scene = {gas()!r}
        try:
            ours = carrom.Simulation(scene, comm=MPI.COMM_SELF)
        except carrom.CarromError as error:
            assert "two MPI libraries" in str(error), error
            print("other")
        else:
            alone = carrom.Simulation(scene)
            for sim in (ours, alone):
                sim.run(20)
            print(ours.state_hash == alone.state_hash)
        """
    )
    assert out.split()[0] in ("True", "other")
    with pytest.raises(TypeError, match="communicator of mpi4py"):
        carrom.Simulation(gas(), comm=3)


RANKS = """
import sys
import numpy as np
from mpi4py import MPI
import carrom

scene = eval(sys.argv[1])
comm = MPI.COMM_WORLD
try:
    together = carrom.Simulation(scene, threads=1, comm=comm)
except carrom.CarromError as error:
    assert "two MPI libraries" in str(error), error
    sys.exit(77)
alone = carrom.Simulation(scene, threads=1, comm=MPI.COMM_SELF)
for sim in (together, alone):
    sim.run(7)
    velocities = sim.velocities.copy()
    velocities[::3] *= -1
    sim.velocities = velocities
    assert sim.copy().state_hash == sim.state_hash
    sim.run(10)
for sim in (together, alone):
    positions = sim.positions.copy()
    positions[7:9] += 1e-7 * (sim.box / 2 - positions[7:9])
    sim.positions = positions
    sim.run(60)
assert np.array_equal(together.images, alone.images)
assert together.images.any()
assert together.report["averages"] == alone.report["averages"]
assert together.state_hash == alone.state_hash
assert np.array_equal(together.positions, alone.positions)
local = together.local
assert np.array_equal(local.velocities, alone.velocities[local.ids])
assert sorted(sum(comm.allgather(local.ids.tolist()), [])) == list(range(60))
try:
    together.velocities = together.velocities * np.nan
except carrom.SceneError as error:
    assert "not finite" in str(error)
else:
    sys.exit("no error")
freed = comm.Dup()
later = carrom.Simulation(scene, threads=1, comm=freed)
freed.Free()
later.run(3)
assert len(later.local.ids) < 60
try:
    later.positions
except carrom.CarromError as error:
    assert "comm was freed" in str(error)
else:
    sys.exit("no error")
"""


@pytest.mark.parametrize("ranks", [2, 3])
def test_ranks_come_to_the_state_of_one(ranks: int) -> None:
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    try:
        launcher = carrom.program.find_launcher()
    except carrom.ProgramNotFoundError as error:
        pytest.skip(str(error))
    environment = carrom.launching.environment(99) | {
        "PYTHONPATH": str(Path(carrom.__file__).parents[1])
    }
    scene = repr(gas(steps=100, **PERIODIC))
    command = [launcher, "-n", str(ranks), sys.executable, "-c", RANKS, scene]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    if "77" in done.stderr and done.returncode != 0:
        pytest.skip("mpi4py is of another MPI library")
    assert done.returncode == 0, done.stderr
