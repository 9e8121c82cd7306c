"""Reflectance of facets: Fresnel's equations, Schlick's approximation and the F82 tint.

The same as ``crates/core/src/fresnel.rs``, ``crates/core/src/schlick.rs`` and ``reflectance.rs`` of the Rust
crates. Cosines are between a direction and the normal of a facet, in [0, 1].
"""

from __future__ import annotations

from typing import Callable

import drjit as dr
import mitsuba as mi
import numpy as np

#: Cosine-weighted averages of Schlick's weight and of the tint's.
_SCHLICK_AVERAGE = 1 / 21
_F82_AVERAGE = 117649 / 839808

#: The reciprocal of the peak of mu (1 - mu)^6, at mu = 1/7.
F82_SCALE = 823543 / 46656


def refracted_cos(eta: mi.Float, cos: mi.Float) -> tuple[mi.Bool, mi.Float]:
    """Whether there is refraction, and its cosine; eta is the index beyond over that before."""
    square = (eta - 1) * (eta + 1) + cos * cos
    return square > 0, dr.sqrt(dr.maximum(square, 1e-30)) / eta


def of_cosines(eta: mi.Float, cos: mi.Float, refracted: mi.Float) -> mi.Float:
    """Reflectance of a dielectric from the cosines on both sides, in [0, 1]."""
    parallel = (eta * cos - refracted) / (eta * cos + refracted)
    perpendicular = (cos - eta * refracted) / (cos + eta * refracted)
    return 0.5 * (parallel * parallel + perpendicular * perpendicular)


def transmitted(eta: mi.Float, cos: mi.Float, refracted: mi.Float) -> mi.Float:
    """1 less that, with its digits where all but little is reflected."""
    parallel, perpendicular = eta * cos + refracted, cos + eta * refracted
    inverse = 1 / (parallel * parallel) + 1 / (perpendicular * perpendicular)
    return dr.minimum(2 * eta * cos * refracted * inverse, 1)


def dielectric(eta: mi.Float, cos: mi.Float) -> mi.Float:
    """Reflectance of a dielectric; 1 beyond the critical angle and at grazing."""
    refracts, refracted = refracted_cos(eta, cos)
    return dr.select(refracts, of_cosines(eta, cos, refracted), 1.0)


def conductor(
    eta: mi.UnpolarizedSpectrum, k: mi.UnpolarizedSpectrum, cos: mi.Float
) -> mi.UnpolarizedSpectrum:
    """Reflectance of a conductor of index eta + ik relative to the outside (Born & Wolf 1999,
    section 14.4), in [0, 1].
    """
    sin2 = 1 - cos * cos
    real = (eta - 1) * (eta + 1) - k * k + cos * cos
    product = eta * k
    modulus = dr.sqrt(dr.maximum(real * real + 4 * product * product, 1e-30))
    # The smaller part of the root comes from the product, so that neither cancels.
    large = dr.sqrt(0.5 * (modulus + dr.abs(real)))
    small = product / dr.maximum(large, 1e-15)
    positive = real >= 0
    a, b = dr.select(positive, large, small), dr.select(positive, small, large)
    b2 = b * b
    perpendicular = ((a - cos) * (a - cos) + b2) / ((a + cos) * (a + cos) + b2)
    along, across2 = a * cos, b2 * (cos * cos)
    less, more = along - sin2, along + sin2
    parallel = (less * less + across2) / (more * more + across2)
    return 0.5 * perpendicular * (1 + parallel)


class White:
    """F = 1."""

    def at(self, si: mi.SurfaceInteraction3f, cos: mi.Float, active: mi.Bool) -> mi.Spectrum:
        return mi.UnpolarizedSpectrum(1)

    def average(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> mi.Spectrum:
        return mi.UnpolarizedSpectrum(1)


class Schlick:
    """f0 + (1 - f0)(1 - mu)^5 (1994, https://doi.org/10.1111/1467-8659.1330233), less a tint of the
    reflectance at mu = 1/7, about 82 degrees (Kutz, Hasan & Edmondson 2021, *Novel aspects of the
    Adobe Standard Material*, eq. 2-5).
    """

    def __init__(self, f0: mi.Texture, f82: mi.Texture | None) -> None:
        self._f0 = f0
        self._f82 = f82

    def at(self, si: mi.SurfaceInteraction3f, cos: mi.Float, active: mi.Bool) -> mi.Spectrum:
        f0 = self._normal(si, active)
        f = self._schlick(f0, cos)
        if self._f82 is None:
            return f
        k = 1 - cos
        weight = F82_SCALE * cos * (k * k) * (k * k) * (k * k)
        # The dip of a small f0 and tint is deeper beside its peak than what is left.
        return dr.maximum(f - self._dip(f0, si, active) * weight, 0)

    def average(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> mi.Spectrum:
        if self._f82 is not None:
            return _average(lambda mu: self.at(si, mu, active))
        f0 = self._normal(si, active)
        return f0 + (1 - f0) * _SCHLICK_AVERAGE

    def _normal(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> mi.UnpolarizedSpectrum:
        """f0, clamped to [0, 1], since a texture may be anything."""
        return dr.clip(self._f0.eval(si, active), 0, 1)

    def _dip(
        self, f0: mi.UnpolarizedSpectrum, si: mi.SurfaceInteraction3f, active: mi.Bool
    ) -> mi.UnpolarizedSpectrum:
        assert self._f82 is not None
        tint = dr.clip(self._f82.eval(si, active), 0, 1)
        return (1 - tint) * self._schlick(f0, mi.Float(1 / 7))

    @staticmethod
    def _schlick(f0: mi.UnpolarizedSpectrum, cos: mi.Float) -> mi.UnpolarizedSpectrum:
        k = 1 - cos
        return f0 + (1 - f0) * ((k * k) * (k * k) * k)


class Exact:
    """Fresnel's equations of an index eta + ik."""

    def __init__(self, eta: mi.Texture, k: mi.Texture) -> None:
        self._eta = eta
        self._k = k

    def at(self, si: mi.SurfaceInteraction3f, cos: mi.Float, active: mi.Bool) -> mi.Spectrum:
        return conductor(self._eta.eval(si, active), self._k.eval(si, active), cos)

    def average(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> mi.Spectrum:
        eta, k = self._eta.eval(si, active), self._k.eval(si, active)
        return _average(lambda mu: conductor(eta, k, mu))


def _average(reflectance: Callable[[mi.Float], mi.UnpolarizedSpectrum]) -> mi.UnpolarizedSpectrum:
    """The cosine-weighted average 2 int F(mu) mu dmu, by Gauss-Legendre quadrature of 8 points.

    To 1e-5 for metals and the tint, 5e-4 where a tint clips the reflectance at 0, and 0.03 for an
    index below 1 with next to no extinction, whose reflectance has a kink.
    """
    nodes, weights = np.polynomial.legendre.leggauss(8)
    total = mi.UnpolarizedSpectrum(0)
    for node, weight in zip(0.5 * (nodes + 1), 0.5 * weights):
        total = total + reflectance(mi.Float(float(node))) * float(2 * weight * node)
    return total
