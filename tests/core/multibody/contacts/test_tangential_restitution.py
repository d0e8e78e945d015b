"""Impacts that turn a slip back: superballs, against closed forms and the plain engine.

With J = k m R^2 the impulse along the face that leaves -e_t u of a slip u = v + R w is -(1 + e_t) u m k/(1 + k), as
long as that is at most the friction of the impulse across it (R. L. Garwin, "Kinematics of an ultraelastic rough
ball", American Journal of Physics 37 (1969); R. Cross, "Grip-slip behavior of a bouncing ball", ibid. 70 (2002)).
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read
from tests.oracles.plain_engine.comparison.comparing import compared

G = 9.81


def dropped(dimension: int = 2, **contact: Any) -> dict[str, Any]:
    """Return a ball of 1 kg and 0.1 m that falls by 0.4 m onto a floor with the slip 1 + 0.1 x 3 m/s."""
    ball = {"mass": 1, "radius": 0.1}
    floor: dict[str, Any] = {"kind": "contact", "name": "f", "place": "b"} | contact
    if dimension == 2:
        ball |= {"inertia": 0.004, "at": [0, 0.5], "velocity": [1, 0], "angular_velocity": 3}
        floor["on"] = {"at": [0, 0]}
        return {"gravity": [0, -G], "bodies": {"b": ball}, "connections": [floor]}
    # The same in the vertical plane through x and z.
    ball |= {"moments": [0.004] * 3, "at": [0, 0, 0.5], "velocity": [1, 0, 0], "angular_velocity": [0, -3, 0]}
    floor["on"] = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    return {"gravity": [0, 0, -G], "bodies": {"b": ball}, "connections": [floor]}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("e", "back", "mu"), [(1, 1, 5), (0.8, 0.6, 2), (0.8, 0, 2), (0.8, 0.6, 0.05), (0, 0.5, 9)])
def test_a_superball_bounces_as_in_closed_form(dimension: int, e: float, back: float, mu: float) -> None:
    scene = dropped(dimension, restitution=e, tangential_restitution=back, friction=mu)
    answer = solve_scene(read(scene), [0.3], ["trajectory"])
    event = answer.events[0]
    push = (1 + e) * math.sqrt(2 * G * 0.4)
    rub = -min((1 + back) * 1.3 * 0.4 / 1.4, mu * push)
    assert event.time == pytest.approx(math.sqrt(0.8 / G), rel=1e-14)
    assert event.impulses["normal"] == pytest.approx(push, rel=1e-13)
    assert event.impulses["friction" if dimension == 2 else "friction.x"] == pytest.approx(rub, rel=1e-13)
    if e > 0:
        assert column(answer, "b.velocity").values[0][0] == pytest.approx(1 + rub, rel=1e-13)
        name = "b.angular_velocity" if dimension == 2 else "b.angular_velocity_in_space"
        spin = column(answer, name).values[0]
        assert (spin if dimension == 2 else -spin[1]) == pytest.approx(3 + 0.1 * rub / 0.004, rel=1e-13)
    if e == back == 1:
        assert event.energy_loss == pytest.approx(0, abs=1e-14)


def test_a_superball_between_two_walls_comes_back() -> None:
    """Thrown under a table it returns after three bounces: its slip turns back at each of them."""
    scene = dropped(restitution=1, tangential_restitution=1, friction=9)
    del scene["gravity"]
    scene["bodies"]["b"] |= {"at": [0, 0.5], "velocity": [3, -1], "angular_velocity": 0}
    floor = scene["connections"][0]
    scene["connections"].append(floor | {"name": "table", "on": {"at": [0, 1], "slope": "pi"}})
    answer = solve_scene(read(scene), [2.4], ["trajectory"])
    assert [event.name for event in answer.events] == ["f", "table", "f"]
    # Each bounce adds -2 u k/(1 + k) to v, and that over k R to w.
    v, w, side = 3.0, 0.0, 1
    for _ in range(3):
        rub = -2 * (v + side * 0.1 * w) * 0.4 / 1.4
        v, w, side = v + rub, w + side * rub / (0.4 * 0.1), -side
    assert v < 0
    assert column(answer, "b.velocity").values[0][0] == pytest.approx(v, rel=1e-13)
    assert column(answer, "b.angular_velocity").values[0] == pytest.approx(w, rel=1e-13)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("mu", [2, 0.05])
def test_the_plain_engine_agrees(dimension: int, mu: float) -> None:
    scene = dropped(dimension, restitution=0.7, tangential_restitution=0.4, friction=mu)
    verdict = compared(scene, [0.0, 0.3, 0.5])
    assert verdict.differences == []
    assert not verdict.not_supported
    assert verdict.compared > 0


@pytest.mark.parametrize(
    "changes",
    [{"tangential_restitution": -0.1}, {"tangential_restitution": 1.1}, {"friction": 0}, {"impacts": "poisson"}],
)
def test_faults_name_the_field(changes: dict[str, Any]) -> None:
    with pytest.raises(InvalidParameter) as caught:
        solve_scene(read(dropped(**{"tangential_restitution": 0.5, "friction": 1, **changes})), [1.0])
    assert caught.value.path == ("connections", 0, "tangential_restitution")
