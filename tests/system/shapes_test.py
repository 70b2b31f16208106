# SPDX-License-Identifier: BSD-3-Clause
"""Boxes that are no rectangles, arcs, polygons and points: what billiards keep, what discs push,
the same bits on any shape of the machine, and what is refused.
"""
import csv
import math

from program import ProgramTest, lines_of, main

ROUND = """
[box]
size = 20
shape = "round"
[discs]
{discs}
[time]
method = "{method}"
steps = 200
sync_every = 16
{effects}
"""
DRUM = """
[effects.contact]
kind = "rough"
restitution = 0.6
tangential_restitution = 0
friction = 0.5
contact_time = 0.01
[effects.gravity]
y = -0.02
[effects.obstacles]
restitution = 0.6
tangential_restitution = 0
friction = 0.8
velocity = 0.1
"""
SEVERAL = """
[effects.obstacles]
arcs = [[5, 5, 2.5], [14, 14, 3, -90, 90], [10, 3, 2, 30, 150]]
polygons = [[3, 12, 7, 12, 5, 16]]
"""
BILLIARD = """
[box]
size = [20, 10]
shape = "stadium"
[discs]
count = 400
radius = 0
speed = 1
[time]
method = "event-driven"
steps = 100
[effects.contact]
kind = "none"
"""


class Shapes(ProgramTest):
    def table(self, name):
        path = self.folder / "run" / "measurements" / f"{name}.csv"
        lines = [line for line in path.read_text(encoding="utf-8").splitlines()
                 if not line.startswith("#")]
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]

    def test_a_round_box_keeps_energy_and_angular_momentum(self):
        scene = ROUND.format(discs="count = 1\nradius = 1\nlist = [[13, 9, 0.31, 0.47]]",
                             method="event-driven", effects="")
        self.write("one.toml", scene)
        for steps in 50, 200:
            out = self.run_program(1, "run", "one.toml", "--check", "--steps", steps, "--set",
                                   "output.text=ends").out
            _, x, y, vx, vy = map(float, [line for line in out.splitlines()
                                          if line.startswith(f"{steps} ")][0].split()[1:6])
            self.assertAlmostEqual((x - 10) * vy - (y - 10) * vx, 3 * 0.47 + 1 * 0.31, delta=1e-11)
            self.assertAlmostEqual(vx**2 + vy**2, 0.31**2 + 0.47**2, delta=1e-13)

    def test_bits_are_those_of_any_shape_and_over_restarts(self):
        discs = "count = 60\nradius = 0.5\nspeed = 0.3"
        for name, scene in {
                "gas": ROUND.format(discs=discs, method="event-driven", effects=""),
                "steps": ROUND.format(discs=discs, method="time-stepped", effects=""),
                "drum": ROUND.format(discs=discs, method="event-driven", effects=DRUM),
                "lasting": ROUND.format(
                    discs=discs, method="event-driven",
                    effects=DRUM + "[effects.lasting_contacts]\nspeed = 0.03\n"
                ).replace("sync_every = 16", ""),
                "several": ROUND.format(discs=discs, method="event-driven",
                                        effects=SEVERAL).replace('shape = "round"', ""),
                "points": BILLIARD}.items():
            with self.subTest(name):
                self.write("scene.toml", scene)
                measured = ("-o", "run", "--overwrite", "--set",
                            'output.measurements.quantities=["obstacle_forces"]', "--report",
                            "report.json")
                hashes, tables = set(), set()
                for ranks, threads in (1, 1), (2, 2), (3, 1), (5, 1):
                    self.run_program(ranks, "run", "scene.toml", "--steps", 60, "--threads",
                                     threads, *measured)
                    hashes.add(self.hash_of("report.json"))
                    path = self.folder / "run/measurements/obstacle_forces.csv"
                    tables.add(path.read_text(encoding="utf-8"))
                self.assertEqual(len(hashes), 1)
                self.assertEqual(len(tables), 1)
                self.check_restart("scene.toml", ("--overwrite",), first=30, last=60)
                self.run_program(2, "run", "scene.toml", "--steps", 40, "--check")

    def test_dense_discs_begin_on_a_lattice_around_obstacles(self):
        """The check finds no disc outside or in another, and the bits are those of any shape."""
        mixed = ("species = [{count = 60, radius = 0.3}, {count = 60, radius = 0.5}]\n"
                 "generator = \"lattice\"")
        periodic = "".join(f"[box.{side}]\nkind = \"periodic\"\n" for side in ("bottom", "top"))
        for name, scene in {
                "round": ROUND.format(discs="packing = 0.7\ncount = 1000", effects="",
                                      method="event-driven"),
                "stadium": BILLIARD.replace("radius = 0", "packing = 0.65").replace(
                    'kind = "none"', 'kind = "elastic"'),
                "several": ROUND.format(discs=mixed, method="time-stepped",
                                        effects=SEVERAL + periodic).replace('shape = "round"', "")
                }.items():
            with self.subTest(name):
                self.write("scene.toml", scene)
                for ranks in (1, 2, 5):
                    self.run_program(ranks, "run", "scene.toml", "--steps", 8, "--check",
                                     "--report", f"{ranks}.json")
                    self.assertEqual(self.hash_of(f"{ranks}.json"), self.hash_of("1.json"))

    def test_discs_are_compressed_and_grow_in_shapes_and_beside_obstacles(self):
        """The check finds no disc outside or in another, and the bits are those of any shape."""
        mixed = ("species = [{count = 80, radius = 0.4}, {count = 80, radius = 0.6}]\n"
                 "generator = \"compressed\"")
        gas = "count = 100\nradius = 0.3\nspeed = 0.2"
        growth = "[effects.growth]\nrate = 0.02\n"
        for name, scene in {
                "round": ROUND.format(discs="packing = 0.78\ncount = 300\nspeed = 0.2\n"
                                      "generator = \"compressed\"", effects="",
                                      method="event-driven"),
                "mixed": ROUND.format(discs=mixed, method="time-stepped",
                                      effects=SEVERAL).replace('shape = "round"', ""),
                "grow": ROUND.format(discs=gas, method="event-driven", effects=SEVERAL + growth
                                     ).replace('shape = "round"', ""),
                "grow round": ROUND.format(discs=gas, method="event-driven", effects=growth)
                }.items():
            with self.subTest(name):
                self.write("scene.toml", scene)
                for ranks, threads in (1, 1), (1, 2), (3, 1):
                    self.run_program(ranks, "run", "scene.toml", "--steps", 80, "--check",
                                     "--threads", threads, "--report", "r.json")
                    report = self.report("r.json")
                    if (ranks, threads) == (1, 1):
                        first = report
                    self.assertEqual(report["state_hash"], first["state_hash"])
                self.assertGreater(first["pair_collisions"], 1000)
                self.assertGreater(first["wall_collisions"], 100)
                if "grow" in name:
                    self.check_restart("scene.toml", ("--overwrite",), first=30, last=60)

    def test_growing_discs_slide_along_a_round_wall_without_restitution(self):
        discs = "count = 1\nradius = 1\nlist = [[10, 4, 0.1, 0]]"
        self.write("slide.toml", ROUND.format(
            discs=discs, method="event-driven",
            effects="[effects.obstacles]\nrestitution = 0\n[effects.growth]\nrate = 0.001\n"))
        self.run_program(1, "run", "slide.toml", "--check", "--report", "r.json")
        self.assertGreater(self.report("r.json")["wall_collisions"], 10)

    def test_discs_slide_from_the_lines_of_a_stadium_onto_its_arcs(self):
        """Without restitution they do, and their exact tangents once let one of them out."""
        self.write("stadium.toml", """
[box]
size = [30, 20]
shape = "stadium"
[discs]
count = 40
radius = 0.5
speed = 0.1
[time]
steps = 100
[effects.obstacles]
restitution = 0
""")
        self.run_program(1, "run", "stadium.toml", "--check")

    def test_the_push_on_a_round_wall_is_the_virial_of_the_gas(self):
        """The virial theorem for a smooth wall that centres touch at the distance R: push R is
        2 N kT and the sum of impulse times distance of pairs, 2 P A with the report's P.
        """
        self.write("gas.toml", ROUND.format(discs="count = 80\nradius = 0.5\ntemperature = 0.04",
                                            method="event-driven", effects=""))
        self.run_program(2, "run", "gas.toml", "--steps", 4000, "-o", "run", "--report", "r.json",
                         "--set", 'output.measurements.quantities=["obstacle_forces"]')
        report, (wall,) = self.report("r.json"), self.table("obstacle_forces")
        self.assertAlmostEqual(wall["length"], 20 * math.pi, delta=1e-6)
        virial = report["pressure"]["value"] * math.pi * 100
        # P leaves the wall out, and so does this.
        self.assertLess(abs(wall["push"] * 9.5 / 2 / virial - 1), 0.01)
        self.assertLess(abs(wall["fx"]), 5 * wall["fx_error"])
        self.assertLess(abs(wall["torque"]), 1e-12)
        self.assertAlmostEqual(report["packing"], 80 * 0.25 / 100, delta=1e-9)

    def test_a_beam_pushes_a_disc_by_free_molecular_drag(self):
        """Points that fly to the right and are reflected: n v^2 8 R / 3; exactly what they lose."""
        n, v, r = 40_000, 2, 5
        self.write("beam.toml", f"""
[box]
size = 100
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "periodic"
top.kind = "periodic"
[discs]
count = {n}
radius = 0
speed = 0
streams = [{{ region = [0, 0, 100, 100], velocity = [{v}, 0] }}]
[time]
method = "event-driven"
steps = 20
[effects.contact]
kind = "none"
[effects.obstacles]
discs = [[60, 50, {r}], [60, 80, 0.5]]
""")
        self.run_program(2, "run", "beam.toml", "-o", "run", "--report", "r.json", "--set",
                         'output.measurements.quantities=["obstacle_forces"]', "--set",
                         "output.measurements.every_steps=10")
        large, small = self.table("obstacle_forces")
        known = n / (1e4 - math.pi * (r**2 + 0.25)) * v**2 * 8 / 3 * r
        self.assertLess(abs(large["fx"] / known - 1), 0.06) # some 1600 points
        self.assertLess(abs(large["fy"]), 0.06 * known)
        self.assertLess(abs(large["torque"]), 1e-9)
        momentum = self.report("r.json")["momentum"]
        self.assertAlmostEqual((large["fx"] + small["fx"]) * 20, n * v - momentum[0], delta=1e-7)
        self.assertAlmostEqual((large["fy"] + small["fy"]) * 20, -momentum[1], delta=1e-7)

    def test_an_obstacle_carries_the_weight_of_what_lies_on_it(self):
        """One disc on a segment, which bounces at first, and one on an arc's inner face."""
        for more in "", "[effects.lasting_contacts]\nspeed = 0.03\n":
            scene = f"""
[box]
size = 20
[discs]
radius = 0.5
list = [[5, 4, 0, 0], [15, 4, 0, 0]]
[time]
method = "event-driven"
steps = 3000
{"sync_every = 16" if not more else ""}
[effects.contact]
kind = "restitution"
restitution = 0.5
contact_time = 0.01
[effects.gravity]
y = -0.02
[effects.obstacles]
restitution = 0.5
segments = [[2, 3, 8, 3]]
arcs = [[15, 5, 2, 180, 360]]
{more}
"""
            self.write("weights.toml", scene)
            self.run_program(1, "run", "weights.toml", "-o", "run", "--overwrite", "--set",
                             "output.measurements.from_step=1000", "--set",
                             'output.measurements.quantities=["obstacle_forces"]')
            for row in self.table("obstacle_forces"):
                self.assertLess(abs(row["fy"] / -0.02 - 1), 0.02, (more, row))
                self.assertLess(abs(row["fx"]), 1e-9)
                self.assertLess(abs(row["torque"]), 1e-9)

    def test_points_are_anywhere(self):
        """g of an ideal gas is 1 at all distances, in both shapes. Pairs scatter like Poisson's,
        and samples are so far apart that they are new."""
        for shape, size in ("round", 20), ("stadium", "[30, 16]"):
            self.write("gas.toml", f"""
[box]
size = {size}
shape = "{shape}"
[discs]
count = 400
radius = 0.05
speed = 1
[time]
method = "event-driven"
steps = 1600
[effects.contact]
kind = "none"
[output.measurements]
quantities = ["radial_distribution"]
every_steps = 40
bins = 16
largest_distance = 7
""")
            self.run_program(2, "run", "gas.toml", "-o", "run", "--overwrite")
            table = self.table("radial_distribution")
            self.assertEqual(len(table), 16)
            for row in table:
                self.assertLess(abs(row["g"] - 1), 4.5 / math.sqrt(row["pairs"]), (shape, row))

    def test_pairs_are_those_of_all_samples(self):
        """Pairs counted by hand, over those of points in the circle of centres (Hammersley's
        distribution of their distances)."""
        n, width, radius = 60, 0.5, 0.5
        self.write("gas.toml", ROUND.format(discs=f"count = {n}\nradius = {radius}\nspeed = 0.2",
                                            method="event-driven", effects=""))
        run = self.run_program(2, "run", "gas.toml", "--steps", 60, "-o", "run", *(
            word for one in ('output.measurements.quantities=["radial_distribution"]',
                             "output.measurements.every_steps=20", "output.text=every_step",
                             "output.measurements.bins=14",
                             "output.measurements.largest_distance=7") for word in ("--set", one)))
        counts = [0] * 14
        for step in 0, 20, 40, 60:
            places = [tuple(map(float, line.split()[2:4])) for line in lines_of(run.out, step)]
            for k, p in enumerate(places):
                for q in places[:k]:
                    if math.dist(p, q) < 7:
                        counts[int(math.dist(p, q) / width)] += 1

        def share(distance):
            s = distance / 19  # over the diameter of the circle of centres
            return 1 + (2 * (4 * s * s - 1) * math.acos(s)
                        - 2 * s * (1 + 2 * s * s) * math.sqrt(1 - s * s)) / math.pi
        table = self.table("radial_distribution")
        self.assertEqual([row["pairs"] for row in table], counts)
        for k, row in enumerate(table):
            ideal = 4 * n * (n - 1) / 2 * (share(width * (k + 1)) - share(width * k))
            self.assertAlmostEqual(row["g"], counts[k] / ideal, delta=1e-6)

    def test_what_has_no_meaning_is_refused(self):
        discs = "count = 10\nradius = 0.5"
        whole = ROUND.format(discs=discs, method="event-driven", effects="")
        self.write("round.toml", whole)
        self.write("points.toml", BILLIARD)
        self.write("several.toml", whole + SEVERAL)
        for scene, said, *words in (
                ("round.toml", 'box.shape = "round" needs a square', "box.size=[20, 10]"),
                ("round.toml", "stadium\" needs a box that is longer", "box.shape=stadium"),
                ("round.toml", "discs never meet the sides", "box.left.kind=open"),
                ("round.toml", "these generators know nothing of obstacles",
                 "discs.generator=legacy"),
                ("round.toml", "no lattice of 350 discs of radius 0.5 has room", "discs.count=350",
                 "discs.generator=lattice"),
                ("round.toml", "\"obstacle_forces\" has the wall's pressure",
                 'output.measurements.quantities=["wall_pressure"]'),
                ("round.toml", "overlaps the round wall", "discs.list=[[1, 1, 0, 0]]",
                 "discs.count=1"),
                ("round.toml", "obstacles that rub or slide", "effects.growth.rate=0.001",
                 "effects.obstacles.tangential_restitution=0.5"),
                ("points.toml", "two points never meet", "effects.contact.kind=elastic"),
                ("points.toml", "only the event-driven method", "time.method=time-stepped"),
                ("several.toml", "four numbers", "effects.obstacles.arcs=[[5, 5, 2, 90]]"),
                ("several.toml", "angles go up", "effects.obstacles.arcs=[[5, 5, 2, 90, 30]]"),
                ("several.toml", "no pairs", "effects.obstacles.polygons=[[3,3,7,3,5,6,4]]")):
            with self.subTest(said):
                options = [option for word in words for option in ("--set", word)]
                self.run_program(1, "run", scene, *options, code=2, says=said)


if __name__ == "__main__":
    main()
