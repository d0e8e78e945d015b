"""Bodies that are refused, by a table; the same table is sent to a real server in test_server."""

import json
from time import perf_counter

import anyio
import pytest

from core.errors import MechanicsError
from service.problems import problem_of
from tests.service import hostile
from tests.service.conftest import client_of, toy_service
from tests.service.toy_routes import GOOD

SERVICE = toy_service(inline_bytes=10**9)
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
def test_the_worst_bodies_are_refused_soon(name: str) -> None:
    body = worst_bodies()[name]
    reader = SERVICE.answering
    route = SERVICE.table[0]
    times = []
    for _ in range(3):
        since = perf_counter()
        with pytest.raises(Exception) as caught:  # noqa: PT011
            reader.read(route, body)
        times.append(perf_counter() - since)
    assert type(caught.value).__name__ == "Refusal", caught.value
    # 50 ms is the aim on a machine at rest; tests share theirs.
    assert min(times) < 0.15


def test_an_error_raised_while_answering_is_a_problem_too() -> None:
    assert problem_of(MechanicsError("no", path=("a", 1))).faults[0].pointer == "/a/1"
