# SPDX-License-Identifier: BSD-3-Clause
"""The program as a child process: its messages, its lines of discs, and interrupts."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import select
import signal
import subprocess
import threading
from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from pathlib import Path

from carrom.errors import OutputError, ProgramNotFoundError
from carrom.plain import open_plain
from carrom.progress import Show, is_progress
from carrom.words import in_python

_ERASE = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")


_stop: ContextVar[threading.Event | None] = ContextVar("stop", default=None)


@contextlib.contextmanager
def process_watch(stop: threading.Event) -> Iterator[None]:
    """Let an event stop the processes that this thread waits for: they store a checkpoint."""
    token = _stop.set(stop)
    try:
        yield
    finally:
        _stop.reset(token)


class Process:
    """The program, running.

    Its standard error is a pseudo-terminal, so that it reports progress as to a person. Its
    standard output goes to the file `text`, at its end.

    Attributes:
        lines: what it has printed to standard error, without progress
    """

    def __init__(self, command: Sequence[str], text: Path, environment: dict[str, str]) -> None:
        """Start it in a session of its own, so that interrupts reach it through us alone."""
        self.lines: list[str] = []
        self._rest = ""
        self._master, slave = pty.openpty()
        try:
            with open_plain(text, "ab") as lines:
                self._child = subprocess.Popen(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=lines,
                    stderr=slave,
                    env=environment,
                    start_new_session=True,
                )
        except BaseException as error:
            os.close(self._master)
            if isinstance(error, OSError) and error.filename == text:
                message = f"{text}: cannot be written to: {error.strerror}"
                raise OutputError([message], 4) from None
            if isinstance(error, OSError):
                what = f"{command[0]} cannot be started: {error.strerror}"
                raise ProgramNotFoundError(what) from None
            raise
        finally:
            os.close(slave)

    def wait(self, show: Show) -> int:
        """Wait for its end and return its exit code.

        Ctrl-C tells it to store a checkpoint and stop; once more ends it at once.
        """
        interrupts = 0
        while True:
            try:
                self._read_all(show)
                code = self._child.wait()
                break
            except KeyboardInterrupt:
                interrupts += 1
                self._signal(signal.SIGUSR1 if interrupts == 1 else signal.SIGKILL)
            except BaseException:
                self._signal(signal.SIGKILL)
                self._child.wait()
                os.close(self._master)
                raise
        os.close(self._master)
        if interrupts:  # launchers add lines of their own
            told = [line for line in self.lines if line.startswith("stopped on request")]
            raise KeyboardInterrupt("\n".join(map(in_python, (told or self.lines)[-1:])))
        return code

    def _read_all(self, show: Show) -> None:
        """Read until the other side is closed."""
        stop = _stop.get()
        while True:
            if stop is not None and not select.select([self._master], [], [], 0.1)[0]:
                if stop.is_set():
                    self._signal(signal.SIGUSR1)
                    stop = None
                continue
            try:
                block = os.read(self._master, 65536)
            except OSError:  # Linux reports a closed other side like this
                block = b""
            if not block:
                break
            self._take(block.decode("utf-8", "replace"), show)
        self._take("\n", show)

    def _take(self, text: str, show: Show) -> None:
        *whole, self._rest = re.split(r"[\r\n]+", self._rest + text)
        for part in whole:
            line = _ERASE.sub("", part)
            if is_progress(line):
                show(line)
            elif line:
                self.lines.append(line)

    def _signal(self, number: signal.Signals) -> None:
        with contextlib.suppress(ProcessLookupError):
            if number == signal.SIGKILL:
                os.killpg(self._child.pid, number)  # ends the launcher and all ranks
            else:
                self._child.send_signal(number)
