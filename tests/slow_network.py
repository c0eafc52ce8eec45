#!/usr/bin/env python3
"""Hosts with a slow network between them, on this machine: network namespaces, whose cables end in this program. It
passes frames on as a switch does, at so many Mbit/s for each cable and each way, and so many milliseconds later. Needs
root, `ip` and /dev/net/tun; exits with 77, and a reason, where these are not there.

Usage: slow_network.py [--hosts 3] [--mbit 10] [--delay-ms 50] [--mtu 1500] -- COMMAND ARGUMENTS…

The command runs on the first host. It finds in its environment what mpirun needs to start processes on all of them:
HOSTS (their addresses, with commas between them) and HOSTS_MPIRUN (options of Open MPI's mpirun).
"""
import contextlib
import argparse
import fcntl
import heapq
import os
import pathlib
import selectors
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

SKIPPED = 77
TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
# Frames that wait longer for their cable are dropped, as by the buffers of real switches.
LONGEST_QUEUE_S = 0.5
NET = "10.77.0"


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


class Host:
    """A network namespace with a host name, and its cable."""

    def __init__(self, number, mtu):
        self.name = f"kaustik{os.getpid()}-{number}"
        self.address = f"{NET}.{number}"
        run("ip", "netns", "add", self.name)
        self.cable = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        device = f"kt{os.getpid() % 100000}-{number}"
        fcntl.ioctl(self.cable, TUNSETIFF, struct.pack("16sH", device.encode(), IFF_TAP | IFF_NO_PI))
        run("ip", "link", "set", device, "netns", self.name, "mtu", str(mtu))
        run("ip", "-n", self.name, "link", "set", "lo", "up")
        run("ip", "-n", self.name, "addr", "add", f"{self.address}/24", "dev", device)
        run("ip", "-n", self.name, "link", "set", device, "up", "txqueuelen", "1000")
        self.sent_at = self.received_at = 0.0  # when its cable is free again, of each way

    def command(self, *words):
        """Words that run a command there."""
        enter = 'hostname "$0" && exec "$@"'
        return ["ip", "netns", "exec", self.name, "unshare", "--uts", "sh", "-c", enter, f"host{self.address[-1]}", *words]

    def close(self):
        pids = subprocess.run(["ip", "netns", "pids", self.name], capture_output=True, text=True, check=False).stdout
        for pid in pids.split():
            with contextlib.suppress(ProcessLookupError):
                os.kill(int(pid), 9)
        os.close(self.cable)
        subprocess.run(["ip", "netns", "del", self.name], check=False)


class Switch(threading.Thread):
    """Passes frames on between the cables of hosts, until it is stopped."""

    def __init__(self, hosts, bits_per_s, delay_s):
        super().__init__(daemon=True)
        self.hosts, self.bits_per_s, self.delay_s = hosts, bits_per_s, delay_s
        self.places, self.flight, self.count = {}, [], 0
        self.bytes = self.dropped = 0
        self.stopped = False

    def run(self):
        selector = selectors.DefaultSelector()
        for host in self.hosts:
            selector.register(host.cable, selectors.EVENT_READ, host)
        while not self.stopped:
            wait = max(0.0, self.flight[0][0] - time.monotonic()) if self.flight else 0.1
            for key, _ in selector.select(min(wait, 0.1)):
                self.take(key.data)
            self.deliver()

    def take(self, host):
        for _ in range(64):
            try:
                frame = os.read(host.cable, 65536)
            except BlockingIOError:
                return
            self.places[frame[6:12]] = host
            to = self.places.get(frame[0:6])
            for other in [to] if to else [h for h in self.hosts if h is not host]:
                self.send(frame, host, other)

    def send(self, frame, sender, receiver):
        now, takes = time.monotonic(), 8 * len(frame) / self.bits_per_s
        if sender.sent_at - now > LONGEST_QUEUE_S or receiver.received_at - now - self.delay_s > LONGEST_QUEUE_S:
            self.dropped += 1
            return
        sender.sent_at = max(now, sender.sent_at) + takes
        # The switch passes bits on as they come.
        receiver.received_at = max(sender.sent_at - takes + self.delay_s, receiver.received_at) + takes
        self.count += 1
        self.bytes += len(frame)
        heapq.heappush(self.flight, (receiver.received_at, self.count, receiver, frame))

    def deliver(self):
        now = time.monotonic()
        while self.flight and self.flight[0][0] <= now:
            _, _, receiver, frame = heapq.heappop(self.flight)
            try:
                os.write(receiver.cable, frame)
            except (BlockingIOError, OSError):
                self.dropped += 1


def skip(reason):
    print(f"skipped: {reason}", file=sys.stderr)
    sys.exit(SKIPPED)


def write_agent(hosts, path):
    """What mpirun runs in the place of ssh: the host's address, then words of a shell command."""
    cases = "".join(f"  {host.address}) exec {shlex.join(host.command('sh', '-c'))} \"$*\" ;;\n" for host in hosts)
    path.write_text(f"#!/bin/sh\nto=$1\nshift\ncase $to in\n{cases}esac\n")
    path.chmod(0o755)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--hosts", type=int, default=3)
    parser.add_argument("--mbit", type=float, default=10)
    parser.add_argument("--delay-ms", type=float, default=50)
    parser.add_argument("--mtu", type=int, default=1500)
    parser.add_argument("command", nargs="+")
    options = parser.parse_args()
    if os.geteuid() != 0:
        skip("network namespaces need root")
    if not shutil.which("ip"):
        skip("there is no `ip` (package iproute2)")
    if not os.access("/dev/net/tun", os.R_OK | os.W_OK):
        skip("there is no /dev/net/tun")
    # So that the namespaces are removed then, too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    hosts = []
    try:
        for number in range(1, options.hosts + 1):
            hosts.append(Host(number, options.mtu))
    except (subprocess.CalledProcessError, OSError) as error:
        for host in hosts:
            host.close()
        skip(f"no network namespaces can be made here: {getattr(error, 'stderr', None) or error}")
    switch = Switch(hosts, 1e6 * options.mbit, 1e-3 * options.delay_ms)
    switch.start()
    with tempfile.TemporaryDirectory() as folder:
        agent = pathlib.Path(folder) / "agent"
        write_agent(hosts, agent)
        environment = dict(
            os.environ, HOSTS=",".join(host.address for host in hosts), OMPI_ALLOW_RUN_AS_ROOT="1",
            OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
            HOSTS_MPIRUN=f"--bind-to none --mca plm rsh --mca plm_rsh_agent {agent} --mca plm_rsh_no_tree_spawn 1 "
                         f"--mca btl tcp,self --mca btl_tcp_if_include {NET}.0/24 --mca oob_tcp_if_include {NET}.0/24")
        try:
            code = subprocess.run(hosts[0].command(*options.command), env=environment, check=False).returncode
        finally:
            switch.stopped = True
            switch.join()
            for host in hosts:
                host.close()
    print(f"network: {options.hosts} hosts, {options.mbit:g} Mbit/s, {options.delay_ms:g} ms: "
          f"{switch.bytes / 1e6:.1f} MB passed on, {switch.dropped} frames dropped", file=sys.stderr)
    sys.exit(code)


if __name__ == "__main__":
    main()
