# SPDX-License-Identifier: BSD-3-Clause
"""What reports say about equations of state, and what theory says."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple, overload

import numpy as np
import numpy.typing as npt

from carrom.errors import NoDataError
from carrom.runs import Run

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


class _ValueAndError(NamedTuple):
    value: float
    error: float


class Measured(_ValueAndError):
    """A number with one standard error: `value, error = measured`.

    Attributes:
        value: the number
        error: one standard error; nan where there is none
        without_error: why there is no error; empty if there is one, or if nobody knows
    """

    without_error: str

    def __new__(cls, value: float, error: float, without_error: str = "") -> Measured:
        """Join the numbers, and the reason why an error of nan is not known."""
        measured = super().__new__(cls, value, error)
        measured.without_error = without_error
        return measured

    def __repr__(self) -> str:
        reason = f" ({self.without_error})" if self.without_error else ""
        return f"Measured(value={self.value!r}, error={self.error!r}{reason})"


Array = npt.NDArray[np.float64]


def _number(packing: npt.ArrayLike) -> Any:
    """Return a number as it is, and all else as an array."""
    return packing if isinstance(packing, (int, float)) else np.asarray(packing, dtype=np.float64)


@overload
def henderson(packing: float) -> float: ...
@overload
def henderson(packing: npt.ArrayLike) -> Array: ...
def henderson(packing: npt.ArrayLike) -> float | Array:
    """Return Z = p A / (N kT) of hard discs: Henderson, Mol. Phys. 30, 971 (1975)."""
    eta = _number(packing)
    z: float | Array = (1 + eta * eta / 8) / (1 - eta) ** 2
    return z


@overload
def virial_equation(packing: float) -> float: ...
@overload
def virial_equation(packing: npt.ArrayLike) -> Array: ...
def virial_equation(packing: npt.ArrayLike) -> float | Array:
    """Return Z = p A / (N kT) of hard discs from ten virial coefficients, in a Padé approximant.

    The equations of Liu, arXiv:2010.10624, and of Luding, Phys. Rev. E 63, 042201 (2001), agree to
    0.1 % up to a packing of 0.60.
    """
    eta = _number(packing)
    above, below = (sum(c * eta**k for k, c in enumerate(row)) for row in _pade())
    z: float | Array = above / below
    return z


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


def _measured(run: Run, entry: Any, name: str) -> Measured:
    if not _has_value(entry):
        known = ", ".join(quantities(run)) or "none"
        raise NoDataError(f"{run.name}: the report has no {name} of this scene; it has {known}")
    error = entry["error"]
    reason = entry.get("without_error", "")
    return Measured(float(entry["value"]), math.nan if error is None else float(error), reason)


def _has_value(entry: Any) -> bool:
    return isinstance(entry, dict) and entry.get("value") is not None


def _averages(run: Run) -> dict[str, Any]:
    """All entries of the report that may be averages, by the names that `carrom replicas` takes."""
    report = run.report
    tensor = report.get("pressure_tensor") or {}
    return {
        **{name: report.get(name) for name in ("temperature", "pressure", "compressibility")},
        **{f"pressure_{part}": tensor.get(part) for part in ("xx", "xy", "yy")},
        **report["averages"],
        **report.get("watched", {}),
    }


def quantities(run: Run) -> dict[str, Measured]:
    """Return all averages that the report of a run has, by the names that `average` takes.

    Raises:
        NoDataError: the run has no report yet
    """
    return {
        name: _measured(run, entry, name)
        for name, entry in _averages(run).items()
        if _has_value(entry)
    }


def average(run: Run, name: str) -> Measured:
    """Return one of the averages of a report. `carrom.quantities` has their names.

    Raises:
        NoDataError: the report has no such average of this scene (null)
    """
    return _measured(run, _averages(run).get(name), name)


def compressibility(run: Run) -> Measured:
    """Return Z = P A / (N kT) as the report has it, with one standard error.

    P is the mean of the pressure tensor's xx and yy over the whole box. Averages begin at
    `output.averages_from_step`.

    Raises:
        NoDataError: the run is not finished, or its report has no Z (null)
    """
    return _measured(run, run.report.get("compressibility"), "compressibility")
