"""Small functions of numbers that the lookups share, for arrays of any variant and for scalars.

They are those of ``numbers.wgsl`` of the shader export.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

#: The smallest normal number of single precision.
SMALLEST = 1.17549435e-38

#: The largest quotient, a little below the largest number.
LARGEST = 3e38

#: The largest density: products and sums of a few of them stay in single precision.
LARGEST_DENSITY = 1e30


def opaque(number: float) -> mi.Float:
    """A number that kernels read from memory: another compiles no other kernel."""
    found = mi.Float(number)
    if dr.is_jit_v(mi.Float):
        dr.make_opaque(found)
    return found


def unit(x: mi.Float) -> mi.Float:
    """x in [0, 1]."""
    return dr.clip(x, 0.0, 1.0)


def horner(coefficients: mi.Vector4f, w: mi.Float) -> mi.Float:
    """The cubic c0 + c1 w + c2 w^2 + c3 w^3."""
    c = coefficients
    return dr.fma(w * w, dr.fma(w, c.w, c.z), dr.fma(w, c.y, c.x))


def between(a: Any, b: Any, w: mi.Float) -> Any:
    """a where w is 0, b where it is 1, and linear between them."""
    return dr.fma(b - a, w, a)


def log_growth(x: mi.Float) -> mi.Float:
    """ln(1 + x) for x > -1, with the digits of a small x."""
    return dr.select((x >= -0.5) & (x <= 1), x * log_quotient(x), dr.log(1 + x))


def log_quotient(x: mi.Float) -> mi.Float:
    """ln(1 + x)/x for x in [-1/2, 1], by a series whose derivative has its digits, too."""
    inverse = 1 / (2 + x)
    y = x * inverse
    q = y * y
    tail = q * (1 / 9 + q * (1 / 11 + q * (1 / 13 + q / 15)))
    return 2 * inverse * (1 + q * (1 / 3 + q * (1 / 5 + q * (1 / 7 + tail))))


def place(x: mi.Float, last: int) -> tuple[mi.UInt32, mi.Float]:
    """The cell of x in [0, last] and the position in it; at the end, the cell after the last. What
    is no number is in any of them.
    """
    # Python makes no integer of it.
    if not dr.is_jit_v(mi.Float) and not x >= 0:
        x = 0.0
    cell = dr.minimum(mi.UInt32(x), last)
    return cell, x - mi.Float(cell)


class Packets:
    """Rows of four numbers, which are read together."""

    _width = 4

    def __init__(self, rows: Any) -> None:
        """``rows``: an array (n, 1 to the width) of numbers; missing columns are padded by 0."""
        rows = np.asarray(rows, np.float32)
        padded = np.zeros((len(rows), self._width), np.float32)
        padded[:, : rows.shape[1]] = rows
        self._rows: Any
        if dr.is_jit_v(mi.Float):
            self._rows = mi.Float(padded.ravel())
        else:
            self._rows = [self._type(row.tolist()) for row in padded]

    def __call__(self, index: mi.UInt32, active: mi.Bool = True) -> Any:
        """The row of an index, which must exist where ``active``."""
        if isinstance(self._rows, list):
            return self._rows[index] if active else self._type(0)
        return dr.gather(self._type, self._rows, index, active)

    @property
    def _type(self) -> Any:
        return mi.Vector4f


class Pairs(Packets):
    """Rows of two numbers."""

    _width = 2

    @property
    def _type(self) -> Any:
        return mi.Vector2f


class Line:
    """Cubics of one variable as lines, of which two numbers are read and not four: reading takes
    longer than arithmetic.
    """

    def __init__(self, cubics: Any, error: float) -> None:
        """``cubics``: an array (n, 4) of the coefficients of cubics, one after the other, the last
        of which is read at its beginning only; ``error``: how far off lines may be, except those
        of the first cubic, which makes them 4 to 256 of each.
        """
        for parts in (4, 8, 16, 32, 64, 128, 256):
            pairs, off = lines(cubics, parts)
            if np.abs(off[1:-1]).max() <= error:
                break
        self._parts, self._last = parts, len(pairs) - parts
        self._pairs = Pairs(pairs)

    def __call__(self, x: mi.Float, active: mi.Bool = True) -> mi.Float:
        """The function at a place among the cubics, in [0, n - 1]."""
        cell, w = place(x * self._parts, self._last)
        pair = self._pairs(cell, active)
        return dr.fma(w, pair.y, pair.x)


def lines(cubics: Any, parts: int) -> tuple[np.ndarray, np.ndarray]:
    """Beginnings and rises (n * parts, 2) of the lines between even places of cubics (n, 4), and
    what the middles of these (n, parts) miss.
    """
    cubics = np.asarray(cubics, np.float64)[:, None, :]

    def at(w: np.ndarray) -> Any:
        c = cubics
        return c[..., 0] + w * (c[..., 1] + w * (c[..., 2] + w * c[..., 3]))

    ends = at(np.arange(parts + 1) / parts)
    off = at((np.arange(parts) + 0.5) / parts) - 0.5 * (ends[:, 1:] + ends[:, :-1])
    return np.stack([ends[:, :-1], np.diff(ends, axis=1)], axis=-1).reshape(-1, 2), off


class Numbers:
    """A row of numbers, read one at a time."""

    def __init__(self, numbers: Any) -> None:
        numbers = np.asarray(numbers, np.float32).ravel()
        self._numbers: Any
        self._numbers = mi.Float(numbers) if dr.is_jit_v(mi.Float) else numbers.tolist()

    def __call__(self, index: mi.UInt32, active: mi.Bool = True) -> mi.Float:
        """The number of an index, which must exist where ``active``."""
        if isinstance(self._numbers, list):
            return self._numbers[index] if active else 0.0
        return dr.gather(mi.Float, self._numbers, index, active)
