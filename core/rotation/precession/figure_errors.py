"""Bounds of the errors of the figures of a free precession.

The double that is stated is the nearest to a number that is right to 1e-27 of itself, or of an angle one unit off by
its arctangent (`core.rotation.precession.figures`). Beside that, moments and axes that were derived are right to their
own rounding only. What that changes is measured: they are moved by so many times as much that the change shows in
doubles. Where equal moments are left equal and zeros zero, a move changes no regime unless the start is as near to the
separatrix as the numbers are known; then a figure is known to its own size.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, nan, ulp

import numpy as np

from core.arrays import Floats
from core.bodies.principal_inertia import PrincipalInertia
from core.bodies.rounding_errors import principal_errors
from core.double_double import dd_add
from core.rotation.closed_form.circulation import UNDECIDED, exact_difference
from core.rotation.closed_form.principal_frame import Resolved
from core.rotation.precession.figures import Figures, Found, precession_figures
from core.rotation.precession.middle_axis import MiddleAxisTilt, middle_axis_tilt

HALF_UNIT = 0.5 * (1.0 + 2.0**-30)
"""Of a double that is the nearest unless the number is within 1e-11 units of the middle between two."""

OF_AN_ARCTANGENT = 1.5
"""Units: one of the C library's function, of a complement half a unit more for its rounding."""

OF_WHAT_IS_LEFT = 1.0
"""Units of an angle that is taken from a whole turn: stated only if that costs less than half a unit."""

UNITS = (
    HALF_UNIT, HALF_UNIT, HALF_UNIT, HALF_UNIT, OF_AN_ARCTANGENT, OF_AN_ARCTANGENT, OF_AN_ARCTANGENT, OF_WHAT_IS_LEFT,
    OF_WHAT_IS_LEFT, OF_AN_ARCTANGENT, OF_AN_ARCTANGENT,
)  # fmt: skip
"""Of the figures in the order of `core.rotation.precession.precession.FIGURES`, and of the tilt of the middle axis."""

MOVES = (2.0**30, 2.0**4)
"""How many times their error numbers are moved: the second factor where the first leads across the separatrix."""

CURVED = 2.0
"""How much more than in proportion a figure may change with a number."""


def axis_error(inertia: PrincipalInertia, pointing: Sequence[float]) -> float:
    """Return the error of a principal axis in body axes, as the length of a vector."""
    axis = int(np.abs(np.array(pointing) @ inertia.axes).argmax())
    return float(np.linalg.norm(principal_errors(inertia, 0.0)["axes"][:, axis]))


def found_figures(k: int, inertia: PrincipalInertia, resolved: Resolved) -> Found:
    """Return what the kernel finds, with the decisive difference in exact arithmetic where it needs that."""
    # Copies, as for arrays of another layout, or that cannot be written, the kernel would be compiled once more.
    given = inertia.moments, inertia.moments_tail, inertia.axes, *resolved.numbers
    moments, tail, axes, i, it, w, wt = (np.array(x) for x in given)
    parts = moments, tail, axes, i, it, w, wt
    found = precession_figures(k, *parts, False, 0.0, 0.0, 0)
    if found[0] == UNDECIDED:
        found = precession_figures(k, *parts, True, *exact_difference(resolved))
    return found


def figure_errors(
    k: int, inertia: PrincipalInertia, resolved: Resolved, figures: Figures, tilt: MiddleAxisTilt | None
) -> tuple[float, ...]:
    """Return bounds of the errors of figures and of the two angles of a tilt; zero for those that are not stated.

    Parameters
    ----------
    k : int
        Number of the moment that is not equal to the other two, -1 where all differ.
    inertia : PrincipalInertia
    resolved : Resolved
        Moments and start along ascending principal axes.
    figures : tuple of float
        In the order of `core.rotation.precession.precession.FIGURES`.
    tilt : MiddleAxisTilt or None
    """
    stated = *figures, *_angles(tilt)
    rounding = [
        units * ulp(figure) if isfinite(figure) and figure else 0.0 for units, figure in zip(UNITS, stated, strict=True)
    ]
    if not inertia.rounding.share:
        return tuple(rounding)
    for times in MOVES:
        changes = _changes(k, inertia, resolved, stated, times)
        if changes is not None:
            break
    else:
        changes = [abs(figure) for figure in stated]
    # Directions are turned by as much as the axes, also where a component was taken for noise.
    turned = 0.0 if inertia.rounding.exact_zeros else _turn(inertia) + resolved.dropped
    return tuple(
        own + change + (turned if units == OF_AN_ARCTANGENT else 0.0) if isfinite(figure) else 0.0
        for own, change, units, figure in zip(rounding, changes, UNITS, stated, strict=True)
    )


def _angles(tilt: MiddleAxisTilt | None) -> tuple[float, float]:
    return (nan, nan) if tilt is None else tilt.range


def _turn(inertia: PrincipalInertia) -> float:
    """Return by how much the principal axes may be turned (rad)."""
    wrong = principal_errors(inertia, 0.0)["axes"] - np.abs(inertia.axes_tail)
    return float(np.max(wrong, initial=0.0))


def _changes(
    k: int, inertia: PrincipalInertia, resolved: Resolved, stated: Sequence[float], times: float
) -> list[float] | None:
    """Return what the rounding of moments and components changes, None where moving them changes the regime."""
    i, it, w, wt = resolved.numbers
    share = inertia.rounding.share
    total = [0.0] * len(stated)
    for moved in _groups(i, it):
        # Of a tensor that is not diagonal, a moment is known as a share of the largest.
        size = float(i[moved[0]]) if inertia.rounding.exact_zeros else float(i[2])
        by = times * share * size
        moments = (*_moved(inertia.moments, inertia.moments_tail, moved, by),)
        changed = PrincipalInertia(*moments, inertia.axes, inertia.axes_tail, inertia.rounding)
        if not _add(total, k, changed, Resolved(*_moved(i, it, moved, by), w, wt, 0.0), stated, times):
            return None
    if not inertia.rounding.exact_zeros:
        by = times * _turn(inertia) * float(np.abs(w).max())
        for axis in np.flatnonzero(w).tolist():
            if not _add(total, k, inertia, Resolved(i, it, *_moved(w, wt, [axis], by), 0.0), stated, times):
                return None
    return total


def _groups(i: Floats, it: Floats) -> list[list[int]]:
    """Return the numbers of moments, those that are equal together."""
    groups: list[list[int]] = []
    for n in range(3):
        if n and i[n] == i[n - 1] and it[n] == it[n - 1]:
            groups[-1].append(n)
        else:
            groups.append([n])
    return groups


def _moved(value: Floats, tail: Floats, where: list[int], by: float) -> tuple[Floats, Floats]:
    """Return pairs with some of them moved."""
    high, low = value.copy(), tail.copy()
    for n in where:
        high[n], low[n] = dd_add(value[n], tail[n], by, 0.0)
    return high, low


def _add(
    total: list[float], k: int, inertia: PrincipalInertia, resolved: Resolved, stated: Sequence[float], times: float
) -> bool:
    """Add what a move changes; return whether the figures are those of the same regime."""
    moved = *found_figures(k, inertia, resolved)[4], *_angles(middle_axis_tilt(resolved, inertia))
    for n, (old, new) in enumerate(zip(stated, moved, strict=True)):
        if isfinite(old) != isfinite(new):
            return False
        if isfinite(old):
            # Both are rounded to doubles.
            total[n] += CURVED * (abs(new - old) + (ulp(old) if old else 0.0)) / times
    return True
