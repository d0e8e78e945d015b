"""Prices of certified answers: counted samples, times costs that grow with the square of the digits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from core.bodies.exact_bodies import MOST_PARTS
from core.digits.adaptive_precision import check_digits
from core.systems.budget import Budget
from service.schemas import sample_count

SET_UP = 5e-3
"""Predicted time without samples (s): precision may be raised a hundredfold, so no such question runs in the server."""


@dataclass(frozen=True)
class PerSample:
    """Predicted time of a sample of d digits: constant + linear d + quadratic d^2 (s)."""

    constant: float
    linear: float
    quadratic: float

    def seconds(self, digits: int) -> float:
        """Return the time of one sample (s)."""
        return self.constant + digits * (self.linear + digits * self.quadratic)


def affordable(times: Any, digits: int, numbers: int, budget: Budget) -> int:
    """Return the number of samples, of so many numbers each, or raise `BudgetExceeded`."""
    samples = sample_count(times, budget)
    check_digits(digits, numbers * samples)
    return samples


def summing(body: Any) -> float:
    """Return the predicted time to sum a body in rational arithmetic (s)."""
    positions: Any = body.positions or ()
    length = max((longest(row) for row in positions), default=0)
    # Every part turns and moves by denominators of its own, which multiply; more parts are refused, at no cost.
    parts = min(_parts(body), MOST_PARTS)
    return len(positions) * (1.2e-4 + 8.5e-9 * length * length) + parts * (4e-3 + 5e-5 * parts)


def _parts(body: Any) -> int:
    return sum(max(1, _parts(part.body)) for part in body.parts or ())


def longest(numbers: Sequence[Any]) -> int:
    """Return the number of characters of the longest numeral, those of a double if there is none."""
    return max((len(number) for number in numbers if isinstance(number, str)), default=17)
