"""Measured columns as complete rows."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.fits.observations import Measured

COLUMNS: dict[str, Any] = {"t": [0.0, 1.0, 2.0, 3.0], "x": [1.0, None, 3.0, 4.0], "s": [0.1, 0.2, None, 0.4]}


def measured(**changes: Any) -> Measured:
    given: dict[str, Any] = {
        "columns": COLUMNS,
        "times": "t",
        "figures": ("x",),
        "standard_deviations": {},
        "units": {},
    }
    return Measured(**given | changes)


def test_rows_with_a_missing_number_are_left_out() -> None:
    plain = measured().observations()
    assert plain.left_out == [1]
    assert plain.times is not None
    assert plain.times.tolist() == [0.0, 2.0, 3.0]
    assert plain.values[:, 0].tolist() == [1.0, 3.0, 4.0]
    assert plain.deviations is None
    by_row = measured(standard_deviations={"x": "s"}).observations()
    assert by_row.left_out == [1, 2]
    assert by_row.deviations is not None
    assert by_row.deviations[:, 0].tolist() == [0.1, 0.4]


def test_units_of_times_and_figures() -> None:
    found = measured(units={"t": "ms", "x": "cm"}, standard_deviations={"x": 2.0})
    rows = found.observations()
    assert rows.times is not None
    assert rows.times == pytest.approx(np.array([0.0, 0.002, 0.003]))
    metres = rows.times_factors([found.factor("x", "m")])
    assert metres.values[:, 0] == pytest.approx(np.array([0.01, 0.03, 0.04]))
    assert metres.deviations == pytest.approx(np.full((3, 1), 0.02))


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"columns": COLUMNS | {"x": [1.0, nan, 3.0, 4.0]}}, ("columns", "x", 1)),
        ({"columns": COLUMNS | {"x": np.array([1.0, 2.0, 3.0, inf])}}, ("columns", "x", 3)),
        ({"columns": COLUMNS | {"x": [1.0]}}, ("columns", "x")),
        ({"columns": {"t": [], "x": []}}, ("columns",)),
        ({"columns": {f"c{k}": [1.0] for k in range(41)}}, ("columns",)),
        ({"figures": ()}, ("figures",)),
        ({"figures": ("y",)}, ("figures", "y")),
        ({"figures": ("x", "s")}, ("standard_deviations",)),
        ({"figures": ("x", "s"), "standard_deviations": {"x": 1.0}}, ("standard_deviations", "s")),
        ({"times": "T"}, ("times",)),
        ({"standard_deviations": {"t": 1.0}}, ("standard_deviations", "t")),
        ({"standard_deviations": {"x": 0.0}}, ("standard_deviations", "x")),
        ({"standard_deviations": {"x": [1.0, 1.0, -1.0, 1.0]}}, ("standard_deviations", "x", 2)),
        ({"standard_deviations": {"x": [1.0]}}, ("standard_deviations", "x")),
        ({"standard_deviations": {"x": "q"}}, ("standard_deviations", "x")),
        ({"units": {"q": "m"}}, ("units", "q")),
        ({"units": {"t": "kg"}}, ("units", "t")),
    ],
)
def test_what_is_wrong_with_data_is_said_at_its_place(changes: dict[str, Any], path: tuple[Any, ...]) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        measured(**changes).observations()
    assert refusal.value.path == path
