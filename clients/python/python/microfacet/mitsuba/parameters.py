"""Reads the properties of the plugins, and refuses with words what cannot be rendered."""

from __future__ import annotations

import difflib
import math
from typing import Any, Iterable

import drjit as dr
import mitsuba as mi
import numpy as np

from .family import GAMMA

#: Roughness below makes facets that single precision cannot tell apart, beyond ones that are
#: vertical.
SIGMA = (1e-4, 10.0)

#: The largest roughness of tables of albedos, ``sigma_max`` of their descriptions.
SIGMA_OF_ALBEDOS = 3.0

_COMPENSATIONS = ("none", "turquin", "kulla_conty")
_MASKINGS = ("height-correlated", "uncorrelated")
#: Why an anisotropic surface has no compensation.
ANISOTROPIC = (
    "compensation has no albedos of anisotropic lobes: set stand_in to true, and the round lobe of"
    " sqrt(sigma_u sigma_v) stands in, which gives back too much or too little light; or set"
    " compensation to none"
)

_HINTS = {
    "alpha": "sigma is what other plugins call alpha",
    "alpha_u": "sigma_u is what other plugins call alpha_u",
    "alpha_v": "sigma_v is what other plugins call alpha_v",
    "sigma_x": "its name is sigma_u, as alpha_u of other plugins",
    "sigma_y": "its name is sigma_v, as alpha_v of other plugins",
    "distribution": "gamma = 2 is ggx, and gamma = inf beckmann",
}


def check_names(props: mi.Properties, known: Iterable[str]) -> None:
    """Raises ``ValueError`` for a property that the plugin does not have."""
    known = sorted(known)
    for name in props.keys():
        if name in known:
            continue
        close = difflib.get_close_matches(name, known, 1)
        hint = _HINTS.get(name) or (f"did you mean {close[0]}?" if close else "")
        raise ValueError(
            f"unknown property {name!r}{': ' if hint else ''}{hint}; there are {', '.join(known)}"
        )


def refuse_together(props: mi.Properties, one: str, others: Iterable[str], why: str) -> None:
    """Raises ``ValueError`` if ``one`` stands beside one of the others."""
    for other in others:
        if one in props and other in props:
            raise ValueError(f"{one} and {other} contradict each other: {why}; remove one of them")


def choice(props: mi.Properties, name: str, values: tuple[str, ...]) -> str:
    """One of some words; the first if none is given."""
    value = props.get(name, values[0])
    if not isinstance(value, str) or value not in values:
        raise ValueError(f"{name} = {value!r} is none of {', '.join(values)}; write one of these")
    return value


def compensation(props: mi.Properties) -> str:
    """How light of further bounces is given back; also with the hyphen of ``microfacet``."""
    if props.get("compensation") == "kulla-conty":
        return "kulla_conty"
    return choice(props, "compensation", _COMPENSATIONS)


def masking(props: mi.Properties) -> str:
    """The form of masking and shadowing."""
    return choice(props, "masking", _MASKINGS)


def flag(props: mi.Properties, name: str) -> bool:
    """A boolean, false if it is not given."""
    value = props.get(name, False)
    if not isinstance(value, bool):
        raise ValueError(f"{name} = {value!r} must be true or false")
    return value


def gamma(props: mi.Properties) -> mi.Texture:
    """The shape: a number in [1.501, inf], also as a word, or a texture."""
    given = props.get("gamma", 2.0)
    if isinstance(given, (int, float, str)) and not isinstance(given, bool):
        try:
            number = float(given)
        except ValueError:
            number = math.nan
        if not number >= GAMMA[0]:
            raise ValueError(
                f"gamma = {given!r} must be a number in [1.501, inf] or a texture (2 is GGX, \"inf\""
                " is Beckmann): towards 1.5 one bounce returns no light; raise it, or leave it out"
                " for GGX"
            )
        return mi.load_dict({"type": "uniform", "value": min(number, GAMMA[1])})
    _refuse_colours(props, "gamma")
    return props.get_texture("gamma")


def _refuse_colours(props: mi.Properties, name: str) -> None:
    """Raises ``ValueError`` for what is neither a number nor a texture."""
    kinds = mi.Properties.Type
    if props.type(name) in (kinds.String, kinds.Color, kinds.Bool):
        raise ValueError(f"{name} = {props[name]} must be a number or a texture")


def number_in(
    props: mi.Properties, name: str, low: float, high: float, why: str
) -> None:
    """Raises ``ValueError`` if a property is a number outside [low, high]; a texture passes."""
    value = props[name]
    if isinstance(value, (int, float)) and not low <= value <= high:
        raise ValueError(f"{name} = {value:g} lies outside [{low:g}, {high:g}]: {why}")


def sigmas(props: mi.Properties) -> tuple[mi.Texture, mi.Texture]:
    """The roughness along u and v; the same texture twice where it is isotropic."""
    refuse_together(props, "sigma", ("sigma_u", "sigma_v"), "sigma is both of them")
    for name in ("sigma", "sigma_u", "sigma_v"):
        if name in props:
            _refuse_colours(props, name)
            number_in(props, name, *SIGMA, "smoother is a mirror, rougher is vertical")
    if ("sigma_u" in props) != ("sigma_v" in props):
        missing = "sigma_v" if "sigma_u" in props else "sigma_u"
        raise ValueError(f"{missing} is missing: give sigma_u and sigma_v, or sigma for both")
    if "sigma_u" in props:
        return props.get_texture("sigma_u"), props.get_texture("sigma_v")
    both = props.get_texture("sigma", 0.1)
    return both, both


def reflectance(props: mi.Properties, name: str) -> mi.Texture | None:
    """A colour in [0, 1], or none."""
    if name not in props:
        return None
    number_in(props, name, 0, 1, "it is a share of the light")
    return props.get_texture(name)


def set_of_tables(props: mi.Properties) -> Any:
    """The set of tables that a plugin reads: those built in, or those of a path."""
    import microfacet

    path = props.get("tables", "")
    if not isinstance(path, str):
        raise ValueError(f"tables = {path!r} must be the path of a set of tables")
    return microfacet.Tables(path) if path else microfacet.Tables()


def check_albedos(props: mi.Properties, stand_in: bool) -> None:
    """Raises ``ValueError`` for a roughness that compensation has no albedos of."""
    for name in ("sigma", "sigma_u", "sigma_v"):
        if name in props:
            why = "compensation has albedos up to there; lower it, or set compensation to none"
            number_in(props, name, SIGMA[0], SIGMA_OF_ALBEDOS, why)
    check_round(props, stand_in, ANISOTROPIC)


def check_round(props: mi.Properties, stand_in: bool, words: str) -> None:
    """Raises ``ValueError`` with these words for an anisotropic surface without a stand-in."""
    if "sigma_u" not in props or stand_in:
        return
    x, y = props["sigma_u"], props["sigma_v"]
    if not (isinstance(x, (int, float)) and x == y):
        raise ValueError(words)


def constant(texture: mi.Texture) -> mi.Float | None:
    """The value of a texture that is the same everywhere; else none."""
    if texture.is_spatially_varying():
        return None
    return texture.eval_1(dr.zeros(mi.SurfaceInteraction3f), True)


def round_sigma(
    sigma_u: mi.Texture,
    sigma_v: mi.Texture,
    stand_in: bool,
    highest: float = SIGMA_OF_ALBEDOS,
    words: str = ANISOTROPIC,
) -> float | None:
    """sqrt(sigma_u sigma_v) where neither varies, up to the highest; ``ValueError`` with the words
    if they differ and the round lobe may not stand in.
    """
    x, y = constant(sigma_u), constant(sigma_v)
    if x is None or y is None:
        return None
    x, y = (min(max(value(one), SIGMA[0]), highest) for one in (x, y))
    if x != y and not stand_in:
        raise ValueError(words)
    return math.sqrt(x * y)


def constant_gamma(texture: mi.Texture) -> float | None:
    """The shape where it is the same everywhere, in [1.501, inf], as it was written; else none."""
    found = constant(texture)
    if found is None:
        return None
    gamma = max(float(f"{value(found):.7g}"), GAMMA[0])
    return gamma if gamma < 0.99 * GAMMA[1] else math.inf


def range_of_gamma(texture: mi.Texture) -> tuple[float, float]:
    """The least and the largest shape of a texture, in [1.501, 1e18], as far as it is known."""
    one, values = constant_gamma(texture), mi.traverse(texture)
    if one is not None:
        return min(one, GAMMA[1]), min(one, GAMMA[1])
    if "data" not in values:
        return GAMMA
    data = np.asarray(values["data"])
    return float(np.clip(data.min(), *GAMMA)), float(np.clip(data.max(), *GAMMA))


def value(number: mi.Float) -> float:
    """A number of the variant, of one entry, as one of Python."""
    return number if isinstance(number, float) else float(dr.detach(number)[0])


def highest_sigma(compensation: str) -> float:
    """The largest roughness of a surface; with compensation that of the tables of albedos."""
    return SIGMA[1] if compensation == "none" else SIGMA_OF_ALBEDOS


def sigma_at(
    sigma_u: mi.Texture,
    sigma_v: mi.Texture,
    si: mi.SurfaceInteraction3f,
    active: mi.Bool,
    highest: float,
) -> mi.Vector2f:
    """The roughness along u and v, clamped to what :func:`highest_sigma` allows."""
    x = dr.clip(sigma_u.eval_1(si, active), SIGMA[0], highest)
    y = x if sigma_v is sigma_u else dr.clip(sigma_v.eval_1(si, active), SIGMA[0], highest)
    return mi.Vector2f(x, y)


def of_material(name: Any) -> dict[str, mi.Texture]:
    """eta and k of a material that Mitsuba has data of, such as "Au" or "Al"."""
    if not isinstance(name, str):
        raise ValueError(f"material = {name!r} must be the name of a metal, such as Au")
    try:
        native = mi.load_dict({"type": "roughconductor", "material": name})
    except RuntimeError:
        raise ValueError(
            f"material = {name!r} is none that Mitsuba has data of, such as Au, Ag, Cu and Al"
        ) from None
    found: dict[str, mi.Texture] = {}

    class Collector(mi.TraversalCallback):  # type: ignore[misc]
        def put(self, name: str, value: Any, flags: int) -> None:
            found[name] = value

    native.traverse(Collector())
    return {"eta": found["eta"], "k": found["k"]}


def index(props: mi.Properties) -> float:
    """The index of refraction inside over that outside, from ``int_ior`` and ``ext_ior``."""
    inside, outside = _ior(props, "int_ior", "bk7"), _ior(props, "ext_ior", "air")
    eta = inside / outside
    check_index(eta, f"int_ior/ext_ior = {inside:g}/{outside:g} = {eta:g}")
    return eta


def check_index(eta: float, what: str) -> None:
    """Raises ``ValueError`` for a ratio of indices that the plugin cannot have."""
    if not 1e-3 <= eta <= 1e3 or abs(eta - 1) < 1e-3:
        raise ValueError(
            f"{what} must lie in [0.001, 1000], and not within 0.001 of 1, where nothing is"
            " refracted; change it, or leave the surface out"
        )


def _ior(props: mi.Properties, name: str, default: str) -> float:
    """An index of refraction: a number, or the name of a material that Mitsuba has data of."""
    given = props.get(name, default)
    if isinstance(given, bool) or not isinstance(given, (int, float, str)):
        raise ValueError(f"{name} = {given!r} must be a number or a name, such as 1.5 or bk7")
    if isinstance(given, str):
        # Over vacuum, which is 1; an index of 1 has no interface there.
        if given == "vacuum":
            return 1.0
        description = {"type": "roughdielectric", "int_ior": given, "ext_ior": 1.0}
        try:
            found: Any = mi.traverse(mi.load_dict(description))["eta"]
        except RuntimeError:
            raise ValueError(
                f"{name} = {given!r} is none that Mitsuba has, such as bk7, water and diamond"
            ) from None
        return float(f"{value(found):.7g}")
    if not given > 0:
        raise ValueError(f"{name} = {given:g} must be above 0: it is an index of refraction")
    return float(given)
