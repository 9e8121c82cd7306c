"""Bakes libraries of materials on a cluster of Dask workers.

What a library needs are parts that any process can bake by itself (`Need`). `bake` sends them to
the workers, keeps what they return, and puts the sets together: byte for byte what one machine
makes. Workers need this package, of the same version, and no files.

>>> from distributed import Client                           # doctest: +SKIP
>>> import microfacet.farm                                   # doctest: +SKIP
>>> client = Client("scheduler:8786")                        # doctest: +SKIP
>>> microfacet.farm.bake("library.toml", client, "library")  # doctest: +SKIP
"""

from __future__ import annotations

import asyncio
import os
import re
import tempfile
import time
import uuid
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, suppress
from dataclasses import dataclass
from itertools import compress, islice
from operator import not_
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias

from ._microfacet import Assembly, Library, Need, __version__, user_cache

try:
    from distributed import Client, as_completed, wait
except ImportError as _missing:
    raise ImportError(
        'microfacet.farm needs Dask: pip install "./clients/python[farm]"'
    ) from _missing

__all__ = ["Assembly", "Farmed", "Library", "Need", "bake", "libraries"]

#: A path of a recipe or scene, the text of a recipe, or materials as tables of a recipe's keys.
Scene: TypeAlias = str | PathLike[str] | Iterable[Mapping[str, Any]]

#: Most materials of one set, and of one step of a list that is read as it goes.
PER_SET = 10_000

#: A finished table as files: names and contents.
_Files: TypeAlias = list[tuple[str, bytes]]

_ENTRY = re.compile(r"[0-9a-f]{64}\.safetensors")

#: Tasks that are under way for each thread of the cluster: one at work, the others at hand.
_AHEAD = 3
#: Seconds after which the threads of the cluster are counted again.
_COUNT_AGAIN = 5.0


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
    import tomli_w

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
        except ValueError as why:
            raise ValueError(f"material {name!r}: {key}: {why}") from None
        except TypeError:
            kind = type(value).__name__
            raise TypeError(
                f"material {name!r}: {key} is a {kind}: give numbers, texts, lists or tables"
            ) from None
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
    goes: of a list of any length no more than per_set materials and what is under way are held.
    More than per_set materials, at most 10,000, become numbered sets with an index; ``Tables``
    opens both. What is in the folder is replaced as a whole at the end.

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
    folder = _folder(cache)
    _check(client, folder if shared else None)
    materials = tables = made_up = 0
    options = {
        "quality": quality,
        "precision": precision,
        "max_error": max_error,
        "albedo": albedo,
        "tabulate_ggx": tabulate_ggx,
        "per_set": per_set,
    }
    farm = _Farm(client, folder, shared, seconds_per_task, retries, max_memory, progress)
    with closing(Assembly(out)) as assembly, farm:
        for library in farm.ready(libraries(scene, **options)):
            count, fresh = assembly.add(library, folder, max_memory)
            materials += sum(map(len, library.sets))
            tables += count
            made_up += fresh
        if not materials:
            raise ValueError("there are no materials to bake for: none is in use")
        files = [Path(path) for path in assembly.finish()]
    seconds = time.monotonic() - start
    return Farmed(files, materials, tables, farm.baked, farm.kept, made_up, seconds)


def _folder(cache: str | PathLike[str] | None) -> Path:
    folder = user_cache() if cache is None else os.fspath(cache)
    if folder is None:
        raise ValueError("there is no home for finished tables: name a folder with cache=")
    Path(folder).mkdir(parents=True, exist_ok=True)
    return Path(folder).resolve()


def _check(client: Client, shared: Path | None) -> None:
    """That all workers have this version, and see a shared folder."""

    def version_there() -> str | None:
        # Sent as it is: a worker that lacks the package could not look it up.
        try:
            from microfacet import __version__ as version
        except ImportError:
            return None
        return version

    versions = client.run(version_there)
    if not versions:
        raise RuntimeError("the client has no workers: start some, such as `dask worker ADDRESS`")
    for worker, version in versions.items():
        if version != __version__:
            found = f"microfacet {version}" if version else "no package microfacet"
            raise RuntimeError(f"the worker {worker} has {found}: install {__version__} there")
    if shared is None:
        return
    token = shared / f".microfacet-farm-{uuid.uuid4().hex}"
    token.touch()
    try:
        for worker, sees in client.run(os.path.exists, os.fspath(token)).items():
            if not sees:
                raise RuntimeError(
                    f"the worker {worker} does not see {shared}: share that folder, or leave out"
                    " shared=True to have tables sent over the network"
                )
    finally:
        token.unlink()


def _work(texts: list[str], cache: str | None, max_memory: int) -> _Files:
    """What a worker does: bakes needs on one thread, and returns the files unless it shares them.

    A worker runs as many tasks at once as it has threads.
    """
    if cache is not None:
        for text in texts:
            Need(text).bake(Path(cache), 1, max_memory)
        return []
    files: _Files = []
    with tempfile.TemporaryDirectory(prefix="microfacet-farm-") as folder:
        for text in texts:
            Need(text).bake(Path(folder), 1, max_memory)
        for path in sorted(Path(folder).glob("*.safetensors")):
            files.append((path.name, path.read_bytes()))
    return files


class _Farm:
    """Needs under way on a cluster."""

    def __init__(
        self,
        client: Client,
        folder: Path,
        shared: bool,
        seconds: float,
        retries: int,
        max_memory: int,
        progress: bool,
    ) -> None:
        from tqdm.auto import tqdm

        self.client, self.folder, self.shared = client, folder, shared
        self.seconds, self.retries, self.max_memory = seconds, retries, max_memory
        self.baked = self.kept = 0
        self._seen: set[str] = set()
        # Of this client, whichever is the default.
        self._done = as_completed(loop=client.loop)
        self._current = ExitStack()
        #: The number of needs of each task under way, and the library that it is for.
        self._under_way: dict[str, tuple[int, int]] = {}
        #: The number of tasks under way for each library.
        self._open: dict[int, int] = {}
        self._threads, self._counted = 0, -_COUNT_AGAIN
        self._bar = tqdm(total=0, unit="part", disable=not progress, dynamic_ncols=True)

    def __enter__(self) -> _Farm:
        self._current.enter_context(self.client.as_current())
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()
        # After an error: what has begun is of no use, what is finished is kept.
        with suppress(Exception):
            self.client.cancel(list(self._done.futures))
        self._current.close()

    def ready(self, all: Iterable[Library]) -> Iterator[Library]:
        """The libraries in order, each as soon as what it needs is kept."""
        waiting: deque[tuple[int, Library]] = deque()
        for number, library in enumerate(all):
            waiting.append((number, library))
            for texts in self._tasks(library):
                self._submit(texts, number)
                while len(self._under_way) >= self._most():
                    self._take()
            # One more set is planned while the last is baked.
            while len(waiting) > 1:
                yield self._finished(*waiting.popleft())
        while waiting:
            yield self._finished(*waiting.popleft())

    def _finished(self, number: int, library: Library) -> Library:
        while self._open.get(number, 0):
            self._take()
        return library

    def _most(self) -> int:
        """The number of tasks to have under way; workers come and go."""
        now = time.monotonic()
        if now >= self._counted + _COUNT_AGAIN:
            self._threads = int(sum(self.client.nthreads().values()))
            self._counted = now
        return max(_AHEAD * self._threads, 2)

    def _tasks(self, library: Library) -> Iterator[list[str]]:
        """The needs that are neither kept nor under way, some seconds in each task."""
        texts: list[str] = []
        seconds = 0.0
        new = [need for need in library.needs() if need.id not in self._seen]
        self._seen.update(need.id for need in new)
        kept = [need.is_kept(self.folder) for need in new]
        self.kept += sum(kept)
        # What is kept counts as done, so that the bar shows how far the library is.
        self._bar.total += len(new)
        self._bar.update(sum(kept))
        self._bar.refresh()
        for need in compress(new, map(not_, kept)):
            texts.append(str(need))
            seconds += need.seconds
            if seconds >= self.seconds:
                yield texts
                texts, seconds = [], 0.0
        if texts:
            yield texts

    def _submit(self, texts: list[str], number: int) -> None:
        cache = os.fspath(self.folder) if self.shared else None
        key = f"microfacet-{uuid.uuid4().hex}"
        arguments = (texts, cache, self.max_memory)
        future = self.client.submit(_work, *arguments, key=key, retries=self.retries, pure=False)
        self._under_way[key] = (len(texts), number)
        self._open[number] = self._open.get(number, 0) + 1
        self._done.add(future)

    def _take(self) -> None:
        """Waits for a task, and keeps what it returns."""
        while not self._done.has_ready():
            # Until Python 3.11 they were two.
            with suppress(TimeoutError, asyncio.TimeoutError):
                wait(list(self._done.futures), timeout=_COUNT_AGAIN, return_when="FIRST_COMPLETED")
                break
            if not self.client.nthreads():
                self._bar.write("the cluster has no workers: waiting for some")
        future = next(self._done)
        for name, content in future.result():
            self._keep(name, content)
        count, number = self._under_way.pop(future.key)
        self._open[number] -= 1
        self.baked += count
        self._bar.update(count)

    def _keep(self, name: str, content: bytes) -> None:
        """Keeps a table; what is damaged counts as missing when it is read."""
        if not _ENTRY.fullmatch(name):
            raise RuntimeError(f"a worker returned a file named {name!r}")
        partial = self.folder / f".microfacet-bake-{uuid.uuid4().hex}.partial"
        try:
            partial.write_bytes(content)
            os.replace(partial, self.folder / name)
        finally:
            partial.unlink(missing_ok=True)
