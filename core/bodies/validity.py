"""Whether mass properties are physically possible: a report of each condition. Nothing is repaired.

For any distribution of positive mass the principal moments are not negative and none exceeds the sum of the other
two, with equality for a lamina (I3 = I1 + I2) and a needle (I1 = 0, I2 = I3).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from core.bodies.principal_inertia import EPSILON, PrincipalInertia
from core.quantities import Unit

TOLERANCE = 16.0 * EPSILON
"""Violation of a condition that rounding of the tensor's components can cause, relative to the trace."""


@dataclass(frozen=True)
class Condition:
    """One condition of the report.

    Attributes
    ----------
    name : str
        For example ``"triangle-inequality"``.
    holds : bool
        Whether `excess` is within `tolerance`.
    detail : str
        The condition with its numbers.
    excess : float
        Scale-free violation (for moments, relative to the trace); negative if the condition holds with a margin.
    tolerance : float
        Largest excess that rounding can cause.
    moments : tuple of float
        The moments concerned, the one that is too large or too small first (kg m^2); empty for other conditions.
    """

    name: str
    holds: bool
    detail: str
    excess: Annotated[float, Unit("1")] = 0.0
    tolerance: Annotated[float, Unit("1")] = 0.0
    moments: Annotated[tuple[float, ...], Unit("kg m^2")] = ()


@dataclass(frozen=True)
class Validity:
    """The validity report.

    Attributes
    ----------
    physical : bool
        Whether every condition holds.
    report : tuple of Condition
        All conditions, those that hold included.
    """

    physical: bool
    report: tuple[Condition, ...]

    @classmethod
    def of(cls, principal: PrincipalInertia, others: tuple[Condition, ...] = ()) -> Validity:
        """Test principal moments, and add further conditions unchanged."""
        report = (*others, *_moments(principal))
        return cls(all(condition.holds for condition in report), report)

    @property
    def violations(self) -> tuple[Condition, ...]:
        """The conditions that do not hold."""
        return tuple(condition for condition in self.report if not condition.holds)


def moments_of_matter(principal: PrincipalInertia) -> bool:
    """Return whether matter can have these moments, without writing the report."""
    low, middle, high = principal.moments.tolist()
    # Of ascending moments these two imply the other two; the rounding of the sum is within the tolerance.
    if low >= 0.0 and high <= low + middle:
        return True
    return all(excess <= TOLERANCE for excess, _ in _excesses(principal))


def _excesses(principal: PrincipalInertia) -> list[tuple[float, tuple[float, ...]]]:
    """Return the excess of each condition and the moments concerned: the sign first, then the three inequalities."""
    low, middle, high = principal.moments.tolist()
    # Of magnitudes and of shares, so that neither signs nor the ends of the double range spoil it.
    size = max(abs(low), abs(high)) or 1.0
    a, b, c = low / size, middle / size, high / size
    trace = abs(a) + abs(b) + abs(c) or 1.0
    return [
        (-a / trace, (low,)),
        ((c - a - b) / trace, (high, low, middle)),
        ((b - a - c) / trace, (middle, low, high)),
        ((a - b - c) / trace, (low, middle, high)),
    ]


def _moments(principal: PrincipalInertia) -> list[Condition]:
    found = []
    for excess, moments in _excesses(principal):
        if len(moments) == 1:
            name, detail = (
                "positive-moments",
                f"no principal moment is negative: the smallest is {moments[0]:.12g} kg m^2",
            )
        else:
            name, detail = "triangle-inequality", "{:.12g} <= {:.12g} + {:.12g} kg m^2".format(*moments)
        found.append(Condition(name, excess <= TOLERANCE, detail, excess, TOLERANCE, moments))
    return found
