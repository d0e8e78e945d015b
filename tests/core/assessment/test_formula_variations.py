"""Numbers are varied one by one, and together where they have to agree."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from core.assessment.formula_variations import MOST_LOOKED_AT, VARIATIONS, Parameters, drawn, tied_numbers
from core.errors import Path

WEDGE = {"mass": 2.0, "slope": 30.0, "direction": -30.0, "also_thirty": 30.0}
PARAMETERS: Parameters = {name: ((name,), value, "1") for name, value in WEDGE.items()}


def slope_and_mass(request: Any) -> Callable[[Path], Any]:
    """Answer where the direction is that of the slope; what is also thirty has nothing to do with it."""
    agreed = request["slope"] == -request["direction"]
    return lambda path: request["mass"] * request["slope"] if agreed and path == ("force",) else None


def test_numbers_that_have_to_agree_are_found_by_changing_each_alone() -> None:
    assert tied_numbers(WEDGE, ("force",), slope_and_mass) == (("slope",), ("direction",))


def test_what_has_no_figure_at_all_is_looked_at_within_limits() -> None:
    assert len(tied_numbers({"values": [1.0] * 500}, ("force",), lambda request: lambda path: None)) == MOST_LOOKED_AT


@pytest.mark.parametrize("names", [("mass", "slope"), ("slope", "direction", "also_thirty"), ("direction",)])
def test_they_change_together_whether_they_are_named_or_not(names: tuple[str, ...]) -> None:
    chosen = {name: PARAMETERS[name] for name in names}
    first, *varied = drawn(WEDGE, chosen, (("slope",), ("direction",)), slope_and_mass)
    assert first[0] == {name: WEDGE[name] for name in names}
    assert first[1](("force",)) == 60.0
    assert len(varied) == 3 * VARIATIONS
    for values, find in varied:
        slope = values["slope"] if "slope" in values else -values["direction"]
        assert find(("force",)) == pytest.approx(values.get("mass", 2.0) * slope)
        assert 0.75 <= slope / 30.0 <= 1.25
    independent = [values for values, _ in varied[: 2 * VARIATIONS]]
    if "also_thirty" in names:
        assert all(one["also_thirty"] != one["slope"] for one in independent)


def test_alone_they_have_no_figure() -> None:
    assert {find(("force",)) for _, find in [*drawn(WEDGE, PARAMETERS, (), slope_and_mass)][1:]} == {None}
