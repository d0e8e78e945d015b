"""Wrong occurrences and extremes are refused: late ones, ones that are left out, values that are not reached."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.audit.searches import quantity
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.systems.trajectory import Column
from tests.core.multibody.audit.spoiled import Audited, answered, description_of

SEARCHED = ("physical-pendulum", "damped-oscillator", "bounce-to-rest")
TIMES = np.linspace(0.0, 3.0, 31)


@cache
def found(scene: str) -> list[Audited]:
    """Return audited answers to searches, one for each quantity that moves."""
    one = answered(description_of(scene), TIMES, ("trajectory", "forces-in-time"))
    assert one.answer.trajectory is not None
    columns, answers = one.answer.trajectory.columns, []
    for name in columns:
        of = quantity(columns, name) or quantity(columns, f"{name}.x")
        assert of is not None
        values, _ = of
        if np.ptp(values) < 1e-3 or not {"position", "angle"} & set(name.split(".")):
            continue
        full = name if columns[name].values.ndim == 1 else f"{name}.x"
        middle = float(np.round((values.min() + values.max()) / 2.0 + 0.01 * np.ptp(values), 4))
        outputs: Any = ("trajectory", "forces-in-time", When(full, middle), ExtremesOf(full))
        answers.append(answered(description_of(scene), TIMES, outputs))
    return answers


def _occurrences(change: Callable[[tuple[Any, ...]], tuple[Any, ...]]) -> Callable[[SceneSolution], SceneSolution]:
    return lambda answer: replace(answer, occurrences=change(answer.occurrences or ()))


def _extremes(change: Callable[[Any], Any]) -> Callable[[SceneSolution], SceneSolution]:
    return lambda answer: replace(answer, extremes=tuple(change(one) for one in answer.extremes or ()))


SPOILED: dict[str, Callable[[SceneSolution], SceneSolution]] = {
    "occurrences are late": _occurrences(lambda some: tuple(replace(one, time=one.time * 1.001) for one in some)),
    "occurrences are off by a millionth": _occurrences(
        lambda some: tuple(replace(one, time=one.time * (1.0 + 1e-6)) for one in some)
    ),
    "the value is another": _occurrences(lambda some: tuple(replace(one, equals=one.equals * 1.01) for one in some)),
    "the first is left out": _occurrences(lambda some: tuple(replace(one, nth=one.nth - 1) for one in some[1:])),
    "the largest value is too large": _extremes(lambda one: replace(one, largest=one.largest + 1e-6)),
    "the least value is too large": _extremes(lambda one: replace(one, least=one.least + 1e-3)),
    "the largest value is at another time": _extremes(lambda one: replace(one, largest_time=one.least_time)),
}


@pytest.mark.parametrize("kind", SPOILED)
def test_wrong_searches_are_refused(kind: str) -> None:
    count = 0
    for scene in SEARCHED:
        for one in found(scene):
            assert one.failure() is None, scene
            spoiled = SPOILED[kind](one.answer)
            if spoiled == one.answer or (kind == "the first is left out" and len(spoiled.occurrences or ()) < 2):
                continue
            count += 1
            assert replace(one, answer=spoiled).failure() is not None, (scene, spoiled.occurrences, spoiled.extremes)
    assert count >= 2


def test_quantities_are_columns_and_their_components() -> None:
    values = np.array([[3.0, 4.0], [0.0, 2.0]])
    columns = {
        "a.position": Column(values, "m", 0.1, "closed form"),
        "s.tension": Column(values[0], "N", 0.2, "closed form"),
    }
    x = quantity(columns, "a.position.x")
    size = quantity(columns, "a.position.length")
    tension = quantity(columns, "s.tension")
    assert x is not None
    assert size is not None
    assert tension is not None
    assert x[0].tolist() == [3.0, 0.0]
    assert size[0].tolist() == [5.0, 2.0]
    assert tension == (columns["s.tension"].values, 0.2)
    assert quantity(columns, "a.position.z") is None
    assert quantity(columns, "b.angle") is None
