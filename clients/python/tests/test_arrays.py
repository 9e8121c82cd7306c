"""Arrays in and out: shapes, types, broadcasting, errors."""

import math
import multiprocessing
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import microfacet
from microfacet import exact

LOBE = microfacet.StudentT(0.4, 2.5)
V = np.array([0.6, 0.0, 0.8])


def test_a_direction_gives_a_number_and_many_an_array():
    one = LOBE.g1(V)
    assert one.shape == () and one.dtype == np.float32 and 0.9 < one < 1.0
    many = LOBE.g1(np.tile(V, (5, 1)))
    assert many.shape == (5,) and (many == one).all()
    grid = LOBE.g1(np.broadcast_to(V, (2, 3, 3)))
    assert grid.shape == (2, 3) and (grid == one).all()
    assert LOBE.g1(np.empty((0, 3))).shape == (0,)
    assert LOBE.sample_visible_normal(V, [0.3, 0.7]).shape == (3,)
    assert LOBE.g1([0.6, 0.0, 0.8]) == one
    assert exact.StudentT(0.4, 2.5).g1(V).dtype == np.float64


def test_arguments_broadcast():
    u = np.random.default_rng(1).random((4, 7, 2))
    views = np.array([[0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.0, 0.0, 1.0], [0.8, 0.0, 0.6]])
    m = LOBE.sample_visible_normal(views[:, None, :], u)
    assert m.shape == (4, 7, 3)
    for i in range(4):
        alone = LOBE.sample_visible_normal(np.tile(views[i], (7, 1)), u[i])
        # Several at once are the same to 2 ulp.
        assert np.abs(m[i] - alone).max() < 5e-7
    pdf = LOBE.visible_normal_pdf(views[:, None, :], m)
    assert pdf.shape == (4, 7) and (pdf > 0).all()


def test_layouts_and_types_do_not_matter():
    rng = np.random.default_rng(2)
    v = rng.normal(size=(3000, 3))
    v[:, 2] = np.abs(v[:, 2])
    v = (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)
    want = LOBE.g1(v)
    assert (LOBE.g1(v.astype(np.float64)) == want).all()
    assert (LOBE.g1(np.asfortranarray(v)) == want).all()
    assert (LOBE.g1(np.repeat(v, 2, axis=0)[::2]) == want).all()
    assert (LOBE.g1(v[::-1])[::-1] == want).all()
    assert (LOBE.g1(v.tolist()) == want).all()


def test_chunks_join_without_seams():
    # More than one chunk, and a last one that is not full.
    for n in [1, 3, 1023, 1024, 1025, 5000]:
        u = np.random.default_rng(n).random((n, 2), dtype=np.float32)
        m = LOBE.sample_visible_normal(V, u)
        alone = np.array([LOBE.sample_visible_normal(V, x) for x in u[[0, n // 2, n - 1]]])
        assert np.abs(m[[0, n // 2, n - 1]] - alone).max() < 5e-7


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: LOBE.g1([1.0, 2.0]), ["v has the shape (2,)", "3 numbers"]),
        (lambda: LOBE.g1(1.0), ["v has the shape ()"]),
        (lambda: LOBE.sample_visible_normal(V, [0.1]), ["u has the shape (1,)", "2 numbers"]),
        (lambda: LOBE.g2([V] * 2, [V] * 3), ["broadcast", "v (2,)", "l (3,)"]),
        (lambda: LOBE.g2(V, V, "smith"), ['"smith"', '"uncorrelated" or "height-correlated"']),
        (lambda: LOBE.g1("abc"), ["could not convert"]),
        (lambda: LOBE.g1([0, 0, 1j]), ["v must be real"]),
        (lambda: LOBE.albedo([0.8, 0.2, 0.1]), ["no unit vector", "cos_theta"]),
        (lambda: LOBE.g1([V, 2 * V]), ["v[1] is no unit vector", "length is 2.0000", "norm(v"]),
        (lambda: exact.StudentT(0.4, 2.5).g2(V, [[V], [0.9 * V]]), ["l[1, 0] is no unit vector"]),
        (lambda: LOBE.g1(np.float16([0.6, 0.0, 0.81])), ["v is no unit vector"]),
        (lambda: LOBE.albedo(1.1), ["v = 1.1", "[-1, 1]"]),
        (lambda: LOBE.albedo(cos_theta=[0.5, -2]), ["cos_theta[1] = -2", "[-1, 1]"]),
        (lambda: LOBE.albedo(), ["either v", "cos_theta"]),
        (lambda: LOBE.albedo(V, cos_theta=0.5), ["either v", "cos_theta"]),
    ],
)
def test_errors_name_what_is_wrong(call, words):
    with pytest.raises(ValueError) as why:
        call()
    for word in words:
        assert word in str(why.value)


def test_lengths_may_be_rounded_and_null_vectors_are_no_errors():
    rng = np.random.default_rng(6)
    v = rng.normal(size=(2000, 3))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    assert np.isfinite(LOBE.g1(v.astype(np.float16))).all()
    # What a path that ends has for its light.
    assert microfacet.Conductor(LOBE).eval(V, [[0, 0, 0], [0, 0, 1]])[0].tolist() == [0, 0, 0]
    assert LOBE.albedo(cos_theta=np.float32(1.0000001)) == LOBE.albedo(1.0)


def test_corners_give_numbers():
    v = np.array([[0, 0, 1], [1, 0, 0], [0, 0, -1], [0.6, 0, -0.8], [0, 0, 0], [math.nan] * 3])
    u = np.array([[0, 0], [1, 1], [0, 1], [math.nan, math.nan], [-1, 2], [0.5, 0.5]])
    for gamma in [1.501, 1.8, 2.0, 4.0, math.inf]:
        for sigma in [1e-8, 0.3, (1e-4, 10.0)]:
            lobe = microfacet.StudentT(sigma, gamma)
            m = lobe.sample_visible_normal(v[:, None, :], u)
            assert np.isfinite(m[:5]).all() and (m[:5, :, 2] > 0).all()
            assert np.isfinite(lobe.g1(v)).all() and np.isfinite(lobe.d(m[:5])).all()


def any_layout(rng: np.random.Generator, shape: "tuple[int, ...]") -> np.ndarray:
    """Numbers of a shape, in one of the ways in which memory may hold them."""
    order = rng.permutation(len(shape))
    dtype = rng.choice(["<f4", ">f4", "<f8"])
    x = rng.random([shape[i] for i in order])
    if shape[-1:] == (3,):
        x /= np.linalg.norm(x, axis=order.tolist().index(len(shape) - 1), keepdims=True)
    x = x.astype(dtype).transpose(np.argsort(order))
    way = rng.choice(["as it is", "reversed", "repeated", "not aligned"])
    if way == "reversed":
        return np.flip(x)
    # Components of directions are not repeated, which would change their length.
    axes = len(shape) - (shape[-1:] == (3,))
    if way == "repeated" and axes and x.size:
        return np.broadcast_to(x.take([0], rng.integers(axes)), shape)
    if way == "not aligned":
        odd = np.zeros(x.nbytes + 1, np.uint8)[1:].view(dtype).reshape(shape)
        odd[...] = x
        return odd
    return x


def test_arguments_of_every_shape_and_layout_broadcast():
    rng = np.random.default_rng(5)
    gold = microfacet.Conductor(LOBE, metal="gold")
    lasts = [(3,), (), (2,)]
    for _ in range(600):
        lengths = [1, 2, 2, 3, 3, 7, 7, 40] + [0] * (rng.random() < 0.1)
        batch = rng.choice(lengths, rng.integers(5))
        given = []
        for last in lasts:
            own = np.where(rng.random(len(batch)) < 0.4, 1, batch)[rng.integers(len(batch) + 1) :]
            given.append(any_layout(rng, (*own.tolist(), *last)))
        shape = np.broadcast_shapes(*(x.shape[: x.ndim - len(y)] for x, y in zip(given, lasts)))
        whole = [np.broadcast_to(x, shape + last) for x, last in zip(given, lasts)]
        have = gold.sample(*given)
        want = gold.sample(*(np.array(x, np.float32, order="C") for x in whole))
        assert have.pdf.shape == shape
        for name in ["l", "weight", "pdf", "eta"]:
            assert np.array_equal(getattr(have, name), getattr(want, name), equal_nan=True)


def test_one_number_that_is_repeated_stands_for_all():
    two = microfacet.StudentT(np.broadcast_to(0.3, 2), 2.5)
    assert two.batch_shape == (2,) and (two.sigma[0] == [0.3, 0.3]).all()
    assert two.g1(V).tolist() == [microfacet.StudentT(np.array([0.3]), 2.5).g1(V)[0]] * 2
    tilted = exact.Ellipsoid(0.3, np.broadcast_to(0.1, 3), 2.5)
    assert tilted.d(V) == exact.Ellipsoid(0.3, [0.1, 0.1, 0.1], 2.5).d(V)


#: Axes that NumPy's arrays may have.
MOST = 64 if int(np.__version__.split(".")[0]) >= 2 else 32


@pytest.mark.parametrize("lobe", [LOBE, exact.StudentT(0.4, 2.5)], ids=["tables", "model"])
@pytest.mark.parametrize("axes", [30, 31, 32, 33, 62])
def test_arrays_have_as_many_axes_as_numpys(lobe, axes):
    if axes + 2 > MOST:
        pytest.skip("this NumPy has fewer")
    # Two of them have a length.
    batch = (2, *[1] * (axes - 2), 3)
    v, u = np.broadcast_to(V, (*batch, 3)), np.full((*batch[:-1], 1, 2), 0.3)
    assert lobe.g1(v).shape == lobe.d(v).shape == lobe.g2(v, V).shape == batch
    m = lobe.sample_visible_normal(v, u)
    assert m.shape == (*batch, 3)
    assert np.abs(m - lobe.sample_visible_normal(V, [0.3, 0.3])).max() < 5e-7
    cos = np.full(batch, 0.8)
    assert (lobe.albedo(cos_theta=cos) == lobe.albedo(0.8)).all()
    assert lobe.albedo_parts(cos_theta=cos).shape == (*batch, 3)
    # All of them longer than 1, or empty, as far as NumPy has such arrays.
    batch = (0, *[2] * min(axes - 1, 40))
    assert lobe.g1(np.zeros((*batch, 3))).shape == batch


def test_more_axes_than_numpys_are_refused():
    cos = np.full((1,) * MOST, 0.8)
    assert LOBE.albedo(cos_theta=cos).shape == cos.shape
    for call in [
        lambda: LOBE.albedo_parts(cos_theta=cos),
        lambda: exact.StudentT(0.4, 2.5).albedo_parts(cos_theta=cos),
        lambda: microfacet.Conductor(LOBE).sample(V, cos, [0.1, 0.2]),
    ]:
        with pytest.raises(ValueError, match="dimension"):
            call()
    assert microfacet.StudentT(cos, 2.5).d(V).shape == cos.shape
    with pytest.raises(ValueError, match="f0 has the shape"):
        microfacet.Conductor(LOBE, f0=cos)
    with pytest.raises(ValueError, match="theta must be"):
        microfacet.Ellipsoid(0.3, np.zeros((1,) * (MOST - 1) + (3,)), 2.5)


#: With 4 GiB of addresses, so that no machine has room for what is refused: results of 10 GB and
#: more, of arguments of 600 kB. Results of 16 MB then take no more than half of that beside them.
LITTLE_MEMORY = """
import resource
import numpy as np
import microfacet
from microfacet import exact

resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
lobe, model = microfacet.StudentT(0.4, 2.5), exact.StudentT(0.4, 2.5)
gold = microfacet.Conductor(lobe, metal="gold")
sigma, gamma = np.linspace(0.1, 0.5, 50_000), np.linspace(1.6, 4, 50_000)
many = microfacet.StudentT(sigma[:, None], gamma)
golds = microfacet.Conductor(many, metal="gold", compensation="turquin")
v = np.broadcast_to(np.float32([0.6, 0.0, 0.8]), (50_000, 1, 3)).copy()
w, u = np.swapaxes(v, 0, 1), np.full((1, 50_000, 2), 0.3, np.float32)
choice, all = np.full((50_000, 1, 1), 0.5), np.broadcast_to(v, (50_000, 50_000, 3))
calls = [
    lambda: gold.eval(v, w), lambda: gold.pdf(v, w), lambda: gold.sample(v, 0.5, u),
    lambda: gold.sample(v[0, 0], choice, u), lambda: golds.sample(v[0, 0], 0.5, [0.3, 0.7]),
    lambda: golds.eval(v[0, 0], v[0, 0]), lambda: many.albedo(0.5), lambda: many.albedo_average(),
    lambda: exact.StudentT(sigma[:, None], gamma).g1(v[0, 0]),
]
for one in [lobe, model, many]:
    for name in ["g2", "reflection_weight", "visible_normal_pdf", "sample_visible_normal"]:
        calls.append(lambda f=getattr(one, name), x=u if name[0] == "s" else w: f(v, x))
    for name in ["d", "g1", "lambda_", "albedo", "albedo_parts"]:
        calls.append(lambda f=getattr(one, name): f(all))
for i, call in enumerate(calls):
    try:
        call()
    except MemoryError:
        continue
    raise SystemExit(f"no MemoryError by call {i}")


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


few = microfacet.StudentT(sigma[:2000, None], gamma[:2000])
for call in [
    lambda: lobe.g2(v[:2000], w[:, :2000]), lambda: lobe.g2(all[:2000, :2000], v[0, 0]),
    lambda: few.g2(v[:2000], w[:, :2000]),
]:
    before = peak()
    assert call().nbytes == 16_000_000
    assert peak() - before < 24_000, f"{peak() - before} kB"
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits and units are those of Linux")
def test_what_memory_lacks_is_an_exception_and_what_is_repeated_takes_none():
    done = subprocess.run([sys.executable, "-c", LITTLE_MEMORY], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]


def draw(queue: "multiprocessing.Queue[bool]", u: np.ndarray) -> None:
    queue.put(bool(np.isfinite(LOBE.sample_visible_normal(V, u)).all()))


@pytest.mark.skipif(sys.platform == "win32", reason="there is no fork")
def test_a_process_that_was_forked_does_not_wait_for_threads_of_the_other():
    u = np.random.default_rng(4).random((10_000, 2))
    LOBE.sample_visible_normal(V, u)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=draw, args=(queue, u))
    child.start()
    try:
        assert queue.get(timeout=60)
    finally:
        child.kill()


def test_the_lock_of_the_interpreter_is_released():
    lobe = exact.StudentT(0.5, 2.5)
    u = np.random.default_rng(3).random((200_000, 2))
    ticks = 0
    worker = threading.Thread(target=lambda: lobe.sample_visible_normal(V, u))
    worker.start()
    while worker.is_alive():
        time.sleep(0.001)
        ticks += 1
    # With the lock held this thread would wait for the other's end.
    assert ticks > 10
