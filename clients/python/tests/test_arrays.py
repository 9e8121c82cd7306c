"""Arrays in and out: shapes, types, broadcasting, errors."""

import math
import multiprocessing
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
        (lambda: LOBE.g2(np.ones((2, 3)), np.ones((3, 3))), ["broadcast", "v (2,)", "l (3,)"]),
        (lambda: LOBE.g2(V, V, "smith"), ['"smith"', '"uncorrelated" or "height-correlated"']),
        (lambda: LOBE.g1("abc"), ["could not convert"]),
        (lambda: LOBE.g1([0, 0, 1j]), ["v must be real"]),
        (lambda: LOBE.albedo([0.8, 0.2, 0.1]), ["no unit vector", "cos_theta"]),
        (lambda: LOBE.albedo(), ["either v", "cos_theta"]),
        (lambda: LOBE.albedo(V, cos_theta=0.5), ["either v", "cos_theta"]),
    ],
)
def test_errors_name_what_is_wrong(call, words):
    with pytest.raises(ValueError) as why:
        call()
    for word in words:
        assert word in str(why.value)


def test_corners_give_numbers():
    v = np.array([[0, 0, 1], [1, 0, 0], [0, 0, -1], [0.6, 0, -0.8], [0, 0, 0], [math.nan] * 3])
    u = np.array([[0, 0], [1, 1], [0, 1], [math.nan, math.nan], [-1, 2], [0.5, 0.5]])
    for gamma in [1.501, 1.8, 2.0, 4.0, math.inf]:
        for sigma in [1e-8, 0.3, (1e-4, 10.0)]:
            lobe = microfacet.StudentT(sigma, gamma)
            m = lobe.sample_visible_normal(v[:, None, :], u)
            assert np.isfinite(m[:5]).all() and (m[:5, :, 2] > 0).all()
            assert np.isfinite(lobe.g1(v)).all() and np.isfinite(lobe.d(m[:5])).all()


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
