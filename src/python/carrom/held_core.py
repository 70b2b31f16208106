# SPDX-License-Identifier: BSD-3-Clause
"""A simulation of the library, which one thread of one process uses and ends.

MPI and OpenMP allow no more: MPI is called by the thread that started it, and a forked process has
neither MPI nor the threads of its parent. Python, however, may let go of an object in any thread,
because its collector of cycles runs in whichever thread has made the last object. A simulation is
such a cycle if its action refers to it. So other threads put what they let go of into a list, and
the right thread ends it later.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from carrom.errors import CarromError

if TYPE_CHECKING:
    from carrom import _core

_left: list[_core.Core] = []
"""Simulations that other threads have let go of; `list` is safe to use from several threads."""


def check_place(module: Any) -> None:
    """Refuse calls from another thread or process than that of the first simulation.

    Raises:
        CarromError: this is another one
    """
    if os.getpid() != module.process:
        raise CarromError(
            "a forked process cannot use simulations, because MPI and threads are its parent's; "
            'let it begin anew, for example by multiprocessing.get_context("spawn")'
        )
    if threading.get_ident() != module.thread:
        raise CarromError(
            "a simulation belongs to the thread that made the first one; MPI allows no other"
        )


class HeldCore:
    """Holds a simulation of the library until it is let go of."""

    def __init__(self, core: _core.Core, module: Any) -> None:
        """Take a simulation that was just made, and end those that other threads have left."""
        self._core, self._module = core, module
        end_left()

    def use(self) -> _core.Core:
        """Return the simulation, if this thread may use it."""
        check_place(self._module)
        return self._core

    def __del__(
        self, this_thread: Callable[[], int] = threading.get_ident, left: list[_core.Core] = _left
    ) -> None:
        # Names of modules may be gone when Python ends, arguments are not.
        if this_thread() != self._module.thread:
            left.append(self._core)


def end_left() -> None:
    """End simulations that other threads have let go of."""
    _left.clear()
