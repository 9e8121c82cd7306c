"""What cannot be rendered is refused, with the value, its range and what to do."""

from __future__ import annotations

from typing import Any

import mitsuba as mi
import pytest

CONDUCTOR: list[tuple[dict[str, Any], list[str]]] = [
    ({"gamma": 1.5}, ["gamma = 1.5", "[1.501, inf]", "raise it"]),
    ({"gamma": "large"}, ["gamma = 'large'", "[1.501, inf]", "inf"]),
    ({"gamma": float("nan")}, ["gamma = nan", "[1.501, inf]"]),
    ({"gamma": {"type": "rgb", "value": [2.0, 3.0, 4.0]}}, ["gamma", "a number or a texture"]),
    ({"gamma": True}, ["gamma = True", "a number or a texture"]),
    ({"sigma": 0.0}, ["sigma = 0", "[0.0001, 10]"]),
    ({"sigma": 20.0}, ["sigma = 20", "[0.0001, 10]"]),
    ({"sigma": 5.0, "compensation": "turquin"}, ["sigma = 5", "[0.0001, 3]", "none"]),
    ({"sigma": 0.1, "sigma_u": 0.2}, ["sigma and sigma_u", "remove one"]),
    ({"sigma_u": 0.2}, ["sigma_v is missing"]),
    ({"sigma_x": 0.2, "sigma_y": 0.3}, ["'sigma_x'", "its name is sigma_u"]),
    ({"alpha": 0.2}, ["'alpha'", "sigma is what other plugins call alpha"]),
    ({"sgima": 0.2}, ["'sgima'", "did you mean sigma?"]),
    ({"compensation": "heitz"}, ["compensation = 'heitz'", "none, turquin, kulla_conty"]),
    ({"masking": "smith"}, ["masking = 'smith'", "height-correlated, uncorrelated"]),
    ({"f0": 1.5}, ["f0 = 1.5", "[0, 1]"]),
    ({"f82": 0.5}, ["f82", "give f0"]),
    ({"f0": 0.5, "eta": 0.2, "k": 3.0}, ["f0 and eta", "remove one"]),
    ({"material": "Au", "k": 3.0}, ["material and k", "remove one"]),
    ({"material": "Unobtainium"}, ["material = 'Unobtainium'"]),
    ({"eta": 0.2}, ["k is missing"]),
    ({"eta": -1.0, "k": 3.0}, ["eta = -1", "[0.001, 1000]"]),
    ({"eta": 1.0, "k": -3.0}, ["k = -3", "[0, 1000]"]),
    ({"stand_in": 3}, ["stand_in = 3", "true or false"]),
    ({"tables": "/no/such/set"}, ["/no/such/set"]),
    (
        {"sigma_u": 0.1, "sigma_v": 0.2, "compensation": "kulla_conty"},
        ["anisotropic", "stand_in", "none"],
    ),
]

DIELECTRIC: list[tuple[dict[str, Any], list[str]]] = [
    ({"int_ior": -1.0}, ["int_ior = -1", "above 0"]),
    ({"int_ior": "treacle"}, ["int_ior = 'treacle'"]),
    ({"int_ior": 1.5, "ext_ior": 1.5}, ["1.5/1.5 = 1", "[0.001, 1000]"]),
    ({"f0": 0.5}, ["'f0'", "there are"]),
    ({"compensation": "turquin", "int_ior": 2.25, "ext_ior": 1.0}, ["2.25"]),
    (
        {"compensation": "turquin", "sigma": {"type": "checkerboard"}},
        ["sigma is a texture", "none"],
    ),
    (
        {"compensation": "kulla_conty", "gamma": {"type": "checkerboard"}},
        ["gamma is a texture", "make gamma a number", "none"],
    ),
]


PLASTIC: list[tuple[dict[str, Any], list[str]]] = [
    ({"int_ior": 1.5, "ext_ior": 1.5}, ["1.5/1.5 = 1", "[0.001, 1000]"]),
    ({"diffuse_reflectance": 1.5}, ["diffuse_reflectance = 1.5", "[0, 1]"]),
    ({"nonlinear": True}, ["'nonlinear'", "there are"]),
    ({"sigma": 20.0}, ["sigma = 20", "[0.0001, 10]"]),
    ({"sigma_u": 0.1, "sigma_v": 0.2}, ["stand_in", "sigma_u and sigma_v the same number"]),
    ({"gamma": {"type": "checkerboard"}}, ["gamma is a texture", "make gamma a number"]),
    ({"compensation": "turquin", "int_ior": 2.25, "ext_ior": 1.0}, ["dielectric = 2.25"]),
    ({"compensation": "kulla_conty", "int_ior": 2.25, "ext_ior": 1.0}, ["dielectric = 2.25"]),
    (
        {"compensation": "turquin", "sigma": {"type": "checkerboard"}},
        ["sigma is a texture", "none"],
    ),
]


@pytest.mark.parametrize(("properties", "words"), CONDUCTOR)
def test_conductors(properties: dict[str, Any], words: list[str]) -> None:
    refused("student_t_conductor", properties, words)


@pytest.mark.parametrize(("properties", "words"), DIELECTRIC)
def test_dielectrics(properties: dict[str, Any], words: list[str]) -> None:
    refused("student_t_dielectric", properties, words)


@pytest.mark.parametrize(("properties", "words"), PLASTIC)
def test_plastics(properties: dict[str, Any], words: list[str]) -> None:
    refused("student_t_plastic", properties, words)


def refused(plugin: str, properties: dict[str, Any], words: list[str]) -> None:
    """Mitsuba hands errors of plugins on as ``RuntimeError``."""
    with pytest.raises(RuntimeError) as caught:
        mi.load_dict({"type": plugin, **properties})
    message = str(caught.value)
    assert "\nValueError: " in message or "tables" in properties, message
    for word in words:
        assert word in message


def test_the_stand_in_for_an_anisotropic_surface() -> None:
    mi.load_dict(
        {
            "type": "student_t_conductor", "sigma_u": 0.1, "sigma_v": 0.2,
            "compensation": "kulla_conty", "stand_in": True,
        }
    )  # fmt: skip
