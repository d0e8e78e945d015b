"""Conversions against the definitions of the units (BIPM, The International System of Units, 9th edition, 2019)."""

from __future__ import annotations

import math
import subprocess
import sys
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.assessment import units
from core.assessment.units import factor
from core.errors import InvalidParameter
from core.work import WorkLimitReached, work_limit
from tests.drawn import draws

TURN = 2.0 * math.pi
KNOWN = [
    ("deg", "rad", TURN / 360.0),
    ("°", "rad", TURN / 360.0),
    ("rpm", "rad s^-1", TURN / 60.0),
    ("rev/min", "rad s^-1", TURN / 60.0),
    ("turn/s", "rad s^-1", TURN),
    ("Hz", "rad s^-1", TURN),
    ("kHz", "rad s^-1", 1e3 * TURN),
    ("Hz/s", "rad s^-2", TURN),
    ("Hz", "s^-1", 1.0),
    ("deg/s", "rad s^-1", TURN / 360.0),
    ("1/s", "rad s^-1", 1.0),
    ("1/min", "s^-1", 1.0 / 60.0),
    (" 1 / h", "s^-1", 1.0 / 3600.0),
    ("rad/s", "s^-1", 1.0),
    ("cm", "m", 1e-2),
    ("g", "kg", 1e-3),
    ("g cm^2", "kg m^2", 1e-7),
    ("kg·m²", "kg m^2", 1.0),
    ("kg*m**2", "kg m^2", 1.0),
    ("N m", "J", 1.0),
    ("kg m/s^2", "N", 1.0),
    ("N m s", "kg m^2 s^-1", 1.0),
    ("hours", "s", 3600.0),
    ("Newton", "kg m s^-2", 1.0),
    ("Meter/Second", "m s^-1", 1.0),
    ("h", "s", 3600.0),
    ("min", "s", 60.0),
    ("ms", "s", 1e-3),
    ("hours", "d", 1.0 / 24.0),
    ("d", "s", 86400.0),
    ("mm/s^2", "m s^-2", 1e-3),
    ("km/h", "m s^-1", 1.0 / 3.6),
    ("%", "1", 1e-2),
    ("kN", "N", 1e3),
]


@pytest.mark.parametrize(("given_unit", "unit", "value"), KNOWN)
def test_units_are_what_they_are_defined_to_be(given_unit: str, unit: str, value: float) -> None:
    assert factor(given_unit, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("given_unit", "unit"),
    [("m", "s"), ("rad", "m"), ("flub", "s"), ("degC", "s"), ("deg", "1"), ("kg m", "kg m^2"), ("", "s"), ("Hz", "s")],
)
def test_units_of_other_quantities_are_wrong(given_unit: str, unit: str) -> None:
    with pytest.raises(InvalidParameter):
        factor(given_unit, unit)


@pytest.mark.parametrize(
    ("given_unit", "unit", "value"),
    [
        ("Nm", "J", 1.0),
        ("kNm", "N m", 1e3),
        ("Ncm", "N m", 1e-2),
        ("Nm/rad", "N m", 1.0),
        ("Ns", "N s", 1.0),
        ("kgm²", "kg m^2", 1.0),
        ("kgm2/s2", "J", 1.0),
        ("g cm2", "kg m^2", 1e-7),
        ("rad.s-1", "rad s^-1", 1.0),
        ("deg s⁻¹", "rad s^-1", math.pi / 180.0),
        ("N-m", "J", 1.0),
        ("newton-meters", "J", 1.0),
        ("kg.m².s-1", "kg m^2 s^-1", 1.0),
        ("mN", "N", 1e-3),
        ("kg", "kg", 1.0),
    ],
)
def test_signs_between_symbols_and_powers_may_be_left_out(given_unit: str, unit: str, value: float) -> None:
    assert factor(given_unit, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("given_unit", ["ms^-2", "ms-2", "ms⁻²", "ms**-2", "ms^(-2)"])
def test_metres_per_second_may_be_written_without_a_space(given_unit: str) -> None:
    """Textbooks write ms⁻². Where powers of a millisecond are meant, they measure the quantity."""
    assert factor(given_unit, "m s^-2") == 1.0
    assert factor(given_unit, "rad s^-2") == pytest.approx(1e6)
    with pytest.raises(InvalidParameter):
        factor(given_unit, "m s^-1")


def test_metres_per_second_written_as_milliseconds_are_said_to_be() -> None:
    with pytest.raises(InvalidParameter) as fault:
        factor("ms", "m s^-1")
    assert "ms is a millisecond" in str(fault.value.remedy)
    with pytest.raises(InvalidParameter) as other:
        factor("ms", "kg")
    assert "millisecond" not in str(other.value.remedy)


@pytest.mark.parametrize(
    "hostile",
    [
        *(
            "9" * 10**5,
            "m^99999",
            "(" * 40,
            "__import__('os')",
            "m.__class__",
            "2 m",
            "1e999 m",
            "m**m",
            "s\n",
            "s" * 41,
        ),
        *("\u202em", "𝒎", "m^-", "^2", "m//s", "'m'", "m;s", "{m}", "%" * 9, "-", "...", "m^(2^9)", "𝟙"),
        *("m**9**9**9**9", "kg*9**9**9**9", "((9)^9)^9", "m^9^9", "m ^ 9 ^ 9", "(kg)^9**9"),
    ],
)
def test_hostile_texts_are_no_units(hostile: str) -> None:
    with pytest.raises(InvalidParameter):
        factor(hostile, "kg")


@settings(max_examples=draws(200), deadline=None, derandomize=True)
@given(text=st.text(max_size=45), unit=st.sampled_from(["s", "1", "rad s^-1", "kg m^2"]))
def test_any_text_is_a_unit_or_a_wrong_one(text: str, unit: str) -> None:
    with suppress(InvalidParameter):
        assert 0.0 < factor(text, unit) < math.inf


def test_units_of_the_international_system_import_nothing() -> None:
    code = (
        "import sys; from core.assessment.units import factor; factor('kg*m^2/s', 'kg m^2 s^-1');"
        "factor('rad/s', 's^-1'); assert 'pint' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_importing_the_library_is_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "pint", raising=False)
    units._factor.cache_clear()
    with pytest.raises(WorkLimitReached), work_limit(2000):
        factor("furlong", "m")
