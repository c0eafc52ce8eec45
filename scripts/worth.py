#!/usr/bin/env python3
"""Measures what devices and constants of the methods are worth: pictures without a device, or with another constant.

Pictures of the same samples and seeds are compared: the relative MSE to the stored reference, and CPU time. Their product is
what counts: time for a given noise. Each is made by one thread, several at a time: threads that wait for one another would
count, too. Renders end by samples, so all passes are whole. A machine's speed drifts: the pictures are made in an order that is
shuffled, and those that all others are compared with several times.

devices: settings of DEVICES, with build/release/kaustik.
constants: each constant of CONSTANTS becomes a variable that the environment sets, in a copy of the sources that is built in
out/worth; there it is multiplied by the factors of its row.
check: whether the tables of this script name constants and settings that there are.
What out/worth/devices.jsonl or constants.jsonl hold already of the same program, scenes and references is not measured again.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "out/worth"

# Scenes, and samples a pixel, for about ten seconds of two threads where learning takes most of the time, for some seconds
# elsewhere: light through a gap, many lamps, caustics of glass, metal and water, a small visible part of a large scene.
SCENES = {"door_ajar": 192, "hall_of_lamps": 32, "pool_among_lamps": 24, "hundredth_of_a_floor": 32, "metal_ring": 8,
          "peer_cornell_glass": 16, "peer_ring": 64, "peer_pool_below": 8}
AUTO = ("auto", ["hall_of_lamps", "peer_cornell_glass", "peer_ring"])
GUIDED = ("auto", ["door_ajar", "pool_among_lamps", "metal_ring"])
CACHE = ("photonmap", ["peer_cornell_glass", "metal_ring"])
PLACES = [AUTO, GUIDED, CACHE]

# ppm with this setting is auto, whose devices have no parameters of their own.
WHOLE = ("ppm", "choose_light_paths=true")
DEVICES = ["aim=none"] + [f"{name}=false" for name in (
    "choose_light_paths", "adaptive", "guiding", "guided_scattering", "choose_survival", "choose_light_samples",
    "learn_radii", "edges")]
# What is there for the picture to be right, and may cost time.
SAFEGUARDS = ["visibility=false"]
# What auto leaves out.
ADDITIONS = ["splats=true connections=true"]
# Student's t for bounds of 95 % on both sides, by seeds.
T_95 = {2: 12.71, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 7: 2.45, 8: 2.36}
# A device is to lower the product by so much in some scene, and to raise it by no more than that in any.
WANTED, TOLERATED = 1.1, 0.95

# What all others are compared with is timed so often.
OWN_RUNS = 3

# How each picture is made.
HOW = ["-q", "--float", "--threads", "1"]

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
    ("vcm/plan/plans.cpp", "worth_a_pilot", (0.8, 1.25), GUIDED),
    ("vcm/plan/plans.cpp", "few_paths", HALF_DOUBLE, GUIDED),
    ("vcm/plan/plans.cpp", "worth_guiding", (0.8, 1.25), GUIDED),
    ("vcm/plan/plan_selection.cpp", "worth_fewer", (0.8, 1.25), GUIDED),
    ("vcm/plan/plans.cpp", "near_per_distance", HALF_DOUBLE, AUTO),
    ("vcm/plan/path_pilot.cpp", "most_merged", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "tolerated", (0.7, 1.4), AUTO),
    ("vcm/lessons/radius_learning.cpp", "least_directions", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "least_share", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "least_left", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "most_vertices", HALF_DOUBLE, AUTO),
    ("vcm/lessons/radius_learning.cpp", "hopeless", HALF_DOUBLE, AUTO),
    ("vcm/lessons/sample_learning.cpp", "pairs_of_mean", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/sample_learning.cpp", "outliers", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/sample_learning.cpp", "worth_spreading", (0.96, 1.05), GUIDED),
    ("vcm/lessons/emission_learning.cpp", "plain_share", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/emission_learning.cpp", "least_paths", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/emission_learning.cpp", "worthwhile", (0.8, 1.25), GUIDED),
    ("vcm/lessons/emission_learning.cpp", "worth_its_time", (0.8, 1.25), GUIDED),
    ("vcm/lessons/emission_learning.cpp", "worth_aiming_less", (0.9, 1.05), GUIDED),
    ("vcm/lessons/scatter_learning.cpp", "most_events_in_cell", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/scatter_learning.cpp", "events_of_all", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/scatter_learning.cpp", "least_unguided", (0.7, 1.3), GUIDED),
    ("vcm/lessons/scatter_learning.cpp", "least_gain", HALF_DOUBLE, GUIDED),
    ("vcm/lessons/light_path_use.cpp", "least_light", HALF_DOUBLE, GUIDED),
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


def digest_of(program):
    """Of the program, all that it is measured with, and how."""
    digest = hashlib.sha256(pathlib.Path(program).read_bytes() + " ".join(HOW).encode())
    for path in files_of_repository("scenes", "benchmarks/scenes", "benchmarks/peer_scenes", "benchmarks/references"):
        digest.update(f"{path}\0".encode() + (ROOT / path).read_bytes())
    return digest.hexdigest()[:16]


def build(folder):
    """The program with variables."""
    source = folder / "source"
    contents = {path: (ROOT / path).read_bytes() for path in files_of_repository()}
    for file, name, _, _ in CONSTANTS:
        path = f"src/kaustik/{file}"
        contents[path] = made_variable(contents[path].decode(), file, name).encode()
    contents["tuned.h"] = TUNED_H.encode()
    for old in source.rglob("*"):
        if old.is_file() and str(old.relative_to(source)) not in contents:
            old.unlink()
    for path, content in contents.items():  # what is the same already is not compiled again
        copy = source / path
        if copy.exists() and copy.read_bytes() == content:
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)
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


def render(program, scene, samples, integrator, settings, seed, environment, run):
    """Relative MSE to the reference, but for what its own noise adds, and CPU seconds of this run."""
    file, reference = files_of(scene)
    picture = FOLDER / f"picture_{threading.get_ident()}.exr"
    options = [option for setting in settings for option in ("--set", f"integrator.{setting}")]
    rendering = subprocess.Popen(
        [program, "render", file, *HOW, "--integrator", integrator, *options, "--spp", str(samples),
         "--seed", str(seed), "-o", picture], env=dict(os.environ, **environment), stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(rendering.pid, 0)
    rendering.returncode = os.waitstatus_to_exitcode(status)
    if rendering.returncode != 0:
        raise subprocess.CalledProcessError(rendering.returncode, rendering.args)
    try:
        compared = subprocess.run([program, "compare", picture, reference], check=True, capture_output=True, text=True).stdout
    finally:
        picture.unlink()
    error, noise = (float(re.search(rf"^{name}\s+(\S+)", compared, re.M).group(1))
                    for name in ("relative_mse_trimmed", "reference_noise"))
    if error <= noise:
        raise ValueError(f"the reference of {scene} is noisier than a picture of {samples} samples a pixel: "
                         f"{noise:.3g}, {error:.3g}; render fewer, or make a better reference (make references)")
    return Measured(error - noise, noise, usage.ru_utime + usage.ru_stime)


# A picture's error but for the reference's noise, this noise, and CPU seconds.
Measured = collections.namedtuple("Measured", "error noise seconds")


class Measurements:
    """Errors and times of (scene, samples, integrator, settings, seed, environment, run), kept in a file with a digest of what
    they were made of. Runs but for 0 are of the same picture, for its time."""

    def __init__(self, file, digest):
        self.file, self.digest, self.known = file, digest, {}
        if file.exists():
            for line in file.read_text().splitlines():
                row = json.loads(line)
                if row.get("digest") == digest and "noise" in row:
                    self.known[json.dumps(row["key"])] = Measured(row["error"], row["noise"], row["seconds"])

    def measure(self, program, keys, jobs):
        missing = [key for key in keys if json.dumps(key) not in self.known]
        random.Random(1).shuffle(missing)
        begin = time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            running = {pool.submit(render, program, *key): key for key in missing}
            try:
                for done, future in enumerate(concurrent.futures.as_completed(running), 1):
                    left = (time.monotonic() - begin) / done * (len(missing) - done)
                    self.add(running[future], future.result(), f"{done} of {len(missing)}, {left / 60:.0f} min left")
            except BaseException:  # what runs comes to its end, and is not lost
                pool.shutdown(cancel_futures=True)
                for future, key in running.items():
                    if future.done() and not future.cancelled() and not future.exception() and json.dumps(key) not in self.known:
                        self.add(key, future.result(), "at the end")
                raise

    def add(self, key, measured, progress):
        self.known[json.dumps(key)] = measured
        with self.file.open("a") as out:
            out.write(json.dumps({"key": key, **measured._asdict(), "digest": self.digest}) + "\n")
        scene, _, integrator, settings, seed, environment, _ = key
        what = " ".join([scene, integrator, *settings, *(f"{name}={value}" for name, value in environment.items())])
        print(f"# {progress}: {what}, seed {seed}: {measured.error:.4g}, {measured.seconds:.1f} s", file=sys.stderr)

    def mean_of(self, keys):
        """What runs of one picture measured, with the mean of their times; none if one is missing."""
        found = [self.known.get(json.dumps(key)) for key in keys]
        return None if None in found else found[0]._replace(seconds=sum(run.seconds for run in found) / len(found))

    def noise_share(self, own):
        """Of the error of a picture that others are compared with: the reference's noise."""
        measured = self.known[json.dumps(own)]
        return measured.noise / (measured.error + measured.noise)

    def ratio(self, others, owns):
        """Of errors, of times, of their product with the standard error of its logarithm: one key a seed on each side."""
        pairs = [(self.known.get(json.dumps(other)), self.mean_of(runs_of(own))) for other, own in zip(others, owns)]
        if any(not other or not own for other, own in pairs):
            return None
        errors = [math.log(other.error / own.error) for other, own in pairs]
        products = [error + math.log(other.seconds / own.seconds) for error, (other, own) in zip(errors, pairs)]
        count = len(pairs)
        mean, mean_error = sum(products) / count, sum(errors) / count
        spread = math.sqrt(sum((x - mean) ** 2 for x in products) / (count - 1) / count) if count > 1 else math.inf
        return Ratio(math.exp(mean), spread, math.exp(mean_error), math.exp(mean - mean_error), count)


# The product and the standard error of its logarithm; the ratios of errors and of times; seeds.
Ratio = collections.namedtuple("Ratio", "product spread error seconds seeds")


def runs_of(own):
    """Of the picture that others are compared with."""
    return [own[:-1] + [run] for run in range(OWN_RUNS)]


def is_same(ratio):
    """Whether the pictures are, bit by bit."""
    return abs(ratio.error - 1) < 1e-6


def cell_of(ratio):
    if not ratio:
        return "–"
    if is_same(ratio):
        return f"same, time {ratio.seconds:.2f}"
    deviation = f" ± {100 * ratio.spread:.0f} %" if math.isfinite(ratio.spread) else ""
    return f"**{ratio.product:.2f}**{deviation}: {ratio.error:.2f} × {ratio.seconds:.2f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def keys_of_device(scene, device, seeds):
    integrator, whole = WHOLE
    settings = [] if device.startswith("choose_light_paths") else [whole] + device.split()
    return [[scene, SCENES[scene], integrator, settings, seed, {}, 0] for seed in seeds]


def verdict(ratios):
    """By bounds of 95 % in each scene by itself; pictures that are the same tell nothing."""
    def bound(ratio, side):
        return ratio.product * math.exp(side * T_95.get(ratio.seeds, 1.96) * ratio.spread)

    known = [ratio for ratio in ratios if not is_same(ratio)]
    helps, might = (sum(bound(ratio, side) >= WANTED for ratio in known) for side in (-1, 1))
    harms = sum(bound(ratio, 1) < TOLERATED for ratio in known)
    words = [f"helps in {helps}" if helps else f"may help in {might}" if might else "does not help"]
    return ", ".join(words + ([f"harms in {harms}"] if harms else []))


DEVICES_TEXT = """# What each device of `auto` is worth

`auto` learns, chooses and guides by itself. Here each of these is switched off alone, in pictures of the same samples and
seeds. A cell has **the time for a given noise without the device over that with it**: the ratio of the errors times the ratio
of the times. More than 1 speaks for the device. An error is the relative MSE to the stored reference without the worst 0.1 %
of the pixels, less what the reference's own noise adds; a time is CPU time of one thread; ± is one standard error over the
seeds. "Same": the pictures are the same bits. Of the errors as measured the reference's noise was {noise}.

A device is to be worth {wanted} in a scene that people could have, and no less than {tolerated} in any. It helps, or harms, in
the scenes whose 95 % bounds (Student's t over the seeds) tell so. Of `pool_among_lamps` and `hundredth_of_a_floor` the reference is `auto` itself, of a long run: bias that both have does not show there.

`make ablation` writes this page: seeds {seeds}; samples a pixel: {samples}. What learning takes counts more in shorter
renders: `scripts/worth.py devices --effort 0.25` measures those.
"""

SAFEGUARDS_TEXT = """## What keeps light where it belongs

`visibility` is no device for speed. It keeps light from passing walls and furniture, where these scenes show little of it;
`wall_tool` prints what passes without it (`unguarded`). So no bar holds here: the table tells what it costs.

"""


def devices(arguments, seeds):
    program = arguments.program
    measured = Measurements(FOLDER / "devices.jsonl", digest_of(program))
    wanted = [device for device in DEVICES + SAFEGUARDS + ADDITIONS if not arguments.only or device.split("=")[0] in arguments.only]
    own = [run for scene in SCENES for key in keys_of_device(scene, "", seeds) for run in runs_of(key)]
    measured.measure(program, own + [key for scene in SCENES for device in wanted for key in keys_of_device(scene, device, seeds)],
                     arguments.jobs)
    rows, verdicts = {}, []
    for device in DEVICES + SAFEGUARDS + ADDITIONS:
        found = {scene: measured.ratio(keys_of_device(scene, device, seeds), keys_of_device(scene, "", seeds)) for scene in SCENES}
        known = {scene: ratio for scene, ratio in found.items() if ratio}
        rows[device] = [device] + [cell_of(found[scene]) for scene in SCENES]
        if not known or device not in DEVICES:
            continue
        most, least = (choose(known, key=lambda scene: known[scene].product) for choose in (max, min))
        mean = math.exp(sum(math.log(ratio.product) for ratio in known.values()) / len(known))
        verdicts.append([device, f"{most}: {known[most].product:.2f}", f"{least}: {known[least].product:.2f}", f"{mean:.2f}",
                         verdict(known.values())])
    noise = {scene: measured.noise_share(keys_of_device(scene, "", seeds)[0]) for scene in SCENES}
    text = DEVICES_TEXT.format(wanted=WANTED, tolerated=TOLERATED, seeds=", ".join(map(str, seeds)),
                               noise=", ".join(f"{100 * share:.0f} % in {scene}" for scene, share in noise.items()),
                               samples=", ".join(f"{scene} {samples}" for scene, samples in SCENES.items()))
    text += "\n" + table(["without", "most", "least", "geometric mean", "the device"], verdicts)
    text += "\n## Scene by scene\n\n" + table(["without", *SCENES], [rows[device] for device in DEVICES])
    missed = [f"{device} {words}" for device, *_, words in verdicts if "harms" in words or "not" in words]
    text += "\n" + SAFEGUARDS_TEXT + table(["without", *SCENES], [rows[device] for device in SAFEGUARDS])
    return missed, text + ("\n## What `auto` leaves out\n\nHere more than 1 speaks for leaving it out.\n\n"
                   + table(["with", *SCENES], [rows[device] for device in ADDITIONS]))


CONSTANTS_TEXT = """# What the constants of the methods are worth

Each constant is changed alone, in pictures of the same samples and seeds. A cell has **the time for a given noise with the
other value over that with the value in the code**: the ratio of the errors times the ratio of the times. More than 1 speaks
for the code. Errors, times and ± are those of [the page on devices](ablation.md); "same": the pictures are the same bits.

The constants of `vcm/plan/cost_model.h` are measured: `cost_tool` prints them. `kernel_efficiency` (¾) is derived: the square
of the kernel's integral over its square's integral and its area.

`make sensitivity` writes this page: seeds {seeds}; samples a pixel: {samples}.
"""


def keys_of_constant(where, scene, file, name, value, seeds):
    return [[scene, SCENES[scene], where[0], [], seed, {variable_of(file, name): repr(value)} if name else {}, 0] for seed in seeds]


def constants(arguments, seeds):
    program, values = build(FOLDER), values_of_code()
    measured = Measurements(FOLDER / "constants.jsonl", digest_of(program))
    rows = [row for row in CONSTANTS if not arguments.only or row[1] in arguments.only]
    own = [run for where in PLACES for scene in where[1] for key in keys_of_constant(where, scene, "", "", 0, seeds)
           for run in runs_of(key)]
    measured.measure(program, own + [
        key for file, name, factors, where in rows for factor in factors for scene in where[1]
        for key in keys_of_constant(where, scene, file, name, values[file, name] * factor, seeds)], arguments.jobs)
    text = CONSTANTS_TEXT.format(seeds=", ".join(map(str, seeds)),
                                 samples=", ".join(f"{scene} {SCENES[scene]}"
                                                   for scene in dict.fromkeys(scene for where in PLACES for scene in where[1])))
    for where, title in zip(PLACES, ["`auto`", "`auto`, where its guides are of use", "`photonmap`"]):
        cells, times = [], []
        for file, name, factors, of in CONSTANTS:
            for value in [values[file, name] * factor for factor in factors if of is where]:
                found = [measured.ratio(keys_of_constant(where, scene, file, name, value, seeds),
                                        keys_of_constant(where, scene, "", "", 0, seeds)) for scene in where[1]]
                times += [ratio.seconds for ratio in found if ratio and is_same(ratio)]
                if any(found):
                    cells.append([f"`{name.rstrip('_')}` ({pathlib.Path(file).name})", f"{values[file, name]:g}", f"{value:g}",
                                  *map(cell_of, found)])
        text += f"\n## {title}\n\n"
        if times:
            text += f"Pictures that are the same took {min(times):.2f} to {max(times):.2f} of the time: so much is the machine's.\n\n"
        text += table(["constant", "value", "instead", *where[1]], cells)
    return [], text


def check(program):
    """Ends the program if a table names what there is not."""
    values_of_code()
    known = subprocess.run([program, "help", WHOLE[0]], check=True, capture_output=True, text=True).stdout
    for setting in " ".join(DEVICES + SAFEGUARDS + ADDITIONS + [WHOLE[1]]).split():
        name = setting.split("=")[0]
        if not re.search(rf"^\s*{name} \(", known, re.M):
            sys.exit(f"integrator '{WHOLE[0]}' has no parameter '{name}'; mend the table in {__file__}")
    for scene in SCENES:
        for file in files_of(scene):
            if not file.exists():
                sys.exit(f"there is no {file}; mend the table in {__file__}")


def seed_list(text):
    seeds = [int(seed) for seed in text.split(",") if seed.isdecimal()]
    if len(seeds) != len(text.split(",")) or len(set(seeds)) != len(seeds):
        raise argparse.ArgumentTypeError(f"'{text}' is no list of different seeds such as 1,2,3")
    return seeds


def positive(text):
    try:
        number = float(text)
    except ValueError:
        number = 0
    if not 0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is no number above 0")
    return number


def job_count(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of pictures: one or more")
    return int(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["devices", "constants", "check"])
    parser.add_argument("--seeds", type=seed_list, default="1,2,3", help="[%(default)s]")
    parser.add_argument("--effort", type=positive, default=1, metavar="FACTOR",
                        help="times as many samples a pixel: what learning takes counts less in long renders [%(default)s]")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="measure these devices or constants alone")
    parser.add_argument("--jobs", type=job_count, default=os.cpu_count(), help="pictures that are made at a time [%(default)s]")
    parser.add_argument("--page", type=pathlib.Path, metavar="FILE.md", help="where to write the tables [standard output]")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/kaustik",
                        help="for devices and check [%(default)s]")
    arguments = parser.parse_args()
    if arguments.what != "constants" and not os.access(arguments.program, os.X_OK):
        parser.error(f"there is no program {arguments.program}; build it first: make build")
    if arguments.page and not os.access(arguments.page.resolve().parent, os.W_OK):
        parser.error(f"{arguments.page} can't be written there; --page takes a file in a folder that there is")
    if arguments.what == "check":
        return check(arguments.program)
    names = [device.split("=")[0] for device in DEVICES + SAFEGUARDS + ADDITIONS] if arguments.what == "devices" else [
        row[1] for row in CONSTANTS]
    for name in arguments.only:
        if name not in names:
            parser.error(f"there is no '{name}' among {', '.join(names)}")
    FOLDER.mkdir(parents=True, exist_ok=True)
    for scene, samples in SCENES.items():
        SCENES[scene] = max(1, round(arguments.effort * samples))
    missed, text = {"devices": devices, "constants": constants}[arguments.what](arguments, arguments.seeds)
    if arguments.page:
        arguments.page.write_text(text)
    else:
        print(text)
    if missed:
        sys.exit("a bar is missed: " + "; ".join(missed))


if __name__ == "__main__":
    main()
