#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw one frame of a checkpoint or a trajectory as PNG (or PDF, SVG), discs to scale.

  docs/tools/plot_frame.py kept/checkpoint-000000000700.h5 -o jet.png
  docs/tools/plot_frame.py trajectory.h5 --step 100 --colour strip --ranks 3 --view 0 0 50 50 -o corner.png
"""
import argparse

from drawing import Picture, add_drawing_options
from frames import Frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="a checkpoint or a trajectory")
    parser.add_argument("--step", type=int, help="default: the last")
    parser.add_argument("-o", "--output", required=True)
    add_drawing_options(parser)
    options = parser.parse_args()
    frames = Frames(options.file)
    picture = Picture(frames, options)
    picture.show(frames.nearest(options.step))
    picture.figure.savefig(options.output, dpi=options.dpi)


if __name__ == "__main__":
    main()
