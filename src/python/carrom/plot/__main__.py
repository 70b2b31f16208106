# SPDX-License-Identifier: BSD-3-Clause
"""`python3 -m carrom.plot` is `carrom-plot`."""

import sys

from carrom.plot.commands import main

sys.exit(main())
