# SPDX-License-Identifier: BSD-3-Clause
"""The report of a simulation: the keys of `report.json` that do not depend on the machine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

_OF_TOP = ("temperature", "pressure", "compressibility")  # beside `averages`, not in it
_OF_ESTIMATE = ("value", "error", "correlation_time", "independent_samples")
_OF_TOTALS = (
    "wall_collisions",
    "pair_collisions",
    "overlapping_pairs",
    "departed",
    "kinetic_energy",
    "rotational_energy",
    "potential_energy",
    "state_hash",
)
_OF_FACTS = ("n_discs", "packing", "method", "micro_steps", "radius")


class Changes:
    """How often discs were given other numbers, and at which steps first and last."""

    def __init__(self, of: Mapping[str, Mapping[str, int]] | None = None) -> None:
        """Know of none, or of those that another simulation has had."""
        self._of = {name: dict(entry) for name, entry in (of or {}).items()}

    def note(self, names: Iterable[str], step: int) -> None:
        """Remember that these arrays were set at a step."""
        for name in names:
            entry = self._of.setdefault(name, {"times": 0, "first_step": step})
            entry["times"] += 1
            entry["last_step"] = step

    def as_dict(self) -> dict[str, dict[str, int]]:
        """Return `times`, `first_step` and `last_step` by the name of the array."""
        return {name: dict(entry) for name, entry in self._of.items()}


def report_of(
    facts: Mapping[str, Any],
    totals: Mapping[str, Any],
    averages: Mapping[str, Any],
    steps: tuple[int, int],
    changes: Changes,
) -> dict[str, Any]:
    """Put together what the extension returns. `steps` are the first and the present step."""
    estimates = {name: _estimate(entry) for name, entry in averages["averages"].items()}
    tensor = {key: estimates.pop(f"pressure_{key}") for key in ("xx", "xy", "yy")}
    report: dict[str, Any] = {name: facts[name] for name in _OF_FACTS}
    report |= {"box": list(facts["box"]), "first_step": steps[0], "steps": steps[1] - steps[0]}
    if any(facts["corner"]):
        report["origin"] = [0 - place for place in facts["corner"]]
    report |= {name: totals[name] for name in _OF_TOTALS}
    report |= {"momentum": list(totals["momentum"])}
    report |= {name: estimates.pop(name) for name in _OF_TOP}
    report["pressure_tensor"] = tensor
    of_averages = {
        "from_step": averages["first_step"],
        "over_steps": averages["steps"],
        "blocks": averages["blocks"],
    }
    return report | {"averages": of_averages | estimates, "changes": changes.as_dict()}


def facts_to_show(sim: Any) -> dict[str, Any]:
    """Return what a notebook shows of a `carrom.Simulation`."""
    report = sim.report
    return {
        "step": f"{sim.step} of {sim.last_step}",
        "discs": sim.n_discs,
        "method": sim.method,
        "kinetic energy": f"{report['kinetic_energy']:.9g}",
        "collisions of pairs": report["pair_collisions"],
        "state hash": report["state_hash"],
    }


def _estimate(entry: Mapping[str, Any]) -> dict[str, float | str | None]:
    """Numbers that do not exist are None, as in report.json."""
    estimate: dict[str, float | str | None] = {
        name: None if math.isnan(entry[name]) else entry[name] for name in _OF_ESTIMATE
    }
    if entry["without_error"]:
        estimate["without_error"] = entry["without_error"]
    return estimate
