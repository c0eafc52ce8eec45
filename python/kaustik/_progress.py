"""How far a render is: a bar on a terminal, the picture so far in a notebook, nothing elsewhere, or whatever somebody
does with it."""

from __future__ import annotations

import base64
import html
import sys
import time
from dataclasses import dataclass, replace
from typing import Any, Callable, Optional, Union


@dataclass(frozen=True)
class Progress:
    """A look at a running render."""

    stage: str  #: "light", "picture" or "done"
    fraction: float  #: of the whole, 0 to 1
    elapsed: float  #: s
    remaining: float  #: s, estimated; negative: unknown
    passes: int  #: that are finished
    passes_total: int  #: 0: limited by time or error
    samples_per_pixel: int
    rays_per_second: float
    error: float  #: of the picture, relative; infinite: not known yet


#: None: the picture so far in a notebook, a bar where stderr is a terminal; True: one of them in any case; False:
#: nothing; else it is called with a Progress, in the thread that waits.
ProgressWish = Union[None, bool, Callable[[Progress], Any]]
#: Makes the picture as it is, an image of the compiled part; None: there is none yet.
Snapshot = Callable[[], Any]


def listener(wish: ProgressWish) -> Optional["_Listener"]:
    if wish is None:
        wish = _is_notebook() or _is_terminal()
    if wish is False:
        return None
    if wish is not True:
        return _Listener(wish)
    return _Notebook() if _is_notebook() else _Bar()


def _is_notebook() -> bool:
    """Whether IPython runs as the kernel of one, and not in a terminal."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and getattr(shell, "kernel", None) is not None


def _is_terminal() -> bool:
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except (AttributeError, ValueError):
        return False


class _Listener:
    def __init__(self, call: Callable[[Progress], Any]):
        self._call = call
        self._last: Optional[dict] = None

    def tell(self, facts: Optional[dict], snapshot: Optional[Snapshot]) -> None:
        if facts is not None and facts != self._last:
            self._last = facts
            self._call(Progress(**facts))

    def end(self) -> None:
        pass


def _sentence(now: Progress) -> str:
    parts = [f"{now.passes}" + (f"/{now.passes_total}" if now.passes_total else "") + " passes"]
    if now.error not in (0.0, float("inf")):
        parts.append(f"error {100 * now.error:.2g} %")
    if now.remaining >= 0:
        parts.append(f"{now.remaining:.0f} s left")
    return ", ".join(parts)


class _Bar(_Listener):
    _width = 30

    def __init__(self) -> None:
        super().__init__(self._show)

    def _show(self, now: Progress) -> None:
        filled = round(self._width * min(1.0, max(0.0, now.fraction)))
        bar = f"[{'#' * filled}{'-' * (self._width - filled)}] {100 * now.fraction:3.0f} %"
        sys.stderr.write(f"\r{bar}, {_sentence(now)}\033[K")
        sys.stderr.flush()

    def end(self) -> None:
        if self._last is not None:
            sys.stderr.write("\n")
            sys.stderr.flush()


class _Shown:
    """What a notebook shows of it."""

    def __init__(self, now: Progress, png: bytes = b""):
        self._now, self._png = now, png

    def _repr_html_(self) -> str:
        if self._now.stage == "done":
            return ""
        bar = f'<progress max="1" value="{min(1.0, max(0.0, self._now.fraction)):.3f}"></progress> '
        text = bar + html.escape(_sentence(self._now))
        if not self._png:
            return text
        return f'<img src="data:image/png;base64,{base64.b64encode(self._png).decode()}"/><br/>{text}'

    def __repr__(self) -> str:
        return "" if self._now.stage == "done" else _sentence(self._now)


class _Notebook(_Listener):
    """The picture so far above a bar, in one output that is replaced. It is gone at the end: the picture is shown
    by what was asked for it."""

    #: Between two pictures, s; more where they take long.
    _least = 1.0

    def __init__(self) -> None:
        super().__init__(lambda now: None)
        self._handle: Any = None
        self._next = time.monotonic() + 0.3
        self._now: Optional[Progress] = None
        self._png = b""

    def tell(self, facts: Optional[dict], snapshot: Optional[Snapshot]) -> None:
        start = time.monotonic()
        if facts is None or start < self._next:
            return
        image = snapshot() if snapshot is not None else None
        if image is not None:
            self._png = image.encode("picture.png", "histogram", [], "", True, 95)
        self._now = Progress(**facts)
        self._show(_Shown(self._now, self._png))
        self._next = time.monotonic() + max(self._least, 10 * (time.monotonic() - start))

    def _show(self, shown: _Shown) -> None:
        from IPython.display import display  # type: ignore[import]

        if self._handle is None:
            self._handle = display(shown, display_id=True)
        else:
            self._handle.update(shown)

    def end(self) -> None:
        if self._now is not None:
            self._show(_Shown(replace(self._now, stage="done")))
