"""Types of the extension module; its docstrings are at run time."""

from os import PathLike
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

__all__ = [
    "Assembly",
    "Bsdf",
    "BsdfSample",
    "Conductor",
    "Dielectric",
    "DielectricAlbedo",
    "Ellipsoid",
    "Haze",
    "Library",
    "Lobe",
    "Need",
    "Plastic",
    "Retroreflective",
    "Shape",
    "StudentT",
    "Tables",
    "bake",
    "inspect",
    "user_cache",
    "ExactLobe",
    "ExactStudentT",
    "ExactEllipsoid",
    "__version__",
]

__version__: str

_Array: TypeAlias = NDArray[np.float32]
_Array64: TypeAlias = NDArray[np.float64]
#: A number of one lobe, or an array of many; likewise a flag.
_Number: TypeAlias = Any
_Flag: TypeAlias = Any
#: One roughness, or those along x and y.
_Sigma: TypeAlias = ArrayLike | tuple[ArrayLike, ArrayLike]
_Masking: TypeAlias = Literal["height-correlated", "uncorrelated"]
_Compensation: TypeAlias = Literal["none", "turquin", "kulla-conty", "kulla_conty"]
_Transport: TypeAlias = Literal["radiance", "importance"]
_Path: TypeAlias = str | PathLike[str]

@disjoint_base
class Lobe:
    @property
    def is_effectively_smooth(self) -> _Flag: ...
    def d(self, m: ArrayLike) -> _Array: ...
    def g1(self, v: ArrayLike) -> _Array: ...
    def lambda_(self, v: ArrayLike) -> _Array: ...
    def g2(self, v: ArrayLike, l: ArrayLike, masking: _Masking = "height-correlated") -> _Array: ...
    def sample_visible_normal(self, v: ArrayLike, u: ArrayLike) -> _Array: ...
    def visible_normal_pdf(self, v: ArrayLike, m: ArrayLike) -> _Array: ...
    def reflection_weight(
        self, v: ArrayLike, l: ArrayLike, masking: _Masking = "height-correlated"
    ) -> _Array: ...
    def albedo(
        self,
        v: ArrayLike | None = None,
        masking: _Masking = "height-correlated",
        *,
        cos_theta: ArrayLike | None = None,
        stand_in: bool = False,
    ) -> _Array: ...
    def albedo_parts(
        self,
        v: ArrayLike | None = None,
        masking: _Masking = "height-correlated",
        *,
        cos_theta: ArrayLike | None = None,
        stand_in: bool = False,
    ) -> _Array: ...
    def albedo_average(
        self, masking: _Masking = "height-correlated", *, stand_in: bool = False
    ) -> _Number: ...
    def albedo_average_parts(
        self, masking: _Masking = "height-correlated", *, stand_in: bool = False
    ) -> _Array: ...
    def _seconds_in_rust(self, v: _Array, u: _Array) -> float: ...

@final
class StudentT(Lobe):
    def __new__(
        cls,
        sigma: _Sigma | None = None,
        gamma: ArrayLike | None = None,
        *,
        sigma_x: ArrayLike | None = None,
        sigma_y: ArrayLike | None = None,
    ) -> StudentT: ...
    @property
    def sigma(self) -> tuple[_Number, _Number]: ...
    @property
    def gamma(self) -> _Number: ...
    @property
    def batch_shape(self) -> tuple[int, ...]: ...

@final
class Ellipsoid(Lobe):
    def __new__(cls, sigma: ArrayLike, theta: ArrayLike, gamma: float) -> Ellipsoid: ...

@final
class Tables:
    def __new__(
        cls, path: _Path | None = None, materials: list[str] | None = None
    ) -> Tables: ...
    @property
    def materials(self) -> list[str]: ...
    def student_t(
        self,
        sigma: _Sigma | None = None,
        gamma: ArrayLike | None = None,
        *,
        sigma_x: ArrayLike | None = None,
        sigma_y: ArrayLike | None = None,
    ) -> StudentT: ...
    def ellipsoid(self, sigma: ArrayLike, theta: ArrayLike, gamma: float) -> Ellipsoid: ...
    def material(self, name: str) -> Lobe: ...
    def bsdf(
        self, name: str, compensation: _Compensation = "none", *, stand_in: bool = False
    ) -> Bsdf: ...
    def covers(self, gamma: float) -> bool: ...
    def dielectric_albedo(
        self, sigma: float, gamma: float, eta: float, masking: _Masking = "height-correlated"
    ) -> DielectricAlbedo: ...
    def shape(self, gamma: float) -> Shape: ...
    def describe(self) -> dict[str, Any]: ...
    def write(self, folder: _Path) -> None: ...
    @staticmethod
    def _of_bytes(bytes: bytes, origin: str) -> Tables: ...

@final
class Shape:
    @property
    def gamma(self) -> float: ...
    @property
    def members(self) -> dict[str, float]: ...
    @property
    def tables(self) -> dict[str, _Array]: ...

@final
class DielectricAlbedo:
    def shares(self, cos_theta: ArrayLike, side: Literal["outside", "inside"]) -> _Array: ...

@final
class BsdfSample:
    @property
    def l(self) -> _Array: ...
    @property
    def weight(self) -> _Array: ...
    @property
    def pdf(self) -> _Array: ...
    @property
    def eta(self) -> _Array: ...
    @property
    def transmitted(self) -> NDArray[np.bool_]: ...
    @property
    def delta(self) -> NDArray[np.bool_]: ...

@disjoint_base
class Bsdf:
    @property
    def is_delta(self) -> _Flag: ...
    def eval(self, v: ArrayLike, l: ArrayLike, transport: _Transport = "radiance") -> _Array: ...
    def pdf(self, v: ArrayLike, l: ArrayLike) -> _Array: ...
    def sample(
        self, v: ArrayLike, choice: ArrayLike, u: ArrayLike, transport: _Transport = "radiance"
    ) -> BsdfSample: ...

@final
class Conductor(Bsdf):
    def __new__(
        cls,
        lobe: Lobe,
        *,
        f0: ArrayLike | None = None,
        f82: ArrayLike | None = None,
        eta: ArrayLike | None = None,
        k: ArrayLike | None = None,
        metal: str | None = None,
        masking: _Masking = "height-correlated",
        compensation: _Compensation = "none",
        stand_in: bool = False,
    ) -> Conductor: ...

@final
class Dielectric(Bsdf):
    def __new__(
        cls,
        lobe: Lobe,
        eta: float,
        *,
        masking: _Masking = "height-correlated",
        compensation: _Compensation = "none",
        stand_in: bool = False,
    ) -> Dielectric: ...

@final
class Plastic(Bsdf):
    def __new__(
        cls,
        lobe: Lobe,
        eta: float,
        base: ArrayLike,
        *,
        masking: _Masking = "height-correlated",
        compensation: _Compensation = "none",
        stand_in: bool = False,
    ) -> Plastic: ...
    @property
    def leaving(self) -> float: ...
    def coat_shares(self, v: ArrayLike) -> _Array: ...

@final
class Haze(Bsdf):
    def __new__(cls, core: Bsdf, haze: Bsdf, weight: ArrayLike) -> Haze: ...
    @property
    def core(self) -> Bsdf: ...
    @property
    def haze(self) -> Bsdf: ...
    @property
    def weight(self) -> _Number: ...

@final
class Retroreflective(Bsdf):
    def __new__(cls, bsdf: Bsdf, share: ArrayLike) -> Retroreflective: ...
    @property
    def bsdf(self) -> Bsdf: ...
    @property
    def share(self) -> _Number: ...

@final
class Need:
    def __new__(cls, text: str) -> Need: ...
    def __getnewargs__(self) -> tuple[str]: ...
    @property
    def id(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def seconds(self) -> float: ...
    def is_kept(self, cache: _Path) -> bool: ...
    def bake(self, cache: _Path, threads: int = 1, max_memory: int = ...) -> bool: ...

@final
class Library:
    def __new__(
        cls,
        scene: _Path,
        *,
        quality: str = "default",
        precision: str = "f32",
        max_error: float | None = None,
        albedo: bool | None = None,
        tabulate_ggx: bool = False,
        per_set: int = ...,
    ) -> Library: ...
    @property
    def sets(self) -> list[list[str]]: ...
    def needs(self) -> list[Need]: ...

@final
class Assembly:
    def __new__(cls, out: _Path) -> Assembly: ...
    def add(self, library: Library, cache: _Path, max_memory: int) -> tuple[int, int]: ...
    def close(self) -> None: ...
    def finish(self) -> list[PathLike[str]]: ...

def user_cache() -> PathLike[str] | None: ...
def bake(
    recipe: _Path | None = None,
    out: _Path | None = None,
    *,
    quality: Literal["draft", "default", "high"] = "default",
    precision: Literal["f32", "f16", "u16"] = "f32",
    max_error: float | None = None,
    max_bytes: int | None = None,
    albedo: bool | None = None,
    tabulate_ggx: bool = False,
    cache: bool | _Path | None = None,
    max_memory: int = ...,
) -> Tables: ...
def inspect(path: _Path | None = None) -> dict[str, Any]: ...

@disjoint_base
class ExactLobe:
    def d(self, m: ArrayLike) -> _Array64: ...
    def g1(self, v: ArrayLike) -> _Array64: ...
    def lambda_(self, v: ArrayLike) -> _Array64: ...
    def g2(
        self, v: ArrayLike, l: ArrayLike, masking: _Masking = "height-correlated"
    ) -> _Array64: ...
    def sample_visible_normal(self, v: ArrayLike, u: ArrayLike) -> _Array64: ...
    def visible_normal_pdf(self, v: ArrayLike, m: ArrayLike) -> _Array64: ...
    def albedo(
        self,
        v: ArrayLike | None = None,
        masking: _Masking = "height-correlated",
        *,
        cos_theta: ArrayLike | None = None,
    ) -> _Array64: ...
    def albedo_parts(
        self,
        v: ArrayLike | None = None,
        masking: _Masking = "height-correlated",
        *,
        cos_theta: ArrayLike | None = None,
    ) -> _Array64: ...
    def albedo_average(self, masking: _Masking = "height-correlated") -> _Number: ...
    def reflection_weight(
        self, v: ArrayLike, l: ArrayLike, masking: _Masking = "height-correlated"
    ) -> _Array64: ...

@final
class ExactStudentT(ExactLobe):
    def __new__(
        cls,
        sigma: _Sigma | None = None,
        gamma: ArrayLike | None = None,
        *,
        sigma_x: ArrayLike | None = None,
        sigma_y: ArrayLike | None = None,
    ) -> ExactStudentT: ...
    @property
    def sigma(self) -> tuple[_Number, _Number]: ...
    @property
    def gamma(self) -> _Number: ...
    @property
    def batch_shape(self) -> tuple[int, ...]: ...

@final
class ExactEllipsoid(ExactLobe):
    def __new__(cls, sigma: ArrayLike, theta: ArrayLike, gamma: float) -> ExactEllipsoid: ...
    @property
    def gamma(self) -> float: ...
