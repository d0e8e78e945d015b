"""What moved inputs do to a motion, by solving the moved problem to many digits."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from core.arrays import Floats
from core.bodies.exact_inertia import ExactInertia
from core.certified.free_rotation import CertifiedRotation
from tests.oracles.uncertain_bodies import Uncertain

DIGITS = 50
ATTITUDE = (Fraction(3, 5), Fraction(0), Fraction(4, 5), Fraction(0))


@dataclass(frozen=True)
class Perturbed:
    """A motion beside others whose inputs are not quite the same.

    Attributes
    ----------
    case : Uncertain
    times : sequence of float
        s.
    """

    case: Uncertain
    times: Sequence[float]

    @cached_property
    def inputs(self) -> list[Fraction]:
        """The numbers of the body, and those of the start."""
        return [Fraction(x) for x in (*self.case.numbers, *self.case.start)]

    def solved(self, inputs: Sequence[Fraction]) -> tuple[list[list[Fraction]], list[list[Fraction]]]:
        """Return angular velocities and attitudes."""
        tensor = self.case.tensor(inputs[:-3])
        x, y, z = (tuple(row) for row in tensor)
        motion = CertifiedRotation(ExactInertia((x, y, z)), tuple(inputs[-3:]))  # type: ignore[arg-type]
        found = motion.trajectory(self.times, DIGITS, ATTITUDE)
        rates, attitudes = ([[Fraction(x) for x in row] for row in rows] for rows in found)
        return rates, attitudes

    @cached_property
    def unmoved(self) -> tuple[list[list[Fraction]], list[list[Fraction]]]:
        """As `solved`, with the inputs as they are."""
        return self.solved(self.inputs)

    def moved(self, uncertainty: Fraction, signs: Sequence[int]) -> tuple[Floats, Floats]:
        """Return the differences of angular velocity (rad/s) and, as vectors of rotation, of attitude, shape (n, 3)."""
        rates, attitudes = self.solved([x * (1 + s * uncertainty) for x, s in zip(self.inputs, signs, strict=True)])
        before, turned = self.unmoved
        change = np.array(
            [[float(a - b) for a, b in zip(p, q, strict=True)] for p, q in zip(rates, before, strict=True)]
        )
        return change, np.array([_between(p, q) for p, q in zip(attitudes, turned, strict=True)])

    def error(self, samples: Floats, size: float) -> float:
        """Return the largest error of angular velocities, shape (n, 3), relative to a rate."""
        wrong = [
            [float(Fraction(float(x)) - y) / size for x, y in zip(*rows, strict=True)]
            for rows in zip(samples, self.unmoved[0], strict=True)
        ]
        return float(np.linalg.norm(wrong, axis=1).max())

    def attitude_error(self, samples: Floats) -> float:
        """Return the largest change of a unit vector that wrong attitudes, shape (n, 4), turn: at most the angle."""
        wrong = []
        for p, q in zip(samples, self.unmoved[1], strict=True):
            got = [Fraction(float(x)) for x in p]
            wrong.append(float(np.linalg.norm([float(x - y) for x, y in zip(got, q, strict=True)])))
        return 2.0 * max(wrong)

    def worst_signs(self) -> list[list[int]]:
        """Return signs of the inputs whose changes add up most at the last time, to first order.

        First for the angular velocity, then for the attitude.
        """
        step, count, last = Fraction(1, 10**30), len(self.inputs), Perturbed(self.case, self.times[-1:])
        moves = [last.moved(step, [int(n == k) for n in range(count)]) for k in range(count)]
        return [_aligned(np.array([move[which][0] for move in moves])) for which in (0, 1)]


def _aligned(moves: Floats) -> list[int]:
    """Return signs that make the sum of signed moves, shape (n, 3), longest, among those that a half-space gives."""
    best, signs = -1.0, [1] * len(moves)
    directions = [np.array(d, dtype=float) for d in itertools.product((-1, 0, 1), repeat=3) if any(d)]
    directions += list(moves)
    for direction in directions:
        for _ in range(3):
            trial = np.where(moves @ direction >= 0.0, 1, -1)
            total = trial @ moves
            direction = total
        length = float(np.linalg.norm(total))
        if length > best:
            best, signs = length, trial.tolist()
    return signs


def _between(p: Sequence[Fraction], q: Sequence[Fraction]) -> Floats:
    """Return the vector of rotation from one attitude to another (rad), right where it is small."""
    w, x, y, z = p[0], -p[1], -p[2], -p[3]
    a, b, c, d = q
    vector = (a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w)
    scale = max(*(abs(v) for v in vector), Fraction(1, 10**60))
    share = np.array([float(v / scale) for v in vector])
    sine = float(scale) * float(np.linalg.norm(share))
    return np.asarray(2.0 * np.arcsin(min(1.0, sine)) * share / float(np.linalg.norm(share) or 1.0))
