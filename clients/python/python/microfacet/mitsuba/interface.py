"""The interface of two transparent media, seen from one side.

As ``crates/sampler/src/bsdf/interface.rs`` (Walter et al. 2007,
https://doi.org/10.2312/EGWR/EGSR07/195-206).
"""

from __future__ import annotations

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi

from .fresnel import dielectric, of_cosines, refracted_cos, transmitted

#: The least cosine between a direction and a facet: below, Fresnel's equations are 0/0.
_LEAST = 1e-7
#: As in the crate: the cosine of a facet is known from view and light to a hundredth of
#: this times (1 + eta)/|1 - eta|, and at most _STEEPEST is steep.
_STEEP = 100 / 2**25
_STEEPEST = 0.01


@dataclass
class Facet:
    """A facet that sends light, above the horizon of the view, which is taken as above."""

    m: mi.Vector3f
    #: Whether it does, and whether by reflection.
    sends: mi.Bool
    reflects: mi.Bool
    #: The cosine v.m, and what the facet reflects there, or transmits.
    facing: mi.Float
    share: mi.Float
    #: Density of the light over that of m per v.m.
    jacobian: mi.Float


def drawn(
    eta: mi.Float, v: mi.Vector3f, m: mi.Vector3f, number: mi.Float, chance: mi.Float | None
) -> tuple[mi.Vector3f, Facet]:
    """The light that a facet of normal m sends, by reflection if ``number`` is below ``chance``,
    or below its reflectance where that is none.
    """
    facing = dr.clip(dr.dot(v, m), _LEAST, 1)
    refracts, refracted = refracted_cos(eta, facing)
    reflectance = dr.select(refracts, of_cosines(eta, facing, refracted), 1.0)
    reflects = number < (reflectance if chance is None else chance)
    share = dr.select(reflects, reflectance, transmitted(eta, facing, refracted))
    through = dr.normalize((facing / eta - refracted) * m - v / eta)
    l = dr.select(reflects, 2 * facing * m - v, through)
    # v.m + eta l.m without the cancellation where eta is near 1.
    length = (1 - eta) * (1 + eta) / (facing + eta * refracted)
    ratio = eta / length
    jacobian = dr.select(reflects, 0.25, facing * refracted * ratio * ratio)
    sends = dr.select(reflects, l.z > 0, refracts & (l.z < 0))
    return l, Facet(m, sends, reflects, facing, share, jacobian)


def steep(eta: mi.Float) -> mi.Float:
    """The cosine below which a facet that refracts is only sampled, for gamma < 2."""
    return dr.minimum(_STEEP * (1 + eta) / dr.abs(1 - eta), _STEEPEST)


def between(
    eta: mi.Float, v: mi.Vector3f, l: mi.Vector3f, has_pole: bool | mi.Bool
) -> Facet:
    """The facet that sends v to l. ``has_pole``: those that are only sampled send nothing."""
    reflects = l.z > 0
    h = v + dr.select(reflects, 1.0, eta) * l
    length = dr.sqrt(dr.maximum(dr.squared_norm(h), 1e-30))
    m = h * (dr.select(h.z < 0, -1.0, 1.0) / length)
    cos_v, cos_l = dr.dot(v, m), dr.dot(l, m)
    sends = (cos_v > 0) & dr.select(reflects, cos_l > 0, cos_l < 0)
    if has_pole is not False:
        sends = sends & (reflects | (m.z >= dr.select(has_pole, steep(eta), 0.0)))
    facing = dr.clip(cos_v, _LEAST, 1)
    refracted = dr.clip(-cos_l, _LEAST, 1)
    share = dr.select(
        reflects, dielectric(eta, facing), transmitted(eta, facing, refracted)
    )
    ratio = eta / length
    jacobian = dr.select(reflects, 0.25, facing * refracted * ratio * ratio)
    return Facet(m, sends, reflects, facing, share, jacobian)


def either(first: mi.Bool, a: Facet, b: Facet) -> Facet:
    """a where ``first``, elsewhere b."""
    return Facet(
        dr.select(first, a.m, b.m),
        dr.select(first, a.sends, b.sends),
        dr.select(first, a.reflects, b.reflects),
        dr.select(first, a.facing, b.facing),
        dr.select(first, a.share, b.share),
        dr.select(first, a.jacobian, b.jacobian),
    )
