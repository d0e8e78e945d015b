"""Units as they are called in the language of a course, in the symbols that every language shares.

``Grad`` is the degree to a German and, as ``grad``, the gon to others: such a word is read with a locale only.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence
from core.assessment.typed_number import Locale

# Symbols that are often written with other capitals; none of these is another unit.
SHARED = {
    "Kg": "kg", "KG": "kg", "kgs": "kg", "Rad": "rad", "Sec": "s", "RPM": "rpm", "Rpm": "rpm", "r.p.m": "rpm",
    "rads": "rad", "kp": "kgf",
}  # fmt: skip
_GERMAN = {
    "sek": "s", "sekunde": "s", "sekunden": "s", "minute": "min", "minuten": "min",
    "std": "h", "stunde": "h", "stunden": "h", "tag": "d", "tage": "d", "tagen": "d",
    "millimeter": "mm", "zentimeter": "cm", "kilometer": "km", "gramm": "g", "kilogramm": "kg", "tonne": "t",
    "tonnen": "t", "grad": "deg", "U": "turn", "umdrehung": "turn", "umdrehungen": "turn", "umdr": "turn",
    "radiant": "rad", "newtonmeter": "N m", "pro": "/",
}  # fmt: skip
_FRENCH = {
    "sec": "s", "seconde": "s", "secondes": "s", "minutes": "min", "heure": "h", "heures": "h", "jour": "d",
    "jours": "d", "mètre": "m", "mètres": "m", "centimètre": "cm", "centimètres": "cm", "millimètre": "mm",
    "millimètres": "mm", "kilomètre": "km", "kilomètres": "km", "gramme": "g", "grammes": "g", "kilogramme": "kg",
    "kilogrammes": "kg", "tonne": "t", "tonnes": "t", "degré": "deg", "degrés": "deg", "grade": "gon",
    "grades": "gon", "mn": "min", "rd": "rad", "radians": "rad", "tr": "turn", "tour": "turn", "tours": "turn",
    "par": "/",
}  # fmt: skip
_SPANISH = {
    "seg": "s", "segs": "s", "segundo": "s", "segundos": "s", "minuto": "min", "minutos": "min", "hora": "h",
    "horas": "h",
    "día": "d", "días": "d", "metro": "m", "metros": "m", "centímetro": "cm", "centímetros": "cm",
    "milímetro": "mm", "milímetros": "mm", "kilómetro": "km", "kilómetros": "km", "gramo": "g", "gramos": "g",
    "kilogramo": "kg", "kilogramos": "kg", "tonelada": "t", "toneladas": "t", "grado": "deg", "grados": "deg",
    "radián": "rad", "radianes": "rad", "julio": "J", "julios": "J", "vuelta": "turn", "vueltas": "turn",
    "revolución": "turn", "revoluciones": "turn", "por": "/",
}  # fmt: skip
WORDS: Mapping[Locale, Mapping[str, str]] = {"de": _GERMAN, "en": {}, "es": _SPANISH, "fr": _FRENCH}
"""Symbols by word, in small letters except the U of revolutions, where pint does not know the word or misreads it."""

_WORD = re.compile(r"(?<![^\W_])(?:r\.p\.m|[^\W\d_²³¹]+)(?![^\W\d_²³¹])(\.(?!\w))?")


_RUN_TOGETHER = re.compile(r"(?<![^\W_])rads(?=\s*(?:(?:\^|\*\*)\s*\(?)?\s*[-⁻])")
"""In ``rads^-1`` the s is a second; in ``rads/s`` it is a plural."""


def in_symbols(unit: str, locale: Locale | None) -> str:
    """Return a unit with symbols for words.

    Raises
    ------
    EntryFault
        For ``grad`` without a locale, which is a degree or a gon.
    """
    if locale is None and re.match(r"grad\b", unit, re.IGNORECASE):
        rule = "be written in symbols: grad may be a degree or a gon"
        raise EntryFault((), rule, remedy="write deg or gon", sentence=Sentence("unit-unknown"))
    unit = _RUN_TOGETHER.sub("rad s", unit)
    words = SHARED if locale is None else {**SHARED, **WORDS[locale]}
    return _WORD.sub(lambda found: _symbol(found[0], words), unit)


def _symbol(found: str, words: Mapping[str, str]) -> str:
    """Return the symbol of a word. Short ones are no other for capitals: mn is a minute, and mN a millinewton."""
    word = found.rstrip(".")
    return words.get(word) or words.get(word.lower() if len(word) > 2 else "", found)
