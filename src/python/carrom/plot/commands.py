# SPDX-License-Identifier: BSD-3-Clause
"""`carrom-plot`: pictures of runs from the command line."""

from __future__ import annotations

import argparse
import struct
import sys
from collections.abc import Callable, Sequence
from typing import Any

from carrom import plot
from carrom.destinations import refuse_owned
from carrom.errors import CarromError
from carrom.plot.sources import COLOURS
from carrom.scene import read_scene

Options = argparse.Namespace


def main(words: Sequence[str] | None = None) -> int:
    """Draw what the command line asks for; return 0, or 2 with a message."""
    parser = _parser()
    options = parser.parse_args(words)
    try:
        import matplotlib as mpl

        mpl.use("Agg")
        refuse_owned(options.output)
        options.act(options)
    except (CarromError, ValueError, OSError) as error:
        print(f"carrom-plot: {error}", file=sys.stderr)
        return 2
    except (
        ArithmeticError,
        MemoryError,
        RuntimeError,
        struct.error,
    ) as error:  # errors of matplotlib and pillow
        print(f"carrom-plot: cannot draw: {error}; try: another --dpi or --rate", file=sys.stderr)
        return 2
    except ImportError as error:
        print(f"carrom-plot: {error}: pip install carrom[plot]", file=sys.stderr)
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="carrom-plot", description="Draw runs of Carrom.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(name: str, act: Callable[[Options], None], text: str, **source: Any) -> Any:
        command = commands.add_parser(name, help=text, description=text)
        command.set_defaults(act=act)
        command.add_argument("source", **source)
        output = "a picture (.png, .pdf, .svg), or a movie (.gif, .mp4)"
        command.add_argument("-o", "--output", required=True, help=output)
        command.add_argument("--dpi", type=int, default=110, help="dots per inch; default 110")
        return command

    run = {"help": "a run's folder, or a file of it"}
    frame = add("frame", _frame, "one frame, discs to scale", **run)
    frame.add_argument("--step", type=int, help="default: the last")
    _add_style(frame)
    movie = add("movie", _movie, "all frames, discs to scale", **run)
    movie.add_argument("--every", type=int, default=1, help="show every so-many-th frame")
    movie.add_argument("--rate", type=float, default=15, help="frames per second; default 15")
    _add_style(movie)
    add("history", _history, "kinetic energy and collisions over time", **run)
    add("measurements", _measurements, "the tables of [output.measurements]", **run)
    profiles = add("profiles", _profiles, 'fields of "profiles", as maps or curves', **run)
    profiles.add_argument(
        "--columns",
        nargs="+",
        metavar="FIELD",
        default=["density", "temperature", "vx", "vy"],
        help="fields to draw; default: density temperature vx vy",
    )
    profiles.add_argument("--step", type=int, help="last step of the block; default: the last")
    profiles.add_argument("--species", type=int, help="one species, counted from 1")
    many = {"nargs": "+", "help": "folders of runs"}
    gr = add("gr", _gr, "the radial distribution g(r)", **many)
    gr.add_argument("--in-diameters", action="store_true", help="distances over the diameter")
    add("eos", _eos, "the equation of state, and what theory says", **many)
    return parser


def _add_style(command: Any) -> None:
    command.add_argument("--colour", "--color", choices=COLOURS, default="speed")
    command.add_argument("--ranks", type=int, default=4, help="how many strips; default 4")
    command.add_argument(
        "--view", type=float, nargs=4, metavar=("X0", "Y0", "X1", "Y1"), help="part of the box"
    )
    command.add_argument(
        "--fastest", type=float, help="number of the strongest colour; default: 99 in 100 are below"
    )
    command.add_argument(
        "--magnify", type=float, default=1, help="draw discs so many times as large; default 1"
    )
    command.add_argument("--scene", help="a scene's TOML, to draw its obstacles")


def _style(options: Options) -> dict[str, Any]:
    return {
        "colour": options.colour,
        "ranks": options.ranks,
        "view": tuple(options.view) if options.view else None,
        "fastest": options.fastest,
        "magnify": options.magnify,
        "scene": read_scene(options.scene) if options.scene else None,
    }


def _save(axes: Any, options: Options) -> None:
    axes.figure.savefig(options.output, dpi=options.dpi)


def _frame(options: Options) -> None:
    _save(plot.frame(options.source, options.step, **_style(options)), options)


def _movie(options: Options) -> None:
    timing = {"every": options.every, "rate": options.rate, "dpi": options.dpi}
    plot.movie(options.source, options.output, **timing, **_style(options))


def _history(options: Options) -> None:
    _save(plot.history(options.source)[0], options)


def _measurements(options: Options) -> None:
    _save(plot.measurements(options.source)[0], options)


def _profiles(options: Options) -> None:
    axes = plot.profiles(
        options.source, options.columns, step=options.step, species=options.species
    )
    _save(axes[0], options)


def _gr(options: Options) -> None:
    _save(plot.radial_distribution(options.source, in_diameters=options.in_diameters), options)


def _eos(options: Options) -> None:
    _save(plot.equation_of_state(options.source), options)


if __name__ == "__main__":
    sys.exit(main())
