#!/usr/bin/env python3
"""Turns data/cornell_box_*.csv (the measured Cornell box) into scenes/cornell_box/room.xml and its
meshes, in metres. The holes of the floor under the blocks are closed: nothing gets there."""
import csv
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "scenes" / "cornell_box"
ROOM = ["floor", "ceiling", "back_wall", "right_wall", "left_wall", "light"]
MATERIAL = {"right_wall": "green", "left_wall": "red"}


def rows_of(name):
    with open(ROOT / "data" / name, newline="") as file:
        return list(csv.DictReader(file))


def faces_of(surface):
    """Quadrilaterals of a surface by the name of the part."""
    faces = {}
    for row in rows_of("cornell_box_geometry.csv"):
        if row["surface"] == surface:
            point = tuple(float(row[c]) / 1000 for c in ("x_mm", "y_mm", "z_mm"))
            faces.setdefault(row["part"], []).append(point)
    return faces


def frame_around(outline, hole):
    """The ceiling without the hole of the light: four quadrilaterals between their edges. Both run
    in the same sense, from different corners."""
    corner = lambda p: min(range(4), key=lambda i: sum((a - b) ** 2 for a, b in zip(outline[i], p)))
    inner = {corner(p): p for p in hole}
    assert len(inner) == 4
    return [[outline[i], outline[(i + 1) % 4], inner[(i + 1) % 4], inner[i]] for i in range(4)]


def write_ply(path, faces):
    lines = ["ply", "format ascii 1.0", "comment made by scripts/make_cornell_box.py",
             f"element vertex {4 * len(faces)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(f"{c:.7g}" for c in point) for face in faces for point in face]
    lines += ["4 " + " ".join(str(4 * i + j) for j in range(4)) for i in range(len(faces))]
    path.write_text("\n".join(lines) + "\n")


def write_meshes():
    meshes = FOLDER / "meshes"
    meshes.mkdir(parents=True, exist_ok=True)
    for surface in ROOM + ["short_block", "tall_block"]:
        parts = faces_of(surface)
        if surface == "ceiling":
            faces = frame_around(parts["outline"], parts["hole_light"])
        else:
            faces = [points for part, points in parts.items() if not part.startswith("hole")]
        write_ply(meshes / f"{surface}.ply", faces)


def spectrum(name, values, indent):
    """A <spectrum> with ten samples per line. Where nothing was measured the nearest value stands."""
    values = [("360", values[0][1]), *values, ("830", values[-1][1])]
    pairs = [f"{nm}:{value}" for nm, value in values]
    lines = [", ".join(pairs[i:i + 10]) for i in range(0, len(pairs), 10)]
    separator = ",\n" + " " * (indent + 2)
    return f'{" " * indent}<spectrum name="{name}" value="{separator.join(lines)}"/>'


def bsdf(name, values):
    return (f'  <bsdf type="twosided" id="{name}">\n    <bsdf type="diffuse">\n'
            + spectrum("reflectance", values, 6) + "\n    </bsdf>\n  </bsdf>\n")


def shape(name, indent="  "):
    return (f'{indent}<shape type="ply">\n{indent}  <string name="filename" value="meshes/{name}.ply"/>\n'
            f'{indent}  <boolean name="face_normals" value="true"/>\n'
            f'{indent}  <ref id="{MATERIAL.get(name, "white")}"/>\n{indent}</shape>\n')


def light():
    rows = rows_of("cornell_box_light.csv")
    emission = [(r["lambda_nm"], r["emission_rel_radiance"]) for r in rows]
    return ('  <shape type="ply" id="lamp">\n    <string name="filename" value="meshes/light.ply"/>\n'
            '    <boolean name="face_normals" value="true"/>\n    <bsdf type="diffuse">\n'
            f'      <spectrum name="reflectance" value="{rows[0]["surface_reflectance"]}"/>\n'
            '    </bsdf>\n    <emitter type="area">\n' + spectrum("radiance", emission, 6)
            + "\n    </emitter>\n  </shape>\n")


def write_room():
    reflectance = rows_of("cornell_box_reflectance.csv")
    text = '<?xml version="1.0" encoding="utf-8"?>\n'
    text += "<!-- Made by scripts/make_cornell_box.py from data/cornell_box_*.csv; not to be edited.\n"
    text += "     The Cornell box as measured by the Program of Computer Graphics of Cornell University:\n"
    text += "     materials, walls and lamp, without blocks and camera. Lengths in metres; the emission,\n"
    text += "     published in relative units, is taken as W/(sr m2). -->\n"
    text += '<scene version="3.0.0">\n'
    for name in ("white", "green", "red"):
        text += bsdf(name, [(r["lambda_nm"], r[name]) for r in reflectance])
    text += "".join(shape(name) for name in ROOM if name != "light") + light() + "</scene>\n"
    (FOLDER / "room.xml").write_text(text)


if __name__ == "__main__":
    write_meshes()
    write_room()
