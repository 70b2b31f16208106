# SPDX-License-Identifier: BSD-3-Clause
"""The program on a folder: options, what is prepared before it starts, and its exit codes."""

from __future__ import annotations

import contextlib
import operator
import os
import signal
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
    OutputError,
    ProgramError,
)
from carrom.process import Process
from carrom.program import find_launcher, find_program
from carrom.progress import progress_display
from carrom.scene import SCENE_FILES, SceneLike, flattened, read_scene, set_words
from carrom.words import in_python

ProgressLike = Union[bool, Callable[..., None], None]


class CarromWarning(UserWarning):
    """A warning of the program."""


def go_on(
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
) -> list[str]:
    """Go on with the run of a folder and return what the program has printed.

    See `carrom.resume`. It is apart, so that a `Run` can go on without a circle of imports.
    """
    place = Path(folder)
    if not place.is_dir():
        raise FileError(f"{folder}: there is no such folder to go on with")
    words = ["--resume", *set_options(set_words(overrides))]
    words += common_options(threads, steps, check, options)
    with prepared(place, is_new=False) as lines:
        return execute(place, words, lines, ranks, program, launcher, progress, stacklevel=4)


def set_options(words: Sequence[str]) -> list[str]:
    """Return `--set key=value` for each `key=value`."""
    return [option for word in words for option in ("--set", word)]


def common_options(
    threads: int | None, steps: int | None, check: bool, options: Sequence[str]
) -> list[str]:
    """Return the options that a new run and one that goes on have in common."""
    if isinstance(options, str):
        raise TypeError(f"options is a list of words, not the string {options!r}")
    words = [] if threads is None else ["--threads", str(threads)]
    words += [] if steps is None else ["--steps", str(steps)]
    words += ["--check"] if check else []
    return [*words, *options]


def place_of(
    folder: str | os.PathLike[str] | None, scene: SceneLike, overrides: Mapping[str, Any]
) -> tuple[Path, bool]:
    """Return where the run goes (what is named, else a folder for good), and whether it is new."""
    named = folder if folder is not None else flattened(overrides).get("output.folder")
    if named is None:
        with contextlib.suppress(CarromError, TypeError):  # the program reports a wrong scene
            named = flattened(read_scene(scene)).get("output.folder")
    if isinstance(named, (str, os.PathLike)) and os.fspath(named):
        return Path(named), not Path(named).exists()
    return Path(tempfile.mkdtemp(prefix="carrom-run-")), True


@contextmanager
def prepared(folder: Path, is_new: bool, overwrite: bool = False) -> Iterator[Path]:
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


def execute(
    folder: Path,
    words: Sequence[str],
    lines: Path,
    ranks: int,
    program: str | os.PathLike[str] | None,
    launcher: str | os.PathLike[str] | None,
    progress: ProgressLike,
    stacklevel: int = 3,
) -> list[str]:
    """Run the program to its end and return what it has printed; its errors become Python's.

    Warnings name the line that called the caller's caller, unless `stacklevel` says another.
    """
    if operator.index(ranks) < 1:
        raise ValueError(f"ranks must be at least 1, not {ranks}")
    command = [str(find_program(program)), "run", *words, "-o", str(folder)]
    if ranks > 1:
        command = [find_launcher(launcher), "-n", str(ranks), *command]
    process = Process(command, lines, environment(ranks))
    with progress_display(progress) as show:
        code = process.wait(show)
    _raise_for(code, process.lines, command, folder)
    for line in process.lines:
        if line.startswith("warning: "):
            text = in_python(line.removeprefix("warning: "))
            warnings.warn(text, CarromWarning, stacklevel=stacklevel)
    return process.lines


def environment(ranks: int) -> dict[str, str]:
    """Let Open MPI start more ranks than cores (MPICH always does), and ranks that wait sleep."""
    variables = dict(os.environ)
    if ranks > len(os.sched_getaffinity(0)):
        variables.setdefault("OMPI_MCA_rmaps_base_oversubscribe", "1")
        variables.setdefault("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe")
        variables.setdefault("OMPI_MCA_hwloc_base_binding_policy", "none")
        variables.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
        variables.setdefault("MPIR_CVAR_ENABLE_HEAVY_YIELD", "1")
        variables.setdefault("OMP_WAIT_POLICY", "passive")
    return variables


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
