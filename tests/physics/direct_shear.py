#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Solve Boltzmann's equation of a granular gas in uniform shear: prints a CSV.

  tests/physics/direct_shear.py [--discs 200000] [--times 800] [--seed 1] [--restitution 0.7 ...]

Bird's direct simulation of velocities about the flow, which have no places (Bird, Molecular Gas
Dynamics and the Direct Simulation of Gas Flows, Clarendon 1994). Pairs are drawn at random, and a
pair collides with the probability that Boltzmann's equation gives it. It shares no code with
Carrom. tests/physics/driven_studies.py has its numbers. Needs NumPy, and some two core-minutes for
each restitution. Temperatures at 0.95 change over 25 times between collisions, so errors are right
for runs that are much longer.

A disc that has been drawn is drawn again in the next batch at the earliest, so batches have to be
short: they take 0.001 of the time between a disc's collisions, which leaves errors of 0.05 %. The
flow acts before and after each 25 of them, with an error of second order, below 0.01 %.
"""
import argparse
import math

import numpy as np


def direct_shear(e, discs, times, seed, per_time=40, batches=25):
    """-xy / yy of the stress, the rate over the frequency of collisions, and their errors.

    `times` are in times between a disc's collisions; `per_time` steps of some batches make one. The
    rate is 1. A velocity is a complex number.
    """
    random = np.random.default_rng(seed)
    loss, beta = (1 - e ** 2) / 2, (1 + e) / 2 * (1 - (1 - e) / 4) # they begin near Grad's kT
    size = 1 / (2 * math.sqrt(math.pi * loss / beta) * (beta + loss))
    v = size * (random.normal(size=discs) + 1j * random.normal(size=discs))
    v -= v.mean()
    found = []
    for step in range(times * per_time):
        square = v.real ** 2 + v.imag ** 2
        dt = 1 / (per_time * 2 * math.sqrt(math.pi * square.mean() / 2))
        fastest_pair = 2.2 * math.sqrt(square.max()) # collisions make few discs faster in a step
        v.real -= v.imag * dt / 2
        for _ in range(batches):
            drawn = int(discs * dt / batches * fastest_pair + random.random())
            first = (random.integers(discs) + np.arange(drawn)) % discs
            second = (first + random.integers(drawn, discs - drawn + 1)) % discs
            apart = v[first] - v[second]
            hit = random.random(drawn) * fastest_pair < np.abs(apart)
            offset = random.uniform(-1, 1, np.count_nonzero(hit)) # how far off centre they meet
            along = np.sqrt(1 - offset ** 2)
            change = (1 + e) / 2 * apart[hit] * along * (along + 1j * offset)
            v[first[hit]] -= change
            v[second[hit]] += change
        v.real -= v.imag * dt / 2
        if step >= times * per_time // 5 and step % 5 == 0:
            found.append((np.mean(v.real ** 2), np.mean(v.real * v.imag), np.mean(v.imag ** 2)))
    blocks = np.array(found[len(found) % 10:]).reshape(10, -1, 3).mean(axis=1)
    ratio = -blocks[:, 1] / blocks[:, 2]
    rate = 1 / (2 * np.sqrt(math.pi * (blocks[:, 0] + blocks[:, 2]) / 2))
    return ratio.mean(), ratio.std() / 3, rate.mean(), rate.std() / 3


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in (("discs", 200_000), ("times", 800), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--restitution", type=float, nargs="+", default=(0.7, 0.8, 0.9, 0.95))
    options = parser.parse_args()
    print("restitution,stress_ratio,stress_ratio_error,rate_over_nu,rate_over_nu_error")
    for restitution in options.restitution:
        row = direct_shear(restitution, options.discs, options.times, options.seed)
        print(f"{restitution}," + ",".join(f"{value:.5f}" for value in row), flush=True)
