#!/usr/bin/env python3
"""Makes docs/gallery.md: a picture of every bsdf, texture, emitter, sensor, shape, volume, medium and phase function.

The types come from `kaustik help`. A type without a row here is shown with its defaults; one that needs more fails, with the
program's message, so that nobody forgets a row. About SECONDS for each picture, a hundred pictures.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs/pictures/gallery"
SIZE = 240
FAMILIES = ["bsdf", "texture", "emitter", "sensor", "shape", "volume", "medium", "phase"]

# Types that other rows show: they hold others, or stand for them.
SHOWN_ELSEWHERE = {"shape": {"shapegroup", "merge"}, "emitter": set(), "sensor": {"batch"}}


def numbers(**values):
    return "".join(f'<float name="{name}" value="{value}"/>' for name, value in values.items())


def text(name, value):
    return f'<string name="{name}" value="{value}"/>'


def rgb(name, value):
    return f'<rgb name="{name}" value="{value}"/>'


def transform(*operations, name="to_world"):
    return f'<transform name="{name}">{"".join(operations)}</transform>'


def look_at(origin, target, up="0, 1, 0"):
    return f'<lookat origin="{origin}" target="{target}" up="{up}"/>'


def translate(by):
    return f'<translate value="{by}"/>'


def scale(by):
    return f'<scale value="{by}"/>'


def rotate(axis, degrees):
    return f'<rotate value="{axis}" angle="{degrees}"/>'


def element(family, kind, inside="", name=""):
    return f'<{family} type="{kind}"{f" name={chr(34)}{name}{chr(34)}" if name else ""}>{inside}</{family}>'


def diffuse(colour):
    return element("bsdf", "diffuse", rgb("reflectance", colour))


def film():
    return (f'<film type="hdrfilm"><integer name="width" value="{SIZE}"/><integer name="height" value="{SIZE}"/></film>')


def camera(origin="0, 1.5, 5", target="0, 0.75, 0", fov=30):
    return element("sensor", "perspective", numbers(fov=fov) + transform(look_at(origin, target)) + film())


CHECKER = element("texture", "checkerboard", rgb("color0", "0.55, 0.53, 0.5") + rgb("color1", "0.3, 0.31, 0.33") +
                  transform(scale("12"), name="to_uv"), "reflectance")
FLOOR = element("shape", "rectangle", transform(scale("6"), rotate("1, 0, 0", -90)) + element("bsdf", "diffuse", CHECKER))
LAMP = element("shape", "rectangle", transform(scale("0.5"), rotate("1, 0, 0", 90), rotate("0, 0, 1", -25), translate("-2, 4, -0.5")) +
               element("emitter", "area", rgb("radiance", "40, 38, 34")))
SKY = element("emitter", "constant", rgb("radiance", "0.25, 0.28, 0.33"))
PICTURE = str(ROOT / "docs/pictures/cornell_box.png")


def ball(inside, radius=0.75):
    return element("shape", "sphere", f'<point name="center" value="0, {radius}, 0"/>' + numbers(radius=radius) + inside)


def of_bsdf(kind, inside):
    return camera() + FLOOR + LAMP + SKY + ball(element("bsdf", kind, inside))


def of_texture(kind, inside):
    board = element("shape", "rectangle", transform(scale("1.6"), translate("0, 1.6, -1.2")) +
                    element("bsdf", "diffuse", element("texture", kind, inside, "reflectance")))
    globe = ball(element("bsdf", "diffuse", element("texture", kind, inside, "reflectance")), 0.6)
    return camera(fov=36) + FLOOR + LAMP + SKY + board + globe


def room():
    walls = ""
    for place in [transform(scale("2"), rotate("1, 0, 0", -90)), transform(scale("2"), translate("0, 2, -2")),
                  transform(scale("2"), rotate("0, 1, 0", 90), translate("-2, 2, 0")),
                  transform(scale("2"), rotate("0, 1, 0", -90), translate("2, 2, 0"))]:
        walls += element("shape", "rectangle", place + diffuse("0.7, 0.68, 0.64"))
    return walls + ball(diffuse("0.5, 0.25, 0.2"), 0.6)


def of_emitter(kind, inside):
    needs_shape = kind in {"area", "directionalarea"}
    light = element("emitter", kind, inside)
    if needs_shape:
        light = element("shape", "rectangle", transform(scale("0.5"), rotate("1, 0, 0", 90), translate("0, 3.4, 0")) + light)
    return camera("0, 2, 7", "0, 1.6, 0", 36) + room() + light


def of_sensor(kind, inside):
    balls = ""
    for i, colour in enumerate(["0.7, 0.3, 0.2", "0.7, 0.6, 0.2", "0.3, 0.6, 0.3", "0.2, 0.4, 0.7", "0.5, 0.3, 0.6"]):
        place = f'<point name="center" value="{1.1 * (i - 2)}, 0.45, {-1.5 * i}"/>'
        balls += element("shape", "sphere", place + numbers(radius=0.45) + diffuse(colour))
    meter = element("sensor", kind, inside + film())
    if kind == "irradiancemeter":
        return FLOOR.replace("</shape>", meter + "</shape>") + LAMP + SKY + balls
    return meter + FLOOR + LAMP + SKY + balls


def of_shape(kind, inside):
    paint = element("bsdf", "twosided", element("bsdf", "plastic", rgb("diffuse_reflectance", "0.25, 0.45, 0.5")))
    if kind == "instance":
        group = f'<shape type="shapegroup" id="pair">{element("shape", "cube", transform(scale("0.3"), translate("0, 0.3, 0")) + paint)}</shape>'
        return camera() + FLOOR + LAMP + SKY + group + "".join(
            f'<shape type="instance"><ref id="pair"/>{transform(rotate("0, 1, 0", 40 * i), translate(f"{i - 1}, 0, 0"))}</shape>'
            for i in range(3))
    return camera() + FLOOR + LAMP + SKY + element("shape", kind, inside + paint)


def of_medium(kind, inside):
    spot = element("emitter", "spot", rgb("intensity", "60, 55, 45") + numbers(cutoff_angle=14) +
                   transform(look_at("-2.5, 4, 1.5", "0, 0.7, 0")))
    box = element("shape", "cube", transform(scale("0.9, 0.75, 0.9"), translate("0, 0.76, 0")) + element("bsdf", "null") +
                  element("medium", kind, inside, "interior"))
    return camera() + FLOOR + spot + element("emitter", "constant", rgb("radiance", "0.1, 0.1, 0.12")) + box


def of_phase(kind, inside):
    return of_medium("homogeneous", numbers(sigma_t=1.2) + rgb("albedo", "0.95, 0.95, 0.95") + element("phase", kind, inside))


def of_volume(kind, inside):
    return of_medium("heterogeneous", element("volume", kind, inside, "sigma_t") + numbers(scale=3, albedo=0.9))


SCENES = {"bsdf": of_bsdf, "texture": of_texture, "emitter": of_emitter, "sensor": of_sensor, "shape": of_shape,
          "medium": of_medium, "phase": of_phase, "volume": of_volume}

GOLD = text("material", "Au")
PAPER, GLASS = diffuse("0.8, 0.75, 0.6"), element("bsdf", "dielectric")
GREEN = rgb("diffuse_reflectance", "0.15, 0.4, 0.2")
VIEW = transform(look_at("0, 1.5, 5", "0, 0.75, 0"))
DOWN = transform(look_at("1.2, 3.6, 1.5", "0, 0.5, 0"))
RIPPLES = element("texture", "waves", "", "texture")
SLAB = transform(rotate("0, 1, 0", 30), translate("0, 0.75, 0"))

# What stands in the element of a type; those that are missing have their defaults.
ROWS = {
    "bsdf": {
        "diffuse": rgb("reflectance", "0.6, 0.25, 0.15"), "roughdiffuse": rgb("reflectance", "0.6, 0.25, 0.15") + numbers(roughness=1),
        "phong": GREEN + rgb("specular_reflectance", "0.3") + numbers(exponent=60), "conductor": GOLD,
        "roughconductor": GOLD + numbers(alpha=0.2), "roughdielectric": numbers(alpha=0.15), "plastic": GREEN,
        "roughplastic": GREEN + numbers(alpha=0.2),
        "principled": rgb("base_color", "0.7, 0.35, 0.1") + numbers(metallic=0.3, roughness=0.3, clearcoat=1),
        "principledthin": rgb("base_color", "0.3, 0.6, 0.3") + numbers(roughness=0.4, diff_trans=1.2, spec_trans=0.2),
        "openpbr": rgb("base_color", "0.6, 0.1, 0.1") + numbers(coat_weight=1), "ward": GREEN + numbers(alpha_u=0.05, alpha_v=0.3),
        "difftrans": rgb("transmittance", "0.6, 0.5, 0.3"), "mask": numbers(opacity=0.5) + PAPER,
        "twosided": PAPER, "blendbsdf": numbers(weight=0.5) + PAPER + element("bsdf", "conductor", GOLD),
        "mixturebsdf": text("weights", "0.5, 0.5") + PAPER + element("bsdf", "conductor", GOLD),
        "bumpmap": RIPPLES + element("bsdf", "plastic", GREEN), "coating": PAPER, "roughcoating": PAPER,
        "normalmap": element("texture", "checkerboard", rgb("color0", "0.5, 0.5, 1") + rgb("color1", "0.65, 0.5, 0.9") +
                             transform(scale("12"), name="to_uv"), "normalmap") + element("bsdf", "plastic", GREEN),
    },
    "texture": {"bitmap": text("filename", PICTURE), "checkerboard": transform(scale("6"), name="to_uv"),
                "scale": element("texture", "checkerboard", transform(scale("6"), name="to_uv")) + numbers(scale=0.5)},
    "emitter": {
        "area": rgb("radiance", "12, 11, 10"), "directionalarea": rgb("radiance", "12, 11, 10"),
        "point": '<point name="position" value="0, 3, 0.5"/>' + rgb("intensity", "12"), "spot": DOWN + rgb("intensity", "50"),
        "directional": '<vector name="direction" value="-0.5, -1, -0.7"/>' + rgb("irradiance", "3"),
        "constant": rgb("radiance", "0.5"), "envmap": text("filename", PICTURE), "background": rgb("radiance", "0.5"),
        "distributed": '<point name="position" value="0, 3, 0.5"/>' + rgb("intensity", "12"),
        "distributedspot": DOWN + rgb("intensity", "50"),
        "projector": element("texture", "bitmap", text("filename", PICTURE), "irradiance") + numbers(fov=40, scale=60) + DOWN,
        "sunsky": '<vector name="sun_direction" value="0.5, 1, 0.9"/>' + numbers(sun_scale=0.05, sky_scale=0.05),
        "sky": '<vector name="sun_direction" value="0.5, 1, 0.9"/>' + numbers(scale=0.05),
        "sun": '<vector name="sun_direction" value="0.5, 1, 0.9"/>' + numbers(scale=0.05),
    },
    "sensor": {
        "perspective": VIEW + numbers(fov=40), "thinlens": VIEW + numbers(fov=40, aperture_radius=0.2, focus_distance=6.5),
        "orthographic": transform(scale("2.5"), look_at("0, 3, 5", "0, 0.5, -1.5")),
        "fisheye": transform(look_at("0, 0.8, 1", "0, 0.6, -2")), "spherical": transform(look_at("0, 0.8, 1", "0, 0.8, -2")),
        "cylinder": transform(look_at("0, 0.8, 1", "0, 0.8, -2")), "radiancemeter": VIEW, "irradiancemeter": "",
        "distant": '<vector name="direction" value="0, -1, 0"/>',
    },
    "shape": {
        "rectangle": SLAB, "disk": SLAB, "cube": transform(scale("0.6"), rotate("0, 1, 0", 30), translate("0, 0.6, 0")),
        "sphere": transform(scale("0.75"), translate("0, 0.75, 0")),
        "cylinder": '<point name="p0" value="0, 0, 0"/><point name="p1" value="0, 1.4, 0"/>' + numbers(radius=0.5),
        "ply": text("filename", str(ROOT / "scenes/metal_ring/meshes/ring.ply")),
    },
    "medium": {"homogeneous": numbers(sigma_t=1.5) + rgb("albedo", "0.9, 0.95, 0.98"),
               "heterogeneous": element("volume", "constvolume", numbers(value=1.5), "sigma_t")},
    "phase": {"hg": numbers(g=0.7), "tabphase": text("values", "0.2, 0.3, 0.5, 1, 3"),
              "blendphase": element("phase", "isotropic") + element("phase", "hg")},
    "volume": {"constvolume": numbers(value=1)},
}

# Of these a picture takes a file or buffers of its own.
WITHOUT_PICTURE = {"shape": {"obj", "serialized", "mesh", "sdf", "sdfgrid", "heightfield"}, "volume": {"gridvolume"},
                   "texture": {"mesh_attribute", "vertexcolors", "volume"}}


def types_of(program):
    """(family, name, sentence) of all that there is."""
    family, found = "", []
    for line in subprocess.run([program, "help"], check=True, capture_output=True, text=True).stdout.splitlines():
        if re.fullmatch(r"[a-z]+", line):
            family = line
        elif match := re.fullmatch(r"  (\S+)\s+(.*)", line):
            if family in FAMILIES:
                found.append((family, *match.groups()))
    return found


def render(program, scene, picture, seconds):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "scene.xml"
        file.write_text(f'<scene version="3.0.0">{scene}</scene>')
        done = subprocess.run([program, "render", file, "-q", "--time", f"{seconds}s", "-o", picture], capture_output=True, text=True)
        if done.returncode != 0:
            return done.stderr.strip()
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/kaustik", help="[%(default)s]")
    parser.add_argument("--seconds", type=float, default=6, help="for each picture [%(default)s]")
    parser.add_argument("--only", nargs="+", default=[], metavar="TYPE", help="make these pictures alone; the page stays")
    arguments = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    page = ["# Gallery", "", "A picture of every type that there is, made by `make gallery` in some seconds each; `kaustik help TYPE`",
            "prints its parameters."]
    failures, last = [], ""
    for family, name, sentence in types_of(arguments.program):
        if name in SHOWN_ELSEWHERE.get(family, set()) or (arguments.only and name not in arguments.only):
            continue
        if family != last:
            page += ["", f"## {family}", "", "| | |", "|---|---|"]
            last = family
        shown = ""
        if name not in WITHOUT_PICTURE.get(family, set()):
            picture = FOLDER / f"{family}_{name}.jpg"
            problem = render(arguments.program, SCENES[family](name, ROWS[family].get(name, "")), picture, arguments.seconds)
            if problem:
                failures.append(f"{family} {name}: {problem}")
            print(f"{family} {name}: {'failed' if problem else 'made'}", flush=True)
            shown = f"![{name}](pictures/gallery/{picture.name})"
        page.append(f"| {shown} | **{name}**: {sentence} |")
    if failures:
        sys.exit("\n".join(failures))
    if not arguments.only:
        (ROOT / "docs/gallery.md").write_text("\n".join(page) + "\n")


if __name__ == "__main__":
    main()
