"""Worked examples and reference numbers, each judged by another formulation than the table."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest

from core.balls import precision
from core.errors import AccuracyUnreachable, BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.algebra.polynomials import BITS
from core.multibody.solve import solve_scene
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.multibody.oracles import integrated
from tests.core.multibody.worked_examples import (
    BEAD_ON_HOOP,
    LAGRANGE_TOP,
    MASSIVE_PULLEY,
    TWO_RODS,
    YO_YO,
    column,
    force,
    linear,
    points,
    read,
)

EPS = 2.0**-52


def test_massive_pulley_is_constant_acceleration_in_one_coordinate() -> None:
    answer = solve_scene(read(MASSIVE_PULLEY), [0.0, 0.5])
    model = answer.model
    assert (model.name, model.degrees_of_freedom, model.coordinates, model.rows) == ("constant acceleration", 1, 1, 0)
    assert model.described == (11, 8)
    assert model.mobility == 3
    # (m2 - m1) g / (m1 + m2 + I/R^2)
    a = 9.81 / 3.25
    assert linear(answer, "b") == pytest.approx((0, -a), rel=4 * EPS)
    assert force(answer, "s.1.tension") == pytest.approx(9.81 + a, rel=4 * EPS)
    assert force(answer, "s.2.tension") == pytest.approx(2 * (9.81 - a), rel=4 * EPS)
    assert column(answer, "b.position").values[1] == pytest.approx((0.1, -1 - a / 8), rel=4 * EPS)
    assert column(answer, "b.position").how == "closed form"


def test_yo_yo_falls_without_moving_sideways() -> None:
    answer = solve_scene(read(YO_YO))
    # g/(1 + I/(m R^2)), with I/(m R^2) = 4
    assert linear(answer, "yo-yo") == pytest.approx((0, -1.962), rel=4 * EPS)
    assert force(answer, "s.tension") == pytest.approx(0.7848, rel=4 * EPS)
    assert "constant throughout the motion: yo-yo.x" in answer.model.noticed


def test_atwood_with_a_disc_for_a_pulley() -> None:
    scene = read(
        {
            "gravity": [0, -9.81],
            "bodies": {
                "a": {"mass": 1, "at": [-0.2, -1]},
                "b": {"mass": 3, "at": [0.2, -1]},
                "disc": {"mass": 2, "radius": 0.2, "inertia": 0.04, "at": [0, 0]},
            },
            "connections": [
                {"kind": "pin", "name": "axle", "a": "disc", "b": [0, 0]},
                {"kind": "string", "name": "s", "through": ["a", "disc", "b"], "sides": {"disc": ["left", "right"]}},
            ],
        }
    )
    answer = solve_scene(scene)
    assert linear(answer, "a")[1] == pytest.approx(3.924, rel=4 * EPS)
    assert force(answer, "s.1.tension") == pytest.approx(13.734, rel=4 * EPS)
    assert force(answer, "s.2.tension") == pytest.approx(17.658, rel=4 * EPS)
    assert force(answer, "axle.y") == pytest.approx(51.012, rel=4 * EPS)


def double_pendulum(m: Any, l: Any, inertia: Any, g: Any, start: list[Any]) -> Any:  # noqa: E741
    """Lagrange's equations of two rods, each of length 2 l: angles from the x axis, by hand."""

    def rate(a: Any, b: Any, p: Any, q: Any) -> list[Any]:
        c, s = mpmath.cos(a - b), mpmath.sin(a - b)
        m11, m12, m22 = inertia + 5 * m * l**2, 2 * m * l**2 * c, inertia + m * l**2
        f1 = -2 * m * l**2 * s * q**2 - 3 * m * g * l * mpmath.cos(a)
        f2 = 2 * m * l**2 * s * p**2 - m * g * l * mpmath.cos(b)
        d = m11 * m22 - m12**2
        return [p, q, (f1 * m22 - f2 * m12) / d, (f2 * m11 - f1 * m12) / d]

    return lambda t: integrated(rate, start, t) if t else start


def test_double_pendulum_of_rods_agrees_with_lagrange() -> None:
    times = [0.0, 0.4, 1.0]
    answer = solve_scene(read(TWO_RODS), times)
    assert (answer.model.name, answer.model.coordinates, answer.model.rows) == ("Taylor series", 4, 2)
    assert answer.model.described == (8, 6)
    with mpmath.workdps(30):
        oracle = double_pendulum(
            mpmath.mpf(1), mpmath.mpf("0.5"), mpmath.mpf("0.0833"), mpmath.mpf("9.81"), [0, mpmath.pi / 2, 0, 0]
        )
        for i, t in enumerate(times):
            expected = oracle(t)
            for k, name in enumerate(("one", "two")):
                angle = column(answer, f"{name}.angle")
                assert abs(angle.values[i] - expected[k]) <= angle.error
                rate = column(answer, f"{name}.angular_velocity")
                assert abs(rate.values[i] - expected[2 + k]) <= rate.error
    assert column(answer, "one.angle").error < 1e-13


def test_double_pendulum_of_points_at_reference_values() -> None:
    scene = read(points((1, 1), (1, -0.5), (1, 1)))
    answer = solve_scene(scene, [1.0], outputs=("trajectory", "forces-in-time"))
    x, y = column(answer, "p0.position").values[0]
    assert math.atan2(x, -y) == pytest.approx(-0.82194943572101677, abs=1e-14)
    u, v = column(answer, "p1.position").values[0] - (x, y)
    assert math.atan2(u, -v) == pytest.approx(0.29181553578655226, abs=1e-14)
    tension = column(answer, "r0.force")
    assert abs(tension.values[0] - 10.370139833611142) <= tension.error
    assert tension.error < 1e-11


def test_long_double_pendulum_is_answered_by_pairs_where_doubles_do_not_reach() -> None:
    coarse = solve_scene(read(TWO_RODS), [10.0], accuracy=1e-3)
    fine = solve_scene(read(TWO_RODS), [10.0], accuracy=1e-14)
    a, b = column(coarse, "two.position"), column(fine, "two.position")
    assert b.error < 1e-14 < a.error < 1e-7
    assert np.linalg.norm(a.values - b.values) <= a.error


@pytest.mark.parametrize("amplitude", ["2.5", "0.001", "3.1"])
def test_pendulum_period_is_the_complete_integral(amplitude: str) -> None:
    scene = read(points((1,), (amplitude,), (1,)))
    times = [1e9, 0.3, -2.0, 1e5]
    answer = solve_scene(scene, times)
    assert answer.model.name == "one period"
    with mpmath.workdps(50):
        omega, a = mpmath.sqrt(mpmath.mpf("9.81")), mpmath.mpf(amplitude)
        m = mpmath.sin(a / 2) ** 2
        period = 4 * mpmath.ellipk(m) / omega
        assert answer.period == pytest.approx(float(period), rel=2 * EPS)
        for i, t in enumerate(times):
            # From rest: sin(theta/2) = k cd(omega t)
            s = mpmath.sin(a / 2) * mpmath.ellipfun("cd", omega * mpmath.mpf(t), m=m)
            theta = 2 * mpmath.asin(s)
            place = column(answer, "p0.position")
            assert (
                math.hypot(float(place.values[i, 0] - mpmath.sin(theta)), float(place.values[i, 1] + mpmath.cos(theta)))
                <= place.error
            )
    assert column(answer, "p0.position").error < 4e-15


@pytest.mark.parametrize("length", ["1e-3", "1", "1e-150"])
def test_pendulum_in_the_strongest_gravity_that_is_read(length: str) -> None:
    scene = {
        "gravity": [0, -1e300],
        "bodies": {"bob": {"mass": 1, "at": [length, 0]}},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    }
    with mpmath.workdps(50):
        period = 4 * mpmath.ellipk(mpmath.mpf(1) / 2) * mpmath.sqrt(mpmath.mpf(length) / mpmath.mpf(10) ** 300)
    found = solve_scene(read(scene)).period
    assert found == pytest.approx(float(period), rel=1e-15, abs=0)
    with pytest.raises(NotApplicable, match="leaves the range of doubles"):
        solve_scene(read(scene), [1.0])


def test_circulating_pendulum_winds_on() -> None:
    body = {"mass": 1, "inertia": 0, "at": [0, -1], "angle": 0, "velocity": [7, 0], "places": {"top": [0, 1]}}
    scene = read(
        {"gravity": [0, -9.81], "bodies": {"p": body}, "connections": [{"kind": "pin", "a": "p.top", "b": [0, 0]}]}
    )
    times = [0.0, 5.0, 1000.0, -3.0]
    answer = solve_scene(scene, times)
    assert answer.model.name == "one period"
    with mpmath.workdps(40):
        # theta/2 = am(omega_0 t/(2 ...)): theta'^2 = 49 - 4 g sin^2(theta/2), so theta/2 = am(7 t/2 | 4 g/49).
        m = 4 * mpmath.mpf("9.81") / 49
        quarter = mpmath.ellipk(m)
        for i, t in enumerate(times):
            u = mpmath.mpf(7) * mpmath.mpf(t) / 2
            turns = mpmath.nint(u / (2 * quarter))
            amplitude = mpmath.asin(mpmath.ellipfun("sn", u - 2 * quarter * turns, m=m)) + mpmath.pi * turns
            angle = column(answer, "p.angle")
            assert abs(angle.values[i] - 2 * amplitude) <= angle.error
        assert answer.period == pytest.approx(float(4 * quarter / 7), rel=2 * EPS)


def test_stone_on_a_string_goes_slack() -> None:
    scene = read(
        {
            "gravity": [0, -9.81],
            "bodies": {"stone": {"mass": 2, "at": [0, -0.5], "velocity": [4, 0]}},
            "connections": [{"kind": "string", "name": "s", "through": ["stone", [0, 0]]}],
        }
    )
    answer = solve_scene(scene, np.linspace(0, 1, 11))
    slack, taut = answer.events
    assert (slack.kind, slack.name, taut.kind, taut.name) == ("slack", "s", "taut", "s")
    assert abs(slack.time - 0.33986875327139788) <= slack.error < 1e-15
    assert abs(taut.time - 0.87122732934228872) <= taut.error < 1e-15
    assert answer.trajectory is not None
    assert len(answer.trajectory.rows) == 11


def test_bead_on_a_turning_hoop_repeats() -> None:
    answer = solve_scene(read(BEAD_ON_HOOP))
    assert answer.period == pytest.approx(2.0782597422067768535, rel=2 * EPS)
    with mpmath.workdps(30):
        # theta'^2 = 2 (E - V): the period is twice the time between the turning points.
        g, w = mpmath.mpf("9.81"), mpmath.mpf(4)
        top = mpmath.mpf("0.8")

        def potential(c: Any) -> Any:
            return -g * c - w**2 * (1 - c**2) / 2

        # 2 (V(0.8) - V(c)) is quadratic in c, and zero again at the other turning point.
        other = 2 * g / w**2 - top
        between = mpmath.quad(
            lambda p: 1 / (w * mpmath.sqrt(1 - ((top + other) / 2 + (top - other) / 2 * mpmath.cos(p)) ** 2)),
            [0, mpmath.pi],
        )
        assert abs(potential(top) - potential(other)) < mpmath.mpf("1e-28")
        assert answer.period == pytest.approx(float(2 * between), rel=2 * EPS)


def test_lagrange_top_nutates_and_precesses() -> None:
    times = [0.1, 0.25, 100.0]
    answer = solve_scene(read(LAGRANGE_TOP), times)
    assert answer.model.name == "one period"
    assert answer.period == pytest.approx(0.507759021739141, abs=1e-15)
    assert answer.model.apart[0].precession == pytest.approx(1.391015037306294, abs=1e-15)
    with mpmath.workdps(40):
        # u = cos(theta): u'^2 = (1 - u^2) (2E' - 2K u)/I - (b - a u)^2/I^2, and u between its roots by sn^2.
        moment, p, k = mpmath.mpf("0.05"), mpmath.mpf("0.8"), mpmath.mpf("1.962")
        b, e = p * mpmath.mpf("0.8"), 2 * k * mpmath.mpf("0.8")
        roots = sorted(
            mpmath.polyroots(
                [
                    e / moment - b**2 / moment**2,
                    2 * b * p / moment**2 - 2 * k / moment,
                    -e / moment - p**2 / moment**2,
                    2 * k / moment,
                ],
                maxsteps=500,
                extraprec=200,
                asc=True,
            ),
            key=lambda root: root.real,
        )  # fmt: skip
        u1, u2, u3 = (root.real for root in roots)
        alpha = mpmath.sqrt(k * (u3 - u1) / (2 * moment))
        m = (u2 - u1) / (u3 - u1)
        assert answer.period == pytest.approx(float(2 * mpmath.ellipk(m) / alpha), rel=4 * EPS)
        axis = column(answer, "top.axis")
        for i, t in enumerate(times):
            # From the upper turning point the phase starts at a quarter period.
            u = u1 + (u2 - u1) * mpmath.ellipfun("sn", alpha * mpmath.mpf(t) + mpmath.ellipk(m), m=m) ** 2
            assert abs(axis.values[i, 2] - u) <= axis.error
    assert axis.error < 4e-15


def regular_top(rate: str) -> dict[str, Any]:
    return {
        "gravity": [0, 0, -9.81],
        "let": {
            "c": "cos(0.8)", "s": "sin(0.8)", "L": "0.002*150", "d": "sqrt(L*L - 4*0.012*9.81*0.1*c)", "W": rate,
        },
        "bodies": {
            "top": {
                "mass": 1,
                "moments": ["0.012-0.01", "0.012-0.01", 0.002],
                "at": ["0.1*s", 0, "0.1*c"],
                "axes": [["c", 0, "-s"], [0, 1, 0], ["s", 0, "c"]],
                # The spin about the axis contains the part of the precession; across it there is W sin(theta).
                "angular_velocity": ["-W*s", 0, 150],
                "places": {"tip": [0, 0, -0.1]},
            }
        },
        "connections": [{"kind": "pin", "a": "top.tip", "b": [0, 0, 0]}],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("rate", "value"),
    [("2*9.81*0.1/(L+d)", 3.6390508741573294), ("(L+d)/(2*0.012*c)", 32.244054117648667)],
)
def test_regular_precession_is_a_steady_turn(rate: str, value: float) -> None:
    answer = solve_scene(read(regular_top(rate)), [0.0, 0.37, 1e6])
    assert answer.model.name == "steady precession"
    axis = column(answer, "top.axis").values
    with mpmath.workdps(40):
        c = mpmath.cos(mpmath.mpf("0.8"))
        root = mpmath.sqrt(mpmath.mpf("0.09") - 4 * mpmath.mpf("0.012") * mpmath.mpf("0.981") * c)
        slow = 2 * mpmath.mpf("0.981") / (mpmath.mpf("0.3") + root)
        turn = slow if value < 10 else (mpmath.mpf("0.3") + root) / (2 * mpmath.mpf("0.012") * c)
        assert float(turn) == pytest.approx(value, rel=2 * EPS)
        for i, t in enumerate((mpmath.mpf(0), mpmath.mpf(0.37), mpmath.mpf(1e6))):
            assert axis[i, 0] == pytest.approx(float(mpmath.sin(mpmath.mpf("0.8")) * mpmath.cos(turn * t)), abs=4 * EPS)
            assert axis[i, 1] == pytest.approx(float(mpmath.sin(mpmath.mpf("0.8")) * mpmath.sin(turn * t)), abs=4 * EPS)


def test_wall_spring_mass_spring_mass() -> None:
    scene = read(
        {
            "gravity": [0, 0],
            "bodies": {"p": {"mass": 1, "at": [1.2, 0]}, "q": {"mass": 1, "at": [2.1, 0], "velocity": [0.3, 0]}},
            "connections": [
                {"kind": "spring", "a": [0, 0], "b": "p", "stiffness": 1, "rest_length": 1},
                {"kind": "spring", "a": "p", "b": "q", "stiffness": 1, "rest_length": 1},
            ],
        }
    )
    times = [0.0, 1.0, 100.0]
    answer = solve_scene(scene, times)
    assert answer.model.name == "modes"
    frequencies = [mode[0] for mode in answer.model.apart[0].modes]
    assert frequencies == pytest.approx([0.61803398874989485, 1.6180339887498948], rel=2 * EPS)
    with mpmath.workdps(30):
        phi = (mpmath.sqrt(5) + 1) / 2
        d = [mpmath.mpf("0.2"), mpmath.mpf("0.1")]
        norm = 1 + phi**2
        for i, t in enumerate(times):
            x = [mpmath.mpf(0), mpmath.mpf(0)]
            for w, e in ((1 / phi, [mpmath.mpf(1), phi]), (phi, [phi, mpmath.mpf(-1)])):
                a = (d[0] * e[0] + d[1] * e[1]) / norm
                r = mpmath.mpf("0.3") * e[1] / norm
                shape = a * mpmath.cos(w * t) + r / w * mpmath.sin(w * t)
                x = [x[0] + shape * e[0], x[1] + shape * e[1]]
            for k, (name, rest) in enumerate((("p", 1), ("q", 2))):
                place = column(answer, f"{name}.position")
                assert abs(place.values[i, 0] - (rest + x[k])) <= place.error < 1e-14


def test_beam_pinned_twice_is_determined_vertically_only() -> None:
    beam = {"mass": 3, "inertia": 1, "at": [0, 0], "places": {"l": [-1, 0], "r": [1, 0]}}
    scene = read(
        {
            "gravity": [0, -9.81],
            "bodies": {"beam": beam},
            "connections": [
                {"kind": "pin", "name": "left", "a": "beam.l", "b": [-1, 0]},
                {"kind": "pin", "name": "right", "a": "beam.r", "b": [1, 0]},
            ],
        }
    )
    answer = solve_scene(scene, [0.0, 5.0])
    assert force(answer, "left.y") == pytest.approx(14.715, rel=2 * EPS)
    assert answer.forces is not None
    assert not answer.forces["left.x"].determined
    assert answer.forces["left.x"].shared_with == ("left", "right")
    assert answer.model.name == "rest"


def shafts(masses: tuple[Any, Any], radii: tuple[Any, Any], slopes: tuple[Any, Any]) -> dict[str, Any]:
    """Two shafts on the faces of a wedge, whose string runs along the faces over the apex."""
    (m1, m2), (r1, r2), (a, b) = masses, radii, slopes
    along1, normal1 = [f"-cos({a})", f"-sin({a})"], [f"-sin({a})", f"cos({a})"]
    along2, normal2 = [f"cos({b})", f"-sin({b})"], [f"sin({b})", f"cos({b})"]
    centre1 = [f"2*({along1[i]}) + {r1}*({normal1[i]})" for i in range(2)]
    centre2 = [f"3*({along2[i]}) + {r2}*({normal2[i]})" for i in range(2)]
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "one": {"mass": m1, "radius": r1, "inertia": f"{m1}*{r1}*{r1}/2", "at": centre1},
            "two": {"mass": m2, "radius": r2, "inertia": f"{m2}*{r2}*{r2}/2", "at": centre2},
        },
        "connections": [
            {"kind": "track", "name": "face1", "place": "one",
             "on": {"at": [f"{r1}*({x})" for x in normal1], "slope": a}},
            {"kind": "track", "name": "face2", "place": "two",
             "on": {"at": [f"{r2}*({x})" for x in normal2], "slope": f"-({b})"}},
            {"kind": "string", "name": "s", "through": ["one", [0, 0], "two"],
             "sides": {"one": "below", "two": "below"}},
        ],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("masses", "radii", "slopes"),
    [((1, 2), (0.1, 0.2), (0.5, 0.8)), ((3, 0.5), (0.05, 0.15), (1.2, 0.3))],
)
def test_unwinding_shafts_agree_with_the_named_scene(masses: Any, radii: Any, slopes: Any) -> None:
    answer = solve_scene(read(shafts(masses, radii, slopes)), [0.5])
    named = UnwindingShafts(
        masses=tuple(map(float, masses)), radii=tuple(map(float, radii)), slopes=tuple(map(float, slopes)), gravity=9.81
    )  # fmt: skip
    with precision(BITS):
        figures = named.figures()
        tension = float(figures["tension"]())
        down = [float(x) for x in figures["accelerations"]()]
        spins = [float(x) for x in figures["angular_accelerations"]()]
        loads = [float(x) for x in figures["normal_forces"]()]
    assert answer.model.name == "constant acceleration"
    assert force(answer, "s.tension") == pytest.approx(tension, rel=8 * EPS)
    assert answer.accelerations is not None
    for i, (name, way) in enumerate((("one", -1), ("two", 1))):
        slope = float(slopes[i])
        expected = (way * down[i] * math.cos(slope), -down[i] * math.sin(slope))
        assert linear(answer, name) == pytest.approx(expected, rel=8 * EPS)
        assert abs(answer.accelerations[name].angular) == pytest.approx(spins[i], rel=8 * EPS)  # type: ignore[arg-type]
        assert force(answer, f"face{i + 1}.normal") == pytest.approx(loads[i], rel=8 * EPS)


def test_unwinding_shafts_at_reference_values() -> None:
    answer = solve_scene(read(shafts((2, 1), (0.1, 0.2), (0.5, 0.9))))
    assert force(answer, "s.tension") == pytest.approx(2.752800337, abs=5e-10)
    gains = [math.hypot(*linear(answer, name)) for name in ("one", "two")]
    assert gains == pytest.approx([3.326764365, 4.931636646], abs=5e-10)


def test_times_may_be_negative_and_in_any_order() -> None:
    forth = solve_scene(read(TWO_RODS), [0.7, -0.7, 0.0])
    # At rest the motion is the same in both directions of time.
    place = column(forth, "two.position")
    assert np.linalg.norm(place.values[0] - place.values[1]) <= 2 * place.error
    assert place.values[2] == pytest.approx((1.0, 0.5), abs=EPS)


@pytest.mark.parametrize(
    ("times", "outputs", "accuracy", "path"),
    [
        ([float("nan")], ("forces",), 1e-9, ("times", 0)),
        ([[1.0]], ("forces",), 1e-9, ("times",)),
        ([1.0], ("colour",), 1e-9, ("outputs", 0)),
        ([1.0], ("forces",), 0.0, ("accuracy",)),
    ],
)
def test_bad_questions_are_refused_with_their_path(times: Any, outputs: Any, accuracy: float, path: Any) -> None:
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(read(TWO_RODS), times, outputs, accuracy)
    assert refused.value.path == path


def test_what_no_pairs_reach_is_refused_with_what_can_be() -> None:
    with pytest.raises(AccuracyUnreachable) as refused:
        solve_scene(read(TWO_RODS), [100.0], accuracy=1e-9)
    assert refused.value.achievable > 1e-9


def test_too_many_samples_are_refused() -> None:
    with pytest.raises(BudgetExceeded):
        solve_scene(read(TWO_RODS), np.zeros(1_000_000))


def arm(at: list[Any], angle: Any, length: Any) -> dict[str, Any]:
    ends = {"l": [f"-{length}/2", 0], "r": [f"{length}/2", 0]}
    return {"mass": 1, "inertia": 0.1, "at": at, "angle": angle, "places": ends}


def parallelogram(angle: str) -> dict[str, Any]:
    c, s = f"cos({angle})", f"sin({angle})"
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "a": arm([f"0.5*{c}", f"0.5*{s}"], angle, 1),
            "b": arm([f"2+0.5*{c}", f"0.5*{s}"], angle, 1),
            "m": arm([f"1+0.5*{c}", f"0.5*{s}"], angle, 1),
            "c": arm([f"1+{c}", s], 0, 2),
        },
        "connections": [
            {"kind": "pin", "a": "a.l", "b": [0, 0]},
            {"kind": "pin", "a": "b.l", "b": [2, 0]},
            {"kind": "pin", "a": "m.l", "b": [1, 0]},
            {"kind": "pin", "a": "c.l", "b": "a.r"},
            {"kind": "pin", "a": "c.r", "b": "b.r"},
            {"kind": "pin", "name": "more", "a": "c", "b": "m.r"},
        ],
    }


def test_a_parallelogram_with_three_cranks_swings_as_a_pendulum() -> None:
    answer = solve_scene(read(parallelogram("-1.2")), [0.0, 1.0, 4.0])
    assert answer.model.degrees_of_freedom == 1
    assert any(sentence.startswith("more partly repeats what ") for sentence in answer.model.noticed)
    with mpmath.workdps(30):
        # Cranks turn about their ends, the coupler does not turn: I = 3 (0.1 + 1/4) + 1, moment = 3/2 + 1.
        omega = mpmath.sqrt(mpmath.mpf("9.81") * mpmath.mpf("2.5") / mpmath.mpf("2.05"))
        m = mpmath.sin((mpmath.pi / 2 - mpmath.mpf("1.2")) / 2) ** 2
        assert answer.period == pytest.approx(float(4 * mpmath.ellipk(m) / omega), rel=2 * EPS)


def test_a_flat_parallelogram_is_a_singular_place() -> None:
    with pytest.raises(InvalidParameter, match="singular place"):
        solve_scene(read(parallelogram("0")))


def test_a_pendulum_on_its_separatrix_is_followed_for_a_while() -> None:
    bob = {"mass": 1, "at": [0, -1], "velocity": ["sqrt(4*9.81)", 0]}
    scene = {"gravity": [0, -9.81], "bodies": {"p": bob}, "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}]}
    answer = solve_scene(read(scene), [1.5])
    assert answer.period is None
    with mpmath.workdps(30):
        # theta = 2 gd(omega t)
        theta = 2 * mpmath.atan(mpmath.sinh(mpmath.sqrt(mpmath.mpf("9.81")) * mpmath.mpf("1.5"))) * 1
        place = column(answer, "p.position")
        away = (place.values[0, 0] - mpmath.sin(theta), place.values[0, 1] + mpmath.cos(theta))
        assert mpmath.hypot(*away) <= place.error < 1e-11


def test_weights_that_reach_the_pulley_end_the_scene() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"m": {"mass": 3, "at": [-1, -1]}, "b": {"mass": 1, "at": [1, -1]}},
        "connections": [{"kind": "string", "name": "s", "through": ["m", [-1, 0], [1, 0], "b"]}],
    }
    answer = solve_scene(read(scene), [0.1, 1.0])
    assert answer.ended is not None
    assert (answer.ended.kind, answer.ended.name) == ("singular", "s")
    # One metre at g/2
    assert answer.ended.time == pytest.approx(math.sqrt(4 / 9.81), rel=2 * EPS)
    assert answer.trajectory is not None
    assert list(answer.trajectory.rows) == [0]


def test_a_string_that_would_push_is_slack_from_the_start() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"p": {"mass": 1, "at": [0, 1]}},
        "connections": [{"kind": "string", "name": "s", "through": ["p", [0, 0]]}],
    }
    answer = solve_scene(read(scene), [0.0, 0.5])
    assert force(answer, "s.tension") == 0.0
    assert answer.phases is not None
    assert [phase.states for phase in answer.phases] == [{"s": "open"}]
    assert column(answer, "p.position").values[-1] == pytest.approx([0, 1 - 9.81 / 8], rel=1e-15)


def test_parts_that_see_nothing_of_each_other_have_models_of_their_own() -> None:
    scene = points((1,), ("0.4",), (1,))
    scene["bodies"]["stone"] = {"mass": 1, "at": [5, 5], "velocity": [1, 2]}
    answer = solve_scene(read(scene), [0.5])
    assert answer.model.name == "parts apart"
    assert sorted(part.name for part in answer.model.apart) == ["constant acceleration", "constant acceleration",
                                                                "one period"]  # fmt: skip
    assert column(answer, "stone.position").values[0] == pytest.approx((5.5, 6 - 9.81 / 8), rel=2 * EPS)


def test_free_asymmetric_body_keeps_momentum_and_energy() -> None:
    body = {"mass": 1, "at": [0, 0, 0], "moments": [1, 2, 3], "angular_velocity": [0.1, 1, 0.1]}
    answer = solve_scene(read({"gravity": [0, 0, 0], "bodies": {"b": body}}), [0.0, 7.0, 20.0])
    spin = column(answer, "b.angular_velocity")
    moments = np.array([1, 2, 3])
    momentum = np.linalg.norm(spin.values * moments, axis=1)
    assert momentum == pytest.approx(momentum[0], abs=10 * spin.error)
    with mpmath.workdps(25):

        def rate(u: Any, v: Any, w: Any) -> list[Any]:
            return [-v * w, w * u, -u * v / 3]

        expected = integrated(rate, ["0.1", 1, "0.1"], 7)
        assert mpmath.norm([spin.values[1, k] - expected[k] for k in range(3)]) <= spin.error


def test_angles_of_bodies_in_different_parts_are_followed_apart() -> None:
    one = {"mass": 1, "inertia": 0.1, "at": [0, -1], "velocity": [9, 0], "places": {"top": [0, 1]}}
    two = {"mass": 1, "inertia": 0.2, "at": [5, -1], "velocity": [-20, 0], "places": {"top": [0, 1]}}
    pins = [{"kind": "pin", "a": "one.top", "b": [0, 0]}, {"kind": "pin", "a": "two.top", "b": [5, 0]}]
    both = solve_scene(
        read({"gravity": [0, -9.81], "bodies": {"one": one, "two": two}, "connections": pins}), [7.3, -2]
    )
    for name, body, pin in (("one", one, pins[0]), ("two", two, pins[1])):
        alone = solve_scene(read({"gravity": [0, -9.81], "bodies": {name: body}, "connections": [pin]}), [7.3, -2])
        together, apart = column(both, f"{name}.angle"), column(alone, f"{name}.angle")
        assert np.abs(together.values - apart.values).max() <= together.error + apart.error
        assert np.abs(apart.values).max() > 8


@pytest.mark.parametrize("distance", ["1", "1.05"])
@pytest.mark.parametrize("direction", [["0", "0", "-1"], ["0", "0.8", "-0.6"], ["0.48", "0.64", "-0.6"]])
def test_a_spring_that_loses_its_length_ends_the_scene_in_every_direction(distance: str, direction: list[str]) -> None:
    """1 kg from rest on 10 N/m of 0.5 m: its length 0.5 + (d - 0.5) cos(sqrt(10) t) passes zero or turns back there."""
    body = {"mass": 1, "at": [f"{distance}*{x}" for x in direction]}
    spring = {"kind": "spring", "name": "s", "a": "b", "b": [0, 0, 0], "stiffness": 10, "rest_length": 0.5}
    ended = solve_scene(read({"gravity": [0, 0, 0], "bodies": {"b": body}, "connections": [spring]}), [1.0]).ended
    assert ended is not None
    assert (ended.kind, ended.name) == ("singular", "s")
    right = math.acos(-0.5 / (float(distance) - 0.5)) / math.sqrt(10)
    assert abs(ended.time - right) <= ended.error < 1e-6
