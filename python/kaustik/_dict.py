"""Scenes from dicts, in Mitsuba 3's convention, to the objects of a description."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

from . import _native
from ._errors import Error, Problem, raise_all
from ._mesh import Mesh
from ._types import Type, types
from ._values import checked_text, colour_value, native_value

_colours = ("rgb", "spectrum")
#: Families whose objects have no name within what holds them.
_nameless = ("film", "rfilter", "sampler", "sensor", "emitter", "integrator", "shape", "phase")
#: Objects nest so deep at most.
_maximum_depth = 100
#: Mitsuba's names of what is a family here.
_families = tuple(types)


class _Object:
    """An object on its way: children are objects, or ids that are looked up at the end."""

    def __init__(self, family: str, type_name: str, place: str):
        self.family, self.type, self.place, self.id = family, type_name, place, ""
        self.properties: List[tuple] = []
        self.children: List[Tuple[str, Any]] = []


class _Reader:
    def __init__(self) -> None:
        self.problems: List[Problem] = []
        self.ids: Dict[str, _Object] = {}

    def add(self, message: str, remedy: str, place: str) -> None:
        self.problems.append(Problem(message, remedy, place))

    def scene(self, scene: Any) -> _Object:
        made = _Object("scene", "", "scene")
        if not isinstance(scene, dict) or scene.get("type") != "scene":
            raise Error("a scene is a dict of type 'scene'",
                        'write {"type": "scene", "lamp": {"type": "constant"}, …}', "scene")
        for key, value in scene.items():
            if key in ("type", "id"):
                continue
            if not _is_text(key):
                self.add(f"the key {ascii(key)} is no text", "keys are the ids of objects", "scene")
            elif not isinstance(value, (dict, Mesh)):
                self.add(f"{type(value).__name__} is no object of a scene",
                         'write a dict with a "type", or a kaustik.Mesh', key)
            elif isinstance(value, dict) and value.get("type") in _colours:
                self.add("a colour at the top of the scene", "put it into the object that it is of", key)
            elif isinstance(value, dict) and value.get("type") == "ref":
                self.add("a reference at the top of the scene", "put it into the object that refers", key)
            else:
                child = self.object(key, value, key)
                if child is not None:
                    self.take_id(child, child.id or key)
                    made.children.append(("", child))
        self.resolve(made)
        raise_all(self.problems)
        return made

    def take_id(self, made: _Object, name: str) -> None:
        if self.ids.setdefault(name, made) is not made:
            self.add(f"the id '{name}' is given twice", "give each object an id of its own", made.place)
        made.id = name

    def object(self, key: str, value: Any, place: str) -> Optional[_Object]:
        if isinstance(value, Mesh):
            value = {"type": "mesh", "mesh": value}
        name = value.get("type")
        if place.count(".") > _maximum_depth:
            self.add(f"objects nest more than {_maximum_depth} levels deep", "make the scene flatter", place[:80] + "…")
            return None
        if not _is_text(name):
            self.add("an object without a type", 'give it a "type", such as "sphere"', place)
            return None
        family = _family_of(name, key)
        if family is None:
            every = [known for others in types.values() for known in others]
            self.add(f"unknown type '{name}'", _native.suggest(name, every), place)
            return None
        made = _Object(family, name, place)
        table = types.find(family, name)
        for part, given in value.items():
            if part == "type":
                continue
            if part == "id":
                if _is_text(given):
                    self.take_id(made, given)
                else:
                    self.add("the id is no text", "give a name", place)
            elif not _is_text(part):
                self.add(f"the key {ascii(part)} is no text", "keys are names of parameters", place)
            else:
                self.part(made, table, part, given, f"{place}.{part}")
        return made

    def part(self, made: _Object, table: Optional[Type], name: str, given: Any, place: str) -> None:
        try:
            if isinstance(given, Mesh) and made.type == "mesh":
                made.properties += [(own, buffer, _at(place)) for own, buffer in given._properties().items()]
            elif isinstance(given, Mesh):
                made.children.append(("", self.object(name, given, place)))
            elif not isinstance(given, dict):
                row = table.get(name) if table is not None else None
                made.properties.append((name, native_value(given, row.kind if row else None, place), _at(place)))
            elif given.get("type") in _colours:
                is_light = made.family == "emitter"
                made.properties.append((name, colour_value(given, place, is_light=is_light), _at(place)))
            elif given.get("type") == "ref":
                self.reference(made, name, given, place)
            else:
                child = self.object(name, given, place)
                if child is not None:
                    made.children.append((_name_within(name, child.family), child))
        except Error as error:
            self.problems += error.problems

    def reference(self, made: _Object, name: str, given: dict, place: str) -> None:
        if not _is_text(given.get("id")):
            self.add("a reference without an id", 'write {"type": "ref", "id": "white"}', place)
        else:
            made.children.append((name, (given["id"], place)))

    def resolve(self, scene: _Object) -> None:
        """References by the objects that they name."""
        pending, seen = [scene], set()
        while pending:
            made = pending.pop()
            if id(made) in seen:
                continue
            seen.add(id(made))
            children = []
            for name, child in made.children:
                if isinstance(child, tuple):
                    child, (wanted, place) = self.ids.get(child[0]), child
                    if child is None:
                        self.add(f"nothing has the id '{wanted}'", _native.suggest(wanted, list(self.ids)), place)
                        continue
                    name = _name_within(name, child.family)
                if child is not None:
                    children.append((name, child))
                    pending.append(child)
            made.children = children
        if not self.problems:
            self.refuse_circles(scene)

    def refuse_circles(self, scene: _Object) -> None:
        done: set = set()
        above: set = set()
        pending = [(scene, False)]
        while pending:
            made, is_left = pending.pop()
            if is_left:
                above.discard(id(made))
                done.add(id(made))
                continue
            if id(made) in done:
                continue
            above.add(id(made))
            pending.append((made, True))
            for _, child in made.children:
                if id(child) in above:
                    self.add("it holds itself, by references", "take one of them out", child.place)
                    return
                pending.append((child, False))


def _at(place: str) -> tuple:
    return (place, 0, 0)


def _is_text(given: Any) -> bool:
    """Of one word or more, that a file could hold."""
    try:
        return isinstance(given, str) and checked_text(given, "") != ""
    except Error:
        return False


def _family_of(name: str, key: str) -> Optional[str]:
    found = [family for family, members in types.items() if name in members and family != "tonemap"]
    if key in found or not found:
        return key if key in _families else None
    return found[0]


def _name_within(name: str, family: str) -> str:
    return "" if family in _nameless or name == family else name


def _flattened(scene: _Object) -> list:
    """Each object once, as the compiled part takes them."""
    order: List[_Object] = []
    index: Dict[int, int] = {}
    pending = [scene]
    while pending:
        made = pending.pop()
        if id(made) in index:
            continue
        index[id(made)] = len(order)
        order.append(made)
        pending += [child for _, child in reversed(made.children)]
    return [(made.family, made.type, made.id, _at(made.place), made.properties,
             [(name, index[id(child)]) for name, child in made.children]) for made in order]


def objects_of_scene(scene: Any) -> list:
    """The objects of a dict of type 'scene'. Raises Error with all problems."""
    return _flattened(_Reader().scene(scene))


def objects_of_integrator(integrator: dict) -> list:
    reader = _Reader()
    made = reader.object("integrator", integrator, "integrator")
    if made is not None and made.family != "integrator":
        reader.add(f"'{made.type}' is of family {made.family}", "give an integrator", "integrator")
    if made is not None:
        reader.resolve(made)
    raise_all(reader.problems)
    return _flattened(made) if made is not None else []
