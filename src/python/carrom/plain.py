# SPDX-License-Identifier: BSD-3-Clause
"""Opening files that anybody can put into a folder. Only plain files are opened: a pipe without a
writer would make the process wait for ever, and a device has no end.
"""

from __future__ import annotations

import errno
import os
import stat
from typing import IO, Any


def _opener(path: str, flags: int) -> int:
    number = os.open(path, flags | os.O_NONBLOCK, 0o666)
    if not stat.S_ISREG(os.fstat(number).st_mode):
        os.close(number)
        raise OSError(errno.EINVAL, "is not a plain file", path)
    return number


def open_plain(path: str | os.PathLike[str], mode: str = "rb", **words: Any) -> IO[Any]:
    """Open as `open` does, if it is a plain file.

    Raises:
        OSError: it is not, or cannot be opened
    """
    return open(path, mode, opener=_opener, **words)


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Return all bytes of a plain file."""
    with open_plain(path) as file:
        content: bytes = file.read()
        return content


def read_text(path: str | os.PathLike[str], errors: str = "strict") -> str:
    """Return the text of a plain file."""
    with open_plain(path, "r", encoding="utf-8", errors=errors) as file:
        text: str = file.read()
        return text
