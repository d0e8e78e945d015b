"""Figures are found by their pointers, and have the form that their field and shape say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest

from core.assessment.figures import equal_moments, figures_within, form_of, is_null, names_of, steps_of, value_at
from core.errors import InvalidParameter, Path


class Row(NamedTuple):
    kind: str
    rate: float | None


@dataclass
class Held:
    error: float
    _secret: float = 1.0


ANSWER: dict[str, Any] = {
    "rows": [Row("saddle", 2.0), Row("center", None)],
    "held": Held(0.5),
    "a/b": {"~": 3},
    "vector": (1.0, 2, np.float64(3.0)),
    "mixed": [1.0, None],
    "infinite": [1.0, float("inf")],
    "none": None,
}


@pytest.mark.parametrize(
    ("pointer", "value"),
    [
        ("/rows/0/rate", 2.0),
        ("/rows/0/kind", "saddle"),
        ("/rows/1/rate", None),
        ("/held/error", 0.5),
        ("/held/_secret", None),
        ("/held/__class__", None),
        ("/a~1b/~0", 3.0),
        ("/vector/2", 3.0),
        ("/vector/3", None),
        ("/mixed", None),
        ("/infinite", None),
        ("/held", None),
        ("/rows/0/0", None),
        ("/vector/02", None),
        ("/vector/\u0662", None),
    ],
)
def test_values_are_found_by_pointer(pointer: str, value: Any) -> None:
    assert value_at(ANSWER, steps_of(pointer)) == value


def test_arrays_are_found_as_doubles() -> None:
    found = value_at(ANSWER, ("vector",))
    assert found.dtype == np.float64
    assert found.tolist() == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("pointer", "null"),
    [
        ("/none", True), ("/rows/1/rate", True), ("/mixed/1", True),
        ("/rows/0/rate", False), ("/absent", False), ("/rows/7", False),
    ],
)  # fmt: skip
def test_null_is_told_from_nothing(pointer: str, null: bool) -> None:
    assert is_null(ANSWER, steps_of(pointer)) is null


@pytest.mark.parametrize("pointer", ["", "period", "#/period"])
def test_what_is_no_pointer_is_refused(pointer: str) -> None:
    with pytest.raises(InvalidParameter):
        steps_of(pointer)


@pytest.mark.parametrize(
    ("path", "value", "unit", "form"),
    [
        (("period",), 1.0, "s", "number"),
        (("tilt",), 1.0, "rad", "angle"),
        (("stable",), True, "1", "choice"),
        (("kind",), "saddle", "1", "choice"),
        (("axis",), np.zeros(3), "1", "direction"),
        (("principal", "axes"), np.zeros((3, 3)), "1", "axes"),
        (("attitude", 2), np.zeros(4), "1", "attitude"),
        (("attitude",), np.zeros((9, 4)), "1", "samples"),
        (("angular_velocity",), np.zeros((9, 3)), "rad s^-1", "samples"),
        (("angular_velocity", 2), np.zeros(3), "rad s^-1", "vector"),
        (("equilibria", 1, "eigenvalues"), np.zeros((3, 2)), "s^-1", "set"),
        (("inertia", "about_origin"), np.zeros((3, 3)), "kg m^2", "matrix"),
    ],
)
def test_forms(path: tuple[str | int, ...], value: Any, unit: str, form: str) -> None:
    assert form_of(path, value, unit) == form


def test_names_of_parameters_and_groups_of_moments() -> None:
    assert names_of([("masses", 0), ("body", "radius")]) == {"masses_1": ("masses", 0), "radius": ("body", "radius")}
    assert equal_moments([1.0, 1.0 + 1e-12, 2.0]) == ((0, 1), (2,))
    assert equal_moments([1.0, 1.5, 2.0]) == ((0,), (1,), (2,))
    assert equal_moments(None) == ()


def test_numbers_that_share_a_name_have_the_fields_around_them() -> None:
    paths: list[Path] = [
        ("gravity", 1),
        ("bodies", "one", "mass"),
        ("bodies", "two", "mass"),
        ("bodies", "1.a", "mass"),
        ("bodies", "one", "radius"),
        ("connections", 0, "on", "at", 1),
        ("bodies", "one", "at", 1),
        ("bodies", "two", "at", 1),
    ]
    assert names_of(paths) == dict(
        zip(
            ["gravity_2", "one_mass", "two_mass", "bodies_1_a_mass", "radius", "at_1_2", "one_at_2", "two_at_2"],
            paths,
            strict=True,
        )
    )


def test_the_figures_within_of_an_object() -> None:
    assert figures_within(ANSWER, ("rows", 0)) == ["kind", "rate"]
    assert figures_within(ANSWER, ("rows", 1)) == ["kind", "rate"]
    assert figures_within(ANSWER, ("held",)) == ["error"]
    assert figures_within(ANSWER, ("a/b",)) == ["~"]
    for path in (("rows",), ("vector",), ("held", "error"), ("nothing", "deeper"), ("rows", 7)):
        assert figures_within(ANSWER, path) == []
