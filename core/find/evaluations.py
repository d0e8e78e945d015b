"""The question that is asked backwards, asked forwards with some values of its inputs, each once."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

from core.assessment.graded_question import GradedQuestion
from core.assessment.propagation import changed
from core.errors import MechanicsError
from core.find.figures import Value, error_of, value_of
from core.find.varied import Varied
from core.sensitivities.figure import Figure
from core.work import spend

RECENT = 6
"""Answers that are kept, as their errors may be wanted; they may be large."""

ASKING = 60
"""Work (`core.work`) of asking a question, beside what the question counts itself."""


@dataclass(frozen=True)
class Sample:
    """What an answer has with some values of the inputs.

    Attributes
    ----------
    inputs : tuple of float
    values : tuple
        Of the figures, None where the answer has none; empty where the question is refused.
    refused : MechanicsError or None
        Why there is no answer.
    """

    inputs: tuple[float, ...]
    values: tuple[Value | None, ...]
    refused: MechanicsError | None = None

    @property
    def numbers(self) -> tuple[float, ...] | None:
        """The figures, if all of them are numbers."""
        found = [value for value in self.values if isinstance(value, float)]
        return tuple(found) if found and len(found) == len(self.values) else None


class Evaluations:
    """Answers with other inputs.

    Parameters
    ----------
    request : Any
        The question as it was sent.
    varied : sequence of Varied
    figures : sequence of Figure
        That are read off the answers.
    ask : callable
        From a request to the question with its answer, which raises `MechanicsError` where it is refused.

    Attributes
    ----------
    count : int
        How often the question was asked.
    """

    def __init__(
        self,
        request: Any,
        varied: Sequence[Varied],
        figures: Sequence[Figure],
        ask: Callable[[Any], GradedQuestion],
    ) -> None:
        self.request, self.varied, self.figures, self._ask = request, tuple(varied), tuple(figures), ask
        self.count = 0
        self.samples: dict[tuple[float, ...], Sample] = {}
        self._recent: OrderedDict[tuple[float, ...], GradedQuestion] = OrderedDict()
        self._errors: dict[tuple[tuple[float, ...], int], float] = {}

    def at(self, inputs: tuple[float, ...]) -> Sample:
        """Return what the answer with some inputs has."""
        if inputs not in self.samples:
            self.samples[inputs] = self._sampled(inputs)
        return self.samples[inputs]

    def error(self, inputs: tuple[float, ...], k: int = 0) -> float:
        """Return the error of the k-th figure with some inputs; infinite where nothing is known of it."""
        if (inputs, k) not in self._errors:
            if self.at(inputs).values[k] is None:
                return inf
            error = error_of(self.figures[k], self._question(inputs))
            self._errors[inputs, k] = error if isfinite(error) else inf
        return self._errors[inputs, k]

    def answer(self, inputs: tuple[float, ...]) -> Mapping[str, Any]:
        """Return the whole answer with some inputs."""
        return self._question(inputs).answer

    def unit(self, k: int) -> str | None:
        """Return the unit of the k-th figure, None where no answer has a number for it."""
        figure = self.figures[k]
        for inputs in [*reversed(self._recent), *self.samples]:
            sample = self.samples.get(inputs)
            if sample is not None and sample.values and isinstance(sample.values[k], float):
                question = self._question(inputs)
                place = figure.place(question.answer)
                return question.unit(place) if figure.continuous and place is not None else "1"
        return None

    def first_refusal(self) -> MechanicsError | None:
        """Return why the first of the questions that were refused was."""
        return next((sample.refused for sample in self.samples.values() if sample.refused is not None), None)

    def some_answer(self) -> Mapping[str, Any] | None:
        """Return one of the answers, None where there is none."""
        inputs = next((sample.inputs for sample in self.samples.values() if sample.refused is None), None)
        return None if inputs is None else self.answer(inputs)

    def _sampled(self, inputs: tuple[float, ...]) -> Sample:
        try:
            answer = self._question(inputs).answer
        except MechanicsError as refusal:
            return Sample(inputs, (), refusal)
        return Sample(inputs, tuple(_finite(value_of(figure, answer)) for figure in self.figures))

    def _question(self, inputs: tuple[float, ...]) -> GradedQuestion:
        if inputs not in self._recent:
            spend(ASKING)
            self.count += 1
            changes = {one.path: value for one, value in zip(self.varied, inputs, strict=True)}
            self._recent[inputs] = self._ask(changed(self.request, changes))
            if len(self._recent) > RECENT:
                self._recent.popitem(last=False)
        return self._recent[inputs]


def _finite(value: Value | None) -> Value | None:
    return None if isinstance(value, float) and not isfinite(value) else value


class Curve:
    """One figure along one input.

    Attributes
    ----------
    varied : Varied
    """

    def __init__(self, evaluations: Evaluations) -> None:
        self.varied, self._evaluations = evaluations.varied[0], evaluations

    def sample(self, x: float) -> Sample:
        """Return what is answered with a value of the input."""
        return self._evaluations.at((x,))

    def answer(self, x: float) -> Mapping[str, Any]:
        """Return the whole answer at a value of the input, where there is one."""
        return self._evaluations.answer((x,))

    def value(self, x: float) -> Value | None:
        """Return the figure, None where the answer has none or the question is refused."""
        values = self.sample(x).values
        return values[0] if values else None

    def number(self, x: float) -> float | None:
        """Return the figure as a number, None where it is none."""
        numbers = self.sample(x).numbers
        return None if numbers is None else numbers[0]

    def error(self, x: float) -> float:
        """Return the error of the figure."""
        return self._evaluations.error((x,))

    @property
    def known(self) -> list[float]:
        """The values of the input that were tried, in ascending order."""
        return sorted(x for (x,) in self._evaluations.samples)
