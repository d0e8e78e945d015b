"""The formulas of a table as one list of operations, each on the results of those before it.

What a formula has several times, and what several formulas have in common, is one operation. Functions are reduced to
those whose Taylor coefficients follow from one another by products of series: a tangent is a quotient, and logarithms
and inverse functions are integrals of their derivatives, which are algebraic.

References
----------
A. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor methods",
Experimental Mathematics 14 (2005), section 2.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

from flint import arb

from core.errors import InvalidParameter
from core.formulas import Node, value_of
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.language.motion_formulas import LENGTH
from core.multibody.language.numerals import BALLS
from core.multibody.laws.law import Input, Law

MOST_OPERATIONS = 2000
"""Operations of the formulas of a scene: as many as a hundred formulas of twenty have, each a product of series."""

LARGEST_PRODUCT = 32
"""Whole powers up to this are products; others are powers of positive numbers."""


class Op(IntEnum):
    """What an operation does to the numbers a, b, c, d that go with it."""

    NUMBER = 0
    """Number a."""
    PLACE = 1
    """Number a, and the terms b to c of coordinates."""
    RATE = 2
    """The terms b to c of rates."""
    ADD = 3
    SUBTRACT = 4
    MULTIPLY = 5
    DIVIDE = 6
    ROOT = 7
    """Square root of a."""
    EXP = 8
    SINE = 9
    """Sine of a; the next operation is its cosine."""
    COSINE = 10
    """Cosine of a; the operation before is its sine."""
    SINH = 11
    COSH = 12
    LOG = 13
    """Logarithm of a, whose derivative is b times that of a; so are the next two."""
    ASIN = 14
    ATAN = 15
    ATAN2 = 16
    """Angle of (b, a), whose derivative is c times that of a and d times that of b."""
    POWER = 17
    """a to the power of number b."""
    LENGTH = 18
    """Length of the vector (a, b, c)."""
    TANH = 19
    """Hyperbolic tangent of a; the next operation is its derivative."""
    TANH_SLOPE = 20
    """One less the square of the operation before."""


Operation = tuple[int, int, int, int, int]


@dataclass
class Tape:
    """Operations on some inputs.

    Attributes
    ----------
    operations : list of tuple of int
        Code and numbers of each.
    numbers : list of balls
    terms : list of (int, ball, bool)
        Coordinates, their slopes, and whether their rates are meant, of inputs.
    outputs : list of int
        The operation that is the value of each law.
    """

    operations: list[Operation] = field(default_factory=list)
    numbers: list[Ball] = field(default_factory=list)
    terms: list[tuple[int, Ball, bool]] = field(default_factory=list)
    outputs: list[int] = field(default_factory=list)
    _known: dict[Operation, int] = field(default_factory=dict, repr=False)
    _numbered: dict[str, int] = field(default_factory=dict, repr=False)
    _listed: dict[str, int] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, laws: Sequence[Law]) -> Tape:
        """Return the operations of some laws.

        Raises
        ------
        InvalidParameter
            For more operations than a scene may have.
        """
        tape = cls()
        for law in laws:
            tape.outputs.append(_Writer(tape, law).of(law.root))
            if len(tape.operations) > MOST_OPERATIONS:
                rule = f"be shorter: all formulas together may have {MOST_OPERATIONS} operations"
                raise InvalidParameter(law.path, rule)
        return tape

    def is_polynomial_in(self, coordinates: Container[int]) -> bool:
        """Return whether every operation is a polynomial in some coordinates, and depends on nothing else."""
        for code, _, b, c, _ in self.operations:
            by_number = code == Op.DIVIDE and self.operations[b][0] == Op.NUMBER
            if code == Op.PLACE:
                if not all(i in coordinates for i, _, _ in self.terms[b:c]):
                    return False
            elif code not in (Op.NUMBER, Op.ADD, Op.SUBTRACT, Op.MULTIPLY) and not by_number:
                return False
        return True

    def add(self, code: Op, a: int = 0, b: int = 0, c: int = 0, d: int = 0) -> int:
        """Return the number of an operation, which is added where it is new."""
        key = (int(code), a, b, c, d)
        if key not in self._known:
            self._known[key] = len(self.operations)
            self.operations.append(key)
        return self._known[key]

    def number(self, value: Ball) -> int:
        """Return the operation that is a number."""
        return self.add(Op.NUMBER, self._number(value))

    def power(self, base: int, exponent: Ball) -> int:
        """Return the operation that is a power with a constant exponent."""
        return self.add(Op.POWER, base, self._number(exponent))

    def input(self, given: Input) -> int:
        """Return the operation that is an input."""
        slopes = [(key[0], x, given.rate) for key, x in given.form.items() if key]
        key = str([(i, *_parts(x), rate) for i, x, rate in slopes])
        if key not in self._listed:
            self._listed[key] = len(self.terms)
            self.terms += slopes
        start = self._listed[key]
        end = start + len(slopes)
        if given.rate:
            return self.add(Op.RATE, 0, start, end)
        return self.add(Op.PLACE, self._number(given.form.get((), ZERO)), start, end)

    def _number(self, value: Ball) -> int:
        key = str(_parts(value))
        if key not in self._numbered:
            self._numbered[key] = len(self.numbers)
            self.numbers.append(value)
        return self._numbered[key]


class _Writer:
    """Adds one formula to a tape."""

    def __init__(self, tape: Tape, law: Law) -> None:
        self.tape, self.law = tape, law

    def of(self, node: Node) -> int:
        """Return the operation that is the value of a part of the formula."""
        if not self._varies(node):
            try:
                return self.tape.number(value_of(node, self.law.numbers, BALLS))
            except InvalidParameter as fault:
                raise InvalidParameter(self.law.path, fault.rule, remedy=fault.remedy) from None
        if node.kind == "name":
            return self.tape.input(self.law.inputs[node.text])
        if node.kind == "^":
            return self._power(node)
        if node.kind == "sqrt" and (vector := _squared(node.inner[0])):
            return self._function(LENGTH, [self.of(part) for part in vector])
        return self._function(node.kind, [self.of(inner) for inner in node.inner])

    def _varies(self, node: Node) -> bool:
        """Return whether a part of the formula has an input."""
        if node.kind == "name":
            return node.text in self.law.inputs
        return any(self._varies(inner) for inner in node.inner)

    def _function(self, kind: str, values: list[int]) -> int:
        tape, first = self.tape, values[0]
        simple = {"+": Op.ADD, "-": Op.SUBTRACT, "*": Op.MULTIPLY, "/": Op.DIVIDE, "sqrt": Op.ROOT, "exp": Op.EXP}
        if kind in simple:
            return tape.add(simple[kind], *values)
        match kind:
            case "negative":
                return tape.add(Op.SUBTRACT, tape.number(ZERO), first)
            case "sin" | "cos" | "tan":
                return self._pair(Op.SINE, Op.COSINE, kind, first)
            case "sinh" | "cosh":
                return self._pair(Op.SINH, Op.COSH, kind, first)
            case "tanh":
                # A quotient of exponentials would overflow where the tangent is one.
                return self._pair(Op.TANH, Op.TANH_SLOPE, kind, first)
            case "log":
                return tape.add(Op.LOG, first, tape.add(Op.DIVIDE, tape.number(ONE), first))
            case "asin" | "acos":
                root = tape.add(Op.ROOT, tape.add(Op.SUBTRACT, tape.number(ONE), tape.add(Op.MULTIPLY, first, first)))
                angle = tape.add(Op.ASIN, first, tape.add(Op.DIVIDE, tape.number(ONE), root))
                return angle if kind == "asin" else tape.add(Op.SUBTRACT, tape.number(arb.pi() / 2), angle)
            case "atan":
                square = tape.add(Op.ADD, tape.number(ONE), tape.add(Op.MULTIPLY, first, first))
                return tape.add(Op.ATAN, first, tape.add(Op.DIVIDE, tape.number(ONE), square))
            case "atan2":
                y, x = values
                square = tape.add(Op.ADD, tape.add(Op.MULTIPLY, x, x), tape.add(Op.MULTIPLY, y, y))
                along, across = tape.add(Op.DIVIDE, x, square), tape.add(Op.DIVIDE, y, square)
                return tape.add(Op.ATAN2, y, x, along, tape.add(Op.SUBTRACT, tape.number(ZERO), across))
        assert kind == LENGTH, f"{kind} has no operation"
        return tape.add(Op.LENGTH, *values, *[tape.number(ZERO)] * (3 - len(values)))

    def _pair(self, sine: Op, cosine: Op, kind: str, argument: int) -> int:
        """Return sine, cosine or tangent, circular or hyperbolic; the first two always follow one another."""
        tape = self.tape
        first = tape.add(sine, argument)
        second = tape.add(cosine, argument)
        assert second == first + 1, "a cosine follows its sine"
        if kind.startswith("sin") or kind == "tanh":
            return first
        return second if kind.startswith("cos") else tape.add(Op.DIVIDE, first, second)

    def _power(self, node: Node) -> int:
        tape, (base, exponent) = self.tape, node.inner
        value = self.of(base)
        power = self.of(exponent)
        code, at, *_ = tape.operations[power]
        if code != Op.NUMBER:
            inverse = tape.add(Op.DIVIDE, tape.number(ONE), value)
            return tape.add(Op.EXP, tape.add(Op.MULTIPLY, power, tape.add(Op.LOG, value, inverse)))
        given = tape.numbers[at]
        whole = given.unique_fmpz()
        if whole is not None and abs(int(whole)) <= LARGEST_PRODUCT and is_zero(given - whole):
            found = self._product(value, abs(int(whole)))
            return found if int(whole) >= 0 else tape.add(Op.DIVIDE, tape.number(ONE), found)
        return tape.power(value, given)

    def _product(self, value: int, power: int) -> int:
        """Return a whole power by squaring."""
        tape = self.tape
        if power == 0:
            return tape.number(ONE)
        if power == 1:
            return value
        half = self._product(value, power // 2)
        square = tape.add(Op.MULTIPLY, half, half)
        return square if power % 2 == 0 else tape.add(Op.MULTIPLY, square, value)


def _squared(node: Node) -> list[Node]:
    """Return the components of a vector of which a formula is the square, as of a speed; nothing where it is none."""
    if node.kind == "+":
        first, last = (_squared(inner) for inner in node.inner)
        return first + last if first and last and len(first + last) <= 3 else []
    if node.kind == "^":
        return [node.inner[0]] if node.inner[1] == Node("number", "2") else []
    return [node.inner[0]] if node.kind == "*" and node.inner[0] == node.inner[1] else []


def _parts(value: Ball) -> tuple[object, object]:
    """Return middle and radius of a ball as whole numbers and exponents."""
    return value.mid().man_exp(), value.rad().man_exp()
