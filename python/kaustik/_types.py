"""The parameter tables: what `kaustik help` prints, as data."""

from __future__ import annotations

import inspect
import keyword
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Dict, Iterator, Optional, Tuple

from . import _native
from ._errors import Error
from ._mesh import Mesh
from ._values import python_value


@dataclass(frozen=True)
class Parameter:
    """One row of a type's table."""

    name: str
    kind: str  #: "number", "integer", "boolean", "text", "choice", "color", "point", "transform", "file", "array", …
    default: Any  #: None: there is none
    required: bool
    minimum: Optional[float]
    maximum: Optional[float]
    unit: str
    sentence: str
    choices: Tuple[str, ...]
    accepts_texture: bool
    accepts_volume: bool
    instead_of: str  #: the parameter that this one stands instead of
    shape: Tuple[int, ...]  #: of arrays, 0 for any number
    of_integers: bool
    no_effect: bool  #: accepted because Mitsuba has it

    def __str__(self) -> str:
        facts = [self.kind]
        if self.required:
            facts.append("required")
        elif self.default is not None:
            facts.append(f"default {self.default}")
        if self.minimum is not None or self.maximum is not None:
            facts.append(f"from {self.minimum} to {self.maximum}")
        if self.unit:
            facts.append(self.unit)
        return f"{self.name} ({', '.join(facts)}): {self.sentence}"


class Type(Mapping):
    """The table of one type: its parameters by their names. Called it makes a dict of a scene:
    ``kaustik.types.bsdf.dielectric(int_ior=1.5)``."""

    def __init__(self, facts: dict):
        self.family: str = facts["family"]
        self.name: str = facts["name"]
        self.sentence: str = facts["sentence"]
        self._rows: Dict[str, Parameter] = {row["name"]: _parameter(row) for row in facts["parameters"]}
        self.__doc__ = repr(self)
        self.__signature__ = _signature(self._rows.values())

    def __call__(self, *, id: Optional[str] = None, **values: Any) -> Dict[str, Any]:
        """An object for `load_dict`; objects within it have any name: ``bsdf={…}``. Raises Error for a
        parameter that there is not."""
        for name, value in values.items():
            if name not in self._rows and not isinstance(value, (dict, Mesh)):
                raise Error(f"{self.family} '{self.name}' has no parameter '{name}'",
                            _native.suggest(name, list(self._rows)))
        return {"type": self.name, **({} if id is None else {"id": id}), **values}

    def __getitem__(self, name: str) -> Parameter:
        return self._rows[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def _ipython_key_completions_(self) -> list:
        return list(self._rows)

    def __repr__(self) -> str:
        rows = "".join(f"\n  {row}" for row in self._rows.values() if not row.no_effect)
        return f"{self.family} '{self.name}': {self.sentence}{rows}"


class Family(Mapping):
    """The types of one family, by their names."""

    def __init__(self, name: str):
        self.name = name
        self._types: Dict[str, Type] = {}

    def __getitem__(self, name: str) -> Type:
        return self._types[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._types)

    def __len__(self) -> int:
        return len(self._types)

    def __getattr__(self, name: str) -> Type:
        return _attribute(self.__dict__.get("_types", {}), name, "kaustik.types." + self.__dict__.get("name", ""))

    def __dir__(self) -> list:
        return [*super().__dir__(), *self._types]

    def _ipython_key_completions_(self) -> list:
        return list(self._types)

    def __repr__(self) -> str:
        return f"{self.name}:" + "".join(f"\n  {t.name}: {t.sentence}" for t in self._types.values())


class Types(Mapping):
    """All types by family and name: ``kaustik.types["bsdf"]["dielectric"]["int_ior"]``."""

    def __init__(self) -> None:
        self._families: Dict[str, Family] = {}
        for facts in _native.types():
            family = self._families.setdefault(facts["family"], Family(facts["family"]))
            family._types.setdefault(facts["name"], Type(facts))

    def __getitem__(self, family: str) -> Family:
        return self._families[family]

    def __iter__(self) -> Iterator[str]:
        return iter(self._families)

    def __len__(self) -> int:
        return len(self._families)

    def __getattr__(self, name: str) -> Family:
        return _attribute(self.__dict__.get("_families", {}), name, "kaustik.types")

    def __dir__(self) -> list:
        return [*super().__dir__(), *self._families]

    def _ipython_key_completions_(self) -> list:
        return list(self._families)

    def find(self, family: str, name: str) -> Optional[Type]:
        """None: there is no such type."""
        return self._families.get(family, {}).get(name)

    def __repr__(self) -> str:
        return "\n".join(f"{family}: {', '.join(types)}" for family, types in self._families.items())


def _attribute(known: dict, name: str, where: str) -> Any:
    if name in known:
        return known[name]
    if name.startswith("_"):
        raise AttributeError(name)
    raise AttributeError(f"{where} has no '{name}': " + _native.suggest(name, list(known)))


def _signature(rows: Any) -> inspect.Signature:
    """For help() and editors."""
    named = [inspect.Parameter(row.name, inspect.Parameter.KEYWORD_ONLY, default=row.default) for row in rows
             if row.name.isidentifier() and not keyword.iskeyword(row.name) and not row.no_effect]
    return inspect.Signature([*named, inspect.Parameter("nested", inspect.Parameter.VAR_KEYWORD)])


def _parameter(row: dict) -> Parameter:
    default = row["default"]
    return Parameter(row["name"], row["kind"], None if default is None else python_value(default),
                     row["required"], row["minimum"], row["maximum"], row["unit"], row["sentence"],
                     tuple(row["choices"]), row["accepts_texture"], row["accepts_volume"],
                     row["instead_of"], tuple(row["extents"]), row["of_integers"], row["no_effect"])


types = Types()
