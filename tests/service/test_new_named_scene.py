"""A scene in a file of its own has its routes, schema, example, price, plan, digits, figure and contracts at once."""

from __future__ import annotations

import io
from dataclasses import replace
from typing import Any

import mpmath as mp
import numpy as np
import orjson
import pytest

from service.app import Service
from service.routing import PostRoute
from service.settings import Settings
from tests.contracts.scene_contracts import (
    each_output_alone_is_what_it_is_among_all,
    figures_of,
    it_is_a_system,
    samples_depend_on_their_own_time_only,
    what_makes_no_sense_is_refused,
)
from tests.service.block_on_spring import BlockOnSpring, table
from tests.service.conftest import INLINE, client_of

PATH, CERTIFIED = "/v1/scenes/block-on-spring", "/v1/certified/scenes/block-on-spring"
ROUTES = {route.path: route for route in table()}
QUESTION: dict[str, Any] = dict(ROUTES[PATH].examples["motion"].question)
BLOCK = BlockOnSpring(2.0, 8.0, 0.1, -0.3)


@pytest.fixture
def service() -> Service:
    return Service(Settings(cached_answers=0, **INLINE), "tests.service.test_new_named_scene:inline_table")


def inline_table() -> Any:
    """Return the two routes of the scene and the plan, answered in this process."""
    return tuple(replace(ROUTES[path], small=lambda question: True) for path in (PATH, CERTIFIED, "/v1/plan"))


@pytest.mark.anyio
async def test_its_example_is_answered_and_right(service: Service) -> None:
    async with client_of(service) as client:
        answer = (await client.post(PATH, json=QUESTION)).json()
    assert answer["model"]["regime"] == "harmonic"
    assert answer["accuracy"]["how"] == "closed form"
    assert answer["accuracy"]["error"] < 1e-15
    assert answer["ended"] == "horizon"
    assert answer["events"] == []
    with mp.workdps(40):
        for t, x in zip(answer["trajectory"]["time"], answer["trajectory"]["position"], strict=True):
            assert abs(mp.mpf(x) - mp.mpf(0.1) * mp.cos(2 * mp.mpf(t))) <= answer["accuracy"]["error"] * 0.1
        assert abs(answer["period"] - mp.pi) <= 1e-15 * mp.pi


@pytest.mark.anyio
async def test_its_certified_example_has_proven_digits(service: Service) -> None:
    question = dict(ROUTES[CERTIFIED].examples["digits"].question)
    assert question["position"] == "0.1"
    async with client_of(service) as client:
        answer = (await client.post(CERTIFIED, json=question)).json()
    assert answer["accuracy"]["requested"] == 50
    with mp.workdps(80):
        for t, x in zip(answer["trajectory"]["time"], answer["trajectory"]["position"], strict=True):
            assert abs(mp.mpf(x) - mp.cos(2 * mp.mpf(t)) / 10) < mp.mpf("1e-50")


@pytest.mark.anyio
async def test_it_is_planned_rounded_archived_and_drawn(service: Service) -> None:
    async with client_of(service) as client:
        plan = (await client.post("/v1/plan", json={"path": PATH, "request": QUESTION})).json()
        short = (await client.post(PATH, json=QUESTION | {"round": 3})).json()
        archive = await client.post(PATH, json=QUESTION, headers={"accept": "application/x-npz"})
        figure = await client.post(PATH, json=QUESTION, headers={"accept": "image/svg+xml"})
        wrong = await client.post(PATH, json=QUESTION | {"mass": -1.0})
    assert plan["cost"]["samples"] == 7
    assert plan["duration"] == "immediate"
    assert short["trajectory"]["position"][1] == pytest.approx(0.1 * np.cos(1.0), abs=5e-5)
    assert len(repr(short["trajectory"]["position"][1])) <= 7
    assert short["accuracy"]["error"] >= 5e-3
    assert np.load(io.BytesIO(archive.content))["trajectory/velocity"].shape == (7,)
    assert "position" in figure.text
    assert "m/s" in figure.text
    assert wrong.status_code == 422
    assert wrong.json()["errors"][0]["pointer"] == "/mass"


@pytest.mark.anyio
async def test_it_is_run_by_a_method_and_planned(service: Service) -> None:
    question = QUESTION | {"method": {"kind": "symmetric-splitting", "step": 0.01}}
    async with client_of(service) as client:
        answer = (await client.post(PATH, json=question)).json()
        plan = (await client.post("/v1/plan", json={"path": PATH, "request": question})).json()
    assert answer["method"] == plan["method"]["kind"] == "symmetric-splitting"
    assert answer["work"]["evaluations"] == plan["cost"]["evaluations"] == 900
    assert answer["accuracy"]["how"] == "measured against closed form"
    assert [warning["code"] for warning in answer["warnings"]] == ["accuracy-not-reached"]
    # Of x'' = -4 x the flow of second order turns by 2 asin(h) a step in place of 2 h: h^2/6 of the angle too far.
    late = 0.1 * np.sin(6.0) * 6.0 * 0.01**2 / 6.0
    assert answer["trajectory"]["position"][-1] - 0.1 * np.cos(6.0) == pytest.approx(-late, rel=1e-2)
    small = ROUTES[PATH].small
    assert small(read(ROUTES[PATH], QUESTION))
    assert not small(read(ROUTES[PATH], question))


@pytest.mark.anyio
async def test_the_document_shows_its_own_model(service: Service) -> None:
    async with client_of(service) as client:
        document = (await client.get("/openapi.json")).json()
    schemas = document["components"]["schemas"]
    assert schemas["BlockOnSpringRequest"]["properties"]["stiffness"]["x-unit"] == "N m^-1"
    assert {"period", "energy", "trajectory"} <= set(schemas["BlockOnSpringAnswer"]["properties"])
    assert PATH in document["paths"]
    assert CERTIFIED in document["paths"]


def read(route: PostRoute, question: dict[str, Any]) -> Any:
    return route.question.model_validate_json(orjson.dumps(question))


@pytest.mark.parametrize("name", figures_of(BLOCK))
def test_its_outputs_obey_the_contracts(name: str) -> None:
    each_output_alone_is_what_it_is_among_all(BLOCK, name)


@pytest.mark.parametrize(
    "contract", [samples_depend_on_their_own_time_only, it_is_a_system, what_makes_no_sense_is_refused]
)
def test_it_obeys_the_contracts(contract: Any) -> None:
    contract(BLOCK)
