#!/usr/bin/env python3
"""Makes the mesh of scenes/metal_ring: a ring about the z axis that stands on z = 0, turned from a
rectangle with rounded edges. Vertices carry the exact normals of the surface."""
import math
import pathlib
import struct

ROOT = pathlib.Path(__file__).resolve().parent.parent
INNER_RADIUS, OUTER_RADIUS, HEIGHT, EDGE_RADIUS = 0.046, 0.050, 0.024, 0.0014
SEGMENTS = 384  # around the axis
EDGE_STEPS = 6  # along the rounding of an edge


def profile():
    """Points (radius, height) of the cross section with their normals, counterclockwise."""
    corners = [  # centre of the rounding, first angle
        (OUTER_RADIUS - EDGE_RADIUS, EDGE_RADIUS, -90),
        (OUTER_RADIUS - EDGE_RADIUS, HEIGHT - EDGE_RADIUS, 0),
        (INNER_RADIUS + EDGE_RADIUS, HEIGHT - EDGE_RADIUS, 90),
        (INNER_RADIUS + EDGE_RADIUS, EDGE_RADIUS, 180),
    ]
    points = []
    for radius, height, first in corners:
        for i in range(EDGE_STEPS + 1):
            angle = math.radians(first + 90 * i / EDGE_STEPS)
            normal = (math.cos(angle), math.sin(angle))
            points.append((radius + EDGE_RADIUS * normal[0], height + EDGE_RADIUS * normal[1], normal))
    return points


def ring():
    section = profile()
    vertices, faces = [], []
    for s in range(SEGMENTS):
        c, n = math.cos(2 * math.pi * s / SEGMENTS), math.sin(2 * math.pi * s / SEGMENTS)
        for radius, height, normal in section:
            vertices.append((radius * c, radius * n, height, normal[0] * c, normal[0] * n, normal[1]))
    count = len(section)
    for s in range(SEGMENTS):
        here, there = s * count, (s + 1) % SEGMENTS * count
        for i in range(count):
            j = (i + 1) % count
            faces += [(here + i, there + j, here + j), (here + i, there + i, there + j)]
    return vertices, faces


def write_ply(path, vertices, faces):
    header = ["ply", "format binary_little_endian 1.0", "comment made by scripts/make_metal_ring.py",
              f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    data = b"".join(struct.pack("<6f", *v) for v in vertices)
    data += b"".join(struct.pack("<B3i", 3, *f) for f in faces)
    path.write_bytes("\n".join(header).encode() + data)


if __name__ == "__main__":
    folder = ROOT / "scenes" / "metal_ring" / "meshes"
    folder.mkdir(parents=True, exist_ok=True)
    write_ply(folder / "ring.ply", *ring())
