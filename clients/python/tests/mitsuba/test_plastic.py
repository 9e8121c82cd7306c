"""Plastics: values and densities, samples, light that a white base returns, and textures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import microfacet
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from domains import Elevation
from surfaces import CONTEXT, directions, drawn, hit, numbers, relative, uniform, vectors
from test_chi_square import agree, view
from test_furnace import COSINES, returned

COLOUR = (0.9, 0.5, 0.05)


def rgb(colour: tuple[float, float, float]) -> dict[str, Any]:
    return {"type": "rgb", "value": list(colour)}


def of_crate(bsdf: mi.BSDF, plastic: microfacet.Plastic) -> None:
    """Values and densities are those of the Rust crate."""
    v, l = directions(5000, 41, 0.01), directions(5000, 42, 0.01)
    l[::2] = l[::2] * 0.1 + v[::2] * [-1, -1, 1]
    l /= np.linalg.norm(l, axis=1, keepdims=True)
    value, pdf = bsdf.eval_pdf(CONTEXT, hit(v), vectors(l))
    assert relative(numbers(value), plastic.eval(v, l) * l[:, 2:], 1e-2) < 1e-4
    assert relative(numbers(pdf), plastic.pdf(v, l), 1e-2) < 1e-4


@pytest.mark.parametrize("masking", ("height-correlated", "uncorrelated"))
@pytest.mark.parametrize("gamma", (1.6, 2.0, 2.5, math.inf))
def test_values_and_densities(gamma: float, masking: str) -> None:
    for sigma, ext_ior in ((0.02, 1.0), (0.3, 1.0), (1.0, 1.0), (3.0, 1.0), (0.3, 2.25)):
        ours = surfaces.plastic(
            sigma=sigma, gamma=gamma, int_ior=1.5, ext_ior=ext_ior, masking=masking,
            diffuse_reflectance=rgb(COLOUR),
        )  # fmt: skip
        lobe = microfacet.StudentT(sigma, gamma)
        of_crate(ours, microfacet.Plastic(lobe, 1.5 / ext_ior, COLOUR, masking=masking))


@pytest.fixture(scope="module")
def coats(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set with the albedos of three coats, one of which is thinner than what is outside."""
    folder = tmp_path_factory.mktemp("coats")
    recipe = "".join(
        f'[[material]]\nname = "coat {sigma} {gamma} {eta}"\nsigma = {sigma}\ngamma = {gamma}\n'
        f"fresnel = {{ dielectric = {eta} }}\n"
        for sigma, gamma, eta in ((0.1, 2.5, 1.5), (0.6, 2.5, 1.5), (0.6, 2.5, 1 / 1.5))
    )
    microfacet.bake(recipe, folder)
    return folder


def compensated(tables: Path, sigma: float, compensation: str, **more: Any) -> mi.BSDF:
    index = {"int_ior": 1.5, "ext_ior": 1.0, **more}
    return surfaces.plastic(
        sigma=sigma, gamma=2.5, compensation=compensation, tables=str(tables), **index
    )


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_compensated_values_and_densities(coats: Path, compensation: str) -> None:
    for sigma, indices in ((0.1, (1.5, 1.0)), (0.6, (1.5, 1.0)), (0.6, (1.0, 1.5))):
        inside, outside = indices
        ours = compensated(
            coats, sigma, compensation, int_ior=inside, ext_ior=outside,
            diffuse_reflectance=rgb(COLOUR),
        )  # fmt: skip
        lobe = microfacet.Tables(coats).student_t(sigma, 2.5)
        rust = microfacet.Plastic(lobe, inside / outside, COLOUR, compensation=compensation)
        of_crate(ours, rust)


@pytest.mark.parametrize("gamma", (1.6, 2.0, 2.5, math.inf))
def test_samples_have_the_stated_density(
    gamma: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for sigma in (0.05, 0.3, 1.0):
        for angle in (0, 50, 87):
            wi = view(angle)
            agree("student_t_plastic", wi, Elevation(wi), 40, sigma=sigma, gamma=gamma)


def test_compensated_samples_have_the_stated_density(
    coats: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    wi, domain = view(50), Elevation(view(50))
    form = {"sigma": 0.6, "gamma": 2.5, "int_ior": 1.5, "ext_ior": 1.0, "tables": str(coats)}
    agree("student_t_plastic", wi, domain, 40, compensation="kulla_conty", **form)


def no_more_than_all(bsdf: mi.BSDF, least: float) -> None:
    for cosine in COSINES:
        mean, error = returned(bsdf, cosine)
        assert least - 4 * error < mean < 1.003 + 4 * error, (bsdf, cosine, mean, error)


@pytest.mark.parametrize("gamma", (1.6, 2.0, 2.5, math.inf))
def test_a_white_base_returns_no_more_than_all_light(gamma: float) -> None:
    for sigma in (0.02, 0.3, 1.0):
        bsdf = surfaces.plastic(sigma=sigma, gamma=gamma, diffuse_reflectance=1.0)
        no_more_than_all(bsdf, 0.0)


def test_what_single_scattering_loses() -> None:
    for gamma, share in ((2.0, 0.69), (1.6, 0.37)):
        bsdf = surfaces.plastic(sigma=0.3, gamma=gamma, diffuse_reflectance=1.0)
        mean, error = returned(bsdf, 0.7)
        assert abs(mean - share) < 5e-3 + 4 * error, (gamma, mean, error)


def test_the_round_lobe_stands_in_with_an_error() -> None:
    form = {"gamma": "inf", "stand_in": True, "diffuse_reflectance": 1.0}
    bsdf = surfaces.plastic(sigma_u=0.05, sigma_v=0.5, **form)
    assert 1.1 < returned(bsdf, 0.05)[0] < 1.12


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_a_white_base_returns_all_light(coats: Path, compensation: str) -> None:
    for sigma in (0.1, 0.6):
        no_more_than_all(compensated(coats, sigma, compensation, diffuse_reflectance=1.0), 0.997)


def test_samples_are_those_of_values_and_densities() -> None:
    """Of both components, and of each alone."""
    bsdf = surfaces.plastic(sigma=0.3, gamma=1.8, diffuse_reflectance=rgb(COLOUR))
    views = directions(20_000, 43, 0.05)
    si, u = hit(views), uniform(20_000, 3, 44)
    total = 0.0
    for component in (0, 1, 0xFFFFFFFF):
        context = mi.BSDFContext()
        context.component = component
        sample, weight = drawn(bsdf, si, u, context)
        value, pdf = bsdf.eval_pdf(context, si, sample.wo)
        kept = numbers(weight)[:, 0] > 1e-3
        assert kept.mean() > 0.8
        assert relative(numbers(sample.pdf)[kept], numbers(pdf)[kept], 1e-3) < 1e-2
        got = numbers(value)[kept] / numbers(pdf)[kept][:, None]
        assert relative(got, numbers(weight)[kept], 1e-3) < 1e-2
        if component <= 1:
            assert (numbers(sample.sampled_component)[kept] == component).all()
            total = total + numbers(bsdf.eval(context, si, vectors(views * [-1, 1, 1])))
        else:
            both = numbers(bsdf.eval(context, si, vectors(views * [-1, 1, 1])))
    assert relative(total, both, 1e-3) < 1e-5


@pytest.mark.parametrize("gamma", (1.6, 2.5, math.inf))
def test_a_texture_of_roughness_is_its_value_everywhere(gamma: float) -> None:
    """Shares of a roughness that varies are interpolated between those of some."""
    worst = 0.0
    v, l = directions(5000, 45, 0.01), vectors(directions(5000, 46, 0.01))
    texture = {
        "type": "bitmap", "raw": True, "filter_type": "nearest",
        "data": mi.TensorXf(np.array([[[0.013], [0.11], [0.7], [2.9]]], np.float32)),
    }  # fmt: skip
    base = {"gamma": gamma, "diffuse_reflectance": 1.0}
    varying = surfaces.plastic(sigma=texture, **base)
    for i, sigma in enumerate((0.013, 0.11, 0.7, 2.9)):
        si = hit(v)
        si.uv = mi.Point2f((i + 0.5) / 4, 0.5)
        got = numbers(varying.eval(CONTEXT, si, l))
        want = numbers(surfaces.plastic(sigma=sigma, **base).eval(CONTEXT, si, l))
        worst = max(worst, relative(got, want, 1e-2))
        count = 1 << 16
        si = hit(np.repeat(np.array([[0.6, 0, 0.8]], np.float32), count, axis=0))
        si.uv = mi.Point2f((i + 0.5) / 4, 0.5)
        sample, weight = drawn(varying, si, uniform(count, 3, 5))
        pdf = numbers(varying.pdf(CONTEXT, si, sample.wo))
        kept = numbers(weight)[:, 0] > 0
        assert relative(pdf[kept], numbers(sample.pdf)[kept], 1e-3) < 1e-2
    assert worst < 2e-3


def test_a_changed_parameter_is_that_of_another_surface() -> None:
    bsdf = surfaces.plastic(sigma=0.2, gamma=2.5)
    parameters = mi.traverse(bsdf)
    parameters["sigma.value"] = 0.6
    parameters["diffuse_reflectance.value"] = 0.8
    parameters.update()
    other = surfaces.plastic(sigma=0.6, gamma=2.5, diffuse_reflectance=0.8)
    si, l = hit(directions(100, 1, 0.1)), vectors(directions(100, 2, 0.1))
    got, want = (numbers(surface.eval(CONTEXT, si, l)) for surface in (bsdf, other))
    assert relative(got, want, 1e-6) < 1e-5
