"""Spectra that a plugin returns."""

from __future__ import annotations

import drjit as dr
import mitsuba as mi


def blocked(value: mi.UnpolarizedSpectrum, active: mi.Bool) -> mi.UnpolarizedSpectrum:
    """The value where ``active``, elsewhere 0."""
    return dr.select(active, value, mi.UnpolarizedSpectrum(0))


def spectrum(value: mi.UnpolarizedSpectrum) -> mi.Spectrum:
    """The value as the variant has it: in polarised ones a matrix that leaves light unpolarised."""
    return mi.depolarizer(value)
