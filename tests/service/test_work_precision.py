"""Work and precision over HTTP: figures, counts, times only if asked for, and the same as a drawing."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from typing import Any, ClassVar

import pytest

from service.routes.examples import examples
from service.routes.work_precision import SVG, WORK_PRECISION
from tests.service.conftest import client_of, inline_service

SERVICE = inline_service()
PATH = WORK_PRECISION[0].path
QUESTION: dict[str, Any] = dict(examples()["work_precision"]["t-handle"].question)

pytestmark = pytest.mark.anyio


async def asked(question: dict[str, Any], **headers: str) -> Any:
    async with client_of(SERVICE) as client:
        return await client.post(PATH, json=question, headers=headers)


async def test_errors_orders_front_and_recommendation() -> None:
    answer = (await asked(QUESTION)).json()
    curves = {curve["kind"]: curve for curve in answer["curves"]}
    assert set(curves) == {"closed-form", "explicit-euler", "runge-kutta-4", "dormand-prince-853"}
    for kind in ("explicit-euler", "runge-kutta-4"):
        coarse, fine = (one["error"] for one in curves[kind]["measurements"])
        assert fine < coarse
    halved = [one["error"] for one in curves["runge-kutta-4"]["measurements"]]
    assert 12 < halved[0] / halved[1] < 20
    assert answer["recommendation"]["method"] == {"kind": "closed-form"}
    front = answer["pareto_front"]
    assert front[0]["method"] == {"kind": "closed-form"}
    assert all(one["seconds"] is None for curve in answer["curves"] for one in curve["measurements"])


async def test_equal_questions_get_equal_bytes() -> None:
    first, second = await asked(QUESTION), await asked(QUESTION)
    assert first.content == second.content


async def test_times_are_medians_of_repeats_if_requested() -> None:
    answer = (await asked(QUESTION | {"repeats": 3})).json()
    assert all(one["seconds"] > 0.0 for curve in answer["curves"] for one in curve["measurements"])


async def test_a_failing_setting_is_listed_with_its_reason() -> None:
    methods = [{"kind": "explicit-euler", "step": 10.0}, {"kind": "closed-form"}]
    times = {"start": 0.0, "stop": 1e4, "count": 3}
    answer = (await asked(QUESTION | {"methods": methods, "times": times})).json()
    (failed,) = next(curve for curve in answer["curves"] if curve["kind"] == "explicit-euler")["measurements"]
    assert failed["error"] is None
    assert "step" in failed["failure"] or "double range" in failed["failure"]


async def test_an_unknown_setting_is_reported_where_it_stands() -> None:
    methods = [{"kind": "closed-form"}, {"kind": "runge-kutta-4", "step": -1.0}]
    response = await asked(QUESTION | {"methods": methods})
    assert response.status_code == 422
    assert response.json()["errors"][0]["pointer"] == "/methods/1/step"


async def test_the_default_ladder_is_a_figure_with_every_method() -> None:
    response = await asked({k: v for k, v in QUESTION.items() if k != "methods"}, accept=f"{SVG}, */*;q=0.1")
    assert response.status_code == 200
    assert response.headers["content-type"] == SVG
    root = ElementTree.fromstring(response.text)
    labels = " ".join(node.text or "" for node in root.iter("{http://www.w3.org/2000/svg}text"))
    for kind in ("closed-form", "explicit-euler, order 1.", "runge-kutta-4, order", "radau", "lsoda"):
        assert kind in labels
    again = await asked({k: v for k, v in QUESTION.items() if k != "methods"}, accept=SVG)
    assert again.content == response.content


@pytest.mark.parametrize(
    ("accept", "media"),
    [
        ("*/*", "application/json"),
        ("application/json, image/svg+xml", "application/json"),
        ("application/json;q=0.5, image/svg+xml", SVG),
        ("image/*", SVG),
        ("image/svg+xml;q=0, */*", "application/json"),
    ],
)
async def test_the_accept_header_chooses(accept: str, media: str) -> None:
    response = await asked(QUESTION, accept=accept)
    assert response.headers["content-type"] == media


async def test_what_is_not_offered_is_refused() -> None:
    response = await asked(QUESTION, accept="image/png")
    assert response.status_code == 406
    assert SVG in response.json()["detail"]


class TestDescribedScenes:
    SCENE: ClassVar[dict[str, Any]] = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [3, -4]}},
        "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}],
    }

    async def test_errors_fall_and_work_grows(self) -> None:
        methods = [{"kind": "runge-kutta-4", "step": step} for step in (0.1, 0.05)]
        answer = (await asked({"scene": self.SCENE, "times": [1.0, 2.0], "methods": methods})).json()
        assert answer["reference"] == "pairs of doubles"
        coarse, fine = answer["curves"][0]["measurements"]
        assert 10 < coarse["error"] / fine["error"] < 24
        assert (coarse["evaluations"], fine["evaluations"]) == (80, 160)

    async def test_the_ladder_is_a_figure(self) -> None:
        response = await asked({"scene": self.SCENE, "times": [2.0]}, accept=SVG)
        texts = [entry.text or "" for entry in ElementTree.fromstring(response.text).iter()]
        for kind in ("explicit-euler", "radau", "lsoda", "dormand-prince-853"):
            assert any(text.startswith(kind) for text in texts)

    async def test_it_is_planned(self) -> None:
        question = {"path": PATH, "request": {"scene": self.SCENE, "times": [2.0]}}
        async with client_of(SERVICE) as client:
            plan = (await client.post("/v1/plan", json=question)).json()
        assert plan["answerable"]
        assert plan["cost"]["bytes"] > 1000

    @pytest.mark.parametrize(
        ("change", "pointer"),
        [
            ({"scene": SCENE | {"bodies": {"p": {"mass": -1, "at": [3, -4]}}}}, "/scene/bodies/p/mass"),
            ({"scene": {"bodies": {"p": {"mass": 1, "at": [3, -4]}}}}, "/scene"),
            ({"body": {"kind": "ball", "mass": 1, "radius": 1}}, "/body"),
            ({"scene": None}, "/body"),
            ({"scene": None, "body": {"kind": "ball", "mass": 1.0, "radius": 1.0}}, "/angular_velocity"),
        ],
    )
    async def test_refusals_have_their_place(self, change: dict[str, Any], pointer: str) -> None:
        response = await asked({"scene": self.SCENE, "times": [1.0]} | change)
        assert response.status_code == 422
        assert [fault["pointer"] for fault in response.json()["errors"]] == [pointer]


class TestNamedScenes:
    ROD: ClassVar[dict[str, Any]] = {
        "named_scene": {"kind": "rod-in-hole", "hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81},
        "times": {"start": 0.0, "stop": 2.0, "count": 5},
    }

    async def test_every_method_is_measured_against_the_closed_form(self) -> None:
        answer = (await asked(self.ROD)).json()
        assert answer["reference"] == "closed form"
        assert answer["reference_error"] < 1e-14
        curves = {curve["kind"]: curve for curve in answer["curves"]}
        fixed = {"explicit-euler": 1, "symmetric-splitting": 2, "implicit-midpoint": 2, "runge-kutta-4": 4}
        assert set(curves) == {*fixed, "dormand-prince-853", "lsoda", "radau"}
        for kind, order in fixed.items():
            assert curves[kind]["fitted_order"] == pytest.approx(order, abs=0.35)

    async def test_what_interrupts_the_motion_is_refused_where_it_stands(self) -> None:
        shafts = {
            "kind": "unwinding-shafts",
            "masses": [2, 1],
            "radii": [0.1, 0.2],
            "slopes": [0.5, 0.9],
            "gravity": 9.81,
        }
        for changes, pointer in (
            ({}, "/named_scene/positions"),
            ({"positions": [1.0, 1.5], "spins": [5.0, 0.0]}, "/times"),
            ({"positions": [1.0, 1.5], "wound": [0.5, 0.8]}, "/times"),
        ):
            response = await asked({"named_scene": shafts | changes, "times": [1.0]})
            assert response.status_code == 422
            assert [fault["pointer"] for fault in response.json()["errors"]] == [pointer]

    async def test_one_motion_is_compared(self) -> None:
        response = await asked(QUESTION | self.ROD)
        assert response.status_code == 422
        assert response.json()["errors"][0]["detail"] == "must be given, or scene or named_scene, and not more than one"

    async def test_it_is_planned_and_drawn(self) -> None:
        async with client_of(SERVICE) as client:
            plan = (await client.post("/v1/plan", json={"path": PATH, "request": self.ROD})).json()
        assert plan["answerable"]
        assert plan["cost"]["bytes"] > 1000
        figure = await asked(self.ROD, accept=SVG)
        assert "runge-kutta-4, order 4" in figure.text or "runge-kutta-4, order 3.9" in figure.text
