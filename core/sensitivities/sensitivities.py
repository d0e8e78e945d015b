"""Derivatives of figures of an answer by numbers of its question, each with an error and a unit.

A number is changed, the question is answered anew, and the figure is read off that answer: what follows an event
changes by the event's time as well as by the state, and an equilibrium moves with what holds it. Where another value
leads to other events, or to no answer, however close it is, there is no derivative, and that is said.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from core.arrays import Floats
from core.assessment.compare import Form, Reference
from core.assessment.graded_question import ANSWERING, GradedQuestion
from core.assessment.propagation import SETTINGS, at, changed, numbers_of, unrounded
from core.assessment.question_source import Source
from core.errors import InvalidParameter, MechanicsError, NotApplicable, Path, pointer_of
from core.near_names import did_you_mean
from core.sensitivities.derivative import Derivative, Known, derivative
from core.sensitivities.figure import Figure
from core.work import spend

MOST_FIGURES, MOST_INPUTS = 20, 20
MOST_ENTRIES = 100_000
"""Of a figure, all its derivatives together."""

SMOOTH: tuple[Form, ...] = ("number", "angle", "vector", "matrix", "samples")
"""Forms of figures that have derivatives; axes and attitudes have a sign that is not theirs, words and counts none."""

BESIDE = 2.0
"""Errors of figures beside a number, in those at the number."""


@dataclass(frozen=True)
class Sensitivity:
    """A derivative of a figure by a number.

    Attributes
    ----------
    of : Figure
    to : path
        Into the request.
    value : float or ndarray
        Of the figure's shape.
    error : float
        Estimate of the largest error of any entry.
    unit : str
        Of the figure by that of the number, as `quotient` writes it.
    """

    of: Figure
    to: Path
    value: float | Floats
    error: float
    unit: str


class Inputs:
    """A question whose numbers are changed, and its figures as functions of them.

    Parameters
    ----------
    source : Source
    request : Any
        As it was sent.
    """

    def __init__(self, source: Source, request: Any) -> None:
        self._source, self.request = source, unrounded(request)
        # No number is uncertain: errors are those of the computation alone.
        self._question = GradedQuestion(source, self.request, {})
        self._answered = cache(self._answer)

    @property
    def answer(self) -> Mapping[str, Any]:
        """The answer to the question as it is; raises what it is refused with."""
        return self._question.answer

    def reference(self, figure: Figure) -> Reference | None:
        """Return a figure of the question as it is with its error, None where it has none."""
        place = figure.place(self.answer)
        return None if place is None else self._question.reference(place)

    def number(self, path: Path) -> float:
        """Return the number at a path of the request.

        Raises
        ------
        InvalidParameter
            If no number that a figure could depend on stands there; its path is empty.
        """
        value = at(self.request, path) if path else None
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            known = [pointer_of(other) for other, _ in numbers_of(self.request, zeros=True)]
            near = did_you_mean(pointer_of(path), known)
            remedy = near or "a formula is not varied, but the numbers in let that it uses are"
            raise InvalidParameter((), "lead to a number of the request", remedy=remedy)
        if path[0] in SETTINGS - {"times"}:
            raise InvalidParameter((), f"lead to a number that figures depend on, and {path[0]} is a setting")
        return float(value)

    def with_number(self, path: Path, number: float) -> Mapping[str, Any]:
        """Return the answer with another number at a path, or raise what the question is refused with then."""
        return self._answered(path, number)

    def unit_of(self, path: Path) -> str | None:
        """Return the unit that a number of the request is written in, None if it is not known."""
        return self._source.units_of_request(self.request)(path)

    def _answer(self, path: Path, number: float) -> Mapping[str, Any]:
        spend(ANSWERING)
        return self._source.answer(json.dumps(changed(self.request, {path: number})))


def sensitivity(inputs: Inputs, of: Figure, to: Path) -> Sensitivity:
    """Return the derivative of a figure by a number of the question.

    Raises
    ------
    InvalidParameter
        With the path ("of",) or ("to",), for what is no figure with derivatives, and for what is no number.
    NotApplicable
        Where the derivative does not exist, with the reason and the names of both.
    """
    number = _named("to", lambda: inputs.number(to))
    reference = inputs.reference(of)
    if not of.continuous:
        raise InvalidParameter(("of",), f"be a figure that may change by little, and {of.words} is a count")
    if reference is None or reference.value is None:
        raise InvalidParameter(("of",), "lead to a figure of the answer")
    if reference.form not in SMOOTH:
        raise InvalidParameter(("of",), f"lead to a number, or an array of numbers, and {of.words} has no derivative")
    if np.size(reference.value) > MOST_ENTRIES:
        raise InvalidParameter(("of",), f"have at most {MOST_ENTRIES} entries")
    middle = np.asarray(reference.value, dtype=np.float64)

    def evaluate(value: float) -> Known:
        if value == number:
            return Known(middle, reference.error)
        answer = inputs.with_number(to, value)
        if of.history(answer) != of.history(inputs.answer):
            raise NotApplicable("other events happen with a value beside this one")
        found = of.value(answer)
        beside = None if found is None or isinstance(found, (str, bool)) else np.asarray(found, dtype=np.float64)
        if beside is None or beside.shape != middle.shape:
            raise NotApplicable(f"{of.words} is another kind of figure with a value beside this one")
        if reference.form == "angle":
            beside = middle + np.remainder(beside - middle + np.pi, 2.0 * np.pi) - np.pi
        return Known(beside, BESIDE * reference.error)

    try:
        found: Derivative = derivative(evaluate, number, abs(number) or _scale(inputs, to))
    except MechanicsError as fault:
        detail = f"{of.words} has no derivative by {pointer_of(to)} here: {fault.detail}"
        raise NotApplicable(detail, path=("to",)) from fault
    value = float(found.value) if found.value.ndim == 0 else found.value
    unit = quotient(reference.unit, inputs.unit_of(to) or f"unit of {pointer_of(to)}")
    return Sensitivity(of, to, value, float(np.max(found.error)), unit)


def _scale(inputs: Inputs, to: Path) -> float:
    """Return what a change of a number that is 0 is compared with: the largest number beside it, 1 without any."""
    beside = [abs(number) for path, number in numbers_of(inputs.request) if path[:-1] == to[:-1]]
    return max(beside, default=1.0)


def quotient(unit: str, by: str) -> str:
    """Return the unit of a derivative, as units of answers are written: ``"s/(m s^-2)"``, ``"1/kg"``."""
    if by == "1":
        return unit
    return f"{unit}/{by}" if by.isalpha() else f"{unit}/({by})"


def sensitivities(inputs: Inputs, of: Sequence[Figure], to: Sequence[Path]) -> list[Sensitivity]:
    """Return the derivatives of figures by numbers, by figure first; see `sensitivity`.

    Faults have the path of what they are about: ("of", i) or ("to", j); so has what is named a second time.
    """
    _require_each_once("of", of)
    _require_each_once("to", to)
    found = []
    for i, figure in enumerate(of):
        for j, path in enumerate(to):
            try:
                found.append(sensitivity(inputs, figure, path))
            except MechanicsError as fault:
                fault.path = {"of": ("of", i), "to": ("to", j)}.get(
                    str(fault.path[0]) if fault.path else "", fault.path
                )
                raise
    return found


def _require_each_once(field: str, named: Sequence[object]) -> None:
    for i, one in enumerate(named):
        if one in named[:i]:
            raise InvalidParameter((field, i), "be named once", remedy="leave out one of the two")


def _named(field: str, call: Callable[[], float]) -> float:
    try:
        return call()
    except InvalidParameter as fault:
        raise InvalidParameter((field,), fault.rule, remedy=fault.remedy) from None
