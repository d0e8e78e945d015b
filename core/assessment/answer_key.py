"""Answer keys: what grading needs to know of one question, as a document that is graded with where nothing is computed.

A key has the references of figures with their bounds, the wrong values of recognised mistakes, and the parameters and
variations by which formulas are judged. The same `Grader` grades with it as with a question that is
answered. Samples are covered at the times for which the key was made.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from core.arrays import Floats
from core.assessment.carried import CarriedStep
from core.assessment.compare import Reference
from core.assessment.comparisons import Comparison
from core.assessment.figures import DESCRIBED, steps_of
from core.assessment.grader import Grader
from core.assessment.mistakes import Figure, Mistake, WrongValues
from core.assessment.results import Result, submission_view
from core.assessment.terms import Terms
from core.errors import NotApplicable, Path, pointer_of
from core.quantities import members_of

if TYPE_CHECKING:
    from core.assessment.graded_question import GradedQuestion

Document = dict[str, Any]

LARGEST_ARRAY = 9
"""Entries of an array that is in a key though nobody claims it: a matrix."""

STATED = tuple(entry.name for entry in fields(Reference) if entry.init)

Place = tuple[Path, tuple[float, ...] | None]
"""Of a figure, or of a column at other times."""


def key_of(
    question: GradedQuestion,
    terms: Terms,
    catalogue: Sequence[Mistake],
    claimed: Sequence[str],
    columns: Sequence[tuple[str, Sequence[float]]],
) -> Document:
    """Return the key of a question.

    Parameters
    ----------
    question : GradedQuestion
    terms : Terms
    catalogue : sequence of Mistake
        With the credits that are given.
    claimed : sequence of str
        Pointers to figures that are in the key beside those of `figures_within`.
    columns : sequence of (str, sequence of float)
        Pointers to columns of samples, each with times.
    """
    paths = dict.fromkeys([*map(steps_of, (*claimed, *terms.steps)), *figures_within(question.answer)])
    found: list[tuple[Place, Reference]] = [
        ((path, None), reference) for path in paths if (reference := question.reference(path)) is not None
    ]
    for pointer, times in columns:
        path = steps_of(pointer)
        column = question.samples(path, np.array(times, dtype=np.float64))
        if column is not None:
            found.append(((path, tuple(times)), column))
    parameters = question.parameters(terms.names)
    numbers = [path for (path, _), reference in found if reference.form in ("number", "angle")]
    # Most figures have their variations at the same parameters, which are written once.
    settings: list[list[float]] = []
    variations: dict[str, list[Any]] = {}
    # Of a described scene without names, a formula says itself what varies, and none is known yet.
    for path in numbers if terms.names is not None or question.subject != DESCRIBED else ():
        at_path = variations[pointer_of(path)] = []
        for one in question.variations(path, parameters):
            values = [one.parameters[name] for name in parameters]
            if values not in settings:
                settings.append(values)
            at_path.append([settings.index(values), one.figure])
    recognised = catalogue if terms.reveal else ()
    return {
        "subject": question.subject,
        "request": question.request,
        "comparison": None if terms.comparison is None else vars(terms.comparison),
        "comparisons": {pointer: vars(comparison) for pointer, comparison in terms.comparisons.items()},
        "reveal": terms.reveal,
        "locale": terms.locale,
        "language": terms.language,
        "steps": {pointer: vars(step) for pointer, step in terms.steps.items()},
        "figures": [_figure(question, place, reference, recognised) for place, reference in found],
        "mistakes": [{name: getattr(entry, name) for name in ("tag", "summary", "credit")} for entry in catalogue],
        "parameters": {name: [list(path), value, unit] for name, (path, value, unit) in parameters.items()},
        "settings": settings,
        "variations": variations,
    }


def figures_within(document: Any, path: Path = ()) -> Iterator[Path]:
    """Yield the paths of an answer's numbers, truth values, strings, nulls and small arrays, those inside of these too.

    The signature and the warnings are no part of an answer's figures, nor are the bounds of their errors.
    """
    if hasattr(document, "_asdict"):
        document = document._asdict()
    elif hasattr(document, "__dataclass_fields__"):
        document = {name: getattr(document, name) for name in document.__dataclass_fields__}
    if isinstance(document, Mapping):
        for name, entry in document.items():
            if name != "errors" and (path or name not in ("signature", "warnings")):
                yield from figures_within(entry, (*path, name))
    elif isinstance(document, (list, tuple, np.ndarray)):
        array = _numbers(document)
        if array is None or array.size <= LARGEST_ARRAY:
            if array is not None:
                yield path
            for i, entry in enumerate(document):
                yield from figures_within(entry, (*path, i))
    else:
        yield path


def _numbers(entries: Any) -> Floats | None:
    try:
        return np.array(entries, dtype=np.float64)
    except (TypeError, ValueError):
        return None


def _figure(question: GradedQuestion, place: Place, reference: Reference, catalogue: Sequence[Mistake]) -> Document:
    path, times = place
    wrong: list[list[Any]] = []
    if reference.form not in ("none",):
        request = question.request | ({} if times is None else {"times": list(times)})
        values = WrongValues(Figure(question.subject, request, path, reference, question.evaluate), tuple(catalogue))
        wrong = [[mistake.tag, _plain(other.value)] for mistake, other in values.entries]
    stated = {name: _plain(getattr(reference, name)) for name in STATED}
    return {"path": list(path), "times": None if times is None else list(times), "reference": stated, "wrong": wrong}


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


class AnswerKey:
    """A key that has been read; see `core.assessment.gradable.Question`.

    Parameters
    ----------
    document : mapping
        As `key_of` makes it, through JSON or not.
    """

    def __init__(self, document: Mapping[str, Any]) -> None:
        self._document = document
        self._figures: dict[Place, Reference] = {}
        self._wrong: dict[tuple[str, Path, tuple[float, ...] | None], list[Any]] = {}
        for entry in document["figures"]:
            path, times = tuple(entry["path"]), None if entry["times"] is None else tuple(entry["times"])
            stated = dict(entry["reference"])
            stated["groups"] = tuple(map(tuple, stated["groups"]))
            self._figures[path, times] = Reference(**stated | {"value": _read(stated["value"])})
            for tag, value in entry["wrong"]:
                self._wrong.setdefault((tag, path, times), []).append(_read(value))

    @property
    def subject(self) -> str:
        """Last steps of the endpoint's path."""
        return str(self._document["subject"])

    @property
    def request(self) -> Any:
        """As it was sent."""
        return self._document["request"]

    def grader(self) -> Grader:
        """Return what grades with the key as the service grades."""
        document = self._document
        terms = Terms(
            None if document["comparison"] is None else _comparison(document["comparison"]),
            {pointer: _comparison(entry) for pointer, entry in document["comparisons"].items()},
            document["reveal"],
            locale=document["locale"],
            language=document["language"],
            steps={pointer: CarriedStep(**entry) for pointer, entry in document["steps"].items()},
        )
        catalogue = [
            Mistake(**entry, wrong=partial(self._wrong_values, entry["tag"])) for entry in document["mistakes"]
        ]
        return Grader(self, terms, catalogue)

    def results(self, submissions: Sequence[Any]) -> list[Result]:
        """Return the results of submissions, as the service answers them."""
        grader = self.grader()
        return [submission_view(i, grader.judged(one), grader.terms) for i, one in enumerate(submissions)]

    def evaluate(self, request: Any) -> Callable[[Path], Any]:
        """Find nothing: no question is question."""
        return lambda path: None

    def reference(self, path: Path) -> Reference | None:
        """Return the reference at a path, None if there is none in the key."""
        return self._figures.get((path, None))

    def figures_in(self, path: Path) -> list[str]:
        """Return the fields of the object at a path that are figures."""
        return sorted(str(place[-1]) for place, times in self._figures if times is None and place[:-1] == path)

    def samples(self, path: Path, times: Floats) -> Reference | None:
        """Return a column of samples at other times.

        Raises
        ------
        NotApplicable
            If the key has none at these times.
        """
        found = self._figures.get((path, tuple(times.tolist())))
        if found is None:
            raise NotApplicable("the answer key has samples at other times")
        return found

    def parameters(self, names: Mapping[str, Path] | None) -> dict[str, tuple[Path, float, str]]:
        """Return path, value and unit of the numbers that formulas may name."""
        stated = self._document["parameters"]
        return {name: (tuple(path), value, unit) for name, (path, value, unit) in stated.items()}

    def variations(self, path: Path, parameters: Mapping[str, tuple[Path, float, str]]) -> list[KeyedVariation]:
        """Return the variations at which the figure at a path is known."""
        names = self._document["parameters"]
        settings = [dict(zip(names, values, strict=True)) for values in self._document["settings"]]
        found = self._document["variations"].get(pointer_of(path), ())
        return [KeyedVariation(settings[i], figure) for i, figure in found]

    def rotation(self) -> None:
        """Find nothing: the method that samples come from is not looked for."""
        return

    def _wrong_values(self, tag: str, figure: Figure) -> list[Any]:
        own = self._wrong.get((tag, figure.path, None), [])
        times = figure.request.get("times")
        column = tuple(times) if isinstance(times, list) else None
        return own if (figure.path, column) not in self._figures else self._wrong.get((tag, figure.path, column), [])


@dataclass(frozen=True)
class KeyedVariation:
    """Parameters by name, and the figure that belongs to them."""

    parameters: Mapping[str, float]
    figure: float


def _read(value: Any) -> Any:
    return np.array(value, dtype=np.float64) if isinstance(value, list) else value


def _comparison(entry: Mapping[str, Any]) -> Comparison:
    kinds: dict[str, Any] = {member.kind: member for member in members_of(Comparison)}  # type: ignore[attr-defined]
    made: Comparison = kinds[entry["kind"]](**entry)
    return made
