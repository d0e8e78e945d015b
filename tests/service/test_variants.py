"""Variants over HTTP: of every question of the route table, reproducible, and refused by pointer."""

from __future__ import annotations

import json
from typing import Any

import orjson
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.assessment.propagation import numbers_of
from core.errors import pointer_of
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.problems import Refusal
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from tests.service.conftest import client_of, inline_service

PATH = "/v1/variants"
SERVICE = inline_service()
ROUTES = {route.path: route for route in questions()}
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
VARIED = [
    path
    for path in ROUTES
    # Documents of other programs are no figures.
    if not path.startswith(("/v1/certified", "/v1/plan", "/v1/assess", "/v1/studies", "/v1/fits", PATH))
    and path not in ("/v1/scenes/import", "/v1/scenes/export")
]
Body = dict[str, Any]
JSON = {"content-type": "application/json"}

COIN: Body = {
    "path": "/v1/rotation/precession",
    "request": {"body": {"kind": "principal-moments", "moments": [1.0, 1.0, 1.5]}, "angular_velocity": [1.0, 1.0, 1.0]},
}
ALIKE: Body = {"/body/moments/0": {"min": 1.0, "max": 2.0, "digits": 2, "also": ["/body/moments/1"]}}
WOBBLE: Body = {"path": "/v1/rotation/wobble", "request": {"period": 430, "day": "sidereal"}}
PERIOD: Body = {"/period": {"min": 100.0, "max": 900.0}}

pytestmark = pytest.mark.anyio


def written_answer(**request: Any) -> bytes:
    route = ROUTES[PATH]
    return written(HANDLER.answer(route, HANDLER.read(route, json.dumps({"seed": 0, **request}).encode())))


def handled(**request: Any) -> Any:
    return json.loads(written_answer(**request))


async def refused(**request: Any) -> tuple[int, str, str, str]:
    async with client_of(SERVICE) as client:
        response = await client.post(PATH, content=json.dumps({"seed": 0, **request}), headers=JSON)
    problem = response.json()
    fault = problem["errors"][0] if problem.get("errors") else {"pointer": "", "detail": problem["detail"]}
    return response.status_code, problem["code"], fault["pointer"], fault["detail"]


@pytest.mark.parametrize("path", VARIED)
def test_every_question_has_variants_whose_figures_are_those_of_its_answer(path: str) -> None:
    """Each number of an example is drawn within 1 % of what it is; the figures are compared with the route's own."""
    route = ROUTES[path]
    question = json.loads(orjson.dumps(next(iter(route.examples.values())).question))
    place, number = next(
        (place, number) for place, number in numbers_of(question) if type(number) is float and place[-1] != "digits"
    )
    low, high = sorted((0.995 * number, 1.005 * number))
    asked = {"path": path, "request": question}
    vary = {pointer_of(place): {"min": low, "max": high}}
    answer = handled(question=asked, vary=vary, count=2, draws=20)
    assert len(answer["variants"]) == 2
    for variant in answer["variants"]:
        own = json.loads(written(HANDLER.answer(route, HANDLER.read(route, orjson.dumps(variant["request"])))))
        assert variant["request"] != question
        for figure in variant["figures"]:
            assert figure["value"] == at(own, figure["pointer"])
            assert figure["condition"] is None or figure["condition"] >= 0.0


def at(document: Any, pointer: str) -> Any:
    for step in (step.replace("~1", "/").replace("~0", "~") for step in pointer[1:].split("/")):
        document = document[int(step)] if isinstance(document, list) else document[step]
    return document


@given(st.integers(0, 2**53 - 1), st.integers(1, 4))
@settings(max_examples=20)
def test_equal_requests_have_equal_bytes_and_counts_only_add_members(seed: int, count: int) -> None:
    request: Body = {"question": COIN, "vary": ALIKE, "seed": seed, "quantities": ["/body_rate"]}
    assert written_answer(**request, count=count) == written_answer(**request, count=count)
    more = handled(**request, count=count + 1)["variants"]
    assert handled(**request, count=count)["variants"] == more[:count]


def test_numbers_that_move_together_keep_a_symmetry() -> None:
    for variant in handled(question=COIN, vary=ALIKE, count=5)["variants"]:
        one, other, third = variant["request"]["body"]["moments"]
        assert one == other
        (rate,) = [figure for figure in variant["figures"] if figure["pointer"] == "/body_rate"]
        # (C - A)/A times the spin along the axis.
        assert rate["value"] == pytest.approx((third - one) / one, rel=1e-12, abs=1e-15)


def test_the_condition_is_that_of_the_closed_form() -> None:
    (variant,) = handled(question=COIN, vary=ALIKE, count=1, quantities=["/body_rate"])["variants"]
    equal, _, third = variant["request"]["body"]["moments"]
    (figure,) = variant["figures"]
    # Of (C - A)/A w: C/(C - A) for each of C and A, and 1 for w.
    assert figure["condition"] == pytest.approx(1.0 + 2.0 * third / abs(third - equal), rel=1e-6)
    more = {"count": 1, "quantities": ["/body_rate"], "input_uncertainty": 1e-4}
    (again,) = handled(question=COIN, vary=ALIKE, **more)["variants"]
    assert again["request"] == variant["request"]
    assert again["figures"][0]["inherited"] == pytest.approx(
        1e-4 * figure["condition"] * abs(figure["value"]), rel=2e-2
    )


def test_variants_are_physical_where_their_question_is() -> None:
    vary = {"/body/moments/2": {"min": 1.5, "max": 3.0}}
    answer = handled(question=COIN, vary=vary, count=10)
    # No body has a moment above the sum of the others.
    assert all(variant["request"]["body"]["moments"][2] <= 2.0 for variant in answer["variants"])
    assert answer["rejected"]["warned"] > 0


def test_constraints_hold_and_rejected_draws_are_counted() -> None:
    answer = handled(
        question=WOBBLE,
        vary={"/period": {"min": 100.0, "max": 900.0, "step": 1.0}, "/day": {"values": ["sidereal", "solar"]}},
        count=6,
        quantities=["/ellipticity", "/asymmetry"],
        constraints={"/asymmetry": {"min": 0.002, "max": 0.004, "digits": 2, "within": 0.02}},
        max_condition=1e6,
    )
    for variant in answer["variants"]:
        assert type(variant["request"]["period"]) is int
        ellipticity, asymmetry = (figure["value"] for figure in variant["figures"])
        assert 0.002 <= asymmetry <= 0.004
        assert abs(asymmetry - float(f"{asymmetry:.1e}")) <= 0.02 * asymmetry
        assert ellipticity > 1.0
    assert sum(answer["rejected"].values()) == sum(variant["draws"] - 1 for variant in answer["variants"])
    assert answer["rejected"]["/asymmetry"] > 0


def test_a_trajectory_has_its_few_figures_and_says_which_are_left_out() -> None:
    request = {"body": COIN["request"]["body"], "angular_velocity": [1.0, 1.0, 1.0], "times": [0.0, 1.0, 2.0]}
    asked = {"path": "/v1/rotation/trajectory", "request": request}
    (variant,) = handled(question=asked, vary=ALIKE, count=1)["variants"]
    assert {"/energy", "/angular_velocity"} <= {figure["pointer"] for figure in variant["figures"]}
    points = json.loads(orjson.dumps(ROUTES["/v1/bodies/mass-properties"].examples["point-masses"].question))
    asked = {"path": "/v1/bodies/mass-properties", "request": points}
    answer = handled(question=asked, vary={"/body/masses/0": {"min": 1.0, "max": 2.0}}, count=1)
    assert "figures-left-out" in [warning["code"] for warning in answer["warnings"]]
    assert len(answer["variants"][0]["figures"]) == 20


def test_refusals_of_the_path_point_to_it_wherever_they_are_found() -> None:
    with pytest.raises(Refusal) as caught:
        handled(question={"path": "/v1/nothing", "request": {}}, vary=PERIOD)
    assert [fault.pointer for fault in caught.value.problem.faults] == ["/question/path"]


@pytest.mark.parametrize(
    ("change", "pointer", "rule"),
    [
        ({"vary": {"/gravity": {"min": 1.0, "max": 2.0}}}, "/vary/~1gravity", "lead to a number"),
        ({"vary": {"period": {"min": 1.0, "max": 2.0}}}, "/vary/period", "JSON pointer"),
        ({"vary": {"/day": {"min": 1.0, "max": 2.0}}}, "/vary/~1day", "lead to a number"),
        ({"vary": {"/period": {"values": ["a", "b"]}}}, "/vary/~1period", "lead to a string"),
        ({"vary": {"/period": {"values": [1.0, "b"]}}}, "/vary/~1period", "one kind"),
        ({"vary": {"/period": {"values": [True, False]}}}, "/vary/~1period", "truth value"),
        ({"vary": {"/period/0": {"min": 1.0, "max": 2.0}}}, "/vary/~1period~10", "lead to a number"),
        ({"vary": {"/" + "x" * 300: {"min": 1.0, "max": 2.0}}}, "/vary", "lead to a number"),
        ({"vary": {}}, "/vary", "not be empty"),
        ({"vary": {f"/{i}": {"min": 1.0, "max": 2.0} for i in range(41)}}, "/vary", "at most 40"),
        ({"vary": {"/period": {"min": 2.0, "max": 1.0}}}, "/vary/~1period/max", "greater than min"),
        ({"vary": {"/period": {"min": 1.0, "max": 1.0}}}, "/vary/~1period/max", "greater than min"),
        ({"vary": {"/period": {"min": 1.0}}}, "/vary/~1period/max", "be given"),
        ({"vary": {"/period": {"min": 1.0, "max": 2.0, "also": ["/period"]}}}, "/vary/~1period", "another entry"),
        ({"vary": {"/period": {"min": 1.0, "max": 2.0, "also": ["/x"]}}}, "/vary/~1period/also/0", "lead to a number"),
        ({"count": 0}, "/count", "at least 1"),
        ({"count": 10**9}, "/count", "at most 200"),
        ({"draws": 10**6}, "/draws", "at most 1000"),
        ({"seed": -1}, "/seed", "at least 0"),
        ({"quantities": ["/nothing"]}, "/quantities/0", "figure of the answer"),
        ({"quantities": ["period"]}, "/quantities/0", "JSON pointer"),
        ({"quantities": [""]}, "/quantities/0", "JSON pointer"),
        ({"constraints": {"/nothing": {"min": 1.0}}}, "/constraints/~1nothing", "figure of the answer"),
        ({"constraints": {"/ellipticity": {"min": 2.0, "max": 1.0}}}, "/constraints/~1ellipticity/max", "at least min"),
        ({"constraints": {"/ellipticity": {}}}, "/constraints/~1ellipticity/min", "be given"),
        ({"constraints": {"/ellipticity": {"min": 5.0}}, "draws": 30}, "/constraints", "30 draws; member 0"),
        ({"max_condition": 0.5}, "/max_condition", "at least 1"),
        ({"question": {"path": "/v1/rotation/wobbles", "request": {}}}, "/question/path", "can be assessed"),
        ({"question": {"path": PATH, "request": {}}}, "/question/path", "can be assessed"),
        (
            {"question": {"path": "/v1/rotation/wobble", "request": {"period": -1}}},
            "/question/request/period",
            "greater",
        ),
    ],
)
async def test_what_cannot_be_varied_is_refused_by_pointer(change: Body, pointer: str, rule: str) -> None:
    request: Body = {"question": WOBBLE, "vary": PERIOD, "count": 2} | change
    status, code, found, detail = await refused(**request)
    assert (status, code, found) == (422, "invalid-parameter", pointer)
    assert rule in detail


async def test_the_numbers_of_all_figures_are_limited() -> None:
    request = COIN["request"] | {"times": {"start": 0.0, "stop": 1.0, "count": 1000}}
    motion = {"path": "/v1/rotation/trajectory", "request": request}
    columns: Body = {"question": motion, "vary": ALIKE, "quantities": ["/angular_velocity"]}
    assert await refused(**columns, count=34) == (
        422, "budget-exceeded", "/count", "102000 numbers in figures are needed and 100000 are allowed",
    )  # fmt: skip
    (variant,) = handled(**columns, count=1)["variants"]
    assert len(variant["figures"][0]["value"]) == 1000


@pytest.mark.parametrize(
    "text", ['{"min": NaN, "max": 1.0}', '{"min": 0.0, "max": Infinity}', '{"values": [NaN, 1.0]}']
)
async def test_numbers_that_json_does_not_have_are_refused(text: str) -> None:
    body = json.dumps({"question": WOBBLE, "vary": {"/period": "HERE"}, "seed": 0}).replace('"HERE"', text)
    async with client_of(SERVICE) as client:
        response = await client.post(PATH, content=body, headers=JSON)
    assert response.status_code in (400, 422)
    assert response.json()["code"] in ("invalid-json", "invalid-parameter")
