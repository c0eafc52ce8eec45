"""How a picture differs from another one."""

from __future__ import annotations

import os
from typing import Any, NamedTuple, Optional, Tuple, Union

from . import _native, _threads
from ._arrays import Buffer
from ._errors import Error
from ._picture import Picture, read


class Comparison(NamedTuple):
    """What `kaustik compare` prints."""

    mse: float  #: mean over pixels and channels of (x - r)^2
    relative_mse: float  #: mean of (x - r)^2 / (r^2 + 0.01)
    relative_mse_trimmed: float  #: the same without the worst thousandth of the pixels
    mean_ratio: Tuple[float, float, float]  #: mean of the picture by that of the reference, of each channel
    reference_noise: Optional[float]  #: what the reference's own noise adds to the trimmed one; None: not known
    pixel_count: int
    non_finite_pixels: int  #: that are left out


Shown = Union[Picture, str, os.PathLike]


def _image(given: Any, name: str) -> Any:
    if isinstance(given, (str, os.PathLike)):
        given = read(given)
    if not isinstance(given, Picture):
        raise Error(f"{name}: {type(given).__name__} is no picture", "give a kaustik.Picture, or the path of one")
    return given._image


def compare(picture: Shown, reference: Shown, *, layer: str = "") -> Comparison:
    """How a picture differs from what it should be; both are pictures or paths. Raises Error where their sizes
    differ."""
    _threads.begin()
    return Comparison(**_native.compared(_image(picture, "picture"), _image(reference, "reference"), layer))


def difference(picture: Shown, reference: Shown, *, scale: float = 1, layer: str = "") -> Buffer:
    """Where it differs, in colours: (rows, columns, 3) uint8. White where both agree, red where the picture is
    brighter, blue where it is darker, fully so at the relative difference `scale`."""
    _threads.begin()
    if not 0 < scale < float("inf"):
        raise Error(f"scale: {scale!r} is no such number", "give a number above 0")
    return _native.difference(_image(picture, "picture"), _image(reference, "reference"), scale, layer)
