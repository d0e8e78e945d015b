"""Balls that record what is done with them, and the record, by which the same is done with other numbers.

The set-up of a scene is recorded once, from the numbers that differ between members to those of its table. Every
decision on the way (a comparison, a coefficient that is zero, an exponent) is recorded with its outcome. Another member
has the same table in form, the same passes and the same model exactly where all its decisions come out alike, and then
the operations of the record give its numbers to the bit: they are those that would have been done, in the same order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from flint import arb, ctx

from core.multibody.algebra.polynomials import Ball
from core.multibody.equations.packed import exponent, pair


class NotRecorded(Exception):
    """Something was done that a record does not hold, so that members are answered one by one."""


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
    outputs : list of (text, places that it uses)
        Numbers of the table, each as a pair of doubles.
    """

    inputs: int
    steps: list[tuple[str, tuple[int, ...], int | None]] = field(default_factory=list)
    constants: list[Any] = field(default_factory=list)
    outputs: list[tuple[str, int]] = field(default_factory=list)
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
        if isinstance(value, arb):
            result: Any = RecordedBall(value, self._count, self)
            self.steps.append((f"x{self._count} = {text}", tuple(used), self._count))
            self._count += 1
        elif isinstance(value, tuple):
            result = tuple(self.found(f"({text})[{k}]", (), one) for k, one in enumerate(value))
            # The places stand in the text.
            for k, one in enumerate(result):
                self.steps[-len(value) + k] = (self.steps[-len(value) + k][0], tuple(used), one.place)
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

    def output(self, value: RecordedBall, power: int) -> int:
        """Have a number times a power of two among the outputs, and return its place there."""
        used: list[int] = []
        self.outputs.append((f"pair({self.written(value, used)}, {power})", value.place))
        return len(self.outputs) - 1

    def repeated(self) -> Callable[..., tuple[tuple[float, float], ...] | None]:
        """Return what computes the outputs from other balls; None from those for which a decision comes out otherwise.

        What no output and no decision depends on is left out.
        """
        needed = {place for _, place in self.outputs}
        lines: list[str] = []
        for text, used, place in reversed(self.steps):
            if place is None or place in needed:
                needed.update(used)
                lines.append(text)
        arguments = ", ".join([*(f"x{k}" for k in range(self.inputs)), *_bound(self.constants)])
        results = "".join(f"{text}, " for text, _ in self.outputs)
        source = "\n    ".join([f"def repeat({arguments}):", *reversed(lines), f"return ({results})"])
        names: dict[str, Any] = {"pair": pair, "exponent": exponent, "constants": self.constants}
        exec(compile(source, "<record>", "exec"), names)
        found: Callable[..., tuple[tuple[float, float], ...] | None] = names["repeat"]
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
    """Return a ball without its record."""
    return value.ball if isinstance(value, RecordedBall) else value


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
    __eq__, _ = _binary("==", lambda a, b: a == b)  # type: ignore[assignment]
    __ne__, _ = _binary("!=", lambda a, b: a != b)  # type: ignore[assignment]
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

    @property
    def exponent(self) -> int | None:
        """Exponent of two, recorded as a decision; see `equations.packed.exponent`."""
        value = exponent(self.ball)
        if value is None:
            self.record.found("exponent({}) is None", (self,), True)
            return None
        found: int = self.record.found("exponent({})", (self,), value)
        return found

    def __getattr__(self, name: str) -> Callable[..., Any]:
        method = getattr(self.ball, name)

        def call(*arguments: Any) -> Any:
            form = f"{{}}.{name}({', '.join(['{}'] * len(arguments))})"
            return self.record.found(form, (self, *arguments), method(*map(plain, arguments)))

        return call
