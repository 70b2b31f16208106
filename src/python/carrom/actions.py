# SPDX-License-Identifier: BSD-3-Clause
"""What a simulation calls at some of its steps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

from carrom.given_arrays import whole

Simulated = TypeVar("Simulated")  # a simulation, which is defined in a module above this one


class Actions(Generic[Simulated]):
    """Functions and the numbers of steps between their calls, in the order of adding."""

    def __init__(self) -> None:
        """Have none."""
        self._of: list[tuple[int, Callable[[Simulated], object]]] = []
        self._owed: list[Callable[[Simulated], object]] = []

    def add(self, interval: int, action: Callable[[Simulated], object]) -> None:
        """Call the action at each multiple of `interval`."""
        interval = whole("interval must be a whole number of steps", interval)
        if interval < 1:
            raise ValueError(f"interval is a number of steps, at least 1, not {interval}")
        if not callable(action):
            raise TypeError(f"an action is a function of the simulation, not {action!r}")
        self._of.append((interval, action))

    def forget(self, action: Callable[[Simulated], object]) -> None:
        """Call an action no more."""
        kept = [pair for pair in self._of if pair[1] is not action]
        if len(kept) == len(self._of):
            raise ValueError(f"{action!r} is no action of this simulation")
        self._of = kept
        self._owed = [owed for owed in self._owed if owed is not action]

    def next_due(self, step: int, end: int) -> int:
        """Return the next step at which an action is due, or the end."""
        dues = ((step // interval + 1) * interval for interval, _ in self._of)
        return min((end, *dues))

    def owe(self, step: int) -> None:
        """Remember which are due at the step that has come."""
        self._owed = [action for interval, action in self._of if step % interval == 0]

    def call(self, simulation: Simulated) -> None:
        """Call those that are due.

        If one is stopped by an error, or Ctrl-C comes before it, the others are called when the
        simulation goes on, so that it has the bits of one that was not stopped.
        """
        while self._owed:
            self._owed.pop(0)(simulation)
