import json
import math
from dataclasses import dataclass

import numpy as np
import pytest

from service.responses.json_rows import CHUNK, ONE_PIECE, NotFinite, array_size, parts, require_finite, rows, written

RNG = np.random.default_rng(20240229)


@dataclass(frozen=True)
class Figures:
    name: str
    value: float | None


ANSWERS = {
    "scalars": {"a": 1.5, "b": None, "c": [1.0, {"d": "é"}], "model": Figures("x", None)},
    "rows": {"time": RNG.normal(size=5), "rows": RNG.normal(size=(5, 3))},
    "transposed": {"rows": RNG.normal(size=(3, 70000)).T, "one": 1.0},
    "vector": {"first": 1, "time": RNG.normal(size=70001), "last": [1, 2]},
    "nested": {"mesh": {"vertices": RNG.normal(size=(40000, 3)), "faces": RNG.integers(0, 9, (40000, 3))}, "x": 1},
    "several": {"polhodes": [{"points": RNG.normal(size=(n, 3))} for n in (1, 2000, 30000, 0)]},
    "cube": {"members": RNG.normal(size=(7, 5000, 3))},
    "few and long": {"members": RNG.normal(size=(3, 2, 50_000)).transpose(1, 2, 0)},
    "extremes": {"v": np.array([5e-324, 1.7976931348623157e308, -0.0, 0.1] * 20000)},
    "numpy scalar": {"a": np.float64(0.1), "b": np.int64(3)},
}


def plain(value: object) -> object:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Figures):
        return {"name": value.name, "value": value.value}
    if isinstance(value, dict):
        return {key: plain(entry) for key, entry in value.items()}
    return [plain(entry) for entry in value] if isinstance(value, list) else value


def chunks(answer: object) -> list[bytes | memoryview]:
    return [piece for part in parts(answer) for piece in (rows(part) if isinstance(part, np.ndarray) else (part,))]


@pytest.mark.parametrize("name", ANSWERS)
def test_both_ways_of_writing_give_the_same_document(name: str) -> None:
    answer = ANSWERS[name]
    one = written(answer)
    pieces = chunks(answer)
    assert b"".join(pieces) == one
    assert json.loads(one) == plain(answer)
    assert list(json.loads(one)) == list(answer)


@pytest.mark.parametrize(("name", "numbers"), [("transposed", 210_000), ("cube", 105_000), ("few and long", 300_000)])
def test_chunks_are_small(name: str, numbers: int) -> None:
    pieces = chunks(ANSWERS[name])
    assert len(pieces) > numbers // CHUNK
    assert max(map(len, pieces)) < 25 * CHUNK


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("large", [False, True])
def test_what_is_not_finite_is_never_written(bad: float, large: bool) -> None:
    rows = np.zeros((ONE_PIECE if large else 4, 3))
    rows[-1, 1] = bad
    for answer in (
        {"rows": rows},
        {"a": {"b": [rows]}},
        {"model": Figures("x", float(bad))},
        {"a": [1.0, float(bad)]},
        {"a": np.float64(bad)},
        {"a": {"b": float(bad)}},
    ):
        with pytest.raises(NotFinite):
            written(answer)
        with pytest.raises(NotFinite):
            require_finite(answer)


def test_null_is_written_where_it_is_meant() -> None:
    assert written({"energy": None, "null": "null"}) == b'{"energy":null,"null":"null"}'


def test_size_counts_numbers_in_arrays_at_any_depth() -> None:
    assert array_size({"a": np.zeros((2, 3)), "b": [np.zeros(4), {"c": np.zeros(5)}], "d": "text", "e": 1.0}) == 15


DECIMALS = [f"{x:.40e}" for x in RNG.normal(size=30_000).tolist()]
STRINGS = {
    "time": DECIMALS,
    "rows": [DECIMALS[i : i + 3] for i in range(0, 30_000, 3)],
    "long": ["1." + "3" * 230] * 13_000,
    "none": [],
    "names": ["a", "b"],
    "signature": {"source": "polhode"},
}


def test_decimal_strings_are_counted_and_written_in_small_chunks() -> None:
    assert array_size(STRINGS) == 30_000 + 30_000 + 13_000 + 2
    pieces = chunks(STRINGS)
    assert b"".join(pieces) == written(STRINGS)
    assert json.loads(written(STRINGS)) == STRINGS
    assert max(map(len, pieces)) < 25 * CHUNK


@pytest.mark.parametrize(
    "hidden",
    [
        {"a": None, "b": {"c": math.nan}},
        {"a": None, "b": math.inf},
        {"null": 1.0, "a": [math.nan]},
        {"a": [None, math.nan]},
    ],
)
def test_nulls_of_its_own_hide_no_other(hidden: dict[str, object]) -> None:
    with pytest.raises(NotFinite):
        written(hidden)


def test_nulls_of_its_own_are_written() -> None:
    for own in (
        {"a": None, "b": "null", "c": None},
        {"a": {"b": None}},
        {"null": None},
        {"a": None, "b": np.arange(3.0)},
    ):
        assert json.loads(written(own)) == {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in own.items()}
