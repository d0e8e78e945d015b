"""Oracle: Python's conversion of decimals (D. M. Gay's, correctly rounded), and its JSON parser for the grammar."""

import json
import random
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.decimal_rows import MARGIN, POWERS, read_rows


def same(text: str) -> None:
    """Hold the array that is read against Python's, to the bit."""
    found, expected = read_rows(text.encode(), 0), json.loads(text)
    assert found is not None, text[:200]
    flat = [x for row in expected for x in row] if isinstance(expected[0], list) else expected
    assert found.end == len(text.rstrip())
    assert found.values.shape == np.array(expected, dtype=np.float64).shape
    right = found.values.ravel().astype(np.float64).view(np.int64) == np.array(flat, dtype=np.float64).view(np.int64)
    assert right.all(), flat[int(right.argmin())]


def middles(rng: random.Random) -> list[str]:
    """Return decimals at, just above and just below the middle between two doubles, written out."""
    found = []
    for _ in range(2000):
        lower, shift = rng.getrandbits(53) | 1 << 52, rng.randrange(0, 8)
        middle = Fraction(2 * lower + 1) / 2**shift
        if middle.denominator == 1:
            found += [str(int(middle) + d) for d in (-1, 0, 1)]
        digits = 10**shift * middle
        if digits < 10**19:
            found.append(f"{int(digits)}e-{shift}")
    return found


def test_every_double_written_shortest_is_read_back() -> None:
    values = np.frombuffer(random.Random(1).randbytes(8 * 50_000), np.float64)
    same("[" + ",".join(repr(x) for x in values[np.isfinite(values) & (np.abs(values) > 1e-240)].tolist()) + "]")


@pytest.mark.parametrize("form", ["%.3g", "%.6f", "%.15e", "%.16e", "%.17e", "%.18e"])
def test_other_numbers_of_digits_are_rounded_correctly(form: str) -> None:
    values = np.random.default_rng(2).normal(size=20_000) * 10.0 ** np.random.default_rng(3).integers(-30, 30, 20_000)
    same("[" + ",".join(form % x for x in values) + "]")


def test_numbers_between_two_doubles_are_rounded_to_even() -> None:
    # Of those that only Python can tell there may not be too many.
    for batch in np.array_split(np.array(middles(random.Random(4))), 500):
        same("[" + ",".join([*batch.tolist(), *["0.25"] * 300]) + "]")


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(10**25), 10**25), min_size=1))
def test_what_python_writes_is_read_as_python_reads_it(values: list[float]) -> None:
    same(json.dumps(values))


@given(st.text("0123456789.eE+-, []\n\t", max_size=40))
def test_whatever_is_read_is_json_and_equal(inner: str) -> None:
    found = read_rows(f"[{inner}]".encode(), 0)
    if found is not None and found.wrong is None:
        same(f"[{inner}]"[: found.end])


@pytest.mark.parametrize(
    "text",
    [
        "[]", "[[]]", "[1,]", "[,1]", "[1 2]", "[01]", "[-]", "[+1]", "[.5]", "[5.]", "[1e]", "[1e+]", "[0x1]", "[1",
        "[NaN]", "[Infinity]", "[[1,2]", "[[1,2],]", "[[1,2] [3,4]]", "[1}", "[", "[[", "[-", "[1.", "[1e", "[1e-",
        "[" + "9" * 2000 + "]", '[1,"2', "[1,[2", '[1,"2"', "[1,{]", "[[1,2],[3]", "[1,[2]", "[nul",
    ],
)  # fmt: skip
def test_what_is_no_array_of_json_is_left_to_be_looked_at(text: str) -> None:
    assert read_rows(text.encode(), 0) is None


@pytest.mark.parametrize(
    ("text", "before", "wrong"),
    [
        ("[null]", [], "null"),
        ("[1,true,2]", [1], "true"),
        ('[1,2,"a]b",3]', [1, 2], '"a]b"'),
        ("[1,[2],3]", [1], "[2]"),
        ("[{}]", [], "{}"),
        ("[[1,2],[3],[4,5]]", [[1, 2]], "[3]"),
        ("[[1,2],[3,4,5]]", [[1, 2]], "[3,4,5]"),
        ("[[1,2],3]", [[1, 2]], "3"),
        ("[[1,2],[3,null],0]", [[1, 2]], "[3,null]"),
        ('[[1,2],[3,{"a":[1,2]}]]', [[1, 2]], '[3,{"a":[1,2]}]'),
        ("[[[1]]]", [], "[[1]]"),
    ],
)
def test_the_first_entry_that_no_array_of_numbers_can_have_is_told(text: str, before: list[Any], wrong: str) -> None:
    found = read_rows(f"{text},7".encode(), 0)
    assert found is not None
    assert (found.values.tolist(), found.wrong, found.end) == (before, wrong.encode(), len(text))


def test_where_only_integers_will_do_others_are_wrong() -> None:
    found = read_rows(b"[[1,2],[3,4.0],[5,6]]", 0, whole=True)
    assert found is not None
    assert (found.values.tolist(), found.wrong) == ([[1, 2]], b"[3,4.0]")
    assert read_rows(b"[1,9007199254740993]", 0, whole=True) is None


def test_rows_blanks_and_signs() -> None:
    same("[ [ 1 ,\t-2.5e0 ] ,\n [ 0, -0.0 ] ]")
    same("[-0, 0, -0.0, 0e5, -0E-5]")
    found = read_rows(b'xx[1,2],"more"', 2)
    assert found is not None
    assert (found.end, found.values.dtype, found.values.tolist()) == (7, np.int64, [1, 2])


@pytest.mark.parametrize("text", ["[1.0]", "[1e2]", "[9007199254740993]", "[1,2.5]"])
def test_only_integers_that_doubles_hold_are_kept_as_integers(text: str) -> None:
    found = read_rows(text.encode(), 0)
    assert found is not None
    assert found.values.dtype == np.float64


def test_infinity_is_what_overflows() -> None:
    found = read_rows(b"[1e999,-1e999,1e-999]", 0)
    assert found is not None
    assert found.values.tolist() == [np.inf, -np.inf, 0.0]


def test_powers_are_right_to_less_than_the_margin() -> None:
    half = len(POWERS) // 2
    for k, (high, low) in zip(range(-half, half + 1), POWERS.tolist(), strict=True):
        power = Fraction(10) ** k
        assert abs(Fraction(high) + Fraction(low) - power) <= power * Fraction(MARGIN) / 64
