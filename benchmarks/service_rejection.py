"""How soon the worst bodies of 1.5 MB are refused, and in how many bytes, by every kind of endpoint.

Run: python -m benchmarks.service_rejection [repeats]. Reading happens in this process, as it does in a compute process:
the time is the processor's, from the bytes of the request to those of the problem. Over HTTP the slowest of each
endpoint are asked again, of a server with its own processes, and that is time on the wall.
"""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from typing import Any

from benchmarks.machine import RESULTS, described
from core.errors import MechanicsError
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.problems import Refusal, problem_of
from service.requests.request_reader import Limits
from service.routes import questions
from service.routing import PostRoute

SIZE = 1_500_000
AIM_MS = 50.0
MOST_BYTES = 2048
ROUTES = {route.path: route for route in questions()}
ANSWERING = RequestHandler(ROUTES.values(), Budget(), Limits())


def filled(entry: str, size: int = SIZE) -> str:
    """Return an array of equal entries of about `size` bytes."""
    return "[" + ",".join([entry] * (size // (len(entry) + 1))) + "]"


def anywhere() -> dict[str, bytes]:
    """Return bodies that no endpoint can read."""
    return {
        "brackets": b"[" * SIZE,
        "braces": b'{"a":' * (SIZE // 5),
        "pairs of brackets": b"[" + b"[]," * (SIZE // 3) + b"[]]",
        "one string": b'"' + b"a" * SIZE + b'"',
        "escapes": b'"' + b"\\u0041" * (SIZE // 6) + b'"',
        "backslashes": b'"' + b"\\" * SIZE,
        "quotes": b'"' * SIZE,
        "colons": b'":' * (SIZE // 2),
        "an unfinished number": b"9" * SIZE,
        "a number of 1.4 million digits": b'{"body":' + b"9" * (SIZE - 100_000) + b"}",
        "blanks": b" " * SIZE,
        "keys": b"{" + b",".join(b'"k%d":1' % i for i in range(SIZE // 11)) + b"}",
        "equal keys": b"{" + b",".join([b'"body":1'] * (SIZE // 9)) + b"}",
        "keys with blanks": b"{" + b",".join([b'"a" :1'] * (SIZE // 7)) + b"}",
        "as many keys as allowed": b"{" + b",".join(b'"k%d":"%s"' % (i, b"x" * 360) for i in range(3_990)) + b"}",
    }


def within(question: dict[str, Any]) -> dict[str, bytes]:
    """Return bodies that begin as a question of this endpoint does and go wrong late."""
    text = json.dumps(question)
    whole = text[:-1]
    found = {
        "an unknown string": f'{whole}, "unknown": "{"a" * SIZE}"}}',
        "unknown numbers": f'{whole}, "unknown": {filled("0.12345678901234567")}}}',
        "unknown exponents": f'{whole}, "unknown": {filled("1e-299")}}}',
        "unknown many digits": f'{whole}, "unknown": {filled("0." + "1234567890" * 50)}}}',
        "unknown rows": f'{whole}, "unknown": {filled("[1,2,3]", 1_100_000)}}}',
        "unknown strings": f'{whole}, "unknown": {filled(chr(34) * 2)}}}',
        "unknown objects": f'{whole}, "unknown": {filled("{}", 440_000)}}}',
        "unknown escapes": f'{whole}, "unknown": {filled(chr(34) + chr(92) + "u00e9" + chr(34))}}}',
        "a key twice at the end": f'{whole}, "unknown": {filled("1")}, "unknown": 1}}',
        "a comma at the end": f'{whole}, "unknown": {filled("0.12345678901234567")},}}',
        "deep objects": whole + ', "unknown": ' + '{"a":' * 25 + filled("1.5") + "}" * 25 + "}",
        "keys twice within": f'{whole}, "unknown": [{",".join([chr(123) + chr(34) + "a" + chr(34) + ":1}"] * 3900)}], '
        f'"x": {filled("0.5", SIZE - 100_000)}, "x": 1}}',
    }
    for name in question:
        wrong = {"strings": '"x"', "nulls": "null", "short rows": "[1,2]", "numbers": "0.12345678901234567"}
        for label, entry in wrong.items():
            size = 900_000 if entry[0] == "[" else SIZE
            document = {**question, name: 0}
            found[f"{name}: {label}"] = json.dumps(document).replace(f'"{name}": 0', f'"{name}": {filled(entry, size)}')
    if question.get("body"):
        rows = filled("[0.123456789,0.123456789,0.123456789]", SIZE - 50_000)
        kinds = {
            "rows of two": ("point-masses", "positions", filled("[1,2]", 900_000)),
            "a bad row at the end": ("point-masses", "positions", rows[:-1] + ",[1,2]]"),
            "a string at the end": ("point-masses", "positions", rows[:-1] + ',[1,2,"3"]]'),
            "an infinity at the end": ("point-masses", "positions", rows[:-1] + ",[1,2,1e999]]"),
            "numbers of 25 digits": ("point-masses", "positions", filled("[1.123456789012345678901234,2,3]", SIZE)),
            "rows without brackets": ("point-masses", "positions", filled("0.12345678901234567")),
            "tiny rows": ("point-masses", "positions", filled("[1,2,3]", 1_150_000)),
            "middles of doubles": ("point-masses", "positions", filled("9007199254740993.0")),
        }
        for label, (kind, name, array) in kinds.items():
            body = f'{{"kind": "{kind}", "masses": -1, "{name}": {array}}}'
            found[f"body: {label}"] = json.dumps({**question, "body": 0}).replace('"body": 0', f'"body": {body}')
        vertices, faces = filled("[0.5,0.25,0.125]", SIZE // 2), filled("[10,20,30]", SIZE // 2)
        for label, array in {"an open mesh": faces, "faces of four": filled("[1,2,3,4]", SIZE // 2),
                             "faces with a point": faces[:-1] + ",[1,2,3.0]]"}.items():  # fmt: skip
            body = f'{{"kind": "mesh", "mass": 1, "vertices": {vertices}, "faces": {array}}}'
            found[f"body: {label}"] = json.dumps({**question, "body": 0}).replace('"body": 0', f'"body": {body}')
        part = '{"body":{"kind":"ball","mass":1,"radius":1}}'
        parts = f'{{"kind": "composite", "parts": {filled(part, 60_000)}, "x": {filled("0.5")}}}'
        found["body: parts"] = json.dumps({**question, "body": 0}).replace('"body": 0', f'"body": {parts}')
    return {label: document.encode() for label, document in found.items()}


def kinds() -> Iterator[tuple[PostRoute, str, dict[str, Any]]]:
    """Yield each endpoint, the name of its first example, and that question."""
    for route in ROUTES.values():
        name, example = next(iter(route.examples.items()))
        yield route, name, dict(example.question)


def refused(route: PostRoute, body: bytes) -> tuple[float, bytes]:
    """Return the processor's time for a refusal (s) and its document, empty if the question is answered."""
    since = time.process_time()
    document = b""
    try:
        ANSWERING.read(route, body)
    except Refusal as refusal:
        document = refusal.problem.body()
    except MechanicsError as error:
        document = problem_of(error).body()
    return time.process_time() - since, document


@contextlib.contextmanager
def serving() -> Iterator[int]:
    """Run the service in a process of its own; gives its port."""
    process = subprocess.Popen([sys.executable, "-m", "service", "--port", "0"], stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr is not None
        line = next(line for line in process.stderr if "running on" in line)
        yield int(line.split("127.0.0.1:")[1].split()[0].strip('",'))
    finally:
        process.terminate()
        process.wait(60)


def over_http(port: int, asked: list[tuple[str, bytes]], repeats: int) -> dict[str, float]:
    """Return the least time of each of these requests (ms)."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    while True:
        connection.request("GET", "/readyz")
        response = connection.getresponse()
        response.read()
        if response.status == 200:
            break
        time.sleep(0.1)
    found: dict[str, float] = {}
    for path, body in asked:
        times = []
        for _ in range(repeats):
            since = time.perf_counter()
            connection.request("POST", path, body, {"content-type": "application/json"})
            response = connection.getresponse()
            document = response.read()
            times.append(time.perf_counter() - since)
            assert response.status >= 400, path
            assert len(document) <= MOST_BYTES, document
        found[path] = max(found.get(path, 0.0), round(1e3 * min(times), 1))
    return found


def main(repeats: int = 5) -> None:
    """Measure and write the result."""
    before, found, slowest = os.getloadavg(), [], []
    for route, name, question in kinds():
        bodies = {**anywhere(), **within(question)}
        took, longest = {}, 0
        for label, body in bodies.items():
            times, documents = zip(*(refused(route, body) for _ in range(repeats)), strict=True)
            if documents[0]:
                took[label] = 1e3 * min(times)
                longest = max(longest, len(documents[0]))
        ranked = sorted(took, key=lambda label: -took[label])
        slowest += [(route.path, bodies[label]) for label in ranked[:2]]
        found.append(
            {
                "path": route.path,
                "example": name,
                "bodies": len(took),
                "median_ms": round(statistics.median(took.values()), 2),
                "slowest_ms": {label: round(took[label], 1) for label in ranked[:4]},
                "within_aim": took[ranked[0]] <= AIM_MS,
                "longest_answer_bytes": longest,
            }
        )
        print(json.dumps(found[-1]))
    with serving() as port:
        http_ms = over_http(port, slowest, repeats)
    print(json.dumps(http_ms))
    result = {
        "machine": described("pydantic", "orjson", "numpy", "numba"),
        "load_average": {"before": before, "after": os.getloadavg()},
        "repeats": repeats,
        "aim": {"milliseconds": AIM_MS, "bytes": MOST_BYTES},
        "least_of_repeats": found,
        "slowest_over_http_ms": http_ms,
    }
    (RESULTS / "service_rejection.json").write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
