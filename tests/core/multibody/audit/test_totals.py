"""Wrong energies, momenta, works and paths in time are refused, and wrong searches for energies and momenta."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from core.multibody.trajectory.occurrences import ExtremesOf
from tests.core.multibody.audit.spoiled import Audited, answered, description_of

SCENES = ("physical-pendulum", "kepler-ellipse", "dumbbell", "asymmetric-top", "spherical-pendulum")
TIMES = np.linspace(0.0, 1.0, 5)


@cache
def right(name: str) -> Audited:
    outputs = ("trajectory", "energy-in-time", "momenta-in-time", "work-in-time", "paths-in-time")
    return answered(description_of(name), TIMES, outputs)


@cache
def searched(name: str, quantity: str) -> Audited:
    return answered(description_of(name), TIMES, ("trajectory", ExtremesOf(quantity)))


CHANGES: dict[str, Callable[[Any], Any]] = {
    "is too large by a millionth": lambda x: x * (1.0 + 1e-6),
    "has the wrong sign": lambda x: -x,
    "is off at one time": lambda x: x + 1e-6 * np.eye(len(x))[-1].reshape(-1, *(1,) * (x.ndim - 1)),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", ["energy.kinetic", "energy.potential", "momentum", "angular_momentum"])
def test_a_total_that_is_not_that_of_places_and_rates_is_refused(name: str, change: str) -> None:
    count = 0
    for scene in SCENES:
        one = right(scene)
        motion = one.answer.trajectory
        assert motion is not None
        assert one.failure() is None, scene
        wrong = CHANGES[change](motion.columns[name].values)
        if np.abs(wrong - motion.columns[name].values).max() < 1e-8:
            continue
        columns = {**motion.columns, name: replace(motion.columns[name], values=wrong)}
        count += 1
        assert replace(one, answer=replace(one.answer, trajectory=replace(motion, columns=columns))).failure(), scene
    assert count >= 3


@pytest.mark.parametrize("quantity", ["energy.kinetic", "energy.potential", "momentum.x"])
def test_a_wrong_extreme_of_a_total_is_refused(quantity: str) -> None:
    for scene in ("physical-pendulum", "kepler-ellipse"):
        one = searched(scene, quantity)
        assert one.failure() is None, scene
        for field in ("least", "largest"):
            extremes = tuple(replace(x, **{field: getattr(x, field) + 1e-5}) for x in one.answer.extremes or ())
            assert replace(one, answer=replace(one.answer, extremes=extremes)).failure() is not None, scene


WORKING = (
    "damped-oscillator",
    "block-on-spring-with-friction",
    "ball-bounces-with-spin",
    "kepler-ellipse",
    "spherical-pendulum",
)


@pytest.mark.parametrize("change", [lambda x: x * (1.0 + 1e-5), lambda x: -x, lambda x: 0.0 * x])
def test_works_that_are_not_the_change_of_the_kinetic_energy_are_refused(change: Callable[[Any], Any]) -> None:
    count = 0
    for scene in WORKING:
        one = right(scene)
        motion = one.answer.trajectory
        assert motion is not None
        assert one.failure() is None, scene
        for name, column in motion.columns.items():
            if name.endswith(".work") and np.ptp(column.values) > 1e-3:
                columns = {**motion.columns, name: replace(column, values=change(column.values))}
                wrong = replace(one, answer=replace(one.answer, trajectory=replace(motion, columns=columns)))
                assert wrong.failure() is not None, (scene, name)
                count += 1
    assert count >= 6


def test_a_path_that_is_shorter_than_its_way_is_refused() -> None:
    for scene in ("damped-oscillator", "ball-bounces-with-spin", "kepler-ellipse"):
        one = right(scene)
        motion = one.answer.trajectory
        assert motion is not None
        assert one.failure() is None, scene
        name = next(name for name in motion.columns if name.endswith(".path"))
        column = motion.columns[name]
        for values in (0.0 * column.values, 0.5 * column.values, -column.values):
            columns = {**motion.columns, name: replace(column, values=values)}
            wrong = replace(one, answer=replace(one.answer, trajectory=replace(motion, columns=columns)))
            assert wrong.failure() is not None, scene
