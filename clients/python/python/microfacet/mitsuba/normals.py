"""Visible normals: of GGX by spherical caps, of all others by tables of two independent slopes.

The same as ``normals.wgsl`` of the shader export, with the table of slopes turned into cubics.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import horner, place, unit

if TYPE_CHECKING:
    from .shape import Lobe, Stretched

#: What a normal's cosine is raised to, so that D of it is finite.
_LEAST_COSINE = 1e-18


def slope_packets(slopes: np.ndarray) -> np.ndarray:
    """Values and derivatives at nodes as the cubics between each node and the next, (n - 1, 4).

    Cubics that begin at the last node of a row end in another row; they are read at their
    beginning only.
    """
    nodes = slopes.astype(np.float64)
    (a, da), (b, db) = nodes[:-1].T, nodes[1:].T
    return np.stack([a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db], axis=1)


def cap_normal(sigma: mi.Vector2f, v: mi.Vector3f, u: mi.Point2f) -> mi.Vector3f:
    """A visible normal of GGX (Dupuy & Benyoub 2023, https://doi.org/10.1111/cgf.14867)."""
    w = mi.Vector3f(sigma.x * v.x, sigma.y * v.y, dr.maximum(v.z, 0))
    tall = dr.sqrt(dr.maximum(dr.squared_norm(w), 1e-36))
    # The height of the half vector, at least 2^-24 of the cap's: one on the horizon may have no
    # length.
    height = dr.maximum(1 - unit(u.x), 5.9604645e-8) * (tall + w.z)
    up = height - w.z
    radius = dr.safe_sqrt((tall - up) * (tall + up))
    sine, cosine = dr.sincos((2 * math.pi) * u.y)
    x, y = w.x + radius * cosine, w.y + radius * sine
    return _facing(v, mi.Vector3f(sigma.x * x, sigma.y * y, height))


def table_normal(
    lobe: Lobe,
    sigma: mi.Vector2f,
    view: Stretched,
    v: mi.Vector3f,
    u: mi.Point2f,
    active: mi.Bool,
) -> mi.Vector3f:
    """A visible normal by inverting the distributions of two slopes: x : z in the plane of
    incidence, and t : tz across it in units of sqrt(z^2 + s x^2).
    """
    of = lobe.members
    far = lobe.across(_end(u.y) * of["across_scale"], active)
    t = dr.select(u.y > 0.5, 1 - far, far - 1)
    tz = far * (2 - far)

    tall = dr.sqrt(view.rho * view.rho + view.z * view.z)
    steep = tall + view.z
    if not lobe.has_heavy:
        rest = 1 - view.z / (view.rho + tall)
    else:
        # Next to normal incidence the other form loses digits, which the narrow cells there need.
        rest = view.rho * (steep + view.rho) / (steep * (view.rho + tall))
    rest = unit(rest)
    at = of["rows_first"] * (1 - rest)
    at = dr.maximum(at, of["rows_second_end"] - of["rows_second"] * rest)
    at = dr.maximum(at, of["rows"] - of["rows_third"] * rest)

    along = unit(u.x)
    if lobe.has_heavy:
        x, z = _slope_of_either_part(lobe, along, at, active)
    else:
        x, z = _table_slope(lobe, along, at, active)

    # Half of the normal's length in the plane of incidence, squeezed by s.
    norm = dr.sqrt(dr.maximum(z * z + (4 * of["s"]) * (x * x), 1e-36))
    ahead, aside = x * tz, norm * t
    azimuth = view.azimuth
    return _facing(
        v,
        mi.Vector3f(
            sigma.x * (ahead * azimuth.x - aside * azimuth.y),
            sigma.y * (ahead * azimuth.y + aside * azimuth.x),
            0.5 * z * tz,
        ),
    )


def _end(u: mi.Float) -> mi.Float:
    """The fourth root of the distance from the nearer of 0 and 1; at least 1e-9, where its
    derivative is finite.
    """
    return dr.sqrt(dr.sqrt(dr.maximum(dr.minimum(u, 1 - u), 1e-36)))


def _table_slope(
    lobe: Lobe, along: mi.Float, at: mi.Float, active: mi.Bool
) -> tuple[mi.Float, mi.Float]:
    """Half a slope x : z by tables: linear between the views, a cubic along the number."""
    of = lobe.members
    numbers = int(of["numbers"])
    row, between = place(at, int(of["rows"]))
    cell, w = place(_end(along) * of["along_scale"], numbers - 1)
    second = along > 0.5
    low = (2 * row + dr.select(second, mi.UInt32(1), mi.UInt32(0))) * numbers + cell
    # g, the distance of the half tangent from the end of its half, so that the slope is
    # 2(1 - g)/(g(2 - g)).
    g = horner(lobe.cubic(low, between, 2 * numbers, active), w)
    return dr.select(second, 1 - g, g - 1), g * (2 - g)


def _slope_of_either_part(
    lobe: Lobe, along: mi.Float, at: mi.Float, active: mi.Bool
) -> tuple[mi.Float, mi.Float]:
    """The same for gamma < 1.8, where a closed form draws what tables cannot hold, chosen by the
    end of the number.
    """
    of = lobe.members
    share, rest = lobe.heavy(at * of["heavy_per_row"], active)
    is_heavy = along > rest
    number = dr.minimum((1 - along) / dr.maximum(share, 1e-18), 1)
    # (1 + s x^2)^(-1/2) = number^exponent, at least 2^-100.
    power = dr.log2(dr.maximum(number, 1e-37)) * of["heavy_exponent"]
    power = dr.maximum(dr.minimum(power, 0), -100)
    zeta = dr.exp2(power)
    # The number has rounded what 1 - zeta rounds.
    heavy_x = 0.5 * dr.sqrt(dr.maximum((1 - zeta) * (1 + zeta), 1e-36))
    x, z = _table_slope(lobe, dr.minimum(along / dr.maximum(rest, 1e-18), 1), at, active)
    return (
        dr.select(is_heavy, heavy_x, x),
        dr.select(is_heavy, zeta * of["heavy_root_s"], z),
    )


def _facing(v: mi.Vector3f, m: mi.Vector3f) -> mi.Vector3f:
    """Turns a normal that rounding has put behind the silhouette back onto it, and normalises."""
    m = m - dr.minimum(dr.dot(v, m), 0) * v
    m = m * (1 / dr.sqrt(dr.maximum(dr.squared_norm(m), 1e-36)))
    return mi.Vector3f(m.x, m.y, dr.maximum(m.z, _LEAST_COSINE))
