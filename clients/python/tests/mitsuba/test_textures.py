"""Surfaces whose sigma and gamma are textures are those of the same numbers."""

from __future__ import annotations

import math
from typing import Any

import microfacet
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import (
    CONTEXT, REPOSITORY, directions, drawn, hit, numbers, place, relative, steps, uniform, vectors,
)  # fmt: skip

from microfacet.mitsuba.albedo import Albedos
from microfacet.mitsuba.family import Family
from microfacet.mitsuba.shape import Shape

#: Of both parts of the tables and their ends; none is a shape that tables were made of but those.
GAMMAS = (1.501, 1.52, 1.55, 1.6, 1.7, 1.79, 1.8, 1.85, 2.0, 2.5, 4.0, 20.0, 1e3, 1e18)


@pytest.fixture(scope="module")
def family() -> Family:
    return Family.of(microfacet.Tables(), True)


@pytest.mark.parametrize("is_known", (False, True))
@pytest.mark.parametrize("gamma", GAMMAS)
def test_lobe(family: Family, gamma: float, is_known: bool) -> None:
    """Masking, D and densities of any gamma are those of the crate, also where the range of a
    texture is known, which leaves out what it does not need.
    """
    lobe = family.at(mi.Float(gamma), *((gamma, gamma) if is_known else ()))
    v, m = directions(5000, 1), directions(5000, 2)
    m[::2] = m[::2] * 0.02 + [0, 0, 1]
    m /= np.linalg.norm(m, axis=1, keepdims=True)
    for pair in ((0.01, 0.01), (0.3, 0.3), (1.0, 0.1), (3.0, 3.0)):
        rust, sigma = microfacet.StudentT(pair, gamma), mi.Vector2f(*pair)
        off = np.abs(numbers(lobe.g1(sigma, vectors(v))) - rust.g1(v)).max()
        assert off < (1e-5 if gamma >= 1.8 else 2e-5), off
        assert relative(numbers(lobe.d(sigma, vectors(m))), rust.d(m), 1e-6) < 2e-5
        got = numbers(lobe.visible_normal_pdf(sigma, vectors(v), vectors(m)))
        assert relative(got, rust.visible_normal_pdf(v, m), 1e-6) < 1e-4


@pytest.mark.parametrize("gamma", [gamma for gamma in GAMMAS if gamma >= 1.8])
def test_visible_normals_of_whole_distributions(family: Family, gamma: float) -> None:
    """They leave the crate's by at most 1e-4 of the distribution of the slope."""
    lobe, sigma = family.at(mi.Float(gamma)), mi.Vector2f(0.3, 0.3)
    count = 4000
    along = (np.arange(count, dtype=np.float32) + 0.5) / count
    for cosine in (0.01, 0.3, 0.9):
        sine = math.sqrt(1 - cosine * cosine)
        v = np.repeat(np.array([[sine, 0, cosine]], np.float32), count, axis=0)
        for axis in (0, 1):
            u = np.full((2, count), 0.5, np.float32)
            u[axis] = along
            got = numbers(lobe.sample_visible_normal(sigma, vectors(v), mi.Point2f(u)))
            want = microfacet.StudentT(0.3, gamma).sample_visible_normal(v, u.T)
            ours, theirs = (np.arctan2(m[:, axis], m[:, 2]) for m in (got, want))
            rising = np.argsort(theirs)
            found = np.interp(ours, theirs[rising], along[rising])
            assert np.abs(found - along)[20:-20].max() < 1e-4


@pytest.mark.parametrize("gamma", [gamma for gamma in GAMMAS if gamma < 1.8])
def test_the_share_of_the_heavy_part(family: Family, gamma: float) -> None:
    shape = Shape(microfacet.Tables().shape(gamma))
    at = np.linspace(0, 2 * shape.members["rows"], 4001, dtype=np.float32)
    got, rest = family.at(mi.Float(gamma)).heavy(mi.Float(at), True)
    want, _ = shape.heavy(mi.Float(at), True)
    assert np.abs(numbers(got) - numbers(want)).max() < (2e-4 if gamma > 1.501 else 2e-5)
    assert np.abs(numbers(got + rest) - 1).max() < 1e-6


@pytest.mark.parametrize("masking", ("height-correlated", "uncorrelated"))
def test_albedos(masking: str) -> None:
    albedos = Albedos(microfacet.Tables(), None, masking == "height-correlated")
    cosines = np.geomspace(2e-5, 1, 300).astype(np.float32)
    for gamma in GAMMAS:
        for sigma in (0.01, 0.05, 0.3, 1.0, 3.0):
            lobe, at = microfacet.StudentT(sigma, gamma), (mi.Float(sigma), mi.Float(gamma))
            lost = 1 - lobe.albedo(cos_theta=cosines, masking=masking)
            off = np.abs(numbers(albedos.lost(*at, mi.Float(cosines))) - lost)
            assert off[cosines >= 0.02].max() < 3e-5 and off.max() < 2e-4, (gamma, sigma)
            average = 1 - lobe.albedo_average(masking)
            assert abs(numbers(albedos.lost_average(*at))[0] - average) < 3e-5


def test_size(family: Family) -> None:
    """Bytes of the tables of all gammas, and of those of albedos."""
    lines = (family.masking, family.across, family.heavy)
    packets = [family.slopes, family.steps, *(of._both for of in lines)]
    assert sum(4 * len(of._rows) for of in packets) < 16.5e6
    assert 4 * len(Albedos(microfacet.Tables(), None, True)._cells._rows) < 10.5e6


FORMS: list[tuple[str, dict[str, Any]]] = [
    ("conductor", {"eta": 0.3, "k": 3.2}),
    ("conductor", {"f0": 0.6, "compensation": "turquin"}),
    ("conductor", {"f0": 0.6, "compensation": "kulla_conty"}),
    ("dielectric", {"int_ior": 1.5, "ext_ior": 1.0}),
]


@pytest.mark.parametrize(("plugin", "form"), FORMS)
@pytest.mark.parametrize("masking", ("height-correlated", "uncorrelated"))
def test_values(plugin: str, form: dict[str, Any], masking: str) -> None:
    """They are those of constants and of the crate, where a texture has these values."""
    sigmas, gammas = (0.4, 0.15, 0.4, 0.4, 0.8, 0.4, 1.0), (1.55, 1.7, 1.79, 1.8, 2.0, 2.5, 20.0)
    make = getattr(surfaces, plugin)
    varying = make(sigma=steps(*sigmas), gamma=steps(*gammas), masking=masking, **form)
    assert mi.has_flag(varying.flags(), mi.BSDFFlags.SpatiallyVarying)
    v, l = directions(5000, 3, 0.05), directions(5000, 4, 0.05)
    if plugin == "dielectric":
        v[::2] *= -1
        l[::3] *= -1
    of = {key: value for key, value in form.items() if not key.endswith("_ior")}
    for number, (sigma, gamma) in enumerate(zip(sigmas, gammas)):
        si = hit(v)
        si.uv = mi.Point2f(place(number, len(sigmas)))
        value, pdf = (numbers(x) for x in varying.eval_pdf(CONTEXT, si, vectors(l)))
        lobe = microfacet.StudentT(sigma, gamma)
        rust: microfacet.Bsdf
        if plugin == "conductor":
            rust = microfacet.Conductor(lobe, masking=masking, **of)
        else:
            rust = microfacet.Dielectric(lobe, 1.5, masking=masking, **of)
        assert relative(value, rust.eval(v, l) * np.abs(l[:, 2:]), 1e-2) < 1e-4
        same = make(sigma=sigma, gamma=gamma, masking=masking, **form)
        other, of_other = (numbers(x) for x in same.eval_pdf(CONTEXT, si, vectors(l)))
        assert relative(value, other, 1e-2) < 1e-4
        # The broad lobe is drawn by the density of a roughness and a gamma nearby.
        if form.get("compensation") != "kulla_conty":
            assert relative(pdf, of_other, 1e-2) < 1e-4


def test_gammas_beyond_the_range_are_those_of_its_ends() -> None:
    si, l = hit(np.array([[0.6, 0, 0.8]], np.float32)), mi.Vector3f(-0.5, 0.1, 0.86)
    for value, end in ((0.0, 1.501), (1.5, 1.501), (math.inf, math.inf)):
        got = surfaces.conductor(gamma=steps(value, 3.0), sigma=0.3)
        want = surfaces.conductor(gamma=end, sigma=0.3)
        si.uv = mi.Point2f(place(0, 2))
        values = [numbers(surface.eval(CONTEXT, si, l)) for surface in (got, want)]
        assert relative(values[0], values[1], 1e-6) < 1e-4


def test_axes_of_anisotropic_textures() -> None:
    """sigma_u is along the tangent s, sigma_v along t, as Mitsuba's alpha_u and alpha_v."""
    si, l = hit(directions(2000, 5, 0.1)), vectors(directions(2000, 6, 0.1))
    index = {"eta": 0.4, "k": 3.0}
    for number, (u, v) in enumerate(((0.1, 0.5), (0.5, 0.2))):
        ours = surfaces.conductor(
            sigma_u=steps(0.1, 0.5), sigma_v=steps(0.5, 0.2), gamma=steps(2.0, 2.0),
            masking="uncorrelated", **index,
        )  # fmt: skip
        native = mi.load_dict({
            "type": "roughconductor", "distribution": "ggx", "alpha_u": u, "alpha_v": v, **index,
        })  # fmt: skip
        si.uv = mi.Point2f(place(number, 2))
        got, want = (numbers(surface.eval(CONTEXT, si, l)) for surface in (ours, native))
        assert relative(got, want, 1e-3 * want.max()) < 1e-4


@pytest.mark.parametrize("plugin", ("conductor", "dielectric"))
def test_samples_are_those_of_values_and_densities(plugin: str) -> None:
    bsdf = getattr(surfaces, plugin)(sigma=steps(0.1, 0.3, 0.6), gamma=steps(1.7, 2.2, 6.0))
    views = directions(60_000, 7, 0.05)
    if plugin == "dielectric":
        views[::2] *= -1
    si = hit(views)
    si.uv = mi.Point2f(uniform(len(views), 2, 8))
    sample, weight = drawn(bsdf, si, uniform(len(views), 3, 9))
    value, pdf = (numbers(x) for x in bsdf.eval_pdf(CONTEXT, si, sample.wo))
    kept = numbers(weight)[:, 0] > 1e-3
    assert kept.mean() > 0.3
    # Where a facet is next to vertical, it is not known from view and light in single precision.
    assert np.quantile(np.abs(pdf[kept] / numbers(sample.pdf)[kept] - 1), 0.97) < 3e-3
    got = value[kept, 0] / np.maximum(pdf[kept], 1e-30)
    assert np.quantile(np.abs(got / numbers(weight)[kept, 0] - 1), 0.97) < 3e-3


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_white_furnace(compensation: str) -> None:
    """Of a sphere all of whose light comes back, which has many roughnesses and gammas."""
    from test_furnace import mean_of_a_sphere

    surface = {
        "type": "student_t_conductor", "sigma": steps(0.05, 0.3, 1.0, 0.6),
        "gamma": steps(1.55, 1.7, 2.5, 8.0, math.inf), "compensation": compensation,
    }  # fmt: skip
    assert abs(mean_of_a_sphere(surface, 256) - 1) < 1e-3


def test_a_set_must_have_all_gammas(tmp_path: Any) -> None:
    recipe = '[[material]]\nname = "one"\nsigma = 0.3\ngamma = 2.5\n'
    microfacet.bake(recipe, tmp_path)
    surfaces.conductor(gamma=2.5, sigma=0.3, tables=str(tmp_path))
    with pytest.raises(RuntimeError, match="has no gamma = 1.501.*leave out tables"):
        surfaces.conductor(gamma=steps(2.0, 3.0), sigma=0.3, tables=str(tmp_path))


def test_scalar_variant() -> None:
    """Values and samples of a texture, and that an image has no holes."""
    from test_scenes import run

    program = """
    import sys
    import microfacet.mitsuba
    microfacet.mitsuba.set_variant("scalar_rgb")
    import mitsuba as mi
    import numpy as np
    sys.path.insert(0, sys.argv[1])
    from surfaces import CONTEXT, conductor, dielectric, place, steps
    si = mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f(0.6, 0, 0.8)
    for make, form in ((conductor, {"f0": 0.6, "compensation": "kulla_conty"}), (dielectric, {})):
        varying = make(sigma=steps(0.2, 0.5), gamma=steps(1.6, 2.5), **form)
        for number, (sigma, gamma) in enumerate(((0.2, 1.6), (0.5, 2.5))):
            si.uv = mi.Point2f(place(number, 2))
            same = make(sigma=sigma, gamma=gamma, **form)
            l = mi.Vector3f(-0.5, 0.2, 0.84)
            got, want = (bsdf.eval(CONTEXT, si, l)[0] for bsdf in (varying, same))
            assert abs(got / want - 1) < 1e-4, (got, want)
            u = 0.3, mi.Point2f(0.4, 0.7)
            sample, weight = varying.sample(CONTEXT, si, *u)
            other, _ = same.sample(CONTEXT, si, *u)
            # A normal is drawn between two of neighbouring gammas.
            assert np.abs(np.array(sample.wo) - np.array(other.wo)).max() < 2e-3
            value, pdf = varying.eval_pdf(CONTEXT, si, sample.wo)
            assert abs(value[0] / pdf / weight[0] - 1) < 1e-3
    ball = {
        "type": "student_t_conductor", "sigma": steps(0.1, 0.6), "gamma": steps(1.6, 2.0, 9.0),
        "compensation": "kulla_conty",
    }
    scene = mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 32},
        "light": {"type": "constant"}, "ball": {"type": "sphere", "bsdf": ball},
        "sensor": {
            "type": "perspective", "fov": 20,
            "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 8, "height": 8},
        },
    })
    picture = np.array(mi.render(scene, spp=16))
    assert abs(picture.mean() - 1) < 0.02, picture.mean()
    """
    done = run(program, str(REPOSITORY / "clients" / "python" / "tests" / "mitsuba"))
    assert done.returncode == 0, done.stderr
