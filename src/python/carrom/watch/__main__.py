# SPDX-License-Identifier: BSD-3-Clause
"""`python3 -m carrom.watch FOLDER`."""

from __future__ import annotations

import argparse
import os
import sys
import webbrowser
from pathlib import Path

from carrom.errors import CarromError
from carrom.watch.follower import Follower
from carrom.watch.server import DEFAULT_PORT, serve

EXAMPLES = """examples:
  carrom run inputs/gas.toml -o gas --set output.trajectory.every_steps=10 &
  python3 -m carrom.watch gas
  ssh -L 8787:localhost:8787 CLUSTER        then open http://localhost:8787 here
"""


def options(words: list[str]) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        prog="python3 -m carrom.watch",
        description="Watch a run in a browser, while it goes on or later.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path, help="the run's folder, or one file of it")
    parser.add_argument(
        "--port", type=int, default=DEFAULT_PORT, help="default %(default)s; 0: any free one"
    )
    parser.add_argument("--wait", action="store_true", help="the folder may not be there yet")
    parser.add_argument("--browser", action="store_true", help="open the page")
    return parser.parse_args(words)


def main(words: list[str] | None = None) -> int:
    """Serve until Ctrl-C; 2 where the command line is wrong."""
    wanted = options(sys.argv[1:] if words is None else words)
    try:
        server = serve(Follower(wanted.folder, may_wait=wanted.wait), wanted.port)
    except CarromError as error:
        print(f"carrom.watch: {error}", file=sys.stderr)
        return 2
    if hasattr(os, "nice"):
        os.nice(10)  # the run comes first
    print(f"Watching {wanted.folder} at {server.address} - Ctrl-C ends this", flush=True)
    if wanted.browser:
        webbrowser.open(server.address)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        print()
    finally:
        server.server_close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
