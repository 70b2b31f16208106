#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold driven, sheared and sliding discs to kinetic theory: prints a study as CSV.

  tests/physics/driven_studies.py CARROM STUDY [--short]

viscosity  elastic discs in uniform shear that `rescale` cools, at four rates, and a row at the
           rate 0 from a fit of a + b rate^2; against Enskog
granular   a thin granular gas in uniform shear, its stress ratio and the rate over the frequency
           of collisions (which is its temperature), against Boltzmann's equation; Grad's moments
           stand beside
heated     a granular gas that kicks heat, its kT and its fourth cumulant a2, against kinetic theory
langevin   diffusion of discs with friction and noise, against kT / (m (gamma + nu))
places     g(r) and kT of discs with a thermostat, against g(r) without one
channel    viscosities from flows of Couette and Poiseuille between thermal walls, against Enskog
sizes      Z of fluids whose radii follow a distribution, by that of equal discs

Citations: Gass, J. Chem. Phys. 54, 1898 (1971), for Enskog's viscosity; Santos, Garzo and Dufty,
Phys. Rev. E 69, 061303 (2004), and Vega Reyes, Santos and Garzo, J. Fluid Mech. 719, 431 (2013),
for Grad's moments; van Noije and Ernst, Granular Matter 1, 57 (1998), for a2; Santos, Yuste and
Lopez de Haro, Mol. Phys. 96, 1 (1999), for discs of many sizes.

Discs have the diameter 1 and the mass 1. Exit codes and errors are those of
tests/physics/literature.py: a number is held to four joint standard errors. Where theory is an
approximation, the error that it is given stands beside it.
"""
import json
import math
import os
import statistics
import subprocess
import tempfile

import literature

PERIODIC = {f"box.{side}.kind": '"periodic"' for side in ("left", "right", "bottom", "top")}
SHEARED = PERIODIC | {f"box.{side}.kind": '"sheared"' for side in ("bottom", "top")}
EVENTS = {"time.method": '"event-driven"'}


def run_and_print(program, settings):
    """The report of a scene with these keys, and what the program prints."""
    with tempfile.TemporaryDirectory() as folder:
        scene, result = (os.path.join(folder, name) for name in ("scene.toml", "report.json"))
        with open(scene, "w", encoding="utf-8") as file:
            file.writelines(f"{key} = {value}\n" for key, value in settings.items())
        ended = subprocess.run([program, "run", scene, "--quiet", "--threads", "1", "--report",
                                result, "-o", os.path.join(folder, "run")], check=True,
                               stdout=subprocess.PIPE, text=True)
        with open(result, encoding="utf-8") as file:
            return json.load(file), ended.stdout


def run(program, settings):
    """The report of a scene with these keys."""
    return run_and_print(program, settings)[0]


def box_of(count, packing):
    return math.sqrt(count * math.pi / (4 * packing))


def contact_value(packing):
    return (1 - 7 * packing / 16) / (1 - packing) ** 2


def frequency(packing):
    """A disc's collisions in a time at kT = 1."""
    return 2 * math.sqrt(math.pi) * (4 * packing / math.pi) * contact_value(packing)


def enskog_viscosity(packing):
    """At kT = 1."""
    chi, bn = contact_value(packing), 2 * packing
    return 1.022 / (2 * math.sqrt(math.pi)) * (1 / chi + bn + 0.8729 * chi * bn ** 2)


def line_through(points):
    """Of (x, y, error): the least squares of y = a + b x, and the error of a."""
    weights = [1 / error ** 2 for _, _, error in points]
    s, sx, sxx, sy, sxy = (sum(w * x ** i * y ** j for w, (x, y, _) in zip(weights, points))
                           for i, j in ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1)))
    scale = s * sxx - sx * sx
    return (sxx * sy - sx * sxy) / scale, math.sqrt(sxx / scale)


def viscosity(program, is_short):
    """Rates go up to a sixth of the pressure over the viscosity, at which a thin gas thins by 8 %.

    Enskog's viscosity is an approximation: the limit is held to it with an error of 1 %.
    """
    count, kt = (500, 0.01) if is_short else (2000, 0.01)
    collisions = 1_500 if is_short else 4_000 # collisions per disc
    for packing in (0.3,) if is_short else (0.1, 0.2, 0.3, 0.4, 0.5):
        known = enskog_viscosity(packing)
        relaxation = (1 + 2 * packing * contact_value(packing)) * 4 * packing / math.pi / known
        often = frequency(packing) * math.sqrt(kt)
        steps = round(collisions / often)
        found = []
        for share in (0.08, 0.16) if is_short else (0.04, 0.08, 0.12, 0.16):
            rate = share * relaxation * math.sqrt(kt)
            report = run(program, SHEARED | EVENTS | {
                "box.size": box_of(count, packing), "discs.count": count, "discs.radius": 0.5,
                "discs.temperature": kt, "time.steps": steps,
                "discs.generator": '"lattice"' if packing > 0.45 else '"random"',
                # The thermostat acts twice in the time between a disc's collisions.
                "time.sync_every": max(1, 2 ** int(math.log2(0.5 / often))),
                "effects.shear.rate": rate, "effects.thermostat.kind": '"rescale"',
                "effects.thermostat.temperature": kt, "output.averages_from_step": steps // 20})
            stress, thermal = report["pressure_tensor"]["xy"], report["temperature"]["value"]
            unit = rate * math.sqrt(thermal)
            found.append((rate ** 2 / thermal, -stress["value"] / unit, stress["error"] / unit))
            yield {"packing": packing, "rate": math.sqrt(found[-1][0]),
                   "collisions": report["pair_collisions"], "viscosity": found[-1][1],
                   "viscosity_error": found[-1][2], "viscosity_known": "",
                   "viscosity_known_error": ""}
        limit, error = line_through(found)
        yield {"packing": packing, "rate": 0, "collisions": "", "viscosity": limit,
               "viscosity_error": error, "viscosity_known": known,
               "viscosity_known_error": 0.01 * known}


# Restitution: -xy / yy of the stress and its error, the rate over the frequency of collisions and
# its error, from Boltzmann's equation, which tests/physics/direct_shear.py solves. Errors are
# those of its averages and 0.05 % for its steps.
BOLTZMANN = {0.7: (0.5941, 0.0003, 0.6230, 0.0003), 0.8: (0.4727, 0.0003, 0.4888, 0.0003),
             0.9: (0.3265, 0.0002, 0.3301, 0.0002), 0.95: (0.2282, 0.0002, 0.2275, 0.0002)}


def granular(program, is_short):
    """A gas so thin that contacts carry a packing of the stress, 0.06 %, and twice that of nu.

    That much is allowed for beside errors. Grad's moments are the theory to first order in the
    anisotropy of velocities: they stand beside, because they are off by 1 to 5 %.
    """
    kt, packing, count = 0.01, 0.000625, 500 if is_short else 2000
    often = frequency(packing) * math.sqrt(kt)
    for e in (0.8,) if is_short else BOLTZMANN:
        # If collisions lose little energy, the temperature changes slowly, so averages take longer.
        collisions = 150 if is_short else 8_000 if e > 0.9 else 2_000
        steps = round(collisions / often)
        ratio, ratio_error, rate_over_nu, rate_error = BOLTZMANN[e]
        # The cooling rate and beta, over the rate nu of viscous relaxation.
        zeta, beta = (1 - e ** 2) / 2, (1 + e) / 2 * (1 - (1 - e) / 4)
        rate = rate_over_nu * often
        report = run(program, SHEARED | EVENTS | {
            "box.size": box_of(count, packing), "discs.count": count, "discs.radius": 0.5,
            "discs.speed": math.sqrt(2 * kt), "time.steps": steps, "time.sync_every": 1024,
            "effects.shear.rate": rate,
            "effects.contact.kind": '"restitution"', "effects.contact.restitution": e,
            "effects.contact.contact_time": 1e-9, "output.averages_from_step": steps // 5})
        tensor, thermal = report["pressure_tensor"], report["temperature"]
        over_nu = rate / (frequency(packing) * math.sqrt(thermal["value"]))
        yield {"restitution": e, "packing": packing, "collisions": report["pair_collisions"],
               "stress_ratio": -tensor["xy"]["value"] / tensor["yy"]["value"],
               "stress_ratio_error": tensor["xy"]["error"] / tensor["yy"]["value"],
               "stress_ratio_known": ratio,
               "stress_ratio_known_error": math.hypot(ratio_error, 2 * packing * ratio),
               "stress_ratio_grad": math.sqrt(zeta / beta), "rate_over_nu": over_nu,
               "rate_over_nu_error": over_nu * thermal["error"] / thermal["value"] / 2,
               "rate_over_nu_known": rate_over_nu,
               "rate_over_nu_known_error": math.hypot(rate_error, 2 * packing * rate_over_nu),
               "rate_over_nu_grad": math.sqrt(zeta / beta) * (beta + zeta)}


def cumulant(table):
    """a2 of a distribution of speeds in bins."""
    square = fourth = number = 0
    for low, high, count in zip(table["from"], table["to"], table["count"]):
        v2 = (low ** 2 + low * high + high ** 2) / 3 # its mean in the bin
        number, square, fourth = number + count, square + count * v2, fourth + count * v2 ** 2
    return fourth * number / (2 * square ** 2) - 1


def heated(program, is_short):
    """Kicks come eight times between two collisions of a disc, and samples are three apart."""
    kt, count = 0.01, 1000
    runs, samples = (4, 60) if is_short else (8, 150)
    for packing, e in [(0.0025, 0.7)] if is_short else [
            (p, e) for p in (0.0025, 0.02) for e in (0.7, 0.8, 0.9)]:
        often = frequency(packing) * math.sqrt(kt)
        a2 = 16 * (1 - e) * (1 - 2 * e * e) / (185 - 153 * e + 30 * (1 - e) * e * e)
        strength = (1 - e * e) * kt * often / 2 * (1 + 3 * a2 / 16)
        every = 8 * max(1, round(3 / often / 8))
        early = every * round(30 / often / every)
        found = []
        for seed in range(1, runs + 1):
            report = run(program, PERIODIC | EVENTS | {
                "box.size": box_of(count, packing), "discs.count": count, "discs.radius": 0.5,
                "discs.temperature": kt, "discs.seed": seed, "time.steps": early + samples * every,
                "time.sync_every": max(1, 2 ** int(math.log2(0.125 / often))),
                "effects.contact.kind": '"restitution"', "effects.contact.restitution": e,
                "effects.contact.contact_time": 1e-9, "effects.thermostat.kind": '"kicks"',
                "effects.thermostat.strength": strength, "effects.thermostat.seed": seed,
                "output.averages_from_step": early,
                "output.measurements.quantities": '["velocities"]',
                "output.measurements.bins": 1000,
                "output.measurements.largest_velocity": 8 * math.sqrt(kt),
                "output.measurements.every_steps": every,
                "output.measurements.from_step": early})
            found.append((report["temperature"]["value"] / kt,
                          cumulant(report["measurements"]["speeds"])))
        (ratio, ratio_error), (value, error) = map(literature.mean, zip(*found))
        # The theory is of first order in a2, and for a dilute gas.
        yield {"restitution": e, "packing": packing, "kT": ratio, "kT_error": ratio_error,
               "kT_known": 1.0, "kT_known_error": 0.003, "a2": value, "a2_error": error,
               "a2_known": a2, "a2_known_error": 0.0015}


def langevin(program, is_short):
    """Friction and collisions both end what a disc remembers of its velocity.

    So D = kT / (m (gamma + nu)) with the frequency nu of a disc's collisions, and kT / (m gamma)
    where these are rare. The first order of Enskog's theory is 2 % off without friction.
    """
    kt, gamma, count = 0.01, 0.01, 1000 if is_short else 2000
    window = 2_000 # 20 relaxation times of the velocity
    windows = 2 if is_short else 6
    for packing in (0.0001,) if is_short else (0.0001, 0.003, 0.01, 0.03):
        nu = frequency(packing) * math.sqrt(kt)
        found = []
        for seed in range(1, 9):
            report = run(program, PERIODIC | EVENTS | {
                "box.size": box_of(count, packing), "discs.count": count, "discs.radius": 0.5,
                "discs.temperature": kt, "discs.seed": seed,
                "time.steps": 400 + windows * window, "time.sync_every": 1,
                "effects.thermostat.kind": '"langevin"', "effects.thermostat.rate": gamma,
                "effects.thermostat.temperature": kt, "effects.thermostat.seed": seed,
                "output.measurements.quantities": '["diffusion"]',
                "output.measurements.every_steps": 100, "output.measurements.from_step": 400,
                "output.measurements.correlation_steps": window})
            found.append(report["measurements"]["diffusion"]["D"][0])
        value, error = literature.mean(found)
        yield {"packing": packing, "gamma_over_nu": gamma / nu,
               "D_over_friction_alone": value * gamma / kt, "D": value, "D_error": error,
               "D_known": kt / (gamma + nu),
               "D_known_error": 0.02 * kt / (gamma + nu) * nu / (gamma + nu)}


def places(program, is_short):
    """Andersen's and Langevin's discs are where discs without a thermostat are.

    `g_scatter` is the mean square of the differences of g(r) in units of their errors, which is 1
    if there are none: its standard error is the root of 2 over the number of bins.
    """
    kt, packing, count = 0.01, 0.4, 500 if is_short else 1000
    steps = 8_000 if is_short else 60_000
    tables = {}
    for kind in ("none", "andersen", "langevin"):
        thermostat = {} if kind == "none" else {
            "effects.thermostat.kind": f'"{kind}"', "effects.thermostat.rate": 0.05,
            "effects.thermostat.temperature": kt}
        report = run(program, PERIODIC | EVENTS | thermostat | {
            "box.size": box_of(count, packing), "discs.count": count, "discs.radius": 0.5,
            "discs.temperature": kt, "discs.seed": 1 + len(tables), "time.steps": steps,
            "time.sync_every": 8, "output.averages_from_step": 1_000,
            "output.measurements.quantities": '["radial_distribution"]',
            "output.measurements.every_steps": 100, "output.measurements.from_step": 1_000,
            "output.measurements.bins": 40, "output.measurements.largest_distance": 5})
        table = report["measurements"]["radial_distribution"]
        tables[kind] = list(zip(table["g"], table["g_error"]))
        if kind == "none":
            continue
        squares = [(g - plain) ** 2 / (error ** 2 + plain_error ** 2)
                   for (g, error), (plain, plain_error) in zip(tables[kind], tables["none"])
                   if error > 0 and plain_error > 0] # empty bins below contact have no error
        yield {"thermostat": kind, "packing": packing, "collisions": report["pair_collisions"],
               "kT": report["temperature"]["value"] / kt,
               "kT_error": report["temperature"]["error"] / kt,
               "kT_known": 1.0, "kT_known_error": 0.0, "g_largest": max(g for g, _ in tables[kind]),
               "g_scatter": statistics.fmean(squares),
               "g_scatter_error": math.sqrt(2 / len(squares)),
               "g_scatter_known": 1.0, "g_scatter_known_error": 0.0}


def parabola(points):
    """Coefficients of y = a + b x + c x^2, by least squares."""
    sums = [sum(x ** k for x, _ in points) for k in range(5)]
    right = [sum(y * x ** k for x, y in points) for k in range(3)]

    def determinant(m):
        return sum(m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] -
                              m[1][(k + 2) % 3] * m[2][(k + 1) % 3]) for k in range(3))
    matrix = [sums[k:k + 3] for k in range(3)]
    return [determinant([row[:k] + [value] + row[k + 1:] for row, value in zip(matrix, right)]) /
            determinant(matrix) for k in range(3)]


def viscosities_of(table, rows, size, flow, gravity):
    """A viscosity, kT and packing of the middle seven tenths, for each block of samples."""
    for first in range(0, len(table["y"]), rows):
        middle = [k for k in range(first, first + rows)
                  if abs(table["y"][k] - size / 2) < 0.35 * size]
        mean = {name: sum(table[name][k] for k in middle) / len(middle)
                for name in ("density", "temperature", "xy", "contact_xy")}
        _, slope, bend = parabola([(table["y"][k] - size / 2, table["vx"][k]) for k in middle])
        stress = mean["xy"] + mean["contact_xy"]
        value = -stress / slope if flow == "couette" else -mean["density"] * gravity / (2 * bend)
        yield value / math.sqrt(mean["temperature"]), mean["temperature"], mean["density"]


def channel(program, is_short):
    """Couette: stress over slope. Poiseuille: weight over curvature.

    Enskog's viscosity is held to 1.5 % beside the errors of the runs.
    """
    length, size, kt, rows = 120, 40, 0.01, 40
    samples, every = 200 if is_short else 400, 25
    for flow in ("couette", "poiseuille"):
        for packing in (0.2,) if is_short else (0.1, 0.2, 0.3):
            sliding, gravity = (0.05, 0) if flow == "couette" else (0, 5e-5)
            # The thinnest gas has the largest viscosity relative to its weight, so its profile is
            # the straightest.
            is_straight = flow == "poiseuille" and packing < 0.15
            blocks = 6 if is_short else 36 if is_straight else 12
            wall = {f"box.{side}.{key}": value for side, sign in (("bottom", -1), ("top", 1))
                    for key, value in (("kind", '"thermal"'), ("temperature", kt),
                                       ("velocity", sign * sliding))}
            report = run(program, PERIODIC | EVENTS | wall | {
                "box.size": f"[{length}, {size}]", "discs.radius": 0.5, "discs.temperature": kt,
                "discs.count": round(packing * length * size * 4 / math.pi),
                "time.steps": 6_000 + blocks * samples * every, "effects.gravity.x": gravity,
                "output.measurements.quantities": '["profiles"]',
                "output.measurements.every_steps": every, "output.measurements.from_step": 6_000,
                "output.measurements.profile_columns": 1, "output.measurements.profile_rows": rows,
                "output.measurements.profile_samples": samples})
            # The first block has one interval less, and the last may have one sample.
            table = report["measurements"]["profiles"]
            found = list(viscosities_of(table, rows, size, flow, gravity))[:blocks]
            (value, error), (thermal, _), (density, _) = map(literature.mean, zip(*found))
            known = enskog_viscosity(density * math.pi / 4)
            yield {"flow": flow, "packing": density * math.pi / 4, "kT_over_walls": thermal / kt,
                   "viscosity": value, "viscosity_error": error, "viscosity_known": known,
                   "viscosity_known_error": 0.015 * known}


def mean_radius_over_root_mean_square(kind, spread):
    """Its square; a normal distribution, and that of a logarithm, end after three deviations."""
    width = math.sqrt(3) if kind == "uniform" else 3
    log_spread = math.sqrt(math.log(1 + spread ** 2))
    sums = [0, 0, 0]
    for k in range(20_000):
        x = width * ((2 * k + 1) / 20_000 - 1)
        weight = 1 if kind == "uniform" else math.exp(-x * x / 2)
        radius = math.exp(log_spread * x) if kind == "lognormal" else 1 + spread * x
        sums = [total + weight * radius ** power for power, total in enumerate(sums)]
    return sums[1] ** 2 / (sums[0] * sums[2])


def sizes(program, is_short):
    """Z = share Z_1 + (1 - share) / (1 - packing), with Kolafa and Rottner's Z_1 of equal discs.

    The rule has the second virial coefficient exactly, and is an approximation beyond: it is given
    an error of 0.25 %. Equal discs in its place would be 2 % off at a packing of 0.5.
    """
    kt, count, collisions = 0.01, 500 if is_short else 2000, 200 if is_short else 1_500
    for kind, spread, packing in [("lognormal", 0.23, 0.5)] if is_short else [
            ("lognormal", 0.23, 0.1), ("lognormal", 0.23, 0.3), ("lognormal", 0.23, 0.5),
            ("lognormal", 0.23, 0.6), ("uniform", 0.3, 0.5), ("normal", 0.1, 0.6)]:
        steps = round(collisions / (frequency(packing) * math.sqrt(kt)))
        report = run(program, PERIODIC | EVENTS | {
            "box.size": box_of(count, packing), "discs.count": count, "discs.packing": packing,
            "discs.generator": '"compressed"' if packing > 0.45 else '"random"',
            "discs.radius.distribution": f'"{kind}"', "discs.radius.polydispersity": spread,
            "discs.temperature": kt, "time.steps": steps, "output.averages_from_step": steps // 10})
        found = report["compressibility"]
        share = mean_radius_over_root_mean_square(kind, spread)
        known = share * literature.factor_of(count, packing) + (1 - share) / (1 - packing)
        yield {"distribution": kind, "polydispersity": spread, "packing": packing,
               "collisions": report["pair_collisions"], "Z": found["value"],
               "Z_error": found["error"], "Z_known": known, "Z_known_error": 0.0025 * known}


# For each study: the function that makes the rows, and the largest relative errors that are allowed
# in a short and in the whole study.
STUDIES = {"viscosity": (viscosity, 0.05, 0.02), "granular": (granular, 0.05, 0.01),
           "heated": (heated, math.inf, math.inf), "langevin": (langevin, 0.05, 0.02),
           "places": (places, 0.5, 0.5), "channel": (channel, 0.2, 0.03),
           "sizes": (sizes, 0.02, 0.003)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
