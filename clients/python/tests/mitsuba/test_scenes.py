"""Plugins in scenes: parameters, textures, several at once, and other variants."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import textwrap
from typing import Any

import drjit as dr
import microfacet.mitsuba
import microfacet.mitsuba.llvm
import mitsuba as mi
import numpy as np
import pytest
import surfaces
from surfaces import CONTEXT, directions, drawn, hit, numbers, relative, uniform, vectors


def test_parameters_can_be_seen_and_changed() -> None:
    bsdf = surfaces.conductor(sigma=0.2, gamma=2.5, f0=0.5, compensation="kulla_conty")
    parameters = mi.traverse(bsdf)
    assert {"sigma.value", "f0.value"} <= set(parameters.keys())
    parameters["sigma.value"] = 0.6
    parameters["f0.value"] = 0.9
    parameters.update()
    other = surfaces.conductor(sigma=0.6, gamma=2.5, f0=0.9, compensation="kulla_conty")
    si, l = hit(directions(100, 1, 0.1)), vectors(directions(100, 2, 0.1))
    got, want = (numbers(surface.eval(CONTEXT, si, l)) for surface in (bsdf, other))
    assert relative(got, want, 1e-6) < 1e-5


@pytest.mark.parametrize("compensation", ("none", "turquin", "kulla_conty"))
def test_a_texture_is_its_value_everywhere(compensation: str) -> None:
    """Albedos of a roughness that varies are looked up another way than of one that does not."""
    form = {"gamma": 1.7, "compensation": compensation}
    texture = {
        "type": "bitmap", "raw": True, "filter_type": "nearest",
        "data": mi.TensorXf(np.array([[[0.2], [0.7]]], np.float32)),
    }  # fmt: skip
    varying = surfaces.conductor(sigma=texture, **form)
    assert mi.has_flag(varying.flags(), mi.BSDFFlags.SpatiallyVarying)
    views, l = directions(2000, 3, 0.05), vectors(directions(2000, 4, 0.05))
    for place, sigma in ((0.25, 0.2), (0.75, 0.7)):
        si = hit(views)
        si.uv = mi.Point2f(place, 0.5)
        value = surfaces.conductor(sigma=sigma, **form).eval(CONTEXT, si, l)
        assert relative(numbers(varying.eval(CONTEXT, si, l)), numbers(value), 1e-3) < 1e-3
        count = 1 << 16
        si = hit(np.repeat(np.array([[0.6, 0, 0.8]], np.float32), count, axis=0))
        si.uv = mi.Point2f(place, 0.5)
        sample, weight = drawn(varying, si, uniform(count, 3, 5))
        pdf = varying.pdf(CONTEXT, si, sample.wo)
        kept = numbers(weight)[:, 0] > 0
        assert relative(numbers(pdf)[kept], numbers(sample.pdf)[kept], 1e-3) < 1e-2
        if compensation != "none":
            weights = numbers(weight)[:, 0]
            assert abs(weights.mean() - 1) < 5e-4 + 4 * weights.std() / np.sqrt(count)


@pytest.mark.parametrize("plugin", ("conductor", "dielectric"))
@pytest.mark.parametrize("gamma", (1.6, 2.0, 2.5, "inf"))
def test_samples_are_those_of_values_and_densities(plugin: str, gamma: Any) -> None:
    """For anisotropic surfaces, whose axes must not be exchanged."""
    bsdf = getattr(surfaces, plugin)(sigma_u=0.15, sigma_v=0.5, gamma=gamma)
    assert mi.has_flag(bsdf.flags(), mi.BSDFFlags.Anisotropic)
    views = directions(50_000, 6, 0.05)
    if plugin == "dielectric":
        views[::2] *= -1
    si = hit(views)
    sample, drawn_weight = drawn(bsdf, si, uniform(len(views), 3, 7))
    value, pdf = bsdf.eval_pdf(CONTEXT, si, sample.wo)
    kept = numbers(drawn_weight)[:, 0] > 1e-3
    assert kept.mean() > 0.3
    got = numbers(pdf)[kept]
    # Where a facet is next to vertical, it is not known from view and light in single precision.
    most = 0.93 if gamma == 1.6 else 0.99
    assert np.quantile(np.abs(got / numbers(sample.pdf)[kept] - 1), most) < 3e-3
    weight = numbers(value)[kept, 0] / np.maximum(got, 1e-30)
    assert np.quantile(np.abs(weight / numbers(drawn_weight)[kept, 0] - 1), most) < 3e-3


@pytest.mark.parametrize("kind", (0, 1), ids=("reflection", "transmission"))
def test_one_event_alone(kind: int) -> None:
    """A context that asks for one event gets that part of all light."""
    bsdf = surfaces.dielectric(sigma=0.3, gamma=2.5)
    views, lights = directions(20_000, 8, 0.1), directions(20_000, 9, 0.1)
    lights[::2] *= -1
    si, l = hit(views), vectors(lights)
    alone = mi.BSDFContext()
    alone.component = kind
    wanted = (lights[:, 2] < 0) == bool(kind)
    both, one = (numbers(bsdf.eval(context, si, l))[:, 0] for context in (CONTEXT, alone))
    assert np.allclose(one[wanted], both[wanted]) and (one[~wanted] == 0).all()
    u = uniform(len(views), 3, 10)
    sample, weight = drawn(bsdf, si, u, alone)
    value, pdf = bsdf.eval_pdf(alone, si, sample.wo)
    kept = numbers(weight)[:, 0] > 1e-3
    got = numbers(value)[:, 0][kept] / numbers(pdf)[kept] / numbers(weight)[:, 0][kept]
    assert np.quantile(np.abs(got - 1), 0.999) < 1e-2
    assert (numbers(sample.sampled_component)[kept] == kind).all()


SPHERES = """
    import sys
    import mitsuba as mi
    import microfacet.mitsuba
    import numpy as np

    def picture(**more):
        surfaces = [
            {"type": "student_t_conductor", "sigma": 0.3, "gamma": 1.6, "material": "Au"},
            {"type": "student_t_conductor", "sigma": 0.5, "gamma": "inf", "f0": 0.8,
             "compensation": "kulla_conty"},
            {"type": "student_t_dielectric", "sigma": 0.2, "gamma": 3.0},
            {"type": "student_t_plastic", "sigma": 0.2, "gamma": 1.8,
             "diffuse_reflectance": {"type": "rgb", "value": [0.8, 0.4, 0.1]}},
        ]
        scene = {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 6},
            "light": {"type": "constant"},
            "sensor": {
                "type": "perspective", "fov": 52,
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 10], [0, 0, 0], [0, 1, 0]),
                "film": {"type": "hdrfilm", "width": 32, "height": 8},
            },
        }
        for i, surface in enumerate(surfaces):
            center = [2.2 * (i - 1.5), 0, 0]
            scene[f"sphere{i}"] = {"type": "sphere", "center": center, "bsdf": surface}
        return np.array(mi.render(mi.load_dict(scene), spp=int(more.get("spp", 64))))
"""


def test_four_surfaces_in_a_scene() -> None:
    """Also after another variant was set, and the plugins were added twice."""
    names: dict[str, Any] = {}
    exec(textwrap.dedent(SPHERES), names)
    first = names["picture"]()
    assert np.isfinite(first).all() and 0.3 < first.mean() < 1.2
    microfacet.mitsuba.register()
    assert np.allclose(names["picture"](), first)


def run(program: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program), *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        timeout=300,
    )


@pytest.mark.parametrize(
    "variant", ("scalar_rgb", "llvm_ad_spectral", "llvm_ad_mono_polarized")
)
def test_other_variants(variant: str) -> None:
    names: dict[str, Any] = {}
    exec(textwrap.dedent(SPHERES), names)
    samples = "16" if variant == "scalar_rgb" else "64"
    want = names["picture"]()
    program = SPHERES + """
    import drjit as dr
    microfacet.mitsuba.set_variant(sys.argv[1])
    got = picture(spp=sys.argv[2])
    assert np.isfinite(got).all()
    print()
    print("mean", *got.mean(axis=(0, 1)))
    """
    done = run(program, variant, samples)
    assert done.returncode == 0, done.stderr
    # Mitsuba's log may follow.
    (mean,) = [line for line in done.stdout.splitlines() if line.startswith("mean ")]
    got = [float(word) for word in mean.split()[1:]]
    if len(got) >= 3:
        assert np.allclose(got[:3], want.mean(axis=(0, 1))[:3], atol=0.03)
    else:
        assert 0.3 < got[0] < 1.2


def test_variants_after_each_other() -> None:
    program = SPHERES + """
    for variant in ("llvm_ad_rgb", "llvm_ad_spectral", "llvm_ad_rgb"):
        mi.set_variant(variant)
        microfacet.mitsuba.register()
        print(picture(spp=4).mean())
    """
    done = run(program)
    assert done.returncode == 0, done.stderr
    first, _, last = map(float, done.stdout.split())
    # Threads add what falls on a pixel in any order, which the default filter of a film rounds.
    assert math.isclose(first, last, rel_tol=1e-6), (first, last)


def test_channels_keep_their_colours_in_polarised_variants() -> None:
    """Of metals, of light of further bounces, and of plastics, by four wavelengths."""
    program = """
    import sys
    import microfacet.mitsuba
    microfacet.mitsuba.set_variant(sys.argv[1])
    import mitsuba as mi
    import numpy as np
    colour = {"type": "rgb", "value": [0.9, 0.5, 0.1]}
    for more in ({"material": "Cu"}, {"f0": colour, "compensation": "kulla_conty"},
                 {"type": "student_t_plastic", "diffuse_reflectance": colour}):
        scene = mi.load_dict({
            "type": "scene", "integrator": {"type": "direct"}, "light": {"type": "constant"},
            "sensor": {
                "type": "perspective", "fov": 10,
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 10], [0, 0, 0], [0, 1, 0]),
                "film": {"type": "hdrfilm", "width": 4, "height": 4, "pixel_format": "rgb"},
            },
            "ball": {
                "type": "sphere", "bsdf": {"type": "student_t_conductor", "sigma": 0.3, **more},
            },
        })
        print(*np.array(mi.render(scene, spp=512))[1:3, 1:3].mean(axis=(0, 1)))
    """
    found = []
    for variant in ("llvm_ad_spectral", "llvm_ad_spectral_polarized"):
        done = run(program, variant)
        assert done.returncode == 0, done.stderr
        found.append(np.array([line.split() for line in done.stdout.splitlines()], float))
    assert found[0][:, 0].min() > 0.05 + found[0][:, 2].max()
    assert np.allclose(found[0], found[1], atol=0.02), found


def test_an_update_compiles_no_other_kernel() -> None:
    for surface, name in (
        ({"type": "student_t_dielectric", "sigma": 0.3, "gamma": 2.5}, "eta"),
        ({"type": "student_t_conductor", "sigma": 0.3, "gamma": 2.5}, "sigma.value"),
        (
            {
                "type": "student_t_conductor", "sigma": 0.3, "gamma": 2.5,
                "compensation": "kulla_conty",
            },
            "sigma.value",
        ),
        # Of another gamma than that of the beginning, which has tables of its own.
        (
            {
                "type": "student_t_conductor", "sigma": 0.3, "gamma": 3.0,
                "compensation": "kulla_conty",
            },
            "gamma.value",
        ),
    ):  # fmt: skip
        bsdf = mi.load_dict(surface)
        parameters = mi.traverse(bsdf)
        si, l = hit(directions(1000, 31, 0.1)), vectors(directions(1000, 32, 0.1))
        dr.eval(si, l)
        kernels = set()
        for value in np.linspace(1.3, 1.45, 8):
            parameters[name] = mi.Float(value + (1 if name == "gamma.value" else 0))
            parameters.update()
            with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
                dr.kernel_history_clear()
                dr.eval(bsdf.eval(CONTEXT, si, l))
                history = dr.kernel_history([dr.KernelType.JIT])
            kernels.add(tuple(kernel["hash"] for kernel in history))
        # Dr.Jit orders the inputs of a kernel by their addresses, which changes from one update to
        # another: the same work is one of two kernels.
        assert len(kernels) <= 2, (surface, kernels)


def test_no_variant_is_an_error_with_words() -> None:
    done = run("import microfacet.mitsuba; microfacet.mitsuba.register()")
    assert "no variant is set" in done.stderr


def test_libraries_of_llvm_that_do_not_work_are_refused() -> None:
    program = "import microfacet.mitsuba; microfacet.mitsuba.set_variant('llvm_ad_rgb')"
    done = run(program, DRJIT_LIBLLVM_PATH="/usr/lib/libLLVM-15.so.1")
    assert "is LLVM 15" in done.stderr and "apt install libllvm19" in done.stderr
    done = run(program, DRJIT_LIBLLVM_PATH="/no/such/library.so")
    assert "found no library of LLVM" in done.stderr and "brew install llvm" in done.stderr


def test_versions_of_libraries(tmp_path: Any) -> None:
    version = microfacet.mitsuba.llvm.version_of
    names = {
        "libLLVM-15.so.1": 15, "libLLVM.so.19.1": 19, "libLLVM-19.so": 19,
        "libLLVM-14.0.6.so.1": 14, "libLLVM.so": None,
        "llvm-18/lib/libLLVM.so": 18, "llvm@17/lib/libLLVM.dylib": 17,
    }  # fmt: skip
    for name, want in names.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        assert version(str(path)) == want, name
    found = microfacet.mitsuba.llvm.libraries((f"{tmp_path}/libLLVM*.so*",))
    assert [number for number, _ in found] == [19, 19]
