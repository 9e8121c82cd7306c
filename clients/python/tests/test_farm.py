"""Libraries on a real cluster of Dask: two worker processes, one of them killed on the way."""

from __future__ import annotations

import json
import os
import pickle
import random
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import microfacet
import numpy as np
import pytest
from microfacet import farm

distributed = pytest.importorskip("distributed")

COUNT = 7


def materials(count: int = COUNT) -> Iterator[dict[str, Any]]:
    """Anisotropic mirrors, each with an albedo of its own."""
    for i in range(count):
        sigma = [0.2 + 0.02 * i, 0.5]
        gamma = 2.5 + 0.5 * (i % 2)
        yield {"name": f"m {i}", "sigma": sigma, "gamma": gamma, "fresnel": "mirror"}


def recipe() -> str:
    return "\n".join(
        f'[[material]]\nname = "{m["name"]}"\nsigma = {m["sigma"]}\ngamma = {m["gamma"]}\n'
        'fresnel = "mirror"'
        for m in materials()
    )


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as cluster, distributed.Client(cluster, set_as_default=False) as client:
        yield client


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What one process makes, with no cache."""
    out = tmp_path_factory.mktemp("alone")
    microfacet.bake(recipe(), out / "set", quality="draft", cache=False)
    return content(out / "set")


def farmed(scene: farm.Scene, client: Any, out: Path, **options: Any) -> farm.Farmed:
    options = {"quality": "draft", "cache": out.parent / "cache", "progress": False} | options
    return farm.bake(scene, client, out, **options)


@pytest.mark.parametrize("shared", [False, True])
def test_the_bytes_are_those_of_one_process(
    client: Any, alone: dict[str, bytes], tmp_path: Path, shared: bool
) -> None:
    done = farmed(recipe(), client, tmp_path / "out", shared=shared, seconds_per_task=0.2)
    assert (done.materials, done.baked, done.kept, done.made_up) == (COUNT, COUNT + 2, 0, 0)
    assert content(tmp_path / "out") == alone
    again = farmed(recipe(), client, tmp_path / "out", shared=shared)
    assert (again.baked, again.kept, again.made_up) == (0, COUNT + 2, 0)
    assert content(tmp_path / "out") == alone


def test_round_lobes_of_one_sigma_each(client: Any, tmp_path: Path) -> None:
    """sigma as one number, of a recipe's text, its file and an iterable: the same bytes."""
    rows = [("brushed", 0.3, 2.5), ("polished", 0.05, 3.5)]
    text = "\n".join(
        f'[[material]]\nname = "{name}"\nsigma = {sigma}\ngamma = {gamma}\n'
        'fresnel = { metal = "gold" }'
        for name, sigma, gamma in rows
    )
    metals = (
        {"name": name, "sigma": sigma, "gamma": gamma, "fresnel": {"metal": "gold"}}
        for name, sigma, gamma in rows
    )
    (tmp_path / "library.toml").write_text(text)
    microfacet.bake(text, tmp_path / "alone", quality="draft", cache=False)
    for number, scene in enumerate((text, tmp_path / "library.toml", metals)):
        cache, out = tmp_path / f"cache {number}", tmp_path / f"out {number}"
        done = farmed(scene, client, out, cache=cache, seconds_per_task=0.01)
        assert (done.materials, done.baked, done.made_up) == (2, 6, 0)
        assert content(out) == content(tmp_path / "alone")
    metal = microfacet.Tables(out).bsdf("polished", compensation="kulla-conty")
    assert np.isfinite(metal.eval([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8])).all()


def test_a_worker_that_is_killed_loses_nothing(
    client: Any, alone: dict[str, bytes], tmp_path: Path
) -> None:
    before = set(client.run(os.getpid).values())
    killed: list[int] = []

    def kill_on_the_way() -> Iterator[dict[str, Any]]:
        for i, material in enumerate(materials()):
            if i == COUNT - 1:
                # Tasks of the first sets are under way.
                time.sleep(0.3)
                killed.append(min(before))
                os.kill(killed[0], signal.SIGKILL)
            yield material

    done = farmed(
        kill_on_the_way(), client, tmp_path / "out", per_set=2, seconds_per_task=0.01
    )
    assert killed and done.materials == COUNT
    one = microfacet.bake(recipe(), quality="draft", cache=False)
    tables = microfacet.Tables(tmp_path / "out")
    assert tables.materials == one.materials
    # The numbered sets are those that the cluster makes when nothing happens.
    farmed(materials(), client, tmp_path / "calm", per_set=2, cache=tmp_path / "other")
    assert content(tmp_path / "calm") == content(tmp_path / "out")


def test_numbered_sets_open_as_one_or_in_part(client: Any, tmp_path: Path) -> None:
    done = farmed(materials(), client, tmp_path / "out", per_set=3)
    names = [path.name for path in done.files]
    assert [name[:13] for name in names[:-1]] == ["tables-00001-", "tables-00002-", "tables-00003-"]
    assert names[-1] == "tables.index.json" and set(names) == set(content(tmp_path / "out"))
    whole = microfacet.Tables(tmp_path / "out")
    part = microfacet.Tables(tmp_path / "out", materials=["m 6", "m 1"])
    assert len(whole.materials) == COUNT and part.materials == ["m 1", "m 6"]
    for name in part.materials:
        v = [0.6, 0.0, 0.8]
        assert float(part.material(name).albedo(v)) == float(whole.material(name).albedo(v))
    with pytest.raises(ValueError, match="none of the 7 materials is named \"gold\""):
        microfacet.Tables(tmp_path / "out", materials=["gold"])


def literal(value: Any) -> str:
    """A value in the TOML that one writes by hand, on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {literal(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(literal, value)) + "]"
    return json.dumps(value) if isinstance(value, (str, bool)) else repr(value)


def any_material(rng: random.Random, number: int) -> dict[str, Any]:
    """A material of any shape: numbers, lists and tables, names of any length and characters."""
    some = rng.choice
    names = ["m", "n" * 120, 'a "b" \\ \'c\' # [[material]]', "\n[[material]]\r\n",
             "м漢\u0085\x00"]
    name = some(names)
    of = some(["sigma", "sigma", "sigma", "theta", "word", "number"])
    table: dict[str, Any] = {"name": f"{name} {number}"}
    if of == "word":
        table |= {"distribution": some(["beckmann", "gauss"]), "m": some([0.25, 0.3])}
    elif of == "number":
        table |= {"distribution": "student-t", "sigma": 0.3, "gamma": some([3.0, 1e20])}
    elif of == "theta":
        table |= {"sigma": some([0.3, [0.4, 0.2]]), "gamma": 2.5, "theta": [3, -6.5, 30]}
        table |= some([{}, {"degrees": True}])
    else:
        extent = {"min": 0.1, "max": 0.2}
        table["sigma"] = some([0.3, 0, [0.3, 0.2], extent, [extent, 0.3], [extent, extent]])
        table["gamma"] = some([2.3, 3, "inf", float("inf"), {"min": 3.0, "max": 4}])
    index = {"eta": [0.14, 0.37, 1.44], "k": [3.98, 2.39, 1.6]}
    fresnel = some([None, "mirror", {"schlick": 0.04}, {"metal": "gold"}, {"conductor": index}])
    if fresnel and of != "theta":
        table |= {"fresnel": fresnel, "masking": some(["uncorrelated", "height-correlated"])}
    entries = list(table.items())
    rng.shuffle(entries)
    return dict(entries)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_materials_of_all_shapes_are_those_of_a_recipe() -> None:
    rng = random.Random(1)
    lists = [[any_material(rng, i) for i in range(rng.randint(1, 5))] for _ in range(150)]
    round_ones = [{"name": f"m {i}", "sigma": 0.1, "gamma": 2.3} for i in range(3)]
    # All on one line each; one that is not; what the error for other things proposes.
    lists += [round_ones, [*round_ones, {**round_ones[0], "name": "n" * 120}]]
    lists += [[{"name": name, "sigma": 0.3, "gamma": 2.5} for name in ("gold", "silver")]]
    for tables in lists:
        text = "".join(
            "[[material]]\n" + "".join(f"{key} = {literal(table[key])}\n" for key in table)
            for table in tables
        )
        want = farm.Library(text)
        (have,) = farm.libraries(tables)
        assert have.sets == want.sets, text
        assert [need.id for need in have.needs()] == [need.id for need in want.needs()], text


def test_needs_travel(tmp_path: Path) -> None:
    (library,) = farm.libraries(materials(), quality="draft", per_set=10_000)
    needs = library.needs()
    assert len(needs) == COUNT + 2 and all(need.seconds > 0 for need in needs)
    for need in needs:
        other = pickle.loads(pickle.dumps(need))
        assert (other.id, str(other)) == (need.id, str(need))
    need = max(needs, key=lambda need: need.seconds)
    assert not need.is_kept(tmp_path)
    assert need.bake(tmp_path) and need.is_kept(tmp_path) and not need.bake(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [need.id + ".safetensors"]
    with pytest.raises(ValueError, match="install the same version"):
        farm.Need(str(need).replace("numerics ", "numerics 9"))


def test_what_is_wrong_is_said(client: Any, tmp_path: Path) -> None:
    def says(match: str, scene: Any = None, error: type[Exception] = ValueError, **o: Any) -> None:
        with pytest.raises(error, match=match):
            farmed(recipe() if scene is None else scene, client, tmp_path / "out", **o)

    says("two materials are named", [*materials(2), *materials(1)], per_set=2)
    says("each material must be a table", ["gold"], TypeError)
    says("seconds_per_task is 0", seconds_per_task=0)
    says("retries is -1", retries=-1)
    says(r"in \[1, 10000\]", per_set=0)
    says(r"in \[1, 10000\]", materials(), per_set=2.5)
    says("and is a dict", {"name": "gold"}, TypeError)
    says("and is a int", 3, TypeError)
    says("no materials", [])
    bad = {"name": "bad", "sigma": 0.3, "gamma": 1.2}
    says(r"^material \'bad\': gamma = 1.2 is", [*materials(4), bad], per_set=2)
    says(r"^material \'bad\': unknown key", [{**bad, "gamma": 3, "department": "fx"}])
    says("name is None", [{"sigma": 0.3, "gamma": 3.0}])
    says("material \'bad\': sigma is a object", [{**bad, "sigma": object()}], TypeError)
    says("material \'bad\': masking: .*surrogates", [{**bad, "masking": "\ud800"}])
    says(r"^material \'bad\': sigma: .*limit", [{**bad, "sigma": 10**5000}])
    # Nothing was written.
    assert not (tmp_path / "out").exists()


def test_values_of_numpy_and_none_are_understood(client: Any, tmp_path: Path) -> None:
    row = {
        "name": np.str_("a"),
        "sigma": np.array([0.3, 0.25], np.float64),
        "gamma": np.float32(3.5),
        "theta": None,
        "fresnel": {"conductor": {"eta": np.ones(3), "k": (3, np.int64(2), 1.0)}},
    }
    assert farmed([row], client, tmp_path / "out").materials == 1


def test_a_damaged_entry_is_baked_by_workers(
    client: Any, alone: dict[str, bytes], tmp_path: Path
) -> None:
    farmed(recipe(), client, tmp_path / "out")
    entry = max((tmp_path / "cache").glob("*.safetensors"))
    entry.write_bytes(entry.read_bytes()[:200])
    again = farmed(recipe(), client, tmp_path / "out")
    assert (again.baked, again.kept, again.made_up) == (1, COUNT + 1, 0)
    assert content(tmp_path / "out") == alone


def test_a_task_that_keeps_failing_ends_the_bake(client: Any, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="memory"):
        farmed(recipe(), client, tmp_path / "out", max_memory=1, retries=1)
    assert not (tmp_path / "out").exists()


def test_a_client_without_workers_is_refused(tmp_path: Path) -> None:
    with distributed.LocalCluster(
        n_workers=0, processes=True, dashboard_address=":0"
    ) as cluster, distributed.Client(cluster) as client:
        with pytest.raises(RuntimeError, match="no workers"):
            farmed(recipe(), client, tmp_path / "out")
