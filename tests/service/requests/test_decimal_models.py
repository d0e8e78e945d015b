"""Forms whose numbers may be decimal strings, held against the decimal module, which reads them by its own rules."""

from __future__ import annotations

import dataclasses
import json
from decimal import Decimal, InvalidOperation, localcontext
from fractions import Fraction
from math import inf, nextafter
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from core.bodies import Body
from core.bodies.exact_bodies import MOST_PARTS
from core.digits.exact_inputs import LARGEST_EXPONENT, LONGEST_NUMERAL
from core.errors import BudgetExceeded, InvalidParameter, MechanicsError, NotApplicable
from core.quantities import members_of
from core.scenes.friction import Friction
from service.requests.decimal_models import (
    DecimalBody,
    DecimalEnergy,
    DecimalRate,
    DecimalSpan,
    DecimalTime,
    DecimalTimes,
    DigitCount,
    body_of,
    decimal_model_for,
    explicit_fields,
    fields_in_numerals,
    instants,
)
from service.routes import questions
from tests.drawn import draws

NUMERAL: TypeAdapter[Any] = TypeAdapter(DecimalTime)
TIMES: TypeAdapter[Any] = TypeAdapter(DecimalTimes)
BODY: TypeAdapter[Any] = TypeAdapter(DecimalBody)
DOUBLE = st.floats(allow_nan=False, allow_infinity=False)
CUBOID: dict[str, Any] = {"kind": "cuboid", "edges": [1.0, 2.0, 0.5], "mass": 3.0}


def reads(value: object) -> bool:
    try:
        NUMERAL.validate_json(json.dumps(value))
    except ValidationError:
        return False
    return True


def decimal(text: str) -> Decimal | None:
    """Return what the decimal module reads, None for what is no finite number to it."""
    try:
        number = Decimal(text)
    except InvalidOperation:
        return None
    return number if number.is_finite() else None


NEARLY = st.text("0123456789+-.eE", max_size=12) | st.text("01.e_ \n\t٣nIaf", max_size=6)


class TestNumeral:
    @given(NEARLY)
    @example("1\n")
    @example(" 1")
    @example("1_000")
    @example("٣")
    @example("NaN")
    @example("Infinity")
    @example("1e")
    @example(".")
    @example("")
    @settings(deadline=None, derandomize=True, max_examples=draws(500))
    def test_strings_are_read_as_decimals_are_and_no_others(self, text: str) -> None:
        """Without what only the decimal module takes: spaces, underscores, digits of other scripts, long exponents."""
        exponent = text.lower().partition("e")[2].lstrip("+-")
        number = decimal(text) if text.isascii() and not set(text) & set("_ \n\t") and len(exponent) <= 5 else None
        assert reads(text) is (number is not None)
        if number is not None and int(exponent or 0) <= LARGEST_EXPONENT:
            assert instants([text]) == (Fraction(number),)

    @given(st.decimals(allow_nan=False, allow_infinity=False))
    @settings(deadline=None, derandomize=True)
    def test_whatever_decimals_write_is_read_as_the_same_number(self, number: Decimal) -> None:
        assume(abs(number.adjusted()) < 900)
        for text in (str(number), f"{number:E}", f"{number:f}"):
            if len(text) <= LONGEST_NUMERAL:
                assert reads(text)
                (found,) = instants([NUMERAL.validate_json(json.dumps(text))])
                with localcontext() as context:
                    context.prec = 4000
                    assert found == Fraction(number)
                    assert Decimal(found.numerator) / Decimal(found.denominator) == number

    @given(DOUBLE)
    @settings(deadline=None, derandomize=True)
    def test_a_json_number_is_the_double_that_it_is_parsed_to(self, number: float) -> None:
        found = NUMERAL.validate_json(json.dumps(number))
        assert type(found) is float
        assert instants([found]) == (Fraction(Decimal(number)),)

    def test_one_tenth_is_not_its_nearest_double(self) -> None:
        assert instants(["0.1", 0.1]) == (Fraction(1, 10), Fraction(3602879701896397, 2**55))
        assert instants(["1e3", "-.5", "+2.", "00"]) == (1000, Fraction(-1, 2), 2, 0)

    @pytest.mark.parametrize("value", [None, True, False, [], {}, ["1"], {"a": "1"}])
    def test_nothing_else_is_a_number(self, value: object) -> None:
        assert not reads(value)

    @pytest.mark.parametrize("text", ["NaN", "Infinity", "-Infinity", "1e999", "-1e999"])
    def test_what_is_not_finite_is_refused(self, text: str) -> None:
        with pytest.raises(ValidationError):
            NUMERAL.validate_json(text)

    def test_the_refusal_says_what_a_number_may_be(self) -> None:
        with pytest.raises(ValidationError) as caught:
            NUMERAL.validate_json('"one"')
        (fault,) = caught.value.errors()
        assert fault["type"] == "numeral"
        assert '"0.1"' in fault["msg"]
        assert str(LONGEST_NUMERAL) in fault["msg"]

    def test_lengths_and_exponents_have_their_limits(self) -> None:
        assert reads("1" * LONGEST_NUMERAL)
        assert not reads("1" * (LONGEST_NUMERAL + 1))
        assert instants([f"1e{LARGEST_EXPONENT}", f"1e-{LARGEST_EXPONENT}"])[0] == 10**LARGEST_EXPONENT
        for text in (f"1e{LARGEST_EXPONENT + 1}", f"1e-{LARGEST_EXPONENT + 1}", "1e99999"):
            assert reads(text)
            with pytest.raises(InvalidParameter) as caught:
                instants(["0", text])
            assert caught.value.path == ("times", 1)
        assert not reads("1e100000")

    @pytest.mark.parametrize(("form", "unit"), [(DecimalRate, "rad s^-1"), (DecimalEnergy, "J")])
    def test_its_schema_states_the_unit_of_both_forms(self, form: Any, unit: str) -> None:
        schema = TypeAdapter(form).json_schema()
        assert schema == {"anyOf": [{"type": kind, "x-unit": unit} for kind in ("number", "string")]}

    @pytest.mark.parametrize("count", [15, 1001, 16.0, "16", True, None])
    def test_digits_are_a_whole_number_within_their_limits(self, count: object) -> None:
        digits: TypeAdapter[int] = TypeAdapter(DigitCount)
        assert [digits.validate_json(text, strict=True) for text in ("16", "1000")] == [16, 1000]
        with pytest.raises(ValidationError):
            digits.validate_json(json.dumps(count), strict=True)


class TestTimes:
    @given(DOUBLE | st.just("0.1"), DOUBLE | st.just("1e-30"), st.integers(1, 40))
    @example("0", "1", 4)
    @settings(deadline=None, derandomize=True)
    def test_spans_are_exactly_even_and_hold_both_ends(self, start: Any, stop: Any, count: int) -> None:
        sent = json.dumps({"start": start, "stop": stop, "count": count})
        found = instants(TIMES.validate_json(sent, strict=True))
        first, last = (Fraction(Decimal(end)) for end in (start, stop))
        assert len(found) == count
        assert found[0] == first
        assert count == 1 or found[-1] == last
        assert all(count == 1 or (count - 1) * (found[i + 1] - found[i]) == last - first for i in range(count - 1))

    @given(st.lists(DOUBLE.map(repr) | DOUBLE, min_size=1, max_size=6))
    @settings(deadline=None, derandomize=True)
    def test_lists_keep_their_order_and_numbers(self, times: list[Any]) -> None:
        assert instants(TIMES.validate_json(json.dumps(times))) == tuple(Fraction(Decimal(t)) for t in times)

    @pytest.mark.parametrize(
        "bad",
        ["[]", '"0.1"', '{"start": 0, "stop": 1}', '{"start": 0, "stop": 1, "count": 0}', '{"start": null}', "[[]]"],
    )
    def test_what_is_neither_is_refused(self, bad: str) -> None:
        with pytest.raises(ValidationError):
            TIMES.validate_json(bad, strict=True)

    @pytest.mark.parametrize("name", ["start", "stop"])
    def test_faults_of_a_span_are_reported_by_name(self, name: str) -> None:
        span = {"start": "0", "stop": "1", "count": 2} | {name: "1e2000"}
        with pytest.raises(InvalidParameter) as caught:
            instants(DecimalSpan.model_validate(span))
        assert caught.value.path == ("times", name)


# Meshes are summed in doubles.
IN_NUMERALS = [member for member in members_of(Body) if member.kind != "mesh"]  # type: ignore[attr-defined]
SHOWN = [
    body
    for route in questions()
    for shown in route.examples.values()
    if isinstance(body := shown.question.get("body"), dict) and body["kind"] != "mesh"
]


def in_strings(value: Any) -> Any:
    """Return a document with every number as the shortest decimal string of it."""
    if isinstance(value, dict):
        return {name: in_strings(entry) for name, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [in_strings(entry) for entry in value]
    return repr(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else value


class TestForms:
    @pytest.mark.parametrize("member", IN_NUMERALS, ids=lambda member: member.__name__)
    def test_it_has_the_fields_of_every_body(self, member: Any) -> None:
        for entry in dataclasses.fields(member):
            assert DecimalBody.model_fields[entry.name].is_required() is (entry.name == "kind")

    def test_every_body_but_a_mesh_has_one(self) -> None:
        assert set(DecimalBody.model_json_schema()["$defs"]["DecimalBody"]["properties"]["kind"]["enum"]) == {
            member.kind for member in IN_NUMERALS
        }
        with pytest.raises(ValidationError):
            BODY.validate_python({"kind": "mesh"})

    def test_a_scene_has_a_form_with_its_own_defaults(self) -> None:
        form = decimal_model_for(Friction)
        assert form is decimal_model_for(Friction)
        assert [*form.model_fields] == [*fields_in_numerals(Friction)] == ["static", "kinetic"]
        given = {"static": ("0.3", 0.2), "kinetic": (0.1, "0.1")}
        assert explicit_fields(form.model_validate_json(json.dumps(given))) == given

    @pytest.mark.parametrize("body", SHOWN, ids=lambda body: str(body["kind"]))
    def test_bodies_are_read_in_doubles_and_in_strings(self, body: dict[str, Any]) -> None:
        for sent in (body, in_strings(body)):
            read = BODY.validate_json(json.dumps(sent), strict=True)
            assert json.loads(json.dumps(explicit_fields(read))) == json.loads(json.dumps(sent))

    @pytest.mark.parametrize(
        "change",
        [
            {"kind": "cube"},
            {"kind": None},
            {"edges": [1.0, 2.0]},
            {"edges": ["1", "2", "three"]},
            {"edges": "123"},
            {"mass": True},
            {"more": 1},
        ],
    )
    def test_form_is_checked_and_nothing_is_guessed(self, change: dict[str, Any]) -> None:
        with pytest.raises(ValidationError):
            BODY.validate_json(json.dumps(CUBOID | change), strict=True)

    def test_what_was_not_given_is_left_out(self) -> None:
        form = BODY.validate_json(json.dumps(CUBOID))
        assert explicit_fields(form) == CUBOID | {"edges": (1.0, 2.0, 0.5)}
        assert explicit_fields(form, "mass", "kind") == {"edges": (1.0, 2.0, 0.5)}


def read(body: dict[str, Any]) -> Any:
    return BODY.validate_json(json.dumps(body), strict=True)


EDGE = st.integers(1, 10**6).map(lambda n: f"{n}e-3")


class TestBodyOf:
    @given(st.tuples(EDGE, EDGE, EDGE), EDGE)
    @settings(deadline=None, derandomize=True, max_examples=draws(40))
    def test_a_cuboid_is_exactly_what_it_says(self, edges: tuple[str, str, str], mass: str) -> None:
        found = body_of(read({"kind": "cuboid", "edges": edges, "mass": mass}))
        a, b, c = (Fraction(Decimal(edge)) for edge in edges)
        m = Fraction(Decimal(mass))
        assert found.mass == m
        diagonal = [row[i] for i, row in enumerate(found.inertia)]
        assert diagonal == [m * (b * b + c * c) / 12, m * (c * c + a * a) / 12, m * (a * a + b * b) / 12]

    @pytest.mark.parametrize(
        ("body", "error", "path"),
        [
            (CUBOID | {"mass": "-1e2000"}, InvalidParameter, ("body", "mass")),
            (CUBOID | {"mass": "1e400"}, InvalidParameter, ("body", "mass")),
            (CUBOID | {"edges": ["1", "-2", "3"]}, InvalidParameter, ("body", "edges", 1)),
            (CUBOID | {"radius": 1}, InvalidParameter, ("body", "radius")),
            ({"kind": "cuboid", "mass": 1}, InvalidParameter, ("body", "edges")),
            ({"kind": "ball", "radius": "1", "density": "1"}, NotApplicable, ("body", "density")),
            (
                {"kind": "composite", "parts": [{"body": {"kind": "ball", "radius": "1", "density": "1"}}]},
                NotApplicable,
                ("body", "parts", 0, "body", "density"),
            ),
            (
                {"kind": "composite", "parts": [{"body": CUBOID}] * (MOST_PARTS + 1)},
                BudgetExceeded,
                ("body", "parts"),
            ),
        ],
        ids=lambda value: value["kind"] if isinstance(value, dict) else None,
    )
    def test_faults_are_reported_as_seen_from_the_question(
        self, body: dict[str, Any], error: type[MechanicsError], path: tuple[Any, ...]
    ) -> None:
        with pytest.raises(error) as caught:
            body_of(read(body))
        assert type(caught.value) is error
        assert caught.value.path == path

    def test_the_remedy_of_an_error_is_given_too(self) -> None:
        with pytest.raises(NotApplicable) as caught:
            body_of(read({"kind": "ball", "radius": "1", "density": "1"}))
        assert caught.value.remedy

    def test_the_largest_double_is_itself(self) -> None:
        largest = nextafter(inf, 0.0)
        assert body_of(read(CUBOID | {"mass": largest})).mass == int(largest)
