"""What the plugins share: the lobe and its properties, and values and densities by one function."""

from __future__ import annotations

import drjit as dr
import mitsuba as mi

from . import parameters
from .shape import Shape

_NAMES = (
    "sigma", "sigma_x", "sigma_y", "gamma", "specular_reflectance", "compensation", "masking",
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
            self._compensation = parameters.compensation(props)
            self._masking = parameters.masking(props)
            self._correlated = self._masking == "height-correlated"
            self._sigma_x, self._sigma_y = parameters.sigmas(props)
            self._stand_in = parameters.flag(props, "stand_in")
            self._reflectance = parameters.reflectance(props, "specular_reflectance")
            self._tables = parameters.set_of_tables(props)
            self._of_gamma = self._tables.shape(self._gamma)
            self._shape = Shape(self._of_gamma)
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

        def traverse(self, callback: mi.TraversalCallback) -> None:
            for name, texture in self._textures().items():
                flags = mi.ParamFlags.Differentiable
                if name.startswith("sigma"):
                    flags = flags | mi.ParamFlags.Discontinuous
                callback.put(name, texture, flags)

        def to_string(self) -> str:
            described = {
                "gamma": f"{self._gamma:g}",
                "sigma_x": self._sigma_x,
                "sigma_y": self._sigma_y,
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
            if self._sigma_x is self._sigma_y:
                textures = {"sigma": self._sigma_x}
            else:
                textures = {"sigma_x": self._sigma_x, "sigma_y": self._sigma_y}
            if self._reflectance is not None:
                textures["specular_reflectance"] = self._reflectance
            return textures

        def _flags(self, sides: int) -> int:
            """Flags of all components of a surface that is seen from some sides."""
            if self._sigma_x is not self._sigma_y:
                sides = sides | mi.BSDFFlags.Anisotropic
            if any(texture.is_spatially_varying() for texture in self._textures().values()):
                sides = sides | mi.BSDFFlags.SpatiallyVarying
            return sides

        def _sigma(self, si: mi.SurfaceInteraction3f, active: mi.Bool) -> mi.Vector2f:
            """The roughness along x and y."""
            highest = parameters.highest_sigma(self._compensation)
            return parameters.sigma_at(self._sigma_x, self._sigma_y, si, active, highest)

        def _round_sigma(self) -> float | None:
            """The roughness of the round lobe that albedos are of, where it is the same everywhere."""
            return parameters.round_sigma(self._sigma_x, self._sigma_y, self._stand_in)

        def _sigma_of_albedos(self) -> float:
            """The same for albedos of one roughness; ``ValueError`` where it is a texture."""
            sigma = self._round_sigma()
            if sigma is None:
                raise ValueError(
                    "compensation of a dielectric has albedos of one roughness, and sigma is a"
                    " texture: make sigma a number, or set compensation to none"
                )
            return sigma

    return Surface


def round_of(sigma: mi.Vector2f) -> mi.Float:
    """The roughness of the round lobe that stands in for an anisotropic one."""
    return dr.sqrt(sigma.x * sigma.y)
