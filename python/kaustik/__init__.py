"""Kaustik, a photon mapping renderer.

    >>> import kaustik
    >>> scene = kaustik.load_file("scenes/metal_ring/metal_ring.xml")
    >>> picture = kaustik.render(scene, time=10)
    >>> picture.write("ring.png")

docs/guides/python.md is the guide.
"""

from ._arrays import Buffer
from ._compare import Comparison, compare, difference
from ._errors import Error, Problem
from ._merge import merge
from ._mesh import Mesh
from ._native import version as __version__
from ._photons import LightCounts, PhotonMap, Photons, trace_photons
from ._picture import Estimate, Film, Interval, Picture, read
from ._points import Estimates, irradiance, radiance
from ._progress import Progress
from ._scene import Parameters, Scene, load_dict, load_file, load_string
from ._session import Interrupted, Session, render
from ._transform import Transform
from ._types import Family, Parameter, Type, types
from ._view import View, view

__all__ = [
    "Buffer", "Comparison", "Error", "Estimate", "Estimates", "Family", "Film", "Interrupted", "Interval",
    "LightCounts", "Mesh", "Parameter", "Parameters", "PhotonMap", "Photons", "Picture", "Problem", "Progress",
    "Scene", "Session", "Transform", "Type", "View", "compare", "difference", "irradiance", "load_dict", "load_file",
    "load_string", "merge", "radiance", "read", "render", "trace_photons", "types", "view",
]
