#!/usr/bin/env python3
"""Makes docs/scenes.md: pictures of scenes that ship, by the default method and denoised, with its command, time
and error.

Usage: scripts/make_pictures.py [--program build/release/kaustik] [--only SCENE ...]

Facts of a picture are kept beside it, so that those of a few scenes can be made anew: docs/pictures/scenes/made.json.
Minutes for each picture: no other work should run meanwhile.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs/pictures/scenes"
PAGE = ROOT / "docs/scenes.md"
RADIANCE = ROOT / "out/scenes"  # the same with all layers, not kept

SQUARE, WIDE = "-D size=1280", "-D width=1280 -D height=960"
FILE_SQUARE, FILE_WIDE = (f"--set film.width=1280 --set film.height={height}" for height in (1280, 960))
BRIGHT = SQUARE + " --tonemap reinhard"
# Files below scenes/ that are not NAME/NAME.xml.
FILES = {
    "pbrt": "formats/pbrt/drink.pbrt",
    "gltf": "formats/gltf/still_life.glb",
    "obj": "formats/obj/goblets.obj",
    "radiance": "formats/radiance/office.rif",
    "nori": "formats/nori/box.xml",
}
# Of each: options of the size and the tones, time, what it shows. README.md and docs/formats show some.
SCENES = {
    "atrium": (SQUARE, "3m", "72 crystals above a fountain"),
    "pool_below": (BRIGHT, "3m", "caustics through real waves"),
    "pool_above": (BRIGHT, "3m", "lamps under bump-mapped water"),
    "museum": (SQUARE, "3m", "evening sun, lamps on exhibits"),
    "gallery_1": (WIDE, "3m", "a room lit through lampshades"),
    "gallery_2": (WIDE, "3m", "marble and lampshades"),
    "maze": (SQUARE, "2m", "lamps in its ways"),
    "point_spotlight": (SQUARE, "2m", "one lamp on a red screen"),
    "metal_ring": (SQUARE, "2m", "gold, a small lamp, the cardioid inside"),
    "cornell_box": (SQUARE, "1m", "the box as it was measured"),
    "prism": ("-D size=1280 -D height=800", "3m", "white light through flint glass"),
    "soap_bubbles": ("-D size=1280 -D height=800", "3m", "films of soap by a window"),
    "cornell_spheres": (SQUARE, "2m", "mirror and glass in the box"),
    "pbrt": (FILE_WIDE, "2m", "a scene of pbrt: tea, flint glass, gold, a translucent pebble"),
    "gltf": (FILE_WIDE, "2m", "a scene in glTF: crystal, stones, gold, a spot lamp"),
    "obj": (FILE_WIDE, "2m", "an OBJ file with its materials, in the studio that files without lamps get"),
    "radiance": (FILE_WIDE, "2m", "a scene of Radiance: sun and sky through a blind, a desk lamp"),
    "nori": (FILE_SQUARE, "1m", "a scene of Nori: glass and mirror in a box"),
}


def run(program, *arguments):
    done = subprocess.run([program, *arguments], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"kaustik {' '.join(arguments)}\n{done.stderr.strip()}")
    return done.stderr


def facts_of(log):
    """Number of passes and error of the pixels, as the program prints them at the end."""
    mean = re.search(r"mean of the picture: ±(\S+ %) \(95 % confidence, (\d+) passes\)", log)
    pixels = re.search(r"error of the pixels: (\S+ %)", log)
    return {"passes": int(mean[2]) if mean else 1, "mean": mean[1] if mean else None,
            "pixels": pixels[1] if pixels else None}


def file_of(name):
    return "scenes/" + FILES.get(name, f"{name}/{name}.xml")


def make_picture(program, name, made):
    options, time, _ = SCENES[name]
    command = ["render", file_of(name), *options.split(), "--time", time, "--denoise", "-o", f"{name}.jpg"]
    arguments = command[:-1] + [str(PICTURES / f"{name}.jpg"), "-o", str(RADIANCE / f"{name}.exr"), "--progress", "plain"]
    made[name] = {"command": "kaustik " + " ".join(command), "time": time, "cores": os.cpu_count(),
                  **facts_of(run(program, *arguments))}


def said_of(facts):
    passes = f"{facts['passes']} pass{'es' if facts['passes'] > 1 else ''}"
    error = f", error of the pixels {facts['pixels']}" if facts["pixels"] else ""
    return f"{facts['time']} on {facts['cores']} cores, {passes}{error}"


def page(made):
    lines = ["# Scenes", "",
             "Scenes that ship, by the default method `auto`, denoised, made by `scripts/make_pictures.py`. Below each",
             "picture stand its command, the time, and the standard error of its pixels (root mean square) before denoising, as",
             "the program prints it. [Comparisons](comparisons.md) shows `auto` beside other methods at equal time.", ""]
    for name, (_, _, shows) in SCENES.items():
        if name in made:
            lines += [f"## {name}", "", f"![{name}: {shows}](pictures/scenes/{name}.jpg)", "",
                      f"[`{name}`](../{pathlib.PurePath(file_of(name)).parent}): {shows}. {said_of(made[name])}.", "",
                      "```sh", made[name]["command"], "```", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/kaustik", help="[%(default)s]")
    parser.add_argument("--only", nargs="+", choices=list(SCENES), metavar="SCENE", help="make these pictures alone")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    if not program.is_file():
        sys.exit(f"there is no program {program}\n  remedy: build it (make build), or name another: --program")
    for folder in (PICTURES, RADIANCE):
        folder.mkdir(parents=True, exist_ok=True)
    facts = PICTURES / "made.json"
    made = json.loads(facts.read_text()) if facts.exists() else {}
    for name in arguments.only or SCENES:
        make_picture(program, name, made)
        print(f"{name}: made", flush=True)
        facts.write_text(json.dumps(made, indent=1, ensure_ascii=False) + "\n")
        PAGE.write_text(page(made))


if __name__ == "__main__":
    main()
