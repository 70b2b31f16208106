# SPDX-License-Identifier: BSD-3-Clause
"""Opening HDF5 files of runs, also of runs that go on."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import h5py

from carrom.errors import FileError
from carrom.heaps import have_end

_MOST_OBJECTS = 100_000
_DEEPEST_GROUP = 16
_MOST_KNOWN = 10_000
_sound_parts: dict[tuple[object, ...], None] = {}
"""Segments that hold all of their own numbers, by what changes with a file."""


def open_file(path: str | os.PathLike[str]) -> h5py.File:
    """Open a file to read. The program takes no HDF5 locks, so runs that go on are no matter.

    HDF5 opens whatever a file names: it would wait for a pipe, and return the bytes of any file as
    numbers. So a file is refused if it leads to other files than plain ones below its own folder.

    Raises:
        FileError: it is absent, damaged, or joins files that are not beside it
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(f"{path}: there is no such file")
    file = _opened(path)
    try:
        _check_parts(_parts_named_in(file, path), path)
    except BaseException:
        file.close()
        raise
    return file


def _opened(path: Path) -> h5py.File:
    """Open as everybody does, so that the same file can be open elsewhere in this process."""
    try:
        if not have_end(path):
            raise FileError(f"{path}: is damaged: HDF5 would come to no end in one of its heaps")
        try:
            return h5py.File(path, "r")
        except OSError:  # perhaps a file system without locks, or it is open without them
            return h5py.File(path, "r", locking=False)
    except OSError as error:
        raise FileError(f"{path}: is no HDF5 file, or is damaged: {error}") from None


def _parts_named_in(file: h5py.File, path: Path) -> set[str]:
    """Return the files that data sets join. Soft links lead to what another link leads to, too."""
    names: set[str] = set()
    waiting: list[tuple[Any, int]] = [(file, 0)]
    n_objects = 0
    try:
        while waiting:
            group, depth = waiting.pop()
            n_objects += len(group)
            if depth > _DEEPEST_GROUP or n_objects > _MOST_OBJECTS:
                raise FileError(f"{path}: has more groups and data sets than carrom writes")
            for name in group:
                link = group.get(name, getlink=True)
                if isinstance(link, h5py.SoftLink):
                    continue
                if not isinstance(link, h5py.HardLink):
                    raise FileError(f"{path}: {group.name}/{name} leads to another file")
                item = group[name]
                if isinstance(item, h5py.Group):
                    waiting.append((item, depth + 1))
                elif isinstance(item, h5py.Dataset):
                    names |= _parts_of(item, path)
    except (RuntimeError, KeyError, OSError, TypeError, ValueError) as error:
        raise FileError(f"{path}: is damaged: {error}") from None
    return names


def _parts_of(dataset: h5py.Dataset, path: Path) -> set[str]:
    if dataset.id.get_create_plist().get_external_count() > 0:
        raise FileError(f"{path}: {dataset.name} has its numbers in a file of another kind")
    if not dataset.is_virtual:
        return set()
    return {source.file_name for source in dataset.virtual_sources()}


def _check_parts(names: set[str], path: Path) -> None:
    """Check that segments are there, below the file's folder, and name no further files.

    HDF5 would show zeros in the place of absent ones.
    """
    parts = [(name, path.parent / name) for name in sorted(names)]
    for name, _ in parts:
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise FileError(f"{path}: joins {name}, which is not below its folder")
    absent = [str(part) for _, part in parts if not part.exists()]
    if absent:
        raise FileError(
            f"{path}: joins {', '.join(absent)}, which is not there; copy the folder "
            f"{path.stem}/ together with {path.name}"
        )
    for _, part in parts:
        key = _version(part)
        if key in _sound_parts:
            continue
        with _opened(part) as file:
            if _parts_named_in(file, part):
                raise FileError(f"{part}: has numbers in further files")
        if len(_sound_parts) >= _MOST_KNOWN:
            _sound_parts.clear()
        _sound_parts[key] = None


def _version(part: Path) -> tuple[object, ...]:
    try:
        status = part.stat()
    except OSError as error:  # it was there a moment ago
        raise FileError(f"{part}: {error.strerror}") from None
    return status.st_dev, status.st_ino, status.st_ctime_ns, status.st_size


def read(dataset: Any, selection: Any = ()) -> Any:
    """Read numbers. A damaged chunk is an error that names the file."""
    try:
        return dataset[selection]
    except OSError as error:
        raise FileError(f"{dataset.file.filename}: {dataset.name} is damaged: {error}") from None


def text(file: h5py.File, name: str, default: str = "") -> str:
    """Read a text."""
    if name not in file:
        return default
    value = file[name][()]
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
