"""What is searched along a motion: when a quantity takes a value, and how small and large it becomes.

A quantity is a column of the answer, or a component of one: ``rod.angle``, ``ball.position.z``, ``s.tension``,
``energy.kinetic``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from core.errors import InvalidParameter, NotApplicable, Path
from core.multibody.algebra.polynomials import Ball
from core.multibody.answer import Occurrence
from core.multibody.equations.packed import nearest
from core.multibody.language.numerals import Numerals
from core.multibody.language.written import Number
from core.near_names import did_you_mean
from core.notices import Notice
from core.systems.trajectory import Column

MOST_FOUND = 1000
"""Occurrences of one search that are answered at most."""


@dataclass(frozen=True)
class When:
    """A question: when does a quantity take a value, for the n-th time after the start, or every time?

    Attributes
    ----------
    quantity : str
    equals : number
        As it is written: a number of the description, which may use its names.
    nth : int or None
    """

    quantity: str
    equals: Number
    nth: int | None = None


@dataclass(frozen=True)
class ValueSearch:
    """The same, with the value as it is read.

    Attributes
    ----------
    quantity : str
    equals : float
        The double nearest to the value.
    nth : int or None
    value : ball
    written : number
        The value as it is written, of which the unit is compared with that of the quantity.
    """

    quantity: str
    equals: float
    nth: int | None
    value: Ball = field(compare=False)
    written: Number = field(compare=False)


@dataclass(frozen=True)
class ExtremesOf:
    """A question: how small and how large does a quantity become?"""

    quantity: str


def component(columns: dict[str, Column], quantity: str) -> Column | None:
    """Return the column of a quantity, or a component or the length of one; None if there is none."""
    if quantity in columns:
        return columns[quantity] if columns[quantity].values.ndim == 1 else None
    name, _, part = quantity.rpartition(".")
    column = columns.get(name)
    if column is None or column.values.ndim == 1:
        return None
    if part == "length":
        return Column(np.linalg.norm(column.values, axis=1), column.unit, column.error, column.how)
    order = _components(column)
    if len(part) != 1 or part not in order:
        return None
    return Column(column.values[:, order.index(part)], column.unit, column.error, column.how)


def _components(column: Column) -> str:
    """Return the names of a vector's components, a letter each."""
    return "wxyz" if column.values.shape[1] == 4 else "xyz"[: column.values.shape[1]]


def _quantities(columns: Mapping[str, Column]) -> Iterator[str]:
    """Yield every quantity of which the values can be searched for."""
    for name, column in columns.items():
        if column.values.ndim == 1:
            yield name
        else:
            yield from (f"{name}.{part}" for part in (*_components(column), "length"))


def require_in_range(quantity: str, *numbers: float) -> None:
    """Raise `NotApplicable` where a value, a time or an error is no double."""
    if not np.isfinite(numbers).all():
        remedy = "ask for a shorter time, or choose units in which the numbers are moderate"
        raise NotApplicable(
            f"what is found of {quantity} leaves the range of doubles", path=("outputs",), remedy=remedy
        )


def checked_extremes(search: ExtremesOf, index: int) -> ExtremesOf:
    """Return a question, or raise `InvalidParameter` if it names no quantity."""
    _require_name(search.quantity, ("outputs", index, "extremes"))
    return search


def value_search(search: When, index: int, numerals: Numerals) -> ValueSearch:
    """Return a question with its value as it is read, or raise `InvalidParameter` if it cannot be answered."""
    where: Path = ("outputs", index, "when")
    _require_name(search.quantity, (*where, "quantity"))
    value = numerals.number(search.equals, (*where, "equals"))
    nth = search.nth
    if nth is not None and (isinstance(nth, bool) or not isinstance(nth, int) or not 1 <= nth <= MOST_FOUND):
        raise InvalidParameter((*where, "nth"), f"be a whole number from 1 to {MOST_FOUND}")
    return ValueSearch(search.quantity, nearest(value), nth, value, search.equals)


def _require_name(quantity: object, path: Path) -> None:
    if not isinstance(quantity, str) or not quantity:
        raise InvalidParameter(path, "name a column of the trajectory, or a component of one")


def unknown(search: ValueSearch | ExtremesOf, index: int, columns: Mapping[str, Column]) -> InvalidParameter:
    """Return the fault of a quantity that is searched, and that the scene has not."""
    path = ("when", "quantity") if isinstance(search, ValueSearch) else ("extremes",)
    return unknown_quantity(search.quantity, ("outputs", index, *path), columns)


def unknown_quantity(quantity: str, path: Path, columns: Mapping[str, Column]) -> InvalidParameter:
    """Return the fault of a quantity that the scene has not."""
    near = did_you_mean(quantity, _quantities(columns))
    components = 'take a component of a vector by ".x", its length by ".length"'
    return InvalidParameter(
        path,
        f'name a quantity of the scene, unlike "{quantity[:80]}"; there are {", ".join([*columns][:40])}',
        remedy=f"{near} {components}" if near else components,
    )


def left_out(outputs: Sequence[object], occurrences: Sequence[Occurrence], end: float) -> Iterator[Notice]:
    """Yield a notice for every search that found less than is asked for, or as much as is listed at most.

    Parameters
    ----------
    outputs : sequence
        Of the question; the searches among them found the occurrences in their order.
    end : float
        Time until which they searched (s).
    """
    left = list(occurrences)
    for index, search in enumerate(outputs):
        if not isinstance(search, ValueSearch):
            continue
        own = of_search(search, left)
        if not own:
            times = "" if search.nth is None or search.nth == 1 else f" {search.nth} times"
            detail = (
                f"{search.quantity} does not take the value {search.equals:g}{times} after the start until {end:g} s"
            )
            yield Notice("value-not-taken", detail, ("outputs", index, "when"))
        elif len(own) == MOST_FOUND:
            last = f"for the {MOST_FOUND}th time at {own[-1].time:g} s"
            detail = (
                f"{search.quantity} takes the value {search.equals:g} {last}; what follows until {end:g} s is left out"
            )
            yield Notice("occurrences-left-out", detail, ("outputs", index, "when"))


def of_search(search: ValueSearch, found: list[Occurrence]) -> list[Occurrence]:
    """Take the occurrences of a search from what is left of those that several found, one after another."""
    own: list[Occurrence] = []
    while found and found[0].quantity == search.quantity and found[0].equals == search.equals:
        expected = len(own) + 1 if search.nth is None else search.nth
        if found[0].nth != expected or (search.nth is not None and own):
            break
        own.append(found.pop(0))
    return own
