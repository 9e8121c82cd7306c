"""The plugin ``student_t_conductor``: a rough conductor.

As ``crates/sampler/src/bsdf/conductor.rs``: every facet reflects, and absorbs what it does not reflect.
"""

from __future__ import annotations

from collections.abc import Sequence

import drjit as dr
import mitsuba as mi

from . import parameters
from .compensation import Account, Losses, account, kulla_conty, turquin
from .fresnel import Exact, Schlick, White
from .reflection import white
from .shape import Lobe
from .spectra import blocked, spectrum
from .surface import round_of, surface_class

_NAMES = ("f0", "f82", "eta", "k", "material")


def conductor_class() -> type:
    """The class of the plugin in the current variant."""

    class StudentTConductor(surface_class()):  # type: ignore[misc]
        """A conductor whose facets follow the Student-t distribution.

        Single scattering is F D G2/(4 cos cos) (Cook & Torrance 1982,
        https://doi.org/10.1145/357290.357293), sampled by visible normals with the weight F G2/G1.
        Black from below.
        """

        def __init__(self, props: mi.Properties) -> None:
            super().__init__(props, _NAMES)
            self._fresnel, self._colours = _reflectance(props)
            self._losses = None
            if self._compensation != "none":
                self._losses = Losses(self._tables, self._family, self._correlated)
            flags = self._flags(mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide)
            self.m_components = [flags]
            self.m_flags = flags
            self.parameters_changed()

        def _textures(self) -> dict[str, mi.Texture]:
            return super()._textures() | self._colours

        def parameters_changed(self, keys: Sequence[str] = ()) -> None:
            super().parameters_changed(keys)
            if self._losses is not None:
                gamma = parameters.constant_gamma(self._gamma)
                self._losses.bind(self._round_sigma(), gamma, self._is_bound)

        def sample(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            sample1: mi.Float,
            sample2: mi.Point2f,
            active: mi.Bool = True,
        ) -> tuple[mi.BSDFSample3f, mi.Spectrum]:
            bs = dr.zeros(mi.BSDFSample3f)
            if not ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0):
                return bs, spectrum(mi.UnpolarizedSpectrum(0))
            v = si.wi
            active = active & (v.z > 0) & dr.isfinite(dr.squared_norm(v))
            sigma, lobe = self._sigma(si, active), self._lobe(si, active)
            m = lobe.sample_visible_normal(sigma, v, sample2, active)
            facing = dr.dot(v, m)
            l = 2 * facing * m - v
            kept = self._account(si, sigma, lobe, active)
            if kept is not None:
                assert self._losses is not None
                is_broad = sample1 >= kept.facets
                broad = self._losses.broad.sample(kept.row, sample2, active)
                l = dr.select(is_broad, broad, l)
                m = dr.select(is_broad, dr.normalize(v + l), m)
                facing = dr.dot(v, m)
            active = active & (l.z > 0) & (facing > 0)
            weight, pdf = self._facets(si, sigma, lobe, l, m, facing, active)
            if kept is not None:
                value, pdf = self._mixed(kept, sigma, lobe, l, weight * pdf, pdf, active)
                weight = value / dr.maximum(pdf, 1e-30)
            bs.wo = l
            bs.pdf = dr.select(active, pdf, 0.0)
            bs.eta = 1.0
            bs.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
            bs.sampled_component = mi.UInt32(0)
            return bs, spectrum(blocked(weight, active & (pdf > 0)))

        def eval_pdf(
            self,
            ctx: mi.BSDFContext,
            si: mi.SurfaceInteraction3f,
            wo: mi.Vector3f,
            active: mi.Bool = True,
        ) -> tuple[mi.Spectrum, mi.Float]:
            if not ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0):
                return spectrum(mi.UnpolarizedSpectrum(0)), mi.Float(0)
            v = si.wi
            active = active & (v.z > 0) & (wo.z > 0)
            active = active & dr.isfinite(dr.squared_norm(v) + dr.squared_norm(wo))
            sigma, lobe = self._sigma(si, active), self._lobe(si, active)
            # The cosine v.m is half the length of v + l.
            m = v + wo
            length = dr.sqrt(dr.maximum(dr.squared_norm(m), 1e-30))
            weight, pdf = self._facets(
                si, sigma, lobe, wo, m / length, dr.minimum(0.5 * length, 1), active
            )
            value = weight * pdf
            kept = self._account(si, sigma, lobe, active)
            if kept is not None:
                value, pdf = self._mixed(kept, sigma, lobe, wo, value, pdf, active)
            return spectrum(blocked(value, active)), dr.select(active, pdf, 0.0)

        def _facets(
            self,
            si: mi.SurfaceInteraction3f,
            sigma: mi.Vector2f,
            lobe: Lobe,
            l: mi.Vector3f,
            m: mi.Vector3f,
            facing: mi.Float,
            active: mi.Bool,
        ) -> tuple[mi.UnpolarizedSpectrum, mi.Float]:
            """Light off facets of normal m: f cos/pdf, and its density."""
            weight, pdf = white(lobe, sigma, si.wi, l, m, self._correlated, active)
            weight = weight * self._fresnel.at(si, facing, active)
            if self._compensation == "turquin":
                assert self._losses is not None
                f0 = self._fresnel.at(si, mi.Float(1), active)
                lost = self._losses.lost(round_of(sigma), lobe.gamma, si.wi.z, active)
                weight = weight * turquin(lost, f0)
            if self._reflectance is not None:
                weight = weight * self._reflectance.eval(si, active)
            return weight, pdf

        def _account(
            self, si: mi.SurfaceInteraction3f, sigma: mi.Vector2f, lobe: Lobe, active: mi.Bool
        ) -> Account | None:
            if self._compensation != "kulla_conty":
                return None
            assert self._losses is not None
            average = self._fresnel.average(si, active)
            kept = account(self._losses, round_of(sigma), lobe.gamma, si.wi, average, active)
            if self._reflectance is not None:
                kept.bounces = kept.bounces * self._reflectance.eval(si, active)
            return kept

        def _mixed(
            self,
            kept: Account,
            sigma: mi.Vector2f,
            lobe: Lobe,
            l: mi.Vector3f,
            value: mi.UnpolarizedSpectrum,
            pdf: mi.Float,
            active: mi.Bool,
        ) -> tuple[mi.UnpolarizedSpectrum, mi.Float]:
            """Value and density of facets together with those of the broad lobe."""
            assert self._losses is not None
            lost = self._losses.lost(round_of(sigma), lobe.gamma, l.z, active)
            value_of_broad = kulla_conty(kept.lost, lost, kept.average) * l.z
            broad = self._losses.broad.pdf(kept.row, l.z, active)
            return (
                value + kept.bounces * value_of_broad,
                kept.facets * pdf + (1 - kept.facets) * broad,
            )

    return StudentTConductor


def _reflectance(props: mi.Properties) -> tuple[White | Schlick | Exact, dict[str, mi.Texture]]:
    """The reflectance of the facets, and its textures by name."""
    exact = ("eta", "k", "material")
    parameters.refuse_together(props, "f0", exact, "each gives the colour of the metal")
    parameters.refuse_together(props, "material", ("eta", "k"), "a material has both")
    if "f82" in props and "f0" not in props:
        raise ValueError("f82 is a tint beside f0, the reflectance at normal incidence; give f0")
    f0, f82 = parameters.reflectance(props, "f0"), parameters.reflectance(props, "f82")
    if f0 is not None:
        named = {"f0": f0} if f82 is None else {"f0": f0, "f82": f82}
        return Schlick(f0, f82), named
    if "material" in props:
        index = parameters.of_material(props["material"])
    elif "eta" in props and "k" in props:
        parameters.number_in(props, "eta", 1e-3, 1e3, "it is an index of refraction")
        parameters.number_in(props, "k", 0, 1e3, "it is an extinction, not negative")
        index = {name: props.get_unbounded_texture(name) for name in ("eta", "k")}
    elif "eta" in props or "k" in props:
        missing = "k" if "eta" in props else "eta"
        raise ValueError(f"{missing} is missing: a metal has both eta and k")
    else:
        return White(), {}
    return Exact(index["eta"], index["k"]), index
