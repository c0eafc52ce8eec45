"""A gold ring on a table in the sun: the light that it throws together is a caustic. docs/guides/python.md explains it.

Usage: first_caustic.py [PICTURE]
"""

import sys

import kaustik

scene = kaustik.load_dict({
    "type": "scene",
    "camera": {"type": "perspective", "fov": 30, "film": {"type": "hdrfilm", "width": 480, "height": 320},
               "to_world": kaustik.Transform().look_at(origin=(-0.6, -3, 3.4), target=(0.1, 0.05, 0), up=(0, 0, 1))},
    "sun": {"type": "directional", "direction": (0.9, 0.5, -0.75), "irradiance": 3.0},
    "sky": {"type": "constant", "radiance": {"type": "rgb", "value": (0.05, 0.07, 0.1)}},
    "table": {"type": "rectangle", "to_world": kaustik.Transform().scale(20), "bsdf": {"type": "diffuse"}},
    "ring": {"type": "cylinder", "radius": 0.8, "p1": (0, 0, 0.4), "bsdf": {
        "type": "twosided", "bsdf": {"type": "conductor", "material": "Au"}}},
})
picture = kaustik.render(scene, spp=64)
picture.write(sys.argv[1] if len(sys.argv) > 1 else "first_caustic.png")

print("the whole picture:", picture.mean())
print("in the caustic:   ", picture.mean((312, 90, 20, 14)))
