"""Works and lengths of paths through events, by closed forms of their own and by the balance of energy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from mpmath import acos, mp, mpf, quad, sqrt

from core.errors import NotApplicable
from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from tests.core.multibody.contact_judge import any_scene
from tests.core.multibody.worked_examples import column as named
from tests.core.multibody.worked_examples import read

ALL = ["energy", "energy-in-time", "work-in-time", "paths-in-time"]
G = mpf("9.81")


def column(answer: SceneSolution, name: str) -> np.ndarray:
    return named(answer, name).values


def bouncing(restitution: Any = 0.8, **body: Any) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"ball": {"mass": 2, "at": [0, 1.25], **body}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0]}, "restitution": restitution}
        ],
    }


def require_balance(answer: SceneSolution) -> None:
    """Raise unless all works together are the change of kinetic energy."""
    assert answer.trajectory is not None
    kinetic = answer.trajectory.columns["energy.kinetic"]
    works = [one for name, one in answer.trajectory.columns.items() if name.endswith(".work")]
    assert answer.energy is not None
    left = kinetic.values - answer.energy.kinetic - sum(one.values for one in works)
    assert np.max(np.abs(left)) <= 2 * kinetic.error + sum(one.error for one in works)


def test_bounces_to_rest_cover_a_finite_path() -> None:
    """h (1 + e^2)/(1 - e^2), of which every bounce is one in the sum; the impacts take all that falls."""
    times = [0.4, 1.0, 3.0, 4.5, 4.55, 6.0]
    answer = solve_scene(read(bouncing()), times, ["trajectory", *ALL], 1e-12)
    path, taken = column(answer, "ball.path"), column(answer, "floor.impacts.work")
    assert path[-1] == pytest.approx(41 / 7.2, abs=named(answer, "ball.path").error)
    assert path[-2] == path[-1]
    assert taken[-1] == pytest.approx(-24.525, rel=1e-14)
    with mp.workdps(40):
        height, first = mpf("1.25"), sqrt(2 * mpf("1.25") / G)
        assert taken[0] == 0.0
        assert path[0] == pytest.approx(float(G * mpf("0.4") ** 2 / 2), rel=1e-14)
        # At 1 s the ball falls from its first bounce, 0.64 h high.
        assert taken[1] == pytest.approx(float(-2 * G * height * mpf("0.36")), rel=1e-14)
        since = mpf(1) - first - mpf("0.8") * first
        assert path[1] == pytest.approx(float(height + mpf("0.64") * height + G * since**2 / 2), rel=1e-14)
        # At 3 s it is in its 6th arc, among those that are listed; at 4.5 s among those that are summed up.
        for k in (2, 3):
            arcs, left = 0, mpf(str(times[k])) - first
            while left > 2 * first * mpf("0.8") ** (arcs + 1):
                arcs += 1
                left -= 2 * first * mpf("0.8") ** arcs
            speed = G * first * mpf("0.8") ** (arcs + 1)
            own = quad(lambda t, speed=speed: abs(speed - G * t), [0, min(left, speed / G), left])
            total = height + 2 * height * sum(mpf("0.64") ** n for n in range(1, arcs + 1)) + own
            assert path[k] == pytest.approx(float(total), rel=1e-13)
            assert taken[k] == pytest.approx(float(-2 * G * height * (1 - mpf("0.64") ** (arcs + 1))), rel=1e-13)
    require_balance(answer)


def test_bounces_on_the_way_have_the_path_of_parabolas() -> None:
    answer = solve_scene(read(bouncing(velocity=[1.5, 0])), [4.5, 6.0], ALL, 1e-12)
    with mp.workdps(30):
        first = sqrt(2 * mpf("1.25") / G)

        def arc(speed: Any, until: Any) -> Any:
            turn = min(speed / G, until)
            return quad(lambda t: sqrt(mpf("2.25") + (speed - G * t) ** 2), [0, turn, until])

        total, left = arc(mpf(0), first), 6 - first
        for n in range(1, 160):
            speed = G * first * mpf("0.8") ** n
            total += arc(speed, 2 * speed / G)
            left -= 2 * speed / G
        total += mpf("1.5") * left
        assert column(answer, "ball.path")[-1] == pytest.approx(float(total), rel=1e-13)
    require_balance(answer)


def test_slip_to_roll_takes_a_third_of_the_energy() -> None:
    """A disc that slides at v and ends rolling at 2v/3 loses m v^2/6, all by friction."""
    disc = {"mass": 1, "inertia": 0.005, "radius": 0.1, "at": [0, 0.1], "velocity": [3, 0]}
    floor = {"kind": "contact", "name": "floor", "place": "disc", "on": {"at": [0, 0]}, "friction": 0.2}
    answer = solve_scene(
        read({"gravity": [0, -9.81], "bodies": {"disc": disc}, "connections": [floor]}), [0.25, 1.0], ALL, 1e-12
    )
    rubbed = column(answer, "floor.friction.work")
    assert rubbed[1] == pytest.approx(-9 / 6, rel=1e-14)
    # The rim slips at v - 3 mu g t.
    with mp.workdps(30):
        pull = mpf("0.2") * G
        assert rubbed[0] == pytest.approx(float(-pull * (3 / mpf(4) - 3 * pull / 32)), rel=1e-14)
    assert column(answer, "floor.impacts.work").tolist() == [0.0, 0.0]
    require_balance(answer)


def test_friction_takes_its_coefficient_times_the_path() -> None:
    """Of a block on a spring: mu m g at every place, through four reversals, until it sticks."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"block": {"mass": 2, "at": [1, 0]}},
        "connections": [
            {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.1},
            {"kind": "spring", "name": "spring", "a": "block", "b": [-3, 0], "stiffness": 20, "rest_length": 3},
        ],
    }
    answer = solve_scene(read(scene), [0.3, 1.1, 2.3, 6.0], ALL, 1e-9)
    assert sum(event.kind in ("stick", "slip") for event in answer.events) >= 4
    path, rubbed = column(answer, "block.path"), column(answer, "floor.friction.work")
    assert rubbed == pytest.approx(-0.1 * 2 * 9.81 * path, rel=1e-13)
    # Every half swing is 2 mu m g/k shorter on either side of the middle: 2 (x0 - mu m g/k), and so on.
    dead = 0.1 * 2 * 9.81 / 20
    swings = [2 * (1 - (2 * n + 1) * dead) for n in range(20) if 1 - 2 * n * dead > dead]
    assert path[-1] == pytest.approx(sum(swings), rel=1e-12)
    require_balance(answer)


def test_a_stone_on_a_string_goes_through_an_arc_and_a_parabola() -> None:
    stone = {"mass": 1, "at": [0, -0.5], "velocity": [4, 0]}
    string = {"kind": "string", "name": "s", "through": ["stone", [0, 0]], "restitution": 0.5}
    scene = {"gravity": [0, -9.81], "bodies": {"stone": stone}, "connections": [string]}
    # Slack at 0.33986875327139788 s, taut at 0.87122732934228872 s.
    answer = solve_scene(read(scene), [0.6, 0.9], ALL, 1e-12)
    with mp.workdps(30):
        angle = acos((2 * G / 2 - 16) / (3 * G / 2))
        speed = sqrt(16 - G * (1 - mp.cos(angle)))
        late = mpf("0.6") - mpf("0.33986875327139788")
        across, up = speed * mp.cos(angle), speed * mp.sin(angle)
        parabola = quad(lambda t: sqrt(across**2 + (up - G * t) ** 2), mp.linspace(0, late, 9))
        assert column(answer, "stone.path")[0] == pytest.approx(float(angle / 2 + parabola), rel=1e-13)
    jerk = next(event for event in answer.events if event.kind == "taut")
    assert column(answer, "s.impacts.work").tolist() == pytest.approx([0.0, -jerk.energy_loss])
    require_balance(answer)


def test_impacts_at_one_time_share_their_loss() -> None:
    """Two balls on a floor, the upper falling onto the lower: its impulse works on both contacts, as u + u' says."""
    scene = {
        "gravity": [0, 0],
        "bodies": {
            "low": {"mass": 1, "radius": 0.1, "at": [0, 0.1]},
            "top": {"mass": 3, "radius": 0.1, "at": [0, 0.3], "velocity": [0, -2]},
        },
        "connections": [
            {"kind": "contact", "name": "floor", "place": "low", "on": {"at": [0, 0]}, "order": 2},
            {"kind": "contact", "name": "pair", "a": "top", "b": "low", "restitution": 0.5, "order": 1},
        ],
    }
    answer = solve_scene(read(scene), [0.0, 0.001], ALL, 1e-12)
    first = [event for event in answer.events if event.time == 0.0]
    assert {event.name for event in first} == {"floor", "pair"}
    kinetic = column(answer, "energy.kinetic")
    assert sum(event.energy_loss for event in first) == pytest.approx(6.0 - kinetic[0], rel=1e-14)
    for name in ("floor", "pair"):
        taken = sum(event.energy_loss for event in first if event.name == name)
        assert column(answer, f"{name}.impacts.work")[0] == pytest.approx(-taken, rel=1e-14)
    require_balance(answer)


@pytest.mark.parametrize("seed", [0, 1, 3, 6, 9, 12, 14, 20, 34, 85])
def test_all_works_are_the_change_of_kinetic_energy(seed: int) -> None:
    """Random scenes; 34 comes to rest by bounces that are alike in the limit only."""
    require_balance(solve_scene(read(any_scene(seed)), np.linspace(0.0, 2.0, 11), ALL, 1e-6))


def test_in_space_friction_takes_what_slip_and_push_say() -> None:
    """A stone on a plane, in the diagonal: mu m g times its way v^2/(2 mu g), all of its energy."""
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"stone": {"mass": 2, "at": [0, 0, 0], "velocity": [1, 2, 0]}},
        "connections": [
            {
                "kind": "contact",
                "name": "floor",
                "place": "stone",
                "on": {"at": [0, 0, 0], "normal": [0, 0, 1]},
                "friction": 0.3,
            }
        ],
    }
    answer = solve_scene(read(scene), [0.2, 2.0], ALL, 1e-12)
    assert column(answer, "floor.friction.work")[1] == pytest.approx(-5.0, rel=1e-14)
    assert column(answer, "stone.path")[1] == pytest.approx(5 / (2 * 0.3 * 9.81), rel=1e-14)
    require_balance(answer)


def test_what_drives_through_impacts_takes_a_share_that_is_not_answered() -> None:
    scene = bouncing(0.5, inertia=1)
    scene["bodies"]["wheel"] = {"mass": 1, "inertia": 1, "at": [5, 0]}
    scene["connections"] += [
        {"kind": "pin", "a": "wheel", "b": [5, 0]},
        {"kind": "motor", "a": "wheel", "rate": 2},
    ]
    apart = solve_scene(read(scene), [1.0], ["work-in-time"])
    assert apart.trajectory is not None
    assert apart.trajectory["motor-3.work"][0] == 0.0
    scene["connections"].append({"kind": "spring", "a": "ball", "b": "wheel", "stiffness": 1})
    with pytest.raises(NotApplicable, match="driven through impacts") as found:
        solve_scene(read(scene), [1.0], ["work-in-time"])
    assert found.value.remedy is not None


def test_impulses_that_could_be_shared_otherwise_have_no_work_of_their_own() -> None:
    """A rod that falls flat on a rough floor and sticks: which end takes how much of the friction is not determined."""
    rod = {"mass": 1, "inertia": 0.1, "at": [0, 1], "velocity": [0.1, 0], "places": {"l": [-0.5, 0], "r": [0.5, 0]}}
    ends = [
        {"kind": "contact", "name": end, "place": f"rod.{end}", "on": {"at": [0, 0]}, "friction": friction}
        for end, friction in (("l", 0.8), ("r", 0.9))
    ]
    scene = {"gravity": [0, -9.81], "bodies": {"rod": rod}, "connections": ends}
    answer = solve_scene(read(scene), [0.4, 0.6], ALL, 1e-9)
    assert answer.trajectory is not None
    assert {name for name in answer.trajectory.columns if name.endswith(".work")} == {
        "gravity.work",
        "l.friction.work",
        "r.friction.work",
    }
    assert sum(event.energy_loss for event in answer.events) == pytest.approx(9.81 + 0.005, rel=1e-14)
    ends[0]["friction"] = ends[1]["friction"] = 0  # Without friction each end takes half.
    require_balance(solve_scene(read(scene), [0.4, 0.6], ALL, 1e-9))


def test_the_path_of_a_stone_across_a_slope_is_what_friction_takes() -> None:
    """mu m g cos(a) times the path is what speed and height have lost, when the slip has ended at 0.69 s too."""
    stone = {"mass": 1, "at": [0, 0, 0], "velocity": [0, 2, 0]}
    on = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    slope = {"kind": "contact", "place": "stone", "on": on, "friction": 0.5}
    gravity = ["9.81*sin(0.3)", 0, "-9.81*cos(0.3)"]
    scene = read({"gravity": gravity, "bodies": {"stone": stone}, "connections": [slope]})
    answer = solve_scene(scene, [0.2, 0.5, 0.6914766235042755, 1.0], ["trajectory", "paths-in-time"])
    path, place, speed = (named(answer, f"stone.{name}") for name in ("path", "position", "velocity"))
    kinetic = 0.5 * np.sum(speed.values**2, axis=1)
    lost = 2.0 - kinetic + 9.81 * math.sin(0.3) * place.values[:, 0]
    assert 0.5 * 9.81 * math.cos(0.3) * path.values == pytest.approx(lost, rel=1e-14)
    assert path.error < 2e-15
