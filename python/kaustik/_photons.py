"""Photon maps as arrays."""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Tuple, Union

from . import _native, _threads
from ._arrays import Buffer
from ._errors import Error
from ._scene import Scene
from ._session import _Goals, _slice

_kinds = ("caustic", "global")


class LightCounts(NamedTuple):
    """What became of the light paths that were begun for a map."""

    emitted: int
    stored: int  #: photons
    nothing: int  #: began without power
    escaped: int  #: left the scene
    absorbed: int
    too_long: int
    stopped: int  #: came to a surface that does not send them on
    stored_flux: float  #: W of all photons


class PhotonMap:
    """The photons of one map, as arrays of one row each."""

    __slots__ = ("_native", "_kind", "_arrays")

    def __init__(self, native: Any, kind: str):
        self._native, self._kind = native, kind
        self._arrays: Dict[str, Buffer] = {}

    def _array(self, name: str) -> Buffer:
        if name not in self._arrays:
            self._arrays[name] = getattr(self._native, name)(self._kind)
        return self._arrays[name]

    @property
    def positions(self) -> Buffer:
        """(n, 3) float32, m: where they arrived at a surface."""
        return self._array("positions")

    @property
    def directions(self) -> Buffer:
        """(n, 3) float32, of length 1: the way that the light went when it arrived. Within 1e-4."""
        return self._array("directions")

    @property
    def normals(self) -> Buffer:
        """(n, 3) float32, of length 1: of the surface, on the side where they arrived. Within 0.01."""
        return self._array("normals")

    @property
    def powers(self) -> Buffer:
        """(n, 3) float32, W: of red, green and blue, before the surface takes anything."""
        return self._array("powers")

    @property
    def paths(self) -> Buffer:
        """(n,) uint32: numbers of their light paths. Photons of one path belong together."""
        return self._array("paths")

    @property
    def lamps(self) -> Buffer:
        """(n,) uint32: numbers of the lamps that they come from, whose names are `Photons.lamp_names`. Raises Error
        for a part of the photons: `merge` the parts before."""
        if not self._native.is_whole:
            raise Error("a part of the photons does not know their lamps", "put all parts together by kaustik.merge")
        return self._array("lamps")

    @property
    def counts(self) -> LightCounts:
        return LightCounts(**self._native.light_counts(self._kind))

    def __len__(self) -> int:
        return self._native.count(self._kind)

    def __repr__(self) -> str:
        return f"<kaustik.PhotonMap '{self._kind}': {len(self)} photons>"


class Photons(Mapping):
    """The maps of a light pass: ``photons["caustic"]`` is light that came by mirrors and glass alone,
    ``photons["global"]`` light that a diffuse surface or a medium has scattered before. What comes straight from
    a lamp is in neither. A `.kpm` file is the same."""

    __slots__ = ("_native", "_warnings", "_lamp_names", "_maps")
    _native: Any
    _warnings: Tuple[str, ...]
    _lamp_names: Tuple[str, ...]
    _maps: Dict[str, PhotonMap]

    def __init__(self, *_: Any):
        raise TypeError("photons come from kaustik.trace_photons, or from kaustik.Photons.load")

    @classmethod
    def _of(cls, native: Any, warnings: Tuple[str, ...] = (), lamp_names: Tuple[str, ...] = ()) -> "Photons":
        photons = object.__new__(cls)
        photons._native, photons._warnings, photons._lamp_names = native, warnings, lamp_names
        photons._maps = {kind: PhotonMap(native, kind) for kind in _kinds}
        return photons

    @classmethod
    def load(cls, path: Union[str, os.PathLike]) -> "Photons":
        """Of a `.kpm` file, of `kaustik photons` as well."""
        return cls._of(_native.Photons.read(os.fspath(path)))

    def save(self, path: Union[str, os.PathLike]) -> None:
        """To a `.kpm` file: the integrator `photonmap` renders with it by its parameter `photon_map`."""
        self._native.write(os.fspath(path))

    def __getitem__(self, kind: str) -> PhotonMap:
        return self._maps[kind]

    def __iter__(self) -> Iterator[str]:
        return iter(self._maps)

    def __len__(self) -> int:
        return len(self._maps)

    @property
    def is_whole(self) -> bool:
        """Not a part: see `merge`."""
        return self._native.is_whole

    @property
    def seed(self) -> int:
        return self._native.seed

    @property
    def lamp_names(self) -> Tuple[str, ...]:
        """Of each lamp its id, or that of its shape, or "lamp 3". Empty where photons come from files, which do not
        keep them."""
        return self._lamp_names

    @property
    def warnings(self) -> Tuple[str, ...]:
        """Why a map is empty, and what else is odd."""
        return self._warnings

    def __repr__(self) -> str:
        part = "" if self.is_whole else ", a part"
        return f"<kaustik.Photons: {', '.join(f'{len(self[kind])} {kind}' for kind in self)}{part}>"


def trace_photons(scene: Scene, *, integrator: Optional[Dict[str, Any]] = None, seed: int = 0, threads: int = 0,
                  part: Tuple[int, int] = (1, 1)) -> Photons:
    """The photon maps of a scene, with the bits of `kaustik photons`. `integrator` says how many photons, as
    ``{"type": "photonmap", "caustic_photons": 100000}``; without it the scene's own integrator does, if it is of
    this type. `part` (2, 4) is the second of four parts, which `merge` puts together. Raises Error; Ctrl-C
    ends it."""
    if not isinstance(scene, Scene):
        raise Error(f"scene: {type(scene).__name__} is no scene", "make one by kaustik.load_file, load_string or load_dict")
    if integrator is not None and (not isinstance(integrator, dict) or integrator.get("type") != "photonmap"):
        raise Error(f"integrator: {integrator!r} traces no photon maps",
                    'give {"type": "photonmap", "caustic_photons": 100000}')
    wishes = _Goals(seed=seed, threads=threads).wishes
    index, count = _checked_part(part)
    source = scene.source
    if integrator is not None:
        scene = scene._with_integrator(integrator)
    _threads.begin()
    scene._build()
    tracing = _native.PhotonTracing(scene._native, wishes["seed"], wishes["threads"], index - 1, count, source)
    photons, warnings, lamp_names = _run(tracing)
    return Photons._of(photons, tuple(warnings), tuple(lamp_names))


def _checked_part(part: Any) -> Tuple[int, int]:
    try:
        index, count = (int(number) for number in part if int(number) == number)
    except (TypeError, ValueError):
        index, count = 0, 0
    if not 1 <= index <= count <= _native.most_photon_parts:
        raise Error(f"part: {part!r} is no part", "give (2, 4) for the second of four parts")
    return index, count


def _run(tracing: Any) -> tuple:
    """In a thread of its own, so that this one sees Ctrl-C."""
    results: List[tuple] = []
    failures: List[BaseException] = []
    done = threading.Event()  # join() that is interrupted takes the thread for ended

    def work() -> None:
        try:
            results.append(tracing.run())
        except BaseException as error:  # for the thread that waits
            failures.append(error)
        done.set()

    threading.Thread(target=work, name="kaustik photons", daemon=True).start()
    try:
        while not done.wait(_slice):
            pass
    except BaseException:
        tracing.cancel()
        done.wait()
        raise
    if failures:
        raise failures[0]
    return results[0]
