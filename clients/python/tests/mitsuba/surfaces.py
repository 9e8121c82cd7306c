"""Makes surfaces, views and lights for the tests."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

REPOSITORY = Path(__file__).resolve().parents[4]

#: Of a uniform surface: Mitsuba's fields of a hit that a plugin reads.
CONTEXT = mi.BSDFContext()


def conductor(**properties: Any) -> mi.BSDF:
    return mi.load_dict({"type": "student_t_conductor", **properties})


def dielectric(**properties: Any) -> mi.BSDF:
    return mi.load_dict({"type": "student_t_dielectric", **properties})


def plastic(**properties: Any) -> mi.BSDF:
    return mi.load_dict({"type": "student_t_plastic", **properties})


def directions(count: int, seed: int, lowest: float = 0.0) -> np.ndarray:
    """Directions (count, 3) of random azimuth, their cosines evenly in [lowest, 1]."""
    rng = np.random.default_rng(seed)
    z = lowest + (1 - lowest) * rng.random(count)
    azimuth, radius = 2 * math.pi * rng.random(count), np.sqrt(1 - z * z)
    w = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=1)
    return w.astype(np.float32)


def vectors(array: np.ndarray) -> mi.Vector3f:
    return mi.Vector3f(np.ascontiguousarray(array.T))


def hit(views: np.ndarray) -> mi.SurfaceInteraction3f:
    """Hits of a surface by views (count, 3), in its frame."""
    si = dr.zeros(mi.SurfaceInteraction3f, len(views))
    si.wi = vectors(views)
    return si


def numbers(array: Any) -> np.ndarray:
    """An array of Dr.Jit in numpy: (count,), or (count, channels)."""
    return np.asarray(array.numpy()).T


def uniform(count: int, dimensions: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).random((dimensions, count), dtype=np.float32)


def drawn(bsdf: mi.BSDF, si: mi.SurfaceInteraction3f, u: np.ndarray, context: Any = CONTEXT) -> Any:
    """A sample and its weight by numbers (3, count)."""
    return bsdf.sample(context, si, mi.Float(u[0]), mi.Point2f(u[1:]))


def relative(got: np.ndarray, want: np.ndarray, floor: float) -> float:
    """The largest difference, over the wanted number or the floor."""
    return float(np.max(np.abs(got - want) / np.maximum(np.abs(want), floor)))


def steps(*values: float) -> dict[str, Any]:
    """A texture of some values side by side, each in an equal part of [0, 1] of u."""
    data = np.tile(np.array(values, np.float32), (2, 1))[..., None]
    return {
        "type": "bitmap", "raw": True, "filter_type": "nearest", "wrap_mode": "clamp",
        "bitmap": mi.Bitmap(data),
    }  # fmt: skip


def place(number: int, count: int) -> list[float]:
    """Where a texture of :func:`steps` has one of its values."""
    return [(number + 0.5) / count, 0.5]
