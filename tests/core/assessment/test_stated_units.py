"""Units of figures, on an answer that states them in every way that there is."""

from __future__ import annotations

import pytest

from core.assessment.stated_units import BESIDE, OF_THAT_NAME, OF_THE_FIGURE, OF_THE_INPUT, unit_of
from core.errors import Path

ANSWER = {
    "extremes": [{"unit": "m", "largest": 2.0, "largest_time": 0.5, "errors": {"largest_time": 1e-9}}],
    "columns": {"bob.speed": {"unit": "m/s", "values": [[1.0, 2.0]]}},
    "places": {"positions": {"bob": [1.0, 2.0]}, "errors": {"positions": {"bob": 1e-9}}},
    "values": {"/length": 1.0, "/turn": 2.0},
    "ranges": [[0.0, 1.0]],
    "units": {"/length": "m", "/turn": "deg", "/let/k": None},
    "figures": [1.0, 2.0],
    "figure": 1.0,
    "figure_units": ["N", "J"],
    "unit_is_null": {"unit": None, "value": 1.0},
}
DECLARED = {
    "largest": BESIDE,
    "largest_time": "s",
    "values": BESIDE,
    "positions": "m",
    "/length": OF_THE_INPUT,
    "/turn": OF_THE_INPUT,
    "/let/k": OF_THE_INPUT,
    "ranges": OF_THE_INPUT,
    "figures": OF_THE_FIGURE,
    "figure": OF_THE_FIGURE,
    "value": BESIDE,
}


def declared(path: Path) -> str | None:
    if "errors" in path:
        return "s" if path[-1] == "largest_time" else OF_THAT_NAME
    return next((DECLARED[step] for step in reversed(path) if isinstance(step, str) and step in DECLARED), None)


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        (("extremes", 0, "largest"), "m"),
        # What is declared counts, whatever unit stands beside it.
        (("extremes", 0, "largest_time"), "s"),
        (("extremes", 0, "errors", "largest_time"), "s"),
        (("columns", "bob.speed", "values", 0, 1), "m/s"),
        (("places", "errors", "positions", "bob"), "m"),
        (("values", "/length"), "m"),
        (("values", "/turn"), "deg"),
        (("values", "/let/k"), "1"),
        (("figures", 1), "J"),
        (("figure",), "N"),
        (("unit_is_null", "value"), "1"),
        (("nothing",), "1"),
    ],
)
def test_a_figure_has_the_unit_that_is_declared_or_stated(path: Path, unit: str) -> None:
    assert unit_of(ANSWER, path, declared) == unit


def test_a_range_has_the_unit_of_the_only_input() -> None:
    assert unit_of(ANSWER | {"units": {"/turn": "deg"}}, ("ranges", 0, 1), declared) == "deg"
    assert unit_of(ANSWER, ("ranges", 0, 1), declared) == "1"
