"""Wrong values are matched by the comparison by which the right one is judged."""

from __future__ import annotations

import numpy as np

from core.assessment.compare import Reference
from core.assessment.comparisons import DecDig, Interval
from core.assessment.mistakes import Figure, Mistake, WrongValues

TWICE = Mistake("twice", "", lambda figure: [2.0 * figure.right])
ALSO_TWICE = Mistake("also-twice", "", lambda figure: [None, np.nan, 2.0 * figure.right])
THRICE = Mistake("thrice", "", lambda figure: [3.0 * figure.right])


def wrong_values(value: float | np.ndarray) -> WrongValues:
    form = "vector" if isinstance(value, np.ndarray) else "number"
    reference = Reference(value, form=form, scale=float(np.abs(value).max()))
    figure = Figure("rotation/precession", {}, ("period",), reference, lambda request: lambda path: None)
    return WrongValues(figure, (TWICE, ALSO_TWICE, THRICE))


def tags(found: tuple[Mistake, ...]) -> list[str]:
    return [mistake.tag for mistake in found]


def test_every_entry_with_the_value_is_named_in_the_order_of_the_catalogue() -> None:
    assert tags(wrong_values(1.0).matching(2.0, None)) == ["twice", "also-twice"]
    assert tags(wrong_values(1.0).matching(3.0, None)) == ["thrice"]
    assert tags(wrong_values(1.0).matching(2.5, None)) == []


def test_arrays_are_matched_as_they_are_compared() -> None:
    assert tags(wrong_values(np.array([1.0, 2.0])).matching(np.array([3.0, 6.01]), None)) == ["thrice"]
    assert tags(wrong_values(np.array([1.0, 2.0])).matching(np.array([3.0, 6.01, 1.0]), None)) == []


def test_the_comparison_decides_how_near_is_near() -> None:
    assert tags(wrong_values(1.0).matching(2.004, DecDig(2))) == ["twice", "also-twice"]
    assert tags(wrong_values(1.0).matching(2.004, DecDig(4))) == []
    # Limits are about the right value; the default stands in.
    assert tags(wrong_values(1.0).matching(2.004, Interval(0.9, 1.1))) == ["twice", "also-twice"]


def test_wrong_values_are_computed_once() -> None:
    calls = []
    counted = Mistake("counted", "", lambda figure: calls.append(1) or [5.0])
    reference = Reference(1.0)
    found = WrongValues(Figure("", {}, ("x",), reference, lambda request: lambda path: None), (counted,))
    for _ in range(3):
        found.matching(5.0, None)
    assert len(calls) == 1
