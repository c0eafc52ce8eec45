"""Irradiance at points and radiance along rays."""

from __future__ import annotations

import array
from collections.abc import Sequence
from typing import Any, Dict, Optional, Tuple, Union, cast, overload

from . import _native
from ._arrays import Buffer, numbers_of
from ._errors import Error
from ._picture import Estimate, Interval, Picture
from ._progress import ProgressWish
from ._scene import Scene
from ._session import render


class Estimates(Sequence):
    """What was measured, one `Estimate` for each point or ray, in their order."""

    __slots__ = ("_all", "_rgb", "_picture")
    _all: Tuple[Estimate, ...]
    _rgb: Tuple[Tuple[float, float, float], ...]
    _picture: Picture

    def __init__(self, *_: Any):
        raise TypeError("estimates come from kaustik.irradiance and kaustik.radiance")

    @classmethod
    def _of(cls, picture: Picture, count: int) -> "Estimates":
        estimates = object.__new__(cls)
        places = [divmod(number, picture.width) for number in range(count)]
        estimates._all = tuple(picture.pixel(x, y) for y, x in places)
        flat = memoryview(cast(Any, picture.array)).cast("B").cast("f")
        estimates._rgb = tuple(tuple(flat[3 * number:3 * number + 3]) for number in range(count))  # type: ignore[misc]
        estimates._picture = picture
        return estimates

    @overload
    def __getitem__(self, index: int) -> Estimate: ...

    @overload
    def __getitem__(self, index: slice) -> Tuple[Estimate, ...]: ...

    def __getitem__(self, index):
        return self._all[index]

    def __len__(self) -> int:
        return len(self._all)

    @property
    def values(self) -> "array.array[float]":
        """Luminances, as the photopic value of RGB; 179 times as many are lux, or cd/m²."""
        return array.array("d", (one.value for one in self._all))

    @property
    def standard_errors(self) -> "array.array[float]":
        """Of noise and bias together; infinite where they are not known."""
        return array.array("d", (one.standard_error for one in self._all))

    def interval(self, level: float = 0.95) -> Interval:
        """Of each by itself: two arrays, between which the truth lies with this chance."""
        each = [one.interval(level) for one in self._all]
        return Interval(array.array("d", (one.low for one in each)), array.array("d", (one.high for one in each)))

    @property
    def rgb(self) -> Tuple[Tuple[float, float, float], ...]:
        """The same in linear Rec. 709."""
        return self._rgb

    @property
    def unit(self) -> str:
        return self._picture.unit

    @property
    def picture(self) -> Picture:
        """The picture that holds them, one in each pixel, row by row: with layers, a film and a report."""
        return self._picture

    def __repr__(self) -> str:
        shown = [f"  {one!r}" for one in self._all[:20]]
        if len(self) > len(shown):
            shown.append(f"  … and {len(self) - len(shown)} more")
        return "\n".join([f"<kaustik.Estimates: {len(self)}", *shown]) + ">"

    def __reduce__(self):
        return Estimates._of, (self._picture, len(self))


def irradiance(scene: Scene, points: Any, normals: Any, *, integrator: Union[str, Dict[str, Any]] = "auto",
               passes: Optional[int] = None, spp: Optional[int] = None, time: Optional[float] = None,
               error: Optional[float] = None, seed: int = 0, threads: int = 0,
               progress: ProgressWish = None) -> Estimates:
    """The irradiance, W/m², at points in the air and on surfaces, each on the side of its normal.

    `points` is (n, 3); `normals` too, of any length, or one for all. All lamps count, and caustics. Nothing
    is changed in the scene: the points are as if they were not there. One that lies on a surface, to a
    hundred thousandth of the scene's size, measures what arrives there.

    `integrator` is "auto", "vcm", "bdpt", "ppm", "path", "photonmap", or a dict of one. Without `passes`, `spp`, `time`
    and `error`, as for `render`, each point gets 1024 samples. Raises Error with the name of what is wrong."""
    at = numbers_of(points, "points", (None, 3))
    return _measured(scene, "irradiancepoints", {"points": at, "normals": _one_for_each("normals", normals, at)},
                     integrator, passes, spp, time, error, seed, threads, progress)


def radiance(scene: Scene, origins: Any, directions: Any, *, integrator: Union[str, Dict[str, Any]] = "auto",
             passes: Optional[int] = None, spp: Optional[int] = None, time: Optional[float] = None,
             error: Optional[float] = None, seed: int = 0, threads: int = 0,
             progress: ProgressWish = None) -> Estimates:
    """The radiance, W/(sr·m²), that arrives along rays: at `origins` from where `directions` look.

    `origins` is (n, 3), or one for all; `directions` is (n, 3), of any length. Integrators and the other
    arguments are those of `irradiance`."""
    along = numbers_of(directions, "directions", (None, 3))
    return _measured(scene, "radiancerays", {"origins": _one_for_each("origins", origins, along), "directions": along},
                     integrator, passes, spp, time, error, seed, threads, progress)


def _one_for_each(name: str, values: Any, others: Buffer) -> Buffer:
    """As many rows as the others have; a single one is that of all."""
    count = others.shape[0]
    try:
        one = numbers_of(values, name, (3,))
    except Error:
        return numbers_of(values, name, (None, 3))
    return numbers_of([[one.at(axis) for axis in range(3)]] * count, name, (None, 3)) if count else one


def _measured(scene: Scene, sensor: str, lists: Dict[str, Buffer], integrator: Any, passes: Optional[int],
              spp: Optional[int], time: Optional[float], error: Optional[float], seed: int, threads: int,
              progress: ProgressWish) -> Estimates:
    if not isinstance(scene, Scene):
        raise Error(f"scene: {type(scene).__name__} is no scene",
                    "make one by kaustik.load_file, load_string or load_dict")
    sizes = {name: values.shape[0] for name, values in lists.items()}
    (first, count), (second, other) = sizes.items()
    if 0 in sizes.values():
        raise Error(f"{first if count == 0 else second}: the list is empty", "give one row at least")
    if count != other:
        raise Error(f"{second}: it has {other} rows, and {first} has {count}", "give one row for each")
    samples_per_pass = None
    if passes is None and spp is None and time is None and error is None:
        passes = _native.measuring_passes
    if spp is None:
        samples_per_pass = _native.measuring_samples_per_pass
    picture = render(_measuring(scene, sensor, lists), integrator=integrator, passes=passes, spp=spp, time=time,
                     error=error, seed=seed, threads=threads, samples_per_pass=samples_per_pass, progress=progress)
    return Estimates._of(picture, count)


def _measuring(scene: Scene, sensor: str, lists: Dict[str, Buffer]) -> Scene:
    """The scene with this sensor for its only camera."""
    return Scene._of(scene._build()._native.with_meter(sensor, list(lists.items())), previous=scene)._build()
