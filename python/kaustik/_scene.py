"""Scenes: loaded, looked at, edited."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Dict, Iterator, List, Optional, Tuple, Union

from . import _native, _threads
from ._dict import objects_of_integrator, objects_of_scene
from ._errors import Error, Problem, raise_all
from ._to_dict import dict_of
from ._types import Type, types
from ._values import native_value, python_value

_no_default = object()


class Parameters(Mapping):
    """The parameters of a scene's objects by ``"id.name"``; objects without an id have the place
    where they stand: ``"floor.bsdf.reflectance"``. What is not given shows the default. Not to be
    changed: `Scene.edit` makes another scene."""

    def __init__(self, objects: list):
        self._values: Dict[str, Any] = {}
        self._slots: Dict[str, Tuple[int, str, Optional[Type]]] = {}
        for index, prefix in _prefixes(objects).items():
            family, type_name, _, _, properties, children = objects[index]
            table = types.find(family, type_name)
            nested = {name for name, _ in children}
            given = {name: value for name, value, _ in properties}
            for name, value in given.items():
                self._put(f"{prefix}.{name}", python_value(value), index, name, table)
            for name, row in (table or {}).items():
                if name in given or name in nested or row.no_effect:
                    continue
                self._slots[f"{prefix}.{name}"] = (index, name, table)
                if row.default is not None:
                    self._values[f"{prefix}.{name}"] = row.default

    def _put(self, key: str, value: Any, index: int, name: str, table: Optional[Type]) -> None:
        self._values[key] = value
        self._slots[key] = (index, name, table)

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __setitem__(self, key: str, value: Any) -> None:
        raise Error("scenes do not change", f'make another one: scene = scene.edit({{"{key}": {value!r}}})')

    def __delitem__(self, key: str) -> None:
        raise Error("scenes do not change", "make another one by scene.edit({…})")

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def _ipython_key_completions_(self) -> List[str]:
        return list(self._values)

    def slot(self, key: str) -> Tuple[int, str, Optional[Type]]:
        """Of what number the object is, and which of its parameters; its table."""
        if key not in self._slots:
            known = list(self._slots)
            raise Error(f"the scene has no parameter {ascii(key)}", _native.suggest(ascii(key)[1:-1], known), str(key))
        return self._slots[key]

    def __repr__(self) -> str:
        width = max(map(len, self._values), default=0)
        rows = []
        for key, value in self._values.items():
            index, name, table = self._slots[key]
            unit = table[name].unit if table is not None and name in table else ""
            rows.append(f"{key:{width}}  {_short(value)}" + (f" {unit}" if unit else ""))
        return "\n".join(rows)


def _short(value: Any) -> str:
    if isinstance(value, _native.Buffer):
        return f"<{value.dtype} {'x'.join(map(str, value.shape))}>"
    text = " ".join(repr(value).split())
    return text if len(text) <= 80 else text[:77] + "…"


def _prefixes(objects: list) -> Dict[int, str]:
    """Of each object but the scene its id, or where it stands for the first time."""
    prefixes: Dict[int, str] = {}
    taken = {name for _, _, name, _, _, _ in objects if name}

    def visit(index: int, prefix: str) -> None:
        counts: Dict[str, int] = {}
        for name, child in objects[index][5]:
            family, _, own_id = objects[child][:3]
            if child in prefixes:
                continue
            key = own_id
            if not key:
                key = name or family
                counts[key] = counts.get(key, -1) + 1
                key = key if counts[key] == 0 else f"{key}_{counts[key]}"
                key = f"{prefix}.{key}" if prefix else key
                while key in taken:
                    key += "_"
            prefixes[child] = key
            visit(child, key)

    visit(0, "")
    return prefixes


class Scene:
    """A scene, which does not change. From `load_file`, `load_string` or `load_dict`."""

    _native: Any
    _source: str
    _definitions: Tuple[Tuple[str, str], ...]
    _parameters: Optional[Parameters]
    _previous: Optional["Scene"]

    def __init__(self, *_: Any):
        raise TypeError("make scenes by kaustik.load_file, load_string or load_dict")

    @classmethod
    def _of(cls, native: Any, source: str = "", definitions: Tuple[Tuple[str, str], ...] = (),
            previous: Optional["Scene"] = None) -> "Scene":
        scene = object.__new__(cls)
        scene._native = native
        scene._source = source
        scene._definitions = definitions
        scene._parameters = None
        scene._previous = previous
        return scene

    def _build(self) -> "Scene":
        """With the check of everything in it. Raises Error."""
        if not self._native.is_built:
            _threads.begin()
            previous, self._previous = self._previous, None
            self._native.build(previous._native if previous is not None else None)
        return self

    def _require_camera(self) -> None:
        if not self._native.has_camera:
            raise Error("the scene has no camera",
                        'add one, {"type": "perspective", "to_world": …}; kaustik.irradiance, radiance and '
                        "trace_photons need none", "scene")

    @property
    def parameters(self) -> Parameters:
        if self._parameters is None:
            self._parameters = Parameters(self._native.objects)
        return self._parameters

    @property
    def warnings(self) -> Tuple[str, ...]:
        """What was left out, or is odd."""
        self._build()
        return tuple(self._native.build_warnings)

    @property
    def source(self) -> str:
        """The file; "": it comes from none, or was edited."""
        return self._source

    def edit(self, changes: Optional[Dict[str, Any]] = None) -> "Scene":
        """Another scene with these values: ``scene.edit({"lamp.radiance": 2})``. It shares with this one
        all that is the same. Raises Error with all that is wrong; this scene stays as it is."""
        problems: List[Problem] = []
        edits = []
        for key, value in dict(changes or {}).items():
            try:
                index, name, table = self.parameters.slot(key)
                row = table.get(name) if table is not None else None
                edits.append((index, name, native_value(value, row.kind if row else None, key), (key, 0, 0)))
            except Error as error:
                problems += error.problems
        raise_all(problems)
        self._build()
        return Scene._of(self._native.edited(edits), previous=self)._build()

    def _with_integrator(self, integrator: dict) -> "Scene":
        return Scene._of(self._native.with_integrator(objects_of_integrator(integrator)), previous=self._build())

    def to_xml(self, folder: Union[str, os.PathLike] = "") -> str:
        """The scene as XML of Mitsuba 3, for a file in `folder`, which names of files are relative to.
        Raises Error for what XML cannot hold: arrays."""
        return str(self._native.to_xml(os.fspath(folder)))

    def to_dict(self) -> Dict[str, Any]:
        """The scene as a dict for `load_dict`, with all that it holds; arrays and transforms are not copied.
        ``load_dict(scene.to_dict(), strict=False)`` renders the same."""
        return dict_of(self._native.objects)

    def __reduce__(self):
        native = self._native
        return _unpickled, (list(native.objects), native.sources, native.load_warnings, native.is_strict,
                            self._source, self._definitions)

    def __repr__(self) -> str:
        objects = self._native.objects
        prefixes = _prefixes(objects)
        rows = [(prefixes[index], objects[index][0], objects[index][1]) for index in sorted(prefixes)]
        shown = rows[:60]
        widths = [max((len(row[column]) for row in shown), default=0) for column in range(2)]
        lines = [f"  {key:{widths[0]}}  {family:{widths[1]}}  {name}" for key, family, name in shown]
        if len(rows) > len(shown):
            lines.append(f"  … and {len(rows) - len(shown)} more")
        head = f"kaustik.Scene '{self._source}'" if self._source else "kaustik.Scene"
        return "\n".join([f"{head}: {len(rows)} objects"] + lines)


def _unpickled(objects: list, sources: list, warnings: list, is_strict: bool, source: str,
               definitions: tuple) -> Scene:
    return Scene._of(_native.scene_from_objects(objects, sources, warnings, is_strict), source, definitions)


def _texts(definitions: Dict[str, Any]) -> Tuple[Tuple[str, str], ...]:
    def text(value: Any) -> str:
        return str(value).lower() if isinstance(value, bool) else str(value)

    return tuple((name, text(value)) for name, value in definitions.items())


def load_file(path: Union[str, os.PathLike], *, strict: bool = False, **definitions: Any) -> Scene:
    """The scene of a Mitsuba XML file, packed by gzip or not. `definitions` stand for ``$name`` in it.
    What Kaustik does not know is left out and told in `warnings`, unless `strict`. Raises Error."""
    pairs = _texts(definitions)
    source = os.fspath(path)
    return Scene._of(_native.load_file(source, pairs, strict), source, pairs)._build()


def load_string(xml: str, *, folder: Union[str, os.PathLike] = "", strict: bool = False,
                **definitions: Any) -> Scene:
    """The same of XML text; names of files in it are relative to `folder`."""
    native = _native.load_string(xml, "string", os.fspath(folder), _texts(definitions), strict)
    return Scene._of(native)._build()


def load_dict(scene: dict, *, strict: bool = True) -> Scene:
    """The scene of a dict, in Mitsuba 3's convention: ``{"type": "scene", "lamp": {"type": "point", …}}``.

    Keys are ids, and within objects names of parameters. ``{"type": "ref", "id": "white"}`` refers to an
    object. Values are numbers, text, ``(r, g, b)`` or ``(x, y, z)``, ``{"type": "rgb", "value": …}``,
    ``{"type": "spectrum", "value": …}``, transforms (`Transform` or 4 x 4 numbers), arrays and `Mesh`.
    A scene without a camera can be measured, but has no picture. Raises Error with all problems, each with its
    place: ``floor.bsdf.reflectance``."""
    return Scene._of(_native.scene_from_objects(objects_of_scene(scene), [], [], strict))._build()
