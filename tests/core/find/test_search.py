"""Inputs that are found, held against the functions whose inputs they are."""

from __future__ import annotations

from itertools import permutations
from math import acos, atan, copysign, cos, inf, log, pi, sin, sqrt
from typing import Any

import pytest

from core.errors import InvalidParameter, MechanicsError
from core.find.varied import Varied, can_vary
from core.sensitivities.figure import Count, Figure
from tests.core.find.toy_question import Function, search

PLACE = sqrt(2.0)


def within(found: Any, expected: list[float]) -> None:
    """Hold solutions against true values, in number and within their errors."""
    got = [(one.inputs[0], one.errors[0]) for one in found.solutions]
    assert len(got) == len(expected), got
    for (x, error), true in zip(got, expected, strict=True):
        assert abs(x - true) <= error, (x, error, true)


ROOTS: list[tuple[Function, tuple[float, float], float, list[float], float, int]] = [
    (cos, (0.0, 3.0), 0.3, [acos(0.3)], 1e-14, 1),
    (cos, (0.0, 10.0), 0.3, [acos(0.3), 2 * pi - acos(0.3), 2 * pi + acos(0.3)], 1e-14, 1),
    (lambda x: x, (0.0, 3.0), 0.0, [0.0], 1e-14, 1),
    (lambda x: x, (-3.0, 0.0), 0.0, [0.0], 1e-14, 1),
    (lambda x: atan(1e14 * (x - 1.234)), (0.0, 3.0), 0.0, [1.234], 1e-15, 1),
    (lambda x: (x - PLACE) ** 2 + 5.0, (0.0, 3.0), 5.0, [PLACE], 2e-7, 2),
    (lambda x: (x - PLACE) ** 3, (0.0, 3.0), 0.0, [PLACE], 1e-4, 3),
    (lambda x: (x - PLACE) ** 4, (0.0, 3.0), 0.0, [PLACE], 1e-3, 4),
    (lambda x: abs(x - 1.1), (0.0, 3.0), 0.0, [1.1], 1e-14, 2),
    (lambda x: abs(x - 1.1), (0.0, 3.0), 0.2, [0.9, 1.3], 1e-14, 1),
    (lambda x: (x - 1.3) ** 2 - 1e-8, (0.0, 3.0), 0.0, [1.2999, 1.3001], 1e-10, 1),
    (lambda x: sqrt(x - 1.0) if x >= 1.0 else None, (0.0, 3.0), sqrt(1e-5), [1.00001], 1e-14, 1),
    (lambda x: 1.0 / (x - 1.234) if x != 1.234 else None, (0.0, 3.0), 0.0, [], 0.0, 1),
    (lambda x: x - 1.234 if not 1.31 < x < 1.33 else None, (0.0, 3.0), 0.0, [1.234], 1e-14, 1),
    (lambda x: x - 1.234 if not 1.15 < x < 1.2 else None, (0.0, 3.0), 0.0, [1.234], 1e-14, 1),
]


@pytest.mark.parametrize(("function", "between", "value", "expected", "largest", "multiplicity"), ROOTS)
def test_roots_are_within_their_errors(
    function: Function,
    between: tuple[float, float],
    value: float,
    expected: list[float],
    largest: float,
    multiplicity: int,
) -> None:
    found, _ = search(function, between, "equals", value)
    within(found, expected)
    assert all(one.kind == "root" and one.multiplicity == multiplicity for one in found.solutions)
    assert all(one.errors[0] <= largest for one in found.solutions)
    assert (found.nearest is None) == bool(expected)


def test_a_simple_root_costs_at_most_twenty_questions() -> None:
    for function, value in (
        (cos, 0.3),
        (lambda x: x**3, 2.0),
        (lambda x: sqrt(1.0 + x), 1.7),
        (lambda x: 1 / (1 + x), 0.4),
    ):
        found, asked = search(function, (0.0, 3.0), "equals", value)
        assert len(found.solutions) == 1
        assert asked.count <= 20


def test_what_oscillates_between_evenly_spaced_places_is_seen() -> None:
    found, _ = search(lambda x: sin(20.0 * x), (0.01, 10.0), "equals", 0.3)
    first = [(k * pi + (-1) ** k * (pi / 2 - acos(0.3))) / 20.0 for k in range(64)]
    within(found, [x for x in first if 0.01 <= x <= 10.0])


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_ranges_over_all_magnitudes(scale: Any) -> None:
    found, _ = search(log, (1e-300, 1e300), "equals", log(1e150), scale="log")
    within(found, [1e150])
    found, asked = search(sqrt, (1e-300, 1e300), "equals", 1e140, scale="log")
    within(found, [1e280])
    assert asked.count < 60
    found, _ = search(lambda x: x - 1e-12, (1e-300, 3.0), "equals", 0.0, scale=scale)
    within(found, [1e-12])


def test_a_leap_past_the_value_is_a_jump() -> None:
    found, _ = search(lambda x: x + (1.0 if x > 1.23 else -1.0), (0.0, 3.0), "equals", 1.3)
    within(found, [1.23])
    (one,) = found.solutions
    assert one.kind == "jump"
    assert (one.below, one.above) == pytest.approx((0.23, 2.23))
    # However large it is beside what surrounds it.
    found, _ = search(
        lambda x: copysign(1e3, x - 1.23) if abs(x - 1.23) < 0.01 else copysign(1.0, x - 1.23),
        (0.0, 3.0),
        "equals",
        0.0,
    )
    within(found, [1.23])


@pytest.mark.parametrize(
    ("function", "value", "ends"),
    [
        (lambda x: 5.0, 5.0, (0.0, 3.0)),
        (lambda x: max(0.0, x - 1.1), 0.0, (0.0, 1.1)),
        (lambda x: float(int(x)), 1.0, (1.0, 2.0)),
    ],
)
def test_a_range_with_the_value_throughout_is_a_family(
    function: Function, value: float, ends: tuple[float, float]
) -> None:
    found, _ = search(function, (0.0, 3.0), "equals", value)
    (family,) = found.families
    assert (family.least[0], family.most[0]) == pytest.approx(ends, abs=1e-14)
    assert found.solutions == []


def test_the_nearest_miss_has_its_value() -> None:
    found, _ = search(lambda x: (x - 1.3) ** 2 + 2.0, (0.0, 3.0), "equals", 1.5)
    assert found.solutions == []
    assert found.nearest is not None
    assert found.nearest.inputs[0] == pytest.approx(1.3, abs=1e-6)
    assert found.nearest.figures == pytest.approx((2.0,))


@pytest.mark.parametrize(
    ("function", "wanted", "expected", "kinds"),
    [
        (lambda x: -((x - 1.3) ** 2), "largest", [1.3], ["extreme"]),
        (lambda x: -((x - 0.001) ** 2), "largest", [0.001], ["extreme"]),
        (lambda x: sin(3.0 * x), "largest", [pi / 6, pi / 6 + 2 * pi / 3], ["extreme", "extreme"]),
        (lambda x: sin(3.0 * x), "least", [0.0, pi / 2, 3.0], ["border", "extreme", "border"]),
        (lambda x: abs(x - 1.1), "least", [1.1], ["extreme"]),
        (lambda x: x, "largest", [3.0], ["border"]),
        (lambda x: x if x <= 1.23 else x - 3.0, "largest", [1.23, 3.0], ["jump", "border"]),
    ],
)
def test_extremes(function: Function, wanted: Any, expected: list[float], kinds: list[str]) -> None:
    found, _ = search(function, (0.0, 3.0), wanted)
    within(found, expected)
    assert [one.kind for one in found.solutions] == kinds
    assert all(one.errors[0] < 2e-7 for one in found.solutions)


def test_a_constant_has_no_extreme() -> None:
    found, _ = search(lambda x: 2.0, (0.0, 3.0), "largest")
    assert found.solutions == []
    assert [(one.least, one.most) for one in found.families] == [((0.0,), (3.0,))]


INFINITE: list[tuple[Function, bool]] = [
    (lambda x: -log(abs(x - PLACE)) if x != PLACE else None, True),
    (lambda x: 1.0 / (x - PLACE) if x != PLACE else None, True),
    (lambda x: (x - PLACE) ** -2 if x != PLACE else None, True),
    (lambda x: (PLACE - x) ** -1.5 if x < PLACE else None, True),
    (lambda x: -log(x - PLACE) if x > PLACE else None, True),
    (lambda x: sqrt(PLACE - x) if x < PLACE else None, False),
    (lambda x: 3.0 - sqrt(abs(x - PLACE)), False),
    (lambda x: 1.0 / (1e-3 + (x - 1.0) ** 2), False),
]


@pytest.mark.parametrize(("function", "infinite"), INFINITE)
def test_what_is_infinite_is_told_from_what_is_large(function: Function, infinite: bool) -> None:
    found, _ = search(function, (0.0, 3.0), "infinite")
    within(found, [PLACE] if infinite else [])
    assert all(one.errors[0] < 1e-14 for one in found.solutions)


@pytest.mark.parametrize(
    ("function", "expected", "sides"),
    [
        (lambda x: "a" if x < 1.1 else "b" if x < 2.2 else "c", [1.1, 2.2], [("a", "b"), ("b", "c")]),
        (lambda x: x < 1.1, [1.1], [(True, False)]),
        (lambda x: False if x < 1.1 else None, [1.1], [(False, None)]),
        (lambda x: sqrt(x - 1.0) if x >= 1.0 else None, [1.0], [(None, 0.0)]),
        (lambda x: sin(x) + (1e-3 if x > 1.23 else 0.0), [1.23], None),
        (lambda x: copysign(sqrt(abs(x - 1.23)), x - 1.23), [], None),
    ],
)
def test_changes(function: Function, expected: list[float], sides: Any) -> None:
    found, _ = search(function, (0.0, 3.0), "changes")
    within(found, expected)
    if sides is not None:
        assert [(one.below, one.above) for one in found.solutions] == sides


def test_words_and_counts_that_equal_something_have_ranges() -> None:
    found, _ = search(lambda x: x < 1.1, (0.0, 3.0), "equals", True)
    assert found.ranges == [(0.0, pytest.approx(1.1))]
    found, _ = search(lambda x: [0] * int(x), (0.0, 3.5), "equals", 2.0, figure=Count(("f0",)))
    within(found, [2.0, 3.0])
    assert found.ranges == [(pytest.approx(2.0), pytest.approx(3.0))]


def test_what_is_refused_widens_the_border_and_is_told() -> None:
    def function(x: float) -> bool:
        if 1.0 < x < 1.5:
            raise MechanicsError("no answer here")
        return x < 1.2

    found, _ = search(function, (0.0, 3.0), "changes")
    (one,) = found.solutions
    assert one.inputs[0] - one.errors[0] <= 1.0 < 1.5 <= one.inputs[0] + one.errors[0]
    assert [notice.code for notice in found.notices] == ["refused-in-range"]


def test_a_question_that_is_refused_throughout_is_refused() -> None:
    def function(x: float) -> float:
        raise MechanicsError(f"no answer at {x}")

    with pytest.raises(MechanicsError, match="no answer"):
        search(function, (0.0, 3.0), "changes")


def test_systems_of_two_and_three() -> None:
    found, _ = search(
        [lambda x, y: x * x + y * y, lambda x, y: x - y * y], [(0.0, 3.0), (-3.0, 3.0)], "equals", [2.0, 0.0]
    )
    assert [one.inputs for one in found.solutions] == [pytest.approx((1.0, -1.0)), pytest.approx((1.0, 1.0))]
    for one, true in zip(found.solutions, [(1.0, -1.0), (1.0, 1.0)], strict=True):
        assert all(abs(x - t) <= e <= 1e-14 for x, t, e in zip(one.inputs, true, one.errors, strict=True))
    # Vieta: the roots of a cubic in every order.
    found, _ = search(
        [lambda x, y, z: x + y + z, lambda x, y, z: x * y * z, lambda x, y, z: x * y + y * z + z * x],
        [(0.0, 3.3)] * 3,
        "equals",
        [6.0, 6.0, 11.0],
    )
    expected = sorted(permutations((1.0, 2.0, 3.0)))
    got = sorted(((one.inputs, one.errors) for one in found.solutions), key=lambda one: [round(x, 6) for x in one[0]])
    assert len(got) == len(expected)
    for (inputs, errors), true in zip(got, expected, strict=True):
        assert all(abs(x - t) <= e <= 1e-12 for x, t, e in zip(inputs, true, errors, strict=True))


def test_a_system_that_does_not_determine_its_inputs_says_in_which_direction() -> None:
    found, _ = search([lambda x, y: x + y, lambda x, y: 2 * x + 2 * y], [(0.0, 3.0)] * 2, "equals", [3.0, 6.0])
    (family,) = found.families
    assert family.direction == pytest.approx((1.0, -1.0))
    found, _ = search([lambda x, y: x + y, lambda x, y: x - y], [(0.0, 3.0)] * 2, "equals", [30.0, 1.2])
    assert (found.solutions, found.families) == ([], [])
    assert found.nearest is not None


@pytest.mark.parametrize(
    ("least", "most", "scale", "place"),
    [
        (1.0, 1.0, "linear", 1),
        (2.0, 1.0, "linear", 1),
        (0.0, 1.0, "log", 0),
        (-1e308, 1e308, "linear", 1),
        (float("nan"), 1.0, "linear", 0),
        (0.0, inf, "linear", 1),
    ],
)
def test_ranges_that_are_none_are_refused(least: float, most: float, scale: Any, place: int) -> None:
    with pytest.raises(InvalidParameter) as refused:
        Varied("/x", ("x",), least, most, scale)
    assert refused.value.path == ("between", place)


def test_figures_that_do_not_fit_are_refused() -> None:
    for value in ("word", True, "nan"):
        with pytest.raises(InvalidParameter, match="as the figure is one"):
            search(lambda x: x, (0.0, 3.0), "equals", value)
    with pytest.raises(InvalidParameter, match="number to be least"):
        search(lambda x: "word", (0.0, 3.0), "least")
    with pytest.raises(InvalidParameter, match="lead to a number, a word or a truth value"):
        search(lambda x: [1.0, x], (0.0, 3.0), "equals", 1.0)
    asked: list[float] = []

    def places(x: float) -> dict[str, float]:
        asked.append(x)
        return {"bob": x}

    with pytest.raises(InvalidParameter, match="lead to a number, a word or a truth value"):
        search(places, (0.0, 3.0), "equals", 1.0, figure=Figure(("f0", "bobb")))
    # A wrong name is one in every answer.
    assert len({*asked}) == 1
    with pytest.raises(InvalidParameter, match="which number"):
        search([lambda x, y: x, lambda x, y: y], [(0.0, 3.0)] * 2, "least")


@pytest.mark.parametrize(
    ("present", "yes"),
    [
        (1, True),
        (2.5, True),
        ("0.1", True),
        ("2*h", True),
        ("2*k", False),
        ("a word", False),
        (True, False),
        ([1], False),
    ],
)
def test_numbers_and_formulas_can_vary(present: object, yes: bool) -> None:
    assert can_vary(present, ["h"]) is yes
