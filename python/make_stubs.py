"""Writes the stubs of kaustik.types from the parameter tables, so that editors complete types and their
parameters, with their sentences. The build runs it: make_stubs.py FOLDER_OF_THE_PACKAGE"""

import keyword
import pathlib
import sys
import textwrap

HEAD = '''\
# Made of the parameter tables by python/make_stubs.py, with every build.
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Dict, List, Literal, Optional, Sequence, Tuple, Union

from ._mesh import Mesh
from ._transform import Transform

Nested = Union[Dict[str, Any], Mesh]
Color = Union[float, Sequence[float], Sequence[Tuple[float, float]], Dict[str, Any]]
Path = Union[str, os.PathLike[str]]

@dataclass(frozen=True)
class Parameter:
    name: str
    kind: str
    default: Any
    required: bool
    minimum: Optional[float]
    maximum: Optional[float]
    unit: str
    sentence: str
    choices: Tuple[str, ...]
    accepts_texture: bool
    accepts_volume: bool
    instead_of: str
    shape: Tuple[int, ...]
    of_integers: bool
    no_effect: bool

class Type(Mapping[str, Parameter]):
    family: str
    name: str
    sentence: str
    def __getitem__(self, name: str) -> Parameter: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...

class Family(Mapping[str, Type]):
    name: str
    def __getitem__(self, name: str) -> Type: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...

'''


def annotation(row) -> str:
    choices = "Literal[" + ", ".join(repr(choice) for choice in row.choices) + "]" if row.choices else "str"
    plain = {"boolean": "bool", "integer": "int", "number": "float", "text": "Union[str, Sequence[float]]",
             "choice": choices, "number or name": f"Union[float, {choices}]", "point": "Sequence[float]",
             "color": "Color", "transform": "Union[Transform, Any]", "file": "Path", "array": "Any"}[row.kind]
    takes_nested = (row.accepts_texture or row.accepts_volume) and row.kind != "color"
    return f"Union[{plain}, Dict[str, Any]]" if takes_nested else plain


def is_name(text: str) -> bool:
    return text.isidentifier() and not keyword.iskeyword(text)


def documentation(table) -> str:
    rows = [str(row) for row in table.values() if not row.no_effect]
    lines = [table.sentence, *([""] if rows else []), *rows]
    text = "\n".join("\n".join(textwrap.wrap(line, 100, subsequent_indent="    ")) for line in lines)
    return textwrap.indent('"""' + text.replace("\\", "\\\\").replace('"""', "'''") + '\n"""', " " * 8)


def stub_of_type(class_name: str, table) -> str:
    arguments = [f"{row.name}: {annotation(row)} = ..." for row in table.values()
                 if is_name(row.name) and not row.no_effect]
    listed = ",\n                 ".join(["*, id: str = ...", *arguments, "**nested: Nested"])
    return (f"class {class_name}(Type):\n    def __call__(self, {listed}) -> Dict[str, Any]:\n"
            f"{documentation(table)}\n        ...\n\n")


def stubs(types) -> str:
    parts, families = [HEAD], []
    for family, members in types.items():
        named = {name: f"_{family}_{name}" for name in members if is_name(name)}
        parts += [stub_of_type(class_name, members[name]) for name, class_name in named.items()]
        parts.append(f"class _{family}(Family):\n" + "".join(f"    {name}: {class_name}\n"
                                                               for name, class_name in named.items()) + "\n")
        families.append(family)
    parts.append("class Types(Mapping[str, Family]):\n"
                 + "".join(f"    {family}: _{family}\n" for family in families if is_name(family))
                 + "    def __getitem__(self, family: str) -> Family: ...\n"
                   "    def __iter__(self) -> Iterator[str]: ...\n"
                   "    def __len__(self) -> int: ...\n"
                   "    def find(self, family: str, name: str) -> Optional[Type]: ...\n\n"
                   "types: Types\n")
    return "".join(parts)


def main() -> None:
    package = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(package.parent))
    import kaustik

    (package / "_types.pyi").write_text(stubs(kaustik.types), encoding="utf-8")


if __name__ == "__main__":
    main()
