# SPDX-License-Identifier: BSD-3-Clause
"""The server of the page: a few addresses, on the loopback interface only."""

from __future__ import annotations

import contextlib
import errno
import json
import re
import socket
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from typing import Any
from urllib.parse import parse_qs, urlsplit

from carrom.errors import CarromError, NoDataError
from carrom.watch.follower import Follower
from carrom.watch.picture import View

DEFAULT_PORT = 8787
_PAGES = {
    "/": ("index.html", "text/html; charset=utf-8"),
    "/watch.css": ("watch.css", "text/css; charset=utf-8"),
    "/watch.js": ("watch.js", "text/javascript; charset=utf-8"),
    "/discs.js": ("discs.js", "text/javascript; charset=utf-8"),
    "/curves.js": ("curves.js", "text/javascript; charset=utf-8"),
    "/fields.js": ("fields.js", "text/javascript; charset=utf-8"),
}
_MOST_CONNECTIONS = 64
_LOOPBACK = re.compile(r"(127\.0\.0\.1|localhost|\[::1\])(:[0-9]{1,5})?", re.ASCII)


class Server(ThreadingHTTPServer):
    """Answers for one run. Other machines cannot reach it."""

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, follower: Follower, port: int) -> None:
        """Bind the port of 127.0.0.1; 0 takes any free one."""
        self.follower = follower
        self._guard = threading.Lock()
        self._open: dict[Any, None] = {}  # connections, that of the oldest request first
        super().__init__(("127.0.0.1", port), _Handler)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer in a thread. Too many connections would take all file descriptors of the process,
        so the one that has been idle longest is closed.
        """
        self.note_use(request)
        with self._guard:
            idle = next(iter(self._open)) if len(self._open) > _MOST_CONNECTIONS else None
            if idle is not None:
                del self._open[idle]
        if idle is not None:
            with contextlib.suppress(OSError):
                idle.shutdown(socket.SHUT_RDWR)
        super().process_request(request, client_address)

    def note_use(self, connection: Any) -> None:
        """Make a connection the youngest one."""
        with self._guard:
            self._open.pop(connection, None)
            self._open[connection] = None

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing where a client has gone or is silent, because nothing is wrong here."""
        if not isinstance(sys.exc_info()[1], (ConnectionError, TimeoutError)):
            super().handle_error(request, client_address)

    def shutdown_request(self, request: Any) -> None:
        """Close a connection."""
        with self._guard:
            self._open.pop(request, None)
        super().shutdown_request(request)

    @property
    def address(self) -> str:
        """What to open in a browser."""
        return f"http://127.0.0.1:{self.server_address[1]}/"


def serve(follower: Follower, port: int = DEFAULT_PORT) -> Server:
    """Make a server; `serve_forever` runs it.

    Raises:
        CarromError: the port is in use, or may not be taken
    """
    try:
        return Server(follower, port)
    except OverflowError:
        raise CarromError(f"port {port}: is no port; take one from 1024 to 65535") from None
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise CarromError(
                f"port {port} is in use, maybe by another watch; "
                f"try: --port {port + 1}, or --port 0 for any free one"
            ) from None
        raise CarromError(f"port {port}: {error.strerror}; try: --port 0") from None


class _Handler(BaseHTTPRequestHandler):
    """One request."""

    server: Server
    protocol_version = "HTTP/1.1"
    timeout = 60  # seconds without a byte; browsers connect again by themselves

    def do_GET(self) -> None:
        """Answer a request for the page, the state, curves or a frame."""
        self.server.note_use(self.connection)
        # A page of another site must not reach this one by its name.
        if not _LOOPBACK.fullmatch(self.headers.get("Host", "")):
            self._answer(403, b"this page is for this machine only", "text/plain")
            return
        try:
            address = urlsplit(self.path)
            words = {name: values[-1] for name, values in parse_qs(address.query).items()}
            self._dispatch(address.path, words)
        except NoDataError as error:
            self._answer(404, str(error).encode(), "text/plain; charset=utf-8")
        except (CarromError, OSError) as error:  # the run may be replacing the file right now
            self._answer(503, str(error).encode(), "text/plain; charset=utf-8")
        except ValueError as error:
            self._answer(400, f"no such request: {error}".encode(), "text/plain; charset=utf-8")
        except (LookupError, TypeError, AttributeError, RuntimeError) as error:
            what = f"the run cannot be shown: {error!r}; `carrom verify` looks for damage"
            self._answer(503, what.encode(), "text/plain; charset=utf-8")

    def _dispatch(self, path: str, words: dict[str, str]) -> None:
        follower = self.server.follower
        if path in _PAGES:
            name, kind = _PAGES[path]
            page = resources.files("carrom.watch").joinpath("page", name).read_bytes()
            self._answer(200, page, kind)
        elif path == "/state":
            self._answer_json(follower.state(int(words.get("have", 0)), int(words.get("last", -1))))
        elif path == "/curves":
            self._answer_json(follower.curves())
        elif path == "/field":
            self._answer_json(follower.field(words.get("name", "density")))
        elif path == "/frame":
            step, colour = int(words.get("step", "")), words.get("colour", "speed")
            view = View.of(words["view"]) if "view" in words else None
            about, body = follower.frame(step, colour, view, "follow" in words)
            self._answer(200, body, "application/octet-stream", {"X-Frame": json.dumps(about)})
        else:
            self._answer(404, b"no such page", "text/plain")

    def _answer_json(self, value: Any) -> None:
        self._answer(200, json.dumps(value).encode(), "application/json")

    def _answer(
        self, code: int, body: bytes, kind: str, headers: dict[str, str] | None = None
    ) -> None:
        try:
            self._send(code, body, kind, headers or {})
        except ConnectionError:
            self.close_connection = True  # the page has been closed

    def _send(self, code: int, body: bytes, kind: str, headers: dict[str, str]) -> None:
        self.send_response(code)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("Content-Security-Policy", "default-src 'self'; img-src 'self' data:")
        self.send_header("X-Content-Type-Options", "nosniff")
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *words: Any) -> None:
        """Print nothing for each request."""
