# SPDX-License-Identifier: BSD-3-Clause
"""Constant pressure: two discs against their exact distribution of volumes, a liquid against an
equation of state, and the same bits on every machine shape and over restarts.
"""
import csv
import math

from program import ProgramTest, main

PERIODIC = """
[box]
size = {size}
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "periodic"
top.kind = "periodic"
"""

SCENE = PERIODIC + """
[discs]
count = {count}
packing = {packing}
speed = {speed}
seed = 3
generator = "{generator}"
[time]
steps = {steps}
method = "event-driven"
[effects.barostat]
pressure = {pressure}
[output]
averages_from_step = {early}
[output.measurements]
quantities = ["volume"]
from_step = {early}
every_steps = 1
"""

MIXTURE = PERIODIC.format(size=24) + """
[discs]
speed = 0.3
seed = 8
[[discs.species]]
count = 90
radius = 0.5
mass = 1
[[discs.species]]
count = 60
radius = 0.8
mass = 3
[time]
steps = 120
micro_steps = 3
sync_every = 7
method = "event-driven"
[effects.barostat]
pressure = 9.0
seed = 77
[effects.thermostat]
kind = "langevin"
rate = 0.01
temperature = 0.1
[output.measurements]
quantities = ["volume", "psi6"]
every_steps = 10
"""


def mean_of_two(pressure, least):
    """Mean and variance of the volume V of two discs of diameter 1, of weight V (V - pi) exp(-p V).

    The place of the second one about the first is anywhere but in a disc of area pi. The box is
    longer than two diameters.
    """
    n, most = 200_000, least + 60 / pressure
    step = (most - least) / n
    sums = [0.0, 0.0, 0.0]
    for k in range(n):
        v = least + (k + 0.5) * step
        weight = v * (v - math.pi) * math.exp(-pressure * (v - least))
        for power in range(3):
            sums[power] += weight * v ** power
    mean = sums[1] / sums[0]
    return mean, sums[2] / sums[0] - mean ** 2


def kolafa_rottner(packing):
    """Z of Kolafa and Rottner, Mol. Phys. 104, 3435 (2006): the terms that matter up to 0.5."""
    x = packing / (1 - packing)
    terms = (1.0, 2.0, 1.12801775, 0.00181895291, -0.0526134737, 0.0504960168, -0.0325537792,
             0.0134578632, 0.00140888182, -0.00834273601, 0.00694127367, -0.00262254723,
             0.000355746352)
    return sum(c * x ** k for k, c in enumerate(terms))


class Barostat(ProgramTest):
    def run_scene(self, name, *words, ranks=1, text=None, **values):
        values = {"size": 10, "count": 2, "packing": 0.05, "speed": 1, "generator": "random",
                  "steps": 100, "early": 0, "pressure": 1.0} | values
        self.write(f"{name}.toml", text or SCENE.format(**values))
        threads = [] if "--threads" in words else ["--threads", 1]
        self.run_program(ranks, "run", f"{name}.toml", "-o", name, "--report", f"{name}.json",
                         "--overwrite", "--quiet", *threads, *words)
        return self.report(f"{name}.json")

    def column(self, name, table, column):
        path = self.folder / name / "measurements" / f"{table}.csv"
        with open(path, encoding="utf-8") as file:
            rows = csv.DictReader(line for line in file if not line.startswith("#"))
            return [float(row[column]) for row in rows]

    def test_two_discs_have_the_exact_distribution(self):
        """The box is longer than four radii, so V is at least 4."""
        pressure = 0.45
        report = self.run_scene("two", pressure=pressure, steps=40_000, early=100,
                                packing=2 * math.pi / 400)
        mean, variance = mean_of_two(pressure, 4.0)
        table = report["measurements"]["volume"]
        volume, error = 2 * table["volume"][0], 2 * table["volume_error"][0]
        self.assertLess(error, 0.025 * mean)
        self.assertLess(abs(volume - mean), 4 * error)
        # compressibility: two times the variance of the volume a disc over its mean
        found, error = (2 * table["volume"][0] * table[name][0] for name in
                        ("compressibility", "compressibility_error"))
        self.assertLess(error, 0.15 * variance)
        self.assertLess(abs(found - variance), 4 * error)
        self.assertGreater(min(self.column("two", "volume_history", "volume")), 2.0)

    def test_a_liquid_has_the_density_of_its_pressure(self):
        """At the pressure of a packing of 0.45; the volume is also that of the virial."""
        packing, n = 0.45, 150
        pressure = 4 / math.pi * packing * kolafa_rottner(packing)
        report = self.run_scene("liquid", pressure=pressure, count=n, packing=0.4, steps=5000,
                                early=500, size=20, speed=0.4)
        table = report["measurements"]["volume"]
        found, error = table["packing"][0], table["packing_error"][0]
        self.assertLess(error, 0.008 * packing)
        self.assertLess(abs(found - packing), 4 * error + packing / n)
        z, z_error = (report["compressibility"][name] for name in ("value", "error"))
        expected = (pressure * n * table["volume"][0] - 1) / n
        self.assertLess(abs(z - expected), 4 * z_error + expected / n)
        self.assertEqual(report["overlapping_pairs"], 0)
        self.assertNotEqual(report["last_packing"], report["packing"])

    def test_bits_do_not_depend_on_ranks_and_threads(self):
        one = self.run_scene("mixed", "--threads", 1, text=MIXTURE)
        tables = [(self.folder / "mixed" / "measurements" / f"{name}.csv").read_bytes()
                  for name in ("volume_history", "psi6_history")]
        for ranks, threads in ((2, 1), (3, 2), (5, 1), (1, 3)):
            other = self.run_scene("mixed", "--threads", threads, ranks=ranks, text=MIXTURE)
            self.assertEqual(other["state_hash"], one["state_hash"])
            self.assertEqual(other["last_packing"], one["last_packing"])
            self.assertEqual([(self.folder / "mixed" / "measurements" / f"{name}.csv").read_bytes()
                              for name in ("volume_history", "psi6_history")], tables)
        other_seed = self.run_scene("mixed", "--set", "effects.barostat.seed=78", text=MIXTURE)
        self.assertNotEqual(other_seed["state_hash"], one["state_hash"])

    def test_a_restart_goes_on_with_the_size(self):
        self.write("mixture.toml", MIXTURE)
        self.check_restart("mixture.toml", first=47, last=120)
        self.assertEqual(self.report("rest.json")["last_packing"],
                         self.report("whole.json")["last_packing"])

    def test_check_holds(self):
        report = self.run_scene("checked", "--check", text=MIXTURE, ranks=2)
        self.assertEqual(report["overlapping_pairs"], 0)

    def test_a_solid_is_denser_at_a_higher_pressure(self):
        """8 rows of 8 discs. Volumes are forgotten in some N / 2 steps."""
        packings = []
        for pressure in (9.6, 12.0):
            report = self.run_scene("solid", pressure=pressure, count=64, packing=0.74,
                                    generator="triangular", steps=4000, early=300, speed=0.1,
                                    size=[8, 8 * math.sqrt(3) / 2])
            packings.append(report["measurements"]["volume"]["packing"][0])
        self.assertGreater(packings[0], 0.70)
        self.assertGreater(packings[1], packings[0] + 0.01)

    def test_what_it_does_not_go_with_is_an_error(self):
        for words, says in (
                (["time.method=time-stepped"], "radii stay there"),
                (["effects.growth.rate=1e-6"], "both change the radii"),
                (["effects.contact.kind=restitution", "effects.contact.restitution=0.9"],
                 "elastic discs in equilibrium"),
                (["effects.drag.rate=0.1"], "straight flights"),
                (["box.left.kind=wall", "box.right.kind=wall"], "all four sides periodic"),
                (["effects.barostat.pressure=0"], "nothing changes the volume"),
                (["effects.barostat.pressure=-1"], "effects.barostat.pressure")):
            self.write("wrong.toml", SCENE.format(
                size=10, count=2, packing=0.05, speed=1, generator="random", steps=5, early=0,
                pressure=1.0))
            sets = [part for word in words for part in ("--set", word)]
            self.run_program(1, "run", "wrong.toml", *sets, code=2, says=says)


if __name__ == "__main__":
    main()
