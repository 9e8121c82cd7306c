"""Renders a sphere of gold whose facets follow the Student-t distribution.

::

    python examples/mitsuba_sphere.py --gamma 1.8 --sigma 0.15
"""

from __future__ import annotations

import argparse

import microfacet.mitsuba

microfacet.mitsuba.set_variant("llvm_ad_rgb")

from mitsuba_studio import picture, studio


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gamma", default="1.8", help="the shape, [1.501, inf]: 2 is GGX")
    parser.add_argument("--sigma", type=float, default=0.15, help="the roughness")
    parser.add_argument(
        "--compensation", choices=("none", "turquin", "kulla_conty"), default="kulla_conty"
    )
    parser.add_argument("--spp", type=int, default=128, help="samples of a pixel")
    parser.add_argument("--size", type=int, default=512, help="of the picture in pixels")
    parser.add_argument("--out", default="mitsuba_sphere.png", help="where the picture goes")
    options = parser.parse_args()

    gold = {
        "type": "student_t_conductor", "material": "Au", "gamma": options.gamma,
        "sigma": options.sigma, "compensation": options.compensation,
    }  # fmt: skip
    scene = studio(gold, options.size, options.size)
    picture(scene, options.spp).write(options.out)
    print(options.out)


if __name__ == "__main__":
    main()
