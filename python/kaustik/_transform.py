"""Transforms, in Mitsuba's convention: p' = M p, column vectors."""

from __future__ import annotations

import math
from typing import Any, Sequence, Union

from . import _native
from ._arrays import Buffer, buffer_of
from ._errors import Error


def _three(values: Any, name: str) -> tuple:
    try:
        numbers = tuple(float(value) for value in values)
    except (TypeError, ValueError):
        numbers = ()
    if len(numbers) != 3 or not all(math.isfinite(number) for number in numbers):
        raise Error(f"{name}: {values!r} is not three finite numbers", f"give {name}=(x, y, z)")
    return numbers


def _made(make: Any, *arguments: Any) -> Any:
    try:
        return make(*arguments)
    except ValueError as error:
        raise Error(str(error), "give a transform that can be undone") from None


class Transform:
    """A map of space; each method returns a new one, which does what it says first, then what was before.

    So ``Transform().translate((0, 0, 1)).rotate((0, 1, 0), 30)`` rotates, then translates, as Mitsuba's
    transforms do. `a @ b` is the same: first b, then a. `matrix` may be 4 x 4 numbers, an array, or
    another transform.
    """

    __slots__ = ("_native",)

    def __init__(self, matrix: Any = None):
        if matrix is None:
            self._native = _native.Transform()
        elif isinstance(matrix, Transform):
            self._native = matrix._native
        elif isinstance(matrix, _native.Transform):
            self._native = matrix
        else:
            self._native = _from_matrix(getattr(matrix, "matrix", matrix))

    def translate(self, value: Sequence[float]) -> "Transform":
        return self @ Transform(_native.Transform.translate(_three(value, "value")))

    def scale(self, value: Union[float, Sequence[float]]) -> "Transform":
        factors = (value, value, value) if isinstance(value, (int, float)) else value
        return self @ Transform(_made(_native.Transform.scale, _three(factors, "value")))

    def rotate(self, axis: Sequence[float], angle: float) -> "Transform":
        """Right-handed about `axis`, by `angle` degrees."""
        return self @ Transform(_made(_native.Transform.rotate, _three(axis, "axis"), float(angle)))

    def look_at(self, origin: Sequence[float], target: Sequence[float], up: Sequence[float]) -> "Transform":
        """From a camera's own space: at `origin`, looking along its +z toward `target`."""
        return self @ Transform(_made(_native.Transform.look_at, _three(origin, "origin"),
                                      _three(target, "target"), _three(up, "up")))

    def inverse(self) -> "Transform":
        return Transform(self._native.inverse())

    @property
    def matrix(self) -> Buffer:
        """4 x 4 numbers."""
        return Buffer(_rows_view(self._native.rows))

    @property
    def __array_interface__(self) -> dict:
        # The memory has to live as long as what is made of it.
        held = self.matrix
        interface = dict(held.__array_interface__)
        interface["data"] = held
        interface["offset"] = 0
        return interface

    def __matmul__(self, other: "Transform") -> "Transform":
        if not isinstance(other, Transform):
            return NotImplemented
        return Transform(self._native @ other._native)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Transform) and self._native == other._native

    def __hash__(self) -> int:
        return hash(self._native.rows)

    def __reduce__(self):
        return Transform, (self._native,)

    def __repr__(self) -> str:
        rows = self._native.rows
        lines = [", ".join(f"{number:.6g}" for number in rows[4 * i:4 * i + 4]) for i in range(4)]
        return "Transform([[" + "],\n           [".join(lines) + "]])"


def _rows_view(rows: Sequence[float]) -> memoryview:
    import array

    return memoryview(array.array("d", rows)).cast("B").cast("d", shape=(4, 4))


def _from_matrix(matrix: Any) -> Any:
    buffer = buffer_of(matrix if not hasattr(matrix, "numpy") else matrix.numpy(), "matrix")
    if tuple(buffer.shape) != (4, 4):
        raise Error(f"matrix: its shape is {tuple(buffer.shape)}", "give one of shape (4, 4)")
    return _made(_native.Transform, [buffer.at(i) for i in range(16)])
