"""Requests of several parts: a document, and a file of columns."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from service.problems import Refusal
from service.requests.request_reader import Limits, Reader
from service.routes.fits import FitRequest
from tests.service.requests.test_npz_body import packed, saved

READER = Reader(FitRequest, Limits())
REQUEST: dict[str, Any] = {
    "question": {"path": "/v1/scenes", "request": {}},
    "data": {"times": "t", "figures": {"x": "p.position.x"}, "standard_deviations": {"x": "sd"}},
    "unknown": [{"pointer": "/let/g"}],
}
TABLE = b"t,x,note,sd\n0,1.5,begins,0.1\n0.5,,lost,0.1\n1e0,-2,,0.2\n"


def form(*parts: tuple[str, bytes], delimiter: bytes = b"--3f2a", end: bytes = b"--\r\n") -> bytes:
    head = b'Content-Disposition: form-data; name="%s"; filename="a"\r\nContent-Type: application/octet-stream'
    chunks = [delimiter + b"\r\n" + head % name.encode() + b"\r\n\r\n" + content + b"\r\n" for name, content in parts]
    return b"".join(chunks) + delimiter + end


def read(columns: bytes, request: Any = REQUEST) -> FitRequest:
    return READER.read(form(("request", json.dumps(request).encode()), ("columns", columns)), npz=True)


@pytest.mark.parametrize(
    "table", [TABLE, TABLE.replace(b",", b";"), TABLE.replace(b",", b"\t"), b"\xef\xbb\xbf" + TABLE]
)
@pytest.mark.parametrize("line", [b"\n", b"\r\n"])
def test_columns_of_a_table(table: bytes, line: bytes) -> None:
    found = read(table.replace(b"\n", line)).data
    # The column that nothing names may hold words.
    assert found.columns == {"t": [0.0, 0.5, 1.0], "x": [1.5, None, -2.0], "sd": [0.1, 0.1, 0.2]}
    assert found.times == "t"


def test_columns_of_an_archive() -> None:
    names = {"t": np.arange(3.0), "x": np.array([1, 2, 3]), "sd": np.full(3, 0.1)}
    found = read(packed({f"{name}.npy": saved(array) for name, array in names.items()})).data
    assert found.columns == {name: array.tolist() for name, array in names.items()}
    names["x"] = np.array([1.0, np.nan, 2.0])
    with pytest.raises(Refusal) as refusal:
        read(packed({f"{name}.npy": saved(array) for name, array in names.items()}))
    assert refusal.value.problem.faults[0].pointer == "/data/columns/x/1"


@pytest.mark.parametrize(
    ("table", "pointer", "detail"),
    [
        (TABLE.replace(b"-2", b"two"), "/data/columns/x/2", "row 2"),
        (TABLE.replace(b"-2", b"nan"), "/data/columns/x/2", "row 2"),
        (TABLE.replace(b"-2", b"1e999"), "/data/columns/x/2", "finite"),
        (TABLE.replace(b"-2", b"1_0"), "/data/columns/x/2", "finite"),
        (TABLE.replace(b"lost,0.1", b"lost"), "/data/columns", "4 cells in row 1"),
        (TABLE.replace(b"note", b"x"), "/data/columns", "different names"),
        (b"", "/data/columns", "different names"),
        (b"\xff\xfe", "/data/columns", "UTF-8"),
    ],
)
def test_cells_that_are_no_numbers_are_named_by_their_row(table: bytes, pointer: str, detail: str) -> None:
    with pytest.raises(Refusal) as refusal:
        read(table)
    fault = refusal.value.problem.faults[0]
    assert fault.pointer == pointer
    assert detail in fault.detail


REQUEST_BYTES = json.dumps(REQUEST).encode()


@pytest.mark.parametrize(
    "body",
    [
        form(("request", REQUEST_BYTES)),
        form(("columns", TABLE)),
        form(("request", REQUEST_BYTES), ("columns", TABLE), end=b""),
        form(("request", REQUEST_BYTES), ("columns", TABLE), delimiter=b"--" + 300 * b"a"),
        form(*(("request", REQUEST_BYTES),) * 20),
        form(("request", b"{"), ("columns", TABLE)),
        form(("request", b"[1]"), ("columns", TABLE)),
        form(("request", b'{"data": 1}'), ("columns", TABLE)),
        form(("request", b'{"data": {"columns": {}}}'), ("columns", TABLE)),
        form(("request", b'{"data": {}, "data": {}}'), ("columns", TABLE)),
        form(("request", 100 * b"[" + 100 * b"]"), ("columns", TABLE)),
        form(("request", REQUEST_BYTES), ("columns", b"PK nothing")),
        b"--",
        b"--a\r\n\r\n--a--",
    ],
)
def test_what_is_no_form_is_refused(body: bytes) -> None:
    with pytest.raises(Refusal):
        READER.read(body, npz=True)
