# SPDX-License-Identifier: BSD-3-Clause
"""`carrom.Simulation` where users do what they should not, and where Python stops it midway."""

from __future__ import annotations

import copy
import gc
import os
import pickle
import subprocess
import sys
import textwrap
import threading
from pathlib import Path
from typing import Any

import pytest
from conftest import gas

import carrom

pytestmark = pytest.mark.usefixtures("extension")


def run_python(code: str, *, status: int = 0) -> list[str]:
    """Run code in a Python of its own and return the lines that it prints."""
    environment = os.environ | {"PYTHONPATH": str(Path(carrom.__file__).parents[1])}
    command = [sys.executable, "-c", textwrap.dedent(code)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    assert done.returncode == status, done.stderr
    assert "Exception ignored" not in done.stderr
    return done.stdout.splitlines()


# Copies and pickles


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy])
def test_copies_of_python_are_independent(copied: Any) -> None:
    sim = carrom.Simulation(gas())
    twin = copied(sim)
    twin.run(5)
    assert (sim.step, twin.step) == (0, 5)


def test_pickles_are_refused_with_advice() -> None:
    sim = carrom.Simulation(gas())
    for pickled in ({"a": [sim]}, sim.copy()):
        with pytest.raises(TypeError, match=r"cannot be pickled; send the path of a checkpoint"):
            pickle.dumps(pickled)


# Actions


def test_copies_and_checkpoints_inside_an_action(tmp_path: Path) -> None:
    sim = carrom.Simulation(gas(steps=40))
    twins: list[carrom.Simulation] = []

    @sim.every(5)  # type: ignore[misc]
    def branch(s: carrom.Simulation) -> None:
        twins.append(s.copy())
        twins[-1].run(3)
        s.checkpoint(tmp_path / "c.h5")
        twins.append(carrom.Simulation(tmp_path / "c.h5"))

    sim.run(15)
    assert [twin.step for twin in twins] == [8, 5, 13, 10, 18, 15]
    alone = carrom.Simulation(gas(steps=40))
    alone.run(13)
    assert twins[2].state_hash == alone.state_hash
    alone.run(2)
    assert sim.state_hash == alone.state_hash


def test_actions_that_add_and_forget_actions() -> None:
    sim = carrom.Simulation(gas(steps=40))
    seen: list[str] = []

    def second(s: carrom.Simulation) -> None:
        seen.append(f"second {s.step}")

    @sim.every(3)  # type: ignore[misc]
    def first(s: carrom.Simulation) -> None:
        seen.append(f"first {s.step}")
        s.forget(first)
        s.every(3, second)

    last = sim.every(3, lambda s: seen.append(f"last {s.step}") or s.forget(last))
    sim.run(7)
    assert seen == ["first 3", "last 3", "second 6"]


def kicked(steps: int = 60) -> carrom.Simulation:
    """A simulation with two actions a step: the second one has to come after the first."""
    sim = carrom.Simulation(gas(steps=steps))
    sim.every(2, lambda s: setattr(s, "velocities", s.velocities * 1.01))
    sim.every(2, lambda s: setattr(s, "velocities", s.velocities[::-1]))
    return sim


def test_after_an_error_the_other_actions_of_the_step_are_called() -> None:
    whole, cut = kicked(), kicked()
    errors: list[Exception] = [ZeroDivisionError()]

    def fails_once(s: carrom.Simulation) -> None:
        if s.step == 4 and errors:
            raise errors.pop()

    cut._actions._of.insert(1, (1, fails_once))
    with pytest.raises(ZeroDivisionError):
        cut.run(12)
    assert cut.step == 4
    cut.run(8)
    whole.run(12)
    assert cut.state_hash == whole.state_hash


class Interrupted:
    """A simulation of the library at whose 4th step Ctrl-C arrives, as Python raises it."""

    def __init__(self, core: Any) -> None:
        self.core = core

    def __getattr__(self, name: str) -> Any:
        return getattr(self.core, name)

    def advance(self, steps: int) -> None:
        self.core.advance(steps)
        if self.core.step == 4:
            raise KeyboardInterrupt


def test_actions_of_the_step_at_which_ctrl_c_comes_are_not_lost() -> None:
    whole, cut = kicked(), kicked()
    whole.run(12)
    real = cut._held._core
    cut._held._core = Interrupted(real)  # type: ignore[assignment]
    with pytest.raises(KeyboardInterrupt):
        cut.run(12)
    assert cut.step == 4
    cut._held._core = real
    cut.run(8)
    assert cut.state_hash == whole.state_hash


def test_bars_cannot_run_the_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(carrom.stepping, "STRETCH", 1e-9)
    sim = carrom.Simulation(gas(steps=40))
    with pytest.raises(carrom.CarromError, match="cannot run the simulation"):
        sim.run(20, progress=lambda step, last: sim.run(1))
    sim.run(40 - sim.step)


def test_a_function_as_bar_gets_the_end() -> None:
    seen: list[tuple[int, int]] = []
    sim = carrom.Simulation(gas(steps=40))
    sim.run(20, progress=lambda step, last: seen.append((step, last)))
    assert seen[-1] == (20, 20)


# Threads and processes


def test_other_threads_make_no_simulations() -> None:
    carrom.Simulation(gas())
    errors: list[str] = []

    def make() -> None:
        try:
            carrom.Simulation(gas())
        except carrom.CarromError as error:
            errors.append(str(error))

    thread = threading.Thread(target=make)
    thread.start()
    thread.join()
    assert "belongs to the thread that made the first one" in errors[0]


def test_what_another_thread_lets_go_of_ends_in_the_right_thread() -> None:
    """The collector of cycles runs in any thread; MPI may be called in one only."""
    sims = [carrom.Simulation(gas())]
    sims[0].every(1, lambda s, keep=sims[0]: None)  # a cycle
    sims.clear()
    thread = threading.Thread(target=gc.collect)
    gc.disable()
    try:
        thread.start()
        thread.join()
    finally:
        gc.enable()
    assert len(carrom.held_core._left) >= 1
    carrom.Simulation(gas())
    assert carrom.held_core._left == []


FORKED = f"""
import os, sys
import carrom

scene = {gas(steps=1000)!r}
sim = carrom.Simulation(scene, threads=2)
sim.run(5)
child = os.fork()
if child == 0:
    for use in (lambda: sim.run(1), lambda: sim.positions, lambda: carrom.Simulation(scene)):
        try:
            use()
        except carrom.CarromError as error:
            assert "forked process cannot use simulations" in str(error)
        else:
            os._exit(3)
    del sim
    sys.exit(0)
_, status = os.waitpid(child, 0)
print(status)
sim.run(5)
whole = carrom.Simulation(scene, threads=1)
whole.run(10)
print(sim.state_hash == whole.state_hash)
"""


def test_a_forked_process_is_told_and_leaves_the_parent_alone() -> None:
    assert run_python(FORKED) == ["0", "True"]


def test_workers_of_multiprocessing_begin_anew(tmp_path: Path) -> None:
    """With "spawn" each worker has MPI and threads of its own."""
    (tmp_path / "work.py").write_text(
        textwrap.dedent(
            f"""
            import multiprocessing
            import carrom

            def energy(seed):
                sim = carrom.Simulation({gas()!r}, discs__seed=seed, threads=1)
                sim.run(5)
                return sim.state_hash

            if __name__ == "__main__":
                here = energy(1)
                with multiprocessing.get_context("spawn").Pool(2) as pool:
                    hashes = pool.map(energy, [1, 2, 1])
                print(here == hashes[0] == hashes[2] != hashes[1])
            """
        )
    )
    environment = os.environ | {"PYTHONPATH": str(Path(carrom.__file__).parents[1])}
    command = [sys.executable, str(tmp_path / "work.py")]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    assert done.stdout.split() == ["True"], done.stderr


def test_a_simulation_in_a_cycle_is_alive_when_python_ends() -> None:
    code = f"""
    import carrom
    sim = carrom.Simulation({gas()!r})
    sim.every(1, lambda s, keep=[sim]: None)
    sim.run(3)
    print(sim.step)
    """
    assert run_python(code) == ["3"]


def test_the_communicator_may_not_be_freed_before() -> None:
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    code = f"""
    import carrom
    from mpi4py import MPI

    comm = MPI.COMM_SELF.Dup()
    try:
        sim = carrom.Simulation({gas()!r}, comm=comm)
    except carrom.CarromError as error:
        print("two MPI libraries" in str(error))
    else:
        sim.run(3)
        comm.Free()
        sim.run(3)
        print(sim.positions.shape == (60, 2))
        try:
            carrom.Simulation({gas()!r}, comm=comm)
        except carrom.CarromError as error:
            print(error)
    """
    printed = run_python(code)
    assert printed[0] == "True"
    assert len(printed) == 1 or "comm was freed" in printed[1]


# Checkpoints


def test_checkpoints_at_odd_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sim = carrom.Simulation(gas())
    sim.run(3)
    monkeypatch.chdir(tmp_path)
    for name in ("ö 'q' \"d\" $x;\n.h5", "no suffix", "-o.h5", "a=b.h5"):
        path = sim.checkpoint(name)
        assert path.is_file()
        assert carrom.Simulation(carrom.Checkpoint(path)).state_hash == sim.state_hash, name
    with pytest.raises(TypeError, match="bytes"):
        sim.checkpoint(b"c.h5")  # type: ignore[arg-type]
    for place in (tmp_path, tmp_path / "none" / "c.h5", "", "/dev/null", "c\0.h5"):
        with pytest.raises((carrom.CarromError, ValueError)):
            sim.checkpoint(place)
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "gas.toml").write_text("[box]")
    with pytest.raises(carrom.FileError):
        sim.checkpoint("gas.toml")
    assert sim.checkpoint("ö 'q' \"d\" $x;\n.h5").is_file()  # replaces a checkpoint
    sim.run(3)
    assert sim.step == 6


def test_a_full_disc_leaves_the_checkpoint_before(tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("there is no /dev/full")
    sim = carrom.Simulation(gas())
    with pytest.raises(carrom.CarromError):
        sim.checkpoint("/dev/full")
    sim.run(1)


# Outputs that a scene requests, but that a Simulation does not write


def test_files_that_a_scene_asks_for_are_warned_of() -> None:
    scene = gas() | {"output": {"trajectory": {"every_steps": 5}, "collisions": True}}
    with pytest.warns(carrom.CarromWarning, match="output.*trajectory"):
        carrom.Simulation(scene)
