"""`solve`: from a system and times to samples with a true statement of their error."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, MechanicsError, NotApplicable
from core.notices import Notice
from core.quantities import Tolerance, Uncertainty, check_value
from core.systems.accuracy import run_to_accuracy
from core.systems.budget import Budget
from core.systems.error_statements import bound_of, drifts, estimated, known_norm, measured
from core.systems.methods import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod, Integration
from core.systems.system import ClosedForm, Floats, System
from core.systems.trajectory import Accuracy, Trajectory, Work
from core.work import spend

HALF_ULP = 2.0**-53

UNCONVERGED = 0.25
"""A finer run that states a larger error than this is not near enough to the motion to state any."""

JUDGE = 1e-4
"""Accuracy of the run that then does."""


def solve(
    system: System,
    times: ArrayLike,
    *,
    accuracy: float = 1e-9,
    method: AbstractMethod | None = None,
    budget: Budget | None = None,
    input_uncertainty: float = HALF_ULP,
) -> Trajectory:
    """Sample the motion of a system.

    Without a method, the closed form is evaluated where there is one, and otherwise the cheapest method that reaches
    the accuracy is run. A method that is named is run as it is and answered whatever its error, which is what it is
    there to show; a warning says so where the error is larger than what was asked for.

    Parameters
    ----------
    system : System
    times : array_like, shape (n,)
        Measured from the initial state, of either sign, in any order, repeated or not (s).
    accuracy : float
        Largest error of any sample that is tolerated, relative to the largest norm of the whole motion.
    method : AbstractMethod, optional
    budget : Budget, optional
        The default of `Budget` if omitted. What is spent on stating the error counts too.
    input_uncertainty : float
        Relative uncertainty of the inputs, for the inherited error.

    Returns
    -------
    Trajectory
        With ``accuracy.how`` one of ``"closed form"`` (a proven bound), ``"measured against closed form"`` (to which
        the closed form's own bound is added) and ``"estimate (finer run)"`` (with a factor of safety, and no bound).

    Raises
    ------
    InvalidParameter
        For times that are none or not finite, an accuracy outside (0, 1), a method that fails with its setting.
    AccuracyUnreachable
        If the closed form's bound, or what integrators reach, is larger than the accuracy asked for.
    BudgetExceeded
        If more samples or evaluations are needed than are allowed.
    NotApplicable
        If the method does not exist for this system.
    """
    budget = budget or Budget()
    check_value("accuracy", Tolerance, accuracy)
    check_value("input_uncertainty", Uncertainty, input_uncertainty)
    instants = checked_times(times, budget)
    exact = system.closed_form()
    if exact is not None and (method is None or isinstance(method, ClosedFormEvaluation)):
        return _evaluated(system, exact, instants, accuracy, input_uncertainty)
    if method is None:
        return _refined(system, instants, accuracy, budget)
    with inside_field("method"):
        run = method.integrate(system, instants, budget)
    if exact is not None:
        # A closed form that cannot be evaluated this far cannot judge either, and leaves it to the finer run.
        with suppress(AccuracyUnreachable):
            return _compared_with_closed_form(system, exact, method, run, instants, accuracy, input_uncertainty)
    return _compared_with_finer_run(system, exact, method, run, instants, accuracy, budget)


def checked_times(times: ArrayLike, budget: Budget) -> Floats:
    """Return times as an array.

    Raises
    ------
    InvalidParameter
        If there are none, or one is not finite.
    BudgetExceeded
        If there are more than the budget has samples.
    """
    instants = np.ascontiguousarray(times, dtype=np.float64)
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


def _evaluated(
    system: System, exact: ClosedForm, times: Floats, accuracy: float, input_uncertainty: float
) -> Trajectory:
    error = bound_of(exact, times)
    if not error <= accuracy:
        if accuracy < exact.error(np.zeros(1)):
            remedy = "ask for less accuracy; what doubles cannot hold at any time takes more digits than theirs"
        else:
            remedy = "ask for earlier times or for less accuracy"
        raise AccuracyUnreachable(accuracy, error, "the closed form's own bound is larger", remedy=remedy)
    states = exact.sample(times)
    if not np.isfinite(states).all():
        raise NotApplicable("the motion leaves the range of double precision", remedy="choose other units")
    inherited, notices = _inherited(exact, times, input_uncertainty)
    return Trajectory(
        times,
        states,
        exact.model,
        ClosedFormEvaluation().kind,
        Accuracy(accuracy, error, "closed form", error, inherited, drifts(system, states), _finite(exact.largest_norm)),
        Work(times.size),
        exact.period,
        warnings=notices,
    )


def _compared_with_closed_form(
    system: System,
    exact: ClosedForm,
    method: AbstractMethod,
    run: Integration,
    times: Floats,
    accuracy: float,
    input_uncertainty: float,
) -> Trajectory:
    reference, own = exact.sample(times), bound_of(exact, times)
    with inside_field("method"):
        found = measured(run.states, reference, times, exact.largest_norm).beyond(own)
    inherited, notices = _inherited(exact, times, input_uncertainty)
    stated = Accuracy(
        accuracy,
        found.largest,
        "measured against closed form",
        found.final,
        inherited,
        drifts(system, run.states),
        _finite(exact.largest_norm),
    )
    return Trajectory(
        times,
        run.states,
        system.model,
        method.kind,
        stated,
        run.work,
        exact.period,
        warnings=_warnings(stated, method) + notices,
    )


def _compared_with_finer_run(
    system: System,
    exact: ClosedForm | None,
    method: AbstractMethod,
    run: Integration,
    times: Floats,
    accuracy: float,
    budget: Budget,
) -> Trajectory:
    # A closed form that is out of reach at these times still knows the norm of the whole motion.
    norm = None if exact is None else exact.largest_norm
    with inside_field("method"):
        estimate = estimated(method, system, times, run, budget, run.work.evaluations, norm)
    errors, spent = estimate.errors, estimate.integration.work.evaluations
    uncertain: tuple[Notice, ...] = ()
    if errors.largest > UNCONVERGED:
        # Two runs as far apart as the motion is wide show nothing of a third; a run that does converge has to judge.
        try:
            judge = run_to_accuracy(system, times, JUDGE, budget, run.work.evaluations + spent)
            scale = known_norm(judge.states, system.initial_state) if norm is None else norm
            found = measured(run.states, judge.states, times, scale)
        except MechanicsError as fault:
            detail = f"the error is so large that it is only known to be of this order: {fault.detail}"
            uncertain = (Notice("error-uncertain", detail, ("method",)),)
        else:
            errors = found._replace(
                largest=found.largest * (1 + JUDGE) + judge.errors.largest,
                final=found.final * (1 + JUDGE) + judge.errors.largest,
            )
            spent += judge.work.evaluations + judge.work.evaluations_for_error
    stated = Accuracy(
        accuracy, errors.largest, "estimate (finer run)", errors.final, None, drifts(system, run.states), _finite(norm)
    )
    work = replace(run.work, evaluations_for_error=spent)
    warnings = _warnings(stated, method) + uncertain
    return Trajectory(times, run.states, system.model, method.kind, stated, work, warnings=warnings)


def _refined(system: System, times: Floats, accuracy: float, budget: Budget) -> Trajectory:
    try:
        run = run_to_accuracy(system, times, accuracy, budget)
    except InvalidParameter as fault:
        # The client chose no setting; what it can change is how far the motion goes.
        rule = f"be within reach of an integrator, whose {fault}"
        raise InvalidParameter("times", rule, remedy=fault.remedy) from fault
    except BudgetExceeded as fault:
        remedy = "ask for earlier times or for less accuracy"
        raise BudgetExceeded(fault.what, fault.needed, fault.limit, path=("times",), remedy=remedy) from fault
    stated = Accuracy(
        accuracy, run.errors.largest, "estimate (finer run)", run.errors.final, None, drifts(system, run.states)
    )
    return Trajectory(times, run.states, system.model, run.method.kind, stated, run.work)


def _inherited(exact: ClosedForm, times: Floats, uncertainty: float) -> tuple[float | None, tuple[Notice, ...]]:
    """Return the error propagated from the inputs, None with a notice where nothing bounds it."""
    inherited = exact.inherited(times, uncertainty)
    if inherited < math.inf:
        return inherited, ()
    detail = (
        f"a relative uncertainty of {uncertainty:.3g} of every input leaves nothing known of the phase at the latest "
        "times, and inherited is null; energy and angular momentum are known all the same; ask for earlier times"
    )
    return None, (Notice("phase-lost", detail, ("times",)),)


def _finite(norm: float | None) -> float | None:
    return norm if norm is not None and norm < math.inf else None


def _warnings(stated: Accuracy, method: AbstractMethod) -> tuple[Notice, ...]:
    if stated.error <= stated.requested:
        return ()
    detail = (
        f"the error of {method.kind} with this setting is {stated.error:.3g}, where {stated.requested:.3g} was "
        "asked for; leave out the method to have one chosen that reaches it"
    )
    return (Notice("accuracy-not-reached", detail, ("method",)),)


@contextmanager
def inside_field(step: str) -> Iterator[None]:
    """Prefix the path of every fault with the field of the question to which it belongs."""
    try:
        yield
    except InvalidParameter as fault:
        raise fault.inside(step) from fault.__cause__
    except MechanicsError as fault:
        fault.path = (step, *fault.path)
        raise
