"""What uncertain inputs do to a motion, against derivatives by hand and against motions of changed descriptions."""

from __future__ import annotations

import copy
import json
from typing import Any

import mpmath
import numpy as np
import pytest

from core.multibody.solve import solve_scene
from core.multibody.trajectory.column_errors import apart
from core.systems.trajectory import Accuracy
from tests.core.multibody.random_scenes import any_scene
from tests.core.multibody.worked_examples import LAGRANGE_TOP, MASSIVE_PULLEY, column, read

STONE: dict[str, Any] = {
    "gravity": [0, -9.81],
    "bodies": {"stone": {"mass": 3, "at": [0, 2], "velocity": [4, 7]}},
}
DOUBLE: dict[str, Any] = {
    "gravity": [0, -9.81],
    "bodies": {"a": {"mass": 1, "at": [0.8, -0.6]}, "b": {"mass": 2, "at": [1.6, 0.1]}},
    "connections": [{"kind": "rod", "a": "a", "b": [0, 0]}, {"kind": "rod", "a": "a", "b": "b"}],
}
HALF_ULP = 2.0**-53


def stated(scene: Any, times: Any, uncertainty: float = HALF_ULP, accuracy: float = 1e-9) -> tuple[Any, Accuracy]:
    answer = solve_scene(read(scene), times, ("trajectory",), accuracy, input_uncertainty=uncertainty)
    assert answer.trajectory is not None
    return answer, answer.trajectory.accuracy


def test_stone_by_hand() -> None:
    """The place is 4 t, 2 + 7 t - g t^2/2: every term changes by its own share."""
    answer, found = stated(STONE, [2.0], 1e-6)
    change = 1e-6 * np.hypot(8.0, 2 + 14 + 9.81 * 2)
    inherited = column(answer, "stone.position").inherited
    assert change <= inherited <= 1.03 * change
    assert found.inherited is not None
    assert found.inherited >= change / np.hypot(8, 2 + 14 - 9.81 * 2)


def test_pendulum_by_the_derivative_of_its_elliptic_function() -> None:
    """Released at rest from 30 degrees, 1.5 m long: with respect to gravity, length and angle, at 30 digits."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 2, "at": {"polar": [1.5, {"degrees": -30}]}}},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    }

    def place(gravity: Any, length: Any, start: Any) -> Any:
        theta_0, w = mpmath.pi / 2 + start * mpmath.pi / 180, mpmath.sqrt(gravity / length)
        k = mpmath.sin(theta_0 / 2)
        theta = 2 * mpmath.asin(k * mpmath.ellipfun("sn", mpmath.ellipk(k * k) - 2 * w, k=k))
        return mpmath.matrix([length * mpmath.sin(theta), -length * mpmath.cos(theta)])

    with mpmath.workdps(40):
        given = [mpmath.mpf("9.81"), mpmath.mpf("1.5"), mpmath.mpf(-30)]
        changes = []
        for k in range(3):
            moved = [x * (1 + mpmath.mpf(10) ** -15) if i == k else x for i, x in enumerate(given)]
            changes.append((place(*moved) - place(*given)) * mpmath.mpf(10) ** 15)
        total = float(mpmath.norm(mpmath.matrix([sum(abs(change[i]) for change in changes) for i in range(2)])))
    answer, _ = stated(scene, [2.0], 1e-12)
    assert 1e-12 * total <= column(answer, "bob.position").inherited <= 1.03e-12 * total


@pytest.mark.parametrize("path", [("bodies", "a", "mass"), ("bodies", "b", "at", 0), ("gravity", 1)])
def test_no_single_number_changes_more(path: tuple[Any, ...]) -> None:
    times = [0.5, 1.0, 3.0]
    answer, _ = stated(DOUBLE, times, 1e-7, 1e-6)
    plain = solve_scene(read(DOUBLE), times, ("trajectory",), 1e-12)
    changed = copy.deepcopy(DOUBLE)
    place: Any = changed
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] *= 1 + 1e-7
    other = solve_scene(read(changed), times, ("trajectory",), 1e-12)
    for name in ("b.position", "b.velocity", "a.velocity"):
        change = np.linalg.norm(column(other, name).values - column(plain, name).values, axis=1).max()
        assert 0.0 < change <= 1.001 * column(answer, name).inherited


def test_horizon_is_where_the_accuracy_is_left() -> None:
    _, found = stated(DOUBLE, [20.0], accuracy=1e-11)
    assert found.horizon is not None
    assert found.why is None
    before, after = (stated(DOUBLE, [0.0, found.horizon * f], accuracy=1e-11)[1] for f in (0.5, 1.5))
    assert before.inherited is not None
    assert after.inherited is not None
    assert before.inherited < 1e-11 < after.inherited


def test_horizon_beyond_the_times_is_not_known() -> None:
    _, found = stated(STONE, [1.0])
    assert found.inherited is not None
    assert found.horizon is None
    assert found.why == "the change stays below the accuracy at all of the times"


def test_what_is_symmetric_remains_so() -> None:
    """A pulley's strings no longer hang by themselves, and a top's two equal moments are one number."""
    for scene in (MASSIVE_PULLEY, LAGRANGE_TOP):
        _, found = stated(scene, [0.1])
        assert found.inherited is not None
        assert HALF_ULP < found.inherited < 1e-12


def test_equal_entries_of_a_tensor_are_one_number() -> None:
    """Two moments on its diagonal are those of a symmetric top, and of the entries beside it none changes alone."""
    top = json.loads(LAGRANGE_TOP)
    _, expected = stated(top, [0.1])
    a, b, c = top["bodies"]["top"].pop("moments")
    top["bodies"]["top"]["tensor"] = [[a, 0, 0], [0, b, 0], [0, 0, c]]
    assert stated(top, [0.1])[1].inherited == pytest.approx(expected.inherited, rel=1e-9)
    free = {"mass": 1, "tensor": [[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]], "angular_velocity": [1, 2, 3]}
    assert stated({"gravity": [0, 0, 0], "bodies": {"b": free | {"at": [0, 0, 0]}}}, [0.1])[1].inherited is not None


def test_formulas_are_exact_and_their_names_are_not() -> None:
    exact = STONE | {"gravity": [0, "-981/100"], "bodies": {"stone": {"mass": 3, "at": [0, "2"]}}}
    answer, _ = stated(exact, [1.0], 1e-6)
    assert column(answer, "stone.position").inherited < 1e-20
    named = exact | {"let": {"g": 9.81}, "gravity": [0, "-g"]}
    answer, _ = stated(named, [1.0], 1e-6)
    assert column(answer, "stone.position").inherited == pytest.approx(9.81e-6 / 2, rel=0.03)


def test_what_two_equal_numbers_let_move_has_no_inherited_error() -> None:
    """Two tracks of one slope are one; of two slopes they hold the bead where they cross."""
    track = {"kind": "track", "place": "bead", "on": {"at": [0, 0], "slope": {"degrees": 30}}}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bead": {"mass": 1, "at": {"polar": [1, {"degrees": 30}]}}},
        "connections": [track, track],
    }
    _, found = stated(scene, [0.1])
    assert found.inherited is None
    assert "exactly what it is" in str(found.why)


def test_the_pull_of_a_weight_changes_with_its_mass_and_with_gravity() -> None:
    """At rest: m g, and the potential energy m g y; both to the share of both, and of the height."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 2, "at": [0, -3]}},
        "connections": [{"kind": "rod", "name": "r", "a": "bob", "b": [0, 0]}],
    }
    answer = solve_scene(read(scene), [0.0, 5.0], ("forces-in-time", "energy-in-time"), input_uncertainty=1e-6)
    assert column(answer, "r.force").inherited == pytest.approx(2e-6 * 2 * 9.81, rel=2e-5)
    assert column(answer, "energy.potential").inherited == pytest.approx(3e-6 * 2 * 9.81 * 3, rel=2e-5)
    assert answer.trajectory is not None
    assert answer.trajectory.accuracy.inherited == pytest.approx(3e-6, rel=2e-5)


def test_what_is_summed_up_along_the_motion_has_none() -> None:
    answer = solve_scene(read(DOUBLE), [1.0], ("work-in-time", "paths-in-time"), input_uncertainty=1e-9)
    assert answer.trajectory is not None
    assert answer.trajectory.accuracy.inherited is None
    assert "integrals along the motion" in str(answer.trajectory.accuracy.why)


@pytest.mark.parametrize("seed", range(11))
def test_no_number_of_a_random_scene_changes_a_force_or_an_energy_more(seed: int) -> None:
    """One number of each description, changed by 4e-10 of itself and run anew as another scene."""
    scene, share = any_scene(seed), 4e-10
    asked = ("forces-in-time", "energy-in-time", "momenta-in-time")
    paths = numbers_of({name: scene[name] for name in scene if name != "numbers"})
    path = paths[int(np.random.default_rng(seed).integers(len(paths)))]
    changed = copy.deepcopy(scene)
    place: Any = changed
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] *= 1 + share
    answer = solve_scene(read(scene), [0.4, 0.8], asked, 1e-6, input_uncertainty=share)
    other = solve_scene(read(changed), [0.4, 0.8], asked, 1e-10)
    assert answer.trajectory is not None
    for name, one in answer.trajectory.columns.items():
        two = column(other, name)
        scale = float(np.abs(one.values).max())
        assert apart(one, two) <= 1.001 * one.inherited + one.error + two.error + 1e-14 * scale


def numbers_of(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    if isinstance(value, dict):
        return [found for name, entry in value.items() for found in numbers_of(entry, (*path, name))]
    if isinstance(value, list):
        return [found for i, entry in enumerate(value) for found in numbers_of(entry, (*path, i))]
    return [path] if isinstance(value, (int, float)) and not isinstance(value, bool) and value else []


@pytest.mark.parametrize("seed", range(24))
def test_no_number_of_a_random_scene_changes_more(seed: int) -> None:
    """One number of each description, changed by 4e-10 of itself and run anew as another scene."""
    scene, share = any_scene(seed), 4e-10
    paths = numbers_of({name: scene[name] for name in scene if name != "numbers"})
    path = paths[int(np.random.default_rng(seed).integers(len(paths)))]
    changed = copy.deepcopy(scene)
    place: Any = changed
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] *= 1 + share
    answer, _ = stated(scene, [0.4, 0.8], share, 1e-6)
    other = solve_scene(read(changed), [0.4, 0.8], ("trajectory",), 1e-10)
    for name, one in answer.trajectory.columns.items():
        two = column(other, name)
        assert apart(one, two) <= 1.001 * one.inherited + one.error + two.error + 1e-14
