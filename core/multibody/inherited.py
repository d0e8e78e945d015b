"""What the uncertainty of a description's numbers does to its motion.

Every number is moved in turn by a share 2^-70 of itself, in balls, and the motion is computed again in pairs of
doubles. The differences, divided by that share, are derivatives to 2^-28 or better. The sum of their magnitudes times
the uncertainty is what independent errors of all inputs can do, to first order. Formulas are exact: where a formula is
to be uncertain, the numbers that it uses stand in `let`. The equal entries of one tensor are one number, because a body
that is symmetric is to remain so.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from core.errors import MechanicsError, NotApplicable, Path
from core.multibody.answer import Column
from core.multibody.columns import Columns, relative
from core.multibody.language import Scene
from core.multibody.modelling import Modelled, modelled
from core.multibody.numerals import SHIFT, Numerals
from core.multibody.packed import Floats
from core.multibody.polynomials import Ball
from core.multibody.rank import independent
from core.multibody.whole import Whole, WholeStates

MOST_INPUTS = 100
"""Numbers that are moved; each costs a motion of its own."""

LOOKS = 64
"""Times between the start and the last sample at which the horizon is looked for, on either side."""


@dataclass(frozen=True)
class Changes:
    """Largest changes of places and rates by relative errors of one in every input, to first order.

    Attributes
    ----------
    times : ndarray, shape (t,)
    q, v : ndarray, shape (t, n)
        Sums of magnitudes, in SI units, of every coordinate as described.
    """

    whole: Whole
    times: Floats
    q: Floats
    v: Floats

    def of_columns(self, rows: np.ndarray) -> dict[str, float]:
        """Return the largest change of each column of places and rates at some of the times."""
        states = self.whole.states(self.times[rows])
        moved = WholeStates(states.q, states.v, self.q[rows], self.v[rows], None)
        columns = Columns(self.whole, self.times[rows], moved, "closed form").trajectory()
        return {name: column.error for name, column in columns.items()}


def changes(scene: Scene, found: Modelled, times: Floats) -> Changes:
    """Return what the numbers of a scene do to its motion.

    Raises
    ------
    NotApplicable
        Where that cannot be told, with the reason.
    """
    for name, body in scene.bodies.items():
        if body.body is not None:
            raise NotApplicable(f'"{name}" is a body of the catalogue, whose numbers are not propagated')
    inputs = list(_inputs(found.described.measures.numerals.read))
    if len(inputs) > MOST_INPUTS:
        raise NotApplicable(f"the description has {len(inputs)} numbers, and at most {MOST_INPUTS} are propagated")
    places, rates = found.whole.in_pairs(times)
    q, v = np.zeros(places.shape[:2]), np.zeros(rates.shape[:2])
    for paths in inputs:
        other = _moved(scene, found, paths)
        for total, before, after in zip((q, v), (places, rates), other.in_pairs(times), strict=True):
            total += np.abs((after[..., 0] - before[..., 0]) + (after[..., 1] - before[..., 1])) / SHIFT
    return Changes(found.whole, times, q, v)


def _inputs(read: dict[Path, Ball]) -> Iterator[tuple[Path, ...]]:
    """Yield the numbers that are uncertain by themselves, each with all of its places."""
    shared: dict[tuple[Path, str], list[Path]] = {}
    for path, value in read.items():
        if path[0] == "bodies" and path[2] in ("moments", "tensor"):
            shared.setdefault((path[:3], value.str(40)), []).append(path)
        else:
            yield (path,)
    yield from map(tuple, shared.values())


def _moved(scene: Scene, found: Modelled, paths: tuple[Path, ...]) -> Whole:
    """Return the scene with one of its numbers moved."""
    name = "/".join(map(str, paths[0]))
    hangs = f"the scene hangs on {name} being exactly what it is: with another value"
    try:
        other = modelled(scene, Numerals.of(scene.let, scene.numbers, paths))
    except MechanicsError as fault:
        raise NotApplicable(f"{hangs}, {fault.detail}") from fault
    if _shape(other) != _shape(found):
        raise NotApplicable(f"{hangs}, it has another mobility")
    return other.whole


def _shape(found: Modelled) -> tuple[list[str], int]:
    table = found.described.measures.table
    return table.names, len(independent(row.line(table.q) for row in table.rows))


def looks(times: Floats) -> Floats:
    """Return times between the start and the farthest ones, nearest first."""
    share = np.arange(1, LOOKS + 1) / LOOKS
    ends = {max(float(np.max(times)), 0.0), min(float(np.min(times)), 0.0)} - {0.0}
    found = np.concatenate([share * end for end in ends]) if ends else np.zeros(1)
    return found[np.argsort(np.abs(found), kind="stable")]


def horizon(known: Changes, first: int, limit: float, columns: dict[str, Column]) -> float | None:
    """Return the last of the times from number `first` on up to which changes stay below a limit, None if all do.

    Parameters
    ----------
    known : Changes
        At times that, from that number on, grow in magnitude.
    limit : float
        Of the changes by relative errors of one, relative to the largest value in columns of the same unit.
    columns : dict of Column
        The samples, which have these values.
    """

    def below(count: int) -> bool:
        return relative(known.of_columns(np.arange(first, first + count)), columns) <= limit

    low, high = 0, len(known.times) - first
    if below(high):
        return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if below(middle) else (low, middle)
    return abs(float(known.times[first + low - 1])) if low else 0.0
