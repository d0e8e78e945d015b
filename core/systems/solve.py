"""`solve`: from any system and times to samples with a true statement of their error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from core.arrays import Floats
from core.errors import BudgetExceeded, InvalidParameter
from core.notices import Notice
from core.quantities import Tolerance, Uncertainty, check_value
from core.systems.budget import Budget
from core.systems.methods.method import AbstractMethod
from core.systems.question import MotionQuestion, System
from core.systems.rounding import Digits, shortened
from core.systems.trajectory import Trajectory
from core.work import spend


def solve(
    system: System,
    times: ArrayLike,
    *,
    accuracy: float = 1e-9,
    method: AbstractMethod | None = None,
    input_uncertainty: float | None = None,
    digits: Digits | None = None,
    budget: Budget | None = None,
) -> Trajectory:
    """Sample the motion of a system.

    Without a method the system's own motion is answered: its closed form where there is one, otherwise the cheapest
    computation that reaches the accuracy. A method that is named is run as it is and answered whatever its error, which
    is what it is there to show; a warning says so where the error is larger than the accuracy.

    Parameters
    ----------
    system : System
    times : array_like, shape (n,)
        Measured from the initial state, of either sign, in any order, repeated or not (s).
    accuracy : float
        Largest tolerated error of any sample, relative to the largest norm of the whole motion, or of a column to its
        scale.
    method : AbstractMethod, optional
    input_uncertainty : float, optional
        Relative uncertainty of the inputs, for the inherited error; if omitted, half a unit in the last place where a
        bound is known for it, and otherwise nothing is said of it.
    digits : int or "meaningful", optional
        Of the samples; as many as doubles have if omitted. The stated error covers it.
    budget : Budget, optional
        The default of `Budget` if omitted. What is spent on stating the error counts too.

    Raises
    ------
    InvalidParameter
        For times that are none or not finite, an accuracy outside (0, 1), a method that fails with its setting.
    AccuracyUnreachable
        If the accuracy is out of reach; with the error that is not.
    BudgetExceeded
        If more samples or evaluations are needed than are allowed.
    NotApplicable
        If the method does not exist for this system.
    """
    budget = budget or Budget()
    check_value("accuracy", Tolerance, accuracy)
    if input_uncertainty is not None:
        check_value("input_uncertainty", Uncertainty, input_uncertainty)
    question = MotionQuestion(checked_times(times, budget), accuracy, method, input_uncertainty, budget)
    return as_requested(system.trajectory(question), question, digits)


def as_requested(found: Trajectory, question: MotionQuestion, digits: Digits | None) -> Trajectory:
    """Return a trajectory with the digits requested, and with a warning if a named method missed the accuracy."""
    if question.method is not None and found.accuracy.error > question.accuracy:
        detail = (
            f"the error of {found.method} with this setting is {found.accuracy.error:.3g}, where "
            f"{question.accuracy:.3g} was asked for; leave out the method to have the motion to that accuracy"
        )
        found = replace(found, warnings=(Notice("accuracy-not-reached", detail, ("method",)), *found.warnings))
    return found if digits is None else shortened(found, digits)


def check_without_times(**options: object) -> None:
    """Raise `InvalidParameter` for an option that is given (not None), and that only a motion has."""
    for name, option in options.items():
        if option is not None:
            raise InvalidParameter(name, "be left out where there are no times", remedy="give times, or leave it out")


def checked_times(times: ArrayLike, budget: Budget) -> Floats:
    """Return times as an array.

    Raises
    ------
    InvalidParameter
        If there are none, or one is not finite.
    BudgetExceeded
        If there are more than the budget has samples.
    """
    try:
        instants = np.ascontiguousarray(times, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameter("times", "be a list of numbers") from None
    if instants.ndim != 1 or instants.size == 0:
        raise InvalidParameter("times", "be a list of at least one time")
    if instants.size > budget.samples:
        remedy = "ask for fewer times, or in several questions"
        raise BudgetExceeded("samples", instants.size, budget.samples, path=("times",), remedy=remedy)
    spend(instants.size)
    finite = np.isfinite(instants)
    if not finite.all():
        raise InvalidParameter(("times", int(finite.argmin())), "be finite")
    return instants
