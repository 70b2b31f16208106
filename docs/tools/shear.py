#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sheared discs held to kinetic theory: docs/validation/shear.csv and granular_shear.csv.

  docs/tools/shear.py CARROM FOLDER     some 10 core-minutes

Viscosity: discs of restitution 0.99, 0.98 and 0.96, at packings from 0.1 to 0.5. The flow does the work
that collisions take, so the temperature is steady without a thermostat, and the rate over the thermal
speed goes to 0 as the restitution goes to 1. Both Enskog's viscosity and the measured one are given in
units of sqrt(m kT) / diameter.

Granular flow: a thin gas of restitution 0.7 to 0.95. Grad's moments give the stress ratio and the
temperature (Santos, Garzo and Dufty, Phys. Rev. E 69, 061303 (2004); Vega Reyes, Santos and Garzo,
J. Fluid Mech. 719, 431 (2013)).
"""
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SIDES = {"left": "periodic", "right": "periodic", "bottom": "sheared", "top": "sheared"}


def contact_value(packing):
    return (1 - 7 * packing / 16) / (1 - packing) ** 2


def enskog_viscosity(packing):
    """Gass, J. Chem. Phys. 54, 1898 (1971), m = kT = diameter = 1."""
    chi, bn = contact_value(packing), 2 * packing
    return 1.022 / (2 * math.sqrt(math.pi)) * (1 / chi + bn + 0.8729 * chi * bn**2)


def frequency(packing):
    """Of a disc's collisions at kT = 1, Enskog."""
    return 2 * math.sqrt(math.pi) * (4 * packing / math.pi) * contact_value(packing)


def run(program, packing, restitution, rate, temperature, count, steps):
    size = math.sqrt(count * math.pi / (4 * packing))
    lines = ["[box]", f"size = {size!r}"]
    for side, kind in SIDES.items():
        lines += [f'{side}.kind = "{kind}"']
    lines += ["[discs]", f"count = {count}", "radius = 0.5", f"speed = {math.sqrt(2 * temperature)!r}", "seed = 1"]
    if packing > 0.45:
        lines += ['generator = "lattice"']
    lines += ["[time]", f"steps = {steps}", 'method = "event-driven"']
    lines += ["[output]", f"averages_from_step = {steps // 5}"]
    lines += ["[effects]", f"shear.rate = {rate!r}"]
    lines += [f'contact = {{kind = "restitution", restitution = {restitution}, contact_time = 1e-9}}']
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "scene.toml"
        scene.write_text("\n".join(lines) + "\n", encoding="utf-8")
        subprocess.run([program, "run", scene, "-o", f"{folder}/out", "--quiet"], check=True)
        return json.loads((pathlib.Path(folder) / "out/report.json").read_text(encoding="utf-8"))


def viscosities(program):
    temperature, count = 0.01, 2000
    for packing in (0.1, 0.2, 0.3, 0.4, 0.5):
        density = 4 * packing / math.pi
        for restitution in (0.96, 0.98, 0.99):
            # viscosity * rate^2 = n omega (1 - e^2) T / 2, per volume
            rate = math.sqrt(density * frequency(packing) * (1 - restitution**2) / 2 / enskog_viscosity(packing))
            rate *= math.sqrt(temperature)
            report = run(program, packing, restitution, rate, temperature, count, 40_000)
            stress, thermal = report["pressure_tensor"]["xy"], report["temperature"]["value"]
            unit = rate * math.sqrt(thermal)
            measured, error = -stress["value"] / unit, stress["error"] / unit
            expected = enskog_viscosity(packing)
            yield packing, restitution, rate / math.sqrt(thermal), measured, error, expected, measured / expected


def granular(program):
    temperature, count, packing = 0.01, 2000, 0.01
    for restitution in (0.7, 0.8, 0.9, 0.95):
        zeta = (1 - restitution**2) / 2  # cooling rate over that of viscous relaxation, nu
        beta = (1 + restitution) / 2 * (1 - (1 - restitution) / 4)
        expected_ratio = math.sqrt(zeta / beta)
        expected_rate = expected_ratio * (beta + zeta)  # over nu
        rate = expected_rate * frequency(packing) * math.sqrt(temperature)
        report = run(program, packing, restitution, rate, temperature, count, 40_000)
        tensor, thermal = report["pressure_tensor"], report["temperature"]["value"]
        ratio = -tensor["xy"]["value"] / tensor["yy"]["value"]
        error = tensor["xy"]["error"] / tensor["yy"]["value"]
        over_nu = rate / (frequency(packing) * math.sqrt(thermal))
        yield restitution, ratio, error, expected_ratio, over_nu, expected_rate


def write(path, columns, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in rows:
            writer.writerow([f"{value:.4g}" for value in row])
            file.flush()
            print(path.name, *[f"{value:.4g}" for value in row], flush=True)


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    columns = "packing restitution rate_over_thermal viscosity error enskog ratio".split()
    write(folder / "shear.csv", columns, viscosities(program))
    columns = "restitution stress_ratio error grad_stress_ratio rate_over_nu grad_rate_over_nu".split()
    write(folder / "granular_shear.csv", columns, granular(program))


if __name__ == "__main__":
    main()
