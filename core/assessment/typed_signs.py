"""Signs and words of a typed entry, written as numbers and formulas have them.

``T ≈ 1,47.10⁻³ s`` of a French student becomes ``1,47·10^-3 s``, and ``Arctg(1/√2)`` becomes ``atan(1/√2)``.
"""

from __future__ import annotations

import re

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence
from core.assessment.typed_number import DIGITS, WITH_COMMA, Locale
from core.formulas import NAMES_OF_FUNCTIONS

_SIGNS = str.maketrans(
    {"−": "-", "–": "-", "—": "-", "π": "pi", "\u00ba": "°"}
    | dict.fromkeys("\u00a0\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f", " ")
)
"""Signs with other code points than those of formulas; the masculine ordinal is typed for the degree sign."""
_RAISED = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_HEDGES = (
    "ca|circa|zirka|approx|approximately|about|around|roughly|etwa|rund|ungefähr|env|environ|aprox|aproximadamente|unos"
)
_NAMED = re.compile(
    rf"(?:.*(?<![<>!=])[=≈≃≅~∼]\s*|[^\W\d]\w*\s*:\s*)?(?:(?:{_HEDGES})\b\.?\s*(?=[-+\d.,√]|pi\b))?",
    re.IGNORECASE | re.DOTALL,
)
"""What stands before the answer itself: ``T = 6.28 s``, ``|ω| ≈ 6.28 s``, ``T: ca. 6.28 s``, ``S = m g/2 = 20.6 N``."""
_STOP = re.compile(r"(?<=[\w%°Ω²³⁻¹)])\.$")
"""The end of a sentence."""

_FUNCTIONS = {
    **{name: name for name in NAMES_OF_FUNCTIONS},
    **{"tg": "tan", "arctg": "atan", "sen": "sin", "arcsen": "asin"},
}
"""Functions by what they are called in French and Spanish, too."""
_CALL = re.compile(r"(?<![\w.])([A-Za-z]+\d?)(?=\s*\()")
_OF_DEGREES = re.compile(rf"(?<![\w.])(sin|cos|tan|sen|tg)\s*(?:\(\s*(-?{DIGITS})\s*°\s*\)|({DIGITS})\s*°)")
"""Functions of a number of degrees, with brackets or without: ``tan(25°)``, ``tan 25°``."""
_INVERSE = re.compile(r"(?<![\w.])(sin|cos|tan)\s*(?:\^\s*(?:-1|\(\s*-1\s*\))|⁻¹)(?=\s*\()")
_PI = re.compile(r"(?<![^\W\d_])P[iI](?![^\W_])")

_POINT_BEFORE_TEN = re.compile(r"(?<![\d.,])(\d[\d ]*)(,\d+)?\.(10\s*(?:\^|\*\*)\s*\(?[-+]?\d+\)?)")
_LOWERED_EXPONENT = re.compile(r"\d[\d.,]*\s*[*xX×⋅·]\s*10-\d{1,2}(?![\w.,])")
_APOSTROPHE = re.compile(r"(?<=\d)['’](?=(?:\d{1,2}|\d{4,})(?!\d))")


def with_plain_signs(text: str, locale: Locale | None) -> str:
    """Return an entry with the signs of formulas, without the name before it.

    Raises
    ------
    EntryFault
        For powers of ten that can be read in two ways: ``2.10^3``, ``2·10-3``.
    """
    entry = re.sub(r"(?<=10)[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda raised: f"^{raised[0].translate(_RAISED)}", text)
    entry = entry.translate(_SIGNS).strip()
    if named := _NAMED.match(entry):
        entry = entry[named.end() :]
    entry = _STOP.sub("", entry)
    if locale == "es" and "°" not in entry:
        entry = _APOSTROPHE.sub(",", entry)
    if lowered := _LOWERED_EXPONENT.search(entry):
        raise _lost_exponent(lowered[0])
    entry = _POINT_BEFORE_TEN.sub(lambda found: _scaled(found, locale), entry)
    entry = _OF_DEGREES.sub(lambda found: f"{found[1]}({found[2] or found[3]}*pi/180)", entry)
    entry = _CALL.sub(lambda found: _FUNCTIONS.get(found[1].lower(), found[1]), _INVERSE.sub(r"a\1", entry))
    return _PI.sub("pi", entry)


def _scaled(found: re.Match[str], locale: Locale | None) -> str:
    """Return a number with a point before a power of ten, a product to who writes decimal commas."""
    number, ten = f"{found[1]}{found[2] or ''}", found[3]
    product, power = f"{number}*{ten}", f"({number}.10){ten[2:]}"
    if locale in WITH_COMMA or found[2]:
        return product
    if locale == "en":
        return found[0]
    raise EntryFault(
        (),
        f"be a number that can be read in one way: {found[0]} may be {product} or {power}",
        remedy=f"write {product} or {power}",
        sentence=Sentence(
            "number-ambiguous", {"digits": found[0], "whole": product, "decimal": power, "padded": power}
        ),
    )


def _lost_exponent(written: str) -> EntryFault:
    """Return the fault of a power of ten whose exponent stands on the line: 2·10-3."""
    rule = f"have powers of ten with a sign of power, unlike {written}"
    return EntryFault((), rule, remedy="write 10^-3, or 1e-3", sentence=Sentence("power-of-ten"))
