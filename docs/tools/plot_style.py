# SPDX-License-Identifier: BSD-3-Clause
"""One style for all plots of the pages: `plot_style.use()` before the first figure.

Plots are at least 900 pixels wide, so that they stay sharp on a page of that width, and labels are
as large as the text around them.
"""

import argparse

import matplotlib
import matplotlib.pyplot as plt

COLOURS = ("#0060b0", "#c05000", "#208040", "#703090", "#444444", "#b02050")
DPI = 120


def use():
    """Set fonts, colours and sizes, and draw without a screen."""
    matplotlib.use("Agg")
    plt.rcParams.update(
        {
            "figure.figsize": (8, 5),
            "figure.dpi": DPI,
            "savefig.dpi": DPI,
            "figure.constrained_layout.use": True,
            "font.size": 12,
            "axes.grid": True,
            "axes.axisbelow": True,
            "grid.color": "0.9",
            "axes.prop_cycle": matplotlib.cycler(color=COLOURS),
            "lines.markersize": 6,
            "legend.frameon": False,
        }
    )


def program_and_picture(text):
    """The words CARROM and PICTURE of the command line, and this style. `text` is the tool's own."""
    parser = argparse.ArgumentParser(
        description=text, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="CARROM")
    parser.add_argument("picture", metavar="PICTURE")
    use()
    return parser.parse_args()
