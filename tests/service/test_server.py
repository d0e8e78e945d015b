"""A real server process on a free port, asked as clients ask, and as they should not."""

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from polhode_client import Client, Refused

from tests.service import hostile
from tests.service.conftest import PATIENCE, ROOT, Server

PATH = "/v1/rotation/trajectory"
JSON = {"content-type": "application/json"}
T_HANDLE = {"kind": "principal-moments", "moments": [795.792181070, 713.509259259, 395.782921811]}


def post(server: Server, body: bytes, headers: dict[str, str] = JSON) -> tuple[int, dict[str, str], bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE)
    try:
        connection.request("POST", PATH, body, headers)
        response = connection.getresponse()
        return response.status, dict(response.getheaders()), response.read()
    finally:
        connection.close()


def raw(server: Server, *pieces: bytes) -> bytes:
    """Send bytes and return all that comes back."""
    with socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE) as connection:
        for piece in pieces:
            connection.sendall(piece)
        received = b""
        while True:
            try:
                more = connection.recv(65536)
            except ConnectionError:
                return received
            if not more:
                return received
            received += more


def test_the_t_handle_tumbles_as_it_should(server: Server) -> None:
    with Client(server.url) as polhode:
        answer = polhode.rotation_trajectory(
            body=T_HANDLE,
            angular_velocity=[1, 10, 1],
            times={"start": 0, "stop": 20, "count": 10_000},
            attitude=[1, 0, 0, 0],
        )
    assert answer["flip_interval"] == pytest.approx(2.453763074, rel=1e-8)
    assert answer["accuracy"]["error"] <= 1e-9
    omega, attitude = np.array(answer["angular_velocity"]), np.array(answer["attitude"])
    assert omega.shape == (10_000, 3)
    np.testing.assert_allclose(np.linalg.norm(attitude, axis=1), 1.0, rtol=1e-14)
    # The angular momentum does not turn in space.
    momentum = omega * np.array(T_HANDLE["moments"])
    w, v = attitude[:, :1], attitude[:, 1:]
    in_space = momentum + 2 * np.cross(v, np.cross(v, momentum) + w * momentum)
    np.testing.assert_allclose(
        in_space, np.broadcast_to(momentum[0], in_space.shape), rtol=0, atol=1e-11 * np.abs(momentum).max()
    )


@pytest.mark.parametrize(
    ("body", "status", "code", "pointer"), [case[1:] for case in hostile.CASES], ids=[case[0] for case in hostile.CASES]
)
def test_hostile_bodies(server: Server, body: bytes, status: int, code: str, pointer: str | None) -> None:
    found, headers, content = post(server, body)
    document = json.loads(content)
    assert (found, document["code"]) == (status, code), content[:500]
    assert headers["content-type"] == "application/problem+json"
    assert len(content) <= 2048
    assert b"Traceback" not in content
    if pointer is not None:
        assert pointer in [fault["pointer"] for fault in document["errors"]], content[:500]


@pytest.mark.parametrize(
    ("headers", "status", "code"), [row[1:] for row in hostile.HEADERS], ids=[row[0] for row in hostile.HEADERS]
)
def test_hostile_headers(server: Server, headers: dict[str, str], status: int, code: str) -> None:
    found, _, content = post(server, hostile.text(), headers)
    assert (found, json.loads(content)["code"]) == (status, code)


def megabytes(pid: int, kind: str) -> float:
    """Return a kind of memory of a process, as Linux counts it."""
    text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    return float(text.split(f"\n{kind}:")[1].split()[0]) / 1024


def children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@pytest.mark.skipif(not Path("/proc/self/smaps_rollup").exists(), reason="the memory of processes is read from /proc")
def test_processes_take_the_memory_that_is_promised(start_server: Callable[..., Server]) -> None:
    """A process that compiled half of the kernels has more than 700 MB for good; caches are empty after the start."""
    server = start_server()
    server.wait_until_ready()
    pid = server.process.pid
    forking = [child for child in children(pid) if children(child)]
    # Pages of files are left out: how many of them count depends on what other processes read them.
    assert sum(megabytes(one, "Pss_Anon") for one in (pid, *forking)) < 215
    computing = [one for child in forking for one in children(child)]
    assert computing
    assert all(megabytes(one, "Rss") < 200 for one in computing)
    assert all(megabytes(one, "Private_Dirty") < 150 for one in computing)
    server.stop()


GOOD = b"POST /v1/rotation/trajectory HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n"


@pytest.mark.parametrize(
    "request_bytes",
    [
        b"GARBAGE\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00",
        GOOD + b"content-length: -1\r\n\r\n",
        GOOD + b"content-length: abc\r\n\r\n",
        GOOD + b"content-length: 99999999999999999999999999\r\n\r\n",
        GOOD + b"content-length: 2\r\ncontent-length: 3\r\n\r\n{}",
        GOOD + b"content-length: 2\r\ntransfer-encoding: chunked\r\n\r\n{}",
        GOOD + b"transfer-encoding: chunked\r\n\r\nZZ\r\n{}\r\n0\r\n\r\n",
        GOOD + b"transfer-encoding: gzip\r\n\r\n{}",
        GOOD + b"x\r\ny: \x00\r\n\r\n",
        GOOD + b"connection: close\r\ntransfer-encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n",
        GOOD + b"connection: close\r\ncontent-length: 99999999\r\nexpect: 100-continue\r\n\r\n",
        b"GET /healthz HTTP/1.1\r\nhost: x\r\nconnection: upgrade\r\nupgrade: websocket\r\n"
        b"sec-websocket-version: 13\r\nsec-websocket-key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
        b"GET /" + b"a" * 60_000 + b" HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n",
    ],
    ids=lambda value: value[-30:].decode("latin-1"),
)
def test_hostile_bytes_never_hurt(server: Server, request_bytes: bytes) -> None:
    with socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE) as connection:
        connection.sendall(request_bytes)
        connection.shutdown(socket.SHUT_WR)
        received = b""
        while more := connection.recv(65536):
            received += more
    assert not received.startswith(b"HTTP/1.1 5"), received[:300]
    assert b"Traceback" not in received
    assert server.get("/healthz").json() == {"status": "alive"}


def test_many_headers_and_a_split_request(server: Server) -> None:
    many = b"".join(b"x-%d: %d\r\n" % (i, i) for i in range(80))
    body = hostile.text()
    head = GOOD + many + b"connection: close\r\ncontent-length: %d\r\n\r\n" % len(body)
    received = raw(server, *[bytes([byte]) for byte in head[-40:-1]][:0], head[:50], head[50:], body[:7], body[7:])
    assert received.startswith(b"HTTP/1.1 200")


def test_pipelined_requests_are_answered_in_turn(server: Server) -> None:
    body = hostile.text()
    one = GOOD + b"content-length: %d\r\n\r\n" % len(body) + body
    last = b"GET /healthz HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n"
    received = raw(server, one + one + last)
    assert received.count(b"HTTP/1.1 200") == 3
    assert received.endswith(b'{"status":"alive"}')


def test_health_is_answered_while_every_core_computes(server: Server) -> None:
    heavy = json.dumps(
        hostile.QUESTION
        | {"times": {"start": 0.0, "stop": 400.0, "count": 11}, "method": {"kind": "runge-kutta-4", "step": 1e-4}}
    ).encode()
    answered = 0
    with ThreadPoolExecutor(4) as threads:
        jobs = [threads.submit(post, server, heavy) for _ in range(4)]
        connection = http.client.HTTPConnection("127.0.0.1", server.port)
        while not all(job.done() for job in jobs):
            connection.request("GET", "/healthz")
            connection.getresponse().read()
            answered += 1
            time.sleep(0.005)
        statuses = {job.result()[0] for job in jobs}
    connection.close()
    assert statuses <= {200, 429}
    assert 200 in statuses
    assert answered > 20


def test_a_client_that_leaves_does_no_harm(server: Server) -> None:
    body = json.dumps(hostile.QUESTION | {"times": {"start": 0, "stop": 1, "count": 1_000_000}}).encode()
    for _ in range(3):
        with socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE) as connection:
            connection.sendall(GOOD + b"content-length: %d\r\n\r\n" % len(body) + body)
            connection.recv(1000)
    assert post(server, hostile.text())[0] == 200


def test_problems_reach_the_client(server: Server) -> None:
    with Client(server.url) as polhode, pytest.raises(Refused) as caught:
        polhode.rotation_trajectory(body=T_HANDLE | {"moments": [1, 2, -3]}, angular_velocity=[1, 10, 1], times=[0.0])
    assert caught.value.code == "invalid-parameter"
    assert caught.value.problem["errors"][0]["pointer"] == "/body/moments/2"


@pytest.fixture
def scratch() -> Iterator[Path]:
    """A temporary directory of a short name: names of sockets in it may have 107 characters."""
    with tempfile.TemporaryDirectory() as name:
        yield Path(name)


def stopped_cleanly(server: Server, scratch: Path, signalled: signal.Signals) -> list[dict[str, Any]]:
    """Stop a server and return the lines of its log, after checks of what holds whenever one is stopped."""
    lines = [json.loads(line) for line in server.stop(signalled).splitlines() if line.strip()]
    assert server.process.returncode == 0
    assert not list(scratch.iterdir())
    assert not [line for line in lines if line["level"] in ("error", "critical")]
    return lines


def until_metrics_have(server: Server, *lines: str) -> None:
    """Wait until the metrics have lines: what other processes count is known a second later."""
    until = time.monotonic() + PATIENCE
    while not all(line in server.get("/metrics").text for line in lines):
        assert time.monotonic() < until, server.get("/metrics").text
        time.sleep(0.05)


def test_several_server_processes_give_the_same_bytes_and_shared_counters_and_stop_cleanly(
    start_server: Callable[..., Server], scratch: Path
) -> None:
    settings = {"POLHODE_WORKERS": "2", "POLHODE_COMPUTE_WORKERS": "1", "POLHODE_CACHED_ANSWERS": "0"}
    server = start_server(**settings, POLHODE_LOG_REQUESTS="all", TMPDIR=str(scratch))
    server.wait_until_ready()
    answers: set[bytes] = set()
    tags: set[Any] = set()
    for _ in range(24):
        # Whichever process accepts the connection is ready.
        status, headers, content = post(server, hostile.text())
        assert status == 200
        answers.add(content)
        tags.add(headers["etag"])
    assert len(answers) == len(tags) == 1
    until_metrics_have(server, 'polhode_request_seconds_count{operation="rotation_trajectory",status="200"} 24.0')
    # Counters, gauges and histograms of large questions add up, too.
    large = json.dumps(hostile.QUESTION | {"times": {"start": 0, "stop": 1, "count": 200_000}}).encode()
    statuses = [post(server, large)[0] for _ in range(6)]
    assert set(statuses) == {200}
    until_metrics_have(
        server, f"polhode_job_seconds_count {statuses.count(200)}.0", "polhode_waiting 0.0", "polhode_long 0.0"
    )
    lines = stopped_cleanly(server, scratch, signal.SIGINT)
    # On a busy machine there are lines about requests that held the event loop, too; those have no status.
    assert sum(line.get("operation") == "rotation_trajectory" and "status" in line for line in lines) == 30


def until_taken(server: Server, count: int) -> None:
    """Wait until so many questions are answered, wait for a compute process, or have used up their slice of one."""
    pattern = r'^polhode_(?:waiting|long|request_seconds_count\{operation="rotation_trajectory",.*\}) (\S+)$'
    until = time.monotonic() + PATIENCE
    while sum(map(float, re.findall(pattern, text := server.get("/metrics").text, re.MULTILINE))) < count:
        assert time.monotonic() < until, text
        time.sleep(0.02)


def server_processes(server: Server) -> list[int]:
    """Return the ids of the processes that the first has started to serve."""
    first = server.process.pid
    started = map(int, Path(f"/proc/{first}/task/{first}/children").read_text().split())
    return [one for one in started if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()]


def test_what_waited_for_a_server_process_that_was_killed_is_not_counted_for_ever(
    start_server: Callable[..., Server],
) -> None:
    server = start_server(POLHODE_WORKERS="2", POLHODE_COMPUTE_WORKERS="1")
    server.wait_until_ready()
    steps = {"kind": "runge-kutta-4", "step": 1e-4}
    heavy = json.dumps(hostile.QUESTION | {"times": {"start": 0.0, "stop": 400.0, "count": 11}, "method": steps})
    with ThreadPoolExecutor(4) as threads:
        flying = [threads.submit(post, server, heavy.encode()) for _ in range(4)]
        # Both have a long question by then, and the gauge says so.
        until = time.monotonic() + PATIENCE
        while "polhode_long 0.0" in server.get("/metrics").text:
            assert not all(one.done() for one in flying), [one.result() for one in flying]
            assert time.monotonic() < until
            time.sleep(0.05)
        for process in server_processes(server):
            os.kill(process, signal.SIGKILL)
        cut = [one.exception() is not None for one in flying]
    assert any(cut)
    while True:
        with suppress(httpx.TransportError):
            if "polhode_long 0.0" in server.get("/metrics").text:
                break
        assert time.monotonic() < until + PATIENCE
        time.sleep(0.1)


def test_requests_are_logged_and_a_large_one_in_flight_is_finished_when_the_server_is_stopped(
    start_server: Callable[..., Server], scratch: Path
) -> None:
    server = start_server(POLHODE_LOG_REQUESTS="all", POLHODE_COMPUTE_WORKERS="1", TMPDIR=str(scratch))
    server.wait_until_ready()
    assert post(server, hostile.text(), JSON | {"x-request-id": "abc-1"})[0] == 200
    assert "server" not in server.get("/healthz").headers
    steps = {"kind": "runge-kutta-4", "step": 2e-4}
    heavy = json.dumps(hostile.QUESTION | {"times": {"start": 0.0, "stop": 400.0, "count": 11}, "method": steps})
    with ThreadPoolExecutor(1) as threads:
        flying = threads.submit(post, server, heavy.encode())
        until_taken(server, 2)
        lines = stopped_cleanly(server, scratch, signal.SIGTERM)
        status, _, content = flying.result()
    assert status == 200
    assert len(json.loads(content)["angular_velocity"]) == 11
    request = next(line for line in lines if line.get("request_id") == "abc-1")
    assert (request["operation"], request["status"], request["method"]) == ("rotation_trajectory", 200, "POST")


def test_what_cannot_be_finished_in_time_is_refused_when_the_server_is_stopped(
    start_server: Callable[..., Server],
) -> None:
    server = start_server(POLHODE_COMPUTE_WORKERS="1", POLHODE_SHUTDOWN_SECONDS="0")
    server.wait_until_ready()
    steps = {"kind": "explicit-euler", "step": 2.5e-5}
    heavy = json.dumps(hostile.QUESTION | {"times": {"start": 0.0, "stop": 400.0, "count": 11}, "method": steps})
    # The first may be finished by then; more than a second of work is queued behind it.
    with ThreadPoolExecutor(12) as threads:
        flying = [threads.submit(post, server, heavy.encode()) for _ in range(12)]
        until_taken(server, 12)
        server.stop()
        answers = [one.result() for one in flying]
    refused = [
        (headers["retry-after"], json.loads(content)["code"]) for status, headers, content in answers if status != 200
    ]
    assert set(refused) == {("1", "shutting-down")}
    assert {status for status, _, _ in answers} <= {200, 503}


def test_the_first_questions_after_readiness_compile_nothing_and_import_nothing() -> None:
    """Every example is asked of a service that has just become ready, in a process of its own, and leaves no trace."""
    script = """
import asyncio, sys
import httpx
from numba import njit
from numba.core import event
from service.app import create_app
from service.routes import questions
from service.settings import Settings

async def main():
    service = create_app(Settings(cached_answers=0, compute_workers=1))
    async with service.lifespan():
        while not service.warm:
            await asyncio.sleep(0.02)
        transport = httpx.ASGITransport(service)
        async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:
            await client.get("/healthz")
            loaded, compiled = set(sys.modules), []
            class Listener(event.Listener):
                def on_start(self, event):
                    compiled.append(event.data["dispatcher"])
                def on_end(self, event):
                    pass
            event.register("numba:compile", Listener())
            for route in questions():
                for example in route.examples.values():
                    response = await client.post(route.path, json=dict(example.question))
                    assert response.status_code == (202 if route.path == "/v1/studies" else 200), response.text
            late = {name for name in set(sys.modules) - loaded if name.split(".")[0] in HEAVY}
            print("compiled", len(compiled), "late", sorted(late))
            njit(lambda x: x + 1)(1)
            print("noticed", len(compiled))

HEAVY = {"scipy", "numba", "flint", "numpy", "core", "service", "mpmath"}
asyncio.run(main())
"""
    run = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, timeout=300)
    # A function that does have to be compiled is noticed.
    assert run.stdout == "compiled 0 late []\nnoticed 1\n", run.stdout + run.stderr
