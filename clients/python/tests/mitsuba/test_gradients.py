"""Derivatives are those of differences."""

from __future__ import annotations

import math
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import CONTEXT, directions, hit, vectors


def agrees(
    bsdf: mi.BSDF,
    name: str,
    value: float,
    step: float,
    lights_below: bool,
    tolerance: float = 5e-3,
) -> None:
    """The derivative of a sum of values over random pairs."""
    views, lights = directions(4000, 21, 0.1), directions(4000, 22, 0.1)
    lights[::2] = lights[::2] * 0.3 + views[::2] * [-1, -1, 1]
    lights /= np.linalg.norm(lights, axis=1, keepdims=True)
    if lights_below:
        lights[::3] *= -1
    si, l = hit(views), vectors(lights)
    parameters = mi.traverse(bsdf)

    def total(at: Any) -> mi.Float:
        parameters[name] = at
        parameters.update()
        return dr.mean(dr.sum(bsdf.eval(CONTEXT, si, l)))

    variable = mi.Float(value)
    dr.enable_grad(variable)
    result = total(variable)
    dr.backward(result)
    got = dr.grad(variable)[0]
    above, below = (total(mi.Float(value + shift))[0] for shift in (step, -step))
    want = (above - below) / (2 * step)
    # Of a change by a part of the value: the larger gamma is, the less it does.
    assert math.isfinite(got) and abs(want) * max(value, 1) > 1e-3
    assert abs(got / want - 1) < tolerance, (got, want)


@pytest.mark.parametrize("compensation", ("none", "turquin", "kulla_conty"))
@pytest.mark.parametrize("gamma", (1.6, 2.0, 2.5, math.inf))
def test_sigma_of_conductors(gamma: float, compensation: str) -> None:
    bsdf = surfaces.conductor(sigma=0.4, gamma=gamma, f0=0.7, compensation=compensation)
    agrees(bsdf, "sigma.value", 0.4, 2e-3, False)


#: On both sides of 1.8, where tables change, near 2 and large; with steps of differences.
SHAPES = ((1.53, 2e-3), (1.78, 2e-3), (1.83, 2e-3), (2.0, 5e-3), (2.5, 1e-2), (30.0, 1.0))


@pytest.mark.parametrize("compensation", ("none", "turquin", "kulla_conty"))
@pytest.mark.parametrize(("gamma", "step"), SHAPES)
def test_gamma_of_conductors(gamma: float, step: float, compensation: str) -> None:
    """Tables are linear between neighbouring gammas, which is what derivatives miss."""
    bsdf = surfaces.conductor(sigma=0.4, gamma=gamma, f0=0.7, compensation=compensation)
    agrees(bsdf, "gamma.value", gamma, step, False, 1e-2)


@pytest.mark.parametrize(("gamma", "step"), SHAPES)
def test_gamma_of_dielectrics(gamma: float, step: float) -> None:
    bsdf = surfaces.dielectric(sigma=0.4, gamma=gamma)
    agrees(bsdf, "gamma.value", gamma, step, True, 1e-2)


@pytest.mark.parametrize("compensation", ("none", "turquin", "kulla_conty"))
@pytest.mark.parametrize(("name", "step"), [("sigma", 2e-3), ("gamma", 5e-3)])
def test_texels(name: str, step: float, compensation: str) -> None:
    """Of textures of both, each by all its texels, of which a hit sees one."""
    values = {"sigma": (0.2, 0.5), "gamma": (1.7, 2.3)}
    bsdf = surfaces.conductor(
        sigma=surfaces.steps(*values["sigma"]), gamma=surfaces.steps(*values["gamma"]), f0=0.7,
        compensation=compensation,
    )  # fmt: skip
    parameters = mi.traverse(bsdf)
    si, l = hit(directions(4000, 25, 0.1)), vectors(directions(4000, 26, 0.1))
    si.uv = mi.Point2f(surfaces.place(1, 2))
    key = f"{name}.data"

    def total(shift: float, with_derivatives: bool) -> mi.Float:
        texels = np.tile(np.array(values[name], np.float32) + shift, (2, 1))[..., None]
        parameters[key] = mi.TensorXf(texels)
        if with_derivatives:
            dr.enable_grad(parameters[key])
        parameters.update()
        return dr.mean(dr.sum(bsdf.eval(CONTEXT, si, l)))

    dr.backward(total(0, True))
    got = np.asarray(dr.grad(parameters[key]))
    want = (total(step, False)[0] - total(-step, False)[0]) / (2 * step)
    assert (got[:, 0] == 0).all() and abs(want) > 1e-3
    assert abs(got.sum() / want - 1) < 1e-2, (got, want)


@pytest.mark.parametrize("compensation", ("turquin", "kulla_conty"))
def test_a_derivative_needs_no_update_and_is_the_same_twice(compensation: str) -> None:
    bsdf = surfaces.conductor(sigma=0.6, gamma=2.5, compensation=compensation)
    views, lights = directions(2000, 23, 0.1), directions(2000, 24, 0.1)
    parameters = mi.traverse(bsdf)

    def total() -> mi.Float:
        return dr.mean(dr.sum(bsdf.eval(CONTEXT, hit(views), vectors(lights))))

    found = []
    dr.enable_grad(parameters["sigma.value"])
    for _ in range(2):
        dr.backward(total())
        found.append(dr.grad(parameters["sigma.value"])[0])
        dr.clear_grad(parameters["sigma.value"])
    ends = []
    for value in (0.602, 0.598):
        parameters["sigma.value"] = mi.Float(value)
        parameters.update()
        ends.append(total()[0])
    want = (ends[0] - ends[1]) / 0.004
    assert abs(want) > 1e-3 and np.allclose(found, want, rtol=5e-3), (found, want)


@pytest.mark.parametrize("gamma", (1.6, 2.0, 2.5, math.inf))
def test_sigma_and_index_of_dielectrics(gamma: float) -> None:
    agrees(surfaces.dielectric(sigma=0.4, gamma=gamma), "sigma.value", 0.4, 2e-3, True)
    # For gamma < 2 the density has poles, which an index moves.
    if gamma >= 2:
        agrees(surfaces.dielectric(sigma=0.4, gamma=gamma), "eta", 1.4, 2e-3, True)


@pytest.mark.parametrize("compensation", ("none", "turquin", "kulla_conty"))
def test_colours(compensation: str) -> None:
    form = {"sigma": 0.6, "gamma": 1.8, "compensation": compensation}
    agrees(surfaces.conductor(f0=0.6, f82=0.5, **form), "f0.value", 0.6, 1e-2, False)
    agrees(surfaces.conductor(f0=0.6, f82=0.5, **form), "f82.value", 0.5, 1e-2, False)
    agrees(surfaces.conductor(eta=0.5, k=2.0, **form), "k.value", 2.0, 1e-2, False)


def test_the_base_of_plastics() -> None:
    bsdf = surfaces.plastic(sigma=0.3, gamma=1.8, diffuse_reflectance=0.5)
    agrees(bsdf, "diffuse_reflectance.value", 0.5, 5e-3, False)


def test_one_roughness_of_an_anisotropic_surface() -> None:
    bsdf = surfaces.conductor(sigma_u=0.2, sigma_v=0.5, gamma=2.5)
    agrees(bsdf, "sigma_u.value", 0.2, 1e-3, False)


@pytest.mark.parametrize("compensation", ("none", "kulla_conty"))
@pytest.mark.parametrize(
    ("name", "value", "step"), [("sigma", 0.4, 0.02), ("gamma", 2.2, 0.1), ("f0", 0.7, 0.05)]
)
def test_pictures(name: str, value: float, step: float, compensation: str) -> None:
    """Through a path tracer that differentiates, of the mean of the highlight in a picture."""
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "prb", "max_depth": 4},
            "sensor": {
                "type": "perspective",
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
                "film": {
                    "type": "hdrfilm", "width": 16, "height": 16, "rfilter": {"type": "box"},
                    "sample_border": False,
                },
            },
            "light": {
                "type": "sphere", "center": [3, 3, 3], "radius": 0.7,
                "emitter": {"type": "area", "radiance": 10.0},
            },
            "sphere": {
                "type": "sphere",
                "bsdf": {
                    "type": "student_t_conductor", "sigma": 0.4, "gamma": 1.8, "f0": 0.7,
                    "compensation": compensation,
                },
            },
        }
    )  # fmt: skip
    parameters = mi.traverse(scene)
    key = next(key for key in parameters.keys() if key.endswith(f".{name}.value"))

    def picture(at: Any, samples: int) -> mi.Float:
        parameters[key] = at
        parameters.update()
        return dr.mean(mi.render(scene, parameters, spp=samples, seed=3)[3:6, 9:13], axis=None)

    variable = mi.Float(value)
    dr.enable_grad(variable)
    dr.backward(picture(variable, 256))
    got = dr.grad(variable)[0]
    above, below = (picture(mi.Float(value + shift), 1024).array[0] for shift in (step, -step))
    want = (above - below) / (2 * step)
    assert abs(want) > 1e-3
    assert abs(got / want - 1) < 0.05, (got, want)
