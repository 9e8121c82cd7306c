"""Compares the time of sampling with that of Mitsuba's own rough conductor.

Ten million samples in one kernel, by numbers drawn beforehand; the least time of several::

    python examples/mitsuba_speed.py
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import microfacet.mitsuba

microfacet.mitsuba.set_variant("llvm_ad_rgb")

import drjit as dr
import mitsuba as mi
import numpy as np


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=10_000_000)
    parser.add_argument("--repeat", type=int, default=10)
    parser.add_argument("--sigma", type=float, default=0.3)
    parser.add_argument("--compensation", default="none")
    parser.add_argument("--threads", type=int, help="fewer than cores, where others work, too")
    options = parser.parse_args()
    if options.threads is not None:
        dr.set_thread_count(options.threads)

    metal = {"eta": 0.2, "k": 3.0}
    surfaces: dict[str, dict[str, Any]] = {
        "roughconductor, ggx": {
            "type": "roughconductor", "distribution": "ggx", "alpha": options.sigma, **metal,
        },
        "roughconductor, beckmann": {
            "type": "roughconductor", "distribution": "beckmann", "alpha": options.sigma, **metal,
        },
    }  # fmt: skip
    surface = {**surfaces["roughconductor, ggx"]}
    surface["alpha"] = bitmap(0.96 * options.sigma, 1.04 * options.sigma)
    surfaces["roughconductor, ggx, texture of alpha"] = surface
    for gamma in (1.6, 2.0, 2.5, 4.0, float("inf")):
        surfaces[f"student_t_conductor, gamma = {gamma:g}"] = {
            "type": "student_t_conductor", "gamma": gamma, "sigma": options.sigma,
            "compensation": options.compensation, **metal,
        }  # fmt: skip
    for names in (("gamma",), ("sigma", "gamma")):
        surface = dict(surfaces["student_t_conductor, gamma = 2.5"])
        for name in names:
            surface[name] = bitmap(0.96 * surface[name], 1.04 * surface[name])
        surfaces[f"student_t_conductor, texture of {' and '.join(names)}"] = surface
    bsdfs, loads = {}, {}
    for name, surface in surfaces.items():
        start = time.perf_counter()
        bsdfs[name] = mi.load_dict(surface)
        loads[name] = time.perf_counter() - start
    hits = views(options.samples)
    numbers = np.random.default_rng(1).random((3, options.samples), dtype=np.float32)
    choice, place = mi.Float(numbers[0]), mi.Point2f(numbers[1:])
    dr.eval(hits, choice, place)

    best = dict.fromkeys(bsdfs, float("inf"))
    # In turns, so that what else the machine does meets all of them; the first compiles.
    for turn in range(options.repeat + 1):
        for name, bsdf in bsdfs.items():
            start = time.perf_counter()
            sample = bsdf.sample(mi.BSDFContext(), hits, choice, place)
            dr.eval(sample)
            dr.sync_thread()
            if turn > 0:
                best[name] = min(best[name], time.perf_counter() - start)
    native = best["roughconductor, ggx"]
    for name, seconds in best.items():
        sample = f"{1e9 * seconds / options.samples:6.2f} ns   {seconds / native:5.2f}"
        print(f"{name:48} {sample}   loaded in {loads[name]:.2f} s")


def bitmap(low: float, high: float) -> dict[str, Any]:
    """A texture of random numbers, as a file gives it."""
    data = np.random.default_rng(3).uniform(low, high, (256, 256, 1)).astype(np.float32)
    return {"type": "bitmap", "raw": True, "bitmap": mi.Bitmap(data)}


def views(count: int) -> mi.SurfaceInteraction3f:
    """Hits anywhere on a texture, whose views have cosines evenly in [0, 1]."""
    rng = np.random.default_rng(2)
    z, azimuth = rng.random(count), 2 * np.pi * rng.random(count)
    radius = np.sqrt(1 - z * z)
    hits = dr.zeros(mi.SurfaceInteraction3f, count)
    w = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z])
    hits.wi = mi.Vector3f(w.astype(np.float32))
    hits.uv = mi.Point2f(rng.random((2, count), dtype=np.float32))
    return hits


if __name__ == "__main__":
    main()
