#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold fields and transport of hard discs to the literature: prints a study as CSV.

  tests/physics/flow_studies.py CARROM STUDY [--short]

shock      a piston drives a shock; the gas behind it, against Rankine and Hugoniot's jumps with
           Henderson's equation of state
fronts     the speed of the front of weak and strong shocks in a long box, against these jumps
transport  viscosities and thermal conductivity in periodic boxes, against Enskog (Gass, J.
           Chem. Phys. 54, 1898 (1971))
windows    the same over Enskog's, as means over all packings, by the lags that they are read from;
           with seeds other than those that have chosen the lags
dense      ratios to Enskog's near freezing, diffusion too: the viscosity rises, diffusion drops
           (Garcia-Rojo, Luding and Brey, Phys. Rev. E 74, 061305 (2006)). The viscosity is in
           proportion to 1 / (0.7 - packing) there (Otsuki, Hayakawa and Luding, arXiv:1002.0618)
conduction a gas between walls of two temperatures: the heat that the walls give, and that of
           profiles, against Enskog's conductivity times the slope of the temperature

Exit codes and errors are those of tests/physics/literature.py.
"""
import math
import statistics

import literature

PISTON_SPEED = 1.5
LENGTH, WIDTH = 400, 50


def henderson(packing):
    """Z."""
    return (1 + packing ** 2 / 8) / (1 - packing) ** 2


def behind_shock(density, kt, radius, speed):
    """Density, kT, pressure and the shock's speed, from the jumps of mass, momentum and energy."""
    def pressure(n, t):
        return n * t * henderson(n * math.pi * radius ** 2)

    def state(shock):
        n = density * shock / (shock - speed)
        p = pressure(density, kt) + density * shock * speed
        t = kt + (pressure(density, kt) + p) / 2 * (1 / density - 1 / n)
        return n, t, p

    low, high = speed * 1.05, speed * 10
    for _ in range(200):
        shock = (low + high) / 2
        n, t, p = state(shock)
        # A shock that is too slow would need a gas so dense that its pressure exceeds the pressure
        # behind the jump.
        low, high = (shock, high) if pressure(n, t) > p else (low, shock)
    return *state(shock), shock


def shock(program, is_short):
    """A wall comes in at 1.5 into a gas with kT = 0.5, at a packing of 0.1."""
    discs = 8_000 if is_short else 40_000
    for seed in (1,) if is_short else (1, 2, 3):
        radius = math.sqrt(0.1 * LENGTH * WIDTH / (discs * math.pi))
        report = literature.run(
            program, "piston.toml", box__size=f"[{LENGTH}, {WIDTH}]", discs__count=discs,
            discs__seed=seed, box__right__speed=-PISTON_SPEED, time__steps=120,
            output__measurements__quantities='["profiles"]', output__measurements__every_steps=1,
            output__measurements__from_step=101, output__measurements__profile_columns=100,
            output__measurements__profile_rows=1, output__measurements__profile_samples=20)
        table = report["measurements"]["profiles"]
        n, kt, p, front = behind_shock(discs / (LENGTH * WIDTH), 0.5, radius, PISTON_SPEED)
        first, last = 101, 120 # the samples of the block
        inside = [k for k, x in enumerate(table["x"])
                  if LENGTH - front * first + 10 < x < LENGTH - PISTON_SPEED * last - 5]
        def mean(column):
            return sum(table[column][k] for k in inside) / len(inside)
        # Momentum flux about the mean, and the collisions' part.
        pressure = mean("xx") + mean("contact_xx")
        # Counts fluctuate less than those of an ideal gas; samples are not independent.
        error = 1 / math.sqrt(mean("count") * len(inside) / (last - first + 1))
        yield {"discs": discs, "seed": seed, "cells": len(inside), "shock_speed": front,
               "density": mean("density"), "density_error": error * mean("density"),
               "density_known": n, "density_known_error": 0.0,
               "kT": mean("temperature"), "kT_error": error * kt, "kT_known": kt,
               "kT_known_error": 0.0,
               "vx": -mean("vx"), "vx_error": error * math.sqrt(kt),
               "vx_known": PISTON_SPEED, "vx_known_error": 0.0,
               "P": pressure, "P_error": 2 * error * p, "P_known": p, "P_known_error": 0.0}


def half_way(table, step, half):
    """Where the density of a block, as a mean over five strips, first rises to `half`."""
    rows = [k for k, at in enumerate(table["to_step"]) if at == step]
    x, density = ([table[name][k] for k in rows] for name in ("x", "density"))
    smooth = [statistics.fmean(density[k - 2:k + 3]) for k in range(2, len(rows) - 2)]
    first = next(k for k, value in enumerate(smooth) if value > half)
    share = (half - smooth[first - 1]) / (smooth[first] - smooth[first - 1])
    return x[first + 1] + share * (x[first + 2] - x[first + 1])


def fronts(program, is_short):
    """A slope over blocks of ten steps, after the first ten of them and before the far wall.

    Between the walls beside it the gas is up to 1 % denser than on average, because centres keep a
    radius away from them. So the jumps are known to 0.5 %.
    """
    length, discs = 4 * LENGTH, 32_000
    radius = math.sqrt(0.1 * length * WIDTH / (discs * math.pi))
    for speed in (0.5,) if is_short else (0.5, 0.8, 1.5):
        density, _, _, front = behind_shock(discs / (length * WIDTH), 0.5, radius, speed)
        half = (density + discs / (length * WIDTH)) / 2
        steps = 10 * int(0.9 * length / front / 10)
        found = []
        for seed in range(1, 3 if is_short else 5):
            report = literature.run(
                program, "piston.toml", box__size=f"[{length}, {WIDTH}]", discs__count=discs,
                discs__seed=seed, box__right__speed=-speed, time__steps=steps,
                output__measurements__quantities='["profiles"]',
                output__measurements__every_steps=1, output__measurements__from_step=1,
                output__measurements__profile_columns=400,
                output__measurements__profile_rows=1, output__measurements__profile_samples=10)
            blocks = range(110, steps + 1, 10)
            places = [half_way(report["measurements"]["profiles"], step, half) for step in blocks]
            found.append(-statistics.linear_regression(blocks, places).slope)
        value, error = literature.mean(found)
        yield {"speed": speed, "discs": discs, "seeds": len(found), "steps": steps, "front": value,
               "front_error": error, "front_known": front, "front_known_error": 0.005 * front}


def enskog(packing, kt):
    """Shear and bulk viscosity and conductivity of discs of diameter 1 and mass 1."""
    chi = (literature.factor(packing) - 1) / (2 * packing)
    x = 2 * packing
    shear, heat = 0.511 * math.sqrt(kt / math.pi), 2.058 * math.sqrt(kt / math.pi)
    return (shear * (1 / chi + x + 0.8729 * chi * x ** 2), 1.246 * shear * chi * x ** 2,
            heat * (1 / chi + 1.5 * x + 0.8718 * chi * x ** 2))


def between(table, name, first, last):
    """The coefficient from the spread's growth between two lags, and its error."""
    at = [table["steps"].index(lag) for lag in (first, last)]
    value, error, time = ([table[column][k] for k in at] for column in
                          (name, f"{name}_error", "steps"))
    span = time[1] - time[0]
    return ((value[1] * time[1] - value[0] * time[0]) / span,
            math.hypot(error[1] * time[1], error[0] * time[0]) / span)


PACKINGS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
LAGS = {"shear": (4, 16), "bulk": (8, 32), "conductivity": (8, 32)}


def coefficients(program, packing, seed, discs, steps, lags):
    """Each coefficient and its error over Enskog's, and Enskog's."""
    report = literature.gas(program, discs, packing, 100, steps, discs__seed=seed,
                            output__measurements__quantities='["transport"]',
                            output__measurements__every_steps=1,
                            output__measurements__from_step=100)
    scale = math.sqrt(report["temperature"]["value"])
    table = report["measurements"]["transport"]
    return {name: (*(x / (scale * known) for x in between(table, name, *lags[name])), known)
            for name, known in zip(LAGS, enskog(packing, 1))}


def transport(program, is_short):
    """Shear from 4 to 16 free times; bulk and heat from 8 to 32: their currents live longer."""
    discs, steps, seeds = (256, 12_000, 1) if is_short else (400, 30_000, 4)
    for packing in (0.1, 0.3) if is_short else PACKINGS:
        found = [coefficients(program, packing, seed, discs, steps, LAGS)
                 for seed in range(1, seeds + 1)]
        row = {"packing": packing, "discs": discs, "seeds": seeds, "steps": steps}
        for name in LAGS:
            value, error, known = zip(*(each[name] for each in found))
            row |= {name: statistics.fmean(value) * known[0],
                    f"{name}_error": math.hypot(*error) / seeds * known[0],
                    f"{name}_known": known[0], f"{name}_known_error": 0.03 * known[0]}
        yield row


def windows(program, is_short):
    """Those that `transport` reads are held to Enskog's; the others show how far lags matter."""
    discs, steps, seeds = (256, 6_000, (11,)) if is_short else (400, 30_000, (11, 12, 13, 14))
    packings = (0.1, 0.3) if is_short else PACKINGS
    for lags in ((8, 32),) if is_short else ((4, 16), (8, 32), (16, 64)):
        found = [coefficients(program, packing, seed, discs, steps, dict.fromkeys(LAGS, lags))
                 for packing in packings for seed in seeds]
        row = {"first": lags[0], "last": lags[1], "discs": discs, "runs": len(found)}
        for name, read in LAGS.items():
            value, error, _ = zip(*(each[name] for each in found))
            row |= {name: statistics.fmean(value), f"{name}_error": math.hypot(*error) / len(found),
                    f"{name}_known": 1.0 if lags == read else "",
                    f"{name}_known_error": 0.03 if lags == read else ""}
        yield row


# Bounds on ratios to Enskog's, by packing: more than, or less than, by four standard errors.
DENSE = {0.55: {}, 0.6: {}, 0.65: {"shear_above": 1.2, "diffusion_below": 1.15},
         0.68: {"shear_above": 1.7, "diffusion_below": 0.85}}
DENSE_LAGS = {"shear": (64, 256), "bulk": (16, 64), "conductivity": (16, 64),
              "diffusion": (64, 256)}


def near_freezing(program, packing, seed, discs, steps, lags):
    """Ratios to Enskog's and their errors."""
    report = literature.gas(program, discs, packing, 2_000, steps, discs__seed=seed,
                            output__measurements__quantities='["transport", "correlations"]',
                            output__measurements__every_steps=4,
                            output__measurements__from_step=2_000)
    scale = math.sqrt(report["temperature"]["value"])
    tables = report["measurements"]
    known = dict(zip(LAGS, enskog(packing, 1)))
    # The second approximation of Sonine's series is 1.027 times kT over the frequency.
    known["diffusion"] = 1.027 * math.sqrt(math.pi) / (4 * (literature.factor(packing) - 1))
    return {name: [x / (scale * known[name]) for x in
                   between(tables["correlations" if name == "diffusion" else "transport"], name,
                           *lags[name])]
            for name in lags}


def dense(program, is_short):
    """Stress lives for some hundred collisions of a disc there, so lags are longer."""
    discs, steps, seeds = (256, 10_000, 1) if is_short else (400, 150_000, 4)
    lags = dict.fromkeys(DENSE_LAGS, (16, 64)) if is_short else DENSE_LAGS
    shear = []
    for packing, bounds in {0.68: {"shear_above": 1.0}}.items() if is_short else DENSE.items():
        found = [near_freezing(program, packing, seed, discs, steps, lags)
                 for seed in range(1, seeds + 1)]
        row = {"packing": packing, "discs": discs, "seeds": seeds, "steps": steps}
        for name in lags:
            value, error = zip(*(each[name] for each in found))
            row |= {name: statistics.fmean(value), f"{name}_error": math.hypot(*error) / seeds}
            row |= {f"{name}_{kind}": bounds.get(f"{name}_{kind}", "") for kind in
                    ("above", "below")}
        row |= {"pole": "", "pole_error": "", "pole_known": "", "pole_known_error": ""}
        shear.append((packing, *(row[name] * enskog(packing, 1)[0] for name in
                                 ("shear", "shear_error"))))
        if packing == list(DENSE)[-1] and not is_short:
            row |= pole(*shear[-2:])
        yield row


def pole(first, last):
    """Where the inverse viscosity of two packings points to zero."""
    (a, v, v_error), (b, w, w_error) = first, last
    slope = (b - a) / (w - v) ** 2 # d(pole)/dv is w * slope, d(pole)/dw is -v * slope
    return {"pole": (w * b - v * a) / (w - v),
            "pole_error": slope * math.hypot(w * v_error, v * w_error),
            "pole_known": 0.7, "pole_known_error": 0.005}


def conduction(program, is_short):
    """Walls at 2 and 0.5 in kT. In each strip the heat should be Enskog's conductivity there times
    the slope of the temperature. Next to walls the temperature jumps, so strips there do not count.
    """
    length, discs, steps = (100, 600, 8_000) if is_short else (200, 2_400, 30_000)
    early, strips = steps // 5, 20
    for packing in (0.1, 0.2):
        width = discs * math.pi / (4 * packing * length)
        report = literature.run(
            program, "conduction.toml", box__size=f"[{length}, {width!r}]", discs__count=discs,
            discs__packing=packing, time__steps=steps, output__averages_from_step=early,
            box__bottom__kind='"periodic"', box__top__kind='"periodic"',
            output__measurements__quantities='["profiles", "wall_exchange"]',
            output__measurements__every_steps=4, output__measurements__from_step=early,
            output__measurements__profile_columns=strips, output__measurements__profile_rows=1,
            output__measurements__profile_samples=(steps - early) // 4 + 1)
        walls, table = (report["measurements"][name] for name in ("wall_exchange", "profiles"))
        heat = (walls["left_heat"][0] - walls["right_heat"][0]) / 2
        error = math.hypot(walls["left_heat_error"][0], walls["right_heat_error"][0]) / 2
        inner = range(3, strips - 3)
        slopes = [(table["temperature"][k + 1] - table["temperature"][k - 1]) * strips /
                  (2 * length) for k in inner]
        fourier = statistics.fmean(
            -enskog(table["density"][k] * math.pi / 4, table["temperature"][k])[2] * slope
            for k, slope in zip(inner, slopes))
        field = statistics.fmean(table["heat_x"][k] + table["contact_heat_x"][k] for k in inner)
        yield {"packing": packing, "discs": discs, "collisions": report["pair_collisions"],
               "walls": heat, "walls_error": error, "walls_known": fourier,
               "walls_known_error": 0.02 * fourier, "profiles": field, "profiles_error": error,
               "profiles_known": heat, "profiles_known_error": error}


STUDIES = {"shock": (shock, 0.05, 0.03), "fronts": (fronts, 0.02, 0.01),
           "transport": (transport, 0.2, 0.04), "windows": (windows, 0.2, 0.02),
           "dense": (dense, 1, 0.01), "conduction": (conduction, 0.05, 0.04)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
