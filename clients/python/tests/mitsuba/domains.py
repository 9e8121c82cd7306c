"""Domains of Mitsuba's chi-square test, on which densities of surfaces can be integrated."""

from __future__ import annotations

import math
from typing import Any, Callable

import drjit as dr
import mitsuba as mi


class Elevation:
    """The sphere by azimuth x and by angle above the horizon in quarter turns y.

    Both poles are resolved, and the horizon is y = 0, the end of cells if their number is even. The
    azimuth is that from the plane of incidence, pi x |x|: seen at grazing, lights of a smooth
    surface lie within its roughness times a cosine of this plane.
    """

    def __init__(self, view: list[float]) -> None:
        length = math.hypot(view[0], view[1])
        self._ahead = (-view[0] / length, -view[1] / length) if length > 0 else (1.0, 0.0)

    def bounds(self) -> mi.ScalarBoundingBox2f:
        return mi.ScalarBoundingBox2f([-1, -1], [1, 1])

    def aspect(self) -> int:
        return 1

    def map_forward(self, p: mi.Point2f) -> mi.Vector3f:
        z, radius = dr.sincos(0.5 * dr.pi * p.y)
        sine, cosine = dr.sincos(dr.pi * p.x * dr.abs(p.x))
        x, y = self._ahead
        return mi.Vector3f((cosine * x - sine * y) * radius, (cosine * y + sine * x) * radius, z)

    def map_backward(self, w: mi.Vector3f) -> mi.Point2f:
        turn = self._azimuth(w) / dr.pi
        x = dr.copysign(dr.sqrt(dr.abs(turn)), turn)
        return mi.Point2f(x, dr.asin(dr.clip(w.z, -1, 1)) / (0.5 * dr.pi))

    def samples(self, sample: Callable[..., Any]) -> Callable[..., Any]:
        return sample

    def density(self, pdf: Callable[..., mi.Float]) -> Callable[..., mi.Float]:
        """A density per steradian as one of this domain."""

        def of(w: mi.Vector3f, *args: Any) -> mi.Float:
            azimuths = 2 * dr.sqrt(dr.pi * dr.abs(self._azimuth(w)))
            elevations = 0.5 * dr.pi * dr.sqrt(w.x * w.x + w.y * w.y)
            return pdf(w, *args) * azimuths * elevations

        return of

    def _azimuth(self, w: mi.Vector3f) -> mi.Float:
        x, y = self._ahead
        return dr.atan2(w.y * x - w.x * y, w.x * x + w.y * y)


class Facets:
    """The lights of a dielectric by the facet that sends them: its azimuth, and its elevation t
    with the cosine LOWEST^((1 - |t|)^2); t < 0 where it refracts.

    For gamma < 2 the density of refracted light has integrable poles where the facet is vertical.
    Here they are the line t = 0, and what lies within LOWEST of them is left out: a little below
    it, at 1.5e-5 for glass, the plugin only samples.
    """

    LOWEST = 2e-5

    def __init__(self, view: list[float], eta: float) -> None:
        """``eta``: the index beyond the surface over that on the side of the view."""
        self._sign = 1.0 if view[2] > 0 else -1.0
        self._view = mi.Vector3f(*(self._sign * x for x in view))
        self._eta = eta

    def bounds(self) -> mi.ScalarBoundingBox2f:
        return mi.ScalarBoundingBox2f([-dr.pi, -1], [dr.pi, 1])

    def aspect(self) -> int:
        return 1

    def map_forward(self, p: mi.Point2f) -> mi.Vector3f:
        """The light, or a null vector where the facet sends none."""
        v, eta = self._view, self._eta
        cosine = dr.exp(math.log(self.LOWEST) * dr.square(1 - dr.abs(p.y)))
        sine = dr.safe_sqrt(1 - cosine * cosine)
        m = mi.Vector3f(dr.cos(p.x) * sine, dr.sin(p.x) * sine, cosine)
        facing = dr.dot(v, m)
        square = 1 - (1 - facing * facing) / (eta * eta)
        refracted = (facing / eta - dr.safe_sqrt(square)) * m - v / eta
        reflects = p.y > 0
        l = dr.select(reflects, 2 * facing * m - v, refracted)
        sends = (facing > 0) & dr.select(reflects, l.z > 0, (square > 0) & (l.z < 0))
        return dr.select(sends, self._sign * l, 0)

    def map_backward(self, w: mi.Vector3f) -> mi.Point2f:
        m, reflects = self._facet(w)
        t = 1 - dr.sqrt(dr.log(dr.clip(m.z, self.LOWEST, 1)) / math.log(self.LOWEST))
        return mi.Point2f(dr.atan2(m.y, m.x), dr.select(reflects, t, -t))

    def samples(self, sample: Callable[..., Any]) -> Callable[..., Any]:
        """Samples with the weight 0 of facets that are left out."""

        def of(*args: Any) -> Any:
            l, weight = sample(*args)
            kept = (weight > 0) & (self._facet(l)[0].z > self.LOWEST)
            return l, dr.select(kept, weight, 0)

        return of

    def density(self, pdf: Callable[..., mi.Float]) -> Callable[..., mi.Float]:
        """A density per steradian of light as one of this domain."""

        def of(w: mi.Vector3f, *args: Any) -> mi.Float:
            m, reflects = self._facet(w)
            facing, refracted = dr.dot(self._view, m), self._sign * dr.dot(w, m)
            length = facing + self._eta * refracted
            lights = dr.select(
                reflects,
                4 * dr.abs(facing),
                length * length / (self._eta * self._eta * dr.abs(refracted)),
            )
            z, log_lowest = dr.clip(m.z, self.LOWEST, 1), math.log(self.LOWEST)
            elevations = -2 * log_lowest * dr.safe_sqrt(dr.log(z) / log_lowest) * z
            return dr.select(dr.squared_norm(w) > 0.5, pdf(w, *args) * lights * elevations, 0)

        return of

    def _facet(self, w: mi.Vector3f) -> tuple[mi.Vector3f, mi.Bool]:
        """The normal that the view sees, and whether it reflects."""
        l = self._sign * w
        reflects = l.z > 0
        h = dr.normalize(self._view + dr.select(reflects, 1.0, self._eta) * l)
        return dr.select(dr.dot(self._view, h) < 0, -h, h), reflects
