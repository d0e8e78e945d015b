"""Whether a start is the nearest to a sketch: that it satisfies the connections, and that no step along them is nearer.

At the nearest places the gradient of the displacement is a combination of the gradients of what is held. Displacement
is the sum over the bodies of the mean square of that of their points; its gradient along a virtual motion (v, w) of a
body is dx.v + w.(sum of R r x (R - R_0) r), with the second moments of its matter about the centre of mass.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.multibody.audit.definitions import Description, description_of
from core.multibody.audit.failure import ROUNDING, Failure, Ledger
from core.multibody.audit.newton import Freedoms
from core.multibody.audit.placement import STEP, Numbers, Placement, moved
from core.multibody.language.scene import Scene, at_start

STATIONARY = 2.0**-26
"""Share of the displacement to which its gradient is known: what is held is of rank only to half the digits."""

THIN = 1e-4
"""Share of its largest moment of inertia below which a body has an extent of its own in the metric: not checked."""


def audited_assembly(sketch: Scene, found: Scene) -> Failure | None:
    """Return the law that places which were found for a sketch do not keep, None where they keep all.

    Parameters
    ----------
    sketch : Scene
        As the client wrote it, with `assemble`.
    found : Scene
        With the places that are taken in its place.
    """
    description, start = description_of(at_start(sketch)), description_of(at_start(found)).start
    if not description.moderate:
        return None
    names = tuple(sketch.bodies) if sketch.assemble == "nearest" else tuple(sketch.assemble["nearest"])  # type: ignore[index]
    placement = {name: pose.at(None) for name, pose in start.items()}
    _, virtual = Freedoms(description).virtual(names)
    count = len(virtual[names[0]].velocity)
    ahead, ledger, rows, none = moved(placement, virtual), Ledger(ROUNDING), [], np.zeros(1)
    for connection in description.connections:
        if not set(connection.bodies) & set(names):
            continue
        known = 8.0 * ROUNDING * (description.extent + connection.arm + connection.reach)
        for key, value in connection.held(ahead).items():
            off = np.abs(value.real).reshape(count, -1)[:1]
            ledger.compare(f"{key} held by the nearest places", connection.name, none, off.max(axis=1), known)
            rows.append(value.imag.reshape(count, -1) / STEP)
        for key, value in connection.gaps(ahead).items():
            gap = value.real.reshape(count, -1)[0]
            ledger.compare(f"gap {key} of the nearest places", connection.name, none, np.minimum(gap, 0.0), known)
            if (np.abs(gap) <= known).all():
                rows.append(value.imag.reshape(count, -1) / STEP)
    slope = _slope(description, names, placement)
    if slope is not None and rows:
        lines = np.concatenate(rows, axis=1)
        left = slope - lines @ np.linalg.lstsq(lines, slope, rcond=STATIONARY)[0]
        allowed = STATIONARY * float(np.abs(slope).max()) + ROUNDING * description.extent
        worst = np.abs(left).max(initial=0.0)
        ledger.compare("the places are the nearest", "", none, np.array([worst]), allowed)
    return ledger.worst


def _slope(description: Description, names: Sequence[str], placement: Placement) -> Numbers | None:
    """Return the gradient of half the displacement along the virtual motions of some bodies, None if not known here."""
    found: list[Numbers] = []
    for name in names:
        body, pose = description.bodies[name], placement[name]
        found.append(pose.position[0] - body.start.position)
        if body.inertia is None:
            continue
        before = body.start.rotation
        if body.mass == 0.0 or pose.rotation is None or before is None:
            return None
        after = pose.rotation[0]
        if description.dimension == 2:
            if not body.inertia > 0.0:
                return None
            across = before[0, 0] * after[1, 0] - before[1, 0] * after[0, 0]
            found.append(np.array([body.inertia / body.mass * across]))
            continue
        second = (np.trace(body.inertia) / 2.0 * np.eye(3) - body.inertia) / body.mass
        if np.linalg.eigvalsh(second)[0] < THIN * np.trace(second):
            return None
        product = after @ second @ (after - before).T
        found.append(np.array([product[i, j] - product[j, i] for i, j in ((1, 2), (2, 0), (0, 1))]))
    return np.concatenate(found)
