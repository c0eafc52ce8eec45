"""Putting together what was computed in parts."""

from __future__ import annotations

import os
from typing import Any, Union

from . import _native, _threads
from ._errors import Error
from ._photons import Photons
from ._picture import Film

Part = Union[Film, Photons, str, os.PathLike]


def _loaded(part: Any) -> Any:
    if isinstance(part, (str, os.PathLike)):
        path = os.fspath(part)
        return Photons.load(path) if str(path).endswith(".kpm") else Film.load(path)
    return part


def merge(*parts: Part) -> Union[Film, Photons]:
    """The whole of the films of different passes, or of all parts of photon maps; also by the paths of `.kpt` and
    `.kpm` files. It has the bits of what is computed at once, whatever the order. Raises Error for parts that do
    not belong together."""
    if not parts:
        raise Error("merge: there are no parts", "give films, or photons")
    _threads.begin()
    loaded = [_loaded(part) for part in parts]
    if all(isinstance(part, Photons) for part in loaded):
        names = next((part.lamp_names for part in loaded if part.lamp_names), ())
        return Photons._of(_native.Photons.merged([part._native for part in loaded]), lamp_names=names)
    if all(isinstance(part, Film) for part in loaded):
        whole = loaded[0]
        for part in loaded[1:]:
            whole = whole + part
        return whole
    kinds = ", ".join(sorted({type(part).__name__ for part in loaded}))
    raise Error(f"merge: parts of different kinds: {kinds}", "give films alone, or photons alone")
