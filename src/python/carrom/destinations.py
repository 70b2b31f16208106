# SPDX-License-Identifier: BSD-3-Clause
"""Where Python may write files, by the rules of the program (docs/reference/exit-codes.md).

Every function of the package that writes to a path of the user asks `refuse_owned` before it
computes anything, so that no file of a run is lost to a picture or a table.
"""

from __future__ import annotations

import os
from pathlib import Path

from carrom.errors import FileError
from carrom.plain import open_plain

_SUBFOLDERS = {"checkpoints", "trajectory", "collisions", "measurements"}
_FILES = {"scene.toml", "scene.in", "report.json", "trajectory.h5", "trajectory.xdmf"}
_FILES |= {"collisions.h5", ".carrom.lock"}
_ENDS_OF_SCENES = {".toml", ".in", ".discs"}
_HDF5 = b"\x89HDF\r\n\x1a\n"


def refuse_owned(path: str | os.PathLike[str], begins: tuple[bytes, ...] = ()) -> None:
    """Check that a file may be written.

    Args:
        path: the file, which need not exist
        begins: first bytes of files that it may replace, beside those that are no file of carrom

    Raises:
        FileError: it belongs to a run, holds what carrom writes, or is no plain file
    """
    named = Path(path)
    # A write replaces the named file or goes to a link's target; either may belong to a run.
    for place in {Path(os.path.realpath(named)), Path(os.path.realpath(named.parent)) / named.name}:
        owner = _owner(place)
        if owner is not None:
            raise FileError(f"{path}: is a file of the run in {owner}; name another file")
        if place.exists() and not place.is_file():
            raise FileError(f"{path}: is not a plain file")
    what = _content(named, begins)
    if what:
        raise FileError(f"{path}: is {what}; name another file, or remove this one")


def _owner(path: Path) -> Path | None:
    """Return the folder of the run that owns a place, if one does."""
    if path.name in _FILES and _is_run(path.parent):
        return path.parent
    for folder in path.parents:
        if folder.name in _SUBFOLDERS and _is_run(folder.parent):
            return folder.parent
    return None


def _is_run(folder: Path) -> bool:
    """Runs make a folder for checkpoints before they write anything else."""
    if os.path.lexists(folder / ".carrom.lock"):
        return True
    return (folder / "checkpoints").is_dir() and any(os.path.lexists(folder / f) for f in _FILES)


def _content(path: Path, begins: tuple[bytes, ...]) -> str:
    """Return what an existing file holds that must not be replaced; empty if it may be."""
    try:
        with open_plain(path) as file:
            first = file.read(4096)
    except OSError:
        return ""
    if not first or any(first.startswith(begin) for begin in begins):
        return ""
    if first.startswith(_HDF5):
        return "an HDF5 file"
    if path.suffix in _ENDS_OF_SCENES or Path(os.path.realpath(path)).suffix in _ENDS_OF_SCENES:
        return "a scene or a file of discs"
    if first.lstrip().startswith(b"{"):
        return "a report"
    line = first.partition(b"\n")[0]
    if (line.startswith(b"# ") and b": " in line) or line.startswith(b"replica,seed,"):
        return "a table"
    return ""
