"""Lobes, BSDFs and sets of tables."""

import json
import math

import numpy as np
import pytest

import microfacet
from microfacet import exact

RECIPE = """
[[material]]
name = "glass"
sigma = 0.3
gamma = 2.5
fresnel = { dielectric = 1.5 }

[[material]]
name = "brushed"
sigma = [0.4, 0.1]
gamma = 3.0
fresnel = { metal = "gold" }
"""


@pytest.fixture(scope="module")
def tables():
    return microfacet.bake(RECIPE, cache=False, quality="draft")


def test_metals_are_known_by_name_and_symbol():
    lobe, v = microfacet.StudentT(0.3, 2.5), [0.6, 0.0, 0.8]
    for symbol, name in [("Au", "gold"), ("Ag", "silver"), ("W", "tungsten"), ("CuZn", "brass")]:
        values = [microfacet.Conductor(lobe, metal=word).eval(v, v) for word in (symbol, name)]
        assert np.array_equal(*values)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: microfacet.StudentT(roughness=0.5, gamma=2), ["roughness", "sigma = roughness**2"]),
        (lambda: microfacet.StudentT(alpha=0.5, gamma=2), ["sigma = alpha"]),
        (lambda: exact.StudentT(0.5, nu=3), ["gamma = nu/2 + 1"]),
        (lambda: microfacet.Tables().student_t(alpha_x=0.5), ["sigma_x = alpha_x"]),
        (lambda: microfacet.StudentT(0.5, 2, tint=3), ["StudentT has no argument tint"]),
        (lambda: microfacet.StudentT(0.5), ["gamma is missing", "2 is GGX"]),
        (lambda: microfacet.StudentT(gamma=2), ["sigma is missing"]),
        (lambda: microfacet.Conductor(microfacet.StudentT(1, 2), material="Au"), ["give metal"]),
        (lambda: microfacet.Dielectric(microfacet.StudentT(1, 2), ior=1.5), ["eta"]),
        (lambda: microfacet.Plastic(microfacet.StudentT(1, 2), 1.5), ["base is missing"]),
    ],
)
def test_words_of_other_renderers_lead_on(call, words):
    with pytest.raises(TypeError) as why:
        call()
    for word in words:
        assert word in str(why.value), why.value


def directions(n, seed, below=False):
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(n, 3))
    if not below:
        w[:, 2] = np.abs(w[:, 2])
    return (w / np.linalg.norm(w, axis=1, keepdims=True)).astype(np.float32)


def test_lobes_say_what_they_are():
    lobe = microfacet.StudentT((0.3, 0.1), math.inf)
    assert lobe.sigma == (0.3, 0.1) and lobe.gamma == math.inf
    assert repr(lobe) == "StudentT(sigma=(0.3, 0.1), gamma=inf)"
    assert repr(microfacet.StudentT(np.float32(0.5), 2)) == "StudentT(sigma=0.5, gamma=2)"
    assert isinstance(lobe, microfacet.Lobe) and not lobe.is_effectively_smooth
    assert microfacet.StudentT(1e-5, 3).is_effectively_smooth
    tilted = microfacet.Ellipsoid((0.3, 0.1), (0.2, -0.1, 0.5), 2.7)
    model = exact.Ellipsoid((0.3, 0.1), (0.2, -0.1, 0.5), 2.7)
    v = directions(500, 1)
    assert np.abs(tilted.g1(v) - model.g1(v)).max() < 1e-5


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: microfacet.StudentT(-1, 2), ["sigma = -1", "[1e-8, 1e6]"]),
        (lambda: microfacet.StudentT(0.3, 1.2), ["gamma = 1.2", "(1.5, inf]"]),
        (lambda: microfacet.StudentT([1, 2, 3], 2), ["sigma is a list of 3", "(sigma_x, sigma_y)"]),
        (lambda: microfacet.Ellipsoid(0.3, 0.1, 2), ["theta", "3 numbers"]),
        (lambda: exact.StudentT(0, 2), ["sigma = 0", "positive"]),
        (
            lambda: microfacet.Conductor(microfacet.StudentT((0.1, 0.3), 2), compensation="turquin"),
            ["sigma = [0.1, 0.3]", "[[material]]", "stand_in=True"],
        ),
        (
            lambda: microfacet.Plastic(microfacet.StudentT(1, 2), 2.25, 0.5, compensation="turquin"),
            ["fresnel = { dielectric = 2.25 }", "microfacet.bake"],
        ),
        (lambda: microfacet.StudentT((0.1, 0.3), 2).albedo(0.5), ["[[material]]", "stand_in=True"]),
        (lambda: microfacet.Conductor(microfacet.StudentT(0.1, 2), metal="wood"), ["wood", "gold"]),
        (
            lambda: microfacet.Conductor(microfacet.StudentT(0.1, 2), metal="Aluminum foil"),
            ['did you mean "aluminium"?'],
        ),
        (
            lambda: microfacet.Conductor(microfacet.StudentT(0.1, 2), metal="AU"),
            ['did you mean "Au"?'],
        ),
        (lambda: microfacet.StudentT(0.1, "ggx"), ["gamma: could not convert", "ggx"]),
        (lambda: microfacet.Conductor(microfacet.StudentT(0.1, 2), f0=1.5), ["f0 = 1.5", "[0, 1]"]),
        (lambda: microfacet.Conductor(microfacet.StudentT(0.1, 2), eta=1.5), ["eta with k"]),
        (lambda: microfacet.Dielectric(microfacet.StudentT(0.1, 2), -1), ["eta = -1", "[0.001, 1000]"]),
        (lambda: microfacet.Tables().material("gold"), ["gold"]),
        (lambda: microfacet.bake("\n[[material]]\nname = 3\n"), ["recipe:2:1", "sigma"]),
        (lambda: microfacet.bake(quality="fine"), ['"fine"', '"high"']),
    ],
)
def test_errors_are_those_of_the_command(call, words):
    with pytest.raises(ValueError) as why:
        call()
    for word in words:
        assert word in str(why.value), why.value


def test_errors_of_albedos_are_in_words_of_python():
    tilted = microfacet.Ellipsoid((0.3, 0.1), (0.2, 0.1, 0.0), 2.5)
    for call in (lambda: tilted.albedo([0, 0, 1]), lambda: tilted.albedo_average()):
        with pytest.raises(ValueError) as why:
            call()
        said = str(why.value)
        for word in ("StandIn", "Skew", "when loading", "compensation needs"):
            assert word not in said, said
        assert "sigma and theta" in said and "microfacet.bake" in said, said


def test_arguments_of_another_type():
    with pytest.raises(TypeError, match="recipe must be the text of a recipe or a path"):
        microfacet.bake({})
    with pytest.raises(TypeError, match="cache must be True, False or a path"):
        microfacet.bake(RECIPE, cache=5)


def test_files_that_are_missing_or_damaged(tmp_path):
    with pytest.raises(FileNotFoundError, match="nothing"):
        microfacet.Tables(tmp_path / "nothing")
    with pytest.raises(FileNotFoundError, match="nothing.toml"):
        microfacet.bake(tmp_path / "nothing.toml")
    (tmp_path / "bad.safetensors").write_bytes(b"\x00" * 100)
    with pytest.raises(ValueError, match="bad.safetensors"):
        microfacet.Tables(tmp_path / "bad.safetensors")


def test_a_set_is_baked_written_and_read(tables, tmp_path):
    assert tables.materials == ["glass", "brushed"]
    tables.write(tmp_path / "set")
    again = microfacet.Tables(str(tmp_path / "set"))
    v = directions(200, 2)
    assert (again.material("glass").g1(v) == tables.material("glass").g1(v)).all()
    described = microfacet.inspect(tmp_path / "set")
    assert described == again.describe() and json.dumps(described)
    assert again.covers(2.5) and not again.covers(2.7) and microfacet.Tables().covers(2.7)
    path = tmp_path / "recipe.toml"
    path.write_text(RECIPE)
    baked = microfacet.bake(path, tmp_path / "other", cache=tmp_path / "cache", quality="draft")
    assert (tmp_path / "other/tables.safetensors").stat().st_size > 1000
    assert repr(baked) == f"Tables(baked, {len(described['tables'])} tables)"


def test_anisotropic_albedos_are_of_the_lobe_itself_or_stood_in_for(tables):
    brushed = tables.material("brushed")
    along, across = brushed.albedo([[0.8, 0, 0.6], [0, 0.8, 0.6]])
    model = exact.StudentT((0.4, 0.1), 3.0)
    want = model.albedo([[0.8, 0, 0.6], [0, 0.8, 0.6]])
    assert abs(along - want[0]) < 2e-3 and abs(across - want[1]) < 2e-3
    with pytest.raises(ValueError, match="azimuth"):
        brushed.albedo(0.6)
    lobe = microfacet.StudentT((0.4, 0.1), 3.0)
    assert lobe.albedo(0.6, stand_in=True) == microfacet.StudentT(0.2, 3.0).albedo(0.6)


def test_samples_have_the_density_and_weight_of_eval(tables):
    v, n = directions(400, 3, below=True), 400
    rng = np.random.default_rng(4)
    u, choice = rng.random((n, 2)), rng.random(n)
    gold = microfacet.Conductor(microfacet.StudentT(0.3, 2.5), metal="gold")
    full = microfacet.Conductor(
        microfacet.StudentT(0.5, 4), f0=(0.9, 0.5, 0.2), f82=0.5, compensation="kulla-conty"
    )
    glass = tables.bsdf("glass", "kulla-conty")
    coat = microfacet.Plastic(
        tables.material("glass"), 1.5, (0.8, 0.2, 0.1), compensation="kulla-conty"
    )
    single = microfacet.Plastic(microfacet.StudentT((0.4, 0.2), 3), 1.5, 0.5)
    rough = microfacet.Dielectric(microfacet.StudentT(1, 3), 1.3)
    for bsdf in [gold, full, glass, coat, single, rough]:
        sample = bsdf.sample(v, choice, u)
        alive = sample.pdf > 0
        assert alive.sum() > 100 and not sample.delta.any()
        f = bsdf.eval(v, sample.l)[alive]
        pdf = bsdf.pdf(v, sample.l)[alive]
        assert np.allclose(pdf, sample.pdf[alive], rtol=2e-3)
        weight = f * (np.abs(sample.l[alive, 2]) / sample.pdf[alive])[:, None]
        assert np.allclose(weight, sample.weight[alive], rtol=2e-3, atol=1e-5)
        assert (sample.transmitted == (np.sign(sample.l[:, 2]) * np.sign(v[:, 2]) < 0)).all()
    smooth = microfacet.Dielectric(microfacet.StudentT(1e-5, 3), 1.5)
    sample = smooth.sample([0, 0, 1], 0.9, [0.5, 0.5])
    assert smooth.is_delta and sample.delta and sample.transmitted and sample.eta == 1.5
    assert np.allclose(sample.l, [0, 0, -1])


def test_a_white_furnace_closes():
    u = np.random.default_rng(5).random((200_000, 2))
    choice = np.random.default_rng(6).random(200_000)
    for sigma, gamma in [(1.0, 1.8), (0.5, math.inf)]:
        lobe = microfacet.StudentT(sigma, gamma)
        v = [0.8, 0.0, 0.6]
        single = microfacet.Conductor(lobe).sample(v, choice, u).weight.mean()
        whole = microfacet.Conductor(lobe, compensation="kulla-conty").sample(v, choice, u)
        assert abs(single - lobe.albedo(v)) < 3e-3 and single < 0.93
        assert abs(whole.weight.mean() - 1) < 3e-3


def test_the_tables_of_a_shape_are_those_of_the_exports():
    shape = microfacet.Tables().shape(1.7)
    assert shape.gamma == 1.7 and shape.members["s"] == np.float32(1 / 0.7)
    assert set(shape.tables) >= {"masking", "slopes", "across", "heavy"}
    assert shape.tables["masking"].shape == (shape.members["masking_cells"] + 1, 4)
    # Masking by the cubics of the table, as docs/shaders.md has it.
    t, cells = shape.tables["masking"], shape.members["masking_cells"]
    sigma, z = 0.5, 0.6
    across = shape.members["kappa"] * sigma * math.sqrt(1 - z * z)
    at = z / (z + across) * cells
    if shape.members["masking_crowded"]:
        at = (1 - math.sqrt(across / (z + across))) * cells
    cell = int(at)
    a, b, c, d = t[cell]
    w = at - cell
    g1 = z * (a + w * (b + w * (c + w * d))) * cells / (z + across)
    assert abs(g1 - microfacet.StudentT(sigma, 1.7).g1([0.8, 0, 0.6])) < 1e-6


def test_shares_of_the_coat_of_a_plastic():
    mirror = microfacet.Plastic(microfacet.StudentT(1e-6, 2), 1.5, 0.5)
    shares = mirror.coat_shares([[0, 0, 1], [0.6, 0, 0.8]])
    assert shares.shape == (2, 2) and np.allclose(shares.sum(axis=1), 1)
    assert np.allclose(shares[0], [0.04, 0.96], atol=1e-6)
    # The share of diffuse light from inside that a smooth coat of 1.5 lets out.
    assert abs(mirror.leaving - 0.404) < 1e-3
    v, l = directions(100, 5), directions(100, 6)
    base = mirror.coat_shares(v)[:, 1] * mirror.coat_shares(l)[:, 1] * 0.5
    base /= np.pi * 1.5**2 * (0.5 + 0.5 * mirror.leaving)
    assert np.allclose(mirror.eval(v, l)[:, 0], base, rtol=1e-5)
    rough = microfacet.Plastic(microfacet.StudentT(0.5, 2), 1.5, 0.5)
    assert rough.coat_shares([0, 0, 1]).sum() < 0.98 and rough.leaving > mirror.leaving
