"""Balls that record what is done with them, and the record, by which the same is done with other numbers.

The set-up of a scene is recorded once, from the numbers that differ between members to those of its table. Every
decision on the way (a comparison, a coefficient that is zero, an exponent) is recorded with its outcome. Another member
has the same table in form, the same passes and the same model exactly where all its decisions come out alike, and then
the operations of the record give its numbers to the bit: they are those that would have been done, in the same order.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from flint import arb, arb_mat, ctx

from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import pair


class NotRecorded(Exception):
    """Something was done that a record does not hold, so that members are answered one by one."""


class Varied:
    """Stands in a description for a number that members have each of their own; only numerals read it."""


@contextmanager
def recording() -> Iterator[None]:
    """Have what a stand-in for numbers of members cannot do raise `NotRecorded`; any other fault stays what it is.

    Python and flint, where they meet one, raise a TypeError that names its class.
    """
    try:
        yield
    except TypeError as fault:
        if not any(one.__name__ in str(fault) for one in (Varied, RecordedBall, Placeholder)):
            raise
        raise NotRecorded(str(fault)) from fault


@dataclass
class Record:
    """Operations and decisions on balls, in order.

    Attributes
    ----------
    inputs : int
        How many balls there were at first: these have the first places.
    steps : list of (text, places that it uses)
        Operations, each of which fills the next place, and decisions, which fill none.
    constants : list
        What they use beside places.
    decisions : dict of str to (places that it uses, outcome)
        Those by which members are told apart.
    outputs : dict of int to int
        Places of the numbers of the table, numbered.
    numbers : dict of (int, int) to int
        Outputs times powers of two, as they stand in the table, numbered.
    functions : dict of str to callable
        Those that the steps call.
    complete : bool
        Whether nothing more is decided, so that the numbers of the table may be asked for.
    """

    inputs: int
    steps: list[tuple[str, tuple[int, ...], int | None]] = field(default_factory=list)
    constants: list[Any] = field(default_factory=list)
    decisions: dict[str, tuple[tuple[int, ...], Any]] = field(default_factory=dict)
    outputs: dict[int, int] = field(default_factory=dict)
    numbers: dict[tuple[int, int], int] = field(default_factory=dict)
    functions: dict[str, Callable[..., Any]] = field(default_factory=dict)
    complete: bool = False
    _known: dict[str, Any] = field(default_factory=dict)
    _names: dict[int, str] = field(default_factory=dict)
    _count: int = 0
    _bits: int = 0

    def begun(self, balls: Sequence[Ball]) -> list[RecordedBall]:
        """Return the balls at first, recorded from now on at the present precision."""
        self._bits, self._count = ctx.prec, len(balls)
        return [RecordedBall(ball, k, self) for k, ball in enumerate(balls)]

    def written(self, value: Any, used: list[int]) -> str:
        """Return an operand as text; places that it uses are added to `used`."""
        if isinstance(value, RecordedBall):
            if value.record is not self:
                raise NotRecorded("of another record")
            used.append(value.place)
            return f"x{value.place}"
        if isinstance(value, (bool, int)):
            return repr(value)
        name = self._names.get(id(value))
        if name is None:
            name = self._names[id(value)] = f"c{len(self.constants)}"
            # What is held here keeps its address.
            self.constants.append(value)
        return name

    def found(self, form: str, operands: Sequence[Any], value: Any) -> Any:
        """Record that a form of some operands has a value, and return the value as it is recorded."""
        if ctx.prec != self._bits:
            raise NotRecorded("at another precision")
        used: list[int] = []
        text = form.format(*(self.written(operand, used) for operand in operands))
        if text in self._known:
            return self._known[text]
        if isinstance(value, (arb, arb_mat)):
            result: Any = self._placed(text, used, value)
        elif isinstance(value, tuple):
            whole = self._placed(text, used, value)
            result = tuple(self.found(f"{{}}[{k}]", (whole,), one) for k, one in enumerate(value))
        elif isinstance(value, bool):
            result = value
            self.steps.append((f"if {'not ' if value else ''}({text}): return None", tuple(used), None))
        elif isinstance(value, (int, float)):
            result = value
            self.steps.append((f"if ({text}) != {value!r}: return None", tuple(used), None))
        else:
            raise NotRecorded(f"{text} is a {type(value).__name__}")
        self._known[text] = result
        return result

    def _placed(self, text: str, used: Sequence[int], value: Any) -> RecordedBall:
        """Return a value as that of an operation."""
        self.steps.append((f"x{self._count} = {text}", tuple(used), self._count))
        self._count += 1
        return RecordedBall(value, self._count - 1, self)

    def told_apart(self, form: str, operands: Sequence[Any], value: Any) -> Any:
        """Have what a form of operands comes out as among the outcomes by which members are told apart."""
        used: list[int] = []
        text = form.format(*(self.written(operand, used) for operand in operands))
        if text not in self.decisions:
            self.decisions[text] = (tuple(used), value)
        return self.decisions[text][1]

    def output(self, place: int, power: int) -> int:
        """Have a number times a power of two among those of the table, and return its place there."""
        output = self.outputs.setdefault(place, len(self.outputs))
        return self.numbers.setdefault((output, power), len(self.numbers))

    @property
    def outcomes(self) -> tuple[Any, ...]:
        """The outcomes by which members are told apart."""
        return tuple(value for _, value in self.decisions.values())

    def alike(self, other: Record) -> bool:
        """Return whether another record has the same steps, decisions and outputs."""
        return (
            self.steps == other.steps
            and self.constants_alike(other)
            and list(self.decisions) == list(other.decisions)
            and list(self.outputs) == list(other.outputs)
        )

    def constants_alike(self, other: Record) -> bool:
        """Return whether the constants are the same balls."""
        pairs = zip(self.constants, other.constants, strict=False)
        return len(self.constants) == len(other.constants) and all(repr(a) == repr(b) for a, b in pairs)

    def repeated(self) -> Callable[..., tuple[tuple[float, ...], tuple[Any, ...]] | None]:
        """Return what computes outputs and outcomes from other balls, None where a step comes out otherwise.

        Outputs are pairs of doubles, one after another. What nothing depends on is left out.
        """
        needed = {*self.outputs, *(place for used, _ in self.decisions.values() for place in used)}
        lines: list[str] = []
        for text, used, place in reversed(self.steps):
            if place is None or place in needed:
                needed.update(used)
                lines.append(text)
        arguments = ", ".join([*(f"x{k}" for k in range(self.inputs)), *_bound(self.constants)])
        results = "".join(f"*pair(x{place}, 0), " for place in self.outputs)
        outcomes = "".join(f"{text}, " for text in self.decisions)
        source = "\n    ".join([f"def repeat({arguments}):", *reversed(lines), f"return ({results}), ({outcomes})"])
        names = {"pair": pair, "constants": self.constants, **self.functions}
        exec(compile(source, "<record>", "exec"), names)
        found: Callable[..., tuple[tuple[float, ...], tuple[Any, ...]] | None] = names["repeat"]  # type: ignore[assignment]
        return found


def _bound(constants: Sequence[Any]) -> Iterator[str]:
    """Yield constants as arguments with defaults, which are found faster than names of a module."""
    for k in range(len(constants)):
        yield f"c{k}=constants[{k}]"


def _binary(sign: str, operation: Callable[[Any, Any], Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    def forward(self: RecordedBall, other: Any) -> Any:
        return self.record.found(f"{{}} {sign} {{}}", (self, other), operation(self.ball, plain(other)))

    def backward(self: RecordedBall, other: Any) -> Any:
        return self.record.found(f"{{}} {sign} {{}}", (other, self), operation(plain(other), self.ball))

    return forward, backward


def plain(value: Any) -> Any:
    """Return a ball, or a sequence of balls, without their record."""
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return value.ball if isinstance(value, RecordedBall) else value


def _form(value: Any, operands: list[Any]) -> str:
    """Return the form of an argument, whose numbers are added to the operands."""
    if isinstance(value, (list, tuple)):
        return f"({''.join(f'{_form(one, operands)}, ' for one in value)})"
    operands.append(value)
    return "{}"


class RecordedBall:
    """A ball whose operations are recorded.

    Attributes
    ----------
    ball : arb
    place : int
        Of it in the record.
    record : Record
    """

    __slots__ = ("ball", "place", "record")

    def __init__(self, ball: Ball, place: int, record: Record) -> None:
        self.ball, self.place, self.record = ball, place, record

    __add__, __radd__ = _binary("+", lambda a, b: a + b)
    __sub__, __rsub__ = _binary("-", lambda a, b: a - b)
    __mul__, __rmul__ = _binary("*", lambda a, b: a * b)
    __truediv__, __rtruediv__ = _binary("/", lambda a, b: a / b)
    __pow__, __rpow__ = _binary("**", lambda a, b: a**b)
    __lt__, _ = _binary("<", lambda a, b: a < b)
    __gt__, _ = _binary(">", lambda a, b: a > b)
    __le__, _ = _binary("<=", lambda a, b: a <= b)
    __ge__, _ = _binary(">=", lambda a, b: a >= b)
    __eq__, _ = _binary("==", lambda a, b: a == b)
    __ne__, _ = _binary("!=", lambda a, b: a != b)
    __hash__ = None  # type: ignore[assignment]

    def __contains__(self, other: Any) -> bool:
        found: bool = self.record.found("{} in {}", (other, self), plain(other) in self.ball)
        return found

    def __neg__(self) -> Any:
        return self.record.found("-{}", (self,), -self.ball)

    def __abs__(self) -> Any:
        return self.record.found("abs({})", (self,), abs(self.ball))

    def __float__(self) -> float:
        found: float = self.record.found("float({})", (self,), float(self.ball))
        return found

    def __bool__(self) -> bool:
        found: bool = self.record.found("bool({})", (self,), bool(self.ball))
        return found

    def decided(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return a decision between many outcomes, such as an exponent of two, by which members are told apart."""
        operands: list[Any] = []
        self.record.functions[function.__name__] = function
        form = f"{function.__name__}({', '.join(_form(one, operands) for one in arguments)})"
        return self.record.told_apart(form, operands, function(*map(plain, arguments)))

    def pair(self, power: int) -> tuple[Placeholder, Placeholder]:
        """Return what stands for the doubles of the number times a power of two."""
        return Placeholder(self, power, 0), Placeholder(self, power, 1)

    def applied(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return what a function makes of numbers, or of sequences of them, some of which are recorded."""
        operands: list[Any] = []
        self.record.functions[function.__name__] = function
        form = f"{function.__name__}({', '.join(_form(one, operands) for one in arguments)})"
        value = function(*map(plain, arguments))
        return self.record.found(form, operands, tuple(value) if isinstance(value, list) else value)

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name.startswith("_"):
            # By such names other packages ask what something is.
            raise AttributeError(name)
        method = getattr(self.ball, name)

        def call(*arguments: Any) -> Any:
            form = f"{{}}.{name}({', '.join(['{}'] * len(arguments))})"
            return self.record.found(form, (self, *arguments), method(*map(plain, arguments)))

        return call


CODE = 0x7FF8_5C00_0000_0000
"""Bits of the doubles, none of which is a number, that stand for numbers of members; the last ones say for which."""


class Placeholder:
    """What stands for a double that members have each of their own; nothing can be computed with it.

    In an array of doubles it becomes one that is no number and says whose place it is.
    """

    def __init__(self, number: RecordedBall, power: int, part: int) -> None:
        self.number, self.power, self.part = number, power, part

    def __float__(self) -> float:
        record = self.number.record
        if not record.complete:
            raise NotRecorded("a decision by doubles")
        code = CODE + 2 * record.output(self.number.place, self.power) + self.part
        found: float = struct.unpack("d", struct.pack("Q", code))[0]
        return found
