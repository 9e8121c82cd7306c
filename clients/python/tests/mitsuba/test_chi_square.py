"""Samples have the density that the plugins state, by Mitsuba's chi-square test."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np
import pytest
from domains import Elevation
from grid import ANGLES, SIGMAS, ByFacets, facets, view
from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain
from surfaces import place, steps

GAMMAS = (1.6, 2.5, 4.0, math.inf)


@pytest.fixture(autouse=True)
def _folder_of_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a test that fails writes what it compared."""
    monkeypatch.chdir(tmp_path)


def agree(
    plugin: str,
    wi: list[float],
    domain: Any,
    tests: int,
    uv: Sequence[float] = (0.5, 0.5),
    **properties: Any,
) -> None:
    sample, pdf = BSDFAdapter(plugin, {"type": plugin, **properties}, wi=wi, uv=uv)
    test = ChiSquareTest(
        domain=domain,
        sample_func=domain.samples(sample),
        pdf_func=domain.density(pdf),
        sample_dim=3,
        sample_count=1_000_000,
        res=100,  # Even, so that the horizon is the end of cells.
        ires=16,
    )
    passed = test.run(significance_level=0.01, test_count=tests, quiet=True)
    assert passed, f"{plugin} {properties} seen from {wi}: {test.messages}"


@pytest.mark.parametrize("gamma", GAMMAS)
@pytest.mark.parametrize("sigma", SIGMAS)
def test_conductors_on_the_sphere_of_mitsuba(sigma: float, gamma: float) -> None:
    """By azimuth and cosine, with as many points in a cell as narrow lobes need."""
    tests = len(SIGMAS) * len(GAMMAS) * len(ANGLES)
    for angle in ANGLES:
        surface = {"type": "student_t_conductor", "sigma": sigma, "gamma": gamma}
        sample, pdf = BSDFAdapter("student_t_conductor", surface, wi=view(angle))
        test = ChiSquareTest(
            domain=SphericalDomain(),
            sample_func=sample,
            pdf_func=pdf,
            sample_dim=3,
            sample_count=1_000_000,
            ires=96 if sigma <= 0.1 else 32,
        )
        passed = test.run(significance_level=0.01, test_count=tests, quiet=True)
        assert passed, f"{surface} seen from {angle} degrees: {test.messages}"


@pytest.mark.parametrize("gamma", GAMMAS)
@pytest.mark.parametrize("sigma", SIGMAS)
def test_conductors(sigma: float, gamma: float) -> None:
    tests = len(SIGMAS) * len(GAMMAS) * len(ANGLES)
    for angle in ANGLES:
        wi = view(angle)
        agree("student_t_conductor", wi, Elevation(wi), tests, sigma=sigma, gamma=gamma)


@pytest.mark.parametrize(
    "more",
    [
        {"sigma": 0.3, "gamma": 1.6, "compensation": "kulla_conty"},
        {"sigma": 1.0, "gamma": 2.5, "f0": 0.5, "compensation": "kulla_conty"},
        {"sigma_u": 0.1, "sigma_v": 0.6, "gamma": 2.5},
        {"sigma_u": 0.6, "sigma_v": 0.2, "gamma": "inf"},
    ],
)
def test_broad_lobes_and_anisotropic_ones(more: dict[str, Any]) -> None:
    for angle in ANGLES[:-1]:
        wi = view(angle)
        agree("student_t_conductor", wi, Elevation(wi), 16, **more)


@pytest.mark.parametrize("below", (False, True), ids=("outside", "inside"))
@pytest.mark.parametrize("gamma", GAMMAS)
@pytest.mark.parametrize("sigma", SIGMAS)
def test_dielectrics(sigma: float, gamma: float, below: bool) -> None:
    tests = 2 * len(SIGMAS) * len(GAMMAS) * len(ANGLES)
    for angle in ANGLES:
        wi = view(angle, below)
        domain = facets(wi) if gamma < 2 else Elevation(wi)
        agree("student_t_dielectric", wi, domain, tests, sigma=sigma, gamma=gamma)


#: Of both ends of gamma, both sides of 1.8 and between.
TEXELS = ((0.3, 1.55), (0.1, 1.7), (0.6, 1.79), (0.3, 1.81), (1.0, 2.0), (0.2, 2.9), (0.4, 12.0))


@pytest.mark.parametrize("number", range(len(TEXELS)))
@pytest.mark.parametrize("surface", ("metal", "compensated metal", "glass", "glass from inside"))
def test_textures(surface: str, number: int) -> None:
    """Where textures of sigma and gamma have several values."""
    sigmas, gammas = zip(*TEXELS)
    plugin = "student_t_dielectric" if "glass" in surface else "student_t_conductor"
    more = {"compensation": "kulla_conty"} if "compensated" in surface else {}
    below = "inside" in surface
    for angle in ANGLES[1:-1]:
        wi = view(angle, below)
        has_poles = "glass" in surface and gammas[number] < 2
        domain = facets(wi) if has_poles else Elevation(wi)
        agree(
            plugin, wi, domain, 84, uv=place(number, len(TEXELS)), sigma=steps(*sigmas),
            gamma=steps(*gammas), **more,
        )  # fmt: skip


@pytest.mark.parametrize("below", (False, True), ids=("outside", "inside"))
@pytest.mark.parametrize("gamma", (1.55, 2.0, math.inf))
@pytest.mark.parametrize("sigma", SIGMAS)
def test_dielectrics_on_the_sphere_of_mitsuba(sigma: float, gamma: float, below: bool) -> None:
    """By azimuth and cosine. Where Mitsuba's own quadrature is too coarse, for the poles of
    gamma < 2 and the narrowest lobes, densities are integrated over facets: ``grid.py`` has all.
    """
    tests = 2 * len(SIGMAS) * 3 * 3
    surface = {"type": "student_t_dielectric", "sigma": sigma, "gamma": gamma}
    for angle in (0, 50, 87):
        wi = view(angle, below)
        of_surface = BSDFAdapter("student_t_dielectric", surface, wi=wi)
        if gamma < 2 or (sigma < 0.1 and angle == 0):
            test = ByFacets(facets(wi), *of_surface)
        else:
            test = ChiSquareTest(SphericalDomain(), *of_surface, sample_dim=3, ires=32)
        passed = test.run(significance_level=0.01, test_count=tests, quiet=True)
        assert passed, f"{surface} seen from {wi}: {test.messages}"
