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
from typing import TYPE_CHECKING, Any, TypeVar

from carrom.actions import Actions
from carrom.errors import CarromError

if TYPE_CHECKING:
    from carrom import _core

_C = TypeVar("_C", bound="Closable")

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
        self._core: _core.Core | None = core
        self._module = module
        end_left()

    def use(self) -> _core.Core:
        """Return the simulation, if this thread may use it.

        Raises:
            CarromError: this is another thread or process, or the simulation is closed
        """
        check_place(self._module)
        if self._core is None:
            raise CarromError(
                "the simulation is closed; begin a new one, or keep a sim.copy() or a checkpoint "
                "before sim.close()"
            )
        return self._core

    @property
    def is_closed(self) -> bool:
        """Whether `close` was called."""
        return self._core is None

    def close(self) -> None:
        """End the simulation now."""
        check_place(self._module)
        self._core = None
        end_left()

    def __del__(
        self, this_thread: Callable[[], int] = threading.get_ident, left: list[_core.Core] = _left
    ) -> None:
        # Names of modules may be gone when Python ends, arguments are not.
        if self._core is not None and this_thread() != self._module.thread:
            left.append(self._core)


class Closable:
    """What a user ends by `close()` or `with`: a held simulation, and the actions on it."""

    _held: HeldCore
    _is_running: bool
    _actions: Actions[Any]

    @property
    def _core(self) -> _core.Core:
        return self._held.use()

    def close(self) -> None:
        """End the simulation now, and free what it holds; a second call does nothing.

        This frees the memory of all discs and tables. With `comm` it also frees the communicators
        that Carrom has made from it, once all copies of the simulation are closed, too; so all
        ranks have to make the call. MPI itself ends with the process, because it cannot begin
        twice. Arrays, frames, tables and averages that were taken before stay usable, and so do
        facts of the scene such as `sim.masses`. Other uses of the simulation raise a `CarromError`.
        Without `close` the same is freed when Python lets go of the simulation.

        Raises:
            CarromError: an action of the simulation makes the call
        """
        if self._is_running:
            raise CarromError("an action cannot close the simulation that calls it")
        self._held.close()
        self._actions = Actions()

    def __enter__(self: _C) -> _C:
        self._held.use()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def end_left() -> None:
    """End simulations that other threads have let go of."""
    _left.clear()
