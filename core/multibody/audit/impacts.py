"""Impacts: the impulses of an answer change the momenta by what they should, and restitution and energy agree.

The state just before an impact, and just after it, is extrapolated from three samples on its side: the parabola through
them is wrong by less than it differs from the line through two. With dv and dw the
changes of velocity and spin, every virtual motion of one body has m dv.v + J dw.w = the sum of impulse x effort; what
holds bodies may add anything along the rates of what it holds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from random import Random

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.definition import Definition
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import kinetic
from core.multibody.audit.failure import MARGIN, Ledger
from core.multibody.audit.newton import Acceleration, Freedoms, balance
from core.multibody.audit.placement import Motion, Numbers, Placement, Pose, Twist, Undefined, rate
from core.multibody.audit.samples import ATTITUDE, POSITION, SPIN, VELOCITY, Samples
from core.systems.trajectory import MotionEvent

MOST_IMPACTS = 2
"""Impacts that are compared, six samples each."""

NEAR = 2.0**-14
"""Distance of the samples, in units of the quickest motion."""

KNOWN = 2.0**-36
"""Share to which places are extrapolated, and with them the directions of impulses: the cube, a few dozen times."""

WEIGHTS = 7.0
"""Sum of the sizes of the weights of an extrapolation, by which it multiplies the errors of samples."""

ROWS = 6
"""Samples of an impact."""

ACCUMULATING = "accumulating bounces"
"""Model of a phase with an impact of its own at every bounce."""


class Impacts:
    """Some impacts of an answer, with the times at which its motion is needed.

    Parameters
    ----------
    quickness : float
        Largest rate of the motion (rad/s).
    end : float
        Time up to which there is a motion (s).
    """

    def __init__(self, answer: SceneSolution, random: Random, quickness: float, end: float) -> None:
        self.step = NEAR / quickness if quickness > 0.0 else NEAR
        self.groups: list[list[MotionEvent]] = []
        grouped: dict[float, list[MotionEvent]] = defaultdict(list)
        for event in answer.events:
            grouped[event.time].append(event)
        times = np.array(sorted(grouped))
        for time, events in grouped.items():
            if not any(event.impulses for event in events) or not 3.0 * self.step < time < end - 3.0 * self.step:
                continue
            alone = (np.abs(times - time) < 4.0 * self.step).sum() == 1
            # Times of doubles are too coarse where the step is next to nothing beside them.
            if alone and self.step > 2.0**-26 * time and not _accumulates(answer, time, 4.0 * self.step):
                self.groups.append([event for event in events if event.impulses])
        if len(self.groups) > MOST_IMPACTS:
            self.groups = random.sample(self.groups, MOST_IMPACTS)
        steps = self.step * np.array([-1.0, -2.0, -3.0, 1.0, 2.0, 3.0])
        self.times: Numbers = np.concatenate([np.zeros(0), *(group[0].time + steps for group in self.groups)])

    def check(self, ledger: Ledger, description: Description, freedoms: Freedoms, samples: Samples) -> None:
        """Compare momenta, energies and rates of gaps.

        Parameters
        ----------
        samples : Samples
            At `times`.
        """
        if any(not samples.spun(name) for name, body in description.bodies.items() if body.inertia is not None):
            return
        if description.undefined:
            return
        for k, group in enumerate(self.groups):
            rows = samples.at(slice(ROWS * k, ROWS * (k + 1)))
            try:
                self._check(ledger, description, freedoms, rows, group)
            except Undefined:
                continue

    def _check(
        self,
        ledger: Ledger,
        description: Description,
        freedoms: Freedoms,
        rows: Samples,
        events: Sequence[MotionEvent],
    ) -> None:
        before, after = _extrapolated(rows.at(slice(0, 3))), _extrapolated(rows.at(slice(3, 6)))
        time = np.array([events[0].time])
        changes = {
            name: Acceleration(after[1][name].velocity - twist.velocity, _difference(after[1][name], twist))
            for name, twist in before[1].items()
        }
        still = {name: Twist(np.zeros_like(twist.velocity), _zero(twist)) for name, twist in before[1].items()}
        left, size = _rest(description, freedoms, before[0], still, changes, events)
        unsure = {
            name: (before[2][name][0] + after[2][name][0], before[2][name][1] + after[2][name][1])
            for name in description.bodies
        }
        reach = min((one.reach for one in description.connections if one.reach > 0.0), default=1.0)
        tilt = max(float(one[0, ATTITUDE] + one[0, POSITION] / reach) for one in rows.errors.values())
        spun = max((float(np.abs(twist.spin).max()) for twist in rows.motion.values() if twist.spin is not None),
                   default=0.0)  # fmt: skip
        # Attitudes are extrapolated up to the cube of the angle between samples.
        tilt += (spun * self.step) ** 3
        momenta = sum(
            body.mass * unsure[name][0] + _largest(body.inertia) * unsure[name][1]
            for name, body in description.bodies.items()
        )
        known = (KNOWN + MARGIN * tilt) * size + MARGIN * momenta
        worst = int(np.argmax(left))
        ledger.compare("momentum at an impact", freedoms.body(worst), time, left[worst : worst + 1], known)
        self._check_energy(ledger, description, rows, (before, after), events)
        arm = max((one.arm + one.reach for one in description.connections), default=0.0)
        speed = sum(velocity + arm * spin for velocity, spin in unsure.values())
        fastest = max(float(np.abs(twist.velocity).max()) for twist in rows.motion.values()) + arm * spun
        self._check_restitution(ledger, description, (before, after), events, speed + (KNOWN + tilt) * fastest)

    def _check_energy(
        self,
        ledger: Ledger,
        description: Description,
        rows: Samples,
        sides: Sequence[_Side],
        events: Sequence[MotionEvent],
    ) -> None:
        if any(connection.driven for connection in description.connections):
            # What drives may bring energy while impulses act.
            return
        energies = [
            float(kinetic(description, Samples(rows.times[:1], *side[:2], {}, rows.errors, {})).max()) for side in sides
        ]
        loss = sum(event.energy_loss for event in events)
        allowed = KNOWN * sum(energies) + 8.0 * ledger.rounding * abs(loss)
        for _, motion, unsure in sides:
            for name, body in description.bodies.items():
                spin = motion[name].spin
                allowed += MARGIN * body.mass * float(np.abs(motion[name].velocity).sum()) * unsure[name][0]
                if spin is not None:
                    allowed += MARGIN * _largest(body.inertia) * float(np.abs(spin).sum()) * unsure[name][1]
        off = np.array([energies[0] - energies[1] - loss])
        time = np.array([events[0].time])
        ledger.compare("energy that an impact takes", events[0].name, time, off, allowed)
        ledger.compare("no gain of energy at an impact", events[0].name, time, np.array([min(loss, 0.0)]), allowed)

    def _check_restitution(
        self,
        ledger: Ledger,
        description: Description,
        sides: Sequence[_Side],
        events: Sequence[MotionEvent],
        known: float,
    ) -> None:
        if len(events) > 1:
            # Of several at once each may act more than once.
            return
        found = _one_sided(description, events[0].name, sides[0][0])
        if found is None or found[0].coefficients is None:
            return
        connection, force = found
        rates = [float(rate(lambda at: connection.gaps(at)[force], *side[:2]).max()) for side in sides]
        assert connection.coefficients is not None, "the caller knows them"
        expected = -connection.coefficients.restitution * rates[0]
        # Bounces that are too small to be followed end: what has come to rest stays closed.
        off = min(abs(rates[1] - expected), abs(rates[1]))
        time = np.array([events[0].time])
        ledger.compare("restitution", connection.name, time, np.array([off]), MARGIN * known)


def _accumulates(answer: SceneSolution, time: float, step: float) -> bool:
    """Return whether bounces accumulate within a step of a time."""
    for phase in answer.phases or ():
        if phase.model == ACCUMULATING and phase.start < time + step and (phase.end is None or phase.end > time - step):
            return True
    return False


_Side = tuple[Placement, Motion, dict[str, tuple[float, float]]]
"""The state on one side of an impact, and how wrong the velocity and the spin of every body may be."""


def _extrapolated(rows: Samples) -> _Side:
    """Return the state on one side of an impact from three samples, the nearest first: as one sample."""

    def of(x: Numbers | None) -> Numbers | None:
        return None if x is None else 3.0 * (x[:1] - x[1:2]) + x[2:]

    def bend(x: Numbers) -> float:
        return float(np.abs(x[:1] - 2.0 * x[1:2] + x[2:]).max())

    placement, motion, unsure = {}, {}, {}
    for name, pose in rows.placement.items():
        twist, error = rows.motion[name], rows.errors[name][0]
        position, velocity = of(pose.position), of(twist.velocity)
        assert position is not None, "every body has a position"
        assert velocity is not None, "every body has a velocity"
        placement[name] = Pose(position, of(pose.rotation), of(pose.turn), of(pose.time))
        motion[name] = Twist(velocity, of(twist.spin))
        spin = 0.0 if twist.spin is None else bend(twist.spin) + WEIGHTS * float(error[SPIN])
        unsure[name] = bend(twist.velocity) + WEIGHTS * float(error[VELOCITY]), spin
    return placement, motion, unsure


def _largest(inertia: Numbers | None) -> float:
    return 0.0 if inertia is None else float(np.abs(inertia).max())


def _difference(after: Twist, before: Twist) -> Numbers | None:
    return None if after.spin is None or before.spin is None else after.spin - before.spin


def _zero(twist: Twist) -> Numbers | None:
    return None if twist.spin is None else np.zeros_like(twist.spin)


def _one_sided(description: Description, name: str, placement: Placement) -> tuple[Definition, str] | None:
    """Return the connection to which an event happens, and the force that keeps its gap."""
    for connection in description.connections:
        for force in connection.gaps(placement):
            if force.rsplit(".", 1)[0] == name:
                return connection, force
    return None


def _rest(
    description: Description,
    freedoms: Freedoms,
    placement: Placement,
    still: Motion,
    changes: Mapping[str, Acceleration],
    events: Sequence[MotionEvent],
) -> tuple[Numbers, float]:
    """Return what is left over of the changes of momenta less the impulses, shape (freedoms,), and its size."""
    impulses: dict[str, Numbers] = {}
    for connection in description.connections:
        forces = [*connection.efforts(placement, still), *connection.laws(placement, still)]
        if connection.gaps(placement) or connection.laws(placement, still):
            # What is one-sided or acts by a law takes no impulse but those that are answered.
            impulses.update((force, np.zeros(1)) for force in forces)
    for event in events:
        found = _one_sided(description, event.name, placement)
        if found is None:
            continue
        for name, value in event.impulses.items():
            force = found[1] if name == "normal" else f"{event.name}.{name}"
            shared = event.errors.impulses.get(name, 0.0) is None
            impulses[force] = np.array([np.nan if shared else value])
    found_rest = balance(description.impulsive, placement, still, changes, impulses, freedoms=freedoms)
    return np.abs(found_rest.left())[:, 0], float(found_rest.size.max(initial=0.0))
