# SPDX-License-Identifier: BSD-3-Clause
"""What a simulation is made of: scenes as the library takes them, and communicators."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from carrom.checkpoints import Checkpoint
from carrom.core_module import load
from carrom.disc_arrays import Array
from carrom.errors import CarromError, SceneError
from carrom.given_arrays import of_rank, whole
from carrom.held_core import check_place
from carrom.launching import CarromWarning
from carrom.scene import (
    flattened,
    is_text,
    keys_of_lines,
    merged,
    parsed,
    set_words,
    to_toml,
    with_absolute_files,
)
from carrom.words import with_arguments, with_keys, with_lines

if TYPE_CHECKING:
    from carrom import _core

MOST_STEPS = 1_000_000
"""The last step of a scene without `time.steps`."""
_FILES = ("output.text", "output.collisions", "output.trajectory", "output.checkpoint")
"""What a scene may ask the program to write."""


def checkpoint_of(scene: Any) -> str | None:
    """Return the path of a checkpoint, or of a folder that has some; None for a scene."""
    if isinstance(scene, Checkpoint):
        return os.fspath(scene.path)
    if isinstance(scene, Mapping) or is_text(scene) or not isinstance(scene, (str, os.PathLike)):
        return None
    path = Path(scene)
    return os.fspath(path) if path.suffix == ".h5" or path.is_dir() else None


class Source(NamedTuple):
    """A scene as the extension takes it."""

    text: str
    """TOML, or the path of a file"""
    is_file: bool
    settings: list[str]
    """KEY=VALUE, on top of the text"""
    in_words: Callable[[str], str]
    """Says where the scene is wrong: by a key of a dictionary, by a line of a text"""


def source_of(scene: Any, overrides: Mapping[str, Any]) -> Source:
    """Return the scene of a dictionary, a text or a path, with keys set."""
    words = set_words(overrides)
    if isinstance(scene, Mapping):
        whole = merged(scene, overrides)
        text = to_toml(with_absolute_files(whole))
        keys = keys_of_lines(text)
        settings = _for_this_process(flattened(whole))
        return Source(text, False, settings, lambda line: with_keys(line, keys))
    if is_text(scene):
        known = flattened(parsed(scene, "the scene's text", words))
        return Source(scene, False, words + _for_this_process(known), with_lines)
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(f"a scene is a dictionary, a path or TOML text, not {scene!r}")
    path = Path(scene)
    known = {"time.steps": None}
    if path.suffix == ".toml":
        with contextlib.suppress(OSError, UnicodeDecodeError, CarromError):
            text = path.read_text(encoding="utf-8")
            known = flattened(parsed(text, path.name, words))
    return Source(os.fspath(path), True, words + _for_this_process(known), str)


def core_of(scene: Any, threads: int | None, comm: Any, overrides: Mapping[str, Any]) -> _core.Core:
    """Begin with a scene or a checkpoint, as `carrom.Simulation` does."""
    core = load()
    check_place(core)
    handle = None if comm is None else handle_of(comm, core)
    in_words: Callable[[str], str] = str
    try:
        given = _agreed_over(comm, lambda: _checked(scene, threads, overrides))
        if isinstance(given, str):
            made = core.from_checkpoint(given, set_words(overrides), threads or 0, handle)
        else:
            text, is_file, settings, in_words = given
            made = core.new(text, is_file, settings, threads or 0, handle)
    except SceneError as error:
        known, names = flattened(overrides), ("threads", "comm")
        error.put_in_words(lambda line: with_arguments(in_words(line), known, names))
        raise
    return cast("_core.Core", made)


def _checked(scene: Any, threads: int | None, overrides: Mapping[str, Any]) -> str | Source:
    """Return the path of a checkpoint, or a scene, after all checks that need no other rank."""
    if threads is not None and whole("threads must be a whole number", threads) < 1:
        raise ValueError(f"threads must be at least 1, not {threads}")
    path = checkpoint_of(scene)
    return source_of(scene, overrides) if path is None else path


def _agreed_over(comm: Any, check: Callable[[], str | Source]) -> str | Source:
    """Return what `check` returns, unless it raises on some rank. Collective over `comm`.

    Raises:
        Exception: that of `check`; on ranks without one, that of the first rank with one
        SceneError: some ranks begin with a checkpoint and others with a scene
    """
    if comm is None:
        return check()
    mine: Exception | None = None
    try:
        given = check()
        word = "a checkpoint" if isinstance(given, str) else "a scene"
    except Exception as error:  # otherwise the other ranks would wait
        mine, word = error, ""
    all_words = comm.allgather((word, type(mine).__name__, str(mine)))
    if mine is not None:
        raise mine
    for rank, (other, kind, text) in enumerate(all_words):
        if not other:
            raise of_rank(rank, kind, text)
        if other != word:
            raise SceneError([f"rank {rank} begins with {other}, and this one with {word}"], 2)
    return given


def _for_this_process(known: Mapping[str, Any]) -> list[str]:
    """Return settings that a scene needs here; warn of files that nobody will write."""
    asked = [
        group
        for group in _FILES
        if any(
            value is not False and (key == group or key.startswith(group + "."))
            for key, value in known.items()
        )
    ]
    if asked:
        warnings.warn(
            f"{', '.join(asked)}: a simulation in this process writes no files but those of "
            "sim.checkpoint; carrom.run does",
            CarromWarning,
            stacklevel=8,
        )
    return [] if "time.steps" in known else [f"time.steps={MOST_STEPS}"]


def handle_of(comm: Any, core: Any) -> int:
    """Return the number of a communicator, after it was found to be of the same MPI library."""
    try:
        from mpi4py import MPI

        number = comm.py2f()
    except (ImportError, AttributeError):
        raise TypeError(f"comm is a communicator of mpi4py, not {comm!r}") from None
    theirs, ours = _first_words(MPI.Get_library_version()), core.mpi_library()
    if theirs != ours:
        raise CarromError(
            f"comm is of {theirs}, but Carrom was built with {ours}; two MPI libraries in one "
            "process do not understand each other. try: pip install --no-binary mpi4py mpi4py"
        )
    if comm == MPI.COMM_NULL:
        raise CarromError("comm was freed, or this rank has no part in it")
    return int(number)


def add_up(array: Array, comm: Any) -> None:
    """Add the arrays of the other ranks to an array. Collective.

    Raises:
        CarromError: there is no communicator of mpi4py, or it was freed
    """
    if comm is None:
        raise CarromError("arrays of several ranks need comm=, a communicator of mpi4py")
    from mpi4py import MPI

    if comm == MPI.COMM_NULL:
        raise CarromError("comm was freed; it has to last as long as the simulation")
    comm.Allreduce(MPI.IN_PLACE, array)


def _first_words(version: str) -> str:
    return version.replace(",", "\n").splitlines()[0].replace("\t", " ")
