"""The motion of an initial value problem: by its closed form, or by a named method.

The errors of a method are measured against the closed form where there is one within reach, and estimated by a finer
run otherwise.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace

import numpy as np

from core.arrays import Floats
from core.errors import (
    AccuracyUnreachable,
    MechanicsError,
    NotApplicable,
    inside_field,
)
from core.notices import Notice
from core.systems.accuracy import run_to_accuracy
from core.systems.error_statements import bound_of, drifts, estimated, known_norm, measured
from core.systems.methods import ClosedFormEvaluation
from core.systems.methods.method import AbstractMethod, Integration
from core.systems.question import MotionQuestion
from core.systems.system import ClosedForm, InitialValueProblem, Model
from core.systems.trajectory import Accuracy, Column, Trajectory, Work

HALF_ULP = 2.0**-53

UNCONVERGED = 0.25
"""A finer run that states a larger error than this is not near enough to the motion to state any."""

REFERENCE_ACCURACY = 1e-4
"""Accuracy of the run that is then the reference."""


def state_motion(system: InitialValueProblem, question: MotionQuestion) -> Trajectory:
    """Return samples of the state, as one column.

    ``accuracy.how`` is one of ``"closed form"`` (a proven bound), ``"measured against closed form"`` (to which the
    closed form's own bound is added) and ``"estimate (finer run)"`` (with a factor of safety, and no bound).

    Raises
    ------
    MechanicsError
        As `core.systems.solve.solve`.
    """
    exact, method, times = system.closed_form(), question.integrator, question.times
    if method is None:
        if exact is not None:
            return _evaluated(system, exact, question)
        method = ClosedFormEvaluation()
    with inside_field("method"):
        run = method.integrate(system, times, question.budget)
    if exact is not None:
        # A closed form that cannot be evaluated this far cannot reference either, and leaves it to the finer run.
        with suppress(AccuracyUnreachable):
            return _compared_with_closed_form(system, exact, method, run, question)
    return _compared_with_finer_run(system, exact, method, run, question)


def _trajectory(
    system: InitialValueProblem,
    model: Model,
    method: AbstractMethod,
    times: Floats,
    states: Floats,
    stated: Accuracy,
    work: Work,
    period: float | None = None,
    warnings: tuple[Notice, ...] = (),
) -> Trajectory:
    """Return the trajectory whose only column is the state."""
    name, unit = system.state_column
    scale = known_norm(states, system.initial_state) if stated.largest_norm is None else stated.largest_norm
    column = Column(
        states, unit, stated.error * scale, stated.how, stated.inherited and stated.inherited * scale, scale
    )
    return Trajectory(times, {name: column}, stated, model, method.kind, work, period, warnings=warnings)


def _evaluated(system: InitialValueProblem, exact: ClosedForm, question: MotionQuestion) -> Trajectory:
    times, accuracy = question.times, question.accuracy
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
    inherited, notices = _inherited(exact, question)
    norm = _finite(exact.largest_norm)
    stated = Accuracy(accuracy, error, "closed form", error, inherited, drifts(system, states), norm)
    work, evaluation = Work(times.size), ClosedFormEvaluation()
    return _trajectory(system, exact.model, evaluation, times, states, stated, work, exact.period, notices)


def _compared_with_closed_form(
    system: InitialValueProblem, exact: ClosedForm, method: AbstractMethod, run: Integration, question: MotionQuestion
) -> Trajectory:
    times = question.times
    reference, own = exact.sample(times), bound_of(exact, times)
    with inside_field("method"):
        found = measured(run.states, reference, times, exact.largest_norm).beyond(own)
    inherited, notices = _inherited(exact, question)
    stated = Accuracy(
        question.accuracy,
        found.largest,
        "measured against closed form",
        found.final,
        inherited,
        drifts(system, run.states),
        _finite(exact.largest_norm),
    )
    return _trajectory(system, system.model, method, times, run.states, stated, run.work, exact.period, notices)


def _compared_with_finer_run(
    system: InitialValueProblem,
    exact: ClosedForm | None,
    method: AbstractMethod,
    run: Integration,
    question: MotionQuestion,
) -> Trajectory:
    times, budget = question.times, question.budget
    # A closed form that is out of reach at these times still knows the norm of the whole motion.
    norm = None if exact is None else exact.largest_norm
    with inside_field("method"):
        estimate = estimated(method, system, times, run, budget, run.work.evaluations, norm)
    errors, spent = estimate.errors, estimate.integration.work.evaluations
    uncertain: tuple[Notice, ...] = ()
    if errors.largest > UNCONVERGED:
        # Two runs as far apart as the motion is wide show nothing of a third; one that does converge has to.
        try:
            reference = run_to_accuracy(system, times, REFERENCE_ACCURACY, budget, run.work.evaluations + spent)
            scale = known_norm(reference.states, system.initial_state) if norm is None else norm
            found = measured(run.states, reference.states, times, scale)
        except MechanicsError as fault:
            detail = f"the error is so large that it is only known to be of this order: {fault.detail}"
            uncertain = (Notice("error-uncertain", detail, ("method",)),)
        else:
            errors = found._replace(
                largest=found.largest * (1 + REFERENCE_ACCURACY) + reference.errors.largest,
                final=found.final * (1 + REFERENCE_ACCURACY) + reference.errors.largest,
            )
            spent += reference.work.evaluations + reference.work.evaluations_for_error
    stated = Accuracy(
        question.accuracy,
        errors.largest,
        "estimate (finer run)",
        errors.final,
        None,
        drifts(system, run.states),
        _finite(norm),
    )
    work = replace(run.work, evaluations_for_error=spent)
    return _trajectory(system, system.model, method, times, run.states, stated, work, warnings=uncertain)


def _inherited(exact: ClosedForm, question: MotionQuestion) -> tuple[float | None, tuple[Notice, ...]]:
    """Return the error propagated from the inputs, None with a notice where nothing bounds it."""
    uncertainty = HALF_ULP if question.input_uncertainty is None else question.input_uncertainty
    inherited = exact.inherited(question.times, uncertainty)
    if inherited < math.inf:
        return inherited, ()
    detail = (
        f"a relative uncertainty of {uncertainty:.3g} of every input leaves nothing known of the phase at the latest "
        "times, and inherited is null; energy and angular momentum are known all the same; ask for earlier times"
    )
    return None, (Notice("phase-lost", detail, ("times",)),)


def _finite(norm: float | None) -> float | None:
    return norm if norm is not None and norm < math.inf else None
