"""What a solved motion is: samples, the model that gave them, how right they are and what they cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from core.notices import Notice
from core.quantities import Duration
from core.systems.system import Floats, Model

How = Literal["closed form", "measured against closed form", "estimate (finer run)"]
"""What a statement of error rests on: a bound, a difference with a bound added, an estimate that may be too small."""


@dataclass(frozen=True)
class Accuracy:
    """How right an answer is; every error is relative to the largest norm of the state in the whole motion.

    Not of the samples: the whole motion's norm does not depend on the times asked for, and closed forms, methods and
    inherited errors share it. Where there is no closed form it is the largest norm known, of the start and the samples.

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
    """

    requested: float
    error: float
    how: How
    final_error: float | None = None
    inherited: float | None = None
    drifts: Mapping[str, float] = field(default_factory=dict)
    largest_norm: float | None = None


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
        Taken by the method, and tried in vain beside them. Of a method with a fixed step, those of its grid.
    evaluations_for_error : int
        Spent on stating the error, beside those that made the samples.
    step : float or None
        Length of the steps from t = 0 (s), None for methods that choose them and for closed forms.
    """

    samples: int
    evaluations: int = 0
    steps: int = 0
    rejected_steps: int = 0
    evaluations_for_error: int = 0
    step: Duration | None = None


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Samples of a motion.

    Attributes
    ----------
    time : ndarray, shape (n,)
        In the order that was asked for (s).
    state : ndarray, shape (n, k)
        One row per time.
    method : str
        Kind of the method that made it.
    ended : str
        ``"horizon"``, or the event that ended the motion before it.
    warnings : tuple of Notice
        What the reader of the samples should know.
    """

    time: Floats
    state: Floats
    model: Model
    method: str
    accuracy: Accuracy
    work: Work
    period: float | None = None
    ended: str = "horizon"
    warnings: tuple[Notice, ...] = ()
