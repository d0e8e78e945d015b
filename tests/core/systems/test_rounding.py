"""Fewer digits: short numbers, and statements of error that still hold."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import Any

import numpy as np
import orjson
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.systems.rounding import Digits, rounded, shortened, to_places, to_significant
from core.systems.trajectory import Accuracy, Column, Trajectory, Work
from tests.drawn import draws
from tests.service.conftest import client_of, inline_service

SERVICE = inline_service()
FREE: dict[str, Any] = {
    "body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
    "angular_velocity": [0.3, 1.0, 0.2],
    "times": {"start": 0.0, "stop": 30.0, "count": 61},
}
ROD = {"hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81}

finite = st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=True)


def digits_of(value: float) -> int:
    """Return the significant digits with which a number is written."""
    digits = Decimal(orjson.dumps(value).decode()).as_tuple().digits
    return len("".join(map(str, digits)).strip("0")) or 1


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(st.lists(finite, min_size=1, max_size=8), st.integers(1, 17))
def test_significant_digits_are_those_of_decimal_rounding(values: list[float], digits: int) -> None:
    out = to_significant(np.array(values), digits) if digits < 17 else rounded(np.array(values), 17, 0.0)[0]
    for value, found in zip(values, out.tolist(), strict=True):
        assert digits_of(found) <= digits or (found == value and abs(value) > 1e308)
        if value == 0.0:
            assert found == 0.0
        elif 1e-300 < abs(value) < 1e300:
            # Ties and products that are themselves rounded may fall to either side, never further.
            unit = Decimal(10) ** (Decimal(value).adjusted() - digits + 1)
            assert abs(Decimal(found) - Decimal(value)) <= unit / 2 + Decimal(math.ulp(value))


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=12),
    st.integers(-280, 280),
    st.floats(1e-16, 1e-1),
)
def test_meaningful_digits_move_samples_by_no_more_than_is_stated(
    mantissas: list[float], size: int, error: float
) -> None:
    values = np.array(mantissas[: len(mantissas) // 3 * 3]).reshape(-1, 3) * 10.0**size
    scale = float(np.abs(values).max()) * 1.5
    out, added = rounded(values, "meaningful", error, scale)
    if scale > 0.0:
        moved = np.linalg.norm((out - values) / scale, axis=1).max()
        assert moved <= added * (1 + 1e-9)
        assert added <= 0.5 * np.sqrt(3) * error * (1 + 1e-9) + 2**-53


def test_digits_beyond_those_of_doubles_leave_the_samples_as_they_are() -> None:
    values = np.array([[0.1, 1.0 / 3.0, 12.345678901234567]])
    cases: tuple[tuple[Digits, float], ...] = (("meaningful", 1e-17), ("meaningful", 0.0), (17, 0.1))
    for digits, error in cases:
        out, added = rounded(values, digits, error)
        assert out is values
        assert added == 0.0


def test_places_left_of_the_point() -> None:
    assert to_places(np.array([123456.0, -987.0]), -3).tolist() == [123000.0, -1000.0]
    assert to_places(np.array([1.234e-250]), 252).tolist() == [1.23e-250]


def test_a_rounding_that_overtakes_the_accuracy_is_reported() -> None:
    stated = Accuracy(1e-9, 1e-12, "closed form")
    column = Column(np.array([1.0 / 3.0, 0.7]), "m", 1e-12, "closed form")
    whole = Trajectory(np.array([0.0, 1.0]), {"x": column}, stated, None, "closed-form", Work(2))
    short = shortened(whole, 3)
    assert [notice.code for notice in short.warnings] == ["rounded-beyond-accuracy"]
    assert short["x"].tolist() == [0.333, 0.7]
    assert short.accuracy.error >= 5e-3
    assert shortened(whole, 12).warnings == ()


def test_columns_are_rounded_to_the_places_of_their_own_errors() -> None:
    columns = {
        "far": Column(np.array([123.456789, 2.0]), "m", 1e-3, "closed form", scale=200.0),
        "near": Column(np.array([0.123456789, 0.0]), "m", 1e-6, "closed form", inherited=1e-5, scale=200.0),
        "nowhere": Column(np.zeros(2), "m", 0.0, "closed form"),
    }
    whole = Trajectory(np.zeros(2), columns, Accuracy(1e-3, 1e-3 / 200, "closed form"), None, "closed-form", Work(2))
    short = shortened(whole, "meaningful")
    assert short["far"].tolist() == [123.457, 2.0]
    assert short["near"].tolist() == [0.12346, 0.0]
    assert short["nowhere"] is columns["nowhere"].values
    assert short.accuracy.error == pytest.approx(1.5e-3 / 200)


async def asked(path: str, question: dict[str, Any]) -> Any:
    async with client_of(SERVICE) as client:
        return await client.post(path, json=question)


@pytest.mark.anyio
@pytest.mark.parametrize("digits", ["meaningful", 3, 9])
async def test_a_trajectory_with_fewer_digits_is_within_its_stated_error(digits: Any) -> None:
    question = FREE | {"input_uncertainty": 1e-6, "attitude": [1.0, 0.0, 0.0, 0.0]}
    full = await asked("/v1/rotation/trajectory", question)
    short = await asked("/v1/rotation/trajectory", question | {"round": digits})
    exact, answer = full.json(), short.json()
    rows, out = np.array(exact["angular_velocity"]), np.array(answer["angular_velocity"])
    error = np.linalg.norm(out - rows, axis=1).max() / np.linalg.norm(rows, axis=1).max()
    assert 0.0 < error <= answer["accuracy"]["error"]
    q, p = np.array(exact["attitude"]), np.array(answer["attitude"])
    assert 2.0 * np.linalg.norm(q - p, axis=1).max() <= answer["accuracy"]["attitude_error"]
    assert len(short.content) < 0.8 * len(full.content)
    assert exact["time"] == answer["time"]
    assert [entry["code"] for entry in answer["warnings"]] == ["rounded-beyond-accuracy"]


@pytest.mark.anyio
async def test_the_same_for_ensembles_and_scenes() -> None:
    many = {name: value for name, value in FREE.items() if name != "angular_velocity"}
    many |= {"angular_velocities": [[0.3, 1.0, 0.2], [1.0, 0.1, 0.1]]}
    answer = (await asked("/v1/rotation/ensemble", many | {"round": 4})).json()
    assert max(digits_of(x) for x in np.ravel(answer["angular_velocity"]).tolist()) == 4
    assert all(5e-4 <= member["accuracy"]["error"] < 5.1e-4 for member in answer["members"])
    scene = ROD | {"times": [0.0, 0.1, 0.7]}
    exact, answer = [(await asked("/v1/scenes/rod-in-hole", scene | more)).json() for more in ({}, {"round": 5})]
    for name, column in answer["trajectory"].items():
        if name != "time":
            assert max(digits_of(x) for x in np.ravel(column).tolist()) == 5
    angles = np.array([exact["trajectory"]["angle"], answer["trajectory"]["angle"]])
    assert np.abs(angles[0] - angles[1]).max() <= answer["accuracy"]["error"] * np.abs(angles[0]).max()


@pytest.mark.anyio
@pytest.mark.parametrize("digits", [0, 18, True, 2.0, "all", [3]])
async def test_other_digits_are_refused(digits: Any) -> None:
    response = await asked("/v1/rotation/trajectory", FREE | {"round": digits})
    assert response.status_code == 422
    assert response.json()["errors"][0]["pointer"] == "/round"


@pytest.mark.anyio
async def test_the_horizon_is_where_the_inherited_error_is_no_longer_known() -> None:
    question = FREE | {"input_uncertainty": 1e-3}
    horizon = (await asked("/v1/rotation/trajectory", question)).json()["accuracy"]["horizon"]
    for time, lost in ((0.99 * horizon, False), (1.01 * horizon, True)):
        answer = (await asked("/v1/rotation/trajectory", question | {"times": [time]})).json()
        assert (answer["accuracy"]["inherited"] is None) is lost
        assert ("phase-lost" in [warning["code"] for warning in answer["warnings"]]) is lost
    exact = FREE | {"input_uncertainty": 0.0}
    answer = (await asked("/v1/rotation/trajectory", exact)).json()["accuracy"]
    assert answer["horizon"] is None
    assert answer["inherited"] == 0.0
    assert (await asked("/v1/rotation/trajectory", FREE)).json()["accuracy"].get("horizon") is None


@pytest.mark.anyio
async def test_the_attitude_has_a_horizon_of_its_own() -> None:
    question = FREE | {"input_uncertainty": 1e-3, "attitude": [1.0, 0.0, 0.0, 0.0]}
    horizon = (await asked("/v1/rotation/trajectory", question)).json()["accuracy"]["attitude_horizon"]
    for time, lost in ((0.99 * horizon, False), (1.01 * horizon, True)):
        answer = (await asked("/v1/rotation/trajectory", question | {"times": [time]})).json()
        assert (answer["accuracy"]["attitude_inherited"] > 1.0) is lost
    without = (await asked("/v1/rotation/trajectory", FREE)).json()["accuracy"]
    assert without.get("attitude_inherited") is None


def test_the_largest_doubles_stay_as_they_are() -> None:
    largest = 1.7976931348623157e308
    found, _ = rounded(np.array([largest, 1.6e307]), "meaningful", 0.5)
    assert found.tolist() == [largest, 2e307]
