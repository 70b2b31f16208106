# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of runs. Needs matplotlib: `pip install carrom[plot]`."""
