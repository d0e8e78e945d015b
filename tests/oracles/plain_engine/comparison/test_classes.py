"""Classes of scenes in which answers were once wrong or refused: each is varied, and both engines have to agree.

Where a time or a value is known by hand, it is beside the comparison.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from tests.oracles.plain_engine.comparison.comparing import compared
from tests.oracles.plain_engine.comparison.run import classes_of

Json = dict[str, Any]
DOWN = [0, -10]


def agree(bodies: Json, connections: list[Json], times: list[float], gravity: Any = DOWN) -> None:
    """Fail where the two engines differ, or the plain one has no answer."""
    verdict = compared({"gravity": gravity, "bodies": bodies, "connections": connections}, [0.0, *times])
    assert classes_of(verdict) == "", verdict.differences
    assert verdict.compared > 0


def events(bodies: Json, connections: list[Json], times: list[float], gravity: Any = DOWN) -> list[tuple[str, float]]:
    scene = scene_from({"gravity": gravity, "bodies": bodies, "connections": connections})
    return [(event.kind, event.time) for event in solve_scene(scene, times).events]


def wall(name: str, place: str, x: float = 0, degrees: int = 90, **law: Any) -> Json:
    on = {"at": [x, 0], "slope": {"degrees": degrees}}
    return {"kind": "contact", "name": name, "place": place, "on": on, **law}


def floor(name: str, place: str, **law: Any) -> Json:
    return {"kind": "contact", "name": name, "place": place, "on": {"at": [0, 0]}, **law}


def ladder(m: float, inertia: Any, x: float, y: float, angle: str) -> Json:
    return {"mass": m, "inertia": inertia, "at": [x, y], "angle": angle, "places": {"f": [-0.5, 0], "h": [0.5, 0]}}


@pytest.mark.parametrize(("stiffness", "friction"), [(10, 0.3), (20, 0.3), (40, 0.4)])
def test_loads_shared_under_friction_stick_while_some_share_allows_it(stiffness: float, friction: float) -> None:
    bodies = {
        "l": ladder(1, "1/12", -0.14, 0.48, "acos(0.28)"),
        "m": {"mass": 1000, "at": [-1.14, 0.48], "velocity": [-1, 0]},
    }
    connections = [
        floor("floor", "l.f", friction=friction),
        wall("wall", "l.h", friction=friction),
        {"kind": "track", "place": "m", "on": {"at": [0, 0.48]}},
        {"kind": "spring", "a": "l", "b": "m", "stiffness": stiffness},
    ]
    agree(bodies, connections, [0.2, 0.4])
    if stiffness == 10 and friction == 0.3:
        # Moments about the foot: the pull P of the spring at the middle and the weight leave nothing for the wall at
        # P = 10 * 0.14/0.48 = 35/12 N, which the heavy mass on its track reaches with sin(w t) = 35/12 * w/10.
        w = math.sqrt(10 / 1000)
        first = next(time for kind, time in events(bodies, connections, [0.4]))
        assert first == pytest.approx(math.asin(35 / 120 * w) / w, abs=1e-9)


@pytest.mark.parametrize("last", [0.36, 0.41])
def test_an_event_before_a_singular_end_is_there_whatever_is_asked(last: float) -> None:
    bodies = {
        "v": {"mass": 1, "at": [0, -1], "velocity": ["sqrt(35)", 0]},
        "m": {"mass": 1, "at": [3.5, 0]},
    }
    connections = [
        {"kind": "contact", "name": "loop", "place": "v", "on": {"at": [0, 0], "radius": -1}},
        {"kind": "track", "place": "m", "on": {"at": [3, 0]}},
        {"kind": "inverse-square", "a": [3, 0], "b": "m", "strength": 1.5},
        {"kind": "spring", "a": "m", "b": "v", "stiffness": 5},
    ]
    kind, time = events(bodies, connections, [0.35, last])[0]
    assert (kind, time) == ("lift-off", pytest.approx(0.348613292669, abs=1e-11))
    agree(bodies, connections, [0.2, last])


@pytest.mark.parametrize("restitution", [0, 0.5, 1])
def test_events_at_one_instant_in_parts_that_share_nothing(restitution: float) -> None:
    law = {"restitution": restitution}
    bodies: Json = {}
    connections: list[Json] = []
    for k, x in enumerate((0, 5)):
        bodies[f"p{k}"] = {"mass": 1, "at": [x + 0.6, -0.8]}
        connections += [{"kind": "rod", "a": f"p{k}", "b": [x, 0]}, wall(f"wall{k}", f"p{k}", x, -90, **law)]
    agree(bodies, connections, [0.4, 0.8])
    balls = {f"b{k}": {"mass": k + 1, "at": [10 + k, 0.2]} for k in range(2)} | {"p": {"mass": 1, "at": [20.6, -0.8]}}
    falls = [floor(f"floor{k}", f"b{k}", **law) for k in range(2)]
    agree(balls, [*falls, {"kind": "rod", "a": "p", "b": [20, 0]}], [0.15, 0.5])
    stones = {f"s{k}": {"mass": 1, "at": [3 * k + 0.3, -0.4]} for k in range(2)}
    cords = [
        {"kind": "string", "name": f"cord{k}", "through": [f"s{k}", [3 * k, 0]], "length": 1, **law} for k in range(2)
    ]
    agree(stones, cords, [0.2, 0.6])


@pytest.mark.parametrize("law", [{}, {"friction": 0.1}])
@pytest.mark.parametrize("tie", ["string", "rod", "gravitation", "damper"])
def test_what_vanishes_for_ever_between_two_equal_stones(law: Json, tie: str) -> None:
    """Two stones slide down two equal humps at once: what joins them carries nothing, and both leave at one time."""
    bodies = {f"s{k}": {"mass": 1, "at": [5 * k + 0.6, 0.8]} for k in range(2)}
    humps: list[Json] = [
        {"kind": "contact", "name": f"hump{k}", "place": f"s{k}", "on": {"at": [5 * k, 0], "radius": 1}, **law}
        for k in range(2)
    ]
    between: Json = {"a": "s0", "b": "s1"} | {
        "string": {"kind": "string", "through": ["s0", "s1"]},
        "gravitation": {"kind": "gravitation", "constant": 2},
        "damper": {"kind": "damper", "coefficient": 2},
    }.get(tie, {"kind": "rod"})
    if tie == "string":
        between = {"kind": "string", "through": ["s0", "s1"]}
    agree(bodies, [*humps, between], [0.1, 0.25])
    if not law and tie in ("string", "rod", "damper"):
        # v^2 = 2 g (0.8 - cos) and cos = v^2/g where they leave: at 2/3 of the height at which they began.
        leaves = [time for kind, time in events(bodies, [*humps, between], [0.25]) if kind == "lift-off"]
        alone = [time for kind, time in events({"s0": bodies["s0"]}, humps[:1], [0.25]) if kind == "lift-off"]
        assert leaves == pytest.approx(alone * 2, abs=1e-12)


@pytest.mark.parametrize("direction", [[0.6, 0.8, 0], [1, 1, 1], [0.36, 0.48, 0.8], [0, 0.6, -0.8], [1, 0, 0]])
def test_lines_in_any_direction_of_space(direction: list[float]) -> None:
    body = {"mass": 1, "moments": [0.1, 0.2, 0.15], "at": [0, 0, 0], "places": {"p": [0.5, 0, 0]}}
    track = {"kind": "track", "name": "line", "place": "b.p", "on": {"at": [0.5, 0, 0], "direction": direction}}
    agree({"b": body}, [track], [0.2, 0.5], [0, 0, -10])


@pytest.mark.parametrize(("stiffness", "again"), [(10, False), (10, True), (40, True)])
def test_redundant_rows_beside_a_string_that_becomes_taut(stiffness: float, *, again: bool) -> None:
    bodies = {
        "a": {"mass": 1, "inertia": 0.02, "radius": 0.2, "at": [0, 0], "places": {"p": [0, 0.1]}},
        "b": {"mass": 2, "inertia": 0.04, "radius": 0.3, "at": [0.5, 0]},
        "s": {"mass": 1, "at": [0, 1], "velocity": [1, 0]},
    }
    connections = [
        {"kind": "pin", "name": "axle-a", "a": "a", "b": [0, 0]},
        {"kind": "pin", "name": "axle-b", "a": "b", "b": [0.5, 0]},
        {"kind": "rolling", "name": "mesh", "a": "a", "b": "b"},
        {"kind": "string", "name": "cord", "through": ["s", [0, 2]], "length": 1.1},
        {"kind": "spring", "name": "pull", "a": "s", "b": "a.p", "stiffness": stiffness},
    ]
    agree(bodies, connections + [{**connections[0], "name": "again"}] * again, [0.1, 0.4])


@pytest.mark.parametrize("inertia", [0.05, 0.1, 0.4])
def test_a_ladder_with_one_rough_end_slides_and_leaves_the_wall(inertia: Any) -> None:
    body = ladder(1, inertia, -0.3, 0.4, "atan(4/3)")
    connections = [floor("floor", "l.f"), wall("wall", "l.h", friction=0.5)]
    agree({"l": body}, connections, [0.2, 0.4])


@pytest.mark.parametrize(("restitution", "rate"), [(0, 2), (0.5, 2), (1, 2), (0.5, "2 + t")])
def test_what_a_motor_strikes(restitution: float, rate: Any) -> None:
    bodies = {
        "c": {"mass": 1, "inertia": 0.1, "at": [0, 0], "angular_velocity": 2},
        "m": {"mass": 1, "at": [1, 0.5], "velocity": [0, 0]},
    }
    connections = [
        {"kind": "pin", "a": "c", "b": [0, 0]},
        {"kind": "motor", "a": "c", "rate": rate},
        {"kind": "contact", "name": "paddle", "place": "m", "on": {"at": "c"}, "restitution": restitution},
    ]
    agree(bodies, connections, [0.2, 1], [0, 0])


@pytest.mark.parametrize("by", ["t/2", "-t^2", "sin(5*t)/4", "(cos(6*t) - 1)/5"])
@pytest.mark.parametrize("restitution", [0, 0.5])
def test_what_lands_on_a_support_that_moves(by: str, restitution: float) -> None:
    bodies = {"lift": {"mass": 1, "at": [0, -1]}, "p": {"mass": 2, "at": [0, -0.8]}}
    connections = [
        {"kind": "slider", "a": "p", "b": [0, 0], "slope": {"degrees": 90}},
        {"kind": "pin", "name": "hold", "a": "lift", "b": ["0", f"{by} - 1"]},
        {"kind": "contact", "name": "top", "place": "p", "on": {"at": "lift"}, "restitution": restitution},
    ]
    agree(bodies, connections, [0.1, 0.4])


def test_a_weight_that_reaches_its_drum_or_its_peg() -> None:
    drum = {
        "a": {"mass": 1, "at": [-0.1, -1]},
        "b": {"mass": 2, "at": [0.1, -1]},
        "w": {"mass": 0.5, "radius": 0.1, "inertia": 0.0025, "at": [0, 0]},
        "ball": {"mass": 1, "at": [3, 0.2]},
        "bob": {"mass": 1, "at": [5.6, -0.8]},
    }
    axle = {"kind": "pin", "a": "w", "b": [0, 0]}
    string = {"kind": "string", "name": "s", "through": ["a", "w", "b"], "sides": {"w": ["left", "right"]}}
    beside = [floor("floor", "ball", restitution=0.5), {"kind": "rod", "a": "bob", "b": [5, 0]}]
    agree(drum, [axle, string, *beside], [0.3, 1])
    # The rope runs from its side of the drum: the weight is there after 1 m with g/3.25.
    scene = scene_from({"gravity": DOWN, "bodies": drum, "connections": [axle, string, *beside]})
    ended = solve_scene(scene, [1.0]).ended
    assert ended is not None
    assert ended.time == pytest.approx(math.sqrt(2 * 3.25 / 10), abs=1e-9)
    thrown = {"p": {"mass": 1, "at": [0, -0.5], "velocity": [0, 5]}, "q": {"mass": 3, "at": [0.5, -1]}}
    over = {"kind": "string", "name": "cord", "through": ["p", [0, 0], [0.5, 0], "q"]}
    agree(thrown, [over], [0.05, 0.3])


@pytest.mark.parametrize("speed", [0, 1])
@pytest.mark.parametrize("count", [3, 4])
def test_a_bar_on_several_places_rests_slides_and_stops(speed: float, count: int) -> None:
    feet = {f"f{k}": [-0.6 + 1.2 * k / (count - 1), -0.1] for k in range(count)}
    bar = {"mass": 2, "inertia": 0.3, "at": [0, 0.1], "velocity": [speed, 0], "angular_velocity": 0, "places": feet}
    agree({"bar": bar}, [floor(f"on-{k}", f"bar.{k}", friction=0.3) for k in feet], [0.2, 0.5])


@pytest.mark.parametrize("velocity", [[0, 0, 0], [0.6, 0.8, 0]])
def test_a_table_on_four_legs_rests_slides_and_stops(velocity: list[float]) -> None:
    legs = {f"f{k}": [0.5 * (-1) ** k, 0.3 * (-1) ** (k // 2), -0.5] for k in range(4)}
    table = {"mass": 10, "moments": [1, 1.5, 2], "at": [0, 0, 0.5], "velocity": velocity, "places": legs}
    table["angular_velocity"] = [0, 0, 0]
    contacts = [
        {"kind": "contact", "name": k, "place": f"t.{k}", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.3}
        for k in legs
    ]
    agree({"t": table}, contacts, [0.2, 0.5], [0, 0, -10])


def tackle_and_plank(*, turned_round: bool) -> tuple[Json, list[Json]]:
    bodies = {
        "plank": {"mass": 1, "at": [0, 0], "velocity": [0, 0]},
        "block": {"mass": 0.5, "at": [0, 0], "velocity": [1, 0]},
        "load": {"mass": 1, "at": [5, -1]},
        "weight": {"mass": 1, "at": [5.4, -0.8]},
    }
    connections = [
        floor("floor", "plank"),
        {"kind": "contact", "name": "top", "place": "block", "on": {"at": "plank"}, "friction": 0.1},
        {"kind": "string", "name": "rope", "through": [[5, 0], "load", [5.2, 0], [5.4, 0], "weight"]},
        {"kind": "damper", "a": "block", "b": "load", "coefficient": 2},
    ]
    return bodies, connections[::-1] if turned_round else connections


@pytest.mark.parametrize("turned_round", [False, True])
def test_whether_something_begins_to_slide_depends_on_what_others_do_later(*, turned_round: bool) -> None:
    """At the limit of friction its rate decides, and that is other while the rope of the load beyond holds."""
    agree(*tackle_and_plank(turned_round=turned_round), [0.36, 0.8], [0, -9.81])


@pytest.mark.parametrize("friction", [0.3, 0.75])
def test_a_point_in_a_hollow_sticks_and_does_not_roll(friction: float) -> None:
    body = {"mass": 1, "at": ["0.6", "-0.8"], "velocity": ["-2*0.8", "-2*0.6"]}
    hollow = {"kind": "contact", "name": "bowl", "place": "p", "on": {"at": [0, 0], "radius": -1}, "friction": friction}
    agree({"p": body}, [hollow], [0.3, 1])


@pytest.mark.parametrize("x", [0, 0.3, 1000])
@pytest.mark.parametrize("field", [["-sin(x) - vx*t", "-vy/3"], ["-vx*t", "-vy*t"]])
def test_a_level_bar_that_lands_in_a_field(x: float, field: list[str]) -> None:
    """Where it lands at the origin, rounding leaves 1e-30 m of its place: the length of the bar is its scale."""
    bar = {"mass": 1, "inertia": "1/3", "at": [x, 0.2], "velocity": [0, 0], "angular_velocity": 0}
    bar["places"] = {"l": [-1, 0], "r": [1, 0]}
    acts = {"kind": "field", "name": "field", "acceleration": field}
    agree({"bar": bar}, [*(floor(f"on-{k}", f"bar.{k}") for k in "lr"), acts], [0.1, 0.4])


def test_a_level_table_that_lands_in_a_field() -> None:
    legs = {f"f{k}": [0.5 * (-1) ** k, 0.3 * (-1) ** (k // 2), 0] for k in range(4)}
    table = {"mass": 10, "moments": [1, 1.5, 2], "at": [0, 0, 0.2], "velocity": [0, 0, 0], "places": legs}
    table["angular_velocity"] = [0, 0, 0]
    on = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    contacts = [{"kind": "contact", "name": k, "place": f"t.{k}", "on": on} for k in legs]
    field = {"kind": "field", "name": "field", "acceleration": ["-sin(x) - vx*t", "-y", "-vz/3"]}
    agree({"t": table}, [*contacts, field], [0.1, 0.4], [0, 0, -10])
