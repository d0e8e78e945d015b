"""Questions in processes of their own: results, kills, deadlines, disconnects, overload."""

import asyncio
import os
import signal
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import orjson
import pytest

from service.app import Service
from service.http.keys import new_key
from tests.service.conftest import PATIENCE, client_of, inline_toys, toy_service
from tests.service.http.test_dispatch import JSON, receiving, scope, sending
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio

PAGE = "/page/vendor/swagger-ui-bundle.js"
"""A large one."""

LARGE = GOOD | {"times": {"start": 0.0, "stop": 1.0, "count": 500_000}}


async def until(holds: Callable[[], Any]) -> None:
    async with asyncio.timeout(PATIENCE):
        while not holds():
            await asyncio.sleep(0.002)


def working(service: Service) -> list[int]:
    """Return the compute processes that work on something."""
    return [pid for pid, busy in service.compute.processes.pids.items() if busy]


def sleeping(seconds: float) -> dict[str, Any]:
    return GOOD | {"behaviour": "sleep", "angular_velocity": [seconds, 1.0, 1.0]}


def spinning(seconds: float) -> dict[str, Any]:
    """Return a question that uses so much processor time (s)."""
    return GOOD | {"behaviour": "spin", "angular_velocity": [seconds, 1.0, 1.0]}


@pytest.fixture(scope="module")
async def service() -> AsyncIterator[Service]:
    # A busy machine takes seconds to replace a process that was killed.
    running = toy_service(compute_workers=2, deadline_seconds=20.0)
    async with running.lifespan():
        await until(lambda: running.warm)
        yield running


@pytest.fixture
async def client(service: Service) -> AsyncIterator[httpx.AsyncClient]:
    async with client_of(service) as open_client:
        yield open_client


async def test_ready_once_the_processes_are_up(client: httpx.AsyncClient) -> None:
    assert (await client.get("/readyz")).json() == {"status": "ready"}


async def test_large_results_come_back_whole(client: httpx.AsyncClient) -> None:
    answer = (await client.post("/v1/toy", json=LARGE)).json()
    np.testing.assert_array_equal(answer["time"], np.linspace(0, 1, 500_000))
    np.testing.assert_array_equal(np.array(answer["position"])[:, 0], 0.1 * np.linspace(0, 1, 500_000))


async def test_the_same_bytes_from_another_process(client: httpx.AsyncClient) -> None:
    elsewhere = await client.post("/v1/toy", json=sleeping(0.1))
    async with client_of(inline_toys()) as here:
        assert (await here.post("/v1/toy", json=sleeping(0.1))).content == elsewhere.content


async def test_large_bodies_are_read_elsewhere(client: httpx.AsyncClient) -> None:
    question = GOOD | {"times": [float(i) for i in range(900)]}
    assert (await client.post("/v1/toy", json=question)).json()["time"] == question["times"]
    bad = await client.post("/v1/toy", json=question | {"times": [*question["times"], None]})
    [fault] = bad.json()["errors"]
    assert (fault["pointer"], fault["detail"]) == ("/times/900", "must be a number")


@pytest.mark.parametrize(
    ("behaviour", "status", "code"), [("unreachable", 422, "accuracy-unreachable"), ("fail", 500, "internal-error")]
)
async def test_what_is_raised_elsewhere_is_answered_the_same(
    client: httpx.AsyncClient, behaviour: str, status: int, code: str
) -> None:
    question = {**LARGE, "behaviour": behaviour}
    response = await client.post("/v1/toy", json=question)
    assert (response.status_code, response.json()["code"]) == (status, code)
    assert "secret" not in response.text


async def test_a_killed_process_fails_its_own_question_only(client: httpx.AsyncClient, service: Service) -> None:
    bystander = asyncio.create_task(client.post("/v1/toy", json=sleeping(0.4)))
    await until(lambda: working(service))
    killed = await client.post("/v1/toy", json=GOOD | {"behaviour": "die"})
    assert (killed.status_code, killed.json()["code"]) == (503, "worker-lost")
    assert (await bystander).status_code == 200
    after = await asyncio.gather(*(client.post("/v1/toy", json=sleeping(0.05)) for _ in range(4)))
    assert [response.status_code for response in after] == [200] * 4
    await until(lambda: b"polhode_workers_lost_total 1.0" in service.metrics.exposition())


async def test_a_computation_past_its_deadline_is_stopped() -> None:
    running = toy_service(compute_workers=1, deadline_seconds=0.1)
    async with running.lifespan(), client_of(running) as client:
        await until(lambda: running.warm)
        response = await client.post("/v1/toy", json=spinning(60.0))
        assert (response.status_code, response.json()["code"]) == (503, "deadline-exceeded")
        assert "not answered in the background: ask for less" in response.json()["detail"]


async def test_what_uses_its_slice_is_answered_from_less_and_becomes_no_long_question(
    client: httpx.AsyncClient, service: Service
) -> None:
    for question, times in ((sleeping(0.0), 3), (sleeping(30.0), 1), (sleeping(60.0), 2)):
        answer = (await client.post("/v1/short", json=question)).json()
        assert len(answer["time"]) == times
    assert service.compute.processes.long == 0


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


async def ready(service: Service) -> None:
    """Wait until every process is there and has nothing to do."""
    await until(lambda: service.compute.processes.ready and not working(service))


async def test_a_client_that_leaves_stops_its_computation(service: Service) -> None:
    """The process that computes is killed: nothing goes on computing for nobody."""
    await ready(service)
    messages: list[dict[str, Any]] = []
    parts = iter([{"type": "http.request", "body": orjson.dumps(sleeping(0.9)), "more_body": False}])
    killed: list[int] = []

    async def receive() -> dict[str, Any]:
        for message in parts:
            return message
        await until(lambda: working(service))
        killed.extend(working(service))
        return {"type": "http.disconnect"}

    await service(scope("POST", "/v1/toy", JSON), receive, sending(messages))
    (pid,) = killed
    await until(lambda: not alive(pid))
    assert messages == []
    assert service.compute.processes.waiting == 0
    assert not working(service)


async def test_one_that_leaves_the_queue_is_never_begun(service: Service, client: httpx.AsyncClient) -> None:
    await ready(service)
    ahead = [asyncio.create_task(client.post("/v1/toy", json=sleeping(0.5))) for _ in range(2)]
    await until(lambda: len(working(service)) == 2)
    before = set(service.compute.processes.pids)
    parts = iter([{"type": "http.request", "body": orjson.dumps(sleeping(0.5)), "more_body": False}])

    async def receive() -> dict[str, Any]:
        return next(parts, {"type": "http.disconnect"})

    await service(scope("POST", "/v1/toy", JSON), receive, sending([]))
    assert [(await task).status_code for task in ahead] == [200, 200]
    # Others may have been started in the place of those that were moved to the long class.
    assert before <= set(service.compute.processes.pids)
    assert not any(service.compute.processes.pids.values())


async def test_idle_processes_that_are_killed_are_replaced_and_nobody_notices(
    service: Service, client: httpx.AsyncClient
) -> None:
    """All of them, three times in a row, with questions arriving the moment they die."""
    for _ in range(3):
        await ready(service)
        before = set(service.compute.processes.pids)
        for pid in before:
            os.kill(pid, signal.SIGKILL)
        responses = await asyncio.gather(*(client.post("/v1/toy", json=sleeping(0.02)) for _ in range(6)))
        assert [response.status_code for response in responses] == [200] * 6
        assert not before & set(service.compute.processes.pids)


async def test_every_process_killed_again_and_again_loses_nothing(service: Service, client: httpx.AsyncClient) -> None:
    """Each large question is answered in full or refused as lost; small ones never notice."""
    await ready(service)
    expected = (await client.post("/v1/toy", json=sleeping(0.1))).content
    outcomes: list[tuple[int, str]] = []
    small: list[int] = []

    async def large() -> None:
        for _ in range(8):
            response = await client.post("/v1/toy", json=sleeping(0.1))
            if response.status_code == 200:
                assert response.content == expected
            else:
                assert response.headers["retry-after"] == "1"
            outcomes.append((response.status_code, response.json().get("code", "")))

    async def little() -> None:
        while len(outcomes) < 24:
            small.append((await client.post("/v1/toy", json=GOOD)).status_code)
            await asyncio.sleep(0.005)

    async def killing() -> None:
        while len(outcomes) < 24:
            await asyncio.sleep(0.17)
            for pid in service.compute.processes.pids:
                os.kill(pid, signal.SIGKILL)
            while not service.compute.processes.ready:
                await asyncio.sleep(0.01)

    async with asyncio.timeout(PATIENCE):
        await asyncio.gather(large(), large(), large(), little(), killing())
    assert len(outcomes) == 24
    assert set(outcomes) == {(200, ""), (503, "worker-lost")}
    assert set(small) == {200}
    await ready(service)
    assert service.compute.processes.waiting == 0


async def test_where_no_process_can_be_started_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    running = toy_service(compute_workers=1, deadline_seconds=0.1)
    async with running.lifespan(), client_of(running) as client:
        await until(lambda: running.warm)

        def lacking() -> None:
            raise OSError(24, "Too many open files")

        monkeypatch.setattr("service.execution.process_starter.socket.socketpair", lacking)
        for pid in running.compute.processes.pids:
            os.kill(pid, signal.SIGKILL)
        await until(lambda: not running.compute.processes.pids)
        response = await client.post("/v1/toy", json=sleeping(0.1))
        assert (response.status_code, response.json()["code"]) == (503, "not-ready")
        assert response.headers["retry-after"] == "1"


async def test_a_question_that_takes_long_delays_no_other(client: httpx.AsyncClient, service: Service) -> None:
    """It is moved while it runs, and begins only once."""
    await ready(service)
    long = [asyncio.create_task(client.post("/v1/toy", json=sleeping(600.0))) for _ in range(3)]
    await until(lambda: service.compute.processes.long == 3)
    assert b"polhode_long 3.0" in service.metrics.exposition()
    assert (await client.post("/v1/toy", json=LARGE)).status_code == 200
    assert not any(task.done() for task in long)
    for task in long:
        task.cancel()
    await until(lambda: service.compute.processes.long == 0)
    text = service.metrics.exposition()
    assert b"polhode_moved_total 0.0" not in text
    assert b'polhode_used_seconds_total{key=""}' in text


async def test_memory_is_limited_for_each_process() -> None:
    """What needs more is refused; its process goes on."""
    running = toy_service(compute_workers=1, compute_memory_bytes=200_000_000)
    async with running.lifespan(), client_of(running) as client:
        await until(lambda: running.warm)
        before = set(running.compute.processes.pids)
        filling = GOOD | {"behaviour": "fill", "angular_velocity": [3e8, 1.0, 1.0]}
        response = await client.post("/v1/toy", json=filling)
        assert (response.status_code, response.json()["code"]) == (503, "no-room")
        assert "compute_memory_bytes" in response.json()["detail"]
        assert "retry-after" not in response.headers
        filling["angular_velocity"] = [1e7, 1.0, 1.0]
        assert (await client.post("/v1/toy", json=filling)).status_code == 200
        assert before <= set(running.compute.processes.pids)


async def test_all_kinds_of_documents_come_from_processes_as_from_here(client: httpx.AsyncClient) -> None:
    async with client_of(inline_toys()) as here:
        for question in (LARGE, sleeping(0.01)):
            for accept in ("application/json", "application/x-npz"):
                one = await client.post("/v1/toy", json=question, headers={"accept": accept})
                other = await here.post("/v1/toy", json=question, headers={"accept": accept})
                assert one.status_code == 200
                assert one.content == other.content
                assert one.headers["etag"] == other.headers["etag"]


async def test_a_client_with_too_many_questions_waiting_is_refused_another(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.execution.fair_shares.MOST_OF_A_CLIENT", 1)
    running = toy_service(compute_workers=1, max_waiting=2)
    async with running.lifespan(), client_of(running) as client:
        await until(lambda: running.warm)
        tasks = [asyncio.create_task(client.post("/v1/toy", json=sleeping(0.9))) for _ in range(12)]
        await until(lambda: sum(task.done() for task in tasks) == 9)
        refused = [task.result() for task in tasks if task.done()]
        assert {(response.status_code, response.json()["code"]) for response in refused} == {(429, "too-busy")}
        assert all(int(response.headers["retry-after"]) >= 1 for response in refused)
        assert "max_waiting" in refused[0].json()["detail"]
        # Small requests do not queue behind large ones.
        assert (await client.post("/v1/toy", json=GOOD)).status_code == 200
        assert sorted(response.status_code for response in await asyncio.gather(*tasks)) == [200] * 3 + [429] * 9
        assert running.compute.processes.waiting == 0


async def test_answers_that_one_client_does_not_read_refuse_no_other() -> None:
    """Several that are computed at the same time: each has 16 MB, of which one client may hold 10."""
    running = toy_service(compute_workers=2, max_held_bytes=20_000_000)
    async with running.lifespan():
        await until(lambda: running.warm)
        read = asyncio.Event()
        body = orjson.dumps(LARGE)

        async def post(address: str, reads: asyncio.Event) -> bytes:
            received: list[bytes] = []

            async def send(message: dict[str, Any]) -> None:
                if message["type"] == "http.response.start":
                    assert message["status"] == 200
                else:
                    await reads.wait()
                    received.append(message["body"])

            asked = scope("POST", "/v1/toy", JSON) | {"client": (address, 1)}
            await running(asked, receiving(body), send)
            return b"".join(received)

        many = [asyncio.create_task(post("10.0.0.1", read)) for _ in range(4)]
        await until(lambda: running.compute.held.total > 10_000_000 and running.compute.processes.unread)
        assert running.compute.held.total < 20_000_000
        eager = asyncio.Event()
        eager.set()
        answer = await post("10.0.0.2", eager)
        assert len(orjson.loads(answer)["time"]) == 500_000
        assert not any(task.done() for task in many)
        read.set()
        assert await asyncio.gather(*many) == [answer] * 4
        assert running.compute.held.total == 0


async def test_small_questions_and_pages_of_a_client_that_reads_nothing_are_refused() -> None:
    running = toy_service(compute_workers=1, max_held_bytes=1_000_000)
    async with running.lifespan(), client_of(running) as client:
        await until(lambda: running.warm)
        with running.compute.held.answering("127.0.0.1", 500_001):
            for response in (await client.post("/v1/toy", json=GOOD), await client.get(PAGE)):
                assert (response.status_code, response.json()["code"]) == (429, "too-busy")
            assert (await client.get("/healthz")).status_code == 200
        with running.compute.held.answering("127.0.0.2", 500_001):
            for response in (await client.post("/v1/toy", json=GOOD), await client.get(PAGE)):
                assert response.status_code == 200


async def test_a_page_is_counted_until_it_is_read(service: Service) -> None:
    read = asyncio.Event()
    held: list[int] = []

    async def send(message: dict[str, Any]) -> None:
        held.append(service.compute.held.total)
        if message["type"] == "http.response.body" and not message.get("more_body"):
            # uvicorn accepts nothing more until the client has taken most of what it has.
            await read.wait()

    task = asyncio.create_task(service(scope("GET", PAGE, {}), receiving(b""), send))
    await until(lambda: len(held) == 3)
    assert service.compute.held.total > 65_536
    read.set()
    await task
    assert service.compute.held.total == 0


async def test_one_clients_backlog_refuses_no_other(client: httpx.AsyncClient) -> None:
    """Whose turn comes after one request of the first."""
    running = toy_service(compute_workers=1, max_waiting=2)
    async with running.lifespan():
        await until(lambda: running.warm)

        async def post(address: str, seconds: float) -> int:
            messages: list[dict[str, Any]] = []
            parts = iter([{"type": "http.request", "body": orjson.dumps(sleeping(seconds)), "more_body": False}])
            leaves = asyncio.Event()

            async def receive() -> dict[str, Any]:
                for message in parts:
                    return message
                await leaves.wait()
                raise AssertionError

            asked = scope("POST", "/v1/toy", JSON) | {"client": (address, 1)}
            await running(asked, receive, sending(messages))
            return int(messages[0]["status"])

        many = [asyncio.create_task(post("10.0.0.1", 0.4)) for _ in range(10)]
        await until(lambda: sum(task.done() for task in many) >= 5)
        other = asyncio.create_task(post("10.0.0.2", 0.01))
        assert await other == 200
        assert not all(task.done() for task in many)
        assert 429 in await asyncio.gather(*many)


async def test_keys_are_charged_with_what_was_spent(tmp_path: Path) -> None:
    key, line = new_key("alpha")
    file = tmp_path / "keys"
    file.write_text(line.replace("- -", "- 0.1") + "\n")
    running = toy_service(compute_workers=1, keys_file=file)
    async with running.lifespan(), client_of(running) as client:
        await until(lambda: running.warm)
        head = {"authorization": f"Bearer {key}"}
        assert (await client.post("/v1/toy", json=spinning(0.03), headers=head)).status_code == 200
        # Time that a process only waits is not used.
        assert (await client.post("/v1/toy", json=sleeping(0.2), headers=head)).status_code == 200
        assert (await client.post("/v1/toy", json=GOOD, headers=head)).status_code == 200
        assert (await client.post("/v1/toy", json=spinning(0.3), headers=head)).status_code == 200
        assert (await client.post("/v1/toy", json=GOOD, headers=head)).json()["code"] == "quota-exceeded"


async def test_stopping_answers_what_is_in_flight() -> None:
    running = toy_service(compute_workers=1)
    async with client_of(running) as client:
        async with running.lifespan():
            await until(lambda: running.warm)
            waiting = asyncio.create_task(client.post("/v1/toy", json=sleeping(5.0)))
            await until(lambda: working(running))
        response = await waiting
        assert (response.status_code, response.json()["code"]) == (503, "shutting-down")
        assert (await client.post("/v1/toy", json=sleeping(0.1))).json()["code"] in ("shutting-down", "not-ready")
