"""Linear scenes against closed forms, also where roots coincide and where times are long."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from core.errors import BudgetExceeded
from core.multibody.search import followed
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


def oscillator(damping: str, stiffness: str = "4") -> dict[str, object]:
    return {
        "gravity": [0, 0],
        "bodies": {"m": {"mass": 1, "at": [2, 0], "velocity": [1, 0]}},
        "connections": [
            {"kind": "spring", "a": [0, 0], "b": "m", "stiffness": stiffness, "rest_length": 1},
            {"kind": "damper", "a": [0, 0], "b": "m", "coefficient": damping},
        ],
    }


@pytest.mark.parametrize("time", [0.0, 0.5, 3.0, 9.0])
def test_critical_damping_has_a_double_root(time: float) -> None:
    answer = solve_scene(read(oscillator("4")), [time])
    assert answer.model.name == "modes"
    with mpmath.workdps(30):
        x = mpmath.exp(-2 * mpmath.mpf(time)) * (1 + 3 * mpmath.mpf(time))
        place = column(answer, "m.position")
        assert abs(place.values[0, 0] - 1 - x) <= place.error < 4e-15


def test_a_long_time_costs_no_accuracy() -> None:
    scene = oscillator("1")
    scene["connections"] = [scene["connections"][0]]  # type: ignore[index]
    scene["bodies"]["m"]["at"] = [1.5, 0]  # type: ignore[index]
    answer = solve_scene(read(scene), [1e9, 1e12])
    place = column(answer, "m.position")
    with mpmath.workdps(60):
        for i, t in enumerate((10**9, 10**12)):
            x = mpmath.cos(2 * t) / 2 + mpmath.sin(2 * t) / 2
            assert abs(place.values[i, 0] - 1 - x) <= place.error < 1e-14
    assert answer.period == pytest.approx(float(mpmath.pi), rel=1e-15)


def test_a_spring_that_collapses_ends_the_scene() -> None:
    scene = oscillator("1")
    scene["connections"] = [scene["connections"][0]]  # type: ignore[index]
    answer = solve_scene(read(scene), [1.0, 2.0])
    # 1 + cos(2 t) + sin(2 t)/2 = 0
    assert answer.ended is not None
    assert answer.ended.kind == "singular"
    t = answer.ended.time
    assert t == pytest.approx(math.pi / 2, abs=1e-14)
    assert abs(1 + math.cos(2 * t) + math.sin(2 * t) / 2) < 1e-14


def test_where_events_cannot_be_excluded_for_so_long_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """The bound of two amplitudes says that a length may reach zero: after 31 s it does."""
    scene = oscillator("1")
    scene["gravity"] = [0, 0]
    bodies = scene["bodies"]
    assert isinstance(bodies, dict)
    bodies["m"]["at"], bodies["m"]["velocity"] = [1.9, 0], [0, 0]
    bodies["n"] = {"mass": 1, "at": [3, 0]}
    scene["connections"] = [
        {"kind": "spring", "a": [0, 0], "b": "m", "stiffness": 4, "rest_length": 1},
        {"kind": "spring", "a": "n", "b": "m", "stiffness": 7, "rest_length": "0.7"},
    ]
    ended = solve_scene(read(scene), [1e9]).ended
    assert ended is not None
    assert (ended.kind, ended.name) == ("singular", "spring-1")
    # Both swing about 1 m and 1.7 m, from 0.9 m and 1.3 m beside these.
    squares, modes = np.linalg.eigh(np.array([[11.0, -7.0], [-7.0, 7.0]]))
    shares = modes[0] * (modes.T @ [0.9, 1.3])
    times = np.append(np.linspace(0.0, ended.time - 1e-4, 400_000), ended.time * (1.0 + np.array([-1e-12, 1e-12])))
    length = 1.0 + np.cos(np.outer(times, np.sqrt(squares))) @ shares
    assert np.all(length[:-1] > 0.0)
    assert length[-1] < 0.0
    monkeypatch.setattr(followed, "MOST_PIECES", 20)
    with pytest.raises(BudgetExceeded):
        solve_scene(read(scene), [1e9])


def test_a_free_pair_on_a_spring_drifts_and_swings() -> None:
    scene = {
        "gravity": [0, 0],
        "bodies": {"p": {"mass": 1, "at": [0, 0], "velocity": [1, 0]}, "q": {"mass": 3, "at": [2, 0]}},
        "connections": [{"kind": "spring", "a": "p", "b": "q", "stiffness": 3, "rest_length": 2}],
    }
    answer = solve_scene(read(scene), [0.7])
    with mpmath.workdps(30):
        # Reduced mass 3/4, omega = 2, centre of mass at 1/4 of the speed.
        t = mpmath.mpf(0.7)
        gap = 2 - mpmath.sin(2 * t) / 2
        centre = (mpmath.mpf(6) + t) / 4
        place = column(answer, "p.position")
        assert abs(place.values[0, 0] - (centre - gap * 3 / 4)) <= place.error < 4e-15
    assert answer.period is None


def test_a_weight_on_a_spring_falls_about_its_equilibrium() -> None:
    scene = {
        "gravity": [0, -10],
        "bodies": {"w": {"mass": 2, "at": [0, -1]}},
        "connections": [{"kind": "spring", "name": "s", "a": [0, 0], "b": "w", "stiffness": 8, "rest_length": 1}],
    }
    answer = solve_scene(read(scene), [0.4], ("trajectory", "forces-in-time", "energy-in-time"))
    with mpmath.workdps(30):
        fall = mpmath.mpf("2.5") * (1 - mpmath.cos(2 * mpmath.mpf(0.4)))
        place, pull = column(answer, "w.position"), column(answer, "s.force")
        assert abs(place.values[0, 1] + 1 + fall) <= place.error
        assert abs(pull.values[0] - 8 * fall) <= pull.error
        total = column(answer, "energy.kinetic").values[0] + column(answer, "energy.potential").values[0]
        assert total == pytest.approx(-20, rel=1e-14)


def test_a_spring_beside_a_free_fall_has_its_mode() -> None:
    """3 u'' = k e - g of the string, e'' = 4 g/3 - 7 k e/3 of the spring.

    The tension 2 (g + u'') vanishes at k e = -2 g.
    """
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "left": {"mass": 2, "at": [-0.1, -50]},
            "right": {"mass": 1, "at": [0.1, -50]},
            "bob": {"mass": 0.5, "at": [0.1, -50.5]},
        },
        "connections": [
            {"kind": "string", "name": "s", "through": ["left", [-0.1, 0], [0.1, 0], "right"]},
            {"kind": "spring", "a": "right", "b": "bob", "stiffness": 6000, "rest_length": 0.4},
        ],
    }
    answer = solve_scene(read(scene), [0.02])
    k, g, (part,) = mpmath.mpf(6000), mpmath.mpf("9.81"), answer.model.apart
    assert [mode[:2] for mode in part.modes] == [(pytest.approx(math.sqrt(14000), rel=1e-15), 0.0)]
    mean = 4 * g / (7 * k)
    first = mpmath.acos((-2 * g / k - mean) / (mpmath.mpf("0.1") - mean)) / mpmath.sqrt(7 * k / 3)
    slack = answer.events[0]
    assert (slack.kind, slack.name) == ("slack", "s")
    assert abs(slack.time - first) <= slack.error + 1e-15


def test_a_hundred_masses_on_springs_swing_as_their_closed_form_says() -> None:
    """Fixed at one end: omega_k = 2 sin((2 k - 1) pi/(4 n + 2)), shapes sin((2 k - 1) i pi/(2 n + 1))."""
    count, pushed = 100, mpmath.mpf("0.25")
    scene = {
        "gravity": [0, 0],
        "bodies": {f"m{i}": {"mass": 1, "at": [i + 0.25 * (i == 1), 0]} for i in range(1, count + 1)},
        "connections": [
            {
                "kind": "spring",
                "a": f"m{i}",
                "b": f"m{i - 1}" if i > 1 else [0, 0],
                "stiffness": 1,
                "rest_length": 1,
            }
            for i in range(1, count + 1)
        ],
    }
    answer = solve_scene(read(scene), [7.0])
    frequencies = [mode.frequency for mode in answer.model.apart[0].modes]
    with mpmath.workdps(30):
        half = mpmath.pi / (2 * count + 1)
        assert frequencies == [
            pytest.approx(float(2 * mpmath.sin((2 * k - 1) * half / 2)), rel=1e-15) for k in range(1, count + 1)
        ]
        for i in (1, 4, 9):
            away = mpmath.fsum(
                4
                * pushed
                / (2 * count + 1)
                * mpmath.sin((2 * k - 1) * half)
                * mpmath.sin((2 * k - 1) * i * half)
                * mpmath.cos(14 * mpmath.sin((2 * k - 1) * half / 2))
                for k in range(1, count + 1)
            )
            place = column(answer, f"m{i}.position")
            assert abs(place.values[0, 0] - i - away) <= place.error


@pytest.mark.parametrize("stiffness", ["4", "3", "2/7"])
def test_critical_damping_lists_its_double_root(stiffness: str) -> None:
    (part,) = solve_scene(read(oscillator(f"2*sqrt({stiffness})", stiffness)), [1.0]).model.apart
    root = -math.sqrt(float(Fraction(stiffness)))
    assert np.array([mode[:2] for mode in part.modes]) == pytest.approx(np.array([(0.0, root), (0.0, root)]), rel=1e-15)


def test_a_double_root_stands_beside_others() -> None:
    # Two equal masses in a row with dampers in proportion: s^2 + c l s + l = 0 for l of [[2, -1], [-1, 1]].
    slow, fast = (3 - math.sqrt(5)) / 2, (3 + math.sqrt(5)) / 2
    share = "2/sqrt((3 + sqrt(5))/2)"
    scene = oscillator(share, "1")
    scene["bodies"]["n"] = {"mass": 1, "at": [4, 0]}  # type: ignore[index]
    scene["connections"] += [  # type: ignore[operator]
        {"kind": "spring", "a": "m", "b": "n", "stiffness": 1},
        {"kind": "damper", "a": "m", "b": "n", "coefficient": share},
    ]
    (part,) = solve_scene(read(scene), [1.0]).model.apart
    decay = slow / math.sqrt(fast)
    swings = (math.sqrt(slow - decay**2), -decay)
    expected = np.array([(0.0, -math.sqrt(fast)), (0.0, -math.sqrt(fast)), swings])
    assert np.array([mode[:2] for mode in part.modes]) == pytest.approx(expected, rel=1e-14)
