"""Lobes whose sigma and gamma are arrays."""

import copy
import math
import multiprocessing
import pickle

import numpy as np
import pytest

import microfacet
from microfacet import exact

V = np.array([0.6, 0.0, 0.8])
#: Both sides of 1.8, where one range of tables meets another: rounded down it is of the other.
GAMMAS = [1.501, 1.55, 1.7, 1.7999, 1.8000001, 2.0, 2.5, 4.0, 30.0, 1e3, 1e6, math.inf]


def directions(n, seed):
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(n, 3))
    w[:, 2] = np.abs(w[:, 2])
    return w / np.linalg.norm(w, axis=1, keepdims=True)


def surfaces(n, seed):
    """Random sigma and gamma, with the ends of both ranges among them."""
    rng = np.random.default_rng(seed)
    sigma, gamma = 10 ** rng.uniform(-3, 1, n), 1.5 + 10 ** rng.uniform(-2.9, 2, n)
    sigma[:4], gamma[: len(GAMMAS)] = [1e-8, 1e6, 1e-4, 10], GAMMAS
    # Arrays are read in single precision, whose rounding near 3/2 is 1e-5 of G1.
    gamma = np.maximum(gamma.astype(np.float32), np.nextafter(np.float32(1.501), 2))
    return sigma, gamma.astype(float)


@pytest.mark.parametrize("pair", [False, True], ids=["round", "sigma_x and sigma_y"])
def test_each_lobe_is_that_of_its_numbers(pair):
    n = 60
    sigma, gamma = surfaces(n, 1)
    other = np.random.default_rng(2).permutation(sigma)
    many = microfacet.StudentT((sigma, other), gamma) if pair else microfacet.StudentT(sigma, gamma)
    v, l = directions(200, 3)[:, None], directions(200, 4)[:, None]
    u = np.random.default_rng(5).random((200, 1, 2))
    u[:4, 0] = [[0, 0], [1, 1], [0, 1], [0.5, 0.5]]
    normals = many.sample_visible_normal(v, u)
    assert normals.shape == (200, n, 3) and many.batch_shape == (n,)
    assert np.abs(np.linalg.norm(normals.astype(float), axis=2) - 1).max() < 2e-6
    flat = normals.copy()
    for i in range(n):
        one = microfacet.StudentT((sigma[i], other[i]) if pair else sigma[i], gamma[i])
        assert np.abs(many.g1(v)[:, i] - one.g1(v[:, 0])).max() < 3e-6
        g2 = many.g2(v, l)[:, i] - one.g2(v[:, 0], l[:, 0])
        assert np.abs(g2).max() < 6e-6
        weight = many.reflection_weight(v, l, "uncorrelated")[:, i]
        assert np.abs(weight - one.reflection_weight(v[:, 0], l[:, 0], "uncorrelated")).max() < 3e-6
        pdf = one.visible_normal_pdf(v[:, 0], flat[:, i])
        assert np.allclose(many.visible_normal_pdf(v, flat)[:, i], pdf, rtol=2e-4)
        assert np.allclose(many.d(flat)[:, i], one.d(flat[:, i]), rtol=2e-4)
        own = one.sample_visible_normal(v[:, 0], u[:, 0])
        # Slopes of both draws in the middle of distributions; in tails numbers decide more.
        rough = max(sigma[i], other[i] if pair else 0)
        slopes = [(m[:, :2] / m[:, 2:]).astype(float) / rough for m in (flat[:, i], own)]
        middle = (np.abs(u[:, 0] - 0.5) < 0.49).all(axis=1) & (np.abs(slopes[1]) < 3).all(axis=1)
        off = np.abs(slopes[0] - slopes[1])[middle]
        assert gamma[i] < 1.7 or len(off) > 50
        assert np.max(off, initial=0) < 2e-3, (sigma[i], gamma[i])


def test_drawn_normals_have_the_stated_distribution():
    """Of the model's cumulative distribution of the cosine of m, seen from above."""
    sigma, gamma = np.array([0.1, 0.5, 1.0]), np.array([1.6, 2.5, 30.0])
    u = np.random.default_rng(7).random((400_000, 1, 2))
    m = microfacet.StudentT(sigma, gamma).sample_visible_normal([0, 0, 1], u)
    for i in range(3):
        tan2 = (1 / m[:, i, 2].astype(float) ** 2 - 1) / sigma[i] ** 2
        # Of projected normals: 1 - (1 + s tan^2/sigma^2)^(1 - gamma), s = 1/(gamma - 1).
        cdf = 1 - (1 + tan2 / (gamma[i] - 1)) ** (1 - gamma[i])
        ranks = (np.argsort(np.argsort(cdf)) + 0.5) / len(cdf)
        # Kolmogorov and Smirnov's statistic, whose limit is for one in a thousand.
        assert np.abs(ranks - cdf).max() * math.sqrt(len(cdf)) < 1.95


def test_all_arguments_broadcast():
    sigma, gamma = np.linspace(0.1, 0.5, 5)[:, None], np.linspace(1.6, 4, 7)
    many = microfacet.StudentT(sigma, gamma)
    v, u = directions(7, 8), np.random.default_rng(9).random((3, 1, 1, 2))
    assert many.batch_shape == (5, 7) and many.g1(v).shape == (5, 7)
    m = many.sample_visible_normal(v, u)
    assert m.shape == (3, 5, 7, 3)
    for i, j in np.ndindex(5, 7):
        one = microfacet.StudentT(np.array([sigma[i, 0]]), gamma[j])
        # Too few to fill the lanes of a processor are drawn one by one, to the last bits.
        off = np.abs(one.sample_visible_normal(v[j], u[:, 0, 0]) - m[:, i, j])
        assert off.max() <= 2 * np.finfo(np.float32).eps
    with pytest.raises(ValueError, match=r"sigma \(2,\), gamma \(3,\)"):
        microfacet.StudentT(np.ones(2), np.array([2, 3, 4]))
    with pytest.raises(ValueError, match="broadcast"):
        many.g1(directions(4, 8))


def test_the_model_is_that_of_numbers():
    sigma, gamma = np.array([0.1, 0.4, 0.4]), np.array([1.6, 2.5, math.inf])
    many = exact.StudentT(sigma, gamma)
    v, u = directions(4, 10)[:, None], np.random.default_rng(11).random((4, 1, 2))
    m, parts = many.sample_visible_normal(v, u), many.albedo_parts(v)
    assert m.dtype == np.float64 and parts.shape == (4, 3, 3)
    turned = exact.StudentT(sigma_x=sigma, sigma_y=0.2, gamma=2.5)
    for i in range(3):
        one = exact.StudentT(sigma[i], gamma[i])
        assert np.array_equal(m[:, i], one.sample_visible_normal(v[:, 0], u[:, 0]))
        assert np.array_equal(many.g1(v)[:, i], one.g1(v[:, 0]))
        assert np.array_equal(parts[:, i], one.albedo_parts(v[:, 0]))
        assert many.albedo_average()[i] == one.albedo_average()
        pair = exact.StudentT((sigma[i], 0.2), 2.5)
        assert np.array_equal(turned.albedo(v)[:, i], pair.albedo(v[:, 0]))
    with pytest.raises(ValueError, match="azimuth"):
        turned.albedo(0.5)


def test_the_model_has_albedos_of_more_shapes_than_it_keeps():
    gamma = np.linspace(1.6, 4, 257)
    many = exact.StudentT(0.3, gamma)
    assert many.albedo(0.8)[[0, 256]].tolist() == [exact.StudentT(0.3, g).albedo(0.8) for g in (1.6, 4)]


@pytest.mark.parametrize("masking", ["height-correlated", "uncorrelated"])
def test_albedos_are_those_of_numbers(masking):
    sigma, gamma = np.array([0.05, 0.3, 1.0, 3.0]), np.array([1.6, 2.0, 2.5, math.inf])
    many, cos = microfacet.StudentT(sigma, gamma), np.linspace(0.05, 1, 20)[:, None]
    e, parts = many.albedo(cos_theta=cos, masking=masking), many.albedo_parts(V, masking)
    averages = many.albedo_average_parts(masking)
    assert e.shape == (20, 4) and parts.shape == averages.shape == (4, 3)
    for i in range(4):
        one = microfacet.StudentT(sigma[i], gamma[i])
        assert np.abs(e[:, i] - one.albedo(cos_theta=cos[:, 0], masking=masking)).max() < 5e-4
        assert np.abs(parts[i] - one.albedo_parts(V, masking)).max() < 7e-4
        assert np.abs(averages[i] - one.albedo_average_parts(masking)).max() < 7e-4
        assert abs(many.albedo_average(masking)[i] - one.albedo_average(masking)) < 5e-4
    pair = microfacet.StudentT((sigma, 0.3), gamma)
    with pytest.raises(ValueError, match="stand_in=True"):
        pair.albedo(V)
    alone = microfacet.StudentT(np.sqrt(sigma * 0.3), gamma).albedo(V)
    assert np.allclose(pair.albedo(V, stand_in=True), alone, atol=1e-6)


RANGES = """
[[material]]
name = "glass"
sigma = { min = 0.1, max = 0.5 }
gamma = { min = 2.2, max = 3 }
fresnel = { dielectric = 1.5 }
"""


@pytest.fixture(scope="module")
def ranges():
    """Lobes of the range, since a family has tables of its own, and albedos of glass."""
    return microfacet.bake(RANGES, cache=False, quality="draft")


@pytest.mark.parametrize("compensation", ["none", "turquin", "kulla-conty"])
@pytest.mark.parametrize("material", ["conductor", "dielectric", "plastic"])
def test_materials_are_those_of_numbers(material, compensation, ranges):
    tables = microfacet.Tables() if material == "conductor" else ranges

    def made(lobe):
        form = {"compensation": compensation}
        if material == "conductor":
            return microfacet.Conductor(lobe, eta=[0.2, 0.9, 1.4], k=[3.9, 2.4, 1.9], **form)
        if material == "dielectric":
            return microfacet.Dielectric(lobe, 1.5, **form)
        return microfacet.Plastic(lobe, 1.5, [0.8, 0.4, 0.1], **form)

    sigma, gamma = np.array([0.15, 0.3, 0.45]), np.array([2.25, 2.5, 2.9])
    many = made(tables.student_t(sigma, gamma))
    v, l, u = directions(300, 12)[:, None], directions(300, 13), directions(300, 14)[:, None, :2] ** 2
    if material == "dielectric":
        l[::2] *= -1
    l = l[:, None]
    f, pdf, sample = many.eval(v, l), many.pdf(v, l), many.sample(v, 0.3, u)
    assert f.shape == sample.weight.shape == (300, 3, 3) and pdf.shape == (300, 3)
    assert not many.is_delta.any()
    assert made(tables.student_t(sigma[0], gamma[0])).is_delta is False
    for i in range(3):
        one = made(tables.student_t(sigma[i], gamma[i]))
        # A volume over all shapes is coarser than one lobe's tables.
        within = {"rtol": 2e-4 if compensation == "none" and material != "plastic" else 2e-2}
        assert np.allclose(f[:, i], one.eval(v[:, 0], l[:, 0]), atol=1e-5, **within)
        # Of a broad lobe a hit has a simpler density.
        if material != "plastic" and compensation != "kulla-conty":
            assert np.allclose(pdf[:, i], one.pdf(v[:, 0], l[:, 0]), atol=1e-5, **within)
    again = many.pdf(v, sample.l)
    ends = sample.pdf == 0
    assert np.allclose(again[~ends], sample.pdf[~ends], rtol=2e-2)
    cosine = np.abs(sample.l[..., 2:])
    value = many.eval(v, sample.l) * cosine
    kept = ~ends & (cosine[..., 0] > 1e-3)
    assert np.allclose(value[kept], (sample.weight * sample.pdf[..., None])[kept], rtol=2e-2)


def test_a_white_furnace_of_many_is_white():
    sigma, gamma = np.array([0.2, 0.5, 1.0])[:, None], np.array([1.7, 2.0, 3.0, math.inf])
    white = microfacet.Conductor(microfacet.StudentT(sigma, gamma), compensation="kulla-conty")
    u = np.random.default_rng(15).random((40_000, 1, 1, 3))
    sample = white.sample(V, u[..., 0], u[..., 1:])
    weights = sample.weight[..., 0]
    mean = weights.mean(axis=0, dtype=float)
    deviation = weights.std(axis=0, dtype=float) / math.sqrt(len(u))
    assert (np.abs(mean - 1) < 4 * deviation + 1e-3).all(), mean


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: microfacet.StudentT(np.array([0.3, 0.0]), 2.5), ["sigma = 0", "[1e-8, 1e6]"]),
        (lambda: microfacet.StudentT(np.array([0.3, math.nan]), 2.5), ["sigma = NaN"]),
        (lambda: microfacet.StudentT(0.3, np.array([2, 1.5])), ["gamma = 1.5", "(1.5, inf]"]),
        (lambda: microfacet.StudentT(0.3, np.array([2, 1.5005])), ["gamma = 1.5005", "1.501"]),
        (lambda: microfacet.StudentT(0.3, np.array([math.nan])), ["gamma = NaN"]),
        (lambda: exact.StudentT(0.3, np.array([2, 1.5])), ["gamma = 1.5", "(1.5, inf]"]),
        (lambda: microfacet.StudentT(0.3, 2, sigma_x=0.2), ["either it or them"]),
        (lambda: microfacet.StudentT(gamma=2, sigma_x=0.2), ["sigma_x and sigma_y"]),
        (lambda: microfacet.StudentT(np.array([1, 4.0]), 2).albedo(0.5), ["sigma = 4", "3]"]),
        (
            lambda: microfacet.StudentT((np.array([1, 40.0]), 1.0), 2).albedo(V, stand_in=True),
            ["sigma = 6.3", "3]"],
        ),
        (
            lambda: microfacet.Dielectric(
                microfacet.StudentT(np.array([0.4]), 2), 2.25, compensation="turquin"
            ),
            ["dielectric", "2.25"],
        ),
        (lambda: microfacet.Plastic(microfacet.StudentT(np.array([0.4]), 2), 1.5, 2.0), ["base"]),
    ],
)
def test_errors_name_what_is_wrong(call, words):
    with pytest.raises(ValueError) as why:
        call()
    for word in words:
        assert word in str(why.value), why.value


@pytest.mark.parametrize("material", [microfacet.Dielectric, microfacet.Plastic])
def test_albedos_beyond_the_tables_are_refused(material, ranges):
    base = [0.5] if material is microfacet.Plastic else []
    for sigma, gamma, word in [([0.2, 0.6], 2.5, "sigma 0.6,"), ([0.2, 0.3], 2.1, "2.1")]:
        lobe = microfacet.StudentT(np.array(sigma), gamma)
        with pytest.raises(ValueError, match=word):
            material(ranges.student_t(lobe.sigma[0], gamma), 1.5, *base, compensation="turquin")


def lobes():
    """One lobe of each kind, of the tables built in, of others, and of the model."""
    other = microfacet.bake(RANGES, cache=False, quality="draft", albedo=False)
    array = np.array([0.2, 0.4])
    return [
        microfacet.StudentT((0.3, 0.1), 2.5),
        microfacet.StudentT(array, array + 2),
        microfacet.Ellipsoid((0.3, 0.1), (0.2, -0.1, 0.5), 2.7),
        other.student_t(sigma_x=array, sigma_y=0.3, gamma=2.5),
        exact.StudentT(array, 2.5),
        exact.Ellipsoid((0.3, 0.1), (0.2, -0.1, 0.5), 2.7),
    ]


def test_lobes_are_pickled_and_copied():
    for lobe in lobes():
        for twin in [pickle.loads(pickle.dumps(lobe)), copy.copy(lobe), copy.deepcopy(lobe)]:
            assert type(twin) is type(lobe) and repr(twin) == repr(lobe)
            assert np.array_equal(twin.g1(V), lobe.g1(V))
    tables = microfacet.Tables()
    assert len(pickle.dumps(tables)) < 200 and pickle.loads(pickle.dumps(tables)).covers(2.5)


def test_processes_are_given_lobes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        lobe = microfacet.StudentT(np.array([0.3, 0.4]), 2.5)
        assert np.array_equal(pool.apply(lobe.g1, (V,)), lobe.g1(V))
