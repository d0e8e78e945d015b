"""Named methods on described scenes, against solutions that know nothing of the table."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.multibody.trajectory.column_errors import worst
from core.systems.budget import Budget
from core.systems.methods import (
    ClosedFormEvaluation,
    DiscreteMoserVeselov,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    Method,
    Radau,
    RungeKutta4,
    SymmetricSplitting,
)
from tests.core.multibody.worked_examples import BEAD_ON_HOOP, LAGRANGE_TOP, MASSIVE_PULLEY, TWO_RODS, column, read

PENDULUM = """{"gravity":[0,-9.81],"bodies":{"bob":{"mass":2,"at":{"polar":[1.5,{"degrees":-30}]}}},
"connections":[{"kind":"rod","name":"r","a":"bob","b":[0,0]}]}"""

PROJECTILE = """{"gravity":[0,-9.81],"bodies":{"stone":{"mass":3,"at":[0,0],"velocity":[4,7]}}}"""

SPRING = """{"bodies":{"m":{"mass":0.5,"at":[1.3,0]}},"connections":[
{"kind":"slider","a":"m","b":[0,0],"direction":[1,0]},
{"kind":"spring","a":"m","b":[0,0],"stiffness":8,"rest_length":1}]}"""

EVERY: tuple[Method, ...] = (
    ExplicitEuler(1e-3),
    RungeKutta4(0.01),
    ImplicitMidpoint(0.01),
    DormandPrince853(1e-12),
    Lsoda(1e-9),
    Radau(1e-9),
)


def moved(scene: str | dict[str, Any], times: Any, method: Method, **others: Any) -> SceneSolution:
    return solve_scene(read(scene), times, ("trajectory", "forces-in-time"), method=method, **others)


def pendulum(times: Any) -> tuple[Any, Any]:
    """Return places of a pendulum of 1.5 m released at rest, by Jacobi's functions at 30 digits, and rod forces.

    sin(theta/2) = k sn(K - w t) with k = sin(theta_0/2), w = sqrt(g/l) (Whittaker, Analytical Dynamics, section 44).
    The force on the rod follows from energy: m g cos theta + 2 m g (cos theta - cos theta_0).
    """
    places, forces = [], []
    with mpmath.workdps(30):
        theta_0, w = mpmath.pi / 3, mpmath.sqrt(mpmath.mpf("9.81") / mpmath.mpf("1.5"))
        k = mpmath.sin(theta_0 / 2)
        for t in times:
            s = k * mpmath.ellipfun("sn", mpmath.ellipk(k * k) - w * mpmath.mpf(float(t)), k=k)
            theta = 2 * mpmath.asin(s)
            places.append([float(1.5 * mpmath.sin(theta)), float(-1.5 * mpmath.cos(theta))])
            forces.append(float(2 * mpmath.mpf("9.81") * (3 * mpmath.cos(theta) - 2 * mpmath.cos(theta_0))))
    return np.array(places), np.array(forces)


@pytest.mark.parametrize("method", EVERY, ids=lambda method: method.kind)
def test_errors_of_a_pendulum_are_the_true_ones(method: Method) -> None:
    times = np.linspace(0, 3, 7)
    answer = moved(PENDULUM, times, method)
    places, forces = pendulum(times)
    found, pull = column(answer, "bob.position"), column(answer, "r.force")
    true = np.linalg.norm(found.values - places, axis=1).max()
    assert true <= found.error <= 1.1 * true + 1e-14
    true = np.abs(np.abs(pull.values) - np.abs(forces)).max()
    assert true <= pull.error <= 1.1 * true + 1e-12
    assert np.linalg.norm(found.values, axis=1) == pytest.approx(1.5, rel=1e-14)
    assert found.how == "measured against pairs"
    assert answer.trajectory is not None
    assert answer.trajectory.method == method.kind


@pytest.mark.parametrize(("method", "order"), [(ExplicitEuler, 1), (ImplicitMidpoint, 2), (RungeKutta4, 4)])
@pytest.mark.parametrize("scene", [PENDULUM, TWO_RODS, LAGRANGE_TOP], ids=["pendulum", "two rods", "top"])
def test_errors_fall_with_the_order(method: Any, order: int, scene: str) -> None:
    step = {1: 1e-4, 2: 4e-4, 4: 5e-3}[order]
    errors = [
        worst(answer.trajectory.columns)
        for h in (step, step / 2)
        if (answer := moved(scene, [0.4], method(h))).trajectory is not None
    ]
    assert errors[0] / errors[1] == pytest.approx(2**order, rel=0.1)


@pytest.mark.parametrize("method", EVERY, ids=lambda method: method.kind)
def test_projectile_by_every_method(method: Method) -> None:
    times = np.array([-0.5, 0.0, 0.25, 1.0])
    answer = moved(PROJECTILE, times, method)
    found = column(answer, "stone.position")
    right = np.stack([4 * times, 7 * times - 9.81 * times**2 / 2], axis=1)
    true = np.linalg.norm(found.values - right, axis=1).max()
    assert true <= found.error + 1e-15
    assert found.how == "measured against closed form"


def test_explicit_euler_of_a_projectile_by_hand() -> None:
    """After n steps Euler's height is v t - g t (t - h)/2: the error is g t h/2."""
    answer = moved(PROJECTILE, [1.0], ExplicitEuler(0.125))
    assert column(answer, "stone.position").values[0, 1] == pytest.approx(7 - 9.81 * 0.875 / 2, rel=1e-15)
    assert column(answer, "stone.position").error == pytest.approx(9.81 * 0.125 / 2, rel=1e-13)


def test_explicit_euler_of_a_spring_grows_as_it_must() -> None:
    """Its energy grows by 1 + (w h)^2 a step: the state is multiplied by 1 +- i w h."""
    answer = moved(SPRING, [1.0], ExplicitEuler(0.01))
    z = 0.3 * (1 + 0.04j) ** 100
    assert column(answer, "m.position").values[0, 0] == pytest.approx(1 + z.real, rel=1e-13)
    assert column(answer, "m.velocity").values[0, 0] == pytest.approx(-4 * z.imag, rel=1e-12)


def test_midpoint_of_a_spring_turns_too_slowly() -> None:
    """A step multiplies the state by (1 + i w h/2)/(1 - i w h/2): the amplitude stays, the phase is 2 atan(w h/2)."""
    answer = moved(SPRING, [1.0], ImplicitMidpoint(0.01))
    phase = 100 * 2 * np.arctan(0.02)
    assert column(answer, "m.position").values[0, 0] == pytest.approx(1 + 0.3 * np.cos(phase), rel=1e-12)


@pytest.mark.parametrize("scene", [MASSIVE_PULLEY, TWO_RODS, BEAD_ON_HOOP, LAGRANGE_TOP])
def test_a_close_tolerance_agrees_with_the_model(scene: str) -> None:
    plain = solve_scene(read(scene), [0.3, 0.05], ("trajectory",), 1e-10)
    answer = moved(scene, [0.3, 0.05], DormandPrince853(1e-13))
    assert plain.trajectory is not None
    assert answer.trajectory is not None
    for name, one in plain.trajectory.columns.items():
        other = answer.trajectory.columns[name]
        assert np.abs(one.values - other.values).max() <= one.error + other.error
    assert worst(answer.trajectory.columns) < 1e-10


def test_error_larger_than_requested_is_answered_with_a_warning() -> None:
    answer = moved(PENDULUM, [3.0], ExplicitEuler(0.1))
    assert answer.trajectory is not None
    (warning,) = answer.trajectory.warnings
    assert warning.code == "accuracy-not-reached"
    assert warning.path == ("method",)
    assert worst(answer.trajectory.columns) > 0.01


def test_nothing_moves_by_any_method() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0, -1]}},
        "connections": [{"kind": "rod", "name": "r", "a": "bob", "b": [0, 0]}],
    }
    answer = moved(scene, [1.0], RungeKutta4(0.1))
    assert column(answer, "bob.position").values.tolist() == [[0.0, -1.0]]
    assert answer.trajectory is not None
    assert answer.trajectory.warnings == ()


def test_work_is_counted_and_refused() -> None:
    answer = moved(PENDULUM, [1.0], RungeKutta4(0.01))
    assert answer.trajectory is not None
    assert answer.trajectory.work is not None
    assert answer.trajectory.work.evaluations == 400
    with pytest.raises(BudgetExceeded) as refused:
        moved(PENDULUM, [1.0], RungeKutta4(0.01), budget=Budget(evaluations=1000))
    # An evaluation of a scene counts as four at least: it factors a matrix.
    assert refused.value.path == ("method", "step")
    assert (refused.value.needed, refused.value.limit) == (400, 250)


@pytest.mark.parametrize("method", [ClosedFormEvaluation(), SymmetricSplitting(0.1), DiscreteMoserVeselov(0.1)])
def test_methods_that_scenes_do_not_have(method: Method) -> None:
    with pytest.raises(NotApplicable) as refused:
        moved(TWO_RODS, [1.0], method)
    assert refused.value.path == ("method", "kind")
    assert refused.value.remedy


def test_closed_form_where_there_is_one() -> None:
    answer = moved(MASSIVE_PULLEY, [0.2], ClosedFormEvaluation())
    plain = solve_scene(read(MASSIVE_PULLEY), [0.2])
    assert column(answer, "b.position").values.tolist() == column(plain, "b.position").values.tolist()
    assert column(answer, "b.position").how == "closed form"


def test_step_that_leaves_the_constraints_is_refused() -> None:
    with pytest.raises(InvalidParameter) as refused:
        moved(TWO_RODS, [3.0], ExplicitEuler(1.0))
    assert refused.value.path == ("method", "step")
