"""Places of rest beside one that a scene hardly keeps: where it is pushed along a soft direction without any force.

Beside a bifurcation several places of rest lie close together, and Newton's method comes to some of them from nearly
everywhere. The scene is held at distances s along the soft direction t by a force mu t. Where mu changes its sign there
is another place of rest. Distances grow by a constant factor, so that places are told apart however close they are.

References
----------
E. Riks, "An incremental approach to the solution of snapping and buckling problems", International Journal of Solids
and Structures 15 (1979): the bordered equations.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from flint import arb, arb_mat

from core.balls import precision
from core.multibody.algebra.polynomials import ZERO, Ball
from core.multibody.statics.exact_places import ExactPlace, RestEquations
from core.multibody.statics.held_aside import force_keeps_sign
from core.multibody.statics.small_motions import SoftDirection
from core.multibody.statics.static_equations import StaticArrays
from core.work import spend

_BITS_BESIDE = 192
"""For forces that differ by the cube of a distance of 2^-40."""
_FARTHEST_POWER = -4
"""Distance, as a power of the root of two of the scene's size, beyond which Newton's method finds places from afar."""
_LEAST, _BEFORE = -80.0, 8
"""The nearest place is about as far as the share of stiffness that is left, or as its root: distances begin at a
sixteenth of the share (M. Golubitsky, D. Schaeffer, "Singularities and Groups in Bifurcation Theory" I (1985))."""
_NEWTON_STEPS_OF_A_DISTANCE = 8
"""Newton steps at a distance: from the one before, 1.4 times as near, quadratic convergence takes fewer."""

_HALVINGS_OF_A_DISTANCE = 24
"""Halvings of a distance: what they leave, 1e-7 of it, is within the reach of Newton's method."""

_SHORT_STEP = 2.0**-120
"""Share of a step that is small enough: its square is below the rounding of `_BITS_BESIDE`."""

_UNITS_OF_A_DISTANCE = 0.02
"""Units of work (`core.work`) of a step, times the cube of the unknowns."""


def places_beside(
    equations: RestEquations, arrays: StaticArrays, place: ExactPlace, direction: SoftDirection
) -> Iterator[ExactPlace]:
    """Yield further places of rest along a soft direction.

    Parameters
    ----------
    arrays : StaticArrays
        The equations in doubles, in units of the sizes.
    """
    with precision(_BITS_BESIDE):
        found = list(_starts(equations, arrays, place, direction))
    for x in found:
        refined = equations.refined(x)
        if refined is not None:
            yield refined


def _starts(
    equations: RestEquations, arrays: StaticArrays, place: ExactPlace, direction: SoftDirection
) -> Iterator[list[Ball]]:
    path = _Path(equations, place, direction.change)
    share = max(direction.share, 2.0**_LEAST)
    nearest = math.floor(2.0 * math.log2(share)) - _BEFORE
    powers = range(nearest, _FARTHEST_POWER + 1)
    start = np.array([float(x / size) for x, size in zip(path.start, equations.sizes, strict=True)])
    along, distances = np.array([float(t) for t in path.along]), np.sqrt(np.exp2(powers))
    for way in (1, -1):
        if force_keeps_sign(arrays, start, along, way * distances):
            continue
        x, before, last = path.start, ZERO, ZERO
        for k in powers:
            distance = way * (arb(2) ** k).sqrt()
            held = path.held(x, distance)
            if held is None:
                break
            x, force = held
            if before != 0 and force * before < 0:
                yield path.between(x, last, distance, before)
            before, last = force, distance


class _Path:
    """A scene that is held at distances from a place of rest."""

    def __init__(self, equations: RestEquations, place: ExactPlace, direction: Sequence[float]) -> None:
        self.equations, count = equations, equations.count
        self.start = [x.mid() for x in (*place.q, *place.multipliers)]
        scaled = [arb(x) / size for x, size in zip(direction, equations.sizes, strict=False)]
        length = sum((x * x for x in scaled), ZERO).sqrt()
        self.along = [(x / length).mid() for x in scaled]
        self.forces = [(t / size).mid() for t, size in zip(self.along, equations.sizes[:count], strict=True)]

    def held(self, x: Sequence[Ball], distance: Ball) -> tuple[list[Ball], Ball] | None:
        """Return coordinates and multipliers at a distance, and the force that holds there; None where none does."""
        equations, count, size = self.equations, self.equations.count, len(x)
        x, force = list(x), ZERO
        for _ in range(_NEWTON_STEPS_OF_A_DISTANCE):
            spend(_UNITS_OF_A_DISTANCE * (size + 1) ** 3)
            rows = equations.derivatives(x)
            left = equations.residuals(x)
            for i, t in enumerate(self.forces):
                left[i] = left[i] - force * t
            gone = sum(((a - b) * t for a, b, t in zip(x, self.start, self.forces, strict=False)), ZERO)
            matrix = [[*(y.mid() for y in row), -self.forces[i] if i < count else ZERO] for i, row in enumerate(rows)]
            matrix.append([*self.forces, *[ZERO] * (size + 1 - count)])
            try:
                step = arb_mat(matrix).solve(arb_mat([[y.mid()] for y in (*left, gone - distance)])).mid().entries()
            except ZeroDivisionError:
                return None
            x = [(a - b).mid() for a, b in zip(x, step[:size], strict=True)]
            force = (force - step[size]).mid()
            share = max(abs(float(b / scale)) for b, scale in zip(step[:size], equations.sizes, strict=True))
            if not share < 1.0:
                return None
            if share < _SHORT_STEP:
                return x, force
        return None

    def between(self, x: Sequence[Ball], low: Ball, high: Ball, before: Ball) -> list[Ball]:
        """Return about where the force is zero between two distances, with the sign that it has at the first."""
        near = list(x)
        for _ in range(_HALVINGS_OF_A_DISTANCE):
            middle = ((low + high) / 2).mid()
            held = self.held(near, middle)
            if held is None:
                break
            near = held[0]
            if held[1] * before < 0:
                high = middle
            else:
                low = middle
        return near
