"""Units in words: every symbol of the table is the unit that it should be, and nothing else of a unit changes."""

from __future__ import annotations

import pytest

from core.assessment.typed_number import Locale
from core.assessment.unit_words import SHARED, WORDS, in_symbols
from core.assessment.units import factor
from core.errors import InvalidParameter

MEASURED = {
    "s": ("s", 1.0),
    "min": ("s", 60.0),
    "h": ("s", 3600.0),
    "d": ("s", 86400.0),
    "mm": ("m", 1e-3),
    "cm": ("m", 1e-2),
    "m": ("m", 1.0),
    "km": ("m", 1e3),
    "g": ("kg", 1e-3),
    "kg": ("kg", 1.0),
    "t": ("kg", 1e3),
    "rad": ("rad", 1.0),
    "deg": ("rad", 0.017453292519943295),
    "gon": ("rad", 0.015707963267948967),
    "turn": ("rad", 6.283185307179586),
    "J": ("J", 1.0),
    "kgf": ("N", 9.80665),
    "N m": ("J", 1.0),
    "rpm": ("rad s^-1", 0.10471975511965977),
}
"""Values of the symbols in units of the International System, of which all but two are in its brochure (9th edition,
tables 2 to 8); the gon is a four-hundredth of a turn, kgf the weight of a kilogram at 9.80665 m/s^2."""


def test_every_symbol_is_the_unit_that_it_should_be() -> None:
    symbols = {symbol for words in (SHARED, *WORDS.values()) for symbol in words.values()}
    assert symbols == {*MEASURED, "/"}
    for symbol, (unit, value) in MEASURED.items():
        assert factor(symbol, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("written", "locale", "symbols"),
    [
        ("Sekunden", "de", "s"),
        ("Sek.", "de", "s"),
        ("Grad/s", "de", "deg/s"),
        ("grad", "de", "deg"),
        ("U/min", "de", "turn/min"),
        ("u", "de", "u"),
        ("Meter pro Sekunde", "de", "Meter / s"),
        ("grades", "fr", "gon"),
        ("mètres par seconde", "fr", "m / s"),
        ("tr/mn", "fr", "turn/min"),
        ("mN", "fr", "mN"),
        ("Tours/Min", "fr", "turn/Min"),
        ("vueltas por minuto", "es", "turn / min"),
        ("kg·m²", "de", "kg·m²"),
        ("rad.s-1", "fr", "rad.s-1"),
        ("m/seg²", "es", "m/s²"),
        ("r.p.m.", "es", "rpm"),
        ("Umdr./min", "de", "turn/min"),
        ("Kg m^2", None, "kg m^2"),
        ("RPM", "en", "rpm"),
        ("grad", "en", "grad"),
        ("deg", None, "deg"),
    ],
)
def test_words_become_symbols(written: str, locale: Locale | None, symbols: str) -> None:
    assert in_symbols(written, locale) == symbols


SYMBOLS = (
    *("kg", "g", "mg", "t", "m", "mm", "cm", "km", "s", "ms", "min", "h", "d", "rad", "mrad", "N", "mN", "kN", "MN"),
    *("J", "mJ", "kJ", "W", "Pa", "Hz", "deg", "gon", "rpm", "rev", "turn", "°"),
)


@pytest.mark.parametrize("locale", [None, *WORDS])
@pytest.mark.parametrize("symbol", SYMBOLS)
def test_symbols_are_no_words(symbol: str, locale: Locale | None) -> None:
    """A word of some language that equals a symbol but for its capitals would change its meaning."""
    assert in_symbols(f"{symbol}*m/{symbol}^2", locale) == f"{symbol}*m/{symbol}^2"


@pytest.mark.parametrize("written", ["grad", "Grad", "Grad/s"])
def test_a_word_for_two_units_needs_a_locale(written: str) -> None:
    with pytest.raises(InvalidParameter, match="a degree or a gon"):
        in_symbols(written, None)
