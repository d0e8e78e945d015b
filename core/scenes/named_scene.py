"""A named scene: parameters, figures that follow from them, and a motion in closed form.

The one way in which every scene is answered: only what is requested is computed.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, ClassVar, Literal, NamedTuple, get_type_hints

import numpy as np

from core.arrays import Floats
from core.balls import precision
from core.errors import AccuracyUnreachable, InvalidParameter, NotApplicable
from core.notices import Notice
from core.quantities import Tolerance, Unit, check_value
from core.scenes.enclosure import BITS, MORE_BITS, Ball, Rounding
from core.scenes.figures import MOTION, SceneEvent, SceneExample, marks_of, measured_names
from core.scenes.motion import Event, NamedSceneMotion
from core.scenes.motion_check import check_motion
from core.scenes.sampled_motion import sampled
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.question import MotionQuestion
from core.systems.rounding import Digits
from core.systems.solve import as_requested, check_without_times, checked_times
from core.systems.system import Model
from core.systems.trajectory import HORIZON, Accuracy, Trajectory, Work
from core.work import spend

WORK_OF_A_SCENE = 100
"""Units of work (`core.work`): the set-up of a scene and of its motion in balls, at one precision."""


@dataclass(frozen=True, eq=False)
class NamedSceneSolution:
    """Answer to a question about a scene.

    Attributes
    ----------
    model : Model
        The smallest model that suffices for the question.
    figures : mapping
        The requested outputs by name: numbers, lists, mappings, None where a double cannot hold the number.
    errors : mapping
        Bounds of the errors of those that are numbers or lists of them; mappings hold their own.
    trajectory : Trajectory or None
    ended : str or None
        `HORIZON`, or the event that ended the motion before it; None if nothing ends it or no motion was requested.
    accuracy : Accuracy
        Bound of the error: of figures relative to themselves, of samples to the scale of their column.
    notices : tuple of Notice
        What the reader of the figures must know.
    work : Work
        Samples computed.
    """

    model: Model
    figures: Mapping[str, Any]
    errors: Mapping[str, float | list[float | None] | None]
    trajectory: Trajectory | None
    ended: str | None
    accuracy: Accuracy
    notices: tuple[Notice, ...]
    work: Work

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """What the reader must know."""
        return self.notices if self.trajectory is None else (*self.notices, *self.trajectory.warnings)


class Outline(NamedTuple):
    """What is computed of a scene beside its samples; see `NamedSceneSolution`. Events are those up to the horizon."""

    model: Model
    figures: Mapping[str, Any]
    motion: NamedSceneMotion | None
    ended: str | None
    events: list[Event]


@dataclass(frozen=True)
class NamedScene(ABC):
    """A member of the catalogue of scenes; a subclass is all that a scene is, and one file."""

    outputs: ClassVar[tuple[str, ...]]
    """Names of everything that can be requested: the fields of `figures_type`, and `MOTION`."""
    figures_type: ClassVar[type]
    """Dataclass, generic in the kind of number, that declares the figures: names, units, meanings."""
    samples_type: ClassVar[type]
    """Dataclass that declares the columns of the trajectory likewise, ``time`` first."""
    examples: ClassVar[Mapping[str, SceneExample]]
    """Questions, by a short name; the last is shown with certified digits too."""
    of_motion: ClassVar[tuple[str, ...]] = ()
    """Outputs that follow from the motion, beside `MOTION`."""
    functions: ClassVar[Literal["elementary", "elliptic"]] = "elementary"
    """What the motion is made of: samples with many digits are priced by it."""
    exact_defaults: ClassVar[Mapping[str, Fraction]] = {}
    """Defaults that are no doubles."""
    warming: ClassVar[tuple[Mapping[str, Any], ...]] = ()
    """Further questions, by which kernels are compiled that no example reaches."""

    @abstractmethod
    def figures(self) -> Mapping[str, Callable[[], Any]]:
        """Return the figures that need no motion, by name, each to be computed only when it is called."""

    @abstractmethod
    def motion(self, horizon: float) -> NamedSceneMotion:
        """Return the motion at least up to `horizon` (s)."""

    @abstractmethod
    def static_model(self) -> Model:
        """Return the model of a question that needs no motion."""

    @property
    def has_motion(self) -> bool:
        """Whether the parameters suffice for a motion; if not, what needs one is left out unless it is requested."""
        return True

    def motion_figures(self, motion: Any) -> Mapping[str, Callable[[], Any]]:
        """Return figures of the motion beside its events, by name."""
        return {}

    def notices(self, wanted: frozenset[str]) -> tuple[Notice, ...]:
        """Return what the reader of the wanted outputs must know."""
        return ()

    def inexact(self, motion: Any) -> NotApplicable | None:
        """Return why a motion has no proven digits: it takes something as zero that is not exactly zero."""
        return None

    @classmethod
    def units(cls) -> dict[str, str]:
        """Return the units of the columns."""
        hints = get_type_hints(cls.samples_type, include_extras=True)
        return {
            name: next(mark.unit for mark in marks_of(hint) if isinstance(mark, Unit)) for name, hint in hints.items()
        }

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        """Return samples up to the end of the motion; see `core.systems.question.System`.

        Raises
        ------
        NotApplicable
            For a method that steps, where an event interrupts the motion.
        """
        found = self._answered(question, frozenset({"trajectory"}), question.accuracy).trajectory
        assert found is not None
        return found

    def motion_to(self, horizon: float) -> NamedSceneMotion:
        """Return the motion at least up to `horizon` (s), at the precision that answers in doubles begin with."""
        with precision(BITS):
            return self.motion(horizon)

    def answer(
        self,
        times: Floats | None = None,
        outputs: frozenset[str] | None = None,
        accuracy: float = 1e-9,
        digits: Digits | None = None,
        *,
        method: AbstractMethod | None = None,
        budget: Budget | None = None,
    ) -> NamedSceneSolution:
        """Compute what is requested and nothing else.

        Parameters
        ----------
        times : ndarray, shape (n,), optional
            Instants of the trajectory, measured from the given state, in any order (s).
        outputs : frozenset of str, optional
            Names out of `outputs`; by default all, the trajectory if there are times.
        accuracy : float
            Largest error that is tolerated.
        digits : int or "meaningful", optional
            Of the samples.
        method : AbstractMethod, optional
            Computes the samples in place of the closed form, from which their errors are measured; they are answered
            whatever those are, with a warning where they are larger than the accuracy. Events are those of the motion
            itself.
        budget : Budget, optional
            Samples, and evaluations that the method may spend.

        Raises
        ------
        InvalidParameter
            For an unknown output; a trajectory, a method or digits without times; times that are not finite or before
            the beginning; a method that fails with its setting.
        AccuracyUnreachable
            If the bound of the error is larger than `accuracy`.
        BudgetExceeded
            For more samples or evaluations than are allowed.
        NotApplicable
            If the method needs what the scene does not have, or an event interrupts the motion.
        SelfCheckFailed
            If the motion that was found does not keep its equation: see `core.scenes.motion_check`.
        """
        check_value("accuracy", Tolerance, accuracy)
        wanted = self.wanted(outputs, timed=times is not None)
        budget = budget or Budget()
        question = None
        if times is None:
            check_without_times(method=method, round=digits)
        else:
            question = MotionQuestion(checked_times(times, budget), accuracy, method, budget=budget)
        found = self._answered(question, wanted, accuracy)
        if question is None or found.trajectory is None:
            return found
        samples = as_requested(replace(found.trajectory, accuracy=found.accuracy), question, digits)
        return replace(found, trajectory=samples, accuracy=samples.accuracy)

    def _answered(self, question: MotionQuestion | None, wanted: frozenset[str], accuracy: float) -> NamedSceneSolution:
        with precision(BITS):
            found, sharp = self._computed(question, wanted, accuracy)
        if not sharp:
            # What was computed so far is cached with the object, so a new one starts again.
            with precision(MORE_BITS):
                found, _ = replace(self)._computed(question, wanted, accuracy)
        # What a method makes of the samples is answered whatever its error; the figures are not its.
        samples = found.trajectory
        accepted = 0.0 if samples is None or samples.accuracy.how == "closed form" else samples.accuracy.error
        if found.accuracy.error > max(accuracy, accepted):
            raise AccuracyUnreachable(
                accuracy,
                found.accuracy.error,
                "the samples are differences of far larger numbers",
                remedy="ask for fewer digits",
            )
        return found

    def _computed(
        self, question: MotionQuestion | None, wanted: frozenset[str], accuracy: float
    ) -> tuple[NamedSceneSolution, bool]:
        """Return the answer at the present precision, and whether that precision was enough."""
        spend(WORK_OF_A_SCENE)
        horizon = math.inf if question is None else max(0.0, float(np.max(question.times)))
        rounded = Rounding(measured_names(self.figures_type) | measured_names(SceneEvent))
        found = self.outline(wanted, horizon, lambda time: float(time) <= horizon, rounded)
        trajectory = None
        if found.motion is not None and question is not None and "trajectory" in wanted:
            events = [event.in_doubles() for event in found.events]
            trajectory = sampled(found.motion, question, self.units(), found.ended or HORIZON, events)
            if question.budget.audited:
                check_motion(found.motion, trajectory.time)
        bare = Accuracy(accuracy, 0.0, "closed form") if trajectory is None else trajectory.accuracy
        answer = NamedSceneSolution(
            model=found.model,
            figures=found.figures,
            errors=rounded.errors,
            trajectory=trajectory,
            ended=found.ended,
            accuracy=replace(bare, error=max(rounded.error, bare.error)),
            notices=(*rounded.notices, *self.notices(wanted)),
            work=Work(0) if trajectory is None else trajectory.work,
        )
        # A time that is a quotient by what may be zero is decided with more digits.
        decided = found.motion is None or all(event.time.is_finite() for event in found.motion.events())
        return answer, rounded.sharp and decided

    def outline(
        self, wanted: frozenset[str], horizon: float, happened: Callable[[Ball], bool], written: Callable[..., Any]
    ) -> Outline:
        """Return what is requested beside the samples, at the present precision.

        Parameters
        ----------
        horizon : float
            Up to which the motion is needed; infinite without one (s).
        happened : callable
            Whether a time is not beyond it.
        written : callable
            From a figure and its path to the same with numbers in place of balls.
        """
        table, events = dict(self.figures()), list[Event]()
        motion, ended = None, None
        if wanted & {*MOTION, *self.of_motion}:
            motion = self.motion(horizon)
            over = motion.end is not None and happened(motion.end.time)
            ended = motion.end.kind if over and motion.end else HORIZON if math.isfinite(horizon) else None
            events += [event for event in motion.events() if happened(event.time)]
            table |= self.motion_figures(motion)
            table["events"] = lambda: [{"kind": event.kind, "time": event.time} for event in events]
        figures = {name: written(table[name](), (name,)) for name in self.outputs if name in wanted and name in table}
        return Outline(self.static_model() if motion is None else motion.model, figures, motion, ended, events)

    def wanted(self, outputs: frozenset[str] | None, *, timed: bool) -> frozenset[str]:
        """Return the outputs that a question is about.

        Parameters
        ----------
        outputs : frozenset of str or None
            Those requested by name; None for all that can be given.
        timed : bool
            Whether the question has times, without which there is no trajectory.

        Raises
        ------
        InvalidParameter
            For an unknown output, or a trajectory without times.
        """
        if outputs is None:
            names = frozenset(self.outputs) - (frozenset() if timed else frozenset({"trajectory"}))
            return names if timed or self.has_motion else names - {*MOTION, *self.of_motion}
        for name in sorted(outputs - set(self.outputs)):
            raise InvalidParameter("outputs", f"name known outputs, not {name!r}", remedy=f"one of {self.outputs}")
        if "trajectory" in outputs and not timed:
            raise InvalidParameter("times", "be given when a trajectory is requested")
        return outputs
