# SPDX-License-Identifier: BSD-3-Clause
"""Swap moves in runs: the same bits on every machine shape and over restarts, no overlaps beside
walls, obstacles and images, and what files and a new scene know of the radii.
"""
from program import ProgramTest, checkpoint, main

PERIODIC = """
[box]
size = 30
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "periodic"
top.kind = "periodic"
"""

# Between walls, beside obstacles and frozen discs, under gravity.
WALLED = """
[box]
size = 30
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "wall"
top.kind = "thermal"
top.temperature = 0.02
[effects.gravity]
y = -1e-4
[effects.obstacles]
discs = [[12, 14, 2.0]]
segments = [[2, 20, 8, 24]]
"""

REST = """
[discs]
count = 200
packing = {packing}
generator = "{generator}"
speed = 0.3
seed = 8
radius.distribution = "lognormal"
radius.polydispersity = 0.23
{freeze}
[time]
steps = 60
micro_steps = 3
sync_every = 7
method = "event-driven"
[effects.swap]
rounds = 3
seed = 77
[output.measurements]
quantities = ["psi6"]
every_steps = 10
"""

BOX = PERIODIC + REST.format(freeze="", packing=0.7, generator="compressed")
FULL = WALLED + REST.format(freeze="freeze = [[22, 2, 28, 8]]", packing=0.42, generator="random")

EVERY_TEN = ("--set", "output.checkpoint.every_steps=10", "--set", "output.checkpoint.keep=9")


class Swap(ProgramTest):
    def run_scene(self, name, text, *words, ranks=1):
        self.write(f"{name}.toml", text)
        threads = [] if "--threads" in words else ["--threads", 1]
        self.run_program(ranks, "run", f"{name}.toml", "-o", name, "--report", f"{name}.json",
                         "--overwrite", "--quiet", *threads, *words)
        return self.report(f"{name}.json")

    def radii_at(self, folder, step):
        """By id, from a checkpoint."""
        run = self.run_program(1, "convert", checkpoint(folder, step), "--to", "xyz")
        return [float(line.split()[8]) for line in run.out.splitlines()[2:]]

    def test_bits_do_not_depend_on_ranks_and_threads(self):
        for text, shapes in ((BOX, ((2, 2), (7, 1))), (FULL, ((3, 2), (5, 1), (1, 3)))):
            one = self.run_scene("some", text)
            self.assertGreater(one["swaps"], 100)
            for ranks, threads in shapes:
                other = self.run_scene("some", text, "--threads", threads, ranks=ranks)
                self.assertEqual(other["state_hash"], one["state_hash"])
                self.assertEqual(other["swaps"], one["swaps"])
        other_seed = self.run_scene("some", FULL, "--set", "effects.swap.seed=78")
        self.assertNotEqual(other_seed["state_hash"], one["state_hash"])

    def test_a_restart_on_another_shape_has_the_same_bits(self):
        for name, text in (("box", BOX), ("full", FULL)):
            with self.subTest(name):
                self.write("some.toml", text)
                self.check_restart("some.toml", ("--overwrite",), first=27, last=60)
                self.assertEqual(self.report("rest.json")["swaps"],
                                 self.report("whole.json")["swaps"])
                (self.folder / "kept").rename(self.folder / f"kept_{name}")

    def test_checks_hold_beside_walls_and_obstacles(self):
        report = self.run_scene("checked", FULL, "--check", ranks=2)
        self.assertEqual(report["overlapping_pairs"], 0)
        self.assertGreater(report["swaps"], 100)

    def test_swaps_keep_all_radii(self):
        self.run_scene("some", BOX, *EVERY_TEN)
        first, last = (self.radii_at("some", step) for step in (10, 60))
        self.assertEqual(sorted(first), sorted(last))
        self.assertGreater(sum(a != b for a, b in zip(first, last)), 100)

    def test_until_step_ends_them(self):
        """A sync at each 7 / 3 steps: the last one that counts is at step 28."""
        self.run_scene("some", BOX, "--set", "effects.swap.until_step=29", *EVERY_TEN)
        earlier, now, last = (self.radii_at("some", step) for step in (20, 30, 60))
        self.assertNotEqual(earlier, now)
        self.assertEqual(now, last)

    def test_constant_pressure_goes_with_swaps(self):
        more = ("--set", "effects.barostat.pressure=6", "--set",
                "output.measurements.quantities=[\"volume\"]")
        one = self.run_scene("some", BOX, *more)
        other = self.run_scene("some", BOX, *more, "--check", ranks=3)
        self.assertEqual(other["state_hash"], one["state_hash"])
        self.assertEqual(one["overlapping_pairs"], 0)
        self.assertGreater(one["swaps"], 100)
        self.assertNotEqual(one["last_packing"], one["packing"])

    def test_other_scenes_cannot_take_the_discs(self):
        self.run_scene("some", BOX)
        text = BOX.replace("count = 200", f"from = \"{checkpoint('some', 60)}\"")
        text = text.replace("compressed", "file")
        self.write("other.toml", text)
        self.run_program(1, "run", "other.toml", code=2, says="have exchanged their radii")


if __name__ == "__main__":
    main()
