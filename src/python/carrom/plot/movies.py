# SPDX-License-Identifier: BSD-3-Clause
"""Movies: GIF by pillow, anything else by ffmpeg."""

from __future__ import annotations

import itertools
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from PIL import Image

from carrom.destinations import refuse_owned
from carrom.errors import FileError, MissingPackageError
from carrom.frame import Frame
from carrom.plot.drawing import Picture, Style, colour_of
from carrom.plot.sources import Drawable, frames_of, scene_of

Pixels = npt.NDArray[np.uint8]


def movie(
    source: Drawable,
    path: str | os.PathLike[str],
    *,
    every: int = 1,
    rate: float = 15,
    colour: str | npt.ArrayLike | None = None,
    color: str | npt.ArrayLike | None = None,
    view: npt.ArrayLike | None = None,
    fastest: float | None = None,
    ranks: int = 4,
    label: str | None = None,
    cmap: str | Colormap | None = None,
    bar: bool = True,
    limits: npt.ArrayLike | None = None,
    magnify: float = 1.0,
    scene: Mapping[str, Any] | None = None,
    dpi: int = 110,
) -> Path:
    """Make a movie of frames, discs to scale, and return its path.

    A name that ends in `.gif` gives a GIF. Any other is for ffmpeg: `.mp4` is usual. ffmpeg is the
    program, or the Python package imageio-ffmpeg.

    Args:
        source: a run, frames, or a path
        path: the movie; it appears once it is whole
        every: show every so-many-th frame
        rate: frames per second
        colour: see `carrom.plot.frame`, as for `color` and `view` to `scene`
        color: the same as `colour`
        view: part of the box to show
        fastest: the number of the strongest colour, in all frames
        ranks: how many strips there are
        label: what the bar of colours says
        cmap: a colour map of matplotlib
        bar: whether there is a bar of colours
        limits: the numbers of the first and the last colour, instead of `fastest`
        magnify: draw discs so many times as large as they are
        scene: where obstacles stand, if the source does not know
        dpi: dots per inch; the figure is 7.2 x 6.2 inches
    """
    if every < 1 or not rate > 0:
        raise ValueError(f"every must be at least 1 and rate above 0, not {every} and {rate}")
    path = Path(path)
    refuse_owned(path)
    if not path.parent.is_dir():
        raise FileError(f"{path}: there is no folder {path.parent}")
    ffmpeg = "" if path.suffix == ".gif" else find_ffmpeg()
    frames = frames_of(source)[::every]
    chosen = colour_of(colour, color)
    style = Style(chosen, view, fastest, ranks, label, cmap, bar, limits, magnify)
    film = _Film(frames[0], style, scene_of(source) if scene is None else scene, dpi)
    with tempfile.TemporaryDirectory(prefix=".carrom-", dir=path.parent) as folder:
        part = Path(folder, path.name)
        images = film.images(frames)
        if ffmpeg:
            _write_with(ffmpeg, images, part, rate)
        else:
            _write_gif(images, part, rate)
        part.replace(path)
    return path


def find_ffmpeg() -> str:
    """Return the program ffmpeg, or the one that the package imageio-ffmpeg has."""
    if found := shutil.which("ffmpeg"):
        return found
    try:
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        raise MissingPackageError(
            "there is no ffmpeg: `pip install imageio-ffmpeg` brings one; "
            "a name that ends in .gif does without"
        ) from None


class _Film:
    """Draws frames fast: only discs and title are drawn anew."""

    def __init__(self, first: Frame, style: Style, scene: Mapping[str, Any], dpi: int) -> None:
        self.figure = Figure(figsize=(7.2, 6.2), layout="constrained", dpi=dpi)
        self.canvas = FigureCanvasAgg(self.figure)
        with plt.rc_context({"figure.dpi": dpi}):
            self.picture = Picture(first, style, scene, self.figure.add_subplot())
        self.picture.show(first)
        self.canvas.draw()  # finds the layout, which is slow to find and the same for all
        self.figure.set_layout_engine("none")
        self.moving = (self.picture.discs, self.picture.sides, self.picture.axes.title)
        for part in self.moving:
            part.set_animated(True)
        self.canvas.draw()
        self.background = self.canvas.copy_from_bbox(self.figure.bbox)

    def images(self, frames: Sequence[Frame]) -> Iterator[Pixels]:
        """Give an array (height, width, 3) of bytes for each frame."""
        axes = self.picture.axes
        for frame in frames:
            self.picture.show(frame)
            self.canvas.restore_region(self.background)
            for part in (*self.moving, *axes.spines.values()):
                axes.draw_artist(part)
            yield np.array(self.canvas.buffer_rgba())[:, :, :3]


def _write_gif(images: Iterator[Pixels], path: Path, rate: float) -> None:
    """One palette for all frames: the first has the colours of all, and finding one is slow."""
    first = Image.fromarray(next(images)).quantize(256)
    others = (
        Image.fromarray(image).quantize(palette=first, dither=Image.Dither.NONE) for image in images
    )
    first.save(path, save_all=True, append_images=others, duration=1000 / rate, loop=0)


def _write_with(ffmpeg: str, images: Iterator[Pixels], path: Path, rate: float) -> None:
    first = next(images)
    height, width = first.shape[0] & ~1, first.shape[1] & ~1  # most codecs want even numbers
    command = [ffmpeg, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{width}x{height}", "-r", str(rate), "-i", "-"]
    command += ["-pix_fmt", "yuv420p", str(path)]
    with tempfile.TemporaryFile() as messages:
        child = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=messages, stderr=messages, bufsize=0
        )
        assert child.stdin is not None
        try:
            for image in itertools.chain([first], images):
                child.stdin.write(np.ascontiguousarray(image[:height, :width]).tobytes())
            child.stdin.close()
        except BrokenPipeError:
            pass  # its exit code and message say why
        except BaseException:
            child.kill()
            raise
        finally:
            code = child.wait()
        if code != 0:
            messages.seek(0)
            reason = messages.read().decode("utf-8", "replace").strip()
            raise FileError(f"ffmpeg cannot write {path.name}: {reason}")
