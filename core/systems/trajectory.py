"""What a solved motion is: samples, the model that gave them, how right they are and what they cost."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Literal

import numpy as np

from core.arrays import Floats, Integers, largest, largest_magnitude, row_lengths
from core.notices import Notice
from core.quantities import Duration
from core.systems.system import Model

How = Literal["closed form", "measured against closed form", "measured against pairs", "estimate (finer run)"]
"""What a statement of error rests on: a bound; a difference with a bound added; the difference from a run in pairs of
doubles; an estimate, which may be too small."""

HORIZON = "horizon"
"""What ends a motion that no event ends."""


@dataclass(frozen=True, eq=False)
class Column:
    """One quantity at every time.

    Attributes
    ----------
    values : ndarray, shape (n,) or (n, k)
    unit : str
    error : float
        Largest error of any sample, in the unit of the column: of a vector its length, of several quantities that
        share a column that of any of them.
    how : str
        What the error rests on.
    inherited : float or None
        Largest change of any sample by the uncertainty of the inputs, to first order; None where it is not known.
    scale : float or None
        What the error is relative to; None for the largest magnitude of a sample.
    """

    values: Floats
    unit: str
    error: float
    how: How
    inherited: float | None = None
    scale: float | None = None

    @cached_property
    def largest(self) -> float:
        """Largest magnitude of a sample."""
        greatest = largest_magnitude(self.values)
        if self.values.ndim == 1:
            return greatest
        # In a power of two as unit, so that no square overflows.
        _, exponent = math.frexp(greatest)
        size = row_lengths(np.ldexp(self.values, -exponent))
        return largest(size) * 2.0 ** (exponent - 1) * 2.0


@dataclass(frozen=True)
class Accuracy:
    """How right an answer is.

    Errors of a state are relative to its largest norm in the whole motion. Not of the samples: the whole motion's norm
    does not depend on the times of the question, and closed forms, methods and inherited errors share it. Where there
    is no closed form it is the largest norm known, of the start and the samples. Where the columns have scales of their
    own, the error is the largest of any column relative to its scale.

    Attributes
    ----------
    requested : float
        Largest error of any sample that the client tolerates.
    error : float
        Largest numerical error of any sample, inputs taken as exact; never smaller than the true one, unless it is an
        estimate.
    final_error : float or None
        The same at the time farthest from the start.
    how : str
        What the figure rests on.
    inherited : float or None
        Error propagated from the input uncertainty, half an ulp of every input unless stated: a bound of the change of
        any sample. None where nothing is known of the phase, or nothing of how inputs act.
    largest_norm : float or None
        The norm that errors are relative to, in the unit of the state; None where every column has a scale of its own.
    drifts : mapping of str to float
        Largest relative change of each conserved quantity. A drift is not an error: it can be 1e-15 while the phase
        is wrong altogether.
    horizon : float or None
        Time until which the inherited error stays below the accuracy (s); None where it does all the time, or where
        that is not known.
    why : str or None
        Why the inherited error or the horizon is not known, where it was requested.
    """

    requested: float
    error: float
    how: How
    final_error: float | None = None
    inherited: float | None = None
    drifts: Mapping[str, float] = field(default_factory=dict)
    largest_norm: float | None = None
    horizon: float | None = None
    why: str | None = None


@dataclass(frozen=True)
class Work:
    """What an answer cost, counted and therefore the same on every machine.

    Attributes
    ----------
    samples : int
        Rows of the answer.
    evaluations : int
        Of the equation of motion, or of the flows of its parts.
    steps, rejected_steps : int
        Steps accepted by the method, and steps rejected. Of a method with a fixed step, those of its grid.
    evaluations_for_error : int
        Spent on estimating the error, in addition to those for the samples.
    step : float or None
        Length of the steps from t = 0 (s), None for methods that choose them and for closed forms.
    """

    samples: int
    evaluations: int = 0
    steps: int = 0
    rejected_steps: int = 0
    evaluations_for_error: int = 0
    step: Duration | None = None


@dataclass(frozen=True)
class ImpactErrors:
    """Errors of an impact: of every impulse (N s, of a stop N m s) and of the energy loss (J).

    None where contacts could share the impact otherwise.
    """

    impulses: Mapping[str, float | None] = field(default_factory=dict)
    energy_loss: float | None = 0.0


@dataclass(frozen=True)
class ImpactRates:
    """The rate along which an impulse acts, before and after an impact (m/s, of a stop rad/s).

    Attributes
    ----------
    before, after, error : float
        The error is of both.
    """

    before: float
    after: float
    error: float


@dataclass(frozen=True)
class MotionEvent:
    """Something that happens in a motion.

    Attributes
    ----------
    kind : str
        Of a described scene "touch", "lift-off", "slip", "stick", "roll", "settle" (bounces end), "taut", "slack",
        "stop", "release", "end-of-chain", "singular", "switch" (a formula changes its piece), "begin" and "end" of what
        acts for a time, "impulse", or the code of a problem; of a named scene as it declares.
    name : str
        Of the connection to which it happens; "" where several make a place singular, and where the kind says it.
    time : float
        From the start (s).
    error : float
        Of the time (s).
    impulses : mapping of str to float
        Of an impact: "normal" and "friction" (N s). Of a blow its components; of that and of what begins, what
        connections take, by the names of their forces.
    energy_loss : float
        Of an impact, by this connection (J); of several at one time they add up to what is lost.
    errors : ImpactErrors
        Of impulses and energy loss.
    rates : mapping of str to ImpactRates
        Of an impact, by the names of the impulses: of the gap, below zero where it closes, and of the slip.
    """

    kind: str
    name: str
    time: float
    error: float
    impulses: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    energy_loss: float = 0.0
    errors: ImpactErrors = field(default_factory=ImpactErrors)
    rates: Mapping[str, ImpactRates] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Samples of a motion.

    Attributes
    ----------
    time : ndarray, shape (n,)
        In the order of the question, without those that the motion does not reach (s).
    columns : mapping of str to Column
    accuracy : Accuracy
    model : Model or None
        None where the parts of a scene have models of their own.
    method : str
        Kind of the method that made it.
    work : Work
    period : float or None
        Of the state (s).
    ended : str
        `HORIZON`, or the event that ended the motion before it.
    rows : ndarray of int, shape (n,), or None
        Which of the times of the question these are; None for all.
    events : sequence of MotionEvent
        What happens in the motion up to the last of the times.
    warnings : tuple of Notice
        What the reader of the samples should know.
    """

    time: Floats
    columns: Mapping[str, Column]
    accuracy: Accuracy
    model: Model | None
    method: str
    work: Work
    period: float | None = None
    ended: str = HORIZON
    rows: Integers | None = None
    events: Sequence[MotionEvent] = ()
    warnings: tuple[Notice, ...] = ()

    def __getitem__(self, name: str) -> Floats:
        """Return the samples of a column, or the times."""
        return self.time if name == "time" else self.columns[name].values

    @property
    def state(self) -> Floats:
        """Samples of the only column, shape (n, k)."""
        (only,) = self.columns.values()
        return only.values
