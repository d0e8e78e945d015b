"""What is answered about the model of a scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
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
        Time after which its state returns (s), up to a turn about the vertical by `precession`.
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
    redundant : mapping of str to tuple of str
        Connections that hold at the start what others hold already, each with these others: what they share is not
        determined.
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
    redundant: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def with_noticed(self, sentences: Sequence[str]) -> SceneModel:
        """Return the model with more of what was noticed."""
        return replace(self, noticed=(*self.noticed, *sentences)) if sentences else self

    @property
    def moving(self) -> list[PartModel]:
        """The parts that do not rest."""
        return [part for part in self.apart if part.name != "rest"]

    @property
    def repeats(self) -> PartModel | None:
        """The one part that moves where its state returns: its period is that of the scene."""
        moving = self.moving
        return moving[0] if len(moving) == 1 and moving[0].period is not None else None


@dataclass(frozen=True)
class AssembledBody:
    """A body at the place that was found for it.

    Attributes
    ----------
    at : tuple of float
        Centre of mass (m).
    angle : float or None
        In the plane, of bodies whose direction matters (rad).
    axes : tuple of three tuples, or None
        In space, the directions of the body axes.
    moved : float
        Distance of the centre of mass from the sketch (m).
    turned : float
        Angle from the sketch, in the plane counter-clockwise (rad).
    errors : mapping of str to float or None
        Of the other fields, of a vector its largest component.
    """

    at: tuple[float, ...]
    angle: float | None
    axes: tuple[tuple[float, ...], ...] | None
    moved: float
    turned: float
    errors: Mapping[str, float | None]


@dataclass(frozen=True)
class FourBarLinkage:
    """A planar four-bar linkage.

    Attributes
    ----------
    links : tuple of str
        In the order of the loop, from the ground on if that is a link.
    lengths : tuple of float
        Distances of their joints (m).
    kind : str
        crank-rocker, double-crank, double-rocker, triple-rocker (no link turns fully), change-point.
    margin : float
        By how much the shortest and the longest link together are shorter than the other two (m); Grashof's condition
        is that it is not negative.
    branch : str
        "open", or "crossed" where the quadrilateral of its joints crosses itself.
    errors : mapping of str to float
        Of the lengths and the margin (m).
    """

    links: tuple[str, ...]
    lengths: tuple[float, ...]
    kind: str
    margin: float
    branch: str
    errors: Mapping[str, float]


@dataclass(frozen=True)
class Assembly:
    """How the start satisfies the connections, nearest to the places that were given.

    Attributes
    ----------
    distance : float
        Root of the sum over the bodies of the mean square of the displacements of their points (m).
    bodies : mapping of str to AssembledBody
    others : tuple of float
        Distances of other places that satisfy the connections and are nearest among their neighbours (m), as far as
        they were found.
    velocities_changed : bool
        Whether given velocities were changed to the nearest that the connections allow.
    four_bar : FourBarLinkage or None
        If the scene is one.
    errors : mapping of str to float or None
        Of the distance and of the others (m).
    """

    distance: float
    bodies: Mapping[str, AssembledBody]
    others: tuple[float, ...]
    velocities_changed: bool
    four_bar: FourBarLinkage | None
    errors: Mapping[str, float | None]
