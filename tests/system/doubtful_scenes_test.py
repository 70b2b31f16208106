# SPDX-License-Identifier: BSD-3-Clause
"""Scenes whose numbers mean something else than their authors may think: the run says so."""
import math
import re

from program import ProgramTest, lines_of, main

BOX = "[box]\nsize = 40\n"
PERIODIC = BOX + "".join(f'{side}.kind = "periodic"\n'
                         for side in ("left", "right", "bottom", "top"))
GAS = "[discs]\ncount = 200\nradius = 0.5\nspeed = 0.1\n[time]\nsteps = 0\n"
TRIANGLE = [[10, 10, 30, 10], [30, 10, 20, 28], [20, 28, 10, 10]]

THREE = """
[box]
size = 20
[discs]
radius = 1
list = {}
[time]
steps = {}
"""

HEAP = """
[box]
size = [20, 40]
[[discs.species]]
count = 10
radius = 1
mass = {}
[[discs.species]]
count = 20
radius = 0.8
[discs]
speed = 0.05
[effects.gravity]
y = -0.01
[effects.contact]
kind = "restitution"
restitution = 0.5
contact_time = 0.01
[effects.lasting_contacts]
speed = 0.05
[time]
steps = 10
sync_every = 2
"""


# A layer flows down a rough plane. The box is periodic along the flow.
CHUTE = """
[box]
size = [16, 44]
left.kind = "periodic"
right.kind = "periodic"
[discs]
count = 100
radius = 1
speed = 0.01
seed = {}
[effects.gravity]
x = 0.00406737
y = -0.00913545
[effects.contact]
kind = "rough"
restitution = 0.5
tangential_restitution = 0
friction = 0.5
contact_time = {}
[effects.lasting_contacts]
speed = 0.05
[effects.obstacles]
restitution = 0.5
tangential_restitution = 0
friction = 0.5
discs = [[1, 1, 1], [3, 1, 1], [5, 1, 1], [7, 1, 1], [9, 1, 1], [11, 1, 1], [13, 1, 1], [15, 1, 1]]
[time]
steps = 250
sync_every = 2
[output]
text = "none"
"""


def obstacles(segments=(), discs=()):
    return f"[effects.obstacles]\nsegments = {list(segments)}\ndiscs = {list(discs)}\n"


def is_in_triangle(x, y):
    sides = [(x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) for x0, y0, x1, y1 in TRIANGLE]
    return min(sides) > 0


class DoubtfulScenes(ProgramTest):
    def places(self, text, **expected):
        self.write("scene.toml", text)
        run = self.run_program(1, "run", "scene.toml", "--set", "output.text=ends", **expected)
        return run, [tuple(map(float, line.split()[2:4])) for line in lines_of(run.out, 0)]

    def check_closed(self, text, is_inside, n_regions=1):
        """The warning has the number of discs that `is_inside` counts, on any number of ranks."""
        run, places = self.places(text)
        n = sum(is_inside(x, y) for x, y in places)
        self.assertGreater(n, 3)
        says = (f"{n} of {len(places)} discs begin in {n_regions} region"
                f"{'s' if n_regions > 1 else ''} that effects.obstacles shut off")
        self.assertIn(says, run.err)
        self.run_program(3, "run", "scene.toml", "--quiet", says=says)

    def check_open(self, text):
        self.assertNotIn("shut off", self.places(text)[0].err)

    def test_closed_regions(self):
        self.check_closed(BOX + GAS + obstacles(TRIANGLE), is_in_triangle)
        ring = [[20 + 9 * math.cos(k * math.pi / 12), 20 + 9 * math.sin(k * math.pi / 12), 1]
                for k in range(24)]
        self.check_closed(PERIODIC + GAS + obstacles(discs=ring),
                          lambda x, y: math.hypot(x - 20, y - 20) < 9)
        # Corners that segments and walls close.
        self.check_closed(BOX + GAS + obstacles([[0, 15, 15, 0], [25, 40, 40, 25]]),
                          lambda x, y: x + y < 15 or x + y > 65, n_regions=2)

    def test_gaps_that_are_too_narrow(self):
        """A disc of radius 0.5 needs a gap of 1. Gaps of 0.6 to 0.95 are 1.2 to 1.9 radii wide."""
        for gap in (0.6, 0.95):
            # Along the last side, whose length is sqrt(10^2 + 18^2), and at a wall.
            part = gap / math.hypot(10, 18)
            sides = [*TRIANGLE[:2], [20, 28, 10 + 10 * part, 10 + 18 * part]]
            self.check_closed(BOX + GAS + obstacles(sides), is_in_triangle)
            self.check_closed(BOX + GAS + obstacles([[0, 15, 40 - gap, 15]]), lambda x, y: y < 15)
            ring = [[20 + 9 * math.cos(k * math.pi / 12), 20 + 9 * math.sin(k * math.pi / 12),
                     (18 * math.sin(math.pi / 24) - gap) / 2] for k in range(24)]
            self.check_closed(PERIODIC + GAS + obstacles(discs=ring),
                              lambda x, y: math.hypot(x - 20, y - 20) < 9)
        # Across a periodic side, and between a disc and a wall.
        row = [[4, 5, 36, 5], [36.9, 5, 40, 5], [0, 5, 3.1, 5], [0, 20, 40, 20]]
        self.check_closed(PERIODIC + GAS + obstacles(row), lambda x, y: 5 < y < 20)
        self.check_closed(BOX + GAS + obstacles([[0, 12, 36, 12]], [[37.6, 12, 1.5]]),
                          lambda x, y: y < 12)

    def test_ways_out(self):
        for gap in (1.001, 1.05, 1.2):
            self.check_open(BOX + GAS + obstacles([[0, 15, 40 - gap, 15]]))
            self.check_open(BOX + GAS + obstacles([[0, 15, 20, 15], [20 + gap, 15, 40, 15]]))
            self.check_open(BOX + GAS + obstacles([[0, 12, 36 - gap, 12]], [[37.5, 12, 1.5]]))
        gap = [[10, 10, 30, 10], [30, 10, 20, 28], [20, 28, 10.6, 11.08]]
        self.check_open(BOX + GAS + obstacles(gap))
        self.check_open(PERIODIC + GAS + obstacles([[0, 15, 40, 15]]))
        self.check_open(BOX + 'bottom.kind = "open"\n' + GAS + obstacles([[0, 15, 40, 15]]))
        # A list is where its author wants it.
        self.check_open(BOX + GAS.replace("count = 200", "list = [[20, 15, 0, 0], [5, 5, 0, 0]]")
                        .replace("speed = 0.1\n", "") + obstacles(TRIANGLE))

    def test_flow_faster_than_lasting_contacts(self):
        """The speed that the warning names makes each disc collide a fifth as often, or less."""
        for seed, contact_time in ((2, 0.01), (3, 0.002)):
            self.write("chute.toml", CHUTE.format(seed, contact_time))
            words = ("run", "chute.toml", "--quiet", "--threads", 1, "--report", "flow.json")
            run = self.run_program(1, *words, says="discs flow past each other faster than that")
            rate = self.report("flow.json")["collisions_per_disc_per_micro_step"]
            speed = re.search(r"try: (effects.lasting_contacts.speed = \S+)\n", run.err)[1]
            run = self.run_program(1, *words, "--set", speed.replace(" ", ""))
            self.assertNotIn("flow past", run.err)
            self.assertLess(self.report("flow.json")["collisions_per_disc_per_micro_step"],
                            rate / 5)

    def test_two_hits_at_once(self):
        """Disc 0 meets 1, and with what is left of its velocity 2, at the same time. Along unit
        vectors at 30 degrees to x, up and down, it loses the velocity that it has: it ends at
        (-1, -sqrt(3)) / 8. If both hits acted together it would have (-1/5, 0)."""
        self.write("three.toml", THREE.format("[[4, 10, 1, 0], [10, 11, 0, 0], [10, 9, 0, 0]]", 6))
        for ranks in 1, 3:
            run = self.run_program(ranks, "run", "three.toml", "--set", "output.text=ends",
                                   "--report", "three.json",
                                   says="at one time 1 collisions of pairs with an earlier one")
            self.assertEqual(self.report("three.json")["simultaneous_collisions"], 1)
            _, _, _, _, vx, vy = map(float, lines_of(run.out, 6)[0].split()[:6])
            self.assertAlmostEqual(vx, -1 / 8, delta=1e-7)
            self.assertAlmostEqual(vy, -math.sqrt(3) / 8, delta=1e-7)

    def test_blow_through_a_row(self):
        """The blow goes through four touching discs at one time; no count without such a row."""
        row = [[4, 10, 1, 0]] + [[10 + 2 * k, 10, 0, 0] for k in range(4)]
        self.write("row.toml", THREE.format(row, 6))
        self.run_program(2, "run", "row.toml", "--report", "row.json")
        self.assertEqual(self.report("row.json")["simultaneous_collisions"], 3)
        row[2:] = [[x + 0.01 * k, y, vx, vy] for k, (x, y, vx, vy) in enumerate(row[2:], 1)]
        self.write("apart.toml", THREE.format(row, 6))
        run = self.run_program(1, "run", "apart.toml", "--report", "apart.json")
        self.assertEqual(self.report("apart.json")["pair_collisions"], 4)
        self.assertNotIn("simultaneous_collisions", self.report("apart.json"))
        self.assertNotIn("at one time", run.err)

    def test_slots_a_rounding_wider_than_a_disc(self):
        """Between two lines, and between a line and a wall: no micro-step would ever end."""
        slots = {"lines": ("[10, 10, 0.01, 0.3]", "[9, 2, 9, 18], "
                           "[11.000000000000002, 2, 11.000000000000002, 18]"),
                 "wall": ("[1.0000000000000002, 10, 0.01, 0.3]",
                          "[2.0000000000000009, 2, 2.0000000000000009, 18]")}
        for name, (disc, segments) in slots.items():
            self.write(f"{name}.toml", f"""
                [box]
                size = 20
                [discs]
                radius = 1
                list = [{disc}, [5, 5, 0.1, 0.2]]
                [time]
                steps = 1
                [effects.obstacles]
                segments = [{segments}]
                restitution = 0.9
                """)
            for ranks in (1, 2):
                with self.subTest(name, ranks=ranks):
                    self.run_program(ranks, "run", f"{name}.toml", "--quiet", code=3, patience=60,
                                     says="disc 0 collides without end")

    def test_short_periods(self):
        """Few discs in an extremely long box would have more images than memory holds."""
        scene = """
            [box]
            size = [10, {}]
            left.kind = "periodic"
            right.kind = "periodic"
            [discs]
            count = 2
            radius = 0.5
            [time]
            steps = 1
            """
        self.write("long.toml", scene.format(1e16))
        run = self.run_program(1, "run", "long.toml", code=2, patience=60,
                               says="the periodic side 10 is too short beside the other one")
        self.assertEqual(len(run.err.splitlines()), 1, run.err)
        self.write("shorter.toml", scene.format(1e9))
        self.run_program(1, "run", "shorter.toml", "--quiet")

    def test_unlike_masses(self):
        for mass, is_warned in ((200, True), (0.005, True), (90, False)):
            self.write("heap.toml", HEAP.format(mass))
            run = self.run_program(1, "run", "heap.toml", "--quiet")
            self.assertEqual("heaviest disc has 200 times the mass" in run.err, is_warned, run.err)


if __name__ == "__main__":
    main()
