"""What goes wrong, as one exception with all its problems."""

from __future__ import annotations

from typing import NamedTuple, Optional, Sequence


class Problem(NamedTuple):
    """One thing that is wrong."""

    message: str
    remedy: str = ""
    file: Optional[str] = None
    line: Optional[int] = None
    column: Optional[int] = None

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
        text = f"{place}: {self.message}" if place else self.message
        return f"{text}\n  {self.remedy}" if self.remedy else text


class Error(ValueError):
    """Something is wrong with what was given, or the machine failed: `is_of_machine` tells.

    `problems` are all that were found; `message`, `remedy`, `file`, `line` and `column` are those of
    the first. `file` is a file, or for scenes from dicts the place in the dict: ``floor.bsdf``.
    """

    def __init__(self, message: str, remedy: str = "", file: Optional[str] = None, *,
                 problems: Optional[Sequence[Problem]] = None, text: Optional[str] = None,
                 is_of_machine: bool = False):
        self.problems = tuple(problems) if problems else (Problem(message, remedy, file),)
        self.is_of_machine = is_of_machine
        super().__init__(text or "\n".join(str(problem) for problem in self.problems))

    @property
    def message(self) -> str:
        return self.problems[0].message

    @property
    def remedy(self) -> str:
        return self.problems[0].remedy

    @property
    def file(self) -> Optional[str]:
        return self.problems[0].file

    @property
    def line(self) -> Optional[int]:
        return self.problems[0].line

    @property
    def column(self) -> Optional[int]:
        return self.problems[0].column

    def __reduce__(self):
        return _unpickled, (str(self), self.problems, self.is_of_machine)


def _unpickled(text: str, problems: Sequence[Problem], is_of_machine: bool) -> Error:
    return Error(problems[0].message, problems=problems, text=text, is_of_machine=is_of_machine)


def error_of(text: str, problems: Sequence[tuple], is_of_machine: bool) -> Error:
    """For the compiled part."""
    return _unpickled(text, [Problem(*problem) for problem in problems], is_of_machine)


def refuse(message: str, remedy: str = "", file: Optional[str] = None) -> None:
    raise Error(message, remedy, file)


def raise_all(problems: Sequence[Problem]) -> None:
    """Raises them together, if there are any."""
    if problems:
        raise Error(problems[0].message, problems=problems)
