"""Claims are read one by one, and what cannot be read is said with its place."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.assessment.claims import Claim
from core.errors import InvalidParameter


def test_what_can_be_claimed() -> None:
    assert Claim.read({"value": 2}).value == 2.0
    assert Claim.read({"value": None}).value is None
    assert Claim.read({"value": True}).value is True
    assert Claim.read({"value": "saddle"}).value == "saddle"
    assert Claim.read({"formula": "2*x", "unit": "s"}).formula == "2*x"
    samples = Claim.read({"value": [[1, 2], [3, 4.5]], "times": [0, 1], "unit": "m"})
    assert samples.value.tolist() == [[1.0, 2.0], [3.0, 4.5]]
    assert samples.times is not None
    assert samples.times.dtype == np.float64


def test_arrays_of_numpy_are_as_good_as_lists() -> None:
    claim = Claim.read({"value": np.ones((2, 3), np.float32), "times": np.arange(2)})
    assert claim.value.dtype == np.float64
    assert claim.times is not None
    assert claim.times.tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    ("entry", "path"),
    [
        (3, ()),
        ({}, ("value",)),
        ({"value": 1, "units": "s"}, ("units",)),
        ({"value": 1, "x" * 50: "s"}, ()),
        ({"value": {}}, ("value",)),
        ({"value": 10**400}, ("value",)),
        ({"value": float("nan")}, ("value",)),
        ({"value": "x" * 201}, ("value",)),
        ({"value": []}, ("value",)),
        ({"value": [1, [2]]}, ("value", 1)),
        ({"value": [1, "2"]}, ("value", 1)),
        ({"value": [[1, 2], [3]]}, ("value", 1)),
        ({"value": [[1, 2], [3, True]]}, ("value", 1, 1)),
        ({"value": [10**400]}, ("value",)),
        ({"value": np.array([np.inf])}, ("value",)),
        ({"value": np.zeros((0, 3))}, ("value",)),
        ({"value": 1, "unit": 3}, ("unit",)),
        ({"value": [1, 2], "times": [[1, 2]]}, ("times",)),
        ({"value": [1, 2], "times": 3}, ("times",)),
        ({"value": [1, 2], "times": [1]}, ("value",)),
        ({"value": 1, "formula": "x"}, ("formula",)),
        ({"formula": "x" * 301}, ("formula",)),
        ({"formula": 3}, ("formula",)),
    ],
    ids=lambda entry: str(entry)[:40],
)
def test_what_cannot_be_read_has_a_place(entry: Any, path: tuple[str | int, ...]) -> None:
    with pytest.raises(InvalidParameter) as caught:
        Claim.read(entry)
    assert caught.value.path == path
