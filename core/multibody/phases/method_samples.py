"""Samples that a method computes, with errors measured against the motion itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.arrays import Floats
from core.errors import AccuracyUnreachable
from core.multibody.motion.generic_equation import SceneSystem
from core.multibody.motion.motion import States
from core.multibody.motion.whole import Whole
from core.multibody.phases.phase_columns import ColumnsInPhases
from core.multibody.trajectory.column_errors import apart, require_known, worst
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.trajectory import Column, Work

SHARE = 0.1
"""Share of a method's error that the error of what it is measured against may have, before that is made finer."""
LOST = 1e-3
"""A motion that is known no better than this measures nothing."""


def integrated(whole: Whole, times: Floats, method: AbstractMethod, budget: Budget) -> tuple[States, Work]:
    """Return the states that a method computes, and what they cost."""
    system = SceneSystem(whole)
    if not len(times) or not len(system.initial_state):
        at_rest = np.zeros((len(times), len(whole.reduced.table.names)))
        return whole.states_at(at_rest, at_rest), Work(len(times))
    found = method.integrate(system, times, budget)
    return whole.states_at(*system.places_and_rates(found.states)), found.work


def measured(own: dict[str, Column], motion: ColumnsInPhases, times: Floats, *, numerical: bool) -> dict[str, Column]:
    """Return columns that a method computed, their errors measured against the motion itself.

    Parameters
    ----------
    own : dict of Column
    motion : ColumnsInPhases
        The motion itself.
    numerical : bool
        Whether it may be computed in pairs of doubles in place of doubles.

    Raises
    ------
    AccuracyUnreachable
        Where the motion itself is not known.
    """
    require_known(own)
    finer = False
    while True:
        right = replace(motion, finer=finer).with_sizes(times)
        require_known(right)
        known = worst(right)
        found = {
            name: replace(one, error=apart(one, right[name]) + right[name].error, scale=right[name].scale)
            for name, one in own.items()
        }
        if finer or not numerical or known <= SHARE * worst(found):
            break
        finer = True
    if known > LOST:
        raise AccuracyUnreachable(
            None,
            known,
            "the motion amplifies rounding, even that of pairs of doubles, and nothing is left to measure against",
            path=("times",),
            remedy="ask for a shorter time",
        )
    return found
