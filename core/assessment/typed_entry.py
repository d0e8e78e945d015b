"""What somebody types into a field as an answer: a number with its unit, a formula, a list, or a word.

Numbers are written in more ways than JSON has: ``6,28 s``, ``1 234,5``, ``3·10²``, ``−2.5e3 N``, ``30°``. A mark that
could be read in two ways, such as the comma of ``1,234``, is refused unless a locale says what it is.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any, Literal

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence

Locale = Literal["de", "en", "es", "fr"]
_WITH_COMMA = ("de", "es", "fr")
"""Locales whose decimal mark is the comma."""

LONGEST_ENTRY = 300
"""Characters: as long as a formula may be."""

_SIGNS = str.maketrans(
    {"−": "-", "–": "-", "π": "pi", "\u00ba": "°"}
    | dict.fromkeys("\u00a0\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f", " ")
)
"""Signs with other code points than those of formulas; the masculine ordinal is typed for the degree sign."""
_OPERATORS = str.maketrans({"×": "*", "⋅": "*", "·": "*", "÷": "/"})
"""Signs that mean something else in formulas only: a unit may have its dots."""
_RAISED = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_TEN = r"10\s*(?:\^|\*\*)\s*\(?\s*([-+]?\d{1,4})\s*\)?"
_DIGITS = r"(?:\d[\d.,]*(?:[ '’]\d{3}(?!\d)[\d.,]*)*|[.,]\d+)"
_NUMBER = re.compile(rf"([-+]?)\s*({_DIGITS})(?:[eE]([-+]?\d{{1,4}})(?!\d)|\s*[*xX×⋅·]\s*{_TEN})?")
_POWER_OF_TEN = re.compile(rf"([-+]?)\s*{_TEN}")
_IN_FORMULA = re.compile(rf"(?<![\w.,]){_DIGITS}")
_WITH_UNIT = re.compile(r"(.*[\w)])\s+([A-Za-z°µμΩ%][\w°µμΩ%²³⁻¹*/^() .-]*)", re.DOTALL)
_WORDS: dict[str, bool | None] = {"true": True, "false": False, "null": None}


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
        For an empty entry, and for a number that can be read in two ways, with both in the remedy.
    """
    entry = re.sub(r"(?<=10)[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda raised: f"^{raised[0].translate(_RAISED)}", text)
    entry = entry.translate(_SIGNS).strip()
    if not entry:
        raise EntryFault((), "not be empty", sentence=Sentence("entry-empty"))
    if entry.lower() in _WORDS:
        return TypedEntry(_WORDS[entry.lower()])
    if entry.startswith("["):
        return TypedEntry(*_listed(entry, locale))
    number = _leading_number(entry, locale)
    if number is not None:
        value, rest = number
        if not re.match(r"[-+*/^(×⋅·÷]|pi\b|\d", rest):
            return TypedEntry(value, rest or None)
    formula, unit = entry, None
    split = _WITH_UNIT.fullmatch(entry)
    if split is not None and not re.search(r"[-+*/^(]\s*$", split[1]):
        formula, unit = split[1], split[2].strip()
    formula = re.sub(r"(?<=\d)\s*(?=pi\b)", "*", formula.translate(_OPERATORS))
    formula = _IN_FORMULA.sub(lambda digits: _plain(digits[0], locale), formula)
    return TypedEntry(entry if re.fullmatch(r"[A-Za-z][\w -]*", entry) else None, unit, formula)


def _leading_number(entry: str, locale: Locale | None) -> tuple[float, str] | None:
    """Return the number with which an entry begins, and what is left of the entry; None if it begins with none."""
    power = _POWER_OF_TEN.match(entry)
    if power is not None:
        sign, exponent = power.groups()
        return float(f"{sign}1e{exponent}"), entry[power.end() :].strip()
    found = _NUMBER.match(entry)
    if found is None:
        return None
    sign, digits, exponent, of_ten = found.groups()
    return float(f"{sign}{_plain(digits, locale)}e{exponent or of_ten or 0}"), entry[found.end() :].strip()


def _listed(entry: str, locale: Locale | None) -> tuple[list[Any], str | None]:
    """Return a list of numbers or of such lists, and the unit behind it."""
    end = entry.rfind("]") + 1
    inside, unit = entry[:end], entry[end:].strip() or None
    if ";" not in inside:
        try:
            read = json.loads(inside)
        except (ValueError, RecursionError):
            read = None
        if isinstance(read, list):
            return read, unit
        remedy = "with decimal commas: [1,5; 2; 3]"
        raise EntryFault((), "be a list such as [1.5, 2, 3]", remedy=remedy, sentence=Sentence("list-malformed"))
    found = []
    for part in inside.strip("[]").split(";"):
        number = _leading_number(part.strip(), locale)
        if number is None or number[1]:
            sentence = Sentence("list-malformed")
            raise EntryFault((), "be a list of numbers such as [1,5; 2; 3]", sentence=sentence)
        found.append(number[0])
    return found, unit


def _plain(digits: str, locale: Locale | None) -> str:
    """Return digits with a point as their decimal mark and nothing between groups of three."""
    digits = re.sub(r"[ '’]", "", digits)
    points, commas = digits.count("."), digits.count(",")
    if not points + commas:
        return digits
    last = max(digits, key=lambda mark: digits.rfind(mark) if mark in ".," else -1)
    whole, _, part = digits.rpartition(last)
    if points + commas > 1:
        other = "," if last == "." else "."
        decimal = digits.count(last) == 1
        groups = (whole if decimal else digits).split(other if decimal else last)
        if not _grouped(groups):
            rule = "be a number with one decimal mark, and groups of three digits if any"
            raise EntryFault((), rule, sentence=Sentence("number-malformed"))
        return "".join(groups) + (f".{part}" if decimal else "")
    if _grouped([whole, part]) and not _is_decimal(last, locale):
        if last == "," and locale == "en":
            return whole + part
        readings = {"digits": digits, "whole": whole + part, "decimal": f"{whole}.{part}", "padded": f"{digits}0"}
        raise EntryFault(
            (),
            f"be a number that can be read in one way: {digits} may be {whole}{part} or {whole}.{part}",
            remedy=f"write {whole}{part} or {digits}0",
            sentence=Sentence("number-ambiguous", readings),
        )
    return f"{whole}.{part}"


def _grouped(groups: list[str]) -> bool:
    """Return whether digits may be groups of three."""
    first, *rest = groups
    return 1 <= len(first) <= 3 and first[0] != "0" and all(len(group) == 3 for group in rest)


def _is_decimal(mark: str, locale: Locale | None) -> bool:
    """Return whether a mark before three digits is the decimal one."""
    if mark == ".":
        return locale not in _WITH_COMMA
    return locale in _WITH_COMMA
