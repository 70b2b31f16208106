#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold discs in fields to hydrostatic balance and to closed forms: prints a study as CSV.

  tests/physics/field_studies.py CARROM STUDY [--short]

balance    density of a fluid in a trap along y and in a sine along x, with a thermostat, against
           dP/dn dn/dx = -n dV/dx with Henderson's equation of state
splitting  energy of free discs in a trap, and of a dense fluid in a sine without a thermostat,
           against the time between syncs
drift      the invariant of the splitting after up to 1e6 periods of a free disc in a trap

Discs have the diameter 1, the mass 1 and kT = 1. Exit codes and errors are those of
tests/physics/literature.py. Henderson, Mol. Phys. 30, 971 (1975).
"""
import math
import statistics

import literature
from driven_studies import EVENTS, PERIODIC, run, run_and_print

AREA = math.pi / 4
ROUND = {f"box.{side}.kind": '"periodic"' for side in ("left", "right")}


def discs_at_end(program, settings):
    """x, y, vx and vy of the discs at the last step."""
    last = f"{settings['time.steps']} "
    lines = [line.split() for line in run_and_print(program, settings)[1].splitlines()
             if line.startswith(last)]
    return [[float(word) for word in line[2:6]] for line in lines]


def potential(packing):
    """The chemical potential over kT, up to a constant, by Henderson's Z."""
    # The integral of (Z - 1) / packing is -7/8 log(1 - packing) + 9/8 packing / (1 - packing).
    z = (1 + packing ** 2 / 8) / (1 - packing) ** 2
    return (math.log(packing) - 7 / 8 * math.log(1 - packing) +
            9 / 8 * packing / (1 - packing) + z - 1)


def packing_at(value):
    """The packing of this chemical potential."""
    low, high = 1e-300, 0.9
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if potential(middle) < value else (low, middle)
    return low


def profile(deepest, energies):
    """Packings where the potential has these energies, given that where it is 0."""
    at_bottom = potential(deepest)
    return [packing_at(at_bottom - energy) for energy in energies]


def profile_of(count, energies, strip):
    """The same, given the number of discs in strips of that area."""
    low, high = 1e-6, 0.88
    for _ in range(60):
        middle = (low + high) / 2
        found = sum(profile(middle, energies)) * strip / AREA
        low, high = (middle, high) if found < count else (low, middle)
    return profile(low, energies)


FINE = 10 # points of the theory in a strip


def means(values):
    return [statistics.fmean(values[k:k + FINE]) for k in range(0, len(values), FINE)]


def scene_of_trap(packing, is_short):
    """Strips along y in a trap that spreads one disc by 10."""
    width, height, bins = 20, 120, 60
    energy = [0.005 * ((k + 0.5) * height / (bins * FINE) - height / 2) ** 2
              for k in range(bins * FINE)]
    strip = width * height / (bins * FINE)
    count = round(sum(profile(packing, energy)) * strip / AREA)
    # At first discs are in a rectangle at a packing of 0.4 or less.
    start = min(height / 2 - 1, max(15, count * AREA / (2 * 0.4 * width)))
    return count, energy, strip, bins, "density_y", ROUND | {
        "box.size": f"[{width}, {height}]",
        "discs.region": f"[0, {height / 2 - start}, {width}, {height / 2 + start}]",
        "effects.field.kind": '"trap"', "effects.field.stiffness_y": 0.01}


def scene_of_sine(packing, is_short):
    """Strips along x in one wave of amplitude kT; the packing is the mean one."""
    length, height, bins = 80, 20, 40
    energy = [1 + math.sin(2 * math.pi * (k + 0.5) / (bins * FINE)) for k in range(bins * FINE)]
    count = round(packing * length * height / AREA)
    return count, energy, length * height / (bins * FINE), bins, "density_x", PERIODIC | {
        "box.size": f"[{length}, {height}]", "effects.field.kind": '"sine"',
        "effects.field.amplitude": 1,
        "discs.generator": '"lattice"' if packing > 0.45 else '"random"'}


def balance(program, is_short):
    """Two seeds, and both halves of the box, give four densities for each strip.

    That the density is a local one, and Henderson's Z, are approximations: they are given an error
    of 1 %.
    """
    cases = [("trap", scene_of_trap, 0.4)] if is_short else [
        *(("trap", scene_of_trap, packing) for packing in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)),
        *(("sine", scene_of_sine, packing) for packing in (0.1, 0.2, 0.3, 0.4, 0.5))]
    for name, scene, packing in cases:
        count, energy, strip, bins, table, settings = scene(packing, is_short)
        known = means(profile_of(count, energy, strip))
        first, last = (100, 200) if is_short else (150, 450)
        if packing < 0.25:
            last *= 3 # few discs take little time
        found = []
        for seed in (1, 2):
            report = run(program, settings | EVENTS | {
                "discs.count": count, "discs.radius": 0.5, "discs.temperature": 1,
                "discs.seed": seed, "time.steps": last, "time.micro_steps": 16,
                "effects.thermostat.kind": '"langevin"', "effects.thermostat.rate": 0.1,
                "effects.thermostat.temperature": 1, "effects.thermostat.seed": seed,
                "output.measurements.quantities": '["density"]',
                "output.measurements.from_step": first, "output.measurements.every_steps": 1,
                "output.measurements.bins": bins})
            packings = [AREA * n for n in report["measurements"][table]["density"]]
            if name == "sine": # the density is symmetric about its minimum
                packings = packings[bins // 4:] + packings[:bins // 4]
            found += [packings, packings[::-1]]
        if name == "sine":
            known = known[bins // 4:] + known[:bins // 4]
        # The densest tenth of the box, and the strips up to there.
        densest = sorted(range(bins), key=lambda k: -known[k])[:bins // 10]
        steps = max(known) - min(known)
        slope = [k for k in range(bins) if 0.2 < (known[k] - min(known)) / steps < 0.8]
        row = {"field": name, "packing": packing, "discs": count}
        for place, strips in (("densest", densest), ("slopes", slope)):
            # The mirror image of a run has the same sums over these strips, so two seeds give two
            # values.
            values = [statistics.fmean(found[2 * seed][k] for k in strips) for seed in (0, 1)]
            expected = statistics.fmean(known[k] for k in strips)
            halves = [statistics.fmean(found[i][k] for k in strips if k < bins / 2)
                      for i in range(4)]
            row |= {place: statistics.fmean(values),
                    f"{place}_error": statistics.stdev(halves) / 2,
                    f"{place}_known": expected, f"{place}_known_error": 0.01 * expected}
        row["worst_share"] = max(abs(statistics.fmean(f[k] for f in found) / known[k] - 1)
                                 for k in range(bins) if known[k] > 0.2 * max(known))
        yield row


def splitting(program, is_short):
    """The energy of a free disc oscillates by up to (w t)^2 / 4 of itself. In a fluid collisions
    change the phase at which it is, so that it wanders.
    """
    for turn in (0.2, 0.4) if is_short else (0.025, 0.05, 0.1, 0.2, 0.4):
        rate = turn / 16 # a sync each 16 micro-steps; a micro-step is one step
        shares = []
        for steps in range(64, 64 * 9, 64):
            report = run(program, EVENTS | {
                "box.size": 40, "discs.radius": 0.5, "discs.list": "[[30, 20, 0, 0]]",
                "time.steps": steps, "time.sync_every": 16, "effects.field.kind": '"trap"',
                "effects.field.stiffness_x": rate ** 2})
            energy = report["kinetic_energy"] + report["potential_energy"]
            shares.append(abs(energy / (50 * rate ** 2) - 1))
        # In the sine w^2 = (2 pi / 20)^2, and a step is a time of 1.
        wave = 2 * math.pi / 20
        report = run(program, PERIODIC | EVENTS | {
            "box.size": "[40, 20]", "discs.count": 400, "discs.radius": 0.5,
            "discs.temperature": 1, "time.steps": 100 if is_short else 800,
            "time.micro_steps": round(16 * wave / turn), "time.sync_every": 16,
            "effects.field.kind": '"sine"', "effects.field.amplitude": 1,
            "effects.field.waves": 2})
        energy = report["kinetic_energy"] + report["potential_energy"]
        first = run(program, PERIODIC | EVENTS | {
            "box.size": "[40, 20]", "discs.count": 400, "discs.radius": 0.5,
            "discs.temperature": 1, "time.steps": 0, "effects.field.kind": '"sine"',
            "effects.field.amplitude": 1, "effects.field.waves": 2})
        begin = first["kinetic_energy"] + first["potential_energy"]
        yield {"turn": turn, "free": max(shares), "free_error": 0.0,
               "free_below": turn ** 2 / 4 * 1.001, "collisions": report["pair_collisions"],
               "fluid": energy / begin - 1}


def drift(program, is_short):
    """A disc that turns by half a radian from sync to sync, where errors are large."""
    turn = 0.5
    for periods in (100, 10_000) if is_short else (100, 10_000, 1_000_000):
        steps = round(periods * 2 * math.pi / turn)
        lines = discs_at_end(program, EVENTS | {
            "box.size": 40, "discs.radius": 0.5, "discs.list": "[[30, 20, 0.5, 0]]",
            "time.steps": steps, "time.sync_every": 1, "effects.field.kind": '"trap"',
            "effects.field.stiffness_x": turn ** 2, "output.text": '"ends"'})
        x, _, v, _ = lines[0]
        shadow = turn ** 2 * (1 - turn ** 2 / 4) # the stiffness in the map's own energy
        known = 0.5 * (0.5 ** 2 + shadow * 10 ** 2)
        energy = 0.5 * (v ** 2 + shadow * (x - 20) ** 2)
        yield {"periods": periods, "syncs": steps, "energy": energy, "energy_error": 0.0,
               "energy_known": known, "energy_known_error": 1e-12 * known,
               "change": energy / known - 1}


# For each study: the function that makes the rows, and the largest relative errors that are allowed
# in a short and in the whole study.
STUDIES = {"balance": (balance, 0.05, 0.02), "splitting": (splitting, 1, 1),
           "drift": (drift, 1, 1)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
