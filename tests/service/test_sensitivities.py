"""Derivatives as an output of any question, over HTTP."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.systems.budget import Budget
from service.requests.request_reader import Limits, Reader
from service.routes import questions
from service.routing import never
from tests.service.conftest import client_of, inline_service
from tests.service.requests.test_npz_body import archive

SERVICE = inline_service()
ROD = {"hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81}
BODY = {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}, "angular_velocity": [1.0, 1.0, 1.0]}
DROP: dict[str, Any] = {
    "gravity": [0, "-g"],
    "let": {"g": 8, "h": "1.00000000000000000000000001"},
    "bodies": {"ball": {"mass": 1, "at": [0, "h"]}},
    "connections": [{"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0], "normal": [0, 1]}}],
    "times": [0.25, 0.75],
}

pytestmark = pytest.mark.anyio


def wanted(of: Any, to: Any) -> dict[str, Any]:
    return {"sensitivities": {"of": of, "to": to}}


async def sent(path: str, request: dict[str, Any]) -> dict[str, Any]:
    async with client_of(SERVICE) as client:
        return dict((await client.post(path, json=request)).json())


async def test_the_time_of_an_event_and_a_whole_column() -> None:
    touch = {"event": {"kind": "touch", "name": "floor"}}
    outputs = ["trajectory", wanted([touch, "/trajectory/columns/ball.position/values"], ["/let/g", "/times/0"])]
    answer = await sent("/v1/scenes", DROP | {"outputs": outputs})
    time, still, place, speed = answer["sensitivities"]
    # t = sqrt(2 h/g), y = h - g t^2/2.
    assert (time["of"], time["to"], time["unit"]) == (touch, "/let/g", "s/(m/s^2)")
    assert time["value"] == pytest.approx(-0.5 * 0.5 / 8.0, abs=time["error"])
    assert still["value"] == pytest.approx(0.0, abs=still["error"])
    assert np.array(place["value"]) == pytest.approx(np.array([[0.0, -1.0 / 32.0], [0.0, 0.0]]), abs=place["error"])
    assert np.array(speed["value"]) == pytest.approx(np.array([[0.0, -2.0], [0.0, 0.0]]), abs=speed["error"])
    assert "accelerations" not in answer
    assert answer["trajectory"]["columns"]["ball.position"]["values"][0][1] == 0.75


@pytest.mark.parametrize(
    ("path", "request_", "of", "to", "unit"),
    [
        ("/v1/scenes/rod-in-hole", ROD, "/period", "/gravity", "s/(m s^-2)"),
        ("/v1/rotation/precession", BODY, "/flip_interval", "/body/moments/0", "s/(kg m^2)"),
        ("/v1/rotation/trajectory", BODY | {"times": [1.0]}, "/energy", "/angular_velocity/1", "J/(rad s^-1)"),
        (
            "/v1/bodies/mass-properties",
            {"body": BODY["body"]},
            "/principal/moments",
            "/body/moments/1",
            "kg m^2/(kg m^2)",
        ),
    ],
)
async def test_questions_of_every_kind(path: str, request_: dict[str, Any], of: str, to: str, unit: str) -> None:
    plain = await sent(path, request_)
    answer = await sent(path, request_ | {"outputs": [wanted([of], [to])]})
    (one,) = answer.pop("sensitivities")
    assert answer == plain
    assert one["unit"].startswith(unit)
    assert 0.0 < one["error"] < 1e-9


@pytest.mark.parametrize(
    ("outputs", "pointer", "detail"),
    [
        ([wanted(["/energy/total"], ["/let/q"])], "/outputs/0/sensitivities/to/0", "number of the request"),
        ([wanted(["/energy/tota"], ["/let/g"])], "/outputs/0/sensitivities/of/0", "figure of the answer"),
        ([wanted(["/energy/total"], [])], "/outputs/0/sensitivities/to", "not be empty"),
        ([wanted(["/energy/total"], ["let"])], "/outputs/0/sensitivities/to/0", "JSON pointer"),
        ([wanted([{"event": {}}], ["/let/g"])], "/outputs/0/sensitivities/of/0/event", "kind"),
        (["trajectory", wanted(["/events/0/time"], ["/let/h"])], "/outputs/1/sensitivities/to/0", "number of the"),
        ([{"sensitivities": []}], "/outputs/0/sensitivities", "object"),
        ([wanted(["/energy/total"], [3])], "/outputs/0/sensitivities/to/0", "string"),
        ([{"sensitivities": {"of": ["/energy/total"]}}], "/outputs/0/sensitivities/to", "required"),
        ([wanted(["/energy/total"], 30 * ["/let/g"])], "/outputs/0/sensitivities/to", "at most 20"),
        ([wanted(["/energy/total"], ["/let/g"]) | {"when": {}}], "/outputs/0/when", "not known"),
    ],
)
async def test_what_cannot_be_differentiated_is_refused(outputs: Any, pointer: str, detail: str) -> None:
    problem = await sent("/v1/scenes", DROP | {"outputs": outputs})
    assert problem["status"] == 422
    assert problem["errors"][0]["pointer"] == pointer
    assert detail in problem["errors"][0]["detail"]


async def test_other_outputs_are_read_as_before() -> None:
    near = await sent("/v1/scenes/rod-in-hole", ROD | {"outputs": ["perod"]})
    assert near["errors"][0]["remedy"] == "did you mean 'period'?"
    near = await sent("/v1/rotation/precession", BODY | {"outputs": ["period"]})
    assert near["errors"][0] == {"pointer": "/outputs/0", "detail": "must be an object"}


def test_a_request_that_is_no_json_says_so() -> None:
    route = next(route for route in questions() if route.path == "/v1/rotation/trajectory")
    document = BODY | {"times": {"array": "times"}, "outputs": [wanted(["/energy"], ["/angular_velocity/1"])]}
    question = Reader[Any](route.question, Limits()).read(archive(document, times=np.array([1.0])), npz=True)
    with pytest.raises(InvalidParameter, match="request in JSON"):
        route.handle(question, Budget())


def test_routes_that_have_no_small_question_are_known_as_such() -> None:
    """The server process loads the kernels of the others alone: those of described scenes take 50 MB."""
    assert {route.path for route in questions() if route.small is never} >= {"/v1/scenes", "/v1/work-precision"}
