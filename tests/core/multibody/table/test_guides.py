"""Sliders and tracks with friction: closed forms of textbooks, and the plain engine.

References
----------
J. L. Meriam, L. G. Kraige, "Engineering Mechanics: Statics", chapter 6 (guides that jam, wedges).
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.errors import InvalidParameter, PlacesDisagree
from core.multibody.answer import SceneSolution
from core.multibody.solve import DEFAULT_OUTPUTS, solve_scene
from core.multibody.statics.thresholds import RestOf
from tests.core.multibody.worked_examples import column, force, read
from tests.oracles.plain_engine.comparison.comparing import compared
from tests.oracles.plain_engine.comparison.run import classes_of

Json = dict[str, Any]
G = 9.81
DOWN = [0, -G]


def block(**more: Any) -> Json:
    return {"mass": 2, "inertia": 0.02, "at": [0, 0], **more}


def slider(a: Any = "b", b: Any = (0, 0), **more: Any) -> Json:
    return {"kind": "slider", "name": "s", "a": a, "b": b if isinstance(b, str) else list(b), **more}


def ring(**more: Any) -> Json:
    return {"kind": "track", "name": "ring", "place": "b", "on": {"at": [0, 0], "radius": 1}, **more}


def pull(place: str, by: Any) -> Json:
    return {"kind": "force", "place": place, "force": by}


def answered(bodies: Json, connections: list[Json], end: float = 1.0, gravity: Any = DOWN) -> SceneSolution:
    scene = {"gravity": gravity, "bodies": bodies, "connections": connections}
    return solve_scene(read(scene), [0.0, end], DEFAULT_OUTPUTS)


@pytest.mark.parametrize("size", [{}, {"length": 0.4}, {"length": 0.4, "width": 0.1}])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_block_in_a_slot_stops_by_its_weight_across_the_slot(size: Json, angle: float) -> None:
    speed = [f"3*cos({angle})", f"3*sin({angle})"]
    answer = answered({"b": block(velocity=speed, angle=angle)}, [slider(slope=angle, friction=0.5, **size)])
    loss = G * (math.sin(angle) + 0.5 * math.cos(angle))
    stopped = answer.events[0]
    assert stopped.time == pytest.approx(3 / loss, abs=stopped.error + 1e-15)
    if angle == 0.0:
        assert column(answer, "b.position").values[-1, 0] == pytest.approx(4.5 / loss, abs=1e-14)
        assert force(answer, "s.friction") == pytest.approx(-0.5 * 2 * G, rel=1e-14)
        assert force(answer, "s.normal") == pytest.approx(2 * G, rel=1e-14)


@pytest.mark.parametrize(("arm", "gain"), [(0.79, 100 * (1 - 0.79 / 0.8) / 2), (0.81, 0.0)])
@pytest.mark.parametrize("sense", [1, -1])
def test_a_drawer_that_is_pulled_beside_its_middle_jams_where_friction_is_above_half_its_length_by_the_arm(
    arm: float, gain: float, sense: int
) -> None:
    """A pull P at an arm h presses both ends by P h/L: it moves by P (1 - 2 mu h/L), however large P is."""
    bodies = {"b": block(places={"p": [0, sense * arm]})}
    answer = answered(bodies, [slider(friction=0.25, length=0.4), pull("b.p", [100, 0])], gravity=[0, 0])
    assert column(answer, "b.velocity").values[-1, 0] == pytest.approx(gain, abs=1e-12)
    assert force(answer, "s.normal") == pytest.approx(200 * arm / 0.4, rel=1e-12)


def test_the_friction_at_which_a_drawer_jams_is_found() -> None:
    bodies = {"b": block(places={"p": [0, 0.8]})}
    scene = {"gravity": [0, 0], "bodies": bodies, "connections": [slider(friction=0.3, length=0.4)]}
    scene["connections"].append(pull("b.p", [100, 0]))
    (found,) = solve_scene(read(scene), (), [RestOf("/connections/0/friction", (0.1, 0.9))]).thresholds
    assert found.lower.value == pytest.approx(0.25, abs=1e-14)
    assert found.upper.value == 0.9
    assert found.upper.beyond is None


def test_a_wedge_under_a_guided_load_locks_itself_below_twice_its_angle_of_friction() -> None:
    """N = P/(cos a + mu sin a) holds the load P, the floor bears P and the weight w: tan(a - phi) = mu (1 + w/P)."""
    wedge = {"mass": 0.1, "at": [0, 0], "inertia": 1}
    load = {"mass": 5, "at": [0, 0.1], "inertia": 1}
    scene = {
        "gravity": DOWN,
        "let": {"angle": 0.3},
        "bodies": {"wedge": wedge, "load": load},
        "connections": [
            {"kind": "slider", "name": "floor", "a": "wedge", "b": [0, 0], "friction": 0.2},
            {"kind": "slider", "name": "guide", "a": "load", "b": [0, 0], "slope": {"degrees": 90}},
            {
                "kind": "track",
                "name": "slope",
                "place": "load",
                "on": {"at": "wedge.top", "slope": "angle"},
                "friction": 0.2,
            },
        ],
    }
    scene["bodies"]["wedge"]["places"] = {"top": [0, 0.1]}
    (found,) = solve_scene(read(scene), (), [RestOf("/let/angle", (0.1, 0.6))]).thresholds
    assert found.upper.value == pytest.approx(math.atan(0.2) + math.atan(0.2 * 1.02), abs=1e-14)


def test_a_bead_on_a_rough_ring_loses_speed_as_the_exponential_of_the_angle() -> None:
    """Without gravity v' = -mu v^2/r: v = v0/(1 + mu v0 t/r), as far along as log(1 + mu v0 t/r)/mu."""
    answer = answered({"b": {"mass": 1, "at": [1, 0], "velocity": [0, 5]}}, [ring(friction=0.3)], 2.0, [0, 0])
    angle = math.log(1 + 0.3 * 5 * 2) / 0.3
    assert column(answer, "b.position").values[-1] == pytest.approx([math.cos(angle), math.sin(angle)], abs=1e-9)


def test_a_bead_passes_from_the_inside_of_a_ring_to_the_outside() -> None:
    """At the top it presses inwards; the normal force changes its side where v^2 = g cos of the angle from above."""
    answer = answered({"b": {"mass": 1, "at": [0, 1], "velocity": [1, 0]}}, [ring(friction=1e-9)])
    cos = (1 + 2 * G) / (3 * G)
    released = next(event for event in answer.events if event.kind == "release")
    assert released.name == "ring.1"
    at = solve_scene(
        read(
            {"gravity": DOWN, "bodies": {"b": {"mass": 1, "at": [0, 1], "velocity": [1, 0]}}, "connections": [ring()]}
        ),
        [released.time],
    )
    assert column(at, "b.position").values[0, 1] == pytest.approx(cos, abs=1e-7)


CRANK = {
    "c": {
        "mass": 1,
        "inertia": 0.05,
        "at": [0.15, 0],
        "angular_velocity": 20,
        "places": {"o": [-0.15, 0], "p": [0.15, 0]},
    },
    "r": {"mass": 0.5, "inertia": 0.02, "at": [0.6, 0], "places": {"p": [-0.3, 0], "q": [0.3, 0]}},
    "b": {"mass": 1, "inertia": 0.01, "at": [0.9, 0]},
}
PINS = [
    {"kind": "pin", "a": "c.o", "b": [0, 0]},
    {"kind": "pin", "a": "c.p", "b": "r.p"},
    {"kind": "pin", "a": "r.q", "b": "b"},
]
CART = {
    "b": block(at=[0, 0.2], velocity=[1, 0]),
    "cart": {"mass": 3, "inertia": 0.3, "at": [0, 0], "angular_velocity": 0, "places": {"top": [0, 0.2]}},
}
BALL = {"mass": 1, "at": [-1, 0], "velocity": [3, 0]}
ARM = block(velocity=[3, 0], places={"p": [0.3, 0.2]})
TURNED = block(at=[1000, 2], angle=0.7, velocity=["3*cos(0.7)", "3*sin(0.7)"], places={"p": [0.3, 0.2]})
SCENES: dict[str, tuple[Json, list[Json]]] = {
    "pushed across": ({"b": ARM}, [slider(friction=0.2, length=0.4, width=0.1), pull("b.p", [0, "60*sin(3*t)"])]),
    "turned and moved": (
        {"b": TURNED},
        [slider(b=(1000, 2), slope=0.7, friction=0.2, length=0.4, width=0.1), pull("b.p", [0, "60*sin(3*t)"])],
    ),
    "crank and piston": (CRANK, [*PINS, slider(friction=0.1, length=0.2, width=0.1)]),
    "on a body that turns": (
        CART,
        [
            slider(b="cart.top", friction=0.2, length=0.3),
            {"kind": "pin", "a": "cart", "b": [0, 0]},
            {"kind": "torsion-spring", "a": "cart", "b": "ground", "stiffness": 5},
        ],
    ),
    "a rod in a fixed sleeve": (
        {"b": block(at=[0.2, 0], velocity=[1, 0])},
        [slider((0, 0), "b", friction=0.3, length=0.2)],
    ),
    "struck along": (
        {"b": block(radius=0.1, velocity=[0, 0]), "ball": BALL},
        [
            slider(friction=0.3, length=0.3),
            {"kind": "track", "place": "ball", "on": {"at": [0, 0]}},
            {"kind": "contact", "a": "ball", "b": "b", "restitution": 0.5},
        ],
    ),
    "struck askew": (
        {"b": block(radius=0.1, velocity=[0, 0]), "ball": BALL | {"at": [0.02, 1], "velocity": [1, -3]}},
        [slider(friction=0.3, length=0.3), {"kind": "contact", "a": "ball", "b": "b", "restitution": 0.5}],
    ),
    "twins": (
        {"b": block(velocity=[3, 0]), "c": block(at=[0, 5], velocity=[3, 0])},
        [
            slider(friction=0.2, length=0.3),
            slider("c", (0, 5), friction=0.2, length=0.3) | {"name": "s2"},
            {"kind": "spring", "a": "b", "b": "c", "stiffness": 3},
        ],
    ),
    "static above kinetic": (
        {"b": block(at=[0.3, 0])},
        [
            slider(friction=[0.3, 0.2]),
            {"kind": "spring", "a": "b", "b": [-1, 0], "stiffness": 200, "rest_length": 1},
        ],
    ),
    "drawn by a string": (
        {"b": block(), "m": {"mass": 3, "at": [2, -1]}},
        [
            slider(friction=0.2, length=0.4, width=0.1),
            {"kind": "string", "through": ["b", [2, 0], "m"], "restitution": 0},
        ],
    ),
    "bead on a ring": ({"b": {"mass": 1, "at": [0, -1], "velocity": [5, 0]}}, [ring(friction=[0.3, 0.2])]),
    "bead on a rod that turns": (
        {
            "r": {"mass": 1, "inertia": 0.3, "at": [0, 0], "angular_velocity": 2},
            "b": {"mass": 0.5, "at": [0.3, 0], "velocity": [0, 0.6]},
        },
        [
            {"kind": "pin", "a": "r", "b": [0, 0]},
            {"kind": "track", "place": "b", "on": {"at": "r"}, "friction": 0.3},
        ],
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_guides_move_as_the_plain_engine_says(name: str) -> None:
    bodies, connections = SCENES[name]
    verdict = compared({"gravity": DOWN, "bodies": bodies, "connections": connections}, [0.0, 0.2, 0.55])
    assert classes_of(verdict) == "", verdict.differences
    assert verdict.compared > 0


@pytest.mark.parametrize(
    ("connection", "field"),
    [
        (slider(friction=-0.1), "friction"),
        (slider(friction=[0.1, 0.2]), "friction"),
        (slider(friction=0.1, drive="t"), "friction"),
        (slider(friction=0.1, width=0.1), "width"),
        (slider(friction=0.1, length=0), "length"),
        (slider(length=0.1), "length"),
        (ring(friction=0.1) | {"on": {"at": [0, 0], "curvature": 1}}, "on"),
    ],
)
def test_what_no_guide_can_be_is_refused(connection: Json, field: str) -> None:
    with pytest.raises(InvalidParameter) as refused:
        answered({"b": block(at=[0, 0])}, [connection])
    assert refused.value.path[2] == field


def test_friction_is_refused_in_space_and_velocities_that_a_guide_does_not_allow_are() -> None:
    bodies = {"b": {"mass": 1, "at": [0, 0, 0]}}
    track = {"kind": "track", "place": "b", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.1}
    with pytest.raises(InvalidParameter) as refused:
        answered(bodies, [track], gravity=[0, 0, -G])
    assert refused.value.path == ("connections", 0, "friction")
    with pytest.raises(InvalidParameter):
        answered({"b": block(velocity=[0, 1])}, [slider(friction=0.1)])
    with pytest.raises(PlacesDisagree):
        answered({"b": block(at=[0, 0.1])}, [slider(friction=0.1)])
