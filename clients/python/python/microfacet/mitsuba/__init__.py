"""Plugins of Mitsuba 3 for surfaces whose facets follow the Student-t distribution.

``student_t_conductor`` is a rough metal, ``student_t_dielectric`` rough glass and
``student_t_plastic`` rough glass over a diffuse base, with gamma = 2 GGX and gamma = inf Beckmann.
They read the tables of :class:`microfacet.Tables`. Their properties are listed in
``docs/mitsuba.md``::

    import microfacet.mitsuba

    microfacet.mitsuba.set_variant("llvm_ad_rgb")

    import mitsuba as mi

    gold = mi.load_dict({"type": "student_t_conductor", "material": "Au", "sigma": 0.2, "gamma": 3})
"""

from __future__ import annotations

from . import llvm

__all__ = ["register", "set_variant"]


def register() -> None:
    """Adds the plugins to the current variant.

    To be called after ``mitsuba.set_variant``, for every variant that is used; twice is as once.
    """
    import mitsuba as mi

    if mi.variant() is None:
        raise RuntimeError("no variant is set: call mitsuba.set_variant first, as for llvm_ad_rgb")
    from .conductor import conductor_class
    from .dielectric import dielectric_class
    from .plastic import plastic_class

    mi.register_bsdf("student_t_conductor", conductor_class())
    mi.register_bsdf("student_t_dielectric", dielectric_class())
    mi.register_bsdf("student_t_plastic", plastic_class())


def set_variant(name: str) -> None:
    """Sets the variant of Mitsuba and adds the plugins.

    For a variant of LLVM it finds the library, if it is called before ``mitsuba`` is imported, and
    raises ``ImportError`` with words on how to get one if there is none.
    """
    if name.startswith("llvm"):
        llvm.prepare()
        llvm.check()
    import mitsuba as mi

    mi.set_variant(name)
    register()
