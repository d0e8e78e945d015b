"""Units of submitted quantities: what one unit of them is in the unit of the reference.

Units of the International System are read here; others (degrees, revolutions per minute, hours, grams) by pint, which
is imported when the first of them arrives. A frequency in hertz counts turns: for an angular rate 1 Hz is 2 pi rad/s.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Mapping
from functools import cache, lru_cache
from math import isfinite, pi
from typing import Any

from core.assessment.feedback.entry_fault import EntryFault
from core.assessment.feedback.languages import Sentence
from core.work import spend

LONGEST_UNIT = 40
"""Characters of a unit."""

IMPORT = 1_000_000
"""Units of work (`core.work`) that importing pint counts for: it takes about a second, once in each process."""

MALFORMED, UNKNOWN, OTHER_KIND, MILLISECOND, WITH_OFFSET, SIZE = (
    f"unit-{what}" for what in ("malformed", "unknown", "other-kind", "millisecond", "with-offset", "size")
)
RULES: Mapping[str, str] = {
    MALFORMED: "be a product of powers of units",
    UNKNOWN: "be a known unit",
    OTHER_KIND: "measure the same kind of quantity",
    MILLISECOND: "measure the same kind of quantity",
    WITH_OFFSET: "be a unit of which multiples can be added",
    SIZE: "be of moderate size",
}
"""What a unit must be, by the key of the feedback on it."""

_PLAIN = re.compile(r"[\w°%µμ·*/^()²³⁻¹. +-]+")
_POWER = re.compile(r"(?<=[\w)°%µμ])\s*(?:\^|\*\*)\s*(?:-?[1-9]|\(-?[1-9]\))(?!\s*(?:\d|\.|\^|\*\*))")
_NUMBER = re.compile(r"(?<![A-Za-z_])\d")
_IN_FULL = re.compile(r"(?!Grad\b)[A-Z][a-z]{3,}")
_MILLISECOND = re.compile(r"(?<![A-Za-z])ms(?![A-Za-z])")
_METRE_PER_SECOND = re.compile(r"(?<![A-Za-z])ms(?=\s*(?:\^|\*\*)\s*\(?-)")
_RECIPROCAL = re.compile(r"\s*1\s*/")
_RAISED = re.compile(r"(?<=[^\W\d_])(-?[1-9])(?!\d)")
_BETWEEN = re.compile(r"(?<=[^\W\d_])-(?=[^\W\d_])|(?<=[^\W_])\.(?=[^\W\d_])")
_RUN_TOGETHER = re.compile(r"(?<![^\W_])([kMm]?N|J|kg)(mm|cm|m)?(s)?(?![^\W\d_])")
_FACTOR = re.compile(r"([*/]?)([A-Za-z]+)(?:\^(-?\d))?")
_DERIVED = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
}
_SI = {"kg", "m", "s", "rad", "d", *_DERIVED}
_SUPERSCRIPTS = str.maketrans({"⁻": "-", "¹": "1", "²": "2", "³": "3"})
_ANGLES = ("radian", "degree", "turn", "revolution", "arcminute", "arcsecond", "grade", "cycle")


def factor(given: str, unit: str) -> float:
    """Return what one `given` is in `unit`.

    Parameters
    ----------
    given : str
        As it was submitted, for example ``"deg/s"``, ``"rpm"``, ``"kg*m^2"``.
    unit : str
        Of the reference, as `core.quantities` writes it: ``"rad s^-1"``; ``"1"`` for a pure number.

    Raises
    ------
    EntryFault
        If the unit is not known, or measures another kind of quantity.
    """
    if given == unit:
        return 1.0
    if len(given) > LONGEST_UNIT:
        raise EntryFault("unit", f"have at most {LONGEST_UNIT} characters", sentence=Sentence(MALFORMED))
    found = _factor(_with_signs(given), unit)
    if isinstance(found, float):
        return found
    key, remedy = found
    raise EntryFault("unit", RULES[key], remedy=remedy, sentence=Sentence(key))


def _with_signs(given: str) -> str:
    """Return a unit with the signs that are left out of ``m2``, ``s-1``, ``kgm`` and ``Nm``, to pint a yarn's fineness.

    The point and the hyphen of ``kg.m2`` and ``N-m`` are products.
    """
    given = given.translate(_SUPERSCRIPTS)
    given = _BETWEEN.sub("*", given)
    given = _RUN_TOGETHER.sub(lambda found: "*".join(filter(None, found.groups())), given)
    return _RAISED.sub(r"^\1", given)


@lru_cache(4096)
def _factor(given: str, unit: str) -> float | tuple[str, str]:
    """Return the factor, or the key of the rule that is broken and the remedy."""
    own = _powers(given)
    if own is not None and own == _powers(unit):
        return 1.0
    if "pint" not in sys.modules:
        spend(IMPORT)
    return _by_pint(given, unit)


def base_powers(unit: str) -> Mapping[str, int] | None:
    """Return the powers of kg, m, s and d of a unit of the International System, None for any other."""
    return _powers("1" if unit == "" else unit)


def _powers(text: str) -> Counter[str] | None:
    """Return the powers of base units of a product of units of the International System, None for any other text.

    An angle is a pure number there, so that radians are left out.
    """
    found: Counter[str] = Counter()
    plain = re.sub(r"(?<=[\w)])[ ·]+(?=\w)", "*", text.strip().replace("**", "^").translate(_SUPERSCRIPTS))
    plain = re.sub(r"(?<=[A-Za-z])(-?\d)", r"^\1", plain.replace(" ", "").replace("^", ""))
    if plain == "1":
        return found
    end = 0
    for part in _FACTOR.finditer(plain.removeprefix("1") if plain.startswith("1/") else plain):
        sign, name, power = part.groups()
        if part.start() != end or name not in _SI:
            return None
        end = part.end()
        exponent = int(power or 1) * (-1 if sign == "/" else 1)
        for base, times in _DERIVED.get(name, {name: 1}).items():
            found[base] += times * exponent
    if end != len(plain.removeprefix("1")) or not end:
        return None
    return Counter({name: power for name, power in found.items() if power and name != "rad"})


@cache
def _registry() -> Any:
    import pint

    registry: Any = pint.UnitRegistry()
    registry.define("rev = turn")
    return registry


def _parsed(registry: Any, given: str) -> Any:
    """Return a unit; names in full may begin with a capital letter, as some of those do after whom they are called.

    Grad is left out: it is the German degree, and pint's grad the gon.
    """
    try:
        return registry.parse_units(given)
    except Exception:
        return registry.parse_units(_IN_FULL.sub(lambda name: name[0].lower(), given))


def _by_pint(given: str, unit: str) -> float | tuple[str, str]:
    registry, remedy = _registry(), "the quantity is a pure number" if unit == "1" else f"the quantity is in {unit}"
    # A text that is none of a unit's is not given to the parser, and numbers are nothing but powers of one digit: the
    # parser would work out 9**9**9.
    if not _PLAIN.fullmatch(given) or _NUMBER.search(_POWER.sub("", _RECIPROCAL.sub("/", given, count=1))):
        return MALFORMED, remedy
    try:
        parsed = _parsed(registry, given)
        quantity = registry.Quantity(1.0, parsed)
        reference = registry.parse_units("" if unit == "1" else unit)
    except Exception:
        # The parser has no error of its own for everything that is no unit.
        return UNKNOWN, remedy
    powers = dict(quantity.unit_items())
    angular = any(name.endswith(_ANGLES) for name in powers)
    if parsed.dimensionality != reference.dimensionality or (unit == "1" and angular):
        apart = _METRE_PER_SECOND.sub("m*s", given)
        if apart != given and isinstance(value := _factor(apart, unit), float):
            # What is no power of a millisecond here is metres per second, as many write them: ms^-1.
            return value
        if _MILLISECOND.search(given) and {"m", "s"} <= set(re.findall("[a-z]+", unit)):
            return MILLISECOND, f"{remedy}; ms is a millisecond, and metres times seconds are m s"
        return OTHER_KIND, remedy
    try:
        value = float(quantity.to(reference).magnitude)
    except Exception:
        return WITH_OFFSET, remedy
    if "rad" in unit.split():
        value *= (2.0 * pi) ** sum(power for name, power in powers.items() if name.endswith("hertz"))
    return value if isfinite(value) and value > 0.0 else (SIZE, remedy)
