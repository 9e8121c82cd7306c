"""Nothing is infinite or no number at the ends of what can be asked."""

from __future__ import annotations

import math
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import CONTEXT, drawn, hit, numbers, vectors

GAMMAS = (1.501, 1.6, 1.8, 2.0, 2.5, 20.0, 1e9, math.inf)
HEIGHTS = (1.0, 0.5, 1e-3, 1e-6, 1e-12, 1e-30, 0.0)


def ends() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All views, lights and numbers of some lists, together."""
    heights = [sign * z for z in HEIGHTS for sign in (1, -1)]
    around = [(math.sqrt(1 - z * z) * math.cos(a), math.sqrt(1 - z * z) * math.sin(a), z)
              for z in heights for a in (0.0, 1.0, math.pi)]  # fmt: skip
    ends = (0.0, 1e-7, 0.3, 0.5, 1 - 6e-8, 1.0)
    u = [(a, b, c) for a in (0.0, 0.5, 1.0) for b in ends for c in ends]
    rng = np.random.default_rng(5)
    count = 20_000
    pick = lambda of: np.array(of, np.float32)[rng.integers(len(of), size=count)]
    return pick(around), pick(around), pick(u).T


SURFACES: list[dict[str, Any]] = [
    {"type": "student_t_conductor"},
    {"type": "student_t_conductor", "eta": 0.2, "k": 3.0, "compensation": "kulla_conty"},
    {"type": "student_t_conductor", "f0": 0.0, "f82": 0.0, "compensation": "turquin"},
    {"type": "student_t_conductor", "masking": "uncorrelated", "compensation": "kulla_conty"},
    {"type": "student_t_dielectric"},
    {"type": "student_t_dielectric", "int_ior": 1.0, "ext_ior": 1.5},
    {"type": "student_t_plastic", "diffuse_reflectance": 1.0},
]


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("gamma", GAMMAS)
def test_nothing_is_infinite(gamma: float, surface: dict[str, Any]) -> None:
    views, lights, u = ends()
    si, l = hit(views), vectors(lights)
    for sigma in (1e-4, 0.01, 0.5, 3.0):
        bsdf = mi.load_dict({**surface, "sigma": sigma, "gamma": gamma})
        sample, weight = drawn(bsdf, si, u)
        value, pdf = bsdf.eval_pdf(CONTEXT, si, l)
        for result in (weight, sample.pdf, sample.wo, value, pdf):
            assert np.isfinite(numbers(result)).all()
        assert (numbers(weight) >= 0).all() and (numbers(pdf) >= 0).all()
        kept = numbers(weight)[:, 0] > 0
        assert np.abs(np.linalg.norm(numbers(sample.wo)[kept], axis=1) - 1).max(initial=0) < 1e-4
        if surface["type"] != "student_t_dielectric":
            below = (views[:, 2] <= 0) | (lights[:, 2] <= 0)
            assert (numbers(value)[below] == 0).all() and (numbers(pdf)[below] == 0).all()
            assert (numbers(weight)[views[:, 2] <= 0] == 0).all()


@pytest.mark.parametrize(
    ("surface", "gamma"),
    # Of compensation one of each form: its kernels take long to compile.
    [(SURFACES[i], gamma) for i in (0, 4, 6) for gamma in (1.6, math.inf)]
    + [(SURFACES[1], 1.6), (SURFACES[2], math.inf)],
)
def test_derivatives_are_finite(surface: dict[str, Any], gamma: float) -> None:
    views, lights, u = ends()
    # Next to the horizon values themselves grow without bound.
    kept = (np.abs(views[:, 2]) > 1e-4) & (np.abs(lights[:, 2]) > 1e-4)
    si, l, u = hit(views[kept]), vectors(lights[kept]), u[:, kept]
    bsdf = mi.load_dict({**surface, "sigma": 0.3, "gamma": gamma})
    parameters = mi.traverse(bsdf)
    for of in (
        lambda: bsdf.eval(CONTEXT, si, l),
        lambda: drawn(bsdf, si, u)[1],
    ):
        variable = mi.Float(0.3)
        dr.enable_grad(variable)
        parameters["sigma.value"] = variable
        parameters.update()
        dr.backward(dr.sum(dr.sum(of())))
        assert math.isfinite(dr.grad(variable)[0])


@pytest.mark.parametrize("surface", [SURFACES[i] for i in (0, 1, 4)])
def test_textures_and_their_derivatives_are_finite(surface: dict[str, Any]) -> None:
    views, lights, u = ends()
    gammas = surfaces.steps(0.0, 1.501, 1.6, 1.8, 2.0, 2.5, 20.0, 1e9, math.inf)
    bsdf = mi.load_dict(
        {**surface, "sigma": surfaces.steps(0.0, 1e-4, 0.01, 0.5, 3.0), "gamma": gammas}
    )
    parameters = mi.traverse(bsdf)
    kept = (np.abs(views[:, 2]) > 1e-4) & (np.abs(lights[:, 2]) > 1e-4)
    for some in (slice(None), kept):
        si = hit(views[some])
        si.uv = mi.Point2f(surfaces.uniform(len(views[some]), 2, 6))
        sample, weight = drawn(bsdf, si, u[:, some])
        value, pdf = bsdf.eval_pdf(CONTEXT, si, vectors(lights[some]))
        for result in (weight, sample.pdf, sample.wo, value, pdf):
            assert np.isfinite(numbers(result)).all()
    for key in ("sigma.data", "gamma.data"):
        dr.enable_grad(parameters[key])
        parameters.update()
        dr.backward(dr.sum(dr.sum(bsdf.eval(CONTEXT, si, vectors(lights[some])))))
        assert np.isfinite(np.asarray(dr.grad(parameters[key]))).all()


def test_numbers_that_are_none() -> None:
    nan = np.full((4, 3), np.nan, np.float32)
    nan[1] = [np.nan, 0, 1]
    nan[2] = [0, 0, np.nan]
    nan[3] = [np.inf, 0, 1]
    for surface in SURFACES:
        bsdf = mi.load_dict({**surface, "sigma": 0.3, "gamma": 2.5})
        bsdf.eval_pdf(CONTEXT, hit(nan), vectors(nan))
        dr.eval(drawn(bsdf, hit(nan), nan.T[:, :4].repeat(2, 0)[:3]))


def test_textures_are_clamped() -> None:
    """A roughness of 0, or beyond the range, is taken at the nearer end of it."""
    for value, end in ((0.0, 1e-4), (50.0, 10.0)):
        texture = {"type": "checkerboard", "color0": value, "color1": value}
        si, l = hit(np.array([[0.6, 0, 0.8]], np.float32)), mi.Vector3f(-0.6, 0.0, 0.8)
        got = surfaces.conductor(sigma=texture, gamma=2.5).eval(CONTEXT, si, l)
        want = surfaces.conductor(sigma=end, gamma=2.5).eval(CONTEXT, si, l)
        assert dr.allclose(got, want, rtol=1e-4)
