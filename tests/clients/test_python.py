"""The client of Python programs: a method for every operation, arrays as numpy arrays, problems as one exception."""

from __future__ import annotations

import ast
import asyncio
import email.utils
import io
import json
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import httpx
import numpy as np
import pytest
from polhode_client import AsyncClient, Client, Refused
from polhode_client.arrays import body_of
from polhode_client.exchange import exchange
from polhode_client.operations import OPERATIONS, AsyncOperations, Operations

from core.bodies import PrincipalMoments
from service.routes import questions

ROOT = Path(__file__).parents[2]
DOCUMENT: dict[str, Any] = json.loads((ROOT / "docs" / "openapi.json").read_text())
BODY = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}

EXAMPLES = [
    (entry["operationId"], path, name)
    for path, verbs in DOCUMENT["paths"].items()
    for entry in verbs.values()
    # A study is another one each time.
    if entry["operationId"] != "create_study"
    for name in entry.get("requestBody", {}).get("content", {}).get("application/json", {}).get("examples", {})
]


def example(path: str, name: str) -> Any:
    return DOCUMENT["paths"][path]["post"]["requestBody"]["content"]["application/json"]["examples"][name]["value"]


def answering(*responses: httpx.Response, **settings: Any) -> tuple[Client, list[httpx.Request]]:
    asked: list[httpx.Request] = []
    remaining = iter(responses)

    def handler(request: httpx.Request) -> httpx.Response:
        asked.append(request)
        return next(remaining)

    return Client("http://test", transport=httpx.MockTransport(handler), **settings), asked


def busy(status: int = 429, **headers: str) -> httpx.Response:
    problem = {"type": "t", "title": "busy", "status": status, "code": "too-busy", "detail": "later"}
    return httpx.Response(status, json=problem, headers=headers)


def as_json(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, dict):
        return {key: as_json(entry) for key, entry in value.items()}
    return [as_json(entry) for entry in value] if isinstance(value, list) else value


def test_a_study_that_is_sent_again_is_the_same_study() -> None:
    client, asked = answering(busy(503, **{"retry-after": "0"}), *(2 * [httpx.Response(202, json={"jobID": "x"})]))
    question: Any = {"path": "/v1/rotation/wobble", "request": {"period": 430}}
    for _ in range(2):
        client.create_study(question=question, vary=[], quantities=[])
    first, again, other = (request.headers["idempotency-key"] for request in asked)
    assert first == again != other


def test_parameters_of_the_address_are_those_that_are_given() -> None:
    client, asked = answering(*(2 * [httpx.Response(200, json={})]))
    client.list_studies()
    client.get_study_results("x", start=3, count=7)
    assert [str(request.url) for request in asked] == [
        "http://test/v1/studies",
        "http://test/v1/studies/x/results?start=3&count=7",
    ]


def test_every_operation_is_a_method_of_both_clients() -> None:
    documented = {entry["operationId"] for verbs in DOCUMENT["paths"].values() for entry in verbs.values()}
    assert set(OPERATIONS) == documented
    assert {route.operation_id: route.path for route in questions()}.items() <= {
        name: operation.path for name, operation in OPERATIONS.items()
    }.items()
    for owner in (Operations, AsyncOperations):
        assert documented <= set(vars(owner))


@pytest.mark.parametrize(("operation", "path", "name"), EXAMPLES, ids=[f"{one}: {name}" for one, _, name in EXAMPLES])
def test_examples_are_answered_as_over_http(service: str, operation: str, path: str, name: str) -> None:
    question = example(path, name)
    # The first question of a kind loads kernels in the process that is asked, which is more than the 20 ms of processor
    # time that a plan may take: processes that have not been asked yet plan otherwise.
    for _ in range(10 if operation == "plan" else 1):
        over_http = httpx.post(service + path, json=question, timeout=100.0, verify=False).json()
        with Client(service) as polhode:
            found = getattr(polhode, operation)(**question)
        if without_times(as_json(found)) == without_times(over_http):
            break
    assert without_times(as_json(found)) == without_times(over_http)


def without_times(answer: Any) -> Any:
    """Return an answer without what is measured with a clock."""
    if isinstance(answer, dict):
        return {key: without_times(entry) for key, entry in answer.items() if key not in ("seconds", "pareto")}
    return [without_times(entry) for entry in answer] if isinstance(answer, list) else answer


def test_documents_texts_and_drawings_are_answered(service: str) -> None:
    with Client(service) as polhode:
        assert polhode.get_health()["status"] == "alive"
        assert "explicit-euler" in [method["kind"] for method in polhode.list_methods()["methods"]]
        assert polhode.get_openapi()["openapi"].startswith("3.")
        assert "polhode" in polhode.get_metrics()
        assert "<html" in polhode.get_start_page()
        assert polhode.energy_ellipsoid_svg(body=BODY, angular_velocity=[1.0, 2.0, 3.0]).startswith("<svg")


def test_the_asynchronous_client_answers_the_same(service: str) -> None:
    async def both() -> tuple[Any, Any]:
        async with AsyncClient(service) as polhode:
            first = polhode.precession(body=BODY, angular_velocity=[1.0, 2.0, 3.0])
            second = polhode.rotation_trajectory(
                body=BODY, angular_velocity=[1.0, 2.0, 3.0], times=np.linspace(0, 9, 5000)
            )
            return await asyncio.gather(first, second)

    precession, trajectory = asyncio.run(both())
    with Client(service) as polhode:
        assert as_json(precession) == as_json(polhode.precession(body=BODY, angular_velocity=[1.0, 2.0, 3.0]))
    assert trajectory["angular_velocity"].shape == (5000, 3)
    assert trajectory["angular_velocity"].dtype == np.float64


def test_large_arrays_are_sent_as_an_archive() -> None:
    client, asked = answering(httpx.Response(200, json={}))
    times = np.linspace(0.0, 1.0, 2000)
    client.rotation_trajectory(body=PrincipalMoments((1.0, 2.0, 3.0)), angular_velocity=np.ones(3), times=times)
    assert asked[0].headers["content-type"] == "application/x-npz"
    with ZipFile(io.BytesIO(asked[0].content)) as archive:
        document = json.loads(archive.read("metadata.json"))
        sent = np.load(io.BytesIO(archive.read("array0.npy")), allow_pickle=False)
    assert document == {
        "body": {"moments": [1.0, 2.0, 3.0], "kind": "principal-moments"},
        "angular_velocity": [1.0, 1.0, 1.0],
        "times": {"array": "array0"},
    }
    assert np.array_equal(sent, times)


def test_an_archive_has_no_more_members_than_the_service_reads() -> None:
    body, media = body_of({"angular_velocities": [np.ones(1000)] * 501})
    assert media == "application/x-npz"
    with ZipFile(io.BytesIO(body)) as archive:
        assert len(archive.namelist()) == 501
        document = json.loads(archive.read("metadata.json"))
    assert document["angular_velocities"][-1] == 1000 * [1.0]


def test_arrays_inside_of_another_request_are_sent_as_json() -> None:
    client, asked = answering(httpx.Response(200, json={}))
    client.plan(path="/v1/rotation/trajectory", request={"times": np.linspace(0.0, 1.0, 2000)})
    assert asked[0].headers["content-type"] == "application/json"
    assert len(json.loads(asked[0].content)["request"]["times"]) == 2000


@pytest.mark.parametrize("count", [1, 200])
def test_samples_are_submitted_as_archives(service: str, count: int) -> None:
    request = {"body": BODY, "angular_velocity": [1.0, 2.0, 3.0], "times": [0.0]}
    times = np.linspace(0.0, 9.0, 1000)
    with Client(service) as polhode:
        right = polhode.rotation_trajectory(body=BODY, angular_velocity=[1.0, 2.0, 3.0], times=times)[
            "angular_velocity"
        ]
        claim: Any = {"/angular_velocity": {"value": right, "times": times, "unit": "rad/s"}}
        question: Any = {"path": "/v1/rotation/trajectory", "request": request}
        answer = polhode.assess(question=question, submissions=count * [claim])
    assert [result["score"] for result in answer["results"]] == count * [1.0]


@pytest.mark.parametrize("times", [np.full(3, np.nan), np.full(2000, np.inf), [float("nan")]])
def test_what_json_has_no_number_for_is_not_sent(times: Any) -> None:
    client, asked = answering()
    with pytest.raises(ValueError, match=r"finite|JSON compliant"):
        client.rotation_trajectory(body=BODY, angular_velocity=[1.0, 2.0, 3.0], times=times)
    assert not asked


def test_problems_are_raised_with_all_their_fields(service: str) -> None:
    with Client(service) as polhode, pytest.raises(Refused) as caught:
        polhode.mass_properties(body={"kind": "ball", "radius": -1.0, "mass": 1.0})
    refused = caught.value
    assert (refused.status, refused.code) == (422, "invalid-parameter")
    assert refused.errors[0]["pointer"] == "/body/radius"
    assert refused.title == refused.problem["title"]
    assert str(refused) == refused.detail == refused.problem["detail"]


def test_a_reply_of_a_proxy_is_a_refusal_without_a_code() -> None:
    client, _ = answering(httpx.Response(502, text="<html>Bad gateway</html>"))
    with pytest.raises(Refused, match="502") as caught:
        client.get_health()
    assert (caught.value.status, caught.value.code, caught.value.errors) == (502, "unknown", [])


@pytest.mark.parametrize("status", [429, 503])
def test_a_busy_service_is_retried_after_the_time_that_it_names(status: int) -> None:
    steps = exchange(OPERATIONS["wobble"], {"period": 430}, None, patience=10.0)
    sent = next(steps)
    assert steps.send(received(busy(status, **{"retry-after": "3"}))) == 3.0
    assert steps.send(None) == sent
    # What is left of the patience is less than what is to be waited.
    with pytest.raises(Refused) as caught:
        steps.send(received(busy(status, **{"retry-after": "8"})))
    assert (caught.value.code, caught.value.retry_after) == ("too-busy", 8.0)


def received(response: httpx.Response) -> Any:
    from polhode_client.exchange import Received

    return Received(response.status_code, response.headers, response.content)


def test_a_date_may_say_when_to_retry() -> None:
    steps = exchange(OPERATIONS["wobble"], {"period": 430}, None, patience=100.0)
    next(steps)
    later = email.utils.format_datetime(datetime.now(UTC) + timedelta(seconds=50), usegmt=True)
    wait = steps.send(received(busy(**{"retry-after": later})))
    assert isinstance(wait, float)
    assert 40.0 < wait <= 50.0


@pytest.mark.parametrize("headers", [{}, {"retry-after": "soon"}])
def test_without_a_time_nothing_is_retried(headers: dict[str, str]) -> None:
    client, asked = answering(busy(503, **headers))
    with pytest.raises(Refused):
        client.wobble(period=430.0)
    assert len(asked) == 1


def test_both_clients_wait_and_retry() -> None:
    def replies() -> list[httpx.Response]:
        later = {"retry-after": "0"}
        return [busy(**later), busy(503, **later), httpx.Response(200, json={"a": [1.0]})]

    client, asked = answering(*replies())
    assert as_json(client.wobble(period=430.0)) == {"a": [1.0]}
    assert len(asked) == 3

    async def asynchronous() -> Any:
        remaining = iter(replies())
        transport = httpx.MockTransport(lambda request: next(remaining))
        async with AsyncClient("http://test", transport=transport) as polhode:
            return await polhode.wobble(period=430.0)

    assert as_json(asyncio.run(asynchronous())) == {"a": [1.0]}


def test_an_answer_that_drips_is_given_up_after_the_timeout() -> None:
    class Dripping(httpx.SyncByteStream, httpx.AsyncByteStream):
        def __iter__(self) -> Iterator[bytes]:
            while True:
                time.sleep(0.01)
                yield b" "

        async def __aiter__(self) -> Any:
            while True:
                await asyncio.sleep(0.01)
                yield b" "

    client, _ = answering(httpx.Response(200, stream=Dripping()), timeout=0.05)
    with pytest.raises(httpx.ReadTimeout):
        client.get_health()

    async def asynchronous() -> None:
        transport = httpx.MockTransport(lambda request: httpx.Response(200, stream=Dripping()))
        async with AsyncClient("http://test", transport=transport, timeout=0.05) as polhode:
            await polhode.get_health()

    with pytest.raises(httpx.ReadTimeout):
        asyncio.run(asynchronous())


def test_the_timeout_is_that_of_the_connection() -> None:
    client, asked = answering(httpx.Response(200, json={}), timeout=7.0)
    client.get_health()
    assert asked[0].extensions["timeout"] == {"connect": 7.0, "read": 7.0, "write": 7.0, "pool": 7.0}


def test_a_key_is_sent() -> None:
    client, asked = answering(httpx.Response(200, json={}), key="secret")
    client.get_health()
    assert asked[0].headers["authorization"] == "Bearer secret"
    client, asked = answering(httpx.Response(200, json={}))
    client.get_health()
    assert "authorization" not in asked[0].headers


def test_it_is_a_package_of_its_own(tmp_path: Path) -> None:
    """It needs what its pyproject.toml says, and neither the service nor core."""
    source = ROOT / "clients" / "python"
    shutil.copytree(source / "polhode_client", tmp_path / "polhode_client")
    script = f"""
import sys
sys.path.insert(0, {str(tmp_path)!r})
import polhode_client
assert polhode_client.__file__.startswith({str(tmp_path)!r})
assert not {{"core", "service"}} & set(sys.modules)
"""
    subprocess.run([sys.executable, "-I", "-c", script], cwd=tmp_path, check=True, timeout=100)
    # The optional ones are imported by name, where they are used.
    declared = tomllib.loads((source / "pyproject.toml").read_text())["project"]["dependencies"]
    trees = [ast.parse(file.read_text()) for file in (source / "polhode_client").glob("*.py")]
    imported = {
        module.partition(".")[0]
        for tree in trees
        for node in ast.walk(tree)
        for module in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [str(node.module)]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    others = imported - set(sys.stdlib_module_names) - {"polhode_client"}
    assert others == {one.partition(">")[0] for one in declared}


TYPED = {
    'rate: float | None = polhode.precession(body=coin, angular_velocity=[1, 1, 1])["space_rate"]': None,
    'polhode.precession(body=coin, angular_velocity=[1, 1, 1])["space_rates"]': "typeddict-item",
    "polhode.precession(body=coin, angular_velocities=[1, 1, 1])": "call-arg",
    'polhode.precession(body={"kind": "ball", "mass": 1.0}, angular_velocity=[1, 1, 1])': "arg-type",
    'polhode.wobble(period="430")': "arg-type",
}
"""By line, which fault of types it has."""


def test_a_type_checker_knows_questions_and_answers(tmp_path: Path) -> None:
    head = [
        "from polhode_client import Client",
        "from polhode_client.documents import PrincipalMoments",
        'polhode = Client("http://test")',
        'coin: PrincipalMoments = {"kind": "principal-moments", "moments": [1, 1, 2]}',
    ]
    (tmp_path / "script.py").write_text("\n".join([*head, *TYPED, ""]))
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), "script.py"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=200,
        env=os.environ | {"MYPYPATH": str(ROOT / "clients" / "python")},
    )  # fmt: skip
    for number, fault in enumerate(TYPED.values(), len(head) + 1):
        found = re.findall(rf"^script.py:{number}: error: .*\[([\w-]+)\]$", done.stdout, re.MULTILINE)
        assert set(found) == (set() if fault is None else {fault}), done.stdout


def test_it_is_imported_in_a_checkout_in_which_nothing_was_built(tmp_path: Path) -> None:
    own = ROOT / "clients" / "python"
    made = shutil.ignore_patterns("documents.py", "operations.py", "__pycache__")
    shutil.copytree(own, tmp_path / "python", ignore=made)
    shutil.copy(ROOT / "docs" / "openapi.json", tmp_path / "python")
    command = [sys.executable, "-c", "from polhode_client import Client; print(Client.precession.__name__)"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env={**os.environ, "PYTHONPATH": str(tmp_path / "python")}
    )
    assert done.stdout == "precession\n", done.stderr


def test_where_no_service_answers_one_line_names_the_address() -> None:
    def refuse(request: httpx.Request) -> httpx.Response:
        raise httpx.ConnectError("[Errno 111] Connection refused", request=request)

    with (
        Client("http://polhode.invalid:8000", transport=httpx.MockTransport(refuse)) as polhode,
        pytest.raises(httpx.ConnectError, match=r"^no service answers at http://polhode\.invalid:8000: .*refused$"),
    ):
        polhode.precession(body={"kind": "principal-moments", "moments": [1, 1, 2]}, angular_velocity=[1, 1, 1])

    async def asked() -> None:
        async with AsyncClient("http://polhode.invalid:8000", transport=httpx.MockTransport(refuse)) as polhode:
            await polhode.precession(
                body={"kind": "principal-moments", "moments": [1, 1, 2]}, angular_velocity=[1, 1, 1]
            )

    with pytest.raises(httpx.ConnectError, match=r"^no service answers at http://polhode\.invalid:8000: "):
        asyncio.run(asked())
