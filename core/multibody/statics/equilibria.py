"""Where a scene can rest, and how it moves near there.

K q - b = W(q)^T lambda with g = 0 is quadratic again: Newton's method in doubles from many starts finds about where its
solutions are, those with positive lengths and taut strings count, and each is refined and enclosed in balls. That all
are found is not proven. Coordinates that a motion from the given start would never move are free here.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from itertools import chain
from math import hypot, inf, isfinite, nextafter

import numpy as np
from flint import arb

from core.balls import precision
from core.errors import AccuracyUnreachable, NotApplicable
from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.doubles import error_in_doubles, in_doubles
from core.multibody.algebra.polynomials import BITS, Ball, evaluated
from core.multibody.answer import Equilibrium, EquilibriumErrors
from core.multibody.equations.dynamics import accelerations
from core.multibody.equations.packed import exponent, packed, state, two_to, units_of
from core.multibody.reduction.passes import reduced
from core.multibody.reduction.reduction import Reduced
from core.multibody.statics.continua import one_of_each
from core.multibody.statics.equilibrium_search import MOST_FOUND, solutions_of
from core.multibody.statics.exact_places import ExactPlace, RestEquations, Tie
from core.multibody.statics.mode_shapes import mode_shape
from core.multibody.statics.places_beside import places_beside
from core.multibody.statics.resting_places import RestingPlaces
from core.multibody.statics.small_motions import small_motions, soft_directions
from core.multibody.statics.static_equations import StaticEquations
from core.multibody.table.description import Described, described
from core.multibody.table.law_pieces import all_entered
from core.multibody.table.table import Table

_FEW_BITS = 64
"""Bits by which masses may differ before the scene is read in more of them."""
_ALIKE = 2.0**-64
"""Share of the scene's size by which places differ at least that are two."""


def equilibria_of(found: Described) -> tuple[Equilibrium, ...]:
    """Return the equilibria that are found, those of lowest potential first.

    Raises
    ------
    NotApplicable
        For scenes that are driven, or held by rates that no measure gives: rolling on curves, and drums.
    BudgetExceeded
        If the search would take too long.
    """
    spread = _spread(found.measures.table)
    if spread > _FEW_BITS:
        # Beside the forces on heavy bodies those on light ones keep their bits.
        with precision(BITS + 2 * spread):
            return _found(described(found.scene))
    return _found(found)


def _found(found: Described) -> tuple[Equilibrium, ...]:
    entered = all_entered(found.measures.table)
    if entered is None:
        raise NotApplicable(
            "equilibria are not answered yet where forces are formulas that read the time or are not linear",
            path=("outputs",),
        )
    small = reduced(entered, pinning=False)
    table = small.table
    frames = found.measures.coordinates.frames
    tied = [r for r, row in enumerate(table.rows) if row.measure is None]
    if any(table.rows[r].name not in frames or frames[table.rows[r].name].turn is None for r in tied):
        raise NotApplicable(
            "equilibria are not answered where rates are held that no measure gives: motors, rolling on curves, drums",
            path=("outputs",),
        )
    resting = RestingPlaces(found, entered, small)
    if not table.names:
        # What is held where it is rests there, if its strings can hold it.
        held, only = RestEquations(table, [], {}, []), ExactPlace([], [])
        return (_described(found, small, held, only),) if resting.possible(only) else ()
    gains, chosen = accelerations(table)
    units = units_of(table, gains)
    equations = StaticEquations(packed(table, chosen, units))
    ties: dict[int, Tie] = {}
    for number, r in enumerate(chosen):
        if r in tied:
            frame = frames[table.rows[r].name]
            equations.tie(number, found, small, units, frame, two_to(units.rows[r]))
            ties[r] = _tie(found, small, frame.turn, frame.direction)
    powers = [*units.lengths, *(units.multiplier(r) for r in chosen)]
    exact = RestEquations(table, chosen, ties, [arb(2) ** power for power in powers])
    start = state(table, units)[0][:, 0]
    places = solutions_of(equations, start, len(table.names) - len(chosen))
    turns = {j for tie in ties.values() for key in tie.turn for j in key}
    found_places = [place for q, x in places for place in [exact.place(q, x)] if place is not None]
    # Of places that differ by whole turns alone that with the fewest is kept.
    found_places.sort(key=lambda place: sum(abs(float(place.q[j] - table.q[j])) for j in turns))
    refined = one_of_each(_different(found_places, exact, turns), exact)
    beside = (
        other
        for place in refined
        if not place.one_of_many
        for direction in soft_directions(exact, place)
        for other in places_beside(exact, equations.arrays, place, direction)
    )
    refined = _different(chain(refined, beside), exact, turns)
    answers = [
        (exact.potential(place.q), _described(found, small, exact, place))
        for place in refined
        if resting.possible(place)
    ]
    answers.sort(key=lambda entry: float(entry[0]))
    return tuple(entry[1] for entry in answers[:MOST_FOUND])


def _spread(table: Table) -> int:
    """Return by how many bits the largest and the smallest mass differ."""
    powers = [power for (i, j), x in table.mass.items() if i == j and (power := exponent(x)) is not None]
    return max(powers) - min(powers) if powers else 0


def _tie(found: Described, small: Reduced, turn: int | None, direction: tuple[int, int] | None) -> Tie:
    assert turn is not None
    assert direction is not None
    q = found.measures.table.q
    now, cosine, sine = (small.expressions[i] for i in (turn, *direction))
    return Tie(now, cosine, sine, q[turn], polar_angle(q[direction[0]], q[direction[1]]))


def _different(places: Iterable[ExactPlace], equations: RestEquations, turns: Set[int]) -> list[ExactPlace]:
    """Return places without those that are one of the others, where turns alone differ with the same moments.

    Parameters
    ----------
    turns : set of int
        Coordinates that count turns, of directions that are coordinates themselves.
    """
    kept: list[ExactPlace] = []
    compared = [i for i in range(equations.count if not turns else len(equations.sizes)) if i not in turns]
    for place in places:
        here = [*place.q, *place.multipliers]
        if all(
            any(_apart(here[i], other[i], equations.sizes[i]) for i in compared)
            for one in kept
            for other in [[*one.q, *one.multipliers]]
        ):
            kept.append(place)
    return kept


def _apart(x: Ball, y: Ball, size: Ball) -> bool:
    return bool(abs(x - y) > _ALIKE * size)


def _described(found: Described, small: Reduced, equations: RestEquations, place: ExactPlace) -> Equilibrium:
    try:
        modes, changes, stable = small_motions(equations, place)
    except (ValueError, ZeroDivisionError) as fault:
        raise _out_of_range("the masses differ by more than 320 bits can resolve") from fault
    shown = tuple(mode.in_doubles() for mode in modes)
    where = [evaluated(expression, place.q) for expression in small.expressions]
    positions: dict[str, tuple[float, ...]] = {}
    angles: dict[str, float] = {}
    wrong: dict[str, float] = {}
    turned: dict[str, float] = {}
    for name, frame in found.measures.coordinates.frames.items():
        centre = [where[i] for i in frame.position]
        positions[name] = tuple(map(in_doubles, centre))
        wrong[name] = _length(list(map(error_in_doubles, centre)))
        if frame.turn is not None:
            # What twists a spring counts whole turns.
            angle = where[frame.turn]
        elif frame.direction is not None:
            c, s = frame.direction
            angle = polar_angle(where[c], where[s])
        else:
            continue
        angles[name] = in_doubles(angle)
        turned[name] = _length([error_in_doubles(angle)])
    numbers = [*(x for centre in positions.values() for x in centre), *(x for mode in shown for x in mode[:2])]
    if not np.isfinite(numbers).all() or not all(map(isfinite, [*wrong.values(), *turned.values()])):
        raise _out_of_range("the search for equilibria leaves the range of doubles")
    frames = found.measures.coordinates.frames
    shapes = tuple(
        None if change is None else mode_shape(frames, small.expressions, place.q, change) for change in changes
    )
    errors = EquilibriumErrors(wrong, turned)
    left = equations.share_left(place)
    return Equilibrium(positions, angles, stable, shown, left, errors, shapes, place.continuum)


def _length(errors: Sequence[float | None]) -> float:
    """Return the length of the errors of a vector, infinite where one is not known."""
    length = hypot(*(inf if error is None else error for error in errors))
    return nextafter(length, inf) if length > 0.0 and len(errors) > 1 else length


def _out_of_range(reason: str) -> AccuracyUnreachable:
    remedy = "ask without equilibria, or choose units in which the numbers are moderate"
    return AccuracyUnreachable(None, np.inf, reason, path=("outputs",), remedy=remedy)
