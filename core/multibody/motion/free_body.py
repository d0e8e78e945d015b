"""One rigid body that turns freely: the closed form of `core.certified`, in balls, at any time.

The body axes are those of the start turned by the quaternion of the free rotation, e_k(t) = sum of R_ik e_i(0). Where
the tensor and the start do not decide the branch of the solution within the precision here, the series is used instead.
"""

from __future__ import annotations

from collections.abc import Callable
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
from core.multibody.equations.packed import pair, two_to
from core.multibody.motion.motion import Motion, States, check_sample_count
from core.multibody.motion.turning_body import TurningBody
from core.multibody.table.table import Table
from core.rotation.exact_start import ExactStart
from core.rotation.turning_motion import TurningMotion

_SMALL = 2.0**-98
"""Bound of the error of a state as a share of its size: eight bits more than the rounding to pairs."""

_ENOUGH = 110
"""Bits to which an axis has to be known."""
_PER_RADIAN = 8
"""Nodes to a radian at the fastest rate: fifty to an oscillation."""

_MOST_NODES = 40_000
"""Nodes of one motion: places and rates at so many are 12 MB in pairs."""

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
        q, v = np.zeros((len(times), 9, 2)), np.zeros((len(times), 9, 2))
        with precision(BITS):
            for s, t in enumerate(times):
                omega, turn = self.sample(arb(float(t)))
                axes = self._axes(turn)
                for a in range(3):
                    b, c = (a + 1) % 3, (a + 2) % 3
                    for i in range(3):
                        if axes[a][i].rad() > two_to(-_ENOUGH):
                            reason = "320 bits do not tell the attitude at this time"
                            raise AccuracyUnreachable(None, np.inf, reason, path=("times",))
                        q[s, 3 * a + i] = pair(axes[a][i], 0)
                        v[s, 3 * a + i] = pair(omega[c] * axes[b][i] - omega[b] * axes[c][i], 0)
        size = np.abs(v[..., 0]).max(axis=1, keepdims=True)
        return States(q, v, np.full(q.shape[:2], _SMALL), _SMALL * np.broadcast_to(size, v.shape[:2]))

    def _axes(self, turn: list[Ball]) -> list[list[Ball]]:
        w, x, y, z = turn
        r = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
        start = self.body.axes
        return [[sum((r[m][k] * start[m][i] for m in range(3)), ZERO) for i in range(3)] for k in range(3)]

    def nodes(self, end: float) -> Floats:
        """Return eight times to a radian at the fastest that the body could turn with its angular momentum."""
        tensor = [[float(x) for x in row] for row in self.body.tensor]
        omega = [float(x) for x in self.body.angular_velocity]
        least = float(np.linalg.eigvalsh(np.array(tensor), UPLO="U")[0])
        fastest = float(np.linalg.norm(np.array(tensor) @ omega)) / least if least > 0.0 else np.inf
        count = fastest * abs(end) * _PER_RADIAN
        check_sample_count(count, _MOST_NODES)
        return np.linspace(0.0, end, 17 + int(count))


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


def _turning(start: ExactStart) -> Sample:
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
