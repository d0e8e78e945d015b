"""Laws that every sample keeps by itself: what is held or one-sided, friction, and forces that follow by a law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.multibody.audit.definition import Definition, Touch
from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import Ledger, Residual
from core.multibody.audit.placement import STEP, Numbers, Placement, Undefined, dot, moved
from core.multibody.audit.samples import Samples

States = Mapping[str, Numbers]
"""By the force of a one-sided measure, its state at every sample, as the phases of the answer say: "open", "closed",
"stick", "slide", "slide back". Empty where the answer has no phases: strings are then taut."""


def check_samples(ledger: Ledger, description: Description, samples: Samples, states: States, fastest: float) -> None:
    """Compare all connections with their definitions at some samples.

    Parameters
    ----------
    fastest : float
        Largest speed in the motion (m/s), beside which rates that vanish are known.
    """
    ahead = moved(samples.placement, samples.motion)
    mass = sum(body.mass for body in description.bodies.values()) + sum(one.mass for one in description.connections)
    pull = mass * float(np.linalg.norm(description.gravity))
    scale = pull + np.zeros(samples.times.shape)
    if samples.forces:
        scale = scale + np.abs(np.stack(list(samples.forces.values()))).max(axis=0)
    for connection in description.connections:
        try:
            one = _Connection(ledger, connection, samples, ahead, states, fastest, scale)
            one.check_held()
            one.check_gaps()
            one.check_laws()
            one.check_derived()
        except Undefined:
            continue


@dataclass(frozen=True)
class _Connection:
    """One connection at some samples.

    Attributes
    ----------
    ahead : mapping of str to Pose
        The placement moved by an imaginary step along the motion.
    fastest : float
    scale : ndarray, shape (n,)
        Size of the forces of the scene (N).
    """

    ledger: Ledger
    connection: Definition
    samples: Samples
    ahead: Placement
    states: States
    fastest: float
    scale: Numbers

    @property
    def known(self) -> bool:
        """Whether all rates of its bodies are answered."""
        samples = self.samples
        return all(samples.spun(name) or samples.placement[name].rotation is None for name in self.connection.bodies)

    def sizes(self) -> tuple[float, float]:
        """Return how large the places and the rates are that it is formed of, in all samples (m, m/s)."""
        arm = self.connection.arm + self.connection.reach
        size, speed = 0.0, self.fastest
        for name in self.connection.bodies:
            pose, twist = self.samples.placement[name], self.samples.motion[name]
            size = max(size, float(np.abs(pose.position).max()))
            speed = max(speed, float(np.abs(twist.velocity).max()))
            if twist.spin is not None and arm:
                speed = max(speed, float(np.abs(twist.spin).max()) * arm)
        return size + arm, speed

    def check_held(self) -> None:
        """Hold measures that stay zero, their rates, and combinations of rates."""
        connection, samples = self.connection, self.samples
        held = connection.held(self.ahead)
        if held:
            size, speed = self.sizes()
        for key, value in held.items():

            def measure(at: Samples, key: str = key) -> Numbers:
                return connection.held(at.placement)[key]

            self._hold(f"{key} held", measure, size, value=value.real)
            if self.known:

                def change(at: Samples, key: str = key) -> Numbers:
                    return connection.held(moved(at.placement, at.of(connection.bodies)))[key].imag / STEP

                self._hold(f"rate of {key} held", change, speed, value=value.imag / STEP)
        if not connection.rolls or not self.known:
            return
        for key, rate in connection.held_rates(samples.placement, samples.motion).items():

            def slip(at: Samples, key: str = key) -> Numbers:
                return connection.held_rates(at.placement, at.motion)[key]

            self._hold(f"{key} held", slip, self.sizes()[1] + connection.driven, value=rate)

    def check_gaps(self) -> None:
        """Keep gaps open, those that are closed at zero, and their forces pushing; hold friction to its law."""
        connection = self.connection
        gaps = connection.gaps(self.ahead)
        if gaps:
            size, speed = self.sizes()
        for force, value in gaps.items():
            steps = connection.steps(force)
            if len(steps) > 1:
                # Whole turns of several drums can make any length.
                continue
            step = steps[0] if steps else 0.0

            def measure(at: Samples, force: str = force, step: float = step) -> Numbers:
                found = connection.gaps(at.placement)[force]
                return found - step * np.round(found / step) if step else found

            def change(at: Samples, force: str = force) -> Numbers:
                return connection.gaps(moved(at.placement, at.of(connection.bodies)))[force].imag / STEP

            state = self.states.get(force)
            if not step:
                self._hold(f"gap of {force} open", measure, size, value=value.real, one_sided=True)
            closed = connection.closed(state, len(self.samples.times))
            if closed is not None and closed.any():
                self._hold(f"gap of {force} closed", measure, size, rows=closed)
                if self.known:
                    self._hold(f"rate of gap of {force} closed", change, speed, rows=closed)
            if force in self.samples.forces:
                self._check_force(force, state, speed)

    def _check_force(self, force: str, state: Numbers | None, speed: float) -> None:
        def push(at: Samples) -> Numbers:
            return at.forces[force]

        value = self.samples.forces[force]
        self._hold(f"{force} not negative", push, self.scale, forces=(force,), value=value, one_sided=True)
        if state is not None and (state == "open").any():
            self._hold(f"{force} of nothing that touches", push, 0.0, forces=(force,), rows=state == "open")
        touch = self.connection.coefficients
        if touch is not None and touch.friction and all(name in self.samples.forces for name in touch.friction):
            self._check_friction(force, touch, state, speed)

    def _check_friction(self, force: str, touch: Touch, state: Numbers | None, speed: float) -> None:
        """Hold friction to its cone; no slip where it sticks, and against the slip where it slides."""
        names = touch.friction
        every = (force, *names)

        def within(at: Samples) -> Numbers:
            return touch.static * at.forces[force] - np.sqrt(sum(at.forces[name] ** 2 for name in names))

        self._hold(f"cone of friction of {force}", within, self.scale, forces=every, one_sided=True)
        if state is None:
            return

        def slip(at: Samples) -> Numbers:
            return self.connection.slips(at.placement, at.motion)[force]

        if (state == "stick").any():
            self._hold(f"stick of {force}", slip, speed, rows=state == "stick")
        sliding = (state == "slide") | (state == "slide back")
        if not sliding.any():
            return

        def full(at: Samples) -> Numbers:
            return touch.kinetic * at.forces[force] - np.sqrt(sum(at.forces[name] ** 2 for name in names))

        def against(at: Samples) -> Numbers:
            rate = slip(at)
            if len(names) == 1:
                return -at.forces[names[0]] * rate
            return -dot(np.stack([at.forces[name] for name in names], axis=-1), rate)

        self._hold(f"sliding friction of {force}", full, self.scale[sliding], forces=every, rows=sliding)
        size = self.scale[sliding] * speed
        self._hold(f"friction of {force} against the slip", against, size, forces=every, rows=sliding, one_sided=True)

    def check_laws(self) -> None:
        """Compare forces that follow from places and rates with those that are answered."""
        connection, samples = self.connection, self.samples
        if not samples.forces or not self.known:
            return
        for key, value in connection.laws(samples.placement, samples.motion).items():
            if key not in samples.forces:
                continue

            def law(at: Samples, key: str = key) -> Numbers:
                return connection.laws(at.placement, at.motion)[key] - at.forces[key]

            size = np.abs(value) + connection.law_size(samples.placement, *self.sizes())
            self._hold(f"law of {key}", law, size, forces=(key,), value=value - samples.forces[key])

    def check_derived(self) -> None:
        """Compare forces that follow from others of the connection with those that are answered."""
        connection, samples = self.connection, self.samples
        names = tuple(name for name in connection.forces if name in samples.forces)
        if not connection.derives or len(names) < len(connection.forces) or not self.known:
            return
        for key in connection.derived(samples.placement, samples.motion, samples.forces):
            if key not in samples.forces:
                continue

            def law(at: Samples, key: str = key) -> Numbers:
                return connection.derived(at.placement, at.motion, at.forces)[key] - at.forces[key]

            self._hold(f"{key} by the others", law, self.scale, forces=(*names, key))

    def _hold(
        self,
        law: str,
        residual: Residual,
        size: Numbers | float,
        *,
        forces: tuple[str, ...] = (),
        value: Numbers | None = None,
        rows: Numbers | None = None,
        one_sided: bool = False,
    ) -> None:
        samples = self.samples if rows is None else self.samples.at(rows)
        self.ledger.hold(
            law,
            self.connection.name,
            samples,
            residual,
            size,
            bodies=self.connection.bodies,
            forces=forces,
            value=value,
            one_sided=one_sided,
        )
