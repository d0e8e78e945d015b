"""Evaluation with increasing precision, until the enclosures determine every requested digit."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

from flint import ctx

from core.balls import Undetermined, precision
from core.digits.decimals import FEWEST_DIGITS, MOST_DIGITS
from core.errors import BudgetExceeded, InvalidParameter
from core.work import spend

MOST_BITS = 2**16
"""Largest working precision of one question: twenty times that of a thousand digits."""

MOST_PRINTED = 3_000_000
"""Largest number of digits that one question may print."""

GUARD_BITS = 48

Answer = TypeVar("Answer")


def check_digits(digits: object, numbers: int = 1) -> int:
    """Return the number of significant digits, checked for so many numbers.

    Raises
    ------
    InvalidParameter
        If it is not an integer from 16 to 1000.
    BudgetExceeded
        If the question would print more digits than allowed.
    """
    if isinstance(digits, bool) or not isinstance(digits, int) or not FEWEST_DIGITS <= digits <= MOST_DIGITS:
        raise InvalidParameter(
            "digits",
            f"be an integer from {FEWEST_DIGITS} to {MOST_DIGITS}",
            remedy="leave it out for an answer in double precision",
        )
    if digits * numbers > MOST_PRINTED:
        raise BudgetExceeded(
            "printed digits", digits * numbers, MOST_PRINTED, path=("digits",), remedy="ask for fewer times or digits"
        )
    return digits


def bits_for(digits: int, magnitude: int = 0) -> int:
    """Return the first working precision: the digits, guard bits, and the bits of the integer part of the phase."""
    return math.ceil(digits * math.log2(10)) + GUARD_BITS + max(0, magnitude)


def until_determined(evaluate: Callable[[], Answer], bits: int) -> Answer:
    """Evaluate with `bits` of working precision, then with half as many more each time, until all is determined.

    A decision or a digit that a precision does not determine raises `Undetermined`. For inputs that are doubles or
    decimal strings of bounded length everything is determined well below the limit, unless the question has no answer
    of this form.

    Raises
    ------
    BudgetExceeded
        If more than 2^16 bits would be needed.
    """
    while bits <= MOST_BITS:
        spend(bits)
        with precision(bits):
            try:
                return evaluate()
            except Undetermined:
                bits += bits // 2
    raise _too_many(bits)


def each_determined(evaluators: Callable[[], Callable[[int], Answer]], count: int, bits: int) -> list[Answer]:
    """Evaluate `count` independent numbers, and again at twice the precision those that are not determined.

    Parameters
    ----------
    evaluators : callable
        Performs the set-up at the current precision, and returns the function of the index.
    """
    answers: list[Answer | None] = [None] * count
    waiting: Sequence[int] = range(count)
    while bits <= MOST_BITS:
        spend(bits + len(waiting) * bits / 16)
        with precision(bits):
            try:
                evaluate, doubtful = evaluators(), []
            except Undetermined:
                bits = 2 * bits
                continue
            for i in waiting:
                try:
                    answers[i] = evaluate(i)
                except Undetermined:
                    doubtful.append(i)
        if not doubtful:
            return answers  # type: ignore[return-value]
        waiting, bits = doubtful, 2 * bits
    raise _too_many(bits)


def working_bits() -> int:
    """Return the current precision."""
    return int(ctx.prec)


def _too_many(bits: int) -> BudgetExceeded:
    return BudgetExceeded(
        "bits of working precision", bits, MOST_BITS, path=("digits",), remedy="ask for fewer digits or earlier times"
    )
