# SPDX-License-Identifier: BSD-3-Clause
"""Conditions of `time.stop` end a run at the first step with a sync at which they hold: the step is
found again by runs without conditions that end there and one check before.
"""
from program import ProgramTest, checkpoint, lines_of, main

GAS = """
[box]
size = 40
{}
[discs]
count = 120
packing = 0.2
seed = 5
speed = 0.05
[time]
steps = 4000
sync_every = 20
micro_steps = 3
stop = {{ {} }}
"""

COOLING = """
[effects.contact]
kind = "restitution"
restitution = 0.8
"""

GROWING = """
[effects.growth]
rate = 2e-4
"""


def is_checked(step):
    """20 micro-steps between syncs, 3 a step."""
    return step == 0 or step * 3 // 20 > (step - 1) * 3 // 20


def check_before(step):
    step -= 1
    while not is_checked(step):
        step -= 1
    return step


class Stop(ProgramTest):
    def run_gas(self, name, condition, *words, more="", sides="", ranks=1, scene=GAS):
        self.write(f"{name}.toml", scene.format(sides, condition) + more)
        run = self.run_program(ranks, "run", f"{name}.toml", "--report", f"{name}.json", *words)
        return self.report(f"{name}.json"), run

    def check_stop(self, key, limit, value_of, *, falls=False, more="", sides=""):
        """Runs with the condition and without it. `value_of` finds the number in a report."""
        condition = f"{key} = {limit}"
        stopped, run = self.run_gas("stop", condition, more=more, sides=sides)
        reason = stopped["stopped_by"]
        step = reason["step"]
        self.assertEqual(reason["key"], f"time.stop.{key}")
        self.assertEqual(reason["limit"], limit)
        self.assertTrue(is_checked(step), step)
        self.assertLess(100, step)
        self.assertLess(step, 4000)
        self.assertEqual(stopped["steps"], step)
        self.assertIn(f"at step {step} of 4000 by time.stop.{key} = {limit:g}", run.err)
        free, _ = self.run_gas("free", "", "--steps", step, more=more, sides=sides)
        self.assertNotIn("stopped_by", free)
        self.assertEqual(free["state_hash"], stopped["state_hash"])
        self.assertAlmostEqual(value_of(free) / reason["value"], 1, delta=1e-12)
        before, _ = self.run_gas("before", "", "--steps", check_before(step), more=more,
                                 sides=sides)
        now, then = value_of(free), value_of(before)
        if falls:
            self.assertTrue(now < limit <= then, (now, limit, then))
        else:
            self.assertTrue(then < limit <= now, (then, limit, now))
        for ranks in (3, 5):
            self.run_program(ranks, "run", "stop.toml", "--quiet", "--threads", 2, "--report",
                             "many.json")
            many = self.report("many.json")
            self.assertEqual(many["stopped_by"], reason)
            self.assertEqual(many["state_hash"], stopped["state_hash"])
        self.check_resumed(reason, stopped["state_hash"])

    def check_resumed(self, reason, state_hash):
        """A run in two stretches ends at the same step, and stays there if it is resumed again."""
        first = reason["step"] // 2 + 1
        self.run_program(2, "run", "stop.toml", "--quiet", "--steps", first, "-o", "kept")
        for ranks in (1, 3):
            self.run_program(ranks, "run", "-o", "kept", "--resume", "--quiet", "--steps", 4000,
                             "--report", "rest.json")
            rest = self.report("rest.json")
            self.assertEqual(rest["stopped_by"], reason)
            self.assertEqual(rest["state_hash"], state_hash)
        self.run_program(1, "verify", checkpoint("kept", reason["step"]))

    def test_collisions(self):
        self.check_stop("collisions", 500, lambda report: report["pair_collisions"])

    def test_temperature_of_a_gas_that_cools(self):
        """Between walls kT is the energy of motion over N."""
        self.check_stop("kT_below", 0.0004, lambda report: report["kinetic_energy"] / 120,
                        falls=True, more=COOLING)

    def test_energy(self):
        self.check_stop("energy_below", 0.06, lambda report: report["kinetic_energy"], falls=True,
                        more=COOLING)

    def test_departed(self):
        self.check_stop("departed", 30, lambda report: sum(report["departed"]),
                        sides='left.kind = "open"')

    def test_energy_of_a_driven_gas(self):
        """A hot wall heats the discs."""
        self.check_stop("energy_above", 0.17, lambda report: report["kinetic_energy"],
                        sides='left.kind = "thermal"\nleft.temperature = 0.003')

    def test_pressure_of_growing_discs(self):
        """The reference is the quantity "pressure", sampled where the condition is checked: each
        20 steps, because a step has one micro-step here.
        """
        scene = GAS.replace("micro_steps = 3", "micro_steps = 1").replace("= 4000", "= 3000")
        measured = "[output.measurements]\nquantities = [\"pressure\"]\nevery_steps = 20\n"
        free, _ = self.run_gas("free", "", "-o", "free", more=GROWING + measured, scene=scene)
        table = free["measurements"]["pressure_history"]
        pressures = [(xx + yy) / 2 for xx, yy in zip(table["xx"], table["yy"])]
        limit = sorted(pressures)[len(pressures) * 3 // 4]
        first = next(k for k, p in enumerate(pressures) if p > limit)
        stopped, _ = self.run_gas("stop", f"pressure_above = {limit!r}", more=GROWING, scene=scene)
        reason = stopped["stopped_by"]
        self.assertEqual(reason["step"], table["to_step"][first])
        self.assertAlmostEqual(reason["value"] / pressures[first], 1, delta=1e-12)
        self.assertGreater(first, 10)
        grown = 1 + 2e-4 * reason["step"]
        self.assertAlmostEqual(stopped["last_packing"], 0.2 * grown ** 2, delta=1e-12)
        self.check_resumed(reason, stopped["state_hash"])

    def test_text_and_checkpoint_of_the_last_step(self):
        """The step is the last one of all outputs."""
        report, run = self.run_gas("text", "collisions = 100", "--set", "output.text=ends", "-o",
                                   "out")
        step = report["stopped_by"]["step"]
        last = lines_of(run.out, step)
        self.assertEqual(len(last), 120)
        self.assertEqual({len(line.split()) for line in last}, {8})
        self.assertEqual(sum(int(line.split()[6]) for line in last) // 2,
                         report["pair_collisions"])
        self.assertTrue((self.folder / checkpoint("out", step)).exists())
        self.assertNotIn("stopped on request", run.err)

    def test_holds_at_the_start(self):
        """A run whose start is beyond a limit shows the start alone. It is no failure."""
        report, _ = self.run_gas("start", "kT_above = 0.0005")
        self.assertEqual((report["stopped_by"]["step"], report["steps"]), (0, 0))
        self.assertAlmostEqual(report["stopped_by"]["value"], 0.05 ** 2 / 2, delta=1e-15)

    def test_never_holds(self):
        report, _ = self.run_gas("never", "collisions = 1e9, kT_below = 1e-5", "--steps", 200)
        self.assertNotIn("stopped_by", report)
        self.assertEqual(report["steps"], 200)

    def test_time_stepped_and_checked(self):
        """The other method, and `--check`, end where the plain run ends."""
        for name, words in (("stepped", ["--set", "time.method=time-stepped"]), ("plain", []),
                            ("checked", ["--check"])):
            self.run_gas(name, "collisions = 200", *words)
        reasons = {name: self.report(f"{name}.json")["stopped_by"]
                   for name in ("stepped", "plain", "checked")}
        self.assertEqual(reasons["plain"], reasons["checked"])
        self.assertGreaterEqual(reasons["stepped"]["value"], 200)

    def test_messages(self):
        for condition, says in (("departed = 3", "no meaning without a side of kind = \"open\""),
                                ("kT = 1", "try: time.stop.kT_below or time.stop.kT_above"),
                                ("collisions = 0", "'time.stop.collisions' must be from 1 to"),
                                ("steps = 4", "[time.stop] has collisions, departed, kT_below")):
            self.write("wrong.toml", GAS.format("", condition))
            self.run_program(1, "run", "wrong.toml", code=2, says=says)


if __name__ == "__main__":
    main()
