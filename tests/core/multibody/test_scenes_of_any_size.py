"""Scenes whose numbers are drawn: connections that share a load, that are redundant, or that never pull."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds
from tests.core.multibody.worked_examples import column, read


def tenths(first: int, last: int) -> st.SearchStrategy[float]:
    return st.integers(first, last).map(lambda x: x / 10)


@settings(max_examples=5)
@given(tenths(3, 30), tenths(2, 10))
@example(1.0, 0.6435011087932844)
def test_a_string_between_stones_that_fall_alike_never_pulls(radius: float, angle: float) -> None:
    """Each stone leaves its hump at cos = 2/3 of that of the start, after the integral of energy; then both fall."""
    names = {"a": 0, "b": 5}
    scene = {
        "gravity": [0, -10],
        "bodies": {
            name: {"mass": 1, "at": [f"{x} + {radius}*sin({angle})", f"{radius}*cos({angle})"]}
            for name, x in names.items()
        },
        "connections": [
            *(
                {"kind": "contact", "name": f"hump-{name}", "place": name, "on": {"at": [x, 0], "radius": radius}}
                for name, x in names.items()
            ),
            {"kind": "string", "name": "between", "through": ["a", "b"]},
        ],
    }
    with mpmath.workdps(30):
        first = mpmath.mpf(angle)
        whole = mpmath.sqrt(mpmath.acos(2 * mpmath.cos(first) / 3) - first)

        def slowness(s: Any) -> Any:
            """Return dt/ds, with the angle first + s^2: regular at the start, where the stone is at rest."""
            return 2 * s / mpmath.sqrt(40 / mpmath.mpf(radius) * mpmath.sin(first + s * s / 2) * mpmath.sin(s * s / 2))

        lifted = mpmath.quad(slowness, [0, whole])
    answer = solve_scene(read(scene), [0.5 * float(lifted), 1.1 * float(lifted)], ("trajectory", "forces-in-time"))
    assert answer.problem is None
    assert kinds(answer) == [("lift-off", "hump-a"), ("lift-off", "hump-b")]
    assert [event.time for event in answer.events] == pytest.approx([float(lifted)] * 2, rel=1e-12)
    tension = column(answer, "between.tension")
    assert np.abs(tension.values).max() <= tension.error + 1e-12


@settings(max_examples=8)
@given(
    st.sampled_from([(3, 4, 5), (5, 12, 13), (-8, 15, 17), (20, -21, 29)]),
    st.sampled_from([(3, 3, 3), (3, 4, 5), (2, 2, 1)]),
    tenths(1, 9),
)
@example((3, 4, 5), (3, 3, 3), 5)
def test_a_body_on_an_oblique_track_moves_as_on_one_along_an_axis(
    direction: tuple[int, int, int], moments: tuple[int, int, int], arm: float
) -> None:
    """The same scene, turned about the vertical until the track lies along x."""
    x, y, size = direction
    turn = np.array([[x, y, 0], [-y, x, 0], [0, 0, size]]) / size
    places = []
    for turned in (False, True):
        axes = [[f"{x}/{size}", f"-{y}/{size}", 0], [f"{y}/{size}", f"{x}/{size}", 0], [0, 0, 1]]
        body: dict[str, Any] = {"mass": 3, "moments": [0.1 * j for j in moments], "at": [0, 0, 0]}
        if turned:
            body["axes"] = axes
        at = [f"{arm}*{x}/{size}", f"-{arm}*{y}/{size}", 0] if turned else [arm, 0, 0]
        on = {"at": at, "direction": [1, 0, 0] if turned else [x, y, 0]}
        scene = {
            "gravity": [0, 0, -10],
            "bodies": {"body": {**body, "places": {"p": [arm, 0, 0]}}},
            "connections": [{"kind": "track", "name": "line", "place": "body.p", "on": on}],
        }
        places.append(column(solve_scene(read(scene), [0.3, 0.8]), "body.position"))
    oblique, along = places
    assert oblique.values @ turn.T == pytest.approx(along.values, abs=2 * (oblique.error + along.error) + 1e-15)


@settings(max_examples=8)
@given(tenths(2, 8), st.integers(1, 20), tenths(1, 9))
@example(0.5, 2, 3)
def test_a_string_beside_meshed_gears_becomes_taut_when_its_stone_has_fallen(
    radius: float, stiffness: int, way: float
) -> None:
    """On a spring, a stone of 1 kg has fallen by y after acos(1 - k y/(m g)) sqrt(m/k); the gears are not moved."""
    end = min(way, 15 / stiffness)
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "gear": {"mass": 1, "inertia": 0.1, "radius": radius, "at": [0, 0], "angular_velocity": 2},
            "other": {"mass": 1, "inertia": 0.2, "radius": f"1 - {radius}", "at": [1, 0]},
            "stone": {"mass": 1, "at": [0, -2]},
        },
        "connections": [
            {"kind": "pin", "a": "gear", "b": [0, 0]},
            {"kind": "pin", "a": "other", "b": [1, 0]},
            {"kind": "rolling", "a": "gear", "b": "other"},
            {"kind": "string", "name": "cord", "through": ["stone", [0, 0]], "length": f"2 + {end}"},
            {"kind": "spring", "a": "stone", "b": "gear", "stiffness": stiffness},
        ],
    }
    taut = math.acos(1 - stiffness * end / 10) / math.sqrt(stiffness)
    answer = solve_scene(read(scene), [0.9 * taut, 1.01 * taut])
    assert answer.problem is None
    assert kinds(answer)[0] == ("taut", "cord")
    assert answer.events[0].time == pytest.approx(taut, rel=1e-12)
    assert column(answer, "gear.angular_velocity").values == pytest.approx(2, rel=1e-13)
    assert column(answer, "other.angular_velocity").values == pytest.approx(-2 * radius / (1 - radius), rel=1e-13)


@settings(max_examples=8)
@given(st.sampled_from(["0.05", "0.1", "1/12", "0.2"]), tenths(0, 9), tenths(8, 13))
@example("0.1", 0.5, math.atan(4 / 3))
def test_a_ladder_with_one_rough_end_slides_down_and_leaves_the_wall(
    inertia: str, friction: float, angle: float
) -> None:
    """Newton's and Euler's equations of the ladder, with friction at its upper end, by SciPy's DOP853."""
    moment = 1 / 12 if inertia == "1/12" else float(inertia)

    def turning(a: float, w: float) -> tuple[float, float]:
        """Return the angular acceleration and the push of the wall, of a ladder of 1 m and 1 kg."""
        c, s = math.cos(a), math.sin(a)
        # Unknown are the acceleration, and the pushes of wall and floor.
        matrix = [[s / 2, 1, 0], [c / 2, -friction, -1], [moment, -(friction * c + s) / 2, c / 2]]
        found = np.linalg.solve(matrix, [-c * w * w / 2, s * w * w / 2 - 10, 0])
        return float(found[0]), float(found[1])

    def leaves(_: float, y: Any) -> float:
        return turning(*y)[1]

    leaves.terminal = True  # type: ignore[attr-defined]
    right = solve_ivp(
        lambda _, y: [y[1], turning(*y)[0]],
        (0, 3),
        [angle, 0.0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        events=leaves,
    )
    lifted = float(right.t_events[0][0])
    ends = {"floor": ("ladder.foot", 0), "wall": ("ladder.head", 90)}
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "ladder": {
                "mass": 1,
                "inertia": inertia,
                "at": [f"-cos({angle})/2", f"sin({angle})/2"],
                "angle": angle,
                "places": {"foot": [-0.5, 0], "head": [0.5, 0]},
            }
        },
        "connections": [
            {"kind": "contact", "name": name, "place": place, "on": {"at": [0, 0], "slope": {"degrees": slope}}}
            | ({"friction": friction} if name == "wall" else {})
            for name, (place, slope) in ends.items()
        ],
    }
    answer = solve_scene(read(scene), [0.9 * lifted, 1.01 * lifted])
    assert answer.problem is None
    assert kinds(answer)[0] == ("lift-off", "wall")
    assert answer.events[0].time == pytest.approx(lifted, rel=1e-9)


def _bead_in_a_ring(place: str, more: list[str]) -> dict[str, Any]:
    ring = {"kind": "contact", "name": "c", "place": "a", "on": {"at": [place, place, *more], "radius": -1}}
    at = [f"{place} + 0.3", f"{place} + 0.2", *more]
    return {"gravity": [0, -10, *["0"] * len(more)], "bodies": {"a": {"mass": 1, "at": at}}, "connections": [ring]}


def _balls_that_meet(place: str, more: list[str]) -> dict[str, Any]:
    nought = ["0"] * len(more)
    ball = {"mass": 1, "radius": "0.1"}
    return {
        "gravity": [0, 0, *nought],
        "bodies": {
            "a": {**ball, "at": [place, place, *more], "velocity": [1, 0, *nought]},
            "b": {**ball, "at": [f"{place} + 1", place, *more]},
        },
        "connections": [{"kind": "contact", "name": "c", "a": "a", "b": "b", "restitution": 0.5}],
    }


@pytest.mark.parametrize(
    ("scene", "space"), [(_bead_in_a_ring, False), (_balls_that_meet, False), (_balls_that_meet, True)]
)
@pytest.mark.parametrize("place", ["1e3", "-1e5", "1e6", "1e7"])
def test_what_does_not_touch_far_from_the_origin_is_not_put_in_touch(scene: Any, space: bool, place: str) -> None:
    """Squares of distances are small differences of large terms there: a metre was nothing beside them."""
    near, far = (
        solve_scene(read(scene(at, [at] if space else [])), [0.0, 1.0], ("trajectory",), 1e-3) for at in ("0", place)
    )
    assert [(event.kind, event.name) for event in far.events] == [("touch", "c")]
    assert far.events[0].time == pytest.approx(near.events[0].time, rel=1e-12)
    own, other = column(far, "a.position"), column(near, "a.position")
    assert np.abs(own.values - float(place) - other.values).max() <= own.error + other.error
