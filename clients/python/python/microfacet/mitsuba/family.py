"""Lobes whose gamma differs from hit to hit: the tables of all gammas, linear between two of some.

The same as ``family.wgsl`` of the shader export, with other tables: numbers of single precision at
more shapes, of which what two neighbours have at one place lies together, since reading takes
longer than arithmetic.
"""

from __future__ import annotations

import atexit
import math
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable, Iterable

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import LARGEST, SMALLEST, Packets, Pairs, between, lines, log_quotient, place
from .normals import slope_packets
from .shape import Lobe

#: The range of gamma, whose upper end is Beckmann to rounding.
GAMMA = (1.501, 1e18)

#: Gamma from which tables hold whole distributions; below, a closed form has a part of them.
SEAM = 1.8

#: The least 1/(gamma - 1), from which derivatives are finite: Beckmann to rounding.
_LEAST_S = 2.0**-40

#: Up to this gamma D needs no series for what 1 + x rounds away.
_MODERATE = 10.0

#: Shapes below 1.8, even in ln(r + _OFFSET), r = (2 gamma - 3)/(gamma - 1), and those above, even
#: in s + _BEND s^2, s = 1/(gamma - 1): they are where tables change most, and as many as keep what
#: is linear between them within 1e-5 of G1 from 1.8 on and 2e-5 below (``test_textures.py``).
_BELOW, _OFFSET = 49, 0.1
_ABOVE, _BEND = 73, 0.5
_FIRST, _LAST = (math.log(2 - 1 / (gamma - 1) + _OFFSET) for gamma in (GAMMA[0], SEAM))
_WHOLE = (1 + _BEND / (SEAM - 1)) / (SEAM - 1)


def _gammas() -> tuple[list[float], list[float]]:
    """The shapes below 1.8, and those above."""
    r = np.exp(np.linspace(_FIRST, _LAST, _BELOW)[1:-1]) - _OFFSET
    s = (np.sqrt(1 + 4 * _BEND * np.linspace(_WHOLE, 0, _ABOVE)[1:-1]) - 1) / (2 * _BEND)
    return (
        [GAMMA[0], *(1 + 1 / (2 - r)).tolist(), SEAM - 1e-9],
        [SEAM, *(1 + 1 / s).tolist(), math.inf],
    )


def _below(r: mi.Float) -> mi.Float:
    """The place of a shape among those below 1.8."""
    return (dr.log(r + _OFFSET) - _FIRST) * ((_BELOW - 1) / (_LAST - _FIRST))


def _above(s: mi.Float) -> mi.Float:
    """The place of a shape among those above."""
    return (_ABOVE - 1) - s * (1 + _BEND * s) * ((_ABOVE - 1) / _WHOLE)


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
        small, whole = (shapes(tables, gammas) for gammas in _gammas())
        every = [shape.tables for shape in small + whole]
        #: The numbers of the two parts, most of which all gammas of a part have in common; of
        #: others, that of a gamma is a closed form.
        self.members = [
            {name: number for name, number in part[0].members.items() if "." not in name}
            for part in (small, whole)
        ]
        #: kappa (2 gamma - 3)/(gamma - 1), the same for all.
        self.kappa = 2 * whole[-1].members["kappa"]
        self.cubics = len(every[0]["slopes"]) - 1
        self.masking = _Lines([of["masking"] for of in every], 8)
        self.across = _Lines([of["across"] for of in every], 32)
        self.heavy = _Lines([_heavy(shape) for shape in small], 4)
        packets = np.stack([slope_packets(of["slopes"]) for of in every])
        self.slopes = Packets(packets.reshape(-1, 4))
        # What the next gamma has more is so little that a line for each cubic gives it.
        more = np.diff(packets[..., 0], axis=0, append=0)
        rises = np.diff(more, axis=1, append=0)
        self.steps = Pairs(np.stack([more, rises], axis=2).reshape(-1, 2))
        #: Albedos of the same set that were asked for, by form of masking.
        self.albedos: dict[bool, Any] = {}

    def at(self, gamma: mi.Float, low: float = GAMMA[0], high: float = GAMMA[1]) -> FamilyLobe:
        """The lobe of a gamma, which is clamped to the range, and known to lie in [low, high]: what
        these do not need is left out.
        """
        return FamilyLobe(self, dr.clip(gamma, *GAMMA), low, high)


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
        self._parts, self._count = parts, max(map(len, pairs))
        padded = np.zeros((len(pairs) + 1, self._count, 2))
        for number, of in enumerate(pairs):
            padded[number, : len(of)] = of
        both = np.concatenate([padded[:-1], padded[1:]], axis=2)
        self._both = Packets(both.reshape(-1, 4))

    def __call__(
        self, x: mi.Float, shape: mi.UInt32, w: mi.Float, active: mi.Bool
    ) -> mi.Float:
        """The function at a place among the cubics, between a shape and the next."""
        cell, along = place(x * self._parts, self._count - self._parts)
        both = self._both(shape * self._count + cell, active)
        return between(dr.fma(along, both.y, both.x), dr.fma(along, both.w, both.z), w)


class FamilyLobe(Lobe):
    """The lobe of one hit, or of many."""

    def __init__(self, family: Family, gamma: mi.Float, low: float, high: float) -> None:
        """``gamma``: in the range of the family, and known to lie in [low, high]."""
        self.gamma = gamma
        self.has_heavy = low < SEAM
        self._family = family
        self._is_moderate = high <= _MODERATE
        self._is_small = gamma < SEAM if low < SEAM <= high else low < SEAM
        self._q = q = 2 * gamma - 3
        s = 1 / (gamma - 1)
        self._s = dr.maximum(s, _LEAST_S)
        r = q * s
        at = dr.maximum(self._either(lambda: _below(r), lambda: _above(s)), 0)
        last, first = (
            self._either(lambda: small, lambda: whole)
            for small, whole in ((_BELOW - 2, _ABOVE - 2), (0, _BELOW))
        )
        cell, self._w = place(at, mi.UInt32(last))
        self._shape = cell + mi.UInt32(first)
        small, whole = family.members
        self.members = {
            name: self._either(lambda: number, lambda: whole[name])
            for name, number in small.items()
        }
        self.members["s"] = s
        self.members["kappa"] = family.kappa / r
        self.members["heavy_exponent"] = 1 / q
        self.members["heavy_root_s"] = dr.sqrt(s)

    def _either(self, small: Callable[[], Any], whole: Callable[[], Any]) -> Any:
        """What holds below 1.8, or above."""
        # Python has a condition that is the same everywhere, and what is the same in both parts.
        if isinstance(self._is_small, bool):
            return small() if self._is_small else whole()
        below, above = small(), whole()
        is_same = isinstance(below, (int, float)) and below == above
        return below if is_same else dr.select(self._is_small, below, above)

    def root_of_d(self, z2: mi.Float, slope2: mi.Float, above: mi.Bool) -> mi.Float:
        b = dr.maximum(z2 + self._s * slope2, SMALLEST)
        t = dr.minimum(slope2 / dr.maximum(z2, SMALLEST), LARGEST / 4)
        x = self._s * t
        if self._is_moderate:
            return dr.exp2((1 - 0.5 * self.gamma) * dr.log2(1 + x)) / b
        # ln(1 + s t)/s, which is t where s is 0.
        growth = dr.select(x <= 1, t * log_quotient(x), dr.log(1 + x) * (1 / self._s))
        return dr.exp((0.5 * self._s - 0.5) * growth) / b

    def masking(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        return self._family.masking(at, self._shape, self._w, active)

    def across(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        return self._family.across(at, self._shape, self._w, active)

    def heavy(self, at: mi.Float, active: mi.Bool) -> tuple[mi.Float, mi.Float]:
        active = active & self._is_small
        share = self._family.heavy(at, self._shape, self._w, active)
        rest = (1 - share) * self._q
        all_of_it = share + rest
        return share / all_of_it, rest / all_of_it

    def cubic(
        self, first: mi.UInt32, w: mi.Float, step: int, active: mi.Bool
    ) -> mi.Vector4f:
        slopes, low = self._family.slopes, self._shape * self._family.cubics + first
        cubic = between(slopes(low, active), slopes(low + step, active), w)
        more = self._family.steps(low + dr.select(w > 0.5, mi.UInt32(step), 0), active)
        return mi.Vector4f(
            dr.fma(more.x, self._w, cubic.x), dr.fma(more.y, self._w, cubic.y), cubic.z, cubic.w
        )
