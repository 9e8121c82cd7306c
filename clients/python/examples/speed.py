"""Compares the time of drawing a million visible normals in Python with that of the Rust crate.

Python's is the whole call, with its arrays, on all cores; Rust's is `sample_batch` alone, on one.
The last row is of a million lobes, one for each normal, and of `Family::sample_batch`.
"""

import time

import numpy as np

import microfacet

N = 1_000_000
TIMES = 15


def main() -> None:
    rng = np.random.default_rng(1)
    v = rng.normal(size=(N, 3))
    v[:, 2] = np.abs(v[:, 2])
    v = (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)
    u = rng.random((N, 2), dtype=np.float32)
    print("gamma  ms in Python  ms in Rust  ratio; the least of", TIMES)
    lobes = {gamma: microfacet.StudentT(0.5, gamma) for gamma in [1.6, 2.5, 4.0, float("inf")]}
    arrays = [rng.uniform(low, high, N) for low, high in [(0.1, 0.6), (1.6, 4.0)]]
    for gamma, lobe in [*lobes.items(), ("array", microfacet.StudentT(*arrays))]:
        python, rust = [], []
        for _ in range(TIMES):
            start = time.perf_counter()
            lobe.sample_visible_normal(v, u)
            python.append(time.perf_counter() - start)
            rust.append(lobe._seconds_in_rust(v, u))
        best, of = min(python), min(rust)
        print(f"{gamma:5}  {best * 1e3:12.1f}  {of * 1e3:10.1f}  {best / of:5.2f}")


if __name__ == "__main__":
    main()
