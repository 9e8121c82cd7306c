"""The lobe of a shape gamma: masking, the distribution of normals, and visible normals.

Formulas and tables are those of ``masking.wgsl`` and ``normals.wgsl`` of the shader export.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import drjit as dr
import mitsuba as mi

from .arithmetic import LARGEST, SMALLEST, Line, Packets, between, log_growth, unit
from .normals import cap_normal, slope_packets, table_normal

#: The least squared length of a horizontal part; anything shorter is upright.
_UPRIGHT = 1e-36

#: The largest root of D: its square is finite in single precision.
_LARGEST_ROOT = 1.8446742e19


@dataclass
class Stretched:
    """A direction with its horizontal part times sigma."""

    #: The azimuth of the horizontal part, of unit length.
    azimuth: mi.Vector2f
    #: The length of the horizontal part, and its square.
    rho: mi.Float
    square: mi.Float
    #: The vertical part, in [0, 1].
    z: mi.Float


class Lobe:
    """A Student-t lobe of a gamma, for any roughness.

    Directions are unit vectors of the tangent frame, in which the normal of the surface is
    (0, 0, 1). ``sigma`` is that along the two tangents, the alpha of GGX and Beckmann, in
    [1e-4, 1e3]. All is one-sided: what is asked of a direction below the horizon has no meaning,
    but is finite. Negate a direction on the other side of a transmitting surface; facets stay
    where they are.

    Here is what :class:`Shape`, of a gamma that is a constant, and a lobe of
    :class:`.family.Family`, of one that differs from hit to hit, have in common. They have the
    tables.
    """

    #: The shape, and the numbers of the tables' description by name; each is a number of Python
    #: where it is the same everywhere.
    gamma: Any
    members: dict[str, Any]
    #: Whether a closed form draws some of the normals, and whether all come from spherical caps.
    has_heavy: bool
    is_ggx = False

    def stretch(self, sigma: mi.Vector2f, w: mi.Vector3f) -> Stretched:
        """``w`` as the surface of roughness 1 sees it, before normalisation."""
        x, y = sigma.x * w.x, sigma.y * w.y
        square = x * x + y * y
        rho = dr.sqrt(dr.maximum(square, _UPRIGHT))
        inverse = 1 / rho
        tilted = square > _UPRIGHT
        azimuth = mi.Vector2f(
            dr.select(tilted, x * inverse, 1.0), dr.select(tilted, y * inverse, 0.0)
        )
        return Stretched(azimuth, rho, square, unit(w.z))

    def inverse_area(self, w: Stretched, active: mi.Bool = True) -> mi.Float:
        """1 over the area of the microsurface seen from a direction, G1/z; finite at grazing."""
        cells, crowded = self.members["masking_cells"], self.members["masking_crowded"]
        across = self.members["kappa"] * w.rho
        inverse = 1 / (w.z + across)
        # Python has a condition that is the same everywhere.
        if isinstance(crowded, float):
            at = 1 - dr.sqrt(unit(across * inverse)) if crowded else w.z * inverse
        else:
            at = dr.select(crowded > 0, 1 - dr.sqrt(unit(across * inverse)), w.z * inverse)
        return self.masking(at * cells, active) * (cells * inverse)

    def g1(self, sigma: mi.Vector2f, w: mi.Vector3f, active: mi.Bool = True) -> mi.Float:
        """Smith's masking of a direction, in [0, 1]; 0 at and below the horizon."""
        stretched = self.stretch(sigma, w)
        return dr.minimum(stretched.z * self.inverse_area(stretched, active), 1)

    def lambda_(self, sigma: mi.Vector2f, w: mi.Vector3f, active: mi.Bool = True) -> mi.Float:
        """Smith's 1/G1 - 1; where that is infinite, at the horizon, 8.5e37."""
        return 1 / dr.maximum(self.g1(sigma, w, active), SMALLEST) - 1

    def d(self, sigma: mi.Vector2f, m: mi.Vector3f) -> mi.Float:
        """The distribution of normals D(m), per steradian: D(m) (m.n) integrates to 1.

        0 at and below the horizon; at most the largest number of single precision.
        """
        inverse = 1 / sigma
        x, y = m.x * inverse.x, m.y * inverse.y
        above = m.z > 0
        root = self.root_of_d(m.z * m.z, x * x + y * y, above)
        scale = dr.sqrt((1 / math.pi) * inverse.x * inverse.y)
        limited = dr.minimum(scale * dr.minimum(root, 1e30), _LARGEST_ROOT)
        return dr.select(above, limited * limited, 0.0)

    def sample_visible_normal(
        self, sigma: mi.Vector2f, v: mi.Vector3f, u: mi.Point2f, active: mi.Bool = True
    ) -> mi.Vector3f:
        """A normal visible from v, above the horizon, of unit length, from two numbers in [0, 1].

        ``u.x`` chooses the slope along the azimuth of the view and ``u.y`` that across, both
        rising; for GGX they are height and azimuth of a point of a spherical cap (Dupuy & Benyoub
        2023, https://doi.org/10.1111/cgf.14867).
        """
        if self.is_ggx:
            return cap_normal(sigma, v, u)
        return table_normal(self, sigma, self.stretch(sigma, v), v, u, active)

    def visible_normal_pdf(
        self, sigma: mi.Vector2f, v: mi.Vector3f, m: mi.Vector3f, active: mi.Bool = True
    ) -> mi.Float:
        """The density of these, (v.m) D(m) G1(v)/(v.n) per steradian; 0 where m is not seen."""
        area = self.inverse_area(self.stretch(sigma, v), active)
        return dr.maximum(dr.dot(v, m), 0) * self.d(sigma, m) * area

    def root_of_d(self, z2: mi.Float, slope2: mi.Float, above: mi.Bool) -> mi.Float:
        """The root of pi sigma_u sigma_v D = b^-gamma z^(2 gamma - 4), b = z^2 + s slope^2."""
        raise NotImplementedError

    def masking(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        """G1 over its coordinate and the number of its cells, at a place among them."""
        raise NotImplementedError

    def across(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        """g of the slope across the view, at a place among the cells."""
        raise NotImplementedError

    def heavy(self, at: mi.Float, active: mi.Bool) -> tuple[mi.Float, mi.Float]:
        """The share of normals that the closed form draws, at a place among rows, and the rest."""
        raise NotImplementedError

    def cubic(
        self, first: mi.UInt32, w: mi.Float, step: int, active: mi.Bool
    ) -> mi.Vector4f:
        """The cubic of the slope in the plane, between that of an index and that a step further."""
        raise NotImplementedError


class Shape(Lobe):
    """The lobe of a gamma that is a constant: formulas of GGX (2) and Beckmann (inf) replace
    tables where they can.
    """

    def __init__(self, shape: Any) -> None:
        """``shape``: what ``microfacet.Tables().shape(gamma)`` returns."""
        members, tables = shape.members, shape.tables
        self.gamma = shape.gamma
        self.members = members
        self.is_ggx = members["is_ggx"] > 0
        self.has_heavy = members["heavy_per_row"] > 0
        self._s, self._power = members["d_s"], members["d_power"]
        if not self.is_ggx:
            # The first cubic across is that of numbers within 1e-6 of 0 and 1.
            self._masking = Line(tables["masking"], 5e-9)
            self._across = Line(tables["across"], 1e-6)
            self._slopes = Packets(slope_packets(tables["slopes"]))
            self._heavy = Line(tables["heavy"], 1e-7) if self.has_heavy else None

    def inverse_area(self, w: Stretched, active: mi.Bool = True) -> mi.Float:
        if self.is_ggx:
            return 2 / (w.z + dr.sqrt(dr.maximum(w.square, _UPRIGHT) + w.z * w.z))
        return super().inverse_area(w, active)

    def root_of_d(self, z2: mi.Float, slope2: mi.Float, above: mi.Bool) -> mi.Float:
        part = self._s * slope2
        b = dr.maximum(z2 + part, SMALLEST)
        if self.is_ggx:
            return 1 / b
        if math.isinf(self.gamma):
            z2 = dr.select(above, dr.maximum(z2, SMALLEST), 1.0)
            return dr.exp(-0.5 * slope2 / z2) / z2
        return dr.exp2(self._power * self._growth(z2, part)) / b

    def _growth(self, z2: mi.Float, part: mi.Float) -> mi.Float:
        """log2(1 + part/z^2)."""
        ratio = dr.minimum(part / dr.maximum(z2, SMALLEST), LARGEST)
        # Up to a power of 4 what 1 + x rounds away is 1e-6 of D.
        if abs(self._power) <= 4:
            return dr.log2(1 + ratio)
        return log_growth(ratio) * (1 / math.log(2))

    def masking(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        return self._masking(at, active)

    def across(self, at: mi.Float, active: mi.Bool) -> mi.Float:
        return self._across(at, active)

    def heavy(self, at: mi.Float, active: mi.Bool) -> tuple[mi.Float, mi.Float]:
        assert self._heavy is not None
        share = self._heavy(at, active)
        return share, 1 - share

    def cubic(
        self, first: mi.UInt32, w: mi.Float, step: int, active: mi.Bool
    ) -> mi.Vector4f:
        return between(self._slopes(first, active), self._slopes(first + step, active), w)


def g2(g1_v: mi.Float, g1_l: mi.Float, correlated: bool) -> mi.Float:
    """Masking and shadowing of both from G1 of each; height-correlated as 1/(1 + lambda + lambda)
    (Heitz 2014, eq. 99, https://jcgt.org/published/0003/02/03/) or as the product.
    """
    both = g1_v * g1_l
    return both / dr.maximum(g1_v + g1_l - both, SMALLEST) if correlated else both


def g2_over_g1(g1_v: mi.Float, g1_l: mi.Float, correlated: bool) -> mi.Float:
    """G2/G1(v), in [0, 1], without 0/0 where both are small."""
    return g1_l / dr.maximum(g1_l + g1_v * (1 - g1_l), SMALLEST) if correlated else g1_l
