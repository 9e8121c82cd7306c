"""GGX and Beckmann are those of the plugins that Mitsuba has."""

from __future__ import annotations

import math
from typing import Any

import drjit as dr
import microfacet
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import CONTEXT, directions, hit, numbers, relative, vectors

from microfacet.mitsuba.shape import Shape

ROUGHNESS: list[dict[str, dict[str, float]]] = [
    {"ours": {"sigma": 0.05}, "native": {"alpha": 0.05}},
    {"ours": {"sigma": 0.4}, "native": {"alpha": 0.4}},
    {
        "ours": {"sigma_u": 0.1, "sigma_v": 0.5},
        "native": {"alpha_u": 0.1, "alpha_v": 0.5},
    },
]


def compare(ours: mi.BSDF, native: mi.BSDF, transmission: bool, tolerance: float) -> None:
    """Values and densities for random pairs, half of them near the mirrored view."""
    views, lights = directions(20_000, 1, 0.02), directions(20_000, 2, 0.02)
    lights[::2] = lights[::2] * 0.1 + views[::2] * [-1, -1, 1]
    lights /= np.linalg.norm(lights, axis=1, keepdims=True)
    if transmission:
        views[::3] *= -1
        lights[1::2, 2] *= -1
    si, l = hit(views), vectors(lights)
    for got, want in (
        (ours.eval(CONTEXT, si, l), native.eval(CONTEXT, si, l)),
        (ours.pdf(CONTEXT, si, l), native.pdf(CONTEXT, si, l)),
    ):
        want = numbers(want)
        assert relative(numbers(got), want, 1e-3 * want.max()) < tolerance
        assert np.count_nonzero(want) > 5000


@pytest.mark.parametrize("roughness", ROUGHNESS)
def test_conductor_of_ggx(roughness: Any) -> None:
    index = {"eta": 0.4, "k": 3.0}
    ours = surfaces.conductor(gamma=2, masking="uncorrelated", **index, **roughness["ours"])
    native = mi.load_dict(
        {"type": "roughconductor", "distribution": "ggx", **index, **roughness["native"]}
    )
    compare(ours, native, False, 1e-4)


def test_a_blend_of_two_conductors_is_a_haze() -> None:
    core, haze = (surfaces.conductor(sigma=sigma, gamma=2.0, f0=0.9) for sigma in (0.1, 0.5))
    blend = mi.load_dict({"type": "blendbsdf", "weight": 0.3, "core": core, "haze": haze})
    lobes = (microfacet.StudentT(sigma, 2.0) for sigma in (0.1, 0.5))
    ours = microfacet.Haze(*(microfacet.Conductor(lobe, f0=0.9) for lobe in lobes), weight=0.3)
    v, l = directions(20_000, 3, 0.02), directions(20_000, 4, 0.02)
    value = numbers(blend.eval(CONTEXT, hit(v), vectors(l)))[:, 0]
    assert np.allclose(value, ours.eval(v, l)[:, 0] * l[:, 2], rtol=1e-4)
    pdf = numbers(blend.pdf(CONTEXT, hit(v), vectors(l)))
    assert np.allclose(pdf, ours.pdf(v, l), rtol=1e-4)


@pytest.mark.parametrize("roughness", ROUGHNESS)
def test_dielectric_of_ggx(roughness: Any) -> None:
    ours = surfaces.dielectric(gamma=2, masking="uncorrelated", **roughness["ours"])
    native = mi.load_dict({"type": "roughdielectric", "distribution": "ggx", **roughness["native"]})
    compare(ours, native, True, 1e-4)


@pytest.mark.parametrize("roughness", ROUGHNESS)
def test_beckmann_within_the_error_of_mitsuba_s_masking(roughness: Any) -> None:
    """Its masking is a rational fit, whose error is below one per cent."""
    properties = {"gamma": "inf", "masking": "uncorrelated", **roughness["ours"]}
    native = {"distribution": "beckmann", **roughness["native"]}
    conductor = {"eta": 0.4, "k": 3.0}
    compare(
        surfaces.conductor(**conductor, **properties),
        mi.load_dict({"type": "roughconductor", **conductor, **native}),
        False,
        1e-2,
    )
    compare(
        surfaces.dielectric(**properties),
        mi.load_dict({"type": "roughdielectric", **native}),
        True,
        1e-2,
    )


@pytest.mark.parametrize("alpha", (0.1, 0.3, 0.5))
def test_plastic_of_ggx_within_the_error_of_mitsuba_s_tables(alpha: float) -> None:
    """It has what the coat transmits at 64 cosines, linear between."""
    form = {"int_ior": 1.5, "ext_ior": 1.0, "diffuse_reflectance": 0.7}
    ours = surfaces.plastic(gamma=2, sigma=alpha, masking="uncorrelated", **form)
    native = mi.load_dict(
        {"type": "roughplastic", "distribution": "ggx", "alpha": alpha, "nonlinear": True, **form}
    )
    views, lights = directions(20_000, 1, 0.05), directions(20_000, 2, 0.05)
    si, l = hit(views), vectors(lights)
    got, want = numbers(ours.eval(CONTEXT, si, l)), numbers(native.eval(CONTEXT, si, l))
    assert relative(got, want, 1e-2) < 1e-2


@pytest.mark.parametrize(
    ("gamma", "kind"), [(2.0, mi.MicrofacetType.GGX), (math.inf, mi.MicrofacetType.Beckmann)]
)
def test_distribution_of_normals(gamma: float, kind: mi.MicrofacetType) -> None:
    shape = Shape(microfacet.Tables().shape(gamma))
    m = vectors(directions(20_000, 3))
    for sigma in (0.1, 0.5):
        got = numbers(shape.d(mi.Vector2f(sigma, sigma), m))
        want = numbers(mi.MicrofacetDistribution(kind, sigma).eval(m))
        kept = want > 1e-15
        assert relative(got[kept], want[kept], 1e-6) < 1e-4


def test_named_materials_are_those_of_mitsuba() -> None:
    si, l = hit(directions(100, 5, 0.2)), vectors(directions(100, 6, 0.2))
    ours = surfaces.conductor(gamma=2, sigma=0.3, masking="uncorrelated", material="Cu")
    native = mi.load_dict(
        {"type": "roughconductor", "distribution": "ggx", "alpha": 0.3, "material": "Cu"}
    )
    got, want = numbers(ours.eval(CONTEXT, si, l)), numbers(native.eval(CONTEXT, si, l))
    assert relative(got, want, 1e-6) < 1e-4
    index = {"int_ior": "diamond", "ext_ior": "water"}
    glass = surfaces.dielectric(sigma=0.3, **index)
    rough = mi.load_dict({"type": "roughdielectric", **index})
    eta, of_mitsuba = mi.traverse(glass)["eta"], mi.traverse(rough)["eta"]
    assert dr.abs(eta / of_mitsuba - 1)[0] < 1e-6
