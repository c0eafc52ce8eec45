"""How far a render is: a bar on a terminal, nothing elsewhere, or whatever somebody does with it."""

from __future__ import annotations

import sys
from dataclasses import dataclass
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


#: None: a bar where stderr is a terminal; True: a bar; False: nothing; else it is called with a
#: Progress, in the thread that waits.
ProgressWish = Union[None, bool, Callable[[Progress], Any]]


def listener(wish: ProgressWish) -> Optional["_Listener"]:
    if wish is None:
        wish = _is_terminal()
    if wish is False:
        return None
    return _Bar() if wish is True else _Listener(wish)


def _is_terminal() -> bool:
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except (AttributeError, ValueError):
        return False


class _Listener:
    def __init__(self, call: Callable[[Progress], Any]):
        self._call = call
        self._last: Optional[dict] = None

    def tell(self, facts: Optional[dict]) -> None:
        if facts is not None and facts != self._last:
            self._last = facts
            self._call(Progress(**facts))

    def end(self) -> None:
        pass


class _Bar(_Listener):
    _width = 30

    def __init__(self) -> None:
        super().__init__(self._show)

    def _show(self, now: Progress) -> None:
        filled = round(self._width * min(1.0, max(0.0, now.fraction)))
        parts = [f"[{'#' * filled}{'-' * (self._width - filled)}] {100 * now.fraction:3.0f} %"]
        parts.append(f"{now.passes}" + (f"/{now.passes_total}" if now.passes_total else "") + " passes")
        if now.error not in (0.0, float("inf")):
            parts.append(f"error {100 * now.error:.2g} %")
        if now.remaining >= 0:
            parts.append(f"{now.remaining:.0f} s left")
        sys.stderr.write("\r" + ", ".join(parts) + "\033[K")
        sys.stderr.flush()

    def end(self) -> None:
        if self._last is not None:
            sys.stderr.write("\n")
            sys.stderr.flush()
