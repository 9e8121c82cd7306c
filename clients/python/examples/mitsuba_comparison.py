"""Renders metal spheres of one roughness and four shapes next to each other.

::

    python examples/mitsuba_comparison.py
"""

from __future__ import annotations

import argparse

import microfacet.mitsuba

microfacet.mitsuba.set_variant("llvm_ad_rgb")

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from mitsuba_studio import picture, studio

SHAPES = {"γ = 1.6": 1.6, "GGX (γ = 2)": 2.0, "γ = 3": 3.0, "Beckmann (γ = ∞)": "inf"}


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
        for gamma in SHAPES.values()
    ]  # fmt: skip
    size = 250
    pictures = [picture(studio(surface, size, size), options.spp) for surface in surfaces]
    pixels = np.concatenate([np.asarray(one) for one in pictures], axis=1)
    figure = plt.figure(figsize=(len(SHAPES) * size / 100, (size + 30) / 100), dpi=100)
    axes = figure.add_axes((0, 0, 1, size / (size + 30)))
    axes.imshow(pixels)
    axes.set_axis_off()
    for number, name in enumerate(SHAPES):
        axes.text(size * (number + 0.5), -8, name, ha="center", va="bottom", fontsize=12)
    figure.savefig(options.out)
    print(options.out)


if __name__ == "__main__":
    main()
