"""In which unit a number of a description is written."""

from __future__ import annotations

import pytest

from core.errors import Path
from core.multibody.language.reading import scene_from
from core.multibody.language.written_units import unit_at, within_object

SCENE = scene_from(
    {
        "gravity": [0, -9.81],
        "let": {"a": {"degrees": 25}, "k": 2, "slope": 0.1, "two": 2, "d": {"value": 3, "unit": "cm"}},
        "bodies": {
            "bob": {
                "mass": 1,
                "at": {"polar": [1, {"degrees": 30}]},
                "velocity": [1, {"value": 7.2, "unit": "km/h"}],
                "places": {"tip": [0.1, 0]},
            }
        },
        "connections": [
            {"kind": "contact", "place": "bob", "on": {"at": ["two", 0], "slope": "-slope"}, "friction": 0.3},
            {"kind": "damper", "measure": "turn", "a": "bob", "coefficient": 2},
            {"kind": "damper", "a": "bob", "b": [0, 0], "coefficient": "two"},
        ],
    }
)


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        (("gravity", 1), "m/s^2"),
        (("let", "a", "degrees"), "deg"),
        (("let", "d", "value"), "cm"),
        (("let", "k"), None),
        (("let", "slope"), "rad"),
        # It is a length and a coefficient.
        (("let", "two"), None),
        (("bodies", "bob", "mass"), "kg"),
        (("bodies", "bob", "velocity", 0), "m/s"),
        (("bodies", "bob", "velocity", 1, "value"), "km/h"),
        (("bodies", "bob", "at", "polar", 0), "m"),
        (("bodies", "bob", "at", "polar", 1, "degrees"), "deg"),
        (("bodies", "bob", "places", "tip", 0), "m"),
        (("connections", 0, "friction"), "1"),
        (("connections", 0, "on", "slope"), "rad"),
        (("connections", 1, "coefficient"), "N m s"),
        (("connections", 2, "coefficient"), "N s/m"),
        (("connections", 7, "coefficient"), None),
        (("bodies", "nobody", "mass"), None),
        (("nothing",), None),
        (("",), None),
    ],
)
def test_the_unit_in_which_a_number_is_written(path: Path, unit: str | None) -> None:
    assert unit_at(SCENE, path) == unit


def test_where_the_number_stands_that_is_written_with_its_unit() -> None:
    assert within_object(SCENE, ("let", "a")) == ("let", "a", "degrees")
    assert within_object(SCENE, ("bodies", "bob", "velocity", 1)) == ("bodies", "bob", "velocity", 1, "value")
    for path in (("let", "k"), ("let", "a", "degrees"), ("bodies", "bob", "at"), ("nothing",)):
        assert within_object(SCENE, path) is None
