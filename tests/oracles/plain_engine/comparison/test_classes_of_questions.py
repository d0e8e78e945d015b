"""Questions whose answers were once refused or incomplete at thresholds and zeros, each beside what is known by hand;
and three kinds of scenes whose events could not be told apart, varied beside the plain engine.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from mpmath import ellipk, mp, mpf

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from tests.oracles.plain_engine.comparison.comparing import compared
from tests.oracles.plain_engine.comparison.run import classes_of

Json = dict[str, Any]
ROD = {"kind": "rod", "a": "b", "b": [0, 0]}
AXES = ([1, 0, 0], [0, 0.6, 0.8], [0.6, 0.8, 0], [1, 1, 1], [0, 1, 0])
MOMENTS = (["1/10", "1/10", "1/10"], ["1/10", "2/10", "3/20"], ["1/12", "1/12", "1/100"])


def asked(
    bodies: Json, connections: list[Json], times: Any = (), outputs: Any = None, gravity: Any = (0, -9.81)
) -> Any:
    scene = scene_from({"gravity": list(gravity), "bodies": bodies, "connections": connections})
    return solve_scene(scene, list(times), outputs)


@pytest.mark.parametrize("rate", ["3.132091953", "3.1320929", "3.1321", "3.13212", "3.2"])
def test_the_lowest_place_is_unstable_as_soon_as_the_others_appear(rate: str) -> None:
    """Of a bead on a turning hoop: at cos = g/(R w^2), which is next to 1 just above the threshold."""
    frame = {"kind": "spinning-frame", "rate": rate}
    answer = asked({"b": {"mass": 1, "at": [0, -1]}}, [ROD, frame], outputs=("equilibria",))
    found = {(round(e.positions["b"][0], 12), round(e.positions["b"][1], 12)): e.stable for e in answer.equilibria}
    with mp.workdps(40):
        c = mpf("9.81") / mpf(rate) ** 2
        x, y = round(float(mp.sqrt(1 - c * c)), 12), -round(float(c), 12)
    assert found == {(0.0, -1.0): False, (x, y): True, (-x, y): True, (0.0, 1.0): False}


@pytest.mark.parametrize("off", ["1e-3", "1e-6", "1e-7", "1e-8", "1e-12"])
def test_the_period_beside_the_separatrix(off: str) -> None:
    answer = asked({"b": {"mass": 1, "at": [f"sin({off})", f"cos({off})"]}}, [ROD])
    with mp.workdps(40):
        period = float(4 * ellipk(mp.cos(mpf(off) / 2) ** 2) / mp.sqrt(mpf("9.81")))
    assert answer.period == pytest.approx(period, rel=1e-15)
    assert abs(answer.period - period) <= answer.period_error


@pytest.mark.parametrize(("angle", "value"), [("acos(0.3 - 0.3)", math.pi / 2), ("asin(0.3 - 0.3)", 0.0)])
def test_functions_of_differences_that_are_zero(angle: str, value: float) -> None:
    body = {"mass": 1, "inertia": 1, "at": [0, 0], "angle": angle}
    answer = asked({"b": body}, [{"kind": "pin", "a": "b", "b": [0, 0]}], [1.0])
    assert answer.trajectory.columns["b.angle"].values[0] == pytest.approx(value, abs=1e-15)


def test_a_column_that_is_zero_at_the_times_asked() -> None:
    """At half a period a swinging mass stands still, and a damper along a line that never changes has no force."""
    spring = {"kind": "spring", "a": "b", "b": [0, 0], "stiffness": "pi^2", "rest_length": 0}
    answer = asked({"b": {"mass": 1, "at": [1, 0]}}, [spring], [1.0], gravity=(0, 0))
    assert np.abs(answer.trajectory.columns["b.velocity"].values).max() < 1e-15


@pytest.mark.parametrize("far", [0, 1000])
@pytest.mark.parametrize("space", [False, True])
def test_a_damper_between_what_never_approaches(far: float, *, space: bool) -> None:
    """Seen from space the two fly side by side; in the frame they circle, and the force is zero for ever."""
    bodies = {
        "a": {"mass": 3, "at": [far - 0.5, 1], "velocity": [0, 1]},
        "b": {"mass": 2, "at": [far + 0.5, 1], "velocity": [0, -1]},
    }
    frame: Json = {"kind": "spinning-frame", "rate": 2, "at": [far, 0]}
    if space:
        bodies = {
            k: {"mass": x["mass"], "at": [*x["at"], 0], "velocity": [*x["velocity"], 0]} for k, x in bodies.items()
        }
        frame["at"] = [far, 0, 0]
    else:
        frame["about"] = "normal"
    damper = {"kind": "damper", "name": "d", "a": "a", "b": "b", "coefficient": 2}
    down = (0, 0, -10) if space else (0, -10)
    answer = asked(bodies, [damper, frame], [0.2, 0.5], ("trajectory", "forces-in-time"), down)
    force = answer.trajectory.columns["d.force"]
    assert np.abs(force.values).max() <= force.error < 1e-9


def test_the_time_of_a_problem_has_an_error() -> None:
    bodies = {
        f"b{k}": {"mass": 1, "radius": 0.1, "at": [0.2 * k if k else -1, 0], "velocity": [0 if k else 1, 0]}
        for k in range(3)
    }
    connections = [
        {"kind": "contact", "name": f"c{k}", "a": f"b{k}", "b": f"b{k + 1}", "restitution": 0.5} for k in range(2)
    ]
    problem = asked(bodies, connections, [2.0], gravity=(0, 0)).problem
    assert problem.code == "simultaneous-impacts"
    assert abs(problem.time - 1.0) <= problem.error + 1e-16


@pytest.mark.parametrize("restitution", [0.25, 0.5, 0.8])
def test_two_balls_come_to_rest_together_and_the_instant_is_told(restitution: float) -> None:
    """After (1 + e)/(1 - e) times the fall."""
    bodies = {f"b{k}": {"mass": k + 1, "at": [k, 1]} for k in range(2)}
    contacts = [
        {"kind": "contact", "name": f"f{k}", "place": f"b{k}", "on": {"at": [0, 0]}, "restitution": restitution}
        for k in range(2)
    ]
    settles = [event for event in asked(bodies, contacts, [6.0]).events if event.kind == "settle"]
    rest = (1 + restitution) / (1 - restitution) * math.sqrt(2 / 9.81)
    assert [event.name for event in settles] == ["f0", "f1"]
    assert [event.time for event in settles] == pytest.approx([rest, rest], abs=1e-14)


def hinged_beside_bouncing(random: np.random.Generator) -> Json:
    """Two hinged bodies in space, pushed or tied, beside bouncing balls that repel each other."""
    bodies: Json = {}
    connections: list[Json] = []
    for k in range(2):
        body = {"mass": 1, "moments": MOMENTS[random.integers(3)], "at": [3 * k, 0, -0.5]}
        bodies[f"h{k}"] = body | {"places": {"p": [0, 0, 0.5], "q": [0, 0, -0.5]}}
        axis = AXES[random.integers(5)]
        connections += [
            {"kind": "pin", "a": f"h{k}.p", "b": [3 * k, 0, 0], "axis": axis},
            {"kind": "force", "place": f"h{k}.q", "force": [int(random.integers(4)), int(random.integers(3)), 0]},
        ]
        height = (0.3, 0.4, 0.6)[random.integers(3)]
        bodies[f"b{k}"] = {"mass": 1, "radius": 0.1, "at": [10 + k, 0, height], "velocity": [0, 0, 0]}
        on = {"at": [0, 0, 0], "normal": [0, 0, 1]}
        connections.append({"kind": "contact", "place": f"b{k}", "on": on, "restitution": (0.5, 0.8, 1)[k]})
    connections.append({"kind": "inverse-square", "a": "b0", "b": "b1", "strength": -5})
    connections.append({"kind": "spring", "a": "h0.q", "b": "h1.q", "stiffness": 5})
    return {"gravity": [0, 0, -10], "bodies": bodies, "connections": connections}


def colliding_beside_a_slider(random: np.random.Generator) -> Json:
    """Two balls that collide beside a body on an oblique line with a pendulum, tied to it by a law."""
    bodies: Json = {
        "a": {"mass": 1, "radius": 0.1, "at": [-0.5, 0, 1], "velocity": [1, 0, 0]},
        "b": {"mass": 2, "radius": 0.1, "at": [0.5, (0, 0.05, 0.12)[random.integers(3)], 1], "velocity": [-1, 0, 0]},
        "k": {"mass": 1, "moments": MOMENTS[1], "at": [5, 0, 0]},
        "p": {"mass": 1, "at": [5, 0, -1]},
    }
    tie: Json = (
        {"kind": "spring", "stiffness": 5},
        {"kind": "inverse-square", "strength": -5},
        {"kind": "damper", "coefficient": 2},
    )[random.integers(3)]
    connections: list[Json] = [
        {"kind": "contact", "a": "a", "b": "b", "restitution": (0, 0.5, 1)[random.integers(3)]},
        {"kind": "slider", "a": "k", "b": [5, 0, 0], "direction": AXES[random.integers(5)]},
        {"kind": "rod", "a": "p", "b": "k"},
        {**tie, "a": "a", "b": "p"},
    ]
    return {"gravity": [0, 0, -10], "bodies": bodies, "connections": connections}


def bouncing_in_a_turning_frame(random: np.random.Generator) -> Json:
    """A point that bounces, a hinge and a spring between them in a spinning frame of space."""
    body = {"mass": 1, "moments": MOMENTS[random.integers(3)], "at": [3, 0, -0.5]}
    bodies = {
        "s": {"mass": 1, "at": [0, 0, (0.2, 0.3, 0.5)[random.integers(3)]]},
        "h": body | {"places": {"p": [0, 0, 0.5], "q": [0, 0, -0.5]}},
    }
    on = {"at": [0, 0, 0], "normal": [0, 0, 1]}
    connections: list[Json] = [
        {"kind": "contact", "place": "s", "on": on, "restitution": (0.5, 0.8, 1)[random.integers(3)]},
        {"kind": "pin", "a": "h.p", "b": [3, 0, 0], "axis": AXES[random.integers(5)]},
        {"kind": "spring", "a": "s", "b": "h.q", "stiffness": int(random.integers(1, 20))},
        {"kind": "spinning-frame", "rate": int(random.integers(1, 4))},
    ]
    return {"gravity": [0, 0, -10], "bodies": bodies, "connections": connections}


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", [hinged_beside_bouncing, colliding_beside_a_slider, bouncing_in_a_turning_frame])
def test_events_beside_motions_in_space(kind: Any, seed: int) -> None:
    verdict = compared(kind(np.random.default_rng([39, seed])), [0.0, 0.36, 0.8])
    assert classes_of(verdict) == "", verdict.differences
    assert verdict.compared > 0
