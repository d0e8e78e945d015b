"""The policy: from the accuracy that is requested to the smallest model and the cheapest method that reaches it.

A closed form, where there is one, is both the cheapest and the most accurate. Otherwise the record of the methods is
read: errors and times measured on problems with known solutions, generated and never typed. The record only says
where to begin; what is answered is judged on the question itself, and refined until it meets the accuracy or cannot.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from typing import NamedTuple

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.systems.budget import Budget
from core.systems.error_statements import Errors, estimated, rest_of
from core.systems.methods import DormandPrince853, Lsoda, Radau
from core.systems.methods.method import AbstractMethod
from core.systems.system import InitialValueProblem
from core.systems.trajectory import Work

CANDIDATES: dict[str, type[DormandPrince853 | Lsoda | Radau]] = {
    candidate.kind: candidate for candidate in (DormandPrince853, Lsoda, Radau)
}
"""The methods that choose their steps, so that a tolerance is all there is to choose for them."""


@dataclass(frozen=True)
class RecordEntry:
    """What a method with one tolerance was measured to do.

    Attributes
    ----------
    kind : str
    tolerance : float
    error : float
        Largest over the problems of the record, relative to the largest norm of each.
    evaluations : int
        Sum over the problems of the record.
    microseconds : float
        Median time for all problems of the record, on the machine that made it.
    """

    kind: str
    tolerance: float
    error: float
    evaluations: int
    microseconds: float


@cache
def record() -> tuple[RecordEntry, ...]:
    """Return the committed record, cheapest first."""
    text = resources.files("core.systems").joinpath("record.json").read_text(encoding="utf-8")
    entries = (RecordEntry(**entry) for entry in json.loads(text)["entries"])
    return tuple(sorted(entries, key=lambda entry: entry.microseconds))


def integrator(accuracy: float) -> AbstractMethod:
    """Return the cheapest integrator whose record meets `accuracy`, the most accurate one where none does."""
    entries = record()
    entry = next((entry for entry in entries if entry.error <= accuracy), min(entries, key=lambda entry: entry.error))
    return CANDIDATES[entry.kind](entry.tolerance)


class Run(NamedTuple):
    """Samples that a method made, and what is known of their errors."""

    method: AbstractMethod
    states: Floats
    errors: Errors
    work: Work


def run_to_accuracy(system: InitialValueProblem, times: Floats, accuracy: float, budget: Budget, spent: int = 0) -> Run:
    """Return the samples of the cheapest integrator that reaches `accuracy` on this question.

    It begins with the setting whose record meets the accuracy, and takes finer ones until its own estimate does; each
    finer run serves first as the estimate of the one before. `spent` evaluations have gone from the budget already.

    Raises
    ------
    AccuracyUnreachable
        If the method's finest setting does not reach it either; with the error that it reached.
    BudgetExceeded
        If reaching it takes more evaluations than the budget has.
    """
    method, before = integrator(accuracy), spent
    run = method.integrate(system, times, rest_of(budget, spent))
    spent += run.work.evaluations
    while True:
        estimate = estimated(method, system, times, run, budget, spent)
        spent += estimate.integration.work.evaluations
        if estimate.errors.largest <= accuracy:
            for_error = spent - before - run.work.evaluations
            return Run(method, run.states, estimate.errors, replace(run.work, evaluations_for_error=for_error))
        if estimate.finer is None:
            raise AccuracyUnreachable(
                accuracy,
                estimate.errors.largest,
                f"{method.kind} meets the round-off of double precision",
                remedy="ask for earlier times or for less accuracy",
            )
        method, run = estimate.finer, estimate.integration
