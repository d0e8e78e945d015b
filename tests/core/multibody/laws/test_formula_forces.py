"""Motions under forces that are formulas, against closed forms and against Taylor's method of mpmath at 40 digits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.errors import AccuracyUnreachable, InvalidParameter, NotApplicable
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf
from core.systems.methods.runge_kutta_4 import RungeKutta4

TIMES = np.array([0.0, 0.4, 1.1, 2.5])
ALL = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "work-in-time", "energy-in-time")


def answer(description: dict[str, Any], times: Sequence[float] = tuple(TIMES.tolist()), **more: Any) -> SceneSolution:
    return solve_scene(scene_from(description), np.array(times), more.pop("outputs", ALL), **more)


def compared(found: SceneSolution, column: str, exact: Callable[[mp.mpf], Any]) -> None:
    """Require the values of a column to be exact ones, and its error to be no less than the true one."""
    assert found.trajectory is not None
    own = found.trajectory.columns[column]
    mp.mp.dps = 30
    wanted = np.array([np.array(exact(mp.mpf(t)), dtype=np.float64) for t in found.trajectory.time.tolist()])
    apart = np.abs(own.values.reshape(wanted.shape) - wanted)
    assert np.max(apart) <= own.error + 2.0**-52 * np.max(np.abs(wanted))
    assert own.error < 1e-10


def integrated(equation: Callable[..., list[mp.mpf]], start: Sequence[float]) -> Callable[[mp.mpf], list[mp.mpf]]:
    """Return the solution of an initial value problem by mpmath's Taylor series of high order."""
    mp.mp.dps = 30
    return mp.odefun(equation, 0, [mp.mpf(x) for x in start], tol=mp.mpf("1e-22"))


POINT: dict[str, Any] = {"mass": 1, "at": [0, 0]}


def forced(force: Sequence[Any], **more: Any) -> dict[str, Any]:
    body = POINT | more.pop("body", {})
    return {"gravity": [0, 0], "bodies": {"p": body}, **more,
            "connections": [{"kind": "force", "name": "f", "place": "p", "force": list(force)}]}  # fmt: skip


def test_a_body_falls_from_rest_with_quadratic_drag() -> None:
    """v = -u tanh(g t/u) with u^2 = m g/c, y = -(u^2/g) log cosh(g t/u)."""
    scene = forced(["-c*speed*vx", "-c*speed*vy"], let={"c": 0.25}) | {"gravity": [0, "-9.81"]}
    g, u = mp.mpf("9.81"), mp.sqrt(mp.mpf("9.81") / mp.mpf("0.25"))
    found = answer(scene)
    compared(found, "p.velocity", lambda t: [0, -u * mp.tanh(g * t / u)])
    compared(found, "p.position", lambda t: [0, -(u**2) / g * mp.log(mp.cosh(g * t / u))])
    compared(found, "f.work", lambda t: (u * mp.tanh(g * t / u)) ** 2 / 2 - u**2 * mp.log(mp.cosh(g * t / u)))
    assert found.energy is not None
    assert not found.energy.conserved


def test_a_body_that_is_thrown_up_turns_back_with_quadratic_drag() -> None:
    """v = u tan(T - g t/u) up to the top at g t/u = T, and -u tanh(g t/u - T) from there, with u = g = 10, T = pi/4."""
    scene = forced(["-speed*vx/10", "-speed*vy/10"], body={"velocity": [0, 10]}) | {"gravity": [0, -10]}
    top = mp.pi / 4

    def rate(t: mp.mpf) -> mp.mpf:
        return 10 * mp.tan(top - t) if t < top else -10 * mp.tanh(t - top)

    def height(t: mp.mpf) -> mp.mpf:
        if t < top:
            return 10 * mp.log(mp.cos(top - t) / mp.cos(top))
        return -10 * mp.log(mp.cos(top)) - 10 * mp.log(mp.cosh(t - top))

    for times in ([0.0, 0.3, 0.8], [0.0, 0.78539, 2.0]):
        found = answer(scene, times, outputs=("trajectory",))
        compared(found, "p.velocity", lambda t: [0, rate(t)])
        compared(found, "p.position", lambda t: [0, height(t)])


def test_a_pendulum_turns_back_with_quadratic_drag() -> None:
    """The speed has a corner at each turning point, which lies on a circle: angle'' = -10 sin(angle) -+ angle'^2/5."""
    sign, begin, end, now = -1.0, [math.asin(0.6), 0.0], 4.0, 0.0
    while True:
        run = solve_ivp(
            lambda _, y, sign=sign: [y[1], -10.0 * math.sin(y[0]) - sign * y[1] ** 2 / 5.0],
            (now, end),
            begin,
            events=_at_rest(-sign),
            **EXACT,
        )
        if run.status == 0:
            break
        sign, now, begin = -sign, run.t[-1], [run.y[0, -1], 0.0]
    angle, rate = run.y[:, -1]
    scene: dict[str, Any] = {
        "gravity": [0, -10],
        "bodies": {"p": {"mass": 1, "at": [0.6, -0.8]}},
        "connections": [
            {"kind": "rod", "a": "p", "b": [0, 0]},
            {"kind": "force", "place": "p", "force": ["-0.2*speed*vx", "-0.2*speed*vy"]},
        ],
    }
    found = answer(scene, [0.0, 1.04, end], outputs=("trajectory",))
    assert found.trajectory is not None
    own = found.trajectory.columns["p.velocity"]
    assert own.values[2] == pytest.approx([rate * math.cos(angle), rate * math.sin(angle)], abs=1e-12)
    # 0.02 s after the first turning point, by hand to five digits: 10 sin(angle) cos(angle) times the time.
    assert own.values[1] == pytest.approx([0.0953, -0.0578], abs=1e-3)
    assert own.error < 1e-14


EXACT: dict[str, Any] = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "first_step": 1e-3}


def _at_rest(direction: float) -> Callable[..., float]:
    def rate(_: float, y: Sequence[float]) -> float:
        return y[1]

    rate.terminal, rate.direction = True, direction  # type: ignore[attr-defined]
    return rate


def test_a_throw_that_is_almost_upright_turns_back_with_quadratic_drag() -> None:
    """The speed is least where the throw is highest, and has no corner there."""
    run = solve_ivp(
        lambda _, v: [-v[0] * math.hypot(*v) / 10.0, -10.0 - v[1] * math.hypot(*v) / 10.0],
        (0.0, 0.2),
        [1e-3, 1.0],
        **EXACT,
    )
    scene = forced(["-speed*vx/10", "-speed*vy/10"], body={"velocity": ["1e-3", 1]}) | {"gravity": [0, -10]}
    found = answer(scene, [0.0, 0.05, 0.2], outputs=("trajectory",))
    assert found.trajectory is not None
    assert found.trajectory.columns["p.velocity"].values[2] == pytest.approx(run.y[:, -1], abs=1e-12)


@pytest.mark.parametrize("power", [3, 5, 9])
def test_a_series_with_gaps_between_its_powers_takes_steps_as_short(power: int) -> None:
    """From rest against v^n every n-th power of time occurs alone."""
    exact = integrated(lambda t, y: [y[1], -1 - y[1] ** power], [0, 0])
    compared(answer(forced([0, f"-1 - vy^{power}"]), [0.0, 0.4, 1.1], outputs=("trajectory",)), "p.velocity",
             lambda t: [0, exact(t)[1]])  # fmt: skip


def test_a_force_that_begins_beyond_the_order_of_the_series_is_refused() -> None:
    with pytest.raises(AccuracyUnreachable):
        answer(forced([0, "-1 - (vy^8)^8"]), [0.0, 1.5], outputs=("trajectory",))


def test_a_charge_in_crossed_fields_moves_on_a_cycloid() -> None:
    """From rest: x = (E/B)(t - sin(w t)/w), y = (E/(B w))(1 - cos(w t)) with w = q B/m."""
    scene = {"gravity": [0, 0], "let": {"B": 2, "E": 3}, "bodies": {"p": POINT},
             "connections": [{"kind": "field", "force": ["B*vy", "E - B*vx"]}]}  # fmt: skip
    compared(answer(scene), "p.position", lambda t: [1.5 * (t - mp.sin(2 * t) / 2), 0.75 * (1 - mp.cos(2 * t))])


def test_a_formula_that_is_linear_in_rates_is_a_damping() -> None:
    """Drag against the velocity: v = v0 exp(-c t/m) at any time; methods run it, and digits are proven."""
    scene = forced(["-c*vx/3", "-2*c*vy/6"], let={"c": 0.75}, body={"velocity": [2, 0]}) | {"gravity": [0, -1]}
    late = [*TIMES.tolist(), 200.0]
    found = answer(scene, late)
    assert found.model.name == "modes"
    compared(found, "p.velocity", lambda t: [2 * mp.exp(-t / 4), -4 * (1 - mp.exp(-t / 4))])
    compared(found, "f.work", lambda t: kinetic(t) - 2 + fallen(t))
    by_method = answer(scene, [0.0, 1.0], outputs=("trajectory",), method=RungeKutta4(0.01)).trajectory
    assert by_method is not None
    assert by_method.columns["p.velocity"].values[1, 0] == pytest.approx(2 * np.exp(-0.25), rel=1e-8)
    proven = proven_answer(scene_from(scene), 30, [Fraction(1)], ("trajectory",)).columns
    assert proven is not None
    assert proven["p.velocity"].values[0][0].startswith(mp.nstr(2 * mp.exp(mp.mpf(-1) / 4), 20)[:18])


def kinetic(t: mp.mpf) -> mp.mpf:
    return (2 * mp.exp(-t / 4)) ** 2 / 2 + (4 * (1 - mp.exp(-t / 4))) ** 2 / 2


def fallen(t: mp.mpf) -> mp.mpf:
    """Return the potential energy of a body that sinks with drag from the origin, with m = g = 1."""
    return -4 * (t - 4 * (1 - mp.exp(-t / 4)))


def test_a_magnetic_field_is_one_too() -> None:
    """A circle with w = q B/m."""
    scene = {"gravity": [0, 0], "let": {"B": 2}, "bodies": {"p": POINT | {"velocity": [3, 0]}},
             "connections": [{"kind": "field", "force": ["B*vy", "-B*vx"]}]}  # fmt: skip
    found = answer(scene, [0.0, 1.0, 1000.0], outputs=("trajectory",))
    assert found.model.name == "modes"
    compared(found, "p.position", lambda t: [1.5 * mp.sin(2 * t), 1.5 * (mp.cos(2 * t) - 1)])


def test_functions_go_on_where_exponentials_overflow() -> None:
    """A step of tanh far from its middle, and the tail of a bell."""
    found = answer(forced(["tanh(2000*(t - 3)) + exp(-(40*(t + 1))^2)", 0]), [0.0, 1.0, 2.0], outputs=("trajectory",))
    compared(found, "p.velocity", lambda t: [-t, 0])


def test_a_driven_oscillator_at_resonance_grows_linearly() -> None:
    """x'' = -4 x + cos(2 t) from rest has x = (t/4) sin(2 t)."""
    scene = forced(["-4*x + cos(2*t)", 0])
    compared(answer(scene), "p.position", lambda t: [t / 4 * mp.sin(2 * t), 0])


@pytest.mark.parametrize(
    ("formula", "exact"),
    [
        ("exp(-t)", lambda t: mp.exp(-t)),
        ("1/(1 + t)^2", lambda t: 1 / (1 + t) ** 2),
        ("log(2 + t)*sqrt(1 + t)", lambda t: mp.log(2 + t) * mp.sqrt(1 + t)),
        ("tan(t/2) + atan(t) - asin(t/4)", lambda t: mp.tan(t / 2) + mp.atan(t) - mp.asin(t / 4)),
        ("sinh(t/3)*cosh(t/2)/tanh(1 + t)", lambda t: mp.sinh(t / 3) * mp.cosh(t / 2) / mp.tanh(1 + t)),
        ("(2 + t)^1.5 - 2^t + acos(t/5)", lambda t: (2 + t) ** mp.mpf(1.5) - 2**t + mp.acos(t / 5)),
        ("atan2(sin(t), 2 + t)", lambda t: mp.atan2(mp.sin(t), 2 + t)),
    ],
)
def test_every_function_of_time(formula: str, exact: Callable[[mp.mpf], mp.mpf]) -> None:
    """The velocity is the integral of the force, here by mpmath's quadrature."""
    compared(answer(forced([formula, 0]), TIMES[:3].tolist()), "p.velocity", lambda t: [mp.quad(exact, [0, t]), 0])


def test_a_spring_by_a_law_is_duffings_oscillator() -> None:
    scene = {"gravity": [0, 0], "let": {"k": 2, "b": 3}, "bodies": {"p": {"mass": 1, "at": [1.5, 0]}},
             "connections": [{"kind": "spring", "name": "s", "a": "p", "b": [0, 0], "rest_length": 1,
                              "law": "k*stretch + b*stretch^3"}]}  # fmt: skip
    exact = integrated(lambda t, y: [y[1], -(2 * (y[0] - 1) + 3 * (y[0] - 1) ** 3)], [1.5, 0])
    found = answer(scene)
    compared(found, "p.position", lambda t: [exact(t)[0], 0])
    compared(found, "s.force", lambda t: 2 * (exact(t)[0] - 1) + 3 * (exact(t)[0] - 1) ** 3)
    # The work is what the kinetic energy gains.
    compared(found, "s.work", lambda t: exact(t)[1] ** 2 / 2)


def test_two_atoms_of_lennard_jones() -> None:
    """A pair with pull 24 (1/r^7 - 2/r^13): the distance moves as a body of the reduced mass."""
    bodies = {"a": {"mass": 1, "at": [0, 0]}, "b": {"mass": 1, "at": [1.3, 0]}}
    law = {"kind": "spring", "name": "bond", "a": "a", "b": "b", "law": "24*(1/length^7 - 2/length^13)"}
    exact = integrated(lambda t, y: [y[1], -2 * 24 * (y[0] ** -7 - 2 * y[0] ** -13)], ["1.3", 0])
    found = answer({"gravity": [0, 0], "bodies": bodies, "connections": [law]}, [0.0, 0.3, 0.9])
    compared(found, "b.position", lambda t: [(mp.mpf("1.3") + exact(t)[0]) / 2, 0])


def test_a_torque_follows_the_rate_of_its_motor() -> None:
    """T(1 - rate/w) on an inertia J: rate = w (1 - exp(-T t/(J w)))."""
    body = {"mass": 1, "inertia": 2, "at": [0, 0]}
    scene = {"gravity": [0, 0], "let": {"T": 3, "w": 5, "start_up": "T*(1 - rotor.rate/w)"}, "bodies": {"rotor": body},
             "connections": [{"kind": "torque", "name": "m", "body": "rotor", "torque": "start_up"}]}  # fmt: skip
    found = answer(scene)
    compared(found, "rotor.angular_velocity", lambda t: 5 * (1 - mp.exp(-3 * t / 10)))
    compared(found, "m.torque", lambda t: 3 * mp.exp(-3 * t / 10))


def test_a_damper_by_a_law_of_its_rate() -> None:
    """A turn against b rate^3: rate^-2 grows linearly."""
    body = {"mass": 1, "inertia": 1, "at": [0, 0], "angular_velocity": 2}
    damper = {"kind": "damper", "name": "d", "a": "w", "measure": "turn", "law": "3*rate^3"}
    found = answer({"gravity": [0, 0], "bodies": {"w": body}, "connections": [damper]})
    compared(found, "w.angular_velocity", lambda t: 1 / mp.sqrt(mp.mpf(1) / 4 + 6 * t))
    compared(found, "d.torque", lambda t: -3 / mp.sqrt(mp.mpf(1) / 4 + 6 * t) ** 3)


def test_a_thrust_turns_with_its_body() -> None:
    """Thrust along the first axis of a body that turns steadily: x'' = F cos(w t), y'' = F sin(w t)."""
    body = {"mass": 1, "inertia": 1, "at": [0, 0], "angular_velocity": 2}
    thrust = {"kind": "force", "place": "r", "force": [3, 0], "in": "body"}
    found = answer({"gravity": [0, 0], "bodies": {"r": body}, "connections": [thrust]})
    compared(found, "r.velocity", lambda t: [1.5 * mp.sin(2 * t), 1.5 * (1 - mp.cos(2 * t))])


def test_a_force_depends_on_another_body() -> None:
    bodies = {"p": POINT, "q-1": {"mass": 1, "at": [1, 0], "velocity": [2, 0]}}
    force = {"kind": "force", "place": "p", "force": ["q-1.x - p.vx", 0]}
    found = answer({"gravity": [0, 0], "bodies": bodies, "connections": [force]})
    # v' = 1 + 2 t - v.
    compared(found, "p.velocity", lambda t: [2 * t - 1 + mp.exp(-t), 0])


def test_drag_in_space() -> None:
    body = {"mass": 1, "at": [0, 0, 0], "velocity": [3, 0, 4]}
    force = {"kind": "force", "place": "p", "force": ["-speed*vx", "-speed*vy", "-speed*vz"]}
    found = answer({"gravity": [0, 0, 0], "bodies": {"p": body}, "connections": [force]})
    compared(found, "p.position", lambda t: [0.6 * mp.log(1 + 5 * t), 0, 0.8 * mp.log(1 + 5 * t)])


def test_a_ball_bounces_with_drag() -> None:
    """Through contacts: from the first impact on as by formulas for falling and rising with c v^2."""
    scene = forced(["-c*speed*vx", "-c*speed*vy"], let={"c": 0.1}, body={"at": [0, 2], "velocity": [1, 0]})
    scene["gravity"] = [0, -10]
    scene["connections"].append(
        {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}, "restitution": 0.5}
    )
    found = answer(scene, [0.0, 0.5, 1.0], outputs=("trajectory",))
    speed = lambda y: mp.sqrt(y[2] ** 2 + y[3] ** 2)  # noqa: E731
    fall = lambda t, y: [y[2], y[3], -speed(y) * y[2] / 10, -10 - speed(y) * y[3] / 10]  # noqa: E731
    first = integrated(fall, [0, 2, 1, 0])
    hit = mp.findroot(lambda t: first(t)[1], 0.65)
    after = first(hit)
    second = integrated(fall, [after[0], 0, after[2], -after[3] / 2])
    compared(found, "p.position", lambda t: first(t)[:2] if t < hit else second(t - hit)[:2])
    assert found.events[0].time == pytest.approx(float(hit), rel=1e-13)


def test_a_formula_of_numbers_is_the_constant_it_is() -> None:
    exact, written = (answer(forced([force, 0]), outputs=("trajectory",)).trajectory for force in (1.5, "3/2"))
    assert exact is not None
    assert written is not None
    np.testing.assert_array_equal(exact.columns["p.position"].values, written.columns["p.position"].values)


@pytest.mark.parametrize(
    ("changes", "pointer", "rule"),
    [
        ({"force": ["-2*sped*vx", 0]}, "connections/0/force/0", "sped"),
        ({"force": ["2*$", 0]}, "connections/0/force/0", r"character 3"),
        ({"force": ["q.x", 0]}, "connections/0/force/0", "q.x"),
        ({"force": ["1/x", 0]}, "connections/0/force/0", "have a value at the start"),
        ({"force": ["sqrt(x - 1)", 0]}, "connections/0/force/0", "have a value at the start"),
        ({"force": ["floor(x)", 0]}, "connections/0/force/0", "floor"),
        ({"force": ["length", 0]}, "connections/0/force/0", "length"),
    ],
)
def test_what_is_no_formula_is_refused(changes: dict[str, Any], pointer: str, rule: str) -> None:
    scene = forced([0, 0])
    scene["connections"][0] |= changes
    with pytest.raises(InvalidParameter, match=rule) as refused:
        answer(scene)
    assert "/".join(map(str, refused.value.path)) == pointer


def test_names_that_use_one_another_are_refused() -> None:
    with pytest.raises(InvalidParameter, match="a uses b uses a"):
        answer(forced(["a", 0], let={"a": "b + 1", "b": "a*2"}))


def test_a_misspelled_name_gets_the_nearest() -> None:
    with pytest.raises(InvalidParameter) as refused:
        answer(forced(["-sped", 0]))
    assert refused.value.remedy is not None
    assert 'did you mean "speed"?' in refused.value.remedy


def test_what_is_not_answered_yet_is_refused() -> None:
    with pytest.raises(NotApplicable, match="equilibria"):
        answer(forced(["-x^3", 0]), outputs=("equilibria",))
    spring = {"kind": "spring", "name": "s", "a": "p", "b": [1, 0], "law": "length^2"}
    scene = {"gravity": [0, 0], "bodies": {"p": POINT}, "connections": [spring]}
    with pytest.raises(NotApplicable, match=r"s\.force"):
        answer(scene, outputs=(ExtremesOf("s.force"),))
    with pytest.raises(NotApplicable, match="methods"):
        answer(scene, outputs=("trajectory",), method=RungeKutta4(0.01))
    with pytest.raises(NotApplicable, match="digits"):
        proven_answer(scene_from(scene), 20)


def test_where_a_formula_loses_its_value_the_motion_ends() -> None:
    found = answer(forced(["sqrt(1 - t)", 0]), [0.0, 2.0], outputs=("trajectory",))
    assert found.trajectory is not None
    assert found.trajectory.ended == "formula"
    assert found.trajectory.time.tolist() == [0.0]
