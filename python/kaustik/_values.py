"""Values of properties: what users write, and what the compiled part takes."""

from __future__ import annotations

import math
import numbers
import os
from typing import Any, Optional

from . import _native
from ._arrays import Buffer, buffer_of
from ._errors import Error
from ._transform import Transform


def python_value(value: Any) -> Any:
    """What users see: numbers, text, tuples for points and colours, pairs for spectra."""
    if isinstance(value, _native.Transform):
        return Transform(value)
    if not isinstance(value, tuple):
        return value
    kind, rest = value[0], value[1:]
    if kind == "spectrum":
        return tuple((nm, number) for nm, number in rest[0])
    return rest[0] if kind == "untyped" else tuple(rest)


def is_number(value: Any) -> bool:
    return isinstance(value, numbers.Real) and not is_boolean(value)


def is_boolean(value: Any) -> bool:
    return isinstance(value, bool) or type(value).__name__ in ("bool_", "bool") and hasattr(value, "dtype")


def _numbers(value: Any, place: str) -> Optional[list]:
    """Of a sequence of numbers; None: it is none."""
    if isinstance(value, (str, bytes, dict)):
        return None
    try:
        items = list(value)
    except TypeError:
        return None
    return [_float(item) for item in items] if all(is_number(item) for item in items) else None


def _float(value: Any) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _cut(value: Any) -> str:
    text = repr(value) if not isinstance(value, numbers.Integral) or abs(int(value)) < 2 ** 200 else "a huge integer"
    return text if len(text) <= 80 else text[:77] + "…"


def checked_text(value: Any, place: str) -> str:
    """Of text or a path; Error for what no file has."""
    text = os.fspath(value)
    if isinstance(text, bytes):
        text = os.fsdecode(text)
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        raise Error(f"{ascii(text)[:80]} is no text that can be written as UTF-8", "give other text", place) from None
    if "\0" in text:
        raise Error(f"{ascii(text)[:80]} holds a zero byte", "give other text", place)
    return text


def _pairs(value: Any) -> Optional[list]:
    try:
        pairs = [(float(nm), float(number)) for nm, number in value]
    except (TypeError, ValueError, OverflowError):
        return None
    return pairs


def _curve(pairs: list, place: str) -> tuple:
    for (nm, number), following in zip(pairs, pairs[1:] + [(math.inf, 0.0)]):
        if not (0 < nm < following[0] and math.isfinite(nm) and math.isfinite(number)):
            raise Error(f"the spectrum is wrong at {nm} nm",
                        "give pairs of a wavelength in nm and a finite value, in ascending order", place)
    return ("spectrum", pairs)


def colour_value(value: dict, place: str, *, is_light: bool) -> Any:
    """Of Mitsuba's {"type": "rgb", "value": …} and {"type": "spectrum", "value": …}."""
    unknown = set(value) - {"type", "value"}
    if unknown or "value" not in value:
        raise Error(f"a {value['type']} takes a 'value'" + (f", not '{sorted(map(str, unknown))[0]}'" if unknown else ""),
                    'write {"type": "rgb", "value": (0.5, 0.4, 0.3)} or '
                    '{"type": "spectrum", "value": [(400, 0.1), (700, 0.4)]}', place)
    given = value["value"]
    if is_number(given):
        number = _float(given)
        if not math.isfinite(number):
            raise Error(f"the colour is {number}", "give a finite number", place)
        if value["type"] == "spectrum" and is_light and number > 0:
            # The same at every wavelength, which is not white.
            return ("spectrum", [(_native.first_nm, number), (_native.last_nm, number)])
        return number
    flat = _numbers(given, place)
    if value["type"] == "rgb" and flat and len(flat) == 3:
        return ("rgb", *flat)
    pairs = _pairs(given)
    if value["type"] == "spectrum" and pairs:
        return _curve(pairs, place)
    raise Error(f"{_cut(given)} is no {value['type']}",
                "give three numbers" if value["type"] == "rgb" else "give a number, or pairs of nm and value",
                place)


def native_value(value: Any, kind: Optional[str], place: str) -> Any:
    """As the compiled part takes it; `kind` as the table says, None: no table knows the parameter."""
    try:
        return _native_value(value, kind, place)
    except Error as error:
        raise Error(error.message, problems=[problem._replace(file=place) for problem in error.problems]) from None


def _native_value(value: Any, kind: Optional[str], place: str) -> Any:
    if isinstance(value, (Transform, _native.Transform)):
        return Transform(value)._native
    if isinstance(value, Buffer):
        return value
    if is_boolean(value):
        return bool(value)
    if isinstance(value, numbers.Integral) and kind not in ("number", "number or name", "color"):
        if not -(2 ** 63) <= int(value) < 2 ** 63:
            raise Error(f"{_cut(value)} is too large", "give an integer of 64 bits", place)
        return int(value)
    if is_number(value):
        return _float(value)
    if isinstance(value, (str, os.PathLike)):
        return checked_text(value, place)
    if kind == "transform":
        return Transform(value)._native
    if kind == "array":
        return buffer_of(value, "the array")
    flat = _numbers(value, place)
    if flat is not None:
        if kind == "text":
            return ", ".join(repr(number) for number in flat)
        if len(flat) == 3:
            return ("rgb" if kind == "color" else "point", *flat)
    if kind == "color" and (pairs := _pairs(value)):
        return _curve(pairs, place)
    if kind is None:
        return buffer_of(value, "the array")
    raise Error(f"{type(value).__name__} is no value of kind '{kind}'", _hint(kind), place)


def _hint(kind: str) -> str:
    return {"color": "give a number, (r, g, b), or pairs of a wavelength in nm and a value",
            "point": "give (x, y, z)", "boolean": "give True or False", "text": "give text",
            "number": "give a number", "integer": "give an integer", "file": "give a path"}.get(kind, "")
