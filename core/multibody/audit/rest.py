"""The range of a number in which a scene stays at rest: forces balance it just inside, and none do just outside.

The forces of what holds bodies may have any value; what touches pushes, strings pull, and friction is within its cone.
Whether such forces balance weights, springs and loads is a least-squares problem in unknowns that are not negative: a
force of either sign is the difference of two, and a cone is spanned by the lines on it.

References
----------
C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from core.multibody.answer import RestEnd, RestRange
from core.multibody.audit.definition import Definition
from core.multibody.audit.definitions import Description, description_of
from core.multibody.audit.equilibria import none_of
from core.multibody.audit.failure import Failure, Ledger
from core.multibody.audit.newton import Freedoms, balance
from core.multibody.audit.placement import Motion, Numbers, Placement, Twist, Undefined
from core.multibody.language.scene import Scene

BALANCED = 1e-9
"""Share of the forces of a body that is left over where they balance, by rounding of the least squares."""

INSIDE = 1e-6
"""Distance from an end at which forces still balance, as a share of its value or of that from the written one."""

OUTSIDE = 1e-4
"""Distance at which none do. Where geometry is varied what is missing may grow with its square."""

LINES = 256
"""Lines that span a cone of friction in space; between them it is smaller by a share of 1 - cos(pi/256) = 8e-5."""

IN_SPACE = 1e-3
"""Distance on either side in space, where cones are known to that share."""

CLOSED = 1e-9
"""Gap of what touches, as a share of the size of the scene."""


def audited_range(scene: Scene, found: RestRange) -> Failure | None:
    """Return what is wrong with a range of rest, None where it is as the description says."""
    path = tuple(int(part) if part.isdecimal() else part for part in found.vary[1:].split("/"))
    ledger = Ledger()
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        try:
            if found.lower is None or found.upper is None:
                # What moves does not rest, whatever balances it.
                description = description_of(scene)
                if not _moves(description):
                    _require(ledger, "no rest as it is written", found, not _balanced(description, wide=True))
                return ledger.worst
            for end, sign in ((found.lower, -1.0), (found.upper, 1.0)):
                _check_end(ledger, scene, path, found, end, sign)
        except Undefined:
            return None
    return ledger.worst


def _check_end(
    ledger: Ledger, scene: Scene, path: tuple[str | int, ...], found: RestRange, end: RestEnd, sign: float
) -> None:
    space = description_of(scene).dimension == 3
    away = abs(end.value - found.written)
    size, within = max(away, abs(end.value)), IN_SPACE if space else INSIDE
    if end.error > within * size:
        # Beside zero an end is known relative to where it was looked for.
        return
    inside = end.value - sign * min(within * size, away / 2.0)
    if away > 0.0:
        _require(ledger, "rest inside its range", found, _balanced(_with(scene, path, inside), wide=False))
    beyond = end.value + sign * (IN_SPACE if space else OUTSIDE) * size
    # A range that reaches its bound says nothing of what is behind it, and signs of numbers have a meaning.
    if (end.beyond is not None or end.problem is not None) and beyond * end.value > 0.0:
        _require(ledger, "no rest outside its range", found, not _balanced(_with(scene, path, beyond), wide=True))


def _require(ledger: Ledger, law: str, found: RestRange, holds: bool) -> None:
    ledger.compare(law, found.vary, np.zeros(1), np.array([0.0 if holds else 1.0]), 0.0)


def _with(scene: Scene, path: tuple[str | int, ...], value: float) -> Description:
    return description_of(scene, {path: value})


def _moves(description: Description) -> bool:
    """Return whether bodies have velocities at the start, or connections require some."""
    for body in description.bodies.values():
        if any(x is not None and np.any(x) for x in (body.velocity, body.angular_velocity)):
            return True
    start = _at_start(description)
    return any(np.any(rate) for one in description.connections for rate in one.held_rates(*start).values())


def _balanced(description: Description, *, wide: bool) -> bool:
    """Return whether forces exist that balance a scene at its start.

    Parameters
    ----------
    wide : bool
        Whether the polygons in place of cones in space are around them, and not inside.
    """
    if description.undefined:
        raise Undefined(next(iter(description.undefined.values())))
    placement, still = _at_start(description)
    freedoms = Freedoms(description)
    gains = {name: none_of(description, name, 1) for name in description.bodies}
    idle = {
        name: np.zeros(1)
        for one in description.connections
        for name in one.efforts(placement, still).keys() - one.laws(placement, still).keys()
    }
    found = balance(description, placement, still, gains, idle, freedoms)
    lines: dict[str, list[Numbers]] = {"": [np.zeros(freedoms.count)]}
    for connection in description.connections:
        own = lines.setdefault(connection.name if connection.excluded else "", [])
        for line, numbers in _lines(description, connection, freedoms, placement, wide=wide):
            row = np.zeros(freedoms.count)
            row[numbers] = line
            own.append(row)
    weights = _weights(description, freedoms, found.size[:, 0])
    # Of both sides of a guide one presses.
    sides = {frozenset((one.name, one.excluded)) for one in description.connections if one.excluded}
    for pressing in product(*map(sorted, sides)):
        every = np.array([row for name in ("", *pressing) for row in lines[name]])
        if nonnegative(every.T * weights[:, None], found.rest[:, 0] * weights) <= BALANCED:
            return True
    return False


def _at_start(description: Description) -> tuple[Placement, Motion]:
    placement, still = {}, {}
    for name, pose in description.start.items():
        placement[name] = pose.at(None)
        turns = description.bodies[name].inertia is not None
        spin = np.zeros((1, 3) if description.dimension == 3 else 1) if turns else None
        still[name] = Twist(np.zeros((1, description.dimension)), spin)
    return placement, still


def _lines(
    description: Description, connection: Definition, freedoms: Freedoms, placement: Placement, *, wide: bool
) -> Iterator[tuple[Numbers, list[int] | slice]]:
    """Yield the directions of the forces of a connection that may have any size, with the freedoms they act on."""
    numbers, virtual = freedoms.virtual(connection.bodies)
    gaps, holding = connection.gaps(placement), connection.holding(placement, virtual)
    touch = connection.coefficients
    for force, gap in gaps.items():
        for step in connection.steps(force):
            gap = gap - step * np.round(gap / step)
        if float(gap[0]) > CLOSED * (description.extent or 1.0):
            continue
        normal = holding[force][:, 0]
        yield normal, numbers
        if touch is None or not touch.friction:
            continue
        slips = np.stack([holding[name][:, 0] for name in touch.friction])
        for way in _ways(slips, wide=wide):
            yield normal + touch.static * way, numbers
    if not gaps:
        for line in (*holding.values(), *connection.unanswered(placement, virtual)):
            yield line[:, 0], numbers
            yield -line[:, 0], numbers


def _ways(slips: Numbers, *, wide: bool) -> Numbers:
    """Return the directions of friction of unit size: both in the plane, many in the plane of contact of space.

    Parameters
    ----------
    slips : ndarray, shape (components, freedoms)
    """
    if len(slips) == 1:
        return np.concatenate([slips, -slips])
    plane = np.linalg.svd(slips, full_matrices=False)[0][:, :2]
    angles = np.arange(LINES) * (2.0 * np.pi / LINES)
    size = 1.0 / np.cos(np.pi / LINES) if wide else 1.0
    found: Numbers = size * np.stack([np.cos(angles), np.sin(angles)], axis=1) @ plane.T @ slips
    return found


def _weights(description: Description, freedoms: Freedoms, size: Numbers) -> Numbers:
    """Return by what the equations of each body are divided: the largest of its forces, and that times an arm."""
    weights, largest, arm = np.ones(freedoms.count), float(size.max(initial=0.0)) or 1.0, description.extent or 1.0
    for name, body in description.bodies.items():
        moving = freedoms.moving(name)
        own = float(size[moving].max()) or largest
        weights[moving] = 1.0 / own
        if body.inertia is not None:
            weights[freedoms.turning(name)] = 1.0 / (own * arm)
    return weights


def nonnegative(lines: Numbers, goal: Numbers) -> float:
    """Return by how much the nearest sum of nonnegative shares of some columns misses a vector (Lawson, Hanson)."""
    count = lines.shape[1]
    shares, used = np.zeros(count), np.zeros(count, dtype=bool)
    for _ in range(3 * count):
        rest = goal - lines @ shares
        gain = np.where(used, -np.inf, lines.T @ rest)
        best = int(np.argmax(gain))
        if gain[best] <= BALANCED * BALANCED or float(np.linalg.norm(rest)) <= BALANCED:
            break
        used[best] = True
        while True:
            wanted = np.zeros(count)
            wanted[used] = np.linalg.lstsq(lines[:, used], goal, rcond=None)[0]
            below = used & (wanted <= 0.0)
            if not below.any():
                break
            # As far as the first share that would become negative.
            shares += float(np.min(shares[below] / (shares[below] - wanted[below]))) * (wanted - shares)
            used &= shares > 0.0
            shares[~used] = 0.0
        shares = wanted
    return float(np.linalg.norm(goal - lines @ shares))
