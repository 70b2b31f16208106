# SPDX-License-Identifier: BSD-3-Clause
"""Clients that go, names of other machines, and files that would make the page's server wait."""

import io
import os
import socket
import struct
import time
import unittest
import unittest.mock
import urllib.error
from pathlib import Path

import h5py
from watch_support import Page, run


class HostileTest(unittest.TestCase):
    def test_only_this_machine_is_a_host(self):
        run("hosts", steps=5)
        with Page("hosts") as page:
            port = page.server.server_address[1]
            for host in (f"localhost:{port}", "127.0.0.1", "[::1]:80"):
                self.assertEqual(
                    page.get("state", Host=host)[0].get_content_type(), "application/json"
                )
            for host in (
                "localhost:80.evil.com",
                "localhost.evil.com",
                "localhost:",
                "evil.com",
                "127.0.0.1:80@evil.com",
                "[::1",
                "localhost:80\u0661",
                "-",
            ):
                with self.assertRaises(urllib.error.HTTPError, msg=host) as refused:
                    page.get("state", Host=host.encode("utf-8").decode("latin-1"))
                refused.exception.close()
                self.assertEqual(refused.exception.code, 403, host)

    def test_clients_that_go_are_no_errors(self):
        run("gone", steps=5)
        with Page("gone") as page, unittest.mock.patch("sys.stderr", io.StringIO()) as printed:
            reset = struct.pack("ii", 1, 0)  # close by a reset, not by an end
            for words in (b"GET /state HTTP/1.1\r\nHost: localhost\r\n\r\n" * 50, b"GET /st", b""):
                for _ in range(5):
                    client = socket.create_connection(page.server.server_address)
                    client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, reset)
                    client.sendall(words)
                    client.close()
            time.sleep(1)
            self.assertEqual(page.json("state")["status"], "finished")
        self.assertEqual(printed.getvalue(), "")

    def test_pipes_and_storage_elsewhere_do_not_hang_the_server(self):
        run("hostile", steps=20)
        os.mkfifo("hostile/pipe")
        with h5py.File("hostile/trajectory.h5", "a") as file:
            shape = file["particles/discs/position/value"].shape
            del file["particles/discs/position/value"]
            external = [(os.path.abspath("hostile/pipe"), 0, h5py.h5f.UNLIMITED)]
            file.create_dataset("particles/discs/position/value", shape, "f8", external=external)
        for name in ("scene.toml", "report.json", "measurements/wall_pressure_history.csv"):
            Path("hostile", name).unlink()
            os.mkfifo(f"hostile/{name}")
        with Page("hostile") as page:
            for path in ("state", "curves", "frame?step=0", "field?name=density"):
                with self.assertRaises(urllib.error.HTTPError, msg=path) as refused:
                    page.get(path)
                refused.exception.close()
                self.assertIn(refused.exception.code, (404, 503), path)
            self.assertIn(b"<html", page.get("")[1].lower())


if __name__ == "__main__":
    unittest.main()
