"""Renders the passes of a picture in several processes and adds them up: the bits are those of one process.

multiprocessing has to *spawn* its processes: threads do not survive a fork. Dask, Ray and mpi4py distribute
films in the same way, since they pickle. Usage: processes.py [SCENE.xml]
"""

import multiprocessing
import sys

import kaustik

PASSES, PARTS = 8, 2


def a_scene() -> kaustik.Scene:
    """A gold ring under a small lamp."""
    return kaustik.load_dict({
        "type": "scene",
        "camera": {"type": "perspective", "fov": 40,
                   "to_world": kaustik.Transform().look_at(origin=(0, -3, 3), target=(0, 0, 0), up=(0, 0, 1)),
                   "film": {"type": "hdrfilm", "width": 48, "height": 32}},
        "lamp": {"type": "point", "position": (1.5, 0, 1.5), "intensity": 10.0},
        "floor": {"type": "rectangle", "to_world": kaustik.Transform().scale(3),
                  "bsdf": {"type": "diffuse", "reflectance": 0.7}},
        "ring": {"type": "cylinder", "p0": (0, 0, 0), "p1": (0, 0, 0.3), "radius": 0.8,
                 "bsdf": {"type": "twosided", "bsdf": {"type": "conductor", "material": "Au"}}},
    })


def render_part(scene: kaustik.Scene, first_pass: int, passes: int) -> kaustik.Film:
    return kaustik.render(scene, first_pass=first_pass, passes=passes, samples_per_pass=4).film


def main() -> None:
    scene = kaustik.load_file(sys.argv[1]) if len(sys.argv) > 1 else a_scene()
    each = PASSES // PARTS
    with multiprocessing.get_context("spawn").Pool(PARTS) as pool:
        films = pool.starmap(render_part, [(scene, first, each) for first in range(0, PASSES, each)])
    film = sum(films)
    print(film)
    print("the same bits:", film == render_part(scene, 0, PASSES))


if __name__ == "__main__":
    main()
