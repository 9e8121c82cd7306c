"""Spectra that a plugin returns."""

from __future__ import annotations

import drjit as dr
import mitsuba as mi


def blocked(value: mi.UnpolarizedSpectrum, active: mi.Bool) -> mi.UnpolarizedSpectrum:
    """The value where ``active``, elsewhere 0."""
    return dr.select(active, value, mi.UnpolarizedSpectrum(0))


def spectrum(value: mi.UnpolarizedSpectrum) -> mi.Spectrum:
    """The value as the variant has it: in polarised ones a matrix that leaves light unpolarised."""
    # A select by channels returns a plain array, of which a matrix would take one channel for all.
    return mi.depolarizer(mi.UnpolarizedSpectrum(value))
