"""How wrong a computed motion is: against a reference, against a finer run of the same method, and by its drifts."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from core.errors import NotApplicable
from core.integration.budget import Budget
from core.integration.methods.method import AbstractMethod, Integration
from core.integration.system import Floats, System

SAFETY = 4.0
"""Factor between the estimate from a finer run and the error that is stated.

A finer run shows the coarser run's error less its own. Halving the step of a first-order method, or asking a sixteenth
of the tolerance, takes away at least half of the error where the method converges at all, so a factor 2 is owed; the
other factor 2 is for methods that converge less evenly than their order says.
"""

ROUNDOFF = 8 * 2.0**-53
"""Added to every estimate: two runs of one method may round alike."""


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


def measured(states: Floats, reference: Floats, times: Floats) -> Errors:
    """Return the errors of `states` against `reference`, both of shape (n, k) at `times` of shape (n,).

    A motion that is at rest has no scale of its own; its errors are then relative to the largest of `states`.
    """
    largest = max(float(np.abs(reference).max()), 0.0) or float(np.abs(states).max())
    if largest == 0.0:
        return Errors(0.0, 0.0, (0.0,) * states.shape[1])
    # In units of a power of two the squares stay in range, and nothing is rounded.
    unit = math.ldexp(1.0, max(math.frexp(largest)[1] - 1, -1022))
    exact = reference / unit
    wrong = states / unit - exact
    error = np.sqrt((wrong * wrong).sum(axis=1))
    norm = float(np.sqrt((exact * exact).sum(axis=1)).max()) or largest / unit
    magnitudes = np.abs(exact).max(axis=0)
    magnitudes[magnitudes == 0.0] = norm
    components = np.abs(wrong).max(axis=0) / magnitudes
    final = int(np.abs(times).argmax())
    return Errors(float(error.max()) / norm, float(error[final]) / norm, tuple(map(float, components)))


def drifts(system: System, states: Floats) -> dict[str, float]:
    """Return the largest relative change of every conserved quantity from its value at the start.

    A quantity that is zero at the start is compared with the largest value it takes. One that leaves the double range
    has no drift that could be stated and is left out.
    """
    found = {}
    start = system.invariants(np.ascontiguousarray(system.initial_state)[None, :])
    for name, values in system.invariants(states).items():
        first = float(start[name][0])
        change = float(np.abs(values - first).max())
        scale = abs(first) or float(np.abs(values).max())
        drift = 0.0 if change == 0.0 else change / scale if scale > 0.0 else math.inf
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


def estimated(method: AbstractMethod, system: System, times: Floats, run: Integration, budget: Budget) -> Estimate:
    """Return the error of a run as a finer run of the same method shows it.

    At the end of what a method offers the comparison is with a coarser run, whose error is the larger of the two.

    Raises
    ------
    BudgetExceeded, InvalidParameter
        As `AbstractMethod.integrate`, for the finer run.
    """
    finer = method.finer()
    neighbour = finer or method.coarser()
    if neighbour is None:
        raise NotApplicable(f"{method.kind} has no setting to compare with", path=("kind",))
    other = neighbour.integrate(system, times, budget)
    found = measured(run.states, other.states, times)
    errors = Errors(
        SAFETY * found.largest + ROUNDOFF,
        SAFETY * found.final + ROUNDOFF,
        tuple(SAFETY * component + ROUNDOFF for component in found.components),
    )
    return Estimate(errors, finer, other)
