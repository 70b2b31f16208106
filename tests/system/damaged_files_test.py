# SPDX-License-Identifier: BSD-3-Clause
"""Damage for which HDF5 would loop without end is found before HDF5 reads the file, and damage of
any range of bytes within seconds.
"""
import random
import shutil
import time

from program import ProgramTest, main

SCENE = """
[box]
size = 20
[discs]
count = 12
packing = 0.4
speed = 2
[time]
steps = 4
method = "event-driven"
[output]
text = "none"
collisions = true
[output.trajectory]
every_steps = 1
[output.checkpoint]
every_steps = 2
"""
# The file that is damaged, and the file with which the program is then called.
FILES = {
    "checkpoints/checkpoint-000000000004.h5": "checkpoints/checkpoint-000000000004.h5",
    "trajectory.h5": "trajectory.h5",
    "trajectory/0001.h5": "trajectory.h5",
    "collisions.h5": "collisions.h5",
    "collisions/0001.h5": "collisions.h5",
}
SOON = 8  # seconds; whole files take 0.1, and HDF5 would be stopped after 10


class Damage(ProgramTest):
    n_runs = 0

    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)
        self.run_program(1, "run", "scene.toml", "-o", "whole", "--quiet")

    def ask(self, name, content, *commands, code=2):
        """Each command ends with this code, and soon, where a file has this content."""
        shutil.rmtree(self.folder / "o", ignore_errors=True)
        shutil.copytree(self.folder / "whole", self.folder / "o")
        (self.folder / "o" / name).write_bytes(content)
        for words in commands:
            Damage.n_runs += 1
            begin = time.monotonic()
            self.run_program(1, *words, code=code)
            self.assertLess(time.monotonic() - begin, SOON, words)

    def test_heaps_without_end(self):
        for name in ("trajectory.h5", "collisions.h5"):
            content = (self.folder / "whole" / name).read_bytes()
            heap = content.index(b"GCOL")
            for begin, end in ((heap + 16, heap + 600), (heap + 16, heap + 4096),
                               (heap + 24, heap + 32), (heap + 16, len(content))):
                with self.subTest(name=name, begin=begin, end=end):
                    self.ask(name, content[:begin] + bytes(end - begin) + content[end:],
                             ("verify", f"o/{name}"), ("info", f"o/{name}"),
                             ("convert", f"o/{name}", "--to", "csv", "--output", "out.csv"))
            # Damages the heap, then also a part of the seal, then also the whole seal.
            damaged = content[:heap + 560] + bytes(1912) + content[heap + 2472:]
            self.ask(name, damaged, ("verify", f"o/{name}"))
            self.ask(name, damaged[:-20] + bytes(20), ("verify", f"o/{name}"))
            self.ask(name, damaged[:-40] + bytes(40), ("verify", f"o/{name}"))

    def test_any_range_of_bytes(self):
        numbers = random.Random(53)
        for name, asked in FILES.items():
            content = (self.folder / "whole" / name).read_bytes()
            # The unused space of a segment has no rows yet, so it has no checksum.
            code = (0, 2) if "/0001" in name else 2
            for _ in range(12):
                begin = numbers.randrange(min(len(content), 6000))
                end = min(len(content), begin + numbers.choice([64, 500, 2000, 5000]))
                filling = numbers.choice([b"\0", b"\377", b"\1"]) * (end - begin)
                if not any(content[begin:end]) and not any(filling):
                    continue
                with self.subTest(name=name, begin=begin, end=end, filling=filling[:1]):
                    damaged = content[:begin] + filling + content[end:]
                    self.ask(name, damaged, ("verify", f"o/{asked}"), code=code)

    @classmethod
    def tearDownClass(cls):
        print(f"{cls.n_runs} runs of the program")


if __name__ == "__main__":
    main()
