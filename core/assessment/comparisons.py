"""How near a submitted answer must come to the reference: comparisons, and the tolerances that they amount to.

The names relabs, sigfig and decdig, and the half-width of 0.51 units of the last digit, are those of PrairieLearn
(``prairielearn.grading_utils``). Unlike there, an absolute tolerance that is left out is a share of the quantity's
characteristic scale: an absolute 1e-8 accepts 0 for a true moment of 1e-9 kg m^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from math import inf
from typing import Annotated, Literal

from core.errors import InvalidParameter
from core.quantities import Quantity, TaggedBy, check

HALF_WIDTH = 0.51
"""Of the last digit that is compared: half a digit, and the rounding of a number written in binary."""

SMALL = 1e-8
"""Share of the characteristic scale that is the absolute tolerance if none is given."""

Digits = Annotated[int, Quantity("1", at_least=1, at_most=15)]
# A double has no more digits than these before its point; places far above the reference would accept any number.
Places = Annotated[int, Quantity("1", at_least=-15, at_most=300)]
Share = Annotated[float, Quantity("1", at_least=0, below=1)]
Width = Annotated[float, Quantity("1", at_least=0)]
End = Annotated[float, Quantity("1")]
Multiple = Annotated[float, Quantity("1", above=0, at_most=1000)]


@dataclass(frozen=True)
class RelAbs:
    """An error of at most `rtol` times the largest magnitude of the reference, plus `atol`.

    Attributes
    ----------
    rtol : float
        Relative tolerance.
    atol : float, optional
        Absolute tolerance, in the unit of the reference; by default 1e-8 of the quantity's characteristic scale.
    """

    rtol: Share = 1e-2
    atol: Width | None = None
    kind: Literal["relabs"] = "relabs"

    def __post_init__(self) -> None:
        check(self)

    def tolerance(self, magnitude: float, scale: float, known: float) -> float:
        """Return the largest error that is accepted."""
        return self.rtol * magnitude + (SMALL * scale if self.atol is None else self.atol)


@dataclass(frozen=True)
class SigFig:
    """Agreement in so many significant figures of the reference, of an array those of its largest entry.

    Attributes
    ----------
    digits : int
        Significant figures.
    """

    digits: Digits = 3
    kind: Literal["sigfig"] = "sigfig"

    def __post_init__(self) -> None:
        check(self)

    def tolerance(self, magnitude: float, scale: float, known: float) -> float:
        """Return the largest error that is accepted; the figures of a reference of zero are those of its scale."""
        size = magnitude or scale
        # The logarithm of what is just below a power of ten rounds up to it.
        return HALF_WIDTH * 10.0 ** (Decimal(size).adjusted() - self.digits + 1) if size > 0.0 else 0.0


@dataclass(frozen=True)
class DecDig:
    """Agreement in so many decimal places, in the unit of the reference.

    Attributes
    ----------
    digits : int
        Places after the decimal point; negative ones are before it.
    """

    digits: Places = 2
    kind: Literal["decdig"] = "decdig"

    def __post_init__(self) -> None:
        check(self)

    def tolerance(self, magnitude: float, scale: float, known: float) -> float:
        """Return the largest error that is accepted."""
        return HALF_WIDTH * 10.0**-self.digits


@dataclass(frozen=True)
class Interval:
    """A number between two limits, whatever the reference is.

    Attributes
    ----------
    lower : float
        Least number that is accepted, in the unit of the reference.
    upper : float
        Largest number that is accepted, in the unit of the reference.
    """

    lower: End
    upper: End
    kind: Literal["interval"] = "interval"

    def __post_init__(self) -> None:
        check(self)
        if self.lower > self.upper:
            raise InvalidParameter("upper", "be at least lower")

    def tolerance(self, magnitude: float, scale: float, known: float) -> float:
        """Return infinity: the limits decide, and no distance from the reference."""
        return inf


@dataclass(frozen=True)
class Data:
    """An error of at most what the uncertainty of the question's own data may cause.

    Attributes
    ----------
    factor : float
        Multiple of the propagated uncertainty that is accepted.
    """

    factor: Multiple = 1.0
    kind: Literal["data"] = "data"

    def __post_init__(self) -> None:
        check(self)

    def tolerance(self, magnitude: float, scale: float, known: float) -> float:
        """Return the largest error that is accepted."""
        return self.factor * known


Comparison = Annotated[RelAbs | SigFig | DecDig | Interval | Data, TaggedBy("kind")]
