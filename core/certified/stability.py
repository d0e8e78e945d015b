"""Eigenvalues of small perturbations of a rotation about a principal axis, to any number of digits.

About axis i at the rate W, lambda^2 = W^2 (I_i - I_j)(I_k - I_i)/(I_j I_k), and lambda = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from flint import arb

from core.certified.decimals import Undetermined, decimal
from core.certified.exact_inertia import ExactInertia
from core.certified.exact_inputs import Number, enclosed, exact
from core.certified.exact_start import ExactStart
from core.certified.raising import bits_for, check_digits, determined

Kind = Literal["center", "saddle", "degenerate"]


@dataclass(frozen=True)
class CertifiedEquilibrium:
    """A rotation about one principal axis.

    Attributes
    ----------
    moment : str
        About this axis (kg m^2).
    kind : {"center", "saddle", "degenerate"}
        Decided exactly.
    rate : str
        The positive number of which +- (saddle) or +-i times (centre) are the eigenvalues beside 0; "0" where
        degenerate (1/s).
    """

    moment: str
    kind: Kind
    rate: str

    @property
    def growth_rate(self) -> str:
        """Exponential rate of a small disturbance (1/s)."""
        return self.rate if self.kind == "saddle" else "0"

    @property
    def eigenvalues(self) -> tuple[tuple[str, str], tuple[str, str], tuple[str, str]]:
        """Real and imaginary parts; a double zero beside the third where degenerate (1/s)."""
        zero = ("0", "0")
        if self.kind == "degenerate":
            return zero, zero, zero
        if self.kind == "saddle":
            return (self.rate, "0"), (f"-{self.rate}", "0"), zero
        return ("0", self.rate), ("0", f"-{self.rate}"), zero


def certified_stability(inertia: ExactInertia, rate: Number, digits: int) -> list[CertifiedEquilibrium]:
    """Return the equilibria about the three principal axes, in ascending order of moments.

    Raises
    ------
    InvalidParameter
        For a rate that is no number, or digits outside 16 to 1000.
    """
    check_digits(digits)
    spin = abs(exact(rate, "rate"))
    equal = inertia.equal_moments
    rational = inertia.rational_moments

    def kind(axis: int) -> Kind:
        if spin == 0 or equal == 3:
            return "degenerate"
        if equal == 2 and rational is not None:
            return "center" if rational.count(rational[axis]) == 1 else "degenerate"
        return "saddle" if axis == 1 else "center"

    def evaluate() -> list[CertifiedEquilibrium]:
        moments = _moments(inertia)
        found = []
        for axis in range(3):
            own, (first, second) = moments[axis], (moments[k] for k in range(3) if k != axis)
            if kind(axis) == "degenerate":
                found.append(CertifiedEquilibrium(decimal(own, digits), "degenerate", "0"))
                continue
            if rational is not None:
                i, (j, k) = rational[axis], (rational[n] for n in range(3) if n != axis)
                square = enclosed(abs((i - j) * (k - i) / (j * k)))
            else:
                square = abs((own - first) * (second - own) / (first * second))
            if not square > 0:
                raise Undetermined
            value = enclosed(spin) * square.sqrt()
            found.append(CertifiedEquilibrium(decimal(own, digits), kind(axis), decimal(value, digits)))
        return found

    return determined(evaluate, bits_for(digits))


def _moments(inertia: ExactInertia) -> tuple[arb, ...]:
    rational = inertia.rational_moments
    if rational is not None:
        return tuple(enclosed(x) for x in rational)
    zero = Fraction(0)
    return ExactStart(inertia, (zero, zero, zero)).principal_state().moments
