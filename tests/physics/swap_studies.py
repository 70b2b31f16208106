#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold swap moves to plain dynamics: prints a study as CSV.

  tests/physics/swap_studies.py CARROM STUDY [--short]

same     a liquid with swaps against long runs without: Z, S(k), and which radii are neighbours
relax    the time in which F_s at the wave number 2 pi falls to 1/e, with swaps and without

The mean diameter is 1 and kT is 0.01. Diameters s have the distribution 1 / s^3 from 0.45 of the
largest one up, whose standard deviation is 23 % of the mean, as in Berthier, Charbonneau,
Ninarello, Ozawa and Yaida, Nature Commun. 10, 1508 (2019). All masses are 1. Exit codes and errors
are those of tests/physics/literature.py.
"""
import json
import math
import os
import statistics
import subprocess
import tempfile

import literature
from driven_studies import EVENTS, PERIODIC

SMALLEST = 0.45 # relative to the largest diameter
KINDS = 40      # number of kinds of discs


def diameters():
    """The middles of so many equal shares of all discs, over their mean."""
    most = 1 / SMALLEST ** 2
    all_of_them = [(most - (k + 0.5) / KINDS * (most - 1)) ** -0.5 for k in range(KINDS)]
    mean = statistics.fmean(all_of_them)
    return [diameter / mean for diameter in all_of_them]


def liquid(count, packing, seed):
    """With a sync in each step, in which a disc flies a tenth of its diameter if it is alone."""
    each = count // KINDS
    area = each * sum(math.pi / 4 * diameter ** 2 for diameter in diameters())
    rows = ", ".join(f"{{count = {each}, radius = {diameter / 2:.12g}}}"
                     for diameter in diameters())
    return PERIODIC | EVENTS | {
        "box.size": math.sqrt(area / packing), "discs.generator": '"compressed"',
        "discs.species": f"[{rows}]", "discs.temperature": 0.01, "discs.seed": seed,
        "time.sync_every": 1}


def run(program, settings, folder):
    """The report of a scene with these keys, whose files are in the folder."""
    scene, result = (os.path.join(folder, name) for name in ("scene.toml", "report.json"))
    with open(scene, "w", encoding="utf-8") as file:
        file.writelines(f"{key} = {value}\n" for key, value in settings.items())
    subprocess.run([program, "run", scene, "--quiet", "--threads", "1", "--overwrite", "--report",
                    result, "-o", os.path.join(folder, "run")], check=True,
                   stdout=subprocess.DEVNULL)
    with open(result, encoding="utf-8") as file:
        return json.load(file)


def frames_of(program, folder):
    """Lists of (x, y, radius) from the trajectory of a run."""
    text = subprocess.run([program, "convert", os.path.join(folder, "run", "trajectory.h5"), "--to",
                           "xyz"], check=True, stdout=subprocess.PIPE, text=True).stdout
    lines = text.splitlines()
    count = int(lines[0]) + 2
    for begin in range(0, len(lines), count):
        words = [line.split() for line in lines[begin + 2:begin + count]]
        yield [(float(word[1]), float(word[2]), float(word[8])) for word in words]


def neighbours(frame, size, gap=0.1):
    """Pairs of radii of discs whose surfaces are nearer than the gap."""
    half = size / 2
    for k, (x, y, r) in enumerate(frame):
        for u, v, s in frame[:k]:
            dx, dy = (u - x + half) % size - half, (v - y + half) % size - half
            if dx * dx + dy * dy < (r + s + gap) ** 2:
                yield r, s


def order_of_radii(frames, size):
    """Of neighbours: how many a disc has; the correlation of their radii; and the mean radius of
    those of the largest fifth of all discs, over the mean radius."""
    radii = sorted(diameter / 2 for diameter in diameters())
    large = radii[-KINDS // 5] - 1e-9
    mean, spread = statistics.fmean(radii), statistics.pvariance(radii)
    n_discs, n_pairs, products, of_large = 0, 0, 0.0, []
    for frame in frames:
        n_discs += len(frame)
        for r, s in neighbours(frame, size):
            n_pairs += 1
            products += (r - mean) * (s - mean)
            of_large += [other for one, other in ((r, s), (s, r)) if one > large]
    return {"neighbours": 2 * n_pairs / n_discs, "correlation": products / n_pairs / spread,
            "beside_large": statistics.fmean(of_large) / mean}


def one_run(program, settings):
    with tempfile.TemporaryDirectory() as folder:
        report = run(program, settings, folder)
        found = order_of_radii(frames_of(program, folder), settings["box.size"])
        found["Z"] = report["compressibility"]["value"]
        s_of_k = report["measurements"]["structure_factor"]["S"]
        return found | {f"S_{k}": value for k, value in enumerate(s_of_k)}


def santos(packing, count):
    """Z of a mixture, Santos, Yuste and Lopez de Haro, Mol. Phys. 96, 1 (1999), by that of equal
    discs; see `sizes` of driven_studies.py."""
    share = 1 / statistics.fmean(diameter ** 2 for diameter in diameters())
    return share * literature.factor_of(count, packing) + (1 - share) / (1 - packing)


def settings_of(steps, rounds, seed):
    early = steps // 5
    swaps = {"effects.swap.rounds": rounds, "effects.swap.seed": seed} if rounds else {}
    return swaps | {
        "time.steps": steps, "output.averages_from_step": early,
        "output.measurements.quantities": '["structure_factor"]',
        "output.measurements.every_steps": 10, "output.measurements.from_step": early,
        "output.measurements.bins": 16, "output.measurements.largest_wavenumber": 12,
        "output.trajectory.every_steps": steps // 30}


def scatter(found, known):
    """The mean square of the differences of S(k) over their errors; for normal errors it is 1."""
    squares = [(value - known[name][0]) ** 2 / (error ** 2 + known[name][1] ** 2)
               for name, (value, error) in found.items()
               if name.startswith("S_") and error > 0] # bins without wave vectors have no error
    return statistics.fmean(squares), math.sqrt(2 / len(squares))


def same(program, is_short):
    """Runs with other seeds give the errors. These are of few runs, so squares over them are larger
    than 1, by the mean of F's distribution."""
    count, steps, seeds = (160, 1_500, 4) if is_short else (200, 12_000, 10)
    for packing in (0.72,) if is_short else (0.60, 0.72):
        runs = {rounds: [one_run(program, liquid(count, packing, seed) |
                                 settings_of(steps, rounds, seed)) for seed in range(1, seeds + 1)]
                for rounds in (4, 0)}
        found, known = ({name: literature.mean([one[name] for one in runs[rounds]])
                         for name in runs[rounds][0]} for rounds in (4, 0))
        peak = max((name for name in known if name.startswith("S_") and known[name][1] > 0),
                   key=lambda name: known[name][0])
        degrees = 2 * (seeds - 1)
        found["S_scatter"], known["S_scatter"] = scatter(found, known), (degrees / (degrees - 2), 0)
        for name in ("Z", "S_0", peak, "S_scatter", "neighbours", "correlation", "beside_large"):
            yield {"packing": packing, "quantity": name, "value": found[name][0],
                   "value_error": found[name][1], "value_known": known[name][0],
                   "value_known_error": known[name][1]}
        if packing < 0.7: # above this packing equal discs would freeze
            z = santos(packing, count)
            yield {"packing": packing, "quantity": "Z_of_theory", "value": found["Z"][0],
                   "value_error": found["Z"][1], "value_known": z, "value_known_error": 0.0025 * z}


def time_of(table, last):
    """When F_s falls to 1/e, on a line over the logarithm of time; None if it does not up to the
    place `last`."""
    points = list(zip(table["steps"], table["scattering"]))[:last + 1]
    for (early, high), (late, low) in zip(points, points[1:]):
        if high > 1 / math.e >= low:
            share = (high - 1 / math.e) / (high - low)
            return math.exp(math.log(early) + share * math.log(late / early))
    return None


def relax(program, is_short):
    """Swaps bring the liquid to equilibrium first. F_s is then followed with swaps and without.

    `F_s` is that of the longest lag up to a quarter of the run. Where F_s without swaps does not
    fall to 1/e up to there, that lag is a bound of the time. Lags beyond have too few origins.
    """
    count, early, rounds = (80, 1_500, 32) if is_short else (200, 6_000, 32)
    lengths = {0.80: 6_000} if is_short else {0.76: 10_000, 0.78: 40_000, 0.80: 160_000}
    for packing, length_without in lengths.items():
        time_with = None
        for until, length in ((0, 2_000 if is_short else 10_000), (early, length_without)):
            with tempfile.TemporaryDirectory() as folder:
                report = run(program, liquid(count, packing, 1) | {
                    "time.steps": early + length, "effects.swap.rounds": rounds,
                    "effects.swap.until_step": until, "effects.swap.seed": 1,
                    "output.averages_from_step": early,
                    "output.measurements.quantities": '["correlations"]',
                    "output.measurements.correlation_wavenumber": 2 * math.pi,
                    "output.measurements.every_steps": 4,
                    "output.measurements.from_step": early}, folder)
            table = report["measurements"]["correlations"]
            last = max(k for k, steps in enumerate(table["steps"]) if 4 * steps <= length)
            time = time_of(table, last)
            time_with = time_with or time
            is_bound = packing == 0.80 and until > 0
            yield {"packing": packing, "swaps_go_on": int(until == 0), "steps": length,
                   "Z": report["compressibility"]["value"],
                   "time": time or f">{table['steps'][last]:g}",
                   "F_s": table["scattering"][last], "F_s_error": table["scattering_error"][last],
                   "F_s_above": 0.3 if is_bound else "",
                   "ratio": (time or table["steps"][last]) / time_with, "ratio_error": 0.0,
                   "ratio_above": (3 if is_short else 100) if is_bound else ""}


STUDIES = {"same": (same, math.inf, math.inf), "relax": (relax, math.inf, math.inf)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
