"""What a conductor gets back of the light that one bounce loses to further ones.

As in ``crates/sampler/src/bsdf/compensation.rs``: a factor on the lobe (Turquin 2019,
https://blog.selfshadow.com/publications/turquin/ms_comp_final.pdf) or a broad lobe beside it (Kulla
& Conty 2017, https://blog.selfshadow.com/publications/s2017-shading-course/).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable

import drjit as dr
import mitsuba as mi
import numpy as np

from . import broad, curve, parameters
from .albedo import Albedos, gamma_nodes, gamma_place
from .arithmetic import opaque
from .broad import Broad
from .curve import Curve
from .family import GAMMA, Family
from .parameters import SIGMA, SIGMA_OF_ALBEDOS

#: What Turquin's factor adds to 1, at most: where E is 0 (gamma near 3/2 at large sigma).
_MOST = 1e6

#: Rows of the broad density where the roughness varies, even in its logarithm; and where gamma
#: varies, for each of so many nodes of albedos one.
_ROWS, _EVERY = 32, 7


def turquin(lost: mi.Float, f0: mi.UnpolarizedSpectrum) -> mi.UnpolarizedSpectrum:
    """Turquin's factor 1 + F0 (1 - E)/E, from what is lost, 1 - E."""
    return 1 + dr.minimum(f0 * (lost / dr.maximum(1 - lost, 1 / _MOST)), _MOST)


def kulla_conty(lost_v: mi.Float, lost_l: mi.Float, average: mi.Float) -> mi.Float:
    """The lobe of further bounces of a white surface, without the cosine, from what is lost at
    view, light and on average.
    """
    # What loses nothing gets nothing back, and the quotient would be 0/0.
    loses = average > 1e-30
    return dr.select(loses, lost_v * lost_l / dr.maximum(average, 1e-30), 0.0) * (1 / math.pi)


class Losses:
    """What one bounce loses, for any roughness and gamma or, faster, for one."""

    def __init__(self, tables: Any, family: Callable[[], Family], correlated: bool) -> None:
        """``family``: returns the lobes of all gammas."""
        self._tables, self._family, self._correlated = tables, family, correlated
        self._of_one: Albedos | None = None

    def bind(self, sigma: float | None, gamma: float | None, is_bound: bool) -> None:
        """``sigma``, ``gamma``: those that are the same everywhere; ``is_bound``: whether gamma
        will not change.
        """
        if not is_bound:
            self._albedos = self._of_all()
        else:
            self._of_one = self._of_one or Albedos(self._tables, gamma, self._correlated)
            self._albedos = self._of_one
        self._curve: Curve | None = None
        if sigma is not None and gamma is not None:
            # Opaque, so that another roughness compiles no other kernel.
            at = (opaque(sigma), opaque(min(gamma, GAMMA[1])))
            self._average = opaque(parameters.value(self._albedos.lost_average(*at)))
            self._curve = Curve(self._tabulated(*at, curve.cosines()))
            self.broad = Broad(self._tabulated(*at, broad.cosines())[None])
            return
        low, high = math.log(SIGMA[0]), math.log(SIGMA_OF_ALBEDOS)
        sigmas = np.exp(np.linspace(low, high, _ROWS)).tolist() if sigma is None else [sigma]
        gammas = gamma_nodes()[::_EVERY] if gamma is None else [gamma]
        self._rows, self._scale = (len(sigmas), len(gammas)), (_ROWS - 1) / (high - low)
        lost = [self._albedos.row(s, g, broad.cosines()) for g in gammas for s in sigmas]
        self.broad = Broad(np.stack(lost))

    def _of_all(self) -> Albedos:
        kept = self._family().albedos
        found: Albedos | None = kept.get(self._correlated)
        if found is None:
            found = kept[self._correlated] = Albedos(self._tables, None, self._correlated)
        return found

    def _tabulated(self, sigma: mi.Float, gamma: mi.Float, cosines: np.ndarray) -> np.ndarray:
        if dr.is_jit_v(mi.Float):
            cosines = mi.Float(cosines.astype(np.float32))
            return np.asarray(self._albedos.lost(sigma, gamma, cosines))
        return np.array([self._albedos.lost(sigma, gamma, float(cos)) for cos in cosines])

    def _at(self, sigma: mi.Float, gamma: mi.Float) -> Albedos | None:
        """The tables to look up in, if the curve does not serve: it has no derivatives."""
        if dr.grad_enabled(gamma):
            return self._of_all()
        return self._albedos if self._curve is None or dr.grad_enabled(sigma) else None

    def lost(
        self, sigma: mi.Float, gamma: mi.Float, cos_theta: mi.Float, active: mi.Bool
    ) -> mi.Float:
        """1 - E at the cosine of a view or light."""
        albedos = self._at(sigma, gamma)
        if albedos is not None:
            return albedos.lost(sigma, gamma, cos_theta, active)
        assert self._curve is not None
        return dr.clip(self._curve(cos_theta, active), 0, 1)

    def average(self, sigma: mi.Float, gamma: mi.Float, active: mi.Bool) -> mi.Float:
        """1 - E_avg."""
        albedos = self._at(sigma, gamma)
        return self._average if albedos is None else albedos.lost_average(sigma, gamma, active)

    def row(self, sigma: mi.Float, gamma: mi.Float) -> mi.UInt32:
        """The row of the broad density: that of the nearest roughness and gamma."""
        row = mi.UInt32(0)
        if self._curve is not None:
            return row
        sigmas, gammas = self._rows
        if gammas > 1:
            row = mi.UInt32(dr.clip(gamma_place(gamma) / _EVERY, 0, gammas - 1) + 0.5) * sigmas
        if sigmas > 1:
            at = (dr.log(dr.maximum(sigma, SIGMA[0])) - math.log(SIGMA[0])) * self._scale
            row = row + mi.UInt32(dr.clip(at, 0, sigmas - 1) + 0.5)
        return row


@dataclass
class Account:
    """What is kept of one view for Kulla and Conty's lobe."""

    #: The probability with which facets are drawn.
    facets: mi.Float
    #: What is lost of the view's light, and on average.
    lost: mi.Float
    average: mi.Float
    #: The factor F_avg^2 E_avg/(1 - F_avg (1 - E_avg)) of coloured surfaces.
    bounces: mi.UnpolarizedSpectrum
    #: The row of the broad density.
    row: mi.UInt32


def account(
    losses: Losses,
    sigma: mi.Float,
    gamma: mi.Float,
    v: mi.Vector3f,
    f: mi.UnpolarizedSpectrum,
    active: mi.Bool,
) -> Account:
    """The account of a view, from the average reflectance of its facets."""
    lost = losses.lost(sigma, gamma, v.z, active)
    average = losses.average(sigma, gamma, active)
    left = 1 - f * average
    # F_avg = 1 and E_avg = 0: infinitely many bounces that lose nothing.
    bounces = dr.select(left > 1e-6, f * f * (1 - average) / dr.maximum(left, 1e-6), 1.0)
    single, multiple = (1 - lost) * dr.mean(f), lost * dr.mean(bounces)
    facets = single / dr.maximum(single + multiple, 1e-30)
    facets = dr.select(multiple > 0, facets, 1.0)
    return Account(facets, lost, average, bounces, losses.row(sigma, gamma))
