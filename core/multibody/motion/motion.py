"""What every model of motion answers: the state at any time, with its error; and the simplest one, rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from core.arrays import Floats
from core.errors import BudgetExceeded
from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import pair
from core.multibody.table.table import Table


@dataclass(frozen=True)
class States:
    """Coordinates and rates of one part at many times, in SI units, as pairs of doubles.

    Attributes
    ----------
    q, v : ndarray, shape (t, n, 2)
    q_error, v_error : ndarray, shape (t, n)
        Errors of the values, rounding to doubles apart.
    reference : tuple of two ndarrays of shape (t, n, 2), or None
        Coordinates and rates of the run in pairs against which these were measured.
    """

    q: Floats
    v: Floats
    q_error: Floats
    v_error: Floats
    reference: tuple[Floats, Floats] | None = None


def check_sample_count(count: float, most: int) -> None:
    """Raise `BudgetExceeded` where a motion would have to be sampled more often than it may be."""
    if count > most:
        raise BudgetExceeded(
            "samples for events",
            count,
            most,
            path=("times",),
            remedy="ask for a shorter time; with fewer samples something could be passed over",
        )


class Motion(Protocol):
    """The motion of one part of a scene from its start."""

    @property
    def name(self) -> str:
        """The model."""

    @property
    def why(self) -> str:
        """What made it suffice."""

    @property
    def how(self) -> str:
        """How errors are stated."""

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states at times of shape (t,), finer ones where there is a choice."""

    def nodes(self, end: float) -> Floats:
        """Return times between 0 and `end`, or over one period, so close that nothing turns twice between two of them.

        Raises
        ------
        BudgetExceeded
            Where they would be too many.
        """

    @property
    def period(self) -> Ball | None:
        """The period in seconds, where there is one."""


@runtime_checkable
class EvaluatedInDoubles(Protocol):
    """A motion that is known faster to a few roundings of doubles: enough to see about when something changes sign."""

    def in_doubles(self, times: Floats) -> tuple[Floats, Floats] | None:
        """Return coordinates and rates at times of shape (t,), each of shape (t, n); None where doubles do not do."""


@dataclass(frozen=True)
class Rest:
    """Nothing moves: the start is an equilibrium and there is no velocity."""

    table: Table
    name: str = "rest"
    why: str = "nothing moves at the start, and no force is left over"
    how: str = "closed form"
    period: Ball | None = None

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the start at every time."""
        q = np.array([pair(x, 0) for x in self.table.q]).reshape(-1, 2)
        shape = (len(times), len(q), 2)
        zero = np.zeros(shape[:2])
        return States(np.broadcast_to(q, shape).copy(), np.zeros(shape), zero, zero)

    def nodes(self, end: float) -> Floats:
        """Return the two ends."""
        return np.array([0.0, end])
