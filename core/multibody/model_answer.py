"""What is answered about the model of a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True)
class ModeErrors:
    """Errors of a mode: of its angular frequency (rad/s) and of its growth rate (1/s)."""

    frequency: float | None
    growth_rate: float | None


class SmallMotion(NamedTuple):
    """A mode, q = exp(growth_rate t) cos(frequency t).

    Attributes
    ----------
    frequency : float
        Angular frequency (rad/s).
    growth_rate : float
        1/s.
    """

    frequency: float
    growth_rate: float
    errors: ModeErrors | None = None


@dataclass(frozen=True)
class PartErrors:
    """Errors of the period of a part (s) and of its precession (rad)."""

    period: float | None
    precession: float | None


@dataclass(frozen=True)
class PartModel:
    """The smallest model of one part of a scene that the others do not see.

    Attributes
    ----------
    name, why : str
    degrees_of_freedom : int
    coordinates : tuple of str
        Those that remain.
    period : float or None
        Time after which it repeats (s), up to a turn about the vertical by `precession`.
    precession : float or None
        That angle (rad).
    modes : tuple of SmallMotion
        Of a linear part.
    errors : PartErrors or None
    """

    name: str
    why: str
    degrees_of_freedom: int
    coordinates: tuple[str, ...]
    period: float | None = None
    precession: float | None = None
    modes: tuple[SmallMotion, ...] = ()
    errors: PartErrors | None = None


@dataclass(frozen=True)
class SceneModel:
    """The model of a scene, and what was noticed on the way.

    Attributes
    ----------
    name, why : str
    degrees_of_freedom : int
        Of the motion from the given start.
    mobility : int
        Of the scene: what could move, though it may not from this start.
    coordinates, rows : int
        Coordinates and rows of the table that remain; `described` holds the numbers before.
    described : tuple of int
    apart : tuple of PartModel
        Parts that have no force or connection in common.
    noticed : tuple of str
        Sentences.
    """

    name: str
    why: str
    degrees_of_freedom: int
    mobility: int
    coordinates: int
    rows: int
    described: tuple[int, int]
    apart: tuple[PartModel, ...]
    noticed: tuple[str, ...]
