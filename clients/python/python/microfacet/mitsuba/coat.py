"""What the coat of a plastic does with light: the shares that it reflects and lets through.

As ``crates/sampler/src/bsdf/plastic.rs``, whose ``Plastic`` has the shares of one bounce;
``docs/bsdf.md`` derives the rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable

import drjit as dr
import mitsuba as mi
import numpy as np

from . import broad, curve, parameters
from .arithmetic import Numbers, opaque
from .broad import Broad
from .compensation import kulla_conty, turquin
from .curve import Curve
from .energy import OUTSIDE, Energy
from .parameters import SIGMA

#: Coats between which a roughness that varies is interpolated, even in its logarithm: as many as
#: keep values within 2e-3 of those of one roughness (``test_plastic.py``).
ROWS = 40


@dataclass
class Shares:
    """What becomes of the light of a direction above."""

    #: What facets reflect, with Turquin's factor, and what enters, by all bounces that count.
    facets: mi.Float
    entering: mi.Float
    #: Turquin's factor on facets, or 1, and what Kulla and Conty's lobe returns, or 0.
    factor: mi.Float
    lost: mi.Float


@dataclass
class Place:
    """Where a roughness lies among the rows: the first of four with their weights, and the nearest
    one. A coat of one roughness has one row.
    """

    first: mi.UInt32
    weights: list[mi.Float]
    nearest: mi.UInt32


class Coat:
    """The shares of a coat; derivatives by a constant roughness do not pass through them."""

    def __init__(
        self,
        plastic: Callable[[float], Any],
        sigma: float | None,
        eta: float,
        compensation: str,
        accounts: Callable[[float], Energy],
    ) -> None:
        """``plastic``: makes a ``microfacet.Plastic`` of a roughness; ``sigma``: the roughness, or
        none where it varies; ``accounts``: makes those of a coat, which Kulla and Conty's lobe
        needs.
        """
        sigmas = np.geomspace(*SIGMA, ROWS) if sigma is None else [sigma]
        made = [plastic(float(one)) for one in sigmas]
        energy = None
        if compensation == "kulla_conty":
            assert sigma is not None
            energy = accounts(sigma)
        self._has_factor, self._energy = compensation == "turquin", energy
        self._is_one = sigma is not None
        # Where the curves of the crate join, with kinks: a thin coat reflects all light beyond a
        # critical angle.
        critical = math.sqrt(max((1 - eta) * (1 + eta), 0))
        joints = [0.5] if critical == 0 else [0.5 * critical, critical, 0.5 * (critical + 1)]
        self._joints, parts = [opaque(joint) for joint in joints], [0.0, *joints, 1.0]
        # What further bounces of lost light send through the coat.
        crossing = 0.0
        if energy is not None:
            crossing = 1 - parameters.value(energy.reflected(mi.UInt32(OUTSIDE)))

        def shares(coat: Any) -> Callable[[np.ndarray], np.ndarray]:
            def of(cosines: np.ndarray) -> np.ndarray:
                views = np.column_stack([np.sqrt(1 - cosines**2), 0 * cosines, cosines])
                found = np.asarray(coat.coat_shares(views.astype(np.float32)), np.float64)
                lost = np.maximum(1 - found.sum(axis=1), 0)
                # Turquin's factor, of F0 = 1.
                factor = 1 / np.maximum(1 - lost, 1e-6) if self._has_factor else 1.0
                facets, entering = found[:, 0] * factor, found[:, 1] * factor + crossing * lost
                return np.column_stack([facets, entering, lost])

            return of

        nodes = [low + (high - low) * curve.cosines() for low, high in zip(parts, parts[1:])]
        at_nodes = np.stack([shares(coat)(part) for coat in made for part in nodes])
        self._facets, self._entering, self._lost = (Curve(at_nodes[..., i]) for i in range(3))
        averages = [curve.average(shares(coat))[1] for coat in made]
        self._average = Numbers(averages)
        self._leaving = Numbers([coat.leaving for coat in made])
        densities = [shares(coat)(broad.cosines()) for coat in made]
        rows = [one[:, 1] for one in densities] + [one[:, 2] for one in densities if energy]
        self._broad = Broad(np.stack(rows))
        if energy is not None:
            through, lost = self._broad.averages
            self._weights = (opaque(through), opaque((1 - crossing) * lost))
        self._eta = opaque(eta)

    def place(self, sigma: mi.Float) -> Place:
        """Where a roughness is."""
        if self._is_one:
            return Place(mi.UInt32(0), [], mi.UInt32(0))
        low, high = math.log(SIGMA[0]), math.log(SIGMA[1])
        at = dr.clip((dr.log(sigma) - low) * ((ROWS - 1) / (high - low)), 0, ROWS - 1)
        first = dr.clip(dr.floor(at) - 1, 0, ROWS - 4)
        a = at - first
        b, c, d = a - 1, a - 2, a - 3
        weights = [b * c * d * (-1 / 6), a * c * d * 0.5, a * b * d * -0.5, a * b * c * (1 / 6)]
        return Place(mi.UInt32(first), weights, mi.UInt32(at + 0.5))

    def shares(self, place: Place, cos_theta: mi.Float, active: mi.Bool) -> Shares:
        """The shares of a direction above by its cosine."""
        ends = [*self._joints, mi.Float(1)]
        part, low, high = mi.UInt32(0), mi.Float(0), ends[0]
        for i, joint in enumerate(self._joints):
            beyond = cos_theta > joint
            part = dr.select(beyond, mi.UInt32(i + 1), part)
            low, high = dr.select(beyond, joint, low), dr.select(beyond, ends[i + 1], high)
        within = (cos_theta - low) / (high - low)

        def at(of: Curve) -> mi.Float:
            found = _mixed(place, lambda row: of(within, active, row * len(ends) + part))
            return dr.clip(found, 0, 1)

        facets, entering = at(self._facets), at(self._entering)
        one, none = mi.Float(1), mi.Float(0)
        if self._has_factor:
            return Shares(facets, entering, turquin(at(self._lost), one), none)
        return Shares(facets, entering, one, none if self._energy is None else at(self._lost))

    def diffuse(
        self, place: Place, base: mi.UnpolarizedSpectrum, active: mi.Bool
    ) -> tuple[mi.UnpolarizedSpectrum, mi.Float]:
        """What a base of albedo rho returns of light that enters, rho/(eta^2 (1 - rho R)), and the
        mean of that, by which lights are drawn and which has no derivative.
        """
        left = 1 - base + base * _mixed(place, lambda row: self._leaving(row, active))
        diffuse = base / dr.maximum(self._eta * self._eta * left, 1e-30)
        return diffuse, dr.detach(dr.mean(diffuse))

    def returned(self, seen: Shares, there: Shares) -> mi.Float:
        """What further bounces reflect from a view to a light, without the cosine."""
        if self._energy is None:
            return mi.Float(0)
        lobe = kulla_conty(seen.lost, there.lost, self._energy.average(mi.UInt32(OUTSIDE)))
        return self._energy.reflected(mi.UInt32(OUTSIDE)) * lobe

    def facets_share(
        self, place: Place, seen: Shares, mean: mi.Float, active: mi.Bool
    ) -> mi.Float:
        """The probability of facets: their share of the light that returns."""
        rest = seen.entering * mean * _mixed(place, lambda row: self._average(row, active))
        if self._energy is not None:
            rest = rest + self._energy.reflected(mi.UInt32(OUTSIDE)) * seen.lost
        return dr.select(rest > 0, seen.facets / dr.maximum(seen.facets + rest, 1e-30), 1.0)

    def sample(
        self, place: Place, mean: mi.Float, number: mi.Float, u: mi.Point2f, active: mi.Bool
    ) -> mi.Vector3f:
        """A light of the base, or of further bounces, from three numbers in [0, 1]."""
        row = place.nearest
        if self._energy is not None:
            row = dr.select(number < self._base_share(mean), mi.UInt32(0), mi.UInt32(1))
        return self._broad.sample(row, u, active)

    def pdf(
        self, place: Place, mean: mi.Float, cos_theta: mi.Float, active: mi.Bool
    ) -> mi.Float:
        """The density of these at a cosine in [0, 1]."""
        density = self._broad.pdf(place.nearest, cos_theta, active)
        if self._energy is None:
            return density
        lost = self._broad.pdf(mi.UInt32(1), cos_theta, active)
        return dr.lerp(lost, density, self._base_share(mean))

    def _base_share(self, mean: mi.Float) -> mi.Float:
        """The share of the base in the lights that are not of facets."""
        through, lost = self._weights
        base = mean * through
        return base / dr.maximum(base + lost, 1e-30)


def _mixed(place: Place, of: Callable[[mi.UInt32], mi.Float]) -> mi.Float:
    """The value of rows at a place."""
    if not place.weights:
        return of(place.first)
    return sum(
        (weight * of(place.first + row) for row, weight in enumerate(place.weights)),
        start=mi.Float(0),
    )
