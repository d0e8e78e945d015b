"""The motion of a described scene through its phases, as a system: its samples, and what is searched in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from flint import arb

from core.arrays import Floats
from core.errors import AccuracyUnreachable, MechanicsError, NotApplicable, inside_field
from core.multibody.answer import Occurrence, SceneExtremes
from core.multibody.language.scene import Scene
from core.multibody.motion.motion import States
from core.multibody.motion.whole import Whole
from core.multibody.phases.inherited_in_phases import changes_in_phases
from core.multibody.phases.method_samples import integrated, measured
from core.multibody.phases.phase import PhaseMotion
from core.multibody.phases.phase_columns import ColumnsInPhases
from core.multibody.phases.phase_states import how_until
from core.multibody.phases.searches import Searches
from core.multibody.phases.smooth_motion import not_watched
from core.multibody.phases.sums import Sums
from core.multibody.trajectory.along import period_within
from core.multibody.trajectory.column_errors import FINEST, require_reached, scaled, worst
from core.multibody.trajectory.columns import NEAREST, Columns
from core.multibody.trajectory.events import searched_until
from core.multibody.trajectory.inherited import (
    NO_HORIZON_NEEDED,
    Changing,
    changes,
    horizon,
    instants,
    with_inherited,
)
from core.multibody.trajectory.integrals import POINTS_OF_INTERVAL, require_few_points
from core.multibody.trajectory.occurrences import ExtremesOf, ValueSearch
from core.multibody.trajectory.scene_request import Output
from core.notices import Notice
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod
from core.systems.question import MotionQuestion
from core.systems.trajectory import HORIZON, Accuracy, Column, How, Trajectory, Work

PLACES_AND_FORCES = ("trajectory", "forces-in-time")
"""Outputs that an audit compares."""
SUMS = ("work-in-time", "paths-in-time")
"""Outputs that are summed up along the motion."""
_TOLD_APART = 9
"""Decimal places of shares of a period: times that differ by less may be the same within a period."""
_ONLY_SUMS = "it is not propagated to integrals along the motion, and nothing else is asked for"


class DescribedSystem:
    """A described scene, as a system.

    Parameters
    ----------
    scene : Scene
    motion : PhaseMotion
    outputs : sequence of str, When and ExtremesOf
        Those of the motion are its columns.
    """

    def __init__(self, scene: Scene, motion: PhaseMotion, outputs: Sequence[Output]) -> None:
        self.scene, self.motion, self.outputs = scene, motion, outputs
        self.columns = ColumnsInPhases(motion, outputs)

    def trajectory(self, question: MotionQuestion) -> Trajectory:
        """Return the samples up to the events that end the motion; see `core.systems.question.System`."""
        motion, method = self.motion, question.method
        rows = np.array([k for k, t in enumerate(question.times) if self._is_reached(float(t))], dtype=np.int64)
        times = question.times[rows]
        how, work = how_until(motion.phases, float(times.max(initial=0.0))), Work(len(times))
        # What leaves the range of doubles is refused.
        with np.errstate(over="ignore", invalid="ignore"):
            if question.integrator is None:
                if method is not None and how != "closed form":
                    raise NotApplicable(
                        "this scene has no closed form",
                        path=("method", "kind"),
                        remedy="leave the method out, and the smallest model that suffices answers",
                    )
                columns = self._own(times, question.accuracy, how)
            else:
                how = "measured against closed form" if how == "closed form" else how
                columns, work = self._by_method(times, question, question.integrator, how)
            stated = Accuracy(question.accuracy, worst(columns), how)
            if question.input_uncertainty is not None and len(times):
                end = float(np.max(question.times))
                columns, stated = self._with_inherited(times, columns, stated, question.input_uncertainty, end)
        return Trajectory(
            times,
            scaled(columns),
            stated,
            None,
            ClosedFormEvaluation().kind if method is None else method.kind,
            work,
            ended=HORIZON if motion.ended is None else motion.ended.kind,
            rows=rows,
            events=tuple(motion.events),
            warnings=self._warnings(),
        )

    def _is_reached(self, time: float) -> bool:
        """Return whether the motion is followed up to a time."""
        motion = self.motion
        if not motion.phases or (motion.before is not None and time < min(motion.before.time, 0.0)):
            return False
        if motion.ended is None:
            return True
        end = motion.phases[-1].end
        return not arb(time) > (arb(motion.ended.time) if end is None else end)

    def sampled(self, times: Floats, forces: bool = True) -> dict[str, Column]:
        """Return places, rates and, if wanted, forces at some times; without forces where they are not known."""
        with np.errstate(over="ignore", invalid="ignore"):
            if not forces:
                return replace(self.columns, outputs=PLACES_AND_FORCES[:1]).at(times)
            try:
                return replace(self.columns, outputs=PLACES_AND_FORCES).at(times)
            except AccuracyUnreachable:
                return replace(self.columns, outputs=PLACES_AND_FORCES[:1]).at(times)

    def _warnings(self) -> tuple[Notice, ...]:
        """Return that some forces might end the motion, and are not determined."""
        names = not_watched(self.motion.phases[0]) if self.motion.phases else []
        if not names:
            return ()
        detail = f"whether {', '.join(names)} would have to push is not known: these forces are not determined"
        return (Notice("end-not-known", detail, ("connections",)),)

    def _own(self, times: Floats, accuracy: float, how: How) -> dict[str, Column]:
        """Return the columns of the motion itself, by pairs of doubles where doubles do not reach the accuracy."""
        columns = self.columns.with_sizes(times)
        lost = worst(columns) > accuracy
        if lost and self.columns.numerical and accuracy >= FINEST:
            self.columns = replace(self.columns, finer=True)
            columns = self.columns.with_sizes(times)
            lost = worst(columns) > accuracy
        if lost and (accuracy < FINEST or self.columns.are_known(times, accuracy)):
            self.columns = replace(self.columns, finer=True)
            columns = replace(self.columns, rounding=NEAREST).with_sizes(times)
            lost = worst(columns) > accuracy
        sums = self._sums(times, how)
        columns |= sums
        lost = worst(columns) > accuracy if sums else lost
        require_reached(columns, accuracy, before=self.columns.reached_until(times, accuracy) if lost else None)
        return columns

    def _sums(self, times: Floats, how: How) -> dict[str, Column]:
        """Return the columns of what is summed up along the motion."""
        if not set(SUMS) & set(self.outputs):
            return {}
        sums = Sums(self.columns, times, how)
        found = sums.works() if "work-in-time" in self.outputs else {}
        return found | (sums.paths() if "paths-in-time" in self.outputs else {})

    def _by_method(
        self, times: Floats, question: MotionQuestion, method: AbstractMethod, how: How
    ) -> tuple[dict[str, Column], Work]:
        """Return the columns that a method computes, measured against the motion itself, and what they cost."""
        if any(output in SUMS or not isinstance(output, str) for output in self.outputs):
            raise NotApplicable(
                "integrals and searches along the motion are answered of the motion itself, not of a method",
                path=("method",),
                remedy="leave the method out",
            )
        whole = self.motion.phases[0].models[0].whole
        with inside_field("method"):
            states, work = integrated(whole, times, method, question.budget)
        own = self.columns.of_states(times, states, how)
        return measured(own, self.columns, times, numerical=self.columns.numerical), work

    def _with_inherited(
        self, times: Floats, columns: dict[str, Column], stated: Accuracy, uncertainty: float, end: float
    ) -> tuple[dict[str, Column], Accuracy]:
        """Add what the uncertainty of the inputs does up to a time, or why that is not known."""
        every = np.concatenate([times, instants(times)])
        known: Changing
        try:
            if self.motion.smooth:
                known = changes(self.scene, self.motion.phases[0].models[0], every, self._following)
            else:
                known = changes_in_phases(self.scene, self.columns, every, end)
            moved = known.of_columns(np.arange(len(times)))
        except MechanicsError as fault:
            return columns, replace(stated, why=fault.detail)
        own = {name: column for name, column in columns.items() if name in moved}
        if not own:
            return columns, replace(stated, why=_ONLY_SUMS)
        moved = {name: moved[name] for name in own}
        until = horizon(known, len(times), stated.requested / uncertainty, own) if uncertainty else None
        why = None if until is not None else NO_HORIZON_NEEDED
        return with_inherited(columns, replace(stated, horizon=until), moved, uncertainty, why=why)

    def _following(self, whole: Whole, times: Floats, states: States) -> dict[str, Column]:
        """Return the columns that follow from places and rates."""
        followed = [output for output in self.outputs if output != "trajectory"]
        return Columns(whole, times, states, "closed form").chosen(followed, self.motion.phases[0].determined)

    def searched(
        self, times: Floats, accuracy: float
    ) -> tuple[tuple[Occurrence, ...] | None, tuple[SceneExtremes, ...] | None]:
        """Return when quantities take values and how large they become, between the start and the latest of the times.

        None where no search is among the outputs.
        """
        searches = self._asked()
        if not searches:
            return None, None
        with np.errstate(over="ignore", invalid="ignore"):
            if not self.motion.phases:
                return (), ()
            along = self._searches(times, accuracy)
            found: list[Occurrence] = []
            ranges: list[SceneExtremes] = []
            for index, one in searches:
                if isinstance(one, ValueSearch):
                    found.extend(along.occurrences(one, index))
                else:
                    ranges.append(along.extremes(one, index))
            return tuple(found), tuple(self._with_places(ranges))

    def require_answerable(self, times: Floats, accuracy: float) -> None:
        """Raise what the samples, the sums and the searches are refused for before any of them is computed.

        Raises
        ------
        InvalidParameter
            For a search of what is no quantity of the scene.
        BudgetExceeded
            For sums at more times than they may have.
        """
        if not self.motion.phases or not len(times):
            return
        if searches := self._asked():
            with np.errstate(over="ignore", invalid="ignore"):
                along = self._searches(times, accuracy)
                for index, one in searches:
                    along.column(one, index)
        if self.motion.smooth and self._integrates():
            reached = np.unique([t for t in times.tolist() if self._is_reached(t)])
            for way in (reached[reached > 0.0], -reached[reached < 0.0]):
                require_few_points(POINTS_OF_INTERVAL * self._distinct(way))

    def _integrates(self) -> bool:
        """Return whether something is integrated to every time: a length, or a work that has no potential."""
        works = any(work.potential is None for work in self.motion.base.measures.works)
        return "paths-in-time" in self.outputs or (works and "work-in-time" in self.outputs)

    def _distinct(self, times: Floats) -> int:
        """Return how many times there are at least to integrate to: along what repeats, of those within a period."""
        counts = [len(times)]
        for _, motion in self.motion.phases[0].models[0].whole.parts:
            period = period_within([motion], float(times.max(initial=0.0)))
            if period is not None:
                counts.append(len(np.unique(np.round(times / float(period) % 1.0, _TOLD_APART))))
        return min(counts)

    def _asked(self) -> list[tuple[int, ValueSearch | ExtremesOf]]:
        """Return the searches among the outputs, with their places there."""
        return [(i, output) for i, output in enumerate(self.outputs) if isinstance(output, (ValueSearch, ExtremesOf))]

    def _searches(self, times: Floats, accuracy: float) -> Searches:
        end = searched_until(float(np.max(times)), self.motion.ended)
        return Searches(self.columns, end, how_until(self.motion.phases, end), accuracy)

    def _with_places(self, ranges: Sequence[SceneExtremes]) -> Iterator[SceneExtremes]:
        """Yield extremes with where the bodies are at their times."""
        times = np.array([time for one in ranges for time in (one.least_time, one.largest_time)])
        columns = self.sampled(times, forces=False) if ranges else {}
        end = ".position"
        own = {name.removesuffix(end): column for name, column in columns.items() if name.endswith(end)}
        errors = {name: column.error for name, column in own.items()}
        for k, one in enumerate(ranges):
            least, largest = (
                {name: tuple(column.values[row].tolist()) for name, column in own.items()} for row in (2 * k, 2 * k + 1)
            )
            yield replace(one, least_places=least, largest_places=largest, place_errors=errors)
