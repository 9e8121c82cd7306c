"""Plots Smith's G1, a reflected lobe, and drawn normals against their density, by matplotlib.

python plots.py [OUT.png]
"""

import math
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from plot_style import SHAPES, name, pixels

import microfacet
from microfacet import exact

SIGMA = 0.4


def plane(theta: np.ndarray) -> np.ndarray:
    """Directions of the plane y = 0 at angles from the normal, in radians: shape (N, 3)."""
    return np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=1)


def masking(axes: Axes) -> None:
    """G1 over the angle of the view, by tables and by the model."""
    theta = np.linspace(0.0, math.pi / 2, 200)
    for gamma, (colour, dash) in SHAPES.items():
        lobe, model = microfacet.StudentT(SIGMA, gamma), exact.StudentT(SIGMA, gamma)
        axes.plot(np.degrees(theta), lobe.g1(plane(theta)), color=colour, ls=dash, label=name(gamma))
        some = theta[::12]
        axes.plot(np.degrees(some), model.g1(plane(some)), ".", color=colour, ms=pixels(5))
    axes.set(title=f"Masking, σ = {SIGMA}", xlabel="angle θ of the view (°)", ylabel="masking G₁(θ)")
    axes.set(xticks=[0, 30, 60, 90], ylim=(0, 1.05))


def lobe(axes: Axes) -> None:
    """f cos of a mirror-like conductor for a view at 40°, over the light in the plane."""
    theta = np.radians(np.linspace(-89.9, 89.9, 800))
    v = [-math.sin(math.radians(40)), 0.0, math.cos(math.radians(40))]
    for gamma, (colour, dash) in SHAPES.items():
        bsdf = microfacet.Conductor(microfacet.StudentT(0.1, gamma))
        value = bsdf.eval(v, plane(theta))[:, 0] * np.cos(theta)
        axes.semilogy(np.degrees(theta), value, color=colour, ls=dash)
    axes.set(title="A view at −40°, σ = 0.1", xlabel="angle θ of the light (°)")
    axes.set(xticks=[-90, -45, 0, 45, 90], ylabel="f cos θ (1/sr)", ylim=(1e-4, 30))


def samples(axes: Axes) -> None:
    """A histogram of drawn visible normals over their angle, and the density, for a view at 60°."""
    v = plane(np.array([math.radians(60)]))[0]
    u = np.random.default_rng(1).random((1_000_000, 2))
    edges = np.linspace(0.0, math.pi / 2, 91)
    middle = 0.5 * (edges[1:] + edges[:-1])
    phi = (np.arange(256) + 0.5) * (2 * math.pi / 256)
    sin, cos = np.sin(middle)[:, None], np.cos(middle)[:, None]
    m = np.stack([sin * np.cos(phi), sin * np.sin(phi), cos + 0 * phi], axis=-1)
    for gamma, (colour, dash) in SHAPES.items():
        lobe = microfacet.StudentT(SIGMA, gamma)
        theta = np.arccos(np.minimum(lobe.sample_visible_normal(v, u)[:, 2], 1.0))
        count, _ = np.histogram(theta, edges, density=True)
        # Every other bin, so that lines are seen between the dots.
        some = slice(0, None, 2)
        axes.plot(np.degrees(middle)[some], count[some], ".", color=colour, ms=pixels(5))
        # In double precision: sums of float32 along an axis lose digits.
        mean = lobe.visible_normal_pdf(v, m).mean(axis=1, dtype=float)
        density = 2 * math.pi * mean * np.sin(middle)
        axes.plot(np.degrees(middle), density, color=colour, ls=dash)
    axes.set(title=f"Visible normals of a view at 60°, σ = {SIGMA}", ylabel="density (1/rad)")
    axes.set(xlabel="angle θ of the normal (°)", xticks=[0, 15, 30, 45, 60, 75, 90], ylim=(0, 3))


def main(out: str = "microfacet.png") -> None:
    figure, axes = plt.subplot_mosaic(
        [["masking", "lobe"], ["samples", "samples"]], figsize=(5.12, 5.2), layout="constrained"
    )
    masking(axes["masking"])
    lobe(axes["lobe"])
    samples(axes["samples"])
    axes["masking"].plot([], [], ".", color="black", ms=pixels(5), label="model; drawn normals")
    figure.legend(loc="outside lower center", ncols=3)
    figure.savefig(out)
    print(out)


if __name__ == "__main__":
    main(*sys.argv[1:])
