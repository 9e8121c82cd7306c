"""The style of the figures of this project, for matplotlib: letters, lines, and a colour and a dash
for each shape, as `crates/report/src/plot/ink.rs` has them.
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

#: A hundredth of an inch is a pixel of a figure, and two of its file.
DPI = 200

Dash = str | tuple[int, tuple[float, ...]]

#: The colour and the dash of a shape: GGX is dashed and Beckmann dotted.
SHAPES: dict[float, tuple[str, Dash]] = {
    1.6: ("#371f7e", "solid"),
    2.0: ("#2463b6", (0, (3.5, 2))),
    4.0: ("#059791", (0, (5, 1.6, 1.2, 1.6))),
    math.inf: ("#faaa28", (0, (1.2, 1.5))),
}
NAMES = {2.0: "γ = 2, GGX", math.inf: "γ = ∞, Beckmann"}


def name(gamma: float) -> str:
    return NAMES.get(gamma, f"γ = {gamma:g}")


def pixels(count: float) -> float:
    """Points of type or of a line for as many pixels of a figure."""
    return 0.72 * count


plt.rcParams.update({
    "font.family": "DejaVu Sans",
    "font.size": pixels(12),
    "axes.titlesize": pixels(13),
    "axes.labelsize": pixels(12),
    "xtick.labelsize": pixels(11),
    "ytick.labelsize": pixels(11),
    "legend.fontsize": pixels(12),
    "legend.frameon": False,
    "legend.handlelength": 2.4,
    "lines.linewidth": pixels(2),
    "lines.dash_capstyle": "butt",
    "axes.linewidth": pixels(1),
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.xmargin": 0,
    "grid.color": "#dcdcdc",
    "grid.linewidth": pixels(1),
    "savefig.dpi": DPI,
})  # fmt: skip
