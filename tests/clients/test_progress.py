"""Progress of requests: reports come while a request is under way. Nothing here depends on how fast."""

from __future__ import annotations

import asyncio
import json
import time
from threading import Event

import httpx
import pytest
from polhode_client import AsyncClient, Client, Progress, bar
from polhode_client.exchange import PLAN


@pytest.fixture
def reports(monkeypatch: pytest.MonkeyPatch) -> list[Progress]:
    monkeypatch.setattr("polhode_client.progress.FIRST", 0.01)
    monkeypatch.setattr("polhode_client.progress.EVERY", 0.01)
    return []


@pytest.mark.parametrize("blocking", [True, False])
def test_it_is_reported_with_the_planned_time(blocking: bool, reports: list[Progress]) -> None:
    seen = Event()

    def report(progress: Progress) -> None:
        reports.append(progress)
        if progress.path != PLAN:
            seen.set()

    def handler(request: httpx.Request) -> httpx.Response:
        if request.url.path == PLAN:
            assert json.loads(request.content) == {"path": "/v1/rotation/wobble", "request": {"period": 430.0}}
            return httpx.Response(200, json={"cost": {"milliseconds": 2500.0}})
        assert seen.wait(60)
        return httpx.Response(200, json={"ellipticity": 1.0})

    if blocking:
        with Client("http://test", transport=httpx.MockTransport(handler), progress=report) as polhode:
            polhode.wobble(period=430.0)
    else:

        async def ask() -> None:
            async def slow(request: httpx.Request) -> httpx.Response:
                return await asyncio.to_thread(handler, request)

            transport = httpx.MockTransport(slow)
            async with AsyncClient("http://test", transport=transport, progress=report) as polhode:
                await polhode.wobble(period=430.0)

        asyncio.run(ask())
    assert {report.path for report in reports if report.expected} == {"/v1/rotation/wobble"}
    last = [report for report in reports if report.path == "/v1/rotation/wobble"]
    assert [report.done for report in last] == [False] * (len(last) - 1) + [True]
    assert last[0].expected == 2.5
    assert [report.elapsed for report in last] == sorted(report.elapsed for report in last)


def test_a_question_that_is_not_planned_has_no_expected_time(reports: list[Progress]) -> None:
    def handler(request: httpx.Request) -> httpx.Response:
        if request.url.path == PLAN:
            return httpx.Response(422, json={})
        while not any(report.path != PLAN for report in reports):
            time.sleep(0.001)
        return httpx.Response(200, json={})

    with Client("http://test", transport=httpx.MockTransport(handler), progress=reports.append) as polhode:
        polhode.wobble(period=430.0)
    assert {report.expected for report in reports} == {None}


def test_the_service_plans_what_the_client_sends(service: str) -> None:
    with Client(service, progress=lambda progress: None) as polhode:
        assert polhode.wobble(period=430.0)["ellipticity"] > 1.0


def test_the_bar(capsys: pytest.CaptureFixture[str]) -> None:
    bar(Progress("/v1/scenes", 2.0, 8.0))
    bar(Progress("/v1/scenes", 9.0, 8.0))
    bar(Progress("/v1/scenes", 3.0, None))
    bar(Progress("/v1/scenes", 4.0, None, done=True))
    first, second, third, last = capsys.readouterr().err.split("\r")[1:]
    assert first.count("#") == 8
    assert first.endswith("2 s of about 8 s")
    assert second.count("#") == 30
    assert third == "/v1/scenes 3 s"
    assert last == "\033[K"
