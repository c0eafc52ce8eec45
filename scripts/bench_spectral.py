#!/usr/bin/env python3
"""Measures spectral mode (docs/theory/color.md): how far colours are off after some passes, what it costs beside
RGB mode, and how `auto` compares with `path` where glass disperses.

Usage: scripts/bench_spectral.py [--program build/release/kaustik] [--seconds 30]

Needs nothing but Python and the program. Minutes, during which no other work should run: times are those of this
machine, ratios hold elsewhere, too. Prints a table in Markdown for each question."""

import argparse
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LAMPS = {
    "D65": '<rgb name="irradiance" value="3.14159265"/>',
    "black body, 2856 K": '<spectrum name="irradiance" type="blackbody">'
                          '<float name="temperature" value="2856"/><float name="scale" value="1e-4"/></spectrum>',
    "white LED": '<spectrum name="irradiance" value="400:0, 430:0.1, 450:1, 470:0.2, 490:0.1, 550:0.6, 600:0.5,'
                 ' 680:0.1, 760:0"/>',
}
SURFACES = {"grey": "0.5, 0.5, 0.5", "red": "0.6, 0.1, 0.05", "blue": "0.05, 0.1, 0.6"}


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)

    def run(self, *arguments):
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"kaustik {' '.join(arguments)}\n{done.stderr.strip()}")
        return done.stdout + done.stderr

    def render(self, scene, name, *arguments):
        """The report of a render, and its picture."""
        picture = self.folder / name
        return self.run("render", str(scene), *arguments, "-o", str(picture)), picture


def mean_rgb(path):
    """Of a PFM picture."""
    with open(path, "rb") as file:
        assert file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        values = struct.unpack(f"{order}{3 * width * height}f", file.read())
    return [sum(values[i::3]) / (width * height) for i in range(3)]


def lab(rgb, white):
    """CIELAB of linear Rec. 709, relative to a white of that luminance under D65."""
    matrix = ((0.4124564, 0.3575761, 0.1804375), (0.2126729, 0.7151522, 0.0721750),
              (0.0193339, 0.1191920, 0.9503041))
    scale = (0.95047, 1, 1.08883)
    f = lambda t: t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29
    x, y, z = (f(sum(a * b for a, b in zip(row, rgb)) / (s * white)) for row, s in zip(matrix, scale))
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def difference(a, b):
    """CIEDE2000 (Sharma, Wu, Dalal 2005)."""
    from math import atan2, cos, degrees, exp, hypot, radians, sin, sqrt
    (l1, a1, b1), (l2, a2, b2) = a, b
    mean_c = (hypot(a1, b1) + hypot(a2, b2)) / 2
    g = 0.5 * (1 - sqrt(mean_c ** 7 / (mean_c ** 7 + 25 ** 7)))
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = hypot(a1, b1), hypot(a2, b2)
    h1, h2 = degrees(atan2(b1, a1)) % 360, degrees(atan2(b2, a2)) % 360
    dh = 0 if c1 * c2 == 0 else (h2 - h1 + 180) % 360 - 180
    big_h = 2 * sqrt(c1 * c2) * sin(radians(dh / 2))
    mean_l, mean_c = (l1 + l2) / 2, (c1 + c2) / 2
    mean_h = h1 + h2 if c1 * c2 == 0 else (h1 + dh / 2) % 360
    t = (1 - 0.17 * cos(radians(mean_h - 30)) + 0.24 * cos(radians(2 * mean_h))
         + 0.32 * cos(radians(3 * mean_h + 6)) - 0.2 * cos(radians(4 * mean_h - 63)))
    s_l = 1 + 0.015 * (mean_l - 50) ** 2 / sqrt(20 + (mean_l - 50) ** 2)
    s_c, s_h = 1 + 0.045 * mean_c, 1 + 0.015 * mean_c * t
    turn = (-sin(radians(60 * exp(-(((mean_h - 275) / 25) ** 2))))
            * 2 * sqrt(mean_c ** 7 / (mean_c ** 7 + 25 ** 7)))
    dl, dc, dh = (l2 - l1) / s_l, (c2 - c1) / s_c, big_h / s_h
    return sqrt(dl * dl + dc * dc + dh * dh + turn * dc * dh)


def wall(lamp, reflectance):
    """Nothing is left to chance but the wavelengths."""
    return f"""<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="20"/>
      <transform name="to_world"><lookat origin="0, 0, 2" target="0, 0, 0" up="0, 1, 0"/></transform>
      <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/></film></sensor>
      <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="{reflectance}"/></bsdf></shape>
      <emitter type="directional"><vector name="direction" value="0, 0, -1"/>{lamp}</emitter></scene>"""


def colours(bench):
    print("Colour difference (CIEDE2000) from 1024 passes, mean of 8 seeds, 4 samples a pass, `auto`:\n")
    counts = (1, 4, 16, 64)
    print("| lamp | surface |" + "".join(f" {n} |" for n in counts) + "\n|---|---|" + "---|" * len(counts))
    for lamp, emission in LAMPS.items():
        for surface, reflectance in SURFACES.items():
            scene = bench.folder / "wall.xml"
            scene.write_text(wall(emission, reflectance))

            def mean(passes, seed, method="auto"):
                _, picture = bench.render(scene, "wall.pfm", "--spectral", "--integrator", method, "--passes",
                                          str(passes), "--seed", str(seed), "-q")
                return mean_rgb(picture)
            truth = mean(1024, 99, "path")
            white = 2 * (0.2126 * truth[0] + 0.7152 * truth[1] + 0.0722 * truth[2])
            found = [sum(difference(lab(mean(n, seed), white), lab(truth, white)) for seed in range(8)) / 8
                     for n in counts]
            print(f"| {lamp} | {surface} |" + "".join(f" {x:.2f} |" for x in found))


def cost(bench):
    print("\nWhat a pass costs beside RGB mode, and the time for the same error (4 passes, the better of 2 runs):\n")
    print("| scene | seconds | error | time ratio | at equal error |\n|---|---|---|---|---|")
    for name in ("cornell_box", "cornell_spheres", "metal_ring"):
        measured = {}
        for mode in ("rgb", "spectral", "rgb", "spectral"):
            report, _ = bench.render(ROOT / f"scenes/{name}/{name}.xml", "cost.exr", "--set", f"film.color={mode}",
                                     "--set", "film.width=400", "--set", "film.height=400", "--passes", "4",
                                     "--progress", "plain")
            seconds = float(re.findall(r"pass 4/4  ([\d.]+) s", report)[-1])
            error = float(re.findall(r"  error ([\d.]+) %", report)[-1])
            best = measured.get(mode, (1e9, error))
            measured[mode] = (min(best[0], seconds), error)
        (t_rgb, e_rgb), (t, e) = measured["rgb"], measured["spectral"]
        print(f"| {name} | {t_rgb:.1f}, {t:.1f} | {e_rgb:.2f} %, {e:.2f} % | {t / t_rgb:.2f} |"
              f" {t / t_rgb * (e / e_rgb) ** 2:.2f} |")


def equal_time(bench, seconds):
    print(f"\n`auto` and `path` in spectral mode after {seconds} s each, relative squared error (trimmed), against"
          f" `auto` of another seed after {8 * seconds} s:\n")
    print("| scene | auto | path | ratio | of auto's that is the reference's noise |\n|---|---|---|---|---|")
    scenes = {
        "prism": (ROOT / "scenes/prism/prism.xml", ["-D", "size=320", "-D", "height=200"]),
        "diamonds": (ROOT / "scenes/examples/jewel.xml",
                     ["-D", "size=240", "-D", "colour=0, 0, 0", "--set", "polish.int_ior=diamond", "--spectral"]),
    }
    for name, (scene, options) in scenes.items():
        _, reference = bench.render(scene, "reference.exr", *options, "--time", f"{8 * seconds}s", "--seed", "77", "-q")
        errors = {}
        for method in ("auto", "path"):
            _, picture = bench.render(scene, f"{method}.exr", *options, "--integrator", method, "--time",
                                      f"{seconds}s", "-q")
            said = bench.run("compare", str(reference), str(picture))
            errors[method] = float(re.search(r"relative_mse_trimmed ([\d.e+-]+)", said)[1])
            noise = float(re.search(r"reference_noise +([\d.e+-]+)", said)[1])
        print(f"| {name} | {errors['auto']:.4g} | {errors['path']:.4g} | {errors['path'] / errors['auto']:.1f} |"
              f" {noise / errors['auto']:.0%} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/kaustik"))
    parser.add_argument("--seconds", type=int, default=30, help="for each picture at equal time [%(default)s]")
    parser.add_argument("--parts", default="colours,cost,time", help="what to measure [%(default)s]")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.program, folder)
        for part in options.parts.split(","):
            {"colours": colours, "cost": cost, "time": lambda b: equal_time(b, options.seconds)}[part](bench)


if __name__ == "__main__":
    main()
