# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of contacts by pairs of species, `effects.contact.pairs`.

Expected velocities follow from restitution and Coulomb's law by hand, and the temperatures of a
mixture that cools from kinetic theory.
"""
import math
import sys

from program import SOURCES, ProgramTest, lines_of, main

sys.path.append(str(SOURCES / "tests" / "physics"))
from mixture_studies import ratio_of_theory  # noqa: E402

# Pairs that meet head-on, each in a lane of its own; ids count by species.
LANES = """
[box]
size = [40, 50]
[discs]
list = [[10, 5, 0.1, 0], [14, 5, -0.1, 0], [10, 15, 0.1, 0], [10, 25, 0.1, 0],
        [14, 15, -0.1, 0], [14, 35, -0.1, 0], [10, 45, 0.1, 0],
        [14, 25, -0.1, 0], [10, 35, 0.1, 0], [14, 45, -0.1, 0]]
species = [{count = 4, radius = 1}, {count = 3, radius = 1}, {count = 3, radius = 1}]
[effects.contact]
kind = "restitution"
restitution = 0.9
pairs = [{species = [2, 1], restitution = 0.25}, {species = [3, 2], restitution = 0.5},
         {species = [1, 1], restitution = 1}]
[time]
steps = 20
[output]
text = "ends"
"""
LEFT_BY_LANE = {5: 1, 15: 0.25, 25: 0.9, 35: 0.5, 45: 0.5}

ROUGH = """
[box]
size = 40
[discs]
list = [[10, 10, 0.3, 0], [12.5, 11, 0, 0]]
species = [{count = 1, radius = 1}, {count = 1, radius = 1}]
[effects.contact]
kind = "rough"
restitution = 1
tangential_restitution = 1
pairs = [{species = [1, 2], restitution = 0.8, tangential_restitution = 0.5, friction = 0.05}]
[time]
steps = 6
[output]
text = "ends"
"""

MORE = ["--set", "discs.species=[{count=300,radius=0.5},{count=300,radius=0.5}]", "--set",
        "box.size=90", "--quiet"]


class Pairs(ProgramTest):
    def rows(self, text, last, *words):
        """x, y, vx and vy of each disc at the last step."""
        run = self.run_program(1, "run", self.write("scene.toml", text), "--report", "r.json",
                               *words)
        return [list(map(float, line.split()[2:6])) for line in lines_of(run.out, last)]

    def test_head_on(self):
        """Both orders of species, the common number and equal discs of three species."""
        for method in ("event-driven", "time-stepped"):
            rows = self.rows(LANES, 20, "--set", f"time.method={method}")
            self.assertEqual(len(rows), 10)
            for _, y, vx, vy in rows:
                self.assertAlmostEqual(abs(vx), 0.1 * LEFT_BY_LANE[round(y)], delta=1e-15)
                self.assertEqual(vy, 0)

    def test_coulomb(self):
        """A disc that grazes one at rest slides: the impulse along the surface is the friction
        times the normal one.
        """
        rows = self.rows(ROUGH, 6)
        normal = (math.sqrt(3) / 2, 0.5)  # 2 apart, and 1 apart along y
        approach = 0.3 * normal[0]
        impulse = (1 + 0.8) / 2 * approach
        along = -0.05 * impulse  # along (-ny, nx), as the surface that comes
        expected = (impulse * normal[0] - along * normal[1],
                    impulse * normal[1] + along * normal[0])
        for found, by_hand in zip(rows[1][2:], expected):
            self.assertAlmostEqual(found, by_hand, delta=1e-12)

    def test_equal_numbers(self):
        """Rows that repeat the common numbers change no bit."""
        hashes = set()
        for more in ("", "pairs = [{species = [1, 2], restitution = 0.9}]"):
            text = LANES[:LANES.index("pairs =")] + more + LANES[LANES.index("\n[time]"):]
            self.rows(text, 20)
            hashes.add(self.hash_of("r.json"))
        self.assertEqual(len(hashes), 1)

    def test_every_shape(self):
        """The same bits on 1 to 5 ranks, over a restart, and under the check."""
        scene = SOURCES / "inputs/materials.toml"
        for method in ("event-driven", "time-stepped"):
            with self.subTest(method):
                options = [*MORE, "--overwrite", "--set", f"time.method={method}"]
                self.check_restart(scene, options, first=25, last=60)
                for ranks in (1, 3, 5):
                    self.run_program(ranks, "run", scene, *options, "--steps", 60, "--check",
                                     "--threads", 1 + ranks // 3, "-o", "checked", "--report",
                                     "c.json")
                    self.assertEqual(self.hash_of("c.json"), self.hash_of("whole.json"))

    def test_two_temperatures(self):
        """The numbers of the three pairs lead to a ratio of temperatures that kinetic theory
        knows. Means over 5 states of 2 times 1000 discs scatter by some 0.03.
        """
        options = ["--set", "discs.species=[{count=1000,radius=0.5},{count=1000,radius=0.5}]",
                   "--set", "box.size=160", "--quiet", "--steps", 240]
        run = self.run_program(1, "run", SOURCES / "inputs/materials.toml", *options, "--set",
                               "output.text=every_step")
        ratios = []
        for step in range(80, 241, 40):
            energies = [0, 0]
            for line in lines_of(run.out, step):
                words = line.split()
                energies[int(words[1]) >= 1000] += float(words[4]) ** 2 + float(words[5]) ** 2
            ratios.append(energies[1] / energies[0])
        theory = ratio_of_theory(0.95, 0.9, 0.5)
        self.assertAlmostEqual(theory, 0.844, delta=0.001)
        self.assertAlmostEqual(sum(ratios) / len(ratios), theory, delta=0.1)

    def test_frozen_and_grouped(self):
        """Rows of species keep their numbers where groups count discs, and where some freeze:
        all pairs that meet are elastic, and the others are not."""
        text = """
            [box]
            size = [40, 10]
            [discs]
            species = [{radius = 1}, {radius = 1}, {radius = 1}]
            freeze = [[0, 0, 3, 10]]
            speed = 0.1
            [[discs.groups]]
            count = 1
            species = 1
            region = [0, 0, 3, 3]
            [[discs.groups]]
            count = 3
            species = 3
            region = [5, 0, 40, 10]
            [[discs.groups]]
            count = 2
            species = 2
            region = [5, 0, 40, 10]
            [effects.contact]
            kind = "restitution"
            restitution = 0.5
            pairs = [{species = [3, 3], restitution = 1}, {species = [2, 3], restitution = 1},
                     {species = [1, 3], restitution = 0}, {species = [2, 2], restitution = 1}]
            [effects.obstacles]
            restitution = 1
            [time]
            steps = 2000
            """
        self.run_program(1, "run", self.write("scene.toml", text), "--check", "--report", "r.json")
        report = self.report("r.json")
        self.assertGreater(report["pair_collisions"], 10)
        self.assertAlmostEqual(report["kinetic_energy"], 5 * 0.005, delta=1e-12)

    def test_refused(self):
        for pairs, says in (
                ("{species = [1, 4], restitution = 0}", "from 1 to 3, not 4"),
                ("{species = [1, 1.5], restitution = 0}", "from 1 to 3, not 1.5"),
                ("{species = [1, 2]}", "it gives no number"),
                ("{species = [1, 2], restitution = 1.5}", "must be from 0 to 1, not 1.5"),
                ("{species = [1, 2], friction = 1}", "without effects.contact.kind = \"rough\""),
                ("{species = [1, 2], restitution = 0.5, friction = nan}",
                 "friction must be a number, not nan"),
                ("{restitution = 1}", "needs species = [i, j]"),
                ("{species = [1, 2], restitution = 1}, {species = [2, 1], restitution = 1}",
                 "row 2 of 'effects.contact.pairs': row 1 has this pair already")):
            text = LANES[:LANES.index("pairs =")] + f"pairs = [{pairs}]" + \
                LANES[LANES.index("\n[time]"):]
            self.run_program(1, "run", self.write("scene.toml", text), code=2, says=says)
        plain = LANES.replace("species = [{count = 4, radius = 1}, {count = 3, radius = 1}, "
                              "{count = 3, radius = 1}]", "")
        self.run_program(1, "run", self.write("scene.toml", plain), code=2,
                         says="has no meaning without 'discs.species'")


if __name__ == "__main__":
    main()
