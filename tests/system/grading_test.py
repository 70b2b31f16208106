# SPDX-License-Identifier: BSD-3-Clause
"""`carrom compare` grades what is there: outputs that are cut, too long, in another order or with
other lines, programs with races or in single precision. The scores follow from the parts that
docs/classroom.md gives.
"""
import random
import subprocess
import sys

from program import SOURCES, ProgramTest, main

STUDENT = SOURCES / "tests" / "system" / "student.py"
STEPS = 12


class Grading(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.in", self.student("--scene", 30, 1.2, STEPS, 5))
        self.right = self.student(self.folder / "scene.in").splitlines()
        self.n_discs = len(self.right) // (STEPS + 1)

    def student(self, *words):
        """What the student's program prints: it shares nothing with the one that grades."""
        return subprocess.run([sys.executable, str(STUDENT), *map(str, words)], text=True,
                              capture_output=True, check=True).stdout

    def grade(self, lines, *options, code=1, scene="scene.in"):
        self.write("output.txt", "\n".join(lines) + "\n")
        return self.run_program(1, "compare", "output.txt", scene, "--points", *options,
                                code=code).out

    def score(self, text):
        """The score and the possible one, then each part as printed."""
        rows = text[text.index("points:"):].splitlines()
        _, points, _, most = rows[0].split()
        parts = {row.split()[0]: row.split(None, 1)[1].split(":")[0].strip() for row in rows[1:5]}
        return (int(points), int(most)), parts

    def test_all_points(self):
        text = self.grade(self.right, code=0)
        self.assertTrue(text.startswith("same: "), text)
        self.assertEqual(self.score(text)[0], (100, 100))

    def test_a_crash_after_a_step_costs_the_steps_that_are_missing(self):
        for n_steps, rest in ((1, 0), (1, 7), (6, 0), (6, 1)):
            lines = self.right[:self.n_discs * (n_steps + 1) + rest]
            text = self.grade(lines)
            score, parts = self.score(text)
            steps = 60 * n_steps // STEPS
            self.assertEqual(score, (10 + steps, 100), text)
            self.assertEqual(parts["steps"], f"{steps:2} of 60".strip())
            if rest == 0:
                self.assertIn(f"end of the output: {n_steps} steps, should be {STEPS}", text)
            else:
                self.assertIn(f"end of the output: step {n_steps + 1}, disc {rest} is missing",
                              text)
        cut_in_a_line = self.right[:self.n_discs * 3] + ["3 0 4.25"]
        self.assertEqual(self.score(self.grade(cut_in_a_line))[0], (10 + 60 * 2 // STEPS, 100))

    def test_one_step_too_few_or_too_many(self):
        for n_steps, steps in ((STEPS - 1, 55), (STEPS + 1, 60)):
            scene = (self.folder / "scene.in").read_text(encoding="ascii").splitlines()
            scene[3] = str(n_steps)
            self.write("other.in", "\n".join(scene) + "\n")
            lines = self.student(self.folder / "other.in").splitlines()
            text = self.grade(lines)
            if n_steps < STEPS:
                self.assertIn(f"end of the output: {n_steps} steps, should be {STEPS}", text)
            else:
                self.assertIn(f"step {n_steps} follows, should be {STEPS} steps", text)
            score, parts = self.score(text)
            self.assertEqual(score, (10 + steps + 20, 100), text)
            self.assertEqual((parts["lines"], parts["counters"]), ("0 of 10", "20 of 20"))
            # Wrong counters of that last step are found, too.
            text = self.grade([*lines[:-1], lines[-1].rsplit(" ", 1)[0] + " 99"])
            self.assertEqual(self.score(text)[0], (10 + steps, 100), text)

    def test_discs_outside_the_box_do_not_end_grading(self):
        lines = self.student(self.folder / "scene.in", "no-stop").splitlines()
        places = [float(line.split()[2]) for line in lines]
        self.assertTrue(max(places) > 16.5 or min(places) < -0.5)  # beyond the wall by a radius
        text = self.grade(lines)
        self.assertIn("rule: stop at a wall", text)
        self.assertIn(f" of {STEPS} steps follow", text)
        self.assertNotIn("missing", text)

    def test_lines_in_another_order_cost_five_points(self):
        chance = random.Random(3)
        mixed = []
        for step in range(STEPS + 1):
            lines = self.right[step * self.n_discs:(step + 1) * self.n_discs]
            mixed += chance.sample(lines, self.n_discs)
        text = self.grade(mixed)
        self.assertEqual(self.score(text)[0], (95, 100), text)
        self.assertIn("lines     5 of 10: discs are not in the order of ids", text)
        self.assertIn("rule: lines", text)
        last = [" ".join(line.split()[:6]) for line in mixed[-self.n_discs:]]
        self.assertIn("lines     0 of 10", self.grade(mixed[:-self.n_discs] + last))
        twice = [*self.right[:3], self.right[0], *self.right[4:]]
        self.assertIn("line 4: step 0 has disc 0 twice", self.grade(twice))

    def test_races_are_named(self):
        named = {"pair-free": "two discs that should collide flew on freely",
                 "wall-free": "a disc flew on freely through a wall",
                 "one-disc": "a collision changes only one of its two discs"}
        for mistake, text in named.items():
            for seed in (5, 6):  # scenes in which no wrong order gives the same lines
                self.write("race.in", self.student("--scene", 30, 1.2, STEPS, seed))
                lines = self.student(self.folder / "race.in", mistake).splitlines()
                graded = self.grade(lines, scene="race.in")
                self.assertIn(text, graded, f"{mistake} {seed}")
                # One step is wrong, and with it the counters.
                self.assertIn(f": {STEPS - 1} of {STEPS} steps", graded, f"{mistake} {seed}")

    def test_single_precision_is_named(self):
        for digits in (".9g", ".8f"):
            lines = self.student(self.folder / "scene.in", "single", digits).splitlines()
            text = self.grade(lines)
            self.assertIn("rule: precision\n", text)
            score, parts = self.score(text)
            self.assertEqual((parts["start"], parts["steps"]), ("0 of 10", "60 of 60"), text)
            self.assertEqual(score, (90, 100))
        # Single precision does not hide another mistake.
        lines[20 + self.n_discs] = " ".join([*lines[20 + self.n_discs].split()[:5], "0.7654321"])
        self.assertEqual(self.score(self.grade(lines))[1]["steps"], "50 of 60")
        # Few digits are not single precision.
        for digits in (".17g", ".8f", ".5f", ".6g"):
            lines = self.student(self.folder / "scene.in", "", digits).splitlines()
            self.assertNotIn("precision", self.grade(lines, code=(0, 6)))

    def test_other_lines_are_left_out_with_a_remark(self):
        text = self.grade(["step id x y vx vy", *self.right, "", "Elapsed 0.12 s"], code=0)
        self.assertEqual(self.score(text)[0], (100, 100))
        self.assertIn("remark: 2 lines were left out", text)
        self.assertIn("line 1: 'step id x y vx vy'", text)
        text = self.grade([*self.right[:40], "Elapsed 0.12 s", *self.right[40:]], code=0)
        self.assertIn("remark: a line was left out, because it is no line of a disc: line 41: "
                      "'Elapsed 0.12 s'", text)

    def test_steps_that_are_left_out_or_come_twice(self):
        at = self.n_discs * 4
        text = self.grade([*self.right[:at], *self.right[at + self.n_discs:]])
        self.assertIn(f"line {at + 1}: step 4 is missing before it", text)
        self.assertEqual(self.score(text)[0], (10 + 55 + 20, 100), text)
        text = self.grade([*self.right[:at], *self.right[at - 2 * self.n_discs:]])
        self.assertIn(f"line {at + 1}: step 2 follows step 3", text)
        self.assertEqual(self.score(text)[0], (10 + 15, 100), text)

    def test_the_last_step_alone_is_enough_if_not_all_are_wanted(self):
        ends = ["--set", "output.text=ends", "--set", "time.steps=3"]
        scene = (self.folder / "scene.in").read_text(encoding="ascii").splitlines()
        scene[3] = "3"
        self.write("short.in", "\n".join(scene) + "\n")
        lines = self.student(self.folder / "short.in").splitlines()
        text = self.grade(lines[-self.n_discs:], *ends, code=0)
        score, parts = self.score(text)
        self.assertEqual((score, parts["start"]), ((90, 90), "-"), text)
        self.assertEqual(self.score(self.grade(lines, *ends, code=0))[0], (100, 100))
        # If every step is required, the others are missing.
        text = self.grade(lines[-self.n_discs:], "--set", "time.steps=3")
        self.assertEqual(self.score(text)[0], (20 + 20, 100), text)
        wrong = lines[-self.n_discs:]
        wrong[4] = " ".join([*wrong[4].split()[:4], "1.5", "0.5", *wrong[4].split()[6:]])
        text = self.grade(wrong, *ends)
        self.assertEqual(self.score(text)[0], (30, 90), text)
        self.assertIn("line 5: step 3, disc 4 differs", text)

    def test_newer_texts_of_the_course_have_no_word_for_the_output(self):
        scene = (self.folder / "scene.in").read_text(encoding="ascii").splitlines()
        scene[3] = "3"
        self.write("old.in", "\n".join(scene) + "\n")
        right = self.student(self.folder / "old.in").splitlines()
        self.write("new.in", "\n".join([*scene[:4], "", *scene[5:]]) + "\n")
        scene[4] = "perf"
        self.write("perf.in", "\n".join(scene) + "\n")
        wanted = self.run_program(1, "run", "perf.in", "--report", "old.json")
        new = self.run_program(2, "run", "new.in", "--report", "new.json")
        self.assertEqual(new.out, wanted.out)
        self.assertEqual(self.hash_of("new.json"), self.hash_of("old.json"))
        for lines, most in ((right, 100), (right[-self.n_discs:], 90),
                            ([*right[:self.n_discs], *right[-self.n_discs:]], 100)):
            text = self.grade(lines, code=0, scene="new.in")
            self.assertEqual(self.score(text)[0], (most, most), text)
        # A wrong disc is named with the line that it has in the file.
        self.write("bad.in", "\n".join([*scene[:4], *scene[5:8], "3 1 x 0 0", *scene[9:]]) + "\n")
        self.run_program(1, "run", "bad.in", code=2, says="bad.in:8: ")
        self.write("cut.in", "\n".join(scene[:4]) + "\n")
        self.run_program(1, "run", "cut.in", code=2, says="cut.in:4: the input ends before 'print'")


if __name__ == "__main__":
    main()
