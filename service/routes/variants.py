"""Well-conditioned variants of any problem, drawn from a seed, each with its figures."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from core.assessment.figures import is_null, steps_of, value_at
from core.assessment.graded_question import GradedQuestion
from core.assessment.propagation import at
from core.assessment.results import reference_view
from core.assessment.variants import Constraint, Member, Variants
from core.assessment.varied_input import LONGEST_WORD, VariedInput
from core.errors import BudgetExceeded, InvalidParameter, Path, pointer_of
from core.notices import Notice
from core.quantities import Quantity, Uncertainty
from core.systems.budget import Budget
from service.responses.json_rows import written
from service.routes.assessments.question_table import WITHIN, EndpointRequest, QuestionTable
from service.routes.assessments.views import ReferenceFigure
from service.routing import Answer, PostRoute
from service.schemas import Envelope, Ratio, Request, View

MOST_VARIED = 40
MOST_FIGURES = 20
"""Figures of a member, and numbers of the answer that are figures unless `quantities` names them."""
LARGEST_FIGURE = 9
"""Entries of an array that is a figure unless named: a matrix."""

MOST_NUMBERS = 100_000
"""In the figures of all variants."""


NO_FIGURES = ("signature", "warnings", "accuracy", "work", "model")
"""Fields of answers that are not about the motion."""

Seed = Annotated[int, Quantity("1", at_least=0, at_most=2**53 - 1)]
Count = Annotated[int, Quantity("1", at_least=1, at_most=200)]
Draws = Annotated[int, Quantity("1", at_least=1, at_most=1000)]
Condition = Annotated[float, Quantity("1", at_least=1)]


class VariantsRequest(Request):
    """A question, and what varies in it."""

    question: EndpointRequest = Field(description="It has to be answerable as it is; what varies has to be in it.")
    vary: dict[str, VariedInput] = Field(
        description="What is drawn anew, by pointer into the request of the question.", min_length=1
    )
    seed: Seed = Field(description="Equal requests have equal variants; the first are the same whatever the count.")
    count: Count = Field(default=10, description="Of variants.")
    quantities: list[str] | None = Field(
        default=None,
        max_length=MOST_FIGURES,
        description=f"Figures that are answered, by pointer into the answer of the question; default: its numbers and "
        f"arrays of at most {LARGEST_FIGURE}, the first {MOST_FIGURES} of them. Those that are named exist in every "
        "variant.",
    )
    constraints: dict[str, Constraint] | None = Field(
        default=None, description="What is required of figures, by pointer into the answer.", max_length=MOST_FIGURES
    )
    max_condition: Condition | None = Field(
        default=None, description="Largest condition of any figure that is answered."
    )
    input_uncertainty: Uncertainty | None = Field(
        default=None,
        description="Relative uncertainty of every number of the question, propagated to the figures; default: half a "
        "unit in the last place.",
    )
    draws: Draws = Field(default=200, description="After which it is given up to find one variant.")


class VariantFigure(ReferenceFigure):
    """A figure of a variant, how well it is known and how sensitive it is."""

    condition: Ratio[float] | None = Field(
        description="How many times the relative uncertainty of the numbers of the question that of the figure is, to "
        "first order in the worst case; null where the figure has no relative error."
    )


class Variant(View):
    """A question with other numbers, and its figures."""

    request: dict[str, Any] = Field(description="The body to be sent to the path of the question.")
    figures: list[VariantFigure] = Field(description="In the order of the quantities.")
    draws: int = Field(description="That were needed to find it.", json_schema_extra={"x-unit": "1"})


class VariantsAnswer(Envelope):
    """Variants of a question."""

    path: str = Field(description="Of the endpoint that the requests go to.")
    seed: int = Field(description="As in the request.", json_schema_extra={"x-unit": "1"})
    variants: list[Variant] = Field(description="As many as `count`.")
    rejected: dict[str, int] = Field(
        description="How many draws were rejected, by reason: refused (the question has no answer with them), warned "
        "(by another kind of warning than the question as it is, such as that no body has these moments), absent (a "
        "figure does not exist), repeated (an earlier variant has the same request), condition, or the pointer of a "
        "constraint."
    )


DESCRIPTION = """Ranges may be uniform or log-uniform, on a grid (`step`) or of few digits (`digits`); `values` are a
choice; `also` gives other numbers the same value. A draw that is rejected is drawn again, at most `draws` times; if no
variant is found then, the request is refused with the reasons and their counts."""


def varying(routes: Sequence[PostRoute], certified: Sequence[PostRoute]) -> PostRoute:
    """Return the route that varies questions to `routes`, some of which have proven digits, too."""
    table = QuestionTable(routes, certified)

    def vary(question: VariantsRequest, budget: Budget) -> Answer:
        inner = question.question
        table.route(inner)
        varied, together = _places(question)

        def ask(request: Any) -> GradedQuestion:
            return table.graded(inner, request, budget, question.input_uncertainty)

        answer = table.answered(inner, budget, question.input_uncertainty).answer
        figures, warnings = _figures(question, answer)
        _require_few_numbers(question, answer, figures.values())
        constraints = question.constraints or {}
        constrained = {pointer: _path(pointer, answer, ("constraints",)) for pointer in constraints}
        source = Variants(
            inner.request, varied, together, ask, figures, constraints, constrained, question.max_condition,
            question.input_uncertainty, question.draws, frozenset(notice.code for notice in answer.get("warnings", ())),
            question.quantities is not None,
        )  # fmt: skip
        members = source.members(question.seed, question.count)
        return {
            "path": inner.path,
            "seed": question.seed,
            "variants": [_view(member) for member in members],
            "rejected": dict(sorted(source.rejected.items())),
            "warnings": warnings,
        }

    return PostRoute(
        "/v1/variants",
        "vary",
        "Well-conditioned variants of any problem from a seed, with their values, errors and condition numbers",
        "assessment",
        VariantsRequest,
        VariantsAnswer,
        vary,
        description=DESCRIPTION,
    )


def _places(question: VariantsRequest) -> tuple[dict[Path, VariedInput], dict[Path, list[Path]]]:
    """Return what varies, by place in the request, and the places that are given the same value."""
    varied: dict[Path, VariedInput] = {}
    together: dict[Path, list[Path]] = {}
    if len(question.vary) > MOST_VARIED:
        raise InvalidParameter("vary", f"have at most {MOST_VARIED} entries")
    taken: set[Path] = set()
    for pointer, variation in question.vary.items():
        within = ("vary", pointer) if len(pointer) <= LONGEST_WORD else ("vary",)
        path = _place(pointer, variation, question, within)
        others = [_place(other, variation, question, (*within, "also", i)) for i, other in enumerate(variation.also)]
        for place in (path, *others):
            if place in taken:
                raise InvalidParameter(within, "vary no number that another entry varies")
            taken.add(place)
        varied[path], together[path] = variation, others
    return varied, together


def _place(pointer: str, variation: VariedInput, question: VariantsRequest, within: Path) -> Path:
    """Return the path of a value of the request that a variation can replace."""
    try:
        path = steps_of(pointer) if len(pointer) <= LONGEST_WORD else ()
    except InvalidParameter as fault:
        raise InvalidParameter(within, "be a JSON pointer into the request", remedy='such as "/gravity"') from fault
    before = at(question.question.request, path) if path else None
    kinds = {_kind(value) for value in variation.values or (0.0,)}
    if kinds != {_kind(before)}:
        named = kinds.pop() if len(kinds) == 1 else "value of one kind"
        remedy = "what varies has to be in the request of the question"
        raise InvalidParameter(within, f"lead to a {named} in the request", remedy=remedy)
    return path


def _kind(value: Any) -> str:
    if isinstance(value, bool):
        return "truth value"
    if isinstance(value, (int, float)):
        return "number"
    return "string" if isinstance(value, str) else "null, an array or an object"


def _figures(question: VariantsRequest, answer: Mapping[str, Any]) -> tuple[dict[str, Path], list[Notice]]:
    """Return the figures that are answered, by pointer, and whether some were left out."""
    warnings = [notice.inside(*WITHIN) for notice in answer.get("warnings", ())]
    if question.quantities is not None:
        named = enumerate(question.quantities)
        return {pointer: _path(pointer, answer, ("quantities",), i) for i, pointer in named}, warnings
    found = [*_numbers({name: entry for name, entry in answer.items() if name not in NO_FIGURES})]
    if len(found) > MOST_FIGURES:
        detail = f"the answer has {len(found)} figures, of which the first {MOST_FIGURES} are answered"
        warnings.append(Notice("figures-left-out", detail, ("quantities",)))
    return {pointer_of(path): path for path in found[:MOST_FIGURES]}, warnings


def _require_few_numbers(question: VariantsRequest, answer: Mapping[str, Any], paths: Iterable[Path]) -> None:
    numbers = question.count * sum(np.size(value_at(answer, path)) for path in paths)
    if numbers > MOST_NUMBERS:
        remedy = "ask for fewer variants, fewer samples or other quantities"
        raise BudgetExceeded("numbers in figures", numbers, MOST_NUMBERS, path=("count",), remedy=remedy)


def _numbers(fields: Answer) -> Iterator[Path]:
    """Yield the paths of numbers, vectors and matrices, those of samples left out."""
    rest: list[tuple[Path, Any]] = [((), json.loads(written(fields)))]
    while rest:
        path, value = rest.pop()
        if isinstance(value, Mapping):
            rest.extend(((*path, name), entry) for name, entry in reversed([*value.items()]))
        elif isinstance(value, float | int) and not isinstance(value, bool):
            yield path
        elif isinstance(value, list) and value:
            figure = value_at({"": value}, ("",))
            if isinstance(figure, np.ndarray):
                if figure.size <= LARGEST_FIGURE:
                    yield path
            else:
                rest.extend(((*path, i), entry) for i, entry in reversed([*enumerate(value)]))


def _path(pointer: str, answer: Mapping[str, Any], within: Path, *place: int) -> Path:
    """Return the path of a figure of the answer, which may be one that does not exist for the question as it is."""
    shown = (*within, *place) if place else (*within, pointer) if len(pointer) <= LONGEST_WORD else within
    try:
        path = steps_of(pointer) if len(pointer) <= LONGEST_WORD else ()
    except InvalidParameter as fault:
        raise InvalidParameter(shown, fault.rule, remedy=fault.remedy) from None
    if not path or (value_at(answer, path) is None and not is_null(answer, path)):
        raise InvalidParameter(shown, "lead to a figure of the answer: a number, an array, a string, true or false")
    return path


def _view(member: Member) -> Answer:
    figures = [
        reference_view(pointer, reference) | {"condition": member.conditions[pointer]}
        for pointer, reference in member.references.items()
    ]
    return {"request": member.request, "figures": figures, "draws": member.draws}
