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
from typing import NamedTuple

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.definition import Touch
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import kinetic
from core.multibody.audit.failure import MARGIN, NOISE, Ledger
from core.multibody.audit.newton import Acceleration, Freedoms, balance
from core.multibody.audit.placement import STEP, Motion, Numbers, Placement, Pose, Twist, Undefined, moved
from core.multibody.audit.samples import ATTITUDE, POSITION, SPIN, VELOCITY, Samples
from core.systems.trajectory import MotionEvent

MOST_IMPACTS = 8
"""Impacts that are compared, all at once: each takes six samples, in two phases."""

NEAR = 2.0**-14
"""Distance of the samples, in units of the quickest motion."""

KNOWN = 2.0**-36
"""Share to which places are extrapolated, and with them the directions of impulses: the cube, a few dozen times."""

WEIGHTS = 7.0
"""Sum of the sizes of the weights of an extrapolation, by which it multiplies the errors of samples."""

CONE = 2.0**-20
"""Share of the largest friction beside which an impulse of it is below that: more than its error."""

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
    span : (float, float)
        Times between which there is a motion (s).
    at_begin : bool
        Whether it is what happens where that begins, in the midst of the answer, and nothing else.
    """

    def __init__(
        self,
        answer: SceneSolution,
        random: Random,
        quickness: float,
        span: tuple[float, float],
        *,
        at_begin: bool = False,
    ) -> None:
        begin, end = span
        self.step = NEAR / quickness if quickness > 0.0 else NEAR
        self.groups: list[list[MotionEvent]] = []
        grouped: dict[float, list[MotionEvent]] = defaultdict(list)
        for event in answer.events:
            grouped[event.time].append(event)
        # What begins at the instant of an impact may lead to another one, which begins with other rates.
        self.chained = {event.time for event in answer.events if event.kind == "begin"}
        times = np.array(sorted(grouped))
        for time, events in grouped.items():
            first = time if at_begin else begin + 3.0 * self.step
            if at_begin and not (time == begin and 3.0 * self.step < time):
                continue
            if not (at_begin or any(map(is_sudden, events))) or not first <= time < end - 3.0 * self.step:
                continue
            alone = (np.abs(times - time) < 4.0 * self.step).sum() == 1
            # Times of doubles are too coarse where the step is next to nothing beside them.
            if alone and self.step > 2.0**-26 * time and not _accumulates(answer, time, 4.0 * self.step):
                self.groups.append([event for event in events if is_sudden(event)] or events[:1])
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
        spun = all(samples.spun(name) for name, body in description.bodies.items() if body.inertia is not None)
        if not self.groups or not spun or description.undefined:
            return
        try:
            self._check(ledger, description, freedoms, samples)
        except Undefined:
            return

    def _check(self, ledger: Ledger, description: Description, freedoms: Freedoms, samples: Samples) -> None:
        before, after = (_extrapolated(samples, first) for first in (0, 3))
        times = np.array([group[0].time for group in self.groups])
        changes = {
            name: Acceleration(
                after.motion[name].velocity - twist.velocity, _minus(after.motion[name].spin, twist.spin)
            )
            for name, twist in before.motion.items()
        }
        still = {
            name: Twist(0.0 * twist.velocity, _minus(twist.spin, twist.spin)) for name, twist in before.motion.items()
        }
        impulses = _impulses(description, before.placement, still, self.groups)
        found = balance(description.impulsive, before.placement, still, changes, impulses, freedoms=freedoms)
        left, size = np.abs(found.left()), found.size.max(axis=0, initial=0.0)
        reach = min((one.reach for one in description.connections if one.reach > 0.0), default=1.0)
        tilt = np.max([one[:, ATTITUDE] + one[:, POSITION] / reach for one in samples.errors.values()], axis=0)[::ROWS]
        spins = [np.abs(one.spin).reshape(len(times), -1) for one in samples.motion.values() if one.spin is not None]
        spun = np.max([one.max(axis=1) for one in spins], axis=0) if spins else np.zeros(len(times))
        # Attitudes are extrapolated up to the cube of the angle between samples.
        tilt = tilt + (spun * self.step) ** 3
        momenta, speed = np.zeros(len(times)), np.zeros(len(times))
        arm = max((one.arm + one.reach for one in description.connections), default=0.0)
        # What is at rest is so to the noise of what holds it, however small that is said to be.
        turning = NOISE * NEAR / self.step
        for name, body in description.bodies.items():
            moved, turned = (
                before.unsure[name][k] + after.unsure[name][k] + noise
                for k, noise in enumerate((description.extent * turning, turning))
            )
            momenta = momenta + body.mass * moved + body.moment * turned
            speed = speed + moved + arm * turned
        known = (KNOWN + MARGIN * tilt) * size + MARGIN * momenta
        for k in np.flatnonzero(~(left <= known).all(axis=0)).tolist():
            worst = int(np.argmax(left[:, k]))
            own = slice(k, k + 1)
            ledger.compare("momentum at an impact", freedoms.body(worst), times[own], left[worst, own], known[own])
        self._check_energy(ledger, description, (before, after), times)
        velocities = [np.abs(one.velocity).reshape(len(times), -1).max(axis=1) for one in samples.motion.values()]
        fastest = np.max(velocities, axis=0) + arm * spun
        unsure = speed + (KNOWN + tilt) * fastest
        self._check_rates(ledger, description, (before, after), unsure)
        self._check_restitution(ledger, description, (before, after), unsure)

    def _check_energy(
        self, ledger: Ledger, description: Description, sides: tuple[_Side, _Side], times: Numbers
    ) -> None:
        if any(one.drives for one in description.connections):
            # What drives may bring energy while impulses act, whatever its rate is at the start.
            return
        energies = [kinetic(description, Samples(times, side.placement, side.motion, {}, {}, {})) for side in sides]
        loss = np.array([sum(event.energy_loss for event in group) for group in self.groups])
        allowed = KNOWN * (energies[0] + energies[1]) + 8.0 * ledger.rounding * np.abs(loss)
        for side in sides:
            for name, body in description.bodies.items():
                twist, (moved, turned) = side.motion[name], side.unsure[name]
                allowed = allowed + MARGIN * body.mass * np.abs(twist.velocity).sum(axis=1) * moved
                if twist.spin is not None:
                    allowed = (
                        allowed + MARGIN * body.moment * np.abs(twist.spin).reshape(len(times), -1).sum(axis=1) * turned
                    )
        ledger.compare("energy that an impact takes", "", times, energies[0] - energies[1] - loss, allowed)
        # A blow brings energy.
        blown = np.array([any(event.kind == "impulse" for event in group) for group in self.groups])
        ledger.compare(
            "no gain of energy at an impact", "", times, np.where(blown, 0.0, np.minimum(loss, 0.0)), allowed
        )

    def _check_rates(
        self, ledger: Ledger, description: Description, sides: tuple[_Side, _Side], known: Numbers
    ) -> None:
        """Compare the rates of the gaps that take impulses with those of the bodies, before and after."""
        for connection in description.connections:
            for force in connection.gaps(sides[0].placement) if connection.coefficients is not None else ():
                name = force.rsplit(".", 1)[0]
                # What strikes at the same instant changes the rates as well.
                plain = [
                    (k, group)
                    for k, group in enumerate(self.groups)
                    if all(event.rates for event in group) and group[0].time not in self.chained
                ]
                own = [(k, event) for k, group in plain for event in group if event.name == name]
                if not own:
                    continue
                rows, times = [k for k, _ in own], np.array([event.time for _, event in own])
                for side, when in zip(sides, ("before", "after"), strict=True):
                    seen = connection.gaps(moved(side.placement, side.motion, in_time=True))[force].imag[rows] / STEP
                    rates = [event.rates["normal"] for _, event in own]
                    stated = np.array([getattr(rate, when) for rate in rates])
                    allowed = MARGIN * known[rows] + np.array([rate.error for rate in rates])
                    ledger.compare(f"rate {when} an impact", connection.name, times, stated - seen, allowed)

    def _check_restitution(
        self, ledger: Ledger, description: Description, sides: tuple[_Side, _Side], known: Numbers
    ) -> None:
        """Compare the rates of the gap to which an impact happens; of several at once each may act more than once."""
        for connection in description.connections:
            touch = connection.coefficients
            for force in connection.gaps(sides[0].placement) if touch is not None else ():
                name = force.rsplit(".", 1)[0]
                rows = [
                    k
                    for k, group in enumerate(self.groups)
                    if len(group) == 1 and group[0].name == name and group[0].rates
                ]
                if not rows or touch is None:
                    continue
                before, after = (
                    connection.gaps(moved(side.placement, side.motion, in_time=True))[force].imag[rows] / STEP
                    for side in sides
                )
                # Bounces that are too small to be followed end: what has come to rest stays closed.
                off = np.minimum(np.abs(after + touch.restitution * before), np.abs(after))
                if touch.law != "newton" and touch.friction:
                    # The rates of the gap are in no fixed ratio, but do not close it.
                    off = np.minimum(after, 0.0)
                times = np.array([self.groups[k][0].time for k in rows])
                ledger.compare("restitution", connection.name, times, off, MARGIN * known[rows])
                if touch.law == "newton" and touch.friction:
                    first, then = (
                        connection.slips(side.placement, side.motion)[force].reshape(len(known), -1)[rows]
                        for side in sides
                    )
                    left = np.abs(then + touch.tangential * first).max(axis=1)
                    # Friction at its limit may not suffice.
                    held = np.array([_within_its_cone(self.groups[k][0], touch) for k in rows])
                    bounced = np.abs(after) > MARGIN * known[rows]
                    ledger.compare(
                        "tangential restitution",
                        connection.name,
                        times,
                        np.where(held & (bounced | (touch.restitution == 0.0)), left, 0.0),
                        MARGIN * known[rows],
                    )


def is_sudden(event: MotionEvent) -> bool:
    """Return whether an event changes rates: connections may share their impulses in other ways, not the energy."""
    return bool(event.impulses) or event.energy_loss != 0.0


def _within_its_cone(event: MotionEvent, touch: Touch) -> bool:
    """Return whether the friction of an impact is known to be less than it might be."""
    if any(error is None for error in event.errors.impulses.values()):
        return False
    rubs = [value for name, value in event.impulses.items() if name != "normal"]
    return float(np.linalg.norm(rubs)) < touch.kinetic * event.impulses["normal"] * (1.0 - CONE)


def _accumulates(answer: SceneSolution, time: float, step: float) -> bool:
    """Return whether bounces accumulate within a step of a time."""
    for phase in answer.phases or ():
        if phase.model == ACCUMULATING and phase.start < time + step and (phase.end is None or phase.end > time - step):
            return True
    return False


class _Side(NamedTuple):
    """The states on one side of some impacts.

    Attributes
    ----------
    unsure : mapping of str to two ndarrays
        How wrong the velocity and the spin of every body may be at each.
    """

    placement: Placement
    motion: Motion
    unsure: Mapping[str, tuple[Numbers, Numbers]]


def _extrapolated(samples: Samples, first: int) -> _Side:
    """Return the states on one side of impacts, from three of the samples of each, the nearest first.

    Parameters
    ----------
    first : int
        Number of the nearest among the samples of an impact.
    """
    near, next_to, far = (slice(first + k, None, ROWS) for k in range(3))

    def of(x: Numbers | None) -> Numbers | None:
        return None if x is None else 3.0 * (x[near] - x[next_to]) + x[far]

    def bend(x: Numbers | None, error: Numbers) -> Numbers:
        if x is None:
            return np.zeros(len(error[near]))
        changes = (x[near] - 2.0 * x[next_to] + x[far], x[near] - x[next_to])
        bent, changed = (np.abs(one).reshape(len(one), -1).max(axis=1) for one in changes)
        known: Numbers = bent + WEIGHTS * (error[near] + late * changed)
        return known

    # Times are doubles: of the step between two samples a share is rounding.
    late = np.spacing(np.abs(samples.times[near])) / np.abs(samples.times[next_to] - samples.times[near])

    placement, motion, unsure = {}, {}, {}
    for name, pose in samples.placement.items():
        twist, error = samples.motion[name], samples.errors[name]
        placement[name] = Pose(*map(of, pose))  # type: ignore[arg-type]
        motion[name] = Twist(*map(of, twist))  # type: ignore[arg-type]
        unsure[name] = bend(twist.velocity, error[:, VELOCITY]), bend(twist.spin, error[:, SPIN])
    return _Side(placement, motion, unsure)


def _minus(after: Numbers | None, before: Numbers | None) -> Numbers | None:
    return None if after is None or before is None else after - before


def _impulses(
    description: Description, placement: Placement, still: Motion, groups: Sequence[Sequence[MotionEvent]]
) -> Mapping[str, Numbers]:
    """Return the impulses of one-sided connections and of laws at every impact, NaN where contacts could share them."""
    impulses: dict[str, Numbers] = {}
    ends: dict[str, str] = {}
    for connection in description.connections:
        laws, gaps = connection.laws(placement, still), connection.gaps(placement)
        if gaps or laws:
            # What is one-sided or acts by a law takes no impulse but those that are answered.
            forces = [*connection.efforts(placement, still), *laws]
            impulses.update((force, np.zeros(len(groups))) for force in forces)
        ends.update((force.rsplit(".", 1)[0], force) for force in gaps)
        if connection.strikes:
            ends[connection.name] = ""
    for k, group in enumerate(groups):
        for event in group:
            for name, value in event.impulses.items() if event.name in ends else ():
                force = ends[event.name] if name == "normal" else f"{event.name}.{name}"
                shared = event.errors.impulses.get(name, 0.0) is None
                # Of impacts in turn a contact may take part in several at one time.
                impulses.setdefault(force, np.zeros(len(groups)))[k] += np.nan if shared else value
    return impulses
