"""Contacts without friction: lift-off, touch, stops and slack strings, against Lagrange by hand and quadratures."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import InvalidParameter, NotApplicable
from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.systems.methods import RungeKutta4
from tests.core.multibody.worked_examples import column, force, read

LADDER = """{"gravity":[0,-9.81],"bodies":{"ladder":{"mass":10,"inertia":3.333333,"at":[-0.6,0.8],
"angle":0.9272952180016122,"places":{"foot":[-1,0],"head":[1,0]}}},"connections":[{"kind":"contact","name":"floor",
"place":"ladder.foot","on":{"at":[0,0]}},{"kind":"contact","name":"wall","place":"ladder.head",
"on":{"at":[0,0],"slope":{"degrees":90}}}]}"""

STONE = """{"gravity":[0,-9.81],"bodies":{"stone":{"mass":1,"at":[0,-0.5],"velocity":[4,0]}},"connections":[
{"kind":"string","name":"s","through":["stone",[0,0]]}]}"""


def kinds(answer: SceneSolution) -> list[tuple[str, str]]:
    return [(event.kind, event.name) for event in answer.events]


def states(answer: SceneSolution) -> list[dict[str, str]]:
    assert answer.phases is not None
    return [dict(phase.states) for phase in answer.phases]


def ladder_time(start: Any, length: Any, mass_ratio: Any) -> Any:
    """Return when a ladder leaves the wall: the angle with the vertical by energy, the time by quadrature.

    With I = m_r m l^2 about the centre and half length l: (1 + m_r) l phi'^2 = 2 g (cos phi_0 - cos phi), and the
    wall's force vanishes where cos phi = 2/3 cos phi_0.
    """
    end = mpmath.acos(2 * mpmath.cos(start) / 3)

    def slowness(u: Any) -> Any:
        # phi = phi_0 + u^2 takes the root away at the start.
        phi = start + u * u
        gain = 2 * mpmath.mpf("9.81") * (mpmath.cos(start) - mpmath.cos(phi)) / ((1 + mass_ratio) * length)
        return 2 * u / mpmath.sqrt(gain) if u else mpmath.mpf(0)

    def smooth(u: Any) -> Any:
        return slowness(u) if u > mpmath.mpf("1e-18") else slowness(mpmath.mpf("1e-18"))

    return mpmath.quad(smooth, mpmath.linspace(0, mpmath.sqrt(end - start), 5))


def test_ladder_leaves_the_wall() -> None:
    answer = solve_scene(read(LADDER), [0.0, 0.2, 0.5], ("forces", "trajectory", "forces-in-time", "energy-in-time"))
    assert kinds(answer) == [("lift-off", "wall")]
    assert states(answer) == [{"floor": "closed", "wall": "closed"}, {"floor": "closed", "wall": "open"}]
    with mpmath.workdps(40):
        start = mpmath.pi / 2 - mpmath.atan2(4, 3)
        ratio = mpmath.mpf("3.333333") / 10
        off = abs(answer.events[0].time - ladder_time(start, mpmath.mpf(1), ratio))
        # The written angle and places agree to 16 digits.
        assert off <= answer.events[0].error + 1e-15
    total = column(answer, "energy.kinetic").values + column(answer, "energy.potential").values
    assert total == pytest.approx([78.48] * 3, rel=1e-14)
    assert column(answer, "wall.normal").values[2] == 0.0


def test_ladder_of_three_metres() -> None:
    """Known figures: it leaves the wall at 0.58173830116164499 s, the floor then carries a quarter of the weight."""
    scene = {
        "gravity": [0, -9.81],
        "let": {"s": "1.5*sin(0.5)", "c": "1.5*cos(0.5)"},
        "bodies": {
            "ladder": {
                "mass": 4,
                "inertia": 3,
                "at": ["-s", "c"],
                "angle": "pi/2 - 0.5",
                "places": {"foot": [-1.5, 0], "head": [1.5, 0]},
            }
        },
        "connections": [
            {"kind": "contact", "name": "floor", "place": "ladder.foot", "on": {"at": [0, 0]}},
            {"kind": "contact", "name": "wall", "place": "ladder.head", "on": {"at": [0, 0], "normal": [-1, 0]}},
        ],
    }
    answer = solve_scene(read(scene), [0.58173830116164499], ("trajectory", "forces-in-time"))
    answer = solve_scene(read(scene), [0.5, 0.7], ("trajectory", "forces-in-time"))
    (event,) = answer.events
    assert abs(event.time - 0.58173830116164499) <= event.error < 2e-16
    at = solve_scene(read(scene), [event.time], ("trajectory", "forces-in-time"))
    assert column(at, "floor.normal").values == pytest.approx([4 * 9.81 / 4], rel=1e-13)
    angle = math.pi / 2 - column(at, "ladder.angle").values[0]
    assert angle == pytest.approx(0.94584840177325587, rel=1e-14)


def test_stone_on_a_string_becomes_slack_and_taut() -> None:
    """Slack where cos theta = (2 g l - v^2)/(3 g l), a parabola of 4 v sin theta/g, then the jerk takes v.u away."""
    answer = solve_scene(read(STONE), [0.1, 0.5, 0.9], ("trajectory", "forces-in-time", "energy-in-time"))
    assert kinds(answer) == [("slack", "s"), ("taut", "s")]
    slack, taut = answer.events
    assert abs(slack.time - 0.33986875327139788) <= slack.error < 2e-16
    assert abs(taut.time - 0.87122732934228872) <= taut.error < 2e-16
    g, r = 9.81, 0.5
    theta = 2.0049681313625003
    speed = math.sqrt(-g * r * math.cos(theta))
    flight = 4 * speed * math.sin(theta) / g
    x, y = r * math.sin(theta), -r * math.cos(theta)
    u, v = speed * math.cos(theta), speed * math.sin(theta)
    end = np.array([x + u * flight, y + v * flight - g * flight**2 / 2])
    jerk = np.array([u, v - g * flight]) @ end / r
    assert taut.impulses["normal"] == pytest.approx(jerk, rel=1e-13)
    assert taut.energy_loss == pytest.approx(jerk**2 / 2, rel=1e-13)
    assert column(answer, "s.tension").values[1] == 0.0
    total = column(answer, "energy.kinetic").values + column(answer, "energy.potential").values
    assert total[0] == pytest.approx(total[1], rel=1e-14)
    assert total[1] - total[2] == pytest.approx(taut.energy_loss, rel=1e-12)


def test_string_that_is_slack_at_the_start_becomes_taut() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 2, "at": [0, -1]}},
        "connections": [
            {"kind": "string", "name": "s", "through": ["p", [0, 0]], "length": 2, "restitution": 0.5},
        ],
    }
    answer = solve_scene(read(scene), [0.5])
    fall = math.sqrt(2 / 9.81)
    (event,) = answer.events
    assert (event.kind, event.time) == ("taut", pytest.approx(fall, rel=1e-15))
    assert event.impulses["normal"] == pytest.approx(2 * 1.5 * 9.81 * fall, rel=1e-15)
    assert event.energy_loss == pytest.approx(0.75 * 2 * 9.81, rel=1e-15)


def test_weight_on_a_drum_lands_and_its_string_becomes_slack() -> None:
    """The weight b falls 0.5 m with (2 - 1) g/(1 + 2 + I/R^2) and rests; a flies on and returns."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "a": {"mass": 1, "at": [-0.1, -2]},
            "b": {"mass": 2, "at": [0.1, -1]},
            "wheel": {"mass": 0.5, "radius": 0.1, "inertia": 0.0025, "at": [0, 0]},
        },
        "connections": [
            {"kind": "pin", "a": "wheel", "b": [0, 0]},
            {"kind": "string", "name": "s", "through": ["a", "wheel", "b"], "sides": {"wheel": ["left", "right"]}},
            {"kind": "contact", "name": "floor", "place": "b", "on": {"at": [0, -1.5]}},
        ],
    }
    answer = solve_scene(read(scene), [0.2, 0.9, 1.2])
    pull = 9.81 / 3.25
    landing = math.sqrt(1 / pull)
    assert kinds(answer)[:2] == [("touch", "floor"), ("slack", "s.2")]
    assert answer.events[0].time == pytest.approx(landing, rel=4e-16)
    # The wheel and a go on together, as a weight on one side.
    speed, back = pull * landing, 9.81 / 1.25
    assert answer.events[2].kind == "taut"
    assert answer.events[2].time == pytest.approx(landing + 2 * speed / back, rel=1e-15)
    assert column(answer, "b.position").values[1] == pytest.approx([0.1, -1.5], rel=1e-15)


def test_disc_leaves_the_top_of_a_smooth_cylinder() -> None:
    """It leaves where cos theta = 2/3 cos theta_0, and lands on a floor: energy, and a parabola."""
    scene = {
        "gravity": [0, -9.81],
        "let": {"x": "1.2*sin(0.2)", "y": "1.2*cos(0.2)"},
        "bodies": {"disc": {"mass": 3, "inertia": 0.06, "radius": 0.2, "at": ["x", "y"]}},
        "connections": [
            {"kind": "contact", "name": "top", "place": "disc", "on": {"at": [0, 0], "radius": 1}},
            {"kind": "contact", "name": "floor", "place": "disc", "on": {"at": [0, -1]}},
        ],
    }
    answer = solve_scene(read(scene), [0.5, 1.3])
    assert kinds(answer) == [("lift-off", "top"), ("touch", "floor")]
    at = solve_scene(read(scene), [answer.events[0].time])
    place = column(at, "disc.position").values[0]
    cosine = 2 * math.cos(0.2) / 3
    assert place == pytest.approx([1.2 * math.sqrt(1 - cosine**2), 1.2 * cosine], rel=1e-13)
    speed = math.sqrt(9.81 * 1.2 * cosine)
    down = speed * math.sqrt(1 - cosine**2)
    drop = 1.2 * cosine + 0.8
    flight = (math.sqrt(down**2 + 2 * 9.81 * drop) - down) / 9.81
    assert answer.events[1].time - answer.events[0].time == pytest.approx(flight, rel=1e-13)


def test_hinge_with_a_stop() -> None:
    """A rod that falls from the level onto a stop, without gravity's help beyond the energy: I w^2/2 = m g h."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"rod": {"mass": 2, "inertia": 0.5, "at": [0.5, 0], "places": {"top": [-0.5, 0]}}},
        "connections": [
            {"kind": "pin", "name": "h", "a": "rod.top", "b": [0, 0]},
            {"kind": "contact", "name": "stop", "measure": "turn", "a": "rod", "at_least": -1, "restitution": 0.5},
        ],
    }
    answer = solve_scene(read(scene), [0.1, 0.7])
    event = answer.events[0]
    assert (event.kind, event.name) == ("stop", "stop")
    inertia, fall = 1.0, 2 * 9.81 * 0.5 * math.sin(1)
    assert event.impulses["normal"] == pytest.approx(1.5 * math.sqrt(2 * fall * inertia), rel=1e-13)
    assert event.energy_loss == pytest.approx(0.75 * fall, rel=1e-13)
    with mpmath.workdps(30):
        k = mpmath.mpf("9.81") / 2 / (mpmath.mpf(1) / 2)

        def slowness(u: Any) -> Any:
            return 2 * u / mpmath.sqrt(2 * k * mpmath.sin(u * u)) if u else 2 / mpmath.sqrt(2 * k)

        # theta'^2 = 2 (m g a/I) sin theta with m a/I = 1
        first = mpmath.quad(slowness, [0, 0.5, 1])
    assert abs(event.time - first) <= event.error + 1e-15


def test_what_starts_apart_by_rounding_touches_and_is_told() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0, 1e-12]}, "q": {"mass": 1, "at": [5, 1]}},
        "connections": [{"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0], "slope": 0}}],
    }
    answer = solve_scene(read(scene))
    # A gap that is all there is of lengths is no rounding, however far from the origin.
    assert states(answer) == [{"floor": "open"}]
    scene["bodies"]["p"]["at"] = [0, 1.000000000001]
    scene["connections"][0]["on"]["at"] = [0, 1]
    assert states(solve_scene(read(scene))) == [{"floor": "open"}]
    scene["connections"][0]["on"]["at"] = [1, 1]
    answer = solve_scene(read(scene))
    assert states(answer) == [{"floor": "closed"}]
    assert any("floor" in sentence for sentence in answer.model.noticed)
    assert force(answer, "floor.normal") == pytest.approx(9.81, rel=1e-15)
    scene["bodies"]["p"]["at"] = [0, 0.9]
    with pytest.raises(InvalidParameter, match="overlap"):
        solve_scene(read(scene))


def test_a_slow_start_beside_an_equilibrium_of_a_spring() -> None:
    """A speed of 1e-5 tells nothing of the time in which the spring swings: 1.7 s for m = 1, k = 3.

    The point is thrown up and lands after 2 v/g but for the spring, whose pull of k v^2/g^2 is 1e-11 of its weight.
    """
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"q": {"mass": 1, "at": [1, 0], "velocity": [0, 1e-5]}},
        "connections": [
            {"kind": "contact", "name": "Q", "place": "q", "on": {"at": [0, 0]}},
            {"kind": "spring", "a": "q", "b": [0, -5], "stiffness": 3},
        ],
    }
    answer = solve_scene(read(scene), [0.14, 30.0])
    assert kinds(answer) == [("touch", "Q")]
    assert answer.events[0].time == pytest.approx(2e-5 / 9.81, rel=1e-5)
    found = column(answer, "q.position")
    # The flight leaves a motion along the floor far below the rounding of the place.
    assert found.values == pytest.approx(np.array([[1.0, 0.0], [1.0, 0.0]]), abs=1e-14)


def test_a_fixed_point_under_a_moving_face() -> None:
    """A plank on a nail beside its centre turns about it: N = m g I/(I + m a^2) at first."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"plank": {"mass": 2, "inertia": 0.5, "at": [0.3, 1]}},
        "connections": [
            {"kind": "contact", "name": "nail", "place": [0, 1], "on": {"at": "plank", "slope": {"degrees": 180}}}
        ],
    }
    answer = solve_scene(read(scene), [0.1])
    assert states(answer) == [{"nail": "closed"}]
    assert force(answer, "nail.normal") == pytest.approx(2 * 9.81 * 0.5 / (0.5 + 2 * 0.09), rel=1e-14)


@pytest.mark.parametrize(
    ("change", "where", "help"),
    [
        ({"place": [0, 0]}, "place", "name a body"),
        ({"restitution": 1.2}, "restitution", "1 is elastic"),
        ({"name": "wall"}, "name", '"wall-2"'),
    ],
)
def test_faults_have_remedies(change: dict[str, Any], where: str, help: str) -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0, 1]}},
        "connections": [
            {"kind": "contact", "name": "wall", "place": "p", "on": {"at": [-1, 0], "slope": {"degrees": -90}}},
            {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}, **change},
        ],
    }
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read(scene))
    assert fault.value.path == ("connections", 1, where)
    assert fault.value.remedy is not None
    assert help in fault.value.remedy


def test_what_is_not_answered_is_refused() -> None:
    with pytest.raises(NotApplicable) as still:
        solve_scene(read(LADDER), [0.1], ("equilibria",))
    assert still.value.remedy is not None
    assert "thresholds" in still.value.remedy
    with pytest.raises(NotApplicable):
        solve_scene(read(LADDER), [0.1], method=RungeKutta4(step=0.01))
    for missing, where, on in (
        ({"friction": 0.3}, "friction", {"at": "plate", "normal": [0, 0, 1]}),
        ({}, "on", {"at": [0, 0, 0], "slope": 0}),
    ):
        space = {
            "gravity": [0, 0, -9.81],
            "bodies": {"p": {"mass": 1, "at": [0, 0, 1]}, "plate": {"mass": 1, "moments": [1, 1, 1], "at": [0, 0, 0]}},
            "connections": [{"kind": "contact", "place": "p", "on": on, **missing}],
        }
        with pytest.raises(InvalidParameter) as spatial:
            solve_scene(read(space))
        assert spatial.value.path == ("connections", 0, where)
        assert spatial.value.remedy is not None


@pytest.mark.parametrize(
    ("connection", "rule"),
    [
        ({"kind": "rod", "a": "p", "b": [0, 0], "length": 0.4}, "be 0.5 m"),
        ({"kind": "string", "through": ["p", [0, 0]], "length": 0.4}, "be 0.5 m"),
        ({"kind": "string", "through": ["p", [0, 0]], "length": 0.4, "restitution": 0}, "be at least 0.5 m"),
        ({"kind": "string", "through": ["p", [0, 0], "q"], "length": 0.9, "restitution": 0}, "be at least 1 m"),
    ],
)
def test_a_length_that_does_not_fit_the_places_is_named(connection: dict[str, Any], rule: str) -> None:
    bodies = {"p": {"mass": 1, "at": [0.3, -0.4]}, "q": {"mass": 1, "at": [-0.3, -0.4]}}
    with pytest.raises(InvalidParameter, match=rule) as fault:
        solve_scene(read({"gravity": [0, -9.81], "bodies": bodies, "connections": [connection]}), [0.1])
    assert fault.value.path == ("connections", 0, "length")
    assert fault.value.remedy is not None
