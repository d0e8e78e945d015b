"""Precision is raised until the enclosures determine every digit that was asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

from flint import ctx

from core.balls import precision
from core.certified.decimals import FEWEST_DIGITS, MOST_DIGITS, Undetermined
from core.errors import BudgetExceeded, InvalidParameter
from core.work import spend

MOST_BITS = 2**16
"""Working precision that one question may need: twenty times that of a thousand digits."""

MOST_PRINTED = 3_000_000
"""Digits that one question may have printed."""

GUARD_BITS = 48

Answer = TypeVar("Answer")


def check_digits(digits: object, numbers: int = 1) -> int:
    """Return the number of significant digits asked for, of so many numbers.

    Raises
    ------
    InvalidParameter
        Unless it is an integer from 16 to 1000.
    BudgetExceeded
        If more digits would have to be printed than one question may have.
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
    """Return a first working precision: the digits, guard bits, and the bits before the point of the largest phase."""
    return math.ceil(digits * math.log2(10)) + GUARD_BITS + max(0, magnitude)


def until_determined(evaluate: Callable[[], Answer], bits: int) -> Answer:
    """Evaluate at `bits` of working precision, and at twice as many, and so on, until no digit is in doubt.

    A decision that cannot be taken at one precision, and a digit that it does not determine, both raise `Undetermined`.
    What depends on doubles or on decimal strings of bounded length is decided well before the limit, unless the
    question has no answer of this form.

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
                bits = 2 * bits
    raise _too_many(bits)


def each_determined(evaluators: Callable[[], Callable[[int], Answer]], count: int, bits: int) -> list[Answer]:
    """Evaluate `count` independent numbers, and again at twice the precision only those that are still in doubt.

    Parameters
    ----------
    evaluators : callable
        Sets up at the precision that holds when it is called, and returns the function of the index.
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
    """Return the precision that holds now."""
    return int(ctx.prec)


def _too_many(bits: int) -> BudgetExceeded:
    return BudgetExceeded(
        "bits of working precision", bits, MOST_BITS, path=("digits",), remedy="ask for fewer digits or earlier times"
    )
