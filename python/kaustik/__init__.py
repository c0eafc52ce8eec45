"""Kaustik, a photon mapping renderer.

    >>> import kaustik
    >>> scene = kaustik.load_file("scenes/metal_ring/metal_ring.xml")
    >>> picture = kaustik.render(scene, time=10)
    >>> picture.write("ring.png")

docs/python.md is the guide.
"""

from ._arrays import Buffer
from ._errors import Error, Problem
from ._mesh import Mesh
from ._native import version as __version__
from ._picture import Estimate, Film, Interval, Picture, read
from ._points import Estimates, irradiance, radiance
from ._progress import Progress
from ._scene import Parameters, Scene, load_dict, load_file, load_string
from ._session import Interrupted, Session, render
from ._transform import Transform
from ._types import Family, Parameter, Type, types

__all__ = [
    "Buffer", "Error", "Estimate", "Estimates", "Family", "Film", "Interrupted", "Interval", "Mesh", "Parameter",
    "Parameters", "Picture", "Problem", "Progress", "Scene", "Session", "Transform", "Type", "irradiance", "load_dict",
    "load_file", "load_string", "radiance", "read", "render", "types",
]
