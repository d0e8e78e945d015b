"""What is to be found: numbers of the question, and what is not known of the instrument that measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from core.errors import InvalidParameter
from core.quantities import Quantity, check

LONGEST_POINTER = 300

Number = Annotated[float, Quantity("1")]
Deviation = Annotated[float, Quantity("1", above=0)]
Kind = Literal["offset", "scale", "time shift", "frame"]


@dataclass(frozen=True)
class Prior:
    """What is known of a number beforehand: a normal distribution, which counts as one measurement more.

    Attributes
    ----------
    value : float
    standard_deviation : float
    """

    value: Number
    standard_deviation: Deviation

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Unknown:
    """A number of the request that is to be found.

    Attributes
    ----------
    pointer : str
        JSON pointer into the request of the question.
    start : float, optional
        From which the search starts; by default the number that the request has, or the middle of `between`.
    between : tuple of float, optional
        Ends of the range in which it is looked for, from several starts.
    prior : Prior, optional
    """

    pointer: str
    start: Number | None = None
    between: tuple[Number, Number] | None = None
    prior: Prior | None = None

    def __post_init__(self) -> None:
        check(self)
        if not self.pointer.startswith("/") or len(self.pointer) > LONGEST_POINTER:
            raise InvalidParameter("pointer", "be a JSON pointer into the request", remedy='such as "/let/g"')
        if self.between is None:
            return
        low, high = self.between
        if not low < high:
            raise InvalidParameter("between", "have its smaller end first", remedy=f"write [{high:g}, {low:g}]")
        if self.start is not None and not low <= self.start <= high:
            raise InvalidParameter("start", "lie in between")


@dataclass(frozen=True)
class Nuisance:
    """Something that is not known of the instrument, and is found with the numbers.

    Attributes
    ----------
    kind : {"offset", "scale", "time shift", "frame"}
        A number that is added to what is computed; one that it is multiplied by; a time by which the clock of the data
        is behind that of the question; a turn of the axes (rad) in which two or three columns are measured.
    figure : str or tuple of str
        Columns that share it.
    """

    kind: Kind
    figure: str | tuple[str, ...]

    def __post_init__(self) -> None:
        if not self.columns or len(set(self.columns)) < len(self.columns):
            raise InvalidParameter("figure", "name columns, each once")
        if self.kind == "frame" and len(self.columns) not in (2, 3):
            raise InvalidParameter("figure", "name the two or three columns that are components along the axes")

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        return (self.figure,) if isinstance(self.figure, str) else tuple(self.figure)
