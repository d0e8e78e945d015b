"""The audit of an answer: whether it keeps the laws of mechanics, as far as its stated errors go.

The answer is compared with the description as it was written and with nothing else. Laws that need something that the
answer does not have, such as the spin of a body of which only the axis is answered, are not checked for it.

References
----------
R. M. McConnell, K. Mehlhorn, S. Näher, P. Schweitzer, "Certifying algorithms", Computer Science Review 5 (2011).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.audit.balanced import Accelerated, check_balance, joined_accelerations
from core.multibody.audit.chosen_times import generator, largest_rates, quickness, rows_of, windows
from core.multibody.audit.claims import check_claims
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import Energies, potential_error
from core.multibody.audit.equilibria import check_equilibria
from core.multibody.audit.failure import ROUNDING, Ledger, Verdict
from core.multibody.audit.impacts import Impacts, is_sudden
from core.multibody.audit.laws_at_samples import MeasureValues, Sizes, States, check_samples, measured
from core.multibody.audit.newton import Freedoms
from core.multibody.audit.occasions import check_occasions
from core.multibody.audit.placement import LARGEST, Numbers, Placement, Pose, Twist, moved
from core.multibody.audit.repetition import check_repetition, times_of_period
from core.multibody.audit.samples import Part, Samples, joined, samples_of
from core.multibody.audit.searches import SearchedQuantities
from core.multibody.audit.stages import Sampler, Stage, stages_of
from core.multibody.audit.start import AfterStart, accelerations_of, check_forces, check_places, forces_of, unsure_of
from core.multibody.audit.totals import check_paths, check_totals, check_works, with_totals
from core.multibody.audit.windows import NODES, check_windows, nodes
from core.multibody.language.scene import Scene

MEANT = 1e-6
"""Relative mismatch of positions up to which rounded figures are taken to be meant as the connections say."""

CLOSED_FORM = "closed-form"
"""Kind of the method by which a motion is answered that no client has named a method for."""


def audited(scene: Scene, answer: SceneSolution, sampler: Sampler, times: Numbers) -> Verdict:
    """Return whether an answer keeps the laws that are checked, and which one it does not.

    Parameters
    ----------
    scene : Scene
        As the client wrote it.
    answer : SceneSolution
        As it is about to be sent.
    sampler : callable
    times : ndarray, shape (n,)
        Those of the question.
    """
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        if answer.phases == ():
            return Verdict()
        occasions = Ledger(ROUNDING)
        check_occasions(occasions, scene, answer, max(float(times.max(initial=0.0)), 0.0))
        verdict = Verdict(occasions.worst)
        if verdict.failure is not None:
            return verdict
        for stage in stages_of(scene, answer, sampler):
            if not stage.description.moderate:
                return Verdict(compared=False)
            verdict = _Audit(stage, times).verdict(sampler, Ledger(ROUNDING))
            if verdict.failure is not None and _was_rounded(stage.description, answer):
                verdict = _Audit(stage, times).verdict(sampler, Ledger(MEANT))
            if verdict.failure is not None:
                return verdict
        return verdict


class _Audit:
    """One audit, with what its laws share.

    All samples are rows of one set: that of the start, those of windows, of the period and of impacts, those of the
    answer. Behind them come the start that the accelerations lead to, a short time before and after.
    """

    def __init__(self, stage: Stage, times: Numbers) -> None:
        description, answer = stage.description, stage.answer
        self.description, self.answer, self.random = description, answer, generator(description, times)
        self.stage = stage
        self.latest = max(float(times.max(initial=0.0)), 0.0)
        found = answer.trajectory
        self.own_rows: Part | None = None
        self.begin = self.end = stage.begin
        if found is not None and len(found.time):
            if stage.begin == 0.0:
                self.begin = min(float(found.time.min()), 0.0)
            self.end = max(min(float(found.time.max()), stage.end), stage.begin)
            if all(f"{name}.velocity" in found.columns for name in description.bodies):
                rows = rows_of(self.random, len(found.time))
                rows = rows[stage.holds(found.time[rows])]
                self.own_rows = Part(found.time[rows], found.columns, rows) if len(rows) else None
        # A method that a client names computes samples of its own.
        self.own = found is None or found.method == CLOSED_FORM

    def verdict(self, sampler: Sampler, ledger: Ledger) -> Verdict:
        """Compare everything."""
        description, answer = self.description, self.answer
        asked = self._asked(sampler)
        parts = [part for part in (None if asked is None else asked.part, self.own_rows) if part is not None]
        if not parts:
            return Verdict()
        samples = samples_of(description, parts)
        if asked is not None:
            samples = samples.with_first_forces(*forces_of(answer))
        spun = _spun(description, samples)
        gains = None if asked is None or not spun else accelerations_of(description, answer)
        start = samples.at(slice(0, 1))
        after = None if gains is None else AfterStart(description, gains, start)
        own = (samples.placement, samples.motion)
        ahead = moved(*(own if after is None else joined([own, after.samples()])), in_time=True)
        measures = measured(description, ahead)
        states = states_of(description, answer, samples.times)
        sizes = Sizes(description, samples)
        if not max(sizes.extent, sizes.fastest) < LARGEST:
            # The squares of a motion that has gone so far are no doubles, though its digits may be answered.
            return Verdict(compared=False)
        check_samples(ledger, measures, samples, states, sizes)
        if self.own_rows is not None:
            check_totals(ledger, description, samples, self.own_rows)
            check_works(ledger, description, samples, self.own_rows, phased=bool(answer.phases))
            check_paths(ledger, description, self.own_rows)
        check_equilibria(ledger, description, answer, self.random)
        if asked is not None:
            self._check_motion(ledger, samples, start, ahead, after, measures, asked, sizes)
            if spun:
                self._check_energy(ledger, samples)
            if asked.searches is not None:
                found = answer.trajectory
                answered = (np.zeros(0), {}) if found is None else (found.time, found.columns)
                sought = with_totals(description, asked.whole, asked.searches.names, ledger.rounding)
                asked.searches.check(ledger, sought, *answered)
        return Verdict(ledger.worst)

    def _check_motion(
        self,
        ledger: Ledger,
        samples: Samples,
        start: Samples,
        ahead: Placement,
        after: AfterStart | None,
        measures: Sequence[MeasureValues],
        asked: _Asked,
        sizes: Sizes,
    ) -> None:
        """Compare what needs the start or windows of the motion."""
        description, answer, freedoms = self.description, self.answer, Freedoms(self.description)
        check_places(ledger, description, start)
        check_forces(ledger, description, answer, start, float(sizes.force[0]))
        if after is not None:
            after.check(ledger, measures, len(samples.times))
            forces, _ = forces_of(answer)
            for own in measures if forces else ():
                rest = own.connection.own_rest(start.placement, start.motion, after.gains_as_motion, forces)
                if rest is not None:
                    law, allowed = "equation of the chain at the start", 8.0 * ledger.rounding * rest[1]
                    ledger.compare(law, own.connection.name, start.times, rest[0], allowed)
        self._check_newton(ledger, freedoms, samples, ahead, after, asked, sizes)
        if asked.beginning is not None:
            impacts, part = asked.beginning
            instant = self.stage.instant
            impacts.check(ledger, instant, Freedoms(instant), samples_of(instant, [part]))
        first = 1 + len(asked.halves) * NODES
        if asked.repeated:
            later = samples.at(slice(first, first + asked.repeated))
            check_repetition(ledger, description, answer, start, later)
        first += asked.repeated
        if asked.impacts is not None:
            struck = samples.at(slice(first, first + len(asked.impacts.times)))
            asked.impacts.check(ledger, description, freedoms, struck)
        check_claims(ledger, answer, samples, None if after is None else after.gains, sizes.typical())

    def _check_newton(
        self,
        ledger: Ledger,
        freedoms: Freedoms,
        samples: Samples,
        ahead: Placement,
        after: AfterStart | None,
        asked: _Asked,
        sizes: Sizes,
    ) -> None:
        """Compare rates in windows, and the laws of Newton and Euler there and at the start."""
        description, last = self.description, 1 + len(asked.halves) * NODES
        begins = after is not None and not description.undefined
        rows = slice(0 if begins else 1, last)
        if not begins and not asked.halves:
            return
        some = samples.at(rows)
        accelerations = {} if after is None else dict(after.gains)
        unsure = unsure_of(description, self.answer, freedoms)[:, : int(begins)]
        if asked.halves:
            inner = samples.at(slice(1, last))
            found = check_windows(
                ledger,
                description,
                freedoms,
                inner,
                {name: pose.at(slice(1, last)) for name, pose in ahead.items()},
                asked.halves,
                sizes.extent,
            )
            unsure = np.concatenate([unsure, found.unsure], axis=1)
            own = [accelerations, found.accelerations] if begins else [found.accelerations]
            accelerations = {name: joined_accelerations([one[name] for one in own]) for name in found.accelerations}
            motion = dict(some.motion)
            for name, spin in found.spins.items():
                motion[name] = Twist(motion[name].velocity, np.concatenate([np.zeros((int(begins), 3)), spin]))
            some = replace(some, motion=motion)
        check_balance(ledger, description, freedoms, Accelerated(some, accelerations, unsure, begins))

    def _check_energy(self, ledger: Ledger, samples: Samples) -> None:
        description, answer = self.description, self.answer
        losses = _losses(description, answer)
        stated = None if any(event.time <= 0.0 for event in answer.events) else answer.energy
        if losses is None and stated is None:
            return
        energies = Energies(description, samples)
        if stated is not None:
            size = 8.0 * ledger.rounding * energies.size[:1]
            for own, given, found in (
                ("kinetic", stated.kinetic, energies.kinetic),
                ("potential", stated.potential, energies.potential),
            ):
                allowed = size
                if own == "potential" and np.any(np.abs(found[:1] - given) > size):
                    allowed = size + potential_error(description, samples, ledger.rounding)[:1]
                ledger.compare(f"{own} energy at the start", "", samples.times[:1], found[:1] - given, allowed)
        if losses is not None:
            energies.check(ledger, losses)

    def _asked(self, sampler: Sampler) -> _Asked | None:
        """Return samples of the motion at the start, in windows, after its period, and where something was found.

        None where the motion is not known there: laws that need it are not checked then.
        """
        description, answer = self.description, self.answer
        forces = self._needs_forces()
        try:
            placed: list[tuple[float, float]] = []
            searches, impacts, repeated, struck = None, None, np.zeros(0), np.zeros(0)
            if self.own and self.end > self.begin:
                rated = sampler(np.array([self.stage.begin]), False) if self.own_rows is None else self.own_rows.columns
                # How quick a motion is need not be known exactly: attitudes of the start do for it.
                places = {
                    name: Pose(rated[f"{name}.position"].values, body.start.rotation, body.start.turn)
                    for name, body in description.bodies.items()
                }
                quick = quickness(description, places, *largest_rates(rated))
                placed = windows(self.random, answer, self.begin, self.end, quick)
                if any(map(is_sudden, answer.events)):
                    impacts = Impacts(answer, self.random, quick, (self.stage.begin, self.end))
                    struck = impacts.times
                if answer.occurrences or answer.extremes:
                    ended = answer.ended
                    searches = SearchedQuantities(answer, self.random, self.latest if ended is None else ended.time)
                    forces = True
            if self.own:
                repeated = times_of_period(answer)
            beginning = self._beginning(sampler)
            found = np.zeros(0) if searches is None else searches.times
            asked = np.concatenate([[self.stage.begin], *(nodes(*one) for one in placed), repeated, struck, found])
            columns, count = sampler(asked, forces), len(asked) - len(found)
            part, whole = Part(asked[:count], columns, slice(0, count)), Part(asked, columns, slice(None))
            return _Asked(part, whole, [half for _, half in placed], len(repeated), impacts, searches, beginning)
        except MechanicsError:
            return None

    def _beginning(self, sampler: Sampler) -> tuple[Impacts, Part] | None:
        """Return what begins and strikes where the stage begins, with samples on either side of that."""
        begin, found = self.stage.begin, self.answer.trajectory
        if not (self.own and begin > 0.0 and self.end > begin) or found is None:
            return None
        columns = sampler(np.array([begin]), False)
        quick = quickness(self.description, self.description.start, *largest_rates(columns))
        impacts = Impacts(self.stage.whole, self.random, quick, (begin, self.end), at_begin=True)
        if not len(impacts.times):
            return None
        return impacts, Part(impacts.times, sampler(impacts.times, False), slice(0, len(impacts.times)))

    def _needs_forces(self) -> bool:
        """Return whether forces in time are answered, decide what touches, or belong to what has mass of its own.

        The equations of motion hold without those that keep what is held; those of the start may be answered.
        """
        found = self.answer.trajectory
        if self.answer.forces is not None and not self.end > self.begin:
            return False
        if found is not None and any(column.unit in ("N", "N m") for column in found.columns.values()):
            return True
        return any(connection.mass or connection.opens for connection in self.description.connections)


@dataclass(frozen=True)
class _Asked:
    """Samples of the motion at times that the audit chose.

    Attributes
    ----------
    part : Part
        At the start, in windows, after the period, beside impacts.
    whole : Part
        With the times of the searches behind them.
    halves : list of float
        Half of the widths of the windows (s).
    repeated : int
        How many samples belong to the period.
    impacts : Impacts or None
        Its samples are behind those of the period.
    searches : SearchedQuantities or None
    beginning : (Impacts, Part) or None
        What happens where the stage begins, with samples of its own.
    """

    part: Part
    whole: Part
    halves: list[float]
    repeated: int
    impacts: Impacts | None
    searches: SearchedQuantities | None
    beginning: tuple[Impacts, Part] | None


def _spun(description: Description, samples: Samples) -> bool:
    """Return whether the spins of all bodies are answered."""
    return all(samples.spun(name) for name, body in description.bodies.items() if body.inertia is not None)


def _was_rounded(description: Description, answer: SceneSolution) -> bool:
    """Return whether positions or velocities were taken as rounded, and moved so that connections hold."""
    if any("rounding" in sentence or "rounded" in sentence for sentence in answer.model.noticed):
        return True
    for pose in description.start.values() if description.dimension == 3 else ():
        axes = pose.rotation
        if axes is not None and np.abs(axes.T @ axes - np.eye(3)).max() > ROUNDING:
            return True
    for connection in description.connections:
        known = ROUNDING * (description.places + connection.arm + connection.reach)
        if any(np.abs(value).max() > known for value in connection.held(description.start).values()):
            return True
    return False


def _losses(description: Description, answer: SceneSolution) -> list[tuple[float, float]] | None:
    """Return when events take how much energy, None where something else takes or brings any, or where that is open."""
    if any(connection.works() for connection in description.connections):
        return None
    if any(phase.model == "accumulating bounces" for phase in answer.phases or ()):
        return None
    if any(event.kind == "settle" for event in answer.events):
        # Bounces that end there are not all listed.
        return None
    return [(event.time, event.energy_loss) for event in answer.events]


def states_of(description: Description, answer: SceneSolution, times: Numbers) -> States:
    """Return the state of every one-sided measure at some times, by the force that keeps it; nothing without phases."""
    if not answer.phases:
        return {}
    starts = np.array([phase.start for phase in answer.phases])
    which = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
    found: dict[str, Numbers] = {}
    for connection in description.connections:
        for force in connection.gaps(description.start):
            name = force.rsplit(".", 1)[0]
            found[force] = np.array([phase.states[name] for phase in answer.phases])[which]
    return found
