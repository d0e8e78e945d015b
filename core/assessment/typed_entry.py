"""What somebody types into a field as an answer: a number with its unit, a formula, a list, or a word."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence
from core.assessment.formulas import Undefined, value_in_doubles
from core.assessment.typed_number import DIGITS, WITH_COMMA, Locale, leading_number, plain_digits
from core.assessment.typed_signs import with_plain_signs
from core.assessment.unit_words import in_symbols
from core.assessment.units import factor
from core.errors import InvalidParameter
from core.formulas import NAMES_OF_FUNCTIONS, Formula

LONGEST_ENTRY = 300
"""Characters: as long as a formula may be."""

_OPERATORS = str.maketrans({"×": "*", "⋅": "*", "·": "*", "÷": "/", "√": "sqrt"})
"""Signs that mean something else in formulas only: a unit may have its dots."""
_IN_FORMULA = re.compile(rf"(?<![\w.,]){DIGITS}")
_FUNCTION = rf"(?:pi\b|(?:{'|'.join(NAMES_OF_FUNCTIONS)})\s*\()"
"""Pattern of what begins a factor of a formula, and no unit: ``min`` is a minute, and ``min(`` a function."""
_WITH_UNIT = re.compile(rf"(.*[\w)])\s+(?!{_FUNCTION})([A-Za-z°µμΩ%][\w°µμΩ%²³⁻¹*/^() .-]*)", re.DOTALL)
_GOES_ON = re.compile(rf"[-+*/^(×⋅·÷√]|{_FUNCTION}|(?!1\s*/\s*[^\W\d])\d|.*\+", re.DOTALL)
"""What follows a number that is the beginning of a formula; ``2.5 1/s`` has a unit, which has no sum."""
_UNIT = re.compile(r"[\w°%µμΩ·*/^()²³⁻¹. -]*")
_PRODUCT = str.maketrans({"⋅": "·", "×": "·"})
_TWO_SIGNS = re.compile(r"[-+]{2}|(?:\+\s+-|-\s+\+)\s*[\d.,]")
"""Two signs together: ``2.5 +- 0.3`` and ``2.5 + - 0.3`` are no differences, and ``--2`` nothing that anybody means."""
_JOINED = re.compile(rf"(?:(?!{_FUNCTION})(?:1\s*/\s*)?[A-Za-zµμΩ%°](?:[^-+]|\^\s*[-+])*?(?:\s+|(?<=°)))?[-+]\s*(.+)")
"""Behind a number, perhaps behind its unit: a sign and what it joins to the number."""
_IN_BRACKETS = re.compile(r"\(\d+\)\s*(?:[^-+*/^(\s\d].*)?")
"""Behind a number: another one in brackets, and perhaps a unit."""
_UNCLEAR_QUOTIENT = re.compile(rf"/\s*{DIGITS}(?={_FUNCTION}|√)")
"""``1/2π`` may be π/2 or the reciprocal of 2π; ``1/2 π`` is half of π."""
_SEPARATOR = re.compile(r"[;|]|,\s")
_BARE_LIST = re.compile(r"[-+.\d].*,\s+[-+.,\d].*")
"""Numbers with commas between them, without brackets."""
_TIGHT_LIST = re.compile(r"[({<]([^(){}<>;|]*)[)}>]")
_GROUPED = re.compile(r"(?<!\d)\d{1,3} \d{3}(?!\d)")
_QUANTITY = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([*/])\s*([A-Za-zµ°Ω%][\w°µΩ%²³⁻¹*/^ .-]*)")
_SECOND_NUMBER = re.compile(r"[^\W\d_]\.?\s+\d(?!\s*/)")
"""Behind a unit: ``6 s 280 ms`` is no product."""
_DIRECTION = re.compile(
    r".*\d.*[\s,](?:(?:nach|zu[rm]?) (?:rechts|links|oben|unten)|(?:to|towards) the (?:right|left)"
    r"|(?:up|down)(?:wards?)?|(?:vers|à) (?:la (?:droite|gauche)|le (?:haut|bas)|droite|gauche)"
    r"|hacia (?:la (?:derecha|izquierda)|arriba|abajo))",
    re.IGNORECASE | re.DOTALL,
)
"""Behind a number: a direction in words, which says nothing of axes."""
_WORDS: dict[str, bool | None] = {
    **dict.fromkeys(("null", "none", "keine", "keiner", "aucun", "aucune", "ninguno", "ninguna")),
    **dict.fromkeys(
        ("true", "yes", "wahr", "richtig", "ja", "vrai", "oui", "verdadero", "verdadera", "cierto", "sí"), True
    ),
    **dict.fromkeys(("false", "no", "falsch", "nein", "faux", "non", "falso", "falsa"), False),
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
    entry = with_plain_signs(text, locale)
    if not entry:
        raise EntryFault((), "not be empty", sentence=Sentence("entry-empty"))
    word = entry.lower().rstrip(".")
    if word in _WORDS:
        return TypedEntry(_WORDS[word])
    if _DIRECTION.fullmatch(entry):
        raise EntryFault((), "say a direction by its sign, not in words", sentence=Sentence("direction-in-words"))
    if _is_list(entry, locale):
        return TypedEntry(*_listed(entry, locale))
    number = leading_number(entry, locale)
    if number is not None:
        value, rest = number
        if _joins_a_number(rest, entry, locale):
            raise _two_numbers(entry)
        if not _GOES_ON.match(rest):
            return TypedEntry(value, _symbols(rest, locale))
    if "=" in entry or _TWO_SIGNS.search(entry):
        raise _malformed()
    formula, unit = entry, ""
    split = _WITH_UNIT.fullmatch(entry)
    if split is not None and not re.search(r"[-+*/^(]\s*$", split[1]):
        formula, unit = split[1], split[2].strip()
    if _UNCLEAR_QUOTIENT.search(formula):
        rule = "have parentheses where a product stands behind a quotient"
        raise EntryFault((), rule, remedy="write 1/(2*pi) or (1/2)*pi", sentence=Sentence("quotient-unclear"))
    formula = re.sub(r"√\s*([\d.,]+|[^\W\d]\w*)", r"sqrt(\1)", formula).translate(_OPERATORS)
    formula = re.sub(rf"(?<=\d)\s*(?={_FUNCTION})", "*", formula)
    formula = _IN_FORMULA.sub(lambda digits: plain_digits(digits[0], locale), formula)
    choice = entry if re.fullmatch(r"[A-Za-z][\w -]*", entry) else None
    return TypedEntry(choice, _symbols(unit, locale), formula)


def number_with_unit(formula: str, unit: str) -> tuple[float, str] | None:
    """Return the number and the unit of a typed formula that is their product, such as ``60/min`` or ``6.28*s``.

    Parameters
    ----------
    formula : str
        None of whose names is a quantity of the question.
    unit : str
        Of the figure; the other unit has to measure the same kind of quantity.
    """
    found = _QUANTITY.fullmatch(formula)
    if found is None:
        return None
    number, sign, given = found.groups()
    given = f"1/{given}" if sign == "/" else given
    try:
        factor(given, unit)
        return float(number), given
    except (EntryFault, ValueError):
        return None


def _symbols(unit: str, locale: Locale | None) -> str | None:
    """Return a unit in symbols, None where there is none; brackets around it are left out."""
    unit = unit.translate(_PRODUCT)
    if unit.startswith("[") and unit.endswith("]"):
        unit = unit[1:-1].strip()
    if not _UNIT.fullmatch(unit) or _SECOND_NUMBER.search(unit):
        raise _malformed()
    return in_symbols(unit, locale) or None


def _joins_a_number(rest: str, entry: str, locale: Locale | None) -> bool:
    """Return whether all that follows the number of an entry is a sign and one more number, with units or without.

    A second sign, ``2 - -3``, makes it a difference unless both numbers are negative: ``-3 - -2`` may be a range.
    In ``6.28(1)`` the second number may be the error of the last digits.
    """
    if _IN_BRACKETS.fullmatch(rest):
        return True
    joined = _JOINED.fullmatch(rest)
    if joined is None or (joined[1][0] in "-+" and not entry.startswith("-")):
        return False
    second = leading_number(joined[1], locale)
    return second is not None and not _GOES_ON.match(second[1])


def _two_numbers(entry: str) -> EntryFault:
    """Return the fault of ``6.2-6.3 s`` and ``6.28 +0.01 s``."""
    rule = f"be one number: {entry} may be a calculation, a range, or a value with its error"
    sentence = Sentence("number-or-range", {"entry": entry})
    return EntryFault((), rule, remedy="write the result alone", sentence=sentence)


def _malformed() -> EntryFault:
    """Return the fault of an entry that is nothing that can be read."""
    rule = "be one number with its unit, a formula, a list or a word"
    return EntryFault((), rule, sentence=Sentence("entry-malformed"))


def _is_list(entry: str, locale: Locale | None) -> bool:
    """Return whether an entry has brackets or separators that no number and no formula has."""
    if entry.startswith(("[", "{", "<")) or ";" in entry or _BARE_LIST.fullmatch(entry):
        return True
    inside = re.match(r"\(([^()]*)\)", entry)
    return inside is not None and (_SEPARATOR.search(inside[1]) is not None or _has_tight_commas(inside[1], locale))


def _has_tight_commas(inside: str, locale: Locale | None) -> bool:
    """Return whether the commas of ``2.5,5,6.5`` separate: points are decimal there, and nothing else can be read."""
    if locale in WITH_COMMA or "," not in inside or "." not in inside or not re.fullmatch(r"[-+\d.,eE]+", inside):
        return False
    try:
        plain_digits(inside, locale)
    except EntryFault:
        return True
    return False


def _listed(entry: str, locale: Locale | None) -> tuple[list[Any], str | None]:
    """Return a list of numbers or of such lists, and its unit."""
    bracketed = entry[0] in "[({<"
    end = max(map(entry.rfind, "])}>")) + 1 if bracketed else len(entry)
    inside, behind = entry[:end], entry[end:].strip()
    with_commas = locale in WITH_COMMA and re.search(r"\d,\d.*,\s|,\s.*\d,\d", inside)
    if inside.startswith("[") and not with_commas and not re.search("[;|]", inside):
        try:
            read = json.loads(inside)
        except (ValueError, RecursionError):
            read = None
        if isinstance(read, list):
            return read, _symbols(behind, locale)
    found = [_element(part, locale) for part in _parts(inside, locale)]
    units = [unit for _, unit in found]
    if behind:
        units.append(_symbols(behind, locale))
    # One unit for all, or each with the same.
    if len(found) < 2 or (any(units[:-1]) and len({*units}) > 1):
        raise _no_list()
    return [value for value, _ in found], units[-1]


def _parts(inside: str, locale: Locale | None) -> list[str]:
    """Return what stands between the separators of a list: semicolons, commas or, in brackets, spaces."""
    bare = inside.strip("[](){}<>" if inside[:1] in ("[", "(", "{", "<") else "")
    if re.search("[;|]", bare):
        return re.split("[;|]", bare)
    if re.search(r",\s", bare):
        return re.split(r",\s", bare)
    if _has_tight_commas(bare, locale) or (inside.startswith("[") and "," in bare and locale not in WITH_COMMA):
        return bare.split(",")
    if "," in bare and locale not in WITH_COMMA:
        raise _no_list()
    if _GROUPED.search(bare):
        raise _no_list()
    return bare.split()


def _element(part: str, locale: Locale | None) -> tuple[float, str | None]:
    """Return a number of a list, which may be a constant such as ``√2/2``, and the unit behind it."""
    if not part.strip() or re.match(r"\s*[\[({<].*[;|,]", part):
        raise _no_list()
    entry = typed_entry(part, locale)
    if type(entry.value) is float:
        return entry.value, entry.unit
    try:
        return value_in_doubles(Formula.read(entry.formula or "", ()), {}), entry.unit
    except (InvalidParameter, Undefined):
        raise _no_list() from None


def _no_list() -> EntryFault:
    """Return the fault of a list that cannot be read."""
    return EntryFault((), "be a list of numbers such as [1,5; 2; 3]", sentence=Sentence("list-malformed"))
