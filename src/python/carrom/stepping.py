# SPDX-License-Identifier: BSD-3-Clause
"""Steps of a simulation, in stretches between which Python sees Ctrl-C, actions and the bar."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from carrom.actions import Actions, Simulated
from carrom.errors import SceneError
from carrom.given_arrays import agreed, whole

if TYPE_CHECKING:
    from carrom import _core

STRETCH = 0.1
"""Seconds between two looks."""


def end_of_run(core: _core.Core, steps: Any, last_step: int) -> int:
    """Return the step at which `run(steps)` ends. Collective.

    Raises:
        SceneError: it is not from the present step to `last_step`
        TypeError: `steps` is no whole number
    """
    end = int(core.step)
    with agreed(core):
        n = whole("run takes a whole number of steps", steps)
        end += n
        if n < 0 or end > last_step:
            raise SceneError(
                [
                    f"run({n}) would end at step {end}, and the scene goes from step {core.step} "
                    f"to time.steps = {last_step}"
                ],
                2,
            )
    return end


def advance(
    core: _core.Core,
    actions: Actions[Simulated],
    simulation: Simulated,
    end: int,
    show: Callable[[str], None],
) -> None:
    """Move forward to the step `end`, and call the actions that are due on the way.

    On several ranks stretches go from one action to the next, so that all ranks have the same.
    """
    actions.call(simulation)  # actions that Ctrl-C or an error has left undone
    begin = time.perf_counter()
    first = step = int(core.step)
    stretch = 1 if core.ranks == 1 else end
    while step < end:
        before = time.perf_counter()
        try:
            core.advance(min(stretch, actions.next_due(step, end) - step))
        finally:  # Ctrl-C is raised where the call returns
            if core.step > step:
                actions.owe(core.step)
        done, step = core.step - step, core.step
        if done == 0:
            return  # time.stop has ended the run
        now = time.perf_counter()
        if core.ranks == 1:
            stretch = max(1, min(int(STRETCH * done / max(now - before, 1e-9)), 10 * stretch))
        actions.call(simulation)
        if now - begin > 5 * STRETCH:
            rate = (step - first) / (now - begin)
            share = 100 * (step - first) / (end - first)
            show(f"step {step} of {end} ({share:.1f} %), {rate:.3g} steps/s")
