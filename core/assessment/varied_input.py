"""How a number of a question is drawn: from a range, of few digits or on a grid, or from a list of values."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal
from math import exp, isfinite, log
from typing import Annotated, Any, Literal

from core.errors import InvalidParameter
from core.quantities import Quantity, check

MOST_VALUES = 1000
MOST_TOGETHER = 20
LONGEST_WORD = 200
"""Characters of a value that is a string, and of a pointer."""

MOST_STEPS = 10**9

End = Annotated[float, Quantity("1")]
Step = Annotated[float, Quantity("1", above=0)]
Digits = Annotated[int, Quantity("1", at_least=1, at_most=15)]


class Scalar:
    """A number as it is written, a string or a truth value; `VariedInput` checks it."""

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> dict[str, Any]:
        return {"type": "any"}

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: Any) -> dict[str, Any]:
        return {"anyOf": [{"type": "number", "x-unit": "1"}, {"type": "string"}, {"type": "boolean"}]}


@dataclass(frozen=True)
class VariedInput:
    """A range from `min` to `max`, or a choice from `values`.

    Attributes
    ----------
    min, max : float, optional
        Ends of the range, both possible.
    distribution : {"uniform", "log-uniform"}
        Of the numbers of a range; log-uniform needs a positive one.
    step : float, optional
        Only `min` plus multiples of it are drawn.
    digits : int, optional
        Only numbers of so many significant digits are drawn.
    values : tuple, optional
        Numbers, words or truth values, equally likely.
    also : tuple of str
        Pointers to other numbers of the request that are given the same value, such as the second moment of a symmetric
        body.
    """

    min: End | None = None
    max: End | None = None
    distribution: Literal["uniform", "log-uniform"] = "uniform"
    step: Step | None = None
    digits: Digits | None = None
    values: tuple[Annotated[Any, Scalar()], ...] | None = None
    also: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check(self)
        if len(self.also) > MOST_TOGETHER:
            raise InvalidParameter("also", f"have at most {MOST_TOGETHER} pointers")
        if self.values is not None:
            self._check_values(self.values)
        elif self.min is None or self.max is None:
            remedy = "give min and max, or values"
            raise InvalidParameter("max" if self.min is not None else "min", "be given", remedy=remedy)
        else:
            self._check_range(self.min, self.max)

    def _check_values(self, values: tuple[Any, ...]) -> None:
        for name in ("min", "max", "step", "digits"):
            if getattr(self, name) is not None:
                raise InvalidParameter(name, "be left out beside values")
        if not 2 <= len(values) <= MOST_VALUES:
            raise InvalidParameter("values", f"have 2 to {MOST_VALUES} entries")
        for i, value in enumerate(values):
            if not isinstance(value, (bool, int, float, str)):
                raise InvalidParameter(("values", i), "be a number, a string, true or false")
            if isinstance(value, str) and len(value) > LONGEST_WORD:
                raise InvalidParameter(("values", i), f"have at most {LONGEST_WORD} characters")
            if isinstance(value, (int, float)) and not _is_double(value):
                raise InvalidParameter(("values", i), "be finite")

    def _check_range(self, low: float, high: float) -> None:
        if not low < high:
            raise InvalidParameter("max", "be greater than min")
        if self.distribution == "log-uniform" and low <= 0.0:
            raise InvalidParameter("min", "be greater than 0 where the distribution is log-uniform")
        if self.step is not None:
            if self.digits is not None:
                raise InvalidParameter("digits", "be left out beside step")
            if not 1 <= self._steps <= MOST_STEPS:
                raise InvalidParameter("step", f"fit into the range 1 to {MOST_STEPS:.0e} times")
        if self.digits is not None and not low <= self._of_few_digits(low, self.digits) <= high:
            raise InvalidParameter("digits", "leave a number in the range", remedy="allow more digits")

    def draw(self, chance: float) -> Any:
        """Return the value that belongs to a number drawn uniformly from 0 (included) to 1 (excluded)."""
        if self.values is not None:
            return self.values[int(chance * len(self.values))]
        assert self.min is not None
        assert self.max is not None
        if self.step is not None and self.distribution == "uniform":
            return self._on_grid(int(chance * (self._steps + 1)))
        if self.distribution == "uniform":
            # The width of the range may exceed the largest double.
            drawn = self.min * (1.0 - chance) + self.max * chance
        else:
            drawn = exp(log(self.min) * (1.0 - chance) + log(self.max) * chance)
        if self.step is not None:
            return self._on_grid(min(self._steps, round((drawn - self.min) / self.step)))
        # Rounding may leave the range by an ulp.
        drawn = min(self.max, max(self.min, drawn))
        return drawn if self.digits is None else self._of_few_digits(drawn, self.digits)

    @property
    def _steps(self) -> int:
        assert self.min is not None
        assert self.max is not None
        assert self.step is not None
        count = (_decimal(self.max) - _decimal(self.min)) / _decimal(self.step)
        return int(count) if count <= 10 * MOST_STEPS else 10 * MOST_STEPS

    def _on_grid(self, k: int) -> float:
        assert self.min is not None
        assert self.step is not None
        # In decimals, as they are written: 0.1 and three steps of 0.1 are 0.4.
        return float(_decimal(self.min) + k * _decimal(self.step))

    def _of_few_digits(self, number: float, digits: int) -> float:
        """Return the nearest number of so many significant digits in the range, or next to it if there is none."""
        assert self.min is not None
        assert self.max is not None
        near = rounded(number, digits, ROUND_HALF_EVEN)
        if near > self.max:
            return rounded(number, digits, ROUND_FLOOR)
        return rounded(number, digits, ROUND_CEILING) if near < self.min else near


def rounded(number: float, digits: int, rounding: str = ROUND_HALF_EVEN) -> float:
    """Return a number with so many significant digits."""
    exact = _decimal(number)
    return float(exact.quantize(Decimal(1).scaleb(exact.adjusted() - digits + 1), rounding=rounding)) if exact else 0.0


def _decimal(number: float) -> Decimal:
    """Return a double as the shortest decimal that reads back as it."""
    return Decimal(repr(float(number)))


def _is_double(number: float) -> bool:
    try:
        return isfinite(float(number))
    except OverflowError:
        return False
