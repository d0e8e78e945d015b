"""The audit of an answer: whether it keeps the laws of mechanics, as far as its stated errors go.

The answer is compared with the description as it was written and with nothing else. Laws that need something that the
answer does not have, such as the spin of a body of which only the axis is answered, are not checked for it.

References
----------
R. M. McConnell, K. Mehlhorn, S. Näher, P. Schweitzer, "Certifying algorithms", Computer Science Review 5 (2011).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.audit.balanced import Moment, check_balance
from core.multibody.audit.chosen_times import generator, quickness, rows_of, windows
from core.multibody.audit.claims import check_claims
from core.multibody.audit.definitions import Description, description_of
from core.multibody.audit.energy import Energies
from core.multibody.audit.failure import ROUNDING, Failure, Ledger
from core.multibody.audit.impacts import Impacts
from core.multibody.audit.laws_at_samples import MeasureValues, Sizes, States, check_samples, measured
from core.multibody.audit.newton import Freedoms
from core.multibody.audit.placement import Motion, Numbers, Placement, Pose, Twist, moved
from core.multibody.audit.repetition import check_repetition, times_of_period
from core.multibody.audit.samples import Columns, Samples, joined, samples_of
from core.multibody.audit.searches import Searches
from core.multibody.audit.start import AfterStart, accelerations_of, check_places, forces_of
from core.multibody.audit.windows import NODES, check_window, nodes
from core.multibody.language.scene import Scene

Sampler = Callable[[Numbers], Columns]
"""From times to the columns of places, rates and forces of the motion that was answered."""

MEANT = 1e-6
"""Relative mismatch of positions up to which rounded figures are taken to be meant as the connections say."""

CLOSED_FORM = "closed-form"
"""Kind of the method by which a motion is answered that no client has named a method for."""


def audited(scene: Scene, answer: SceneSolution, sampler: Sampler, times: Numbers) -> Failure | None:
    """Return the worst law that an answer does not keep, None where it keeps all that are checked.

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
    description = description_of(scene)
    if not description.moderate or answer.phases == ():
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        return _Audit(description, answer, times).worst(sampler)


class _Audit:
    """One audit, with what its laws share.

    All samples are rows of one set: that of the start, those of windows and of the period, those of the answer. Behind
    them come the start that the accelerations lead to, a short time before and after, and that of the description.
    """

    def __init__(self, description: Description, answer: SceneSolution, times: Numbers) -> None:
        self.description, self.answer, self.random = description, answer, generator(description, times)
        self.latest = max(float(times.max(initial=0.0)), 0.0)
        found = answer.trajectory
        self.own_samples: Samples | None = None
        self.begin = self.end = 0.0
        if found is not None and len(found.time):
            self.begin, self.end = min(float(found.time.min()), 0.0), max(float(found.time.max()), 0.0)
            if all(f"{name}.velocity" in found.columns for name in description.bodies):
                rows = rows_of(self.random, len(found.time))
                self.own_samples = samples_of(description, found.time, found.columns, rows)
        # A method that a client names computes samples of its own.
        self.own = found is None or found.method == CLOSED_FORM

    def worst(self, sampler: Sampler) -> Failure | None:
        """Compare everything, and return the worst failure."""
        description, answer = self.description, self.answer
        samples = self.own_samples
        asked = self._asked(sampler)
        if asked is not None:
            samples = asked.samples if samples is None else asked.samples.followed_by(samples)
        if samples is None:
            return None
        after = None
        if asked is not None:
            gains = accelerations_of(description, answer)
            if gains is not None and _spun(description, samples):
                after = AfterStart(description, gains, samples.at(slice(0, 1)))
        behind = [] if after is None else [after.samples()]
        every = joined([(samples.placement, samples.motion), *behind, _described(description)])
        ahead = moved(*every)
        measures = measured(description, ahead)
        ledger = Ledger(MEANT if _was_rounded(description, answer, measures) else ROUNDING)
        states = states_of(description, answer, samples.times)
        sizes = Sizes(description, samples)
        check_samples(ledger, measures, samples, states, sizes)
        if asked is not None:
            self._check_motion(ledger, samples, ahead, after, measures, asked, sizes)
            if asked.searches is not None:
                found = answer.trajectory
                own = (np.zeros(0), {}) if found is None else (found.time, found.columns)
                asked.searches.check(ledger, asked.columns, *own)
        return ledger.worst

    def _check_motion(
        self,
        ledger: Ledger,
        samples: Samples,
        ahead: Placement,
        after: AfterStart | None,
        measures: Sequence[MeasureValues],
        asked: _Asked,
        sizes: Sizes,
    ) -> None:
        """Compare what needs the start or windows of the motion."""
        description, answer, freedoms = self.description, self.answer, Freedoms(self.description)
        start, moments, motion = samples.at(slice(0, 1)), [], dict(samples.motion)
        check_places(ledger, description, start)
        if after is not None:
            after.check(ledger, measures, len(samples.times))
            if answer.forces is not None and not description.undefined:
                none, forces = np.zeros((freedoms.count, 1)), forces_of(answer)
                errors = {name: np.zeros(1) for name in forces}
                law = "Newton and Euler at the start"
                moments.append(Moment(law, slice(0, 1), after.gains, forces, errors, none, stated=False))
                for own in measures:
                    rest = own.connection.own_rest(start.placement, start.motion, after.gains_as_motion, forces)
                    if rest is not None:
                        law, allowed = "equation of the chain at the start", 8.0 * ledger.rounding * rest[1]
                        ledger.compare(law, own.connection.name, start.times, rest[0], allowed)
        for number, half in enumerate(asked.halves):
            rows = slice(1 + number * NODES, 1 + (number + 1) * NODES)
            window = samples.at(rows)
            gains = check_window(ledger, description, freedoms, window, _rows(ahead, rows), half, sizes.extent)
            for name, twist in gains.spins.items():
                spin = motion[name].spin
                spin = np.zeros((len(samples.times), 3)) if spin is None else spin
                spin[rows] = twist.spin
                motion[name] = Twist(motion[name].velocity, spin)
            moments.append(
                Moment("Newton and Euler", rows, gains.accelerations, window.forces, window.force_errors, gains.unsure,
                       stated=True)
            )  # fmt: skip
        check_balance(ledger, description, freedoms, samples, motion, moments)
        if asked.repeated:
            first = 1 + len(asked.halves) * NODES
            later = samples.at(slice(first, first + asked.repeated))
            check_repetition(ledger, description, answer, start, later)
        if asked.impacts is not None:
            first = 1 + len(asked.halves) * NODES + asked.repeated
            struck = samples.at(slice(first, first + len(asked.impacts.times)))
            asked.impacts.check(ledger, description, freedoms, struck)
        check_claims(ledger, answer, samples, None if after is None else after.gains, sizes.typical())
        if _spun(description, samples):
            self._check_energy(ledger, samples)

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
                ledger.compare(f"{own} energy at the start", "", samples.times[:1], found[:1] - given, size)
        if losses is not None:
            energies.check(ledger, losses)

    def _asked(self, sampler: Sampler) -> _Asked | None:
        """Return samples of the motion at the start, in windows, after its period, and where something was found.

        None where the motion is not known there: laws that need it are not checked then.
        """
        try:
            placed: list[tuple[float, float]] = []
            searches, impacts, repeated, struck = None, None, np.zeros(0), np.zeros(0)
            if self.own and self.end > self.begin:
                rated = self.own_samples
                if rated is None:
                    rated = samples_of(self.description, np.zeros(1), sampler(np.zeros(1)), slice(None))
                quick = quickness(self.description, rated)
                placed = windows(self.random, self.answer, self.begin, self.end, quick)
                if any(event.impulses for event in self.answer.events):
                    impacts = Impacts(self.answer, self.random, quick, self.end)
                    struck = impacts.times
                if self.answer.occurrences or self.answer.extremes:
                    ended = self.answer.ended
                    searches = Searches(self.answer, self.random, self.latest if ended is None else ended.time)
            if self.own:
                repeated = times_of_period(self.answer)
            found = np.zeros(0) if searches is None else searches.times
            asked = np.concatenate([np.zeros(1), *(nodes(*one) for one in placed), repeated, struck, found])
            columns = sampler(asked)
            rows = slice(0, len(asked) - len(found))
            samples = samples_of(self.description, asked, columns, rows)
            return _Asked(samples, columns, [half for _, half in placed], len(repeated), impacts, searches)
        except MechanicsError:
            return None


@dataclass(frozen=True)
class _Asked:
    """Samples of the motion at times that the audit chose.

    Attributes
    ----------
    samples : Samples
        At the start, in windows, after the period.
    columns : mapping of str to Column
        There, and at the times of the searches behind.
    halves : list of float
        Half of the widths of the windows (s).
    repeated : int
        How many samples belong to the period.
    impacts : Impacts or None
        Its samples are behind those of the period.
    searches : Searches or None
    """

    samples: Samples
    columns: Columns
    halves: list[float]
    repeated: int
    impacts: Impacts | None
    searches: Searches | None


def _spun(description: Description, samples: Samples) -> bool:
    """Return whether the spins of all bodies are answered."""
    return all(samples.spun(name) for name, body in description.bodies.items() if body.inertia is not None)


def _rows(placement: Placement, rows: slice) -> Placement:
    return {
        name: Pose(*(None if x is None else x[rows] for x in (pose.position, pose.rotation, pose.turn)))  # type: ignore[arg-type]
        for name, pose in placement.items()
    }


def _described(description: Description) -> tuple[Placement, Motion]:
    """Return the start of a description as one sample, at rest."""
    placement, motion = {}, {}
    for name, body in description.bodies.items():
        at = body.start
        placement[name] = Pose(*(None if x is None else x[None] for x in (at.position, at.rotation, at.turn)))  # type: ignore[arg-type]
        still = np.zeros((1, description.dimension))
        spin = np.zeros((1, 3) if description.dimension == 3 else 1)
        motion[name] = Twist(still, None if body.inertia is None else spin)
    return placement, motion


def _was_rounded(description: Description, answer: SceneSolution, measures: Sequence[MeasureValues]) -> bool:
    """Return whether positions or velocities were taken as rounded, and moved so that connections hold.

    Parameters
    ----------
    measures : sequence of MeasureValues
        Of which the last sample is the start as it is described.
    """
    if any("rounding" in sentence or "rounded" in sentence for sentence in answer.model.noticed):
        return True
    for pose in description.start.values() if description.dimension == 3 else ():
        axes = pose.rotation
        if axes is not None and np.abs(axes.T @ axes - np.eye(3)).max() > ROUNDING:
            return True
    for own in measures:
        known = ROUNDING * (description.places + own.connection.arm + own.connection.reach)
        if any(np.abs(value[-1].real).max() > known for value in own.held.values()):
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
