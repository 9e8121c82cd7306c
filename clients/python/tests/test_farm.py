"""Libraries on a real cluster of Dask: two worker processes, one of them killed on the way."""

from __future__ import annotations

import os
import pickle
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
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


RECIPE = "".join(
    f'[[material]]\nname = "{m["name"]}"\nsigma = {m["sigma"]}\ngamma = {m["gamma"]}\n'
    'fresnel = "mirror"\n'
    for m in materials()
)


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@contextmanager
def cluster(workers: int) -> Iterator[Any]:
    options = {"threads_per_worker": 1, "dashboard_address": ":0"}
    with distributed.LocalCluster(n_workers=workers, **options) as cluster:
        with distributed.Client(cluster, set_as_default=False) as client:
            yield client


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with cluster(2) as client:
        yield client


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What one process makes, with no cache."""
    out = tmp_path_factory.mktemp("alone")
    microfacet.bake(RECIPE, out / "set", quality="draft", cache=False)
    return content(out / "set")


def farmed(scene: farm.Scene, client: Any, out: Path, **options: Any) -> farm.Farmed:
    options = {"quality": "draft", "cache": out.parent / "cache", "progress": False} | options
    return farm.bake(scene, client, out, **options)


@pytest.mark.parametrize("shared", [False, True])
def test_the_bytes_are_those_of_one_process(
    client: Any, alone: dict[str, bytes], tmp_path: Path, shared: bool
) -> None:
    done = farmed(RECIPE, client, tmp_path / "out", shared=shared, seconds_per_task=0.2)
    assert (done.materials, done.baked, done.kept, done.made_up) == (COUNT, COUNT + 2, 0, 0)
    assert content(tmp_path / "out") == alone
    again = farmed(RECIPE, client, tmp_path / "out", shared=shared)
    assert (again.baked, again.kept, again.made_up) == (0, COUNT + 2, 0)
    assert content(tmp_path / "out") == alone


def test_a_worker_that_is_killed_loses_nothing(client: Any, tmp_path: Path) -> None:
    process = min(client.run(os.getpid).values())

    def kill_on_the_way() -> Iterator[dict[str, Any]]:
        *most, last = materials()
        yield from most
        # Tasks of the first sets are under way.
        time.sleep(0.3)
        os.kill(process, signal.SIGKILL)
        yield last

    farmed(kill_on_the_way(), client, tmp_path / "out", per_set=2, seconds_per_task=0.01)
    assert process not in client.run(os.getpid).values()
    names = [material["name"] for material in materials()]
    assert microfacet.Tables(tmp_path / "out").materials == names
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


#: Values of all kinds, keys in any order, names of any length and characters.
SHAPES = r'''
{ name = "m", sigma = 0.1, gamma = 2.3 }
{ sigma = 0.1, name = "short", gamma = 2.3 }
{ name = "LONG", sigma = 0.1, gamma = 2.3 }
{ name = "a 'b' \\ \"c\" # [[material]]", gamma = { min = 3.0, max = 4 }, sigma = 0 }
{ name = "\n[[material]]\r\n", sigma = [{ min = 0.1, max = 0.2 }, 0.3], gamma = "inf" }
{ name = "м漢\u0085\u0000", gamma = inf, sigma = { min = 0.1, max = 0.2 }, fresnel = "mirror" }
{ fresnel = { schlick = 0.04 }, name = "plastic", sigma = [0.3, 0.2], gamma = 3 }
{ name = "word", fresnel = { metal = "gold" }, distribution = "beckmann", m = 0.25 }
{ distribution = "gauss", m = 0.3, name = "gauss LONG", masking = "uncorrelated" }
{ name = "number", sigma = 0.3, distribution = "student-t", gamma = 1e20 }
{ fresnel = { conductor = { eta = [0.1, 1, 2], k = [4, 2.4, 2] } }, name = "c", sigma = 1, gamma = 3 }
{ name = "tilted", theta = [3, -6.5, 30], sigma = 0.3, gamma = 2.5 }
{ theta = [3, -6.5, 30], name = "t", sigma = [0.4, 0.2], degrees = true, gamma = 2.5 }
'''.replace("LONG", "n" * 120).strip().splitlines()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_materials_of_all_shapes_are_those_of_a_recipe() -> None:
    tomllib = pytest.importorskip("tomllib", reason="Python 3.11 has it")
    # Each alone, in pairs, and all.
    for shapes in [*(dict.fromkeys([a, b]) for a in SHAPES for b in SHAPES), SHAPES]:
        text = f"material = [{', '.join(shapes)}]\n"
        want = farm.Library(text)
        (have,) = farm.libraries(tomllib.loads(text)["material"])
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


BAD = {"name": "bad", "sigma": 0.3, "gamma": 1.2}


@pytest.mark.parametrize(("error", "match", "scene", "options"), [
    (ValueError, "two materials are named", [*materials(2), *materials(1)], {"per_set": 2}),
    (TypeError, "each material must be a table", ["gold"], {}),
    (ValueError, "seconds_per_task is 0", RECIPE, {"seconds_per_task": 0}),
    (ValueError, "retries is -1", RECIPE, {"retries": -1}),
    (ValueError, r"in \[1, 10000\]", RECIPE, {"per_set": 0}),
    (ValueError, r"in \[1, 10000\]", [BAD], {"per_set": 2.5}),
    (TypeError, "and is a dict", BAD, {}),
    (TypeError, "and is a int", 3, {}),
    (ValueError, "no materials", [], {}),
    (ValueError, "^material 'bad': gamma = 1.2 is", [*materials(4), BAD], {"per_set": 2}),
    (ValueError, "^material 'bad': unknown key", [BAD | {"gamma": 3, "department": "fx"}], {}),
    (ValueError, "name is None", [{"sigma": 0.3, "gamma": 3.0}], {}),
    (TypeError, "^material 'bad': sigma: .*'object'", [BAD | {"sigma": object()}], {}),
    (ValueError, "^material 'bad': masking: .*surrogates", [BAD | {"masking": "\ud800"}], {}),
    (ValueError, "^material 'bad': sigma: .*limit", [BAD | {"sigma": 10**5000}], {}),
    # A task that keeps failing.
    (RuntimeError, "memory", RECIPE, {"max_memory": 1, "retries": 1}),
])
def test_what_is_wrong_is_said(
    client: Any, tmp_path: Path, error: type[Exception], match: str, scene: Any, options: Any
) -> None:
    with pytest.raises(error, match=match):
        farmed(scene, client, tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def test_workers_of_another_version_are_refused(
    client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(farm, "__version__", "0.0.9")
    with pytest.raises(RuntimeError, match="the worker .* has microfacet .*: install 0.0.9 there"):
        farmed(RECIPE, client, tmp_path / "out")


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
    farmed(RECIPE, client, tmp_path / "out")
    entry = max((tmp_path / "cache").glob("*.safetensors"))
    entry.write_bytes(entry.read_bytes()[:200])
    again = farmed(RECIPE, client, tmp_path / "out")
    assert (again.baked, again.kept, again.made_up) == (1, COUNT + 1, 0)
    assert content(tmp_path / "out") == alone


def test_a_client_without_workers_is_refused(tmp_path: Path) -> None:
    with cluster(0) as client, pytest.raises(RuntimeError, match="no workers"):
        farmed(RECIPE, client, tmp_path / "out")
