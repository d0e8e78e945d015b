"""Shares of a load: conditions without the share against linear programming, and motions against statics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from flint import arb
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from core.errors import BudgetExceeded
from core.multibody.contacts.certificates import certificates
from core.multibody.solve import solve_scene
from tests.core.multibody.table.test_contact_geometry import kinds, states
from tests.core.multibody.worked_examples import column, linear, read

SIGNS = st.sampled_from([1, -1])


@pytest.mark.parametrize("trial", range(60))
def test_conditions_without_the_share_say_what_linear_programming_says(trial: int) -> None:
    """Farkas: a share exists if and only if no certificate is negative; the largest margin has the same sign."""
    random = np.random.default_rng(trial)
    free, count = int(random.integers(1, 4)), int(random.integers(3, 9))
    slopes = random.integers(-2, 3, (count, free))
    found = certificates([{f: arb(int(x)) for f, x in enumerate(line) if x} for line in slopes])
    for weights in found:
        assert all(y > 0 for y in weights.values())
        for f in range(free):
            assert sum(y * int(slopes[k, f]) for k, y in weights.items()) == 0 or 0 in sum(
                y * int(slopes[k, f]) for k, y in weights.items()
            )
    supports = [set(weights) for weights in found]
    assert not any(a < b for a in supports for b in supports)
    feasible = []
    for _ in range(20):
        constants = random.integers(-3, 6, count)
        # Conditions c + g x >= t, with t as large as it can be.
        bound = np.hstack([-slopes, np.ones((count, 1))])
        best = linprog([0.0] * free + [-1.0], A_ub=bound, b_ub=constants, bounds=[(None, None)] * free + [(None, 1.0)])
        least = min((sum(y * int(constants[k]) for k, y in w.items()) for w in found), default=arb(1))
        if abs(best.fun) > 1e-7:
            feasible.append(-best.fun > 0)
            assert (least > 0) == feasible[-1]
    assert len(feasible) > 10


def test_more_sums_than_can_be_followed_are_refused() -> None:
    random = np.random.default_rng(7)
    slopes = [{f: arb(float(x)) for f, x in enumerate(line)} for line in random.normal(size=(40, 12))]
    with pytest.raises(BudgetExceeded, match="shared"):
        certificates(slopes)


def largest_pull(cosine: float, frictions: tuple[float, float], way: int) -> float | None:
    """Return the largest pull at the middle under which a ladder of 1 m and 1 kg may rest, None if it never does.

    Unknown are normal force and friction at the foot, at the wall, and the pull along -x: three equations, two cones.
    """
    sine = math.sqrt(1 - cosine**2)
    balance = [[0, 1, -1, 0, -way], [1, 0, 0, 1, 0], [-cosine / 2, sine / 2, sine / 2, cosine / 2, 0]]
    floor, wall = frictions
    cones = [[-floor, s, 0, 0, 0] for s in (1, -1)] + [[0, 0, -wall, s, 0] for s in (1, -1)]
    bounds: list[tuple[float | None, float | None]] = [(0, None), (None, None), (0, None), (None, None)]
    rest, most = (
        linprog(
            [0, 0, 0, 0, -1],
            A_ub=cones,
            b_ub=[0.0] * 4,
            A_eq=balance,
            b_eq=[0.0, 10.0, 0.0],
            bounds=[*bounds, (0, pull)],
        )
        for pull in (0, 100)
    )
    return float(most.x[4]) if rest.success else None


ROUGH = st.integers(10, 120).map(lambda x: x / 100)


@settings(max_examples=20)
@given(st.sampled_from([0.28, 0.6, "5/13", "8/17"]) | ROUGH.map(lambda x: x / 1.5), st.tuples(ROUGH, ROUGH), SIGNS)
@example("8/17", (0.3, 0.3), 1)
@example(0.28, (0.5, 0.5), -1)
@example(0.6, (0.9, 0.2), 1)
@example("5/13", (0.35, 1.2), -1)
def test_a_ladder_rests_as_long_as_some_share_is_admissible(
    cosine: Any, frictions: tuple[float, float], way: int
) -> None:
    """A heavy block moves away at 1 m/s, and stretches or presses a spring on the middle: the pull is 10 N/m t."""
    c = 5 / 13 if cosine == "5/13" else 8 / 17 if cosine == "8/17" else cosine
    largest = largest_pull(c, frictions, way)
    scene = {
        "gravity": [0, -10],
        "let": {"c": cosine, "s": "sqrt(1 - c^2)"},
        "bodies": {
            "ladder": {
                "mass": 1,
                "inertia": "1/12",
                "at": ["-c/2", "s/2"],
                "angle": "acos(c)",
                "places": {"foot": [-0.5, 0], "head": [0.5, 0]},
            },
            "m": {"mass": 1e12, "at": [f"-c/2 - {way}", "s/2"], "velocity": [-way, 0]},
        },
        "connections": [
            {
                "kind": "contact",
                "name": "floor",
                "place": "ladder.foot",
                "on": {"at": [0, 0]},
                "friction": frictions[0],
            },
            {
                "kind": "contact",
                "name": "wall",
                "place": "ladder.head",
                "on": {"at": [0, 0], "slope": {"degrees": 90}},
                "friction": frictions[1],
            },
            {"kind": "track", "place": "m", "on": {"at": [0, "s/2"]}},
            {"kind": "spring", "a": "ladder", "b": "m", "stiffness": 10},
        ],
    }
    end = 2.0 if largest is None or largest > 99 else 1.02 * largest / 10
    answer = solve_scene(read(scene), [end], ("trajectory",))
    rests = set(states(answer)[0].values()) == {"stick"}
    assert rests == (largest is not None)
    if rests and end == 2.0:
        assert answer.events == ()
    elif largest is not None:
        # The block is slowed down by parts in 1e11.
        assert answer.events[0].time == pytest.approx(largest / 10, rel=1e-8)


BAR = {"l": -1.0, "m": 0.2, "n": 0.5, "r": 1.0}


def bar(places: str, friction: float, velocity: float, tilt: Any = 0) -> dict[str, Any]:
    """Return a bar on several equally rough places of a slope."""
    return {
        "gravity": [0, -10],
        "let": {"t": tilt},
        "bodies": {
            "bar": {
                "mass": 2,
                "inertia": 1,
                "at": [0, 0],
                "angle": "t",
                "velocity": [f"{velocity}*cos(t)", f"{velocity}*sin(t)"],
                "places": {name: [BAR[name], 0] for name in places},
            }
        },
        "connections": [
            {
                "kind": "contact",
                "name": name,
                "place": f"bar.{name}",
                "on": {"at": [0, 0], "slope": "t"},
                "friction": friction,
            }
            for name in places
        ],
    }


@pytest.mark.parametrize("places", ["lr", "lmr", "lmnr"])
@pytest.mark.parametrize(("friction", "tilt"), [(0.3, 0), (0.3, "atan(0.2)"), (0.3, "-atan(0.3)")])
def test_a_bar_on_several_equally_rough_places_rests(places: str, friction: float, tilt: Any) -> None:
    """Its weight is within the cone of all together; at the angle of friction, exactly."""
    answer = solve_scene(read(bar(places, friction, 0, tilt)), [1.0])
    assert answer.problem is None
    assert answer.events == ()
    assert states(answer) == [dict.fromkeys(places, "stick")]
    assert linear(answer, "bar") == (0.0, 0.0)
    assert answer.forces is not None
    assert not any(answer.forces[f"{name}.friction"].determined for name in places)


@settings(max_examples=10)
@given(st.sampled_from(["lr", "lmr", "lmnr"]), ROUGH, st.integers(-90, 40).map(lambda x: x / 100))
@example("lmr", 0.3, 0.0)
@example("lmnr", 0.5, -0.3)
def test_a_bar_slides_to_a_stop_on_several_equally_rough_places(places: str, friction: float, slope: float) -> None:
    """It stops after v/(g (mu cos + sin)), and stays; a steeper slope than that of friction would let it go on."""
    assume(-0.9 * friction < slope < friction)
    cosine = 1 / math.hypot(1, slope)
    stop = 1.5 / (10 * cosine * (friction + slope))
    answer = solve_scene(read(bar(places, friction, 1.5, f"atan({slope})")), [1.5 * stop])
    assert answer.problem is None
    assert kinds(answer) == [("stick", name) for name in places]
    for event in answer.events:
        assert event.time == pytest.approx(stop, rel=1e-13)
    assert np.linalg.norm(column(answer, "bar.position").values[0]) == pytest.approx(0.75 * stop, rel=1e-12)


@pytest.mark.parametrize("places", ["lmr", "lmnr"])
@pytest.mark.parametrize("height", [0.4, -0.7])
def test_a_bar_on_several_places_slides_when_the_pull_is_all_that_friction_bears(places: str, height: float) -> None:
    """A spring on a block that moves away pulls along the slope; with height it presses one end on, until that tips.

    Sliding begins at mu m g, tipping where the moment of the pull about the end is that of the weight.
    """
    scene = bar(places, 0.6, 0)
    scene["bodies"]["bar"]["places"]["hook"] = [0, height]
    scene["bodies"]["block"] = {"mass": 1e12, "at": [1, height], "velocity": [1, 0]}
    scene["connections"] += [
        {"kind": "track", "place": "block", "on": {"at": [0, height]}},
        {"kind": "spring", "a": "bar.hook", "b": "block", "stiffness": 10},
    ]
    slide, tip = 0.6 * 20 / 10, 20 / (10 * abs(height))
    answer = solve_scene(read(scene), [1.01 * min(slide, tip)], ("trajectory",))
    assert answer.problem is None
    assert answer.events[0].time == pytest.approx(min(slide, tip), rel=1e-8)
    expected = {"slip"} if slide < tip else {"lift-off"}
    assert {event.kind for event in answer.events} == expected


def test_unequal_coefficients_leave_a_sliding_bar_undetermined_but_not_one_at_rest() -> None:
    """At rest every share gives no motion; once it slides, the share decides how."""
    scene = bar("lmr", 0.3, 0)
    scene["connections"][1]["friction"] = 0.5
    assert solve_scene(read(scene), [1.0]).problem is None
    scene["bodies"]["bar"]["velocity"] = [1, 0]
    problem = solve_scene(read(scene), [1.0]).problem
    assert problem is not None
    assert (problem.code, problem.time) == ("undetermined-friction", 0.0)


@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_beams_on_three_smooth_supports_tip_when_no_share_carries_them(speed: float) -> None:
    """A weight runs along a beam: only over the outermost support does the beam begin to turn."""
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "beam": {
                "mass": 2,
                "inertia": 2,
                "at": [0, 0],
                "velocity": [0, 0],
                "places": {"l": [-1, 0], "m": [0.3, 0], "r": [1, 0], "top": [0, 0.1]},
            },
            "w": {"mass": 3, "at": [0, 0.1], "velocity": [speed, 0]},
        },
        "connections": [
            *(
                {"kind": "contact", "name": name, "place": f"beam.{name}", "on": {"at": [0, 0]}}
                for name in ("l", "m", "r")
            ),
            {"kind": "rod", "name": "brace", "a": "beam", "b": [-5, 0]},
            {"kind": "contact", "name": "way", "place": "w", "on": {"at": "beam.top"}},
        ],
    }
    # Moments about r: 2 kg at 1 m against 3 kg at x - 1.
    tips = (1 + 2 / 3) / speed
    answer = solve_scene(read(scene), [1.01 * tips], ("trajectory",))
    assert answer.problem is None
    assert {event.kind for event in answer.events} == {"lift-off"}
    assert answer.events[0].time == pytest.approx(tips, rel=1e-12)
