# SPDX-License-Identifier: BSD-3-Clause
"""Scenes that begin, by `discs.from`, with what an open box has left: discs that have departed are
left out, those halfway through the open side go on, and all fly as in the run that they come from.
"""
from program import ProgramTest, checkpoint, main

ESCAPE = """
[box]
size = 10
right.kind = "open"
[discs]
radius = 1
list = [[2, 3, 0.3, 0], [5, 7, -0.5, 0]]
[time]
steps = 60
"""

NEXT = """
[box]
size = 10
{}
[discs]
radius = 1
from = "out/checkpoints/checkpoint-000000000029.h5"
[time]
steps = 4
"""

GATE = """
[box]
size = [40, 80]
bottom.kind = "open"
[discs]
{}
radius = 1
[effects.contact]
kind = "rough"
restitution = 0.5
tangential_restitution = 0
friction = 0.5
contact_time = 0.01
[effects.gravity]
y = -0.01
[effects.obstacles]
segments = [[0, 10, 15, 10], [25, 10, 40, 10]]
[time]
steps = {}
sync_every = 2
"""

# Two species, and two sides through which they leave.
MIXED = """
[box]
size = 30
left.kind = "open"
top.kind = "open"
[discs]
{}
[[discs.species]]
count = {}
radius = 0.8
mass = 3
[[discs.species]]
count = {}
radius = 0.5
[time]
method = "{}"
steps = 60
[output.trajectory]
every_steps = 10
precision = "double"
"""


class Departed(ProgramTest):
    def discs(self, path):
        """x, y, vx and vy of each disc, by id."""
        lines = self.run_program(1, "convert", path, "--to", "csv").out.splitlines()
        names = lines[0].split(",")
        rows = [dict(zip(names, map(float, line.split(",")))) for line in lines[1:]]
        return {int(row["id"]): [row[name] for name in ("x", "y", "vx", "vy")] for row in rows}

    def check_same(self, expected, found):
        for before, after in zip(expected, found, strict=True):
            for a, b in zip(before, after):
                self.assertAlmostEqual(a, b, delta=1e-9)

    def test_halfway(self):
        """Disc 1 left at 28; disc 0 stands at 10.7, and its centre comes to 11 at step 30."""
        self.write("escape.toml", ESCAPE)
        self.run_program(1, "run", "escape.toml", "--steps", 29, "-o", "out")
        self.write("next.toml", NEXT.format('right.kind = "open"'))
        for ranks in 1, 3:
            self.run_program(ranks, "run", "next.toml", "-o", f"on_{ranks}",
                             says="1 of 2 discs in out/checkpoints/checkpoint-000000000029.h5 "
                                  "departed by an open side and are left out")
        self.assertEqual(self.discs(checkpoint("on_3", 4)), {0: [11, 3, 0, 0]})
        self.run_program(1, "run", "next.toml", "--steps", 0, "-o", "begun")
        self.check_same([[10.7, 3, 0.3, 0]], self.discs(checkpoint("begun", 0)).values())
        self.write("closed.toml", NEXT.format(""))
        self.run_program(1, "run", "closed.toml", code=2, says='set box.right.kind = "open"')
        self.run_program(3, "run", "next.toml", "--set", "discs.count=2", code=2,
                         says="has 1 disc in the box, and 1 that departed by an open side, and the "
                              "scene is of 2")
        self.run_program(1, "run", "escape.toml", "--steps", 40, "-o", "out_40")
        self.run_program(3, "run", "next.toml", "--set", "discs.from=" +
                         checkpoint("out_40", 40), code=2, says="all its discs departed")

    def test_packing_of_fewer_discs(self):
        """The packing fraction of one disc of radius 1 is half that of two: sqrt(2) follows."""
        self.write("escape.toml", ESCAPE.replace("radius = 1", "packing = 0.06283185307179587"))
        self.run_program(1, "run", "escape.toml", "--steps", 29, "-o", "out")
        text = NEXT.format('right.kind = "open"')
        self.write("next.toml", text.replace("radius = 1", "packing = 0.06283185307179587"))
        for ranks in 1, 3:
            self.run_program(ranks, "run", "next.toml", "--quiet",
                             says="the radius 1.414213562, and in the file it is 1; try: "
                                  "discs.radius = 1 in place of discs.packing")
        self.write("next.toml", text)
        self.assertNotIn("discs.packing", self.run_program(1, "run", "next.toml", "--quiet").err)

    def test_hints_of_closed_sides(self):
        """Of discs that reach over a side, be their centre beyond it or not, and over two."""
        for x, y, sides in ((-0.5, 5, ["left"]), (0.5, 5, ["left"]), (9.6, 5, ["right"]),
                            (5, 9.5, ["top"]), (5, -0.1, ["bottom"]),
                            (9.7, 0.4, ["right", "bottom"])):
            scene = "[box]\nsize = 10\n" + "".join(
                f'{side}.kind = "open"\n' for side in ("left", "right", "bottom", "top"))
            self.write("open.toml", f"{scene}[discs]\nradius = 1\nlist = [[{x}, {y}, 0, 0]]\n"
                       "[time]\nsteps = 0\n")
            self.run_program(1, "run", "open.toml", "--quiet", "-o", "out", "--overwrite")
            self.write("next.toml", "[box]\nsize = 10\n[discs]\nradius = 1\nfrom = "
                       f'"{checkpoint("out", 0)}"\n[time]\nsteps = 1\n')
            says = " and ".join(f'box.{side}.kind = "open"' for side in sides)
            self.run_program(1, "run", "next.toml", code=2,
                             says=f"if it is halfway through an open side, set {says}\n")

    def test_gate(self):
        """A hopper's heap goes on to fall through the gate."""
        self.write("gate.toml", GATE.format("count = 300\nspeed = 0.05", 500))
        self.run_program(1, "run", "gate.toml", "--quiet", "-o", "out", "--report", "left.json")
        self.run_program(1, "run", "gate.toml", "--quiet", "--steps", 504, "-o", "on")
        left = self.report("left.json")
        n_there = 300 - sum(left["departed"])
        self.assertLess(n_there, 300)
        self.write("next.toml", GATE.format(f'from = "{checkpoint("out", 500)}"', 4))
        hashes = []
        for ranks in 1, 3:
            self.run_program(ranks, "run", "next.toml", "-o", f"next_{ranks}", "--report",
                             "next.json", says=f"{300 - n_there} of 300 discs in")
            self.assertEqual(self.report("next.json")["n_discs"], n_there)
            hashes.append(self.hash_of("next.json"))
        self.assertEqual(hashes[0], hashes[1])
        at_rest = [0, 0]
        before, whole = self.discs(checkpoint("out", 500)), self.discs(checkpoint("on", 504))
        there = [id for id, disc in before.items() if disc[1] > -1 or disc[2:] != at_rest]
        self.assertEqual(len(there), n_there)
        self.check_same([whole[id] for id in there],
                        self.discs(checkpoint("next_3", 4)).values())

    def test_mixed(self):
        """In both methods, from a checkpoint and from a frame."""
        for method in "event-driven", "time-stepped":
            self.write("gas.toml", MIXED.format("speed = 0.2", 60, 90, method))
            self.run_program(2, "run", "gas.toml", "--quiet", "-o", method)
            frame = self.discs(checkpoint(method, 60))
            self.run_program(1, "run", "gas.toml", "--quiet", "--steps", 40, "-o", f"{method}_40")
            first = checkpoint(f"{method}_40", 40)
            start = self.discs(first)
            there = [id for id, (x, y, vx, vy) in start.items()
                     if (x >= 0 and y <= 30) or (vx, vy) != (0, 0)]
            n = [sum(id < 60 for id in there), sum(id >= 60 for id in there)]
            self.assertTrue(0 < n[0] < 60 and 0 < n[1] < 90)
            for name, ranks in ((f'"{first}"', 3),
                                (f'"{method}/trajectory.h5"\nfrom_step = 40', 1)):
                self.write("next.toml", MIXED.format(f"from = {name}", *n, method))
                self.run_program(ranks, "run", "next.toml", "--steps", 20, "-o", "next",
                                 "--overwrite", says=f"{150 - sum(n)} of 150 discs in")
                self.check_same([frame[id] for id in there],
                                self.discs(checkpoint("next", 20)).values())
            self.write("wrong.toml", MIXED.format(f"from = {name}", 60, 90, method))
            self.run_program(1, "run", "wrong.toml", code=2,
                             says=f"(in the box of each species: {n[0]}, {n[1]})")


if __name__ == "__main__":
    main()
