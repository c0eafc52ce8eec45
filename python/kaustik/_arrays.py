"""Arrays from anywhere: whatever has the buffer protocol or `__array_interface__`, and lists."""

from __future__ import annotations

import array
import copyreg
import ctypes
import math
from typing import Any, Optional, Sequence

from . import _native
from ._errors import Error

Buffer = _native.Buffer
_integers = ("uint8", "uint16", "uint32", "int32", "int64")


def _unpickled(dtype: str, shape: list, content: bytes) -> Buffer:
    return Buffer.from_bytes(dtype, shape, content)


copyreg.pickle(Buffer, lambda buffer: (_unpickled, (buffer.dtype, list(buffer.shape), buffer.tobytes())))


_codes = {"f4": "f", "f8": "d", "u1": "B", "u2": "H", "u4": "I", "i4": "i", "i8": "q"}


def _by_interface(interface: dict, name: str) -> Buffer:
    """Of memory that an `__array_interface__` shows; its owner lives until this returns."""
    kind = interface["typestr"]
    code = _codes.get(kind[1:])
    if kind[0] == ">" or code is None or interface.get("strides") is not None:
        raise Error(f"{name}: elements of type '{kind}', or rows with gaps",
                    "give it as contiguous float32, float64 or int64")
    shape = list(interface["shape"])
    size = int(kind[2:]) * math.prod(shape)
    if size == 0:
        return Buffer.from_bytes("float64", shape, b"")
    memory = (ctypes.c_char * size).from_address(interface["data"][0])
    return Buffer(memoryview(memory).cast("B").cast(code, shape=shape))


def _from_lists(values: Sequence, name: str) -> Buffer:
    """Of numbers, or lists of lists of them."""
    shape = []
    level: Any = values
    while isinstance(level, (list, tuple)):
        shape.append(len(level))
        if not level:
            break
        level = level[0]
    flat: list = []

    def collect(part: Any, depth: int) -> None:
        if depth == len(shape):
            flat.append(part)
            return
        if not isinstance(part, (list, tuple)) or len(part) != shape[depth]:
            raise Error(f"{name}: its rows are not of one length", "give rows of the same length")
        for item in part:
            collect(item, depth + 1)

    collect(values, 0)
    try:
        code = "q" if flat and all(isinstance(number, int) for number in flat) else "d"
        numbers = array.array(code, flat)
    except (TypeError, OverflowError):
        raise Error(f"{name}: it holds what is no number", "give numbers alone") from None
    if 0 in shape:
        return Buffer.from_bytes("float64", shape, b"")
    return Buffer(memoryview(numbers).cast("B").cast(code, shape=shape))


def buffer_of(values: Any, name: str) -> Buffer:
    """A copy without gaps, whatever the strides are; `name` is for messages."""
    if isinstance(values, Buffer):
        return values
    if isinstance(values, (list, tuple)):
        return _from_lists(values, name)
    try:
        view = memoryview(values)
    except TypeError:
        interface = getattr(values, "__array_interface__", None)
        if interface is not None:
            return _by_interface(interface, name)
        raise Error(f"{name}: {type(values).__name__} is no array",
                    "give an array (NumPy's, array.array, anything with the buffer protocol), "
                    "or lists of numbers") from None
    if view.format in ("Q", "L") and view.itemsize == 8:
        values = _as_int64(view, name)
    elif view.format in ("h", "b", "e", "?", "g", "Zd", "Zf", "O"):
        raise Error(f"{name}: elements of type {_type_name(view.format)}",
                    "convert it, as by .astype(numpy.float32) or .astype(numpy.int64)")
    try:
        return Buffer(values)
    except ValueError as error:
        raise Error(f"{name}: {error}",
                    "convert it, as by .astype(numpy.float32) or .astype(numpy.int64)") from None


def _type_name(code: str) -> str:
    return {"h": "int16", "b": "int8", "e": "float16", "?": "bool", "g": "long double", "Zd": "complex128",
            "Zf": "complex64", "O": "object"}.get(code, code)


def _as_int64(view: memoryview, name: str) -> memoryview:
    flat = array.array("Q", memoryview(view.tobytes()).cast("Q"))
    if flat and max(flat) >= 1 << 63:
        raise Error(f"{name}: it holds {max(flat)}, which is too large", "give indices from 0 on")
    numbers = memoryview(flat).cast("B").cast("q")
    return numbers.cast("B").cast("q", shape=list(view.shape or ())) if view.ndim > 1 else numbers


def numbers_of(values: Any, name: str, shape: Sequence[Optional[int]], *, integers: bool = False) -> Buffer:
    """The same, checked: of this shape (None: any number), finite, and of integers if those are wanted."""
    buffer = buffer_of(values, name)
    wanted = "(" + ", ".join("n" if extent is None else str(extent) for extent in shape) + ")"
    if len(buffer.shape) != len(shape) or any(w is not None and w != g for w, g in zip(shape, buffer.shape)):
        raise Error(f"{name}: its shape is {tuple(buffer.shape)}", f"give one of shape {wanted}")
    if integers and buffer.dtype not in _integers:
        raise Error(f"{name}: its elements are {buffer.dtype}, not integers",
                    "convert it, as by .astype(numpy.int64)")
    bad = buffer.find_not_finite()
    if bad >= 0:
        row = bad // (shape[-1] or 1) if len(shape) > 1 else bad
        raise Error(f"{name}: row {row} holds {buffer.at(bad)}", "give finite numbers")
    return buffer
