"""Numbers as a client writes them, read exactly: decimal text, formulas over names, degrees.

A decimal is the rational number that its digits say, never the double nearest to it: 0.9 + 0.1 = 1 holds, so that what
is exactly dependent or parallel in a description is found to be. Formulas are evaluated in balls.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from decimal import Decimal
from fractions import Fraction
from math import isfinite
from operator import methodcaller
from typing import Any, Literal

from flint import arb, fmpq

from core.balls import raised
from core.errors import InvalidParameter, Path
from core.formulas import FUNCTIONS, LARGEST_EXPONENT, NAMES_OF_FUNCTIONS, Arithmetic, Formula, is_name, names_in
from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.language.tabulated import Tabulated, is_table, tabulated
from core.multibody.language.units import DEGREES, unit_of

MOST_DIGITS = 200
"""Digits of a number: twice as many as the precision of the set-up distinguishes."""

_ROUNDED_UP = 1 + arb(2) ** -52
"""What rounding to the nearest double may add, with a factor of two: bounds hold for decimals and doubles alike."""

LARGEST, LEAST = 10**300 * _ROUNDED_UP, 1 / (10**300 * _ROUNDED_UP)
"""Size between which numbers other than zero are, as decimals or doubles: these hold them with all their digits."""
LARGEST_ANGLE = 1e15
"""Radians: beyond it doubles are further apart than 0.1, so that none holds a direction."""
LARGEST_POWER = 100
"""To which something is raised in a formula."""
SHIFT = 2.0**-70
"""Share of itself by which a number is moved, to see what depends on it."""
MOST_NAMES = 100
"""Names in `let`: as many as there may be bodies. Each may use all before it."""

LONGEST_NAME = 64
"""Letters of a name, as `NAME` has them."""

OF_STATE = ("at", "angle", "axes", "velocity", "angular_velocity")
"""Fields of a body that say where it is and how it moves at the start."""

NAMES_OF_MOTION = frozenset(
    ["t", "x", "y", "z", "vx", "vy", "vz", "speed", "length", "rate", "angle", "turn", "stretch"]
)
"""Names of formulas of the motion that need no body before them."""

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
"""What bodies, places, connections and numbers may be called."""


def member(path: Path, name: object) -> Path:
    """Return the path of a member of an object; of the object, if its name is longer than names are."""
    return (*path, str(name)) if len(str(name)) <= LONGEST_NAME else path


@dataclass(frozen=True)
class Numerals:
    """Evaluates numbers, with the names that the description introduces.

    Attributes
    ----------
    let : mapping of str to ball
        Named numbers.
    doubles : bool
        Whether a number that arrives as a double is that double exactly, and not the shortest decimal that reads as it.
    moved : collection of paths
        Numbers that are read as larger by the share `share` of themselves.
    instead : mapping of path to ball
        Numbers in place of those that are written.
    read : dict
        Filled with the numbers other than zero by their paths, as they are read; formulas are none.
    every : dict
        Filled with all numbers by their paths, formulas too.
    formulas : dict of str to str
        Names in `let` that are formulas of the motion.
    tables : dict of str to Tabulated
        Names in `let` that are functions by points.
    """

    let: Mapping[str, Ball]
    doubles: bool = False
    moved: Collection[Path] = ()
    share: float = SHIFT
    instead: Mapping[Path, Ball] = field(default_factory=dict)
    read: dict[Path, Ball] = field(default_factory=dict, repr=False)
    every: dict[Path, Ball] = field(default_factory=dict, repr=False)
    formulas: dict[str, str] = field(default_factory=dict, repr=False)
    tables: dict[str, Tabulated] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        let: Any,
        numbers: Literal["decimals", "doubles"] = "decimals",
        moved: Collection[Path] = (),
        share: float = SHIFT,
        instead: Mapping[Path, Ball] | None = None,
    ) -> Numerals:
        """Evaluate a list of definitions, each of which may use those before it.

        Raises
        ------
        InvalidParameter
            For a name that is not plain, or a formula that cannot be evaluated.
        """
        if numbers not in ("decimals", "doubles"):
            raise InvalidParameter("numbers", 'be "decimals" or "doubles"')
        if len(let) > MOST_NAMES:
            raise InvalidParameter("let", f"have at most {MOST_NAMES} names, not {len(let)}")
        known: dict[str, Ball] = {}
        found = cls(known, numbers == "doubles", moved, share, instead or {})
        for name, number in let.items():
            if not is_name(name):
                raise InvalidParameter(member(("let",), name), "be a name of letters, digits and _, and no function")
            if is_table(number):
                found.tables[name] = tabulated(number, found.number, ("let", name))
                continue
            if isinstance(number, str) and _is_of_motion(number, found, let):
                found.formulas[name] = number
                continue
            circle = _circle(name, let)
            if circle:
                raise InvalidParameter(("let", name), f"not be used for itself: {' uses '.join(circle)}")
            known[name] = found.number(number, ("let", name))
        return found

    @property
    def as_written(self) -> bool:
        """Whether every number is read as it is written."""
        return not self.moved and not self.instead

    def without_places(self) -> Numerals:
        """Return the numerals that take places, attitudes and velocities of bodies as they are written."""
        own = {path: value for path, value in self.instead.items() if path[0] != "bodies" or path[2] not in OF_STATE}
        return replace(self, instead=own)

    def number(self, value: object, path: Path) -> Ball:
        """Return a number as a ball.

        Raises
        ------
        InvalidParameter
            If it is none, not finite, near or beyond the ends of the range of doubles, too long, or divides by zero.
        """
        found = self.instead[path] if path in self.instead else self._written(value, path)
        size = abs(found)
        if size > LARGEST or 0 < size < LEAST:
            raise InvalidParameter(
                path, "be zero or between 1e-300 and 1e300 in size", remedy="describe the scene in other units"
            )
        self.every[path] = found
        return found

    def _written(self, value: object, path: Path) -> Ball:
        if isinstance(value, str):
            return self._formula(value, path)
        if not isinstance(value, (float, int, Decimal)) and isinstance(value, Mapping):
            return self._of_object(value, path)
        plain = isinstance(value, float) and isfinite(value) and not self.doubles
        found = _decimal(float.__repr__(value)) if plain else _exact(value, path)
        if not is_zero(found):
            self.read[path] = found
        return found + found * self.share if path in self.moved else found

    def _of_object(self, value: Mapping[str, object], path: Path) -> Ball:
        """Return a number that has a unit."""
        if set(value) == {"value", "unit"}:
            return self._in_unit(value, path)
        if set(value) != {"degrees"}:
            raise InvalidParameter(
                path, 'be a number, a formula, {"degrees": number} or {"value": number, "unit": text}'
            )
        inner = value["degrees"]
        if isinstance(inner, Mapping):
            raise InvalidParameter((*path, "degrees"), "be a number or a formula")
        return self.number(inner, (*path, "degrees")) * arb.pi() / 180

    def _in_unit(self, value: Mapping[str, object], path: Path) -> Ball:
        """Return a number in the unit that is written beside it."""
        unit = unit_of(value["unit"], (*path, "unit"))
        if isinstance(value["value"], Mapping):
            raise InvalidParameter((*path, "value"), "be a number or a formula")
        return self.number(value["value"], (*path, "value")) * unit.factor

    def _formula(self, text: str, path: Path) -> Ball:
        try:
            found = Formula.read(text, self.let).value(self.let, BALLS)
        except InvalidParameter as fault:
            remedy = fault.remedy or 'write a formula such as "sqrt(2)/2", in SI units and without a unit'
            raise InvalidParameter((*path, *fault.path), fault.rule, remedy=remedy) from None
        if not found.is_finite():
            raise InvalidParameter(path, "be finite")
        return found

    def angle(self, value: object, path: Path) -> tuple[Ball, Ball]:
        """Return cosine and sine of an angle; multiples of 30 and 45 degrees come out exactly as zeros and ones do."""
        if isinstance(value, Mapping) and set(value) == {"degrees"} and not isinstance(value["degrees"], Mapping):
            half_turns = self.number(value["degrees"], (*path, "degrees")) / 180
        elif isinstance(value, Mapping) and value.get("unit") in DEGREES and set(value) == {"value", "unit"}:
            # Read as any other, of which simple multiples are exact.
            self.number(value, path)
            half_turns = self.number(value["value"], (*path, "value")) / 180
        else:
            radians = self.number(value, path)
            _check_angle(radians, path)
            sine, cosine = radians.sin_cos()
            return cosine, sine
        _check_angle(half_turns * arb.pi(), path)
        sine, cosine = half_turns.sin_cos_pi()
        return cosine, sine

    def vector(self, value: object, path: Path, dimension: int) -> tuple[Ball, ...]:
        """Return a vector, in the plane also as ``{"polar": [r, angle]}``."""
        if type(value) is not list and isinstance(value, Mapping) and set(value) == {"polar"} and dimension == 2:
            polar = value["polar"]
            if isinstance(polar, str) or not isinstance(polar, Sequence) or len(polar) != 2:
                raise InvalidParameter((*path, "polar"), "be a distance and an angle")
            r = self.number(polar[0], (*path, "polar", 0))
            cosine, sine = self.angle(polar[1], (*path, "polar", 1))
            return r * cosine, r * sine
        # What is tried first is what it mostly is: an abstract class takes longer to find out.
        if isinstance(value, str) or not isinstance(value, (list, tuple, Sequence)):
            raise InvalidParameter(path, f"be a list of {dimension} numbers")
        if len(value) != dimension:
            raise InvalidParameter(path, f"have {dimension} entries, not {len(value)}")
        return tuple([self.number(entry, (*path, i)) for i, entry in enumerate(value)])


def _check_angle(radians: Ball, path: Path) -> None:
    if not abs(radians) <= LARGEST_ANGLE:
        raise InvalidParameter(path, f"be an angle of at most {LARGEST_ANGLE:g} rad", remedy="leave out whole turns")


def _is_of_motion(text: str, numerals: Numerals, let: Mapping[str, object]) -> bool:
    """Return whether a formula in `let` has names of the motion, or of others that have."""
    unknown = names_in(text) - {*numerals.let, *NAMES_OF_FUNCTIONS, "pi"}
    return bool(unknown) and all(
        "." in name
        or (name in NAMES_OF_MOTION and name not in let)
        or name in numerals.formulas
        or name in numerals.tables
        for name in unknown
    )


def _circle(name: str, let: Mapping[str, object]) -> list[str]:
    """Return names of which each uses the next, from a name to itself; nothing where there are none."""
    trails = [[name]]
    seen = {name}
    while trails:
        trail = trails.pop()
        text = let.get(trail[-1])
        for used in sorted(names_in(text)) if isinstance(text, str) else ():
            if used == name:
                return [*trail, name]
            if used in let and used not in seen:
                seen.add(used)
                trails.append([*trail, used])
    return []


def _exact(value: object, path: Path) -> Ball:
    if isinstance(value, bool) or not isinstance(value, (int, float, Decimal, Fraction)):
        raise InvalidParameter(path, "be a number")
    if isinstance(value, int):
        if value.bit_length() > 4 * LARGEST_EXPONENT:
            raise InvalidParameter(path, f"have an exponent between -{LARGEST_EXPONENT} and {LARGEST_EXPONENT}")
        return arb(value)
    if isinstance(value, Fraction):
        return arb(fmpq(value.numerator, value.denominator))
    if not isfinite(value):
        raise InvalidParameter(path, "be finite")
    if isinstance(value, float):
        return arb(value)
    if abs(value.adjusted()) > LARGEST_EXPONENT or len(value.as_tuple().digits) > MOST_DIGITS:
        raise InvalidParameter(path, f"have at most {MOST_DIGITS} digits and a moderate exponent")
    return arb(fmpq(*value.as_integer_ratio()))


def _decimal(text: str) -> Ball:
    """Return the rational number of decimal digits, in one rounding."""
    digits, _, exponent = text.lower().partition("e")
    whole, _, part = digits.partition(".")
    behind = (int(exponent) if exponent else 0) - len(part)
    number = int(whole + part)
    return arb(number * 10**behind) if behind >= 0 else arb(fmpq(number, 10**-behind))


def _quotient(one: Ball, other: Ball) -> Ball:
    if is_zero(other):
        raise InvalidParameter((), "divide by something other than zero")
    return one / other


def _power(one: Ball, exponent: Ball) -> Ball:
    if not abs(exponent) <= LARGEST_POWER:
        raise InvalidParameter((), f"have powers between -{LARGEST_POWER} and {LARGEST_POWER}")
    if is_zero(one) and exponent > 0:
        return arb(0)
    return _quotient(arb(1), raised(one, -exponent)) if exponent < 0 else raised(one, exponent)


def _root(argument: Ball) -> Ball:
    if argument < 0:
        raise InvalidParameter((), "take the root of something that is not negative")
    return arb(0) if is_zero(argument) else argument.sqrt()


def _of_a_sine(inverse: Callable[[Ball], Ball]) -> Callable[[Ball], Ball]:
    """Return an inverse function that takes what cannot be told from -1 and 1 as these."""

    def found(argument: Ball) -> Ball:
        end = next((end for end in (arb(-1), arb(1)) if is_zero(argument - end)), None)
        return inverse(argument if end is None else end)

    return found


BALLS = Arithmetic[Ball](
    _decimal,
    arb.pi,
    _quotient,
    _power,
    {name: abs if name == "abs" else methodcaller(name) for name in FUNCTIONS}
    | {"sqrt": _root, "asin": _of_a_sine(methodcaller("asin")), "acos": _of_a_sine(methodcaller("acos"))}
    | {"atan2": lambda y, x: y.atan2(x), "min": lambda a, b: a.min(b), "max": lambda a, b: a.max(b)}
    | {"sign": methodcaller("sgn"), "if": lambda c, a, b: a if c > 0 else b},
)
"""Formulas in balls of the precision of the context."""
