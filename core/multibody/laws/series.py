"""The Taylor coefficients of the values of formulas along a motion whose own are still being found, in balls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import mul

from flint import arb

from core.balls import as_text, raised
from core.errors import InvalidParameter
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, is_zero
from core.multibody.laws.law import Law
from core.multibody.laws.tape import Op, Tape

Series = list[Ball]

FUNCTIONS: dict[int, Callable[[Ball], Ball]] = {
    Op.ROOT: arb.sqrt,
    Op.EXP: arb.exp,
    Op.SINE: arb.sin,
    Op.COSINE: arb.cos,
    Op.SINH: arb.sinh,
    Op.COSH: arb.cosh,
    Op.TANH: arb.tanh,
    Op.LOG: arb.log,
    Op.ASIN: arb.asin,
    Op.ATAN: arb.atan,
}
"""Values of the functions of one number."""


class LawSeries:
    """The values of some laws as series.

    Parameters
    ----------
    laws : sequence of Law
    """

    def __init__(self, laws: Sequence[Law]) -> None:
        self.laws, self.tape = laws, Tape.of(laws)
        self.values: list[Series] = [[] for _ in self.tape.operations]

    def add_to(self, right: list[Ball], places: Sequence[Series], rates: Sequence[Series], power: int) -> None:
        """Add coefficient `power` of the forces to a right-hand side; the earlier ones have been formed.

        Parameters
        ----------
        right : list of balls
            By coordinate, to which the forces are added.
        places, rates : sequence of series
            Of every coordinate, up to that power.
        """
        for number in range(len(self.values)):
            self.values[number].append(self._coefficient(number, places, rates, power))
        for law, output in zip(self.laws, self.tape.outputs, strict=True):
            for i, factor in law.push.items():
                right[i] = right[i] + factor * self.values[output][power]

    def value(self, law: int) -> Ball:
        """Return the value of a law at the start of the series."""
        return self.values[self.tape.outputs[law]][0]

    def _coefficient(self, number: int, places: Sequence[Series], rates: Sequence[Series], k: int) -> Ball:
        code, a, b, c, d = self.tape.operations[number]
        values, own = self.values, self.values[number]
        match code:
            case Op.NUMBER:
                return self.tape.numbers[a] if k == 0 else ZERO
            case Op.PLACE:
                start = self.tape.numbers[a] if k == 0 else ZERO
                return sum((x * places[i][k] for i, x, _ in self.tape.terms[b:c]), start)
            case Op.RATE:
                return sum((x * rates[i][k] for i, x, _ in self.tape.terms[b:c]), ZERO)
            case Op.ADD:
                return values[a][k] + values[b][k]
            case Op.SUBTRACT:
                return values[a][k] - values[b][k]
            case Op.MULTIPLY:
                return convolved(values[a][: k + 1], values[b][: k + 1])
            case Op.DIVIDE:
                return (values[a][k] - convolved(values[b][1 : k + 1], own[:k])) / values[b][0]
            case Op.ATAN2 if k == 0:
                return arb.atan2(values[a][0], values[b][0])
            case Op.POWER if k == 0:
                return raised(values[a][0], self.tape.numbers[b])
            case Op.TANH_SLOPE:
                tangent = values[number - 1][: k + 1]
                return (ONE if k == 0 else ZERO) - convolved(tangent, tangent)
            case Op.LENGTH:
                return _length(own, [values[i] for i in (a, b, c)], k)
        if k == 0:
            return FUNCTIONS[code](values[a][0])
        match code:
            case Op.ROOT:
                return (values[a][k] - convolved(own[1:k], own[1:k])) / (2 * own[0])
            case Op.EXP:
                return _integrated(values[a], own, k)
            case Op.SINE | Op.SINH | Op.TANH:
                return _integrated(values[a], values[number + 1], k)
            case Op.COSINE:
                return -_integrated(values[a], values[number - 1], k)
            case Op.COSH:
                return _integrated(values[a], values[number - 1], k)
            case Op.LOG | Op.ASIN | Op.ATAN:
                return _integrated(values[a], values[b], k)
            case Op.ATAN2:
                return _integrated(values[a], values[c], k) + _integrated(values[b], values[d], k)
        exponent = self.tape.numbers[b]
        total = sum(((exponent * j - (k - j)) * values[a][j] * own[k - j] for j in range(1, k + 1)), ZERO)
        return total / (k * values[a][0])


def convolved(first: Sequence[Ball], second: Sequence[Ball]) -> Ball:
    """Return the sum of products of which the first of one series meets the last of the other."""
    return sum(map(mul, first, reversed(second)), ZERO)


def _integrated(argument: Series, derivative: Series, k: int) -> Ball:
    """Return coefficient k of what changes by a derivative times the change of an argument."""
    return sum((j * argument[j] * derivative[k - j] for j in range(1, k + 1)), ZERO) / k


def _length(own: Series, vector: Sequence[Series], k: int) -> Ball:
    """Return coefficient k of the length of a vector, which may grow from zero with time.

    A vector that begins as t^m w has the length t^m |w|.
    """
    leading = next((m for m in range(k + 1) if not all(is_zero(part[m]) for part in vector)), None)
    if leading is None:
        return ZERO
    square = sum((convolved(part[leading : k + 1], part[leading : k + 1]) for part in vector), ZERO)
    if k == leading:
        return square.sqrt()
    return (square - convolved(own[leading + 1 : k], own[leading + 1 : k])) / (2 * own[leading])


def values_at(laws: Sequence[Law], q: Sequence[Ball], v: Sequence[Ball]) -> list[Ball]:
    """Return the values of some laws at a state.

    Raises
    ------
    InvalidParameter
        For a formula that has no value there, with its path.
    """
    if not laws:
        return []
    series = LawSeries(laws)
    series.add_to([ZERO] * len(q), [[x] for x in q], [[x] for x in v], 0)
    found = [series.value(number) for number in range(len(laws))]
    for law, value in zip(laws, found, strict=True):
        if not value.is_finite():
            inputs = ", ".join(f"{name} = {as_text(one.value(q, v), 6)}" for name, one in law.inputs.items())
            rule = "have a value at the start: it divides by zero, or leaves the domain of a function"
            raise InvalidParameter(law.path, f"{rule}, where {inputs}" if inputs else rule)
    return found
