"""Energies and momenta in time: those of the places and rates that are answered beside them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import numpy as np

from core.multibody.audit.bodies import RigidBody
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import kinetic, potential, size_of
from core.multibody.audit.failure import Ledger, propagated
from core.multibody.audit.placement import Numbers, cross
from core.multibody.audit.samples import Columns, Part, Samples, samples_of
from core.systems.trajectory import Column

Total = Callable[[Samples], Numbers]
"""From samples to a number of each, or a vector."""

KINETIC, POTENTIAL = "energy.kinetic", "energy.potential"
MOMENTUM, ANGULAR = "momentum", "angular_momentum"


def check_totals(ledger: Ledger, description: Description, samples: Samples, own: Part) -> None:
    """Compare the energies and momenta of an answer with its places and rates.

    Parameters
    ----------
    samples : Samples
        Of which the last are those of the rows `own` of the columns of the answer.
    """
    totals = _totals(description, samples, own.columns)
    samples = samples.at(slice(len(samples.times) - len(own.times), None)) if totals else samples
    for name, total in totals.items():
        column = own.columns[name]
        found, size = total(samples), _size(description, samples, name)
        off, allowed = _largest(found - own.values(name)), ledger.rounding * size + column.error
        if np.any(off > allowed):
            allowed = allowed + _largest(propagated(samples, tuple(description.bodies), (), total))
        ledger.compare("total of places and rates", name, samples.times, off, allowed)


def with_totals(description: Description, part: Part, names: Iterable[str], rounding: float) -> Columns:
    """Return the columns of samples, with the energies and momenta that some names and their components lack."""
    missing = {one for name in names for one in (name, name.rpartition(".")[0])} - part.columns.keys()
    if not any(name.endswith((KINETIC, POTENTIAL, MOMENTUM)) for name in missing):
        return part.columns
    samples, found = samples_of(description, [part]), dict(part.columns)
    for name, total in _totals(description, samples, missing).items():
        unsure = np.linalg.norm(propagated(samples, tuple(description.bodies), (), total), axis=1)
        error = rounding * float(_size(description, samples, name).max()) + float(unsure.max())
        found[name] = Column(total(samples), "", error, "closed form")
    return found


def _totals(description: Description, samples: Samples, names: Iterable[str]) -> dict[str, Total]:
    """Return the energies and momenta among some names by what they are of samples, as far as these have all it takes.

    What has mass beside the bodies has momenta that are not formed here.
    """
    every: dict[str, Total] = {KINETIC: partial(kinetic, description), POTENTIAL: partial(potential, description)}
    bodies = list(description.bodies.values())
    if not any(connection.mass for connection in description.connections):
        every |= {MOMENTUM: partial(_momentum, bodies), ANGULAR: partial(_angular, bodies)}
    every |= {f"{body.name}.{MOMENTUM}": partial(_momentum, [body]) for body in bodies}
    every |= {f"{body.name}.{ANGULAR}": partial(_angular, [body]) for body in bodies}
    spun = all(samples.spun(body.name) for body in bodies if body.inertia is not None)
    own = [name for name in names if name in every]
    # Of a top the axis alone is answered.
    return {name: every[name] for name in own if spun or not (name == KINETIC or name.endswith(ANGULAR))}


def _momentum(bodies: Iterable[RigidBody], samples: Samples) -> Numbers:
    total: Numbers = sum((body.mass * samples.motion[body.name].velocity for body in bodies), np.zeros(()))
    return total


def _angular(bodies: Iterable[RigidBody], samples: Samples) -> Numbers:
    """Return the angular momentum about the origin, r x m v + J w."""
    total: Numbers = np.zeros(())
    for body in bodies:
        pose, twist = samples.placement[body.name], samples.motion[body.name]
        r, v = pose.position, twist.velocity
        plane = r.shape[-1] == 2
        total = total + body.mass * (r[..., 0] * v[..., 1] - r[..., 1] * v[..., 0] if plane else cross(r, v))
        if body.inertia is None or twist.spin is None:
            continue
        if plane:
            total = total + body.inertia * twist.spin
            continue
        assert pose.rotation is not None, "a body with a spin has an attitude"
        own = np.einsum("...ji,...j->...i", pose.rotation, twist.spin)
        total = total + np.einsum("...ij,jk,...k->...i", pose.rotation, body.inertia, own)
    return total


def _size(description: Description, samples: Samples, name: str) -> Numbers:
    """Return the sum of the sizes of the terms of a total of all bodies, shape (n,)."""
    if name in (KINETIC, POTENTIAL):
        return 4.0 * size_of(description, samples, kinetic(description, samples))
    total: Numbers = np.zeros(samples.times.shape)
    for body in description.bodies.values():
        twist = samples.motion[body.name]
        speed = body.mass * np.abs(twist.velocity).max(axis=-1)
        if not name.endswith(ANGULAR):
            total = total + speed
            continue
        total = total + 4.0 * np.abs(samples.placement[body.name].position).max(axis=-1) * speed
        if twist.spin is not None:
            total = total + 9.0 * body.moment * np.abs(twist.spin).reshape(len(total), -1).max(axis=1)
    return total


def _largest(values: Numbers) -> Numbers:
    found: Numbers = np.abs(values).reshape(len(values), -1).max(axis=1)
    return found
