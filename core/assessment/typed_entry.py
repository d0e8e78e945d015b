"""What somebody types into a field as an answer: a number with its unit, a formula, a list, or a word."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence
from core.assessment.typed_number import DIGITS, WITH_COMMA, Locale, leading_number, plain_digits
from core.assessment.unit_words import in_symbols
from core.formulas import NAMES_OF_FUNCTIONS

LONGEST_ENTRY = 300
"""Characters: as long as a formula may be."""

_SIGNS = str.maketrans(
    {"−": "-", "–": "-", "—": "-", "π": "pi", "\u00ba": "°"}
    | dict.fromkeys("\u00a0\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f", " ")
)
"""Signs with other code points than those of formulas; the masculine ordinal is typed for the degree sign."""
_OPERATORS = str.maketrans({"×": "*", "⋅": "*", "·": "*", "÷": "/", "√": "sqrt"})
"""Signs that mean something else in formulas only: a unit may have its dots."""
_RAISED = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_NAMED = re.compile(
    r"(?:(?:[^\W\d]\w*)?\s*[=≈~]\s*)?(?:(?:ca|circa|approx|aprox|env|environ|etwa)\b\.?\s*(?=[-+\d.,]))?", re.IGNORECASE
)
"""What stands before the answer itself: ``T = 6.28 s``, ``≈ 6.28 s``, ``ca. 6.28 s``."""
_IN_FORMULA = re.compile(rf"(?<![\w.,]){DIGITS}")
_FUNCTION = rf"(?:pi\b|(?:{'|'.join(NAMES_OF_FUNCTIONS)})\s*\()"
"""Pattern of what begins a factor of a formula, and no unit: ``min`` is a minute, and ``min(`` a function."""
_WITH_UNIT = re.compile(rf"(.*[\w)])\s+(?!{_FUNCTION})([A-Za-z°µμΩ%][\w°µμΩ%²³⁻¹*/^() .-]*)", re.DOTALL)
_GOES_ON = re.compile(rf"[-+*/^(×⋅·÷√]|{_FUNCTION}|(?!1\s*/\s*[^\W\d])\d|.*\+", re.DOTALL)
"""What follows a number that is the beginning of a formula; ``2.5 1/s`` has a unit, which has no sum."""
_UNIT = re.compile(r"[\w°%µμΩ·*/^()²³⁻¹. -]*")
_PRODUCT = str.maketrans({"⋅": "·", "×": "·"})
_TWO_SIGNS = re.compile(r"[-+]{2}")
"""Two signs together: ``2.5 +- 0.3`` is no difference, and ``--2`` nothing that anybody means."""
_SEPARATOR = re.compile(r"[;|]|,\s")
_WORDS: dict[str, bool | None] = {
    **dict.fromkeys(("null", "none", "keine", "keiner", "aucun", "aucune", "ninguno", "ninguna")),
    **dict.fromkeys(("true", "yes", "wahr", "ja", "vrai", "oui", "verdadero", "sí"), True),
    **dict.fromkeys(("false", "no", "falsch", "nein", "faux", "non", "falso"), False),
}


@dataclass(frozen=True)
class TypedEntry:
    """What an entry says.

    Attributes
    ----------
    value : float, bool, str, None or list
        A number, a word, or a list of numbers or of equally long lists of them.
    unit : str or None
    formula : str or None
        Where the entry is no number: in place of the value, or what a single word is as a formula.
    """

    value: Any
    unit: str | None = None
    formula: str | None = None


def typed_entry(text: str, locale: Locale | None = None) -> TypedEntry:
    """Return what an entry says.

    Parameters
    ----------
    text : str
    locale : {"de", "en", "es", "fr"}, optional
        Of who typed it. Without one, a point is a decimal mark, and a comma is one where it cannot group digits.

    Raises
    ------
    EntryFault
        For an empty entry, and for one that can be read in two ways or in none.
    """
    entry = re.sub(r"(?<=10)[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda raised: f"^{raised[0].translate(_RAISED)}", text)
    entry = entry.translate(_SIGNS).strip()
    if named := _NAMED.match(entry):
        entry = entry[named.end() :]
    if not entry:
        raise EntryFault((), "not be empty", sentence=Sentence("entry-empty"))
    if entry.lower() in _WORDS:
        return TypedEntry(_WORDS[entry.lower()])
    if entry.startswith(("[", "{")) or ";" in entry or _is_list_in_parentheses(entry):
        values, behind = _listed(entry, locale)
        return TypedEntry(values, _symbols(behind, locale))
    number = leading_number(entry, locale)
    if number is not None:
        value, rest = number
        if not _GOES_ON.match(rest):
            return TypedEntry(value, _symbols(rest, locale))
    if _TWO_SIGNS.search(entry):
        raise _malformed()
    formula, unit = entry, ""
    split = _WITH_UNIT.fullmatch(entry)
    if split is not None and not re.search(r"[-+*/^(]\s*$", split[1]):
        formula, unit = split[1], split[2].strip()
    formula = re.sub(r"√\s*([\d.,]+|[^\W\d]\w*)", r"sqrt(\1)", formula).translate(_OPERATORS)
    formula = re.sub(rf"(?<=\d)\s*(?={_FUNCTION})", "*", formula)
    formula = _IN_FORMULA.sub(lambda digits: plain_digits(digits[0], locale), formula)
    word = entry if re.fullmatch(r"[A-Za-z][\w -]*", entry) else None
    return TypedEntry(word, _symbols(unit, locale), formula)


def _symbols(unit: str, locale: Locale | None) -> str | None:
    """Return a unit in symbols, None where there is none; brackets around it are left out."""
    unit = unit.translate(_PRODUCT)
    if unit.startswith("[") and unit.endswith("]"):
        unit = unit[1:-1].strip()
    if not _UNIT.fullmatch(unit):
        raise _malformed()
    return in_symbols(unit, locale) or None


def _malformed() -> EntryFault:
    """Return the fault of an entry that is nothing that can be read."""
    rule = "be one number with its unit, a formula, a list or a word"
    return EntryFault((), rule, sentence=Sentence("entry-malformed"))


def _is_list_in_parentheses(entry: str) -> bool:
    """Return whether parentheses hold numbers with separators that no formula has."""
    inside = re.match(r"\(([^()]*)\)", entry)
    return inside is not None and _SEPARATOR.search(inside[1]) is not None


def _listed(entry: str, locale: Locale | None) -> tuple[list[Any], str]:
    """Return a list of numbers or of such lists, and the unit behind it."""
    end = max(map(entry.rfind, "])}")) + 1 if entry[0] in "[({" else len(entry)
    inside, unit = entry[:end], entry[end:].strip()
    with_commas = locale in WITH_COMMA and re.search(r"\d,\d.*,\s|,\s.*\d,\d", inside)
    if inside.startswith("[") and not with_commas and not re.search("[;|]", inside):
        try:
            read = json.loads(inside)
        except (ValueError, RecursionError):
            read = None
        if isinstance(read, list):
            return read, unit
        remedy = "with decimal commas: [1,5; 2; 3]"
        raise EntryFault((), "be a list such as [1.5, 2, 3]", remedy=remedy, sentence=Sentence("list-malformed"))
    parts = re.split("[;|]" if re.search("[;|]", inside) else r",\s", inside.strip("[](){}"))
    found = [number for part in parts if (number := leading_number(part.strip(), locale)) is not None]
    *others, (last, rest) = found or [(0.0, "")]
    if not unit and end == len(entry) and entry[0] not in "[({":
        # Without brackets the unit follows the last number.
        unit, rest = rest, ""
    if len(found) < len(parts) or rest or any(behind for _, behind in others):
        raise EntryFault((), "be a list of numbers such as [1,5; 2; 3]", sentence=Sentence("list-malformed"))
    return [*(value for value, _ in others), last], unit
