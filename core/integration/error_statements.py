"""How wrong a computed motion is: against a reference, against a finer run of the same method, and by its drifts."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numba import types

from core.compiled import kernel
from core.errors import BudgetExceeded, NotApplicable
from core.integration.budget import Budget
from core.integration.methods.method import AbstractMethod, Integration
from core.integration.system import Floats, System

SAFETY = 4.0
"""Factor between the estimate from a finer run and the error that is stated.

A finer run shows the coarser run's error less its own. Halving the steps of a first-order method takes away half of the
error, so a factor 2 is owed, and so is it where a sixteenth of the tolerance does no better than that; the other factor
2 is for methods that converge less evenly than their order says.
"""

ROUNDOFF = 8 * 2.0**-53
"""Added to every estimate: two runs of one method may round alike."""


_row = types.float64[::1]
_rows = types.float64[:, :]


class Errors(NamedTuple):
    """Errors of samples, all relative.

    Attributes
    ----------
    largest : float
        Largest norm of any row's error, relative to the largest norm of the motion.
    final : float
        The same at the time farthest from the start.
    components : tuple of float
        Largest error of each component, relative to the largest magnitude that this component takes.
    """

    largest: float
    final: float
    components: tuple[float, ...]


@kernel(types.float64(_rows, _rows, types.float64, _row, _row, _row))
def _differences(
    states: Floats, reference: Floats, unit: float, errors: Floats, wrong: Floats, magnitudes: Floats
) -> float:
    """Fill in the norm of every row's error and the extremes of every column; return the largest norm of `reference`.

    All in units of `unit`, a power of two that keeps the squares in range and rounds nothing.
    """
    largest, inverse = 0.0, 1.0 / unit
    for i in range(states.shape[0]):
        norm, error = 0.0, 0.0
        for k in range(states.shape[1]):
            exact = reference[i, k] * inverse
            difference = states[i, k] * inverse - exact
            norm += exact * exact
            error += difference * difference
            magnitudes[k] = max(magnitudes[k], abs(exact))
            wrong[k] = max(wrong[k], abs(difference))
        largest = max(largest, norm)
        errors[i] = math.sqrt(error)
    return math.sqrt(largest)


def measured(states: Floats, reference: Floats, times: Floats) -> Errors:
    """Return the errors of `states` against `reference`, both of shape (n, k) at `times` of shape (n,).

    A motion that is at rest has no scale of its own; its errors are then relative to the largest of `states`.
    """
    largest = _magnitude(reference) or _magnitude(states)
    if largest == 0.0:
        return Errors(0.0, 0.0, (0.0,) * states.shape[1])
    unit = math.ldexp(1.0, max(math.frexp(largest)[1] - 1, -1022))
    errors = np.empty(len(states))
    wrong, magnitudes = np.zeros(states.shape[1]), np.zeros(states.shape[1])
    norm = _differences(states, reference, unit, errors, wrong, magnitudes) or largest / unit
    magnitudes[magnitudes == 0.0] = norm
    final = int(np.abs(times).argmax())
    return Errors(float(errors.max()) / norm, float(errors[final]) / norm, tuple(map(float, wrong / magnitudes)))


def _magnitude(rows: Floats) -> float:
    return max(float(rows.max()), -float(rows.min()))


def drifts(system: System, states: Floats) -> dict[str, float]:
    """Return the largest relative change of every conserved quantity from its value at the start.

    A quantity that is zero at the start is compared with the largest value it takes. One that leaves the double range
    has no drift that could be stated and is left out.
    """
    found = {}
    for name, (first, least, largest) in system.ranges(states).items():
        change = max(largest - first, first - least)
        scale = abs(first) or max(abs(least), abs(largest))
        drift = change if change == 0.0 else change / scale if scale > 0.0 else math.inf
        if math.isfinite(drift):
            found[name] = drift
    return found


class Estimate(NamedTuple):
    """What a finer run tells about a run.

    Attributes
    ----------
    errors : Errors
        Not smaller than the true ones as long as the method converges from one run to the other.
    finer : AbstractMethod or None
        The method that made the finer run; None if there was none finer and a coarser one had to serve.
    integration : Integration
        Of the other run.
    """

    errors: Errors
    finer: AbstractMethod | None
    integration: Integration


def estimated(
    method: AbstractMethod, system: System, times: Floats, run: Integration, budget: Budget, spent: int
) -> Estimate:
    """Return the error of a run as a finer run of the same method shows it.

    At the end of what a method offers the comparison is with a coarser run, whose error is the larger of the two.

    Parameters
    ----------
    method, system, times : AbstractMethod, System, ndarray
        Of the run.
    run : Integration
    budget : Budget
        For all that is done to answer the question.
    spent : int
        Evaluations that were spent so far.

    Raises
    ------
    BudgetExceeded, InvalidParameter
        As `AbstractMethod.integrate`, for the other run.
    """
    finer = method.finer()
    neighbour = finer or method.coarser()
    if neighbour is None:
        raise NotApplicable(f"{method.kind} has no setting to compare with", path=("kind",))
    rest = rest_of(budget, spent)
    try:
        other = neighbour.integrate(system, times, rest)
    except BudgetExceeded as fault:
        raise BudgetExceeded(
            fault.what, spent + fault.needed, budget.evaluations, path=fault.path, remedy=fault.remedy
        ) from None
    difference = measured(run.states, other.states, times)
    scale = _certain_scale(system, other.states, difference)
    errors = Errors(
        SAFETY * scale * difference.largest + ROUNDOFF,
        SAFETY * scale * difference.final + ROUNDOFF,
        tuple(SAFETY * scale * component + ROUNDOFF for component in difference.components),
    )
    return Estimate(errors, finer, other)


def _certain_scale(system: System, states: Floats, difference: Errors) -> float:
    """Return by how much the motion's largest norm may be smaller than that of `states`, as a factor of at least 1.

    A run that blows up has a norm that the motion never had, and errors relative to it would look small. The motion's
    largest norm is certain only as far as the error leaves it, and to be no smaller than the norm at the start.
    """
    unit = float(np.abs(states).max()) or 1.0
    norms = np.sqrt(((states / unit) ** 2).sum(axis=1))
    start = float(np.sqrt(((system.initial_state / unit) ** 2).sum()))
    largest = max(float(norms.max()), start)
    left = max(largest * (1 - difference.largest), start)
    return largest / left if left > 0.0 else 1.0


def rest_of(budget: Budget, spent: int) -> Budget:
    """Return what is left of a budget.

    Raises
    ------
    BudgetExceeded
        If nothing is left.
    """
    if spent >= budget.evaluations:
        remedy = "ask for earlier times or for less accuracy"
        raise BudgetExceeded("evaluations", spent + 1, budget.evaluations, remedy=remedy)
    return replace(budget, evaluations=budget.evaluations - spent)
