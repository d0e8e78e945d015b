"""Momenta of bodies, and what conservative forces have done: functions of the state that are no coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from core.arrays import Floats
from core.multibody.algebra.polynomials import Poly, entry
from core.multibody.table.frames import Frame
from core.multibody.table.table import Table

Terms = list[tuple[float, int | None, int | None]]
"""Sums of factor times coordinate times rate, either of which may be missing."""


@dataclass(frozen=True)
class StateFunction:
    """A vector of the state, of one component in the plane.

    Attributes
    ----------
    unit : str
    components : list of terms
    """

    unit: str
    components: list[Terms] = field(default_factory=list)

    def at(self, q: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return the values at states of shape (t, n, 2), and the sums of the magnitudes of terms, each (t, k)."""
        found, size = (np.zeros((len(q), len(self.components))) for _ in range(2))
        for k, terms in enumerate(self.components):
            for factor, i, j in terms:
                term = np.full(len(q), factor)
                term = term if i is None else term * q[:, i, 0]
                term = term if j is None else term * v[:, j, 0]
                found[:, k] += term
                size[:, k] += np.abs(term)
        return found, size


def momenta(
    table: Table, frames: Mapping[str, Frame], beside: Mapping[str, tuple[StateFunction, StateFunction]]
) -> dict[str, StateFunction]:
    """Return momentum and angular momentum about the origin, of every body, of what has mass beside them, and of all.

    Parameters
    ----------
    beside : mapping of str to two StateFunctions
        What has mass and is no body.
    """
    dimension = len(next(iter(frames.values())).position)
    total = StateFunction("kg m/s", [[] for _ in range(dimension)])
    turning = StateFunction("kg m^2/s", [[] for _ in range(1 if dimension == 2 else 3)])
    found: dict[str, StateFunction] = {}
    each = dict(beside)
    for name, frame in frames.items():
        mass = float(entry(table.mass, (frame.position[0], frame.position[0])))
        own = StateFunction("kg m/s", [[(mass, None, i)] for i in frame.position])
        spin = StateFunction("kg m^2/s", _angular(table, frame, mass))
        each[name] = own, spin
    for name, (own, spin) in each.items():
        found[f"{name}.momentum"], found[f"{name}.angular_momentum"] = own, spin
        for whole, part in ((total, own), (turning, spin)):
            for terms, more in zip(whole.components, part.components, strict=True):
                terms.extend(more)
    return {"momentum": total, "angular_momentum": turning} | found


def _angular(table: Table, frame: Frame, mass: float) -> list[Terms]:
    """Return m r x v, and what the body turns with beside it."""
    if len(frame.position) == 2:
        x, y = frame.position
        terms: Terms = [(mass, x, y), (-mass, y, x)]
        if frame.direction is not None:
            c, s = frame.direction
            inertia = float(entry(table.mass, (c, c)))
            terms.extend([(inertia, c, s), (-inertia, s, c)])
        elif frame.turn is not None:
            terms.append((float(entry(table.mass, (frame.turn, frame.turn))), None, frame.turn))
        return [terms]
    found = _crossed(mass, frame.position, frame.position)
    if frame.axes is not None:
        for first in frame.axes:
            for second in frame.axes:
                low, high = sorted((first[0], second[0]))
                weight = float(entry(table.mass, (low, high)))
                if weight != 0.0:
                    found = [terms + more for terms, more in zip(found, _crossed(weight, first, second), strict=True)]
    elif frame.axis is not None:
        n = frame.axis[1]
        found = [
            terms + more
            for terms, more in zip(found, _crossed(float(entry(table.mass, (n[0], n[0]))), n, n), strict=True)
        ]
        for terms, i in zip(found, n, strict=True):
            terms.append((float(frame.spin_momentum), i, None))
    elif frame.turns is not None:
        for terms, turn in zip(found, frame.turns, strict=True):
            terms.append((float(entry(table.mass, (turn, turn))), None, turn))
    return found


def _crossed(factor: float, first: Sequence[int], second: Sequence[int]) -> list[Terms]:
    """Return the components of factor q x v."""
    return [
        [(factor, first[(i + 1) % 3], second[(i + 2) % 3]), (-factor, first[(i + 2) % 3], second[(i + 1) % 3])]
        for i in range(3)
    ]


def work_of_potential(potential: Poly, start: Floats, q: Floats) -> tuple[Floats, Floats]:
    """Return by how much a potential has fallen since the start, and the sum of the magnitudes of terms, each (t,).

    Formed by the change of the coordinates, so that what does not move has done nothing.
    """
    change = (q[..., 0] - start[None, :, 0]) + (q[..., 1] - start[None, :, 1])
    total, size = np.zeros(len(q)), np.zeros(len(q))
    for key, value in potential.items():
        factor = -float(value)
        if len(key) == 1:
            terms = [factor * change[:, key[0]]]
        elif len(key) == 2:
            i, j = key
            terms = [factor * change[:, i] * q[:, j, 0], factor * start[i, 0] * change[:, j]]
        else:
            continue
        for term in terms:
            total, size = total + term, size + np.abs(term)
    return total, size
