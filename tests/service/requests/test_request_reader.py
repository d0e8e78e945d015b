"""Bodies that are refused, by a table; the same table is sent to a real server in test_server."""

import json

import anyio
import pytest

from core.errors import MechanicsError
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.problems import Refusal, problem_of
from service.requests.request_reader import Limits
from tests.service import hostile
from tests.service.conftest import client_of, inline_toys
from tests.service.toy_routes import GOOD, TOY

SERVICE = inline_toys()
READER = RequestHandler([TOY], Budget(), Limits())
JSON = {"content-type": "application/json"}


def toyish(body: bytes) -> bytes:
    """Turn the table's question into the toy's."""
    return body.replace(b'"principal-moments"', b'"moments"')


async def post(body: bytes, **headers: str):  # type: ignore[no-untyped-def]
    async with client_of(SERVICE) as client:
        return await client.post("/v1/toy", content=body, headers={**JSON, **headers})


def ask(body: bytes, **headers: str):  # type: ignore[no-untyped-def]
    return anyio.run(lambda: post(body, **headers))


@pytest.mark.parametrize(
    ("body", "status", "code", "pointer"), [c[1:] for c in hostile.CASES], ids=[c[0] for c in hostile.CASES]
)
def test_hostile_bodies_are_refused_with_a_pointer(body: bytes, status: int, code: str, pointer: str | None) -> None:
    response = ask(toyish(body))
    assert (response.status_code, response.json()["code"]) == (status, code), response.text[:500]
    assert response.headers["content-type"] == "application/problem+json"
    assert len(response.content) <= 2048
    document = response.json()
    assert {"type", "title", "status", "detail"} <= document.keys()
    if pointer is not None:
        assert pointer in [fault["pointer"] for fault in document["errors"]], response.text[:500]


def test_pointers_lead_into_the_clients_document() -> None:
    question = GOOD | {
        "body": {
            "kind": "nest",
            "inner": [GOOD["body"], {"kind": "points", "masses": [1, -1], "positions": [[1, 2, "x"]]}],
        }
    }
    document = ask(json.dumps(question).encode()).json()
    assert [fault["pointer"] for fault in document["errors"]] == [
        "/body/inner/1/masses/1",
        "/body/inner/1/positions/0/2",
    ]


def test_a_rule_of_the_mechanics_keeps_its_code_pointer_and_remedy() -> None:
    inner = {"kind": "nest", "inner": [{"kind": "moments", "moments": [1, 2, 7]}]}
    response = ask(json.dumps(GOOD | {"body": inner}).encode())
    document = response.json()
    assert (response.status_code, document["code"]) == (422, "unphysical-inertia")
    assert document["errors"] == [
        {
            "pointer": "/body/inner/0/moments/2",
            "detail": "must not exceed the sum of the others",
            "remedy": "make it smaller",
        }
    ]


def test_faults_of_several_kinds_have_the_code_of_all() -> None:
    inner = {"kind": "nest", "inner": [{"kind": "moments", "moments": [1, 2, 7]}]}
    document = ask(json.dumps(GOOD | {"body": inner, "times": "x"}).encode()).json()
    assert document["code"] == "invalid-parameter"
    assert {fault["pointer"] for fault in document["errors"]} == {"/body/inner/0/moments/2", "/times"}


def test_an_accuracy_that_cannot_be_reached_says_what_can() -> None:
    document = ask(json.dumps(GOOD | {"behaviour": "unreachable"}).encode()).json()
    assert (document["requested"], document["achievable"]) == (1e-30, 1e-15)
    assert document["errors"][0]["pointer"] == "/accuracy"


def test_nothing_that_was_sent_comes_back() -> None:
    secret = "s3cr3t" * 20
    for body in (
        json.dumps({secret: 1}),
        json.dumps(GOOD | {"body": {"kind": secret}}),
        json.dumps(GOOD | {"times": [secret]}),
        json.dumps(GOOD | {"behaviour": secret}),
        f'{{"{secret}',
    ):
        assert "s3cr3t" not in ask(body.encode()).text


def worst_bodies() -> dict[str, bytes]:
    size = 1_500_000
    return {
        "bad rows": json.dumps(
            GOOD | {"body": {"kind": "points", "masses": [1], "positions": [[1, 2]] * 180_000}}
        ).encode(),
        "bad numbers": json.dumps(GOOD | {"times": ["x"] * 290_000}).encode(),
        "keys": b"{" + b",".join(b'"k%d":1' % i for i in range(130_000)) + b"}",
        "keys allowed": b"{" + b",".join(b'"k%d":"%s"' % (i, b"x" * 360) for i in range(3_990)) + b"}",
        "last entry": json.dumps(GOOD | {"times": [0.12345678901234567] * 70_000 + [None]}).encode(),
        "brackets": b"[" * size,
        "pairs of brackets": b"[" + b"[]," * (size // 3) + b"[]]",
        "strings": b"[" + b'"",' * (size // 3) + b'""]',
        "one string": b'"' + b"a" * size + b'"',
        "escapes": b'"' + b"\\u0041" * (size // 6) + b'"',
        "digits": b"9" * size,
        "blanks": b" " * size,
        "unclosed keys": b'{"a' * (size // 3),
        "colons": b'":' * (size // 2),
    }


@pytest.mark.parametrize("name", worst_bodies())
def test_the_worst_bodies_are_refused_with_little(name: str) -> None:
    """How long that takes is measured by benchmarks/service_rejection.py."""
    with pytest.raises(Refusal) as caught:
        READER.read(TOY, worst_bodies()[name])
    assert len(caught.value.problem.body()) <= 2048


def test_an_error_raised_while_answering_is_a_problem_too() -> None:
    assert problem_of(MechanicsError("no", path=("a", 1))).faults[0].pointer == "/a/1"
