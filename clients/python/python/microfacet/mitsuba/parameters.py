"""Reads the properties of the plugins, and refuses with words what cannot be rendered."""

from __future__ import annotations

import difflib
import math
from typing import Any, Iterable

import drjit as dr
import mitsuba as mi

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
    " sqrt(sigma_x sigma_y) stands in, which gives back too much or too little light; or set"
    " compensation to none"
)

_HINTS = {
    "alpha": "sigma is what other plugins call alpha",
    "alpha_u": "sigma_x is what other plugins call alpha_u",
    "alpha_v": "sigma_y is what other plugins call alpha_v",
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


def gamma(props: mi.Properties) -> float:
    """The shape, a constant in [1.501, inf], also as a word."""
    value = props.get("gamma", 2.0)
    try:
        number = float(value)
    except (TypeError, ValueError):
        given = repr(value) if isinstance(value, str) else type(value).__name__
        raise ValueError(
            f"gamma = {given} must be a number in [1.501, inf], the same for the whole surface"
            ' (2 is GGX, "inf" is Beckmann)'
        ) from None
    if not number >= 1.501:
        raise ValueError(
            f"gamma = {number:g} lies outside [1.501, inf]: towards 1.5 one bounce returns no"
            " light; raise it, or leave it out for GGX (2)"
        )
    return number


def number_in(
    props: mi.Properties, name: str, low: float, high: float, why: str
) -> None:
    """Raises ``ValueError`` if a property is a number outside [low, high]; a texture passes."""
    value = props[name]
    if isinstance(value, (int, float)) and not low <= value <= high:
        raise ValueError(f"{name} = {value:g} lies outside [{low:g}, {high:g}]: {why}")


def sigmas(props: mi.Properties) -> tuple[mi.Texture, mi.Texture]:
    """The roughness along x and y; the same texture twice where it is isotropic."""
    refuse_together(props, "sigma", ("sigma_x", "sigma_y"), "sigma is both of them")
    for name in ("sigma", "sigma_x", "sigma_y"):
        if name in props:
            if props.type(name) in (mi.Properties.Type.String, mi.Properties.Type.Color):
                raise ValueError(f"{name} = {props[name]} must be a number or a texture")
            number_in(props, name, *SIGMA, "smoother is a mirror, rougher is vertical")
    if ("sigma_x" in props) != ("sigma_y" in props):
        missing = "sigma_y" if "sigma_x" in props else "sigma_x"
        raise ValueError(f"{missing} is missing: give sigma_x and sigma_y, or sigma for both")
    if "sigma_x" in props:
        return props.get_texture("sigma_x"), props.get_texture("sigma_y")
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
    for name in ("sigma", "sigma_x", "sigma_y"):
        if name in props:
            why = "compensation has albedos up to there; lower it, or set compensation to none"
            number_in(props, name, SIGMA[0], SIGMA_OF_ALBEDOS, why)
    check_round(props, stand_in, ANISOTROPIC)


def check_round(props: mi.Properties, stand_in: bool, words: str) -> None:
    """Raises ``ValueError`` with these words for an anisotropic surface without a stand-in."""
    if "sigma_x" not in props or stand_in:
        return
    x, y = props["sigma_x"], props["sigma_y"]
    if not (isinstance(x, (int, float)) and x == y):
        raise ValueError(words)


def constant(texture: mi.Texture) -> mi.Float | None:
    """The value of a texture that is the same everywhere; else none."""
    if texture.is_spatially_varying():
        return None
    return texture.eval_1(dr.zeros(mi.SurfaceInteraction3f), True)


def round_sigma(
    sigma_x: mi.Texture,
    sigma_y: mi.Texture,
    stand_in: bool,
    highest: float = SIGMA_OF_ALBEDOS,
    words: str = ANISOTROPIC,
) -> float | None:
    """sqrt(sigma_x sigma_y) where neither varies, up to the highest; ``ValueError`` with the words
    if they differ and the round lobe may not stand in.
    """
    x, y = constant(sigma_x), constant(sigma_y)
    if x is None or y is None:
        return None
    x, y = (min(max(value(one), SIGMA[0]), highest) for one in (x, y))
    if x != y and not stand_in:
        raise ValueError(words)
    return math.sqrt(x * y)


def value(number: mi.Float) -> float:
    """A number of the variant, of one entry, as one of Python."""
    return number if isinstance(number, float) else float(dr.detach(number)[0])


def highest_sigma(compensation: str) -> float:
    """The largest roughness of a surface; with compensation that of the tables of albedos."""
    return SIGMA[1] if compensation == "none" else SIGMA_OF_ALBEDOS


def sigma_at(
    sigma_x: mi.Texture,
    sigma_y: mi.Texture,
    si: mi.SurfaceInteraction3f,
    active: mi.Bool,
    highest: float,
) -> mi.Vector2f:
    """The roughness along x and y, clamped to what :func:`highest_sigma` allows."""
    x = dr.clip(sigma_x.eval_1(si, active), SIGMA[0], highest)
    y = x if sigma_y is sigma_x else dr.clip(sigma_y.eval_1(si, active), SIGMA[0], highest)
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
