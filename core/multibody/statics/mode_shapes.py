"""Shapes of small motions near a place of rest: how bodies move in each mode, as changes of positions and angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot, inf
from typing import Any

from flint import acb

from core.multibody.algebra.doubles import error_in_doubles, in_doubles
from core.multibody.algebra.polynomials import Ball, Poly, evaluated, gradient
from core.multibody.algebra.spectrum import spectrum
from core.multibody.answer import ModeShape
from core.multibody.motion.motion import Mode
from core.multibody.table.frames import Frame

Change = Mapping[int, Any]
"""Complex changes of coordinates of a table, by their numbers."""

CLOSE = 1e-9
"""Share of the largest root within which two computations give one root: they are told apart to 2^-50 of it."""


def vectors_of(matrix: Any, size: int) -> list[tuple[Any, list[Any]]]:
    """Return the roots of a matrix with the first `size` entries of their vectors; none where roots coincide.

    Where roots coincide, every combination of their motions is a mode: none is that of the scene.
    """
    found = spectrum(matrix)
    if found is None:
        return []
    roots, vectors = found
    columns = vectors.transpose().tolist()
    return [(acb(root), [acb(x) for x in column[:size]]) for root, column in zip(roots, columns, strict=True)]


def matched(modes: Sequence[Mode], vectors: Sequence[tuple[Any, list[Any]]]) -> list[list[Any] | None]:
    """Return the vector of each mode, whose root it is to rounding; None without one."""
    largest = max((abs(complex(root)) for root, _ in vectors), default=0.0)
    shapes: list[list[Any] | None] = []
    for mode in modes:
        wanted = complex(float(mode.growth.mid()), float(mode.frequency.mid()))
        near = [vector for root, vector in vectors if abs(complex(root) - wanted) <= CLOSE * largest]
        shapes.append(near[0] if len(near) == 1 else None)
    return shapes


def change_along(directions: Sequence[Mapping[int, Ball]], vector: Sequence[Any]) -> Change:
    """Return the change of all coordinates for one of the directions that are free."""
    change: dict[int, Any] = {}
    for weight, direction in zip(vector, directions, strict=True):
        for i, x in direction.items():
            change[i] = change.get(i, acb(0)) + weight * x
    return change


def mode_shape(
    frames: Mapping[str, Frame], expressions: Sequence[Poly], q: Sequence[Ball], change: Change
) -> ModeShape | None:
    """Return how bodies move in a mode; None where no column shows it, or its numbers leave the range of doubles.

    Parameters
    ----------
    frames : mapping of str to Frame
    expressions : sequence of poly
        Coordinates of the scene by those of the table.
    q : sequence of ball
        Of the table at the place of rest.
    change : mapping of int to acb
        Of the coordinates of the table.
    """

    def moved(i: int) -> Any:
        slopes = gradient(expressions[i])
        return sum((change[j] * evaluated(slope, q) for j, slope in slopes.items() if j in change), acb(0))

    positions: dict[str, list[Any]] = {}
    angles: dict[str, Any] = {}
    for name, frame in frames.items():
        positions[name] = [moved(i) for i in frame.position]
        if frame.turn is not None:
            angles[name] = moved(frame.turn)
        elif frame.direction is not None:
            c, s = frame.direction
            cosine, sine = (evaluated(expressions[i], q) for i in (c, s))
            angles[name] = moved(s) * cosine - moved(c) * sine
    every = [[x for one in positions.values() for x in one], list(angles.values())]
    largest = max((max(numbers, key=_size) for numbers in every if numbers), key=_size, default=acb(0))
    # Places first: an angle is the measure where no centre moves.
    unit = max(every[0], key=_size, default=acb(0))
    if _size(unit) <= CLOSE * _size(largest):
        unit = largest
    if not abs(unit) > 0:
        return None
    positions = {name: [x / unit for x in one] for name, one in positions.items()}
    angles = {name: x / unit for name, x in angles.items()}
    numbers = [*(x for one in positions.values() for x in one), *angles.values()]
    errors = [error_in_doubles(part) for x in numbers for part in (x.real, x.imag)]
    error = hypot(*(inf if one is None else one for one in errors))
    if error == inf:
        return None
    quarter = any(in_doubles(x.imag) != 0.0 and not x.imag.contains(0) for x in numbers)
    return ModeShape(
        {name: tuple(in_doubles(x.real) for x in one) for name, one in positions.items()},
        {name: in_doubles(x.real) for name, x in angles.items()},
        {name: tuple(in_doubles(x.imag) for x in one) for name, one in positions.items()} if quarter else None,
        {name: in_doubles(x.imag) for name, x in angles.items()} if quarter else None,
        error,
    )


def _size(number: Any) -> float:
    return abs(complex(number))
