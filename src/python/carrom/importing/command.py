# SPDX-License-Identifier: BSD-3-Clause
"""`carrom-import`: discs from files of other programs, on the command line."""

from __future__ import annotations

import argparse
import math
import sys
import warnings
from collections.abc import Sequence

from carrom.errors import CarromError, ProgramError
from carrom.importing.importer import FORMATS, Choice, import_discs
from carrom.launching import CarromWarning


def _by_type(words: Sequence[str] | None, what: str) -> dict[str, float]:
    """`0.5`, or `A=0.5 B=0.3`."""
    values: dict[str, float] = {}
    for word in words or []:
        name, _, number = word.rpartition("=")
        try:
            values[name] = float(number)
        except ValueError:
            raise ValueError(f"--{what} takes a number or TYPE=NUMBER, not {word!r}") from None
    return values


def _origin(words: Sequence[str] | None) -> tuple[float, float] | str | None:
    if words is None or list(words) == ["centre"]:
        return None if words is None else "centre"
    try:
        x, y = (float(word) for word in words)
    except ValueError:
        raise ValueError('--origin takes X Y, or "centre"') from None
    return x, y


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="carrom-import",
        description="Take discs from a file of another program: GSD, LAMMPS dump and data, "
        "(extended) XYZ, CSV with named columns, or rows `x y vx vy r m`. Writes a checkpoint for "
        "`discs.from`, and prints the tables [box] and [discs] of a scene that begins from it. The "
        "path in `discs.from` is that of -o, so a scene in the working folder finds the file.",
        epilog="Exit codes: 0 done; 2 the file or an option is wrong, and nothing was written.",
    )
    add = parser.add_argument
    add("file", help="the file; its begin decides the format, not its name")
    add("-o", "--output", required=True, metavar="DISCS.h5", help="the checkpoint; is replaced")
    add("--format", choices=sorted(FORMATS), default="", help="the format, if it is known")
    add("--frame", type=int, help="from 0 on, or from -1 backwards; default: the last")
    add("--step", type=int, help="the frame of this step")
    add("--box", type=float, nargs="+", metavar="L", help="edges, where the file has no box")
    add("--origin", nargs="+", metavar="X", help='lower left corner of the box, or "centre"')
    add("--keep-origin", action="store_true",
        help="places stay as the file has them, and [box] gets an origin")  # fmt: skip
    add("--periodic", choices=["x", "y", "xy", "none"], help="instead of what the file says")
    add("--radius", nargs="+", metavar="R", help="of all discs, or TYPE=R for each type")
    add("--mass", nargs="+", metavar="M", help="of all discs, or TYPE=M for each type")
    add("--time-step", type=float, default=1.0, metavar="DT",
        help="time of the file in a step of Carrom; multiplies velocities; default 1")  # fmt: skip
    add("--shrink", type=float, default=0.0, metavar="SHARE",
        help="make radii smaller by this share, where roundings let discs overlap")  # fmt: skip
    return parser


def _choice(options: argparse.Namespace) -> Choice:
    box = options.box
    if box is not None and len(box) not in (1, 2):
        raise ValueError("--box takes one edge or two")
    if not 0 <= options.shrink < 1:
        raise ValueError("--shrink is at least 0 and below 1")
    if not 0 < options.time_step < math.inf:
        raise ValueError("--time-step is above 0 and finite")
    return Choice(
        format=options.format,
        frame=options.frame,
        step=options.step,
        box=None if box is None else (box[0], box[-1]),
        origin=_origin(options.origin),
        periodic=options.periodic,
        radius=_by_type(options.radius, "radius"),
        mass=_by_type(options.mass, "mass"),
        time_step=options.time_step,
        shrink=options.shrink,
        keep_origin=options.keep_origin,
    )


def main(words: Sequence[str] | None = None) -> int:
    """Import what the command line names; return the exit code."""
    options = _parser().parse_args(words)
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", CarromWarning)
            imported = import_discs(options.file, options.output, _choice(options))
    except ProgramError as error:
        print(error, file=sys.stderr)
        return error.returncode if error.returncode > 0 else 3
    except (CarromError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{options.output}: {error.strerror or error}", file=sys.stderr)
        return 4
    except MemoryError:
        print(f"{options.file}: has more discs than memory can hold", file=sys.stderr)
        return 2
    for warning in caught:
        print(f"warning: {warning.message}", file=sys.stderr)
    for remark in imported.remarks:
        print(remark, file=sys.stderr)
    print(imported.scene, end="")
    return 0
