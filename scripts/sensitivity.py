#!/usr/bin/env python3
"""Prints what the constants of the code are worth: the error and the time of pictures where one is another.

Usage: scripts/sensitivity.py [--build FOLDER] [--seeds 1,2] [--results FILE.jsonl] [--only NAME ...] [--page FILE.md]

The sources are copied into FOLDER (out/sensitivity). There each constant of CONSTANTS below becomes a variable that the
environment sets, and the copy is built once. Each constant is then multiplied by the factors of its row, alone,
in pictures of the same passes and seeds. An error is the relative MSE to the stored reference; a time is CPU
time. What FILE.jsonl holds already is not measured again, unless the sources differ.
"""
import argparse
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Integrator and samples a pixel, some seconds each. Light through a gap, many lamps, glass, caustics of water: there all
# devices of auto have something to do.
AUTO = {"door_ajar": ("auto", 48), "hall_of_lamps": ("auto", 32), "pool_among_lamps": ("auto", 24),
        "peer_cornell_glass": ("auto", 16), "peer_pool_below": ("auto", 8)}
CACHE = {"cornell_spheres": ("photonmap", 8), "metal_ring": ("photonmap", 8)}

# A file below src/kaustik, a constant in it, what it is multiplied by, and where it counts.
HALF_DOUBLE = (0.5, 2.0)
CONSTANTS = [
    ("vcm/plan/cost_model.h", "merging", HALF_DOUBLE, AUTO),
    ("vcm/plan/cost_model.h", "merged_vertex", (0.1, 10.0), AUTO),
    ("vcm/plan/cost_model.h", "light_ray", HALF_DOUBLE, AUTO),
    ("vcm/plan/efficiency.cpp", "most_evenness", HALF_DOUBLE, AUTO),
    ("vcm/plan/efficiency.cpp", "share_of_mean_unknown", (0.1, 10.0), AUTO),
    ("vcm/plan/pixel_plans.h", "most_disk_widths", HALF_DOUBLE, AUTO),
    ("vcm/plan/pixel_plans.cpp", "most_other_radius", HALF_DOUBLE, AUTO),
    ("vcm/plan/plans.cpp", "worth_a_pilot", (0.8, 1.25), AUTO),
    ("vcm/plan/plans.cpp", "few_paths", HALF_DOUBLE, AUTO),
    ("vcm/plan/plans.cpp", "worth_guiding", (0.8, 1.25), AUTO),
    ("vcm/plan/plans.cpp", "worth_fewer", (0.8, 1.25), AUTO),
    ("vcm/plan/plans.cpp", "near_per_distance", HALF_DOUBLE, AUTO),
    ("vcm/plan/path_pilot.cpp", "most_merged", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "tolerated", (0.7, 1.4), AUTO),
    ("vcm/lessons/radius_learning.cpp", "least_directions", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "least_share", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "least_left", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "most_vertices", HALF_DOUBLE, AUTO),
    ("vcm/lessons/sample_learning.cpp", "pairs_of_mean", HALF_DOUBLE, AUTO),
    ("vcm/lessons/sample_learning.cpp", "outliers", HALF_DOUBLE, AUTO),
    ("vcm/lessons/sample_learning.cpp", "worth_spreading", (0.96, 1.05), AUTO),
    ("vcm/lessons/emission_learning.cpp", "plain_share", HALF_DOUBLE, AUTO),
    ("vcm/lessons/emission_learning.cpp", "least_paths", HALF_DOUBLE, AUTO),
    ("vcm/lessons/emission_learning.cpp", "worthwhile", (0.8, 1.25), AUTO),
    ("vcm/lessons/emission_learning.cpp", "worth_its_time", (0.8, 1.25), AUTO),
    ("vcm/lessons/scatter_learning.cpp", "most_events_in_cell", HALF_DOUBLE, AUTO),
    ("vcm/lessons/scatter_learning.cpp", "events_of_all", HALF_DOUBLE, AUTO),
    ("vcm/lessons/scatter_learning.cpp", "least_unguided", (0.7, 1.3), AUTO),
    ("vcm/lessons/scatter_learning.cpp", "least_gain", HALF_DOUBLE, AUTO),
    ("vcm/lessons/light_path_use.cpp", "least_light", HALF_DOUBLE, AUTO),
    ("transport/path_weights.h", "least_spread", HALF_DOUBLE, AUTO),
    ("photon/coverage/merge_disk.h", "flatness_", HALF_DOUBLE, AUTO),
    ("photon/coverage/merge_disk.h", "least_cosine_", (0.5, 1.5), AUTO),
    ("photon/coverage/merge_disk.cpp", "height_share", HALF_DOUBLE, AUTO),
    ("photon/coverage/merge_disk.cpp", "per_clearance", HALF_DOUBLE, AUTO),
    ("photon/coverage/merge_disk.cpp", "most_tries", HALF_DOUBLE, AUTO),
    ("photon/coverage/surface_edges.cpp", "wall_height", HALF_DOUBLE, AUTO),
    ("photon/coverage/surface_edges.cpp", "same_height", HALF_DOUBLE, AUTO),
    ("photon/coverage/surface_edges.cpp", "low_height", HALF_DOUBLE, AUTO),
    ("photon/coverage/surface_edges.cpp", "gentle", HALF_DOUBLE, AUTO),
    ("photon/coverage/surface_edges.cpp", "end_angle", HALF_DOUBLE, AUTO),
    ("photon/coverage/surface_edges.cpp", "least_sine", HALF_DOUBLE, AUTO),
    ("photon/light_pass.cpp", "largest_first_weight", HALF_DOUBLE, CACHE),
    ("transport/vertex.h", "largest_irradiance_factor", HALF_DOUBLE, CACHE),
    ("photonmap/photon_map_integrator.cpp", "stored_quantile", (0.9, 1.05), CACHE),
    ("photonmap/photon_map_integrator.cpp", "quantile", (0.75, 1.2), CACHE),
    ("irradiance/record_reach.h", "total_error_scale", HALF_DOUBLE, CACHE),
]

TUNED_H = r"""
#pragma once
#include <cstdlib>
namespace kaustik_tuned {
inline double value(const char* name, double otherwise) {
  const char* set = std::getenv(name);
  return set ? std::strtod(set, nullptr) : otherwise;
}
}  // namespace kaustik_tuned
"""


def variable_of(file, name):
    return re.sub(r"\W", "_", "KAUSTIK_TUNE_" + pathlib.Path(file).stem + "_" + name)


def declaration_of(name):
    return re.compile(r"(\b" + re.escape(name) + r"\s*=\s*)([-+.\w]+)(?=\s*[;,])")


def value_in(text, name, file):
    found = declaration_of(name).findall(text)
    if len(found) != 1:
        sys.exit(f"{file} has {len(found)} definitions of '{name}'; mend the table in {__file__}")
    return float(found[0][1].rstrip("fu"))


def made_variable(text, file, name):
    """The same text where `name` has the value of the environment, if it has one."""
    begin = declaration_of(name).search(text).start()
    line = text.rfind("\n", 0, begin) + 1
    head = text[line:begin]
    kind = re.search(r"(double|float|int|uint32_t|size_t)\b", head).group(1)
    head = head.replace("static constexpr", "static inline const").replace("constexpr", "const")
    made = declaration_of(name).sub(
        lambda m: f'{m[1]}{kind}(kaustik_tuned::value("{variable_of(file, name)}", {m[2]}))', text[begin:], 1)
    return (text[:line] + head + made).replace("inline constexpr CostModel cost_model", "inline const CostModel cost_model")


def values_of_code():
    texts = {}
    for file, name, _, _ in CONSTANTS:
        texts.setdefault(file, (ROOT / "src/kaustik" / file).read_text())
    return {(file, name): value_in(texts[file], name, file) for file, name, _, _ in CONSTANTS}


def files_of_repository(*folders):
    listed = subprocess.run(["git", "ls-files", "-z", *folders], cwd=ROOT, check=True, capture_output=True).stdout
    return sorted(path for path in map(os.fsdecode, listed.split(b"\0")) if path and (ROOT / path).is_file())


def digest_of_sources():
    """Of what makes pictures; the table of this script may grow."""
    digest = hashlib.sha256()
    for path in files_of_repository("src", "apps", "scenes", "benchmarks/scenes"):
        digest.update(f"{path}\0".encode() + (ROOT / path).read_bytes())
    return digest.hexdigest()[:16]


def build(folder):
    """The program with variables."""
    source = folder / "source"
    if source.exists():
        shutil.rmtree(source)
    source.mkdir(parents=True)
    for path in files_of_repository():
        (source / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / path, source / path)
    (source / "tuned.h").write_text(TUNED_H)
    for file, name, _, _ in CONSTANTS:
        path = source / "src/kaustik" / file
        path.write_text(made_variable(path.read_text(), file, name))
    target = folder / "build"
    subprocess.run(["cmake", "-G", "Ninja", "-S", source, "-B", target, "-D", "CMAKE_BUILD_TYPE=Release", "-D",
                    f"CMAKE_CXX_FLAGS=-include {source}/tuned.h", "-D", "KAUSTIK_UNITY=ON", "-D", "KAUSTIK_TESTS=OFF", "-D",
                    "KAUSTIK_BENCHMARKS=OFF"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", target, "--target", "kaustik"], check=True)
    return target / "kaustik"


def files_of(scene):
    """The scene, and its reference."""
    if scene.startswith("peer_"):
        folder = ROOT / "benchmarks/peer_scenes" / scene.removeprefix("peer_")
        return folder / "scene.xml", ROOT / "benchmarks/references" / f"{scene}.exr"
    shipped = ROOT / "scenes" / scene / f"{scene}.xml"
    file = shipped if shipped.exists() else ROOT / "benchmarks/scenes" / f"{scene}.xml"
    return file, ROOT / "benchmarks/references" / f"{scene}.exr"


def render(program, folder, scene, integrator, samples, seed, environment):
    """Relative MSE to the reference, and CPU seconds."""
    file, reference = files_of(scene)
    picture = folder / "picture.exr"
    begin = os.times()
    subprocess.run([program, "render", file, "-q", "--float", "--integrator", integrator, "--spp", str(samples),
                    "--seed", str(seed), "-o", picture], check=True, env=dict(os.environ, **environment),
                   stdout=subprocess.DEVNULL)
    end = os.times()
    compared = subprocess.run([program, "compare", picture, reference], check=True,
                              capture_output=True, text=True).stdout
    error = float(re.search(r"^relative_mse\s+(\S+)", compared, re.M).group(1))
    return error, end.children_user + end.children_system - begin.children_user - begin.children_system


def measure(program, folder, results, sources, seeds, only):
    known = {}
    if results.exists():
        for line in results.read_text().splitlines():
            row = json.loads(line)
            if row["sources"] == sources:
                known[tuple(row["key"])] = row
    values = values_of_code()
    wanted = []
    for scenes in (AUTO, CACHE):
        wanted += [(scene, *scenes[scene], seed, "", "", 0.0) for scene in scenes for seed in seeds]
    for file, name, factors, scenes in CONSTANTS:
        if only and name not in only:
            continue
        wanted += [(scene, *scenes[scene], seed, file, name, values[file, name] * factor)
                   for factor in factors for scene in scenes for seed in seeds]
    missing = [key for key in wanted if key not in known]
    begin = time.monotonic()
    for done, key in enumerate(missing):
        scene, integrator, samples, seed, file, name, value = key
        environment = {variable_of(file, name): repr(value)} if name else {}
        error, seconds = render(program, folder, scene, integrator, samples, seed, environment)
        row = {"key": key, "error": error, "seconds": seconds, "sources": sources}
        known[key] = row
        with results.open("a") as out:
            out.write(json.dumps(row) + "\n")
        left = (time.monotonic() - begin) / (done + 1) * (len(missing) - done - 1)
        print(f"# {done + 1} of {len(missing)}, {left / 60:.0f} min left: {scene} {name} {value:g}: {error:.4g}, {seconds:.1f} s",
              file=sys.stderr)
    return known, values


def ratio(known, seeds, scene, how, file, name, value):
    """Error times CPU time with `value` over that of the code, and the standard error of its logarithm over the seeds."""
    logs = []
    for seed in seeds:
        other, own = known.get((scene, *how, seed, file, name, value)), known.get((scene, *how, seed, "", "", 0.0))
        if not other or not own:
            return None
        logs.append((math.log(other["error"] / own["error"]), math.log(other["seconds"] / own["seconds"])))
    mean = [sum(x) / len(logs) for x in zip(*logs)]
    spread = [math.sqrt(sum((x - m) ** 2 for x in xs) / max(1, len(logs) - 1) / len(logs)) for xs, m in zip(zip(*logs), mean)]
    return math.exp(mean[0]), spread[0], math.exp(mean[1])


INTRODUCTION = """# What the constants are worth

Each constant is changed alone, in pictures of the same passes and seeds. A cell has the error with the other value over the
error with the one in the code, and the CPU time over the CPU time. An error is the relative MSE to the stored reference; ± is
one standard error over the seeds. A product above 1 speaks for the code. 1: the pictures are the same.
What was measured instead of chosen stands elsewhere: `vcm/plan/cost_model.h` is what `cost_tool` prints.

`make sensitivity` writes this page.
"""


def page(known, values, seeds):
    lines = [INTRODUCTION]
    for title, scenes in (("auto", AUTO), ("photonmap", CACHE)):
        shown = ", ".join(f"{scene} ({samples} samples a pixel)" for scene, (_, samples) in scenes.items())
        lines += [f"## Constants of `{title}`", "", f"Scenes: {shown}; seeds {', '.join(map(str, seeds))}.", "",
                  "| constant | value | instead | " + " | ".join(scenes) + " |", "|---|---:|---:|" + "---:|" * len(scenes)]
        for file, name, factors, where in CONSTANTS:
            if where is not scenes:
                continue
            for factor in factors:
                value = values[file, name] * factor
                cells = []
                for scene, how in scenes.items():
                    found = ratio(known, seeds, scene, how, file, name, value)
                    cells.append("–" if not found else "1" if abs(found[0] - 1) < 1e-6 else
                                 f"{found[0]:.2f} ± {100 * found[1]:.0f} %, time {found[2]:.2f}")
                if any(cell != "–" for cell in cells):
                    lines.append(f"| {name.rstrip('_')} ({pathlib.Path(file).name}) | {values[file, name]:g} | {value:g} | "
                                 + " | ".join(cells) + " |")
        lines.append("")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "out/sensitivity")
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--page", type=pathlib.Path)
    arguments = parser.parse_args()
    seeds = [int(seed) for seed in arguments.seeds.split(",")]
    folder = arguments.build.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    results = arguments.results or folder / "measurements.jsonl"
    known, values = measure(build(folder), folder, results, digest_of_sources(), seeds, arguments.only)
    text = page(known, values, seeds)
    if arguments.page:
        arguments.page.write_text(text)
    else:
        print(text)


if __name__ == "__main__":
    main()
