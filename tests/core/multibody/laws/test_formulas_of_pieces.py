"""Forces by formulas that change their piece, and speeds that pass through zero, against closed forms and mpmath."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When

Exact = Callable[[mp.mpf], Sequence[mp.mpf]]


def scene(force: Sequence[Any], gravity: Sequence[Any] = (0, 0), **body: Any) -> dict[str, Any]:
    push = {"kind": "force", "name": "f", "place": "p", "force": list(force)}
    bodies = {"p": {"mass": 1, "at": [0, 0]} | body}
    return {"gravity": list(gravity), "bodies": bodies, "connections": [push]}


def answer(
    description: dict[str, Any], times: Sequence[float], outputs: Sequence[Any] = ("trajectory", "forces-in-time")
) -> SceneSolution:
    return solve_scene(scene_from(description), np.array(times), outputs)


def compared(found: SceneSolution, column: str, exact: Exact) -> None:
    assert found.trajectory is not None
    own = found.trajectory.columns[column]
    with mp.workdps(40):
        wanted = np.array([[float(x) for x in exact(mp.mpf(t))] for t in found.trajectory.time.tolist()])
    assert np.max(np.abs(own.values - wanted)) <= own.error + 2.0**-52 * np.max(np.abs(wanted))
    assert own.error < 1e-11


def ramp(t: mp.mpf) -> mp.mpf:
    """Return the velocity under the force |t - 1|."""
    return (1 - (1 - t) * abs(1 - t)) / 2


def wave(t: mp.mpf) -> mp.mpf:
    """Return the velocity under a force that is 1 and -1 by turns, for one second each."""
    return abs(t - 2 * mp.floor(t / 2 + mp.mpf(1) / 2))


@pytest.mark.parametrize(
    ("formula", "rate"),
    [
        ("abs(t - 1)", ramp),
        ("max(t - 1, 1 - t)", ramp),
        ("min(t, 1)", lambda t: t**2 / 2 if t < 1 else t - mp.mpf(1) / 2),
        ("if(t - 1, 2, 0)", lambda t: 2 * max(t - 1, 0)),
        ("if(t - 1, 0, 1/(2 - t))", lambda t: mp.log(2 / (2 - min(t, 1)))),
        ("sign(sin(pi*t))", wave),
    ],
)
def test_a_force_of_time_in_pieces(formula: str, rate: Callable[[mp.mpf], mp.mpf]) -> None:
    compared(answer(scene([formula, 0]), [0.0, 0.5, 0.999, 1.7, 3.2]), "p.velocity", lambda t: [rate(t), 0])


def test_a_body_between_two_forces_that_are_constant() -> None:
    """x'' = -sign(x): parabolas of which each takes 2 sqrt(2) s."""

    def place(t: mp.mpf) -> mp.mpf:
        half = mp.sqrt(8)
        turns = mp.floor((t + mp.sqrt(2)) / half)
        s = t - turns * half
        return (-1) ** int(turns) * (1 - s**2 / 2)

    compared(answer(scene(["-sign(x)", 0], at=[1, 0]), [0.0, 1.0, 2.0, 10.0]), "p.position", lambda t: [place(t), 0])


def test_forces_that_are_constant_on_their_piece_are_in_no_potential() -> None:
    """Of x'' = 3 - sign(x) from 1 the weight of 3 N alone has one: -3 x with x = 1 + t^2, which is -3.75 at 1/2 s."""
    outputs = ("trajectory", "energy-in-time", When("energy.potential", "-3.75"))
    found = answer(scene(["-sign(x)", 0], [3, 0], at=[1, 0]), [0.0, 0.5, 1.0], outputs)
    assert found.trajectory is not None
    columns = found.trajectory.columns
    np.testing.assert_allclose(columns["energy.potential"].values, [-3, -3.75, -6], rtol=1e-14)
    np.testing.assert_allclose(columns["energy.kinetic"].values, [0, 0.5, 2], atol=1e-14)
    assert found.occurrences is not None
    assert [one.time for one in found.occurrences] == pytest.approx([0.5], abs=1e-14)


def test_a_spring_by_a_square_has_its_largest_speed_in_the_middle() -> None:
    """x'' = -|x| x from 1 at rest: v^2 = 2 (1 - |x|^3)/3, and a quarter of a period is an integral."""
    outputs = ("trajectory", ExtremesOf("p.velocity.x"), When("p.position.x", 0))
    found = answer(scene(["-abs(x)*x", 0], at=[1, 0]), [0.0, 4.0], outputs)
    assert found.extremes is not None
    assert found.occurrences is not None
    assert found.extremes[0].least == pytest.approx(-np.sqrt(2 / 3), abs=1e-15)
    with mp.workdps(30):
        # By x = 1 - s^2 the integrand has no singularity.
        quarter = mp.quad(lambda s: 2 * mp.sqrt(mp.mpf(3) / 2) / mp.sqrt(3 - 3 * s**2 + s**4), [0, 1])
    assert found.occurrences[0].time == pytest.approx(float(quarter), rel=1e-14)


def test_a_tilted_throw_with_quadratic_drag_comes_back() -> None:
    """As upright, with u = g = 10: v = u tan(T - t) up to T = pi/4, and u tanh(T - t) from there."""

    def rate(t: mp.mpf) -> mp.mpf:
        return 10 * (mp.tan(mp.pi / 4 - t) if t < mp.pi / 4 else mp.tanh(mp.pi / 4 - t))

    found = answer(scene(["-speed*vx/10", "-speed*vy/10"], [-6, -8], velocity=[6, 8]), [0.0, 0.3, 0.8, 2.0])
    compared(found, "p.velocity", lambda t: [mp.mpf(6) / 10 * rate(t), mp.mpf(8) / 10 * rate(t)])


def test_a_speed_that_is_written_out_is_the_speed() -> None:
    force, written = (
        answer(scene([f"-{speed}*vx/10", f"-{speed}*vy/10"], [-6, -8], velocity=[6, 8]), [0.0, 0.8, 2.0]).trajectory
        for speed in ("speed", "sqrt(vx^2 + vy*vy)")
    )
    assert force is not None
    assert written is not None
    np.testing.assert_array_equal(*(one.columns["p.velocity"].values for one in (force, written)))


def test_a_root_does_not_go_on_with_its_other_branch() -> None:
    found = answer(scene([0, "-0.1*(vy^2)^0.5*vy"], [0, -10], velocity=[0, 10]), [0.0, 0.5, 2.0])
    assert found.ended is not None
    assert found.ended.kind == "formula"
    # v' = -10 - v^2/10 from 10 on: v = 10 tan(pi/4 - t).
    assert found.ended.time == pytest.approx(np.pi / 4, abs=1e-8)


def test_a_pendulum_swings_with_quadratic_drag() -> None:
    """Between the turns E = cos(a) and w^2 are related by a linear equation: d(w^2)/da = -2 g sin(a) -+ 2 c w^2."""
    rod = {"kind": "rod", "a": "p", "b": [0, 0]}
    swing = scene(["-0.3*speed*vx", "-0.3*speed*vy"], [0, -10], at=[1, 0])
    swing["connections"].append(rod)
    outputs = ("trajectory", When("p.velocity.x", 0))
    found = answer(swing, [0.0, 4.0], outputs)
    assert found.occurrences is not None
    c, g = mp.mpf("0.3"), mp.mpf(10)

    def turn(a: mp.mpf) -> mp.mpf:
        """Return the angle from below at which a swing turns that starts at rest at an angle on the other side."""

        def square(b: mp.mpf) -> mp.mpf:
            integral = mp.quad(lambda s: -2 * g * mp.sin(s) * mp.exp(2 * c * s), [-a, b])
            return mp.exp(-2 * c * b) * integral

        return mp.findroot(square, a * mp.mpf("0.7"))

    with mp.workdps(25):
        first = turn(mp.pi / 2)
        second = turn(first)
    turns = [one for one in found.occurrences if abs(one.time) > 0]
    assert found.trajectory is not None
    places = answer(swing, [turns[0].time], ("trajectory",)).trajectory
    assert places is not None
    # At a turn the velocity vanishes with its direction: x = sin(a) and y = -cos(a).
    np.testing.assert_allclose(
        places.columns["p.position"].values[0], [-float(mp.sin(first)), -float(mp.cos(first))], atol=1e-13
    )
    assert second < first


def test_a_ball_bounces_upright_with_quadratic_drag() -> None:
    """From the second touch on as by formulas: v0^2 falls to v0^2/(1 + c v0^2/g) on the way up and down."""
    ball = scene(["-speed*vx/10", "-speed*vy/10"], [0, -10], at=[0, 2])
    ball["connections"].append(
        {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}, "restitution": 0.5}
    )
    found = answer(ball, [0.0, 2.0])
    with mp.workdps(30):
        # With u = g = 10: a fall from h takes acosh(exp(h/10)), and hits at 10 sqrt(1 - exp(-h/5)).
        first, speed = mp.acosh(mp.exp(mp.mpf(2) / 10)), 10 * mp.sqrt(1 - mp.exp(-mp.mpf(2) / 5))
        up = mp.atan(speed / 20)
        height = -10 * mp.log(mp.cos(up))
        second = first + up + mp.acosh(mp.exp(height / 10))
        end = first
        for _ in range(100):
            up = mp.atan(speed / 20)
            fall = mp.acosh(1 / mp.cos(up))
            end, speed = end + up + fall, 10 * mp.tanh(fall)
    times = [event.time for event in found.events]
    np.testing.assert_allclose(times[:2], [float(first), float(second)], rtol=1e-14)
    assert found.events[-1].kind == "settle"
    assert abs(times[-1] - float(end)) <= found.events[-1].error + 2.0**-52


def test_a_one_sided_spring_beside_a_wall() -> None:
    """A body meets a spring that only pushes, comes back as fast, and bounces off a wall at half the speed."""
    description = scene(["max(0, 50*(1 - x))", 0], at=[2, 0], velocity=[-1, 0])
    wall = {"kind": "contact", "name": "wall", "place": "p", "on": {"at": [5, 0], "slope": "pi/2"}, "restitution": 0.5}
    description["connections"].append(wall)
    found = answer(description, [0.0, 1.5, 6.0])
    back = 1 + np.pi / np.sqrt(50)
    assert [(event.kind, event.name) for event in found.events] == [("switch", "f")] * 2 + [("touch", "wall")]
    assert [event.time for event in found.events] == pytest.approx([1, back, back + 4], rel=1e-14)
    assert found.trajectory is not None
    assert found.trajectory.columns["p.position"].values[2, 0] == pytest.approx(5 - (6 - back - 4) / 2, rel=1e-14)


def test_a_force_against_the_slip_stops_a_body_and_says_no_more() -> None:
    compared(answer(scene(["-sign(vx)", 0], velocity=[1, 0]), [0.0, 0.9]), "p.velocity", lambda t: [1 - t, 0])
    found = answer(scene(["-sign(vx)", 0], velocity=[1, 0]), [0.0, 1.0, 2.0])
    assert found.problem is not None
    assert (found.problem.code, found.problem.time, found.problem.connections) == ("formula", 1.0, ("f",))
    assert found.trajectory is not None
    assert found.trajectory.ended == "formula"
    assert found.trajectory.time.tolist() == [0.0, 1.0]
    with pytest.raises(InvalidParameter, match="lead away from the zero"):
        answer(scene(["0.5 - sign(vx)", 0]), [0.0, 2.0])


def test_a_force_that_overcomes_a_sign_starts_a_body() -> None:
    compared(answer(scene(["3 - sign(vx)", 0]), [0.0, 1.0, 2.0]), "p.velocity", lambda t: [2 * t, 0])


def test_a_sign_of_what_stays_zero_is_zero() -> None:
    compared(answer(scene(["1 + sign(y)", 0]), [0.0, 1.0]), "p.velocity", lambda t: [t, 0])


@pytest.mark.parametrize("half", ["1/10", "1/300", "1/10000"])
@pytest.mark.parametrize("of", ["t", "x"])
def test_a_force_that_acts_for_a_short_time_is_not_passed_over(half: str, of: str) -> None:
    """Within half a width of t = 1/2 or x = 1/2 it gives a momentum, or does a work, of 1/10."""
    force = f"if(({half})^2 - ({of} - 1/2)^2, 1/(20*({half})), 0)"
    found = answer(scene([force, 0], velocity=[1, 0]), [1, 2])
    right = 1.1 if of == "t" else float(np.sqrt(1.2))
    assert found.trajectory is not None
    own = found.trajectory.columns["p.velocity"]
    assert np.max(np.abs(own.values[:, 0] - right)) <= own.error < 1e-12


@pytest.mark.parametrize("width", ["1/10", "1/300", "1/10000"])
def test_of_three_changes_the_first_two_are_not_passed_over_for_the_last(width: str) -> None:
    """A force of 1/(10 w) within w after t = 1/2, and again from t = 1.9 on."""
    force = f"if((t - 1/2)*(t - 1/2 - {width})*(t - 1.9), 1/(10*({width})), 0)"
    found = answer(scene([force, 0], velocity=[1, 0]), [1, 1.8])
    assert found.trajectory is not None
    own = found.trajectory.columns["p.velocity"]
    assert np.max(np.abs(own.values[:, 0] - 1.1)) <= own.error < 1e-12


@pytest.mark.parametrize("apart", ["1/10", "1/1000", "1/10000", "1/100000"])
def test_a_speed_that_is_zero_twice_in_short_turn_has_both_corners(apart: str) -> None:
    """The velocity is (3, 4)(t - 1/2)(t - 1/2 - d)/5, whose size drives another body."""
    description = scene(
        [f"3/5*(2*t - 1 - {apart})", f"4/5*(2*t - 1 - {apart})"],
        velocity=[f"3/10*(1/2 + {apart})", f"2/5*(1/2 + {apart})"],
    )
    description["bodies"]["q"] = {"mass": 1, "at": [9, 0]}
    push = {"kind": "force", "name": "g", "place": "q", "force": ["sqrt(p.vx^2 + p.vy^2)", 0]}
    description["connections"].append(push)
    found = answer(description, [1], ("trajectory", When("p.velocity.x", 0)))
    with mp.workdps(30):
        d = mp.mpf(1) / int(apart[2:])
        half = mp.mpf(1) / 2
        right = mp.quad(lambda t: abs((t - half) * (t - half - d)), [0, half, half + d, 1])
    assert found.trajectory is not None
    own = found.trajectory.columns["q.velocity"]
    assert abs(own.values[0, 0] - float(right)) <= own.error + 2.0**-54
    assert own.error < 1e-11
    assert found.occurrences is not None
    assert [one.time for one in found.occurrences] == pytest.approx([0.5, 0.5 + float(d)], abs=1e-10)


@pytest.mark.parametrize(
    ("formula", "start", "gained"),
    [
        ("if(t, 2, 0)", {}, 2),
        ("if(t^2, 2, 0)", {}, 2),
        ("1 + sign(-t)", {}, 0),
        ("if(x, 2, 0)", {"velocity": [1, 0]}, 2),
        ("if(x, 2, 0)", {"velocity": [-1, 0]}, 0),
        ("if(3*x - 0.9, 2, 0)", {"at": [0.3, 0], "velocity": [1, 0]}, 2),
        ("if(x, 2, 1)", {}, 2),
        ("2 + sign(vx)", {}, 3),
        ("if(atan2(x, 1 - t), 2, 0)", {"velocity": [1, 0]}, 2),
    ],
)
def test_a_force_that_jumps_at_the_start_has_the_value_that_follows(
    formula: str, start: dict[str, Any], gained: float
) -> None:
    found = answer(scene([formula, 0], **start), [0.0, 1.0], ("accelerations", "trajectory"))
    assert found.accelerations is not None
    assert found.accelerations["p"].linear == (gained, 0.0)
    assert found.trajectory is not None
    velocity = found.trajectory.columns["p.velocity"].values
    assert velocity[1, 0] - velocity[0, 0] == pytest.approx(gained, abs=1e-14)


@pytest.mark.parametrize(
    ("law", "forces"),
    [("if(t - 1/2, 2, 0)", [0, 2, 2]), ("if(t, 2, 0)", [2, 2, 2]), ("if(1 - length, 1, 0)", [0, 0, 0])],
)
def test_a_sample_at_a_jump_has_the_force_that_follows(law: str, forces: list[float]) -> None:
    spring = {"kind": "spring", "name": "s", "a": "p", "b": [0, 0], "law": law}
    body = {"p": {"mass": 1, "at": [1, 0], "velocity": [4, 0]}}
    found = answer({"gravity": [0, 0], "bodies": body, "connections": [spring]}, [0.0, 0.5, 1.0])
    assert found.trajectory is not None
    assert found.trajectory.columns["s.force"].values.tolist() == forces


@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize(
    ("formula", "end", "place"),
    [
        ("sqrt(2 - t)", 2, lambda t: 2 ** mp.mpf("1.5") * (10 * t - 8) / 15 + 4 * (2 - t) ** mp.mpf("2.5") / 15),
        ("1/(2 - t)", 2, lambda t: (2 - t) * mp.log(1 - t / 2) + t),
        ("1/(2 - x)", None, None),
    ],
)
def test_a_formula_that_loses_its_value_ends_the_motion(
    formula: str, end: float | None, place: Callable[[mp.mpf], mp.mpf] | None, beside: bool
) -> None:
    """Also in a scene with contacts; v^2/2 = log(2/(2 - x)) from rest, and u = sqrt(log(2/(2 - x))) takes the time."""
    description = scene([formula, 0])
    if beside:
        description["connections"].append({"kind": "contact", "place": "p", "on": {"at": [0, -1]}})
    found = answer(description, [0.0, 1.0, 5.0])
    assert found.problem is not None
    assert (found.problem.code, found.problem.connections) == ("formula", ("f",))
    assert f"where {'x' if 'x' in formula else 't'} = 2" in found.problem.explanation
    with mp.workdps(25):
        right = mp.sqrt(2) * mp.quad(lambda u: 2 * mp.exp(-u * u), [0, mp.inf]) if end is None else end
        assert abs(found.problem.time - right) <= found.problem.error <= 1e-8
    assert found.trajectory is not None
    assert found.trajectory.time.tolist() == [0.0, 1.0]
    if place is not None:
        own = found.trajectory.columns["p.position"]
        assert abs(own.values[1, 0] - float(place(mp.mpf(1)))) <= own.error + 2.0**-52
