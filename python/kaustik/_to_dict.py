"""Scenes as dicts, for `load_dict`."""

from __future__ import annotations

from typing import Any, Dict, List

from . import _native
from ._transform import Transform


def _written(value: Any) -> Any:
    """As `load_dict` takes it."""
    if isinstance(value, _native.Transform):
        return Transform(value)
    if not isinstance(value, tuple):
        return value
    kind, rest = value[0], value[1:]
    if kind == "rgb":
        return {"type": "rgb", "value": tuple(rest)}
    if kind == "spectrum":
        return {"type": "spectrum", "value": [(nm, number) for nm, number in rest[0]]}
    return rest[0] if kind == "untyped" else tuple(rest)


class _Writer:
    def __init__(self, objects: list):
        self.objects = objects
        self.holders: Dict[int, int] = {}  #: how many objects hold each
        for *_, children in objects:
            for _, child in children:
                self.holders[child] = self.holders.get(child, 0) + 1
        self.on_top = {child for _, child in objects[0][5]}
        self.ids: Dict[int, str] = {}
        self.taken = {name for _, _, name, *_ in objects if name}
        self.written: set = set()

    def free(self, name: str, taken: Any) -> str:
        number, free = 0, name
        while free in taken:
            number += 1
            free = f"{name}_{number}"
        return free

    def id_of(self, index: int) -> str:
        """Its own, or one that is made for what several objects hold, and for what stands at the top."""
        if index not in self.ids:
            family, _, name = self.objects[index][:3]
            if not name:
                name = self.free(family, self.taken)
                self.taken.add(name)
            self.ids[index] = name
        return self.ids[index]

    def scene(self) -> Dict[str, Any]:
        """What refers comes after what it refers to, but for the order at the top, which says which lamp is which."""
        made: Dict[str, Any] = {"type": "scene"}
        for index in dict.fromkeys(child for _, child in self.objects[0][5]):
            made[self.id_of(index)] = self.object(index)
        return made

    def object(self, index: int) -> Dict[str, Any]:
        _, type_name, _, _, properties, children = self.objects[index]
        self.written.add(index)
        made: Dict[str, Any] = {"type": type_name}
        for name, value, _ in properties:
            made[name] = _written(value)
        for name, child in children:
            family = self.objects[child][0]
            key = self.free(name or family, made)
            if child in self.on_top or child in self.written:
                made[key] = {"type": "ref", "id": self.id_of(child)}
            else:
                made[key] = self.object(child)
                if self.objects[child][2] or self.holders[child] > 1:
                    made[key] = {"type": made[key].pop("type"), "id": self.id_of(child), **made[key]}
        return made


def dict_of(objects: List[tuple]) -> Dict[str, Any]:
    return _Writer(objects).scene()
