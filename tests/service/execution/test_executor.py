"""Where requests are answered: small ones in the event loop and within a limit of work, all others elsewhere."""

from __future__ import annotations

import json
import logging
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.work import spend, work_limit
from service.execution.admission import Compute, Sender
from service.execution.executor import Executor
from service.execution.request_handler import RequestHandler
from service.http.held_bytes import HeldBytes
from service.observability.metrics import Metrics
from service.responses.svg import SVG
from service.routes import questions
from service.routing import TABLE, PostRoute
from service.settings import Settings
from tests.service.toy_routes import GOOD, TOY

pytestmark = pytest.mark.anyio

ROUTES = {route.path: route for route in questions()}
SETTINGS = Settings()
COMPUTE = Compute(SETTINGS, Metrics(), TABLE)
HANDLER = RequestHandler(ROUTES.values(), COMPUTE.terms.budget, COMPUTE.terms.limits)
EXECUTOR = Executor(HANDLER, COMPUTE, Metrics(), SETTINGS)

HANDLE = {"kind": "principal-moments", "moments": [795.0, 713.0, 395.0]}
TRAJECTORY = {"body": HANDLE, "angular_velocity": [1.0, 10.0, 1.0], "times": {"start": 0.0, "stop": 20.0, "count": 11}}
BALL = {"kind": "ball", "radius": 1.0, "mass": 1.0}
MANY = {"kind": "composite", "parts": [{"body": BALL, "position": [float(i), 0.1, 0.2]} for i in range(600)]}
NUMERAL = "1." + "7" * 998
CUBOIDS = {
    "kind": "composite",
    "parts": [
        {"body": {"kind": "cuboid", "lengths": [NUMERAL] * 3, "mass": NUMERAL}, "attitude": [NUMERAL[:300]] * 4}
        for _ in range(9)
    ],
}
SHAFTS = {
    "masses": [2.0, 1.0], "radii": [0.1, 0.2], "slopes": [0.5, 0.9], "gravity": 9.81, "positions": [1.0, 1.5],
    "wound": [0.5, 0.8], "times": [0.0, 2.0],
}  # fmt: skip

HELD: dict[str, tuple[str, dict[str, Any], str | None]] = {
    "judging an ensemble beyond the closed form": (
        "/v1/rotation/ensemble",
        {
            "body": HANDLE,
            "angular_velocities": [[1e57, 2e57, 1e57]] * 8,
            "times": [1.0],
            "method": {"kind": "symmetric-splitting", "step": 269},
        },
        None,
    ),
    "a plan with digits of long numerals": (
        "/v1/plan",
        {"path": "/v1/rotation/stability", "request": {"body": CUBOIDS, "digits": 16}},
        None,
    ),
    "a drawing of many points": (
        "/v1/rotation/energy-ellipsoid",
        {"body": HANDLE, "energy": 1.0, "points": 100_000, "separatrix": True},
        SVG,
    ),
    "judging a method beyond the closed form": (
        "/v1/rotation/trajectory",
        {**TRAJECTORY, "angular_velocity": [1e20] * 3, "method": {"kind": "explicit-euler", "step": 269}},
        None,
    ),
    "a plan of many parts": (
        "/v1/plan",
        {"path": "/v1/rotation/trajectory", "request": {**TRAJECTORY, "body": MANY, "attitude": [1.0, 0.0, 0.0, 0.0]}},
        None,
    ),
    "a body of many parts": ("/v1/bodies/mass-properties", {"body": MANY}, None),
    "a measurement of many samples": (
        "/v1/rotation/precession",
        {
            "body": HANDLE,
            "angular_velocity": [1.0, 10.0, 1.0],
            "measure": {"method": {"kind": "closed-form"}, "duration": 20.0, "samples": 1_000_000, "tolerance": 0.1},
        },
        None,
    ),
    "rounding many tiny numbers": (
        "/v1/rotation/trajectory",
        {
            **TRAJECTORY,
            "angular_velocity": [1e-30, 2e-30, 1e-30],
            "times": {"start": 0.0, "stop": 1.0, "count": 100_000},
            "round": 1,
        },
        None,
    ),
    "rounding shafts of tiny lengths": (
        "/v1/scenes/unwinding-shafts",
        {**SHAFTS, "radii": [1e-200, 2e-200], "times": {"start": 0.0, "stop": 1.0, "count": 50_000}, "round": 1},
        None,
    ),
    "jerks with friction": (
        "/v1/scenes/unwinding-shafts",
        {
            **SHAFTS,
            "velocities": [0.1, 0.2],
            "spins": [5.0, 1.0],
            "restitution": 0.9,
            "friction": {"kinetic": [0.1, 0.1], "static": [0.12, 0.12]},
        },
        None,
    ),
    "a comparison of repeated closed forms": (
        "/v1/work-precision",
        {**TRAJECTORY, "methods": [{"kind": "closed-form"}] * 20, "repeats": 101},
        None,
    ),
}
"""Requests each of which held the event loop for between 0.08 and 23 s."""


@pytest.mark.parametrize("name", HELD)
def test_what_held_the_event_loop_is_not_answered_in_it(name: str) -> None:
    path, question, media = HELD[name]
    body = json.dumps(question).encode()
    with work_limit(1e12) as meter:
        inline = len(body) <= SETTINGS.inline_bytes
        assert not inline or EXECUTOR.answer_inline(ROUTES[path], body, media) is None
    # The executor counts for itself.
    assert meter.spent == 0.0


def asked(question: dict[str, Any], route: PostRoute = TOY, work: int = 2000) -> tuple[Any, str]:
    """Return what a handler with the toy answers inline, and the metrics."""
    metrics = Metrics()
    handler = RequestHandler([route], COMPUTE.terms.budget, COMPUTE.terms.limits)
    executor = Executor(handler, COMPUTE, metrics, Settings(inline_work=work))
    return executor.answer_inline(route, json.dumps(question).encode()), metrics.exposition().decode()


def test_what_is_small_is_answered_here() -> None:
    for route in ROUTES.values():
        for name, example in route.examples.items():
            document = EXECUTOR.answer_inline(route, json.dumps(dict(example.question)).encode())
            small = route.small(HANDLER.read(route, json.dumps(dict(example.question)).encode()))
            assert (document is not None) is small, (route.path, name)
    small_ones = [path for path, route in ROUTES.items() if route.small is not PostRoute.small]
    assert {"/v1/rotation/precession", "/v1/rotation/trajectory", "/v1/bodies/mass-properties"} <= set(small_ones)


def working(question: Any, budget: Any) -> dict[str, Any]:
    spend(10.0)
    return {}


WORKING = replace(TOY, handle=working)
WRITTEN = replace(TOY, handle=lambda question, budget: {"time": np.zeros(160)})
POINTS = {"body": {"kind": "point-masses", "masses": 1.0, "positions": [[0.1, 0.2, 0.3]] * 10}}
READ = replace(ROUTES["/v1/bodies/mass-properties"], handle=lambda question, budget: {})


@pytest.mark.parametrize(("route", "question"), [(READ, POINTS), (WORKING, GOOD), (WRITTEN, GOOD)])
def test_beyond_the_limit_nothing_is_answered_here(route: PostRoute, question: dict[str, Any]) -> None:
    """Reading, answering and writing take ten units each."""
    document, metrics = asked(question, route, work=10)
    assert document is not None
    assert "polhode_handed_over_total{" not in metrics
    document, metrics = asked(question, route, work=9)
    assert document is None
    assert f'polhode_handed_over_total{{operation="{route.operation_id}"}} 1.0' in metrics


class Elsewhere:
    """Compute processes that answer everything at once."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, bytes, bool, str | None]] = []
        self.held = HeldBytes(2**20)

    async def answer(
        self, route: PostRoute, body: bytes, npz: bool, media: str | None, sender: Sender, *, later: bool
    ) -> str:
        self.asked.append((route.path, body, npz, media))
        return "elsewhere"


class Paying:
    """A key that notes what it is charged with."""

    def __init__(self) -> None:
        self.taken: list[float] = []
        self.charged: list[float] = []

    def work(self, seconds: float) -> None:
        self.taken.append(seconds)

    def charge(self, seconds: float) -> None:
        self.charged.append(seconds)


async def gone() -> None:
    raise AssertionError


@pytest.mark.parametrize(
    ("body", "npz", "work", "here"),
    [
        (json.dumps(GOOD), False, 2000, True),
        (json.dumps(GOOD), True, 2000, False),
        (json.dumps(GOOD) + " " * 9000, False, 2000, False),
        (json.dumps(GOOD | {"behaviour": "sleep"}), False, 2000, False),
        (json.dumps(GOOD), False, 0, False),
    ],
    ids=["small", "an archive", "padded", "not small", "no work at all"],
)
async def test_a_request_is_begun_where_it_belongs(body: str, npz: bool, work: int, here: bool) -> None:
    elsewhere, key = Elsewhere(), Paying()
    handler = RequestHandler([TOY], COMPUTE.terms.budget, COMPUTE.terms.limits)
    executor = Executor(handler, elsewhere, Metrics(), Settings(inline_work=work))  # type: ignore[arg-type]
    sender = Sender("client", key, gone)  # type: ignore[arg-type]
    document = await executor.answer(TOY, body.encode(), npz, None, sender)
    assert (document != "elsewhere") is here
    assert elsewhere.asked == ([] if here else [(TOY.path, body.encode(), npz, None)])
    # Whoever has debts is refused before anything is done, and what is done here is charged.
    assert key.taken == [0.0]
    assert len(key.charged) == (not npz and len(body) <= 8192)


async def test_a_request_that_holds_the_event_loop_is_counted_and_logged(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    ticks = iter([0.0, 0.019, 1.0, 1.021])
    monkeypatch.setattr("service.execution.executor.perf_counter", lambda: next(ticks))
    metrics = Metrics()
    handler = RequestHandler([TOY], COMPUTE.terms.budget, COMPUTE.terms.limits)
    executor = Executor(handler, Elsewhere(), metrics, Settings())  # type: ignore[arg-type]
    with caplog.at_level(logging.WARNING):
        for _ in range(2):
            await executor.answer(TOY, json.dumps(GOOD).encode(), False, None, Sender("client", None, gone))
    assert 'polhode_long_inline_total{operation="ask_toy"} 1.0' in metrics.exposition().decode()
    [record] = caplog.records
    assert (record.__dict__["operation"], record.__dict__["milliseconds"]) == ("ask_toy", 21.0)
