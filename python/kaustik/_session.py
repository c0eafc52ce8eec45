"""Renders: in one call, or watched and steered."""

from __future__ import annotations

import math
import os
import time as clock
import weakref
from typing import Any, Callable, Dict, List, Optional, Tuple, Union

from . import _native, _threads
from ._errors import Error
from ._picture import Film, Picture
from ._progress import Progress, ProgressWish, listener
from ._scene import Scene, load_file
from ._values import is_number
from ._view import View

#: Between two looks at signals and progress, s.
_slice = 0.05
#: Between two looks whether it has begun, s.
_poll = 0.002
_most_pixels = 1 << 20


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during `render`: `picture` is what was finished until then, None: nothing was."""

    def __init__(self, picture: Optional[Picture]):
        super().__init__("the render was interrupted" + ("" if picture is None else "; .picture is what there is"))
        self.picture = picture


def _positive(name: str, value: Any, *, is_integer: bool = False, least: float = 0, most: float = math.inf) -> Any:
    if value is None:
        return None
    fits = is_number(value) and (not is_integer or int(value) == value) and math.isfinite(value)
    if not fits or not (value >= least and (value > 0 or least == 0 and is_integer)) or value > most:
        kind = "an integer" if is_integer else "a number"
        raise Error(f"{name}: {value!r} is no such number",
                    f"give {kind} {'from 0 on' if is_integer and least == 0 else 'above 0'}"
                    + (f", up to {most:.0f}" if most < math.inf else ""))
    return int(value) if is_integer else float(value)


class _Goals:
    """What a render is asked for, checked."""

    def __init__(self, *, integrator: Union[None, str, Dict[str, Any]] = None, passes: Optional[int] = None,
                 spp: Optional[int] = None, time: Optional[float] = None, error: Optional[float] = None,
                 seed: int = 0, threads: int = 0, first_pass: int = 0, samples_per_pass: Optional[int] = None):
        largest = 2 ** 31 - 1
        if integrator is not None and not isinstance(integrator, (str, dict)):
            raise Error(f"integrator: {integrator!r} is no integrator",
                        'give a name such as "path", or a dict: {"type": "path", "max_depth": 5}')
        self.integrator = integrator
        self.wishes = {
            "passes": _positive("passes", passes, is_integer=True, least=1, most=largest),
            "spp": _positive("spp", spp, is_integer=True, least=1, most=largest),
            "samples_per_pass": _positive("samples_per_pass", samples_per_pass, is_integer=True, least=1,
                                          most=1 << 20),
            "time": _positive("time", time, most=1e9),
            "error": _positive("error", error),
            "seed": _positive("seed", seed, is_integer=True, most=2 ** 64 - 1),
            "threads": _positive("threads", threads, is_integer=True, most=1 << 16),
            "first_pass": _positive("first_pass", first_pass, is_integer=True, most=largest),
        }


class Session:
    """A render that is watched and steered. It goes on in threads of its own.

    ``time`` is in seconds, ``error`` the picture's relative error (0.01 for 1 %), ``spp`` samples per
    pixel of all passes together. As a context manager it stops at the end of its block.
    """

    def __init__(self, scene: Scene, *, integrator: Union[None, str, Dict[str, Any]] = None,
                 passes: Optional[int] = None, spp: Optional[int] = None, time: Optional[float] = None,
                 error: Optional[float] = None, seed: int = 0, threads: int = 0, first_pass: int = 0,
                 samples_per_pass: Optional[int] = None, progress: ProgressWish = None):
        if not isinstance(scene, Scene):
            raise Error(f"scene: {type(scene).__name__} is no scene",
                        "make one by kaustik.load_file, load_string or load_dict")
        scene._require_camera()
        self._goals = _Goals(integrator=integrator, passes=passes, spp=spp, time=time, error=error, seed=seed,
                             threads=threads, first_pass=first_pass, samples_per_pass=samples_per_pass)
        self._scene = scene
        self._waiting: List[List[int]] = []  # regions: x, y, width, height, passes that the last run left
        self._progress = progress
        self._job: Any = None
        self._film: Optional[Film] = None  # of what was finished before
        self._picture: Optional[Picture] = None
        self._keeps_passes = True
        self._views: "weakref.WeakSet[View]" = weakref.WeakSet()

    # What is rendered.

    @property
    def scene(self) -> Scene:
        return self._scene

    def edit(self, changes: Dict[str, Any]) -> None:
        """Renders the scene with these values instead, from its first pass on. What is wrong with them
        raises Error, and the render goes on as it was."""
        scene = self._scene.edit(changes)
        was_running, was_paused = self.is_running, self.is_paused
        self.stop()
        self._scene, self._job, self._film, self._picture = scene, None, None, None
        self._waiting = []
        if was_running or was_paused:
            self.start()
            if was_paused:
                self.pause()

    # Its course.

    def start(self) -> "Session":
        """Begins, or goes on where it ended, in the background."""
        if self.is_running:
            return self
        self._collect()
        self._begin()
        return self

    def refine(self, x: int, y: int, width: int, height: int, passes: int = 16) -> None:
        """More samples in a region of the picture: so many passes for its pixels alone. The picture, its errors
        and its intervals count them. While the session runs they come before the next pass of the picture, and this
        returns as soon as it has begun; after the end they are taken now. Choose a region by what is
        in it, not by single pixels that look too bright: only then the picture stays unbiased. What the end of a
        run leaves waiting, the next `start` or `refine` takes up."""
        region = [_positive("x", x, is_integer=True, most=_most_pixels),
                  _positive("y", y, is_integer=True, most=_most_pixels),
                  _positive("width", width, is_integer=True, least=1, most=_most_pixels),
                  _positive("height", height, is_integer=True, least=1, most=_most_pixels),
                  _positive("passes", passes, is_integer=True, least=1, most=4096)]
        while self.is_running:
            if self._job.has_session():
                if self._job.refine(region):
                    return
                self._job.wait(_slice)  # it is about to end
            else:
                self._job.wait(_poll)  # it reads its scene
        begin = self.film._native.first_pass
        done = set(self.film.passes)
        wishes = dict(self._goals.wishes, time=None, error=None, spp=None, regions=[region],
                      passes=next(i for i in range(len(done) + 1) if begin + i not in done))
        self._begin(wishes)
        self.wait()
        self._collect()

    def _begin(self, wishes: Optional[Dict[str, Any]] = None) -> None:
        _threads.begin()
        self._job = self._new_job(wishes)
        self._job.start()
        for view in list(self._views):
            if view.is_running:
                view._show(self._job, self._rendered_scene())
            else:
                self._views.discard(view)

    def _rendered_scene(self) -> Scene:
        if isinstance(self._goals.integrator, dict):
            return self._scene._with_integrator(self._goals.integrator)
        return self._scene

    def _new_job(self, wanted: Optional[Dict[str, Any]] = None) -> Any:
        goals = self._goals
        scene = self._rendered_scene()
        wishes = {name: value for name, value in (wanted or goals.wishes).items() if value is not None}
        if isinstance(goals.integrator, str):
            wishes["integrator"] = goals.integrator
        if self._film is not None:
            wishes["samples_per_pass"] = self._film._native.samples_per_pass
        wishes["keeps_passes"] = self._keeps_passes
        if self._waiting:
            wishes["regions"] = self._waiting + wishes.get("regions", [])
            self._waiting = []
        if scene.source:
            wishes.update(scene=scene.source, folder=os.getcwd(), definitions=list(scene._definitions))
        scene._build()
        return _native.Job(scene._native, wishes, self._film._native if self._film is not None else None)

    def pause(self) -> None:
        """Its threads rest until `resume`; a light pass is finished first."""
        if self._job is not None:
            self._job.pause()

    def resume(self) -> None:
        if self._job is not None:
            self._job.resume()

    def stop(self) -> Optional[Picture]:
        """Ends it; what is finished stays: `picture`, and `start` goes on with it."""
        if self._job is not None:
            self._job.cancel()
            while not self._job.wait(_slice):
                pass
        return self.picture

    def wait(self, timeout: Optional[float] = None) -> bool:
        """Until it has ended, or for so many seconds: then False. Shows progress. Raises what ended it
        otherwise than it should. Ctrl-C stops it, keeps what is finished, and raises KeyboardInterrupt."""
        if self._job is None:
            raise Error("the session was not started", "start() it before")
        shown = listener(self._progress)
        until = math.inf if timeout is None else clock.monotonic() + timeout
        try:
            while not self._job.wait(max(0.0, min(_slice, until - clock.monotonic()))):
                if shown:
                    shown.tell(self._job.progress(), self._job.snapshot)
                if clock.monotonic() >= until:
                    return False
            if shown:
                shown.tell(self._job.progress(), None)
        except BaseException:
            self.stop()
            raise
        finally:
            if shown:
                shown.end()
        self._job.join()
        return True

    def run(self, *, passes: Optional[int] = None, time: Optional[float] = None,
            error: Optional[float] = None) -> Picture:
        """Renders until there are so many passes in all, for so many seconds more, or until the picture's
        error is so small; without any of these as the session was told. Returns the picture."""
        if self.is_running:
            raise Error("the session runs", "wait() for it, or stop() it before")
        if not (passes is None and time is None and error is None):
            wanted = _Goals(passes=passes, time=time, error=error).wishes
            for name in ("passes", "time", "error"):
                self._goals.wishes[name] = wanted[name]
            self._goals.wishes["spp"] = None
        self.start()
        self.wait()
        picture = self.picture
        assert picture is not None
        return picture

    @property
    def is_running(self) -> bool:
        return self._job is not None and not self._job.has_ended

    @property
    def is_paused(self) -> bool:
        return self.is_running and self._job.is_paused

    @property
    def progress(self) -> Optional[Progress]:
        """None: it has not begun to render."""
        facts = self._job.progress() if self._job is not None else None
        return None if facts is None else Progress(**facts)

    @property
    def messages(self) -> Tuple[str, ...]:
        """What is odd about the scene, or went wrong by half."""
        return tuple(self._job.messages()) if self._job is not None else ()

    # What there is of it.

    def snapshot(self) -> Optional[Picture]:
        """The picture as it is now; None: there is none yet."""
        if not self.is_running:
            return self.picture
        image = self._job.snapshot()
        return None if image is None else Picture._of(image)

    @property
    def picture(self) -> Optional[Picture]:
        """What is finished, after the end; while it runs what was so before it began. None: nothing."""
        self._collect()
        return self._picture

    @property
    def film(self) -> Film:
        """Its finished passes, after the end. Raises Error if there is none."""
        if self.is_running:
            raise Error("the session runs", "wait() for it, or stop() it before")
        self._collect()
        if self._film is None:
            raise Error("no pass is finished", "give it more time, or fewer samples per pass")
        return self._film

    def _collect(self) -> None:
        """Takes what a job that has ended leaves behind, once."""
        job = self._job
        if job is None or not job.has_ended or getattr(self, "_collected", None) is job:
            return
        self._collected = job
        try:
            facts = job.report()
        except Exception:  # wait() raises it
            return
        facts["warnings"] = tuple(facts["warnings"])
        facts["messages"] = tuple(job.messages())
        self._waiting = [[*region[:4], region[5]] for region in job.regions() if region[5] > 0]
        if facts["passes"] > 0 and not facts["is_incomplete"]:
            self._film = Film._of(job.film())
        if facts["passes"] > 0 or facts["end"] != "cancelled":
            self._picture = Picture._of(job.image(), self._film, facts)

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Its finished passes to a `.kpt` file, with which `Session.load` and, where the scene is a file,
        `kaustik resume` go on."""
        self.film.save(path)

    @classmethod
    def load(cls, path: Union[str, os.PathLike], scene: Optional[Scene] = None, *,
             integrator: Union[None, str, Dict[str, Any]] = None, passes: Optional[int] = None,
             time: Optional[float] = None, error: Optional[float] = None, threads: int = 0,
             progress: ProgressWish = None) -> "Session":
        """Goes on with what was saved. The scene has to be the same, to the bit; without one that is loaded
        which the file names."""
        film = Film.load(path)
        kept = film._native
        if kept.settings:
            raise Error(f"it was rendered with settings of the command line: {kept.settings[0][0]}",
                        "go on with it there: kaustik resume", os.fspath(path))
        if scene is None:
            if not kept.scene:
                raise Error("its scene comes from no file", "give it: Session.load(path, scene)", os.fspath(path))
            scene = load_file(kept.scene, **dict(kept.definitions))
        session = cls(scene, integrator=integrator or kept.asked_integrator or None, passes=passes, time=time,
                      error=error, seed=kept.seed, threads=threads, first_pass=kept.first_pass, progress=progress)
        session._film = film
        session._picture = film.picture()
        return session

    def view(self, *, port: int = 0, output: Union[str, os.PathLike] = ".") -> "View":
        """Shows what this session renders to browsers of this machine: its picture, errors and values of pixels, as
        they are now, and after each `start` and `edit`. Nothing is rendered for the view; who looks can pause and
        stop the session, but not change the scene. `port` 0 is any that is free, and `output` the folder where
        pages may save pictures. It goes on until `.stop()`, or until nobody holds it."""
        integrator = self._goals.integrator if isinstance(self._goals.integrator, str) else ""
        view = View._of_session(self._rendered_scene(), integrator, self._goals.wishes["threads"],
                                self._goals.wishes["seed"], port, output)
        self._views.add(view)
        if self._job is not None:
            view._show(self._job, self._rendered_scene())
        return view

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: Any) -> None:
        self.stop()

    def __repr__(self) -> str:
        state = "paused" if self.is_paused else "running" if self.is_running else "idle"
        return f"<kaustik.Session: {state}, {self.picture!r}>"


def render(scene: Scene, *, integrator: Union[None, str, Dict[str, Any]] = None, passes: Optional[int] = None,
           spp: Optional[int] = None, time: Optional[float] = None, error: Optional[float] = None, seed: int = 0,
           threads: int = 0, first_pass: int = 0, samples_per_pass: Optional[int] = None,
           progress: ProgressWish = None) -> Picture:
    """Renders a scene to the end and returns the picture, with the bits of `kaustik render`.

    `integrator` is a name or a dict; `spp` samples per pixel of all passes; `time` seconds; `error` the
    picture's relative error, such as 0.01; `threads` 0 for all. `first_pass` and `samples_per_pass` are for
    rendering in parts, whose films add up. Ctrl-C raises `Interrupted`, a KeyboardInterrupt with what is
    finished as its `picture`."""
    session = Session(scene, integrator=integrator, passes=passes, spp=spp, time=time, error=error, seed=seed,
                      threads=threads, first_pass=first_pass, samples_per_pass=samples_per_pass,
                      progress=progress)
    session._keeps_passes = False
    try:
        return session.run()
    except KeyboardInterrupt:
        raise Interrupted(session.picture) from None
