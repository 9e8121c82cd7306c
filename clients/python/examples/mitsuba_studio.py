"""A studio for the examples: a sphere on a chequered floor under a lamp, a window and the sky."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi


def studio(surface: dict[str, Any], width: int, height: int) -> mi.Scene:
    """The scene of a sphere with a surface."""
    at = mi.ScalarTransform4f
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 8},
        "sensor": {
            "type": "perspective", "fov": 19, "fov_axis": "smaller",
            "to_world": at().look_at([0, 2.4, 8], [0, 0.97, 0], [0, 1, 0]),
            "film": {
                "type": "hdrfilm", "width": width, "height": height,
                "rfilter": {"type": "gaussian"},
            },
        },
        "floor": {
            "type": "rectangle",
            "to_world": at().scale([40, 1, 40]) @ at().rotate([1, 0, 0], -90),
            "bsdf": {
                "type": "diffuse",
                "reflectance": {
                    "type": "checkerboard", "color0": 0.12, "color1": 0.35,
                    "to_uv": at().scale([40, 40, 1]),
                },
            },
        },
        "sphere": {"type": "sphere", "center": [0, 1, 0], "bsdf": surface},
        "lamp": {
            "type": "sphere", "center": [-2.4, 4.6, 4], "radius": 0.16,
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [200, 190, 176]}},
        },
        "window": {
            "type": "rectangle",
            "to_world": at().look_at([5, 3, 1.5], [0, 1, 0], [0, 1, 0]) @ at().scale([0.5, 1.2, 1]),
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [8, 8, 8]}},
        },
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.22, 0.2, 0.18]}},
    }  # fmt: skip
    return mi.load_dict(scene)


def picture(scene: mi.Scene, samples: int) -> mi.Bitmap:
    """The scene in bytes of sRGB, rendered in passes that fit into memory."""
    passes = max(1, -(-samples // 64))
    total = None
    for number in range(passes):
        some = mi.render(scene, spp=max(1, samples // passes), seed=number)
        total = some if total is None else total + some
        dr.eval(total)
    assert total is not None
    return mi.Bitmap(total / passes).convert(
        mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, srgb_gamma=True
    )
