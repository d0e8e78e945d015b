"""Equilibria and small motions against closed forms."""

from __future__ import annotations

import itertools
import math
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq

from core.errors import BudgetExceeded, NotApplicable
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import BEAD_ON_HOOP, points, read


def bead(radius: str, rate: float) -> dict[str, object]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"bead": {"mass": 0.1, "at": [0, f"-{radius}"]}},
        "connections": [{"kind": "rod", "a": "bead", "b": [0, 0]}, {"kind": "spinning-frame", "rate": rate}],
    }


def test_bead_on_a_turning_hoop_has_four_equilibria() -> None:
    found = solve_scene(read(BEAD_ON_HOOP), outputs=("equilibria",)).equilibria
    assert found is not None
    assert len(found) == 4
    # cos(theta) = g/(Omega^2 R); the small oscillation is Omega sin(theta).
    c = 9.81 / 16
    tilted = [e for e in found if abs(e.positions["bead"][0]) > 0.1]
    for equilibrium in tilted:
        assert equilibrium.stable is True
        assert -equilibrium.positions["bead"][1] == pytest.approx(c, rel=1e-14)
        assert equilibrium.modes[0][0] == pytest.approx(4 * math.sqrt(1 - c * c), rel=1e-13)
        assert equilibrium.modes[0][0] == pytest.approx(3.159944, abs=5e-7)
    others = [e for e in found if abs(e.positions["bead"][0]) < 0.1]
    assert [e.stable for e in others] == [False, False]


def test_bead_at_reference_values() -> None:
    found = solve_scene(read(bead("0.5", 6)), outputs=("equilibria",)).equilibria
    assert found is not None
    stable = [e for e in found if e.stable]
    x, y = stable[0].positions["bead"]
    assert math.atan2(abs(x), -y) == pytest.approx(0.99440721205869942, rel=1e-14)
    assert stable[0].modes[0][0] == pytest.approx(5.0306162644352033, rel=1e-13)


def test_bead_below_the_critical_rate_has_two() -> None:
    found = solve_scene(read(bead("0.5", 4)), outputs=("equilibria",)).equilibria
    assert found is not None
    assert [e.stable for e in found] == [True, False]


def test_double_pendulum_has_four_equilibria_and_known_modes() -> None:
    found = solve_scene(read(points((1, 1), ("0.3", "0.2"), (1, 1))), outputs=("equilibria",)).equilibria
    assert found is not None
    assert [e.stable for e in found] == [True, False, False, False]
    # omega^2 = (g/l) (2 -+ sqrt 2) for equal points
    expected = [math.sqrt(9.81 * (2 - math.sqrt(2))), math.sqrt(9.81 * (2 + math.sqrt(2)))]
    assert [mode[0] for mode in found[0].modes] == pytest.approx(expected, rel=1e-13)
    assert max(e.residual for e in found) < 1e-14


@pytest.mark.parametrize(("upper", "lower"), [("1", "1"), ("1e16", "1"), ("1", "1e12"), ("1e-12", "1"), ("1e100", "1")])
def test_modes_of_a_double_pendulum_of_any_masses(upper: str, lower: str) -> None:
    """Of M phi'' + K phi = 0 with M = [[m + n, n], [n, n]] and K = g diag(m + n, n), hanging, of lengths 1."""
    found = solve_scene(read(points((1, 1), ("0.3", "0.2"), (upper, lower))), outputs=("equilibria",)).equilibria
    assert found is not None
    with mpmath.workdps(150):
        share = mpmath.mpf(lower) / (mpmath.mpf(upper) + mpmath.mpf(lower))
        # det(K - w^2 M) = 0 divided by m + n and by n: (g - w^2)^2 = share w^4.
        squares = [mpmath.mpf("9.81") / (1 + sign * mpmath.sqrt(share)) for sign in (1, -1)]
        expected = [float(mpmath.sqrt(square)) for square in squares]
    assert [mode[0] for mode in found[0].modes] == pytest.approx(expected, rel=1e-11)
    assert found[0].stable is True
    assert [one.stable for one in found[1:]] == [False] * 3
    for name, reach in (("p0", 1.0), ("p1", 2.0)):
        heights = sorted(abs(one.positions[name][1]) for one in found)
        assert heights == pytest.approx([1.0] * 4 if name == "p0" else [0.0, 0.0, reach, reach], abs=1e-12)


def test_strings_are_taut_in_an_equilibrium() -> None:
    scene = points((1,), ("0.3",), (1,))
    scene["connections"] = [{"kind": "string", "through": ["p0", [0, 0]]}]
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    assert [e.positions["p0"] for e in found] == [pytest.approx((0, -1), abs=1e-14)]


def test_rolling_on_a_curve_is_refused() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"disc": {"mass": 1, "inertia": 0.005, "radius": 0.1, "at": [0, -0.9]}},
        "connections": [{"kind": "rolling", "place": "disc", "on": {"at": [0, 0], "radius": -1}}],
    }
    with pytest.raises(NotApplicable):
        solve_scene(read(scene), outputs=("equilibria",))


def test_places_beside_a_spring_of_no_length_are_no_equilibria() -> None:
    """V = -g (cos a + cos b) + k/2 (d - 1)^2 has four; beside d = 0 Newton's steps are short, too."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"left": {"mass": 1, "at": [0.6, -0.8]}, "right": {"mass": 1, "at": [1, -1]}},
        "connections": [
            {"kind": "rod", "a": "left", "b": [0, 0]},
            {"kind": "rod", "a": "right", "b": [1, 0]},
            {"kind": "spring", "a": "left", "b": "right", "stiffness": 3, "rest_length": 1},
        ],
    }
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    assert len(found) == 4
    for one in found:
        left, right = one.positions["left"], one.positions["right"]
        d = (right[0] - left[0], right[1] - left[1])
        pull = 3 * (1 - 1 / math.hypot(*d))
        # Across each rod: the spring against the weight.
        assert (pull * d[0]) * -left[1] + (pull * d[1] - 9.81) * left[0] == pytest.approx(0, abs=1e-11)
        assert -(pull * d[0]) * -right[1] - (pull * d[1] + 9.81) * (right[0] - 1) == pytest.approx(0, abs=1e-11)


def test_a_rod_on_a_torsion_spring_stands_in_three_ways() -> None:
    """k phi = m g l/2 sin(phi) with k = 4: upright, unstable, and bent to either side; I phi'' by the second slope."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "rod": {
                "mass": 1,
                "inertia": "1/12",
                "at": ["0.5*sin(0.1)", "0.5*cos(0.1)"],
                "angle": "pi/2 - 0.1",
                "places": {"foot": [-0.5, 0]},
            }
        },
        "connections": [
            {"kind": "pin", "a": "rod.foot", "b": [0, 0]},
            {"kind": "torsion-spring", "a": "rod", "stiffness": 4, "rest_angle": "pi/2"},
        ],
    }
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    bent = brentq(lambda x: 4 * x - 4.905 * math.sin(x), 0.5, 2, xtol=1e-15)
    angles = sorted((math.pi / 2 - one.angles["rod"], one.stable, one.modes) for one in found)
    assert [one[0] for one in angles] == pytest.approx([-bent, 0, bent], abs=1e-12)
    assert [one[1] for one in angles] == [True, False, True]
    frequency = math.sqrt((4 - 4.905 * math.cos(bent)) * 3)
    assert [mode[:2] for mode in angles[2][2]] == [pytest.approx((frequency, 0.0), rel=1e-12)]
    growth = math.sqrt(0.905 * 3)
    assert [mode[:2] for mode in angles[1][2]] == [pytest.approx((0.0, growth), rel=1e-12)]


@pytest.mark.parametrize("power", [3, 6, 8, 9, 10, 13, 16, 20])
@pytest.mark.parametrize("side", ["+", "-"])
def test_beside_its_bifurcation_it_stands_in_one_way_or_three(power: int, side: str) -> None:
    """k = 4.905 is critical; just below it the rod leans by the root of 6 (1 - k/4.905), and a little more."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "rod": {"mass": 1, "inertia": "1/12", "at": [0, 0.5], "angle": "pi/2", "places": {"foot": [-0.5, 0]}}
        },
        "connections": [
            {"kind": "pin", "a": "rod.foot", "b": [0, 0]},
            {"kind": "torsion-spring", "a": "rod", "stiffness": f"4.905{side}1e-{power}", "rest_angle": "pi/2"},
        ],
    }
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    leaning = sorted((math.pi / 2 - one.angles["rod"], one.stable) for one in found)
    if side == "+":
        assert leaning == [(0.0, True)]
        return
    with mp.workdps(60):
        stiffness, critical = mpf("4.905") - mpf(10) ** -power, mpf("4.905")
        about = mp.sqrt(6 * (1 - stiffness / critical))
        bent = float(mp.findroot(lambda x: (stiffness * x - critical * mp.sin(x)) / x, about))
    assert [one[0] for one in leaning] == pytest.approx([-bent, 0.0, bent], abs=3e-16)
    assert [one[1] for one in leaning] == [True, False, True]


@pytest.mark.parametrize(("spin", "grows"), [(108.49884, True), (108.49886, False)])
def test_a_sleeping_top_is_held_by_a_spin_above_its_threshold(spin: float, grows: bool) -> None:
    """I3 w3 = 2 sqrt(I1 M g l), w3 = 108.49884792015075 rad/s with M = 1, l = 0.1, I1 = 0.012, I3 = 0.002."""
    top = {
        "mass": 1,
        "moments": [0.002, 0.002, 0.002],
        "at": [0, 0, 0.1],
        "angular_velocity": [0, 0, spin],
        "places": {"tip": [0, 0, -0.1]},
    }
    scene = {
        "gravity": [0, 0, -9.81],
        "bodies": {"top": top},
        "connections": [{"kind": "pin", "a": "top.tip", "b": [0, 0, 0]}],
    }
    answer = solve_scene(read(scene), outputs=("equilibria",))
    assert answer.model.name == "steady spin"
    assert answer.equilibria is not None
    upright = next(one for one in answer.equilibria if one.positions["top"][2] > 0)
    assert (max(mode.growth_rate for mode in upright.modes) > 1e-3) is grows


def test_a_weak_torsion_spring_may_be_wound_up() -> None:
    """k phi = m g l sin(phi), k small: windings of more than a turn are equilibria, too."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {
            "bar": {"mass": 1, "inertia": 0.1, "at": [0, -1], "angle": {"degrees": -90}, "places": {"top": [-1, 0]}}
        },
        "connections": [
            {"kind": "pin", "a": "bar.top", "b": [0, 0]},
            {"kind": "torsion-spring", "a": "bar", "stiffness": 1},
        ],
    }
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None

    def torque(x: float) -> float:
        return x + 9.81 * math.sin(x)

    grid = np.linspace(-10, 10.001, 20001)
    exact = [brentq(torque, a, b, xtol=1e-14) for a, b in pairwise(grid) if torque(a) * torque(b) < 0]
    # Angles are those of the direction; what is wound up differs in its frequency.
    squares = sorted((1 + 9.81 * math.cos(x)) / 1.1 for x in exact)
    assert len(found) == len(exact) == 5
    own = sorted(w * w - g * g for one in found for w, g, _ in one.modes)
    assert own == pytest.approx(squares, rel=1e-9)


def test_searches_that_would_take_minutes_and_gigabytes_are_refused() -> None:
    scene = {"gravity": [0, -9.81], "bodies": {f"p{i}": {"mass": 1, "at": [i, 0]} for i in range(100)}}
    with pytest.raises(BudgetExceeded, match="4096 starts, 200 unknowns"):
        solve_scene(read(scene), outputs=("equilibria",))


@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize(
    "holds",
    [
        [{"kind": "rod", "a": "p", "b": [-1, 0]}, {"kind": "rod", "a": "p", "b": [1, 0]}],
        [{"kind": "string", "through": ["p", [-1, 0]]}, {"kind": "string", "through": ["p", [1, 0]]}],
        [{"kind": "string", "through": ["p", ["-1e3", 0]]}, {"kind": "string", "through": ["p", ["1e3", 0]]}],
        [{"kind": "rod", "a": "p", "b": [-1, 0]}, {"kind": "track", "place": "p", "on": {"at": [0, -1]}}],
    ],
)
def test_what_cannot_move_rests_where_it_is(holds: list[dict[str, Any]], beside: bool) -> None:
    scene: dict[str, Any] = {"gravity": [0, -9.81], "bodies": {"p": {"mass": 2, "at": [0, -1]}}, "connections": holds}
    if beside:
        scene["bodies"] = scene["bodies"] | {"q": {"mass": 1, "at": [5, -1]}}
        scene["connections"] = [*holds, {"kind": "rod", "a": "q", "b": [5, 0]}]
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    assert [(one.positions["p"], one.stable) for one in found] == [((0.0, -1.0), True), ((0.0, -1.0), False)][
        : 1 + beside
    ]
    assert len(found[0].modes) == beside


@pytest.mark.parametrize(
    ("ends", "rests"),
    [
        ([[-1, 0], [1, 0], [0, -3]], True),
        ([[-1, 0], [1, 0], [0, 0]], True),
        ([[0, 0], [0, -3]], True),
        ([[-1, -3], [1, -3], [0, -3]], False),
    ],
)
def test_strings_rest_where_some_share_of_the_load_leaves_all_of_them_taut(
    ends: list[list[float]], rests: bool
) -> None:
    strings = [{"kind": "string", "through": ["p", end]} for end in ends]
    scene = {"gravity": [0, -9.81], "bodies": {"p": {"mass": 2, "at": [0, -1]}}, "connections": strings}
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    assert any(one.positions["p"] == (0.0, -1.0) for one in found) == rests


@pytest.mark.parametrize("x", [0, 1000])
@pytest.mark.parametrize("angle", [0, 90, 180, 270, 360])
@pytest.mark.parametrize("top", [(0, 1), (1, 0), (0, -1), (-1, 0), (0.6, -0.8)])
def test_a_rod_hangs_and_stands_at_whichever_of_its_places_it_is_pinned(
    top: tuple[float, float], angle: int, x: int
) -> None:
    """Its angle takes the arm (p, q) to (0, 1) where it hangs, and to (0, -1) where it stands, also at half a turn."""
    p, q = top
    turn = math.radians(angle)
    c, s = round(math.cos(turn)), round(math.sin(turn))
    at = [f"{x} - ({c})*({p}) + ({s})*({q})", f"-({s})*({p}) - ({c})*({q})"]
    rod = {"mass": 1, "inertia": 0.1, "at": at, "angle": {"degrees": angle}, "places": {"top": [p, q]}}
    pin = {"kind": "pin", "a": "rod.top", "b": [x, 0]}
    scene = {"gravity": [0, -9.81], "bodies": {"rod": rod}, "connections": [pin]}
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    assert [one.stable for one in found] == [True, False]
    arm = complex(*top)
    for one, up in zip(found, (1, -1), strict=True):
        assert one.positions["rod"] == pytest.approx((x, -up), abs=1e-12)
        assert one.errors.angles["rod"] < 1e-14
        assert abs(arm * mpmath.expj(one.angles["rod"]) - up * 1j) < 1e-14


@pytest.mark.parametrize("x", [0, 1000])
@pytest.mark.parametrize("place", [(0, 0, 0.5), (0, 0.3, 0.4)])
@pytest.mark.parametrize("pendulums", [1, 2])
def test_bodies_of_space_rest_without_their_mirror_images(
    pendulums: int, place: tuple[float, float, float], x: int
) -> None:
    """A pendulum about a level axis hangs or stands: two places, and four of two pendulums, each on its own axis."""
    bodies, pins = {}, []
    for i in range(pendulums):
        # As it hangs, turned about its axis by the angle of which sine and cosine are 0.6 and 0.8.
        _, y, z = place
        at = [x + i, -(0.8 * y + 0.6 * z), -(-0.6 * y + 0.8 * z)]
        axes = [[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]]
        bodies[f"b{i}"] = {"mass": 1, "moments": [0.1, 0.12, 0.05], "at": at, "axes": axes, "places": {"top": place}}
        pins.append({"kind": "pin", "a": f"b{i}.top", "b": [x + i, 0, 0], "axis": [1, 0, 0]})
    scene = {"gravity": [0, 0, -9.81], "bodies": bodies, "connections": pins}
    found = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert found is not None
    heights = sorted(tuple(one.positions[name][2] for name in bodies) for one in found)
    expected = sorted(itertools.product((-0.5, 0.5), repeat=pendulums))
    assert np.array(heights) == pytest.approx(np.array(expected), abs=1e-12)
