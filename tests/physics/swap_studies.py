#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold swap moves to plain dynamics: prints a study as CSV.

  tests/physics/swap_studies.py CARROM STUDY [--short]

same     Z and S(k) of a liquid of discs of many sizes with swaps, against long runs without
relax    the time in which F_s falls to 1/e, with swaps and without, at a packing that plain
         dynamics does not bring to equilibrium

Radii have a lognormal distribution of 23 %, the width of glass formers in the plane (Berthier,
Charbonneau, Ninarello, Ozawa and Yaida, Nature Commun. 10, 1508 (2019), with another distribution).
Exit codes and errors are those of tests/physics/literature.py.
"""
import math
import statistics

import literature
from driven_studies import EVENTS, PERIODIC, box_of, run

SIZES = {"discs.radius.distribution": '"lognormal"', "discs.radius.polydispersity": 0.23,
         "discs.generator": '"compressed"'}


def liquid(count, packing, seed):
    """Discs of the mean diameter 1 or so, which have the root mean square velocity 1 along an axis
    in a hundred steps."""
    return PERIODIC | EVENTS | SIZES | {
        "box.size": box_of(count, packing), "discs.count": count, "discs.packing": packing,
        "discs.temperature": 1e-4, "discs.seed": seed, "time.sync_every": 16}


def same(program, is_short):
    """`S_scatter` is the mean square of the differences of S(k) in units of their errors, which is
    1 if there are none: its standard error is the root of 2 over the number of bins."""
    count, packing = 300 if is_short else 600, 0.68
    steps, seeds = (20_000, 4) if is_short else (60_000, 8)
    found = {}
    for rounds in (0, 4):
        found[rounds] = [run(program, liquid(count, packing, seed) | {
            "time.steps": steps, "effects.swap.rounds": rounds,
            "output.averages_from_step": steps // 4,
            "output.measurements.quantities": '["structure_factor"]',
            "output.measurements.every_steps": 200, "output.measurements.from_step": steps // 4,
            "output.measurements.bins": 24, "output.measurements.largest_k": 12,
        }) for seed in range(1, seeds + 1)]
    z = {rounds: literature.mean([report["compressibility"]["value"] for report in reports])
         for rounds, reports in found.items()}
    curves = {rounds: [literature.mean(values) for values in zip(
        *[report["measurements"]["structure_factor"]["S"] for report in reports])]
        for rounds, reports in found.items()}
    squares = [(a - b) ** 2 / (x ** 2 + y ** 2) for (a, x), (b, y) in zip(curves[0], curves[4])
               if math.isfinite(a - b) and x > 0 and y > 0]
    # Errors of means over few seeds have long tails: a mean of squares of t instead of 1.
    degrees = 2 * (seeds - 1)
    yield {"packing": packing, "swaps": statistics.fmean(r["swaps"] for r in found[4]),
           "Z": z[4][0], "Z_error": z[4][1], "Z_known": z[0][0], "Z_known_error": z[0][1],
           "S_largest": max(value for value, _ in curves[4]),
           "S_scatter": statistics.fmean(squares),
           "S_scatter_error": math.sqrt(2 / len(squares)),
           "S_scatter_known": degrees / (degrees - 2), "S_scatter_known_error": 0.2}


def time_of(table):
    """When F_s falls to 1/e, on a line through the logarithm of time; None if it does not."""
    points = [(lag, value) for lag, value in zip(table["steps"], table["F_s"]) if lag > 0]
    for (early, high), (late, low) in zip(points, points[1:]):
        if high > 1 / math.e >= low:
            share = (high - 1 / math.e) / (high - low)
            return math.exp(math.log(early) + share * math.log(late / early))
    return None


def relax(program, is_short):
    """Swaps bring the liquid to equilibrium first. F_s is then followed with swaps and without."""
    count = 200 if is_short else 400
    packing = 0.72 if is_short else 0.80
    early, steps = (20_000, 40_000) if is_short else (100_000, 2_000_000)
    for rounds, until, length in ((8, 0, min(steps, 200_000)), (8, early, steps)):
        report = run(program, liquid(count, packing, 1) | {
            "time.steps": early + length, "effects.swap.rounds": rounds,
            "effects.swap.until_step": until,
            "output.measurements.quantities": '["correlations"]',
            "output.measurements.every_steps": 100, "output.measurements.from_step": early})
        time = time_of(report["measurements"]["correlations"])
        yield {"packing": packing, "swaps_go_on": int(until == 0), "steps": length,
               "swaps": report["swaps"], "steps_to_1_over_e": time or "",
               "last_F_s": report["measurements"]["correlations"]["F_s"][-1]}


STUDIES = {"same": (same, 2, 2), "relax": (relax, math.inf, math.inf)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
