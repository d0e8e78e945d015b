"""What every model of motion answers: the state at any time, with its error; and the simplest one, rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from core.arrays import Floats
from core.multibody.algebra.doubles import error_in_doubles, in_doubles
from core.multibody.algebra.polynomials import ZERO, Ball, Poly
from core.multibody.equations.packed import Packed, Units, pair
from core.multibody.model_answer import ModeErrors, SmallMotion
from core.multibody.table.table import Table


@dataclass(frozen=True)
class States:
    """Coordinates and rates of one part, or of a scene as described, at many times, in SI units, as pairs of doubles.

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


@dataclass(frozen=True)
class Mode:
    """One pair of characteristic roots, or a real one.

    Attributes
    ----------
    frequency : ball
        Angular frequency (rad/s), a ball with zero where nothing oscillates.
    growth : ball
        Growth rate (1/s), negative where it decays.
    """

    frequency: Ball
    growth: Ball

    def in_doubles(self) -> SmallMotion:
        """Return the mode as it is answered, with bounds of its errors."""
        errors = ModeErrors(error_in_doubles(self.frequency), error_in_doubles(self.growth))
        return SmallMotion(in_doubles(self.frequency), in_doubles(self.growth), errors)


@dataclass(frozen=True)
class BallState:
    """Coordinates and rates of one part at a time, in balls.

    Attributes
    ----------
    q, v : sequence of ball
    path : sequence of sequences of ball
        Coordinates at times before, from the start on, between which no direction turns by half a turn.
    turned : ball or None
        Angle by which two coordinates on a circle, the first towards the second, have turned since the start (rad).
    """

    q: Sequence[Ball]
    v: Sequence[Ball]
    path: Sequence[Sequence[Ball]] = ()
    turned: Ball | None = None


class ElementaryTerm(NamedTuple):
    """A term value * t^power * exp(growth t) * cos(frequency t), or with the sine.

    Attributes
    ----------
    value : ball
    power : int
    growth, frequency : ball
        1/s and rad/s.
    sine : bool
    """

    value: Ball
    power: int = 0
    growth: Ball = ZERO
    frequency: Ball = ZERO
    sine: bool = False


def in_pairs(states: Sequence[BallState], count: int) -> tuple[Floats, Floats]:
    """Return coordinates and rates of states as pairs, each of shape (t, count, 2)."""
    q, v = np.zeros((len(states), count, 2)), np.zeros((len(states), count, 2))
    for s, state in enumerate(states):
        for i in range(count):
            q[s, i], v[s, i] = pair(state.q[i], 0), pair(state.v[i], 0)
    return q, v


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
        """Return times between 0 and `end`, or over one period, between which no direction turns by half a turn.

        They serve to count the turns of an angle, of a motion that turns a direction and does not know by how much.
        """
        raise AssertionError(f"nothing turns a direction in {self.name}, or it is known how far")

    def angles_turned(self, times: Sequence[Ball]) -> list[Ball] | None:
        """Return by how much two coordinates on a circle have turned since the start (rad), None where it is not known.

        The first turns towards the second, the one of the smaller number.
        """
        return None

    @property
    def period(self) -> Ball | None:
        """The period in seconds, where there is one: it repeats, up to a turn about the vertical and what moves on."""

    @property
    def moves(self) -> bool:
        """Whether anything moves."""
        return True

    @property
    def uniform(self) -> bool:
        """Whether every acceleration is constant."""
        return False

    @property
    def winding(self) -> float:
        """Angle by which a period turns it about the vertical (rad)."""
        return 0.0

    @property
    def winding_error(self) -> float:
        """Error of that angle (rad)."""
        return 0.0

    @property
    def moved_on(self) -> Sequence[Ball]:
        """By how much a period moves each of its coordinates on; empty where all of them return."""
        return ()

    @property
    def winds_on(self) -> bool:
        """Whether some coordinates have other values after a period, as angles of what turns over do."""
        return False

    @property
    def modes(self) -> tuple[Mode, ...]:
        """The modes of a linear motion, slowest first."""
        return ()

    @property
    def has_finer_run(self) -> bool:
        """Whether there is a run in pairs of doubles beside the one in doubles."""
        return False

    @property
    def lost_to_doubles(self) -> bool:
        """Whether it is answered by pairs of doubles in any case."""
        return False

    def keep_to_pairs(self) -> None:
        """Have it answered by pairs of doubles, where there is a choice."""
        return None

    @property
    def in_arrays(self) -> tuple[Packed, Units] | None:
        """Its table and units for compiled code, where it is integrated."""
        return None

    def steps_about(
        self, times: Floats, reach: Floats, kind: str, order: int
    ) -> tuple[tuple[Floats, Floats], Floats, Floats] | None:
        """Return the polynomials of its own steps about times of shape (p,) in SI units, of one kind of run.

        Lengths of pieces, which are powers of two and no longer than a reach (s) needs, and how long they could be;
        coefficients of powers of time as a share of the length, shape (p, n, order + 1, 2); the largest one of the same
        unit and power. None where the Taylor series of its equations is as good.
        """
        return None

    @property
    def is_faster_in_doubles(self) -> bool:
        """Whether a closed form is evaluated faster to a few roundings of doubles."""
        return False

    def in_doubles(self, times: Floats) -> tuple[Floats, Floats] | None:
        """Return coordinates and rates at times of shape (t,), each of shape (t, n); None where doubles do not do.

        They are known to a few roundings: enough to see about when something changes its sign.
        """
        return None

    def in_balls(self, times: Sequence[Ball]) -> list[BallState] | None:
        """Return the states by a closed form at the present precision; None where there is none.

        Raises
        ------
        Undetermined
            Where the precision does not suffice.
        """
        return None

    def by(self, kind: str, times: Floats) -> tuple[Floats, Floats]:
        """Return coordinates and rates in pairs, each of shape (t, n, 2), by one of two computations.

        Parameters
        ----------
        kind : {"fine", "check", "reference", "doubles"}
            A closed form has the first alone; what is known from steps of a period has a coarser one beside it.
        """
        found = self.states(times)
        if kind in ("fine", "reference") or found.reference is None:
            return found.q, found.v
        return found.reference

    def places_in_doubles(self, times: Floats) -> Floats:
        """Return coordinates at times of one sign, shape (t, n), to a few roundings of doubles."""
        found: Floats = self.states(times).q[..., 0]
        return found

    def elementary(self) -> list[list[ElementaryTerm]] | None:
        """Return the coordinates as sums of elementary functions of the time, None where they are none."""
        return None

    def keeps_positive(self, length: Poly) -> bool:
        """Return whether a length that is positive at the start is so for all time, or its zero is where it ends."""
        return False

    def ended(self, end: float) -> tuple[float, float] | None:
        """Return the time before `end` from which on it cannot be followed, and its error (s); None without one."""
        return None

    def lost_in(self, end: float) -> str:
        """Return why it is not known how it goes on where it ends before a time, empty where it is singular there."""
        return ""


@dataclass(frozen=True)
class Rest(Motion):
    """Nothing moves: the start is an equilibrium and there is no velocity."""

    table: Table
    name: str = "rest"
    why: str = "nothing moves at the start, and no force is left over"
    how: str = "closed form"
    period: Ball | None = None
    moves: bool = False
    uniform: bool = True

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the start at every time."""
        q = np.array([pair(x, 0) for x in self.table.q]).reshape(-1, 2)
        shape = (len(times), len(q), 2)
        zero = np.zeros(shape[:2])
        return States(np.broadcast_to(q, shape).copy(), np.zeros(shape), zero, zero)

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the start at every time."""
        return [BallState(self.table.q, self.table.v)] * len(times)

    def angles_turned(self, times: Sequence[Ball]) -> list[Ball]:
        """Return zero: a rod that hangs at rest has a direction that does not turn."""
        return [ZERO] * len(times)
