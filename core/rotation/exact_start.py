"""The state from which a free rotation starts, and what it decides exactly: the regime and the axis that is circled."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal, NamedTuple

from flint import arb, fmpq, fmpq_poly

from core.balls import Undetermined
from core.bodies.exact_inertia import ExactInertia, Vector, cross, triple
from core.digits.adaptive_precision import bits_for, until_determined, working_bits
from core.digits.decimals import FEWEST_DIGITS
from core.digits.exact_inputs import enclosed

Regime = Literal["rest", "steady", "periodic", "separatrix"]
Balls = tuple[arb, arb, arb]

EQUALITY_BITS = 640
"""A number that may vanish, and cannot be told from zero with so many bits, is taken to vanish."""


class PrincipalState(NamedTuple):
    """The start in right-handed principal axes of ascending moments, as balls of the current precision.

    Attributes
    ----------
    moments, rates : 3 balls
    gaps : 3 balls
        |B - A|, |C - B|, |C - A|, each formed without cancellation where the moments are rational.
    axes : 3 rows of 3 balls
        Columns are the principal axes in body axes.
    """

    moments: Balls
    gaps: Balls
    rates: Balls
    axes: tuple[Balls, Balls, Balls]


@dataclass(frozen=True)
class ExactStart:
    """A body and its angular velocity at t = 0 in rational numbers, and the facts that depend on nothing else.

    Attributes
    ----------
    inertia : ExactInertia
    angular_velocity : tuple of 3 fractions
        In body axes (rad/s).
    """

    inertia: ExactInertia
    angular_velocity: Vector

    @cached_property
    def momentum(self) -> Vector:
        """M = I w, in body axes."""
        return self.inertia.momentum(self.angular_velocity)

    @cached_property
    def twice_energy(self) -> Fraction:
        """2E = w.I w."""
        return sum((m * w for m, w in zip(self.momentum, self.angular_velocity, strict=True)), Fraction(0))

    @cached_property
    def squared_momentum(self) -> Fraction:
        """L^2."""
        return sum((m * m for m in self.momentum), Fraction(0))

    @cached_property
    def side(self) -> int:
        """The sign of D_B = L^2 - 2E B for a motion that turns: 1 circles the axis of the largest moment, -1 the least.

        s = L^2/2E lies strictly between A and C, because it is the mean of the moments with weights I w^2. There
        (A - s)(B - s)(C - s) has the sign of s - B, whatever coincides: a rational number decides although the moments
        may be irrational.
        """
        value = self.inertia.determinant_at(self.squared_momentum / self.twice_energy)
        return (value > 0) - (value < 0)

    @cached_property
    def regime(self) -> Regime:
        """Which branch of the solution holds."""
        if not any(self.angular_velocity):
            return "rest"
        if not any(cross(self.momentum, self.angular_velocity)):
            return "steady"
        return "periodic" if self.side else "separatrix"

    @cached_property
    def middle_side(self) -> int:
        """Where the moment of a steady spin lies among the others: -1 between them, 1 outside, 0 equal to one.

        The moment is a root r = L^2/2E of the characteristic cubic (x - r)(x - r1)(x - r2), whose derivative there is
        (r - r1)(r - r2), a rational number.
        """
        r = self.squared_momentum / self.twice_energy
        slope = 3 * r * r - 2 * r * self.inertia.trace + self.inertia.minors
        return (slope > 0) - (slope < 0)

    @cached_property
    def order(self) -> tuple[int, int, int]:
        """Body axes in ascending order of moments, where the body axes are principal."""
        i, j, k = sorted(range(3), key=lambda n: self.inertia.tensor[n][n])
        return i, j, k

    @cached_property
    def middle_difference(self) -> Fraction | None:
        """D_B, where the moments are rational."""
        moments = self.inertia.rational_moments
        if moments is None:
            return None
        return self.squared_momentum - self.twice_energy * moments[1]

    def difference(self, middle: arb) -> arb:
        """Return |D_B|, given an enclosure of the middle moment B.

        Raises
        ------
        Undetermined
            If the precision does not tell it from zero.
        """
        exact = self.middle_difference
        if exact is not None:
            return enclosed(abs(exact))
        if self.side == 0:
            return arb(0)
        squared, twice_energy = self.invariants()
        found = abs(squared - twice_energy * middle)
        if not found > 0:
            raise Undetermined
        return found

    def invariants(self) -> tuple[arb, arb]:
        """Return L^2 and 2E as balls of the current precision."""
        return enclosed(self.squared_momentum), enclosed(self.twice_energy)

    def tilts_below_45_degrees(self) -> bool:
        """Return whether the middle axis of a periodic motion comes within 45 degrees of the angular momentum.

        Where it comes nearest w_c vanishes, and with s = L^2/2E

            cos^2 = (1/s - 1/I_d)/(1/I_b - 1/I_d),

        which is more than 1/2 where 2 I_b I_d - s (I_b + I_d) has the sign of I_d - I_b. In the moment of the axis c,
        the trace and the determinant that is g(I_c)/I_c, g(x) = s x^2 - s tr x + 2 det: rational coefficients decide
        whether it can vanish although the moments may be irrational.
        """
        s, trace, determinant = (
            self.squared_momentum / self.twice_energy,
            self.inertia.trace,
            self.inertia.determinant_at(Fraction(0)),
        )
        own = 0 if self.side > 0 else 2
        rational = self.inertia.rational_moments
        if rational is not None:
            return (s * rational[own] * (rational[own] - trace) + 2 * determinant) * self.side > 0
        cubic = _polynomial(-determinant, self.inertia.minors, -trace, Fraction(1))
        may_vanish = cubic.gcd(_polynomial(2 * determinant, -s * trace, s)).degree() > 0

        def decided() -> bool:
            x = self.principal_state().moments[own]
            value = enclosed(s) * x * (x - enclosed(trace)) + enclosed(2 * determinant)
            if value > 0 or value < 0:
                return bool(value * self.side > 0)
            if may_vanish and working_bits() >= EQUALITY_BITS:
                return False
            raise Undetermined

        return until_determined(decided, bits_for(FEWEST_DIGITS))

    def principal_state(self) -> PrincipalState:
        """Return the start in principal axes at the current precision.

        Raises
        ------
        Undetermined
            If the precision does not tell the moments apart.
        """
        if self.inertia.diagonal:
            return self._along_body_axes()
        rational = self.inertia.rational_moments
        return self._general() if rational is None else self._symmetric(rational)

    def _along_body_axes(self) -> PrincipalState:
        moments = [self.inertia.tensor[n][n] for n in self.order]
        # An odd permutation is made right-handed by turning the third axis round.
        sign = 1 if self.order in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
        signs = (1, 1, sign)
        rates = [enclosed(s * self.angular_velocity[n]) for s, n in zip(signs, self.order, strict=True)]
        rows = []
        for body_axis in range(3):
            row = [arb(s if n == body_axis else 0) for s, n in zip(signs, self.order, strict=True)]
            rows.append(triple(row))
        return PrincipalState(
            triple([enclosed(x) for x in moments]), _gaps(moments), triple(rates), (rows[0], rows[1], rows[2])
        )

    def _symmetric(self, moments: tuple[Fraction, ...]) -> PrincipalState:
        """Two moments coincide: the axis of the third is rational, up to its length, and the spin gives another."""
        low, middle, high = moments
        pair, single = (low, high) if low == middle else (high, low)
        # I - pair has rank one, so its columns are along the axis of the single moment.
        t = self.inertia.tensor
        columns = [[t[i][j] - (pair if i == j else 0) for i in range(3)] for j in range(3)]
        n = next(column for column in columns if any(column))
        w = self.angular_velocity
        along = sum((x * y for x, y in zip(n, w, strict=True)), Fraction(0)) / sum((x * x for x in n), Fraction(0))
        across = [x - along * y for x, y in zip(w, n, strict=True)]
        if not any(across):
            # Every direction in the plane of the pair is an axis: that of the body axis farthest from the third.
            k = min(range(3), key=lambda j: abs(n[j]))
            across = [(Fraction(j == k) - n[k] * n[j] / sum((x * x for x in n), Fraction(0))) for j in range(3)]
            plane = arb(0)
        else:
            plane = enclosed(sum((x * x for x in across), Fraction(0))).sqrt()
        axis, first = _unit(n), _unit(across)
        second = _unit(cross(n, across))
        spin = enclosed(along) * enclosed(sum((x * x for x in n), Fraction(0))).sqrt()
        zero = arb(0)
        if single == high:
            return PrincipalState(
                triple([enclosed(x) for x in moments]),
                _gaps(moments),
                (plane, zero, spin),
                _columns(first, second, axis),
            )
        return PrincipalState(
            triple([enclosed(x) for x in moments]), _gaps(moments), (spin, plane, zero), _columns(axis, first, second)
        )

    def _general(self) -> PrincipalState:
        """Three algebraic moments: enclosures of the roots of the cubic, and the axes from the adjugate of I - root."""
        moments = self._roots()
        low, middle, high = moments
        axes = [_eigenvector(self.inertia, x) for x in moments]
        first, second, third = axes
        if not dot(cross(first, second), third) > 0:
            third = triple([-x for x in third])
        w = triple([enclosed(x) for x in self.angular_velocity])
        return PrincipalState(
            moments,
            (middle - low, high - middle, high - low),
            (dot(first, w), dot(second, w), dot(third, w)),
            _columns(first, second, third),
        )

    def _roots(self) -> Balls:
        inertia = self.inertia
        coefficients = [-inertia.determinant_at(Fraction(0)), inertia.minors, -inertia.trace, Fraction(1)]
        polynomial = _polynomial(*coefficients)
        roots: list[Any] = polynomial.complex_roots()
        found = [root.real for root, _ in roots]
        a, b, c = sorted(found, key=lambda root: root.mid())
        if not (a < b < c and a > 0):
            raise Undetermined
        return a, b, c


def _polynomial(*coefficients: Fraction) -> Any:
    """Return a polynomial by its coefficients in ascending order."""
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in coefficients])


def principal_axes(inertia: ExactInertia) -> PrincipalState:
    """Return principal moments and axes at the current precision, of a body that need not turn."""
    zero = Fraction(0)
    return ExactStart(inertia, (zero, zero, zero)).principal_state()


def _gaps(moments: tuple[Fraction, ...] | list[Fraction]) -> Balls:
    low, middle, high = moments
    return enclosed(middle - low), enclosed(high - middle), enclosed(high - low)


def _eigenvector(inertia: ExactInertia, moment: arb) -> Balls:
    """Return a unit eigenvector: every column of the adjugate of I - root is one, and the longest is not zero."""
    (a, b, c), (_, d, e), (_, _, f) = ([enclosed(x) for x in row] for row in inertia.tensor)
    a, d, f = a - moment, d - moment, f - moment
    columns = (
        (d * f - e * e, c * e - b * f, b * e - c * d),
        (c * e - b * f, a * f - c * c, b * c - a * e),
        (b * e - c * d, b * c - a * e, a * d - b * b),
    )
    # The adjugate is the projector on the axis times a number, so its diagonal holds the squares of the components.
    longest = max(range(3), key=lambda k: abs(columns[k][k]).mid())
    column = columns[longest]
    if not abs(column[longest]) > 0:
        raise Undetermined
    norm = dot(column, column).sqrt()
    return triple([x / norm for x in column])


def _unit(vector: list[Fraction] | Vector) -> Balls:
    norm = enclosed(sum((x * x for x in vector), Fraction(0))).sqrt()
    return triple([enclosed(x) / norm for x in vector])


def dot(u: Balls, v: Balls) -> arb:
    """Return u.v."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def _columns(x: Balls, y: Balls, z: Balls) -> tuple[Balls, Balls, Balls]:
    rows = [(x[i], y[i], z[i]) for i in range(3)]
    return rows[0], rows[1], rows[2]
