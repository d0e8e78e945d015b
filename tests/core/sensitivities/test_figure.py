"""Figures read off answers."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InvalidParameter
from core.sensitivities.figure import figure_of

ANSWER = {
    "period": 2.0,
    "events": [
        {"kind": "touch", "name": "floor", "time": 0.5},
        {"kind": "touch", "name": "wall", "time": 0.7},
        {"kind": "touch", "name": "floor", "time": 1.5},
    ],
}


@pytest.mark.parametrize(
    ("given", "value", "place"),
    [
        ("/period", 2.0, ("period",)),
        ("/events/1/time", 0.7, ("events", 1, "time")),
        ({"event": {"kind": "touch", "name": "floor", "nth": 2}}, 1.5, ("events", 2, "time")),
        ({"event": {"kind": "touch", "nth": 2}}, 0.7, ("events", 1, "time")),
        ({"event": {"kind": "touch"}}, 0.5, ("events", 0, "time")),
        ({"event": {"kind": "touch", "name": "floor", "nth": 3}}, None, None),
        ({"event": {"kind": "slip"}}, None, None),
        ({"count": "/events"}, 3.0, ("events",)),
        ({"count": "/period"}, None, None),
        ({"count": "/events/0"}, None, None),
        ("/energy", None, None),
    ],
)
def test_figures_of_an_answer(given: Any, value: float | None, place: tuple[Any, ...] | None) -> None:
    figure = figure_of(given, ())
    assert figure.value(ANSWER) == value
    assert figure.place(ANSWER) == place
    assert figure.words


def test_counts_do_not_change_by_little() -> None:
    assert not figure_of({"count": "/events"}, ()).continuous
    assert figure_of("/period", ()).continuous


@pytest.mark.parametrize(
    ("given", "path"),
    [
        ("period", ("of",)),
        ({"event": {"kind": 3}}, ("of", "event")),
        ({"event": {"kind": "touch", "nth": 0}}, ("of", "event", "nth")),
        ({"event": {"kind": "touch", "name": 1}}, ("of", "event", "name")),
        ({"count": 3}, ("of", "count")),
        ({"sum": "/a"}, ("of",)),
        ("/" + 300 * "a", ("of",)),
        (3, ("of",)),
    ],
)
def test_what_names_no_figure_is_refused(given: Any, path: tuple[str, ...]) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        figure_of(given, ("of",))
    assert refusal.value.path == path
