"""What one-sided measures may do, and in which directions of space they begin to slide."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.optimize import root

from tests.oracles.plain_engine.coordinates import Floats

FOUND = 1e-9
"""Sine of the angle between a slip and the direction that was assumed for it, up to which they are one."""


class Kind(Enum):
    """What a one-sided measure does."""

    OPEN = "open"
    CLOSED = "closed"
    STICK = "stick"
    SLIDE = "slide"


@dataclass(frozen=True)
class Mode:
    """What a one-sided measure does, and along which unit vector it slides: (1,) or (-1,) in the plane."""

    kind: Kind
    along: tuple[float, ...] = ()

    @property
    def undirected(self) -> bool:
        """Whether it begins to slide in a direction of space that is still to be found."""
        return self.kind is Kind.SLIDE and not self.along


OPEN, CLOSED, STICK = Mode(Kind.OPEN), Mode(Kind.CLOSED), Mode(Kind.STICK)


def ways(slips: int) -> tuple[Mode, ...]:
    """Return all that a measure may do whose slip has so many components, and is zero."""
    sliding = {0: (), 1: (Mode(Kind.SLIDE, (1.0,)), Mode(Kind.SLIDE, (-1.0,)))}.get(slips, (Mode(Kind.SLIDE),))
    return (STICK if slips else CLOSED, *sliding, OPEN)


def sticks_more(other: Sequence[Mode], one: Sequence[Mode]) -> bool:
    """Return whether other states differ only in that something sticks where here it slides."""
    pairs = [(a, b) for a, b in zip(other, one, strict=True) if a != b]
    return bool(pairs) and all(a.kind is Kind.STICK and b.kind is Kind.SLIDE for a, b in pairs)


def tangents(lines: Floats) -> Floats:
    """Return unit vectors along which a slip has its components: of three in space two are independent."""
    return np.eye(1) if len(lines) == 1 else np.linalg.svd(lines, full_matrices=False)[0][:, :2].T


Directions = dict[int, Floats]


def directions(
    frames: Directions, rubs: Mapping[int, Floats], follow: Callable[[Directions], Directions]
) -> Directions | None:
    """Return the unit vectors along which contacts of space begin to slide: those of the slips that follow.

    Parameters
    ----------
    frames : dict of int to ndarray, shape (2, 3)
    rubs : mapping of int to ndarray, shape (3,)
        Friction while they stick, against which the search begins.
    follow : callable
        What comes of directions: slips, or their accelerations.
    """

    def along(angles: Floats) -> Directions:
        return {i: np.array([np.cos(a), np.sin(a)]) @ frames[i] for i, a in zip(frames, angles, strict=True)}

    def beside(angles: Floats) -> Floats:
        missed, chosen = [], along(angles)
        for i, slip in follow(chosen).items():
            a, b = frames[i] @ chosen[i], frames[i] @ slip
            missed.append((a[0] * b[1] - a[1] * b[0]) / (float(np.linalg.norm(b)) or 1.0))
        return np.array(missed)

    against = [-frames[i] @ rubs[i] for i in frames]
    angles = root(beside, np.array([np.arctan2(y, x) for x, y in against]), tol=1e-13).x
    found = along(angles)
    follows = all(found[i] @ slip > 0.0 for i, slip in follow(found).items())
    return found if follows and np.abs(beside(angles)).max(initial=0.0) <= FOUND else None


def toward(modes: Sequence[Mode], along: Directions) -> list[Mode]:
    """Return states in which some measures slide along given directions."""
    return [Mode(Kind.SLIDE, tuple(along[i].tolist())) if i in along else mode for i, mode in enumerate(modes)]
