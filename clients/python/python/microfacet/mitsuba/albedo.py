"""Directional albedos of one bounce off a round lobe with F = 1, and their averages.

Formulas and tables are those of ``albedo.wgsl`` of the shader export.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi

from .arithmetic import Packets, log_growth, unit
from .fresnel import F82_SCALE


class Albedos:
    """The albedos of one gamma and one form of masking, for sigma in [1e-8, 3]; beyond, the ends.

    A moment is a vector (E - 1, bias, F82): E the albedo, bias its part that Schlick's weight
    (1 - v.m)^5 takes, F82 the moment of (v.m)(1 - v.m)^6 over its peak at v.m = 1/7.
    """

    def __init__(self, shape: Any, correlated: bool) -> None:
        """``shape``: what ``microfacet.Tables().shape(gamma)`` returns."""
        form = "height_correlated" if correlated else "uncorrelated"
        self._of = {
            name.partition(".")[2]: value
            for name, value in shape.members.items()
            if name.startswith(form + ".")
        }
        self._moments = Packets(shape.tables["albedo_" + form])
        self._averages = Packets(shape.tables["averages_" + form])

    def moments(self, sigma: mi.Float, cos_theta: mi.Float, active: mi.Bool = True) -> mi.Vector3f:
        """The moments of a view. Within 2e-5 of the horizon they are those at its end."""
        of = self._of
        sigma = self._clamped(sigma)
        lowest = of["floor"] * (of["slope"] * sigma) / (of["floor"] + of["slope"] * sigma)
        mu = dr.minimum(dr.maximum(cos_theta, lowest), 1)
        start = self._view(sigma, lowest)
        at = (self._view(sigma, mu) - start) / (1 - start)
        views = int(of["views"])
        i, of_row = _six(self._coordinate(sigma), int(of["sigmas"]))
        j, of_view = _six(at, views)
        first = i * views + j
        # Less a constant, whose digits the weights would round.
        middle = self._moments(first + 2 * views + 2, active)
        total = mi.Vector4f(0)
        for row, row_weight in enumerate(of_row):
            part = mi.Vector4f(0)
            for view, view_weight in enumerate(of_view):
                node = self._moments(first + (row * views + view), active)
                part = part + (node - middle) * view_weight
            total = total + part * row_weight
        total = total + middle
        e = dr.clip(total.x, -1, 0)
        # What a mirror has is left out of the tables.
        k = 1 - mu
        fourth = (k * k) * (k * k)
        tint = F82_SCALE * mu * (fourth * (k * k))
        return mi.Vector3f(e, total.y + (1 + e) * (fourth * k), total.z + (1 + e) * tint)

    def lost(self, sigma: mi.Float, cos_theta: mi.Float, active: mi.Bool = True) -> mi.Float:
        """What one bounce loses to further ones, 1 - E, in [0, 1]."""
        return -self.moments(sigma, cos_theta, active).x

    def averages(self, sigma: mi.Float, active: mi.Bool = True) -> mi.Vector3f:
        """1 - E_avg, and the averages of bias and F82, weighted by the cosine of the view."""
        i, weights = _six(self._coordinate(self._clamped(sigma)), int(self._of["average_sigmas"]))
        total = mi.Vector4f(0)
        for row, weight in enumerate(weights):
            total = total + self._averages(i + row, active) * weight
        return mi.Vector3f(dr.minimum(dr.exp(total.x), 1), total.y, total.z)

    def lost_average(self, sigma: mi.Float, active: mi.Bool = True) -> mi.Float:
        """1 - E_avg, with its digits where that is small."""
        return self.averages(sigma, active).x

    def _clamped(self, sigma: mi.Float) -> mi.Float:
        return dr.clip(sigma, self._of["sigma_min"], self._of["sigma_max"])

    def _coordinate(self, sigma: mi.Float) -> mi.Float:
        """The place of a roughness among those of the tables, in [0, 1]."""
        of = self._of
        slow = of["slow"] * dr.log(sigma / of["first"])
        coordinate = log_growth(sigma / of["offset"]) + slow + of["linear"] * sigma
        return (coordinate - of["start"]) / of["range"]

    def _view(self, sigma: mi.Float, mu: mi.Float) -> mi.Float:
        """The coordinate of a view by its cosine, before it is stretched to [0, 1]."""
        of = self._of
        sine = dr.safe_sqrt((1 - mu) * (1 + mu))
        x = mu / (mu + of["kappa"] * sigma * sine)
        h = mu / (1 + sine)
        nu = of["spread"] * sigma
        roots = of["share"] * dr.sqrt(dr.sqrt(x)) + (1 - of["share"]) * dr.sqrt(dr.sqrt(h))
        rest = 1 - of["weight"] - of["normal"]
        return of["weight"] * x + of["normal"] * (nu / (nu + sine)) + rest * roots


def _six(x: mi.Float, count: int) -> tuple[mi.UInt32, list[mi.Float]]:
    """The first of six even nodes about x in [0, 1], with the weights of the polynomial through
    them.
    """
    at = unit(x) * (count - 1)
    start = dr.clip(dr.floor(at) - 2, 0, count - 6)
    a = at - start
    b, c, d, e, f = a - 1, a - 2, a - 3, a - 4, a - 5
    low, high = d * e * f, a * b * c
    weights = [
        low * (b * c) * (-1 / 120),
        low * (a * c) * (1 / 24),
        low * (a * b) * (-1 / 12),
        high * (e * f) * (1 / 12),
        high * (d * f) * (-1 / 24),
        high * (d * e) * (1 / 120),
    ]
    return mi.UInt32(start), weights
