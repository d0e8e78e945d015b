"""The figures of the free precessions of many bodies at once, compiled: the same bits as `precession` gives for each.

Bodies are known by their principal moments, so that nothing is derived but an order of axes. Each motion goes through
the kernels that a single one goes through. What a single one treats outside of them (rest, steady rotations, spheres
and needles, the separatrix and what only exact arithmetic tells from it, figures that no double states) is left to it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.bodies.principal_inertia import EQUAL, ZEROS
from core.bodies.validity import TOLERANCE
from core.compiled import kernel
from core.double_double import Scaled
from core.errors import InvalidParameter
from core.rotation.closed_form.circulation import PERIODIC
from core.rotation.closed_form.principal_frame import resolve
from core.rotation.precession.figures import precession_figures
from core.rotation.precession.middle_axis import swing

NUMBERS = 9
"""Figures of a precession, in the order of `core.rotation.precession.precession.FIGURES`."""


class Precessions(NamedTuple):
    """Figures of many precessions; those of a motion that is not answered are not set.

    Attributes
    ----------
    answered : ndarray, shape (n,), of bool
        Whether a motion is one of those that are answered here.
    figures : ndarray, shape (n, 9)
        In the order of `core.rotation.precession.precession.FIGURES`, NaN where the motion has no such thing.
    tilt : ndarray, shape (n, 2)
        Least and largest angle of the middle axis from the angular momentum (rad); NaN where there is no middle axis.
    tumbles : ndarray, shape (n,), of bool
    axis : ndarray, shape (n, 3)
        Unit vectors in body axes.
    unphysical : ndarray, shape (n,), of bool
        Whether no distribution of positive mass has these moments.
    """

    answered: NDArray[np.bool_]
    figures: Floats
    tilt: Floats
    tumbles: NDArray[np.bool_]
    axis: Floats
    unphysical: NDArray[np.bool_]


@kernel()
def _ascending(a: float, b: float, c: float) -> tuple[int, int, int]:
    """Return the numbers of three moments in ascending order, equal ones in the order in which they are given."""
    i, j, k = 0, 1, 2
    if b < a:
        i, j, a, b = 1, 0, b, a
    if c < b:
        j, k, b = k, j, c
        if b < a:
            i, j = j, i
    return i, j, k


@kernel()
def _fill(
    moments: NDArray[np.float64],
    spins: NDArray[np.float64],
    no_tails: NDArray[np.float64],
    answered: NDArray[np.bool_],
    figures: NDArray[np.float64],
    tilt: NDArray[np.float64],
    tumbles: NDArray[np.bool_],
    axis: NDArray[np.float64],
    unphysical: NDArray[np.bool_],
) -> None:
    inertia, axes, parts = np.empty(3), np.empty((3, 3)), np.empty((4, 3))
    undecided = Scaled(0.0, 0.0, 0)
    for n in range(moments.shape[0]):
        answered[n] = False
        i, j, k = _ascending(moments[n, 0], moments[n, 1], moments[n, 2])
        low, middle, high = moments[n, i], moments[n, j], moments[n, k]
        x, y, z = spins[n, 0], spins[n, 1], spins[n, 2]
        if not (low > 0.0 and high < math.inf and math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
            continue
        # The classes of `PrincipalInertia.symmetry`.
        lower, upper = middle - low <= EQUAL * high, high - middle <= EQUAL * high
        if (lower and upper) or (upper and low <= EQUAL * high):
            continue
        symmetry_axis = 2 if lower else 0 if upper else -1
        # As in `PrincipalInertia.along_body_axes`.
        axes[:, :] = 0.0
        axes[i, 0], axes[j, 1] = 1.0, 1.0
        axes[k, 2] = 1.0 if (j - i) % 3 == 1 else -1.0
        inertia[0], inertia[1], inertia[2] = low, middle, high
        resolve(axes, no_tails, inertia, no_tails[0], x, y, z, False, parts)
        i_, it, w, wt = parts[0], parts[1], parts[2], parts[3]
        regime, beyond, apart, direction, found = precession_figures(
            symmetry_axis, inertia, no_tails[0], axes, i_, it, w, wt, False, 0.0, 0.0, 0
        )
        if regime != PERIODIC or beyond or apart:
            continue
        stated = True
        for m in range(NUMBERS):
            stated = stated and not math.isinf(found[m])
            figures[n, m] = found[m]
        turning = 0
        for m in range(3):
            if w[m] != 0.0:
                turning += 1
        tilt[n, 0], tilt[n, 1], tumbles[n] = math.nan, math.nan, False
        if low != middle and middle != high:
            if turning < 2:
                continue
            of, least, largest, over = swing(i_, it, w, wt, False, undecided)
            stated = stated and of == PERIODIC and math.isfinite(least)
            tilt[n, 0], tilt[n, 1], tumbles[n] = least, largest, over
        # As in `core.bodies.validity`.
        a, b, c = low / high, middle / high, 1.0
        unphysical[n] = high > low + middle and (c - a - b) / (a + b + c) > TOLERANCE
        axis[n, 0], axis[n, 1], axis[n, 2] = direction[0], direction[1], direction[2]
        answered[n] = stated


def precessions(moments: Floats, angular_velocities: Floats) -> Precessions:
    """Return the precessions of bodies with principal moments, each from an angular velocity at t = 0.

    Parameters
    ----------
    moments : ndarray, shape (n, 3)
        Along the body axes, in any order (kg m^2).
    angular_velocities : ndarray, shape (n, 3)
        In body axes (rad/s).

    Raises
    ------
    InvalidParameter
        If the arrays have other shapes.
    """
    count = len(moments)
    for name, array in (("moments", moments), ("angular_velocities", angular_velocities)):
        if array.shape != (count, 3):
            raise InvalidParameter(name, f"have the shape ({count}, 3)")
    found = Precessions(
        np.empty(count, dtype=np.bool_),
        np.empty((count, NUMBERS)),
        np.empty((count, 2)),
        np.empty(count, dtype=np.bool_),
        np.empty((count, 3)),
        np.empty(count, dtype=np.bool_),
    )
    # A negative zero is none, as in `PrincipalMoments`.
    given = np.ascontiguousarray(moments, dtype=np.float64) + 0.0
    _fill(given, np.ascontiguousarray(angular_velocities, dtype=np.float64), ZEROS, *found)
    return found
