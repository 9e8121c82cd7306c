"""Measures a farm on this machine: the speed-up of two workers, the overhead of a task, and the
time and memory of a driver that plans 100,000 materials.

    python clients/python/examples/farm_speed.py

Two workers need two idle cores.
"""

from __future__ import annotations

import argparse
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from distributed import Client, LocalCluster, as_completed
from microfacet import farm


def materials(count: int) -> Iterator[dict[str, Any]]:
    """Brushed metals, each with albedos of its own."""
    numbers = random.Random(7)
    for i in range(count):
        sigma = [round(numbers.uniform(0.05, 0.6), 4) for _ in range(2)]
        gamma = round(numbers.uniform(1.6, 6.0), 1)
        yield {"name": f"metal {i}", "sigma": sigma, "gamma": gamma, "fresnel": "mirror"}


def seconds(workers: int, count: int) -> float:
    """The time of a bake of draft quality on so many workers of one thread."""
    cluster = LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=":0"
    )
    with tempfile.TemporaryDirectory() as folder, cluster, Client(cluster) as client:
        out, cache = Path(folder) / "out", Path(folder) / "cache"
        options: dict[str, Any] = {"quality": "draft", "seconds_per_task": 0.5}
        done = farm.bake(
            materials(count), client, out, cache=cache, progress=False, **options
        )
        assert done.made_up == done.kept == 0
        return done.seconds


def overhead(tasks: int) -> float:
    """The seconds of a task that has nothing to do."""
    cluster = LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    )
    with cluster, Client(cluster) as client:
        start = time.monotonic()
        empty = [
            client.submit(farm._work, [], None, 1 << 30, key=f"empty-{i}") for i in range(tasks)
        ]
        for future in as_completed(empty):
            future.result()
        return (time.monotonic() - start) / tasks


def plan(count: int) -> None:
    """Plans a list as it goes, and prints what that takes."""
    start = time.monotonic()
    needs, work = 0, 0.0
    seen: set[str] = set()
    for library in farm.libraries(materials(count), quality="default"):
        for need in library.needs():
            if need.id not in seen:
                seen.add(need.id)
                needs, work = needs + 1, work + need.seconds
    took = time.monotonic() - start
    # Linux counts kilobytes.
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(f"driver: {count} materials, {needs} needs, {work / 3600:.0f} core hours")
    print(f"driver: planned in {took:.1f} s, {peak / 1e6:.0f} MB at most")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--materials", type=int, default=40, help="baked by workers")
    parser.add_argument("--planned", type=int, default=100_000, help="planned by the driver")
    parser.add_argument("--only-plan", action="store_true")
    args = parser.parse_args()
    if args.only_plan:
        plan(args.planned)
        return
    one, two = (seconds(workers, args.materials) for workers in (1, 2))
    print(f"{args.materials} materials: one worker {one:.1f} s, two {two:.1f} s: {one / two:.2f}")
    print(f"overhead of a task: {1e3 * overhead(500):.1f} ms")
    # In a process of its own, whose memory nothing else has used.
    subprocess.run(
        [sys.executable, __file__, "--only-plan", "--planned", str(args.planned)], check=True
    )


if __name__ == "__main__":
    main()
