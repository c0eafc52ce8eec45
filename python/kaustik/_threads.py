"""Threads do not survive a fork: who forks after a render is told so, where it would hang."""

from __future__ import annotations

import os

from ._errors import Error

_has_threads = False
_is_forked = False


def begin() -> None:
    """To be called before anything that starts threads. Raises Error in a forked process."""
    global _has_threads
    if _is_forked:
        raise Error(
            "this process was forked from one in which Kaustik had started threads: they are not here",
            'start processes with multiprocessing.get_context("spawn")')
    _has_threads = True


def _after_fork() -> None:
    global _is_forked
    _is_forked = _is_forked or _has_threads


os.register_at_fork(after_in_child=_after_fork)
