"""Progress of requests: reports come while a request is under way. Nothing here depends on how fast."""

from __future__ import annotations

import asyncio
from threading import Event

import httpx
import pytest
from polhode_client import AsyncClient, Client, Progress, bar


@pytest.fixture
def reports(monkeypatch: pytest.MonkeyPatch) -> list[Progress]:
    monkeypatch.setattr("polhode_client.progress.FIRST", 0.01)
    monkeypatch.setattr("polhode_client.progress.EVERY", 0.01)
    return []


@pytest.mark.parametrize("blocking", [True, False])
def test_it_is_reported_while_it_is_under_way(blocking: bool, reports: list[Progress]) -> None:
    seen = Event()

    def report(progress: Progress) -> None:
        reports.append(progress)
        seen.set()

    def handler(request: httpx.Request) -> httpx.Response:
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
    assert {report.path for report in reports} == {"/v1/rotation/wobble"}
    assert [report.done for report in reports] == [False] * (len(reports) - 1) + [True]
    assert [report.elapsed for report in reports] == sorted(report.elapsed for report in reports)


def test_the_line(capsys: pytest.CaptureFixture[str]) -> None:
    bar(Progress("/v1/scenes", 3.0))
    bar(Progress("/v1/scenes", 4.0, done=True))
    first, last = capsys.readouterr().err.split("\r")[1:]
    assert first == "/v1/scenes 3 s"
    assert last == "\033[K"
