"""Constant rotations that give the quaternions of a closed form the requested initial attitude, compiled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from core.compiled import kernel
from core.double_double import Pair, Scaled, dd_add_d, sc_mul, scaled
from core.rotation.attitude.quaternions import (
    IDENTITY,
    ZERO,
    Quaternion,
    conjugate,
    fill_between,
    of_matrix,
    product,
    unit,
)
from core.rotation.attitude.sampling import phase_at_start
from core.rotation.closed_form.circulation import SEPARATRIX
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion
from core.rotation.precession.constants import PrecessionConstants


@kernel()
def _given(q: NDArray[np.float64]) -> Quaternion:
    """Return the unit quaternion of four given numbers."""
    return unit(Quaternion((q[0], 0.0), (q[1], 0.0), (q[2], 0.0), (q[3], 0.0)))


@kernel()
def fill_at_rest(start: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Fill `out`, shape (4, n), with the unit quaternion of `start`, shape (4,)."""
    q = _given(start)
    out[0, :], out[1, :], out[2, :], out[3, :] = q.w[0], q.x[0], q.y[0], q.z[0]


@kernel()
def from_steady(
    start: NDArray[np.float64], rate: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the matrix from rotations about an angular velocity to attitudes, shape (4, 4), and its direction.

    Parameters
    ----------
    start : ndarray, shape (4,)
        Attitude at t = 0; any length but zero.
    rate : ndarray, shape (3,)
        Constant angular velocity in body axes, not zero.
    """
    turn = np.empty((4, 4))
    fill_between(_given(start), IDENTITY, turn)
    axis = unit(Quaternion(ZERO, (rate[0], 0.0), (rate[1], 0.0), (rate[2], 0.0)))
    return turn, np.array((axis.x[0], axis.y[0], axis.z[0]))


@kernel()
def _shifted(x: Scaled, exponent: int, sign: float) -> Pair:
    """Return x 2^-exponent, at most 1 in magnitude, times a sign."""
    shift = x.exponent - exponent
    if x.high == 0.0 or shift < -900:
        return 0.0, 0.0
    f = math.ldexp(sign, shift)
    return x.high * f, x.low * f


@kernel()
def from_precession(
    motion: ConstantsOfMotion,
    pre: PrecessionConstants,
    i: NDArray[np.float64],
    it: NDArray[np.float64],
    w: NDArray[np.float64],
    wt: NDArray[np.float64],
    axes: NDArray[np.float64],
    axes_tail: NDArray[np.float64],
    start: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the matrix from Rz(psi) P to the attitude, shape (4, 4): a product from the left and one from the right.

    The axes of P are those of the motion: x along c, z along d, each in the direction of the initial component, and
    y = z x x. In these axes m is the direction of the angular momentum and P the shortest rotation that takes it to z.

    Parameters
    ----------
    i, it, w, wt : ndarray, shape (3,)
        Principal moments and angular velocity along their axes, each with its tail.
    axes, axes_tail : ndarray, shape (3, 3)
        Principal axes as columns in body axes.
    start : ndarray, shape (4,)
        Attitude at t = 0; any length but zero.
    """
    c, d = (0, 2) if motion.circled == 2 else (2, 0)
    on_c = math.copysign(1.0, motion.A_c) if motion.regime == SEPARATRIX else 1.0
    on_d = math.copysign(1.0, motion.A_d)
    # The middle axis is e_d x e_c for d = 2, and the opposite for d = 0.
    on_b = on_c * on_d * (1.0 if d == 2 else -1.0)
    first = sc_mul(scaled(i[c], it[c], 0), scaled(w[c], wt[c], 0))
    middle = sc_mul(scaled(i[1], it[1], 0), scaled(w[1], wt[1], 0))
    last = sc_mul(scaled(i[d], it[d], 0), scaled(w[d], wt[d], 0))
    exponent = -(1 << 30)
    for x in (first, middle, last):
        if x.high != 0.0 and x.exponent > exponent:
            exponent = x.exponent
    m = unit(
        Quaternion(
            ZERO, _shifted(first, exponent, on_c), _shifted(middle, exponent, on_b), _shifted(last, exponent, on_d)
        )
    )
    arc = unit(Quaternion(dd_add_d(m.z[0], m.z[1], 1.0), m.y, (-m.x[0], -m.x[1]), ZERO))
    tr, ti = phase_at_start(motion, pre)
    at_start = product(unit(Quaternion((tr, 0.0), ZERO, ZERO, (ti, 0.0))), arc)
    frame, frame_tail = np.empty((3, 3)), np.empty((3, 3))
    for row in range(3):
        frame[row, 0], frame_tail[row, 0] = on_c * axes[row, c], on_c * axes_tail[row, c]
        frame[row, 1], frame_tail[row, 1] = on_b * axes[row, 1], on_b * axes_tail[row, 1]
        frame[row, 2], frame_tail[row, 2] = on_d * axes[row, d], on_d * axes_tail[row, d]
    q = of_matrix(frame, frame_tail)
    onto = np.empty((4, 4))
    fill_between(product(product(_given(start), q), conjugate(at_start)), conjugate(q), onto)
    return onto
