# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of runs. Needs matplotlib: `pip install carrom[plot]`.

Functions take a `Run`, `Frames`, a `Frame` or the path of any of these, draw into `ax` or a new
figure, and return matplotlib Axes. `carrom-plot` has the same as commands.
"""

from carrom.plot.curves import (
    equation_of_state,
    history,
    measurements,
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
    "radial_distribution",
]
