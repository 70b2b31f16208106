# SPDX-License-Identifier: BSD-3-Clause
"""A check of a small HDF5 file's bytes, because HDF5 may hang on damage, and Python with it."""

from __future__ import annotations

import os

from carrom.plain import open_plain

_SIGNATURE = b"GCOL"
_LARGEST_SEARCHED = 16 << 20  # larger files of carrom have no such heaps
_HEADER = 16  # bytes, of a heap and of each object in it
_ALIGNMENT = 8


def have_end(path: str | os.PathLike[str]) -> bool:
    """Return whether HDF5 comes to the end of each global heap, where names of segments are.

    HDF5 up to 2.0 reads free room without a size again and again.
    """
    with open_plain(path) as file:
        if os.fstat(file.fileno()).st_size > _LARGEST_SEARCHED:
            return True
        content = file.read()
    place = content.find(_SIGNATURE)
    while place >= 0:
        if not _has_end(content, place):
            return False
        place = content.find(_SIGNATURE, place + 1)
    return True


def _has_end(content: bytes, place: int) -> bool:
    end = min(len(content), place + _length(content, place))
    place += _HEADER
    while place + _HEADER <= end:
        is_free_room = content[place : place + 2] == b"\0\0"
        length = _length(content, place)
        if is_free_room and length == 0:
            return False
        if length > end - place:
            return True  # HDF5 itself reports this damage
        padded = -(-length // _ALIGNMENT) * _ALIGNMENT
        place += length if is_free_room else _HEADER + padded
    return True


def _length(content: bytes, place: int) -> int:
    return int.from_bytes(content[place + 8 : place + 16], "little")
