"""Studies over HTTP: states, pages, archives, tables, grids, events; owners, limits and what cannot be stored."""

from __future__ import annotations

import asyncio
import csv
import io
import json
import os
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from math import inf
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from service.app import Service
from service.http.keys import Key, new_key
from service.http.request_context import RequestContext
from service.observability.metrics import Metrics
from service.problems import Refusal
from service.settings import Settings
from service.studies import resources
from service.studies.cluster import TRIED_AGAIN
from service.studies.database import DATABASE
from service.studies.folder import Ownership, data_folder
from service.studies.store import Store, identity_of
from service.studies.study import DISMISSED, Owner, Quotas
from service.studies.supervisor import Supervisor
from tests.service.conftest import INLINE, PATIENCE, client_of
from tests.service.observability.test_metrics import read
from tests.service.studies.conftest import UNIFORM, Desk
from tests.service.studies.toy_table import TABLE
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

TO_DELETE = "PRAGMA journal_mode=DELETE"
"""Needs the database for one process alone."""

GRID: dict[str, Any] = {
    "question": {"path": "/v1/toy", "request": GOOD},
    "vary": [
        {"pointer": "/angular_velocity/0", "min": 0.0, "max": 1.0, "count": 3},
        {"pointer": "/body/moments/2", "values": [3.0, 7.0]},
    ],
    "quantities": ["/position/2/0", "/position/1/1"],
}

PLAN: dict[str, Any] = {"path": "/v1/toy", "count": 1, "seconds": 1e-3, "bytes": 0, "together": False}
PLAN |= {"shape": [], "inputs": [], "figures": []}

STUDIES, MISSING = ("polhode_studies", ()), ("polhode_study_members_missing", ())

Desks = Callable[..., Desk]


@asynccontextmanager
async def client_at(folder: Path, **settings: Any) -> AsyncIterator[httpx.AsyncClient]:
    """Yield a client of a service whose studies nothing works on but this test."""
    folder.mkdir(exist_ok=True)
    ownership = Ownership(folder)
    taken = ownership.acquire()
    async with client_of(Service(Settings(data=str(folder), **INLINE, **settings), TABLE)) as client:
        yield client
    if taken:
        ownership.release()


async def submitted(client: httpx.AsyncClient, request: Any = GRID, **headers: str) -> str:
    response = await client.post("/v1/studies", json=request, headers=headers)
    assert response.status_code == 202, response.text
    assert response.headers["location"] == f"/v1/studies/{response.json()['jobID']}"
    assert response.json()["status"] == "accepted"
    return str(response.headers["location"])


@asynccontextmanager
async def finished(desk_on: Desks, address: str, folder: Path, request: Any = GRID) -> AsyncIterator[Any]:
    """Yield a client, and the address of a study that is finished."""
    async with client_at(folder) as client:
        place = await submitted(client, request)
        await asyncio.to_thread(desk_on(address, folder).work)
        yield client, place


async def test_a_study_from_submission_to_results(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    async with finished(desk_on, in_process, tmp_path) as (client, place):
        state = (await client.get(place)).json()
        assert (state["status"], state["progress"], state["done"], state["failed"]) == ("successful", 100, 6, 3)
        assert (state["count"], state["shape"], state["predicted_end"]) == (6, [3, 2], None)
        assert state["inputs"][0] == {"pointer": "/angular_velocity/0", "unit": "rad s^-1", "levels": 3}
        assert {link["rel"] for link in state["links"]} == {"self", "events", "results"}
        for link in state["links"]:
            if link["rel"] == "results":
                answer = await client.get(link["href"], headers={"accept": link["type"]})
                assert (answer.status_code, answer.headers["content-type"]) == (200, link["type"])
        found = (await client.get(f"{place}/results")).json()
        assert found["inputs"] == {
            "/angular_velocity/0": [0.0, 0.0, 0.5, 0.5, 1.0, 1.0],
            "/body/moments/2": [3.0, 7.0] * 3,
        }
        assert found["figures"]["/position/2/0"] == [0.0, None, 0.5, None, 1.0, None]
        assert found["failures"] == [{"member": k, "code": "unphysical-inertia"} for k in (1, 3, 5)]
        statistics = found["statistics"]["figures"]["/position/2/0"]
        assert (statistics["mean"], statistics["std"], statistics["max"]) == (0.5, 0.5, {"value": 1.0, "member": 4})
        assert found["statistics"]["failures"] == {"unphysical-inertia": 3}
        listed = (await client.get("/v1/studies")).json()["studies"]
        assert [entry["jobID"] for entry in listed] == [state["jobID"]]


LATER = {"prefer": "wait=5, respond-async", "content-type": "application/json"}


async def test_an_answer_in_the_background_has_the_bytes_of_the_answer(
    desk_on: Desks, in_process: str, tmp_path: Path
) -> None:
    body = json.dumps(GOOD).encode()
    async with client_at(tmp_path) as client:
        response = await client.post("/v1/toy", content=body, headers=LATER)
        assert (response.status_code, response.headers["preference-applied"]) == (202, "respond-async")
        place = response.headers["location"]
        assert (await client.get(f"{place}/results")).json()["code"] == "results-not-ready"
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        state = (await client.get(place)).json()
        assert (state["status"], state["count"], state["progress"], state["figures"]) == ("successful", 1, 100, [])
        (link,) = (link for link in state["links"] if link["rel"] == "results")
        found = await client.get(link["href"])
        assert found.headers["content-type"] == "application/json"
        assert found.content == (await client.post("/v1/toy", json=GOOD)).content
        # What it takes is known when it is there.
        assert state["bytes"] > len(found.content)
        assert (await client.get(f"{link['href']}?start=0")).status_code == 422
        assert (await client.get(link["href"], headers={"accept": "application/x-npz"})).status_code == 406


@pytest.mark.parametrize("behaviour", ["unreachable", "fail"])
async def test_an_answer_in_the_background_that_there_is_not_has_failed(
    desk_on: Desks, in_process: str, tmp_path: Path, behaviour: str
) -> None:
    async with client_at(tmp_path) as client:
        response = await client.post("/v1/toy", json=GOOD | {"behaviour": behaviour}, headers=LATER)
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        state = (await client.get(response.headers["location"])).json()
        code = {"unreachable": "accuracy-unreachable", "fail": "internal-error"}[behaviour]
        assert (state["status"], state["message"].split(":")[0]) == ("failed", code)


async def test_what_is_wrong_with_a_request_is_said_before_it_is_put_off(tmp_path: Path) -> None:
    async with client_at(tmp_path) as client:
        response = await client.post("/v1/toy", json=GOOD | {"behaviour": "absent"}, headers=LATER)
        assert (response.status_code, response.json()["errors"][0]["pointer"]) == (422, "/behaviour")
        assert (await client.get("/v1/studies")).json()["studies"] == []
        # A preference that cannot be met is ignored (RFC 7240, 2).
        archive = {**LATER, "accept": "application/x-npz"}
        assert (await client.post("/v1/toy", json=GOOD, headers=archive)).status_code == 200


@pytest.mark.parametrize("place", ["/v1/studies/{study}", "/v1/studies/{study}/results", "/v1/studies/{study}/events"])
async def test_a_path_as_it_is_documented_is_no_study(tmp_path: Path, place: str) -> None:
    async with client_at(tmp_path) as client:
        assert (await client.get(place)).status_code == 404
        assert (await client.delete("/v1/studies/{study}")).status_code == 404


async def test_results_page_by_page(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    async with finished(desk_on, in_process, tmp_path, UNIFORM) as (client, place):
        whole = (await client.get(f"{place}/results?count=10000")).json()
        after, pages = f"{place}/results?count=70", []
        while after:
            pages.append((await client.get(after)).json())
            after = pages[-1]["next"]
        assert [page["start"] for page in pages] == [0, 70, 140, 210, 280]
        for name in ("inputs", "figures"):
            for pointer, column in whole[name].items():
                assert [entry for page in pages for entry in page[name][pointer]] == column
        for query in (
            "start=300",
            "count=0",
            "count=10001",
            "start=-1",
            "start=1.5",
            "start=",
            "first=1",
            "count=1&count=2",
        ):
            response = await client.get(f"{place}/results?{query}")
            assert (response.status_code, response.json()["code"]) == (422, "invalid-parameter"), query


async def test_all_results_as_an_archive_a_table_and_a_grid(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    import xarray
    import zarr
    from pyarrow import parquet

    async with finished(desk_on, in_process, tmp_path) as (client, place):
        page = (await client.get(f"{place}/results")).json()
        expected = [page["figures"]["/position/2/0"][k] for k in range(6)]
        figures = np.array([np.nan if entry is None else entry for entry in expected])
        archive = np.load(io.BytesIO((await get(client, place, "application/x-npz")).content))
        assert np.array_equal(archive["figures"][:, 0], figures, equal_nan=True)
        about = json.loads(archive["metadata.json"])
        assert archive["failures"].tolist() == [0, 1, 0, 1, 0, 1]
        assert about["failure_names"] == ["unphysical-inertia"]
        rows = parquet.read_table(io.BytesIO((await get(client, place, "application/vnd.apache.parquet")).content))
        assert rows["/position/2/0"].to_pylist() == expected
        assert rows["failure"].to_pylist() == [None, "unphysical-inertia"] * 3
        assert json.loads(rows.schema.metadata[b"units"])["/angular_velocity/0"] == "rad s^-1"
        file = tmp_path / "grid.zip"
        file.write_bytes((await get(client, place, "application/vnd.zarr+zip")).content)
        with zarr.storage.ZipStore(file, mode="r") as store:
            grid = xarray.open_zarr(store, consolidated=False).load()
        assert grid["position_2_0"].dims == ("angular_velocity_0", "moments_2")
        assert np.array_equal(grid["position_2_0"].to_numpy().ravel(), figures, equal_nan=True)
        assert grid["moments_2"].to_numpy().tolist() == [3.0, 7.0]
        assert grid["angular_velocity_0"].attrs["units"] == "rad s^-1"
        figure = await get(client, place, "image/svg+xml")
        assert figure.headers["content-type"] == "image/svg+xml"
        assert figure.content.startswith(b"<svg")
        table = [*csv.reader((await client.get(f"{place}/results.csv")).text.splitlines())]
        assert table[0] == [
            "member",
            "/angular_velocity/0",
            "/body/moments/2",
            *GRID["quantities"],
            "failure",
            "warnings",
        ]
        assert [row[3] for row in table[1:]] == ["" if entry is None else str(entry) for entry in expected]
        assert [row[5] for row in table[1:]] == ["", "unphysical-inertia"] * 3
        assert [(row[1], row[2]) for row in table[1:3]] == [("0.0", "3.0"), ("0.0", "7.0")]
        assert (await get(client, place, "text/html")).status_code == 406
        for query in ("start=1", "count=2", "first=1", "start"):
            everything = {"accept": "application/x-npz"}
            response = await client.get(f"{place}/results?{query}", headers=everything)
            assert (response.status_code, response.json()["code"]) == (422, "invalid-parameter"), query
            assert response.json()["errors"][0]["pointer"] == f"?{query.partition('=')[0]}"


async def get(client: httpx.AsyncClient, place: str, media: str) -> httpx.Response:
    return await client.get(f"{place}/results", headers={"accept": media})


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> asyncio.Event:
    """What is set when a stream of events has begun."""
    begun, events = asyncio.Event(), RequestContext.events

    async def noted(self: RequestContext, *arguments: Any) -> None:
        begun.set()
        await events(self, *arguments)

    monkeypatch.setattr(RequestContext, "events", noted)
    return begun


async def test_events_tell_every_state_until_the_end(
    desk_on: Desks, in_process: str, tmp_path: Path, watched: asyncio.Event
) -> None:
    async with client_at(tmp_path) as client:
        place = await submitted(client)
        watching = asyncio.create_task(client.get(f"{place}/events"))
        await watched.wait()
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        response = await watching
        assert response.headers["content-type"] == "text/event-stream"
        events = [event.split("\n") for event in response.text.strip().split("\n\n")]
        assert events[0][0] == "event: accepted"
        assert events[-1][0] == "event: successful"
        assert json.loads(events[-1][1].removeprefix("data: "))["done"] == 6


async def test_those_who_watch_one_study_share_the_looks_at_it(
    desk_on: Desks, in_process: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks = 0
    get = Store.get

    def counted(self: Store, *arguments: Any) -> Any:
        nonlocal looks
        looks += 1
        return get(self, *arguments)

    watchers = 40
    async with client_at(tmp_path) as client:
        place = await submitted(client)
        monkeypatch.setattr(Store, "get", counted)
        watching = [asyncio.create_task(client.get(f"{place}/events")) for _ in range(watchers)]
        await asyncio.sleep(1.2)
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        responses = await asyncio.gather(*watching)
    assert all("event: successful" in response.text for response in responses)
    # One for each that begins, and then some for all; on its own, each would have looked four times a second.
    assert looks < 3 * watchers


async def test_a_dismissed_study_has_no_results_and_a_finished_one_is_removed(
    desk_on: Desks, in_process: str, tmp_path: Path
) -> None:
    async with finished(desk_on, in_process, tmp_path) as (client, place):
        assert (await client.delete(place)).status_code == 200
        assert (await client.get(place)).json()["code"] == "not-found"
        assert not [*(tmp_path / "studies").iterdir()]
        other = await submitted(client)
        early = await client.get(f"{other}/results")
        assert (early.status_code, early.json()["code"]) == (404, "results-not-ready")
        assert "retry-after" in early.headers
        assert (await client.delete(other)).json()["status"] == "dismissed"
        late = await client.get(f"{other}/results")
        assert (late.status_code, "retry-after" in late.headers) == (404, False)


async def test_results_that_are_damaged_are_computed_again(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    async with finished(desk_on, in_process, tmp_path) as (client, place):
        before = (await client.get(f"{place}/results")).json()
        (file,) = (tmp_path / "studies").rglob("*.npz")
        file.write_bytes(file.read_bytes()[:-20])
        damaged = await client.get(f"{place}/results")
        assert (damaged.status_code, damaged.json()["code"]) == (404, "results-not-ready")
        assert (await client.get(place)).json()["status"] == "running"
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        assert (await client.get(f"{place}/results")).json() == before


async def test_a_damaged_row_harms_no_other_study(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    import sqlite3

    async with finished(desk_on, in_process, tmp_path) as (client, place):
        before = (await client.get(f"{place}/results")).json()
        others = [(await submitted(client)).rpartition("/")[2] for _ in range(3)]
        changes = ("plan = '{'", "plan = '{}'", "status = 'odd'")
        with sqlite3.connect(tmp_path / "studies.sqlite") as database:
            for change, identity in zip(changes, others, strict=True):
                database.execute(f"UPDATE studies SET {change} WHERE id = ?", (identity,))
            database.execute("DELETE FROM chunks")
        listed = (await client.get("/v1/studies")).json()["studies"]
        assert [entry["jobID"] for entry in listed] == [before["jobID"]]
        for identity in others:
            assert (await client.get(f"/v1/studies/{identity}")).status_code == 404
        # The record of its results is gone: they are computed again, and so is another study.
        assert (await client.get(f"{place}/results")).json()["code"] == "results-not-ready"
        new = await submitted(client)
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        assert (await client.get(f"{place}/results")).json() == before
        assert (await client.get(new)).json()["status"] == "successful"


async def test_a_key_sees_its_own_studies_and_is_charged(tmp_path: Path) -> None:
    lines, secrets = [], {}
    for name, work in (("ada", "60"), ("bob", "-")):
        secrets[name], line = new_key(name)
        lines.append(line.rsplit(" ", 1)[0] + f" {work}\n")
    (tmp_path / "keys").write_text("".join(lines))
    ada, bob = ({"authorization": f"Bearer {secrets[name]}"} for name in ("ada", "bob"))
    async with client_at(tmp_path / "data", keys_file=tmp_path / "keys") as client:
        assert (await client.get("/v1/studies")).status_code == 401
        assert (await client.post("/v1/studies", json=GRID)).status_code == 401
        place = await submitted(client, **ada)
        assert (await client.get(place, headers=ada)).status_code == 200
        for method in ("GET", "DELETE"):
            assert (await client.request(method, place, headers=bob)).status_code == 404
        for part in ("/results", "/events"):
            assert (await client.get(place + part, headers=bob)).status_code == 404
        assert (await client.get("/v1/studies", headers=bob)).json()["studies"] == []
        # About a thousand seconds of work, of which this key has one a second.
        large = {**UNIFORM, "count": 3_000_000}
        await submitted(client, large, **ada)
        spent = await client.post("/v1/studies", json=large, headers=ada)
        assert (spent.status_code, spent.json()["code"]) == (429, "quota-exceeded")
        await submitted(client, large, **bob)


@pytest.mark.parametrize(("predicted", "took", "left"), [(1e5, 1.0, True), (0.0, 1e5, False)])
async def test_a_key_is_charged_what_a_study_took(tmp_path: Path, predicted: float, took: float, left: bool) -> None:
    supervisor, key = Supervisor(Settings(data=str(tmp_path)), TABLE, Metrics()), Key("ada", inf, 60.0, 1)
    identity = supervisor.store.create(Owner("ada"), b"{}", PLAN, Quotas(100, 100, 10**9))
    key.charge(predicted)
    supervisor.charge(identity, key, predicted)
    supervisor.store.add_chunk(identity, 0, 1, 0, took)
    supervisor.store.end(identity, DISMISSED, "")

    def admitted() -> bool:
        try:
            key.work(1e-3)
        except Refusal:
            return False
        return True

    watch = asyncio.create_task(supervisor.watch())
    async with asyncio.timeout(PATIENCE):
        while admitted() is not left:
            await asyncio.sleep(0.01)
    watch.cancel()
    supervisor.store.close()


@pytest.mark.parametrize(
    ("changes", "settings", "code", "pointer"),
    [
        ({}, {"max_study_members": 5}, "budget-exceeded", "/vary"),
        ({}, {"max_study_seconds": 1e-6}, "budget-exceeded", "/vary"),
        ({"quantities": ["/absent"]}, {}, "invalid-parameter", "/quantities/0"),
        ({"quantities": ["/position/0"]}, {}, "invalid-parameter", "/quantities/0"),
        ({"quantities": ["/position/0/0", "/position/1/0"] * 2}, {}, "invalid-parameter", "/quantities/2"),
        ({"quantities": []}, {}, "invalid-parameter", "/quantities"),
        ({"statistics": ["mean"] * 7}, {}, "invalid-parameter", "/statistics"),
        ({"vary": []}, {}, "invalid-parameter", "/vary"),
        ({"vary": [{"pointer": "/nowhere", "values": [1.0]}]}, {}, "invalid-parameter", "/vary/0/pointer"),
        (
            {"vary": [{"pointer": "/angular_velocity/0", "min": 0.0, "max": 1.0}]},
            {},
            "invalid-parameter",
            "/vary/0/count",
        ),
        ({"design": "zip"}, {}, "invalid-parameter", "/vary/1"),
        ({"design": "random"}, {}, "invalid-parameter", "/count"),
        (
            {
                "design": "random",
                "vary": [{"pointer": "/angular_velocity/0", "min": 0.5, "max": 1.5}],
                "count": 10_000_001,
            },
            {},
            "budget-exceeded",
            "/count",
        ),
        ({"question": {"path": "/v1/studies", "request": {}}}, {}, "invalid-parameter", "/question/path"),
        ({"question": {"path": "/v1/toy", "request": {}}}, {}, "invalid-parameter", "/question/request/body"),
        (
            {"vary": [*GRID["vary"], {"pointer": "/angular_velocity", "values": [[1.0, 0.0, 0.0]]}]},
            {},
            "invalid-parameter",
            "/vary/2/pointer",
        ),
    ],
)
async def test_what_is_refused_is_not_stored(
    tmp_path: Path, changes: Any, settings: Any, code: str, pointer: str
) -> None:
    async with client_at(tmp_path, **settings) as client:
        response = await client.post("/v1/studies", json=GRID | changes)
        assert (response.status_code, response.json()["code"]) == (422, code), response.text
        assert response.json()["errors"][0]["pointer"].startswith(pointer)
        assert (await client.get("/v1/studies")).json()["studies"] == []


async def test_unfinished_studies_are_limited(tmp_path: Path) -> None:
    async with client_at(tmp_path, max_studies=2) as client:
        places = [await submitted(client) for _ in range(2)]
        assert (await client.post("/v1/studies", json=GRID)).json()["code"] == "too-busy"
        await client.delete(places[0])
        await submitted(client)


async def test_one_address_has_a_share_of_studies_and_of_event_streams(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, watched: asyncio.Event
) -> None:
    async with client_at(tmp_path, max_address_studies=1) as client:
        place = await submitted(client)
        refused = await client.post("/v1/studies", json=GRID)
        assert refused.json()["code"] == "too-busy"
        assert "max_address_studies" in refused.json()["detail"]
        monkeypatch.setattr(resources, "MOST_WATCHED_BY_ONE", 1)
        watching = asyncio.create_task(client.get(f"{place}/events"))
        await watched.wait()
        assert (await client.get(f"{place}/events")).json()["code"] == "too-busy"
        await client.delete(place)
        assert "event: dismissed" in (await watching).text
        assert "event: dismissed" in (await client.get(f"{place}/events")).text


@pytest.mark.parametrize("media", ["application/json", "application/x-npz", "text/csv"])
async def test_results_count_among_the_answers_that_their_client_reads(
    desk_on: Desks, in_process: str, tmp_path: Path, media: str
) -> None:
    async with finished(desk_on, in_process, tmp_path) as (client, place):
        held = client._transport.app.compute.held
        for address, status in (("127.0.0.1", 429), ("192.0.2.1", 200)):
            with held.answering(address, 200_000_000):
                answer = await client.get(f"{place}/results", headers={"accept": media})
                assert answer.status_code == status
        assert held.total == 0


def test_one_client_has_half_of_the_bytes(tmp_path: Path) -> None:
    store, plan, most = Store(tmp_path), {"count": 1, "bytes": 400}, Quotas(9, 9, 1000)
    store.create(Owner("", "192.0.2.1"), b"{}", plan, most)
    with pytest.raises(Refusal, match="one client's share"):
        store.create(Owner("", "192.0.2.1"), b"{}", plan, most)
    store.create(Owner("", "192.0.2.2"), b"{}", plan, most)
    with pytest.raises(Refusal, match="the limit max_studies_bytes"):
        store.create(Owner("another"), b"{}", plan, most)
    store.close()


def test_requests_are_stored_compressed_and_given_back_to_the_file_system(tmp_path: Path) -> None:
    sent = b'{"vary": [' + b" " * 8_000_000 + b"]}"
    store, most = Store(tmp_path), Quotas(100, 100, 10**9)
    for _ in range(5):
        identity = store.create(Owner(""), sent, {"count": 1, "bytes": 0}, most)
        assert store.request(identity) == sent
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) < 1_000_000
    noise = np.random.default_rng(3).bytes(2_000_000)
    identity = store.create(Owner(""), noise, {"count": 1, "bytes": 0}, most)
    with pytest.raises(Refusal, match="max_studies_bytes"):
        store.create(Owner(""), noise, {"count": 1, "bytes": 0}, Quotas(100, 100, 3_000_000))
    store.remove(identity)
    store.close()
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) < 1_000_000


def test_a_store_that_opens_leaves_the_locks_of_another_in_its_process(tmp_path: Path) -> None:
    """Another process cannot change the mode of the database then (sqlite.org/howtocorrupt.html, 2.2)."""
    first, second = Store(tmp_path), Store(tmp_path)
    first.create(Owner(""), b"{}", {"count": 1, "bytes": 0}, Quotas(9, 9, 10**6))
    second.create(Owner(""), b"{}", {"count": 1, "bytes": 0}, Quotas(9, 9, 10**6))
    second.close()
    change = f"import sqlite3; sqlite3.connect({str(tmp_path / DATABASE)!r}, timeout=0).execute('{TO_DELETE}')"
    outcome = subprocess.run([sys.executable, "-c", change], capture_output=True, text=True)
    assert "database is locked" in outcome.stderr
    first.close()


async def test_what_is_stored_is_readable_by_its_owner_alone(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    folder = tmp_path / "data"
    before = os.umask(0)
    try:
        Store(folder).unfinished()
        async with finished(desk_on, in_process, folder):
            places = [*folder.glob("studies.sqlite*"), *(folder / "studies").iterdir(), folder / "studies"]
            assert len(places) >= 3
            assert {path.name: path.stat().st_mode & 0o077 for path in places if path.stat().st_mode & 0o077} == {}
    finally:
        os.umask(before)


async def test_dismissed_studies_are_removed_within_minutes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    supervisor = Supervisor(Settings(data=str(tmp_path)), TABLE, Metrics())
    async with client_at(tmp_path) as client:
        kept, place = await submitted(client), await submitted(client)
        await client.delete(place)
        supervisor.clean()
        assert (await client.get(place)).json()["status"] == "dismissed"
        now = time.time()
        monkeypatch.setattr(time, "time", lambda: now + 180.0)
        supervisor.clean()
        assert (await client.get(place)).status_code == 404
        assert (await client.get(kept)).status_code == 200


async def test_stored_bytes_are_limited_until_results_are_removed(
    desk_on: Desks, in_process: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # How many files results have depends on the time that a member takes.
    monkeypatch.setattr("service.routes.studies.members.FILES_PER_SECOND", 0.0)
    async with client_at(tmp_path, max_studies_bytes=80_000) as client:
        first = await submitted(client, UNIFORM)
        state = (await client.get(first)).json()
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        stored = sum(file.stat().st_size for file in (tmp_path / "studies").rglob("*.npz"))
        # Two inputs and two figures of 300 members, their labels, and what a file has beside them.
        assert 300 * 36 < stored <= state["bytes"] < 20_000
        await submitted(client, UNIFORM)
        await submitted(client, GRID)
        refused = await client.post("/v1/studies", json=UNIFORM)
        assert (refused.status_code, refused.json()["code"]) == (503, "storage-unavailable")
        assert "max_studies_bytes" in refused.json()["detail"]
        assert len((await client.get("/v1/studies")).json()["studies"]) == 3
        await client.delete(first)
        await submitted(client, UNIFORM)


async def test_a_plan_tells_the_price_before(tmp_path: Path) -> None:
    async with client_at(tmp_path) as client:
        state = (await client.post("/v1/studies", json=UNIFORM)).json()
        assert state["count"] == 300
        assert state["predicted_seconds"] > 0.0


async def test_a_folder_that_cannot_be_used_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    service = Service(Settings(data=str(tmp_path / "file" / "data"), **INLINE), TABLE)
    async with client_of(service) as client:
        response = await client.post("/v1/studies", json=GRID)
        assert (response.status_code, response.json()["code"]) == (503, "storage-unavailable")
        assert "Not a directory" in response.json()["detail"]


async def test_results_that_cannot_be_stored_anywhere_are_refused_before(tmp_path: Path) -> None:
    async with client_at(tmp_path, studies_results="nowhere://user:secret@results") as client:
        response = await client.post("/v1/studies", json=GRID)
        assert "nowhere" not in response.text
        assert (response.status_code, response.json()["code"]) == (503, "storage-unavailable")
        assert (await client.get("/v1/studies")).json()["studies"] == []


async def test_storage_that_cannot_be_reached_is_said(
    desk_on: Desks, in_process: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unreachable(*arguments: Any) -> Any:
        raise OSError("https://user:secret@store.example does not answer")

    async with finished(desk_on, in_process, tmp_path) as (client, place):
        monkeypatch.setattr("service.studies.chunk_files.ChunkFiles.read", unreachable)
        monkeypatch.setattr("service.studies.chunk_files.ChunkFiles.remove", unreachable)
        for media in ("application/json", "application/x-npz", "image/svg+xml"):
            response = await get(client, place, media)
            assert (response.status_code, response.json()["code"]) == (503, "storage-unavailable"), media
            assert "secret" not in response.text
        assert (await client.delete(place)).json()["code"] == "storage-unavailable"


async def test_a_full_disk_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import sqlite3

    def full(*arguments: Any, **settings: Any) -> Any:
        raise sqlite3.OperationalError("database or disk is full")

    async with client_at(tmp_path) as client:
        monkeypatch.setattr("service.studies.store.sqlite3.connect", full)
        response = await client.post("/v1/studies", json=GRID)
        assert (response.status_code, response.json()["code"]) == (503, "storage-unavailable")
        assert "disk is full" in response.json()["detail"]


async def test_a_folder_that_cannot_be_written_to_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import sqlite3

    def unable(*arguments: Any, **settings: Any) -> Any:
        raise sqlite3.OperationalError("unable to open database file")

    async with client_at(tmp_path) as client:
        monkeypatch.setattr("service.studies.store.sqlite3.connect", unable)
        # Tests may run as root, whom no permission stops.
        monkeypatch.setattr("service.studies.store.os.access", lambda folder, wish: False)
        response = await client.post("/v1/studies", json=GRID)
        assert (response.status_code, response.json()["code"]) == (503, "storage-unavailable")
        assert "cannot be written to" in response.json()["detail"]


async def test_a_request_that_is_repeated_is_one_study(tmp_path: Path) -> None:
    async with client_at(tmp_path) as client:
        first, again = [await submitted(client, GRID, **{"idempotency-key": "a"}) for _ in range(2)]
        other = await submitted(client, GRID, **{"idempotency-key": "b"})
        assert first == again != other
        changed = await client.post(
            "/v1/studies", json=GRID | {"quantities": ["/time/0"]}, headers={"idempotency-key": "a"}
        )
        assert (changed.status_code, changed.json()["code"]) == (422, "idempotency-key-reused")
        long = await client.post("/v1/studies", json=GRID, headers={"idempotency-key": 256 * "a"})
        assert (long.status_code, long.json()["errors"][0]["pointer"]) == (422, "Idempotency-Key")
        # The same name of another client is another study.
        assert identity_of(Owner("", "192.0.2.1"), b"a") != identity_of(Owner("", "192.0.2.2"), b"a")


async def test_studies_are_listed_in_pages_and_orders(tmp_path: Path) -> None:
    async with client_at(tmp_path) as client:
        made = [(await submitted(client)).rpartition("/")[2] for _ in range(5)]
        found: list[str] = []
        place = "/v1/studies?count=2&sort=created"
        while place:
            page = (await client.get(place)).json()
            found += [study["jobID"] for study in page["studies"]]
            place = page["next"]
        assert found == made
        latest = (await client.get("/v1/studies?count=3")).json()["studies"]
        assert [study["jobID"] for study in latest] == made[:1:-1]
        unstarted = (await client.get("/v1/studies?sort=-started")).json()["studies"]
        assert [(study["started"], study["jobID"]) for study in unstarted] == [(None, name) for name in made]
        for query in ("sort=name", "count=0", "start=-1", "page=2", "count=1&count=2"):
            refused = await client.get(f"/v1/studies?{query}")
            assert (refused.status_code, refused.json()["errors"][0]["pointer"]) == (422, "?" + query.partition("=")[0])
        unknown = (await client.get("/v1/studies?limit=2")).json()["errors"][0]
        assert unknown["remedy"] == "known here: start, count, sort"


async def test_archives_and_other_documents_are_no_requests(tmp_path: Path) -> None:
    async with client_at(tmp_path) as client:
        headers = {"content-type": "application/x-npz"}
        assert (await client.post("/v1/studies", content=b"PK", headers=headers)).status_code == 415
        assert (await client.post("/v1/studies", json=GRID, headers={"accept": "text/html"})).status_code == 406
        assert (await client.put("/v1/studies", json=GRID)).status_code == 405
        other = await client.patch("/v1/studies/of-somebody")
        assert (other.status_code, other.headers["allow"]) == (405, "GET, HEAD, DELETE, OPTIONS")


async def test_old_studies_are_removed(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    async with finished(desk_on, in_process, tmp_path) as (client, place):
        Supervisor(Settings(data=str(tmp_path)), TABLE, Metrics()).clean()
        assert (await client.get(place)).status_code == 200
        Supervisor(Settings(data=str(tmp_path), studies_keep_days=1e-12), TABLE, Metrics()).clean()
        assert (await client.get(place)).status_code == 404
        assert not [*(tmp_path / "studies").iterdir()]


async def test_unfinished_studies_are_counted(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    metrics = Metrics()

    async def counted(*expected: float) -> None:
        watch = asyncio.create_task(Supervisor(Settings(data=str(tmp_path)), TABLE, metrics).watch())
        try:
            async with asyncio.timeout(PATIENCE):
                while (read(metrics.exposition())[STUDIES], read(metrics.exposition())[MISSING]) != expected:
                    await asyncio.sleep(0.01)
        finally:
            watch.cancel()

    async with client_at(tmp_path) as client:
        await submitted(client)
        await counted(1.0, 6.0)
        await asyncio.to_thread(desk_on(in_process, tmp_path).work)
        await counted(0.0, 0.0)


def test_ids_are_long_and_random(tmp_path: Path) -> None:
    store = Store(tmp_path)
    ids = {store.create(Owner(""), b"{}", {"count": 1, "bytes": 0}, Quotas(100, 100, 10**4)) for _ in range(9)}
    store.close()
    assert len(ids) == 9
    assert all(len(identity) == 24 for identity in ids)


def test_a_checkout_has_a_folder_of_data_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folders = []
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "pyproject.toml").touch()
        monkeypatch.setattr("service.studies.folder.CHECKOUT", tmp_path / name)
        folders.append(data_folder(Settings(data="")))
    assert folders == [tmp_path / "one" / ".data", tmp_path / "other" / ".data"]
    # An installed package has the user's.
    monkeypatch.setattr("service.studies.folder.CHECKOUT", tmp_path)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "share"))
    assert data_folder(Settings(data="")) == tmp_path / "share" / "polhode"


def test_one_process_at_a_time_owns_a_folder(tmp_path: Path) -> None:
    first, second = Ownership(tmp_path), Ownership(tmp_path)
    assert first.acquire()
    assert second.taken
    assert not second.acquire()
    first.release()
    assert second.acquire()


async def test_that_a_scheduler_cannot_be_reached_is_said_before_anything_works_on_it(
    tmp_path: Path, silent: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.studies.cluster.ANSWERING", 0.1)
    async with client_at(tmp_path) as client:
        place = await submitted(client)
        watch = asyncio.create_task(Supervisor(Settings(data=str(tmp_path), dask=silent), TABLE, Metrics()).watch())
        while not (state := (await client.get(place)).json())["message"]:
            await asyncio.sleep(0.02)
        watch.cancel()
        assert (state["status"], state["message"]) == ("accepted", f"{TRIED_AGAIN}: it cannot be reached")
