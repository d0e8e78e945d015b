"""Numbers found from data, over HTTP: the documented examples, and what is refused at which place."""

from __future__ import annotations

from copy import deepcopy
from typing import Any
from xml.etree import ElementTree

import httpx
import pytest

from service.routes.examples import examples
from tests.service.conftest import client_of, inline_service

SERVICE = inline_service()
FILM: Any = examples()["fit"]["film"].question
GYROSCOPE: Any = examples()["fit"]["gyroscope"].question

pytestmark = pytest.mark.anyio


async def sent(request: dict[str, Any], accept: str = "application/json") -> httpx.Response:
    async with client_of(SERVICE) as client:
        return await client.post("/v1/fits", json=request, headers={"accept": accept})


def changed(place: list[Any], value: Any) -> dict[str, Any]:
    """Return the request about the film with something else at a place."""
    request: Any = deepcopy(FILM)
    inner = request
    for step in place[:-1]:
        inner = inner[step]
    inner[place[-1]] = value
    return dict(request)


async def test_g_and_length_from_a_film() -> None:
    answer = (await sent(FILM)).json()
    # The places were made with these numbers, and rounded to a millimetre.
    for pointer, true in {"/let/g": 9.81, "/let/L": 0.83, "/let/a": 0.61}.items():
        found = answer["parameters"][pointer]
        assert abs(found["value"] - true) < 3.0 * found["standard_error"]
        low, high = found["interval"]
        assert low < found["value"] < high
    assert answer["left_out"] == [9]
    assert answer["residuals"]["y"][9] is None
    assert answer["units"] == {"x": "m", "y": "m"}
    assert answer["degrees_of_freedom"] == 30 - 3
    assert answer["probability"] > 0.01
    assert [row[k] for k, row in enumerate(answer["correlation"])] == [1.0, 1.0, 1.0]
    assert answer["not_determined"] == answer["outliers"] == answer["comparison"] == []
    assert answer["warnings"][0]["code"] == "rows-left-out"


async def test_only_ratios_of_moments_from_a_gyroscope() -> None:
    answer = (await sent(GYROSCOPE)).json()
    (lost,) = answer["not_determined"]
    assert set(lost["direction"]) == {f"/body/moments/{k}" for k in range(3)}
    assert answer["parameters"]["/body/moments/0"]["standard_error"] is None
    assert answer["covariance"][0] == [None] * 6
    speed = answer["parameters"]["/angular_velocity/1"]
    assert abs(speed["value"] - 4.1) < 3.0 * speed["standard_error"]


async def test_does_friction_earn_its_parameter() -> None:
    request = deepcopy(FILM)
    damped = deepcopy(request["question"])
    damped["request"]["let"]["c"] = 0.0
    damped["request"]["connections"].append({"kind": "force", "place": "bob", "force": ["-c*vx", "-c*vy"]})
    request["compare"] = [{"question": damped, "unknown": [*request["unknown"], {"pointer": "/let/c"}]}]
    (other,) = (await sent(request)).json()["comparison"]
    assert not other["earns"]
    assert "further unknown of the compared question" in other["why"]
    assert other["degrees_of_freedom"] == 26
    assert abs(other["parameters"]["/let/c"]["value"]) < 3.0 * other["parameters"]["/let/c"]["standard_error"]


async def test_residuals_are_drawn() -> None:
    response = await sent(FILM, "image/svg+xml")
    drawing = ElementTree.fromstring(response.text)
    # 31 of 32 numbers, one of whose rows is left out.
    assert len(drawing.findall(".//{*}circle")) == 30
    assert "x: data minus figure (m)" in response.text


@pytest.mark.parametrize(
    ("place", "value", "pointer", "detail"),
    [
        (["unknown", 0, "pointer"], "/let/l", "/unknown/0/pointer", "number of the request"),
        (["unknown", 0, "pointer"], "L", "/unknown/0/pointer", "JSON pointer"),
        (["unknown", 0, "between"], [2.0, 1.0], "/unknown/0/between", "smaller end first"),
        (["unknown", 0, "start"], "1", "/unknown/0/start", "number"),
        (["unknown", 0, "prior"], {"value": 1.0, "standard_deviation": 0.0}, "/unknown/0/prior/standard_deviation",
         "greater than 0"),
        (["unknown"], [], "/unknown", "not be empty"),
        (["data", "columns", "x", 3], "1", "/data/columns/x/3", "number"),
        (["data", "columns", "x"], [1.0], "/data/columns/x", "as many rows"),
        (["data", "figures", "x"], "bob.positon.x", "/data/figures/x", "figure of the answer"),
        (["data", "figures", "x"], "bob.position", "/data/figures/x", "one number for each row"),
        (["data", "units", "x"], "kg", "/data/units/x", "same kind"),
        (["data", "times"], "T", "/data/times", "column of the data"),
        (["question", "path"], "/v1/scene", "/question/path", "fitted to data"),
        (["question", "request", "gravty"], 1, "/question/request/gravty", "not known"),
        (["question", "request", "gravity"], [0, "-q"], "/question/request/gravity/1", "known names"),
        (["nuisance"], [{"kind": "offset", "figure": "q"}], "/nuisance/0/figure", "column of figures"),
        (["nuisance"], [{"kind": "frame", "figure": "x"}], "/nuisance/0/figure", "two or three"),
        (["nuisance"], [{"kind": "tilt", "figure": "x"}], "/nuisance/0/kind", "must be"),
        (["robust"], {"loss": "tukey"}, "/robust/loss", "must be"),
        (["compare"], [{"question": {"path": "/v1/x", "request": {}}, "unknown": [{"pointer": "/a"}]}],
         "/compare/0/question/path", "fitted"),
    ],
)  # fmt: skip
async def test_what_is_wrong_is_said_at_its_place(place: list[Any], value: Any, pointer: str, detail: str) -> None:
    response = await sent(changed(place, value))
    assert response.status_code == 422
    fault = response.json()["errors"][0]
    assert fault["pointer"] == pointer
    assert detail in fault["detail"]


async def test_what_is_unknown_may_have_any_value_in_the_question() -> None:
    request = deepcopy(FILM)
    request["question"]["request"]["let"]["L"] = -1e308
    request["unknown"][1]["start"] = 1.0
    answer = (await sent(request)).json()
    assert answer["parameters"] == (await sent(FILM)).json()["parameters"]


async def test_files_of_columns_belong_to_fits_alone() -> None:
    async with client_of(SERVICE) as client:
        response = await client.post("/v1/scenes", files={"request": b"{}", "columns": b"t"})
    assert response.status_code == 415
    assert "application/json, or application/x-npz" in response.json()["detail"]


async def test_numbers_that_are_none_and_too_few_of_them() -> None:
    body = b'{"question": {"path": "/v1/scenes", "request": {"bodies": {"a": {"mass": 1, "at": [0, 0]}}}}, "unknown": '
    body += b'[{"pointer": "/bodies/a/at/0"}], "data": {"columns": {"t": [1, 2], "x": [1, 1e999]}, "times": "t", '
    body += b'"figures": {"x": "a.position.x"}}}'
    async with client_of(SERVICE) as client:
        response = await client.post("/v1/fits", content=body, headers={"content-type": "application/json"})
    assert response.json()["errors"][0]["pointer"] == "/data/columns/x/1"
    few = changed(["data", "columns"], {"t": [0.1], "x": [50.0], "y": [-70.0]})
    few["data"]["standard_deviations"] = {"x": 0.3, "y": 0.3}
    answer = (await sent(few)).json()
    assert answer["errors"][0]["pointer"] == "/data/columns"
    assert "2 for 3" in answer["detail"]


async def test_a_fit_that_leaves_the_range_of_doubles_writes_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    """LAPACK writes a line of its own to the standard output about numbers that are none."""
    response = await sent(changed(["data", "columns", "y", 6], -1.2399499703911948e16))
    assert (response.status_code, response.json()["errors"][0]["pointer"]) == (422, "/data/columns")
    assert not capfd.readouterr().out
