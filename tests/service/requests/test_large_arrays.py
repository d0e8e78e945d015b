"""Large arrays give the question, and the refusal, that the validator gives of the same document without this path."""

import json
from typing import Any

import numpy as np
import pytest

from core.bodies.measured import PointMasses
from core.decimal_rows import read_rows
from service.problems import Refusal
from service.requests import large_arrays
from service.requests.large_arrays import extract_arrays
from service.requests.request_reader import Limits, Reader
from service.routes.bodies import MassPropertiesRequest
from service.routes.rotation.trajectory import TrajectoryRequest

LIMITS = Limits()
READER = Reader(MassPropertiesRequest, LIMITS)
N = 2000
POINTS = np.random.default_rng(5).normal(size=(N, 3))
GOOD = {"kind": "point-masses", "masses": [1.5] * N, "positions": POINTS.tolist()}


def document(**changes: Any) -> bytes:
    return json.dumps({"body": {**GOOD, **changes}}).encode()


def without_this_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(large_arrays, "LEAST_BYTES", 10**9)


def test_points_arrive_to_the_bit() -> None:
    _, taken = extract_arrays(document(), READER._arrays)
    assert taken is not None
    assert len(taken) == 2
    body = READER.read(document()).body
    assert isinstance(body, PointMasses)
    assert body.positions.tobytes() == POINTS.tobytes()
    assert not body.positions.flags.writeable


def test_rows_do_not_count_as_arrays_of_the_document() -> None:
    strict = Reader(MassPropertiesRequest, Limits(arrays=10))
    assert len(strict.read(document()).body.positions) == N


def test_other_fields_keep_their_arrays() -> None:
    question = {
        "body": {"kind": "principal-moments", "moments": [1, 2, 2.5]},
        "angular_velocity": [0.1, 1, 0.1],
        "times": [0.25] * 5000,
    }
    assert Reader(TrajectoryRequest, LIMITS).read(json.dumps(question).encode()).times == [0.25] * 5000


def changed(row: int, entry: Any, column: int | None = None) -> list[Any]:
    rows = POINTS.tolist()
    if column is None:
        rows[row] = entry
    else:
        rows[row][column] = entry
    return rows


MESH = {"kind": "mesh", "density": 1.0, "vertices": POINTS.tolist()}
FACES = [[0, 1, 2]] * 500
BAD = {
    "a string": document(positions=changed(1997, "1", 1)),
    "true": document(positions=changed(1997, True, 1)),
    "null": document(positions=changed(1997, None, 1)),
    "NaN": document(positions=changed(1997, float("nan"), 1)),
    "an infinity": document(positions=changed(1997, float("inf"), 2)),
    "an overflow": document().replace(repr(POINTS[1500, 1]).encode()[11:-1], b"1e999"),
    "a short row": document(positions=changed(1997, [1.0, 2.0])),
    "a row that is none": document(positions=changed(1997, 3.0)),
    "rows of two": document(positions=POINTS[:, :2].tolist()),
    "a plain list": document(positions=POINTS.ravel().tolist()),
    "rows of masses": document(masses=POINTS.tolist()),
    "a negative mass": document(masses=[1.0] * 1234 + [-1.0] * (N - 1234)),
    "a mass too many": document(masses=[1.0] * (N + 1)),
    "a trailing comma": document().replace(b"]]", b"],]"),
    "an unclosed array": document()[:-3],
    "two documents": document() * 2,
    "an unknown key": document(mass=[0.5] * 500),
    "a field of another kind": document(vertices=POINTS.tolist()),
    "a known name elsewhere": json.dumps({"body": GOOD, "positions": POINTS.tolist()}).encode(),
    "twice": document().replace(b'"masses"', b'"positions": [], "masses"'),
    "twice, both large": document()[:-2] + b', "masses": ' + json.dumps([1.0] * N).encode() + b"}}",
    "in a string": json.dumps({"body": GOOD, "x": '"positions": [' + "1," * 999 + "1]"}).encode(),
    "after a string": document().replace(b'"positions"', b'"x" "positions"'),
    "faces that are no integers": json.dumps({"body": {**MESH, "faces": [[0, 1, 2.0]] * 500}}).encode(),
    "faces that are negative": json.dumps({"body": {**MESH, "faces": [*FACES, [0, -1, 2]]}}).encode(),
    "faces beyond 64 bits": json.dumps({"body": {**MESH, "faces": [*FACES, [0, 2**64, 2]]}}).encode(),
    "faces without vertices": json.dumps({"body": {**MESH, "faces": [*FACES, [0, 2**40, 2]]}}).encode(),
    "an open mesh": json.dumps({"body": {**MESH, "faces": FACES}}).encode(),
}


def refusal(body: bytes) -> tuple[str, str, Any]:
    with pytest.raises(Refusal) as caught:
        READER.read(body)
    problem = caught.value.problem
    return problem.type.code, problem.detail, problem.faults


@pytest.mark.parametrize("name", BAD)
def test_refusals_are_those_of_the_document_as_it_was_sent(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    quick = refusal(BAD[name])
    without_this_path(monkeypatch)
    assert quick == refusal(BAD[name])
    assert large_arrays._TOKEN not in str(quick)


@pytest.mark.parametrize(
    "text",
    [b'"positions":[[1,2],' * 1000, b'{"positions":[[1,2],' * 60 + b"0" * 3000 + b"]}" * 60],
    ids=["never closed", "one in another"],
)
def test_a_text_is_not_gone_through_once_for_each_array(text: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[int] = []

    def looking(document: bytes, start: int, *, whole: bool) -> Any:
        looked.append(start)
        return read_rows(document, start, whole=whole)

    monkeypatch.setattr(large_arrays, "read_rows", looking)
    extract_arrays(text, READER._arrays)
    assert 1 <= len(looked) <= large_arrays.UNREADABLE


def test_a_pointer_leads_to_the_entry() -> None:
    _, _, faults = refusal(BAD["a string"])
    assert [fault.pointer for fault in faults] == ["/body/positions/1997/1"]


def test_a_token_cannot_be_guessed_into_a_document() -> None:
    # Even the right token names nothing but what the same document sent.
    forged = document(positions=f"{large_arrays._TOKEN}-7")
    assert refusal(forged)[2][0].pointer == "/body/positions"
