"""Lobes whose gamma differs from hit to hit: the tables of all gammas, linear between two of some.

The same as ``family.wgsl`` of the shader export, with other tables: numbers of single precision at
more shapes, of which what two neighbours have at one place lies together, since reading takes
longer than arithmetic.
"""

from __future__ import annotations

import atexit
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, Iterable

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import LARGEST, SMALLEST, Packets, lines, log_quotient, place
from .normals import slope_packets
from .shape import Lobe

#: The range of gamma, whose upper end is Beckmann to rounding.
GAMMA = (1.501, 1e18)

#: Gamma from which tables hold whole distributions; below, a closed form has a part of them.
SEAM = 1.8

#: The least 1/(gamma - 1), from which derivatives are finite: Beckmann to rounding.
_LEAST_S = 2.0**-40


@dataclass(frozen=True)
class _Part:
    """Shapes of one range of gamma, even in ln(r + offset), r = (2 gamma - 3)/(gamma - 1)."""

    low: float
    high: float
    offset: float
    count: int

    @property
    def ends(self) -> tuple[float, float]:
        """The coordinate of the lowest gamma, and of the highest."""
        low, high = (math.log(2 - 1 / (g - 1) + self.offset) for g in (self.low, self.high))
        return low, high

    def gammas(self) -> list[float]:
        r = np.exp(np.linspace(*self.ends, self.count)[1:-1]) - self.offset
        return [self.low, *(1 + 1 / (2 - r)).tolist(), self.high]


#: The offsets put shapes where tables change most.
_PARTS = (_Part(1.501, SEAM - 1e-9, 0.1, 49), _Part(SEAM, math.inf, -0.3, 65))

#: Of both parts: offset, start and scale of the coordinate, the last cell, and the first shape.
_PLACES = tuple(
    (part.offset, start, (part.count - 1) / (end - start), part.count - 2, first)
    for part, first in zip(_PARTS, (0, _PARTS[0].count))
    for start, end in (part.ends,)
)


def shapes(tables: Any, gammas: Iterable[float]) -> list[Any]:
    """What ``tables.shape`` returns for some gammas; ``ValueError`` if the set lacks one."""
    lacks = [gamma for gamma in (GAMMA[0], 2.5, math.inf) if not tables.covers(gamma)]
    if lacks:
        raise ValueError(
            f"this set of tables has no gamma = {lacks[0]:g}: a gamma that is a texture, is changed"
            " or has derivatives needs tables of [1.501, inf]; leave out tables, or bake them"
            " without a recipe"
        )
    with ThreadPoolExecutor() as pool:
        return list(pool.map(tables.shape, gammas))


class Family:
    """The tables of all gammas in the current variant."""

    _built_in: dict[str, Family] = {}

    @classmethod
    def of(cls, tables: Any, is_built_in: bool) -> Family:
        """The family of a set; that of the built-in one is made once for all plugins."""
        found = cls._built_in.get(mi.variant()) if is_built_in else None
        if found is None:
            found = cls(tables)
            if is_built_in:
                cls._built_in[mi.variant()] = found
        return found

    def __init__(self, tables: Any) -> None:
        small, whole = (shapes(tables, part.gammas()) for part in _PARTS)
        every = [shape.tables for shape in small + whole]
        #: The numbers of the two parts, most of which all gammas of a part have in common; of
        #: others, that of a gamma is a closed form.
        self.members = [
            {name: number for name, number in part[0].members.items() if "." not in name}
            for part in (small, whole)
        ]
        #: kappa (2 gamma - 3)/(gamma - 1), the same for all.
        self.kappa = 2 * whole[-1].members["kappa"]
        self.count = len(every)
        self.masking = _Lines([of["masking"] for of in every], 8)
        self.across = _Lines([of["across"] for of in every], 32)
        self.heavy = _Lines([_heavy(shape) for shape in small], 4)
        packets = np.stack([slope_packets(of["slopes"]) for of in every], axis=1)
        self.slopes = Packets(packets.reshape(-1, 4))
        #: Albedos of the same set that were asked for, by form of masking.
        self.albedos: dict[bool, Any] = {}

    def at(self, gamma: mi.Float, low: float = GAMMA[0], high: float = GAMMA[1]) -> FamilyLobe:
        """The lobe of a gamma, which is clamped to the range, and known to lie in [low, high]: all
        below 1.8, or all above, is faster.
        """
        return FamilyLobe(self, dr.clip(gamma, *GAMMA), low < SEAM, high >= SEAM)


# Before Dr.Jit ends.
atexit.register(Family._built_in.clear)


def _heavy(shape: Any) -> np.ndarray:
    """The cubics of heavy/(heavy + rest/q), q = 2 gamma - 3, of the shares heavy and rest.

    It is smooth where gamma falls to 3/2, as the share itself is not.
    """
    cubics, q = np.asarray(shape.tables["heavy"], np.float64), 2 * shape.gamma - 3
    w = np.arange(4) / 3
    powers = np.stack([w**0, w, w * w, w**3])
    share = cubics @ powers
    return np.asarray((share * q / (share * q + 1 - share)) @ np.linalg.inv(powers))


class _Lines:
    """Functions of one variable for each of some shapes, as :class:`.arithmetic.Line` has them."""

    def __init__(self, cubics: list[Any], parts: int) -> None:
        """``cubics``: an array (n, 4) for each shape."""
        pairs = [lines(of, parts)[0] for of in cubics]
        self._parts, self._count = parts, len(pairs)
        longest = max(map(len, pairs))
        padded = np.zeros((longest, len(pairs) + 1, 2))
        for number, of in enumerate(pairs):
            padded[: len(of), number] = of
        self._last = longest - parts
        both = np.concatenate([padded[:, :-1], padded[:, 1:]], axis=2)
        self._both = Packets(both.reshape(-1, 4))

    def __call__(
        self, x: mi.Float, shape: mi.UInt32, between: mi.Float, active: mi.Bool
    ) -> mi.Float:
        """The function at a place among the cubics, between a shape and the next."""
        cell, w = place(x * self._parts, self._last)
        both = self._both(cell * self._count + shape, active)
        a, b = both.x + w * both.y, both.z + w * both.w
        return a + between * (b - a)


class FamilyLobe(Lobe):
    """The lobe of one hit, or of many."""

    def __init__(self, family: Family, gamma: mi.Float, is_below: bool, is_above: bool) -> None:
        """``gamma``: in the range of the family, some of it below 1.8 and some above, or all."""
        self.gamma = gamma
        self.has_heavy = is_below
        self._family = family
        self._is_small = gamma < SEAM if is_below and is_above else is_below
        self._q = q = 2 * gamma - 3
        s = 1 / (gamma - 1)
        self._s = dr.maximum(s, _LEAST_S)
        offset, start, scale, last, first = (self._either(*both) for both in zip(*_PLACES))
        at = dr.maximum((dr.log(q * s + offset) - start) * scale, 0)
        cell, self._between = place(at, mi.UInt32(last))
        self._shape = cell + mi.UInt32(first)
        small, whole = family.members
        self.members = {
            name: number if number == whole[name] else self._either(number, whole[name])
            for name, number in small.items()
        }
        self.members["s"] = s
        self.members["kappa"] = family.kappa / (q * s)
        self.members["heavy_exponent"] = 1 / q
        self.members["heavy_root_s"] = dr.sqrt(s)

    def _either(self, small: float, whole: float) -> Any:
        # Python has a condition that is the same everywhere.
        if isinstance(self._is_small, bool):
            return small if self._is_small else whole
        return dr.select(self._is_small, small, whole)

    def root_of_d(self, z2: mi.Float, slope2: mi.Float, above: mi.Bool) -> mi.Float:
        b = dr.maximum(z2 + self._s * slope2, SMALLEST)
        # ln(1 + s t)/s, which is t where s is 0.
        t = dr.minimum(slope2 / dr.maximum(z2, SMALLEST), LARGEST / 4)
        x = self._s * t
        growth = dr.select(x <= 1, t * log_quotient(x), dr.log(1 + x) / self._s)
        return dr.exp((0.5 * self._s - 0.5) * growth) / b

    def masking(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        return self._family.masking(at, self._shape, self._between, active)

    def across(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        return self._family.across(at, self._shape, self._between, active)

    def heavy(self, at: mi.Float, active: mi.Bool) -> tuple[mi.Float, mi.Float]:
        active = active & self._is_small
        share = self._family.heavy(at, self._shape, self._between, active)
        rest = (1 - share) * self._q
        all_of_it = share + rest
        return share / all_of_it, rest / all_of_it

    def cubic(
        self, first: mi.UInt32, between: mi.Float, step: int, active: mi.Bool
    ) -> mi.Vector4f:
        count, slopes = self._family.count, self._family.slopes
        low = first * count + self._shape
        high = low + step * count
        a, b = slopes(low, active), slopes(high, active)
        c, d = slopes(low + 1, active), slopes(high + 1, active)
        a = a + between * (b - a)
        c = c + between * (d - c)
        return a + self._between * (c - a)
