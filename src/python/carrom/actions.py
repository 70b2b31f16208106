# SPDX-License-Identifier: BSD-3-Clause
"""What a simulation calls at some of its steps."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Generic, TypeVar

Simulated = TypeVar("Simulated")  # a simulation, which is defined in a module above this one


class Actions(Generic[Simulated]):
    """Functions and the numbers of steps between their calls, in the order of adding."""

    def __init__(self) -> None:
        """Have none."""
        self._of: list[tuple[int, Callable[[Simulated], object]]] = []

    def add(self, interval: int, action: Callable[[Simulated], object]) -> None:
        """Call the action at each multiple of `interval`."""
        if operator.index(interval) < 1:
            raise ValueError(f"interval is a number of steps, at least 1, not {interval}")
        if not callable(action):
            raise TypeError(f"an action is a function of the simulation, not {action!r}")
        self._of.append((operator.index(interval), action))

    def forget(self, action: Callable[[Simulated], object]) -> None:
        """Call an action no more."""
        kept = [pair for pair in self._of if pair[1] is not action]
        if len(kept) == len(self._of):
            raise ValueError(f"{action!r} is no action of this simulation")
        self._of = kept

    def next_due(self, step: int, end: int) -> int:
        """Return the next step at which an action is due, or the end."""
        dues = ((step // interval + 1) * interval for interval, _ in self._of)
        return min((end, *dues))

    def call(self, simulation: Simulated, step: int) -> None:
        """Call those that are due at the step."""
        for interval, action in list(self._of):
            if step % interval == 0:
                action(simulation)
