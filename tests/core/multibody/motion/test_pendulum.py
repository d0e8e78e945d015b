"""Pendulums beside the separatrix, and on it, against elliptic functions in mpmath."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import When
from tests.core.multibody.worked_examples import read

with mpmath.workdps(80):
    G = mpf("9.81")


@pytest.fixture(autouse=True)
def _in_many_digits() -> Iterator[None]:
    with mpmath.workdps(80):
        yield


def from_rest(below_the_top: str, length: str = "1") -> dict[str, Any]:
    angle = f"pi - {below_the_top}"
    return {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 2, "at": [f"{length}*sin({angle})", f"-{length}*cos({angle})"]}},
        "connections": [{"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]}],
    }


@pytest.mark.parametrize("below", ["1e-3", "1e-6", "1e-7", "1e-8", "1e-10", "1e-15", "1e-30"])
@pytest.mark.parametrize("length", ["1", "0.37"])
def test_period_and_place_from_rest_beside_the_top(below: str, length: str) -> None:
    size, m1 = mpf(length), mpmath.sin(mpf(below) / 2) ** 2
    rate = mpmath.sqrt(G / size)
    quarter = mpmath.pi / (2 * mpmath.agm(1, mpmath.sqrt(m1)))
    times = [1.0, 5.0, 17.0, float(quarter / rate)]
    found = solve_scene(read(from_rest(below, length)), times, ("trajectory", "energy"))
    assert found.period is not None
    assert found.period_error is not None
    period = 4 * quarter / rate
    assert abs(mpf(found.period) - period) <= found.period_error <= 2e-16 * float(period)
    assert found.trajectory is not None
    column = found.trajectory.columns["bob.position"]
    for time, place in zip(times, column.values.tolist(), strict=True):
        # sin(psi/2) = sqrt(m) cd(w t | m), which is sqrt(m) sn(K + w t | m).
        sine = mpmath.sqrt(1 - m1) * mpmath.ellipfun("cd", rate * mpf(time), m=1 - m1)
        cosine = mpmath.sqrt(1 - sine**2)
        exact = 2 * size * sine * cosine, -size * (1 - 2 * sine**2)
        assert mpmath.norm([mpf(x) - y for x, y in zip(place, exact, strict=True)]) <= column.error < 1e-14


def test_a_start_on_the_separatrix_never_returns() -> None:
    """With the energy of the top: tan((pi - psi)/4) falls as exp(-w t)."""
    half = "(pi - 0.5)/2"
    speed = f"2*sqrt(9.81)*cos({half})"
    scene = from_rest("0.5")
    scene["bodies"]["bob"]["velocity"] = [f"{speed}*cos(2*{half})", f"{speed}*sin(2*{half})"]
    found = solve_scene(read(scene), [1.0, 6.0])
    assert found.model.apart[0].name == "pendulum"
    assert found.period is None
    assert found.trajectory is not None
    column = found.trajectory.columns["bob.position"]
    for time, (x, y) in zip((1, 6), column.values.tolist(), strict=True):
        away = 4 * mpmath.atan(mpmath.tan(mpf("0.125")) * mpmath.exp(-mpmath.sqrt(G) * time))
        assert mpmath.hypot(mpf(x) - mpmath.sin(away), mpf(y) - mpmath.cos(away)) <= column.error < 1e-14


@pytest.mark.parametrize("faster", ["1e-6", "1e-9", "1e-14"])
def test_a_pendulum_that_only_just_turns_over(faster: str) -> None:
    scene = from_rest("pi")
    scene["bodies"]["bob"]["velocity"] = [f"2*sqrt(9.81)*(1 + {faster})", 0]
    search = When("bob.position.y", 0.5)
    found = solve_scene(read(scene), [20.0], (search, "forces-in-time"))
    m = (1 + mpf(faster)) ** 2
    quarter = mpmath.pi / (2 * mpmath.agm(1, mpmath.sqrt((m - 1) / m)))
    period = 2 * quarter / mpmath.sqrt(G * m)
    assert found.period is not None
    assert found.period_error is not None
    assert abs(mpf(found.period) - period) <= found.period_error <= 2e-16 * float(period)
    assert found.occurrences is not None
    times = np.array([one.time for one in found.occurrences])
    # At 120 degrees, up and down again in every turn.
    first = mpmath.ellipf(mpmath.pi / 3, 1 / m) / mpmath.sqrt(G * m)
    assert abs(mpf(times[0]) - first) <= found.occurrences[0].error < 1e-13
    assert times[1] - times[0] == pytest.approx(float(period - 2 * first), rel=1e-12)
