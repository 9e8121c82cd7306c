"""What a conductor gets back of the light that one bounce loses to further ones.

As in ``crates/sampler/src/bsdf/compensation.rs``: a factor on the lobe (Turquin 2019,
https://blog.selfshadow.com/publications/turquin/ms_comp_final.pdf) or a broad lobe beside it (Kulla
& Conty 2017, https://blog.selfshadow.com/publications/s2017-shading-course/).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from . import broad, curve, parameters
from .albedo import Albedos
from .arithmetic import opaque
from .broad import Broad
from .curve import Curve
from .parameters import SIGMA, SIGMA_OF_ALBEDOS

#: What Turquin's factor adds to 1, at most: where E is 0 (gamma near 3/2 at large sigma).
_MOST = 1e6

#: Rows of the broad density where the roughness varies, even in its logarithm.
_ROWS = 32


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
    """What one bounce loses, for any roughness or, faster, for one."""

    def __init__(self, albedos: Albedos, sigma: float | None) -> None:
        """``sigma``: the roughness if it is the same everywhere."""
        self._albedos = albedos
        self._curve: Curve | None = None
        if sigma is None:
            low, high = math.log(SIGMA[0]), math.log(SIGMA_OF_ALBEDOS)
            self._rows = (low, (_ROWS - 1) / (high - low))
            rows = np.exp(np.linspace(low, high, _ROWS))
            self.broad = Broad(np.stack([self._lost(float(row), broad.cosines()) for row in rows]))
        else:
            # Opaque, so that another roughness compiles no other kernel.
            self._average = opaque(parameters.value(albedos.lost_average(mi.Float(sigma))))
            self._curve = Curve(self._lost(sigma, curve.cosines()))
            self.broad = Broad(self._lost(sigma, broad.cosines())[None])

    def _lost(self, sigma: float, cosines: np.ndarray) -> np.ndarray:
        if dr.is_jit_v(mi.Float):
            lost = self._albedos.lost(mi.Float(sigma), mi.Float(cosines.astype(np.float32)))
            return np.asarray(lost)
        return np.array([self._albedos.lost(sigma, float(cos)) for cos in cosines])

    def _at_once(self, sigma: mi.Float) -> bool:
        """Whether the curve serves; derivatives by sigma go through the tables."""
        return self._curve is not None and not dr.grad_enabled(sigma)

    def lost(self, sigma: mi.Float, cos_theta: mi.Float, active: mi.Bool) -> mi.Float:
        """1 - E at the cosine of a view or light."""
        if self._at_once(sigma):
            assert self._curve is not None
            return dr.clip(self._curve(cos_theta, active), 0, 1)
        return self._albedos.lost(sigma, cos_theta, active)

    def average(self, sigma: mi.Float, active: mi.Bool) -> mi.Float:
        """1 - E_avg."""
        if self._at_once(sigma):
            return self._average
        return self._albedos.lost_average(sigma, active)

    def row(self, sigma: mi.Float) -> mi.UInt32:
        """The row of the broad density: that of the nearest roughness."""
        if self._curve is not None:
            return mi.UInt32(0)
        low, scale = self._rows
        at = dr.clip((dr.log(dr.maximum(sigma, SIGMA[0])) - low) * scale, 0, _ROWS - 1)
        return mi.UInt32(at + 0.5)


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
    losses: Losses, sigma: mi.Float, v: mi.Vector3f, f: mi.UnpolarizedSpectrum, active: mi.Bool
) -> Account:
    """The account of a view, from the average reflectance of its facets."""
    lost, average = losses.lost(sigma, v.z, active), losses.average(sigma, active)
    left = 1 - f * average
    # F_avg = 1 and E_avg = 0: infinitely many bounces that lose nothing.
    bounces = dr.select(left > 1e-6, f * f * (1 - average) / dr.maximum(left, 1e-6), 1.0)
    single, multiple = (1 - lost) * dr.mean(f), lost * dr.mean(bounces)
    facets = single / dr.maximum(single + multiple, 1e-30)
    facets = dr.select(multiple > 0, facets, 1.0)
    return Account(facets, lost, average, bounces, losses.row(sigma))
