#!/usr/bin/env python3
"""Runs parts of a picture as Kubernetes runs the pods of an Indexed Job, with all that may happen to them: stopped at any
moment (SIGTERM), killed before they have ended (SIGKILL), two at a time for one index. However that goes, the merged
picture has the bits of one render. Of two pods for one index the slower one may have the last word, with fewer passes:
then merge names the part, and its command renders the rest. Usage: indexed_job_test.py PROGRAM [PODS]"""
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
PODS = int(sys.argv[2]) if len(sys.argv) > 2 else 200
SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes/cornell_box/cornell_box.xml"
PARTS = 5
PICTURE = ["--integrator", "path", "--set", "film.width=16", "--set", "film.height=16", "--passes", "40", "--spp", "2000",
           "--threads", "1", "--reproducible", "-q"]
ENDED_EARLY = 75
random.seed(17)


class Pod:
    """A process that renders the part of its index, and what will happen to it."""

    def __init__(self, folder, index, grace_s):
        part = index + 1
        self.index = index
        self.process = subprocess.Popen(
            [PROGRAM, *part_command(part)], cwd=folder, stderr=subprocess.PIPE, text=True)
        self.stop_at = time.monotonic() + random.uniform(0, 2.5 * grace_s) if random.random() < 0.7 else None
        self.kill_at = None
        if self.stop_at and random.random() < 0.4:
            self.kill_at = self.stop_at + random.uniform(0, 0.1)

    def happen(self):
        now = time.monotonic()
        if self.stop_at and now >= self.stop_at:
            self.process.send_signal(signal.SIGTERM)
            self.stop_at = None
        if self.kill_at and now >= self.kill_at:
            self.process.kill()
            self.kill_at = None

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.stop_at = None


def run(arguments, folder):
    result = subprocess.run([PROGRAM, *arguments], cwd=folder, stderr=subprocess.PIPE, text=True)
    if result.returncode != 0:
        raise SystemExit(f"{arguments[0]} ended with {result.returncode}: {result.stderr}")


def part_command(part):
    return ["render", SCENE, *PICTURE, "--part", f"{part}/{PARTS}", "--checkpoint", f"part_{part}.kpt", "--resume-if-there",
            "--every", "0.01s"]


def finish(folder, merge):
    """What the message of a merge asks for. Returns whether there was anything to do."""
    message = subprocess.run([PROGRAM, *merge], cwd=folder, stderr=subprocess.PIPE, text=True).stderr
    if " unfinished" not in message:
        return False
    for part in range(1, PARTS + 1):
        run(part_command(part), folder)
    return True


def run_job(folder, part_s):
    """Until each index has had a pod that ended well. Returns how many pods there were, and how they ended."""
    todo, pods, ends = set(range(PARTS)), [], []
    while todo or pods:
        # Two at a time, now and then for one index.
        while todo and len(pods) < 2:
            pods.append(Pod(folder, random.choice(sorted(todo)), part_s))
        for pod in list(pods):
            pod.happen()
            code = pod.process.poll()
            if code is None:
                continue
            pods.remove(pod)
            ends.append(code)
            if code == 0:
                todo.discard(pod.index)
                for other in pods:
                    if other.index == pod.index:
                        other.stop()
            elif code not in (ENDED_EARLY, -signal.SIGTERM, -signal.SIGKILL):
                raise SystemExit(f"a pod of index {pod.index} ended with {code}: {pod.process.stderr.read()}")
        time.sleep(0.002)
    return ends


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        begin = time.monotonic()
        run(["render", SCENE, *PICTURE, "-o", "whole.exr"], folder)
        part_s = (time.monotonic() - begin) / PARTS
        whole = (folder / "whole.exr").read_bytes()
        ends, jobs, overtaken = [], 0, 0
        while len(ends) < PODS:
            ends += run_job(folder, part_s)
            jobs += 1
            parts = [f"part_{part}.kpt" for part in range(1, PARTS + 1)]
            random.shuffle(parts)
            merge = ["merge", *parts, "-o", "merged.exr"]
            overtaken += finish(folder, merge)
            run(merge, folder)
            if (folder / "merged.exr").read_bytes() != whole:
                raise SystemExit(f"job {jobs}: the merged picture is not that of one render")
            for part in parts:
                (folder / part).unlink()
        early = ends.count(ENDED_EARLY)
        killed = len(ends) - early - ends.count(0)
        print(f"{jobs} jobs of {PARTS} parts, {len(ends)} pods: {early} ended early, {killed} were killed; "
              f"{overtaken} jobs had an unfinished part")
        if early < len(ends) // 10 or killed == 0:
            raise SystemExit("too few were disturbed for the test to mean something")


main()
