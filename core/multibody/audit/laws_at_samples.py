"""Laws that every sample keeps by itself: what is held or one-sided, friction, and forces that follow by a law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import hypot, sqrt

import numpy as np

from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import NOISE, ROUNDING, Ledger, Residual
from core.multibody.audit.placement import STEP, Numbers, Placement, Undefined, dot, moved
from core.multibody.audit.samples import EPSILON, Samples

ANGULAR = frozenset({"attitude", "axis"})
"""Measures that are formed of angles and cosines, which are known to rounding of one where everything is small."""

States = Mapping[str, Numbers]
"""By the force of a one-sided measure, its state at every sample, as the phases of the answer say: "open", "closed",
"stick", "slide", "slide back". Empty where the answer has no phases: strings are then taut."""


@dataclass(frozen=True)
class MeasureValues:
    """The measures of a connection at the samples of an audit, moved by an imaginary step along the motion.

    Attributes
    ----------
    held, gaps : mapping of str to ndarray, shape (n,) or (n, k)
        Complex: their rates are the imaginary parts over the step.
    """

    connection: Definition
    held: Mapping[str, Numbers]
    gaps: Mapping[str, Numbers]


def measured(description: Description, ahead: Placement) -> list[MeasureValues]:
    """Return the measures of all connections of which the samples have enough."""
    found = []
    for connection in description.connections:
        try:
            found.append(MeasureValues(connection, connection.held(ahead), connection.gaps(ahead)))
        except Undefined:
            continue
    return found


class Sizes:
    """How large the places, rates and forces of some samples are, beside which differences of them are known.

    Attributes
    ----------
    place, speed, spin : mapping of str to float
        Largest components of each body (m, m/s, rad/s).
    fastest : float
        Largest speed (m/s).
    extent : float
        Largest component of a place, or size of a connection (m).
    mass : float
        Of all (kg).
    force : ndarray, shape (n,)
        N.
    """

    def __init__(self, description: Description, samples: Samples) -> None:
        self.place = {name: float(np.abs(pose.position).max()) for name, pose in samples.placement.items()}
        self.speed = {name: float(np.abs(twist.velocity).max()) for name, twist in samples.motion.items()}
        self.spin = {
            name: float(np.abs(twist.spin).max())
            for name, twist in samples.motion.items()
            if twist.spin is not None
        }  # fmt: skip
        self.fastest = max(self.speed.values())
        self.extent = max(
            *self.place.values(), *(connection.arm + connection.reach for connection in description.connections), 0.0
        )
        mass = sum(body.mass for body in description.bodies.values()) + sum(one.mass for one in description.connections)
        self.mass = mass
        self.force = np.full(samples.times.shape, mass * hypot(*description.gravity))
        if samples.forces:
            self.force += np.nan_to_num(np.fmax.reduce([np.abs(force) for force in samples.forces.values()]))

    def typical(self) -> tuple[float, float]:
        """Return a speed and a spin that the forces would make (m/s, rad/s)."""
        extent = self.extent if self.extent > 0.0 else 1.0
        gain = float(self.force.max()) / self.mass if self.mass > 0.0 else 0.0
        return self.fastest + sqrt(gain * extent), self.fastest / extent + sqrt(gain / extent)

    def of(self, connection: Definition) -> tuple[float, float]:
        """Return how large the places and the rates are that the measures of a connection are formed of (m, m/s)."""
        arm = connection.arm + connection.reach
        # Rates that vanish are known beside those that the forces would make.
        size, speed = 0.0, max(self.fastest, NOISE / ROUNDING * self.typical()[0])
        for name in connection.bodies:
            size = max(size, self.place[name])
            # What is fixed in a body may be a difference of places in space, which are rounded.
            rounded = EPSILON / ROUNDING * (size + arm)
            speed = max(speed, self.spin.get(name, 0.0) * (arm + rounded))
        return size + arm, speed


def check_samples(
    ledger: Ledger, measures: Sequence[MeasureValues], samples: Samples, states: States, sizes: Sizes
) -> None:
    """Compare all connections with their definitions at some samples.

    Parameters
    ----------
    measures : sequence of MeasureValues
        At these samples, and perhaps at others behind them.
    """
    for own in measures:
        one = _Connection(ledger, own.connection, samples, states, sizes.force, *sizes.of(own.connection))
        try:
            one.check_held(own.held)
            one.check_gaps(own.gaps)
            one.check_laws()
            one.check_derived()
        except Undefined:
            continue


@dataclass(frozen=True)
class _Connection:
    """One connection at some samples.

    Attributes
    ----------
    scale : ndarray, shape (n,)
        Size of the forces of the scene (N).
    size, speed : float
        Of the places and the rates that it is formed of (m, m/s).
    """

    ledger: Ledger
    connection: Definition
    samples: Samples
    states: States
    scale: Numbers
    size: float
    speed: float

    @cached_property
    def known(self) -> bool:
        """Whether all rates of its bodies are answered."""
        samples = self.samples
        return all(samples.spun(name) or samples.placement[name].rotation is None for name in self.connection.bodies)

    def check_held(self, held: Mapping[str, Numbers]) -> None:
        """Hold measures that stay zero, their rates, and combinations of rates."""
        connection, samples = self.connection, self.samples
        for key, found in held.items():
            value = found[: len(samples.times)]

            def measure(at: Samples, key: str = key) -> Numbers:
                return connection.held(at.placement)[key]

            size = max(1.0, self.size) if key in ANGULAR else self.size
            self._hold(f"{key} held", measure, size, value.real)
            if self.known:

                def change(at: Samples, key: str = key) -> Numbers:
                    return connection.held(moved(at.placement, at.of(connection.bodies), in_time=True))[key].imag / STEP

                self._hold(f"rate of {key} held", change, self.speed, value.imag / STEP)
        if not connection.rolls or not self.known:
            return
        for key, rate in connection.held_rates(samples.placement, samples.motion).items():

            def slip(at: Samples, key: str = key) -> Numbers:
                return connection.held_rates(at.placement, at.motion)[key]

            self._hold(f"{key} held", slip, self.speed + connection.driven, rate)

    def check_gaps(self, gaps: Mapping[str, Numbers]) -> None:
        """Keep gaps open, those that are closed at zero, and their forces pushing; hold friction to its law."""
        for force, found in gaps.items():
            # Both ways around one drum are one step.
            steps = {abs(step) for step in self.connection.steps(force)}
            state = self.states.get(force)
            # Whole turns of several drums can make any length.
            if len(steps) <= 1:
                self._check_gap(force, found, state, max(steps, default=0.0))
            if force in self.samples.forces:
                self._check_force(force, state)

    def _check_gap(self, force: str, found: Numbers, state: Numbers | None, step: float) -> None:
        """Keep a gap open, or at zero, but for whole steps of it."""
        connection = self.connection

        def wound(gap: Numbers) -> Numbers:
            return gap - step * np.round(gap / step) if step else gap

        def measure(at: Samples) -> Numbers:
            return wound(connection.gaps(at.placement)[force])

        def change(at: Samples) -> Numbers:
            return connection.gaps(moved(at.placement, at.of(connection.bodies), in_time=True))[force].imag / STEP

        value = found[: len(self.samples.times)]
        gap = wound(value.real)
        if not step:
            self._hold(f"gap of {force} open", measure, self.size, gap, one_sided=True)
        closed = connection.closed(state, len(self.samples.times))
        if closed is not None and closed.any():
            self._hold(f"gap of {force} closed", measure, self.size, gap, rows=closed)
            if self.known:
                self._hold(f"rate of gap of {force} closed", change, self.speed, value.imag / STEP, rows=closed)

    def _check_force(self, force: str, state: Numbers | None) -> None:
        value = self.samples.forces[force]
        given = ~np.isnan(value)

        def push(at: Samples) -> Numbers:
            return at.forces[force]

        self._hold(f"{force} not negative", push, self.scale, value, forces=(force,), rows=given, one_sided=True)
        if state is not None:
            idle = given & (state == "open")
            self._hold(f"{force} of nothing that touches", push, 0.0, value, forces=(force,), rows=idle)
        touch = self.connection.coefficients
        if touch is not None and touch.friction and all(name in self.samples.forces for name in touch.friction):
            given = given & ~np.any([np.isnan(self.samples.forces[name]) for name in touch.friction], axis=0)
            self._check_friction(force, touch, state, given)

    def _check_friction(self, force: str, touch: Touch, state: Numbers | None, given: Numbers) -> None:
        """Hold friction to its cone; no slip where it sticks, and against the slip where it slides."""
        names = touch.friction
        every = (force, *names)

        def below(coefficient: float, at: Samples) -> Numbers:
            found: Numbers = coefficient * at.forces[force] - np.sqrt(sum(at.forces[name] ** 2 for name in names))
            return found

        within, full = partial(below, touch.static), partial(below, touch.kinetic)
        value = within(self.samples)
        law, scale = f"cone of friction of {force}", self.scale * self.connection.coefficient_size(self.size)
        self._hold(law, within, scale, value, forces=every, rows=given, one_sided=True)
        if state is None:
            return

        def slip(at: Samples) -> Numbers:
            return self.connection.slips(at.placement, at.motion)[force]

        def against(at: Samples) -> Numbers:
            rate = slip(at)
            if len(names) == 1:
                return -at.forces[names[0]] * rate
            return -dot(np.stack([at.forces[name] for name in names], axis=-1), rate)

        stuck = state == "stick"
        # Of a body of which only the axis is answered no place has a rate that is known.
        if stuck.any() and self.known:
            self._hold(f"stick of {force}", slip, self.speed, slip(self.samples), rows=stuck)
        sliding = given & ((state == "slide") | (state == "slide back"))
        if not sliding.any():
            return
        self._hold(f"sliding friction of {force}", full, scale, full(self.samples), forces=every, rows=sliding)
        if not self.known:
            return
        law, value = f"friction of {force} against the slip", against(self.samples)
        size = self.scale * self.speed
        self._hold(law, against, size, value, forces=every, rows=sliding, one_sided=True)

    def check_laws(self) -> None:
        """Compare forces that follow from places and rates with those that are answered."""
        connection, samples = self.connection, self.samples
        if not samples.forces or not self.known:
            return
        for key, value in self._laws(samples).items():
            if key not in samples.forces:
                continue

            def law(at: Samples, key: str = key) -> Numbers:
                return connection.without_steps(key, self._laws(at)[key] - at.forces[key])

            size = np.abs(value) + connection.law_size(samples.placement, self.size, self.speed)
            rest = connection.without_steps(key, value - samples.forces[key])
            rows = ~np.isnan(rest)
            if connection.switches:
                ahead = connection.ahead(samples.placement, samples.motion)
                rows &= ~connection.undecided(ahead, samples.motion)
            self._hold(f"law of {key}", law, size, rest, forces=(key,), rows=rows)

    def _laws(self, samples: Samples) -> Mapping[str, Numbers]:
        """Return the forces that follow from places and rates, those of several pieces by the piece that follows."""
        ahead = self.connection.ahead(samples.placement, samples.motion)
        return {key: value.real for key, value in self.connection.laws(ahead, samples.motion).items()}

    def check_derived(self) -> None:
        """Compare forces that follow from others of the connection with those that are answered."""
        connection, samples = self.connection, self.samples
        names = tuple(name for name in connection.forces if name in samples.forces)
        if not connection.derives or len(names) < len(connection.forces) or not self.known:
            return
        for key, value in connection.derived(samples.placement, samples.motion, samples.forces).items():
            if key not in samples.forces:
                continue

            def law(at: Samples, key: str = key) -> Numbers:
                return connection.derived(at.placement, at.motion, at.forces)[key] - at.forces[key]

            rest = value - samples.forces[key]
            self._hold(f"{key} by the others", law, self.scale, rest, forces=(*names, key), rows=~np.isnan(rest))

    def _hold(
        self,
        law: str,
        residual: Residual,
        size: Numbers | float,
        value: Numbers,
        *,
        forces: tuple[str, ...] = (),
        rows: Numbers | None = None,
        one_sided: bool = False,
    ) -> None:
        self.ledger.hold(
            law,
            self.connection.name,
            self.samples,
            residual,
            size,
            value=value,
            bodies=self.connection.bodies,
            forces=forces,
            rows=rows,
            one_sided=one_sided,
        )
