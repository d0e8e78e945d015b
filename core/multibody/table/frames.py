"""The coordinates of one body, places on bodies, and rates as linear forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from core.errors import Path
from core.multibody.algebra.polynomials import ZERO, Ball, Poly
from core.multibody.language.shapes import Shape


@dataclass
class Frame:
    """The coordinates of one body.

    Attributes
    ----------
    position : list of int
        Of the centre of mass.
    direction : tuple of int or None
        In the plane, cosine and sine of the angle of its first axis.
    turn : int or None
        In the plane, the angle itself, unwrapped.
    axes : list of list of int, or None
        In space, the components of each body axis.
    axis : tuple (int, list of int) or None
        Of a symmetric top: which body axis, and its components.
    turns : tuple of int, or None
        In space, of a body that rolls: three coordinates whose rates are its angular velocity in space.
    start_axes : three lists of balls, or None
        Of a ball, which has no other coordinates: the body axes at the start.
    shape : Shape or None
        What touches where the body as a whole does.
    """

    name: str
    position: list[int]
    radius: Ball | None = None
    direction: tuple[int, int] | None = None
    turn: int | None = None
    axes: list[list[int]] | None = None
    axis: tuple[int, list[int]] | None = None
    turns: tuple[int, ...] | None = None
    start_axes: list[list[Ball]] | None = None
    spin_momentum: Ball = ZERO
    spin_energy: Ball = ZERO
    orients: bool = False
    places: dict[str, tuple[Ball, ...]] = field(default_factory=dict)
    shape: Shape | None = None

    @property
    def coordinates(self) -> list[int]:
        """All of its coordinates."""
        triples = [] if self.axes is None else [i for axis in self.axes for i in axis]
        along = [] if self.axis is None else self.axis[1]
        turn = [] if self.turn is None else [self.turn]
        return [*self.position, *(self.direction or ()), *turn, *triples, *along, *(self.turns or ())]


@dataclass(frozen=True)
class Point:
    """A place: its components as affine polynomials, and the body that carries it."""

    at: list[Poly]
    body: str | None


@dataclass(frozen=True)
class Given:
    """A rate that the client states: a linear form that equals a value."""

    line: dict[int, Ball]
    value: Ball
    path: Path


def axis_after(axis: Sequence[Ball], frame: Frame | None, before: Sequence[Ball], after: Sequence[Ball]) -> list[Ball]:
    """Return where a vector of space goes that is fixed in a body between two places of it; None is the ground."""
    if frame is None or frame.axes is None:
        return list(axis)
    inside = [sum((before[i] * x for i, x in zip(own, axis, strict=True)), ZERO) for own in frame.axes]
    return [sum((x * after[own[k]] for x, own in zip(inside, frame.axes, strict=True)), ZERO) for k in range(3)]
