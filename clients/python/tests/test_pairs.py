"""BSDFs of two parts: haze, and light that goes back."""

import math

import numpy as np
import pytest

import microfacet

V = np.array([0.6, 0.0, 0.8])


def directions(n, seed):
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(n, 3))
    w[:, 2] = np.abs(w[:, 2])
    return w / np.linalg.norm(w, axis=1, keepdims=True)


def turned(v):
    return v * [-1, -1, 1]


def gold(sigma, gamma=2.0, **form):
    return microfacet.Conductor(microfacet.StudentT(sigma, gamma), metal="gold", **form)


def mixed(first, second, share):
    """The second with its share, and the first with the rest."""
    share = np.reshape(share, np.shape(share) + (1,) * (np.ndim(first) - np.ndim(share)))
    return (1 - share) * first + share * second


def test_haze_is_what_its_parts_are_in_their_shares():
    lobe = microfacet.StudentT(0.3, 2.5)
    glass = [microfacet.Dielectric(microfacet.StudentT(s, 2.5), 1.5) for s in (0.1, 0.6)]
    coat = microfacet.Plastic(lobe, 1.5, (0.8, 0.2, 0.1))
    tilted = microfacet.Conductor(microfacet.Ellipsoid((0.3, 0.1), (0.2, -0.1, 0.5), 2.7))
    v, l = directions(500, 1), directions(500, 2)
    for core, haze in [(gold(0.1), gold(0.45)), (coat, gold(0.5)), (tilted, coat), glass]:
        both = microfacet.Haze(core, haze, 0.3)
        light = l * ([1, 1, -1] if core is glass[0] else 1)
        want = mixed(core.eval(v, light), haze.eval(v, light), 0.3)
        assert (want > 0).any() and np.allclose(both.eval(v, light), want, rtol=1e-5)
        # Not of other shares: the test can fail.
        assert not np.allclose(both.eval(v, light), want * 1.001, rtol=1e-5)
        want = mixed(core.pdf(v, light), haze.pdf(v, light), 0.3)
        assert np.allclose(both.pdf(v, light), want, rtol=1e-5)
        for weight, part in [(0, core), (1, haze)]:
            alone = microfacet.Haze(core, haze, weight)
            assert np.array_equal(alone.eval(v, light), part.eval(v, light))
            assert np.array_equal(alone.sample(v, 0.3, l[:, :2]).l, part.sample(v, 0.3, l[:, :2]).l)
    radiance, importance = (both.eval(V, [0, 0, -1], of) for of in ("radiance", "importance"))
    assert np.allclose(importance, radiance * 1.5**2)


@pytest.mark.parametrize("share", [0.25, 1.0])
def test_light_goes_back_to_the_view(share):
    silver = microfacet.Conductor(microfacet.StudentT((0.3, 0.15), 2.5), metal="silver")
    sheet = microfacet.Retroreflective(silver, share)
    v, l = directions(500, 3), directions(500, 4)
    want = mixed(silver.eval(v, l), silver.eval(turned(v), l), share)
    assert np.allclose(sheet.eval(v, l), want, rtol=1e-5)
    assert np.allclose(sheet.eval(v, l), sheet.eval(l, v), rtol=1e-3, atol=1e-6)
    none = microfacet.Retroreflective(silver, 0)
    assert np.array_equal(none.eval(v, l), silver.eval(v, l))
    # The peak about the view, of all lights in the plane of incidence.
    angles = np.linspace(-1.4, 1.4, 561)
    plane = np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=1)
    narrow = microfacet.Retroreflective(gold(0.02), share)
    about = plane[np.argmax(narrow.eval(V, plane)[:, 0] * (plane[:, 0] > 0))]
    assert np.abs(about - V).max() < 0.01
    back, forth = narrow.eval(V, [V, turned(V)])[:, 0]
    if share < 1:
        assert abs(back / forth * (1 - share) / share - 1) < 0.05
    else:
        assert back > 1000 * forth
    mirror = microfacet.Retroreflective(gold(1e-6), share)
    sample = mirror.sample(V, [0.999, 0.001], [0.3, 0.7])
    assert mirror.is_delta and sample.delta.all() and np.allclose(sample.l[0], V)
    assert np.allclose(sample.l[1], V if share == 1 else turned(V))


def everything():
    """Pairs of one lobe, of arrays and of both, and pairs of pairs; and the shape of each."""
    sigma, weight = np.array([0.1, 0.2, 0.4]), np.array([0.0, 0.3, 0.6, 1.0])[:, None]
    many, few = gold(sigma, compensation="kulla-conty"), gold(np.array([0.5]), 1.8)
    coat = microfacet.Plastic(microfacet.StudentT(0.3, 2.5), 1.5, 0.5)
    glass = microfacet.Dielectric(microfacet.StudentT(sigma, 2.5), 1.5)
    haze = microfacet.Haze(gold(0.1), gold(0.5), 0.3)
    return [
        (haze, ()),
        (microfacet.Retroreflective(haze, 0.4), ()),
        (microfacet.Haze(many, few, 0.3), (3,)),
        (microfacet.Haze(gold(0.1), gold(0.5), weight), (4, 1)),
        (microfacet.Haze(many, coat, weight), (4, 3)),
        (microfacet.Haze(microfacet.Haze(many, coat, weight), gold(0.9), 0.2), (4, 3)),
        (microfacet.Retroreflective(many, weight), (4, 3)),
        (microfacet.Retroreflective(microfacet.Haze(many, few, 0.3), weight), (4, 3)),
        (microfacet.Haze(microfacet.Retroreflective(many, 0.5), few, weight), (4, 3)),
        (microfacet.Haze(glass, glass, weight), (4, 3)),
    ]


def test_samples_have_the_density_and_weight_of_eval():
    rng = np.random.default_rng(5)
    v, choice, u = directions(400, 6)[:, None, None], rng.random((400, 1, 1)), rng.random((400, 1, 1, 2))
    for bsdf, shape in everything():
        sample = bsdf.sample(v, choice, u)
        assert sample.pdf.shape == (400, *np.broadcast_shapes((1, 1), shape)), bsdf
        alive = sample.pdf > 0
        assert alive.mean() > 0.5 and not sample.delta.any()
        assert np.allclose(bsdf.pdf(v, sample.l)[alive], sample.pdf[alive], rtol=5e-3), bsdf
        cosine = np.abs(sample.l[..., 2:])
        got = bsdf.eval(v, sample.l) * cosine
        want = sample.weight * sample.pdf[..., None]
        kept = alive & (cosine[..., 0] > 1e-3)
        assert np.allclose(got[kept], want[kept], rtol=5e-3, atol=1e-6), bsdf


def test_pairs_of_arrays_are_those_of_numbers():
    sigma, gamma = np.array([0.15, 0.3, 0.45]), np.array([1.7, 2.5, 4.0])
    weight = np.array([[0.0], [0.3], [1.0]])
    core, haze = gold(sigma, gamma), gold(np.array([0.7, 0.8, 0.9]))
    hazy = microfacet.Haze(core, haze, weight)
    back = microfacet.Retroreflective(hazy, np.array([0.2, 0.5, 1.0]))
    v, l = directions(200, 7)[:, None, None], directions(200, 8)[:, None, None]
    f, b = hazy.eval(v, l), back.eval(v, l)
    assert f.shape == b.shape == (200, 3, 3, 3)
    assert hazy.is_delta.shape == (3, 3) and not hazy.is_delta.any()
    v, l = v[:, 0, 0], l[:, 0, 0]
    for i, j in np.ndindex(3, 3):
        parts = [gold(sigma[j], gamma[j]), gold(0.7 + 0.1 * j)]
        one = microfacet.Haze(*parts, weight[i, 0])
        assert np.allclose(f[:, i, j], one.eval(v, l), rtol=2e-4, atol=1e-5)
        one = microfacet.Retroreflective(one, [0.2, 0.5, 1.0][j])
        assert np.allclose(b[:, i, j], one.eval(v, l), rtol=2e-4, atol=1e-5)
    # Arrays of parts that are smooth are deltas one by one.
    smooth = microfacet.Haze(gold(np.array([1e-6, 0.3])), gold(1e-6), np.array([[0.5], [1.0]]))
    assert smooth.is_delta.tolist() == [[True, False], [True, True]]


def test_a_white_furnace_closes():
    """Of parts that are compensated, as whole as each; of single bounces as their albedos."""
    lobes = [microfacet.StudentT(0.3, 2.0), microfacet.StudentT(1.0, 1.8)]
    rng = np.random.default_rng(9)
    choice, u = rng.random(200_000), rng.random((200_000, 2))
    for form in ["none", "kulla-conty"]:
        parts = [microfacet.Conductor(lobe, compensation=form) for lobe in lobes]
        hazy = microfacet.Haze(*parts, 0.4)
        want = mixed(*(lobe.albedo(V) for lobe in lobes), 0.4) if form == "none" else 1
        for bsdf in [hazy, microfacet.Retroreflective(hazy, 0.3)]:
            mean = bsdf.sample(V, choice, u).weight.mean(dtype=float)
            assert abs(mean - want) < 3e-3, (bsdf, mean, want)


def test_pairs_say_what_they_are():
    core, haze = gold(0.1), gold(0.45)
    hazy = microfacet.Haze(core, haze, weight=0.3)
    assert isinstance(hazy, microfacet.Bsdf)
    assert hazy.core is core and hazy.haze is haze and hazy.weight == 0.3
    assert repr(hazy) == f"Haze({core!r}, {haze!r}, weight=0.3)"
    back = microfacet.Retroreflective(hazy, share=1)
    assert back.bsdf is hazy and back.share == 1.0
    assert repr(back) == f"Retroreflective({hazy!r}, share=1)"
    weight = np.array([[0.1, 0.2]])
    many = microfacet.Haze(core, haze, weight)
    weight[:] = 5  # A copy was kept.
    assert many.weight.tolist() == [[0.1, 0.2]]
    assert repr(many) == f"Haze({core!r}, {haze!r}, weight of shape (1, 2))"
    back = microfacet.Retroreflective(core, np.array([0.5, 1]))
    assert repr(back) == f"Retroreflective({core!r}, share of shape (2,))"


TILTED = microfacet.Conductor(microfacet.Ellipsoid((0.3, 0.1), (0.2, -0.1, 0.5), 2.7))
GLASS = microfacet.Dielectric(microfacet.StudentT(0.3, 2.5), 1.5)
PANES = microfacet.Dielectric(microfacet.StudentT(np.array([0.3, 0.4]), 2.5), 1.5)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), 1.5), ["weight = 1.5", "[0, 1]"]),
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), -0.1), ["weight = -0.1:", "[0, 1]"]),
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), math.nan), ["weight = NaN:"]),
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), [0.5, 2]), ["weight[1] = 2:", "[0, 1]"]),
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), "much"), ["weight: could not convert"]),
        (
            lambda: microfacet.Haze(gold(np.array([0.1, 0.2])), gold(0.4), [0.1, 0.2, 0.3]),
            ["broadcast", "sigma (2,)", "weight (3,)"],
        ),
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), [0.1, 0.2]).pdf([V] * 3, V), ["weight (2,)"]),
        (lambda: microfacet.Retroreflective(gold(0.1), 1.5), ["share = 1.5:", "[0, 1]"]),
        (lambda: microfacet.Retroreflective(gold(0.1), [[math.nan]]), ["share[0, 0] = NaN:"]),
        (lambda: microfacet.Retroreflective(GLASS, 0.5), ["transmits", "take a conductor"]),
        (lambda: microfacet.Retroreflective(PANES, 0.5), ["transmits", "take a conductor"]),
        (lambda: microfacet.Retroreflective(GLASS, [0.5, 0.2]), ["transmits", "take a conductor"]),
        (lambda: microfacet.Retroreflective(TILTED, 0.5), ["tilted", "theta = 0"]),
        (lambda: microfacet.Retroreflective(TILTED, [0.5]), ["tilted", "theta = 0"]),
        (
            lambda: microfacet.Retroreflective(microfacet.Haze(gold(0.1), TILTED, [0.5]), 0.5),
            ["tilted", "theta = 0"],
        ),
        (
            lambda: microfacet.Retroreflective(microfacet.Haze(PANES, gold(0.1), 0.5), 0.5),
            ["transmits"],
        ),
    ],
)
def test_errors_name_what_is_wrong(call, words):
    with pytest.raises(ValueError) as why:
        call()
    said = str(why.value)
    assert "is_symmetric" not in said, said
    for word in words:
        assert word in said, said


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: microfacet.Haze(gold(0.1), gold(0.4)), ["weight is missing", "[0, 1]"]),
        (lambda: microfacet.Haze(gold(0.1), gold(0.4), specular_haze=0.3), ["is weight"]),
        (lambda: microfacet.Haze(microfacet.StudentT(0.1, 2), gold(0.4), 0.5), ["StudentT", "Bsdf"]),
        (lambda: microfacet.Retroreflective(gold(0.1)), ["share is missing", "[0, 1]"]),
        (lambda: microfacet.Retroreflective(gold(0.1), tint=1), ["has no argument tint"]),
    ],
)
def test_arguments_that_are_missing_or_of_another_type(call, words):
    with pytest.raises(TypeError) as why:
        call()
    for word in words:
        assert word in str(why.value), why.value


def test_parts_are_limited():
    """Of pairs of pairs, which else would take all memory, or a stack."""
    for make in [
        lambda bsdf: microfacet.Haze(bsdf, bsdf, 0.5),
        lambda bsdf: microfacet.Haze(bsdf, bsdf, [0.5]),
        lambda bsdf: microfacet.Haze(bsdf, gold(0.5), [0.5]),
        lambda bsdf: microfacet.Retroreflective(bsdf, 0.5),
    ]:
        bsdf = gold(0.2)
        with pytest.raises(ValueError, match=r"parts: it may have 64 at most.* make it of fewer"):
            for _ in range(100):
                bsdf = make(bsdf)
                last = bsdf
        assert np.isfinite(last.eval(V, V)).all() and (last.eval(V, V) > 0).all()
        assert np.isfinite(last.sample(V, np.linspace(0, 1, 5000), [0.3, 0.7]).weight).all()


RECIPE = """
[[material]]
name = "hazy gold"
sigma = 0.2
gamma = 2.5
haze = { weight = { min = 0.2, max = 0.4 }, sigma = 0.5 }
fresnel = { metal = "gold" }

[[material]]
name = "sheet"
sigma = 0.2
gamma = 2.5
haze = { weight = 0.3, sigma = 0.5 }
retroreflection = 0.8
fresnel = { metal = "gold" }
"""


def test_materials_of_a_set_have_their_haze_and_send_light_back(tmp_path):
    microfacet.bake(RECIPE, tmp_path, cache=False, quality="draft")
    tables = microfacet.Tables(tmp_path)
    v, l = directions(300, 10), directions(300, 11)
    for form in ["none", "kulla-conty"]:
        parts = [
            microfacet.Conductor(tables.student_t(sigma, 2.5), metal="gold", compensation=form)
            for sigma in (0.2, 0.5)
        ]
        hazy = microfacet.Haze(*parts, 0.3)
        sheet = microfacet.Retroreflective(hazy, 0.8)
        for name, made in [("hazy gold", hazy), ("sheet", sheet)]:
            named = tables.bsdf(name, form)
            assert np.allclose(named.eval(v, l), made.eval(v, l), rtol=1e-4), name
    # A material by name is a BSDF as any.
    named = microfacet.Retroreflective(tables.bsdf("hazy gold"), 0.8)
    assert np.allclose(named.eval(v, l), tables.bsdf("sheet").eval(v, l), rtol=1e-5)
    assert np.array_equal(tables.material("sheet").g1(v), tables.student_t(0.2, 2.5).g1(v))
