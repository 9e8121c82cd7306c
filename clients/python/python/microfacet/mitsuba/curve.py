"""A function of the cosine of a view, tabulated for one roughness."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import Packets, horner, place, unit

#: Cells of the coordinate x = i/256 of the cosine (x (2 - x))^4: what a surface loses changes
#: within its roughness of the horizon, and next to the normal with the angle.
CELLS = 256


def cosines() -> np.ndarray:
    """The cosines (257) at which the function must be known."""
    x = np.arange(CELLS + 1) / CELLS
    return (x * (2 - x)) ** 4


class Curve:
    """Cubics through the values at :func:`cosines`."""

    def __init__(self, values: Any) -> None:
        """``values``: 257 numbers."""
        node, values = np.arange(CELLS + 1), np.asarray(values, np.float64)
        # Next to the normal it may bend too sharply for a mirror image: a parabola goes on.
        a, b, c = values[-3:]
        values = np.append(values, a - 3 * b + 3 * c)
        ends = (values[np.clip(node + shift, 0, CELLS + 1)] for shift in (-1, 0, 1, 2))
        self._cells = Packets(np.stack(_cubics(*ends), axis=1))

    def __call__(self, cos_theta: mi.Float, active: mi.Bool = True) -> mi.Float:
        """The function at a cosine in [0, 1]."""
        x = 1 - dr.safe_sqrt(1 - dr.sqrt(dr.sqrt(unit(cos_theta))))
        cell, w = place(x * CELLS, CELLS)
        return horner(self._cells(cell, active), w)


def _cubics(a: Any, b: Any, c: Any, d: Any) -> tuple[Any, Any, Any, Any]:
    """The cubics from b to c, whose slopes are those across two cells (Catmull & Rom)."""
    start, end = 0.5 * (c - a), 0.5 * (d - b)
    return b, start, 3 * (c - b) - 2 * start - end, 2 * (b - c) + start + end


def average(of: Any) -> Any:
    """The cosine-weighted average 2 int f(mu) mu dmu of a function of numpy's cosines."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    x = (np.arange(CELLS)[:, None] + 0.5 * (nodes + 1)).ravel() / CELLS
    root = x * (2 - x)
    # 2 mu dmu of mu = root^4.
    weight = np.tile(0.5 * weights / CELLS, CELLS) * 8 * root**7 * 2 * (1 - x)
    return (of(root**4).T @ weight).T
