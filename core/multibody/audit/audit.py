"""The audit of an answer: whether it keeps the laws of mechanics, as far as its stated errors go.

The answer is compared with the description as it was written and with nothing else. Laws that need something that the
answer does not have, such as the spin of a body of which only the axis is answered, are not checked for it.

References
----------
R. M. McConnell, K. Mehlhorn, S. Näher, P. Schweitzer, "Certifying algorithms", Computer Science Review 5 (2011).
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.audit.chosen_times import generator, quickness, rows_of, windows
from core.multibody.audit.definitions import Description, description_of
from core.multibody.audit.energy import check_energy
from core.multibody.audit.failure import ROUNDING, Failure, Ledger
from core.multibody.audit.laws_at_samples import States, check_samples
from core.multibody.audit.newton import Freedoms
from core.multibody.audit.placement import Numbers, Undefined
from core.multibody.audit.repetition import check_period, period_of, times_of_period
from core.multibody.audit.samples import Columns, Samples, samples_of
from core.multibody.audit.start import check_start
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
    ledger = Ledger(MEANT if _was_rounded(description, answer) else ROUNDING)
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            _Audit(ledger, description, answer, generator(description, times)).run(sampler)
    except (ArithmeticError, np.linalg.LinAlgError):
        # What leaves the range of doubles is not compared.
        return None
    return ledger.worst


def _was_rounded(description: Description, answer: SceneSolution) -> bool:
    """Return whether positions or velocities were taken as rounded, and moved so that connections hold."""
    if any("rounding" in sentence or "rounded" in sentence for sentence in answer.model.noticed):
        return True
    for pose in description.start.values():
        if (
            pose.rotation is not None
            and np.abs(pose.rotation.T @ pose.rotation - np.eye(len(pose.position))).max() > ROUNDING
        ):
            return True
    size = max(float(np.abs(pose.position).max()) for pose in description.start.values())
    for connection in description.connections:
        known = ROUNDING * (size + connection.arm + connection.reach)
        try:
            if any(np.abs(value).max() > known for value in connection.held(description.start).values()):
                return True
        except Undefined:
            continue
    return False


class _Audit:
    """One audit, with what its laws share."""

    def __init__(self, ledger: Ledger, description: Description, answer: SceneSolution, random: Random) -> None:
        self.ledger, self.description, self.answer, self.random = ledger, description, answer, random
        found = answer.trajectory
        self.samples: Samples | None = None
        self.begin = self.end = 0.0
        if found is not None and len(found.time):
            self.begin, self.end = min(float(found.time.min()), 0.0), max(float(found.time.max()), 0.0)
            if all(f"{name}.velocity" in found.columns for name in description.bodies):
                rows = rows_of(random, len(found.time))
                self.samples = samples_of(description, found.time, found.columns, rows)
        # A method that a client names computes samples of its own.
        self.own = found is None or found.method == CLOSED_FORM

    def run(self, sampler: Sampler) -> None:
        """Compare everything."""
        known = self._asked(sampler)
        near = None if known is None else known[0].at(slice(0, 1 + len(known[1]) * NODES))
        fastest = max((_fastest(one) for one in (self.samples, near) if one), default=0.0)
        complete = self.samples is not None and len(self.samples.forces) > 0
        for one in (self.samples, None if complete else near):
            if one is not None:
                states = states_of(self.description, self.answer, one.times)
                check_samples(self.ledger, self.description, one, states, fastest)
        if known is None or near is None:
            return
        extra, halves = known
        freedoms = Freedoms(self.description)
        start = extra.at(slice(0, 1))
        check_start(self.ledger, self.description, freedoms, self.answer, start)
        for number, half in enumerate(halves):
            first = 1 + number * NODES
            check_window(self.ledger, self.description, freedoms, extra.at(slice(first, first + NODES)), half)
        if self.own and period_of(self.answer) is not None:
            later = extra.at(slice(1 + len(halves) * NODES, None))
            check_period(self.ledger, self.description, self.answer, start, later)
        losses = _losses(self.description, self.answer)
        if losses is not None:
            check_energy(self.ledger, self.description, self.samples or near, start, losses)

    def _asked(self, sampler: Sampler) -> tuple[Samples, list[float]] | None:
        """Return samples of the motion at the start and in windows, with half of the width of each of these.

        None where the motion is not known there: laws that need it are not checked then.
        """
        try:
            rated = self.samples
            if rated is None:
                rated = samples_of(self.description, np.zeros(1), sampler(np.zeros(1)), slice(None))
            placed: list[tuple[float, float]] = []
            if self.own and self.end > self.begin:
                placed = windows(self.random, self.answer, self.begin, self.end, quickness(self.description, rated))
            period = period_of(self.answer) if self.own else None
            repeated = [] if period is None else [times_of_period(period)]
            asked = np.concatenate([np.zeros(1), *(nodes(*one) for one in placed), *repeated])
            return samples_of(self.description, asked, sampler(asked), slice(None)), [half for _, half in placed]
        except MechanicsError:
            return None


def _fastest(samples: Samples) -> float:
    """Return the largest speed in some samples (m/s)."""
    return max(float(np.abs(twist.velocity).max(initial=0.0)) for twist in samples.motion.values())


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
