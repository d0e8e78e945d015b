"""Energies, momenta and works in time: those of the places and rates that are answered beside them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import numpy as np

from core.multibody.audit.bodies import RigidBody
from core.multibody.audit.definitions import Description
from core.multibody.audit.energy import kinetic, potential, size_of
from core.multibody.audit.failure import Ledger, propagated
from core.multibody.audit.laws import SpinningFrameDefinition
from core.multibody.audit.placement import Numbers, cross
from core.multibody.audit.samples import Columns, Part, Samples, samples_of
from core.systems.trajectory import Column

Total = Callable[[Samples], Numbers]
"""From samples to a number of each, or a vector."""

KINETIC, POTENTIAL = "energy.kinetic", "energy.potential"
WORK, PATH = ".work", ".path"
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


def check_works(ledger: Ledger, description: Description, samples: Samples, own: Part, *, phased: bool) -> None:
    """Require that all works together are the change of the kinetic energy, from the first row behind the start on.

    Parameters
    ----------
    samples : Samples
        Of which the last are those of the rows `own` of the columns of the answer.
    phased : bool
        Whether impacts may take something.
    """
    names = [name for name in own.columns if name.endswith(WORK)]
    if not names or not _works_are_all(description, set(names), phased=phased):
        return
    spun = all(samples.spun(name) for name, body in description.bodies.items() if body.inertia is not None)
    rows = np.argsort(own.times, kind="stable")
    rows = rows[own.times[rows] >= 0.0]
    if len(rows) < 2 or not spun:
        return
    some, total = samples.at(len(samples.times) - len(own.times) + rows), partial(kinetic, description)
    moving, done = total(some), np.array([own.values(name)[rows] for name in names])
    rest = done.sum(axis=0) - moving
    size = np.abs(done).sum(axis=0).max() + 4.0 * moving.max()
    allowed = 2.0 * sum(own.columns[name].error for name in names) + 4.0 * ledger.rounding * size
    off = np.abs(rest - rest[0])
    if (off > allowed).any():
        allowed = allowed + 2.0 * float(propagated(some, tuple(description.bodies), (), total).max())
    ledger.compare("works are the change of the kinetic energy", "", some.times, off, allowed)


def check_paths(ledger: Ledger, description: Description, own: Part) -> None:
    """Require that no path is shorter between two rows of an answer than the way between its places."""
    order = np.argsort(own.times, kind="stable")
    for name in description.bodies:
        if f"{name}{PATH}" not in own.columns or len(order) < 2:
            continue
        path, place = own.columns[f"{name}{PATH}"], own.columns[f"{name}.position"]
        gone, places = np.diff(own.values(f"{name}{PATH}")[order]), own.values(f"{name}.position")[order]
        way = np.linalg.norm(np.diff(places, axis=0), axis=1)
        allowed = 2.0 * (path.error + place.error) + ledger.rounding * float(np.abs(places).max())
        ledger.compare("path as long as its way", name, own.times[order][1:], np.minimum(gone - way, 0.0), allowed)


def _works_are_all(description: Description, names: set[str], *, phased: bool) -> bool:
    """Return whether the works of an answer are all that change the kinetic energy.

    Works that rigid bodies do not determine are left out of an answer; those of spinning frames are not among them.
    """
    needed = {f"gravity{WORK}"} if any(description.gravity) else set()
    for connection in description.connections:
        gaps = connection.gaps(description.start)
        if connection.kind == SpinningFrameDefinition.kind:
            return False
        if not gaps and not connection.strikes and (connection.lawful or connection.loads or connection.works()):
            needed.add(f"{connection.name}{WORK}")
        for force in gaps if phased else ():
            name, touch = force.rsplit(".", 1)[0], connection.coefficients
            needed |= {f"{name}.impacts{WORK}"}
            needed |= {f"{name}.friction{WORK}"} if touch is not None and touch.friction else set()
    return needed <= names and not description.undefined


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
    every: dict[str, Total] = {KINETIC: partial(kinetic, description)}
    if not any(connection.winds for connection in description.connections):
        every[POTENTIAL] = partial(potential, description)
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
