"""Sets the variant of Mitsuba before any test imports it."""

import pytest

pytest.importorskip("mitsuba", reason="Mitsuba is an optional dependency")

import microfacet.mitsuba

microfacet.mitsuba.set_variant("llvm_ad_rgb")
