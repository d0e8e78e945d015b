"""Equilibria of an answer: bodies are where connections hold them, forces balance there, and modes are those of it.

In the plane, and in space where all bodies are particles: there the answer says where everything is. With x small
changes of the places along what is free, the equations of motion are M x'' + D x' + K x = 0. The columns of K are rates
of what is left over of the equations at rest, where the forces that hold bodies keep their values but not their
directions; those of D are its rates with the velocities. All roots are compared at once: the product of s less each
root is det(s^2 M + s D + K)/det M at any s.

References
----------
L. Meirovitch, "Methods of Analytical Dynamics", 1970, chapter 5.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations
from math import hypot
from random import Random

import numpy as np

from core.multibody.answer import Equilibrium, SceneSolution
from core.multibody.audit.balanced import Accelerated, check_balance
from core.multibody.audit.definition import Definition
from core.multibody.audit.definitions import Description
from core.multibody.audit.failure import ROUNDING, Ledger
from core.multibody.audit.laws_at_samples import ANGULAR, Sizes
from core.multibody.audit.newton import Acceleration, Freedoms, balance
from core.multibody.audit.placement import Motion, Numbers, Placement, Pose, Twist, Undefined, turned
from core.multibody.audit.samples import ATTITUDE, POSITION, Samples

MOST_LINEARISED = 16
"""Equilibria whose modes are compared."""

STEP = 2.0**-12
"""Change of places by which rates are formed, as a share of the shortest length of the scene."""

SHORTEST = 2.0**-26
"""Share of the longest length below which two places of a connection are at one: their distance is rounding."""

ROOTS_KNOWN = 1e-8
"""Share to which the product over all roots is known at least: that of the rates, 1e-10, and some products."""

STENCIL = (-2.0, -1.0, 1.0, 2.0)
"""Multiples of a step at which a function is evaluated for its rate."""
WEIGHTS = np.array([[1.0, -8.0, 8.0, -1.0], [0.0, -6.0, 6.0, 0.0]]) / 12.0
"""Rates of a function from its values at multiples of a step, up to the fourth power of that, and up to the second."""

CURVED = 30.0
"""Times the square of what the second power of the step contributes to a rate that the fourth does at most."""

HELD = 1e-9
"""Singular value of unit rows below which they depend on one another."""


Measures = Callable[[Samples], dict[str, Numbers]]
"""From samples to all that is held at them."""


def check_equilibria(ledger: Ledger, description: Description, answer: SceneSolution, random: Random) -> None:
    """Compare all equilibria of an answer with the description, and the modes of some."""
    found = [one for one in answer.equilibria or () if all(map(np.isfinite, one.errors.positions.values()))]
    rigid = any(body.inertia is not None for body in description.bodies.values())
    if not found or description.undefined or (description.dimension == 3 and rigid):
        return
    samples = _samples(description, found)
    still = {name: none_of(description, name, len(found)) for name in description.bodies}
    freedoms = Freedoms(description)
    _check_places(ledger, description, samples)
    if any(connection.mass for connection in description.connections):
        # Forces act in it beside those at its ends.
        return
    nothing = np.zeros((freedoms.count, len(found)))
    moments = Accelerated(samples, still, nothing, starts=False)
    check_balance(ledger, description, freedoms, moments, law="forces balance in equilibrium")
    numbers = range(len(found)) if len(found) <= MOST_LINEARISED else random.sample(range(len(found)), MOST_LINEARISED)
    for k in numbers:
        try:
            _check_modes(ledger, description, freedoms, found[k], samples.at(slice(k, k + 1)))
        except (Undefined, np.linalg.LinAlgError):
            continue


def _check_places(ledger: Ledger, description: Description, samples: Samples) -> None:
    """Require places to be where connections hold bodies, and strings to be taut; whole turns do not matter."""
    sizes = Sizes(description, samples)
    for connection in description.connections:
        if any(connection.steps(force) for force in connection.gaps(description.start)):
            # Strings over drums wind up by whole turns.
            continue

        def measures(at: Samples, connection: Definition = connection) -> dict[str, Numbers]:
            found = {**connection.held(at.placement), **connection.gaps(at.placement)}
            attitude = found.get("attitude")
            if attitude is not None and description.dimension == 2:
                found["attitude"] = attitude - 2.0 * np.pi * np.round(attitude / (2.0 * np.pi))
            return found

        of_place = sizes.of(connection)[0]
        for key, value in measures(samples).items():
            size = max(1.0, of_place) if key in ANGULAR else of_place

            def measure(at: Samples, key: str = key, of: Measures = measures) -> Numbers:
                return of(at)[key]

            law, name = f"{key} held in equilibrium", connection.name
            ledger.hold(law, name, samples, measure, size, value=value, bodies=connection.bodies)


def _samples(description: Description, found: Sequence[Equilibrium]) -> Samples:
    """Return places at rest, known to their errors and to the doubles in which they are given."""
    placement, motion, errors, count = {}, {}, {}, len(found)
    for name, body in description.bodies.items():
        position = np.array([one.positions[name] for one in found])
        known = np.zeros((count, 4))
        known[:, POSITION] = [one.errors.positions[name] for one in found]
        known[:, POSITION] += 2.0**-52 * np.abs(position).max(axis=1)
        if body.inertia is None or body.start.turn is None:
            placement[name] = Pose(position)
            motion[name] = Twist(np.zeros_like(position))
        else:
            # Where no angle is answered none matters.
            turn = np.array([one.angles.get(name, float(body.start.turn)) for one in found])
            known[:, ATTITUDE] = [one.errors.angles.get(name, 0.0) for one in found]
            known[:, ATTITUDE] += 2.0**-52 * np.maximum(1.0, np.abs(turn))
            placement[name] = Pose(position, turned(turn), turn)
            motion[name] = Twist(np.zeros_like(position), np.zeros(count))
        errors[name] = known
    return Samples(np.zeros(count), placement, motion, {}, errors, {})


def none_of(description: Description, name: str, count: int) -> Acceleration:
    """Return the acceleration of a body that has none, at some samples."""
    still = np.zeros((count, description.dimension))
    if description.bodies[name].inertia is None:
        return Acceleration(still, None)
    return Acceleration(still, np.zeros(count) if description.dimension == 2 else np.zeros((count, 3)))


def _check_modes(
    ledger: Ledger, description: Description, freedoms: Freedoms, one: Equilibrium, sample: Samples
) -> None:
    """Compare the roots of the linear motion beside an equilibrium with those that are answered."""
    matrices = _linear(description, freedoms, sample)
    if matrices is None:
        return
    mass, damping, stiffness, share = matrices
    grows = any(mode.growth_rate > 0.0 for mode in one.modes)
    if one.stable is not None and not damping.any() and grows == one.stable:
        ledger.compare("stability of an equilibrium", "", np.zeros(1), np.ones(1), 0.0)
    roots = np.array([complex(mode.growth_rate, mode.frequency) for mode in one.modes])
    typical = float(np.abs(roots).max(initial=0.0))
    if not len(roots):
        ledger.compare("modes of an equilibrium", "", np.zeros(1), np.ones(1), 0.0)
    if not np.isfinite(roots).all() or typical == 0.0:
        return
    inverse = np.linalg.inv(mass)
    unknown = (ROOTS_KNOWN + share) * max(float(np.abs(inverse).max() * np.abs(stiffness).max()), typical**2)
    for root in roots:
        size = abs(root)
        if size <= 1e-3 * typical:
            # What hardly moves is no larger than what is known of the others.
            continue
        s = size * np.exp(0.7j)
        found = np.linalg.det(s * s * np.eye(len(mass)) + s * inverse @ damping + inverse @ stiffness)
        # Of undamped motions every mode is listed once, of others both real roots, and one of each complex pair.
        alone, apart = roots[roots.imag == 0.0], roots[roots.imag != 0.0]
        pairs = (s - apart) * (s - apart.conj())
        expected = [
            np.prod(s * s - roots**2) if len(roots) == len(mass) else np.inf,
            np.prod(pairs) * np.prod(s - alone) if 2 * len(apart) + len(alone) == 2 * len(mass) else np.inf,
        ]
        off = min(abs(found / value - 1.0) if np.isfinite(value) else np.inf for value in expected)
        allowed = len(mass) * unknown / size**2
        ledger.compare("modes of an equilibrium", "", np.zeros(1), np.array([off]), allowed)


def _holding(description: Description, freedoms: Freedoms, placement: Placement, motion: Motion) -> Numbers:
    """Return the directions of what holds bodies at some placements, shape (directions, freedoms, n)."""
    found = [np.zeros((0, freedoms.count, len(next(iter(placement.values())).position)))]
    for connection in description.connections:
        numbers, virtual = freedoms.virtual(connection.bodies)
        # The components of one force hold along one direction, which is given under the name of each.
        lines = {id(line): line for line in connection.holding(placement, virtual).values()}.values()
        for line in (*lines, *connection.unanswered(placement, virtual)):
            own = np.zeros((1, *found[0].shape[1:]))
            own[0, numbers] = line
            found.append(own)
    return np.concatenate(found)


def _complement(rows: Numbers) -> Numbers | None:
    """Return a basis at right angles to some directions as rows; None where they depend on one another."""
    count = len(rows)
    if not count:
        return np.eye(rows.shape[1])
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    if not size.all():
        return None
    _, values, every = np.linalg.svd(rows / size)
    if len(values) < count or values.min() < HELD:
        return None
    found: Numbers = every[count:]
    return found


def _linear(
    description: Description, freedoms: Freedoms, sample: Samples
) -> tuple[Numbers, Numbers, Numbers, float] | None:
    """Return mass, damping and stiffness along the free directions, and the share to which the stiffness is known.

    None where nothing is free, or what holds depends on one another.
    """
    free = _complement(_holding(description, freedoms, sample.placement, sample.motion)[:, :, 0])
    if free is None or not len(free):
        return None
    (shortest, away), count = _lengths(description, sample.placement), len(free)
    step = STEP * shortest
    still = np.zeros((1, freedoms.count))
    changes = np.concatenate([still, *(step * s * free for s in STENCIL), 0.0 * free, 0.0 * free])
    rates = np.concatenate([still, *(0.0 * free for _ in STENCIL), free, -free])
    placement, motion = _beside(description, freedoms, sample.placement, changes, rates)
    gains, many = {name: none_of(description, name, len(changes)) for name in description.bodies}, len(changes)
    held = _holding(description, freedoms, placement, motion)
    idle = {
        name: np.zeros(many)
        for one in description.connections
        for name in one.efforts(placement, motion).keys() - one.laws(placement, motion).keys()
    }
    balanced = balance(description, placement, motion, gains, idle, freedoms)
    values = np.linalg.lstsq(held[:, :, 0].T, balanced.rest[:, 0], rcond=None)[0]
    found = balanced.rest - np.einsum("k,kft->ft", values, held)
    moved_by = found[:, 1 : 1 + 4 * count].reshape(freedoms.count, 4, count)
    stiffness, roughly = free @ np.einsum("ek,ikj->eij", WEIGHTS, moved_by) / step
    largest = float(np.abs(stiffness).max())
    share = np.inf
    if largest > 0.0:
        # Lengths are differences of coordinates, each rounded.
        noise = ROUNDING * away * float(balanced.size.max(initial=0.0) + np.abs(values).sum()) / step
        share = noise / largest + CURVED * (float(np.abs(stiffness - roughly).max()) / largest) ** 2
    first = 1 + 4 * count
    damping = (found[:, first : first + count] - found[:, first + count :]) / 2.0
    masses = np.zeros(freedoms.count)
    for name, body in description.bodies.items():
        masses[freedoms.moving(name)] = body.mass
        if body.inertia is not None:
            masses[freedoms.turning(name)] = body.inertia
    damping = free @ damping
    if np.abs(damping).max() <= ROUNDING * np.abs(found).max():
        damping = np.zeros_like(damping)
    return (free * masses) @ free.T, damping, stiffness, share


def _lengths(description: Description, placement: Placement) -> tuple[float, float]:
    """Return the shortest length by which forces change their directions (m), and coordinates in units of it.

    However far from the origin a scene is, rates are formed by changes that are small beside its own lengths.
    """
    connections = description.connections
    own = [connection.reach for connection in connections if connection.reach > 0.0]
    arms = (hypot(*place.offset) for connection in connections for place in connection.places if place.body is not None)
    own += [arm for arm in arms if arm > 0.0]
    between = [
        float(np.linalg.norm(a.at(placement) - b.at(placement)))
        for connection in connections
        for a, b in combinations(connection.places, 2)
    ]
    longest = max([*own, *between], default=0.0)
    shortest = min([*own, *(x for x in between if x > SHORTEST * longest)], default=description.extent or 1.0)
    placed = max(float(np.abs(pose.position).max()) for pose in placement.values())
    return shortest, max(1.0, max(placed, description.extent) / shortest)


def _beside(
    description: Description, freedoms: Freedoms, placement: Placement, changes: Numbers, rates: Numbers
) -> tuple[Placement, Motion]:
    """Return placements that are changed along the freedoms, shape (n, freedoms), and motions with such rates."""
    places: dict[str, Pose] = {}
    motion: dict[str, Twist] = {}
    for name, pose in placement.items():
        own = freedoms.moving(name)
        if description.bodies[name].inertia is None or pose.turn is None:
            places[name], motion[name] = Pose(pose.position + changes[:, own]), Twist(rates[:, own])
            continue
        angle = freedoms.turning(name).start
        turn = pose.turn + changes[:, angle]
        places[name] = Pose(pose.position + changes[:, own], turned(turn), turn)
        motion[name] = Twist(rates[:, own], rates[:, angle])
    return places, motion
