"""Recovers sigma and gamma of a metal from a picture of it, by derivatives of Mitsuba's renderer.

The picture is rendered, too: a sphere under one lamp. The fit begins with another roughness and
shape, and follows the derivatives of the difference between both pictures (Adam)::

    python examples/mitsuba_fit.py --out mitsuba_fit.png
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import microfacet.mitsuba

microfacet.mitsuba.set_variant("llvm_ad_rgb")

import drjit as dr
import matplotlib.pyplot as plt
import mitsuba as mi
import numpy as np
from plot_style import pixels

#: Steps of the optimiser, at the beginning.
RATE = 0.12

SIGMA, GAMMA = "metal.sigma.value", "metal.gamma.value"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sigma", type=float, default=0.2, help="what is to be found")
    parser.add_argument("--gamma", type=float, default=1.7, help="what is to be found")
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--out", default="mitsuba_fit.png", help="where the plot goes")
    options = parser.parse_args()

    scene = sphere(options.sigma, options.gamma)
    reference = mi.render(scene, spp=1024, seed=1000)
    dr.eval(reference)
    start = time.perf_counter()
    parameters = mi.traverse(scene)
    # Logarithms of sigma and of gamma - 3/2: a step is one of their order, and in range.
    optimizer = mi.ad.Adam(lr=RATE)
    optimizer["sigma"], optimizer["gamma"] = dr.log(mi.Float(0.5)), dr.log(mi.Float(2.5))
    path, first = [], None
    for step in range(options.steps):
        parameters[SIGMA] = dr.exp(optimizer["sigma"])
        parameters[GAMMA] = 1.5 + dr.exp(optimizer["gamma"])
        parameters.update()
        path.append((parameters[SIGMA][0], parameters[GAMMA][0]))
        # Smaller steps towards the end, since every picture has noise.
        optimizer.set_learning_rate(RATE * min(1, 3 * (1 - step / options.steps)) ** 2)
        picture = mi.render(scene, parameters, spp=16, seed=step)
        # Relative, so that the haze counts as much as the highlight.
        off = dr.square(picture - reference) / (dr.square(reference) + 1e-4)
        dr.backward(dr.mean(off, axis=None))
        optimizer.step()
        first = picture if first is None else first
    seconds = time.perf_counter() - start
    sigma, gamma = path[-1]
    print(f"{options.steps} steps in {seconds:.0f} s")
    print(f"sigma = {sigma:.4f}, off by {100 * abs(sigma / options.sigma - 1):.2f} %")
    print(f"gamma = {gamma:.4f}, off by {100 * abs(gamma / options.gamma - 1):.2f} %")
    plot(np.array(path), options, [first, mi.render(scene, spp=256), reference])
    print(options.out)


def sphere(sigma: float, gamma: float) -> mi.Scene:
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "prb", "max_depth": 3},
        "sensor": {
            "type": "perspective", "fov": 30,
            "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
            "film": {
                "type": "hdrfilm", "width": 64, "height": 64, "rfilter": {"type": "box"},
                "sample_border": False,
            },
        },
        "lamp": {
            "type": "sphere", "center": [3, 4, 5], "radius": 0.5,
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [30, 28, 25]}},
        },
        "metal": {
            "type": "student_t_conductor", "sigma": sigma, "gamma": gamma, "material": "Au",
            "compensation": "kulla_conty",
        },
        "ball": {"type": "sphere", "bsdf": {"type": "ref", "id": "metal"}},
    }  # fmt: skip
    return mi.load_dict(scene)


def plot(path: np.ndarray, options: argparse.Namespace, pictures: list[Any]) -> None:
    figure, axes = plt.subplot_mosaic(
        [["path"] * 3, ["before", "after", "wanted"]],
        figsize=(5.12, 4.4), height_ratios=(1.25, 1), layout="constrained",
    )  # fmt: skip
    steps = axes["path"]
    for column, (name, wanted, dash) in enumerate(
        (("roughness σ", options.sigma, "solid"), ("shape γ", options.gamma, (0, (3.5, 2))))
    ):
        (line,) = steps.plot(path[:, column], ls=dash, label=name)
        # What is to be found.
        steps.axhline(wanted, color=line.get_color(), linestyle=":", linewidth=pixels(1.4))
    steps.plot([], [], "k:", linewidth=pixels(1.4), label="wanted")
    steps.set_yscale("log")
    steps.set_yticks([0.2, 0.5, 1, 2, 4], labels=["0.2", "0.5", "1", "2", "4"])
    steps.minorticks_off()
    steps.set(xlabel="step of the optimiser", ylabel="σ and γ")
    steps.legend(loc="center right")
    names = ("before", f"after {options.steps} steps", "wanted")
    for key, name, picture in zip(("before", "after", "wanted"), names, pictures):
        axes[key].imshow(np.asarray(mi.util.convert_to_bitmap(picture)))
        axes[key].set_title(name)
        axes[key].set_axis_off()
    figure.savefig(options.out)


if __name__ == "__main__":
    main()
