# SPDX-License-Identifier: BSD-3-Clause
"""The command `python3 -m carrom.importing`."""

import sys

from carrom.importing.command import main

sys.exit(main())
