"""The accounts of a rough dielectric: what one bounce reflects, transmits and loses of the light of
either side, and where the light of further bounces goes.

As ``crates/sampler/src/bsdf/energy.rs``; ``docs/bsdf.md`` derives it.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from . import broad, curve
from .arithmetic import opaque
from .broad import Broad
from .curve import Curve

SIDES = ("outside", "inside")

#: The number of the side above the surface; that below is 1.
OUTSIDE = 0


class Energy:
    """The losses of one interface, for one roughness; derivatives do not pass through them."""

    def __init__(self, albedo: Any, eta: float) -> None:
        """``albedo``: what ``microfacet.Tables().dielectric_albedo`` returns; eta is the index
        inside over that outside.
        """

        def lost(shares: np.ndarray) -> Any:
            # Interpolation may have both exceed one by the error of the tables.
            return np.maximum(1 - shares[:, 0] - shares[:, 1], 0)

        def shares(cosines: np.ndarray, side: str) -> np.ndarray:
            found = albedo.shares(cosines.astype(np.float32), side)
            return np.asarray(found, np.float64)

        self._curves = [Curve(lost(shares(curve.cosines(), side))) for side in SIDES]
        self.broad = Broad(np.stack([lost(shares(broad.cosines(), side)) for side in SIDES]))

        def parts(side: str) -> Any:
            def of(cosines: np.ndarray) -> np.ndarray:
                both = shares(cosines, side)
                return np.column_stack([both, lost(both)])

            return curve.average(of)

        averages = [parts(side) for side in SIDES]
        lost_averages = [float(lost) for _, _, lost in averages]
        self._average = [opaque(lost) for lost in lost_averages]
        # The flux that changes sides is the same either way, by reciprocity: as much of it as one
        # bounce would send there, from the side that sends less.
        outside, inside = (
            lost * transmitted / (reflected + transmitted) if reflected + transmitted > 0 else 0.0
            for reflected, transmitted, lost in averages
        )
        flux = min(outside, eta * eta * inside)
        crossing = (flux, flux / (eta * eta))
        self._reflected = [
            opaque(1 - min(part / lost, 1) if lost > 0 else 1.0)
            for part, lost in zip(crossing, lost_averages)
        ]

    def lost(self, below: mi.UInt32, cos_theta: mi.Float, active: mi.Bool) -> mi.Float:
        """What one bounce loses at a cosine in [0, 1]; ``below`` is 0 outside and 1 inside."""
        outside, inside = (curve(cos_theta, active) for curve in self._curves)
        return dr.clip(dr.select(below == 0, outside, inside), 0, 1)

    def average(self, below: mi.UInt32) -> mi.Float:
        """The cosine-weighted average of that."""
        return dr.select(below == 0, *self._average)

    def reflected(self, below: mi.UInt32) -> mi.Float:
        """The share of what is lost that further bounces reflect."""
        return dr.select(below == 0, *self._reflected)
