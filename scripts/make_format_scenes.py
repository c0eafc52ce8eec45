#!/usr/bin/env python3
"""Makes the meshes of scenes/formats: still_life.glb, and OBJ files of the scenes in OBJ and Nori's XML.

Usage: scripts/make_format_scenes.py [FOLDER]     [scenes/formats]

Lengths are in metres. The same files come out each time.
"""

import json
import math
import pathlib
import struct
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Mesh:
    """Points, normals (may be empty: flat), and triangles, anticlockwise as seen from outside."""

    def __init__(self):
        self.points, self.normals, self.triangles = [], [], []

    def box(self):
        return ([min(p[i] for p in self.points) for i in range(3)], [max(p[i] for p in self.points) for i in range(3)])


def joined(mesh):
    """The same with each vertex once."""
    result, numbers = Mesh(), {}
    for triangle in mesh.triangles:
        corners = []
        for i in triangle:
            key = tuple(round(x, 7) for x in (*mesh.points[i], *mesh.normals[i]))
            if key not in numbers:
                numbers[key] = len(result.points)
                result.points.append(mesh.points[i])
                result.normals.append(mesh.normals[i])
            corners.append(numbers[key])
        result.triangles.append(tuple(corners))
    return result


def turned(profile, sides):
    """The body of a closed profile [(radius, height)], clockwise around its matter as seen with the radius to the
    right, turned about +y. Normals are smooth where the profile turns by less than 40°."""
    mesh = Mesh()
    corners = len(profile)
    edges = [(profile[(i + 1) % corners][0] - profile[i][0], profile[(i + 1) % corners][1] - profile[i][1])
             for i in range(corners)]

    def outward(edge):
        length = math.hypot(*edge) or 1
        return (edge[1] / length, -edge[0] / length)

    def normal_at(corner, edge):
        """Of the edge at one of its ends: the mean of two edges that meet smoothly."""
        own = outward(edges[edge])
        other = outward(edges[(corner - 1) % corners if edge == corner else corner])
        if own[0] * other[0] + own[1] * other[1] < math.cos(math.radians(40)):
            return own
        total = (own[0] + other[0], own[1] + other[1])
        length = math.hypot(*total)
        return (total[0] / length, total[1] / length)

    for edge in range(corners):
        ends = (edge, (edge + 1) % corners)
        if profile[ends[0]][0] == 0 and profile[ends[1]][0] == 0:
            continue  # on the axis
        first = len(mesh.points)
        for side in range(sides + 1):
            angle = 2 * math.pi * (side % sides) / sides
            direction = (math.cos(angle), math.sin(angle))
            for end in ends:
                radius, height = profile[end]
                across, up = normal_at(end, edge)
                mesh.points.append((radius * direction[0], height, radius * direction[1]))
                mesh.normals.append((across * direction[0], up, across * direction[1]))
        for side in range(sides):
            a = first + 2 * side
            if profile[ends[0]][0] != 0:
                mesh.triangles.append((a, a + 1, a + 2))
            if profile[ends[1]][0] != 0:
                mesh.triangles.append((a + 2, a + 1, a + 3))
    return joined(mesh)


def ball(radius, centre_height, sides, rings):
    arc = [(radius * math.sin(math.pi * i / rings) if 0 < i < rings else 0.0,
            centre_height - radius * math.cos(math.pi * i / rings)) for i in range(rings + 1)]
    return turned(arc, sides)


def faceted(radius, sides):
    """A brilliant: crown, girdle and pavilion of flat facets, its table at the top, its tip at y = 0."""
    pavilion, crown = 0.86 * radius, 0.32 * radius
    rings = [(0.0, 0.0, 0), (radius, pavilion, 0), (radius, pavilion + 0.05 * radius, 0),
             (0.55 * radius, pavilion + crown, 1), (0.0, pavilion + crown, 0)]
    mesh = Mesh()

    def corner(ring, side):
        distance, height, half = rings[ring]
        angle = 2 * math.pi * (side + half / 2) / sides
        return (distance * math.cos(angle), height, distance * math.sin(angle))

    def facet(*corners):
        first = len(mesh.points)
        mesh.points += corners
        a, b, c = corners
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        length = math.sqrt(sum(x * x for x in n))
        mesh.normals += [tuple(x / length for x in n)] * 3
        mesh.triangles.append((first, first + 1, first + 2))

    for side in range(sides):
        facet(corner(0, side), corner(1, side), corner(1, side + 1))
        facet(corner(1, side), corner(2, side), corner(1, side + 1))
        facet(corner(1, side + 1), corner(2, side), corner(2, side + 1))
        facet(corner(2, side), corner(3, side), corner(2, side + 1))
        facet(corner(2, side + 1), corner(3, side), corner(3, side + 1))
        facet(corner(3, side), corner(4, side), corner(3, side + 1))
    return mesh


def rectangle(width, depth):
    """In the plane y = 0, facing up."""
    mesh = Mesh()
    mesh.points = [(-width / 2, 0, depth / 2), (width / 2, 0, depth / 2), (width / 2, 0, -depth / 2),
                   (-width / 2, 0, -depth / 2)]
    mesh.normals = [(0, 1, 0)] * 4
    mesh.triangles = [(0, 1, 2), (0, 2, 3)]
    return mesh


def rounded(points, steps=4):
    """The same profile with corners cut by curves: [(radius, height, how far from the corner)]."""
    result = []
    for i, (radius, height, cut) in enumerate(points):
        before, after = points[i - 1], points[(i + 1) % len(points)]
        if cut == 0:
            result.append((radius, height))
            continue

        def toward(other):
            length = math.hypot(other[0] - radius, other[1] - height)
            return (radius + (other[0] - radius) * cut / length, height + (other[1] - height) * cut / length)

        a, b = toward(before), toward(after)
        for step in range(steps + 1):
            t = step / steps
            weights = ((1 - t) ** 2, 2 * t * (1 - t), t * t)
            result.append(tuple(weights[0] * a[k] + weights[1] * (radius, height)[k] + weights[2] * b[k] for k in (0, 1)))
    return result


# The matter lies to the right of the way round, as turned() wants it: up along the axis' side, down outside is clockwise
# with the radius to the right. So the lists run from the axis below outward, and back to the axis above.
GOBLET = rounded([(0.0, 0.0, 0), (0.036, 0.0, 0.0015), (0.036, 0.0025, 0.001), (0.009, 0.0075, 0.008), (0.0042, 0.02, 0.008),
                  (0.0042, 0.07, 0.012), (0.03, 0.088, 0.018), (0.038, 0.12, 0.016), (0.031, 0.165, 0.0006),
                  (0.0298, 0.165, 0.0006), (0.0365, 0.12, 0.016), (0.0285, 0.0895, 0.0165), (0.0, 0.078, 0)])
BOWL = rounded([(0.0, 0.0, 0), (0.022, 0.0, 0.002), (0.024, 0.006, 0.003), (0.06, 0.034, 0.02), (0.07, 0.058, 0.0012),
                (0.0672, 0.058, 0.0012), (0.057, 0.036, 0.02), (0.02, 0.0095, 0.012), (0.0, 0.0085, 0)])


class Glb:
    """A binary glTF file."""

    def __init__(self):
        self.bytes = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "scripts/make_format_scenes.py"}, "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [],
                     "bufferViews": [], "buffers": [{}]}

    def _view(self, data, target):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data),
                                         "target": target})
        self.bytes += data
        self.bytes += bytes(-len(self.bytes) % 4)
        return len(self.json["bufferViews"]) - 1

    def _accessor(self, **facts):
        self.json["accessors"].append(facts)
        return len(self.json["accessors"]) - 1

    def mesh(self, name, mesh, material):
        def vectors(values):
            return b"".join(struct.pack("<3f", *v) for v in values)

        low, high = mesh.box()
        as_floats = lambda values: list(struct.unpack("<3f", struct.pack("<3f", *values)))
        positions = self._accessor(bufferView=self._view(vectors(mesh.points), 34962), componentType=5126,
                                   count=len(mesh.points), type="VEC3", min=as_floats(low), max=as_floats(high))
        normals = self._accessor(bufferView=self._view(vectors(mesh.normals), 34962), componentType=5126,
                                 count=len(mesh.normals), type="VEC3")
        indices = self._accessor(
            bufferView=self._view(b"".join(struct.pack("<3H", *t) for t in mesh.triangles), 34963), componentType=5123,
            count=3 * len(mesh.triangles), type="SCALAR")
        self.json["meshes"].append({"name": name, "primitives": [
            {"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices, "material": material}]})
        return len(self.json["meshes"]) - 1

    def material(self, name, **facts):
        self.json["materials"].append({"name": name, **facts})
        used = self.json.setdefault("extensionsUsed", [])
        for extension in facts.get("extensions", {}):
            if extension not in used:
                used.append(extension)
        return len(self.json["materials"]) - 1

    def node(self, **facts):
        self.json["nodes"].append(facts)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def write(self, path):
        self.json["buffers"][0]["byteLength"] = len(self.bytes)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(self.bytes)) +
                         struct.pack("<I4s", len(text), b"JSON") + text +
                         struct.pack("<I4s", len(self.bytes), b"BIN\0") + bytes(self.bytes))


def facing(eye, target):
    """Quaternion (x, y, z, w) that turns -z to the target, +y up."""
    back = [eye[i] - target[i] for i in range(3)]
    length = math.sqrt(sum(x * x for x in back))
    z = [x / length for x in back]
    across = math.hypot(z[2], z[0])
    x = [z[2] / across, 0.0, -z[0] / across]
    y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
    w = math.sqrt(max(0.0, 1 + x[0] + y[1] + z[2])) / 2
    return [(y[2] - z[1]) / (4 * w), (z[0] - x[2]) / (4 * w), (x[1] - y[0]) / (4 * w), w]


def make_glb(path):
    """A goblet, a bowl, stones and balls under a spot lamp."""
    glb = Glb()
    pbr = lambda colour, metal, rough: {"baseColorFactor": [*colour, 1], "metallicFactor": metal, "roughnessFactor": rough}
    table = glb.material("table", pbrMetallicRoughness=pbr((0.34, 0.3, 0.27), 0, 0.55))
    wall = glb.material("wall", pbrMetallicRoughness=pbr((0.2, 0.26, 0.3), 0, 0.9))
    crystal = glb.material("crystal", pbrMetallicRoughness=pbr((1, 1, 1), 0, 0), extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.54},
        "KHR_materials_volume": {"thicknessFactor": 0.004}})
    ruby = glb.material("ruby", pbrMetallicRoughness=pbr((1, 1, 1), 0, 0), extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.77},
        "KHR_materials_volume": {"thicknessFactor": 0.03, "attenuationColor": [0.75, 0.03, 0.06],
                                 "attenuationDistance": 0.02}})
    emerald = glb.material("emerald", pbrMetallicRoughness=pbr((1, 1, 1), 0, 0), extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.58},
        "KHR_materials_volume": {"thicknessFactor": 0.03, "attenuationColor": [0.04, 0.62, 0.2],
                                 "attenuationDistance": 0.02}})
    gold = glb.material("gold", pbrMetallicRoughness=pbr((1, 0.71, 0.29), 1, 0.18), doubleSided=True)
    paint = glb.material("paint", pbrMetallicRoughness=pbr((0.03, 0.11, 0.32), 0, 0.6), extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.04}})
    lamp = glb.material("panel", pbrMetallicRoughness=pbr((0, 0, 0), 0, 1), emissiveFactor=[1, 0.86, 0.7], extensions={
        "KHR_materials_emissive_strength": {"emissiveStrength": 900}})
    balls = glb.mesh("ball", ball(0.028, 0.028, 64, 32), paint)
    stone = glb.mesh("ruby", faceted(0.022, 12), ruby)
    other_stone = glb.mesh("emerald", faceted(0.02, 8), emerald)
    glb.node(name="table", mesh=glb.mesh("table", rectangle(3, 3), table))
    glb.node(name="wall", mesh=glb.mesh("wall", rectangle(3, 3), wall), translation=[0, 0.5, -0.7],
             rotation=[math.sin(math.pi / 4), 0, 0, math.cos(math.pi / 4)])
    glb.node(name="goblet", mesh=glb.mesh("goblet", turned(GOBLET, 72), crystal), translation=[-0.035, 0.0003, 0.01])
    glb.node(name="bowl", mesh=glb.mesh("bowl", turned(BOWL, 72), gold), translation=[0.1, 0.0003, -0.045])
    glb.node(name="ball", mesh=balls, translation=[-0.135, 0.0003, -0.02])
    tilt = math.radians(51) / 2
    glb.node(name="ruby", mesh=stone, translation=[0.045, 0.0003, 0.085], rotation=[0, 0, -math.sin(tilt), math.cos(tilt)])
    glb.node(name="emerald", mesh=other_stone, translation=[-0.075, 0.0003, 0.095],
             rotation=[math.sin(tilt), 0, 0, math.cos(tilt)])
    glb.node(name="panel", mesh=glb.mesh("panel", rectangle(0.5, 0.3), lamp), translation=[-0.8, 0.55, 0.3],
             rotation=[0, 0, -math.sin(math.radians(62)), math.cos(math.radians(62))])
    glb.json["extensionsUsed"].append("KHR_lights_punctual")
    glb.json["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"name": "spot", "type": "spot", "color": [1, 0.93, 0.82], "intensity": 160,
         "spot": {"innerConeAngle": 0.22, "outerConeAngle": 0.5}}]}}
    eye, target = (0.34, 0.42, -0.3), (0.0, 0.03, 0.02)
    glb.node(name="spot", translation=list(eye), rotation=facing(eye, target),
             extensions={"KHR_lights_punctual": {"light": 0}})
    glb.json["cameras"] = [{"type": "perspective", "perspective": {"aspectRatio": 4 / 3, "yfov": 0.42, "znear": 0.01}}]
    eye, target = (0.02, 0.27, 0.62), (0.0, 0.056, 0.005)
    glb.node(name="camera", camera=0, translation=list(eye), rotation=facing(eye, target))
    glb.write(path)


def write_obj(path, parts, library=None):
    """Parts: [(name, material or None, mesh, (x, y, z))]."""
    lines = [f"# {path.name}: scripts/make_format_scenes.py"]
    if library:
        lines.append(f"mtllib {library}")
    first = 1
    for name, material, mesh, place in parts:
        lines.append(f"o {name}")
        if material:
            lines.append(f"usemtl {material}")
        lines += ["v " + " ".join(f"{p[i] + place[i]:.6g}" for i in range(3)) for p in mesh.points]
        lines += ["vn " + " ".join(f"{x:.5g}" for x in n) for n in mesh.normals]
        lines += ["f " + " ".join(f"{i + first}//{i + first}" for i in t) for t in mesh.triangles]
        first += len(mesh.points)
    path.write_text("\n".join(lines) + "\n")


def make_obj(folder):
    write_obj(folder / "goblets.obj", [
        ("table", "table", rectangle(0.42, 0.36), (0, 0, 0.03)),
        ("clear", "glass", turned(GOBLET, 32), (-0.05, 0.0003, 0.03)),
        ("blue", "blue_glass", turned(GOBLET, 32), (0.045, 0.0003, -0.03)),
        ("bowl", "silver", turned(BOWL, 32), (0.075, 0.0003, 0.085)),
        ("ball", "red_paint", ball(0.02, 0.02, 32, 16), (-0.11, 0.0003, 0.1)),
    ], "goblets.mtl")


def panel(width, depth, right, front, place):
    """A rectangle by its axes, facing right × front."""
    mesh = Mesh()
    normal = (right[1] * front[2] - right[2] * front[1], right[2] * front[0] - right[0] * front[2],
              right[0] * front[1] - right[1] * front[0])
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        mesh.points.append(tuple(place[i] + a * width / 2 * right[i] + b * depth / 2 * front[i] for i in range(3)))
    mesh.normals = [normal] * 4
    mesh.triangles = [(0, 1, 2), (0, 2, 3)]
    return mesh


def make_nori_meshes(folder):
    here = (0, 0, 0)
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    minus_z = (0, 0, -1)
    write_obj(folder / "room.obj", [
        ("floor", None, panel(2, 2, x, minus_z, (0, 0, 0)), here),
        ("ceiling", None, panel(2, 2, x, z, (0, 2, 0)), here),
        ("back", None, panel(2, 2, x, y, (0, 1, -1)), here)])
    write_obj(folder / "left.obj", [("left", None, panel(2, 2, minus_z, y, (-1, 1, 0)), here)])
    write_obj(folder / "right.obj", [("right", None, panel(2, 2, z, y, (1, 1, 0)), here)])
    write_obj(folder / "lamp.obj", [("lamp", None, panel(0.6, 0.5, x, z, (0, 1.995, 0)), here)])
    write_obj(folder / "ball.obj", [("ball", None, ball(1, 0, 40, 20), here)])


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "scenes/formats"
    for name in ("gltf", "obj", "nori"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    make_glb(folder / "gltf/still_life.glb")
    make_obj(folder / "obj")
    make_nori_meshes(folder / "nori")


if __name__ == "__main__":
    main()
