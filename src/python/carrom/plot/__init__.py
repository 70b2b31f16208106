# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of runs. Needs matplotlib: `pip install carrom[plot]`.

Functions take a `Run`, `Frames`, a `Frame` or the path of any of these, draw into `ax` or a new
figure, and return matplotlib Axes. `carrom-plot` has the same as commands.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from carrom.errors import MissingPackageError

if TYPE_CHECKING:
    from carrom.plot.curves import (
        equation_of_state,
        history,
        measurements,
        profiles,
        radial_distribution,
    )
    from carrom.plot.drawing import frame
    from carrom.plot.movies import movie

__all__ = [
    "equation_of_state",
    "frame",
    "history",
    "measurements",
    "movie",
    "profiles",
    "radial_distribution",
]

_MODULES = {
    "equation_of_state": "curves",
    "frame": "drawing",
    "history": "curves",
    "measurements": "curves",
    "movie": "movies",
    "profiles": "curves",
    "radial_distribution": "curves",
}


def __getattr__(name: str) -> Any:
    """Import matplotlib once something is drawn."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    try:
        return getattr(importlib.import_module(f"carrom.plot.{_MODULES[name]}"), name)
    except ModuleNotFoundError as error:
        raise MissingPackageError(
            f"carrom.plot needs {error.name}: pip install carrom[plot]"
        ) from None


def __dir__() -> list[str]:
    """Name what can be drawn, so that completion offers that and nothing else."""
    return sorted(__all__)
