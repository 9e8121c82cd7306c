"""Renders metal spheres of one roughness and four shapes next to each other.

::

    python examples/mitsuba_comparison.py
"""

from __future__ import annotations

import argparse
import math

import microfacet.mitsuba

microfacet.mitsuba.set_variant("llvm_ad_rgb")

import matplotlib.pyplot as plt
import numpy as np
from mitsuba_studio import picture, studio
from plot_style import name, pixels

SHAPES = [1.6, 2.0, 3.0, math.inf]
#: Pixels: the edge of a picture, the gap between two, and the room for letters.
SIZE, GAP, ABOVE, BELOW = 250, 10, 42, 42


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sigma", type=float, default=0.12, help="the roughness")
    parser.add_argument("--spp", type=int, default=512, help="samples of a pixel")
    parser.add_argument("--out", default="mitsuba_comparison.png", help="where the picture goes")
    options = parser.parse_args()

    surfaces = [
        {
            "type": "student_t_conductor", "material": "Cu", "gamma": gamma,
            "sigma": options.sigma, "compensation": "kulla_conty",
        }
        for gamma in map(str, SHAPES)
    ]  # fmt: skip
    pictures = [picture(studio(surface, SIZE, SIZE), options.spp) for surface in surfaces]
    width, height = len(SHAPES) * (SIZE + GAP) - GAP, ABOVE + SIZE + BELOW
    figure = plt.figure(figsize=(width / 100, height / 100), dpi=100)
    letters = pixels(24)
    for number, (gamma, one) in enumerate(zip(SHAPES, pictures)):
        left = number * (SIZE + GAP)
        axes = figure.add_axes((left / width, BELOW / height, SIZE / width, SIZE / height))
        axes.imshow(np.asarray(one))
        axes.set_axis_off()
        middle = (left + SIZE / 2) / width
        figure.text(middle, 1 - 30 / height, name(gamma), ha="center", fontsize=letters)
    words = f"copper of roughness σ = {options.sigma:g}"
    figure.text(0.5, 12 / height, words, ha="center", fontsize=letters)
    figure.savefig(options.out, dpi=100)
    print(options.out)


if __name__ == "__main__":
    main()
