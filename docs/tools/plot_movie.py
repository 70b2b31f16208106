#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Make a movie of a trajectory, discs to scale: GIF, or MP4 where ffmpeg is installed.

  docs/tools/plot_movie.py trajectory.h5 -o movie.gif
  docs/tools/plot_movie.py trajectory.h5 --every 2 --rate 25 --colour strip --ranks 8 -o movie.mp4
"""
import argparse
import shutil
import sys

from matplotlib import animation

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
    if options.output.endswith(".gif"):
        writer = animation.PillowWriter(fps=options.rate)
    elif shutil.which("ffmpeg"):
        writer = animation.FFMpegWriter(fps=options.rate)
    else:
        sys.exit("ffmpeg is not installed; a name that ends in .gif does without")
    frames = Frames(options.file)
    picture = Picture(frames, options)
    with writer.saving(picture.figure, options.output, options.dpi):
        for frame in range(0, len(frames.steps), options.every):
            picture.show(frame)
            writer.grab_frame()


if __name__ == "__main__":
    main()
