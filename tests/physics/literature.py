#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold hard discs to the literature: prints a study as CSV.

  tests/physics/literature.py CARROM STUDY [--short]

pressure   Z of 4096 discs without walls, against Kolafa and Rottner, Mol. Phys. 104, 3435 (2006)
li         P* = beta P (2r)^2 of 870 discs, against Li and others, J. Chem. Phys. 157, 234111 (2022)
enskog     decay of the velocity autocorrelation, and D, over Enskog's
haff       granular gases that cool, against Haff's law
melting    P* and psi6 of 128^2 discs through melting, against Li and others
barostat   packing of 870 discs at constant P*, against Li and others and runs at constant volume
axes       sides of a strained crystal at constant P*, against those of a perfect one

The exit code is 1 where a number is further than four joint standard errors from what is known,
or less than four above or below a bound, or its own error is too large. Seeds are fixed, so a
study has the same digits each time. Core-hours go to standard error.
docs/tools/plot_literature.py draws the tables.
"""
import argparse
import json
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile

INPUTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "inputs")

# Kolafa and Rottner's equation for densities up to 0.90: powers of eta / (1 - eta). It agrees with
# their data to 1e-5 of Z, and with the virial series.
KOLAFA_ROTTNER = {
    0: 1.0, 1: 2.0, 2: 1.12801775, 3: 0.00181895291, 4: -0.0526134737, 5: 0.0504960168,
    6: -0.0325537792, 7: 0.0134578632, 8: 0.00140888182, 9: -0.00834273601, 10: 0.00694127367,
    11: -0.00262254723, 12: 0.000355746352, 22: -5.24672938e-9, 57: 5.88054639e-23}
KOLAFA_ROTTNER_ERROR = 1e-5

# Packing fraction: P* and its standard error, of 870 discs in a periodic square.
LI = {0.67: (7.986779, 0.000025), 0.68: (8.513249, 0.000037), 0.69: (8.969898, 0.000075)}
LI_REPLICAS = {0.67: 7, 0.68: 1, 0.69: 1}
# The same for 128^2 discs, and densities for which they give no value.
MELTING = {0.69: ("", ""), 0.698: (9.17405, 0.00049), 0.704: (9.18558, 0.00080),
           0.708: (9.17630, 0.00074), 0.712: (9.16554, 0.00090), 0.716: (9.1587, 0.0010),
           0.72: ("", ""), 0.73: ("", "")}


def factor(packing):
    """Z of an endless gas."""
    x = packing / (1 - packing)
    return sum(a * x ** i for i, a in KOLAFA_ROTTNER.items())


def factor_of(discs, packing):
    """Z of so many discs in a periodic box: docs/understanding/pressure.md has the term in 1/N."""
    h = 1e-4
    below, here, above = (x * factor(x) for x in (packing - h, packing, packing + h))
    slope, bend = (above - below) / (2 * h), (above - 2 * here + below) / h ** 2
    return factor(packing) - packing * bend / slope / (2 * discs)


def words_of(settings):
    """Options of the command line; in names of settings `__` is a dot."""
    return [word for name, value in settings.items()
            for word in ("--set", f"{name.replace('__', '.')}={value}")]


def run(program, scene, **settings):
    """The report of a run."""
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "report.json")
        command = [program, "run", os.path.join(INPUTS, scene), "--quiet", "--threads", "1",
                   "-o", os.path.join(folder, "run"), "--report", result, *words_of(settings)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(result, encoding="utf-8") as file:
            return json.load(file)


def run_many(program, scene, count, **settings):
    """What `count` replicas have together, with their collisions; as `run`."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "replicas", os.path.join(INPUTS, scene), "--quiet",
                   "--count", str(count), "-o", folder, *words_of(settings)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "replicas.json"), encoding="utf-8") as file:
            joined = json.load(file)
        reports = [os.path.join(folder, f"{k:04}", "report.json") for k in range(count)]
        joined["pair_collisions"] = 0
        for report in reports:
            with open(report, encoding="utf-8") as file:
                joined["pair_collisions"] += json.load(file)["pair_collisions"]
        return joined


def gas(program, discs, packing, early, steps, rate=1, count=1, **settings):
    """The report of discs of diameter 1 without walls, at `rate` collisions of each in a step.

    Of `count` replicas together, if there are several.

    `early` steps come before the averages begin. The frequency is 4 (Z - 1) sqrt(kT / pi).
    """
    speed = rate * math.sqrt(math.pi / 8) / (factor(min(packing, 0.7)) - 1)
    settings = {"box__size": math.sqrt(discs * math.pi / packing) / 2} | settings
    settings = {"discs__count": discs, "discs__packing": packing, "discs__speed": speed,
                "time__steps": early + steps, "output__averages_from_step": early} | settings
    if count > 1:
        return run_many(program, "dense_liquid.toml", count, **settings)
    return run(program, "dense_liquid.toml", **settings)


def pressure(program, is_short):
    """Errors of some 1e-4 of Z, and 1e-3 in a short study."""
    discs = 1024 if is_short else 4096
    for packing in (0.1, 0.3, 0.5) if is_short else (0.1, 0.2, 0.3, 0.4, 0.5, 0.6):
        steps = round(80_000 * packing) // (20 if is_short else 1)
        report = gas(program, discs, packing, 200 if is_short else 1000, steps)
        found = report["compressibility"]
        known = factor_of(discs, packing)
        yield {"packing": packing, "discs": discs, "collisions": report["pair_collisions"],
               "Z": found["value"], "Z_error": found["error"], "Z_known": known,
               "Z_known_error": KOLAFA_ROTTNER_ERROR * known, "Z_endless": factor(packing)}


def li(program, is_short):
    """A million collisions of each disc, in 0.05 core-hours a replica.

    Errors of 2e-4 take 14 replicas at 0.67, 31 at 0.68 and 130 at 0.69.
    """
    for packing, (known, known_error) in list(LI.items())[:1 if is_short else None]:
        early, steps, count = (300, 3_000, 1) if is_short else \
            (50_000, 1_000_000, LI_REPLICAS[packing])
        report = gas(program, 870, packing, early, steps, count=count)
        per_factor = 4 / math.pi * packing
        found = report["compressibility"]
        yield {"packing": packing, "discs": 870, "collisions": report["pair_collisions"],
               "P": per_factor * found["value"], "P_error": per_factor * found["error"],
               "P_known": known, "P_known_error": known_error}


def mean(values):
    """Mean and standard error of independent numbers."""
    return statistics.fmean(values), statistics.stdev(values) / math.sqrt(len(values))


def correlations(program, packing, rate, window, n_windows, seed):
    """The diffusion tables of 4096 discs, in windows of steps; the frequency, and kT."""
    early = round(20 / rate)
    report = gas(program, 4096, packing, early, window * n_windows, rate, discs__seed=seed,
                 output__measurements__quantities='["diffusion"]',
                 output__measurements__every_steps=1, output__measurements__from_step=early,
                 output__measurements__correlation_steps=window)
    kt = report["temperature"]["value"]
    frequency = 4 * (factor_of(4096, packing) - 1) * math.sqrt(kt / math.pi)
    return report["measurements"], frequency, kt


def first_decay(table, up_to=10):
    """-d ln C / dt at t = 0, C being the velocity autocorrelation: of a parabola through zero."""
    sums = [0.0] * 5
    for t, c in list(zip(table["steps"], table["velocities"]))[1:up_to + 1]:
        y = math.log(c / table["velocities"][0])
        # Each point has the weight 1 / t, because its squared error grows with t.
        for k, term in enumerate((t, t ** 2, t ** 3, y, y * t)):
            sums[k] += term
    m11, m12, m22, b1, b2 = sums
    return -(b1 * m22 - b2 * m12) / (m11 * m22 - m12 ** 2)


def enskog(program, is_short):
    """Collisions take 2kT/m from <v(0) v> = 2kT/m each: C decays by the frequency, at first.

    Enskog's D = kT / (m nu) follows if it goes on so, as in a thin gas (Erpenbeck and Wood, Phys.
    Rev. A 26, 1648 (1982)). Here D is that from 10 to 20 free times; in two dimensions it grows.
    """
    for packing in (0.02, 0.4) if is_short else (0.02, 0.1, 0.2, 0.3, 0.4, 0.5):
        decays, coefficients = [], []
        for seed in range(1, 5 if is_short else 9):
            near, frequency, kt = correlations(program, packing, 0.05, 10, 25 if is_short else 60,
                                               seed)
            decays.append(first_decay(near["velocity_autocorrelation"]) / frequency)
            far, frequency, kt = correlations(program, packing, 1, 20, 4 if is_short else 20, seed)
            coefficients.append(far["diffusion"]["D"][0] * frequency / kt)
        decay, decay_error = mean(decays)
        diffusion, diffusion_error = mean(coefficients)
        row = {"packing": packing, "decay": decay, "decay_error": decay_error, "decay_known": 1.0,
               "decay_known_error": 1 / 4096, "D": diffusion, "D_error": diffusion_error}
        yield row | ({"D_known": 1.0, "D_known_error": 0.02} if packing < 0.05 else
                     {"D_known": "", "D_known_error": ""})


def cooling(program, restitution, discs, every, seed):
    """Roots of kT(0) / kT, at each `every` steps to ten times that, over Haff's law."""
    loss = 1 - restitution ** 2
    kurtosis = (16 * (1 - restitution) * (1 - 2 * restitution ** 2) /
                (57 - 25 * restitution + 30 * restitution ** 2 * (1 - restitution)))
    thermo = run(program, "haff.toml", discs__count=discs, discs__seed=seed,
                 effects__contact__restitution=restitution, time__steps=10 * every,
                 box__size=math.sqrt(discs * math.pi / 0.1) / 2,
                 output__measurements__every_steps=every)["measurements"]["thermo"]
    start = thermo["temperature"][0]
    frequency = 4 * (factor_of(discs, 0.1) - 1) * math.sqrt(start / math.pi)
    rate = frequency * loss / 4 * (1 + 3 * kurtosis / 16) * discs / (discs - 1)
    return [math.sqrt(start / kt) / (1 + rate * step)
            for step, kt in zip(thermo["step"][1:], thermo["temperature"][1:])]


def haff(program, is_short):
    """kT = kT(0) (1 + t/t0)^-2 with 4/t0 = (1 - e^2) nu(0) (1 + 3 a/16).

    a is that of van Noije and Ernst, Granular Matter 1, 57 (1998). Boxes are too small for streams.
    The law leaves out that discs nearby come to move alike: 0.5 % is allowed for that.
    """
    for restitution, discs in ((0.98, 1024), (0.95, 400), (0.9, 200)):
        every = round(4 / (1 - restitution ** 2))
        gases = [cooling(program, restitution, discs, every, seed)
                 for seed in range(1, 9 if is_short else 65)]
        for k, ratios in enumerate(zip(*gases), 1):
            ratio, error = mean(ratios)
            yield {"restitution": restitution, "discs": discs, "step": k * every,
                   "time": k, "ratio": ratio, "ratio_error": error, "ratio_known": 1.0,
                   "ratio_known_error": 0.005}


def melting(program, is_short):
    """From a crystal, with 120,000 collisions of each disc: 0.2 core-hours a density."""
    known = {0.68: LI[0.68], 0.73: ("", "")} if is_short else MELTING
    discs, steps = (1024, 900) if is_short else (128 ** 2, 80_000)
    for packing, (pressure_known, known_error) in known.items():
        spacing = math.sqrt(math.pi / (2 * math.sqrt(3) * packing)) # lattice spacing for diameter 1
        width = math.sqrt(discs) * spacing
        report = gas(program, discs, packing, steps // 2, steps, discs__generator="triangular",
                     box__size=f"[{width!r}, {width * math.sqrt(3) / 2!r}]",
                     output__measurements__quantities='["psi6"]',
                     output__measurements__every_steps=steps // 20,
                     output__measurements__from_step=steps // 2)
        found, order = report["compressibility"], report["measurements"]["psi6"]
        per_factor = 4 / math.pi * packing
        yield {"packing": packing, "discs": discs, "collisions": report["pair_collisions"],
               "P": per_factor * found["value"], "P_error": per_factor * found["error"],
               "P_known": pressure_known, "P_known_error": known_error,
               "psi6": order["psi6"][0], "psi6_error": order["psi6_error"][0]}


def compressibility_of(packing, step=1e-4):
    """kT kappa / (2r)^2 = dln(eta) / dP* of the equation of state."""
    def pressure_at(x):
        return 4 / math.pi * x * factor(x)
    return 2 * step / packing / (pressure_at(packing + step) - pressure_at(packing - step))


def at_pressure(program, packing, known, is_short, **settings):
    """870 discs at a P*, with five moves in the time in which each collides; of several seeds."""
    pressure, phase = settings.pop("pressure"), settings.pop("phase")
    early, steps = (500, 3_000) if is_short else (15_000, 150_000)
    found = {"packing": [], "volume": [], "compressibility": [], "Z": []}
    for seed in settings.pop("seeds", (4321,)):
        report = gas(program, 870, packing, early, steps, rate=0.2, effects__barostat__seed=seed,
                     effects__barostat__pressure=pressure,
                     output__measurements__quantities='["volume"]',
                     output__measurements__every_steps=5, output__measurements__from_step=early,
                     **settings)
        table, z = report["measurements"]["volume"], report["compressibility"]
        for name in ("packing", "volume", "compressibility"):
            found[name].append((table[name][0], table[f"{name}_error"][0]))
        found["Z"].append((z["value"], z["error"]))

    def joined(name):
        n = len(found[name])
        return (sum(value for value, _ in found[name]) / n,
                math.hypot(*(error for _, error in found[name])) / n)

    row = {"phase": phase, "P": pressure, "discs": 870, "runs": len(found["Z"])}
    for name in ("packing", "compressibility"):
        row[name], row[f"{name}_error"] = joined(name)
        row[f"{name}_known"], row[f"{name}_known_error"] = known.get(name, ("", ""))
    # The mean virial is p <V> - kT. Z is this virial per disc and kT; `volume` is <V> per disc.
    row["Z"], row["Z_error"] = joined("Z")
    volume, error = joined("volume")
    return row | {"Z_known": pressure * volume - 1 / 870,
                  "Z_known_error": pressure * error + 1e-4 * row["Z"]}


def liquid_at_pressure(program, packing, is_short):
    """At the P* of Li and others; means differ from the most likely volume by 1e-4 of it."""
    kappa = compressibility_of(packing)
    known = {"packing": (packing, 1e-4 * packing)}
    if not is_short: # a short run has only a part of the fluctuations
        known["compressibility"] = (kappa, 0.02 * kappa)
    return at_pressure(program, packing, known, is_short, pressure=LI[packing][0], phase="liquid",
                       seeds=(4321, 1, 2, 3))


def solid_at_pressure(program, packing, is_short):
    """At the P* of a run at constant volume."""
    spacing = math.sqrt(math.pi / (2 * math.sqrt(3) * packing))
    lattice = {"discs__generator": "triangular",
               "box__size": f"[{29 * spacing!r}, {30 * spacing * math.sqrt(3) / 2!r}]"}
    early, steps = (500, 3_000) if is_short else (5_000, 40_000)
    found = gas(program, 870, packing, early, steps, **lattice)["compressibility"]
    per_factor = 4 / math.pi * packing
    slope = 70 # dP* / d(packing), which is 72 on average from 0.73 to 0.75
    known = {"packing": (packing, per_factor * found["error"] / slope + 1e-4 * packing)}
    return at_pressure(program, packing, known, is_short, pressure=per_factor * found["value"],
                       phase="solid", **lattice)


def barostat(program, is_short):
    """Packing, compressibility and virial on both sides of freezing."""
    for packing in (0.67, 0.69)[:1 if is_short else None]:
        yield liquid_at_pressure(program, packing, is_short)
    for packing in (0.73, 0.75)[:1 if is_short else None]:
        yield solid_at_pressure(program, packing, is_short)


def axes(program, is_short):
    """Ratio of the sides and of the pressures along them, of 16 rows of 16 discs that begin 5 % too
    low. Rows of a perfect crystal are sqrt(3) / 2 of a spacing apart.
    """
    early, steps = (2_000, 8_000) if is_short else (10_000, 100_000)
    for pressure in (12, 10, 15)[:1 if is_short else None]:
        report = run(program, "each_axis.toml", effects__barostat__pressure=pressure,
                     time__steps=early + steps, output__averages_from_step=early,
                     output__measurements__quantities='["volume"]',
                     output__measurements__from_step=early)
        table, tensor = report["measurements"]["volume"], report["pressure_tensor"]
        xx, yy = tensor["xx"], tensor["yy"]
        yield {"P": pressure, "discs": 256, "collisions": report["pair_collisions"],
               "packing": table["packing"][0], "packing_error": table["packing_error"][0],
               "ratio": table["ratio"][0], "ratio_error": table["ratio_error"][0],
               "ratio_known": 2 / math.sqrt(3), "ratio_known_error": 1e-4,
               "tensor": xx["value"] / yy["value"],
               "tensor_error": math.hypot(xx["error"] / xx["value"], yy["error"] / yy["value"]),
               "tensor_known": 1, "tensor_known_error": 0}


# For each study: the function that makes the rows, and the largest relative errors that are allowed
# in a short and in the whole study.
STUDIES = {"pressure": (pressure, 2e-3, 1.5e-4), "li": (li, 2e-3, 3e-4),
           "enskog": (enskog, 0.02, 0.01), "haff": (haff, 0.02, 0.005),
           "melting": (melting, 5e-3, 2e-3), "barostat": (barostat, 0.5, 0.2),
           "axes": (axes, 0.03, 0.01)}


def is_right(row, largest_error):
    """Whether numbers are within four joint standard errors of what is known, with small ones, and
    four of their own above or below their bounds."""
    def is_number_right(name):
        value, error = row[name], row.get(f"{name}_error")
        known, above, below = (row.get(f"{name}_{kind}", "") for kind in
                               ("known", "above", "below"))
        return ((known == "" or error <= largest_error * abs(known) and
                 abs(value - known) <= 4 * math.hypot(error, row[f"{name}_known_error"])) and
                (above == "" or value - 4 * error > above) and
                (below == "" or value + 4 * error < below))

    return all(is_number_right(name) for name in row)


def main(description, studies):
    """Print a study line by line."""
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("carrom")
    parser.add_argument("study", choices=studies)
    parser.add_argument("--short", action="store_true")
    options = parser.parse_args()
    study, largest_of_short, largest = studies[options.study]
    is_all_right = True
    for count, row in enumerate(study(options.carrom, options.short)):
        if count == 0:
            print(",".join(row))
        print(",".join(f"{value:.7g}" if isinstance(value, float) else str(value)
                       for value in row.values()), flush=True)
        is_all_right &= is_right(row, largest_of_short if options.short else largest)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    print(f"{seconds / 3600:.5f} core-hours", file=sys.stderr)
    sys.exit(0 if is_all_right else 1)


if __name__ == "__main__":
    main(__doc__, STUDIES)
