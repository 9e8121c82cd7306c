"""Student-t microfacet materials, GGX (gamma = 2) and Beckmann (gamma = inf) among them.

Directions are arrays of shape (..., 3): unit vectors in the tangent frame, n = +z, away from the
surface. Arguments broadcast as NumPy's do, without their axis of components; results are float32.
`microfacet.exact` has the same lobes by the model in float64, and `microfacet.mitsuba` plugins for
Mitsuba 3.

>>> import microfacet
>>> lobe = microfacet.StudentT(sigma=0.3, gamma=2.5)
>>> m = lobe.sample_visible_normal([0.6, 0.0, 0.8], [[0.3, 0.7], [0.5, 0.5]])
>>> m.shape
(2, 3)
>>> float(lobe.g1([0.0, 0.0, 1.0]))
1.0
"""

from . import exact
from ._microfacet import (
    Bsdf,
    BsdfSample,
    Conductor,
    Dielectric,
    DielectricAlbedo,
    Ellipsoid,
    Haze,
    Lobe,
    Plastic,
    Retroreflective,
    Shape,
    StudentT,
    Tables,
    __version__,
    bake,
    inspect,
)

__all__ = [
    "Bsdf",
    "BsdfSample",
    "Conductor",
    "Dielectric",
    "DielectricAlbedo",
    "Ellipsoid",
    "Haze",
    "Lobe",
    "Plastic",
    "Retroreflective",
    "Shape",
    "StudentT",
    "Tables",
    "__version__",
    "bake",
    "exact",
    "inspect",
]
