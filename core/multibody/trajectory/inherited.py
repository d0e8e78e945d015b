"""What the uncertainty of a description's numbers does to its motion.

Every number is moved in turn by a share 2^-70 of itself, in balls, and the motion is computed again in pairs of
doubles. The differences, divided by that share, are derivatives to 2^-28 or better. The sum of their magnitudes times
the uncertainty is what independent errors of all inputs can do, to first order. Forces, energies and momenta are
evaluated in doubles, where so small a change is not seen: for them the number is moved by `VISIBLE` of itself, less
where the motion grows, and the state along the derivative that is known. Formulas are exact: where a formula is
to be uncertain, the numbers that it uses stand in `let`. The equal entries of one tensor are one number, because a body
that is symmetric is to remain so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from core.arrays import Floats, largest_magnitude, row_lengths
from core.errors import MechanicsError, NotApplicable, Path
from core.multibody.language.numerals import SHIFT, Numerals
from core.multibody.language.scene import Scene
from core.multibody.motion.modelling import Modelled, modelled
from core.multibody.motion.motion import States
from core.multibody.motion.whole import Whole
from core.multibody.table.description import Described
from core.multibody.trajectory.column_errors import relative
from core.multibody.trajectory.columns import Columns
from core.systems.trajectory import Accuracy, Column

MOST_PROPAGATED_NUMBERS = 400
"""Numbers that are moved; each costs a motion of its own."""

VISIBLE = 2.0**-34
"""Share of a number whose effect on a function of the state is seen in doubles, to some 2^-18 of itself.

It is less than the share by which velocities may miss the connections."""

NO_HORIZON_NEEDED = "the change stays below the accuracy at all of the times"
"""Why there is no horizon, where none is needed."""

Derived = Callable[[Whole, Floats, States], dict[str, Column]]
"""From a scene and its states at some times to columns that follow from them."""

INSTANTS = 64
"""Times between the start and the last sample at which the horizon is looked for, on either side."""


@dataclass(frozen=True)
class Changes:
    """Largest changes of places and rates by relative errors of one in every input, to first order.

    Attributes
    ----------
    times : ndarray, shape (t,)
    q, v : ndarray, shape (t, n)
        Sums of magnitudes, in SI units, of every coordinate as described.
    derived : dict of str to ndarray, shape (t,)
        The same of columns that follow from the state.
    """

    whole: Whole
    times: Floats
    q: Floats
    v: Floats
    derived: dict[str, Floats]

    def of_columns(self, rows: np.ndarray) -> dict[str, float]:
        """Return the largest change of each column at some of the times."""
        states = self.whole.states(self.times[rows])
        moved = States(states.q, states.v, self.q[rows], self.v[rows], None)
        columns = Columns(self.whole, self.times[rows], moved, "closed form").trajectory()
        own = {name: column.error for name, column in columns.items()}
        return own | {name: float(np.max(one[rows], initial=0.0)) for name, one in self.derived.items()}


def changes(scene: Scene, found: Modelled, times: Floats, follow: Derived) -> Changes:
    """Return what the numbers of a scene do to its motion.

    Raises
    ------
    NotApplicable
        Where that cannot be told, with the reason.
    """
    inputs = inputs_of(scene, found.described)
    places, rates = found.whole.in_pairs(times)
    q, v = np.zeros(places.shape[:2]), np.zeros(rates.shape[:2])
    nothing = np.zeros(places.shape[:2])
    now = follow(found.whole, times, States(places, rates, nothing, nothing, None))
    derived = {name: np.zeros(len(times)) for name in now}
    for paths in inputs:
        other = _moved(scene, found, paths, SHIFT)
        slopes = []
        for total, before, after in zip((q, v), (places, rates), other.in_pairs(times), strict=True):
            slope = ((after[..., 0] - before[..., 0]) + (after[..., 1] - before[..., 1])) / SHIFT
            slopes.append(slope)
            total += np.abs(slope)
        if now:
            growth = (
                max(
                    largest_magnitude(slope) / max(largest_magnitude(value), 1e-300)
                    for slope, value in zip(slopes, (places, rates), strict=True)
                    if np.any(slope)
                )
                if any(np.any(slope) for slope in slopes)
                else 1.0
            )
            share = VISIBLE / 2.0 ** max(0, int(np.ceil(np.log2(max(growth, 1.0)))))
            state = [_shifted(value, slope * share) for slope, value in zip(slopes, (places, rates), strict=True)]
            whole = _moved(scene, found, paths, share)
            for name, column in follow(whole, times, States(state[0], state[1], nothing, nothing, None)).items():
                away = (column.values - now[name].values) / share
                derived[name] += np.abs(away) if away.ndim == 1 else row_lengths(away)
    return Changes(found.whole, times, q, v, derived)


def _shifted(pairs: Floats, change: Floats) -> Floats:
    """Return pairs of shape (t, n, 2) with a change of shape (t, n) added."""
    high = pairs[..., 0] + change
    back = high - pairs[..., 0]
    return np.stack([high, (pairs[..., 0] - (high - back)) + (change - back) + pairs[..., 1]], axis=-1)


def inputs_of(scene: Scene, found: Described) -> list[tuple[Path, ...]]:
    """Return the numbers of a scene that are uncertain by themselves, each with all of its places.

    Raises
    ------
    NotApplicable
        For bodies whose numbers are not the scene's, and for more numbers than are propagated.
    """
    for name, body in scene.bodies.items():
        if body.body is not None:
            raise NotApplicable(f'"{name}" is a body of the catalogue, whose numbers are not propagated')
    shared: dict[tuple[Path, str], list[Path]] = {}
    inputs: list[tuple[Path, ...]] = []
    for path, value in found.measures.numerals.read.items():
        if path[0] == "bodies" and path[2] in ("moments", "tensor"):
            shared.setdefault((path[:3], value.str(40)), []).append(path)
        else:
            inputs.append((path,))
    inputs.extend(map(tuple, shared.values()))
    if len(inputs) > MOST_PROPAGATED_NUMBERS:
        raise NotApplicable(
            f"the description has {len(inputs)} numbers, and at most {MOST_PROPAGATED_NUMBERS} are propagated"
        )
    return inputs


def _moved(scene: Scene, found: Modelled, paths: tuple[Path, ...], share: float) -> Whole:
    """Return the scene with one of its numbers moved by a share of itself."""
    name = "/".join(map(str, paths[0]))
    hangs = f"the scene hangs on {name} being exactly what it is: with another value"
    try:
        other = modelled(scene, Numerals.of(scene.let, scene.numbers, paths, share))
    except MechanicsError as fault:
        raise NotApplicable(f"{hangs}, {fault.detail}") from fault
    if _shape(other) != _shape(found):
        raise NotApplicable(f"{hangs}, it has another mobility")
    return other.whole


def _shape(found: Modelled) -> tuple[list[str], int]:
    table = found.described.measures.table
    return table.names, len(table.independent_rows())


def instants(times: Floats) -> Floats:
    """Return times between the start and the farthest ones, nearest first."""
    share = np.arange(1, INSTANTS + 1) / INSTANTS
    ends = {max(float(np.max(times)), 0.0), min(float(np.min(times)), 0.0)} - {0.0}
    found = np.concatenate([share * end for end in ends]) if ends else np.zeros(1)
    return found[np.argsort(np.abs(found), kind="stable")]


class Changing(Protocol):
    """Changes at some times."""

    @property
    def times(self) -> Floats:
        """Times, shape (t,)."""
        ...

    def of_columns(self, rows: np.ndarray) -> dict[str, float]:
        """Return the largest change of each column at some of the times."""
        ...


def horizon(known: Changing, first: int, limit: float, columns: dict[str, Column]) -> float | None:
    """Return the last of the times from number `first` on up to which changes stay below a limit, None if all do.

    Parameters
    ----------
    known : Changing
        At times that, from that number on, grow in magnitude.
    limit : float
        Of the changes by relative errors of one, relative to the largest value in columns of the same unit.
    columns : dict of Column
        The samples, which have these values.
    """

    def below(count: int) -> bool:
        moved = known.of_columns(np.arange(first, first + count))
        return relative({name: moved[name] for name in columns}, columns) <= limit

    low, high = 0, len(known.times) - first
    if below(high):
        return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if below(middle) else (low, middle)
    return abs(float(known.times[first + low - 1])) if low else 0.0


def with_inherited(
    columns: dict[str, Column], stated: Accuracy, moved: dict[str, float], uncertainty: float, *, why: str | None
) -> tuple[dict[str, Column], Accuracy]:
    """Return columns with what the uncertainty of the inputs does to them, and the accuracy with the largest share.

    Parameters
    ----------
    columns : dict of Column
    stated : Accuracy
    moved : dict of str to float
        Largest changes of some of the columns by relative errors of one in every input.
    uncertainty : float
        Relative, of every input.
    why : str, optional
        Why there is no horizon.
    """
    own = {name: columns[name] for name in moved}
    share = uncertainty * relative(moved, own)
    if not share < 1.0:
        return columns, replace(stated, why="nothing is known of the motion at the latest times")
    known = {name: replace(column, inherited=uncertainty * moved[name]) for name, column in own.items()}
    return columns | known, replace(stated, inherited=share, why=why)
