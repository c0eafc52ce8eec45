"""Watching a scene in a browser: what `kaustik view` serves."""

from __future__ import annotations

import html
import os
from typing import Any, Dict, Optional, Tuple, Union

from . import _native, _threads
from ._errors import Error
from ._scene import Scene, load_file
from ._types import types


def _check_place(port: Any, output: Any) -> None:
    if not isinstance(port, int) or not 0 <= port < 65536:
        raise Error(f"port: {port!r} is no port", "give a number up to 65535, or 0 for any that is free")
    if not os.path.isdir(output):
        raise Error(f"output: '{os.fspath(output)}' is no folder", "give one that is there")


def _title(scene: Scene) -> str:
    return os.path.splitext(os.path.basename(scene.source))[0] or "scene"


class View:
    """A server that shows a scene to browsers of this machine, until `stop`. It renders by itself, from its first
    pass on, and what is changed in the browser stays there; but that of `Session.view` shows what the session
    renders."""

    _native: Any

    def __init__(self, scene: Scene, *, integrator: Union[None, str, Dict[str, Any]] = None, port: int = 0,
                 threads: int = 0, output: Union[str, os.PathLike] = "."):
        if not isinstance(scene, Scene):
            raise Error(f"scene: {type(scene).__name__} is no scene",
                        "make one by kaustik.load_file, load_string or load_dict")
        _check_place(port, output)
        if not isinstance(threads, int) or not 0 <= threads <= 1 << 16:
            raise Error(f"threads: {threads!r} is no number of threads", "give an integer, 0 for all")
        name = ""
        if isinstance(integrator, dict):
            scene = scene._with_integrator(integrator)
        elif integrator is not None:
            if integrator not in types["integrator"]:
                raise Error(f"integrator: there is no '{integrator}'",
                            _native.suggest(str(integrator), list(types["integrator"])))
            name = integrator
        scene._require_camera()
        _threads.begin()
        scene._build()
        self._native = _native.View(scene._native, _title(scene), name, port, threads, os.fspath(output), 0, False)

    @classmethod
    def _of_session(cls, scene: Scene, integrator: str, threads: int, seed: int, port: int,
                    output: Union[str, os.PathLike]) -> "View":
        """Shows nothing but what `_show` says."""
        _check_place(port, output)
        _threads.begin()
        made = object.__new__(cls)
        made._native = _native.View(scene._native, _title(scene), integrator, port, threads, os.fspath(output), seed, True)
        return made

    def _show(self, job: Any, scene: Scene) -> None:
        self._native.show(job, scene._native)

    @property
    def url(self) -> str:
        """The address to open, with the token that lets you in."""
        return self._native.url

    @property
    def port(self) -> int:
        return self._native.port

    @property
    def is_running(self) -> bool:
        return self._native.is_running

    @property
    def messages(self) -> Tuple[str, ...]:
        return tuple(self._native.messages)

    def stop(self) -> None:
        self._native.stop()

    def __enter__(self) -> "View":
        return self

    def __exit__(self, *_: Any) -> None:
        self.stop()

    def __repr__(self) -> str:
        return f"<kaustik.View: {self.url if self.is_running else 'stopped'}>"

    def _repr_html_(self) -> Optional[str]:
        if not self.is_running:
            return None
        address = html.escape(self.url)
        return f'<a href="{address}" target="_blank">{address.split("#")[0]}</a>'


def view(scene: Union[Scene, str, os.PathLike], **settings: Any) -> View:
    """Serves a scene, or the file of one, to browsers of this machine, as `kaustik view` does: turn the camera,
    change parameters, see errors. Open `.url`; it goes on until `.stop()` or the end of the program. `integrator`
    is used while the camera rests, `port` 0 is any that is free, and `output` the folder where pages may save
    pictures."""
    return View(scene if isinstance(scene, Scene) else load_file(scene), **settings)
