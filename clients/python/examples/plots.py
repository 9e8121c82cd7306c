"""Plots Smith's G1, a reflected lobe, and drawn normals against their density, by matplotlib.

python plots.py [OUT.png]
"""

import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

import microfacet
from microfacet import exact

SHAPES = {1.6: "tab:red", 2.0: "tab:orange", 4.0: "tab:green", math.inf: "tab:blue"}
NAMES = {2.0: "γ = 2, GGX", math.inf: "γ = ∞, Beckmann"}
SIGMA = 0.4


def name(gamma: float) -> str:
    return NAMES.get(gamma, f"γ = {gamma}")


def plane(theta: np.ndarray) -> np.ndarray:
    """Directions of the plane y = 0 at angles from the normal, in radians: shape (N, 3)."""
    return np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=1)


def masking(axes: Axes) -> None:
    """G1 over the angle of the view, by tables and by the model."""
    theta = np.linspace(0.0, math.pi / 2, 200)
    for gamma, colour in SHAPES.items():
        lobe, model = microfacet.StudentT(SIGMA, gamma), exact.StudentT(SIGMA, gamma)
        axes.plot(np.degrees(theta), lobe.g1(plane(theta)), colour, label=name(gamma))
        axes.plot(np.degrees(theta[::12]), model.g1(plane(theta[::12])), ".", color=colour)
    axes.set(title="G1, tables (lines) and model (dots)", xlabel="θ in degrees", ylabel="G1(v)")
    axes.legend()


def lobe(axes: Axes) -> None:
    """f cos of a mirror-like conductor for a view at 40°, over the light in the plane."""
    theta = np.radians(np.linspace(-89.9, 89.9, 800))
    v = [-math.sin(math.radians(40)), 0.0, math.cos(math.radians(40))]
    for gamma, colour in SHAPES.items():
        bsdf = microfacet.Conductor(microfacet.StudentT(0.1, gamma))
        value = bsdf.eval(v, plane(theta))[:, 0] * np.cos(theta)
        axes.semilogy(np.degrees(theta), value, colour, label=name(gamma))
    axes.set(title="f cos θ of σ = 0.1, view at −40°", xlabel="θ of the light in degrees")
    axes.set_ylim(1e-4, 30)


def samples(axes: Axes) -> None:
    """A histogram of drawn visible normals over their angle, and the density, for a view at 60°."""
    v = plane(np.array([math.radians(60)]))[0]
    u = np.random.default_rng(1).random((1_000_000, 2))
    edges = np.linspace(0.0, math.pi / 2, 91)
    middle = 0.5 * (edges[1:] + edges[:-1])
    phi = (np.arange(256) + 0.5) * (2 * math.pi / 256)
    sin, cos = np.sin(middle)[:, None], np.cos(middle)[:, None]
    m = np.stack([sin * np.cos(phi), sin * np.sin(phi), cos + 0 * phi], axis=-1)
    for gamma, colour in SHAPES.items():
        lobe = microfacet.StudentT(SIGMA, gamma)
        theta = np.arccos(np.minimum(lobe.sample_visible_normal(v, u)[:, 2], 1.0))
        count, _ = np.histogram(theta, edges, density=True)
        axes.stairs(count, np.degrees(edges), color=colour, alpha=0.4, fill=True)
        # In double precision: sums of float32 along an axis lose digits.
        mean = lobe.visible_normal_pdf(v, m).mean(axis=1, dtype=float)
        density = 2 * math.pi * mean * np.sin(middle)
        axes.plot(np.degrees(middle), density, colour)
    axes.set(title="a million visible normals (areas) and\ntheir density (lines), view at 60°")
    axes.set_ylim(0, 3)
    axes.set_xlabel("θ of the normal in degrees")


def main(out: str = "microfacet.png") -> None:
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.6), layout="constrained")
    masking(axes[0])
    lobe(axes[1])
    samples(axes[2])
    figure.savefig(out, dpi=110)
    print(out)


if __name__ == "__main__":
    main(*sys.argv[1:])
