# SPDX-License-Identifier: BSD-3-Clause
"""No output of any subcommand replaces a file of a run, of replicas, or one that holds something
else: every output against every kind of file that Carrom writes is code 2, and no byte changes.
"""
import hashlib
import os
import shutil
from pathlib import Path

from program import ProgramTest, main

SCENE = """
[box]
size = 20
[discs]
count = 120
packing = 0.2
speed = 0.05
[time]
steps = 10
method = "event-driven"
[output.checkpoint]
every_steps = 5
[output.trajectory]
every_steps = 5
[output]
collisions = true
[output.measurements]
quantities = ["thermo", "velocities", "profiles"]
every_steps = 5
hdf5 = 1
"""
PLAIN = SCENE.split("[output.checkpoint]", maxsplit=1)[0]
LINES = ("--set", "output.text=ends")
ACCURACY = ("--starts", 1, "--repetitions", 1, "--collisions", 1, "--approach", 1,
            "--micro-steps", 1, "--arithmetic", "default", "--quiet")


class Destinations(ProgramTest):
    n_runs = 0

    def run_program(self, *words, **expected):
        type(self).n_runs += 1
        return super().run_program(*words, **expected)

    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)
        self.write("plain.toml", PLAIN)

    def files(self):
        """The contents of all files, by name."""
        return {str(path.relative_to(self.folder)): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in sorted(self.folder.rglob("*")) if path.is_file()}

    def make_all(self):
        """Every kind of file that Carrom writes. Returns one name of each, and what it is."""
        for folder in ("here", "other"):
            self.run_program(1, "run", "scene.toml", "-o", folder, "--quiet")
        self.run_program(1, "replicas", "scene.toml", "--count", 2, "-o", "replicas", "--quiet",
                         "--set", "output.measurements.hdf5=0")
        self.run_program(1, "accuracy", "plain.toml", *ACCURACY, "--output", "accuracy.csv")
        self.run_program(1, "run", "plain.toml", "--quiet", "--report", "report.json", "--output",
                         "lines.txt", *LINES)
        for form in ("xyz", "csv"):
            self.run_program(1, "convert", "other/trajectory.h5", "--to", form, "--output",
                             f"frames.{form}")
        shutil.copy(self.folder / "other/checkpoints/checkpoint-000000000010.h5",
                    self.folder / "copy")
        self.write("check_step_3_disc_4.discs", "0 1 1 0 0\n")
        (self.folder / "link").symlink_to("other/scene.toml")
        files = [str(path.relative_to(self.folder)) for folder in ("here", "other", "replicas")
                 for path in sorted((self.folder / folder).rglob("*")) if path.is_file()]
        named = [name for name in files if "/0001/" not in name and not name.endswith("0002.h5")]
        return [*named, "scene.toml", "accuracy.csv", "copy", "check_step_3_disc_4.discs", "link"]

    def test_every_output_against_every_file(self):
        victims = self.make_all()
        ends = {name.rsplit("/", 1)[-1] for name in victims}
        self.assertLessEqual({"scene.toml", "report.json", "trajectory.h5", "trajectory.xdmf",
                              "0001.h5", "collisions.h5", "checkpoint-000000000010.h5",
                              "thermo.csv", "velocities.csv", "tables.h5", "replicas.csv",
                              "replicas.json"}, ends)
        before = self.files()
        own = [("run", "-o", "here", "--resume", "--steps", 20, option)
               for option in ("--report", "--output")]
        others = [("run", "plain.toml", "--quiet", "--report"),
                  ("run", "scene.toml", "-o", "new", "--output"),
                  ("convert", "other/trajectory.h5", "--to", "csv", "--output"),
                  ("accuracy", "plain.toml", *ACCURACY, "--output")]
        for victim in [*victims, "here/measurements/new.csv", "other/checkpoints/x/report.json",
                       "other/.carrom.lock"]:
            for words in own if victim.startswith("here") else others:
                with self.subTest(victim=victim, words=words):
                    self.run_program(1, *words, victim, code=2, says=Path(victim).name)
        self.assertEqual(self.files(), before)

    def test_files_of_another_kind(self):
        self.make_all()
        before = self.files()
        for victim in ("lines.txt", "frames.xyz", "frames.csv", "accuracy.csv"):
            self.run_program(1, "run", "plain.toml", "--report", victim, code=2,
                             says="--report does not replace")
        self.run_program(1, "run", "plain.toml", "--output", "report.json", code=2,
                         says="is a report")
        self.assertEqual(self.files(), before)
        # An output may replace a file that it has written before.
        self.run_program(1, "run", "plain.toml", "--quiet", "--report", "report.json", "--output",
                         "lines.txt", *LINES, "--steps", 5)
        self.run_program(1, "convert", "other/trajectory.h5", "--to", "xyz", "--output",
                         "frames.xyz")
        self.run_program(1, "run", "plain.toml", "--output", "here/lines.txt", "--quiet",
                         *LINES)
        self.run_program(1, "run", "plain.toml", "--output", "here/lines.txt", "--quiet")

    def test_folders(self):
        """A run or replicas in a folder of checkpoints, recordings or tables."""
        self.make_all()
        before = self.files()
        for place in ("here/checkpoints", "other/trajectory/x", "other/measurements", "link2"):
            if place == "link2":
                (self.folder / place).symlink_to("other/collisions")
            self.run_program(1, "run", "scene.toml", "-o", place, code=2, says="of the run in")
            self.run_program(1, "replicas", "plain.toml", "--count", 2, "-o", place, code=2,
                             says="of the run in")
        self.assertEqual(self.files(), before)

    def test_links(self):
        """Text goes to the file behind a link, so that file decides; hard links hide a run's."""
        scene = "box.size = 10\ndiscs.count = 5\ndiscs.packing = 0.1\ntime.steps = 2\n"
        self.write("linked.toml", scene)
        (self.folder / "link").symlink_to("plain.toml")
        self.run_program(1, "run", "linked.toml", "-o", "owner", "--quiet")
        os.link(self.folder / "owner/scene.toml", self.folder / "second_name")
        for output, why in (("link", "does not replace"), ("second_name", "has other names")):
            self.run_program(1, "run", "linked.toml", "--set", "output.text=ends", "--quiet",
                             "--output", output, code=2, says=why)
        self.run_program(1, "run", "linked.toml", "--quiet", "-o", "owner/.carrom.lock", code=2,
                         says="is a file of the run")
        self.assertEqual((self.folder / "plain.toml").read_text(encoding="utf-8"), PLAIN)
        self.run_program(1, "run", "-o", "owner", "--resume", "--steps", 3, "--quiet")

    def test_overwrite_keeps_what_is_read(self):
        """--overwrite removes the checkpoints of the run, of which one is the start."""
        self.run_program(1, "run", "scene.toml", "-o", "here", "--quiet")
        self.write("from.toml", PLAIN.replace("count = 120\npacking = 0.2", "radius = 0.5\n"
                   'from = "here/checkpoints/checkpoint-000000000010.h5"'))
        before = self.files()
        self.run_program(1, "run", "from.toml", "-o", "here", "--overwrite", code=2,
                         says="--overwrite removes")
        self.assertEqual(self.files(), before)

    def test_a_failed_start_leaves_no_folder(self):
        """The folder and those above it go where the run has made them, and stay where they were,
        or hold a file."""
        crowded = self.write("crowded.toml", PLAIN.replace("packing = 0.2", "radius = 1\nlist = "
                                                           "[[5, 5, 0, 0], [5.5, 5, 0, 0]]")
                             .replace("count = 120", "count = 2"))
        (self.folder / "there").mkdir()
        for folder, stays in (("new", False), ("new/inner/", False), ("there", True),
                              ("there/inner", True)):
            for ranks in (1, 2):
                self.run_program(ranks, "run", crowded, "-o", folder, "--quiet", code=2,
                                 says="overlap")
                self.assertEqual((self.folder / folder.split("/", maxsplit=1)[0]).exists(), stays)
            self.assertEqual(list((self.folder / "there").iterdir()), [])
        self.run_program(1, "run", "plain.toml", "-o", "new/inner", "--quiet")
        self.assertTrue((self.folder / "new/inner/report.json").exists())

    def test_replicas_keep_tables_of_others(self):
        (self.folder / "mine").mkdir()
        self.write("mine/velocities.csv", "precious\n")
        self.run_program(1, "replicas", "scene.toml", "--count", 2, "-o", "mine", code=2,
                         says="velocities.csv")
        self.assertEqual((self.folder / "mine/velocities.csv").read_text(), "precious\n")

    @classmethod
    def tearDownClass(cls):
        print(f"{cls.n_runs} runs of the program")


if __name__ == "__main__":
    main()
