# SPDX-License-Identifier: BSD-3-Clause
"""How far a run is, from its files alone."""

from __future__ import annotations

import os
import time
from collections import deque
from pathlib import Path

from carrom.plain import open_plain

_REMEMBERED = 60  # steps that a rate is taken over
_FRESH = 30.0  # seconds


class Rate:
    """Steps a second, from when the newest step has changed."""

    def __init__(self) -> None:
        """Remember nothing yet."""
        self._seen: deque[tuple[float, int]] = deque(maxlen=_REMEMBERED)

    def note(self, step: int, now: float) -> None:
        """Remember a step when it has changed. A smaller one begins anew."""
        if self._seen and step < self._seen[-1][1]:
            self._seen.clear()
        if not self._seen or step > self._seen[-1][1]:
            self._seen.append((now, step))

    def steps_per_second(self) -> float | None:
        """Return the rate, or None while too little is known."""
        if len(self._seen) < 2:
            return None
        (begin, first), (end, last) = self._seen[0], self._seen[-1]
        return (last - first) / (end - begin) if end > begin else None


def is_being_written(folder: Path) -> bool:
    """Whether a process holds the run's lock. Takes none itself: /proc/locks lists them.

    Where the system does not list locks, a file that was written in the last half minute counts.
    """
    try:
        lock = (folder / ".carrom.lock").stat()
    except OSError:
        return False
    try:
        listed = Path("/proc/locks").read_text(encoding="ascii")
    except OSError:
        return newest_change(folder) > time.time() - _FRESH
    inode = f":{lock.st_ino} "
    device = f" {os.major(lock.st_dev):02x}:{os.minor(lock.st_dev):02x}{inode}"
    return any(" FLOCK " in line and device in f"{line} " for line in listed.splitlines())


def newest_change(folder: Path) -> float:
    """Return when a file of the run was last written, seconds since 1970; 0 if there is none."""
    times = [0.0]
    for name in ("report.json", "trajectory.h5", "collisions.h5", "checkpoints", "measurements"):
        try:
            times.append((folder / name).stat().st_mtime)
        except OSError:
            continue
    return max(times)


def legacy_steps(path: Path) -> int | None:
    """Return S, the fourth line of legacy text."""
    try:
        with open_plain(path, "r", encoding="utf-8", errors="replace") as file:
            words = [line.strip() for line in file.readlines(4096) if line.strip()]
        return int([word for word in words if not word.startswith("#")][3])
    except (OSError, ValueError, IndexError):
        return None
