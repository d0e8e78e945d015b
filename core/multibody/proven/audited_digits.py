"""The audit of an answer in digits: its numbers, as doubles, are held against the description like any other answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from flint import arb

from core.arrays import Floats
from core.balls import Undetermined
from core.errors import NotApplicable
from core.multibody.algebra.polynomials import Ball
from core.multibody.answer import BodyAcceleration, Energy, SceneSolution
from core.multibody.audit.audit import audited
from core.multibody.audit.failure import Verdict
from core.multibody.language.scene import Scene
from core.multibody.proven.part_proof import ProvenAnswer, ProvenColumn
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.trajectory import HORIZON, Accuracy, Column, How, Trajectory, Work

NEAREST = 2.0**-51
"""Share of a number of at least 16 digits by which the double that is read from it may be off."""

HOW: How = "closed form"
"""The digits are right to the last."""

Digits = Mapping[str, ProvenColumn]
Moving = Callable[[Sequence[Ball]], Digits]
"""From times to the columns of the motion."""


def audited_digits(scene: Scene, answer: ProvenAnswer, moving: Moving, times: Floats) -> Verdict:
    """Return whether an answer in digits keeps the laws that are checked, and which one it does not.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Those of the question, as doubles.
    """

    def sampled(moments: Floats, forces: bool) -> dict[str, Column]:
        try:
            return _columns(moving([arb(float(t)) for t in moments]))
        except Undetermined:
            # Zeros between the times of the question would need more digits than are answered.
            raise NotApplicable("what the motion is there is not determined", path=("times",)) from None

    return audited(scene, _in_doubles(answer, times), sampled, times)


def _in_doubles(answer: ProvenAnswer, times: Floats) -> SceneSolution:
    repeats = answer.model.repeats
    period = None if repeats is None or repeats.period is None else float(repeats.period)
    if period is not None and period > times.max(initial=0.0):
        # A series that nobody asks for would be followed up to there.
        period = None
    motion = None
    if answer.columns is not None and answer.rows:
        stated = Accuracy(NEAREST, NEAREST, HOW)
        rows, method = np.array(answer.rows), ClosedFormEvaluation().kind
        motion = Trajectory(times[rows], _columns(answer.columns), stated, None, method, Work(len(rows)), ended=HORIZON)
    energy = answer.energy
    if energy is not None:
        energy = Energy(float(energy.kinetic), float(energy.potential), float(energy.total), energy.conserved)
    return SceneSolution(
        answer.model,
        None
        if answer.accelerations is None
        else {name: _acceleration(one) for name, one in answer.accelerations.items()},
        None if answer.forces is None else {name: _in_double(one) for name, one in answer.forces.items()},
        energy,
        motion,
        period,
        None if period is None else NEAREST * period,
        None,
        (),
        None,
    )


def _acceleration(one: BodyAcceleration) -> BodyAcceleration:
    turning: Any = one.angular
    angular = tuple(map(float, turning)) if isinstance(turning, tuple) else None if turning is None else float(turning)
    return BodyAcceleration(tuple(map(float, one.linear)), angular)


def _in_double(one: Any) -> Any:
    return replace(one, value=None if one.value is None else float(one.value))


def _columns(found: Digits) -> dict[str, Column]:
    columns = {}
    for name, column in found.items():
        values = np.array(column.values, dtype=np.float64)
        columns[name] = Column(values, column.unit, NEAREST * float(np.abs(values).max(initial=0.0)), HOW)
    return columns
