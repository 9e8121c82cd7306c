"""What the plugins share: the lobe and its properties, and values and densities by one function."""

from __future__ import annotations

from collections.abc import Sequence

import drjit as dr
import mitsuba as mi

from . import parameters
from .family import Family
from .shape import Lobe, Shape

_NAMES = (
    "sigma", "sigma_u", "sigma_v", "gamma", "specular_reflectance", "compensation", "masking",
    "stand_in", "tables", "id",
)  # fmt: skip


def surface_class() -> type:
    """The class that the plugins derive from in the current variant."""

    class Surface(mi.BSDF):  # type: ignore[misc]
        """A surface whose facets follow the Student-t distribution; a plugin adds ``sample`` and
        ``eval_pdf``.
        """

        def __init__(self, props: mi.Properties, names: tuple[str, ...]) -> None:
            """``names``: the properties that only this plugin has."""
            mi.BSDF.__init__(self, props)
            parameters.check_names(props, _NAMES + names)
            self._gamma = parameters.gamma(props)
            self._bound_gamma = parameters.constant_gamma(self._gamma)
            self._compensation = parameters.compensation(props)
            self._masking = parameters.masking(props)
            self._correlated = self._masking == "height-correlated"
            self._sigma_u, self._sigma_v = parameters.sigmas(props)
            self._stand_in = parameters.flag(props, "stand_in")
            self._reflectance = parameters.reflectance(props, "specular_reflectance")
            self._tables = parameters.set_of_tables(props)
            self._is_built_in = not props.get("tables", "")
            self._of_all: Family | None = None
            # Gamma as it was loaded has tables of its own, which are faster.
            self._shape = None
            if self._bound_gamma is not None:
                self._shape = Shape(self._tables.shape(self._bound_gamma))
            else:
                self._family()
            if self._compensation != "none":
                parameters.check_albedos(props, self._stand_in)

        def eval(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            wo: mi.Vector3f,
            active: mi.Bool = True,
        ) -> mi.Spectrum:
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            wo: mi.Vector3f,
            active: mi.Bool = True,
        ) -> mi.Float:
            return self.eval_pdf(ctx, si, wo, active)[1]

        def parameters_changed(self, keys: Sequence[str] = ()) -> None:
            gamma = parameters.constant_gamma(self._gamma)
            self._is_bound = gamma is not None and gamma == self._bound_gamma
            self._gammas = parameters.range_of_gamma(self._gamma)

        def traverse(self, callback: mi.TraversalCallback) -> None:
            for name, texture in self._textures().items():
                flags = mi.ParamFlags.Differentiable
                if name.startswith(("sigma", "gamma")):
                    flags = flags | mi.ParamFlags.Discontinuous
                callback.put(name, texture, flags)

        def to_string(self) -> str:
            described = {
                "gamma": self._gamma,
                "sigma_u": self._sigma_u,
                "sigma_v": self._sigma_v,
                **self._described(),
                "masking": self._masking,
                "compensation": self._compensation,
            }
            lines = ",\n".join(f"  {name} = {value}" for name, value in described.items())
            return f"{type(self).__name__}[\n{lines}\n]"

        def _described(self) -> dict[str, object]:
            """What else ``to_string`` tells."""
            return {}

        def _textures(self) -> dict[str, mi.Texture]:
            """The textures that there are, by name."""
            if self._sigma_u is self._sigma_v:
                textures = {"sigma": self._sigma_u}
            else:
                textures = {"sigma_u": self._sigma_u, "sigma_v": self._sigma_v}
            textures["gamma"] = self._gamma
            if self._reflectance is not None:
                textures["specular_reflectance"] = self._reflectance
            return textures

        def _flags(self, sides: int) -> int:
            """Flags of all components of a surface that is seen from some sides."""
            if self._sigma_u is not self._sigma_v:
                sides = sides | mi.BSDFFlags.Anisotropic
            if any(texture.is_spatially_varying() for texture in self._textures().values()):
                sides = sides | mi.BSDFFlags.SpatiallyVarying
            return sides

        def _lobe(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> Lobe:
            """The lobe of gamma: of its own tables where they serve, which have no derivatives."""
            gamma = self._gamma.eval_1(si, active)
            if self._is_bound and not dr.grad_enabled(gamma):
                assert self._shape is not None
                return self._shape
            return self._family().at(gamma, *self._gammas)

        def _family(self) -> Family:
            if self._of_all is None:
                self._of_all = Family.of(self._tables, self._is_built_in)
            return self._of_all

        def _sigma(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> mi.Vector2f:
            """The roughness along u and v."""
            highest = parameters.highest_sigma(self._compensation)
            return parameters.sigma_at(self._sigma_u, self._sigma_v, si, active, highest)

        def _round_sigma(self) -> float | None:
            """The roughness of the round lobe that albedos are of, where it is the same everywhere."""
            return parameters.round_sigma(self._sigma_u, self._sigma_v, self._stand_in)

        def _sigma_of_albedos(self) -> float:
            """The same for albedos of one roughness and gamma; ``ValueError`` where either is a
            texture.
            """
            sigma = self._round_sigma()
            gamma = parameters.constant_gamma(self._gamma)
            for name, one in (("sigma", sigma), ("gamma", gamma)):
                if one is None:
                    raise ValueError(
                        f"compensation of a dielectric has albedos of one {name}, and {name} is a"
                        f" texture: make {name} a number, or set compensation to none"
                    )
            assert sigma is not None
            return sigma

    return Surface


def round_of(sigma: mi.Vector2f) -> mi.Float:
    """The roughness of the round lobe that stands in for an anisotropic one."""
    return dr.sqrt(sigma.x * sigma.y)
