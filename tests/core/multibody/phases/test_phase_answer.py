"""What is answered about motions in phases: held connections beside friction, what rests, whether energy is kept."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mp

from core.multibody.solve import solve_scene
from tests.core.multibody.swings import Swing
from tests.core.multibody.worked_examples import column, read

SCENES = Path(__file__).parents[4] / "examples" / "scenes"
DISCS: dict[str, Any] = {
    "bodies": {
        "a": {"mass": 1, "inertia": 0.02, "radius": 0.2, "at": [-1, 0.1], "velocity": [3, 0]},
        "b": {"mass": 2.5, "inertia": 0.1, "radius": 0.3, "at": [0, 0]},
        "far": {"mass": 1, "at": [0, 5]},
    },
    "connections": [{"kind": "contact", "name": "hit", "a": "a", "b": "b", "restitution": 1}],
}


def test_block_slides_on_a_plank_with_a_damper_until_it_sticks() -> None:
    """The slider holds the plank's direction twice over, which is not seen beside places that are not exact.

    3 u' = F - k u with F = 0.4 m g, v' = -0.4 g, both together 5 u' = -k u: three exponentials, by hand.
    """
    scene = read(
        """{"gravity":[0,-9.81],"bodies":{"plank":{"mass":3,"inertia":1,"at":[0,0]},
        "block":{"mass":2,"at":[0,0],"velocity":[5,0]}},"connections":[
        {"kind":"slider","a":"plank","b":[0,0],"slope":0},
        {"kind":"damper","a":"plank","b":[-10,0],"coefficient":1.5},
        {"kind":"contact","name":"top","place":"block","on":{"at":"plank"},"friction":0.4}]}"""
    )
    times = np.linspace(0.0, 3.0, 13)
    answer = solve_scene(scene, times)
    with mpmath.workdps(30):
        drag, rate = mpmath.mpf("0.4") * 2 * mpmath.mpf("9.81"), mpmath.mpf("0.5")

        def alone(t: Any) -> Any:
            return drag / mpmath.mpf("1.5") * (1 - mpmath.exp(-rate * t))

        together = mpmath.findroot(lambda t: alone(t) - 5 + drag / 2 * t, 0.8)
        expected = [
            float(alone(t) if t < together else alone(together) * mpmath.exp(mpmath.mpf("-0.3") * (t - together)))
            for t in map(mpmath.mpf, times)
        ]
    (stick,) = answer.events
    assert (stick.kind, stick.name) == ("stick", "top")
    assert abs(stick.time - together) <= stick.error
    found = column(answer, "plank.velocity")
    assert np.max(np.abs(found.values[:, 0] - expected)) <= found.error + 1e-16
    assert answer.energy is not None
    assert not answer.energy.conserved


@pytest.mark.parametrize(("restitution", "kept"), [(1, True), (0.5, False)])
def test_energy_is_kept_if_no_impact_costs_any(restitution: float, kept: bool) -> None:
    scene = json.loads(json.dumps(DISCS))
    scene["connections"][0]["restitution"] = restitution
    answer = solve_scene(read(json.dumps(scene)), np.array([0.0, 1.0]))
    assert answer.energy is not None
    assert answer.energy.conserved is kept
    assert (answer.events[0].energy_loss == 0.0) is kept


def test_energy_is_not_kept_where_something_slides_with_friction() -> None:
    scene = """{"gravity":[0,-9.81],"bodies":{"p":{"mass":1,"at":[0,0],"velocity":[1,0]}},
    "connections":[{"kind":"contact","place":"p","on":{"at":[0,0]},"friction":%s}]}"""
    for friction, kept in (("0", True), ("0.1", False)):
        answer = solve_scene(read(scene % friction), np.array([0.0, 0.05]))
        assert answer.energy is not None
        assert answer.energy.conserved is kept


def test_what_an_impact_moves_is_not_said_to_rest() -> None:
    """After an oblique impact both discs move across their line at the start; nothing touches the far particle."""
    answer = solve_scene(read(json.dumps(DISCS)), np.array([0.0, 1.0]))
    assert np.all(column(answer, "b.velocity").values[-1] != 0.0)
    assert answer.model.noticed == (
        "at rest until 1 s: a.angle, b.angle",
        "constant throughout the motion: far.x, far.y",
    )


def test_a_bounce_of_microseconds_is_found_in_a_long_time() -> None:
    """A particle thrown up from 1.6e-11 m falls within 3 us, beside a pendulum that sets far longer steps.

    Newton's law for the particle on its guide and the angle of the bob, by mpmath's Taylor series.
    """
    scene = read(
        """{"gravity":[0,-9.81],"bodies":{"p":{"mass":1,"at":[0,1.6e-11],"velocity":[0,3.8e-6]},
        "bob":{"mass":1,"at":[3,0]}},"connections":[
        {"kind":"slider","a":"p","b":[0,0],"slope":{"degrees":90}},
        {"kind":"contact","name":"floor","place":"p","on":{"at":[0,0]},"restitution":0.5},
        {"kind":"rod","a":"bob","b":[2,0]},{"kind":"spring","a":"p","b":"bob","stiffness":3}]}"""
    )
    answer = solve_scene(scene, np.array([0.0, 0.14]))
    with mpmath.workdps(40):
        gravity, height, rate = mpmath.mpf("9.81"), mpmath.mpf("1.6e-11"), mpmath.mpf("3.8e-6")
        rest = mpmath.sqrt(9 + height**2)

        def slopes(_: Any, state: Any) -> list[Any]:
            y, turn, up, spin = state
            across, along = 2 + mpmath.cos(turn), mpmath.sin(turn) - y
            length = mpmath.sqrt(across**2 + along**2)
            pull = 3 * (length - rest) / length
            torque = pull * (across * mpmath.sin(turn) - along * mpmath.cos(turn))
            return [up, spin, pull * along - gravity, torque - gravity * mpmath.cos(turn)]

        motion = mpmath.odefun(slopes, 0, [height, 0, rate, 0])
        root = mpmath.findroot(lambda t: motion(t)[0], (2e-6, 3e-6))
    first = answer.events[0]
    assert (first.kind, first.name) == ("touch", "floor")
    assert abs(first.time - root) <= first.error


@pytest.mark.parametrize("speed", [1e-2, 1e-5, 1e-8])
def test_a_swing_meets_the_wall_it_came_from_just_before_its_period_ends(speed: float) -> None:
    swing = Swing(-speed)
    wall = {
        "kind": "contact",
        "place": "bob",
        "on": {"at": ["sin(0.5)", 0], "slope": {"degrees": 90}},
        "restitution": 1,
    }
    events = solve_scene(swing.scene(wall=wall), [10.0]).events
    with mp.workdps(40):
        # From the wall through the lowest place to the other side and back.
        once = 4 * swing.quarter - 2 * (swing.quarter - swing.phase(mp.mpf("0.5")))
        assert [event.kind for event in events] == ["touch"] * int(10 / once)
        for number, event in enumerate(events, 1):
            assert abs(number * once - event.time) <= event.error


def test_events_cost_as_much_as_they_are_however_late_the_horizon_is() -> None:
    question = json.loads((SCENES / "block-tips-over.json").read_text())
    scene = read({name: part for name, part in question.items() if name != "times"})
    early, late = (solve_scene(scene, [end]).events for end in (40.0, 4e6))
    # It rocks from corner to corner, ever less high, until it is not known whether it still lifts off.
    assert len(early) == 129
    assert late[:129] == early
    assert late[-1].kind == "grazing-contact"


@pytest.mark.parametrize("beside", [[], [{"kind": "contact", "place": "b", "on": {"at": [0, -9]}}]])
def test_what_ends_before_it_repeats_has_no_period(beside: list[dict[str, object]]) -> None:
    """A spring that shrinks to nothing ends the motion after half a period, a contact out of reach or not."""
    spring = {"kind": "spring", "a": "b", "b": [0, 0], "stiffness": 4, "rest_length": "0.5"}
    track = {"kind": "track", "place": "b", "on": {"at": [1, 0]}}
    scene = {"gravity": [0, 0], "bodies": {"b": {"mass": 1, "at": [1, 0]}}, "connections": [track, spring, *beside]}
    answer = solve_scene(read(scene), [0.5])
    assert [part.period for part in answer.model.apart] == [None]
    assert answer.period is None


@pytest.mark.parametrize(("speed", "repeats"), [(2.0, True), (5.5, False)])
def test_whether_a_period_is_reached_does_not_depend_on_how_far_is_asked(speed: float, repeats: bool) -> None:
    # Below sqrt(2 g l) the string stays taut; above, and below sqrt(4 g l), it is slack before the bob turns back.
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0, -1], "velocity": [speed, 0]}},
        "connections": [{"kind": "string", "through": ["bob", [0, 0]]}],
    }
    periods = [
        [part.period for part in solve_scene(read(scene), [time], ("trajectory", "equilibria")).model.apart]
        for time in (0.1, 10.0)
    ]
    assert periods[0] == periods[1]
    assert (periods[0][0] is not None) == repeats
