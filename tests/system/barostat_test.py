# SPDX-License-Identifier: BSD-3-Clause
"""Constant pressure: two discs against their exact distribution of volumes and shapes, a liquid
against an equation of state, a crystal against its shape, and the same bits on every machine shape
and over restarts.
"""
import csv
import math
from random import Random

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
CRYSTAL = PERIODIC + """
[discs]
radius = {radius}
list = {list}
[time]
steps = 10000
method = "event-driven"
[effects.barostat]
pressure = 12.0
axes = "each"
[output]
averages_from_step = 2000
[output.measurements]
quantities = ["volume"]
from_step = 2000
every_steps = 1
"""
EACH = MIXTURE.replace("seed = 77", 'seed = 77\naxes = "each"')


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


def shapes_of_two(pressure):
    """Means of V and of ln(Lx / 10)^2 for two discs of diameter 1 whose axes move alone.

    The weight of sides Lx and Ly is dLx dLy V (V - pi) exp(-p V) with V = Lx Ly. So u = ln(Lx / Ly)
    / 2 is even between bounds: sides are longer than two diameters, and stay within half and twice
    the sides of a square box.
    """
    weights = volumes = squares = 0.0
    for k in range(20_000):
        v = 4 + (k + 0.5) * 60 / pressure / 20_000
        bound = min(math.log(2), math.log(v / 4) / 2)
        weight = v * (v - math.pi) * math.exp(-pressure * (v - 4)) * 2 * bound
        weights += weight
        volumes += weight * v
        squares += weight * bound ** 2 / 3
    return volumes / weights, squares / weights


def strained_crystal(n, strain, packing):
    """Sides, and rows of places and velocities: n rows of n discs, longer by the strain."""
    size = [n * (1 + strain), n * math.sqrt(3) / 2 / (1 + strain)]
    random = Random(4)
    rows = [[(i + 0.25 + 0.5 * (j % 2)) * size[0] / n, (j + 0.5) * size[1] / n,
             random.gauss(0, 0.1), random.gauss(0, 0.1)] for j in range(n) for i in range(n)]
    return {"size": size, "list": rows, "radius": math.sqrt(packing * size[0] * size[1] / math.pi)
            / n}


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

    def test_two_discs_have_the_exact_distribution_of_shapes(self):
        """Bounds: some four standard errors, from the scatter of four seeds."""
        pressure = 0.45
        self.run_scene("shapes", "--set", "effects.barostat.axes=each", pressure=pressure,
                       steps=60_000, early=100, packing=2 * math.pi / 400)
        width, height = (self.column("shapes", "volume_history", name)
                         for name in ("width", "height"))
        self.assertLess(max(abs(w * h / 100 - 1) for w, h in zip(width, height)), 1e-14)
        stretches = [math.log(w / 10) for w in width]
        n = len(stretches)
        self.assertLess(abs(sum(stretches) / n), 0.06)
        mean, expected = shapes_of_two(pressure)
        self.assertLess(abs(sum(u * u for u in stretches) / n - expected), 0.25 * expected)
        self.assertLess(max(map(abs, stretches)), math.log(2) * (1 + 1e-14))
        volumes = [2 * v for v in self.column("shapes", "volume_history", "volume")]
        self.assertLess(abs(sum(volumes) / n - mean), 0.06 * mean)

    def test_a_strained_crystal_finds_its_shape(self):
        """Sides of a perfect crystal of n rows of n discs are in the ratio 2 / sqrt(3)."""
        for strain in (0.03, -0.03):
            crystal = strained_crystal(8, strain, 0.70)
            report = self.run_scene("strained", text=CRYSTAL.format(**crystal))
            table = report["measurements"]["volume"]
            ratio, error = table["ratio"][0], table["ratio_error"][0]
            self.assertLess(error, 0.006)
            self.assertLess(abs(ratio - 2 / math.sqrt(3)), 4 * error)
            xx, yy = (report["pressure_tensor"][name]["value"] for name in ("xx", "yy"))
            self.assertLess(abs(xx / yy - 1), 0.06)

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
        self.check_bits(MIXTURE, ((2, 1), (3, 2), (5, 1), (1, 3)))
        self.check_bits(EACH, ((2, 1), (3, 2), (5, 1)))

    def check_bits(self, text, shapes):
        one = self.run_scene("mixed", "--threads", 1, text=text)
        tables = [(self.folder / "mixed" / "measurements" / f"{name}.csv").read_bytes()
                  for name in ("volume_history", "psi6_history")]
        for ranks, threads in shapes:
            other = self.run_scene("mixed", "--threads", threads, ranks=ranks, text=text)
            self.assertEqual(other["state_hash"], one["state_hash"])
            self.assertEqual(other["last_packing"], one["last_packing"])
            self.assertEqual([(self.folder / "mixed" / "measurements" / f"{name}.csv").read_bytes()
                              for name in ("volume_history", "psi6_history")], tables)
        other_seed = self.run_scene("mixed", "--set", "effects.barostat.seed=78", text=text)
        self.assertNotEqual(other_seed["state_hash"], one["state_hash"])

    def test_a_restart_goes_on_with_the_size(self):
        self.check_restart_of(MIXTURE)

    def test_a_restart_goes_on_with_the_shape(self):
        self.check_restart_of(EACH)

    def check_restart_of(self, text):
        self.write("mixture.toml", text)
        self.check_restart("mixture.toml", first=47, last=120)
        self.assertEqual(self.report("rest.json")["last_packing"],
                         self.report("whole.json")["last_packing"])

    def test_check_holds(self):
        for text in (MIXTURE, EACH):
            report = self.run_scene("checked", "--check", text=text, ranks=2)
            self.assertEqual(report["overlapping_pairs"], 0)

    def test_files_have_the_box_of_their_step(self):
        recorded = EACH + "[output.trajectory]\nevery_steps = 40\n"
        self.run_scene("boxes", text=recorded, ranks=2)
        self.run_program(1, "verify", "boxes/trajectory.h5")
        self.run_program(1, "convert", "boxes/trajectory.h5", "--to", "xyz",
                         "--output", "boxes.xyz")
        text = (self.folder / "boxes.xyz").read_text(encoding="utf-8")
        boxes = [line.split('"')[1].split() for line in text.splitlines() if "Lattice" in line]
        history = list(zip(*(self.column("boxes", "volume_history", name)
                             for name in ("step", "width", "height"))))
        expected = [list(row[1:]) for row in history if row[0] % 40 == 0]
        self.assertEqual([[float(box[0]), float(box[4])] for box in boxes], expected)
        self.assertNotEqual(expected[0], expected[-1])

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
                (["effects.barostat.axes=each", 'output.measurements.quantities=["density"]'],
                 "sides stay as they are"),
                (["effects.barostat.axes=x"], "effects.barostat.axes"),
                (["effects.barostat.pressure=-1"], "effects.barostat.pressure")):
            self.write("wrong.toml", SCENE.format(
                size=10, count=2, packing=0.05, speed=1, generator="random", steps=5, early=0,
                pressure=1.0))
            sets = [part for word in words for part in ("--set", word)]
            self.run_program(1, "run", "wrong.toml", *sets, code=2, says=says)


if __name__ == "__main__":
    main()
