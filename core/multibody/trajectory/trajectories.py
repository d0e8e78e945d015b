"""The motion of a described scene: by the models of its parts, or by a method that the client names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.arrays import Floats, Integers
from core.errors import AccuracyUnreachable, BudgetExceeded, MechanicsError, NotApplicable, inside_field
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.language.scene import Scene
from core.multibody.motion.generic_equation import SceneSystem
from core.multibody.motion.modelling import Modelled
from core.multibody.motion.numerical import BEFORE_SINGULAR
from core.multibody.motion.whole import Whole, WholeStates
from core.multibody.table.connection_effects import Limit
from core.multibody.trajectory.along import Along
from core.multibody.trajectory.column_errors import (
    FINEST,
    apart,
    require_known,
    require_reached,
    scaled,
    with_natural_sizes,
    worst,
)
from core.multibody.trajectory.columns import NEAREST, Columns
from core.multibody.trajectory.events import OF_LENGTHS, first_event
from core.multibody.trajectory.inherited import NO_HORIZON_NEEDED, changes, horizon, instants, with_inherited
from core.multibody.trajectory.nearest import Nearest
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.multibody.trajectory.smooth_search import SmoothSearch
from core.notices import Notice
from core.systems.budget import Budget
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod
from core.systems.question import MotionQuestion, System
from core.systems.rounding import Digits
from core.systems.solve import solve
from core.systems.trajectory import HORIZON, Accuracy, Column, How, MotionEvent, Trajectory, Work

_HOLDS = 1e-8
"""Relative mismatch of a measure above which it is not held."""

SHARE = 0.1
"""Share of a method's error that the error of what it is measured against may have, before that is made finer."""

LOST = 1e-3
"""A motion that is known no better than this measures nothing."""

MOST_NUMBERS = 5_000_000
"""Numbers that one trajectory may have."""

ONLY_SUMS = "it is not propagated to what is summed up along the motion, and there is nothing else"
"""Why nothing is inherited where only works and paths are answered."""

PLACES_AND_FORCES = ("trajectory", "forces-in-time")
"""Outputs that an audit compares."""

Output = str | When | ExtremesOf


def require_affordable(samples: int, coordinates: int) -> None:
    """Raise `BudgetExceeded` for more samples of so many coordinates than one trajectory may have."""
    most = MOST_NUMBERS // (4 * coordinates) if coordinates else samples
    if samples > most:
        raise BudgetExceeded("samples", samples, most, path=("times",), remedy="ask for fewer times")


@dataclass(frozen=True)
class SceneRequest:
    """What is requested of a scene; the attributes are the parameters of `core.multibody.solve.solve_scene`."""

    times: Floats
    outputs: Sequence[Output]
    accuracy: float
    method: AbstractMethod | None
    input_uncertainty: float | None
    digits: Digits | None
    budget: Budget

    def solved(self, system: System) -> Trajectory | None:
        """Return the trajectory of a system, None without times."""
        if not len(self.times):
            return None
        return solve(
            system,
            self.times,
            accuracy=self.accuracy,
            method=self.method,
            input_uncertainty=self.input_uncertainty,
            digits=self.digits,
            budget=self.budget,
        )


class DescribedSystem:
    """A described scene without contacts, as a system.

    Parameters
    ----------
    scene : Scene
    found : Modelled
        The models of its parts.
    determined : sequence of bool
        Which of the forces the scene determines.
    outputs : sequence of str, When and ExtremesOf
        Those of the motion are its columns.
    """

    def __init__(self, scene: Scene, found: Modelled, determined: Sequence[bool], outputs: Sequence[Output]) -> None:
        self.scene, self.found, self.whole = scene, found, found.whole
        self.determined, self.outputs = determined, outputs
        self.finer = False
        self.numerical = any(motion.has_finer_run for _, motion in self.whole.parts)
        self.closed = all(motion.how == "closed form" for _, motion in self.whole.parts)

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        """Return the samples up to the events that end the motion; see `core.systems.question.System`."""
        require_affordable(len(question.times), len(self.found.described.measures.table.names))
        # What leaves the range of doubles is refused.
        with np.errstate(over="ignore", invalid="ignore"):
            rows, events = self._until(question.times)
            times, method = question.times[rows], question.method
            work = Work(len(times))
            if question.integrator is None:
                if method is not None and not self.closed:
                    raise NotApplicable(
                        "this scene has no closed form",
                        path=("method", "kind"),
                        remedy="leave the method out, and the smallest model that suffices answers",
                    )
                columns, how = self._own(times, question.accuracy), self.how
            else:
                if self._follows:
                    raise NotApplicable(
                        "what is summed up or searched along the way belongs to the motion itself, not to a method",
                        path=("method",),
                        remedy="leave the method out",
                    )
                with inside_field("method"):
                    states, work = _integrated(self.whole, times, question.integrator, question.budget)
                how = "measured against closed form" if self.closed else "measured against pairs"
                columns = self._measured(times, states, how)
            stated = Accuracy(question.accuracy, worst(columns), how)
            if question.input_uncertainty is not None and len(times):
                columns, stated = self._with_inherited(times, columns, stated, question.input_uncertainty)
        return Trajectory(
            times,
            scaled(columns),
            stated,
            None,
            ClosedFormEvaluation().kind if method is None else method.kind,
            work,
            ended=next((event.kind for event in events if event.time >= 0.0), HORIZON),
            rows=rows,
            events=events,
            warnings=self._not_watched(),
        )

    @property
    def how(self) -> How:
        """How the errors of the motion itself are known."""
        return "closed form" if self.closed else "measured against pairs"

    def sampled(self, times: Floats) -> dict[str, Column]:
        """Return places, rates and forces at some times."""
        with np.errstate(over="ignore", invalid="ignore"):
            states = self.whole.states(times, finer=self.finer)
            return Columns(self.whole, times, states, self.how).chosen(PLACES_AND_FORCES, self.determined)

    def _until(self, times: Floats) -> tuple[Integers, tuple[MotionEvent, ...]]:
        """Return the rows of the times that the motion reaches, and the events that end it."""
        events: list[MotionEvent] = []
        rows = np.arange(len(times))
        watched = [limit for limit in self.whole.measures.limits if self._watches(limit)]
        for end in {max(float(np.max(times)), 0.0), min(float(np.min(times)), 0.0)} - {0.0}:
            event = first_event(self.whole, watched, end)
            if event is not None:
                events.append(event)
                beyond = times[rows] > event.time if end > 0.0 else times[rows] < event.time
                rows = rows[~beyond]
        return rows, tuple(sorted(events, key=lambda event: event.time))

    def ends_within(self, time: float) -> bool:
        """Return whether the motion ends before a time after the start, or whether it does is not known."""
        watched = [limit for limit in self.whole.measures.limits if self._watches(limit)]
        if not watched:
            return False
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                return first_event(self.whole, watched, time) is not None
        except MechanicsError:
            return True

    def _watches(self, limit: Limit) -> bool:
        return limit.force is None or self.determined[limit.force]

    def _not_watched(self) -> tuple[Notice, ...]:
        """Return that some forces might end the motion, and are not determined."""
        names = dict.fromkeys(limit.name for limit in self.whole.measures.limits if not self._watches(limit))
        if not names:
            return ()
        detail = f"whether {', '.join(names)} would have to push is not known: these forces are not determined"
        return (Notice("end-not-known", detail, ("connections",)),)

    def _own(self, times: Floats, accuracy: float) -> dict[str, Column]:
        """Return the columns of the motion itself, by pairs of doubles where doubles do not reach the accuracy."""
        columns = self._columns(times, finer=False)
        if worst(columns) > accuracy and self.numerical and accuracy >= FINEST:
            self.finer = True
            columns = self._columns(times, finer=True)
        if worst(columns) > accuracy and (accuracy < FINEST or self._is_known(times, accuracy)):
            self.finer = True
            columns = self._columns(times, finer=True, rounding=NEAREST)
        sums = Along(self.whole, times, self.how, finer=self.finer)
        columns |= sums.works() if "work-in-time" in self.outputs else {}
        columns |= sums.paths() if "paths-in-time" in self.outputs else {}
        lost = worst(columns) > accuracy
        require_reached(columns, accuracy, before=self._reached_until(times, accuracy) if lost else None)
        return columns

    def _reached_until(self, times: Floats, accuracy: float) -> float | None:
        """Return the time before which the accuracy is reached, None if that is at none of the times or of one sign."""
        order = np.argsort(np.abs(times))
        if len(times) < 2 or np.min(times) < 0.0:
            return None
        reached, lost = 0, len(times)
        while lost - reached > 1:
            middle = (reached + lost) // 2
            known = worst(self._columns(times[order[:middle]], finer=self.finer)) <= accuracy
            reached, lost = (middle, lost) if known else (reached, middle)
        return float(times[order[reached]]) if reached and times[order[reached - 1]] > 0.0 else None

    def _is_known(self, times: Floats, accuracy: float) -> bool:
        """Return whether the motion itself reaches an accuracy, so that only what doubles make of it does not.

        The force of a stiff spring is a small difference of lengths: doubles lose the digits that both share.
        """
        states = self.whole.states(times, finer=True)
        return worst(Columns(self.whole, times, states, self.how).trajectory()) <= max(accuracy, 2 * FINEST)

    def _columns(self, times: Floats, *, finer: bool, rounding: float = FINEST) -> dict[str, Column]:
        """Return the columns of the states of the motion itself, with their errors."""
        states = self.whole.states(times, finer=finer)
        if self.whole.dropped and self.whole.misfit(states.q) > _HOLDS:
            raise NotApplicable(
                "connections that depend on one another at the start do not do so later: the start is a singular place",
                path=("connections",),
                remedy="start elsewhere",
            )
        columns = Columns(self.whole, times, states, self.how, rounding)
        chosen = Nearest(columns).chosen if rounding == NEAREST else columns.chosen
        return with_natural_sizes(chosen(self.outputs, self.determined), times, self._columns_between)

    def _columns_between(self, times: Floats) -> dict[str, Column]:
        """Return the columns at times between the samples, for their sizes."""
        return Columns(self.whole, times, self.whole.states(times), self.how).chosen(self.outputs, self.determined)

    def _measured(self, times: Floats, states: WholeStates, how: How) -> dict[str, Column]:
        """Return the columns of states that a method computed, their errors measured against the motion itself."""
        own = Columns(self.whole, times, states, how).chosen(self.outputs, self.determined)
        require_known(own)
        finer = False
        while True:
            right = self._columns(times, finer=finer)
            require_known(right)
            known = worst(right)
            found = {
                name: replace(one, error=apart(one, right[name]) + right[name].error, scale=right[name].scale)
                for name, one in own.items()
            }
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

    def _with_inherited(
        self, times: Floats, columns: dict[str, Column], stated: Accuracy, uncertainty: float
    ) -> tuple[dict[str, Column], Accuracy]:
        """Add what the uncertainty of the inputs does, or why that is not known."""

        def following(whole: Whole, times: Floats, states: WholeStates) -> dict[str, Column]:
            followed = [output for output in self.outputs if output != "trajectory"]
            return Columns(whole, times, states, "closed form").chosen(followed, self.determined)

        try:
            known = changes(self.scene, self.found, np.concatenate([times, instants(times)]), following)
            moved = known.of_columns(np.arange(len(times)))
        except MechanicsError as fault:
            return columns, replace(stated, why=fault.detail)
        own = {name: column for name, column in columns.items() if name in moved}
        if not own:
            return columns, replace(stated, why=ONLY_SUMS)
        moved = {name: moved[name] for name in own}
        until = horizon(known, len(times), stated.requested / uncertainty, own) if uncertainty else None
        why = None if until is not None else NO_HORIZON_NEEDED
        return with_inherited(columns, replace(stated, horizon=until), moved, uncertainty, why=why)

    @property
    def _follows(self) -> bool:
        """Whether something is requested that needs the motion between the samples."""
        return any(
            output in ("work-in-time", "paths-in-time") or not isinstance(output, str) for output in self.outputs
        )

    def searched(
        self, found: Trajectory, times: Floats
    ) -> tuple[tuple[Occurrence, ...], tuple[SceneExtremes, ...]] | None:
        """Return when quantities take values and how large they become, between the start and the latest of the times.

        None where no search is among the outputs.
        """
        if all(isinstance(output, str) for output in self.outputs):
            return None
        latest = float(np.max(times))
        ended = next((event for event in found.events if 0.0 <= event.time <= latest), None)
        end = latest if ended is None else ended.time
        expanded = end if ended is None or ended.kind not in OF_LENGTHS else BEFORE_SINGULAR * end
        search = SmoothSearch(
            self.whole, self.how, self.determined, end, expanded, found.accuracy.requested, self.numerical, self.finer
        )
        with np.errstate(over="ignore", invalid="ignore"):
            return search.found(self.outputs)


def _integrated(whole: Whole, times: Floats, method: AbstractMethod, budget: Budget) -> tuple[WholeStates, Work]:
    """Return the states that a method computes, and what they cost."""
    system = SceneSystem(whole)
    if not len(times) or not len(system.initial_state):
        at_rest = np.zeros((len(times), len(whole.reduced.table.names)))
        return whole.states_at(at_rest, at_rest), Work(len(times))
    found = method.integrate(system, times, budget)
    return whole.states_at(*system.places_and_rates(found.states)), found.work
