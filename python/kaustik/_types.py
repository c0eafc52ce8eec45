"""The parameter tables: what `kaustik help` prints, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Dict, Iterator, Optional, Tuple

from . import _native


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
    """The table of one type: its parameters by their names."""

    def __init__(self, facts: dict):
        self.family: str = facts["family"]
        self.name: str = facts["name"]
        self.sentence: str = facts["sentence"]
        self._rows: Dict[str, Parameter] = {row["name"]: _parameter(row) for row in facts["parameters"]}

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

    def _ipython_key_completions_(self) -> list:
        return list(self._families)

    def find(self, family: str, name: str) -> Optional[Type]:
        """None: there is no such type."""
        return self._families.get(family, {}).get(name)

    def __repr__(self) -> str:
        return "\n".join(f"{family}: {', '.join(types)}" for family, types in self._families.items())


def _parameter(row: dict) -> Parameter:
    from ._values import python_value

    default = row["default"]
    return Parameter(row["name"], row["kind"], None if default is None else python_value(default),
                     row["required"], row["minimum"], row["maximum"], row["unit"], row["sentence"],
                     tuple(row["choices"]), row["accepts_texture"], row["accepts_volume"],
                     row["instead_of"], tuple(row["extents"]), row["of_integers"], row["no_effect"])


types = Types()
