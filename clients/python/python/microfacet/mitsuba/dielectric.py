"""The plugin ``student_t_dielectric``: a rough interface between two transparent media.

As ``crates/sampler/src/bsdf/dielectric.rs``: every facet reflects F of the light and refracts the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import drjit as dr
import mitsuba as mi

from . import parameters
from .arithmetic import LARGEST_DENSITY
from .compensation import kulla_conty, turquin
from .energy import Energy
from .interface import Facet, between, drawn, either, steep
from .shape import Lobe, g2_over_g1
from .spectra import blocked, spectrum
from .surface import surface_class

_NAMES = ("int_ior", "ext_ior", "specular_transmittance")


@dataclass
class Seen:
    """A view taken above the surface, and the interface as it is seen from there."""

    v: mi.Vector3f
    #: 1 for a view from above, else -1; and 0 for one from above, else 1.
    sign: mi.Float
    below: mi.UInt32
    #: The index of refraction beyond the interface over that on the side of the view.
    eta: mi.Float
    #: The factor on transmitted light: (n_v/n_l)^2 of radiance, 1 of importance.
    scale: mi.Float
    sigma: mi.Vector2f
    lobe: Lobe
    #: Whether the density of refracted light has poles.
    has_pole: bool | mi.Bool
    #: Which events are asked for.
    reflects: bool
    transmits: bool

    def chance(self) -> mi.Float | None:
        """The chance of reflection, if it is not the reflectance."""
        if self.reflects and self.transmits:
            return None
        return mi.Float(1.0 if self.reflects else 0.0)


def dielectric_class() -> type:
    """The class of the plugin in the current variant."""
    reflection, transmission, only_sampled = (
        mi.BSDFFlags.GlossyReflection,
        mi.BSDFFlags.GlossyTransmission,
        mi.BSDFFlags.DeltaTransmission,
    )

    class StudentTDielectric(surface_class()):  # type: ignore[misc]
        """A dielectric whose facets follow the Student-t distribution.

        Seen from either side the microsurface is the same: a direction below is taken through the
        point reflection v -> -v, which leaves the facets in place. Facets are drawn by visible
        normals and events by F, so a sample's weight is G2/G1, for refracted radiance times
        (n_v/n_l)^2. For gamma < 2 what facets next to the horizon refract is only sampled, as a
        delta: single precision does not tell them from view and light.
        """

        def __init__(self, props: mi.Properties) -> None:
            super().__init__(props, _NAMES)
            self._index = parameters.index(props)
            self._eta = mi.Float(self._index)
            self._transmittance = parameters.reflectance(props, "specular_transmittance")
            if self._compensation != "none":
                self._sigma_of_albedos()
            self._energy: Energy | None = None
            self.parameters_changed()

        def traverse(self, callback: mi.TraversalCallback) -> None:
            super().traverse(callback)
            # A compensated surface has albedos of one index.
            if self._compensation == "none" and dr.is_jit_v(mi.Float):
                flags = mi.ParamFlags.Differentiable | mi.ParamFlags.Discontinuous
                callback.put("eta", self._eta, flags)

        def parameters_changed(self, keys: Sequence[str] = ()) -> None:
            super().parameters_changed(keys)
            gamma = parameters.constant_gamma(self._gamma)
            sides = self._flags(mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide)
            has_pole = gamma is None or gamma < 2
            refraction = transmission | only_sampled if has_pole else transmission
            self.m_components = [
                reflection | sides,
                refraction | sides | mi.BSDFFlags.NonSymmetric,
            ]
            self.m_flags = self.m_components[0] | self.m_components[1]
            if self._compensation == "none":
                eta = parameters.value(self._eta)
                parameters.check_index(eta, f"eta = {eta:g}")
                # Another index compiles no other kernel.
                if dr.is_jit_v(mi.Float):
                    dr.make_opaque(self._eta)
                return
            sigma = self._sigma_of_albedos()
            albedo = self._tables.dielectric_albedo(sigma, gamma, self._index, self._masking)
            self._energy = Energy(albedo, self._index)

        def sample(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            sample1: mi.Float,
            sample2: mi.Point2f,
            active: mi.Bool = True,
        ) -> tuple[mi.BSDFSample3f, mi.Spectrum]:
            seen, active = self._seen(ctx, si, active)
            bs = dr.zeros(mi.BSDFSample3f)
            if not (seen.reflects or seen.transmits):
                return bs, spectrum(mi.UnpolarizedSpectrum(0))
            m = seen.lobe.sample_visible_normal(seen.sigma, seen.v, sample2, active)
            if self._compensation != "kulla_conty":
                l, facet = drawn(seen.eta, seen.v, m, sample1, seen.chance())
                delta = self._only_sampled(seen, l, facet)
                white, base, chance = self._facets(si, seen, l, facet, active)
                weight, pdf = white / dr.maximum(chance, 1e-30), base * chance
            else:
                assert self._energy is not None
                p = 1 - self._energy.lost(seen.below, seen.v.z, active)
                is_facet = sample1 < p
                rest = dr.select(
                    is_facet,
                    sample1 / dr.maximum(p, 1e-30),
                    (sample1 - p) / dr.maximum(1 - p, 1e-30),
                )
                l, facet = drawn(seen.eta, seen.v, m, rest, seen.chance())
                broad = self._broad(seen, rest, sample2, active)
                delta = is_facet & self._only_sampled(seen, l, facet)
                white, _, chance = self._facets(si, seen, l, facet, active & delta)
                alone = white / dr.maximum(p * chance, 1e-30)
                l = dr.select(is_facet, l, broad)
                facet = either(is_facet, facet, between(seen.eta, seen.v, l, seen.has_pole))
                value, pdf = self._mixed(si, seen, l, facet, active)
                weight = dr.select(delta, alone, value / dr.maximum(pdf, 1e-30))
                facet.sends = facet.sends | (~is_facet if dr.is_jit_v(mi.Float) else not is_facet)
                facet.reflects = l.z > 0
            active = active & facet.sends & ((pdf > 0) | delta)
            reflects = facet.reflects
            bs.wo = seen.sign * l
            # Mitsuba has the probability of an event as the density of a delta.
            bs.pdf = dr.select(active, dr.select(delta, chance, pdf), 0.0)
            bs.eta = dr.select(reflects, 1.0, seen.eta)
            bs.sampled_component = dr.select(reflects, mi.UInt32(0), mi.UInt32(1))
            refraction = dr.select(delta, mi.UInt32(+only_sampled), mi.UInt32(+transmission))
            bs.sampled_type = dr.select(reflects, mi.UInt32(+reflection), refraction)
            return bs, spectrum(blocked(weight, active))

        def eval_pdf(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            wo: mi.Vector3f,
            active: mi.Bool = True,
        ) -> tuple[mi.Spectrum, mi.Float]:
            seen, active = self._seen(ctx, si, active)
            l = seen.sign * wo
            active = active & (l.z != 0) & dr.isfinite(dr.squared_norm(wo))
            if not seen.reflects:
                active = active & (l.z < 0)
            if not seen.transmits:
                active = active & (l.z > 0)
            facet = between(seen.eta, seen.v, l, seen.has_pole)
            if self._compensation == "kulla_conty":
                value, pdf = self._mixed(si, seen, l, facet, active)
            else:
                white, base, chance = self._facets(si, seen, l, facet, active)
                active = active & facet.sends
                value, pdf = white * base, base * chance
            return spectrum(blocked(value, active)), dr.select(active, pdf, 0.0)

        def _only_sampled(self, seen: Seen, l: mi.Vector3f, facet: Facet) -> mi.Bool:
            """Whether a drawn facet is too steep to be found again from its light."""
            if seen.has_pole is False:
                return mi.Bool(False)
            found = between(seen.eta, seen.v, l, seen.has_pole)
            near = (facet.m.z < 2 * steep(seen.eta)) & facet.sends
            return near & ((facet.reflects | found.sends) == False)  # noqa: E712

        def _described(self) -> dict[str, object]:
            return {"eta": self._eta}

        def _textures(self) -> dict[str, mi.Texture]:
            textures = super()._textures()
            if self._transmittance is not None:
                textures["specular_transmittance"] = self._transmittance
            return textures

        def _seen(
            self, ctx: mi.BSDFContext, si: mi.SurfaceInteraction3f, active: mi.Bool
        ) -> tuple[Seen, mi.Bool]:
            active = active & (si.wi.z != 0) & dr.isfinite(dr.squared_norm(si.wi))
            above = si.wi.z > 0
            sign = dr.select(above, mi.Float(1), mi.Float(-1))
            eta = dr.select(above, self._eta, 1 / self._eta)
            lobe = self._lobe(si, active)
            radiance = ctx.mode == mi.TransportMode.Radiance
            seen = Seen(
                v=sign * si.wi,
                sign=sign,
                below=dr.select(above, mi.UInt32(0), mi.UInt32(1)),
                eta=eta,
                scale=1 / (eta * eta) if radiance else mi.Float(1),
                sigma=self._sigma(si, active),
                lobe=lobe,
                has_pole=lobe.gamma < 2,
                reflects=ctx.is_enabled(reflection, 0),
                transmits=ctx.is_enabled(transmission, 1),
            )
            return seen, active

        def _facets(
            self,
            si: mi.SurfaceInteraction3f,
            seen: Seen,
            l: mi.Vector3f,
            facet: Facet,
            active: mi.Bool,
        ) -> tuple[mi.UnpolarizedSpectrum, mi.Float, mi.Float]:
            """Light off facets: f cos over a density, that density, and the chance of the event, by
            which it is multiplied.
            """
            lobe, reflects = seen.lobe, facet.reflects
            view = lobe.stretch(seen.sigma, seen.v)
            inverse_area = lobe.inverse_area(view, active)
            g1_v = dr.minimum(view.z * inverse_area, 1)
            # A transmitted light is as its facet's other side sees it.
            g1_l = lobe.g1(seen.sigma, dr.select(reflects, l, -l), active)
            base = facet.jacobian * lobe.d(seen.sigma, facet.m) * inverse_area
            base = dr.select(facet.sends, dr.minimum(base, LARGEST_DENSITY), 0.0)
            white = facet.share * g2_over_g1(g1_v, g1_l, self._correlated)
            white = white * dr.select(reflects, 1.0, seen.scale)
            if self._compensation == "turquin":
                assert self._energy is not None
                white = white * turquin(self._energy.lost(seen.below, seen.v.z, active), 1.0)
            return self._tint(si, reflects, active) * white, base, (
                facet.share if seen.chance() is None else mi.Float(1)
            )

        def _tint(
            self, si: mi.SurfaceInteraction3f, reflects: mi.Bool, active: mi.Bool
        ) -> mi.UnpolarizedSpectrum:
            """The textures that scale what is reflected and transmitted."""
            one = mi.UnpolarizedSpectrum(1)
            return dr.select(
                reflects,
                one if self._reflectance is None else self._reflectance.eval(si, active),
                one if self._transmittance is None else self._transmittance.eval(si, active),
            )

        def _reflected(self, seen: Seen) -> mi.Float:
            """The chance with which the broad lobe is on the side of the view."""
            assert self._energy is not None
            chance = seen.chance()
            return self._energy.reflected(seen.below) if chance is None else chance

        def _broad(
            self, seen: Seen, number: mi.Float, u: mi.Point2f, active: mi.Bool
        ) -> mi.Vector3f:
            """A light of further bounces."""
            assert self._energy is not None
            reflects = number < self._reflected(seen)
            there = dr.select(reflects, seen.below, 1 - seen.below)
            l = self._energy.broad.sample(there, u, active)
            return dr.select(reflects, l, -l)

        def _mixed(
            self,
            si: mi.SurfaceInteraction3f,
            seen: Seen,
            l: mi.Vector3f,
            facet: Facet,
            active: mi.Bool,
        ) -> tuple[mi.UnpolarizedSpectrum, mi.Float]:
            """Value and density of facets together with those of the broad lobe."""
            energy = self._energy
            assert energy is not None
            white, base, chance = self._facets(si, seen, l, facet, active)
            lost = energy.lost(seen.below, seen.v.z, active)
            reflects, cos_theta = l.z > 0, dr.minimum(dr.abs(l.z), 1)
            there = dr.select(reflects, seen.below, 1 - seen.below)
            share = energy.reflected(seen.below)
            share = dr.select(reflects, share, (1 - share) * seen.scale)
            lobe = kulla_conty(lost, energy.lost(there, cos_theta, active), energy.average(there))
            side = self._reflected(seen)
            side = dr.select(reflects, side, 1 - side)
            broad = side * energy.broad.pdf(there, cos_theta, active)
            value = white * base + self._tint(si, reflects, active) * (share * lobe * cos_theta)
            return value, (1 - lost) * base * chance + lost * broad

    return StudentTDielectric
