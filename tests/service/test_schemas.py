"""Requests that hold core's dataclasses, times as they are sampled, and the views of answers."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, nextafter
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from core.errors import BudgetExceeded, InvalidParameter
from core.systems.budget import Budget
from service import VERSION
from service.schemas import (
    SIGNATURE,
    Envelope,
    Matrix,
    QuaternionRow,
    Request,
    Rounding,
    Signature,
    Span,
    Times,
    Vector,
    fields_of,
    sample_count,
    sample_times,
)

LARGEST = nextafter(inf, 0.0)
TIME = st.floats(allow_nan=False, allow_infinity=False)
READ_TIMES: TypeAdapter[Any] = TypeAdapter(Times)


class Asked(Request):
    number: float
    pair: tuple[float, float] = (0.0, 0.0)


class TestRequest:
    @pytest.mark.parametrize(
        "given_fields",
        [
            {},
            {"number": "1.5"},
            {"number": True},
            {"number": None},
            {"number": 1.0, "other": 1},
            {"number": 1.0, "Number": 1},
            {"number": 1.0, "pair": [1.0]},
            {"number": 1.0, "pair": "ab"},
        ],
    )
    def test_it_is_strict_and_closed(self, given_fields: dict[str, Any]) -> None:
        with pytest.raises(ValidationError):
            Asked.model_validate_json(TypeAdapter(Any).dump_json(given_fields))

    def test_it_cannot_be_changed(self) -> None:
        asked = Asked.model_validate_json('{"number": 1, "pair": [1, 2]}')
        assert (asked.number, asked.pair) == (1.0, (1.0, 2.0))
        with pytest.raises(ValidationError):
            asked.number = 2.0


class TestSpan:
    @given(TIME, TIME, st.integers(1, 50))
    @example(-0.5 * LARGEST, 0.5 * LARGEST, 3)
    @example(0.0, LARGEST, 50)
    @example(5e-324, 1e-323, 50)
    @settings(derandomize=True)
    def test_values_are_those_of_linspace_both_ends_included(self, start: float, stop: float, count: int) -> None:
        span = Span(start=start, stop=stop, count=count)
        assume(isfinite(stop - start))
        values = sample_times(span, Budget())
        with np.errstate(over="ignore"):
            np.testing.assert_array_equal(values, np.linspace(start, stop, count))
        assert values.shape == (count,)
        assert values.dtype == np.float64
        assert values[0] == start
        assert count == 1 or values[-1] == stop
        assert np.isfinite(values).all()
        assert (np.diff(values) * np.sign(stop - start) >= 0.0).all()

    @pytest.mark.parametrize(
        "fields",
        [
            {"count": 0},
            {"count": -1},
            {"count": 10**9 + 1},
            {"count": 2.0},
            {"count": True},
            {"start": inf},
            {"stop": None},
            {"step": 1},
        ],
    )
    def test_it_is_refused_where_it_means_nothing(self, fields: dict[str, Any]) -> None:
        with pytest.raises(ValidationError):
            Span(**({"start": 0.0, "stop": 1.0, "count": 2} | fields))


class TestSamples:
    @pytest.mark.parametrize("count", [1, 5, 6, 10**9])
    def test_more_than_an_answer_may_have_are_refused_without_being_made(self, count: int) -> None:
        span = Span(start=0.0, stop=1.0, count=count)
        if count <= 5:
            assert sample_count(span, Budget(samples=5)) == count == len(sample_times(span, Budget(samples=5)))
        else:
            for ask in (sample_count, sample_times):
                with pytest.raises(BudgetExceeded) as caught:
                    ask(span, Budget(samples=5))
                assert caught.value.path == ("times", "count")
                assert (caught.value.needed, caught.value.limit) == (count, 5)
                assert caught.value.remedy

    def test_a_list_is_counted_and_stays_in_its_order(self) -> None:
        times = [3.0, -1.0, 3.0, 0.0]
        assert sample_count(times, Budget(samples=4)) == 4
        found = sample_times(times, Budget(samples=4))
        assert found.tolist() == times
        assert found.dtype == np.float64
        with pytest.raises(BudgetExceeded) as caught:
            sample_count(times, Budget(samples=3))
        assert caught.value.path == ("times",)

    @given(TIME, TIME)
    @example(-LARGEST, LARGEST)
    @example(LARGEST, -LARGEST)
    @example(-0.5 * LARGEST, 0.5 * LARGEST)
    @settings(derandomize=True)
    def test_a_span_wider_than_doubles_is_refused_and_no_other(self, start: float, stop: float) -> None:
        span = Span(start=start, stop=stop, count=3)
        # From half a unit in the last place beyond the largest double on, a difference is rounded to infinity.
        if abs(int(stop) - int(start)) < int(LARGEST) + 2**970:
            assert sample_count(span, Budget()) == 3
        else:
            with pytest.raises(InvalidParameter) as caught:
                sample_count(span, Budget())
            assert caught.value.path == ("times", "stop")


class TestTimes:
    @pytest.mark.parametrize(
        ("sent", "place"),
        [
            ('{"start": 0, "stop": 1, "count": "3"}', ("count",)),
            ('{"start": 0, "stop": 1}', ("count",)),
            ("[0, 1, null]", (2,)),
            ("[]", ()),
        ],
    )
    def test_faults_are_reported_of_the_kind_that_was_sent(self, sent: str, place: tuple[Any, ...]) -> None:
        with pytest.raises(ValidationError) as caught:
            READ_TIMES.validate_json(sent)
        kinds = {tuple(error["loc"][1:]): error["loc"][0] for error in caught.value.errors()}
        wanted = "object" if sent.startswith("{") else "array"
        assert wanted in str(kinds[place])

    def test_both_kinds_are_read(self) -> None:
        assert READ_TIMES.validate_json("[0, -1.5]") == [0.0, -1.5]
        assert READ_TIMES.validate_json('{"start": 0, "stop": 1, "count": 3}') == Span(start=0.0, stop=1.0, count=3)
        with pytest.raises(ValidationError):
            READ_TIMES.validate_json('"0.1"')


class TestRounding:
    read: TypeAdapter[Any] = TypeAdapter(Rounding)

    @pytest.mark.parametrize("sent", ["meaningful", 1, 17])
    def test_digits_are_a_whole_number_or_those_with_a_meaning(self, sent: Any) -> None:
        assert self.read.validate_python(sent) == sent

    @pytest.mark.parametrize("sent", [0, 18, "3", 3.0, True, "all", None])
    def test_nothing_is_taken_for_a_number_of_digits(self, sent: Any) -> None:
        with pytest.raises(ValidationError, match="must be 'meaningful' or an integer from 1 to 17"):
            self.read.validate_python(sent)


@dataclass(frozen=True)
class Found:
    number: float
    named: Any
    listed: tuple[float, ...] = (1.0,)


def test_a_dataclass_is_written_field_by_field_with_mappings_as_objects() -> None:
    array = np.zeros(3)
    found = fields_of(Found(1.5, MappingProxyType({"b": 1, "a": 2})))
    assert list(found) == ["number", "named", "listed"]
    assert type(found["named"]) is dict
    assert list(found["named"].items()) == [("b", 1), ("a", 2)]
    # Arrays are written from where they lie.
    assert fields_of(Found(1.0, array))["named"] is array


def test_an_envelope_is_closed_and_signed() -> None:
    assert SIGNATURE == {"source": "polhode", "version": VERSION}
    Signature.model_validate(SIGNATURE)
    whole = {"signature": SIGNATURE, "warnings": [{"code": "a", "detail": "b"}]}
    assert Envelope.model_validate(whole).warnings[0].pointer is None
    for change in ({"more": 1}, {"warnings": [{"code": "a"}]}, {"signature": {"source": "other", "version": "1"}}):
        with pytest.raises(ValidationError):
            Envelope.model_validate(whole | change)


@pytest.mark.parametrize(
    ("kind", "value"), [(Vector, [1.0] * 3), (QuaternionRow, [1.0] * 4), (Matrix, [[1.0] * 3] * 3)]
)
def test_rows_have_their_lengths(kind: Any, value: list[Any]) -> None:
    view: TypeAdapter[Any] = TypeAdapter(kind)
    assert view.validate_python(value) == value
    for wrong in (value[:-1], [*value, value[0]]):
        with pytest.raises(ValidationError):
            view.validate_python(wrong)
