# SPDX-License-Identifier: BSD-3-Clause
"""Watch a run in a browser: `python3 -m carrom.watch FOLDER`. `docs/how-to/watch.md` says how.

A small server on the loopback interface reads the files that the run writes anyway. It leaves
the run's lock alone and writes nothing, so the run and its bits stay as they are.
"""

from carrom.watch.follower import Follower
from carrom.watch.server import DEFAULT_PORT, Server, serve

__all__ = ["DEFAULT_PORT", "Follower", "Server", "serve"]
