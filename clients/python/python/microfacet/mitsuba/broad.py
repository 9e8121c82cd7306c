"""The density from which light of further bounces is drawn: the cosine, weighted by what is lost
at each elevation.

The density of ``crates/sampler/src/bsdf/broad.rs``, of several rows: for a roughness that varies there is
one for each of some roughnesses, and for a dielectric one for each side.
"""

from __future__ import annotations

import math

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import Numbers, unit

#: Bands of elevation, between the cosines (i/32)^4: a smooth surface loses its light at grazing,
#: within its roughness of the horizon.
BANDS = 32

#: The share that is drawn by the plain cosine, so that nothing is left out.
_PLAIN = 0.05

#: Places within a band at which what is lost is averaged.
_PLACES = 8

_SQUARES = (np.arange(BANDS + 1) / BANDS) ** 8


def cosines() -> np.ndarray:
    """The cosines (256) at which rows must be known."""
    within = (np.arange(_PLACES) + 0.5) / _PLACES
    squares = _SQUARES[:-1, None] + within * np.diff(_SQUARES)[:, None]
    return np.sqrt(squares).ravel()


class Broad:
    """A density over the hemisphere above, per steradian: a factor, linear in the squared cosine
    between the ends of the bands and continuous, times cos/pi.
    """

    def __init__(self, lost: np.ndarray) -> None:
        """``lost``: what is lost at :func:`cosines`, (rows, 256) numbers >= 0."""
        rows = [_factors(row) for row in np.asarray(lost, np.float64)]
        self._factors = Numbers(np.stack([factors for factors, _, _ in rows]))
        self._shares = Numbers(np.stack([shares for _, shares, _ in rows]))
        #: The cosine-weighted average of what is lost, of each row.
        self.averages = [average for _, _, average in rows]
        self._squares = Numbers(_SQUARES)

    def sample(self, row: mi.UInt32, u: mi.Point2f, active: mi.Bool = True) -> mi.Vector3f:
        """A direction above the horizon from two numbers in [0, 1]."""
        first = row * (BANDS + 1)
        number = unit(u.x)
        # The last band that begins below the number.
        band = mi.UInt32(0)
        for step in (16, 8, 4, 2, 1):
            further = self._shares(first + band + step, active) < number
            band = dr.select(further, band + step, band)
        below, above = (self._shares(first + band + end, active) for end in (0, 1))
        within = unit((number - below) / dr.maximum(above - below, 1e-30))
        # The inverse of the quadratic distribution of a linear density, without cancellation.
        a, b = (self._factors(first + band + end, active) for end in (0, 1))
        root = dr.safe_sqrt(a * a + within * (b - a) * (b + a))
        w = dr.minimum(within * (a + b) / dr.maximum(a + root, 1e-30), 1)
        low, high = (self._squares(band + end, active) for end in (0, 1))
        # Off the horizon, where the density is 0.
        square = dr.maximum(low + w * (high - low), 1e-16)
        radius = dr.safe_sqrt(1 - square)
        sine, cosine = dr.sincos((2 * math.pi) * u.y)
        return mi.Vector3f(radius * cosine, radius * sine, dr.sqrt(square))

    def pdf(self, row: mi.UInt32, cos_theta: mi.Float, active: mi.Bool = True) -> mi.Float:
        """The density at a cosine in [0, 1]."""
        band = dr.minimum(mi.UInt32(BANDS * dr.sqrt(dr.sqrt(unit(cos_theta)))), BANDS - 1)
        low, high = (self._squares(band + end, active) for end in (0, 1))
        w = unit((cos_theta * cos_theta - low) / dr.maximum(high - low, 1e-30))
        a, b = (self._factors(row * (BANDS + 1) + band + end, active) for end in (0, 1))
        return (a + w * (b - a)) * cos_theta * (1 / math.pi)


def _factors(lost: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """The factors at the ends of the bands, the share of all bands below each end, and the average
    of what is lost.
    """
    w = (np.arange(_PLACES) + 0.5) / _PLACES
    places = lost.reshape(BANDS, _PLACES)
    total, weight = np.zeros(BANDS + 1), np.zeros(BANDS + 1)
    # Averages about each end, so that a peak between two ends is not missed.
    for end, share in ((0, 1 - w), (1, w)):
        total[end : BANDS + end] += places @ share
        weight[end : BANDS + end] += share.sum()
    means, widths = total / weight, np.diff(_SQUARES)
    whole = (0.5 * (means[:-1] + means[1:]) * widths).sum()
    factors = _PLAIN + (1 - _PLAIN) * means / whole if whole > 0 else np.ones(BANDS + 1)
    shares = np.concatenate([[0], np.cumsum(0.5 * (factors[:-1] + factors[1:]) * widths)])
    return factors, shares, float(whole)
