"""Numbers as somebody types them: ``6,28``, ``1 234,5``, ``3·10²``, ``−2.5e3``, ``35°16′``.

A mark that could be read in two ways, such as the comma of ``1,234``, is refused unless a locale says what it is; so
are groups as another locale writes them, such as those of ``1.234,5`` in English.
"""

from __future__ import annotations

import re
from typing import Literal

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence

Locale = Literal["de", "en", "es", "fr"]
WITH_COMMA = ("de", "es", "fr")
"""Locales whose decimal mark is the comma."""

DIGITS = r"(?:\d[\d.,]*(?:[ '’]\d{3}(?!\d)[\d.,]*)*|[.,]\d+)"
"""Pattern of the digits of a number, with decimal marks and groups."""
_TEN = r"10\s*(?:\^|\*\*)\s*\(?\s*([-+]?\d{1,4})\s*\)?"
_NUMBER = re.compile(rf"([-+]?)\s*({DIGITS})(?:[eE]([-+]?\d{{1,4}})(?!\d)|\s*[*xX×⋅·]\s*{_TEN})?")
_POWER_OF_TEN = re.compile(rf"([-+]?)\s*{_TEN}")
_SEXAGESIMAL = re.compile(r"([-+]?)(\d+)\s*°\s*([0-5]?\d)\s*['′](?:\s*([0-5]?\d(?:[.,]\d+)?)\s*(?:[\"″]|''))?")


def leading_number(entry: str, locale: Locale | None) -> tuple[float, str] | None:
    """Return the number with which an entry begins, and what is left of the entry; None if it begins with none.

    Degrees with minutes and seconds of arc are a number of degrees.

    Raises
    ------
    EntryFault
        For a number that can be read in two ways, with both in the remedy.
    """
    turned = _SEXAGESIMAL.match(entry)
    if turned is not None:
        sign, degrees, minutes, seconds = turned.groups()
        value = int(degrees) + int(minutes) / 60 + float((seconds or "0").replace(",", ".")) / 3600
        return (-value if sign == "-" else value), f"°{entry[turned.end() :].strip()}"
    power = _POWER_OF_TEN.match(entry)
    if power is not None:
        sign, exponent = power.groups()
        return float(f"{sign}1e{exponent}"), entry[power.end() :].strip()
    found = _NUMBER.match(entry)
    if found is None:
        return None
    sign, digits, exponent, of_ten = found.groups()
    return float(f"{sign}{plain_digits(digits, locale)}e{exponent or of_ten or 0}"), entry[found.end() :].strip()


def plain_digits(digits: str, locale: Locale | None) -> str:
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
        mark = last if decimal else other
        foreign = locale is not None and (mark == ",") != (locale in WITH_COMMA)
        if foreign or not _grouped(groups):
            rule = "be a number with one decimal mark, and groups of three digits if any"
            raise EntryFault((), rule, sentence=Sentence("number-malformed"))
        return "".join(groups) + (f".{part}" if decimal else "")
    if _grouped([whole, part]) and not _is_decimal(last, locale):
        if last == "," and locale == "en":
            return whole + part
        # With decimal commas the comma decides; without a locale only a digit more does.
        number, clear = (f"{whole},{part}",) * 2 if locale in WITH_COMMA else (f"{whole}.{part}", f"{digits}0")
        readings = {"digits": digits, "whole": whole + part, "decimal": number, "padded": clear}
        raise EntryFault(
            (),
            f"be a number that can be read in one way: {digits} may be {whole}{part} or {whole}.{part}",
            remedy=f"write {whole}{part} or {clear}",
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
        return locale not in WITH_COMMA
    return locale in WITH_COMMA
