"""How answers with many samples are foreseen by few of them (`service.routing.PlanningProbe`)."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import ceil, inf, log10
from typing import Any

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.systems.budget import Budget
from core.systems.methods import ClosedFormEvaluation
from core.systems.rounding import ROUND_TRIP
from service.execution.cost_model import error_of, extreme
from service.responses.json_rows import written
from service.routing import Answer, PlanningProbe
from service.schemas import sample_times

FEW, FEW_CERTIFIED = 64, 8
"""Rows of doubles and of decimal strings by which longer columns are foreseen."""

FEW_STEPS, FEW_RADIANS = 64, 0.1
"""How far a method is run for its rows: steps of a fixed length, or a turn."""

OF_FEW_STEPS = ("accuracy-not-reached", "rounded-beyond-accuracy")
"""Warnings about the few steps that are run of a method."""

GOLDEN = 0.5 * (5.0**0.5 - 1.0)


def few_of(count: int, most: int = FEW) -> list[int]:
    """Return the indices of at most `most` rows that stand for `count`: all if they are few, else irregularly spread.

    At equal distances, evenly spaced times might only be met where they are round numbers, and short.
    """
    if count <= most:
        return list(range(count))
    between = (int((k + k * GOLDEN % 1.0) * count / most) for k in range(1, most - 1))
    return sorted({0, *between, count - 1})


def in_closed_form(method: Any) -> bool:
    """Return whether nothing is to be integrated."""
    return method is None or isinstance(method, ClosedFormEvaluation)


def probe_in_samples(
    handle: Callable[[Any, Budget], Answer], question: Any, speed: float, budget: Budget, members: float = 1.0
) -> PlanningProbe:
    """Answer a question about samples of free rotations at few of its times, the farthest among them.

    Parameters
    ----------
    handle : callable
        Answers it.
    question : Any
        Or one about fewer members.
    speed : float
        That tells how often a method evaluates the motion (rad/s).
    members : float
        How many times as many the question has.
    """
    instants = sample_times(question.times, budget)
    times = instants[sorted({*few_of(instants.size), int(np.abs(instants).argmax())})]
    share, method = instants.size / times.size, question.method
    growth = {"time": share, "attitude": share, "angular_velocity": share * members, "members": members}
    if in_closed_form(method):
        return PlanningProbe(handle(question.model_copy(update={"times": times.tolist()}), budget), growth)
    near = in_few_steps(method, times, speed)
    growth["time"] *= len(written(times)) / len(written(near))
    error = error_of(method, question.times, speed)
    changes: dict[str, Any] = {"times": near.tolist()}
    if question.round == "meaningful":
        changes["round"] = max(1, ceil(-log10(error))) if error > 10.0**-ROUND_TRIP else ROUND_TRIP
    fields, exact = handle(question.model_copy(update=changes), budget), {}
    # A method that is named is answered whatever its error, and where the closed form is out of reach.
    farthest = {"times": [extreme(question.times)], "method": None, "round": None, "accuracy": 0.5}
    with suppress(AccuracyUnreachable):
        exact = handle(question.model_copy(update=farthest), budget)
    return PlanningProbe(fields, growth, error, exact)


def in_few_steps(method: Any, times: Floats, speed: float) -> Floats:
    """Return times, shape (n,), drawn towards the start so that a method takes few steps: rows are as long there."""
    reach = FEW_STEPS * method.step if hasattr(method, "step") else FEW_RADIANS / speed if speed else inf
    farthest = float(np.abs(times).max())
    return times if farthest <= reach else times * (reach / farthest)
