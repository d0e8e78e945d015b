"""The request of a study, and what a study will be: its members and figures."""

from __future__ import annotations

import json
from collections.abc import Sequence
from time import thread_time
from typing import Annotated

from pydantic import Field

from core.assessment.figures import is_null, steps_of, value_at
from core.assessment.propagation import at
from core.assessment.varied_input import LONGEST_WORD
from core.errors import BudgetExceeded, InvalidParameter, Path
from core.formulas import is_formula
from core.quantities import Quantity
from core.studies.designs import Design, Kind
from core.studies.statistics import BINS, PROBABILITIES, STATISTICS, Statistic
from core.studies.study_input import StudyInput
from core.systems.budget import Budget
from service.requests.declared_units import unit_at
from service.routes.assessments.question_table import WITHIN, EndpointRequest, QuestionTable, within_question
from service.routes.studies.members import Members, number_of
from service.routes.studies.views import StudyState
from service.routing import Answer, PostRoute, StudyRoute
from service.schemas import Request

PATH = "/v1/studies"

MOST_VARIED = 20
MOST_QUANTITIES = 20

MOST_BINS = 1000

SECONDS_AMONG_MANY = 8e-6
"""Of a member that is answered together with many others."""

Seed = Annotated[int, Quantity("1", at_least=0, at_most=2**53 - 1)]
Count = Annotated[int, Quantity("1", at_least=1)]
Bins = Annotated[int, Quantity("1", at_least=1, at_most=MOST_BINS)]
Probability = Annotated[float, Quantity("1", at_least=0, at_most=1)]


class StudyRequest(Request):
    """One question with varied inputs, and the figures of its answers that are wanted."""

    question: EndpointRequest = Field(description="It has to be answerable as it is; what varies has to be in it.")
    vary: list[StudyInput] = Field(description="What varies.", min_length=1, max_length=MOST_VARIED)
    design: Kind = Field(
        default="product",
        description="product: every combination of levels, the last input varying fastest; zip: levels side by side; "
        "random: independent draws; sobol: scrambled Sobol points.",
    )
    count: Count | None = Field(default=None, description="Of members, in the designs random and sobol.")
    seed: Seed | None = Field(
        default=None,
        description="Of the designs random and sobol, 0 by default: equal requests draw alike.",
    )
    quantities: list[str] = Field(
        min_length=1,
        max_length=MOST_QUANTITIES,
        description="Figures of each member, by pointer into its answer: numbers, and truth values as 1 and 0.",
    )
    statistics: list[Statistic] = Field(
        default=[*STATISTICS], max_length=len(STATISTICS), description="Of each figure over all members."
    )
    probabilities: list[Probability] = Field(default=[*PROBABILITIES], max_length=100, description="Of quantiles.")
    bins: Bins = Field(default=BINS, description="Of histograms.")

    def all_members(self) -> Design:
        """Return the design of the members.

        Raises
        ------
        InvalidParameter
            If the inputs do not fit the design, or an option is given for a statistic that is not wanted.
        """
        for option, statistic in (("bins", "histogram"), ("probabilities", "quantiles")):
            if option in self.model_fields_set and statistic not in self.statistics:
                raise InvalidParameter(option, f"be left out where the statistics have no {statistic}")
        return Design(tuple(self.vary), self.design, self.count, self.seed)


DESCRIPTION = """Answered with 202 and the state of the study; its address is in the Location header. Members that are
refused are part of the results, with the code of their problem. Results are a function of the request alone: the
same bits whatever the number of processes, and after any interruption. `/v1/plan` tells the number of members."""


A_FIGURE = "lead to a number, true or false in the answer"
"""Rule of a quantity. Whether it begins with a field of the answer is known without one."""


def studying(routes: Sequence[PostRoute]) -> StudyRoute:
    """Return the route of studies of questions to `routes`."""
    table = QuestionTable(routes, (), "have studies")

    def plan(question: StudyRequest, budget: Budget) -> Answer:
        return _answerable(question, table, budget)

    def require(question: StudyRequest, budget: Budget) -> None:
        _require_members(question, budget)
        _places(question, table.readable(question.question))

    def members(question: StudyRequest, budget: Budget) -> Members:
        return Members(question, table.source(question.question, budget))

    return StudyRoute(
        PATH,
        "create_study",
        "A study: any problem with varied inputs, computed in the background",
        "studies",
        StudyRequest,
        StudyState,
        plan,
        description=DESCRIPTION,
        members=members,
        require=require,
        paths=frozenset(route.path for route in routes),
    )


def _answerable(question: StudyRequest, table: QuestionTable, budget: Budget) -> Answer:
    """Return what is planned of a study whose question is answered as it is, or refuse it."""
    _require_members(question, budget)
    source = table.source(question.question, budget)
    before = thread_time()
    with within_question():
        answer = source.answer(json.dumps(question.question.request))
    found = _planned(question, table, budget, thread_time() - before)
    for k, figure in enumerate(_places(question, table.route(question.question))[1]):
        value = value_at(answer, figure)
        if number_of(value) is None and not is_null(answer, figure):
            raise InvalidParameter(("quantities", k), A_FIGURE)
    return found | {"warnings": [notice.inside(*WITHIN) for notice in answer.get("warnings", ())]}


def _require_members(question: StudyRequest, budget: Budget) -> Design:
    """Return the design, or refuse more members than are allowed."""
    design = question.all_members()
    if design.members > budget.members:
        remedy = "take fewer levels or a smaller count, or several studies"
        path = ("vary",) if question.count is None else ("count",)
        raise BudgetExceeded("members", design.members, budget.members, path=path, remedy=remedy)
    return design


def _planned(question: StudyRequest, table: QuestionTable, budget: Budget, each: float) -> Answer:
    """Return members, inputs, figures, time and size of a study whose question took some processor time (s)."""
    route, design = table.route(question.question), _require_members(question, budget)
    inputs, figures = _places(question, route)
    members = Members(question, table.source(question.question, budget))
    together = members.together
    seconds = design.members * (SECONDS_AMONG_MANY if together else each)
    axes = zip(question.vary, inputs, strict=True)
    return {
        "path": route.path,
        "count": design.members,
        "shape": list(design.shape),
        "inputs": [
            {
                "pointer": entry.pointer,
                "unit": unit_at(route.question, path),
                "levels": None if question.count is not None else entry.levels,
            }
            for entry, path in axes
        ],
        "figures": [
            {"pointer": pointer, "unit": unit_at(route.answer, path)}
            for pointer, path in zip(question.quantities, figures, strict=True)
        ],
        "together": together,
        "seconds": seconds,
        "bytes": members.bytes_of(seconds),
    }


def _places(question: StudyRequest, route: PostRoute) -> tuple[list[Path], list[Path]]:
    """Return the places of the varied inputs in the request and of the figures in the answer."""
    taken: set[Path] = set()
    inputs = []
    for k, entry in enumerate(question.vary):
        for within, pointer in (
            (("vary", k, "pointer"), entry.pointer),
            *((("vary", k, "also", i), other) for i, other in enumerate(entry.also)),
        ):
            path = _steps(pointer, within)
            present = at(question.question.request, path)
            if present is None:
                remedy = "what varies has to be in the request of the question"
                raise InvalidParameter(within, "lead to a value in the request", remedy=remedy)
            names = question.question.request.get("let") or ()
            if entry.values is None and isinstance(present, str) and not is_formula(present, names):
                remedy = "words vary by values"
                raise InvalidParameter(within, "lead to a number or a formula in the request", remedy=remedy)
            if any(path[: len(other)] == other or other[: len(path)] == path for other in taken):
                raise InvalidParameter(within, "vary nothing that another entry varies")
            taken.add(path)
        inputs.append(_steps(entry.pointer, ("vary", k, "pointer")))
    figures: list[Path] = []
    for k, pointer in enumerate(question.quantities):
        path = _steps(pointer, ("quantities", k))
        if path in figures:
            raise InvalidParameter(("quantities", k), "name another figure than those before it")
        if path[:1] and path[0] not in route.answer.model_fields:
            raise InvalidParameter(("quantities", k), A_FIGURE)
        figures.append(path)
    return inputs, figures


def _steps(pointer: str, within: Path) -> Path:
    try:
        if len(pointer) > LONGEST_WORD:
            raise InvalidParameter((), f"have at most {LONGEST_WORD} characters")
        return steps_of(pointer)
    except InvalidParameter as fault:
        raise InvalidParameter(within, fault.rule, remedy=fault.remedy) from None


__all__ = ["PATH", "StudyRequest", "studying"]
