"""Units of the numbers of a description: exact factors to those of the International System, and their dimensions.

An inch is 0.0254 m and a revolution 2 pi exactly, so that what is exactly so in a description stays so; libraries of
units convert in doubles.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from flint import arb, fmpq

from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import Ball
from core.near_names import did_you_mean

LONGEST_UNIT = 40
"""Characters of a unit."""

Dimension = tuple[int, int, int]
"""Powers of kg, m and s; an angle has none."""

_NONE, _LENGTH, _TIME, _FORCE, _RATE = (0, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, -2), (0, 0, -1)

_SI: Mapping[str, Dimension] = {
    **{"g": (1, 0, 0), "m": _LENGTH, "s": _TIME, "N": _FORCE, "J": (1, 2, -2), "W": (1, 2, -3), "Pa": (1, -1, -2)},
    **{"Hz": _RATE, "rad": _NONE},
}
"""Units that may have a prefix."""

_PREFIXES = {"": 0, "G": 9, "M": 6, "k": 3, "h": 2, "d": -1, "c": -2, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9}
"""Powers of ten."""

_OTHERS: Mapping[str, tuple[str, Dimension]] = {
    **{"1": ("1", _NONE), "%": ("1/100", _NONE), "t": ("1000", (1, 0, 0)), "min": ("60", _TIME), "h": ("3600", _TIME)},
    **{"in": ("127/5000", _LENGTH), "ft": ("381/1250", _LENGTH), "mi": ("201168/125", _LENGTH)},
    **{"lb": ("45359237/100000000", (1, 0, 0)), "lbf": ("8896443230521/2000000000000", _FORCE)},
}
"""Units without a prefix, as fractions of those of the International System."""

_TURNS: Mapping[str, tuple[str, Dimension]] = {
    **{"deg": ("1/180", _NONE), "°": ("1/180", _NONE), "rev": ("2", _NONE), "rpm": ("1/30", _RATE)}
}
"""Units of turns, as fractions of pi."""

DEGREES = ("deg", "°")
"""Names of the unit in which cosines of simple angles are exact."""

_FACTOR = re.compile(r"\s*([*/·]?)\s*([A-Za-zµμ°%]+|1)(?:(?:\^|\*\*)\(?(-?[1-9])\)?)?")


@dataclass(frozen=True)
class Unit:
    """A unit.

    Attributes
    ----------
    fraction : rational number
        Of the unit of the International System, but for powers of pi.
    turns : int
        The power of pi.
    dimension : tuple of int
    """

    fraction: Any
    turns: int
    dimension: Dimension

    @property
    def factor(self) -> Ball:
        """What one of it is in the International System."""
        return arb(self.fraction) * arb.pi() ** self.turns


def unit_of(text: object, path: Path) -> Unit:
    """Return the unit that a text names, such as ``"kg m^2"``, ``"km/h"``, ``"rpm"``.

    Raises
    ------
    InvalidParameter
        For a text that is no product of powers of known units.
    """
    if not isinstance(text, str) or not 0 < len(text) <= LONGEST_UNIT:
        raise InvalidParameter(path, f'be a unit of at most {LONGEST_UNIT} characters, such as "N/m"')
    fraction, turns, dimension, end = fmpq(1), 0, _NONE, 0
    text = text.strip()
    while end < len(text):
        found = _FACTOR.match(text, end)
        if found is None or (end == 0 and found[1]):
            raise InvalidParameter(path, 'be a product of powers of units, such as "kg m^2" or "N/m"')
        power = int(found[3] or 1) * (-1 if found[1] == "/" else 1)
        if found[2] not in _known():
            raise InvalidParameter(
                path, f'be of known units, unlike "{found[2]}"', remedy=did_you_mean(found[2], _known())
            )
        one = _known()[found[2]]
        fraction, turns = fraction * one.fraction**power, turns + power * one.turns
        (a, b, c), (kg, m, s) = dimension, one.dimension
        dimension = a + power * kg, b + power * m, c + power * s
        end = found.end()
    return Unit(fraction, turns, dimension)


@cache
def _known() -> Mapping[str, Unit]:
    found = {}
    for name, dimension in _SI.items():
        for prefix, power in _PREFIXES.items():
            # The unit of mass has a prefix already.
            exponent = power - 3 if name == "g" else power
            fraction = fmpq(10**exponent) if exponent >= 0 else fmpq(1, 10**-exponent)
            found[prefix + name] = Unit(fraction, 0, dimension)
    for names, turns in ((_OTHERS, 0), (_TURNS, 1)):
        for name, (text, dimension) in names.items():
            above, _, below = text.partition("/")
            found[name] = Unit(fmpq(int(above), int(below or 1)), turns, dimension)
    return found
