"""Of rough glass of gamma < 2 facets next to the horizon are only sampled; all others have the
density of their sample when it is evaluated again."""

from __future__ import annotations

import math

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
from surfaces import dielectric, place, steps

COUNT = 200_000


@pytest.mark.parametrize("is_texture", (False, True))
@pytest.mark.parametrize("below", (False, True))
def test_densities_are_found_again(below: bool, is_texture: bool) -> None:
    shares = {}
    gammas = (1.55, 1.65, 2.5)
    for number, gamma in enumerate(gammas):
        glass = dielectric(sigma=0.3, gamma=steps(*gammas) if is_texture else gamma)
        si = dr.zeros(mi.SurfaceInteraction3f, COUNT)
        si.uv = mi.Point2f(place(number, len(gammas)))
        angle = math.radians(130 if below else 50)
        si.wi = mi.Vector3f(math.sin(angle), 0, math.cos(angle))
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(1, COUNT)
        context = mi.BSDFContext()
        bs, weight = glass.sample(context, si, sampler.next_1d(), sampler.next_2d())
        value, pdf = glass.eval_pdf(context, si, bs.wo)
        delta = np.array(mi.has_flag(bs.sampled_type, mi.BSDFFlags.Delta))
        weight, value = (np.array(x).reshape(-1, COUNT)[0] for x in (weight, value))
        pdf, drawn = np.array(pdf), np.array(bs.pdf)
        sends = weight > 0
        assert (value[delta] == 0).all() and (pdf[delta] == 0).all() and sends[delta].all()
        known = sends & ~delta
        assert np.abs(pdf[known] / drawn[known] - 1).max() < 0.02
        shares[gamma] = delta[sends].mean()
    assert shares[1.55] > 0.02 and 1e-4 < shares[1.65] < 0.05 and shares[2.5] == 0
