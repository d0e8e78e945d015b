"""Requests as numpy archives: the questions of their JSON, and refusals of everything that is none."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import numpy as np
import pytest

from core.bodies.measured import PointMasses
from service.problems import Refusal
from service.requests.npz_body import MOST_MEMBERS, taking_arrays, unpacked
from service.requests.request_reader import Limits, Reader
from service.routes.bodies import MassPropertiesRequest
from service.routes.rotation.ensemble import EnsembleRequest
from service.routes.rotation.trajectory import TrajectoryRequest

LIMITS = Limits()
READER = Reader(MassPropertiesRequest, LIMITS)
POINTS = np.random.default_rng(5).normal(size=(500, 3))
BODY = {"kind": "point-masses", "masses": 1.5, "positions": {"array": "body/positions"}}
HANDLE = {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}


def saved(array: Any, **options: Any) -> bytes:
    text = io.BytesIO()
    np.save(text, array, **options)
    return text.getvalue()


def packed(members: dict[str, bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    text = io.BytesIO()
    with zipfile.ZipFile(text, "w", compression) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return text.getvalue()


def archive(question: Any, **arrays: Any) -> bytes:
    named = {name.replace("__", "/") + ".npy": saved(array) for name, array in arrays.items()}
    return packed({"metadata.json": json.dumps(question).encode()} | named)


@pytest.mark.parametrize("compression", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("array", [POINTS, np.asfortranarray(POINTS), POINTS.astype(">f8"), POINTS.astype("<f4")])
def test_arrays_arrive_to_the_bit(array: np.ndarray[Any, Any], compression: int) -> None:
    members = {"metadata.json": json.dumps({"body": BODY}).encode(), "body/positions.npy": saved(array)}
    body = READER.read(packed(members, compression), npz=True).body
    assert isinstance(body, PointMasses)
    assert body.positions.tobytes() == np.array(array, np.float64, order="C").tobytes()


def test_numpy_packs_what_is_read() -> None:
    text = io.BytesIO()
    np.savez(text, positions=POINTS)
    with zipfile.ZipFile(text, "a") as more:
        more.writestr("metadata.json", json.dumps({"body": BODY | {"positions": {"array": "positions"}}}))
    np.testing.assert_array_equal(READER.read(text.getvalue(), npz=True).body.positions, POINTS)


def test_what_may_be_anything_takes_arrays_only_where_it_says_so() -> None:
    assert taking_arrays({"type": "any"}, 10) == {"type": "any"}
    assert taking_arrays({"type": "any", "metadata": {"arrays_within": True}}, 10)["type"] == "function-plain"


def test_every_list_may_be_an_array() -> None:
    times, starts = np.linspace(0.0, 1.0, 50), np.array([[0.1, 1.0, 0.1], [1.0, 0.0, 0.2]])
    question = {"body": HANDLE, "angular_velocities": {"array": "starts"}, "times": {"array": "t"}}
    found = Reader(EnsembleRequest, LIMITS).read(archive(question, starts=starts, t=times), npz=True)
    plain = question | {"angular_velocities": starts.tolist(), "times": times.tolist()}
    assert found == Reader(EnsembleRequest, LIMITS).read(json.dumps(plain).encode())


def test_whole_numbers_are_faces() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.uint8)
    mesh = {"kind": "mesh", "density": 1.0, "vertices": {"array": "v"}, "faces": {"array": "f"}}
    body: Any = READER.read(archive({"body": mesh}, v=vertices, f=faces), npz=True).body
    assert (body.faces.tolist(), body.vertices.tolist()) == (faces.tolist(), vertices.tolist())


def refusal(body: bytes, reader: Any = READER) -> tuple[str, str]:
    with pytest.raises(Refusal) as caught:
        reader.read(body, npz=True)
    problem = caught.value.problem
    assert len(problem.body()) <= 2048
    return problem.type.code, problem.faults[0].pointer if problem.faults else problem.detail


@pytest.mark.parametrize(
    ("positions", "pointer"),
    [
        (POINTS[:, :2], "/body/positions/0"),
        (POINTS.ravel(), "/body/positions/0"),
        (np.where(np.arange(1500).reshape(500, 3) == 700, np.nan, POINTS), "/body/positions/233/1"),
        (np.where(np.arange(1500).reshape(500, 3) == 700, np.inf, POINTS), "/body/positions/233/1"),
        (POINTS[:0], "/body/positions"),
    ],
    ids=["rows of two", "a plain list", "NaN", "an infinity", "nothing"],
)
def test_what_no_body_has_is_refused_with_a_pointer(positions: Any, pointer: str) -> None:
    assert refusal(archive({"body": BODY}, body__positions=positions)) == ("invalid-parameter", pointer)


def test_times_that_are_no_times_are_refused_with_a_pointer() -> None:
    question = {"body": HANDLE, "angular_velocity": [0.1, 1.0, 0.1], "times": {"array": "t"}}
    reader = Reader(TrajectoryRequest, LIMITS)
    assert refusal(archive(question, t=np.array([0.0, np.nan])), reader) == ("invalid-parameter", "/times/1")
    assert refusal(archive(question, t=np.zeros((2, 2))), reader) == ("invalid-parameter", "/times/0")


def test_an_array_that_the_document_does_not_name_is_refused() -> None:
    code, detail = refusal(archive({"body": BODY}, body__positions=POINTS, unused=POINTS))
    assert code == "invalid-archive"
    assert "'unused'" in detail


def test_a_reference_to_nothing_is_no_array() -> None:
    with pytest.raises(Refusal, match=r"body/positions\.npy") as missing:
        READER.read(archive({"body": BODY}), npz=True)
    assert missing.value.problem.faults[0].pointer == "/body/positions"
    plain = json.dumps({"body": BODY}).encode()
    with pytest.raises(Refusal) as caught:
        READER.read(plain)
    assert caught.value.problem.faults[0].pointer == "/body/positions"


GOOD = {"metadata.json": json.dumps({"body": BODY}).encode(), "body/positions.npy": saved(POINTS)}
HEADER = b"\x93NUMPY\x01\x00"


def with_header(text: str, data: bytes = b"") -> bytes:
    header = text.encode() + b"\n"
    return HEADER + len(header).to_bytes(2, "little") + header + data


ARRAYS: dict[str, bytes] = {
    "objects": saved(np.array([{"a": 1}], dtype=object), allow_pickle=True),
    "texts": saved(np.array(["a", "b"])),
    "complex numbers": saved(np.zeros(3, complex)),
    "truth values": saved(np.zeros(3, bool)),
    "records": saved(np.zeros(3, [("a", "f8"), ("b", "f8")])),
    "rows of rows of rows": saved(np.zeros((2, 2, 2))),
    "one number": saved(np.float64(1.0)),
    "long doubles": saved(np.zeros(3, np.longdouble)),
    "times of a calendar": saved(np.zeros(3, "M8[s]")),
    "nothing": b"",
    "no header": b"x" * 200,
    "an endless header": HEADER + b"\xff\xff" + b"{" * 70_000,
    "code in the header": with_header("{'descr': exit(), 'fortran_order': False, 'shape': (1,)}"),
    "more numbers than there are": with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 3)}"),
    "fewer numbers than there are": with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (1,)}", bytes(80)),
    "a negative number of numbers": with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}", bytes(8)),
    "two negative numbers": with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (-2, -3)}", bytes(48)),
    "many rows of nothing": with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 0)}"),
    "another version": b"\x93NUMPY\x04\x00" + saved(POINTS)[8:10] + b"\0\0" + saved(POINTS)[10:],
    "more numbers than can be counted": with_header(
        f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({2**40}, {2**40})}}"
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ARRAYS)
def test_what_is_no_array_of_plain_numbers_is_refused(name: str) -> None:
    assert refusal(packed(GOOD | {"body/positions.npy": ARRAYS[name]}))[0] == "invalid-archive"


def test_bytes_that_were_changed_are_refused() -> None:
    whole = packed(GOOD)
    middle = len(whole) // 2
    assert refusal(whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :])[0] == "invalid-archive"
    for end in (0, 10, middle, len(whole) - 1):
        assert refusal(whole[:end])[0] == "invalid-archive"


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{}",
        json.dumps({"body": BODY}).encode(),
        packed({}),
        packed({"body/positions.npy": saved(POINTS)}),
        packed(GOOD | {"../../etc/passwd": b""}),
        packed(GOOD | {"data.pkl": b"cos\nsystem\n(S'true'\ntR."}),
        packed(GOOD, zipfile.ZIP_LZMA),
        packed(GOOD, zipfile.ZIP_BZIP2),
    ],
    ids=["nothing", "an object", "JSON", "empty", "no question", "another name", "a pickle", "LZMA", "bzip2"],
)
def test_what_is_no_archive_is_refused(body: bytes) -> None:
    assert refusal(body)[0] == "invalid-archive"


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_member_named_twice_is_refused() -> None:
    text = io.BytesIO(packed(GOOD))
    with zipfile.ZipFile(text, "a") as more:
        more.writestr("body/positions.npy", saved(POINTS))
    assert refusal(text.getvalue()) == ("invalid-archive", "the body names a member twice")


def test_numbers_of_one_byte_make_no_longer_lists_than_those_of_eight() -> None:
    question = {"body": HANDLE, "angular_velocity": [0.1, 1.0, 0.1], "times": {"array": "t"}}
    reader = Reader(TrajectoryRequest, LIMITS._replace(bytes=8_000))
    assert len(reader.read(archive(question, t=np.zeros(1_000, np.int8)), npz=True).times) == 1_000
    assert refusal(archive(question, t=np.zeros(1_001, np.int8)), reader)[0] == "too-complex"
    assert refusal(archive(question, t=np.zeros((1_001, 1), np.int8)), reader)[0] == "too-complex"


def test_many_members_are_refused_unread() -> None:
    many = {f"{i}.npy": saved(POINTS[:1]) for i in range(MOST_MEMBERS)}
    assert refusal(packed(GOOD | many))[0] == "too-complex"


def test_what_would_unpack_to_more_than_a_body_may_have_is_refused_before_it_is_unpacked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bomb = packed(GOOD | {"more.npy": saved(np.zeros(2_000_000))}, zipfile.ZIP_DEFLATED)
    assert len(bomb) < 100_000
    monkeypatch.setattr(zipfile.ZipFile, "read", None)
    assert refusal(bomb)[0] == "body-too-large"


def test_a_member_that_says_it_is_smaller_than_it_is_gives_no_more() -> None:
    """The sizes in the directory are lies of the client."""
    content = saved(np.zeros(100_000))
    whole = bytearray(packed({"metadata.json": b"{}", "a.npy": content}, zipfile.ZIP_DEFLATED))
    entry = whole.rindex(b"PK\x01\x02")
    assert int.from_bytes(whole[entry + 24 : entry + 28], "little") == len(content)
    whole[entry + 24 : entry + 28] = (200).to_bytes(4, "little")
    with pytest.raises(Refusal):
        unpacked(bytes(whole), 10_000)


def test_the_limits_of_a_document_hold_for_its_question() -> None:
    assert refusal(packed({"metadata.json": b"[" * 100 + b"]" * 100}))[0] == "too-complex"
    assert refusal(packed({"metadata.json": b'{"body": 1, "body": 2}'}))[0] in ("invalid-parameter", "duplicate-key")
