"""Glass on Mitsuba's own grid of azimuth and cosine: which of its chi-square tests pass by the
quadrature of Mitsuba, with how many points along a cell, and which by that over facets.

``python clients/python/tests/mitsuba/grid.py [GAMMA ...]`` prints a row for each sigma and gamma, of
views at five angles from both sides; two to five minutes for each gamma on two cores.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from typing import Any, Callable

import microfacet.mitsuba

if __name__ == "__main__":
    microfacet.mitsuba.set_variant("llvm_ad_rgb")

import drjit as dr
import mitsuba as mi
import numpy as np
from domains import Facets
from mitsuba.chi2 import ChiSquareTest, SphericalDomain

SIGMAS = (0.05, 0.3, 1.0)
GAMMAS = (1.55, 1.6, 2.0, 2.5, 4.0, math.inf)
ANGLES = (0, 20, 50, 75, 87)
SIDES = (False, True)
ETA = 1.5046 / 1.000277  # Mitsuba's bk7 in air, the default.
TESTS = len(SIGMAS) * len(GAMMAS) * len(ANGLES) * len(SIDES)

#: Points along a cell of Mitsuba's quadrature.
POINTS = (32, 96, 288)


def view(angle: float, below: bool = False) -> list[float]:
    theta, azimuth = math.radians(angle), 0.7
    z = -math.cos(theta) if below else math.cos(theta)
    return [math.sin(theta) * math.cos(azimuth), math.sin(theta) * math.sin(azimuth), z]


def facets(wi: list[float]) -> Facets:
    """The domain of facets of a view."""
    return Facets(wi, ETA if wi[2] > 0 else 1 / ETA)


class ByFacets(ChiSquareTest):  # type: ignore[misc]
    """The test on Mitsuba's grid, with densities integrated over the facets that send lights and
    not over lights, so that neither poles nor narrow lobes need a fine grid: the points of an
    additive recurrence (Roberts 2018) by the facet, each added to the cell of its light.
    """

    #: Points of the quadrature.
    COUNT = 1 << 24

    def __init__(self, domain: Facets, sample: Callable[..., Any], pdf: Callable[..., Any]) -> None:
        super().__init__(SphericalDomain(), domain.samples(sample), domain.density(pdf), 3)
        self._facets = domain

    def tabulate_pdf(self) -> None:
        self.histogram_start = time.time()
        # In integers, whose overflow is the part after the point.
        i = dr.arange(mi.UInt32, self.COUNT)
        u = mi.Point2f(mi.Float(i * 3242174889), mi.Float(i * 2447445414)) * 2**-32
        bounds = self._facets.bounds()
        l = self._facets.map_forward(bounds.min + bounds.extents() * u)
        weight = self.pdf_func(l) * (dr.prod(bounds.extents()) * self.sample_count / self.COUNT)
        at = (self.domain.map_backward(l) - self.bounds.min) / self.bounds.extents()
        cell = mi.Vector2u(dr.clip(at * mi.Vector2f(self.res), 0, mi.Vector2f(self.res - 1)))
        total = dr.zeros(mi.Float64, dr.prod(self.res))
        index = cell.x + cell.y * self.res.x
        dr.scatter_reduce(dr.ReduceOp.Add, total, mi.Float64(weight), index)
        self.pdf = mi.Float(total)
        self.pdf_sum = dr.sum(self.pdf) / self.sample_count
        self.histogram_end = time.time()


def main(gammas: Sequence[float]) -> None:
    context = mi.BSDFContext()
    print(f"each: {len(ANGLES) * len(SIDES)} tests at the level 0.01 of {TESTS}")
    columns = [f"{points} points" for points in POINTS]
    columns += ["by facets", "only sampled, at most", "error of a sum of Mitsuba's, at most"]
    print("gamma", "sigma", *columns, sep="  ")
    for gamma in gammas:
        for sigma in SIGMAS:
            bsdf = mi.load_dict({"type": "student_t_dielectric", "sigma": sigma, "gamma": gamma})
            passed, most, off = np.zeros(len(POINTS) + 1, int), 0.0, 0.0
            for wi in (view(angle, below) for angle in ANGLES for below in SIDES):

                def hit(count: int) -> mi.SurfaceInteraction3f:
                    si = dr.zeros(mi.SurfaceInteraction3f, count)
                    si.wi = wi
                    return si

                def sample(u: mi.Vector3f) -> tuple[mi.Vector3f, mi.Float, mi.Bool]:
                    drawn, weight = bsdf.sample(context, hit(dr.width(u)), u.x, u.yz)
                    delta = mi.has_flag(drawn.sampled_type, mi.BSDFFlags.Delta)
                    return drawn.wo, weight[0] > 0, delta

                def with_density(u: mi.Vector3f) -> tuple[mi.Vector3f, mi.Float]:
                    l, sends, delta = sample(u)
                    nonlocal most
                    most = max(most, float(np.mean((sends & delta).numpy())))
                    return l, dr.select(sends & ~delta, 1.0, 0.0)

                def pdf(l: mi.Vector3f) -> mi.Float:
                    return bsdf.pdf(context, hit(dr.width(l)), l)

                by_facets = ByFacets(facets(wi), with_density, pdf)
                passed[-1] += by_facets.run(0.01, TESTS, quiet=True)
                for i, points in enumerate(POINTS):
                    test = ChiSquareTest(SphericalDomain(), with_density, pdf, 3, ires=points)
                    if test.run(0.01, TESTS, quiet=True):
                        # And with more points, which take long.
                        passed[i:-1] += 1
                        break
                off = max(off, abs(test.pdf_sum[0] - test.histogram_sum[0]))
            row = (f"{gamma:5g} {sigma:5g} ", *passed, f"{most:.4f}", f"{off:.3f}")
            print(*row, sep="  ", flush=True)


if __name__ == "__main__":
    main([float(word) for word in sys.argv[1:]] or GAMMAS)
