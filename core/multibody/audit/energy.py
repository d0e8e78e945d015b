"""Energy: what the answer states of it, and that it stays the same where nothing takes or brings any."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np

from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import Ledger
from core.multibody.audit.placement import Numbers
from core.multibody.audit.samples import Samples


def kinetic(description: Description, samples: Samples) -> Numbers:
    """Return the kinetic energy (J), shape (n,)."""
    total: Numbers = np.zeros(())
    for name, body in description.bodies.items():
        pose, twist = samples.placement[name], samples.motion[name]
        total = total + body.mass / 2.0 * (twist.velocity**2).sum(axis=-1)
        if body.inertia is None or twist.spin is None:
            continue
        if description.dimension == 2:
            total = total + body.inertia / 2.0 * twist.spin**2
            continue
        assert pose.rotation is not None, "a body with a spin has an attitude"
        own = np.einsum("...ji,...j->...i", pose.rotation, twist.spin)
        total = total + np.einsum("...i,ij,...j->...", own, body.inertia, own) / 2.0
    for connection in description.connections:
        total = total + connection.kinetic(samples.placement, samples.motion)
    return total


def potential(description: Description, samples: Samples) -> Numbers:
    """Return the potential energy (J), that of gravity from the origin, shape (n,)."""
    total: Numbers = np.zeros(())
    for name, body in description.bodies.items():
        total = total - body.mass * (samples.placement[name].position * np.array(description.gravity)).sum(axis=-1)
    for connection in description.connections:
        total = total + connection.potential(samples.placement)
    return total


def size_of(description: Description, samples: Samples, moving: Numbers) -> Numbers:
    """Return the sum of the sizes of all energies (J), shape (n,), of which the kinetic one is given."""
    total = np.abs(moving)
    pull = hypot(*description.gravity)
    for name, body in description.bodies.items():
        # Whatever the direction: a component that vanishes is known to rounding of the others.
        total = total + body.mass * pull * np.abs(samples.placement[name].position).max(axis=-1)
    for connection in description.connections:
        total = total + np.abs(connection.potential(samples.placement))
    return total


def potential_error(description: Description, samples: Samples, rounding: float) -> Numbers:
    """Return by how much rounding of places and turns moves the potential energy (J), shape (n,), also at zero.

    Parameters
    ----------
    rounding : float
        Share of the largest coordinate to which places are known, and of half a turn.
    """
    placed = samples.placement
    size = np.max([np.abs(one.position).max(axis=-1) for one in placed.values()], axis=0)
    at_rest, total = potential(description, samples), np.zeros(())
    for name, one in placed.items():
        moved = [
            one._replace(position=one.position + rounding * size[:, None] * e) for e in np.eye(one.position.shape[-1])
        ]
        if one.turn is not None:
            moved.append(one._replace(turn=one.turn + rounding * (np.pi + np.abs(one.turn))))
        for other in moved:
            beside = replace(samples, placement={**placed, name: other})
            total = total + np.abs(potential(description, beside) - at_rest)
    return total


class Energies:
    """Energies at the samples of an audit, of which the first is that of the start (J), shapes (n,)."""

    def __init__(self, description: Description, samples: Samples) -> None:
        self.description, self.samples = description, samples
        self.kinetic, self.potential = kinetic(description, samples), potential(description, samples)
        self.size = size_of(description, samples, self.kinetic)

    def check(self, ledger: Ledger, losses: Sequence[tuple[float, float]]) -> None:
        """Require the energy to be that of the start, less what events have taken.

        Parameters
        ----------
        losses : sequence of (float, float)
            Times of events and what they take (J).
        """
        samples, start = self.samples, self.kinetic[0] + self.potential[0]
        # What an impact at the start takes is gone from the motion before its first sample.
        taken = [(time, loss) for time, loss in losses if time > 0.0]

        def missing(times: Numbers) -> Numbers:
            return sum((np.where(times >= time, loss, 0.0) for time, loss in taken), -start * np.ones(times.shape))

        def change(at: Samples) -> Numbers:
            return kinetic(self.description, at) + potential(self.description, at) + missing(at.times)

        value = self.kinetic + self.potential + missing(samples.times)
        size = self.size + self.size[0] + sum(abs(loss) for _, loss in losses)
        ledger.hold("energy", "", samples, change, 4.0 * size, value=value, bodies=tuple(self.description.bodies))
