# SPDX-License-Identifier: BSD-3-Clause
"""Replicas: each has the bits of a run of its own, means and errors are those of the reports, what
is done is left alone, and what is wrong is said once.
"""
import csv
import json
import re
import shutil
import statistics

from program import SOURCES, ProgramTest, main

SCENE = [SOURCES / "inputs/gas.toml", "--set", "discs.count=300", "--set", "discs.packing=0.2",
         "--set", "time.steps=300", "--set",
         "output.measurements.quantities=['velocities']", "--set",
         "output.measurements.every_steps=10"]


class Replicas(ProgramTest):
    def replicas(self, ranks, count, folder, *words, **expected):
        return self.run_program(ranks, "replicas", *SCENE, "--count", count, "-o", folder, *words,
                                **expected)

    def rows(self, file):
        lines = (self.folder / file).read_text(encoding="utf-8").splitlines()
        return list(csv.reader(line for line in lines if not line.startswith("#")))

    def table(self, folder):
        head, *rows = self.rows(f"{folder}/replicas.csv")
        return [dict(zip(head, row)) for row in rows]

    def test_bits_and_means(self):
        for ranks in (1, 3):
            self.replicas(ranks, 5, f"on{ranks}", says="replicas           5")
        for file in ("replicas.csv", "replicas.json", "velocities.csv"):
            files = [(self.folder / f"on{ranks}" / file).read_bytes() for ranks in (1, 3)]
            self.assertEqual(*files, file)

        table = self.table("on1")
        third = table[3]
        self.assertEqual(third["replica"], "3")
        self.run_program(2, "run", *SCENE, "--set", f"discs.seed={third['seed']}", "-o", "one",
                         "--quiet")
        self.assertEqual(self.hash_of("one/report.json"), third["state_hash"])
        self.assertEqual(len({row["state_hash"] for row in table}), 5)

        pressures = [float(row["pressure"]) for row in table]
        found = self.report("on1/replicas.json")["pressure"]
        self.assertAlmostEqual(found["value"] / statistics.fmean(pressures), 1, delta=1e-9)
        error = statistics.stdev(pressures) / len(pressures) ** 0.5
        self.assertAlmostEqual(found["error"] / error, 1, delta=1e-5)

    def test_columns_have_names_of_their_own(self):
        """D_error is the error over replicas, D_run_error the mean of the errors that runs claim.
        """
        self.replicas(1, 3, "flights", "--quiet", "--set", "box.left.kind=periodic", "--set",
                      "box.right.kind=periodic", "--set",
                      "output.measurements.quantities=['diffusion']", "--set",
                      "output.measurements.correlation_steps=50")
        self.assertEqual(self.rows("flights/diffusion.csv")[0][:3], ["D", "D_error", "D_run_error"])
        for table in (self.folder / "flights").glob("*.csv"):
            head = self.rows(table)[0]
            self.assertEqual(len(set(head)), len(head), table)

    def test_what_is_done_stays(self):
        self.replicas(1, 5, "all", "--quiet")
        before = self.table("all")
        report = self.folder / "all/0001/report.json"
        written = report.stat()
        shutil.rmtree(self.folder / "all/0002")
        self.replicas(2, 6, "all", "--quiet")  # one is missing, one is new
        after = report.stat()
        self.assertEqual((after.st_mtime, after.st_ino), (written.st_mtime, written.st_ino))
        self.assertEqual(self.table("all")[:5], before)
        self.assertEqual(len(self.table("all")), 6)
        self.replicas(3, 6, "all", "--set", "discs.packing=0.3", code=2)

        # A damaged report is made again from the replica's checkpoint, or is an error that names
        # the report.
        whole = report.read_text(encoding="utf-8")
        state_hash = json.loads(whole)["state_hash"]
        for damaged in (re.sub(r'"first_step": \d+', '"first_step": "x"', whole),
                        re.sub(r'"steps": \d+', '"steps": null', whole),
                        "".join(whole.splitlines(keepends=True)[:5])):
            self.assertNotEqual(damaged, whole)
            report.write_text(damaged, encoding="utf-8")
            self.replicas(2, 6, "all", "--quiet")
            self.assertEqual(self.hash_of("all/0001/report.json"), state_hash)
        report.write_text(whole.replace(f'"{state_hash}"', "5"), encoding="utf-8")
        self.replicas(2, 6, "all", "--quiet", code=2,
                      says="all/0001/report.json: is no whole report")

    def test_too_short_for_errors(self):
        """Of three steps no run claims an error; kT is the same in all and needs none."""
        run = self.replicas(1, 4, "short", "--set", "time.steps=3",
                            says="replicas are too short to claim an error (pressure in 4 of 4")
        self.assertRegex(run.err, r"temperature +0\.\d+ in each")
        self.assertNotIn("temperature in", run.err)

    def test_folder_of_a_run(self):
        """The folder of a run is no place for replicas, whose files would stand among its own."""
        self.run_program(1, "run", *SCENE, "-o", "taken", "--set", "time.steps=3", "--quiet")
        before = sorted((self.folder / "taken").iterdir())
        self.replicas(1, 2, "taken", code=2, says="of a run; name another folder with -o")
        self.assertEqual(before, sorted((self.folder / "taken").iterdir()))

    def test_wrong_words(self):
        self.replicas(3, 0, "none", "--set", "discs.colour=red", code=2,
                      says=["must be a whole number from 1 to 10000", "discs.colour"])
        self.assertFalse((self.folder / "none").exists())


if __name__ == "__main__":
    main()
