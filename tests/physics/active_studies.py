#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold active discs to exact results: prints a study as CSV.

  tests/physics/active_studies.py CARROM STUDY [--short]

free        mean square displacements and diffusion of discs that do not meet, with rotational
            diffusion, with tumbles and with both, against the exact ones, inertia included
swim        the pressure of active discs on walls, against the exact one of discs that do not meet
separation  how much densities differ from place to place on both sides of the critical point of
            active Brownian discs
coexistence packings of the gas and of the dense phase beside it, from two mean packings

Citations: Cates and Tailleur, EPL 101, 20010 (2013), for diffusion by turns and tumbles; Takatori,
Yan and Brady, Phys. Rev. Lett. 113, 028103 (2014), and Solon and others, Phys. Rev. Lett. 114,
198301 (2015), for the swim pressure; Siebert and others, Phys. Rev. E 98, 030601 (2018), for the
critical point at the Peclet number 40(2) and the packing 0.597(3), of discs that repel each other
softly; Redner, Hagan and Baskaran, Phys. Rev. Lett. 110, 055701 (2013), for phases whose packings
depend on the activity alone.

Discs have the mass 1. Exit codes and errors are those of tests/physics/literature.py: a number is
held to four joint standard errors.
"""
import cmath
import collections
import math
import statistics

import literature
from driven_studies import EVENTS, PERIODIC, box_of, run

CELLS, CELL = (24, 6), 6 # cells of a band's box, and their side
CRITICAL = 0.597 # packing of the critical point
BETWEEN = 2 # variance over mean of homogeneous discs and of two phases
LANGEVIN = {"effects.thermostat.kind": '"langevin"'}
ALONG_Y = {f"box.{side}.kind": '"periodic"' for side in ("bottom", "top")}
IDEAL = {"effects.contact.kind": '"none"'}


def square_displacement(time, kt, gamma, speed, memory):
    """Exact: the mean of v(0) v(t) is 2 kT exp(-gamma t), and for the active part
    u^2 gamma^2 / (gamma^2 - b^2) (exp(-b t) - b / gamma exp(-gamma t)) with the rate b at which
    directions are forgotten."""
    def twice_integrated(rate):
        return 2 * (time / rate - (1 - math.exp(-rate * time)) / rate ** 2)
    active = speed ** 2 * gamma ** 2 / (gamma ** 2 - memory ** 2)
    return (2 * kt - active * memory / gamma) * twice_integrated(gamma) + \
        active * twice_integrated(memory)


def free(program, is_short):
    """Directions that stay between syncs make D too large by (b t)^2 / 12 and (gamma t)^2 / 12.

    That is below 0.1 % here, and 0.2 % are allowed for at short lags, where the time from a sync
    to the next one counts.
    """
    kt, gamma, speed, count = 0.001, 0.1, 0.1, 500 if is_short else 2000
    window, windows = 400, 2 if is_short else 5
    lags = (20, 100, 400)
    for diffusion, tumbles in ((0.03, 0),) if is_short else ((0.03, 0), (0, 0.03), (0.02, 0.01)):
        memory = diffusion + tumbles
        found = []
        for seed in range(1, 9):
            report = run(program, PERIODIC | EVENTS | LANGEVIN | IDEAL | {
                "box.size": 100, "discs.count": count, "discs.radius": 0.5,
                "discs.temperature": kt, "discs.seed": seed,
                "time.steps": 200 + windows * window, "time.sync_every": 1,
                "effects.thermostat.rate": gamma, "effects.thermostat.temperature": kt,
                "effects.thermostat.seed": seed, "effects.activity.speed": speed,
                "effects.activity.rotational_diffusion": diffusion,
                "effects.activity.tumble_rate": tumbles, "effects.activity.seed": seed,
                "output.measurements.quantities": '["diffusion"]',
                "output.measurements.every_steps": 20, "output.measurements.from_step": 200,
                "output.measurements.correlation_steps": window})
            table = report["measurements"]["velocity_autocorrelation"]
            found.append([table["squares"][table["steps"].index(lag)] for lag in lags] +
                         [report["measurements"]["diffusion"]["D"][0]])
        row = {"rotational_diffusion": diffusion, "tumble_rate": tumbles}
        known = [square_displacement(lag, kt, gamma, speed, memory) for lag in lags]
        half = square_displacement(window // 2, kt, gamma, speed, memory)
        known.append((known[-1] - half) / (4 * (window - window // 2)))
        for name, right, values in zip([f"msd_{lag}" for lag in lags] + ["D"], known, zip(*found)):
            row[name], row[f"{name}_error"] = literature.mean(values)
            row[f"{name}_known"], row[f"{name}_known_error"] = right, 0.002 * right
        row["D_of_long_times"] = kt / gamma + speed ** 2 / (2 * memory)
        yield row


def swim(program, is_short):
    """P = n (kT + m gamma u^2 / (2 b)) with the density n far from walls, whatever the inertia.

    Discs wait at the two walls, so n is smaller than the mean. They do not meet: this is the limit
    of low density. The box is 16 run lengths wide, and averages begin when its profile has settled.
    """
    kt, gamma, speed, memory = 0.001, 0.1, 0.1, 0.04
    count, steps = (500, 4_000) if is_short else (2000, 10_000)
    ideal = kt + gamma * speed ** 2 / (2 * memory)
    for diffusion, tumbles in ((memory, 0),) if is_short else ((memory, 0), (0, memory)):
        found = []
        for seed in range(1, 9):
            report = run(program, ALONG_Y | EVENTS | LANGEVIN | IDEAL | {
                "box.size": 40, "discs.count": count, "discs.radius": 0.01,
                "discs.temperature": kt, "discs.seed": seed, "time.steps": steps,
                "time.sync_every": 1, "effects.thermostat.rate": gamma,
                "effects.thermostat.temperature": kt, "effects.thermostat.seed": seed,
                "effects.activity.speed": speed,
                "effects.activity.rotational_diffusion": diffusion,
                "effects.activity.tumble_rate": tumbles, "effects.activity.seed": seed,
                "output.measurements.quantities": '["wall_pressure", "density"]',
                "output.measurements.every_steps": 20, "output.measurements.from_step": steps // 2,
                "output.measurements.bins": 20})
            tables = report["measurements"]
            pressure = statistics.fmean(tables["wall_pressure"][side][0]
                                        for side in ("left", "right"))
            density = tables["density_x"]["density"]
            found.append((pressure / (statistics.fmean(density[5:15]) * ideal),
                          pressure / (statistics.fmean(density) * ideal)))
        (share, error), (of_mean, _) = map(literature.mean, zip(*found))
        yield {"rotational_diffusion": diffusion, "tumble_rate": tumbles,
               "kT_over_ideal": kt / ideal, "over_mean_density": of_mean, "share": share,
               "share_error": error, "share_known": 1.0, "share_known_error": 0.004}


def separation(program, is_short):
    """The variance of the number of discs in a cell of 8 diameters, over its mean.

    It is the compressibility of a homogeneous fluid, of the order of 1 below the critical point,
    and grows with the phases beyond it.
    """
    count, packing = 1000 if is_short else 2000, 0.6
    turns = 8 if is_short else 30
    size = box_of(count, packing)
    cells = round(size / 8)
    for peclet in (20, 120):
        diffusion, gamma = 1e-3, 0.25
        thermal = diffusion / 3 # diffusion of positions: D / 3, as for a sphere
        report = run(program, PERIODIC | EVENTS | LANGEVIN | {
            "box.size": size, "discs.count": count, "discs.radius": 0.5,
            "discs.generator": '"lattice"', "discs.temperature": gamma * thermal,
            "time.steps": round(turns / diffusion), "time.sync_every": 1,
            "effects.thermostat.rate": gamma, "effects.thermostat.temperature": gamma * thermal,
            "effects.activity.speed": peclet * thermal,
            "effects.activity.rotational_diffusion": diffusion,
            "output.measurements.quantities": '["profiles"]',
            "output.measurements.every_steps": 100,
            "output.measurements.from_step": round(turns / 2 / diffusion),
            "output.measurements.profile_columns": cells, "output.measurements.profile_rows": cells,
            "output.measurements.profile_samples": 1})
        table = report["measurements"]["profiles"]
        counts = table["count"]
        blocks = [statistics.pvariance(counts[k:k + cells ** 2])
                  for k in range(0, len(counts) - cells ** 2 + 1, cells ** 2)]
        yield {"peclet": peclet, "packing": packing, "collisions": report["pair_collisions"],
               "variance_over_mean": statistics.fmean(blocks) / statistics.fmean(counts),
               "variance_over_mean_error": 0.0,
               "variance_over_mean_below": BETWEEN if peclet < 40 else "",
               "variance_over_mean_above": BETWEEN if peclet > 40 else ""}


def band(program, peclet, packing, steps, seed=1):
    """Packings of cells of a long box, one list for each sample, row by row. Discs begin as a dense
    band across it, with the rest around them."""
    length, width = (CELL * count for count in CELLS)
    dense, gas, diffusion, gamma = 0.8, 0.25, 1e-3, 0.25
    share = (packing - gas) / (dense - gas)
    edges = [length * (1 - share) / 2, 0, length * (1 + share) / 2, width]
    thermal = diffusion / 3
    groups = [f'{{packing = {dense}, generator = "lattice", region = {edges}}}',
              f"{{count = {round(gas * (1 - share) * length * width * 4 / math.pi)}}}"]
    report = run(program, PERIODIC | EVENTS | LANGEVIN | {
        "box.size": [length, width], "discs.radius": 0.5, "discs.groups": f"[{', '.join(groups)}]",
        "discs.temperature": gamma * thermal, "discs.seed": seed, "time.steps": steps,
        "time.sync_every": 1, "effects.thermostat.rate": gamma,
        "effects.thermostat.temperature": gamma * thermal, "effects.thermostat.seed": seed,
        "effects.activity.speed": peclet * thermal, "effects.activity.seed": seed,
        "effects.activity.rotational_diffusion": diffusion,
        "output.measurements.quantities": '["profiles"]', "output.measurements.every_steps": 100,
        "output.measurements.from_step": steps // 3,
        "output.measurements.profile_columns": CELLS[0],
        "output.measurements.profile_rows": CELLS[1], "output.measurements.profile_samples": 1})
    table, n_cells = report["measurements"]["profiles"], CELLS[0] * CELLS[1]
    packings = [count * math.pi / 4 / CELL ** 2 for count in table["count"]]
    return [packings[k:k + n_cells] for k in range(0, len(packings) - n_cells + 1, n_cells)]


def gas_beside(sample):
    """The mean packing of the quarter of the box that is furthest from the band's middle."""
    columns = [statistics.fmean(sample[k::CELLS[0]]) for k in range(CELLS[0])]
    mode = sum(value * cmath.exp(2j * math.pi * k / CELLS[0]) for k, value in enumerate(columns))
    opposite = round(cmath.phase(mode) / (2 * math.pi) * CELLS[0]) + CELLS[0] // 2
    far = CELLS[0] // 8
    return statistics.fmean(columns[(opposite + k) % CELLS[0]] for k in range(-far, far))


def upper_peak(packings, wide=0.03):
    """Where the histogram of cells is highest among dense ones: gas comes and goes within a band,
    so that the mean of its cells is less."""
    dense = [value for value in packings if value > CRITICAL]
    counts = collections.Counter(round(value / wide) for value in dense)
    peak = wide * max(counts, key=counts.get)
    return statistics.fmean(value for value in dense if abs(value - peak) < 2.5 * wide)


def phases_of(samples):
    return (statistics.fmean(map(gas_beside, samples)),
            upper_peak([value for sample in samples for value in sample]))


def coexistence(program, is_short):
    """From the second mean packing the band is wider, and both phases have to be those of the
    first. A third of each run comes before averages. Errors are from the scatter of quarters."""
    steps = 1_500 if is_short else 30_000
    first = {}
    for packing in (0.4, 0.55):
        samples = band(program, 100, packing, steps)
        quarters = [phases_of(samples[k * len(samples) // 4:(k + 1) * len(samples) // 4])
                    for k in range(4)]
        row = {"peclet": 100, "packing": packing, "steps": steps}
        for name, value, parts in zip(("gas", "dense"), phases_of(samples), zip(*quarters)):
            row[name], row[f"{name}_error"] = value, literature.mean(parts)[1]
            row[f"{name}_known"], row[f"{name}_known_error"] = first.get(name, ("", ""))
        if not is_short: # short runs remember how they began
            first = {name: (row[name], row[f"{name}_error"]) for name in ("gas", "dense")}
        yield row | {"gas_below": CRITICAL, "dense_above": CRITICAL}


# For each study: the function that makes the rows, and the largest relative errors that are allowed
# in a short and in the whole study.
STUDIES = {"free": (free, 0.05, 0.01), "swim": (swim, 0.05, 0.02),
           "separation": (separation, math.inf, math.inf),
           "coexistence": (coexistence, math.inf, 0.2)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
