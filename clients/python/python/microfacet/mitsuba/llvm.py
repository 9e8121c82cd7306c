"""Finds the library of LLVM that the variants ``llvm_*`` of Mitsuba compile with.

Dr.Jit, Mitsuba's compiler, looks in a few folders of Debian, or takes what ``DRJIT_LIBLLVM_PATH``
names. It reads that variable when it is imported. It accepts LLVM 15, which then ends the process
at the first picture on processors with AVX-512; so 16 is asked for here.
"""

from __future__ import annotations

import glob
import os
import re
import sys

#: The first version that works.
OLDEST = 16

_VARIABLE = "DRJIT_LIBLLVM_PATH"

_PLACES = {
    "linux": (
        "/usr/lib/*-linux-gnu/libLLVM*.so*",
        "/usr/lib/llvm-*/lib/libLLVM*.so*",
        "/usr/lib64/libLLVM*.so*",
        "/usr/lib64/llvm*/lib*/libLLVM*.so*",
        "/usr/lib/libLLVM*.so*",
        "/usr/lib/llvm*/lib/libLLVM*.so*",
        "/usr/local/lib/libLLVM*.so*",
        "{conda}/lib/libLLVM*.so*",
    ),
    "darwin": (
        "/opt/homebrew/opt/llvm*/lib/libLLVM*.dylib",
        "/usr/local/opt/llvm*/lib/libLLVM*.dylib",
        "/opt/local/libexec/llvm-*/lib/libLLVM*.dylib",
        "{conda}/lib/libLLVM*.dylib",
    ),
    "win32": (
        "C:/Program Files/LLVM/bin/LLVM-C.dll",
        "{conda}/Library/bin/LLVM*.dll",
    ),
}

HOW_TO_GET = (
    f"Install LLVM {OLDEST} or newer: on Debian and Ubuntu `apt install libllvm19`, on Fedora"
    " `dnf install llvm-libs`, on macOS `brew install llvm`, elsewhere from https://llvm.org; or"
    f" set {_VARIABLE} to the path of its library before Python starts."
)


def version_of(path: str) -> int | None:
    """The major version that the path of a library tells, following links; none if it does not."""
    real = os.path.realpath(path)
    name = re.search(r"LLVM(?:-C)?(?:-|\.so\.|\.)?(\d+)", os.path.basename(real))
    folder = re.search(r"llvm(?:@|-|/)?(\d+)", os.path.dirname(real))
    found = name or folder
    return int(found[1]) if found else None


def libraries(places: tuple[str, ...] | None = None) -> list[tuple[int, str]]:
    """The versions and paths of libraries that work, in usual places, the newest first."""
    if places is None:
        places = _PLACES.get(sys.platform, ())
    conda = os.environ.get("CONDA_PREFIX", "")
    paths = [
        path
        for place in places
        if conda or "{conda}" not in place
        for path in glob.glob(place.replace("{conda}", conda))
    ]
    found = [(version_of(path), path) for path in paths]
    works = [(version, path) for version, path in found if version and version >= OLDEST]
    return sorted(works, key=lambda pair: (-pair[0], len(pair[1]), pair[1]))


def _instead() -> str:
    """Names a library that works, if there is one."""
    found = libraries()
    return f" LLVM {found[0][0]} is {found[0][1]}." if found else ""


def prepare() -> None:
    """Tells Dr.Jit which library to take, if it is not loaded yet and has not been told.

    Raises ``ImportError`` where the variable names a version that does not work.
    """
    told = os.environ.get(_VARIABLE)
    if told is not None:
        version = version_of(told)
        if version is not None and version < OLDEST:
            raise ImportError(f"{_VARIABLE} = {told} is LLVM {version}.{_instead()} {HOW_TO_GET}")
    elif "drjit" not in sys.modules:
        found = libraries()
        if found:
            os.environ[_VARIABLE] = found[0][1]


def check() -> None:
    """Raises ``ImportError`` if Dr.Jit has no library of LLVM, saying how to get one."""
    import drjit as dr

    if dr.has_backend(dr.JitBackend.LLVM):
        version = dr.detail.llvm_version()
        if version[0] < OLDEST:
            raise ImportError(f"Dr.Jit has loaded LLVM {version[0]}. {HOW_TO_GET}")
        return
    found = libraries()
    if found and os.environ.get(_VARIABLE) is None:
        raise ImportError(
            f"Dr.Jit has not found {found[0][1]}, and looks only once: call"
            " microfacet.mitsuba.set_variant before mitsuba or drjit are imported, or set"
            f" {_VARIABLE} to this path before Python starts."
        )
    told = os.environ.get(_VARIABLE)
    if told is not None:
        raise ImportError(
            f"Dr.Jit found no library of LLVM: {_VARIABLE} = {told} cannot be loaded; correct or"
            f" unset it.{_instead()} {HOW_TO_GET}"
        )
    raise ImportError(f"Dr.Jit found no library of LLVM. {HOW_TO_GET}")
