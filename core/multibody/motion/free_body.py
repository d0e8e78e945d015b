"""One rigid body that turns freely: the closed form of `core.certified`, in balls, at any time.

The body axes are those of the start turned by the quaternion of the free rotation, e_k(t) = sum of R_ik e_i(0). Where
the tensor and the start do not decide the branch of the solution within the precision here, the series is used instead.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import Undetermined, precision
from core.bodies.exact_inertia import ExactInertia
from core.errors import AccuracyUnreachable, MechanicsError
from core.multibody.algebra.directions import cross
from core.multibody.algebra.polynomials import BITS, ONE, ZERO, Ball, is_zero
from core.multibody.equations.packed import two_to
from core.multibody.motion.motion import BallState, Motion, States, in_pairs
from core.multibody.motion.turning_body import TurningBody
from core.multibody.table.table import Table
from core.rotation.exact_start import ExactStart, PrincipalState
from core.rotation.turning_motion import TurningMotion, TurningStart

_SMALL = 2.0**-98
"""Bound of the error of a state as a share of its size: eight bits more than the rounding to pairs."""

_ENOUGH = 110
"""Bits to which an axis has to be known."""

Sample = Callable[[Ball], tuple[list[Ball], list[Ball]]]
"""From a time to the angular velocity in body axes and the quaternion from the axes of the start."""


@dataclass(frozen=True)
class FreeBody(Motion):
    """A body that nothing turns.

    Attributes
    ----------
    sample : callable
        From a time to angular velocity and quaternion, in balls.
    """

    table: Table
    body: TurningBody
    sample: Sample
    name: str = "free rotation"
    why: str = "one rigid body turns freely: Euler's equations by elliptic functions"
    how: str = "closed form"
    period: Ball | None = field(default=None)

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, right to the last bits of pairs.

        Raises
        ------
        AccuracyUnreachable
            At a time so far away that 320 bits do not tell the attitude.
        """
        with precision(BITS):
            states = [self._at(self.sample, arb(float(t))) for t in times]
            if any(x.rad() > two_to(-_ENOUGH) for state in states for x in state.q):
                reason = "320 bits do not tell the attitude at this time"
                raise AccuracyUnreachable(None, np.inf, reason, path=("times",))
        q, v = in_pairs(states, 9)
        size = np.abs(v[..., 0]).max(axis=1, initial=0.0, keepdims=True)
        return States(q, v, np.full(q.shape[:2], _SMALL), _SMALL * np.broadcast_to(size, v.shape[:2]))

    def in_balls(self, times: Sequence[Ball]) -> list[BallState] | None:
        """Return the states where the body axes are principal, or it spins steadily; it raises as `Motion.in_balls`."""
        sample = self._enclosed()
        return None if sample is None else [self._at(sample, time) for time in times]

    def _enclosed(self) -> Sample | None:
        """Return the motion from what is known of tensor and angular velocity, None where axes have to be found."""
        tensor, omega = self.body.tensor, self.body.angular_velocity
        momentum = [sum((x * w for x, w in zip(row, omega, strict=True)), ZERO) for row in tensor]
        if all(is_zero(x) for x in cross(momentum, omega)):
            return _steady(omega)
        if not all(is_zero(tensor[a][b]) for a in range(3) for b in range(a + 1, 3)):
            return None
        return _turning(EnclosedStart([tensor[k][k] for k in range(3)], omega))

    def _at(self, sample: Sample, time: Ball) -> BallState:
        """Return the state at a time."""
        omega, turn = sample(time)
        axes = self._axes(turn)
        rates: list[Ball] = []
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            rates.extend(omega[c] * x - omega[b] * y for x, y in zip(axes[b], axes[c], strict=True))
        return BallState([x for axis in axes for x in axis], rates)

    def _axes(self, turn: list[Ball]) -> list[list[Ball]]:
        w, x, y, z = turn
        r = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
        start = self.body.axes
        return [[sum((r[m][k] * start[m][i] for m in range(3)), ZERO) for i in range(3)] for k in range(3)]


def freely_turning(table: Table, body: TurningBody) -> FreeBody | None:
    """Return the motion of a body without a torque; None where its branch is not decided by exact numbers."""
    if body.arm is not None:
        return None
    tensor = [[_fraction(body.tensor[min(a, b)][max(a, b)]) for b in range(3)] for a in range(3)]
    for a in range(3):
        for b in range(a):
            if is_zero(body.tensor[a][a] - body.tensor[b][b]) and not tensor[a][b]:
                tensor[a][a] = tensor[b][b]
    omega = [_fraction(x) for x in body.angular_velocity]
    try:
        inertia = ExactInertia(tuple((row[0], row[1], row[2]) for row in tensor))  # type: ignore[arg-type]
        start = ExactStart(inertia, (omega[0], omega[1], omega[2]))
        if start.regime == "rest" or inertia.is_line:
            return None
        momentum = [sum((x * w for x, w in zip(row, body.angular_velocity, strict=True)), ZERO) for row in body.tensor]
        if all(is_zero(x) for x in cross(momentum, body.angular_velocity)):
            return FreeBody(table, body, _steady(body.angular_velocity))
        return FreeBody(table, body, _turning(start))
    except (Undetermined, MechanicsError, ZeroDivisionError):
        return None


class EnclosedStart:
    """The start of a body that turns freely, as balls; what the present precision does not tell from zero is zero.

    Parameters
    ----------
    moments : sequence of 3 balls
        About the body axes, which are principal.
    omega : sequence of 3 balls
        In body axes.
    """

    def __init__(self, moments: Sequence[Ball], omega: Sequence[Ball]) -> None:
        i, j, k = sorted(range(3), key=lambda n: float(moments[n]))
        low, middle, high = moments[i], moments[j], moments[k]
        gaps = [ZERO if is_zero(x) else x for x in (middle - low, high - middle, high - low)]
        # An odd permutation is made right-handed by turning the third axis round.
        sign = 1 if (i, j, k) in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
        axes = [(ONE * (n == i), ONE * (n == j), sign * ONE * (n == k)) for n in range(3)]
        rates = omega[i], omega[j], sign * omega[k]
        self._state = PrincipalState(
            (low, middle, high), (gaps[0], gaps[1], gaps[2]), rates, (axes[0], axes[1], axes[2])
        )
        # L^2 - 2E B, as a sum without the term of the middle axis.
        first, last = low * gaps[0] * rates[0] ** 2, high * gaps[1] * rates[2] ** 2
        self._difference = ZERO if is_zero(last - first) else last - first

    @property
    def side(self) -> int:
        """The sign of D_B."""
        return 1 if self._difference > 0 else -1 if self._difference < 0 else 0

    def principal_state(self) -> PrincipalState:
        """Return the start in principal axes."""
        return self._state

    def difference(self, middle: Ball) -> Ball:
        """Return |D_B|."""
        return abs(self._difference)

    def invariants(self) -> tuple[Ball, Ball]:
        """Return L^2 and 2E."""
        moments, rates = self._state.moments, self._state.rates
        momenta = [x * w for x, w in zip(moments, rates, strict=True)]
        return sum((x * x for x in momenta), ZERO), sum((x * w for x, w in zip(momenta, rates, strict=True)), ZERO)


def _turning(start: TurningStart) -> Sample:
    motion = TurningMotion(start)
    attitude = motion.attitudes((ONE, ZERO, ZERO, ZERO))

    def sample(time: Ball) -> tuple[list[Ball], list[Ball]]:
        phase = motion.phase(time)
        v = motion.in_frame(phase)
        return list(motion.in_body(v)), list(attitude(phase, v))

    return sample


def _steady(omega: list[Ball]) -> Sample:
    rate = sum((x * x for x in omega), ZERO).sqrt()

    def sample(time: Ball) -> tuple[list[Ball], list[Ball]]:
        sine, cosine = (rate * time / 2).sin_cos()
        return omega, [cosine, *(sine * x / rate for x in omega)]

    return sample


def _fraction(ball: Ball) -> Fraction:
    """Return the midpoint of a ball, zero of one that holds it."""
    if is_zero(ball):
        return Fraction(0)
    mantissa, power = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(power)
