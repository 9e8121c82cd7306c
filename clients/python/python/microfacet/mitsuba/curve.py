"""A function of the cosine of a view, tabulated for one roughness, or for several."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import Packets, horner, place, unit

#: Cells of the coordinate x = i/256 of the cosine (1 - (1 - x)^4)^4: what a surface loses changes
#: within its roughness of the horizon, and for gamma < 2 steeply next to the normal.
CELLS = 256


def cosines() -> np.ndarray:
    """The cosines (257) at which the function must be known."""
    x = np.arange(CELLS + 1) / CELLS
    return (1 - (1 - x) ** 4) ** 4


class Curve:
    """Cubics through the values at :func:`cosines`."""

    def __init__(self, values: Any) -> None:
        """``values``: 257 numbers, or rows of them."""
        node, rows = np.arange(CELLS + 1), np.atleast_2d(np.asarray(values, np.float64))
        ends = (rows[:, np.clip(node + shift, 0, CELLS)] for shift in (-1, 0, 1, 2))
        self._cells = Packets(np.stack(_cubics(*ends), axis=-1).reshape(-1, 4))

    def __call__(
        self, cos_theta: mi.Float, active: mi.Bool = True, row: mi.UInt32 | int = 0
    ) -> mi.Float:
        """The function at a cosine in [0, 1]."""
        x = 1 - dr.sqrt(dr.safe_sqrt(1 - dr.sqrt(dr.sqrt(unit(cos_theta)))))
        cell, w = place(x * CELLS, CELLS)
        return horner(self._cells(row * (CELLS + 1) + cell, active), w)


def _cubics(a: Any, b: Any, c: Any, d: Any) -> tuple[Any, Any, Any, Any]:
    """The cubics from b to c, whose slopes are those across two cells (Catmull & Rom)."""
    start, end = 0.5 * (c - a), 0.5 * (d - b)
    return b, start, 3 * (c - b) - 2 * start - end, 2 * (b - c) + start + end


def average(of: Any) -> Any:
    """The cosine-weighted average 2 int f(mu) mu dmu of a function of numpy's cosines."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    x = (np.arange(CELLS)[:, None] + 0.5 * (nodes + 1)).ravel() / CELLS
    root = 1 - (1 - x) ** 4
    # 2 mu dmu of mu = root^4.
    weight = np.tile(0.5 * weights / CELLS, CELLS) * 32 * root**7 * (1 - x) ** 3
    return (of(root**4).T @ weight).T
