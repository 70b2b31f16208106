# SPDX-License-Identifier: BSD-3-Clause
"""What the server of the page answers, held to the run's files as h5py reads them."""

import json
import math
import os
import resource
import signal
import socket
import subprocess
import sys
import time
import unittest
import unittest.mock
import urllib.error
from pathlib import Path

import carrom
import h5py
import numpy as np
from carrom.watch.curves import Curves
from carrom.watch.order import hexatic_order
from carrom.watch.picture import View, picture
from watch_support import PROGRAM, SCENE, Page, run, start, stored, wait_for


class ServerTest(unittest.TestCase):
    def test_frames_are_those_of_the_file(self):
        run("frames")
        steps, places, velocities = stored("frames")
        self.assertEqual(list(steps), list(range(0, 61, 5)))
        with Page("frames") as page:
            state = page.json("state?have=0&last=-1")
            self.assertEqual(state["steps"], list(steps))
            self.assertEqual(
                (state["status"], state["step"], state["wanted"]), ("finished", 60, 60)
            )
            for index in (0, 7, 12):
                about, numbers = page.frame(f"step={steps[index]}")
                x, y, speed = numbers.reshape(3, 200)
                self.assertEqual(
                    (about["step"], about["shown"], about["kind"]), (steps[index], 200, "discs")
                )
                np.testing.assert_array_equal(x, places[index, :, 0])
                np.testing.assert_array_equal(y, places[index, :, 1])
                np.testing.assert_allclose(
                    speed, np.linalg.norm(velocities[index], axis=1), rtol=1e-6
                )
                self.assertAlmostEqual(
                    about["radius"], np.sqrt(0.3 * 40**2 / 200 / np.pi), places=5
                )

    def test_walls_are_where_they_are_at_the_step(self):
        sides = (
            'right = {kind = "moving", speed = -0.125}\nbottom = {kind = "oscillating", '
            "amplitude = 2, period = 12, phase = -0.5}\n"
        )
        text = SCENE.format(steps=60, every=5, pressure=10).replace("[discs]", sides + "[discs]")
        text = text.replace("[box]\nsize = 40\n", "[box]\nsize = [40, 30]\n")
        run("walls", text=text)
        _, places, _ = stored("walls")
        radius = np.sqrt(0.3 * 40 * 30 / 200 / np.pi)
        with Page("walls") as page:
            for step in (0, 25, 60):
                about, numbers = page.frame(f"step={step}")
                left, bottom, right, top = about["walls"]
                self.assertEqual((left, right, top), (0, 40 - step / 8, 30))
                # 25 is a twelfth of a period after two of them, and 60 is five periods
                angle = -0.5 + (math.pi / 6 if step == 25 else 0)
                self.assertAlmostEqual(bottom, 2 * math.sin(angle), places=12)
                self.assertEqual(about["room"], [0, -2, 40, 30])
                self.assertEqual(about["shown"], 200)
                x, y, _ = numbers.reshape(3, 200)
                self.assertGreater(y.min() - 2, bottom + radius - 1e-4)  # relative to `room`
                self.assertLess(x.max(), right - radius + 1e-4)
                np.testing.assert_allclose(y - 2, places[step // 5, :, 1], atol=1e-5)

    def test_a_frame_of_200000_discs_reads_its_own_arrays_only(self):
        text = SCENE.format(steps=4, every=1, pressure=4).replace("size = 40", "size = 1300")
        run("large", text=text.replace("count = 200", "count = 200_000"))
        with Page("large") as page:
            page.json("state?have=0&last=-1")  # opens the run, as a page does first
            page.frame("step=0")  # makes the server read the scale of colours
            counted, plain = [], h5py.Dataset.__getitem__

            def read(dataset, *words):
                values = plain(dataset, *words)
                counted.append((dataset.name, np.asarray(values).nbytes))
                return values

            with unittest.mock.patch.object(h5py.Dataset, "__getitem__", read):
                about, numbers = page.frame("step=3")
        self.assertEqual((about["kind"], about["shown"]), ("density", 200_000))
        arrays = [name for name, size in counted if size > 1000]
        self.assertEqual(
            sorted(arrays),
            ["/particles/discs/position/value", "/particles/discs/velocity/value"],
        )
        self.assertLessEqual(sum(size for _, size in counted), 200_000 * 2 * 3 * 4 + 1000)
        self.assertLessEqual(numbers.nbytes, 2 * 320 * 320 * 4)  # data for the browser

    def test_a_field_is_that_of_the_table(self):
        quantities = 'output.measurements.quantities=["profiles"]'
        sizes = ("every_steps=1", "profile_columns=4", "profile_rows=3", "profile_samples=2")
        options = ["--set", quantities]
        for size in sizes:
            options += ["--set", f"output.measurements.{size}"]
        run("field", options=options)
        lines = Path("field/measurements/profiles.csv").read_text(encoding="ascii").splitlines()
        names, *rows = [line.split(",") for line in lines if not line.startswith("#")]
        newest = np.array(rows[-12:], dtype=float)
        with Page("field") as page:
            field = page.json("field?name=temperature")
            self.assertEqual(field["step"], newest[-1, 0])
            self.assertEqual(field["names"][:-1], names[3:])
            np.testing.assert_array_equal(
                field["rows"], newest[:, names.index("temperature")].reshape(3, 4)
            )
            with self.assertRaisesRegex(urllib.error.HTTPError, "404"):
                page.json("field?name=colour")

    def test_the_scale_of_colours_is_that_of_the_first_frame(self):
        """In a granular gas speeds fall, so that each step of its own would have another scale."""
        loss = '[effects.contact]\nkind = "restitution"\nrestitution = 0.6\n'
        run("scale", text=SCENE.format(steps=60, every=5, pressure=10) + loss)
        _, _, velocities = stored("scale")
        speeds = np.linalg.norm(velocities.astype(float), axis=2)
        slower = np.sort(speeds[0])[199]  # 0.995 of 200 discs are slower
        self.assertLess(speeds[-1].max(), 0.9 * slower)
        for first in (60, 25, 0):  # pages that open at other steps, each from its own server
            with Page("scale") as page:
                for words in (f"step={first}", "step=60", "step=60&view=10,10,20,20", "step=0"):
                    about, _ = page.frame(words)
                    self.assertAlmostEqual(about["top"], slower, places=6, msg=(first, words))

    def test_discs_that_rest_at_first_have_the_scale_of_the_first_motion(self):
        fall = "[effects.gravity]\ny = -0.001\n"
        text = SCENE.format(steps=20, every=5, pressure=10).replace("speed = 0.2", "speed = 0")
        run("fall", text=text + fall)
        _, _, velocities = stored("fall")
        self.assertEqual(np.abs(velocities[0]).max(), 0)
        with Page("fall") as page:
            for step in (20, 0):
                about, _ = page.frame(f"step={step}")
                wanted = np.sort(np.linalg.norm(velocities[1], axis=1))[199]
                self.assertAlmostEqual(about["top"], wanted, places=6)

    def test_curves_are_those_of_the_tables(self):
        run("curves", options=("--set", "output.collisions=true"))
        _, _, velocities = stored("curves")
        report = json.loads(Path("curves/report.json").read_text(encoding="ascii"))
        with Page("curves") as page:
            wait_for(lambda: len(page.json("curves")["energy"]["steps"]) == len(velocities))
            curves = page.json("curves")
        energies = 0.5 * (velocities.astype(float) ** 2).sum(axis=(1, 2))
        np.testing.assert_allclose(curves["energy"]["values"], energies, rtol=1e-12)
        pairs = np.mean(curves["rate"]["values"]) * 60 * 200 / 2  # bins are of equal width here
        self.assertAlmostEqual(pairs, report["pair_collisions"], places=6)
        table = np.loadtxt(
            "curves/measurements/wall_pressure_history.csv", delimiter=",", skiprows=4
        )
        np.testing.assert_allclose(
            curves["pressure"]["values"], table[:, 2:].mean(axis=1), rtol=1e-12
        )

    def test_reads_without_time_still_span_the_run(self):
        run("hasty", steps=60, every=5)
        curves, asked = Curves(), carrom.open("hasty")
        gaps = []
        for _ in range(12):
            steps = curves.read(asked, asked.frames, 200, seconds=-1)["energy"]["steps"]
            self.assertEqual((steps[0], steps[-1]), (0, 60))
            gaps.append(max(np.diff(steps)))
        self.assertEqual(gaps[:4], [60, 40, 20, 20])  # steps 0 and 60, then 40, 20, 10
        self.assertEqual(gaps[-1], 5)

    def test_only_new_steps_are_sent(self):
        run("news")
        with Page("news") as page:
            state = page.json("state?have=5&last=20")
            self.assertEqual((state["first"], state["steps"][0]), (5, 25))
            state = page.json("state?have=5&last=21")  # of another run, so all steps are sent
            self.assertEqual((state["first"], state["steps"][0]), (0, 0))

    def test_a_run_without_a_trajectory_shows_its_checkpoints(self):
        text = SCENE.format(steps=40, every=5, pressure=10).replace(
            "[output.trajectory]\nevery_steps = 5\n", ""
        )
        run("kept", text=text, options=("--set", "output.checkpoint.every_steps=20"))
        with Page("kept") as page:
            state = page.json("state?have=0&last=-1")
            self.assertEqual(state["steps"], [20, 40])
            self.assertIn("There is no trajectory", state["message"])
            about, numbers = page.frame("step=40")
            with h5py.File("kept/checkpoints/checkpoint-000000000040.h5") as file:
                expected = file["particles/discs/position/value"][()].reshape(200, -1)
            np.testing.assert_allclose(numbers.reshape(3, 200)[0], expected[:, 0], rtol=1e-6)
            self.assertEqual(
                page.json("curves")["rate"]["source"], "counters of frames or checkpoints"
            )

    def test_a_run_that_has_not_begun_is_waited_for(self):
        os.mkdir("later")
        with Page("later") as page, Page("much_later", may_wait=True) as other:
            for one in (page, other):
                self.assertEqual(one.json("state?have=0&last=-1")["status"], "waiting")
            run("later", steps=10)
            self.assertEqual(page.json("state?have=0&last=-1")["steps"], [0, 5, 10])

    def test_a_killed_run_and_its_resumption(self):
        options = ("--set", "output.checkpoint.every_steps=2000")
        process = start("killed", steps=10**7, every=500, options=options)
        with Page("killed", may_wait=True) as page:
            wait_for(lambda: page.json("state?have=0&last=-1").get("step", 0) >= 4000)
            state = page.json("state?have=0&last=-1")
            self.assertEqual(state["status"], "running")
            self.assertEqual(state["wanted"], 10**7)
            process.send_signal(signal.SIGKILL)
            process.wait()
            state = page.json("state?have=0&last=-1")
            self.assertEqual(state["status"], "stopped")
            self.assertIn("carrom run -o killed --resume", state["message"])
            at = state["step"]
            goal = at + 3000
            subprocess.run(
                [
                    PROGRAM,
                    "run",
                    "-o",
                    "killed",
                    "--resume",
                    "--steps",
                    str(goal),
                    "--quiet",
                    "--threads",
                    "1",
                ],
                check=True,
                timeout=60,
                stdin=subprocess.DEVNULL,
            )
            state = page.json("state?have=0&last=-1")
            self.assertEqual((state["status"], state["step"]), ("finished", goal))
            self.assertEqual(state["steps"], list(stored("killed")[0]))
            page.frame(f"step={state['steps'][-1]}")

    def test_idle_connections_do_not_shut_others_out(self):
        run("idle")
        before = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (700, before[1]))
        with Page("idle") as page:
            place = page.server.server_address
            idle = [socket.create_connection(place, timeout=10) for _ in range(400)]
            try:
                page.get("state")
                seconds = time.process_time()
                time.sleep(1)
                self.assertLess(time.process_time() - seconds, 0.5, "idle ones take a core")
                page.get("state")
            finally:
                resource.setrlimit(resource.RLIMIT_NOFILE, before)
                for connection in idle:
                    connection.close()

    def test_requests_that_are_wrong(self):
        run("wrong", steps=10)
        with Page("wrong") as page:
            for words, code in (
                ("frame?step=7", 404),
                ("frame?step=x", 400),
                ("frame?step=5&colour=red", 400),
                ("frame?step=5&view=1,2,0,4", 400),
                ("frame?step=5&view=1,2", 400),
                ("frame?step=5&view=-inf,0,inf,4", 400),
                ("frame", 400),
                ("../../etc/passwd", 404),
            ):
                with self.assertRaises(urllib.error.HTTPError) as caught:
                    page.get(words)
                self.assertEqual(caught.exception.code, code, words)
            with self.assertRaises(urllib.error.HTTPError) as caught:
                page.get("state", Host="somewhere.example:8787")
            self.assertEqual(caught.exception.code, 403)

    def test_a_file_of_any_name_and_a_damaged_one(self):
        run("files", steps=10)
        content = Path("files/checkpoints/checkpoint-000000000010.h5").read_bytes()
        Path("my-copy.h5").write_bytes(content)
        with Page("my-copy.h5") as page:
            self.assertEqual(page.json("state?have=0&last=-1")["steps"], [10])
        with Page("files") as page:
            Path("files/scene.toml").write_text("time = 4\n", encoding="ascii")
            self.assertIsNone(page.json("state?have=0&last=-1")["wanted"])
            Path("files/report.json").write_text("[]", encoding="ascii")
            with self.assertRaises(urllib.error.HTTPError) as caught:
                page.get("state?have=0&last=-1")
            self.assertEqual(caught.exception.code, 503)

    def test_wrong_command_lines(self):
        run("there", steps=5)
        os.makedirs("other/things")
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = str(taken.getsockname()[1])
            for words, text in (
                (["there", "--port", port], f"port {port} is in use"),
                (["nowhere"], "nowhere: there is no such folder; --wait waits for it"),
                (["other"], "other: is no run of carrom"),
                (["there", "--port", "99999"], "is no port"),
            ):
                done = subprocess.run(
                    [sys.executable, "-m", "carrom.watch", *words],
                    timeout=60,
                    capture_output=True,
                    text=True,
                    check=False,
                )
                self.assertEqual(done.returncode, 2, words)
                self.assertIn(text, done.stderr)
                self.assertNotIn("Traceback", done.stderr)

    def test_watching_leaves_the_lock_alone_and_writes_nothing(self):
        run("quiet")
        names = sorted(str(path) for path in Path("quiet").rglob("*"))
        before = [(name, os.stat(name).st_mtime_ns) for name in names]
        os.chmod("quiet", 0o555)
        with Page("quiet") as page:
            page.json("state?have=0&last=-1")
            page.json("curves")
            page.frame("step=60&colour=psi6")
            lock = "quiet/.carrom.lock"
            for number in os.listdir("/proc/self/fd"):
                opened = Path("/proc/self/fd") / number
                self.assertFalse(opened.exists() and os.readlink(opened).endswith(lock))
        os.chmod("quiet", 0o755)
        self.assertEqual(before, [(name, os.stat(name).st_mtime_ns) for name in names])
        run("unwatched")
        hashes = [
            json.loads(Path(f"{name}/report.json").read_text(encoding="ascii"))["state_hash"]
            for name in ("quiet", "unwatched")
        ]
        self.assertEqual(hashes[0], hashes[1])


class PictureTest(unittest.TestCase):
    def test_psi6_by_all_pairs(self):
        chance = np.random.default_rng(24)
        for n, periods in ((300, (0, 0)), (300, (9, 0)), (250, (9, 7)), (7, (0, 0)), (12, (9, 7))):
            x = chance.random((n, 2)) * (9, 7)
            x[: n // 3] *= 0.2  # an uneven density
            apart = x[None] - x[:, None]
            for axis in (0, 1):
                if periods[axis]:
                    apart[..., axis] -= periods[axis] * np.round(apart[..., axis] / periods[axis])
            squares = (apart**2).sum(axis=2) + np.diag(np.full(n, np.inf))
            nearest = np.argsort(squares, axis=1)[:, :6]
            vectors = np.take_along_axis(apart, nearest[..., None], axis=1)
            expected = (
                ((vectors[..., 0] + 1j * vectors[..., 1]) ** 6) / (vectors**2).sum(axis=2) ** 3
            ).mean(axis=1)
            np.testing.assert_allclose(
                hexatic_order(x, np.array(periods, dtype=float)), expected, atol=1e-9
            )
        rows, columns = np.mgrid[:20, :20]
        lattice = (
            np.stack([columns + rows % 2 / 2, rows * np.sqrt(0.75)], axis=-1)
            .reshape(-1, 2)
            .astype(float)
        )
        np.testing.assert_allclose(
            np.abs(hexatic_order(lattice, np.array([20, 20 * np.sqrt(0.75)]))), 1
        )

    def test_many_discs_are_a_density(self):
        run("many", steps=5)
        with Page("many") as page:
            frame = page.server.follower._find_run() or page.server.follower._run.frames[0]
        about, body = picture(frame, "speed", None, most=100)
        fraction, mean = np.frombuffer(body, dtype="<f4").reshape(2, *about["grid"][::-1])
        self.assertEqual(about["kind"], "density")
        self.assertAlmostEqual(float(fraction.mean()), 0.3, places=5)  # the packing
        self.assertAlmostEqual(
            float(mean.sum()), float(frame.speed.sum()), delta=0.05 * float(frame.speed.sum())
        )
        about, body = picture(frame, "speed", View(10, 10, 20, 25), most=100)
        inside = (abs(frame.x - (15, 17.5)) < (5 + about["radius"], 7.5 + about["radius"])).all(
            axis=1
        )
        self.assertEqual(about["shown"], inside.sum())
        x, y, _ = np.frombuffer(body, dtype="<f4").reshape(3, -1)
        np.testing.assert_allclose(x, frame.x[inside, 0] - 10, atol=1e-5)


if __name__ == "__main__":
    unittest.main()
