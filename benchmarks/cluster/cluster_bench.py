#!/usr/bin/env python3
"""What processes of kaustik-mpi are worth on this machine, and what cluster_model goes by. Prints a line of JSON for each
claim, with its bar, and writes what was measured to a file. Other programs that run beside make all slower, so ratios
are of processor time, or of pairs that run one after the other; "share" is how much of the processors a run got.

Usage: cluster_bench.py PROGRAM MPI_PROGRAM MERGE_BENCH ADDING_BENCH MEASURED.json [--seconds 6] [--width 640]
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENE = ROOT / "scenes/cornell_box/cornell_box.xml"
HOSTS = 3
CORES = len(os.sched_getaffinity(0))
MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np"]
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def report(name, value, unit, compared_with, bar=None, is_most=False):
    line = {"name": name, "value": float(f"{value:.4g}"), "unit": unit, "compared_with": compared_with}
    if bar is not None:
        kept = value <= bar if is_most else value >= bar
        line.update({"bar": bar, "bar_is": "kept" if kept else "missed"})
    print(json.dumps(line, ensure_ascii=False), flush=True)


class Cost:
    """What a command takes, in seconds: of the clock, and of processors."""

    def __init__(self, command, folder):
        begin = time.perf_counter()
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{self.output}")
        self.wall = time.perf_counter() - begin
        self.processor = usage.ru_utime + usage.ru_stime

    def share(self, cores):
        return f"{self.processor / self.wall / cores:.0%} of {cores} core{'s' if cores > 1 else ''}"


def render(passes, first=0):
    """Arguments: passes of about a tenth of a second each, of one thread."""
    return ["render", SCENE, "--integrator", "path", "--set", "film.width=96", "--set", "film.height=96", "--threads", "1",
            "--reproducible", "-q", "--first-pass", str(first), "--passes", str(passes), "--spp", str(16 * passes), "-o",
            "picture.exr"]


class Rendering:
    """Processor time of many passes, without what processes take to start: that is told by itself."""

    def __init__(self, options, folder, passes, processes=None):
        command = [*MPIRUN, str(processes), options.mpi_program] if processes else [options.program]
        few, many = (Cost([*command, *render(count)], folder) for count in (4, passes))
        self.seconds = (many.processor - few.processor) / (passes - 4)
        self.start_s = few.processor - 4 * self.seconds
        self.share = many.share(min(processes or 1, CORES))
        self.wall = many.wall - few.wall


def measure_processes(options, folder):
    probe = Rendering(options, folder, 8)
    passes = max(16, round(options.seconds / max(probe.seconds, 0.01)) // 4 * 4)
    counts = [None, 1, 2, 4]
    found = {count: [] for count in counts}
    for turn in range(options.turns):
        for count in counts if turn % 2 == 0 else counts[::-1]:
            found[count].append(Rendering(options, folder, passes, count))
    ratio = {count: statistics.median(one.seconds / alone.seconds for one, alone in zip(found[count], found[None]))
             for count in counts[1:]}
    start = {count: statistics.median(one.start_s for one in found[count]) for count in counts}
    report("overhead of one process", 100 * (ratio[1] - 1), "% of processor time",
           f"kaustik; {options.turns} turns of {passes} passes; {found[1][0].share}; starts in {start[1]:.2f} s, kaustik in "
           f"{start[None]:.2f} s", 2, is_most=True)
    for count in counts[1:]:
        speed = statistics.median(alone.wall / one.wall for one, alone in zip(found[count], found[None]))
        report(f"efficiency of {count} process{'es' if count > 1 else ''}", 1 / ratio[count], "of kaustik",
               f"processor time; {speed:.2f} times as fast by the clock; {found[count][0].share}; start {start[count]:.2f} s",
               0.9 if count <= CORES else None)


def measure_merging(options, folder):
    output = Cost([options.merge_bench, str(options.width)], folder).output
    print(output, end="", flush=True)
    lines = [json.loads(line) for line in output.splitlines()]
    return next(line["value"] for line in lines if line["name"] == "merge-speed") / 1000


def measure_adding(options, folder):
    """Adding up a film of 1080p on three hosts of a test network, beside what its cables allow. None: no such network."""
    mbit, height = options.mbit, options.film_height
    command = f"exec mpirun $HOSTS_MPIRUN --host $HOSTS -np {HOSTS} {options.adding_bench} {height * 16 // 9} {height}"
    network = [sys.executable, ROOT / "tests/slow_network.py", "--hosts", str(HOSTS), "--mbit", str(mbit), "--delay-ms", "1",
               "--mtu", "9000", "--", "bash", "-c", command]
    result = subprocess.run(network, cwd=folder, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        print(f"# adding up is not measured: {result.stderr.strip()}", file=sys.stderr)
        return None
    found = json.loads(result.stdout.splitlines()[-1])
    # Each but the leader has to send its film.
    least_s = 8e-6 * found["bytes"] / mbit
    ratio = found["seconds"] / least_s
    report("adding up", ratio, "times what the bandwidth allows",
           f"{found['bytes'] / 1e6:.0f} MB of sums, {height} lines, {HOSTS} hosts with {mbit:g} Mbit/s: "
           f"{found['seconds']:.1f} s, at least {least_s:.1f} s", 1.5, is_most=True)
    return ratio


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("mpi_program", type=pathlib.Path)
    parser.add_argument("merge_bench", type=pathlib.Path)
    parser.add_argument("adding_bench", type=pathlib.Path)
    parser.add_argument("measured", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=6, help="of a run of one process")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--width", type=int, default=640, help="of the picture whose parts are merged")
    parser.add_argument("--film-height", type=int, default=1080, help="of the film that is added up")
    parser.add_argument("--mbit", type=float, default=200, help="of the test network")
    options = parser.parse_args()
    for name in ("program", "mpi_program", "merge_bench", "adding_bench"):
        setattr(options, name, getattr(options, name).resolve())
    with tempfile.TemporaryDirectory() as folder:
        measure_processes(options, folder)
        measured = {"merge_gb_s": measure_merging(options, folder)}
        if (adding := measure_adding(options, folder)) is not None:
            measured["reduction"] = adding
    options.measured.write_text(json.dumps(measured) + "\n")


if __name__ == "__main__":
    main()
