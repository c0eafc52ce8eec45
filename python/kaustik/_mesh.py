"""Meshes from arrays."""

from __future__ import annotations

from typing import Any, Optional

from ._arrays import Buffer, numbers_of
from ._errors import Error


class Mesh:
    """Triangles from arrays, which are copied once.

    `vertices` is of shape (n, 3), in metres in the mesh's own space; `faces` of shape (m, 3) holds
    rows of `vertices`, from 0 on, counter-clockwise seen from outside; `normals` (n, 3) and `uvs`
    (n, 2) are of each vertex. Whatever has the buffer protocol will do, and lists of lists; strides
    of any kind are fine.

    Stands in the dict of a scene by itself, or with more to say of it::

        {"type": "mesh", "mesh": Mesh(vertices, faces), "bsdf": {"type": "dielectric"}}
    """

    __slots__ = ("_vertices", "_faces", "_normals", "_uvs")

    def __init__(self, vertices: Any, faces: Any, normals: Any = None, uvs: Any = None):
        self._vertices = numbers_of(vertices, "vertices", (None, 3))
        self._faces = numbers_of(faces, "faces", (None, 3), integers=True)
        count = self._vertices.shape[0]
        if count == 0:
            raise Error("vertices: there are none", "give at least three")
        if self._faces.shape[0] == 0:
            raise Error("faces: there are none", "give at least one triangle")
        bad = self._faces.find_outside(0, count - 1)
        if bad >= 0:
            raise Error(f"faces: row {bad // 3} refers to vertex {int(self._faces.at(bad))}",
                        f"give indices from 0 to {count - 1}: there are {count} vertices")
        self._normals = self._of_vertices(normals, "normals", 3)
        self._uvs = self._of_vertices(uvs, "uvs", 2)

    def _of_vertices(self, values: Any, name: str, columns: int) -> Optional[Buffer]:
        if values is None:
            return None
        buffer = numbers_of(values, name, (None, columns))
        if buffer.shape[0] != self._vertices.shape[0]:
            raise Error(f"{name}: {buffer.shape[0]} rows for {self._vertices.shape[0]} vertices",
                        "give one row for each vertex")
        return buffer

    @property
    def vertices(self) -> Buffer:
        return self._vertices

    @property
    def faces(self) -> Buffer:
        return self._faces

    @property
    def normals(self) -> Optional[Buffer]:
        return self._normals

    @property
    def uvs(self) -> Optional[Buffer]:
        return self._uvs

    def _properties(self) -> dict:
        """By the names of the type 'mesh'."""
        given = {"positions": self._vertices, "faces": self._faces, "normals": self._normals, "uv": self._uvs}
        return {name: buffer for name, buffer in given.items() if buffer is not None}

    def __reduce__(self):
        return Mesh, (self._vertices, self._faces, self._normals, self._uvs)

    def __repr__(self) -> str:
        extras = "".join(f", {name}" for name, given in (("normals", self._normals), ("uvs", self._uvs))
                         if given is not None)
        return f"<kaustik.Mesh: {self._vertices.shape[0]} vertices, {self._faces.shape[0]} faces{extras}>"
