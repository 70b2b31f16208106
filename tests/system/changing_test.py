# SPDX-License-Identifier: BSD-3-Clause
"""Runs that are still changing say so: melting and freezing by psi6, ageing glasses by F_s, and
replicas that scatter more than each of them claims. Gases in equilibrium say nothing of the kind.
"""
import csv
import math

from program import SOURCES, ProgramTest, main

SIDES = "".join(f'{side} = {{ kind = "periodic" }}\n'
                for side in ("left", "right", "bottom", "top"))


def box(discs_area, packing):
    return f"[box]\nsize = {math.sqrt(discs_area * math.pi / packing)!r}\n{SIDES}"


MELTING = ["run", SOURCES / "inputs/crystal.toml", "--set", "discs.packing=0.69", "--set",
           "discs.speed=0.06", "--threads", 1]
FREEZING = box(1024, 0.72) + """[discs]
count = 1024
radius = 1
generator = "compressed"
speed = 0.12
seed = 3
[time]
method = "event-driven"
steps = 3000
"""
GLASS = box(200 + 200 * 1.96, 0.785) + """[discs]
generator = "compressed"
speed = 0.05
seed = 3
[[discs.species]]
count = 200
radius = 1
[[discs.species]]
count = 200
radius = 1.4
[time]
method = "event-driven"
steps = 20000
[output.measurements]
quantities = ["correlations"]
every_steps = 4
"""
LIQUID = box(256, 0.5) + """[discs]
count = 256
radius = 1
speed = 0.6
[time]
method = "event-driven"
steps = 3000
[output]
averages_from_step = 200
[output.measurements]
quantities = ["psi6", "correlations"]
from_step = 200
every_steps = 8
largest_distance = 3
"""


class Changing(ProgramTest):
    def test_melting_crystal(self):
        """Its order halves, so that averages with small errors are not those of equilibrium."""
        ended = self.run_program(1, *MELTING, "--steps", 2000, "--report", "report.json")
        report = self.report("report.json")
        quarters = report["watched"]["psi6"]["quarters"]
        self.assertGreater(quarters[0], 1.5 * quarters[3])
        for text in (ended.err, report["doubts"]):
            self.assertIn("psi6", text)
            self.assertIn("carrom replicas", text)

    def test_freezing_liquid(self):
        scene = self.write("freezing.toml", FREEZING)
        self.run_program(1, "run", scene, "--threads", 1, "--report", "report.json")
        report = self.report("report.json")
        quarters = report["watched"]["psi6"]["quarters"]
        self.assertGreater(quarters[3], 1.3 * quarters[0])
        self.assertRegex(report["doubts"], "psi6 (is still changing|has only)")

    def test_watching_changes_nothing_else(self):
        """The same bits without a watch, on other ranks and after a restart."""
        self.run_program(1, *MELTING, "--steps", 600, "--set", "output.averages_from_step=600",
                         "--report", "alone.json")
        self.run_program(2, *MELTING, "--steps", 600, "-o", "whole")
        self.run_program(1, *MELTING, "--steps", 250, "-o", "kept")
        self.run_program(3, "run", "--restart", "kept", "--steps", 600, "--report", "rest.json")
        whole, rest = self.report("whole/report.json"), self.report("rest.json")
        self.assertNotIn("watched", self.report("alone.json"))
        self.assertEqual(self.hash_of("alone.json"), whole["state_hash"])
        self.assertEqual(rest["state_hash"], whole["state_hash"])
        self.assertEqual(rest["watched"], whole["watched"])

    def test_ageing_glass(self):
        scene = self.write("glass.toml", GLASS)
        ended = self.run_program(1, "run", scene, "--threads", 1, "-o", "glass")
        doubts = self.report("glass/report.json")["doubts"]
        self.assertRegex(doubts, "F_s of [0-9]+ steps depends on the waiting time")
        self.assertIn("depends on the waiting time", ended.err)
        with open(self.folder / "glass/measurements/correlations_waiting.csv",
                  encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        at = {float(row["from"]): float(row["scattering"]) for row in rows
              if float(row["steps"]) == 512}
        self.assertGreater(at[max(at)], at[0] + 0.1)  # discs have become slower

    def test_liquid_in_equilibrium(self):
        scene = self.write("liquid.toml", LIQUID)
        self.run_program(1, "run", scene, "--threads", 1, "-o", "liquid")
        report = self.report("liquid/report.json")
        self.assertEqual(set(report["watched"]), {"psi6", "local_psi6"})
        for word in ("psi6", "F_s", "still changing"):
            self.assertNotIn(word, report.get("doubts", ""))

    def test_replicas_of_rare_excursions(self):
        """At this packing most runs from a crystal never see the excursions that few see."""
        ended = self.run_program(2, "replicas", SOURCES / "inputs/crystal.toml", "--count", 16,
                                 "-o", "rare", "--steps", 2000, "--set", "discs.packing=0.716")
        self.assertIn("replicas scatter more than their errors claim", ended.err)
        self.assertGreater(self.report("rare/replicas.json")["pressure"]["scatter_over_claimed"],
                           1.82)

    def test_replicas_that_are_too_short(self):
        """Discs that have met one other disc still have the speeds that they began with."""
        ended = self.run_program(2, "replicas", SOURCES / "inputs/gas.toml", "--count", 8, "-o",
                                 "gas", "--steps", 400, "--set", "discs.count=300", "--set",
                                 "discs.packing=0.2", "--set", "output.averages_from_step=50")
        self.assertRegex(ended.err, "claim .*mean_speed")

    def test_replicas_in_equilibrium(self):
        scene = self.write("liquid.toml", LIQUID)
        ended = self.run_program(2, "replicas", scene, "--count", 8, "-o", "liquid", "--steps",
                                 1200)
        self.assertNotIn("warning", ended.err)
        ratios = [one["scatter_over_claimed"]
                  for one in self.report("liquid/replicas.json").values()
                  if isinstance(one, dict) and one["scatter_over_claimed"]]
        self.assertGreater(len(ratios), 5)
        self.assertTrue(all(0.3 < ratio < 1.9 for ratio in ratios), ratios)


if __name__ == "__main__":
    main()
