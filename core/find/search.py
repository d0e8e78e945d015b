"""A question asked backwards: with which inputs does a figure take a value, become extreme or infinite, or change?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from typing import Any, Literal, get_args

from core.assessment.figures import is_null
from core.assessment.graded_question import GradedQuestion
from core.errors import InvalidParameter, MechanicsError, pointer_of
from core.find.borders import FIRST, REFUSED, borders_of, case_of, jumps_of
from core.find.evaluations import Curve, Evaluations
from core.find.extremes import extremes_of
from core.find.figures import Value, events_within, lists_within, names_nothing, single_figures
from core.find.infinite import infinities_of
from core.find.roots import roots_of
from core.find.scanning import FIRST as FEW
from core.find.scanning import first_shares, widest
from core.find.solutions import Findings
from core.find.systems import PER_INPUT, solved_system
from core.find.varied import Varied
from core.near_names import MOST_LISTED, did_you_mean
from core.notices import Notice
from core.sensitivities.figure import Figure

Wanted = Literal["equals", "least", "largest", "infinite", "changes", "happens"]

WANTED: tuple[Wanted, ...] = get_args(Wanted)

MOST_INPUTS = 3
"""Inputs that are varied together."""


@dataclass(frozen=True)
class Condition:
    """What is to hold of an answer.

    Attributes
    ----------
    figure : Figure
    wanted : str
        One of `Wanted`.
    equals : number, word or truth value, or None
        The value that the figure is to have.
    of_event : bool
        Whether the figure is about an event: that it does not happen is then no fault of the request.
    """

    figure: Figure
    wanted: Wanted
    equals: Value | None = None
    of_event: bool = False


def found(
    request: Any,
    varied: Sequence[Varied],
    conditions: Sequence[Condition],
    ask: Callable[[Any], GradedQuestion],
) -> tuple[Findings, Evaluations]:
    """Return the inputs with which the conditions hold, and the answers that were looked at.

    Parameters
    ----------
    request : Any
        The question; what is varied has values in it.
    varied : sequence of Varied
        From one to `MOST_INPUTS`.
    conditions : sequence of Condition
        As many.
    ask : callable
        From a request to the question with its answer, which raises `MechanicsError` where it is refused.

    Raises
    ------
    InvalidParameter
        If the conditions do not fit the figures, or no answer has them.
    MechanicsError
        If the question is refused with every value that was tried.
    """
    evaluations = Evaluations(request, varied, [one.figure for one in conditions], ask)
    if len(varied) > 1:
        return _several(evaluations, conditions), evaluations
    curve, condition = Curve(evaluations), conditions[0]
    if not _look(curve, condition.figure) and not condition.of_event:
        _missing(evaluations, conditions)
    findings = _one(curve, condition)
    findings.notices += _missing(evaluations, conditions)
    findings.resolution = (widest(curve),)
    return findings, evaluations


def _look(curve: Curve, figure: Figure) -> bool:
    """Ask across the range, and more closely if no answer has the figure; return whether one has.

    A name that the first answer does not know is none of the others', which are asked the same: nothing more is asked.
    """
    answered = False
    for shares in (first_shares(FEW), first_shares(FIRST)):
        for share in shares:
            x = curve.varied.at_share(share)
            answered = curve.value(x) is not None or answered
            sample = curve.sample(x)
            if not answered and sample.refused is None and names_nothing(curve.answer(x), figure.path):
                return False
        if answered:
            return True
    return False


def _one(curve: Curve, condition: Condition) -> Findings:
    """Return what is found of one condition by one input."""
    numbers = condition.figure.continuous and _are_numbers(curve)
    if condition.wanted == "happens" or (condition.wanted == "equals" and not numbers):
        return _where_it_holds(curve, condition)
    if condition.wanted == "changes":
        return Findings(jumps_of(curve) if numbers else borders_of(curve, lambda x: case_of(curve, x), curve.value))
    if not numbers:
        rule = f"be a number to be {condition.wanted}"
        raise InvalidParameter(
            ("until", 0, "figure"), rule, remedy='ask where it "changes", or for a value that it "equals"'
        )
    if condition.wanted == "infinite":
        return Findings(infinities_of(curve))
    if condition.wanted == "equals":
        roots = roots_of(curve, _number(condition.equals))
        return Findings(roots.solutions, families=roots.families, nearest=roots.nearest)
    solutions, families = extremes_of(curve, 1.0 if condition.wanted == "largest" else -1.0)
    return Findings(solutions, families=families)


def _number(value: Value | None) -> float:
    """Return the number that a figure is to equal, which may be a decimal in quotes."""
    try:
        number = nan if isinstance(value, bool) or value is None else float(value)
    except ValueError:
        number = nan
    if not isfinite(number):
        raise InvalidParameter(("until", 0, "equals"), "be a number, as the figure is one")
    return number


def _are_numbers(curve: Curve) -> bool:
    """Return whether a figure is a number, and no word or truth value, from the answers so far."""
    return all(isinstance(value, float) for x in curve.known if (value := curve.value(x)) is not None)


def _where_it_holds(curve: Curve, condition: Condition) -> Findings:
    """Return the ranges in which something is the case, and their borders."""

    def holds(x: float) -> bool:
        value = curve.value(x)
        if condition.wanted == "happens":
            return value is True
        # True is no 1 here: a truth value equals another alone.
        return isinstance(value, bool) == isinstance(condition.equals, bool) and value == condition.equals

    def case(x: float) -> object:
        return REFUSED if curve.sample(x).refused is not None else holds(x)

    borders = borders_of(curve, case, curve.value)
    answered = [x for x in curve.known if curve.sample(x).refused is None]
    if not answered:
        return Findings(borders, ranges=[])
    ends = [answered[0], *(one.inputs[0] for one in borders), answered[-1]]
    # The case changes at every border.
    first = 0 if holds(answered[0]) else 1
    return Findings(borders, ranges=list(zip(ends[first::2], ends[first + 1 :: 2], strict=False)))


def _several(evaluations: Evaluations, conditions: Sequence[Condition]) -> Findings:
    """Return what is found of several conditions by as many inputs."""
    for k, one in enumerate(conditions):
        if one.wanted != "equals" or isinstance(one.equals, (bool, str)):
            raise InvalidParameter(
                ("until", k),
                "say which number a figure equals",
                remedy="other conditions are answered where one input is varied",
            )
    evaluations.at(tuple(one.at_share(0.5) for one in evaluations.varied))
    system = solved_system(evaluations, [float(one.equals or 0.0) for one in conditions])
    count = len(evaluations.varied)
    unbounded = [
        Notice(
            "error-not-bounded",
            f"near {', '.join(f'{x:.17g}' for x in one)} the figures have their values, but no box "
            "about it was found on whose faces they are decided; it is left out",
            ("until",),
        )
        for one in system.unbounded
    ]
    return Findings(
        system.solutions,
        families=system.families,
        nearest=system.nearest,
        resolution=tuple((one.most - one.least) / (PER_INPUT[count] - 1) for one in evaluations.varied),
        notices=[*_missing(evaluations, conditions), *unbounded],
    )


def _missing(evaluations: Evaluations, conditions: Sequence[Condition]) -> list[Notice]:
    """Return warnings of what is missing in all answers, or in some; refuse what no question and no figure stands for.

    Raises
    ------
    InvalidParameter
        For a pointer that leads to nothing in any answer.
    MechanicsError
        That of the question, if it is refused with every value that was tried.
    """
    answered = [sample for sample in evaluations.samples.values() if sample.refused is None]
    refusal = evaluations.first_refusal()
    if not answered and refusal is not None:
        raise refusal
    notices = _refusals(evaluations)
    for k, one in enumerate(conditions):
        absent = False if one.wanted == "happens" else None
        if any(sample.values[k] is not absent for sample in answered):
            continue
        answer = evaluations.some_answer()
        if one.of_event:
            listed = ", ".join(events_within(answer)) or "none"
            detail = f"the event happens in no answer that was looked at; one of them has the events: {listed}"
            notices.append(Notice("event-does-not-happen", detail, ("until", k)))
        elif not is_null(answer, one.figure.path):
            names = single_figures(answer) if one.figure.continuous else lists_within(answer)
            listed = f"the answer has {', '.join(names[:MOST_LISTED])}"
            what = "a number, a word or a truth value" if one.figure.continuous else "a list"
            remedy = did_you_mean(pointer_of(one.figure.path), names) or listed
            raise InvalidParameter(("until", k, "figure"), f"lead to {what} of the answer", remedy=remedy)
    return notices


def _refusals(evaluations: Evaluations) -> list[Notice]:
    """Return a warning of inputs with which the question is refused."""
    refused = sorted(sample.inputs for sample in evaluations.samples.values() if sample.refused is not None)
    if not refused:
        return []
    reason: MechanicsError | None = evaluations.first_refusal()
    shown = ", ".join(f"{x:.6g}" for x in refused[0])
    detail = f"{len(refused)} of {evaluations.count} questions have no answer, between {shown} and "
    detail += f"{', '.join(f'{x:.6g}' for x in refused[-1])}: {'' if reason is None else reason.detail[:300]}"
    return [Notice("refused-in-range", detail, ("vary",))]
