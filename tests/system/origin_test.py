# SPDX-License-Identifier: BSD-3-Clause
"""`box.origin`. The reference is the same scene in coordinates from the lower left corner: moved by
powers of two, all bits are the same, and all places differ by the origin. Round trips through text
stand still after the first, as a theorem about rounded sums says.
"""
import csv

from program import SOURCES, ProgramTest, checkpoint, lines_of, main

HALF = 16  # half the box; sums with multiples of 2^-10 are exact
SCENE = """
[box]
{origin}
size = {size}
{sides}
[discs]
{discs}
[time]
method = "{method}"
steps = 40
{effects}
"""
CENTRE = 'origin = "centre"'


def rows(places, dx, dy):
    """Lists of x and y in turns, and then of the other numbers of a tuple."""
    return [[number - (dx, dy)[k % 2] for k, number in enumerate(numbers)] + list(others)
            for numbers, others in places]


class Places:
    """Keys in coordinates whose (0, 0) is (dx, dy) from the corner."""

    def __init__(self, dx=0.0, dy=0.0):
        self.by = dx, dy

    def __call__(self, *numbers):
        return rows([(numbers, ())], *self.by)[0]

    def generated(self):
        return f"""species = [{{count = 30, radius = 0.5, region = {self(1, 1, 14, 30)}}},
    {{count = 20, radius = 1, mass = 4, region = {self(17, 2, 31, 30)}}}]
seed = 7
streams = [{{region = {self(0, 0, 16, 32)}, velocity = [0.5, 0]}}]
freeze = [{self(8, 0, 10, 32)}]"""

    def grouped(self):
        return f"""radius = 0.5
groups = [{{count = 30, region = {self(1, 1, 14, 30)}, generator = "lattice"}},
    {{packing = 0.2, region = {self(17, 2, 31, 30)}, temperature = 0.25}}]"""

    def listed(self, radius=0.5):
        discs = rows([((2.5 + 3 * i, 3.25 + 2.5 * j), (0.125 * (i - 4), 0.25)) for i in range(9)
                      for j in range(10)], *self.by)
        return f"radius = {radius}\nlist = {discs}"

    def region(self):
        return f"count = 40\nradius = 0.5\nregion = {self(1, 1, 14, 30)}"

    def obstacles(self):
        return f"""[effects.obstacles]
discs = {rows([((15.5, 4), (1,)), ((15.5, 20), (0.5,))], *self.by)}
segments = [{self(15.25, 8, 15.75, 16)}]
arcs = {rows([((15.5, 26), (1.5,)), ((1, 1), (0.5, 0, 90))], *self.by)}
polygons = [{self(15.25, 29, 16, 29, 15.5, 31)}]
"""

    def trap(self):
        x, y = self(4, 20)
        return f"""[effects.field]
kind = "trap"
stiffness_x = 0.01
stiffness_y = 0.02
centre_x = {x}
centre_y = {y}
"""


CASES = {
    "generated": lambda p: (p.generated(), p.obstacles()),
    "grouped": lambda p: (p.grouped(), p.trap()),
    "listed": lambda p: (p.listed(), p.trap()),
    "region": lambda p: (p.region(), ""),
}


class Origin(ProgramTest):
    def write_case(self, name, case, *, by=(0.0, 0.0), origin="", method="event-driven", size=32,
                   sides=""):
        discs, effects = CASES[case](Places(*by))
        return self.write(f"{name}.toml", SCENE.format(origin=origin, size=size, sides=sides,
                                                       discs=discs, method=method,
                                                       effects=effects))

    def write_pair(self, case, **others):
        """`corner.toml` counts from the corner, `centre.toml` from the middle."""
        self.write_case("corner", case, **others)
        self.write_case("centre", case, by=(HALF, HALF), origin=CENTRE, **others)

    def run_pair(self, *options, ranks=1):
        for name in ("corner", "centre"):
            self.run_program(ranks, "run", f"{name}.toml", "--quiet", "-o", name, "--overwrite",
                             "--report", f"{name}.json", *options)
        return [self.report(f"{name}.json") for name in ("corner", "centre")]

    def discs(self, path, to="text"):
        """Rows of numbers of a file of discs."""
        text = self.run_program(1, "convert", path, "--to", to).out
        if to == "csv":
            return [list(map(float, line.split(",")[2:6])) for line in text.splitlines()[1:]]
        if to == "xyz":
            return [list(map(float, (w[1], w[2], w[4], w[5])))
                    for w in map(str.split, text.splitlines()[2:])]
        return [list(map(float, line.split()[2:6])) for line in text.splitlines()]

    def check_moved(self, corner, centre):
        self.assertEqual(centre, [[x - HALF, y - HALF, vx, vy] for x, y, vx, vy in corner])
        self.assertTrue(corner)
        self.assertLess(min(x for x, *_ in centre), 0)


class SameBits(Origin):
    def test_keys(self):
        for case in CASES:
            for method in ("event-driven", "time-stepped"):
                with self.subTest(case=case, method=method):
                    self.write_pair(case, method=method)
                    corner, centre = self.run_pair("--check")
                    self.assertEqual(corner["state_hash"], centre["state_hash"])
                    self.assertGreater(corner["pair_collisions"], 0)
                    self.assertEqual(centre["origin"], [HALF, HALF])
                    self.assertNotIn("origin", corner)
                    self.check_moved(*[self.discs(checkpoint(name, 40))
                                       for name in ("corner", "centre")])

    def test_machine_shapes(self):
        self.write_pair("generated")
        corner, _ = self.run_pair()
        for ranks, threads in ((2, 1), (3, 2), (5, 1)):
            self.run_program(ranks, "run", "centre.toml", "--quiet", "--threads", threads, "-o",
                             "other", "--overwrite", "--report", "other.json")
            self.assertEqual(self.hash_of("other.json"), corner["state_hash"])

    def test_a_point(self):
        """Any point may be the origin, also one outside; keys may come in any order."""
        for dx, dy in ((0, 24), (-64, 0.5), (40, 8)):
            self.write_case("corner", "generated")
            self.write_case("centre", "generated", by=(dx, dy), origin=f"origin = [{dx}, {dy}]")
            corner, centre = self.run_pair()
            self.assertEqual(corner["state_hash"], centre["state_hash"])
        text = (self.folder / "centre.toml").read_text(encoding="utf-8")
        before, line, after = text.partition("origin = [40, 8]")
        self.write("later.toml", before + after.replace("size = 32", f"size = 32\n{line}", 1))
        self.run_program(1, "run", "later.toml", "--quiet", "--report", "later.json")
        self.assertEqual(self.hash_of("later.json"), corner["state_hash"])

    def test_command_line(self):
        self.write_case("centre", "region", by=(HALF, HALF))
        self.write_case("corner", "region")
        self.run_program(1, "run", "corner.toml", "--quiet", "--report", "corner.json")
        for word in ("box.origin=centre", 'box.origin="centre"', "box.origin=[16, 16]",
                     "box={origin = [16, 16]}"):
            self.run_program(1, "run", "centre.toml", "--quiet", "--set", word, "--report",
                             "centre.json")
            self.assertEqual(self.hash_of("centre.json"), self.hash_of("corner.json"), word)

    def test_box_that_grows(self):
        """The middle is that of the box at its start, wherever walls move."""
        sides = '[box.right]\nkind = "moving"\nspeed = 0.125'
        self.write_pair("region", sides=sides)
        self.run_pair("--set", "output.trajectory.precision=double")
        for name in ("checkpoints/checkpoint-000000000040.h5", "trajectory.h5"):
            corner, centre = (self.discs(f"{run}/{name}") for run in ("corner", "centre"))
            self.check_moved(corner, centre)


class Outputs(Origin):
    def test_lines(self):
        self.write_pair("listed")
        corner, centre = (
            self.run_program(3, "run", f"{name}.toml", "--quiet", "--set", "output.text=every_step",
                             "--digits", 17).out for name in ("corner", "centre"))
        for step in (0, 7, 40):
            both = [[list(map(float, line.split()[2:6])) for line in lines_of(text, step)]
                    for text in (corner, centre)]
            self.check_moved(*both)

    def test_formats(self):
        self.write_pair("generated")
        self.run_pair("--set", "output.trajectory.every_steps=40", "--set",
                      "output.trajectory.precision=double")
        for to in ("text", "csv", "xyz"):
            for name in ("checkpoints/checkpoint-000000000040.h5", "trajectory.h5"):
                corner, centre = (
                    self.discs(f"{run}/{name}", to) if to != "xyz" or "check" in name else
                    self.discs(f"{run}/checkpoints/checkpoint-000000000040.h5", to)
                    for run in ("corner", "centre"))
                self.check_moved(corner, centre)
        head = self.run_program(1, "convert", "centre/trajectory.h5", "--to", "xyz").out
        self.assertIn('Origin="-16 -16 0"', head.splitlines()[1])
        for path in (checkpoint("centre", 40), "centre/trajectory.h5"):
            self.assertIn("(16, 16) from the lower left corner",
                          self.run_program(1, "info", path).out)
            self.run_program(1, "verify", path)
        out = self.run_program(1, "diff", checkpoint("corner", 40), checkpoint("centre", 40),
                               code=1).out
        self.assertIn("origin: 0 and 16", out)

    def test_tables(self):
        quantities = '["density", "profiles", "obstacle_forces"]'
        self.write_pair("generated")
        keys = ("every_steps=2", f"quantities={quantities}", "profile_columns=4", "profile_rows=5")
        self.run_pair(*(word for key in keys for word in ("--set", f"output.measurements.{key}")))
        for table, columns in (("density_x", ("from", "to")), ("density_y", ("from", "to")),
                               ("profiles", ("x", "y")), ("obstacle_forces", ("x", "y"))):
            both = []
            for name in ("corner", "centre"):
                path = self.folder / name / "measurements" / f"{table}.csv"
                with open(path, encoding="utf-8") as file:
                    both.append(list(csv.DictReader(line for line in file if line[0] != "#")))
            self.assertTrue(both[0])
            for one, other in zip(*both, strict=True):
                for column, text in one.items():
                    moved = float(text) - HALF if column in columns else text
                    self.assertEqual(float(other[column]) if column in columns else other[column],
                                     moved, (table, column))


class Restarts(Origin):
    def test_restart(self):
        """Discs that froze stay where they were, on another number of ranks, too."""
        self.write_pair("generated")
        corner, _ = self.run_pair()
        self.check_restart("centre.toml", first=20, last=40)
        self.assertEqual(self.hash_of("rest.json"), corner["state_hash"])
        self.run_program(2, "run", "centre.toml", "--quiet", "-o", "more", "--steps", 20)
        self.run_program(3, "run", "centre.toml", "--quiet", "-o", "more", "--resume", "--report",
                         "more.json")
        self.assertEqual(self.hash_of("more.json"), corner["state_hash"])

    def test_a_restart_cannot_change_it(self):
        self.write_pair("region")
        self.run_pair("--steps", 10)
        self.run_program(1, "run", "--restart", "centre", "--set", "box.origin=[15, 16]", code=2,
                         says="'box.origin' is \"centre\" there and [15, 16] here; a restart "
                              "cannot change it")
        self.run_program(1, "run", "--restart", "centre", "--set", "box.origin=[16, 16]", "--steps",
                         20)

    def test_discs_of_another_run(self):
        """Places keep their coordinates; with the same origin they keep their bits."""
        self.write_pair("region")
        self.run_pair("--set", "output.trajectory.every_steps=40", "--set",
                      "output.trajectory.precision=double")
        discs = self.discs(checkpoint("centre", 40))
        for number, path in enumerate((checkpoint("{}", 40), "{}/trajectory.h5")):
            for name, origin in (("corner", ""), ("centre", CENTRE)):
                self.write(f"next_{name}.toml", SCENE.format(
                    origin=origin, size=32, sides="", method="event-driven", effects="",
                    discs=f'radius = 0.5\nfrom = "{path.format(name)}"'))
                self.run_program(1 + 2 * number, "run", f"next_{name}.toml", "--quiet", "--report",
                                 f"{name}.json")
            self.assertEqual(self.hash_of("corner.json"), self.hash_of("centre.json"))
            larger = 'radius = 0.5\nfrom = "' + path.format("centre") + '"'
            self.write("larger.toml", SCENE.format(origin=CENTRE, size=64, sides="", discs=larger,
                                                   method="event-driven", effects=""))
            self.run_program(2, "run", "larger.toml", "--quiet", "--steps", 0, "-o", "larger",
                             "--overwrite")
            for disc, other in zip(self.discs(checkpoint("larger", 0)), discs, strict=True):
                self.assertLessEqual(max(abs(x - y) for x, y in zip(disc, other)), 2**-48)
        self.write("wrong.toml", SCENE.format(origin="", size=32, sides="", discs=larger,
                                              method="event-driven", effects=""))
        self.run_program(1, "run", "wrong.toml", code=2, says="is not inside the box")

    def test_text_there_and_back(self):
        """A sum with an origin of many digits rounds once, and never again."""
        origin = "origin = [0.1, 9.7]"
        self.write_case("first", "region", by=(0.1, 9.7), origin=origin)
        self.run_program(1, "run", "first.toml", "--quiet", "-o", "first")
        path, texts = checkpoint("first", 40), []
        for number in range(3):
            texts.append(self.run_program(1, "convert", path, "--to", "text").out)
            discs = [line.split()[1:6] for line in texts[-1].splitlines()]
            self.write("discs.txt", "".join(" ".join(words) + "\n" for words in discs))
            self.write("again.toml", SCENE.format(
                origin=origin, size=32, sides="", method="event-driven", effects="",
                discs='radius = 0.5\nfile = "discs.txt"'))
            self.run_program(2, "run", "again.toml", "--quiet", "--steps", 0, "-o", f"r{number}")
            path = checkpoint(f"r{number}", 0)
            places = [[list(map(float, line.split()[2:4])) for line in text.splitlines()]
                      for text in (texts[0], texts[-1])]
            for (x, y), (u, v) in zip(*places, strict=True):
                self.assertLessEqual(max(abs(x - u), abs(y - v)), 2**-48)  # an ulp of 32
        hashes = [self.run_program(1, "info", checkpoint(f"r{number}", 0)).out for number in (0, 2)]
        self.assertEqual(*[[line for line in text.splitlines() if "hash" in line]
                           for text in hashes])


class Refused(Origin):
    def test_values(self):
        def write(line):
            self.write_case("wrong", "region", origin=line)
        self.check_refused(write, (
            ("origin = nan", '\'box.origin\' must be "centre", or two numbers, [x, y], not a num'),
            ("origin = [nan, 0]", '\'box.origin\' must be "centre", or two numbers'),
            ("origin = [1, 2, 3]", "not an array of 3"),
            ("origin = [inf, 0]", '\'box.origin\' must be "centre", or two numbers'),
            ('origin = "center"', 'try: "centre"'),
            ('origin = "left"', '\'box.origin\' must be "centre", or two numbers'),
        ))
        self.write("wrong.toml", SCENE.format(origin="origin = [1e9, 0]", size=32, sides="",
                                              discs="radius = 1\ncount = 2", effects="",
                                              method="event-driven"))
        self.run_program(1, "run", "wrong.toml", code=2, says="'box.origin' must be within 32000")

    def test_places(self):
        """A disc, a region or an obstacle outside is named in the coordinates of the scene."""
        def write(text):
            discs, _, effects = text.partition("|")
            self.write("wrong.toml", SCENE.format(origin=CENTRE, size=32, sides="", discs=discs,
                                                  method="event-driven", effects=effects))
        one = "radius = 0.5\nlist = [[{}, {}, 0, 0]]"
        self.check_refused(write, (
            (one.format(15.9, 0), "disc 0 at (15.9, 0) is not inside the box: centres lie between "
                                  "-15.5 and 15.5 along x, -15.5 and 15.5 along y"),
            ("count = 4\nradius = 0.5\nregion = [-17, 0, 1, 1]",
             "the region [-17, 0, 1, 1] must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1, inside "
             "a box of side 32, whose lower left corner is at (-16, -16)"),
            (one.format(0, 0) + "|[effects.obstacles]\ndiscs = [[0.1, 16.5, 1]]",
             "the centre (0.1, 16.5) is not in the box, whose lower left corner is at (-16, -16)"),
            (one.format(0, 0) + "|[effects.obstacles]\nsegments = [[0, 0, 0.3, 20]]",
             "the segment from (0, 0) to (0.3, 20) has an end outside the box"),
            (one.format(0.3, 0.1) + "|[effects.obstacles]\ndiscs = [[0, 0, 1]]",
             "disc 0 at (0.3, 0.1) overlaps fixed disc 1"),
        ))
        self.write("discs.txt", "0 -15.9 0 0 0\n")
        self.write("wrong.toml", SCENE.format(origin=CENTRE, size=32, sides="", effects="",
                                              discs='radius = 0.5\nfile = "discs.txt"',
                                              method="event-driven"))
        self.run_program(3, "run", "wrong.toml", code=2, says="disc 0 at (-15.9, 0) is not inside")

    def test_texts_of_the_course(self):
        scene = SOURCES / "inputs" / "tiny.in"
        self.run_program(1, "run", scene, "--set", "box.origin=centre", code=2,
                         says="'box.origin' has no meaning for legacy text")
        self.write_case("centre", "region", by=(HALF, HALF), origin=CENTRE, method="time-stepped")
        self.write("output.txt", "0 0 1 1 0 0\n")
        self.run_program(1, "compare", "output.txt", "centre.toml", "--set",
                         "output.text=every_step", code=2, says="has box.origin")


if __name__ == "__main__":
    main()
