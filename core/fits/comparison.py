"""Whether further unknown numbers are worth having: two questions fitted to the same data.

Where one question contains the other, its further numbers lower chi-squared by as many degrees of freedom by chance
alone. They earn their place if chance lowers it so much in fewer than one in twenty cases.

References
----------
S. S. Wilks, "The large-sample distribution of the likelihood ratio", Annals of Mathematical Statistics 9 (1938) 60.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

from core.fits.fit import Fit
from core.fits.search import scipy_module

CHANCE = 0.05
"""Below which chance is no explanation."""
TWENTY_TIMES = 2.0 * log(1.0 / CHANCE)
"""Difference of chi-squared at which one question is twenty times as likely as another with as many unknowns."""


@dataclass(frozen=True)
class Comparison:
    """A question beside the one that was fitted first.

    Attributes
    ----------
    chi_squared : float
    degrees_of_freedom : int
    earns : bool
        Whether the further unknown numbers, of whichever question has more, are worth having; of two with as many,
        whether the data prefer the compared one.
    why : str
    """

    chi_squared: float
    degrees_of_freedom: int
    earns: bool
    why: str


def compared(first: Fit, other: Fit) -> Comparison:
    """Return how a question compares with the one that was fitted first, to the same data."""
    special = scipy_module("special")
    one, two = first.statistics, other.statistics
    further = one.degrees_of_freedom - two.degrees_of_freedom
    larger, smaller = (two, one) if further > 0 else (one, two)
    # Where deviations are estimated, they are those that the larger question leaves.
    variance = larger.deviation**2
    gain = (smaller.chi_squared - larger.chi_squared) / variance if variance > 0.0 else 0.0
    known = first.data.deviations is not None
    if further == 0:
        gain = (one.chi_squared - two.chi_squared) / variance if variance > 0.0 else 0.0
        earns = gain > TWENTY_TIMES
        word = "lower" if gain > 0.0 else "higher"
        why = f"both have as many unknowns; chi-squared of the compared question is {word} by {abs(gain):.3g}"
        return Comparison(two.chi_squared, two.degrees_of_freedom, earns, why)
    count = abs(further)
    if known or larger.degrees_of_freedom < 1:
        chance = float(special.chdtrc(count, max(gain, 0.0)))
    else:
        chance = float(special.fdtrc(count, larger.degrees_of_freedom, max(gain, 0.0) / count))
    whose = "the compared question" if further > 0 else "the first question"
    numbers = "unknown" if count == 1 else "unknowns"
    why = (
        f"the {count} further {numbers} of {whose} lower{'s' if count == 1 else ''} chi-squared by {gain:.3g}, "
        f"which chance alone does with a probability of {chance:.2g}"
    )
    return Comparison(two.chi_squared, two.degrees_of_freedom, bool(chance < CHANCE), why)
