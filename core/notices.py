"""Warnings that are part of an answer, with a code for programs and a text for people."""

from __future__ import annotations

from dataclasses import dataclass

from core.errors import Path


@dataclass(frozen=True)
class Notice:
    """A warning that accompanies an answer.

    Attributes
    ----------
    code : str
        Stable name for programs, for example ``"unphysical-inertia"``.
    detail : str
        One or two sentences for the user.
    path : tuple of str and int
        Path of the field concerned in the question; empty if it concerns the whole.
    """

    code: str
    detail: str
    path: Path = ()

    def inside(self, *outer: str | int) -> Notice:
        """Return the same notice with the path from an enclosing object."""
        return Notice(self.code, self.detail, (*outer, *self.path))
