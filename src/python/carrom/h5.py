# SPDX-License-Identifier: BSD-3-Clause
"""Opening HDF5 files of runs, also of runs that go on."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import h5py

from carrom.errors import FileError


def open_file(path: str | os.PathLike[str]) -> h5py.File:
    """Open a file to read. The program takes no HDF5 locks, so runs that go on are no matter.

    Raises:
        FileError: it is absent, damaged, or joins files that are not beside it
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(f"{path}: there is no such file")
    try:
        file = _opened(path)
    except OSError as error:
        raise FileError(f"{path}: is no HDF5 file, or is damaged: {error}") from None
    try:
        _check_sources(file, path)
    except BaseException:
        file.close()
        raise
    return file


def _opened(path: Path) -> h5py.File:
    """Open as everybody does, so that the same file can be open elsewhere in this process."""
    try:
        return h5py.File(path, "r")
    except OSError:  # perhaps a file system without locks, or the file is open without them
        return h5py.File(path, "r", locking=False)


def _check_sources(file: h5py.File, path: Path) -> None:
    """Check that segments are there. HDF5 would show zeros in the place of absent ones."""
    names: set[str] = set()

    def inspect(_: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and item.is_virtual:
            names.update(source.file_name for source in item.virtual_sources())

    try:
        file.visititems(inspect)
    except (RuntimeError, KeyError, OSError) as error:
        raise FileError(f"{path}: is damaged: {error}") from None
    absent = [
        str(path.parent / name) for name in sorted(names) if not (path.parent / name).exists()
    ]
    if absent:
        raise FileError(
            f"{path}: joins {', '.join(absent)}, which is not there; copy the folder "
            f"{path.stem}/ together with {path.name}"
        )


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
