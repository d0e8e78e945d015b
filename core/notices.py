"""What an answer has to say beside its figures: a warning that a program can tell apart and a person can read."""

from __future__ import annotations

from dataclasses import dataclass

from core.errors import Path


@dataclass(frozen=True)
class Notice:
    """A warning that goes with an answer; it never replaces one.

    Attributes
    ----------
    code : str
        Stable name for programs, for example ``"unphysical-inertia"``.
    detail : str
        One or two sentences for a person.
    path : tuple of str and int
        What it is about, as steps into the question; empty when it is about the whole.
    """

    code: str
    detail: str
    path: Path = ()

    def inside(self, *outer: str | int) -> Notice:
        """Return the same notice seen from an enclosing object."""
        return Notice(self.code, self.detail, (*outer, *self.path))
