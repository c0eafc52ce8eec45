#!/usr/bin/env python3
"""Makes the density of a small cloud, a file of Mitsuba's format VOL: make_cloud.py [-n CELLS] FILE

Bytes that stand for 0 to 1. A heap of balls, frayed by sums of noise; the same for every run.
"""
import argparse
import math
import struct

# Centres and radii, in the cube from -1 to 1.
BALLS = [((-0.35, 0.0, -0.15), 0.42), ((0.1, -0.1, 0.05), 0.5), ((0.5, 0.1, -0.2), 0.34),
         ((-0.05, 0.25, 0.3), 0.36), ((0.2, -0.35, -0.25), 0.3), ((-0.6, -0.15, -0.3), 0.22)]


def hashed(x, y, z):
    """A number in [-1, 1] for a point of the lattice."""
    h = (x * 374761393 + y * 668265263 + z * 2147483647 + 1274126177) & 0xffffffff
    h = ((h ^ (h >> 13)) * 1274126177) & 0xffffffff
    h = ((h ^ (h >> 16)) * 2246822519) & 0xffffffff
    return ((h ^ (h >> 13)) & 0xffff) / 32767.5 - 1


def noise(p):
    """Between the points of the lattice, smoothly."""
    cell = [math.floor(c) for c in p]
    t = [(c - f) * (c - f) * (3 - 2 * (c - f)) for c, f in zip(p, cell)]
    total = 0
    for corner in range(8):
        bits = [corner >> i & 1 for i in range(3)]
        weight = math.prod(t[i] if bits[i] else 1 - t[i] for i in range(3))
        total += weight * hashed(*(cell[i] + bits[i] for i in range(3)))
    return total


def density(p):
    inside = max(radius - math.dist(p, center) for center, radius in BALLS)
    if inside < -0.35:
        return 0
    frayed = inside + sum(0.16 / 2**i * noise([c * 4 * 2**i + 7 * i for c in p]) for i in range(4))
    return min(1, max(0, 3 * frayed))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-n", type=int, default=48, help="cells along each edge")
    parser.add_argument("file")
    given = parser.parse_args()
    n = given.n
    middles = [2 * (i + 0.5) / n - 1 for i in range(n)]
    values = bytes(round(255 * density((x, y, z)))
                   for z in middles for y in middles for x in middles)
    with open(given.file, "wb") as out:
        out.write(b"VOL\x03" + struct.pack("<5i6f", 3, n, n, n, 1, -1, -1, -1, 1, 1, 1) + values)


if __name__ == "__main__":
    main()
