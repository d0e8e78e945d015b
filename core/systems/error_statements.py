"""How wrong a computed motion is: against a reference, against a finer run of the same method, and by its drifts.

Every error is relative to the largest norm of the state in the whole motion, which a closed form knows. Where there is
none, it is relative to the largest norm that the motion is known to have among the start and the samples, which is not
larger: an error is never stated as smaller than it is relative to the whole motion.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numba import types

from core.arrays import Floats
from core.compiled import entry, kernel
from core.errors import AccuracyUnreachable, BudgetExceeded, NotApplicable
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod, Integration
from core.systems.system import ClosedForm, InitialValueProblem

SAFETY = 4.0
"""Factor between the estimate from a finer run and the error that is stated.

A finer run shows the coarser run's error less its own. Halving the steps of a first-order method takes away half of the
error, so a factor 2 is owed, and so is it where a sixteenth of the tolerance does no better than that; the other factor
2 is for methods that converge less evenly than their order says.
"""

LARGEST = float(np.finfo(np.float64).max)

FARTHEST = 2.0**1020
"""No error is stated that is as large as this: what `Errors.beyond` adds to it might not be a double."""

ROUNDOFF = 8 * 2.0**-53
"""Added to every estimate: two runs of one method may round alike."""


_row = types.float64[::1]
_rows = types.float64[:, :]


class Errors(NamedTuple):
    """Errors of samples, all relative.

    Attributes
    ----------
    largest : float
        Largest norm of any row's error, relative to the largest norm of the whole motion.
    final : float
        The same at the time farthest from the start.
    components : tuple of float
        Largest error of each component, relative to the largest magnitude that its samples take; to the largest norm
        where that magnitude is zero, or so small that the quotient leaves the range of doubles.
    """

    largest: float
    final: float
    components: tuple[float, ...]

    def beyond(self, own: float) -> Errors:
        """Return errors that are not below the true ones, the reference being wrong by up to `own`.

        What the reference's norm is wrong by, and what the comparison rounds, counts in proportion to large errors.
        """
        more = 1.0 + own + ROUNDOFF
        return Errors(
            self.largest * more + own, self.final * more + own, tuple(c * more + own for c in self.components)
        )


@kernel()
def _norm_of_far(state: Floats, exact: Floats, inverse: float) -> float:
    """Return the norm of a difference whose square leaves the range of doubles."""
    most, norm = 0.0, 0.0
    for k in range(state.size):
        most = max(most, abs(state[k] * inverse - exact[k] * inverse))
    for k in range(state.size):
        share = (state[k] * inverse - exact[k] * inverse) / most
        norm += share * share
    return most * math.sqrt(norm) if most < math.inf else most


@entry(types.void(_rows, _rows, types.float64, _row, _row, _row))
def _differences(
    states: Floats, reference: Floats, unit: float, errors: Floats, wrong: Floats, magnitudes: Floats
) -> None:
    """Fill in the norm of every row's error and the extremes of every column.

    All in units of `unit`, a power of two that keeps the squares in range and rounds nothing.
    """
    inverse = 1.0 / unit
    for i in range(states.shape[0]):
        error = 0.0
        for k in range(states.shape[1]):
            exact = reference[i, k] * inverse
            difference = states[i, k] * inverse - exact
            error += difference * difference
            magnitudes[k] = max(magnitudes[k], abs(exact))
            wrong[k] = max(wrong[k], abs(difference))
        errors[i] = math.sqrt(error)
        if error == math.inf:
            errors[i] = _norm_of_far(states[i], reference[i], inverse)


def measured(states: Floats, reference: Floats, times: Floats, largest_norm: float) -> Errors:
    """Return the errors of `states` against `reference`, both of shape (n, k) at `times` of shape (n,).

    Parameters
    ----------
    largest_norm : float
        Of the whole motion. A motion that is at rest has no scale of its own; its errors are then relative to the
        largest component of `states`.

    Raises
    ------
    NotApplicable
        If the states are so far from the reference that a double cannot say how far; the path leads from the method.
    """
    scale = min(largest_norm, LARGEST) or max(float(states.max()), -float(states.min()))
    if scale == 0.0:
        return Errors(0.0, 0.0, (0.0,) * states.shape[1])
    unit = math.ldexp(1.0, max(math.frexp(scale)[1] - 1, -1022))
    errors = np.empty(len(states))
    wrong, magnitudes = np.zeros(states.shape[1]), np.zeros(states.shape[1])
    _differences(states, reference, unit, errors, wrong, magnitudes)
    norm = scale / unit
    if not errors.max() / norm < FARTHEST:
        raise _out_of_range()
    magnitudes[magnitudes == 0.0] = norm
    with np.errstate(over="ignore"):
        components = wrong / magnitudes
    components = np.where(components < FARTHEST, components, wrong / norm)
    final = int(np.abs(times).argmax())
    return Errors(float(errors.max()) / norm, float(errors[final]) / norm, tuple(map(float, components)))


def _out_of_range() -> NotApplicable:
    return NotApplicable(
        "the states are so far from the motion that their error leaves the range of double precision",
        path=("kind",),
        remedy="give the method a finer setting, or leave it out",
    )


def known_norm(states: Floats, start: Floats) -> float:
    """Return the largest norm among states, shape (n, k), and the start, shape (k,); infinite beyond the doubles."""
    largest = max(float(np.abs(states).max()), float(np.abs(start).max()))
    unit = math.ldexp(1.0, max(math.frexp(largest)[1] - 1, -1022))
    norms = np.sqrt(((states / unit) ** 2).sum(axis=1))
    # The square of the start may be nothing beside that of a run that blows up.
    return unit * max(float(norms.max()), math.hypot(*(start / unit).tolist()))


def bound_of(exact: ClosedForm, times: Floats) -> float:
    """Return the bound of a closed form's own error at `times`.

    Raises
    ------
    AccuracyUnreachable
        If there is none, or a time is beyond what the closed form answers; the path leads from the question.
    """
    error = exact.error(times)
    if error < math.inf:
        return error
    raise AccuracyUnreachable(
        None,
        2.0,
        "rounding leaves nothing known of the phase at the latest times",
        path=("times",),
        remedy="ask for earlier times, or for certified digits",
    )


def drifts(system: InitialValueProblem, states: Floats) -> dict[str, float]:
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
        An estimate: not smaller than the true ones as long as the method converges from one run to the other, which
        nothing shows (docs/accuracy.md has how often it fails).
    finer : AbstractMethod or None
        The method that made the finer run; None if there was none finer and a coarser one had to serve.
    integration : Integration
        Of the other run.
    """

    errors: Errors
    finer: AbstractMethod | None
    integration: Integration


def estimated(
    method: AbstractMethod,
    system: InitialValueProblem,
    times: Floats,
    run: Integration,
    budget: Budget,
    spent: int,
    largest_norm: float | None = None,
) -> Estimate:
    """Return the error of a run as a finer run of the same method shows it.

    At the end of what a method offers the comparison is with a coarser run, whose error is the larger of the two.

    Parameters
    ----------
    method, system, times : AbstractMethod, InitialValueProblem, ndarray
        Of the run.
    run : Integration
    budget : Budget
        For all that is done to answer the question.
    spent : int
        Evaluations that were spent so far.
    largest_norm : float, optional
        Of the whole motion; if omitted, that of the start and of the finer run's samples, as far as it is certain.

    Raises
    ------
    BudgetExceeded, InvalidParameter
        As `AbstractMethod.integrate`, for the other run.
    NotApplicable
        If the error leaves the range of doubles.
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
    scale = known_norm(other.states, system.initial_state) if largest_norm is None else largest_norm
    difference = measured(run.states, other.states, times, scale)
    factor = SAFETY if largest_norm is not None else SAFETY * _uncertainty_of(scale, system.initial_state, difference)
    errors = Errors(
        factor * difference.largest + ROUNDOFF,
        factor * difference.final + ROUNDOFF,
        tuple(factor * component + ROUNDOFF for component in difference.components),
    )
    if not max(errors.largest, *errors.components) < math.inf:
        raise _out_of_range()
    return Estimate(errors, finer, other)


def _uncertainty_of(scale: float, start: Floats, difference: Errors) -> float:
    """Return by how much the largest norm may be smaller than that of a run, as a factor of at least 1.

    A run that blows up has a norm that the motion never had, and errors relative to it would look small. The motion's
    largest norm is certain only as far as the error leaves it, and to be no smaller than the norm at the start.
    """
    left = max(1 - difference.largest, known_norm(start[None, :], start) / scale if scale > 0.0 else 1.0)
    return 1.0 / left if left > 0.0 else 1.0


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
