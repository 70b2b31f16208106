#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Solve Boltzmann's equation of a granular gas in uniform shear: prints a CSV.

  tests/physics/direct_shear.py [--discs 20000] [--steps 20000] [--seed 1]

Bird's direct simulation of velocities about the flow, which have no places (Bird, Molecular Gas
Dynamics and the Direct Simulation of Gas Flows, Clarendon 1994): in each time step discs are paired
at random, and a pair collides with the probability that Boltzmann's equation gives it. Steps of
0.01 collision times have the same numbers as steps of 0.02 within errors. It shares no code with
Carrom. tests/physics/driven_studies.py has its numbers. Needs NumPy.
"""
import argparse
import math

import numpy as np


def direct_shear(e, discs, steps, seed, per_collision_time=100):
    """-xy / yy of the stress, the rate over the frequency of collisions, and their errors."""
    random = np.random.default_rng(seed)
    v = random.normal(size=(discs, 2)) / (2 * math.sqrt(math.pi) * 0.5) # the rate is 1
    half = discs // 2
    found = []
    for step in range(steps):
        dt = 1 / (per_collision_time * 2 * math.sqrt(math.pi * np.mean(v ** 2)))
        v[:, 0] -= v[:, 1] * dt / 2
        order = random.permutation(discs)
        first, second = order[:half], order[half:]
        angle = random.uniform(0, 2 * math.pi, half)
        normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        closing = np.sum((v[first] - v[second]) * normal, axis=1)
        hit = random.random(half) < 2 * math.pi * dt * closing
        change = ((1 + e) / 2 * closing[hit])[:, None] * normal[hit]
        v[first[hit]] -= change
        v[second[hit]] += change
        v[:, 0] -= v[:, 1] * dt / 2
        v -= v.mean(axis=0)
        if step > steps // 5 and step % 5 == 0:
            found.append((np.mean(v[:, 0] ** 2), np.mean(v[:, 0] * v[:, 1]), np.mean(v[:, 1] ** 2)))
    blocks = np.array(found[len(found) % 10:]).reshape(10, -1, 3).mean(axis=1)
    ratio = -blocks[:, 1] / blocks[:, 2]
    rate = 1 / (2 * np.sqrt(math.pi * (blocks[:, 0] + blocks[:, 2]) / 2))
    return ratio.mean(), ratio.std() / 3, rate.mean(), rate.std() / 3


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in (("discs", 20_000), ("steps", 20_000), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=value)
    options = parser.parse_args()
    print("restitution,stress_ratio,stress_ratio_error,rate_over_nu,rate_over_nu_error")
    for restitution in (0.7, 0.8, 0.9, 0.95):
        row = direct_shear(restitution, options.discs, options.steps, options.seed)
        print(f"{restitution}," + ",".join(f"{value:.4f}" for value in row), flush=True)
