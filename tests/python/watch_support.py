# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the page share: runs, a server, and pictures of it."""

import json
import os
import shutil
import subprocess
import threading
import time
import urllib.request
import zlib
from pathlib import Path

import h5py
import numpy as np
from carrom.watch import Follower, serve

PROGRAM = os.environ["CARROM_PROGRAM"]
BROWSER = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
SCENE = """
[box]
size = 40
[discs]
count = 200
packing = 0.3
speed = 0.2
[time]
method = "event-driven"
steps = {steps}
[output.trajectory]
every_steps = {every}
[output.measurements]
quantities = ["wall_pressure"]
every_steps = {pressure}
"""


def start(folder, steps=60, every=5, text=None, options=()):
    """Start a run in the background."""
    Path("scene.toml").write_text(
        text or SCENE.format(steps=steps, every=every, pressure=max(10, steps // 1000)),
        encoding="ascii",
    )
    command = [PROGRAM, "run", "scene.toml", "-o", folder, "--quiet", "--threads", "1", *options]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL)


def run(folder, **words):
    assert start(folder, **words).wait(timeout=60) == 0


class Page:
    """A server in a thread, and what it answers."""

    def __init__(self, folder, **words):
        self.server = serve(Follower(Path(folder), **words), 0)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def get(self, path, **headers):
        request = urllib.request.Request(self.server.address + path, headers=headers)
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.headers, answer.read()

    def json(self, path):
        return json.loads(self.get(path)[1])

    def frame(self, words):
        headers, body = self.get(f"frame?{words}")
        return json.loads(headers["X-Frame"]), np.frombuffer(body, dtype="<f4")


def stored(folder):
    """Steps, positions and velocities of the trajectory, by h5py alone."""
    with h5py.File(f"{folder}/trajectory.h5") as file:
        discs = file["particles/discs"]
        return discs["position/step"][()], discs["position/value"][()], discs["velocity/value"][()]


def wait_for(claim, seconds=60):
    end = time.monotonic() + seconds
    while not claim():
        if time.monotonic() > end:
            raise AssertionError("it takes too long")
        time.sleep(0.2)


def pixels(path):
    """The pixels of a PNG of 8 bits a channel, (rows, columns, channels)."""
    data, at, packed = Path(path).read_bytes(), 8, b""
    while at < len(data):
        length, kind = int.from_bytes(data[at : at + 4], "big"), data[at + 4 : at + 8]
        part = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height = int.from_bytes(part[:4], "big"), int.from_bytes(part[4:8], "big")
            channels = {2: 3, 6: 4}[part[9]]
        packed += part if kind == b"IDAT" else b""
        at += length + 12
    lines, above = zlib.decompress(packed), bytes(width * channels)
    picture = []
    for begin in range(0, len(lines), 1 + width * channels):
        above = unfiltered(
            lines[begin], lines[begin + 1 : begin + 1 + width * channels], above, channels
        )
        picture.append(above)
    return np.frombuffer(b"".join(picture), dtype=np.uint8).reshape(height, width, channels)


def unfiltered(kind, row, above, channels):
    """A row of a PNG: each byte was stored as its difference to a guess."""
    if kind == 0:
        return row
    result = bytearray(channels) + bytearray(row)
    before = bytes(channels) + above
    for i in range(channels, len(result)):
        left, up, corner = result[i - channels], before[i], before[i - channels]
        guess = (None, left, up, (left + up) // 2)[kind] if kind < 4 else paeth(left, up, corner)
        result[i] = (result[i] + guess) & 255
    return bytes(result[channels:])


def paeth(left, up, corner):
    away = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    return left if away[0] <= min(away[1:]) else up if away[1] <= away[2] else corner
