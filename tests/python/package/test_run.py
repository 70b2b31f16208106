# SPDX-License-Identifier: BSD-3-Clause
"""Running: the program's bits and files, its errors by exit code, and runs that end early."""

from __future__ import annotations

import _thread
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import Scene, gas

import carrom
import carrom.process
from carrom.words import in_python

LONG = 50_000_000  # steps: no test waits for the end


def program_alone(program: Path, scene: Scene, folder: Path) -> None:
    path = folder.with_suffix(".toml")
    path.write_text(carrom.to_toml(scene))
    subprocess.run([program, "run", path, "-o", folder, "--quiet"], check=True)


def test_a_run_writes_what_the_program_alone_writes(program: Path, tmp_path: Path) -> None:
    scene = gas() | {
        "output": {
            "collisions": True,
            "trajectory": {"every_steps": 4},
            "measurements": {"quantities": ["radial_distribution"]},
        }
    }
    program_alone(program, scene, tmp_path / "alone")
    run = carrom.run(scene, folder=tmp_path / "run")

    def files(folder: str) -> list[str]:
        top = tmp_path / folder
        return sorted(str(path.relative_to(top)) for path in top.rglob("*"))

    assert files("run") == files("alone")
    assert run.state_hash == carrom.open(tmp_path / "alone").state_hash
    assert run.is_finished
    table = "measurements/radial_distribution.csv"
    ours, theirs = ((tmp_path / name / table).read_text() for name in ("run", "alone"))
    assert ours.splitlines()[1:] == theirs.splitlines()[1:]  # the first line names the scene


def test_two_ranks_give_the_same_bits(program: Path, tmp_path: Path) -> None:
    one = carrom.run(gas(), folder=tmp_path / "one", threads=2)
    two = carrom.run(gas(), ranks=2, threads=1, folder=tmp_path / "two")
    assert (one.report["threads"], two.report["ranks"]) == (2, 2)
    assert one.state_hash == two.state_hash


def test_all_problems_of_a_scene_are_in_the_error(program: Path, tmp_path: Path) -> None:
    scene = gas()
    scene["box"] = {"size": -3, "sice": 4}
    folder = tmp_path / "bad"
    with pytest.raises(carrom.InputError) as caught:
        carrom.run(scene, folder=folder)
    error = caught.value
    assert error.returncode == 2
    assert len(error.lines) >= 2
    assert "input.toml:2: 'box.size' must be" in error.lines[0]
    assert "no such key 'box.sice'; did you mean 'box.size'?" in str(error)
    if sys.version_info >= (3, 11):
        assert "   2 size = -3" in error.__notes__[0]
    assert not folder.exists()
    assert isinstance(error, ValueError)
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.lines, copy.returncode) == (error.lines, 2)


def test_a_scene_that_is_not_there_is_an_input_error(program: Path, tmp_path: Path) -> None:
    with pytest.raises(carrom.InputError, match=r"nowhere\.toml: cannot be opened"):
        carrom.run(tmp_path / "nowhere.toml", folder=tmp_path / "run")


def test_a_missing_launcher_is_named(program: Path, tmp_path: Path) -> None:
    with pytest.raises(carrom.ProgramNotFoundError, match="no MPI launcher: /no/mpiexec"):
        carrom.run(gas(), ranks=2, folder=tmp_path / "run", launcher="/no/mpiexec")
    assert not (tmp_path / "run").exists()
    with pytest.raises(ValueError, match="ranks must be at least 1, not 0"):
        carrom.run(gas(), ranks=0, folder=tmp_path / "run")


def test_a_run_is_not_written_over_unless_asked(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=2) | {"output": {"text": "ends"}}
    first = carrom.run(scene, folder=tmp_path / "run")
    lines = (tmp_path / "run/lines.txt").read_bytes()
    with pytest.raises(carrom.InputError, match="begin anew by overwrite=True"):
        carrom.run(scene, folder=tmp_path / "run", discs__seed=9)
    assert first.report["steps"] == 2
    assert (tmp_path / "run/lines.txt").read_bytes() == lines
    second = carrom.run(scene, folder=tmp_path / "run", discs__seed=9, overwrite=True)
    assert second.scene["discs"]["seed"] == 9
    assert len(second.lines[2]) == 60
    assert (tmp_path / "run/lines.txt").read_bytes() != lines


def test_a_call_that_fails_leaves_what_is_there(program: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "input.toml").write_text("# the user's own\n")
    scene = gas(steps=2) | {"output": {"text": "ends"}}
    carrom.run(scene, folder=folder)
    assert (folder / "input.toml").read_text() == "# the user's own\n"
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    wrong = scene | {"discs": None}
    with pytest.raises(ValueError, match="ranks must be"):
        carrom.run(scene, ranks=0, folder=folder, overwrite=True)
    with pytest.raises(carrom.ProgramNotFoundError):
        carrom.run(scene, folder=folder, overwrite=True, program="/no/carrom")
    with pytest.raises(carrom.ProgramError):
        carrom.run(scene, ranks=2, folder=folder, overwrite=True, launcher="false")
    with pytest.raises(TypeError, match="discs: a scene cannot have None"):
        carrom.run(wrong, folder=folder, overwrite=True)
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before
    carrom.run(gas(steps=2), folder=folder, overwrite=True)
    assert not (folder / "lines.txt").exists()


def test_a_refused_run_leaves_the_lines_of_one_that_goes_on(program: Path, tmp_path: Path) -> None:
    carrom.run(gas(steps=2), folder=tmp_path)
    lines = tmp_path / "lines.txt"
    lines.touch()  # as if another process had opened it
    with pytest.raises(carrom.InputError, match="begin anew by overwrite=True"):
        carrom.run(gas(steps=2), folder=tmp_path)
    assert lines.exists()


def test_wrong_calls_say_what_is_wrong(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    no_program = tmp_path / "no_program"
    no_program.write_text("no program")
    no_program.chmod(0o755)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    with pytest.raises(carrom.InputError, match="'output' is a table, not a value"):
        carrom.run(gas() | {"output": 5})
    with pytest.raises(carrom.InputError, match="no such key 'ä\U0001f600'"):
        carrom.run(gas() | {"ä\U0001f600": 5})
    with pytest.raises(TypeError, match="keys of a scene are strings, not 5"):
        carrom.run({**gas(), 5: 1})  # type: ignore[dict-item]
    with pytest.raises(TypeError, match="a scene is a dictionary, a path or TOML text, not None"):
        carrom.run(None)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"time\.steps: a scene cannot have None"):
        carrom.run(gas(), time__steps=None)
    with pytest.raises(TypeError, match="integer"):
        carrom.run(gas(), ranks=2.5)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="options is a list of words"):
        carrom.run(gas(), options="--check")
    with pytest.raises(carrom.ProgramNotFoundError, match="cannot be started"):
        carrom.run(gas(), program=no_program)
    with pytest.raises(carrom.ProgramNotFoundError, match="prints no version"):
        carrom.program_version(no_program)
    assert list(temporary.iterdir()) == []


def test_a_folder_that_cannot_be_is_an_output_error(program: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(carrom.OutputError, match="file/run: cannot be written to") as caught:
        carrom.run(gas(), folder=tmp_path / "file" / "run")
    assert caught.value.returncode == 4


def test_without_a_folder_the_run_is_kept_in_a_new_one(program: Path) -> None:
    run = carrom.run(gas(steps=1))
    assert run.folder is not None
    assert run.is_finished
    for path in sorted(run.folder.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    run.folder.rmdir()


def test_the_folder_of_the_scene_counts(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    run = carrom.run(gas(steps=1) | {"output": {"folder": "named"}})
    assert run.folder == Path("named")


def test_progress_calls_a_function(program: Path, tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    carrom.run(gas(steps=20_000), folder=tmp_path / "run", progress=lambda *at: seen.append(at))
    assert seen
    assert all(0 <= step <= last == 20_000 for step, last in seen)
    assert [step for step, _ in seen] == sorted(step for step, _ in seen)
    assert seen[-1] == (20_000, 20_000)


def test_progress_gives_the_line_to_a_third_argument(program: Path, tmp_path: Path) -> None:
    lines: list[str] = []

    def show(step: int, last: int, line: str) -> None:
        assert line.startswith(f"step {step} of {last} (")
        lines.append(line)

    carrom.run(gas(steps=30_000), folder=tmp_path / "run", progress=show)
    assert any("steps/s" in line and "left" in line for line in lines[:-1])
    assert lines[-1] == "step 30000 of 30000 (100 %)"


def test_an_unknown_argument_is_answered_by_an_argument(program: Path, tmp_path: Path) -> None:
    for scene in (gas(), carrom.to_toml(gas())):
        with pytest.raises(carrom.InputError) as caught:
            carrom.run(scene, folder=tmp_path / "run", seed=3)
        assert "no such key 'seed'; did you mean discs__seed=3?" in str(caught.value)
        assert caught.value.lines == str(caught.value).splitlines()
    with pytest.raises(carrom.InputError, match=r"did you mean 'discs\.seed'\?"):
        carrom.run(gas() | {"seed": 3}, folder=tmp_path / "run")


def wait_for(path: Path, pattern: str, seconds: float = 60) -> None:
    end = time.monotonic() + seconds
    while not list(path.glob(pattern)):
        assert time.monotonic() < end, f"no {pattern} in {path}"
        time.sleep(0.02)


def when_there(path: Path, pattern: str, act: object) -> threading.Thread:
    """Do something once a file is there."""

    def wait_and_act() -> None:
        wait_for(path, pattern)
        act()  # type: ignore[operator]

    thread = threading.Thread(target=wait_and_act)
    thread.start()
    return thread


@pytest.fixture
def children(monkeypatch: pytest.MonkeyPatch) -> list[subprocess.Popen[bytes]]:
    """The processes that runs start."""
    found: list[subprocess.Popen[bytes]] = []

    class Watched(subprocess.Popen):  # type: ignore[type-arg]
        def __init__(self, *words: object, **options: object) -> None:
            super().__init__(*words, **options)  # type: ignore[call-overload]
            found.append(self)

    monkeypatch.setattr(carrom.process.subprocess, "Popen", Watched)
    return found


CHECKPOINTS = {"output": {"checkpoint": {"every_steps": 500, "keep": 3}}}


@pytest.mark.parametrize(
    ("number", "kind"),
    [(signal.SIGKILL, carrom.ProgramError), (signal.SIGUSR1, carrom.StoppedError)],
)
def test_a_run_that_ends_early_can_be_gone_on_with(
    program: Path,
    tmp_path: Path,
    children: list[subprocess.Popen[bytes]],
    number: signal.Signals,
    kind: type[carrom.ProgramError],
) -> None:
    folder = tmp_path / "run"
    thread = when_there(
        folder, "checkpoints/checkpoint-*.h5", lambda: children[0].send_signal(number)
    )
    with pytest.raises(kind, match=r"goes on") as caught:
        carrom.run(gas(steps=LONG) | CHECKPOINTS, threads=1, folder=folder)
    thread.join()
    assert caught.value.returncode == (75 if number == signal.SIGUSR1 else -9)
    run = carrom.open(folder)
    assert not run.is_finished
    assert "not finished" in repr(run)
    last = run.checkpoints[-1].step + 30
    resumed = run.resume(steps=last)
    assert resumed.is_finished
    whole = carrom.run(gas(steps=last), folder=tmp_path / "whole")
    assert resumed.state_hash == whole.state_hash


def test_an_interrupt_stores_a_checkpoint(program: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    thread = when_there(folder, "scene.toml", lambda: (time.sleep(0.5), _thread.interrupt_main()))
    with pytest.raises(KeyboardInterrupt, match="goes on"):
        carrom.run(gas(steps=LONG), threads=1, folder=folder)
    thread.join()
    assert len(carrom.open(folder).checkpoints) == 1


def test_going_on_with_nothing_is_an_error(program: Path, tmp_path: Path) -> None:
    with pytest.raises(carrom.FileError, match="there is no such folder"):
        carrom.resume(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(carrom.InputError, match="there is no checkpoint, and no scene"):
        carrom.resume(tmp_path / "empty")
    assert (tmp_path / "empty").is_dir()


def test_legacy_text_runs(program: Path, tmp_path: Path) -> None:
    path = tmp_path / "tiny.in"
    path.write_text("2\n10\n1\n2\nprint\n0 2 2 1 0\n1 7 7 0 -1\n")
    run = carrom.run(path, folder=tmp_path / "run")
    assert sorted(run.lines) == [0, 1, 2]
    assert run.lines[2].tolist() == [[4, 2, 1, 0], [7, 5, 0, -1]]
    assert run.is_finished


def test_the_program_goes_on_without_python(program: Path, tmp_path: Path) -> None:
    """Python is killed in mid-run: the program finishes its run."""
    code = (
        "import carrom, sys\n"
        f"carrom.run({gas(steps=30_000)!r}, threads=1, folder=sys.argv[1], progress=True)\n"
    )
    folder = tmp_path / "run"
    child = subprocess.Popen([sys.executable, "-c", code, str(folder)], env=with_package())
    try:
        wait_for(folder, "scene.toml")
        child.kill()
    finally:
        child.wait()
    wait_for(folder, "report.json")
    assert carrom.open(folder).is_finished


def with_package() -> dict[str, str]:
    path = str(Path(carrom.__file__).parents[1])
    return os.environ | {"PYTHONPATH": path}


def test_a_context_closes_the_file(run: carrom.Run) -> None:
    def is_open(path: Path) -> bool:
        links = (os.path.realpath(link) for link in Path("/proc/self/fd").iterdir())
        return any(link.startswith(str(path.parent / "trajectory")) for link in links)

    assert run.folder is not None
    path = Path(run.folder / "trajectory.h5").resolve()
    run.close()
    with carrom.open(run.folder) as opened:
        frame, other = opened.frames[-1], opened.frames[0]
        assert frame.x.shape == (60, 2)
        assert is_open(path)
    assert not is_open(path)
    assert frame.x.shape == (60, 2)
    with pytest.raises(ValueError, match="the trajectory is closed"):
        other.x  # noqa: B018
    assert len(opened.frames) == 5
    with opened.frames as frames:
        assert frames[0].x.shape == (60, 2)
    assert not is_open(path)


def test_errors_speak_python(program: Path, tmp_path: Path) -> None:
    with pytest.raises(carrom.InputError) as caught:
        carrom.run(gas(steps=2), folder=tmp_path / "run", threads=-1)
    assert "threads" in str(caught.value)
    assert "--" not in str(caught.value)
    carrom.run(gas(steps=2), folder=tmp_path / "run")
    with pytest.raises(carrom.InputError, match=r"go on with it by carrom\.resume\(folder\)"):
        carrom.run(gas(steps=2), folder=tmp_path / "run")
    said = in_python("stopped on request; carrom run -o a folder --resume goes on")
    assert said == 'stopped on request; carrom.resume("a folder") goes on'


def test_frames_appear_while_a_run_goes_on(program: Path, tmp_path: Path) -> None:
    """A second after the start there are some, with nothing committed by a checkpoint."""
    scene = gas(steps=50_000_000)
    scene["output"] = {"trajectory": {"every_steps": 1000}}
    (tmp_path / "scene.toml").write_text(carrom.to_toml(scene))
    folder = tmp_path / "run"
    command = [program, "run", tmp_path / "scene.toml", "-o", folder, "--quiet"]
    child = subprocess.Popen(command)
    try:
        wait_for(folder, "trajectory.h5")
        start = time.monotonic()
        while len(carrom.open(folder, check=False).frames) < 2:
            time.sleep(0.05)
            assert time.monotonic() - start < 4
    finally:
        child.terminate()
        child.wait()
