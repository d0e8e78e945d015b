"""Questions asked backwards over the wire: what is answered, refused, planned, graded and varied in a study."""

from __future__ import annotations

import json
from typing import Any

import pytest

from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from tests.service.conftest import client_of, inline_service

PATH = "/v1/find"
SERVICE = inline_service()
ROUTES = {route.path: route for route in questions()}
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
Body = dict[str, Any]

FLIP: Body = {
    "path": "/v1/rotation/precession",
    "request": {"body": {"kind": "principal-moments", "moments": [3.0, 2.0, 1.5]}, "angular_velocity": [0.1, 4.0, 0.1]},
}
MIDDLE: Body = {"pointer": "/body/moments/1", "between": [1.7, 2.8]}
SPIN: Body = {"pointer": "/angular_velocity/1", "between": [1.0, 8.0]}
EIGHT: Body = {"figure": "/flip_interval", "equals": 8.0}

pytestmark = pytest.mark.anyio


def answered(path: str, request: Body) -> Any:
    route = ROUTES[path]
    return json.loads(written(HANDLER.answer(route, HANDLER.read(route, json.dumps(request).encode()))))


def found(question: Body, vary: Any, until: Any, **more: Any) -> Any:
    return answered(PATH, {"question": question, "vary": vary, "until": until, **more})


async def refused(question: Body, vary: Any, until: Any) -> tuple[int, str, str, str]:
    async with client_of(SERVICE) as client:
        response = await client.post(PATH, json={"question": question, "vary": vary, "until": until})
    problem = response.json()
    fault = problem["errors"][0] if problem.get("errors") else {"pointer": "", "detail": problem["detail"]}
    return response.status_code, fault["pointer"], fault["detail"], fault.get("remedy", "")


def test_a_root_has_the_answer_that_has_the_figure() -> None:
    answer = found(FLIP, MIDDLE, EIGHT, answers=True)
    (one,) = answer["solutions"]
    forward = answered(
        FLIP["path"],
        FLIP["request"] | {"body": FLIP["request"]["body"] | {"moments": [3.0, one["values"]["/body/moments/1"], 1.5]}},
    )
    assert forward["flip_interval"] == one["figure"] == one["answer"]["flip_interval"]
    assert abs(one["figure"] - 8.0) < 1e-14
    assert 0.0 < one["errors"]["/body/moments/1"] < 1e-14
    assert answer["units"] == {"/body/moments/1": "kg m^2"}
    assert answer["complete"] is False
    assert answer["resolution"]["/body/moments/1"] < 0.3


def test_units_of_ranges_and_values() -> None:
    plain = found(FLIP, SPIN | {"between": [0.5, 2.0]}, EIGHT)
    turns = {"between": [{"value": "0.5", "unit": "rad/s"}, {"value": 2, "unit": "rad/s"}]}
    assert found(FLIP, SPIN | turns, EIGHT | {"equals": {"value": "8e3", "unit": "ms"}}) == plain


FAULTS: list[tuple[Any, Any, str, str, str]] = [
    (
        SPIN | {"pointer": "/angular_velocty/1"},
        EIGHT,
        "/vary/pointer",
        "number in the request",
        '"/angular_velocity/1"',
    ),
    (SPIN | {"pointer": "/body/kind"}, EIGHT, "/vary/pointer", "number in the request", ""),
    (SPIN | {"between": [8, 1]}, EIGHT, "/vary/between/1", "greater than the first", "smaller one first"),
    (SPIN | {"between": [1, 1.0000000000000002]}, EIGHT, "/vary/between/1", "roundings of doubles", "ask the question"),
    (SPIN | {"between": [1, "x"]}, EIGHT, "/vary/between/1", "number", ""),
    (SPIN | {"between": [1, {"value": 1, "unit": "kg"}]}, EIGHT, "/vary/between/1/unit", "same kind", "rad s^-1"),
    (SPIN | {"scale": "log", "between": [-1, 1]}, EIGHT, "/vary/between/0", "greater than 0", "linear"),
    (SPIN, {"figure": "/flip_intervall", "equals": 1}, "/until/figure", "lead to", '"/flip_interval"'),
    (SPIN, {"figure": "/axis", "equals": 1}, "/until/figure", "lead to", ""),
    (SPIN, {"figure": "/flip_interval"}, "/until", "one thing", "equals"),
    (SPIN, {"figure": "/flip_interval", "equals": 1, "least": True}, "/until", "one thing", ""),
    (SPIN, {"equals": 1}, "/until/figure", "given", ""),
    (SPIN, {"figure": {"evnt": 1}, "equals": 1}, "/until/figure", "pointer", ""),
    (SPIN, {"figure": "/regime", "least": True}, "/until/figure", "number", "changes"),
    (SPIN, {"figure": "/flip_interval", "happens": True}, "/until/event", "happens", ""),
    (SPIN, {"figure": "/flip_interval", "equals": {"value": 1, "unit": "kg"}}, "/until/equals/unit", "same kind", ""),
    (SPIN, [EIGHT, EIGHT], "/until", "as many entries", ""),
    ([SPIN, SPIN], [EIGHT, EIGHT], "/vary/1/pointer", "another entry", ""),
    ([SPIN, MIDDLE], [EIGHT, {"figure": "/flip_interval", "least": True}], "/until/1", "which number", "one input"),
    ([], EIGHT, "/vary", "empty", ""),
]


@pytest.mark.parametrize(("vary", "until", "pointer", "rule", "remedy"), FAULTS)
async def test_what_is_wrong_is_refused_in_its_place(
    vary: Any, until: Any, pointer: str, rule: str, remedy: str
) -> None:
    status, where, detail, help_ = await refused(FLIP, vary, until)
    assert (status, where) == (422, pointer)
    assert rule in detail
    assert remedy in help_


async def test_a_name_behind_an_index_that_no_answer_has_is_refused_before_any_is_computed() -> None:
    question = STONE | {"request": STONE["request"] | {"outputs": ["equilibria"]}}
    until = {"figure": "/equilibria/0/stabel", "changes": True}
    status, where, _, remedy = await refused(question, {"pointer": "/let/h", "between": [0.5, 2.0]}, until)
    assert (status, where) == (422, "/until/figure")
    assert 'did you mean "/stable"?' in remedy
    assert "/equilibria/0 has positions" in remedy


async def test_faults_of_the_question_point_into_it() -> None:
    status, where, _, _ = await refused(FLIP | {"path": "/v1/nothing"}, SPIN, EIGHT)
    assert (status, where) == (422, "/question/path")
    body = {"kind": "principal-moments", "moments": [3.0, -2.0, 1.5]}
    status, where, _, _ = await refused(FLIP | {"request": FLIP["request"] | {"body": body}}, SPIN, EIGHT)
    assert (status, where) == (422, "/question/request/body/moments/1")


def test_a_range_without_a_root_has_the_nearest_miss() -> None:
    answer = found(FLIP, SPIN, EIGHT | {"equals": 3.0})
    assert answer["solutions"] == []
    assert answer["nearest"]["values"] == {"/angular_velocity/1": 8.0}
    assert answer["nearest"]["figure"] > 3.0


STONE: Body = {
    "path": "/v1/scenes",
    "request": {
        "gravity": [0, -9.81],
        "let": {"h": 1.0},
        "bodies": {"stone": {"mass": 1, "at": [0, "h"]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "stone", "on": {"at": [0, 0]}, "restitution": 0.5}
        ],
        "times": [0.5],
        "outputs": ["energy"],
    },
}


def test_an_event_is_a_time_a_count_and_something_that_happens() -> None:
    """Half g t^2: a stone falls 1.22625 m in half a second."""
    height: Body = {"pointer": "/let/h", "between": [0.5, 2.0]}
    touch: Body = {"kind": "touch", "name": "floor"}
    (one,) = found(STONE, height, {"figure": {"event": touch}, "equals": 0.4})["solutions"]
    assert abs(one["values"]["/let/h"] - 9.81 * 0.08) <= one["errors"]["/let/h"] < 1e-14
    happens = found(STONE, height, {"event": touch, "happens": True})
    (one,) = happens["solutions"]
    assert (one["kind"], one["below"], one["above"]) == ("border", True, False)
    assert abs(one["values"]["/let/h"] - 1.22625) <= one["errors"]["/let/h"]
    assert happens["ranges"] == [[0.5, one["values"]["/let/h"]]]
    counted = found(STONE, height, {"figure": {"count": "/events"}, "changes": True})["solutions"]
    assert abs(counted[-1]["values"]["/let/h"] - 1.22625) <= counted[-1]["errors"]["/let/h"]


def test_an_event_that_never_happens_is_told_with_those_that_do() -> None:
    until = {"event": {"kind": "touch", "name": "flor"}, "happens": True}
    answer = found(STONE, {"pointer": "/let/h", "between": [0.5, 0.6]}, until)
    assert (answer["solutions"], answer["ranges"]) == ([], [])
    (warning,) = answer["warnings"]
    assert warning["code"] == "event-does-not-happen"
    assert "touch floor" in warning["detail"]


def test_it_is_planned_and_graded_and_swept() -> None:
    request = {"question": FLIP, "vary": MIDDLE, "until": EIGHT}
    plan = answered("/v1/plan", {"path": PATH, "request": request})
    assert plan["answerable"] is not False
    graded = answered(
        "/v1/assessments",
        {
            "question": {"path": PATH, "request": request},
            "submissions": [
                {"/solutions/0/values/~1body~1moments~11": {"value": value, "unit": "kg m^2"}} for value in (2.42, 2.3)
            ],
        },
    )
    assert [one["correct"] for one in graded["results"]] == [True, False]
    study = {
        "question": {"path": PATH, "request": request},
        "vary": [{"pointer": "/until/equals", "values": [7.0, 8.0, 9.0]}],
        "quantities": ["/solutions/0/values/~1body~1moments~11", "/evaluations"],
    }
    route = ROUTES["/v1/studies"]
    members = route.members(HANDLER.read(route, json.dumps(study).encode()), Budget())
    block = members.block(0, 3)
    assert block.failures.tolist() == [0, 0, 0]
    assert block.figures[:, 0].tolist() == sorted(block.figures[:, 0].tolist())
    assert block.figures[1, 0] == found(FLIP, MIDDLE, EIGHT)["solutions"][0]["values"]["/body/moments/1"]
