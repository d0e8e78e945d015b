"""Samples of a named scene's motion: by its closed form, or by a method whose errors are measured against that."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats, Integers
from core.balls import precision
from core.errors import InvalidParameter, NotApplicable, inside_field
from core.scenes.enclosure import BITS
from core.scenes.equation import SceneEquation
from core.scenes.motion import NamedSceneMotion, finite
from core.systems.budget import Budget
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod
from core.systems.question import MotionQuestion
from core.systems.trajectory import Accuracy, Column, How, MotionEvent, Trajectory, Work

_NOT_KNOWN = "what the uncertainty of the inputs does is not followed in this scene"


def sampled(
    motion: NamedSceneMotion,
    question: MotionQuestion,
    units: Mapping[str, str],
    ended: str,
    events: Sequence[MotionEvent],
) -> Trajectory:
    """Return the samples that exist.

    Parameters
    ----------
    motion : NamedSceneMotion
    question : MotionQuestion
    units : mapping of str to str
        Of the columns.
    ended : str
        The horizon, or the event that ended the motion before it.
    events : sequence of MotionEvent
        What happens up to the last of the times.

    Raises
    ------
    InvalidParameter
        For times before the beginning, and for a method that fails with its setting.
    BudgetExceeded, NotApplicable
        As `core.systems.methods.method.AbstractMethod.integrate`, and if an event interrupts what a method is to do.
    """
    rows = _existing(motion, question.times)
    times = question.times[rows]
    samples = motion.sample(times)
    columns, work, how = samples.columns(units), Work(times.size), _how(question)
    if question.integrator is not None and times.size:
        columns, work = _integrated(motion, columns, times, question.integrator, question.budget)
    error = max((_relative(column.error, column.scale or 0.0) for column in columns.values()), default=0.0)
    why = None if question.input_uncertainty is None else _NOT_KNOWN
    return Trajectory(
        times,
        columns,
        Accuracy(question.accuracy, error, how, why=why),
        motion.model,
        (question.method or ClosedFormEvaluation()).kind,
        work,
        ended=ended,
        rows=rows,
        events=events,
        warnings=samples.notices,
    )


@dataclass(frozen=True, eq=False)
class ComparableEquation(SceneEquation):
    """The equation of a motion, and the motion itself, to which methods are compared."""

    motion: NamedSceneMotion

    @classmethod
    def of(cls, motion: NamedSceneMotion) -> ComparableEquation:
        """Return the equation of a motion; raises `NotApplicable` if something happens that it does not describe."""
        with precision(BITS):
            return cls(motion.equation().coordinates, motion.model, motion)

    def reference(self, times: Floats) -> tuple[str, Floats, float]:
        """Return how the motion is known, its states at times of shape (t,), and their largest error as a norm.

        Raises
        ------
        InvalidParameter
            For times before the beginning.
        NotApplicable
            If the motion ends before the last time.
        """
        with precision(BITS):
            if len(_existing(self.motion, times)) < times.size:
                raise NotApplicable(
                    "the motion ends before the last of the times",
                    path=("times",),
                    remedy="ask for times before the event that ends it",
                )
            samples = self.motion.sample(times)
            errors = {
                name: np.broadcast_to(samples.errors[name], values.shape) for name, values in samples.values.items()
            }
            wrong = np.linalg.norm(self.motion.states(errors), axis=1)
            return "closed form", self.motion.states(samples.values), float(np.max(wrong, initial=0.0))


def _how(question: MotionQuestion) -> How:
    return "closed form" if question.integrator is None else "measured against closed form"


def _integrated(
    motion: NamedSceneMotion, right: Mapping[str, Column], times: Floats, method: AbstractMethod, budget: Budget
) -> tuple[dict[str, Column], Work]:
    """Return the columns that a method computes, their errors measured against the right ones, and its work."""
    equation = motion.equation()
    with inside_field("method"):
        run = method.integrate(equation, times, budget)
    with np.errstate(over="ignore", invalid="ignore"):
        values = finite(motion.observed(run.states))
    columns = {}
    for name, column in right.items():
        apart = float(np.max(np.abs(values[name] - column.values), initial=0.0))
        columns[name] = replace(
            column, values=values[name], error=apart + column.error, how="measured against closed form"
        )
    return columns, run.work


def _relative(error: float, scale: float) -> float:
    return error / scale if scale > 0.0 else 0.0 if error == 0.0 else math.inf


def _existing(motion: NamedSceneMotion, instants: Floats) -> Integers:
    """Return the rows of the instants at which there is a motion; samples past its end are not invented."""
    if float(np.min(instants, initial=0.0)) < motion.valid_from:
        raise InvalidParameter(
            "times",
            f"be at least {motion.valid_from:.17g} s",
            remedy="the model does not hold earlier; start from an earlier state",
        )
    return np.flatnonzero(instants <= (math.inf if motion.end is None else float(motion.end.time)))
