# SPDX-License-Identifier: BSD-3-Clause
"""What can be drawn: runs, frames and paths of them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Union

from carrom.errors import CarromError, NoDataError
from carrom.frame import Frame
from carrom.runs import Run, open_run

COLOURS = ("speed", "vx", "vy", "spin", "direction", "strip", "species")
"""What discs can be coloured by."""

Drawable = Union[Run, Frame, Sequence[Frame], str, "os.PathLike[str]"]
"""A run, frames, a frame, or the path of a run's folder, a trajectory or a checkpoint."""


def as_run(source: Run | str | os.PathLike[str]) -> Run:
    """Open a path."""
    return source if isinstance(source, Run) else open_run(source)


def frames_of(source: Drawable) -> Sequence[Frame]:
    """Return the frames to draw: of the trajectory, else the checkpoints.

    Raises:
        NoDataError: there is nothing to draw
    """
    if isinstance(source, Frame):
        return [source]
    if isinstance(source, Sequence) and not isinstance(source, str):
        if len(source) == 0:
            raise NoDataError("there are no frames to draw")
        return source
    run = as_run(source)
    frames: Sequence[Frame] = run.frames if len(run.frames) else run.checkpoints
    if len(frames) == 0:
        raise NoDataError(f"{run.name}: has neither frames nor checkpoints")
    return frames


def frame_of(source: Drawable, step: int | None) -> Frame:
    """Return the frame of a step; the last one for None."""
    frames = frames_of(source)
    if step is None:
        return frames[-1]
    found = [frame for frame in frames if frame.step == step]
    if not found:
        few = f"there are {len(frames)}, of steps {frames[0].step} to {frames[-1].step}"
        raise NoDataError(f"no frame of step {step}; {few}")
    return found[0]


def scene_of(source: Drawable) -> dict[str, Any]:
    """Return the scene, to draw obstacles and periodic sides; {} if it is not known."""
    try:
        if isinstance(source, Run):
            return source.scene
        if isinstance(source, (str, os.PathLike)):
            return open_run(source).scene
    except CarromError:
        return {}
    scene: dict[str, Any] = getattr(source, "scene", {})
    return scene
