"""Bakes libraries of materials on a cluster of Dask workers.

What a library needs are parts that any process can bake by itself (`Need`). `bake` sends them to
the workers, keeps what they return, and puts the sets together: byte for byte what one machine
makes. Workers need this package, of the same version, and no files.
"""

from __future__ import annotations

import os
import re
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, suppress
from dataclasses import dataclass
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias

from ._microfacet import Assembly, Library, Need, __version__, user_cache

try:
    import tomli_w
    from distributed import Client, Future, as_completed
    from tqdm.auto import tqdm
except ImportError as missing:
    raise ImportError(
        f'microfacet.farm needs {missing.name}: pip install "./clients/python[farm]"'
    ) from missing

__all__ = ["Assembly", "Farmed", "Library", "Need", "bake", "libraries"]

#: A path of a recipe or scene, the text of a recipe, or materials as tables of a recipe's keys.
Scene: TypeAlias = str | PathLike[str] | Iterable[Mapping[str, Any]]

#: Most materials of one set, and of one step of a list that is read as it goes.
PER_SET = 10_000


@dataclass(frozen=True)
class Farmed:
    """What a bake on a cluster did."""

    #: The files that were written: one set, or numbered sets and their index last.
    files: list[Path]
    #: The number of materials, and of tables that serve them.
    materials: int
    tables: int
    #: Needs (parts that are baked by themselves, each of some tables) that workers baked, and that
    #: were kept from before.
    baked: int
    kept: int
    #: Tables that were missing in the end all the same, so that they were baked here.
    made_up: int
    seconds: float


def libraries(scene: Scene, **options: Any) -> Iterator[Library]:
    """The libraries that a scene or a list of materials makes; each has whole sets.

    A list of any length is read as it goes, ``per_set`` materials at a time. The options are those
    of `bake`.
    """
    if isinstance(scene, (str, PathLike)):
        yield Library(scene, **options)
        return
    per_set = options.get("per_set", PER_SET)
    if not isinstance(per_set, int) or not 1 <= per_set <= PER_SET:
        raise ValueError(f"per_set is {per_set}: it must be a whole number in [1, {PER_SET}]")
    if isinstance(scene, Mapping) or not isinstance(scene, Iterable):
        raise TypeError(
            "scene must be a path, the text of a recipe or an iterable of materials, and is a"
            f" {type(scene).__name__}"
        )
    names: set[str] = set()
    materials = iter(scene)
    while part := list(islice(materials, per_set)):
        tables = []
        for material in part:
            tables.append(_table(material))
            # In one set the recipe's reader would say so; two may be a week apart.
            if material["name"] in names:
                raise ValueError(f"two materials are named {material['name']!r}: rename one")
            names.add(material["name"])
        try:
            library = Library(_recipe(tables), **options)
        except ValueError:
            # Lines of the text mean nothing to the caller: say whose they are.
            for table in tables:
                try:
                    Library(_recipe([table]), **options)
                except ValueError as why:
                    said = re.sub(r"^recipe:\d+:\d+: ", "", str(why))
                    raise ValueError(f"material {table['name']!r}: {said}") from None
            raise
        yield library


def _recipe(tables: list[dict[str, Any]]) -> str:
    """Materials as the text of a recipe.

    As one document, since TOML's ``[[material]]`` and ``material = [{...}]`` do not go together,
    and tomli_w writes either, by the length of the lines.
    """
    return tomli_w.dumps({"material": tables})


def _table(material: Mapping[str, Any]) -> dict[str, Any]:
    """A material as a table of values that TOML knows."""
    if not isinstance(material, Mapping):
        raise TypeError(
            "each material must be a table of a recipe's keys, such as"
            ' {"name": "gold", "sigma": 0.3, "gamma": 2.5}, and one is a'
            f" {type(material).__name__}"
        )
    name = material.get("name")
    if not isinstance(name, str) or not name:
        raise ValueError(f"a material's name is {name!r}: it must be a text that is not empty")
    plain = {}
    for key, value in material.items():
        if value is None:
            continue
        try:
            plain[key] = _plain(value)
            _recipe([{key: plain[key]}]).encode()
        except (TypeError, ValueError) as why:
            kind = TypeError if isinstance(why, TypeError) else ValueError
            raise kind(f"material {name!r}: {key}: {why}") from None
    return plain


def _plain(value: Any) -> Any:
    """A value without NumPy's types, which TOML does not know."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def bake(
    scene: Scene,
    client: Client,
    out: str | PathLike[str],
    *,
    cache: str | PathLike[str] | None = None,
    shared: bool = False,
    quality: Literal["draft", "default", "high"] = "default",
    precision: Literal["f32", "f16", "u16"] = "f32",
    max_error: float | None = None,
    albedo: bool | None = None,
    tabulate_ggx: bool = False,
    per_set: int = PER_SET,
    max_memory: int = 4 << 30,
    seconds_per_task: float = 10.0,
    retries: int = 3,
    progress: bool = True,
) -> Farmed:
    """Bakes a library on the workers of a Dask client, into the folder out.

    scene is a path (.toml, .pbrt, .xml, .gltf, .glb, .mtlx), the text of a recipe, or any iterable
    of materials, each a mapping with the keys of a recipe (docs/recipe.md), which is read as it
    goes: no more than two sets are under way. More than per_set materials, at most 10,000, become
    numbered sets with an index; ``Tables`` opens both. What is in the folder is replaced as a whole
    at the end.

    Finished tables are kept in the folder cache, by default the user's, so that a bake that ended
    early goes on from there. Workers return them over the network, or with shared=True write them
    into that folder, which then must be the same on all machines. Each task has needs of about
    seconds_per_task by the planner's estimate, on one thread, and is tried again up to retries
    times; what is lost with a worker is baked by another. After an interrupt, tasks that have not
    ended are lost (with shared=True only the need at hand). The options of quality are those of
    `microfacet.bake`.

    Raises what a worker raised if a task keeps failing, and RuntimeError if a worker has another
    version of this package or does not see a shared folder.
    """
    if not seconds_per_task > 0.0:
        raise ValueError(f"seconds_per_task is {seconds_per_task}: it must be above 0")
    if retries < 0:
        raise ValueError(f"retries is {retries}: it must be 0 or more")
    start = time.monotonic()
    home = cache or user_cache()
    if home is None:
        raise ValueError("there is no home for finished tables: name a folder with cache=")
    folder = Path(home).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    _check(client, folder if shared else None)
    planned = libraries(
        scene,
        quality=quality,
        precision=precision,
        max_error=max_error,
        albedo=albedo,
        tabulate_ggx=tabulate_ggx,
        per_set=per_set,
    )
    options = {
        "cache": os.fspath(folder) if shared else None,
        "max_memory": max_memory,
        "retries": retries,
    }
    materials = tables = made_up = 0
    farm = _Farm(client, folder, seconds_per_task, options, progress)
    with client.as_current(), closing(Assembly(out)) as assembly, closing(farm):
        for library in farm.ready(planned):
            count, fresh = assembly.add(library, folder, max_memory)
            materials += sum(map(len, library.sets))
            tables += count
            made_up += fresh
        if not materials:
            raise ValueError("there are no materials to bake for: none is in use")
        files = [Path(path) for path in assembly.finish()]
    seconds = time.monotonic() - start
    return Farmed(files, materials, tables, farm.baked, farm.kept, made_up, seconds)


def _check(client: Client, shared: Path | None) -> None:
    """That all workers have this version, and see a shared folder."""
    workers = client.get_versions(packages=["microfacet"])["workers"]
    if not workers:
        raise RuntimeError("the client has no workers: start some, such as `dask worker ADDRESS`")
    for worker, found in workers.items():
        version = found["packages"]["microfacet"] or "of no version"
        if version != __version__:
            raise RuntimeError(
                f"the worker {worker} has microfacet {version}: install {__version__} there"
            )
    if shared is None:
        return
    with tempfile.NamedTemporaryFile(dir=shared, prefix=".microfacet-farm-") as token:
        seen = client.run(os.path.exists, token.name)
    for worker, sees in seen.items():
        if not sees:
            raise RuntimeError(
                f"the worker {worker} does not see {shared}: share that folder, or leave out"
                " shared=True to have tables sent over the network"
            )


def _work(texts: list[str], cache: str | None, max_memory: int) -> list[tuple[str, bytes]]:
    """What a worker does: bakes needs on one thread, and returns the files unless it shares them.

    A worker runs as many tasks at once as it has threads.
    """
    with tempfile.TemporaryDirectory(prefix="microfacet-farm-") as own:
        for text in texts:
            Need(text).bake(cache or own, 1, max_memory)
        return [(path.name, path.read_bytes()) for path in Path(own).glob("*.safetensors")]


class _Farm:
    """Needs under way on a cluster."""

    def __init__(
        self, client: Client, folder: Path, seconds: float, options: dict[str, Any], progress: bool
    ) -> None:
        self.client, self.folder, self.seconds, self.options = client, folder, seconds, options
        self.baked = self.kept = 0
        self._seen: set[str] = set()
        #: The tasks under way, and the number of needs of each.
        self._under_way: dict[Future, int] = {}
        self._bar = tqdm(total=0, unit="part", disable=not progress, dynamic_ncols=True)

    def close(self) -> None:
        """After an error: what has begun is of no use, what is finished is kept."""
        self._bar.close()
        with suppress(Exception):
            self.client.cancel(list(self._under_way))

    def ready(self, planned: Iterable[Library]) -> Iterator[Library]:
        """The libraries in order, each as soon as what it needs is kept."""
        last = None
        for library in planned:
            tasks = self._send(library)
            # One more set is planned while the last is baked.
            if last:
                yield self._received(*last)
            last = library, tasks
        if last:
            yield self._received(*last)

    def _send(self, library: Library) -> list[Future]:
        """Makes tasks of the needs that are neither kept nor under way."""
        new = [need for need in library.needs() if need.id not in self._seen]
        self._seen.update(need.id for need in new)
        missing = [need for need in new if not need.is_kept(self.folder)]
        kept = len(new) - len(missing)
        self.kept += kept
        # What is kept counts as done, so that the bar shows how far the library is.
        self._bar.total += len(new)
        self._bar.update(kept)
        texts: list[list[str]] = []
        seconds = self.seconds
        for need in missing:
            if seconds >= self.seconds:
                texts.append([])
                seconds = 0.0
            texts[-1].append(str(need))
            seconds += need.seconds
        tasks: list[Future] = self.client.map(_work, texts, pure=False, **self.options)
        self._under_way |= zip(tasks, map(len, texts), strict=True)
        return tasks

    def _received(self, library: Library, tasks: list[Future]) -> Library:
        """The library, when what its tasks return is kept."""
        for task in as_completed(tasks):
            for name, content in task.result():
                # Renamed, so that nobody reads half of it; what is damaged counts as missing.
                partial = self.folder / f".microfacet-bake-{task.key}.partial"
                partial.write_bytes(content)
                partial.replace(self.folder / name)
            count = self._under_way.pop(task)
            # The cluster need not keep it as well.
            task.release()
            self.baked += count
            self._bar.update(count)
        return library
