#!/usr/bin/env python3
"""How long programs take to start, as a ratio: an older program beside a newer one, warm, in pairs whose order takes turns.

Usage: benchmarks/program_start.py OLD NEW [--pairs 60] [--most 1.05] [-- ARGUMENTS]

Arguments are what both are run with; without any, --version. Of each pair the ratio of the times, of wall clock and of
processor, NEW over OLD; printed are their medians with an interval of 95 % by the ranks of the pairs (no assumption on how
times scatter). Exits with 1 if the ratio of processor time is surely larger than --most: that does not count what other
programs do beside.
"""
import argparse
import math
import os
import statistics
import subprocess
import sys
import time


def start_times(command):
    """Seconds of wall clock and of processor that a command takes."""
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {process.returncode}")
    return wall, usage.ru_utime + usage.ru_stime


def median_interval(values):
    """Median, and the ranks between which it lies with a chance of 95 %."""
    ordered = sorted(values)
    count = len(ordered)
    reach = 1.96 * math.sqrt(count) / 2
    low = max(0, math.floor(count / 2 - reach) - 1)
    high = min(count - 1, math.ceil(count / 2 + reach))
    return statistics.median(ordered), ordered[low], ordered[high]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--pairs", type=int, default=60)
    parser.add_argument("--most", type=float, default=1.05)
    options, arguments = parser.parse_known_args()
    arguments = [a for a in arguments if a != "--"] or ["--version"]
    programs = [[options.old, *arguments], [options.new, *arguments]]
    for program in programs * 5:  # into the caches
        start_times(program)
    pairs = []
    for pair in range(options.pairs):
        order = (0, 1) if pair % 2 == 0 else (1, 0)
        times = {which: start_times(programs[which]) for which in order}
        pairs.append((times[0], times[1]))
    least = 0
    for clock, name in enumerate(("wall clock", "processor")):
        old = statistics.median(p[0][clock] for p in pairs)
        new = statistics.median(p[1][clock] for p in pairs)
        ratio, least, most = median_interval([p[1][clock] / p[0][clock] for p in pairs if p[0][clock] > 0])
        print(f"{name}: {1000 * old:.2f} ms, then {1000 * new:.2f} ms; ratio {ratio:.3f} ({least:.3f} to {most:.3f})")
    sys.exit(1 if least > options.most else 0)


if __name__ == "__main__":
    main()
