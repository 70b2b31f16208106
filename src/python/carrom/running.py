# SPDX-License-Identifier: BSD-3-Clause
"""Starting the program: `run` and `resume`."""

from __future__ import annotations

import contextlib
import operator
import os
import signal
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Union

from carrom.errors import (
    ERROR_OF_CODE,
    CarromError,
    FileError,
    InputError,
    OutputError,
    ProgramError,
)
from carrom.process import Process
from carrom.program import find_launcher, find_program
from carrom.progress import progress_display
from carrom.runs import SCENE_FILES, Run
from carrom.scene import SceneLike, flattened, read_scene, scene_file, set_words
from carrom.words import in_python

ProgressLike = Union[bool, Callable[[int, int], None], None]


class CarromWarning(UserWarning):
    """A warning of the program."""


def run(
    scene: SceneLike,
    ranks: int = 1,
    threads: int | None = None,
    folder: str | os.PathLike[str] | None = None,
    *,
    steps: int | None = None,
    overwrite: bool = False,
    check: bool = False,
    accuracy: float | None = None,
    progress: ProgressLike = None,
    program: str | os.PathLike[str] | None = None,
    launcher: str | os.PathLike[str] | None = None,
    options: Sequence[str] = (),
    **overrides: Any,
) -> Run:
    """Run a scene and return it when it is done.

    Args:
        scene: a dictionary, the path of a file, or TOML text (a string with a line break)
        ranks: MPI ranks; more than 1 start through the MPI launcher
        threads: threads of each rank; the program's choice if None
        folder: where all that the run writes goes. None: `output.folder` of the scene, else a
            new folder in the system's place for temporary files, which is kept
        steps: steps to run, instead of the scene's
        overwrite: remove a run that is in the folder; without it such a run is an error
        check: check all invariants after each step
        accuracy: choose the fastest method with at most this relative error
        progress: True or False; None shows progress on terminals and in notebooks. Or a
            function that is called with the step and the last step
        program: the program; see `carrom.find_program`
        launcher: the MPI launcher; else CARROM_MPIEXEC, mpiexec or mpirun
        options: more words for `carrom run`, for example `["--rebalance-every", "4"]`
        **overrides: keys of the scene: `time={"steps": 5}`, `time__steps=5` or
            `**{"time.steps": 5}`

    Raises:
        InputError: the scene or an option is wrong; the message has the program's lines
        StoppedError: the run was told to stop and has stored a checkpoint
        CollectiveError, OutputError, InvariantError, ProgramError: as their names say
        ProgramNotFoundError: the program or the launcher is not there, or cannot be started
        TypeError: a scene or an argument is of the wrong kind, or TOML has no such value (None)
        ValueError: ranks is below 1
    """
    place, is_new = _place(folder, scene, overrides)
    with (
        _prepared(place, is_new, overwrite) as lines,
        scene_file(scene, overrides, place) as file,
    ):
        words = [str(file.path), *_set_options(file.overrides)]
        words += ["--overwrite"] if overwrite else []
        words += ["--accuracy", repr(float(accuracy))] if accuracy is not None else []
        words += _common_options(threads, steps, check, options)
        try:
            return _execute(place, words, lines, ranks, program, launcher, progress)
        except InputError as error:
            if file.text is not None and sys.version_info >= (3, 11):
                numbered = enumerate(file.text.splitlines(), 1)
                text = "\n".join(f"{n:4} {line}" for n, line in numbered)
                error.add_note(f"{file.path}:\n{text}")
            raise


def resume(
    folder: str | os.PathLike[str],
    ranks: int = 1,
    threads: int | None = None,
    *,
    steps: int | None = None,
    check: bool = False,
    progress: ProgressLike = None,
    program: str | os.PathLike[str] | None = None,
    launcher: str | os.PathLike[str] | None = None,
    options: Sequence[str] = (),
    **overrides: Any,
) -> Run:
    """Go on with the run of a folder, from its newest whole checkpoint, to its last step.

    `steps` names another last step. The bits are those of a run that was never stopped, on any
    number of ranks and threads. Arguments and errors are those of `carrom.run`.
    """
    place = Path(folder)
    if not place.is_dir():
        raise FileError(f"{folder}: there is no such folder to go on with")
    words = ["--resume", *_set_options(set_words(overrides))]
    words += _common_options(threads, steps, check, options)
    with _prepared(place, is_new=False) as lines:
        return _execute(place, words, lines, ranks, program, launcher, progress)


def _set_options(words: Sequence[str]) -> list[str]:
    return [option for word in words for option in ("--set", word)]


def _common_options(
    threads: int | None, steps: int | None, check: bool, options: Sequence[str]
) -> list[str]:
    if isinstance(options, str):
        raise TypeError(f"options is a list of words, not the string {options!r}")
    words = [] if threads is None else ["--threads", str(threads)]
    words += [] if steps is None else ["--steps", str(steps)]
    words += ["--check"] if check else []
    return [*words, *options]


def _place(
    folder: str | os.PathLike[str] | None, scene: SceneLike, overrides: Mapping[str, Any]
) -> tuple[Path, bool]:
    """Where the run goes, and whether the folder is new: what is named, else one for good."""
    named = folder if folder is not None else flattened(overrides).get("output.folder")
    if named is None:
        with contextlib.suppress(CarromError, TypeError):  # the program reports a wrong scene
            named = flattened(read_scene(scene)).get("output.folder")
    if isinstance(named, (str, os.PathLike)) and os.fspath(named):
        return Path(named), not Path(named).exists()
    return Path(tempfile.mkdtemp(prefix="carrom-run-")), True


@contextmanager
def _prepared(folder: Path, is_new: bool, overwrite: bool = False) -> Iterator[Path]:
    """Make the folder, and a file for lines of discs. Leave nothing there that is empty.

    Lines of an older run stay until the program has begun another. An empty file of lines that
    was there may be that of a run that goes on.
    """
    kept = folder / "lines.txt"
    lines = folder / "lines.txt.new" if overwrite else kept
    try:
        folder.mkdir(parents=True, exist_ok=True)
        were_there, before = lines.exists(), _scene_files(folder)
        lines.touch()
    except OSError as error:
        message = f"{folder}: cannot be written to: {error.strerror}"
        raise OutputError([message], 4) from None
    is_done = False
    try:
        yield lines
        is_done = True
    finally:
        with contextlib.suppress(OSError):
            if overwrite and _scene_files(folder) != before:
                lines.replace(kept)
                lines = kept
            if (is_done or not were_there) and lines.stat().st_size == 0:
                lines.unlink()
            if is_new:
                folder.rmdir()


def _scene_files(folder: Path) -> list[tuple[str, int, int]]:
    """What changes when the program begins a run in a folder."""
    paths = [folder / name for name in SCENE_FILES]
    stats = [(path.name, path.stat()) for path in paths if path.exists()]
    return [(name, stat.st_ino, stat.st_mtime_ns) for name, stat in stats]


def _execute(
    folder: Path,
    words: Sequence[str],
    lines: Path,
    ranks: int,
    program: str | os.PathLike[str] | None,
    launcher: str | os.PathLike[str] | None,
    progress: ProgressLike,
) -> Run:
    if operator.index(ranks) < 1:
        raise ValueError(f"ranks must be at least 1, not {ranks}")
    command = [str(find_program(program)), "run", *words, "-o", str(folder)]
    if ranks > 1:
        command = [find_launcher(launcher), "-n", str(ranks), *command]
    process = Process(command, lines, _environment(ranks))
    with progress_display(progress) as show:
        code = process.wait(show)
    _raise_for(code, process.lines, command, folder)
    for line in process.lines:
        if line.startswith("warning: "):
            text = in_python(line.removeprefix("warning: "))
            warnings.warn(text, CarromWarning, stacklevel=3)
    result = Run(folder)
    result.log = process.lines
    return result


def _environment(ranks: int) -> dict[str, str]:
    """Let Open MPI start more ranks than cores (MPICH always does), and ranks that wait sleep."""
    environment = dict(os.environ)
    if ranks > len(os.sched_getaffinity(0)):
        environment.setdefault("OMPI_MCA_rmaps_base_oversubscribe", "1")
        environment.setdefault("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe")
        environment.setdefault("OMPI_MCA_hwloc_base_binding_policy", "none")
        environment.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
        environment.setdefault("MPIR_CVAR_ENABLE_HEAVY_YIELD", "1")
        environment.setdefault("OMP_WAIT_POLICY", "passive")
    return environment


def _raise_for(code: int, lines: list[str], command: list[str], folder: Path) -> None:
    if code == 0:
        return
    if code in ERROR_OF_CODE:
        raise ERROR_OF_CODE[code]([in_python(line) for line in lines], code, command)
    number = -code if code < 0 else code - 128
    ending = f"exit code {code}"
    if number in set(signal.Signals):
        ending = f"signal {signal.Signals(number).name}"
    kept = any((folder / "checkpoints").glob("checkpoint-*.h5"))
    advice = f"; carrom.resume({str(folder)!r}) goes on from the newest checkpoint" if kept else ""
    lines = [in_python(line) for line in lines]
    raise ProgramError([*lines, f"carrom ended with {ending}{advice}"], code, command)
