"""What students type: numbers in the notations of several countries, with units, formulas and words."""

from __future__ import annotations

from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.assessment.claims import Claim
from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.typed_entry import TypedEntry, typed_entry
from core.assessment.typed_number import Locale
from core.errors import InvalidParameter


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("6,28 s", 6.28, "s"),
        ("2,75", 2.75, None),
        ("0,125 m", 0.125, "m"),
        (",5", 0.5, None),
        ("6.28s", 6.28, "s"),
        ("1.234", 1.234, None),
        ("1 234,5 N", 1234.5, "N"),
        ("1\u202f234\u202f567,25 Pa", 1234567.25, "Pa"),
        ("1'234.5", 1234.5, None),
        ("1,234.5", 1234.5, None),
        ("1.234,5", 1234.5, None),
        ("1,234,567", 1234567.0, None),
        ("1e3", 1000.0, None),
        ("\u22122.5E-3 kg\u00b7m\u00b2", -0.0025, "kg\u00b7m\u00b2"),
        ("3\u00b710\u00b2 N", 300.0, "N"),
        ("3\u00d710\u207b\u00b2", 0.03, None),
        ("3 x 10^-2 m", 0.03, "m"),
        ("2,5*10^3", 2500.0, None),
        ("10^3 Pa", 1000.0, "Pa"),
        ("30\u00b0", 30.0, "\u00b0"),
        ("9,81 m/s\u00b2", 9.81, "m/s\u00b2"),
        ("[1,2,3] m", [1, 2, 3], "m"),
        ("[1,5; 2; -3,25]", [1.5, 2.0, -3.25], None),
        ("(1.5, 2) m", [1.5, 2.0], "m"),
        ("{1,5; 2} m", [1.5, 2.0], "m"),
        ("1,5; 2; 3 kg m", [1.5, 2.0, 3.0], "kg m"),
        ("(1,5 | 2)", [1.5, 2.0], None),
        ("T = 6,28 s", 6.28, "s"),
        ("\u2248 6,28 s", 6.28, "s"),
        ("S = m*g/2 = 20,58 N", 20.58, "N"),
        ("T = 2π/ω = 6,28 s", 6.28, "s"),
        ("|F| = 3 N", 3.0, "N"),
        ("-2,95 m/s\u00b2.", -2.95, "m/s\u00b2"),
        ("120 r.p.m.", 120.0, "rpm"),
        ("ca. 12,3 N", 12.3, "N"),
        ("F \u2248 ca. 12,3 N", 12.3, "N"),
        ("Circa -3 m", -3.0, "m"),
        ("6,28 [s]", 6.28, "s"),
        ("2 kg\u22c5m\u00b2", 2.0, "kg\u00b7m\u00b2"),
        ("9,5 1/min", 9.5, "1/min"),
        ("-30\u00b0 15\u2032", -30.25, "\u00b0"),
        ("30\u00b0 15' 36''", 30.26, "\u00b0"),
        ("30\u00b0 15'/s", 30.25, "\u00b0/s"),
        ("TRUE", True, None),
        ("nein", False, None),
        ("keine", None, None),
        ("0,1047 min", 0.1047, "min"),
        ("null", None, None),
        ("falsch.", False, None),
        ("|ω| ≅ 3 rad/s", 3.0, "rad/s"),
        ("T: about 6.28 s", 6.28, "s"),
        ("6,28.10⁻³ s", 0.00628, "s"),
        ("1 rads^-1", 1.0, "rad s^-1"),
        ("1 rads/s", 1.0, "rad/s"),
        ("5 m s-1", 5.0, "m s-1"),
        ("5 kg m-1 s^-2", 5.0, "kg m-1 s^-2"),
        ("[1 2.5 -3] m", [1.0, 2.5, -3.0], "m"),
        ("[5/2, 5, 13/2] m", [2.5, 5.0, 6.5], "m"),
        ("[√2; 0] m", [2**0.5, 0.0], "m"),
        ("2.5, 5, 6.5 m", [2.5, 5.0, 6.5], "m"),
        ("(2.5,5,6.5) m", [2.5, 5.0, 6.5], "m"),
        ("<1, 2> m", [1.0, 2.0], "m"),
        ("1,5 m; 2 m", [1.5, 2.0], "m"),
        ("2,5 kg, 5 kg", [2.5, 5.0], "kg"),
    ],
)
def test_values_with_units(text: str, value: Any, unit: str | None) -> None:
    assert typed_entry(text) == TypedEntry(value, unit)


@pytest.mark.parametrize(
    ("text", "formula", "unit"),
    [
        ("2*pi s", "2*pi", "s"),
        ("2\u03c0 s", "2*pi", "s"),
        ("M*g\u00b7sin(alpha)/3", "M*g*sin(alpha)/3", None),
        ("2,5*m*g", "2.5*m*g", None),
        ("sqrt(2) m/s", "sqrt(2)", "m/s"),
        ("tan(25\u00b0)", "tan(25*pi/180)", None),
        ("2*sin 7,5\u00b0 N", "2*sin(7.5*pi/180)", "N"),
        ("2\u221a3 m", "2*sqrt(3)", "m"),
        ("0,5 \u03c0/3", "0.5*pi/3", None),
        ("2 sin(a) m", "2*sin(a)", "m"),
        ("\u221a(2,5/k)", "sqrt(2.5/k)", None),
        ("v = (m + M)*g", "(m + M)*g", None),
        ("(2,5)*m", "(2.5)*m", None),
        ("2,5 - -3 m", "2.5 - -3", "m"),
        ("2*-3 m", "2*-3", "m"),
        ("2 + 3 + 4 m", "2 + 3 + 4", "m"),
        ("1 - 2/3", "1 - 2/3", None),
        ("2 - pi", "2 - pi", None),
        ("2-3*m", "2-3*m", None),
        ("a + -b", "a + -b", None),
        ("2 Pi s", "2*pi", "s"),
        ("3/2 π m", "3/2*pi", "m"),
        ("Arctg(1/√2)", "atan(1/sqrt(2))", None),
        ("tan⁻¹(a)", "atan(a)", None),
        ("sin^(-1)(a)", "asin(a)", None),
    ],
)
def test_formulas(text: str, formula: str, unit: str | None) -> None:
    assert typed_entry(text) == TypedEntry(None, unit, formula)


def test_a_word_may_be_a_choice_or_a_name() -> None:
    assert typed_entry("saddle") == TypedEntry("saddle", None, "saddle")


@pytest.mark.parametrize(
    ("text", "locale", "value"),
    [
        ("1,234", "de", 1.234),
        ("1,234", "fr", 1.234),
        ("1,234", "es", 1.234),
        ("1,234", "en", 1234.0),
        ("1,5", "en", 1.5),
        ("1,234.5", "en", 1234.5),
        ("1.234,5", "de", 1234.5),
        ("1.234.567", "es", 1234567.0),
        ("2.10^3", "fr", 2000.0),
        ("1,5.10^(-3)", "de", 0.0015),
        ("6'28", "es", 6.28),
        ("6'280", "es", 6280.0),
    ],
)
def test_a_locale_decides_what_a_comma_is(text: str, locale: Locale, value: float) -> None:
    assert typed_entry(text, locale).value == value


@pytest.mark.parametrize(
    ("text", "locale"),
    [
        ("1,234", None),
        ("12,345 kg", None),
        ("1.234", "de"),
        ("1.2.3", None),
        ("1,23,456", None),
        ("1,5,5", "de"),
        ("1.000,5 s", "en"),
        ("2.153,0 s", "en"),
        ("1.234.567", "en"),
        ("2,153.0 s", "de"),
        ("2,153.0 s", "fr"),
        ("1,234,567", "es"),
        ("  ", None),
        ("T =", None),
        ("6,28 ± 0,01 s", None),
        ("2.5 +- 0.347 s", None),
        ("2.5+-0.347", None),
        ("2.5 \u2212+ 0.347 s", None),
        ("2.5 +\u2212 0.347 s", "en"),
        ("2.5 (+-0.3) s", None),
        ("2.5 + - 0.347 s", None),
        ("2.5 - + .347 s", "en"),
        ("2.10^3", None),
        ("2·10-3 m", "de"),
        ("6.2-6.3 s", "en"),
        ("6,2–6,3 s", "de"),
        ("6,28 +0,01 s", "fr"),
        ("6,28 -0,01", "es"),
        ("T = 6.28+0.01 s", None),
        ("6.2 s - 6.3 s", None),
        ("6.28 s + 0.01 s", None),
        ("2.5 m s^-1 - 3 m s^-1", None),
        ("35°-36°", None),
        ("-3 - -2 m", None),
        ("2·10²-3·10² N", None),
        ("6.2-6.3 1/s", None),
        ("[1-2; 3] m", None),
        ("6.28(1) s", None),
        ("6,283(12)", "de"),
        ("1/2π Hz", None),
        ("1/2sin(a)", "en"),
        ("6 s 280 ms", None),
        ("6.28 s or 6.29 s", "en"),
        ("[1 234 567]", None),
        ("[1 m, 2 kg]", None),
        ("--2.153 s", None),
        ("2*m --3", None),
        ("1,5; 2 m; 3", None),
        ("(1, x)", None),
        ("1;", None),
        (";", None),
        ("1; x", None),
        ("[1; 2 m; 3]", None),
        ("(1; 2", None),
        ("{", None),
    ],
)
def test_what_can_be_read_in_two_ways_or_in_none_is_refused(text: str, locale: Locale | None) -> None:
    with pytest.raises(InvalidParameter):
        typed_entry(text, locale)


def test_both_readings_are_in_the_remedy_and_can_be_read() -> None:
    with pytest.raises(InvalidParameter, match=r"1,234 may be 1234 or 1\.234") as fault:
        typed_entry("1,234")
    assert fault.value.remedy == "write 1234 or 1,2340"
    assert typed_entry("1234").value == 1234.0
    assert typed_entry("1,2340").value == 1.234


def test_the_reading_with_a_decimal_comma_has_one_where_the_comma_decides() -> None:
    with pytest.raises(EntryFault) as fault:
        typed_entry("14.715 N", "de")
    assert fault.value.sentence.text("de") == "14.715 kann 14715 oder 14,715 bedeuten. Schreiben Sie 14715 oder 14,715."
    assert typed_entry("14,715 N", "de").value == 14.715


def test_a_range_or_a_value_with_its_error_is_told_how_to_be_written() -> None:
    with pytest.raises(EntryFault, match="6,2-6,3 s may be a calculation, a range") as fault:
        typed_entry("T = 6,2-6,3 s", "de")
    with pytest.raises(EntryFault, match="a range, or a value with its error"):
        typed_entry("6.28(1) s")
    assert fault.value.sentence.text("en") == (
        "6,2-6,3 s can mean a calculation, a range, or a value with its uncertainty. "
        "Write the result as a single number."
    )


@pytest.mark.parametrize(
    ("text", "unit", "value", "given"),
    [
        ("60/min", "rad s^-1", 60.0, "1/min"),
        ("1/s", "rad s^-1", 1.0, "1/s"),
        ("6,28·s", "s", 6.28, "s"),
        ("2*kg*m", "kg m", 2.0, "kg*m"),
    ],
)
def test_a_number_and_its_unit_may_have_a_sign_between(text: str, unit: str, value: float, given: str) -> None:
    claim = Claim.read({"text": text}).as_quantity(unit, {"M": 1})
    assert (claim.value, claim.unit, claim.formula) == (value, given, None)


@pytest.mark.parametrize(("text", "unit", "names"), [("5*m", "m", {"m"}), ("1.5*g", "N", set()), ("2*x", "m", set())])
def test_names_come_before_units_and_other_words_are_names(text: str, unit: str, names: set[str]) -> None:
    claim = Claim.read({"text": text})
    assert claim.as_quantity(unit, names) is claim


WRITTEN = {"en": ".", "de": ",", "es": ",", "fr": ","}


@given(
    st.integers(-(10**9), 10**9),
    st.integers(0, 6),
    st.integers(-30, 30),
    st.sampled_from(get_args(Locale)),
    st.sampled_from(["", " ", "\u202f"]),
    st.sampled_from(["", "e{}", "\u00b710^{}", " x 10^{}", "*10**{}"]),
)
def test_numbers_come_back_as_they_were_written(
    digits: int, places: int, exponent: int, locale: Locale, group: str, power: str
) -> None:
    """The double is that of Python's own reading of the same decimal."""
    sign, text = "-" * (digits < 0), str(abs(digits)).rjust(places + 1, "0")
    whole, part = text[: len(text) - places], text[len(text) - places :]
    grouped = f"{int(whole):,}".replace(",", group) if group else whole
    written = sign + grouped + (WRITTEN[locale] + part if part else "") + power.format(exponent)
    expected = float(f"{sign}{whole}.{part or 0}e{exponent if power else 0}")
    assert typed_entry(f"{written} m", locale) == TypedEntry(expected, "m")


NOTHING = {"null", "none", "keine", "keiner", "aucun", "aucune", "ninguno", "ninguna"}


@given(st.text(max_size=40))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        found = typed_entry(text)
    except InvalidParameter:
        return
    assert found.value is not None or found.formula is not None or text.strip().lower() in NOTHING


def test_a_unit_of_its_own_takes_precedence() -> None:
    assert Claim.read({"text": "6,28 s", "unit": "min"}).unit == "s"
    assert Claim.read({"text": "6,28", "unit": "min"}).unit == "min"


def test_commas_before_spaces_separate_where_the_comma_is_decimal() -> None:
    assert typed_entry("[1,5, 2, 3,25] m", "de") == TypedEntry([1.5, 2.0, 3.25], "m")
    assert typed_entry("[1, 2, 3] m", "de") == TypedEntry([1, 2, 3], "m")


def test_a_list_may_have_times_beside_it() -> None:
    claim = Claim.read({"text": "[1,5; 2] N", "times": [0.0, 1.0]}, "de")
    assert claim.times is not None
    assert (claim.value.tolist(), claim.unit, claim.times.tolist()) == ([1.5, 2.0], "N", [0.0, 1.0])
    with pytest.raises(InvalidParameter, match="3 entries, one for each time"):
        Claim.read({"text": "[1,5; 2] N", "times": [0.0, 1.0, 2.0]}, "de")


@pytest.mark.parametrize("other", [{"value": 1}, {"formula": "x"}])
def test_a_text_stands_alone(other: dict[str, Any]) -> None:
    with pytest.raises(InvalidParameter, match="beside a text"):
        Claim.read({"text": "1", **other})


@pytest.mark.parametrize("text", ["1e400", "x" * 301, 3, ["1"]])
def test_texts_that_cannot_be_read(text: Any) -> None:
    with pytest.raises(InvalidParameter) as fault:
        Claim.read({"text": text})
    assert fault.value.path == ("text",)


@pytest.mark.parametrize(
    "text", ["2 N nach unten", "3 m/s to the right", "4 N vers la droite", "5 m hacia arriba", "1 N up"]
)
def test_a_direction_in_words_is_asked_for_as_a_sign(text: str) -> None:
    with pytest.raises(EntryFault) as raised:
        typed_entry(text)
    assert raised.value.sentence.key == "direction-in-words"
