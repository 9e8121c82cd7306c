"""Lookups and whole surfaces are those of the Rust crates through ``microfacet``."""

from __future__ import annotations

import csv
import math
from typing import Any

import microfacet
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import CONTEXT, REPOSITORY, directions, hit, numbers, relative, uniform, vectors

from microfacet.mitsuba.albedo import Albedos
from microfacet.mitsuba.parameters import SIGMA_OF_ALBEDOS
from microfacet.mitsuba.shape import Shape, g2

GAMMAS = (1.501, 1.6, 1.8, 2.0, 2.5, 4.0, 20.0, 1e6, math.inf)
SIGMAS = ((0.01, 0.01), (0.3, 0.3), (1.0, 0.1), (3.0, 3.0))


def test_roughness_ends_where_albedos_end() -> None:
    for gamma in (1.6, 2.0, math.inf):
        members = microfacet.Tables().shape(gamma).members
        for form in ("uncorrelated", "height_correlated"):
            assert members[f"{form}.sigma_max"] == SIGMA_OF_ALBEDOS


@pytest.mark.parametrize("gamma", GAMMAS)
def test_lobe(gamma: float) -> None:
    shape = Shape(microfacet.Tables().shape(gamma))
    v, m = directions(5000, 1), directions(5000, 2)
    m[::2] = m[::2] * 0.02 + [0, 0, 1]
    m /= np.linalg.norm(m, axis=1, keepdims=True)
    l = directions(5000, 3)
    for pair in SIGMAS:
        lobe, sigma = microfacet.StudentT(pair, gamma), mi.Vector2f(*pair)
        g1_v, g1_l = (shape.g1(sigma, vectors(w)) for w in (v, l))
        assert np.abs(numbers(g1_v) - lobe.g1(v)).max() < 1e-6
        assert relative(numbers(shape.lambda_(sigma, vectors(v))), lobe.lambda_(v), 1.0) < 1e-3
        for correlated, masking in ((True, "height-correlated"), (False, "uncorrelated")):
            got = numbers(g2(g1_v, g1_l, correlated))
            assert np.abs(got - lobe.g2(v, l, masking)).max() < 1e-6
        # Powers of a large gamma magnify the last digit of the slope.
        assert relative(numbers(shape.d(sigma, vectors(m))), lobe.d(m), 1e-6) < 2e-5
        got = numbers(shape.visible_normal_pdf(sigma, vectors(v), vectors(m)))
        assert relative(got, lobe.visible_normal_pdf(v, m), 1e-6) < 1e-4


@pytest.mark.parametrize("gamma", [gamma for gamma in GAMMAS if gamma != 2])
def test_visible_normals(gamma: float) -> None:
    """GGX draws by caps here, and by the tables of the family there."""
    shape = Shape(microfacet.Tables().shape(gamma))
    v, u = directions(5000, 4, 1e-3), uniform(5000, 2, 5)
    for pair in SIGMAS:
        got = shape.sample_visible_normal(mi.Vector2f(*pair), vectors(v), mi.Point2f(u))
        want = microfacet.StudentT(pair, gamma).sample_visible_normal(v, u.T)
        assert np.abs(numbers(got) - want).max() < (1e-4 if gamma < 1.8 else 1e-5)


@pytest.mark.parametrize("masking", ("height-correlated", "uncorrelated"))
@pytest.mark.parametrize("gamma", GAMMAS)
def test_albedos(gamma: float, masking: str) -> None:
    albedos = Albedos(microfacet.Tables(), gamma, masking == "height-correlated")
    cosines = np.geomspace(2e-5, 1, 200).astype(np.float32)
    for sigma in (1e-3, 0.05, 0.3, 1.0, 3.0):
        lobe, at = microfacet.StudentT(sigma, gamma), (mi.Float(sigma), mi.Float(gamma))
        lost = 1 - lobe.albedo(cos_theta=cosines, masking=masking)
        assert np.abs(numbers(albedos.lost(*at, mi.Float(cosines))) - lost).max() < 1e-5
        average = numbers(albedos.lost_average(*at))[0]
        assert abs(1 - average - lobe.albedo_average(masking)) < 3e-5


def test_reference() -> None:
    """The rows of docs/reference.csv, whose columns of tables the crate computed."""
    with open(REPOSITORY / "docs" / "reference.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) > 100

    def column(name: str, rows: list[dict[str, str]]) -> np.ndarray:
        return np.array([float(row[name] or "nan") for row in rows], np.float32)

    def vector(name: str, rows: list[dict[str, str]]) -> np.ndarray:
        return np.stack([column(name + axis, rows) for axis in "xyz"], axis=1)

    for gamma in sorted({row["gamma"] for row in rows}):
        some = [row for row in rows if row["gamma"] == gamma]
        shape = Shape(microfacet.Tables().shape(float(gamma)))
        sigma = mi.Vector2f(column("sigma_x", some), column("sigma_y", some))
        v, m = vectors(vector("v", some)), vectors(vector("m", some))
        # Beyond the roughness of the plugins numbers lose digits that are not looked at here.
        usual = (numbers(sigma) >= 1e-4).all(axis=1) & (numbers(sigma) <= 1e3).all(axis=1)
        g1 = numbers(shape.g1(sigma, v))
        assert np.abs(g1 - column("g1_table", some))[usual].max(initial=0) < 1e-6
        d = column("d_table", some)
        kept = usual & (d > 0) & (d < 1e30)
        assert relative(numbers(shape.d(sigma, m))[kept], d[kept], 1e-30) < 1e-4


METALS: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({}, {}),
    ({"f0": 0.6}, {"f0": 0.6}),
    (
        {"f0": {"type": "rgb", "value": [0.9, 0.6, 0.3]}, "f82": 0.5},
        {"f0": (0.9, 0.6, 0.3), "f82": 0.5},
    ),
    ({"eta": 0.3, "k": 3.2}, {"eta": 0.3, "k": 3.2}),
]


@pytest.mark.parametrize("masking", ("height-correlated", "uncorrelated"))
@pytest.mark.parametrize("compensation", ("none", "turquin", "kulla-conty"))
@pytest.mark.parametrize("metal", METALS)
def test_conductors(metal: Any, compensation: str, masking: str) -> None:
    v, l = directions(5000, 7, 0.01), directions(5000, 8, 0.01)
    form = {"compensation": compensation, "masking": masking}
    for gamma in (1.6, 2.5):
        ours = surfaces.conductor(sigma=0.4, gamma=gamma, **metal[0], **form)
        rust = microfacet.Conductor(microfacet.StudentT(0.4, gamma), **metal[1], **form)
        si = hit(v)
        value = rust.eval(v, l) * l[:, 2:]
        assert relative(numbers(ours.eval(CONTEXT, si, vectors(l))), value, 1e-3) < 1e-4
        pdf = numbers(ours.pdf(CONTEXT, si, vectors(l)))
        assert relative(pdf, rust.pdf(v, l), 1e-3) < 1e-4


@pytest.mark.parametrize("masking", ("height-correlated", "uncorrelated"))
def test_dielectrics(masking: str) -> None:
    v, l = directions(5000, 9, 0.01), directions(5000, 10, 0.01)
    v[::2] *= -1
    l[::3] *= -1
    for gamma in (1.6, 2.0, 2.5, math.inf):
        ours = surfaces.dielectric(
            sigma=0.4, gamma=gamma, int_ior=1.5, ext_ior=1.0, masking=masking
        )
        rust = microfacet.Dielectric(microfacet.StudentT(0.4, gamma), 1.5, masking=masking)
        for mode in ("radiance", "importance"):
            context = mi.BSDFContext(getattr(mi.TransportMode, mode.capitalize()))
            value = rust.eval(v, l, mode) * np.abs(l[:, 2:])
            got = numbers(ours.eval(context, hit(v), vectors(l)))
            assert relative(got, value, 1e-3) < 1e-4
        got = numbers(ours.pdf(CONTEXT, hit(v), vectors(l)))
        assert relative(got, rust.pdf(v, l), 1e-3) < 1e-4
