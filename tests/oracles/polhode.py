"""The exact facts of a torque-free motion, as fractions of the inputs.

Which axis is circled, whether the motion stands on the separatrix, whether anything accelerates at all: these are
decided here, where nothing is rounded. So is everything that could cancel; what follows only takes square roots.

References
----------
.. [1] L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed., section 37 (the asymmetrical top).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Generic, NamedTuple, TypeVar

Scalar = TypeVar("Scalar")


class Axes(NamedTuple, Generic[Scalar]):
    """What belongs to the middle axis b, to the other axis c, and to the circled axis d."""

    b: Scalar
    c: Scalar
    d: Scalar


@dataclass(frozen=True)
class Polhode:
    """The curve that the angular velocity draws in the body, and the pace at which it does.

    With ``v = v(0) + direction p t`` [1]_::

        w_b = A_b sn v        w_c = sign_c A_c cn v        w_d = sign_d A_d dn v

    Axis d, of the largest or the smallest moment, is the one that the curve circles; c is the other extreme.
    On the separatrix neither extreme is circled; the same holds with ``m1 = 0``.

    Attributes
    ----------
    axes : Axes of int
        Where the axes stand in the body's order.
    moments, rates, squared_amplitudes : Axes of Fraction
        Principal moments, angular velocity at the start, and the squares of A.
    signs : Axes of int
        Signs of the components at ``v = 0``; that of the middle axis is put into `direction`.
    direction : int
        +1 or -1.
    m, m1 : Fraction
        Parameter and its complement.
    squared_p, squared_momentum : Fraction
        Squares of the rate of v and of the angular momentum.
    n, k : Fraction
        Axis d turns about the angular momentum L at the rate ``(L/I_c) (1 - k sn**2 / (1 + n sn**2))``.
    """

    axes: Axes[int]
    moments: Axes[Fraction]
    rates: Axes[Fraction]
    squared_amplitudes: Axes[Fraction]
    signs: Axes[int]
    direction: int
    m: Fraction
    m1: Fraction
    squared_p: Fraction
    squared_momentum: Fraction
    n: Fraction
    k: Fraction

    @classmethod
    def through(cls, moments: Sequence[Fraction], rates: Sequence[Fraction]) -> Polhode:
        """Return the polhode through a state that accelerates (see `accelerates`)."""

        def excess(j: int) -> Fraction:
            """L**2 - 2 E I_j, as a sum that cancels only for the middle axis, and there exactly."""
            return sum((moments[i] * (moments[i] - moments[j]) * rates[i] ** 2 for i in range(3)), Fraction(0))

        least, b, greatest = sorted(range(3), key=lambda i: moments[i])
        d, c = (greatest, least) if excess(b) > 0 else (least, greatest)
        i_b, i_c, i_d = moments[b], moments[c], moments[d]
        gap_b, gap_c, x, y = abs(i_d - i_b), abs(i_d - i_c), abs(excess(d)), abs(excess(c))
        sign_c, sign_d = (-1 if rates[axis] < 0 else 1 for axis in (c, d))
        # Euler's equation of the middle axis, I_b w_b' = (I_(b+1) - I_(b+2)) w_(b+1) w_(b+2), where sn rises.
        forward = sign_c * sign_d * (1 if moments[b - 2] > moments[b - 1] else -1)
        return cls(
            axes=Axes(b, c, d),
            moments=Axes(i_b, i_c, i_d),
            rates=Axes(rates[b], rates[c], rates[d]),
            squared_amplitudes=Axes(x / (i_b * gap_b), x / (i_c * gap_c), y / (i_d * gap_c)),
            signs=Axes(1, sign_c, sign_d),
            direction=forward,
            m=abs(i_b - i_c) * x / (gap_b * y),
            m1=gap_c * abs(excess(b)) / (gap_b * y),
            squared_p=gap_b * y / (i_b * i_c * i_d),
            squared_momentum=sum(((i * w) ** 2 for i, w in zip(moments, rates, strict=True)), Fraction(0)),
            n=i_d * (i_b - i_c) / (i_c * (i_d - i_b)),
            k=(i_b - i_c) * (i_d - i_c) / (i_c * (i_d - i_b)),
        )

    @property
    def squared_largest_rate(self) -> Fraction:
        """Square of the largest angular velocity of the whole motion: linear in sn**2, so reached at sn = 0 or 1."""
        b, c, d = self.squared_amplitudes
        return max(c + d, b + self.m1 * d)


def accelerates(moments: Sequence[Fraction], rates: Sequence[Fraction]) -> bool:
    """Tell whether any component of the angular velocity changes."""
    return any((moments[i - 2] - moments[i - 1]) * rates[i - 2] * rates[i - 1] for i in range(3))
