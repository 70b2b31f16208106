# SPDX-License-Identifier: BSD-3-Clause
"""What reports say about equations of state, and what theory says."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple, TypeVar

import numpy as np

from carrom.errors import NoDataError
from carrom.runs import Run

Number = TypeVar("Number", float, np.ndarray[Any, np.dtype[np.float64]])

# Padé approximant [5/4] in the packing fraction of the virial series with the coefficients B_n /
# B_2^(n-1), n = 2 to 10 (Clisby and McCoy, J. Stat. Phys. 122, 15 (2006)).
_VIRIAL = (
    1,
    0.78200442,
    0.53223180,
    0.33355604,
    0.1988425,
    0.1148728,
    0.0649930,
    0.0362193,
    0.0199537,
)
_SIDES = ("left", "right", "bottom", "top")


class Measured(NamedTuple):
    """A number with one standard error; the error is nan where the program gives none."""

    value: float
    error: float


def henderson(packing: Number) -> Number:
    """Return Z = p A / (N kT) of hard discs: Henderson, Mol. Phys. 30, 971 (1975)."""
    return (1 + packing * packing / 8) / (1 - packing) ** 2


def virial_equation(packing: Number) -> Number:
    """Return Z = p A / (N kT) of hard discs from ten virial coefficients, in a Padé approximant.

    The equations of Liu, arXiv:2010.10624, and of Luding, Phys. Rev. E 63, 042201 (2001), agree to
    0.1 % up to a packing of 0.60.
    """
    above, below = _pade()
    return sum(c * packing**k for k, c in enumerate(above)) / sum(  # type: ignore[return-value]
        c * packing**k for k, c in enumerate(below)
    )


@cache
def _pade(n: int = 4) -> tuple[list[float], list[float]]:
    """Coefficients above and below the line, of the powers of the packing fraction."""
    series = np.array([1.0, *(b * 2.0**k for k, b in enumerate(_VIRIAL, 1))])
    m = len(series) - 1 - n
    rows = [[series[m + i - j] for j in range(1, n + 1)] for i in range(1, n + 1)]
    below = np.array([1.0, *np.linalg.solve(rows, -series[m + 1 :])])
    above = [
        float(np.dot(series[max(i - n, 0) : i + 1], below[min(i, n) :: -1])) for i in range(m + 1)
    ]
    return above, below.tolist()


def average(run: Run, name: str) -> Measured:
    """Return one of the averages of a report.

    Raises:
        NoDataError: the report has no such average of this scene (null)
    """
    entry = run.report["averages"].get(name)
    if not isinstance(entry, dict) or entry["value"] is None:
        raise NoDataError(f"{run.name}: the report has no {name} of this scene")
    error = entry["error"]
    return Measured(float(entry["value"]), math.nan if error is None else float(error))


def compressibility(run: Run) -> Measured:
    """Return Z = p A / (N kT) of a gas of equal discs, with one standard error.

    Between walls Z comes from `virial_pressure` of the report; A is the whole box. The walls push
    discs together: Z is above that of an endless gas by some 2 r / L. In a box that is periodic
    all round Z comes from the collision frequency f: Z = 1 + (d / 4) f sqrt(pi m / kT), with the
    diameter d. That holds in equilibrium. kT leaves out the motion of all discs together. Z - 1 of
    N discs is below that of an endless gas by some 1 / N of itself.

    Raises:
        NoDataError: the run is not finished, has species, or effects other than periodic sides
    """
    report, scene = run.report, run.scene
    n = int(report["n_discs"])
    kinds = [scene.get("box", {}).get(side, {}).get("kind", "wall") for side in _SIDES]
    effects = scene.get("effects", {})
    if "species" in scene.get("discs", {}) or effects or set(kinds) - {"wall", "periodic"}:
        raise NoDataError(f"{run.name}: compressibility is of equal discs without effects alone")
    energy, area = float(report["kinetic_energy"]), float(np.prod(report["box"]))
    if set(kinds) == {"wall"}:
        pressure = average(run, "virial_pressure")
        return Measured(pressure.value * area / energy, pressure.error * area / energy)
    if set(kinds) != {"periodic"}:
        raise NoDataError(f"{run.name}: compressibility needs four walls or four periodic sides")
    frequency = average(run, "collision_frequency")
    diameter = 2 * math.sqrt(area * float(report["packing"]) / (math.pi * n))
    momentum = np.asarray(report["momentum"], dtype=float)
    temperature = (2 * energy - float(momentum @ momentum) / n) / (2 * max(n - 1, 1))
    factor = diameter / 4 * math.sqrt(math.pi / temperature)
    return Measured(1 + factor * frequency.value, factor * frequency.error)
