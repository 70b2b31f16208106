#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run the scenes of inputs/, and draw the picture of each that the pages show.

  build/python/bin/python docs/tools/effects.py build/carrom [NAME ...] [--output docs/pictures]

It takes some minutes. A picture is 907 pixels wide, and has as many colours as 250 kB allow.
docs/tools/flows.py draws those of driven discs.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

MOST_BYTES = 250_000
TOP = pathlib.Path(__file__).resolve().parents[2]

# The step that is shown, and words for `carrom-plot frame`.
PICTURES = {
    "atmosphere": (20_000, "--view 0 0 200 200"),
    "break": (250, "--view 20 10 100 90"),
    "conduction": (4_000, ""),
    "cooling": (3_000, ""),
    "crossing": (100, "--colour vx --view 30 80 130 140 --magnify 2"),
    "crystal": (100, ""),
    "dense": (500, "--view 0 0 100 100"),
    "dense_liquid": (100, "--view 0 0 100 100"),
    "drag": (200, ""),
    "effusion": (600, "--scene --colour vx --fastest 0.3 --view 40 40 200 160 --magnify 2"),
    "galton": (400, "--scene"),
    "gas": (100, "--view 0 0 100 100"),
    "haff": (500, ""),
    "hopper": (140, "--scene"),
    "jet": (700, "--view 150 380 700 870"),
    "lorentz": (25, "--scene --colour vx"),
    "mixture": (500, ""),
    "piston": (60, ""),
    "rain": (600, "--view 0 0 200 45"),
    "rough": (40, "--colour spin --fastest 0.08"),
    "shaker": (2_000, ""),
    "single_file": (2_000, "--view 0 -1 45 3"),
    "swirled": (400, ""),
    "tiny": (5, ""),
    "trap": (400, ""),
    "vibrated": (80_000, "--view 0 0 120 90 --magnify 2.5"),
    "washboard": (200, ""),
}


def draw(program, name, folder, target):
    step, words = PICTURES[name]
    scene = TOP / "inputs" / f"{name}.toml"
    run = folder / name
    subprocess.run([program, "run", scene, "--quiet", "--steps", str(step), "-o", run], check=True)
    words = [str(word) for part in words.split() for word in with_scene(part, scene)]
    checkpoint = run / "checkpoints" / f"checkpoint-{step:012}.h5"
    tool = [sys.executable, "-m", "carrom.plot.commands", "frame"]
    picture = folder / f"{name}.png"
    subprocess.run([*tool, checkpoint, "--dpi", "126", *words, "-o", picture], check=True,
                   env=dict(os.environ, PYTHONPATH=TOP / "src/python"))
    shrink(picture, target)


def with_scene(word, scene):
    return [word, scene] if word == "--scene" else [word]


def shrink(picture, target, most_bytes=MOST_BYTES):
    """As many colours as the size allows."""
    image = Image.open(picture).convert("RGB")
    for colours in (128, 96, 64, 48, 32, 24, 16, 12, 8):
        image.quantize(colours, dither=Image.Dither.NONE).save(target, optimize=True)
        if target.stat().st_size < most_bytes:
            print(f"{target}: {colours} colours, {target.stat().st_size} bytes")
            return
    sys.exit(f"{target} has {target.stat().st_size} bytes")


def options_of(text):
    """The program, the names of pictures and the folder for them, as words of the command line."""
    parser = argparse.ArgumentParser(description=text,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("names", nargs="*", metavar="NAME", help="default: all")
    parser.add_argument("--output", type=pathlib.Path, default=TOP / "docs" / "pictures")
    return parser.parse_args()


def main():
    options = options_of(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names or PICTURES:
            draw(options.program.resolve(), name, pathlib.Path(folder),
                 options.output / f"{name}.png")


if __name__ == "__main__":
    main()
