# SPDX-License-Identifier: BSD-3-Clause
"""Pipes, sockets and folders in the place of any file of a run or of any input, and texts nested
without end: each command ends soon and in words, and no process waits or crashes.
"""
import os
import shutil
import socket
import threading

from program import ProgramTest, main

SCENE = """
[box]
size = 20
[discs]
count = 60
packing = 0.2
speed = 0.05
[time]
steps = 10
method = "event-driven"
[output]
collisions = true
[output.checkpoint]
every_steps = 5
[output.trajectory]
every_steps = 5
[output.measurements]
quantities = ["thermo", "velocities"]
every_steps = 5
"""
DEEP = 100_000
SOON = 30  # seconds; a run takes 0.1


class SpecialFiles(ProgramTest):
    n_runs = 0

    def run_program(self, *words, **expected):
        type(self).n_runs += 1
        return super().run_program(*words, **{"patience": SOON, **expected})

    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)

    def put(self, kind, name):
        """Put a pipe, a socket or a folder in the place of a file."""
        path = self.folder / name
        path.unlink(missing_ok=True)
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "socket":
            with socket.socket(socket.AF_UNIX) as server:
                server.bind(os.path.relpath(path))
        else:
            path.mkdir()

    def test_in_the_place_of_a_file_of_a_run(self):
        self.run_program(1, "run", "scene.toml", "-o", "whole", "--quiet")
        whole = self.folder / "whole"
        files = [str(path.relative_to(whole)) for path in sorted(whole.rglob("*"))
                 if path.is_file()] + [".carrom.lock"]
        self.assertIn("measurements/thermo.csv", files)
        self.assertIn("measurements/velocities.csv", files)
        for name in files:
            for kind in ("pipe", "socket") if name.endswith("thermo.csv") else ("pipe",):
                shutil.rmtree(self.folder / "o", ignore_errors=True)
                shutil.copytree(whole, self.folder / "o")
                self.put(kind, f"o/{name}")
                with self.subTest(name=name, kind=kind):
                    for words in (("run", "-o", "o", "--resume", "--steps", 20),
                                  ("run", "scene.toml", "-o", "o"),
                                  ("run", "scene.toml", "-o", "o", "--overwrite")):
                        self.run_program(1, *words, "--quiet", code=(0, 2, 4))
        for kind in ("pipe", "socket", "folder"):
            shutil.rmtree(self.folder / "o")
            shutil.copytree(whole, self.folder / "o")
            self.put(kind, "o/measurements/thermo.csv")
            self.run_program(1, "run", "-o", "o", "--resume", "--steps", 20, code=2,
                             says="thermo.csv")

    def test_as_an_input(self):
        self.put("pipe", "pipe")
        self.put("pipe", "pipe.toml")
        self.put("socket", "socket.in")
        self.write("file.toml", '[box]\nsize = 20\n[discs]\ncount = 2\nradius = 1\n'
                   'file = "pipe"\n[time]\nsteps = 1\n')
        self.write("from.toml", '[box]\nsize = 20\n[discs]\nradius = 1\nfrom = "pipe"\n'
                   '[time]\nsteps = 1\n')
        self.run_program(1, "run", "scene.toml", "-o", "o", "--quiet")
        for words in (("run", "pipe.toml"), ("run", "socket.in"), ("run", "pipe"),
                      ("run", "file.toml"), ("run", "from.toml"),
                      ("run", "--restart", "pipe", "-o", "n"),
                      ("info", "pipe"), ("verify", "pipe"), ("diff", "pipe", "o/trajectory.h5"),
                      ("convert", "pipe", "--to", "csv"), ("compare", "pipe", "socket.in"),
                      ("accuracy", "pipe.toml", "--output", "a.csv"),
                      ("replicas", "pipe.toml", "--count", 2, "-o", "r")):
            with self.subTest(words=words):
                self.run_program(1, *words, code=2)
        self.run_program(3, "run", "file.toml", code=2, says="not a plain file")

    def test_reports_of_replicas(self):
        words = ("replicas", "scene.toml", "--count", 3, "-o", "r", "--quiet")
        self.run_program(1, *words)
        self.put("pipe", "r/0002/report.json")
        self.run_program(1, *words, code=2, says="report.json")
        (self.folder / "r/0002/report.json").unlink()
        self.write("r/0002/report.json", "[" * DEEP)
        self.run_program(1, *words)  # the replica goes on from its checkpoint and writes it anew
        self.put("pipe", "r/velocities.csv")
        self.run_program(1, *words, code=2, says="velocities.csv")

    def test_nested_without_end(self):
        texts = {"brackets": "a = " + "[" * DEEP, "closed": f"a = {'[' * DEEP}{']' * DEEP}",
                 "tables": "a = " + "{a = " * DEEP, "dots": ".".join("a" * DEEP) + " = 1",
                 "heads": f"[{'.'.join('a' * DEEP)}]\nb = 1"}
        for name, text in texts.items():
            self.write(f"{name}.toml", SCENE + text + "\n")
            with self.subTest(name=name):
                self.run_program(1, "run", f"{name}.toml", code=2, says=f"{name}.toml")
        self.run_program(1, "run", "scene.toml", "--set", "a=" + "[" * DEEP, code=2)
        self.run_program(1, "run", "scene.toml", "--set", ".".join("a" * 60_000) + "=1", code=2)

    def test_a_pipe_is_read_where_it_may_be(self):
        """Lines go to a pipe, as they always have, and its reader gets them."""
        self.put("pipe", "lines")
        read = []
        reader = threading.Thread(
            target=lambda: read.append((self.folder / "lines").read_text(encoding="ascii")))
        reader.start()
        self.run_program(1, "run", "scene.toml", "--set", "output.text=ends", "--output", "lines",
                         "-o", "o", "--quiet")
        reader.join(timeout=SOON)
        self.assertEqual(len(read[0].splitlines()), 120)

    @classmethod
    def tearDownClass(cls):
        print(f"{cls.n_runs} runs of the program")


if __name__ == "__main__":
    main()
