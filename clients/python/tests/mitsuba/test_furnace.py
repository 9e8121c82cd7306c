"""White surfaces return all light where it is compensated, and less where it is not."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import microfacet
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import drawn, hit, numbers, uniform

SIGMAS = (0.05, 0.3, 1.0)
GAMMAS = (1.6, 2.5, math.inf)
COSINES = (0.05, 0.3, 0.7, 1.0)


def returned(bsdf: mi.BSDF, cosine: float) -> tuple[float, float]:
    """The light that a view returns by samples, and the error of that."""
    count = 1 << 18
    view = np.array([[math.sqrt(1 - cosine * cosine), 0, cosine]], np.float32)
    # Radiance is scaled where it is refracted; importance is what is returned.
    context = mi.BSDFContext(mi.TransportMode.Importance)
    u = uniform(count, 3, 11)
    weight = numbers(drawn(bsdf, hit(np.repeat(view, count, axis=0)), u, context)[1])[:, 0]
    return float(weight.mean()), float(weight.std()) / math.sqrt(count)


def is_white(bsdf: mi.BSDF, cosine: float, tolerance: float) -> None:
    mean, error = returned(bsdf, cosine)
    assert abs(mean - 1) < tolerance + 4 * error, (bsdf, cosine, mean, error)


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
@pytest.mark.parametrize("gamma", GAMMAS)
def test_views_of_conductors(gamma: float, compensation: str) -> None:
    for sigma in SIGMAS:
        bsdf = surfaces.conductor(sigma=sigma, gamma=gamma, compensation=compensation)
        for cosine in COSINES:
            is_white(bsdf, cosine, 5e-4)


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_textures_of_roughness(compensation: str) -> None:
    """Also where a texture is rougher than the tables of albedos are: it is taken at their end."""
    for value in (0.02, 0.5, 8.0):
        texture = {"type": "checkerboard", "color0": value, "color1": value}
        bsdf = surfaces.conductor(sigma=texture, gamma=2.5, compensation=compensation)
        for cosine in (0.3, 0.9):
            is_white(bsdf, cosine, 5e-4)


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_colours_above_one_are_one(compensation: str) -> None:
    texture = {"type": "checkerboard", "color0": 4.0, "color1": 4.0}
    bsdf = surfaces.conductor(sigma=0.5, gamma=2, f0=texture, compensation=compensation)
    is_white(bsdf, 0.7, 5e-4)


@pytest.fixture(scope="module")
def glass(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set with the albedos of three dielectrics, one of which is dense outside."""
    folder = tmp_path_factory.mktemp("glass")
    recipe = "".join(
        f'[[material]]\nname = "glass {sigma} {eta}"\nsigma = {sigma}\ngamma = 2.5\n'
        f"fresnel = {{ dielectric = {eta} }}\n"
        for sigma, eta in ((0.1, 1.5), (0.6, 1.5), (0.6, 1 / 1.5))
    )
    microfacet.bake(recipe, folder)
    return folder


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_views_of_dielectrics(glass: Path, compensation: str) -> None:
    for sigma in (0.1, 0.6):
        bsdf = compensated(glass, sigma, compensation)
        for cosine in COSINES:
            is_white(bsdf, cosine, 5e-4)
            is_white(bsdf, -cosine, 5e-4)


@pytest.mark.parametrize("indices", ((1.5, 1.0), (1.0, 1.5)))
@pytest.mark.parametrize("compensation", ("turquin", "kulla-conty"))
def test_compensated_dielectrics_are_those_of_the_crates(
    glass: Path, compensation: str, indices: tuple[float, float]
) -> None:
    v, l = surfaces.directions(5000, 12, 0.05), surfaces.directions(5000, 13, 0.05)
    v[::2] *= -1
    l[::3] *= -1
    lobe = microfacet.Tables(glass).student_t(0.6, 2.5)
    rust = microfacet.Dielectric(lobe, indices[0] / indices[1], compensation=compensation)
    ours = compensated(glass, 0.6, compensation, indices)
    value = rust.eval(v, l) * np.abs(l[:, 2:])
    got = numbers(ours.eval(surfaces.CONTEXT, hit(v), surfaces.vectors(l)))
    assert surfaces.relative(got, value, 1e-2) < 1e-4
    got = numbers(ours.pdf(surfaces.CONTEXT, hit(v), surfaces.vectors(l)))
    assert surfaces.relative(got, rust.pdf(v, l), 1e-2) < 1e-4


def compensated(
    tables: Path, sigma: float, compensation: str, indices: tuple[float, float] = (1.5, 1.0)
) -> mi.BSDF:
    return surfaces.dielectric(
        sigma=sigma, gamma=2.5, int_ior=indices[0], ext_ior=indices[1], compensation=compensation,
        tables=str(tables),
    )  # fmt: skip


def mean_of_a_sphere(bsdf: dict[str, Any], samples: int) -> float:
    """What a sphere returns of light that is 1 from everywhere, as a mean over its disc."""
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 64, "rr_depth": 1000},
            "sensor": {
                "type": "orthographic",
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 3], [0, 0, 0], [0, 1, 0]),
                "film": {
                    "type": "hdrfilm", "width": 64, "height": 64, "rfilter": {"type": "box"},
                },
                "sampler": {"type": "independent", "sample_count": samples},
            },
            "light": {"type": "constant"},
            "sphere": {"type": "sphere", "bsdf": bsdf},
        }
    )  # fmt: skip
    picture = np.asarray(mi.render(scene))[..., 0]
    # The background is 1, and the disc pi/4 of the picture.
    return float(1 + (picture.mean() - 1) * 4 / math.pi)


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
@pytest.mark.parametrize(("sigma", "gamma"), [(0.1, 2.5), (0.5, 1.8), (1.0, "inf")])
def test_spheres_of_metal(sigma: float, gamma: Any, compensation: str) -> None:
    surface = {"type": "student_t_conductor", "sigma": sigma, "gamma": gamma}
    assert abs(mean_of_a_sphere({**surface, "compensation": compensation}, 256) - 1) < 1e-3
    if sigma >= 0.5:
        assert mean_of_a_sphere(surface, 16) < 0.85


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_spheres_of_glass(glass: Path, compensation: str) -> None:
    surface = {
        "type": "student_t_dielectric", "sigma": 0.6, "gamma": 2.5, "int_ior": 1.5, "ext_ior": 1.0,
        "tables": str(glass),
    }  # fmt: skip
    assert abs(mean_of_a_sphere({**surface, "compensation": compensation}, 64) - 1) < 1e-2
    assert mean_of_a_sphere(surface, 16) < 0.9
