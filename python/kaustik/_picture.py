"""Pictures, films and estimates."""

from __future__ import annotations

import math
import os
from typing import Any, Dict, List, NamedTuple, Optional, Tuple, Union

from . import _native, _threads
from ._arrays import Buffer
from ._errors import Error, Problem

_units = {False: "W/(sr·m²)", True: "W/m²"}


class Interval(NamedTuple):
    low: Any
    high: Any


class Estimate:
    """A luminance, as the photopic value of RGB radiances, and how well it is known."""

    __slots__ = ("value", "noise", "bias", "freedom", "unit", "bias_noise")
    value: float
    noise: float  #: standard error of the mean; not known where `freedom` is 0
    bias: float  #: that it may have, on one side
    freedom: float  #: degrees of freedom of `noise`; 0: fewer than two replicates
    unit: str
    bias_noise: float  #: standard error of a pixel's `bias`, as far as the pixels around share it; 0 of regions

    def __init__(self, value: float, noise: float, bias: float = 0.0, freedom: float = 0.0,
                 unit: str = _units[False], bias_noise: float = 0.0):
        self.value, self.noise, self.bias, self.freedom, self.unit = value, noise, bias, freedom, unit
        self.bias_noise = bias_noise

    @property
    def standard_error(self) -> float:
        """Of noise and bias together; infinite where it is not known."""
        return math.hypot(self.noise, self.bias) if self.freedom > 0 else math.inf

    def interval(self, level: float = 0.95) -> Interval:
        """Holds the truth with this chance, by Student's t, widened by the bias."""
        half = _native.half_width(self.noise, self.bias, self.freedom, self.bias_noise, _level(level))
        return Interval(self.value - half, self.value + half)

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        return f"{_with_error(self.value, self.standard_error)} {self.unit}"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Estimate) and self._all() == other._all()

    def __hash__(self) -> int:
        return hash(self._all())

    def _all(self) -> tuple:
        return self.value, self.noise, self.bias, self.freedom, self.unit, self.bias_noise

    def __reduce__(self):
        return Estimate, self._all()


def _with_error(value: float, error: float) -> str:
    """0.1234(5): the last digits are that uncertain."""
    if not math.isfinite(value) or not math.isfinite(error):
        return f"{value:.4g}(?)"
    if error <= 0:
        return f"{value:.7g}"
    place = math.floor(math.log10(error))
    digits = round(error / 10.0 ** place)
    if digits == 10:
        place, digits = place + 1, 1
    if place >= 0:
        return f"{round(value, -place):.0f}({digits * 10 ** place:.0f})"
    if place < -8 or abs(value) < 1e-4:
        power = math.floor(math.log10(max(abs(value), error)))
        return f"{value / 10.0 ** power:.{max(0, power - place)}f}({digits})e{power}"
    return f"{value:.{-place}f}({digits})"


def _level(level: float) -> float:
    if not 0 < level < 1:
        raise Error(f"level: {level} is no chance", "give a number between 0 and 1, such as 0.95")
    return float(level)


class Film:
    """Finished passes as exact sums: ``film_of_passes_0_to_3 + film_of_passes_4_to_7`` has the bits of a
    film of all eight, whatever machine or process they come from. Pickles; a `.kpt` file is the same."""

    __slots__ = ("_native",)
    _native: Any

    def __init__(self, *_: Any):
        raise TypeError("films come from pictures and sessions, or from kaustik.Film.load")

    @classmethod
    def _of(cls, native: Any) -> "Film":
        film = object.__new__(cls)
        film._native = native
        return film

    @classmethod
    def load(cls, path: Union[str, os.PathLike]) -> "Film":
        """Of a `.kpt` file, of `kaustik render --checkpoint` as well."""
        return cls._of(_native.Film.read(os.fspath(path)))

    def save(self, path: Union[str, os.PathLike]) -> None:
        self._native.write(os.fspath(path))

    def __add__(self, other: "Film") -> "Film":
        if not isinstance(other, Film):
            return NotImplemented
        return Film._of(self._native + other._native)

    def __radd__(self, other: Any) -> "Film":
        # For sum().
        if other == 0:
            return self
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        """The same passes of the same scene, to the bit."""
        return isinstance(other, Film) and self._native.equals(other._native)

    __hash__ = None  # type: ignore[assignment]

    @property
    def passes(self) -> Tuple[int, ...]:
        """Their numbers."""
        return tuple(number for begin, end in self._native.passes for number in range(begin, end))

    @property
    def regions(self) -> Tuple[Tuple[int, int, int, int, int], ...]:
        """Regions with passes of their own: (x, y, width, height, passes) of each."""
        return tuple((x, y, width, height, passes) for x, y, width, height, passes in self._native.regions)

    @property
    def shape(self) -> Tuple[int, int]:
        """Rows and columns."""
        return self._native.height, self._native.width

    @property
    def samples_per_pixel(self) -> int:
        return self._native.samples_per_pixel

    @property
    def seed(self) -> int:
        return self._native.seed

    @property
    def integrator(self) -> str:
        return self._native.integrator

    @property
    def error(self) -> float:
        """Of the picture: the root mean square over pixels of their relative standard errors."""
        _threads.begin()
        return self._native.error()

    def picture(self) -> "Picture":
        _threads.begin()
        return Picture._of(self._native.image(), self)

    def __reduce__(self):
        return Film._of, (self._native,)

    def __repr__(self) -> str:
        ranges = ", ".join(f"{begin}" if end == begin + 1 else f"{begin}–{end - 1}"
                           for begin, end in self._native.passes)
        rows, columns = self.shape
        return (f"<kaustik.Film: {columns} x {rows} pixels, passes {ranges}, "
                f"{self.samples_per_pixel} samples per pixel, {self.integrator}>")


class Picture:
    """A rendered picture. ``numpy.asarray(picture)`` is (rows, columns, 3) float32, linear Rec. 709."""

    __slots__ = ("_image", "_film", "_rgb", "_facts")
    _image: Any
    _film: Optional[Film]
    _rgb: Optional[Buffer]
    _facts: Dict[str, Any]

    def __init__(self, *_: Any):
        raise TypeError("pictures come from kaustik.render, sessions, films, or kaustik.read")

    @classmethod
    def _of(cls, image: Any, film: Optional[Film] = None, facts: Optional[dict] = None) -> "Picture":
        picture = object.__new__(cls)
        picture._image, picture._film, picture._rgb = image, film, None
        picture._facts = facts or {}
        return picture

    @property
    def width(self) -> int:
        return self._image.width

    @property
    def height(self) -> int:
        return self._image.height

    @property
    def shape(self) -> Tuple[int, int, int]:
        return self.height, self.width, 3

    @property
    def array(self) -> Buffer:
        """(rows, columns, 3) float32."""
        if self._rgb is None:
            self._rgb = self._image.rgb("")
        return self._rgb

    @property
    def __array_interface__(self) -> dict:
        return self.array.__array_interface__

    @property
    def channels(self) -> Tuple[str, ...]:
        """As EXR files name them: "R", "caustic.R", "depth.Z", …"""
        return tuple(self._image.channels)

    @property
    def layers(self) -> Tuple[str, ...]:
        """What `picture[layer]` knows: components such as "caustic", and "albedo", "N", "depth", …"""
        return tuple(dict.fromkeys(name.rpartition(".")[0] for name in self.channels if "." in name))

    def __getitem__(self, name: str) -> Buffer:
        """A layer, (rows, columns, 3) or (rows, columns); or a channel by its whole name."""
        if name in self.channels:
            return self._image.channel(name)
        own = [channel for channel in self.channels if channel.rpartition(".")[0] == name and name]
        if not own:
            raise KeyError(f"{name!r}: " + _native.suggest(name, list(self.layers)))
        last = [channel.rpartition(".")[2] for channel in own]
        if last[:3] == ["R", "G", "B"] or last == ["X", "Y", "Z"]:
            return self._image.rgb(name)
        if len(own) > 1:
            raise KeyError(f"{name!r} has the channels {', '.join(own)}: name one of them")
        return self._image.channel(own[0])

    def _ipython_key_completions_(self) -> List[str]:
        return list(self.layers) + list(self.channels)

    @property
    def metadata(self) -> Dict[str, Any]:
        return dict(self._image.metadata)

    @property
    def film(self) -> Film:
        """The passes that it shows. Raises Error for a picture that has none: of a file, of a render that
        still goes on, or that ended within its first pass."""
        if self._film is None:
            raise Error("this picture has no film",
                        "take that of a finished render, with at least one finished pass")
        return self._film

    @property
    def report(self) -> Dict[str, Any]:
        """How the render went: seconds, rays, what ended it, what it decided, warnings."""
        return dict(self._facts)

    @property
    def is_incomplete(self) -> bool:
        """Whether it ended before every pixel had all samples of a pass."""
        return bool(self._facts.get("is_incomplete")) or "incomplete" in self._image.metadata

    @property
    def error(self) -> Optional[Buffer]:
        """Standard errors of the channels, noise and bias together; None: the picture does not tell."""
        return self["error"] if "error" in self.layers else None

    @property
    def bias(self) -> Optional[Buffer]:
        """How much it is expected to be too bright; None: its method has none, or does not tell."""
        return self["bias"] if "bias" in self.layers else None

    @property
    def unit(self) -> str:
        return _units[self.film._native.is_irradiance]

    def interval(self, level: float = 0.95) -> Interval:
        """Of each pixel's luminance: two arrays (rows, columns) between which the truth lies with this
        chance."""
        _threads.begin()
        return Interval(*self.film._native.intervals(_level(level)))

    def pixel(self, x: int, y: int) -> Estimate:
        """The luminance of the pixel in column `x` and row `y`, both from 0 on."""
        if not (0 <= x < self.width and 0 <= y < self.height):
            raise Error(f"there is no pixel ({x}, {y})", f"the picture is {self.width} x {self.height}")
        _threads.begin()
        return self._estimate(self.film._native.pixel(x, y))

    def mean(self, region: Optional[Tuple[int, int, int, int]] = None) -> Estimate:
        """The mean luminance of a region (x, y, width, height), or of all. Its error is its own: pixels
        share photons."""
        x, y, width, height = region if region is not None else (0, 0, self.width, self.height)
        if not (0 <= x and 0 <= y and width > 0 and height > 0 and x + width <= self.width
                and y + height <= self.height):
            raise Error(f"region: {region} does not lie in the picture",
                        f"give (x, y, width, height) within {self.width} x {self.height}")
        _threads.begin()
        return self._estimate(self.film._native.mean(x, y, width, height))

    def _estimate(self, numbers: Tuple[float, float, float, float, float]) -> Estimate:
        value, noise, bias, freedom, bias_noise = numbers
        return Estimate(value, noise, bias, freedom, self.unit, bias_noise)

    def tonemap(self, operator: str = "histogram", *, layer: str = "", **parameters: Any) -> Buffer:
        """As a display shows it: (rows, columns, 3) uint8 in sRGB. `types["tonemap"]` lists operators."""
        _threads.begin()
        return self._image.shown(operator, _tone_settings(parameters), layer)

    def denoise(self) -> "Picture":
        """With its noise smoothed; all other layers stay as they are."""
        _threads.begin()
        return Picture._of(self._image.denoised(), self._film, self._facts)

    def write(self, *paths: Union[str, os.PathLike], tonemap: str = "histogram", layer: str = "",
              half: bool = True, quality: int = 95, **parameters: Any) -> None:
        """To .exr (all layers; `half`: as 16 bits), .hdr, .pfm, .tif, and tone mapped .png, .jpg, .ppm.
        One that fails does not cost the others: all are tried, then Error is raised."""
        if not paths:
            raise Error("write: there is no path", 'give one, such as "picture.exr"')
        _threads.begin()
        failures: List[Problem] = []
        for path in paths:
            try:
                self._image.write(os.fspath(path), tonemap, _tone_settings(parameters), layer, half, quality)
            except Error as error:
                failures += error.problems
        if failures:
            raise Error(failures[0].message, problems=failures)

    def _repr_png_(self) -> bytes:
        return self.to_bytes("png")

    def to_bytes(self, extension: str = "png", *, tonemap: str = "histogram", layer: str = "",
                 half: bool = True, quality: int = 95, **parameters: Any) -> bytes:
        """What `write` would write to a file of this extension."""
        _threads.begin()
        return self._image.encode("picture." + extension.lstrip("."), tonemap, _tone_settings(parameters), layer,
                                  half, quality)

    def to_xarray(self) -> Any:
        """A DataArray with the dimensions y, x, channel; needs xarray and NumPy."""
        try:
            import numpy
            import xarray  # type: ignore[import]
        except ImportError as error:
            raise ImportError(f"to_xarray needs {error.name}: pip install xarray") from None
        attributes = {**self.metadata}
        if self._film is not None:
            attributes["units"] = self.unit
        return xarray.DataArray(numpy.asarray(self), dims=("y", "x", "channel"),
                                coords={"channel": ["R", "G", "B"]}, attrs=attributes, name="radiance")

    def __reduce__(self):
        return Picture._of, (self._image, self._film, self._facts)

    def __repr__(self) -> str:
        text = f"{self.width} x {self.height} pixels"
        if self._film is not None:
            text += f", {len(self._film.passes)} passes, {self._film.samples_per_pixel} samples per pixel"
        return f"<kaustik.Picture: {text}; layers {', '.join(self.layers) or 'none'}>"


def _tone_settings(parameters: Dict[str, Any]) -> List[str]:
    def text(value: Any) -> str:
        return str(value).lower() if isinstance(value, bool) else str(value)

    return [f"{name}={text(value)}" for name, value in parameters.items()]


def read(path: Union[str, os.PathLike]) -> Picture:
    """The picture of a file, EXR with all its layers: without a film, so without intervals."""
    return Picture._of(_native.read_image(os.fspath(path)))
