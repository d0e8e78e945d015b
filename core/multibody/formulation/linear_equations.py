"""The matrices of equations that are linear, or of small motions about a place of rest near the start."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from flint import arb, arb_mat

from core.multibody.algebra.doubles import in_doubles
from core.multibody.algebra.polynomials import ONE, ZERO, Ball
from core.multibody.equations_answer import LinearEquations
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Term, Variable

NEWTON_STEPS = 40
"""Steps towards a place of rest; from where it converges, it does so in ten."""

ASIDE = (0.0, 0.7, -0.7)
"""By how much all coordinates are moved from the start (rad, m) before a place of rest is looked for: a pendulum that
is level has no slope there, and from some places Newton's method goes to the unstable one."""

HANGING = (0.1, -1.4)
"""Values of all coordinates (rad, m) from which it is looked for, too: points hang at 0, bodies at minus half pi."""

REACHED = 2.0**-200
"""Share of the coordinates, or of one, below which a step has reached the place: far below the digits of doubles."""


def linear_equations(
    equations: Mapping[str, Sum], start: Mapping[str, Ball], lengths: Sequence[Sum], tensions: Sequence[Sum]
) -> Iterator[LinearEquations]:
    """Yield the matrices of equations, as a whole if they are linear, else about a place of rest, if one is found.

    Parameters
    ----------
    equations : mapping of str to Sum
        What is zero, by the variable whose equation it is; without multipliers and values of laws.
    start : mapping of str to ball
        Where a place of rest is looked for from.
    lengths, tensions : sequence of Sum
        What is positive, and what is not negative, at any place that can be: the equations alone hold a bob on a string
        that has no length, or a negative one, as well.
    """
    names = list(equations)
    known = {variable for one in equations.values() for term in one.terms for variable, _ in term.factors}
    driven = any(TIME in one.names() for one in equations.values())
    if driven or not {variable.name for variable in known} <= set(names):
        return
    shown: dict[str, float]
    nowhere = dict.fromkeys(names, ZERO)
    load = [one.terms.get(Term(), ZERO) for one in equations.values()]
    if all(_is_linear(one) for one in equations.values()):
        about, shown, right = nowhere, {}, tuple(in_doubles(-x) for x in load)
    else:
        starts = [{name: start[name] + x for name in names} for x in ASIDE]
        starts += [dict.fromkeys(names, ONE * x) for x in HANGING]
        places = [place for one in starts if (place := _place_of_rest(equations, one)) is not None]
        places = [place for place in places if _can_be(place, lengths, tensions)]
        # Small motions stay small about a stable place.
        found = next((place for place in places if _is_stable(equations, place)), next(iter(places), None))
        if found is None:
            return
        about, shown, right = found, {name: in_doubles(x) for name, x in found.items()}, (0.0,) * len(names)
    mass, damping, stiffness = (_matrix(equations, order, about) for order in (2, 1, 0))
    yield LinearEquations(tuple(names), shown, mass, damping, stiffness, right)


def _can_be(place: Mapping[str, Ball], lengths: Sequence[Sum], tensions: Sequence[Sum]) -> bool:
    """Return whether all lengths are positive at a place of rest, and no tension negative, as far as it says so."""
    known, rounding = set(place), REACHED * (1 + max(map(abs, place.values())))
    long = all(one.value(place) > rounding for one in lengths if one.names() <= known)
    return long and not any(one.value(place) < -rounding for one in tensions if one.names() <= known)


def _is_stable(equations: Mapping[str, Sum], place: Mapping[str, Ball]) -> bool:
    """Return whether the stiffness at a place is positive definite: all its leading minors are positive."""
    stiffness = [[one.derivative(Variable(n)).value(place) for n in equations] for one in equations.values()]
    return all(arb_mat([row[:k] for row in stiffness[:k]]).det() > 0 for k in range(1, len(stiffness) + 1))


def _is_linear(equation: Sum) -> bool:
    return all(not term.function and sum(abs(power) for _, power in term.factors) <= 1 for term in equation.terms)


def _place_of_rest(equations: Mapping[str, Sum], start: Mapping[str, Ball]) -> dict[str, Ball] | None:
    """Return where nothing moves that rests there, by Newton's method; None where it does not converge."""
    names = list(equations)
    statics = {name: Sum({t: x for t, x in one.terms.items() if _rests(t)}) for name, one in equations.items()}
    place = {name: start[name] for name in names}
    for _ in range(NEWTON_STEPS):
        slopes = [[one.derivative(Variable(name)).value(place) for name in names] for one in statics.values()]
        left = [[one.value(place)] for one in statics.values()]
        try:
            steps = arb_mat(slopes).solve(arb_mat(left)).entries()
        except ZeroDivisionError:
            return None
        if any(abs(step) > REACHED * (1 + abs(place[name])) for name, step in zip(names, steps, strict=True)):
            # Balls would grow from step to step, and each begins at a number anew.
            place = {name: (place[name] - step).mid() for name, step in zip(names, steps, strict=True)}
            continue
        turning = set(names) - {name for one in equations.values() for name in one.in_places()}
        return {name: _cleaned(x, turns=name in turning) for name, x in place.items()}
    return None


def _cleaned(x: Ball, *, turns: bool) -> Ball:
    """Return zero for what is nothing but rounding, and of what only sines see the value within half a turn of zero."""
    if turns:
        x = x - 2 * arb.pi() * round(float(x) / (2 * math.pi))
    return ZERO if abs(x) < REACHED else x


def _rests(term: Term) -> bool:
    return all(variable.order == 0 for variable, _ in term.factors)


Matrix = tuple[tuple[float, ...], ...]


def _matrix(equations: Mapping[str, Sum], order: int, about: Mapping[str, Ball]) -> Matrix:
    """Return the derivatives of equations by accelerations, rates or places, at rest at a place."""
    return tuple(
        tuple(in_doubles(one.derivative(Variable(name, order)).value(about)) for name in equations)
        for one in equations.values()
    )
