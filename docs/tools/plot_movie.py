#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Make a movie of a trajectory, discs to scale: GIF, or MP4 where ffmpeg or the package imageio-ffmpeg is installed.

  docs/tools/plot_movie.py trajectory.h5 -o movie.gif
  docs/tools/plot_movie.py trajectory.h5 --every 2 --rate 25 --colour strip --ranks 8 -o movie.mp4
"""
import argparse
import itertools
import shutil
import subprocess
import sys

import numpy as np
from PIL import Image

from drawing import Picture, add_drawing_options
from frames import Frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="a trajectory")
    parser.add_argument("--every", type=int, default=1, help="show every so-many-th frame")
    parser.add_argument("--rate", type=float, default=15, help="frames per second")
    parser.add_argument("-o", "--output", required=True)
    add_drawing_options(parser)
    options = parser.parse_args()
    is_gif = options.output.endswith(".gif")
    ffmpeg = None if is_gif else find_ffmpeg()
    frames = Frames(options.file)
    picture = Picture(frames, options)

    def images():
        for frame in range(0, len(frames.steps), options.every):
            picture.show(frame)
            yield picture.pixels()

    if is_gif:
        write_gif(images(), options)
    else:
        write_with(ffmpeg, images(), options)


def find_ffmpeg():
    """The program, or the one that the Python package imageio-ffmpeg brings along."""
    if found := shutil.which("ffmpeg"):
        return found
    try:
        import imageio_ffmpeg
        return imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        sys.exit("ffmpeg is not installed: `pip install imageio-ffmpeg` brings one; a name that ends in .gif does without")


def write_gif(images, options):
    """One palette for all frames: the first one has the colours of all, and finding one takes as long as drawing."""
    first = Image.fromarray(next(images)).quantize(256)
    others = (Image.fromarray(image).quantize(palette=first, dither=Image.Dither.NONE) for image in images)
    first.save(options.output, save_all=True, append_images=others, duration=1000 / options.rate, loop=0)


def write_with(ffmpeg, images, options):
    first = next(images)
    height, width = first.shape[0] & ~1, first.shape[1] & ~1  # most codecs want even numbers
    command = [ffmpeg, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
               "-r", str(options.rate), "-i", "-", "-pix_fmt", "yuv420p", options.output]
    with subprocess.Popen(command, stdin=subprocess.PIPE, bufsize=0) as movie:
        try:
            for image in itertools.chain([first], images):
                movie.stdin.write(np.ascontiguousarray(image[:height, :width]).tobytes())
        except BrokenPipeError:
            pass  # it has said why, and its code will tell
        movie.stdin.close()
        if movie.wait() != 0:
            sys.exit(f"ffmpeg has failed: {options.output} is not whole")


if __name__ == "__main__":
    main()
