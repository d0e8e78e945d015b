"""Closed forms of pendulums against their motion integrated in many digits: swinging, circling, on the separatrix."""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import Any

import mpmath
import pytest

from tests.core.multibody.formulation.reading import Jet, evaluated
from tests.core.multibody.formulation.test_scene_equations import answer_of, scene_of


def rod_pendulum(angle: float, rate: float, gravity: tuple[float, float] = (0.0, -9.81)) -> dict[str, Any]:
    """Return a point on a rod of 1 m at an angle from the downward vertical."""
    return {
        "gravity": list(gravity),
        "let": {"a": angle, "w": rate},
        "bodies": {"bob": {"mass": 1, "at": ["sin(a)", "-cos(a)"], "velocity": ["w*cos(a)", "w*sin(a)"]}},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    }


CASES = {
    "released": (0.8, 0.0, (0.0, -9.81)),
    "released on the other side": (-2.9, 0.0, (0.0, -9.81)),
    "swings inwards": (1.0, -1.3, (0.0, -9.81)),
    "swings outwards": (-1.0, -1.3, (0.0, -9.81)),
    "turns over": (0.3, 8.0, (0.0, -9.81)),
    "turns over backwards": (0.3, -8.0, (0.0, -9.81)),
    "in an inclined field": (0.4, 0.5, (3.0, -9.0)),
    "below a field upwards": (3.0, 0.5, (0.0, 9.81)),
    "slowly": (1e-7, 0.0, (0.0, -9.81)),
}


@pytest.mark.parametrize("case", CASES)
def test_the_angle_is_that_of_the_integrated_motion(case: str) -> None:
    angle, rate, (across, up) = CASES[case]
    scene = scene_of(rod_pendulum(angle, rate, (across, up)))
    equations = answer_of(scene).equations
    assert equations is not None
    (name, formula) = next(iter(equations.closed_form.items()))
    known = {key: Jet(mpmath.mpf(x)) for key, x in equations.constants.items()}
    with mpmath.workdps(25):
        run = mpmath.odefun(
            lambda _, y: [y[1], across * mpmath.cos(y[0]) + up * mpmath.sin(y[0])], 0, [mpmath.mpf(angle), rate]
        )
        for time in (0.0, 1.3):
            moved = evaluated(formula.plain, known | {"t": Jet(mpmath.mpf(time), mpmath.mpf(1))})
            turned, turning = run(time)
            place = {"bob.x": Jet(mpmath.sin(turned)), "bob.y": Jet(-mpmath.cos(turned))}
            there = evaluated(equations.coordinates[name] or "", known | place).value
            away = (moved.value - there + mpmath.pi) % (2 * mpmath.pi) - mpmath.pi
            assert abs(float(away)) <= 1e-13 * max(1.0, abs(float(turned))), time
            assert float(moved.rate) == pytest.approx(float(turning), rel=1e-12, abs=1e-12 * max(abs(angle), 1e-9))


def test_from_below_with_the_speed_of_the_top_it_is_the_gudermannian() -> None:
    scene = scene_of(rod_pendulum(0.0, 0.0))
    question = rod_pendulum(0.0, 0.0)
    question["let"]["w"] = "2*sqrt(9.81)"
    equations = answer_of(scene_of(question)).equations
    assert equations is not None
    assert [one.plain for one in equations.closed_form.values()] == ["2*atan(sinh(c1*t))"]
    assert equations.constants["c1"] == pytest.approx(sqrt(9.81), rel=1e-15)
    resting = answer_of(scene).equations
    assert resting is not None
    assert not resting.closed_form


def test_two_pendulums_beside_each_other_have_a_form_each_and_a_coupled_one_none() -> None:
    one = rod_pendulum(0.8, 0.0)
    one["bodies"]["other"] = {"mass": 2, "at": [5 + sin(1.2), -cos(1.2)]}
    one["connections"].append({"kind": "rod", "a": "other", "b": [5, 0], "length": 1})
    apart = answer_of(scene_of(one)).equations
    assert apart is not None
    assert len(apart.closed_form) == 2
    one["connections"].append({"kind": "spring", "a": "bob", "b": "other", "stiffness": 2, "rest_length": pi})
    coupled = answer_of(scene_of(one)).equations
    assert coupled is not None
    assert not coupled.closed_form
