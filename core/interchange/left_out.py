"""What is lost between a file and a scene, each with its place in what was read."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LeftOutOfFile:
    """Something of a file that a scene does not say.

    Attributes
    ----------
    line : int
        Of the document, from 1.
    what : str
        The element.
    why : str
    changes_motion : bool
        Whether the motion may be another without it.
    """

    line: int
    what: str
    why: str
    changes_motion: bool = True


@dataclass(frozen=True)
class LeftOutOfScene:
    """Something of a scene that a file does not say.

    Attributes
    ----------
    pointer : str
        JSON pointer of the part.
    what : str
        Its name.
    why : str
    changes_motion : bool
        Whether the motion may be another without it.
    """

    pointer: str
    what: str
    why: str
    changes_motion: bool = True
