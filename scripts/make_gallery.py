#!/usr/bin/env python3
"""Makes docs/gallery.md: a picture of each scene in docs/gallery, one for every bsdf, texture, emitter, sensor, shape,
volume, medium and phase function.

The scene FAMILY_TYPE.xml shows a type; what the page says of it is the sentence of `kaustik help`. A test tells which types
lack a scene. Some seconds for each picture, a hundred pictures.
"""

import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES, PICTURES = ROOT / "docs/gallery", ROOT / "docs/pictures/gallery"
TITLES = {"bsdf": "Materials", "texture": "Textures", "emitter": "Lights", "sensor": "Cameras", "shape": "Shapes",
          "volume": "Volumes", "medium": "Media", "phase": "Phase functions"}


def sentences_of(program):
    """What the program says of each (family, type), in its order."""
    family, found = "", {}
    for line in subprocess.run([program, "help"], check=True, capture_output=True, text=True).stdout.splitlines():
        if re.fullmatch(r"[a-z]+", line):
            family = line
        elif match := re.fullmatch(r"  (\S+)\s+(.*)", line):
            found.setdefault((family, match[1]), match[2])
    return found


def render(program, scene, picture, seconds):
    """What went wrong; None: nothing."""
    done = subprocess.run([program, "render", scene, "-q", "--time", f"{seconds}s", "-o", picture], capture_output=True, text=True)
    return done.stderr.strip() if done.returncode != 0 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/kaustik", help="[%(default)s]")
    parser.add_argument("--seconds", type=float, default=6, help="for each picture [%(default)s]")
    parser.add_argument("--only", nargs="+", default=[], metavar="FAMILY_TYPE", help="make these pictures alone")
    arguments = parser.parse_args()
    PICTURES.mkdir(parents=True, exist_ok=True)
    sentences = sentences_of(arguments.program)
    page = ["# Gallery", "",
            "A scene for every type, made by `make gallery` in some seconds each. `kaustik help TYPE` prints a type's parameters."]
    failures = []
    for family, title in TITLES.items():
        rows = []
        for (of, name), sentence in sentences.items():
            scene = SCENES / f"{family}_{name}.xml"
            if of != family or not scene.exists():
                continue
            picture = PICTURES / f"{scene.stem}.jpg"
            if not arguments.only or scene.stem in arguments.only:
                problem = render(arguments.program, scene, picture, arguments.seconds)
                print(f"{scene.stem}: {problem or 'made'}", flush=True)
                if problem:
                    failures.append(scene.stem)
            rows.append(f"| [![{name}](pictures/gallery/{picture.name})](gallery/{scene.name}) | **{name}**: {sentence} |")
        if rows:
            page += ["", f"## {title}", "", "| | |", "|---|---|", *rows]
    if failures:
        sys.exit(f"not made: {', '.join(failures)}")
    (ROOT / "docs/gallery.md").write_text("\n".join(page) + "\n")


if __name__ == "__main__":
    main()
