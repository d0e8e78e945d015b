"""What every named scene owes, whatever it declares: its outputs alone and together, times in any order, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.scenes.figures import MOTION
from core.systems.methods import ClosedFormEvaluation, RungeKutta4
from core.systems.solve import solve

Samples = dict[str, np.ndarray]


def columns_of(answer: Any) -> Samples:
    """Return the samples of an answer by column, the times among them."""
    assert answer.trajectory is not None
    return {name: answer.trajectory[name] for name in ("time", *answer.trajectory.columns)}


def samples_of(scene: Any, times: np.ndarray) -> Samples:
    return columns_of(scene.answer(times))


def span_of(scene: Any) -> float:
    """Return a time in which something happens, within the motion."""
    events = scene.answer(outputs=frozenset({"events"})).figures["events"]
    last = events[-1] if events else {"kind": "none", "time": None}
    # An event that no double can place is later than any time here.
    return 2.0 if last["kind"] == "jerk" or last["time"] is None else min(last["time"], 2.0)


def each_output_alone_is_what_it_is_among_all(scene: Any, name: str) -> None:
    times = np.linspace(0, span_of(scene), 5)
    whole, alone = scene.answer(times), scene.answer(times, frozenset({name}))
    assert set(alone.figures) == {name}
    assert alone.figures[name] == whole.figures[name]
    assert alone.trajectory is None
    assert alone.work.samples == 0
    if name not in (*MOTION, *scene.of_motion):
        assert alone.model.degrees_of_freedom == 0
        assert alone.ended is None
    assert set(whole.figures) == set(figures_of(scene))


def figures_of(scene: Any) -> list[str]:
    """Return the outputs that are figures."""
    return [name for name in scene.outputs if name not in ("trajectory", "ended")]


def samples_depend_on_their_own_time_only(scene: Any) -> None:
    times = np.linspace(0, span_of(scene), 7)
    order = np.array([3, 0, 6, 1, 5, 2, 4])
    straight, shuffled = samples_of(scene, times), samples_of(scene, times[order])
    for name, column in straight.items():
        assert np.allclose(column[order], shuffled[name], rtol=1e-13, atol=1e-14 * np.max(np.abs(column)) + 1e-300)
        assert np.all(np.isfinite(column))


def it_is_a_system(scene: Any) -> None:
    """`solve` answers it by its closed form, with the same samples, and by a method, with a measured error."""
    times = np.linspace(0, 0.5 * span_of(scene), 3)
    whole = scene.answer(times).trajectory
    for method in (None, ClosedFormEvaluation()):
        found = solve(scene, times, method=method)
        for name, column in found.columns.items():
            assert np.array_equal(column.values, whole[name])
            assert column.how == "closed form"
            assert column.unit == scene.units()[name]
        assert found.accuracy.error <= whole.accuracy.error
    uninterrupted = [event["time"] for event in scene.answer(outputs=frozenset({"events"})).figures["events"]]
    times = times * min([1.0, *(0.5 * time / times[-1] for time in uninterrupted if time)])
    whole = scene.answer(times).trajectory
    found = solve(scene, times, method=RungeKutta4(0.01 * float(times[-1])))
    assert found.method == "runge-kutta-4"
    assert found.work.steps == 100
    assert found.accuracy.how == "measured against closed form"
    for name, column in found.columns.items():
        apart = float(np.max(np.abs(column.values - whole[name])))
        assert apart <= column.error <= 2e-8 * column.scale


def what_makes_no_sense_is_refused(scene: Any) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        scene.answer(outputs=frozenset({"colour"}))
    assert refusal.value.path == ("outputs",)
    with pytest.raises(InvalidParameter) as refusal:
        scene.answer(outputs=frozenset({"trajectory"}))
    assert refusal.value.path == ("times",)
    for times in (np.array([np.nan]), np.array([np.inf]), np.zeros((2, 2)), np.zeros(0)):
        with pytest.raises(InvalidParameter) as refusal:
            scene.answer(times)
        assert refusal.value.path[:1] == ("times",)
    assert scene.answer(np.zeros(1)).accuracy.error < 1e-13, "rest at the start is exact"
