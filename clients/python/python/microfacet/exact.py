"""The model in float64: what tables are baked from and judged by.

>>> from microfacet import exact
>>> lobe = exact.StudentT(sigma=0.3, gamma=2.5)
>>> round(float(lobe.albedo(cos_theta=0.8)), 9)
0.920406219
"""

from ._microfacet import ExactEllipsoid as Ellipsoid
from ._microfacet import ExactLobe as Lobe
from ._microfacet import ExactStudentT as StudentT

__all__ = ["Ellipsoid", "Lobe", "StudentT"]
