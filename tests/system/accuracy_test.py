# SPDX-License-Identifier: BSD-3-Clause
"""`carrom accuracy` writes a line for each trial into a new table and can be shared out;
`--accuracy` chooses a setting that a restart keeps.
"""
import collections

from program import ProgramTest, main

SCENE = """
[box]
size = 46
[discs]
count = 200
packing = 0.3
speed = 0.2
[time]
method = "time-stepped"
steps = 20
"""

OPTIONS = ["--starts", 2, "--repetitions", 2, "--micro-steps", 2, "--collisions", 10, "--approach",
           5, "--quiet"]


class Accuracy(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("small.toml", SCENE)

    def study(self, output, *words, scene="small.toml", ranks=1, **expected):
        return self.run_program(ranks, "accuracy", scene, *OPTIONS, *words, "--output", output,
                                **expected)

    def rows(self, *files):
        """The lines of the tables, split at commas; without their heads."""
        return [line.split(",") for file in files
                for line in (self.folder / file).read_text(encoding="utf-8").splitlines()[1:]]

    def bits(self, *files):
        """All columns but the times, in any order."""
        return sorted(row[:30] for row in self.rows(*files))

    def test_table(self):
        self.assertEqual(self.study("whole.csv").out, "")
        rows = self.rows("whole.csv")
        self.assertEqual(len(rows), 2 * 2 * 2 * 2 * 6)
        runs = collections.Counter(tuple(row[8:13]) for row in rows)
        self.assertEqual(len(runs), 24)
        self.assertEqual(set(runs.values()), {4}, "every setting twice from both starts")
        self.assertGreater(min(float(row[16]) for row in rows), 0, "collisions")
        self.assertGreater(min(float(row[30]) for row in rows), 0, "seconds")
        repeated = collections.Counter(tuple(row[:15] + row[16:30]) for row in rows)
        self.assertEqual(set(repeated.values()), {2}, "a repetition has other results")

        shares = [f"share{k}.csv" for k in (1, 2, 3)]
        for k, share in enumerate(shares, 1):
            self.study(share, "--share", f"{k}/3")
        self.assertEqual(self.bits(*shares), self.bits("whole.csv"))

        # The folder of a scene is no part of its name.
        (self.folder / "elsewhere").mkdir()
        self.write("elsewhere/small.toml", SCENE)
        self.study("moved.csv", scene="elsewhere/small.toml")
        self.assertEqual(self.bits("moved.csv"), self.bits("whole.csv"))

    def test_table_is_a_new_file(self):
        self.write("known.csv", "of another study\n")
        for place, why in (("known.csv", "is there already; name a new file"),
                           ("small.toml", "is the input itself"),
                           ("/dev/full", "is not a plain file")):
            self.study(place, code=2, says=f"--output {place}: {why}")
        self.assertEqual((self.folder / "known.csv").read_text(), "of another study\n")
        self.study("nowhere/table.csv", code=2)

    def test_distances(self):
        """None between the event-driven method and itself, all above 0 and below the box's
        diagonal, and the same again.
        """
        for output in ("distances.csv", "again.csv"):
            self.study(output, "--distances", "--arithmetic", "stable")
        rows = self.rows("distances.csv")
        self.assertEqual(len({tuple(row[8:11]) for row in rows}), 3, "settings beside the exact")
        self.assertGreaterEqual(len(rows), 2 * 3 * 9, "not a distance for every collision")
        for row in rows:
            self.assertTrue(0 < float(row[15]) < 65 * 1.5, row)
        self.assertEqual(self.rows("again.csv"), rows)

    def test_wrong_options(self):
        self.study("two.csv", ranks=2, code=2, says="runs on one rank")
        self.assertFalse((self.folder / "two.csv").exists())
        self.run_program(1, "accuracy", "small.toml", "--starts", 0, "--share", "4/3",
                         "--arithmetic", "some", "--output", "none.csv", code=2,
                         says=["--starts", "--share", "--arithmetic"])

    def test_choice_is_kept(self):
        for ranks in (1, 2):
            self.run_program(ranks, "run", "small.toml", "--accuracy", "1e-6", "--set",
                             f"output.folder=kept{ranks}", says='method = "event-driven"')
        self.run_program(1, "run", "small.toml", "--accuracy", "1e-6", "--steps", 30, "--set",
                         "output.folder=kept1", "--restart", "latest",
                         says="going on with the checkpoint")
        self.run_program(1, "run", "--restart", "kept1", "--steps", 40, "--accuracy", 0.2,
                         says="going on with the checkpoint's setting")
        self.run_program(1, "run", "--restart", "kept2", "--steps", 30, "--report", "report.json",
                         "--quiet")
        self.assertEqual(self.report("report.json")["method"], "event-driven")

    def test_report_names_the_precision(self):
        for ranks in (1, 3):
            self.run_program(ranks, "run", "small.toml", "--set", "time.precision=single", "--set",
                             "time.arithmetic=naive", "--set", "time.contraction=true", "--report",
                             "report.json", "--quiet")
            self.assertEqual(self.report("report.json")["precision"], "single")


if __name__ == "__main__":
    main()
