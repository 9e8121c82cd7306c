"""The plugin ``student_t_plastic``: a rough dielectric coat over a diffuse base.

As ``crates/sampler/src/bsdf/plastic.rs``: the base receives the light that the coat transmits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import drjit as dr
import mitsuba as mi

from . import parameters
from .arithmetic import opaque
from .coat import Coat, Place, Shares
from .energy import Energy
from .fresnel import dielectric
from .reflection import white
from .shape import Lobe
from .spectra import blocked, spectrum
from .surface import round_of, surface_class

_NAMES = ("int_ior", "ext_ior", "diffuse_reflectance")

#: Why an anisotropic coat is refused.
_ANISOTROPIC = (
    "the light that a coat transmits is known of round lobes: set stand_in to true, and the round"
    " lobe of sqrt(sigma_u sigma_v) stands in, which gives the base too much or too little light;"
    " or give sigma_u and sigma_v the same number"
)


@dataclass
class Seen:
    """A plastic as a view has it."""

    lobe: Lobe
    sigma: mi.Vector2f
    place: Place
    shares: Shares
    #: What the base returns, and the mean of that.
    diffuse: mi.UnpolarizedSpectrum
    mean: mi.Float
    #: The probability of facets.
    facets: mi.Float
    #: Which components are asked for.
    coat: bool
    base: bool


def plastic_class() -> type:
    """The class of the plugin in the current variant."""
    glossy, diffuse = mi.BSDFFlags.GlossyReflection, mi.BSDFFlags.DiffuseReflection

    class StudentTPlastic(surface_class()):  # type: ignore[misc]
        """A dielectric coat, whose facets follow the Student-t distribution, over a Lambert base.

        The coat reflects F D G2/(4 cos cos), and the base, of albedo rho, returns
        T(v) T(l) rho/(pi eta^2 (1 - rho R)): T is what the coat transmits, and R what it reflects
        of diffuse light from inside. Black from below.
        """

        def __init__(self, props: mi.Properties) -> None:
            super().__init__(props, _NAMES)
            parameters.check_round(props, self._stand_in, _ANISOTROPIC)
            self._index = parameters.index(props)
            self._eta = opaque(self._index)
            base = parameters.reflectance(props, "diffuse_reflectance")
            self._base = props.get_texture("diffuse_reflectance", 0.5) if base is None else base
            flags = self._flags(mi.BSDFFlags.FrontSide)
            self.m_components = [glossy | flags, diffuse | flags]
            self.m_flags = self.m_components[0] | self.m_components[1]
            self._coat: Coat | None = None
            #: The roughness, if it is one, and gamma of the coat.
            self._of: tuple[float | None, float] | None = None
            self.parameters_changed()

        def parameters_changed(self, keys: Sequence[str] = ()) -> None:
            super().parameters_changed(keys)
            gamma = parameters.constant_gamma(self._gamma)
            if gamma is None:
                raise ValueError(
                    "gamma is a texture, and the light that a coat transmits is known for one: make"
                    " gamma a number"
                )
            none = self._compensation == "none"
            of = (self._round_sigma() if none else self._sigma_of_albedos(), gamma)
            if of == self._of:
                return
            self._of = of
            self._coat = Coat(
                self._made, of[0], self._index, self._compensation, self._accounts
            )

        def sample(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            sample1: mi.Float,
            sample2: mi.Point2f,
            active: mi.Bool = True,
        ) -> tuple[mi.BSDFSample3f, mi.Spectrum]:
            bs = dr.zeros(mi.BSDFSample3f)
            v = si.wi
            active = active & (v.z > 0) & dr.isfinite(dr.squared_norm(v))
            seen = self._seen(ctx, si, active)
            if not (seen.coat or seen.base):
                return bs, spectrum(mi.UnpolarizedSpectrum(0))
            assert self._coat is not None
            m = seen.lobe.sample_visible_normal(seen.sigma, v, sample2, active)
            is_facet = sample1 < seen.facets
            rest = (sample1 - seen.facets) / dr.maximum(1 - seen.facets, 1e-30)
            below = self._coat.sample(seen.place, seen.mean, rest, sample2, active)
            l = dr.select(is_facet, 2 * dr.dot(v, m) * m - v, below)
            m = dr.select(is_facet, m, dr.normalize(v + l))
            facing = dr.dot(v, m)
            active = active & (l.z > 0) & (facing > 0)
            value, pdf = self._both(si, seen, l, m, facing, active)
            bs.wo = l
            bs.pdf = dr.select(active, pdf, 0.0)
            bs.eta = 1.0
            bs.sampled_type = dr.select(is_facet, mi.UInt32(+glossy), mi.UInt32(+diffuse))
            bs.sampled_component = dr.select(is_facet, mi.UInt32(0), mi.UInt32(1))
            weight = value / dr.maximum(pdf, 1e-30)
            return bs, spectrum(blocked(weight, active & (pdf > 0)))

        def eval_pdf(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            wo: mi.Vector3f,
            active: mi.Bool = True,
        ) -> tuple[mi.Spectrum, mi.Float]:
            v = si.wi
            active = active & (v.z > 0) & (wo.z > 0)
            active = active & dr.isfinite(dr.squared_norm(v) + dr.squared_norm(wo))
            seen = self._seen(ctx, si, active)
            if not (seen.coat or seen.base):
                return spectrum(mi.UnpolarizedSpectrum(0)), mi.Float(0)
            # The cosine v.m is half the length of v + l.
            m = v + wo
            length = dr.sqrt(dr.maximum(dr.squared_norm(m), 1e-30))
            facing = dr.minimum(0.5 * length, 1)
            value, pdf = self._both(si, seen, wo, m / length, facing, active)
            return spectrum(blocked(value, active)), dr.select(active, pdf, 0.0)

        def _both(
            self,
            si: mi.SurfaceInteraction3f,
            seen: Seen,
            l: mi.Vector3f,
            m: mi.Vector3f,
            facing: mi.Float,
            active: mi.Bool,
        ) -> tuple[mi.UnpolarizedSpectrum, mi.Float]:
            """Value and density of the components that are asked for."""
            coat = self._coat
            assert coat is not None
            value, pdf = mi.UnpolarizedSpectrum(0), mi.Float(0)
            tint = mi.UnpolarizedSpectrum(1)
            if self._reflectance is not None:
                tint = self._reflectance.eval(si, active)
            if seen.coat:
                weight, density = white(
                    seen.lobe, seen.sigma, si.wi, l, m, self._correlated, active
                )
                factor = dielectric(self._eta, facing) * seen.shares.factor
                value, pdf = tint * (weight * factor * density), seen.facets * density
            if seen.base:
                cosine = dr.minimum(l.z, 1)
                there = coat.shares(seen.place, cosine, active)
                base = seen.shares.entering * there.entering * dr.inv_pi * seen.diffuse
                value = value + cosine * (base + tint * coat.returned(seen.shares, there))
                density = coat.pdf(seen.place, seen.mean, cosine, active)
                pdf = pdf + (1 - seen.facets) * density
            return value, pdf

        def _seen(
            self, ctx: mi.BSDFContext, si: mi.SurfaceInteraction3f, active: mi.Bool
        ) -> Seen:
            coat = self._coat
            assert coat is not None
            sigma = self._sigma(si, active)
            place = coat.place(round_of(sigma))
            shares = coat.shares(place, dr.clip(si.wi.z, 0, 1), active)
            base = dr.clip(self._base.eval(si, active), 0, 1)
            diffuse_part, mean = coat.diffuse(place, base, active)
            asked = ctx.is_enabled(glossy, 0), ctx.is_enabled(diffuse, 1)
            if all(asked):
                facets = coat.facets_share(place, shares, mean, active)
            else:
                facets = mi.Float(1.0 if asked[0] else 0.0)
            return Seen(self._lobe(si, active), sigma, place, shares, diffuse_part, mean, facets, *asked)

        def _made(self, sigma: float) -> Any:
            """The crate's plastic of a round coat."""
            import microfacet

            assert self._of is not None
            lobe = self._tables.student_t(sigma, self._of[1])
            form = {"masking": self._masking, "compensation": self._compensation}
            return microfacet.Plastic(lobe, self._index, 1.0, **form)

        def _accounts(self, sigma: float) -> Energy:
            """What a coat loses, from both sides."""
            assert self._of is not None
            form = (sigma, self._of[1], self._index, self._masking)
            return Energy(self._tables.dielectric_albedo(*form), self._index)

        def _textures(self) -> dict[str, mi.Texture]:
            return super()._textures() | {"diffuse_reflectance": self._base}

        def _round_sigma(self) -> float | None:
            highest = parameters.highest_sigma(self._compensation)
            return parameters.round_sigma(
                self._sigma_u, self._sigma_v, self._stand_in, highest, _ANISOTROPIC
            )

        def _described(self) -> dict[str, object]:
            return {"eta": self._eta}

    return StudentTPlastic
