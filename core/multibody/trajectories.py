"""The motion of a scene at many times: by the models of its parts, or by a method that the client names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.errors import AccuracyUnreachable, MechanicsError, NotApplicable
from core.multibody.along import Along
from core.multibody.answer import Column, Extremes, How, Occurrence, SceneAccuracy, SceneEvent, SceneTrajectory
from core.multibody.columns import Columns, apart, relative, worst
from core.multibody.events import first_event
from core.multibody.generic_equation import SceneSystem
from core.multibody.inherited import Derived, changes, horizon, looks
from core.multibody.language import Scene
from core.multibody.modelling import Modelled
from core.multibody.numerical import Numerical
from core.multibody.occurrences import (
    ExtremesOf,
    Sampler,
    When,
    component,
    extremes,
    occurrences,
    unknown,
)
from core.multibody.packed import Floats
from core.multibody.shortened import shortened
from core.multibody.whole import Whole, WholeStates
from core.notices import Notice
from core.systems.budget import Budget
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod
from core.systems.rounding import Digits
from core.systems.solve import inside_field
from core.systems.trajectory import Work

_HOLDS = 1e-8
"""Relative mismatch of a measure above which it is not held."""

SHARE = 0.1
"""Share of a method's error that the error of what it is measured against may have, before that is made finer."""

LOST = 1e-3
"""A motion that is known no better than this measures nothing."""


_GROUPS = ("trajectory", "forces-in-time", "energy-in-time", "momenta-in-time")
"""Outputs that are columns of the state, in the order in which they are answered."""


@dataclass(frozen=True)
class AskedMotion:
    """What is asked about a motion; the attributes are the parameters of `core.multibody.solve.solve_scene`."""

    times: Floats
    outputs: Sequence[str | When | ExtremesOf]
    accuracy: float
    method: AbstractMethod | None
    input_uncertainty: float | None
    digits: Digits | None
    budget: Budget


@dataclass(frozen=True)
class Searched:
    """What was searched for along the motion; None where nothing was."""

    occurrences: tuple[Occurrence, ...] | None = None
    extremes: tuple[Extremes, ...] | None = None


def trajectory_of(
    scene: Scene, found: Modelled, determined: Sequence[bool], asked: AskedMotion
) -> tuple[SceneTrajectory, tuple[SceneEvent, ...], Searched]:
    """Return the samples up to the events that end the motion, these events, and what was searched for.

    Parameters
    ----------
    determined : sequence of bool
        Which of the forces the scene determines.

    Raises
    ------
    AccuracyUnreachable, NotApplicable, BudgetExceeded, InvalidParameter
        As `core.multibody.solve.solve_scene`.
    """
    method = asked.method
    work = None
    # What leaves the range of doubles is refused.
    with np.errstate(over="ignore", invalid="ignore"):
        rows, events = _until(found.whole, determined, asked.times)
        sampling = _Sampling(found.whole, determined, asked.times[rows], asked.outputs)
        times = sampling.times
        if method is None:
            columns = sampling.answered(asked.accuracy)
        elif isinstance(method, ClosedFormEvaluation):
            columns, work = sampling.exact(asked.accuracy), Work(len(times))
        elif sampling.follows:
            raise NotApplicable(
                "what is summed up or searched along the way is told of the motion itself, not of a method",
                path=("method",),
                remedy="leave the method out",
            )
        else:
            with inside_field("method"):
                states, work = _integrated(found.whole, times, method, asked.budget)
            columns = sampling.measured(states)
        searched = sampling.searched(
            min((event.time for event in events if event.time >= 0.0), default=np.inf), asked.times
        )
        stated = SceneAccuracy(asked.accuracy, worst(columns), sampling.how(method))
        if asked.input_uncertainty is not None and len(times):
            follow = sampling.following
            columns, stated = _with_inherited(scene, found, times, columns, stated, asked.input_uncertainty, follow)
    warnings = () if method is None else _warnings(stated, method)
    kind = None if method is None else method.kind
    trajectory = SceneTrajectory(times, rows, columns, stated, kind, work, warnings)
    return trajectory if asked.digits is None else shortened(trajectory, asked.digits), events, searched


def _with_inherited(
    scene: Scene,
    found: Modelled,
    times: Floats,
    columns: dict[str, Column],
    stated: SceneAccuracy,
    uncertainty: float,
    follow: Derived,
) -> tuple[dict[str, Column], SceneAccuracy]:
    """Add what the uncertainty of the inputs does, or why that is not known."""
    try:
        known = changes(scene, found, np.concatenate([times, looks(times)]), follow)
        moved = known.of_columns(np.arange(len(times)))
    except MechanicsError as fault:
        return columns, replace(stated, why=fault.detail)
    own = {name: column for name, column in columns.items() if name in moved}
    if not own:
        return columns, replace(
            stated, why="it is not propagated to what is summed up along the motion, and there is nothing else"
        )
    moved = {name: moved[name] for name in own}
    share = uncertainty * relative(moved, own)
    until = horizon(known, len(times), stated.requested / uncertainty, own) if uncertainty else None
    why = None if until is not None else "the change stays below the accuracy at all of the times"
    if not share < 1.0:
        return columns, replace(stated, horizon=until, why="nothing is known of the motion at the latest times")
    with_own = {name: replace(column, inherited=uncertainty * moved[name]) for name, column in own.items()}
    return columns | with_own, replace(stated, inherited=share, horizon=until, why=why)


def _until(whole: Whole, determined: Sequence[bool], times: Floats) -> tuple[np.ndarray, tuple[SceneEvent, ...]]:
    """Return the rows of the times that the motion reaches, and the events that end it."""
    events: list[SceneEvent] = []
    rows = np.arange(len(times))
    watched = [limit for limit in whole.measures.limits if limit.force is None or determined[limit.force]]
    for end in {max(float(np.max(times)), 0.0), min(float(np.min(times)), 0.0)} - {0.0}:
        event = first_event(whole, watched, end)
        if event is not None:
            events.append(event)
            beyond = times[rows] > event.time if end > 0.0 else times[rows] < event.time
            rows = rows[~beyond]
    return rows, tuple(sorted(events, key=lambda event: event.time))


class _Sampling:
    """What is answered of a motion at some times."""

    def __init__(
        self, whole: Whole, determined: Sequence[bool], times: Floats, outputs: Sequence[str | When | ExtremesOf]
    ) -> None:
        self.whole, self.determined, self.times, self.outputs = whole, determined, times, outputs
        self.finer = False
        self.numerical = any(isinstance(motion, Numerical) for _, motion in whole.parts)
        self.closed = all(motion.how == "closed form" for _, motion in whole.parts)

    def how(self, method: AbstractMethod | None) -> How:
        """Return how errors are known."""
        if not self.closed:
            return "measured against pairs"
        own = method is None or isinstance(method, ClosedFormEvaluation)
        return "closed form" if own else "measured against closed form"

    def exact(self, accuracy: float) -> dict[str, Column]:
        """Return the columns of a motion in closed form."""
        if not self.closed:
            raise NotApplicable(
                "this scene has no closed form",
                path=("method", "kind"),
                remedy="leave the method out, and the smallest model that suffices answers",
            )
        return self.answered(accuracy)

    def answered(self, accuracy: float) -> dict[str, Column]:
        """Return the columns of the motion itself, by pairs of doubles where doubles do not reach the accuracy."""
        columns = self.columns(finer=False)
        if self.numerical and worst(columns) > accuracy:
            self.finer = True
            columns = self.columns(finer=True)
        columns |= self.along()
        _require_known(columns)
        reached = worst(columns)
        if reached > accuracy:
            raise AccuracyUnreachable(
                accuracy,
                reached,
                "the motion amplifies rounding, even that of pairs of doubles",
                remedy="ask for a shorter time or a larger accuracy",
            )
        return columns

    def columns(self, *, finer: bool) -> dict[str, Column]:
        """Return the columns of the motion itself, with their errors."""
        states = self.whole.states(self.times, finer=finer)
        if self.whole.dropped and self.whole.misfit(states.q) > _HOLDS:
            raise NotApplicable(
                "connections that depend on one another at the start do not do so later: the start is a singular place",
                path=("connections",),
                remedy="start elsewhere",
            )
        return self.columns_of(states, self.how(None))

    def columns_of(self, states: WholeStates, how: How) -> dict[str, Column]:
        """Return the columns of any states."""
        columns = Columns(self.whole, self.times, states, how)
        found: dict[str, Column] = {}
        for group in _GROUPS:
            if group in self.outputs and (len(self.times) or group != "forces-in-time"):
                found.update(self._group(columns, group))
        return found

    @property
    def follows(self) -> bool:
        """Whether something is asked that needs the motion between the samples."""
        return any(
            output in ("work-in-time", "paths-in-time") or not isinstance(output, str) for output in self.outputs
        )

    def along(self) -> dict[str, Column]:
        """Return the columns that are summed up along the motion."""
        sums = Along(self.whole, self.times, self.how(None), finer=self.finer)
        found = sums.works() if "work-in-time" in self.outputs else {}
        return found | sums.paths() if "paths-in-time" in self.outputs else found

    def searched(self, ended: float, times: Floats) -> Searched:
        """Return when quantities take values and how large they become, between the start and the latest time."""
        if all(isinstance(output, str) for output in self.outputs):
            return Searched()
        end = min(ended, float(np.max(times)))
        times_found: list[Occurrence] = []
        ranges: list[Extremes] = []
        for index, output in enumerate(self.outputs):
            if isinstance(output, When):
                times_found.extend(occurrences(self.whole, self._sampler(output, index), output, end))
            elif isinstance(output, ExtremesOf):
                ranges.append(extremes(self.whole, self._sampler(output, index), output.quantity, end))
        return Searched(tuple(times_found), tuple(ranges))

    def _sampler(self, asked: When | ExtremesOf, index: int) -> Sampler:
        """Return the samples of a quantity, from the columns among which it is."""

        def of(group: str, times: Floats) -> dict[str, Column]:
            states = self.whole.states(times, finer=self.finer)
            return self._group(Columns(self.whole, times, states, self.how(None)), group)

        known: list[str] = []
        for group in _GROUPS:
            columns = of(group, np.zeros(1))
            known.extend(columns)
            if component(columns, asked.quantity) is not None:

                def sampled(times: Floats, group: str = group) -> Column:
                    found = component(of(group, np.asarray(times, dtype=np.float64)), asked.quantity)
                    assert found is not None
                    return found

                return sampled
        raise unknown(asked, index, known)

    def _group(self, columns: Columns, group: str) -> dict[str, Column]:
        if group == "trajectory":
            return columns.trajectory()
        if group == "energy-in-time":
            return columns.energy()
        if group == "momenta-in-time":
            return columns.momenta()
        forces = columns.whole.measures.forces
        return columns.forces([f for f, known in zip(forces, self.determined, strict=True) if known])

    def following(self, whole: Whole, times: Floats, states: WholeStates) -> dict[str, Column]:
        """Return the columns that were asked for and that follow from the states of a scene like this one."""
        columns = Columns(whole, times, states, "closed form")
        found: dict[str, Column] = {}
        for group in _GROUPS[1:]:
            if group in self.outputs:
                found.update(self._group(columns, group))
        return found

    def measured(self, states: WholeStates) -> dict[str, Column]:
        """Return the columns of states that a method computed, their errors measured against the motion itself."""
        how: How = "measured against closed form" if self.closed else "measured against pairs"
        own = self.columns_of(states, how)
        _require_known(own)
        finer = False
        while True:
            right = self.columns(finer=finer)
            _require_known(right)
            known = worst(right)
            found = {name: replace(one, error=apart(one, right[name]) + right[name].error) for name, one in own.items()}
            if finer or not self.numerical or known <= SHARE * worst(found):
                break
            finer = True
        if known > LOST:
            raise AccuracyUnreachable(
                None,
                known,
                "the motion amplifies rounding, even that of pairs of doubles, and nothing is left to measure against",
                path=("times",),
                remedy="ask for a shorter time",
            )
        return found


def _integrated(whole: Whole, times: Floats, method: AbstractMethod, budget: Budget) -> tuple[WholeStates, Work]:
    """Return the states that a method computes, and what they cost."""
    system = SceneSystem(whole)
    if not len(times) or not len(system.initial_state):
        at_rest = np.zeros((len(times), len(whole.reduced.table.names)))
        return whole.states_at(at_rest, at_rest), Work(len(times))
    found = method.integrate(system, times, budget)
    return whole.states_at(*system.places_and_rates(found.states)), found.work


def _require_known(columns: Mapping[str, Column]) -> None:
    lost = [name for name, one in columns.items() if not (np.isfinite(one.values).all() and np.isfinite(one.error))]
    if lost:
        raise NotApplicable(
            f"{lost[0]} or its error leaves the range of doubles",
            path=("times",),
            remedy="ask for a shorter time, or choose units in which the numbers are moderate",
        )


def _warnings(stated: SceneAccuracy, method: AbstractMethod) -> tuple[Notice, ...]:
    if stated.error <= stated.requested:
        return ()
    detail = (
        f"the error of {method.kind} with this setting is {stated.error:.3g}, where {stated.requested:.3g} was asked "
        "for; leave out the method to have the motion to that accuracy"
    )
    return (Notice("accuracy-not-reached", detail, ("method",)),)
