"""The light that facets reflect, whatever they are of."""

from __future__ import annotations

import drjit as dr
import mitsuba as mi

from .arithmetic import LARGEST_DENSITY
from .shape import Lobe, g2_over_g1


def white(
    lobe: Lobe,
    sigma: mi.Vector2f,
    v: mi.Vector3f,
    l: mi.Vector3f,
    m: mi.Vector3f,
    correlated: bool,
    active: mi.Bool,
) -> tuple[mi.Float, mi.Float]:
    """What facets of normal m reflect of F = 1, f cos/pdf, and the density of the light."""
    view = lobe.stretch(sigma, v)
    inverse_area = lobe.inverse_area(view, active)
    g1_v = dr.minimum(view.z * inverse_area, 1)
    g1_l = lobe.g1(sigma, l, active)
    pdf = dr.minimum(0.25 * lobe.d(sigma, m) * inverse_area, LARGEST_DENSITY)
    return g2_over_g1(g1_v, g1_l, correlated), pdf
