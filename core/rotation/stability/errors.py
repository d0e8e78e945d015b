"""Bounds of the errors of what is answered of equilibria of a free body.

The doubles that are stated are the nearest to numbers that are right to 1e-27 of themselves for the moments that the
kernel is given. Moments that were derived are known to their own rounding only: about an axis of moment a, beside b and
c, lambda^2 = W^2 (a - b)(c - a)/(b c) lies between the values of that for the ends of all differences and moments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import expm1, inf, isfinite, log1p, ulp
from typing import NamedTuple

import numpy as np

from core.arrays import Floats
from core.bodies.principal_inertia import PrincipalInertia, Rounding
from core.bodies.rounding_errors import WIDER, principal_errors
from core.rotation.closed_form.principal_frame import Resolved
from core.rotation.precession.figure_errors import HALF_UNIT, axis_error, figure_errors, found_figures

FLIP = 3
"""Number of the interval between flips in `core.rotation.precession.precession.FIGURES`."""


class EquilibriumErrors(NamedTuple):
    """Bounds of the errors of an equilibrium's figures; None where the figure is.

    Attributes
    ----------
    axis : float or None
        Length of the difference.
    moment : float or None
        kg m^2.
    eigenvalue : float or None
        Of the two eigenvalues that may differ from 0, as of `growth_rate`; the third is 0 exactly (1/s).
    drift_rate : float or None
        1/s.
    """

    axis: float | None
    moment: float | None
    eigenvalue: float | None
    drift_rate: float | None


AT_REST = EquilibriumErrors(None, None, 0.0, 0.0)
"""All is zero exactly."""


def equilibrium_errors(
    inertia: PrincipalInertia,
    moments: tuple[Floats, Floats],
    axis: int,
    pointing: Sequence[float],
    size: float | None,
    drift: float | None,
) -> EquilibriumErrors:
    """Return the errors of what is stated about one of the principal axes.

    Parameters
    ----------
    inertia : PrincipalInertia
    moments : tuple of two ndarray, shape (3,)
        With their tails, as they decide the kinds of equilibria.
    axis : int
        Of the moments in ascending order.
    pointing : sequence of 3 floats
        The axis in body axes.
    size, drift : float or None
        Magnitude of the eigenvalues, and the rate of drift (1/s).
    """
    value, tail = moments
    known = _known(inertia, value)

    def apart(j: int, k: int) -> tuple[float, float]:
        """Return a difference of moments, and what it may be wrong by as a share of it."""
        gap = abs(float((value[j] - value[k]) + (tail[j] - tail[k])))
        return gap, (known[j] + known[k]) / gap if gap else 0.0

    others = [k for k in range(3) if k != axis]
    shares = [apart(axis, k) for k in others]
    off = [known[k] / float(value[k]) for k in others]
    eigenvalue = _off(size, [share for _, share in shares], off, 0.5)
    # It drifts where one of the others is equal to it: by the difference with the third over the moment.
    drifting = max(shares)[1]
    drifts = _off(drift, [drifting], [known[axis] / float(value[axis])], 1.0)
    stated = principal_errors(inertia, 0.0)["moments"]
    return EquilibriumErrors(axis_error(inertia, pointing), float(stated[axis]), eigenvalue, drifts)


def _known(inertia: PrincipalInertia, moments: Floats) -> list[float]:
    """Return what the moments may be wrong by (kg m^2)."""
    share = inertia.rounding.share
    if inertia.rounding.exact_zeros:
        return [share * float(x) for x in moments]
    stated = principal_errors(inertia, 0.0)["moments"]
    # Without the tails, which the kernel has.
    return [max(float(wrong) - abs(float(x)), 0.0) for wrong, x in zip(stated, inertia.moments_tail, strict=True)]


def _off(figure: float | None, above: Sequence[float], below: Sequence[float], power: float) -> float | None:
    """Return how far a figure may be from a power of a quotient, each factor of which is known to a share of it."""
    if not figure:
        return figure
    if max(below) >= 1.0:
        return inf
    most = sum(map(log1p, above)) - sum(log1p(-share) for share in below)
    least = sum(log1p(-share) if share < 1.0 else -inf for share in above) - sum(map(log1p, below))
    change = max(expm1(power * most), -expm1(power * least))
    return HALF_UNIT * ulp(figure) + abs(figure) * change * WIDER


def flip_error(inertia: PrincipalInertia, rates: Sequence[float], interval: float | None) -> float | None:
    """Return the error of the interval between flips, from rates along the principal axes (s); None without one."""
    if interval is None:
        return None
    rounding = inertia.rounding
    if not rounding.exact_zeros:
        # The axes do not enter; of the moments each is known as a share of the largest.
        rounding = Rounding(rounding.share * float(inertia.moments[2] / inertia.moments[0]), True)
    along = replace(inertia, axes=np.eye(3), axes_tail=np.zeros((3, 3)), rounding=rounding, tensor=None)
    resolved = Resolved(inertia.moments, inertia.moments_tail, np.array(rates), np.zeros(3), 0.0)
    figures = found_figures(-1, along, resolved)[4]
    found = figure_errors(-1, along, resolved, figures, None)[FLIP]
    return found + abs(figures[FLIP] - interval) if isfinite(figures[FLIP]) else interval
