# SPDX-License-Identifier: BSD-3-Clause
"""What a real Chromium shows of the page, held to the run's files."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from watch_support import BROWSER, SCENE, Page, pixels, run, start, stored, wait_for


@unittest.skipUnless(BROWSER, "there is no chromium")
class BrowserTest(unittest.TestCase):
    def browse(self, address, *options, seconds=6, size="1200,900"):
        """Return what Chromium writes of a page after some seconds of its own clock."""
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run(
                [
                    BROWSER,
                    "--headless",
                    "--no-sandbox",
                    "--disable-gpu",
                    "--disable-quic",
                    "--no-first-run",
                    "--disable-background-networking",
                    "--disable-component-update",
                    "--disable-sync",
                    f"--user-data-dir={profile}",
                    f"--window-size={size}",
                    "--hide-scrollbars",
                    f"--virtual-time-budget={1000 * seconds}",
                    *options,
                    address,
                ],
                capture_output=True,
                timeout=120,
                check=True,
                text=True,
            )
        return done.stdout

    def shown(self, page, words="", seconds=6):
        text = self.browse(page.server.address + words, "--dump-dom", seconds=seconds)
        body = re.search("<body[^>]*>", text)[0]
        facts = dict(re.findall('data-([a-z]+)="([^"]*)"', body))
        return facts, text

    def test_a_finished_run(self):
        run("done")
        steps, _, _ = stored("done")
        with Page("done") as page:
            facts, text = self.shown(page)
            self.assertEqual(
                (facts["status"], facts["step"], facts["drawn"]), ("finished", "60", "200")
            )
            self.assertEqual(facts["frames"], str(len(steps)))
            self.assertIn("step 60: 200 of 200 discs drawn", text)
            self.assertIn("step 60 of 60", text)
            for step in (0, 25):
                facts, _ = self.shown(page, f"?step={step}&colour=psi6")
                self.assertEqual((facts["step"], facts["drawn"]), (str(step), "200"))
            facts, _ = self.shown(page, "?step=20&play=-1")  # back to the start
            self.assertEqual(facts["step"], "0")
            facts, _ = self.shown(page, "?step=20&play=1")
            self.assertEqual(facts["step"], "60")

    def test_discs_have_their_size_on_the_screen(self):
        run("sizes")
        with Page("sizes") as page:
            self.browse(
                page.server.address + "?theme=light&colour=species",
                "--screenshot=shot.png",
                size="800,500",
            )
        picture = pixels("shot.png")
        ground, colour = np.array([241, 242, 244]), np.array([44, 116, 188])
        away = picture[40:435, :440, :3] - ground.astype(float)  # the rest of the page is blue too
        covered = away @ (colour - ground) / ((colour - ground) ** 2).sum()
        is_mixed = np.linalg.norm(away - covered[..., None] * (colour - ground), axis=2) < 8
        covered = np.where(is_mixed & (covered > 0.05), np.minimum(covered, 1), 0)
        rows, columns = np.nonzero(covered > 0.5)
        radius = np.sqrt(0.3 * 40**2 / 200 / np.pi)
        _, places, _ = stored("sizes")
        width = (
            np.ptp(places[-1, :, 0]) + 2 * radius
        )  # from the first disc's edge to the last one's
        scale = (np.ptp(columns) + 1) / width
        height = np.ptp(places[-1, :, 1]) + 2 * radius
        self.assertAlmostEqual((np.ptp(rows) + 1) / height, scale, delta=0.02 * scale)
        self.assertAlmostEqual(covered.sum() / scale**2, 200 * np.pi * radius**2, delta=0.03 * 480)

    def test_a_step_has_one_scale_of_colours_in_all_windows(self):
        loss = '[effects.contact]\nkind = "restitution"\nrestitution = 0.6\n'
        run("cools", text=SCENE.format(steps=60, every=5, pressure=10) + loss)
        found = set()
        with Page("cools") as page:
            for words in ("?step=60", "?step=0&play=1", "?step=60&play=-1"):
                _, text = self.shown(page, words)
                found.add(re.search('id="high">([^<]*)<', text)[1])
        self.assertEqual(len(found), 1)
        _, _, velocities = stored("cools")
        speeds = np.sort(np.linalg.norm(velocities[0].astype(float), axis=1))
        self.assertAlmostEqual(float(found.pop()), speeds[199], delta=0.01 * speeds[199])

    def test_walls_that_move_are_drawn_where_they_are(self):
        text = SCENE.format(steps=60, every=5, pressure=10)
        text = text.replace("[discs]", 'right = {kind = "moving", speed = -0.1}\n[discs]')
        run("piston", text=text)
        with Page("piston") as page:
            facts, _ = self.shown(page, "?step=30")
            self.assertEqual([float(x) for x in facts["walls"].split(",")], [0, 0, 37, 40])
            self.assertEqual(facts["drawn"], "200")

    def test_a_run_that_goes_on(self):
        process = start("going", steps=10**7, every=200)
        try:
            with Page("going", may_wait=True) as page:
                wait_for(lambda: len(page.json("state?have=0&last=-1")["steps"]) > 3)
                facts, text = self.shown(page)
                steps, _, _ = stored("going")
                self.assertEqual((facts["status"], facts["drawn"]), ("running", "200"))
                self.assertIn(int(facts["step"]), steps)
                self.assertIn("of 10000000", text)
                later, _ = self.shown(page)
                wait_for(
                    lambda: page.json("state?have=0&last=-1")["steps"][-1] > int(later["step"])
                )
                newest, _ = self.shown(page)
                self.assertGreater(int(newest["step"]), int(facts["step"]))
        finally:
            process.kill()
            process.wait()

    def test_the_newest_profiles_of_a_run_that_goes_on(self):
        for columns, rows in ((4, 3), (5, 1), (1, 6)):
            grid = (f"profile_columns={columns}", f"profile_rows={rows}", "profile_samples=4")
            options = ['output.measurements.quantities=["profiles"]']
            options += [f"output.measurements.{one}" for one in (*grid, "every_steps=500")]
            words = [word for option in options for word in ("--set", option)]
            name = f"grid{columns}"
            process = start(name, steps=10**7, every=5000, options=words)
            try:
                with Page(name, may_wait=True) as page:
                    table = Path(name, "measurements/profiles.csv")
                    wait_for(lambda: table.exists() and table.read_text().count("\n") > 8)
                    facts, text = self.shown(page)
                    self.assertEqual(facts["status"], "running")
                    self.assertEqual(facts["field"], f"{columns} by {rows}")
                    self.assertIn('<option value="temperature">', text)
            finally:
                process.kill()
                process.wait()

    def test_a_page_without_a_run(self):
        os.mkdir("nothing")
        with Page("nothing") as page:
            facts, text = self.shown(page, seconds=3)
        self.assertEqual(facts["status"], "waiting")
        self.assertIn("No run has begun here yet", text)


if __name__ == "__main__":
    unittest.main()
