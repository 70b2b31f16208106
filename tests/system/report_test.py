# SPDX-License-Identifier: BSD-3-Clause
"""The report has every key that is promised, with the numbers that the hand-computed scene is known
to have.
"""
from program import SOURCES, ProgramTest, checkpoint, main

THREE_DISCS = SOURCES / "tests/system/expected/three_discs.in"

PROMISED = """
    version state_hash n_discs steps wall_collisions pair_collisions rejected_candidates
    overlapping_pairs averages radius box packing temperature pressure compressibility
    pressure_tensor lost_collisions kinetic_energy momentum wall_seconds ns_per_disc_step ranks
    threads phase_seconds phase_imbalance imbalance peak_bytes_per_disc
    """.split()

KNOWN = {"n_discs": 3, "steps": 5, "wall_collisions": 3, "pair_collisions": 1,
         "rejected_candidates": 0, "overlapping_pairs": 0, "kinetic_energy": 1.125, "ranks": 2,
         "threads": 2, "ranks_across": 1}

STREAMS = """
[box]
size = 40
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "periodic"
top.kind = "periodic"
[[discs.species]]
count = 30
radius = 1
mass = 2
[[discs.species]]
count = 10
radius = 0.5
mass = 1
[discs]
speed = 0.1
streams = [{ region = [0, 0, 20, 40], velocity = [0.25, -0.5] },
           { region = [20, 0, 40, 40], velocity = [0.75, 0.5] }]
[time]
method = "event-driven"
steps = 50
"""


def values_in(tree):
    """Every "value" of the report, at any depth."""
    for key, entry in tree.items():
        if key == "value":
            yield entry
        elif isinstance(entry, dict):
            yield from values_in(entry)


class Report(ProgramTest):
    def test_known_numbers(self):
        self.write("report.json", '{"old": 1}\n')
        run = self.run_program(2, "run", THREE_DISCS, "--threads", 2, "--report", "report.json")
        report = self.report("report.json")
        self.assertEqual([key for key in PROMISED if key not in report], [])
        self.assertEqual({key: report[key] for key in KNOWN}, KNOWN)
        self.assertRegex(report["state_hash"], "^[0-9a-f]{32}$")
        self.assertIn(report["state_hash"], run.err)
        self.assertEqual([file.name for file in self.folder.iterdir()], ["report.json"])

    def test_no_steps(self):
        self.run_program(1, "run", THREE_DISCS, "--steps", 0, "--quiet", "--report", "none.json")
        report = self.report("none.json")
        self.assertIsNone(report["temperature"]["value"])
        self.assertEqual([value for value in values_in(report) if value is not None], [])

    def test_drift_is_that_of_the_centre_of_mass(self):
        """30 discs of mass 2 and 10 of mass 1 move with two streams. The reference is the sum over
        the discs of the last checkpoint, as text.
        """
        self.write("streams.toml", STREAMS)
        self.run_program(2, "run", "streams.toml", "--quiet", "--threads", 1, "--report",
                         "drift.json", "-o", "streams")
        text = self.run_program(1, "convert", checkpoint("streams", 50), "--to", "text").out
        rows = [line.split() for line in text.splitlines() if not line.startswith("#")]
        masses = [2 if int(row[1]) < 30 else 1 for row in rows]
        self.assertEqual(sum(masses), 70)
        for axis, reported in enumerate(self.report("drift.json")["drift_velocity"]):
            momentum = sum(mass * float(row[4 + axis]) for mass, row in zip(masses, rows))
            self.assertAlmostEqual(reported, momentum / 70, delta=1e-12)
            self.assertGreater(abs(momentum / 70), (0.3, 1e-3 / 70)[axis])

    def test_files_of_others_stay(self):
        """Files that look like a report being written are somebody else's."""
        self.write("victim", "precious\n")
        (self.folder / "report.json.partial").symlink_to("victim")
        self.run_program(1, "run", THREE_DISCS, "--quiet", "--report", "report.json")
        self.assertEqual((self.folder / "victim").read_text(), "precious\n")
        self.write("other.json.partial", "of another run\n")
        self.run_program(1, "run", "nowhere.in", "--report", "other.json", code=2)
        self.assertEqual((self.folder / "other.json.partial").read_text(), "of another run\n")


if __name__ == "__main__":
    main()
