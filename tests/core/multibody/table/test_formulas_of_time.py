"""Supports, turns, rates and lengths that are driven by formulas of time, against closed forms and mpmath."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from core.errors import InvalidParameter, NotApplicable, PlacesDisagree
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from core.systems.methods.runge_kutta_4 import RungeKutta4
from tests.oracles.elliptic import real_of
from tests.oracles.minimal_coordinates import cos, motion, sin

TIMES = [0.0, 0.5, 1.0, 2.5]
ALL = ("accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "work-in-time")
BOB: dict[str, Any] = {"mass": 1, "at": [1, 0]}
WHEEL: dict[str, Any] = {"mass": 1, "inertia": 2, "at": [0, 0]}


def scene(body: dict[str, Any], *connections: dict[str, Any], gravity: Sequence[Any] = (0, 0)) -> dict[str, Any]:
    return {"gravity": list(gravity), "bodies": {"p": body}, "connections": list(connections)}


def answer(description: dict[str, Any], times: Sequence[float] = tuple(TIMES), **more: Any) -> SceneSolution:
    return solve_scene(scene_from(description), np.array(times), more.pop("outputs", ALL), **more)


def compared(found: SceneSolution, column: str, exact: Callable[[mp.mpf], Any]) -> None:
    assert found.trajectory is not None
    own = found.trajectory.columns[column]
    with mp.workdps(40):
        wanted = np.array([np.array(exact(mp.mpf(t)), dtype=np.float64) for t in found.trajectory.time.tolist()])
    apart = np.abs(own.values.reshape(wanted.shape) - wanted)
    assert np.max(apart) <= own.error + 2.0**-52 * np.max(np.abs(wanted))
    assert own.error < 1e-10


def rod(b: Sequence[Any], **more: Any) -> dict[str, Any]:
    return {"kind": "rod", "name": "r", "a": "p", "b": list(b), **more}


def test_kapitzas_pendulum() -> None:
    """By Lagrange's equations of the angle a from the x axis and of the phase s of the support at sin(s)/10."""
    found = answer(scene(BOB, rod([0, "A*sin(w*t)"]), gravity=(0, -10)) | {"let": {"A": 0.1, "w": 30}})

    def place(s: Any, a: Any) -> tuple[Any, Any]:
        return cos(a), sin(a) + sin(s) / 10

    states = motion(
        lambda s, a: [(1, x) for x in place(s, a)], lambda s, a: place(s, a)[1] * 10, [0, 0], [30, -3], TIMES, driven=1
    )
    with mp.workdps(30):
        angles = {time: (real_of(q[1]), real_of(v[1])) for time, (q, v) in zip(TIMES, states, strict=True)}
        compared(found, "p.position", lambda t: [mp.cos(angles[t][0]), mp.sin(angles[t][0]) + mp.sin(30 * t) / 10])

    def brought(t: mp.mpf) -> mp.mpf:
        """Return what the energy has gained: that of the start is 9/2 at the height zero, the bob moving with it."""
        a, rate = angles[t]
        x, y = -mp.sin(a) * rate, mp.cos(a) * rate + 3 * mp.cos(30 * t)
        return (x**2 + y**2) / 2 + 10 * (mp.sin(a) + mp.sin(30 * t) / 10) - mp.mpf(0)

    with mp.workdps(30):
        compared(found, "r.work", brought)


def test_a_support_that_shakes_a_spring() -> None:
    """x'' = -4 (x - 1 - sin(3 t)/2) from rest at 1: x = 1 + (4/2)(sin(3t) - (3/2) sin(2t))/(4 - 9)."""
    spring = {"kind": "spring", "name": "s", "a": "p", "b": ["sin(3*t)/2 - 10", 0], "stiffness": 4, "rest_length": 11}
    line = {"kind": "slider", "a": "p", "b": [0, 0]}
    found = answer(scene(BOB, line, spring))
    compared(found, "p.position", lambda t: [1 - mp.mpf(2) / 5 * (mp.sin(3 * t) - 1.5 * mp.sin(2 * t)), 0])


def test_a_pin_that_is_carried() -> None:
    """A body without gravity at a support that is lifted: its weight is m a."""
    found = answer(scene({"mass": 2, "at": [0, 0]}, {"kind": "pin", "name": "h", "a": "p", "b": ["3*t", "t^2/2"]}))
    compared(found, "p.position", lambda t: [3 * t, t**2 / 2])
    compared(found, "h.y", lambda t: 2)
    compared(found, "h.work", lambda t: t**2)


def test_a_motor_by_the_angle_and_by_the_rate() -> None:
    """An inertia J: torque J a'', work J (rate^2 - rate_0^2)/2."""
    by_angle = answer(scene(WHEEL, {"kind": "motor", "name": "m", "a": "p", "drive": "sin(3*t)"}))
    compared(by_angle, "p.angle", lambda t: mp.sin(3 * t))
    compared(by_angle, "m.torque", lambda t: -18 * mp.sin(3 * t))
    compared(by_angle, "m.work", lambda t: 9 * (mp.cos(3 * t) ** 2 - 1))
    by_rate = answer(scene(WHEEL, {"kind": "motor", "name": "m", "a": "p", "rate": "1 - exp(-2*t)"}))
    compared(by_rate, "p.angle", lambda t: t - (1 - mp.exp(-2 * t)) / 2)
    compared(by_rate, "m.torque", lambda t: 4 * mp.exp(-2 * t))
    compared(by_rate, "m.work", lambda t: (1 - mp.exp(-2 * t)) ** 2)


def test_a_bob_is_drawn_in() -> None:
    """At the length l(t) with the angular momentum 2: pull (4/l^3 - l''), here l'' = 0."""
    bob = BOB | {"velocity": [-0.1, 2]}
    found = answer(scene(bob, rod([0, 0], drive="1 - t/10")))

    def length(t: mp.mpf) -> mp.mpf:
        return 1 - t / 10

    def place(t: mp.mpf) -> list[mp.mpf]:
        # The angle is the integral of 2/l^2.
        angle = 20 * (1 / length(t) - 1)
        return [length(t) * mp.cos(angle), length(t) * mp.sin(angle)]

    compared(found, "p.position", place)
    compared(found, "r.force", lambda t: 4 / length(t) ** 3)
    compared(found, "r.work", lambda t: 2 / length(t) ** 2 - 2)


@pytest.mark.parametrize(
    ("formula", "exact"),
    [
        ("exp(-t) - cosh(t/2)/(1 + t)^2", lambda t: mp.exp(-t) - mp.cosh(t / 2) / (1 + t) ** 2),
        ("log(1 + t)*sqrt(1 + 3*t)", lambda t: mp.log(1 + t) * mp.sqrt(1 + 3 * t)),
        ("tan(t/2) + atan(2*t) - asin(t/4)", lambda t: mp.tan(t / 2) + mp.atan(2 * t) - mp.asin(t / 4)),
        ("sinh(t/3)*tanh(1 + t) - acos(t/5)", lambda t: mp.sinh(t / 3) * mp.tanh(1 + t) - mp.acos(t / 5)),
        ("(2 + t)^1.5 - 2^t + (1 + t)^-3 + sin(t)^5", lambda t: (2 + t) ** 1.5 - 2**t + (1 + t) ** -3 + mp.sin(t) ** 5),
    ],
)
def test_every_function_of_time(formula: str, exact: Callable[[mp.mpf], mp.mpf]) -> None:
    with mp.workdps(40):
        start = mp.nstr(exact(mp.mpf(0)), 35)
    carried = scene({"mass": 1, "at": [0, start]}, {"kind": "pin", "name": "h", "a": "p", "b": [0, formula]})
    found = answer(carried, TIMES[:3], outputs=("trajectory", "forces-in-time"))
    compared(found, "p.position", lambda t: [0, exact(t)])
    compared(found, "h.y", lambda t: mp.diff(exact, t, 2))


def test_a_method_follows_what_is_driven() -> None:
    shaken = scene(BOB, rod([0, "sin(3*t)/10"]), gravity=(0, -10))
    own, other = (
        answer(shaken, outputs=("trajectory",), method=method).trajectory for method in (None, RungeKutta4(0.01))
    )
    assert own is not None
    assert other is not None
    a, b = (one.columns["p.position"] for one in (own, other))
    assert 0.0 < np.max(np.abs(a.values - b.values)) <= b.error


def test_a_sketch_is_moved_to_where_its_support_begins() -> None:
    sketch = scene(BOB | {"at": [1.5, 0.2]}, rod([0, "0.2 + sin(3*t)"], length=1), gravity=(0, -10))
    found = answer(sketch | {"assemble": "nearest"}, [0.0, 0.3], outputs=("trajectory",))
    assert found.trajectory is not None
    np.testing.assert_allclose(found.trajectory.columns["p.position"].values[0], [1, 0.2], atol=1e-15)


@pytest.mark.parametrize(
    ("formula", "rule"),
    [
        ("abs(t)", "one piece"),
        ("atan2(t, 1)", "do without atan2"),
        ("sin(x)", 'unlike "x"'),
        ("1/t", "a value at the start"),
        ("sqrt(t)", "a rate at the start"),
        ("t^1.5", "a rate at the start"),
    ],
)
def test_formulas_that_cannot_drive_are_refused(formula: str, rule: str) -> None:
    with pytest.raises(InvalidParameter, match=rule) as refused:
        answer(scene(BOB, rod([0, formula]), gravity=(0, -10)))
    assert tuple(refused.value.path) == ("connections", 0, "b", 1)


def test_drives_that_do_not_fit_are_refused() -> None:
    with pytest.raises(PlacesDisagree, match="0 rad"):
        answer(scene(WHEEL, {"kind": "motor", "name": "m", "a": "p", "drive": "cos(t)"}))
    with pytest.raises(InvalidParameter, match="a rate or a drive"):
        answer(scene(WHEEL, {"kind": "motor", "a": "p"}))
    with pytest.raises(InvalidParameter, match="beside a length"):
        answer(scene(BOB, rod([0, 0], drive="1 + t", length=1)))
    with pytest.raises(NotApplicable, match="equilibria"):
        answer(scene(BOB, rod([0, "sin(t)"])), outputs=("equilibria",))


def driven_slider(drive: str, **more: Any) -> dict[str, Any]:
    return {"kind": "slider", "name": "s", "a": "p", "b": [0, 0], "drive": drive, **more}


def test_a_slider_that_is_driven_up_a_slope() -> None:
    """The force along the slope is m (g/2 + x''), with x = (1 + sin 2t)/10."""
    slider = driven_slider("(1 + sin(2*t))/10", slope={"degrees": 30})
    found = answer(scene({"mass": 2, "at": {"polar": ["0.1", {"degrees": 30}]}}, slider, gravity=(0, -10)))
    compared(found, "p.position", lambda t: [(1 + mp.sin(2 * t)) / 10 * x for x in (mp.sqrt(3) / 2, mp.mpf("0.5"))])
    compared(found, "s.drive", lambda t: 2 * (5 - mp.mpf("0.4") * mp.sin(2 * t)))
    compared(found, "s.work", lambda t: mp.mpf("0.04") * (mp.cos(2 * t) ** 2 - 0) + mp.sin(2 * t) - mp.mpf("0.04"))


def test_a_slider_along_a_body_that_turns_throws_it_round() -> None:
    """A point that moves out along a free bar: (I + m r^2) w is conserved, r = 1 + t/2."""
    bar = {"mass": 1, "inertia": 2, "at": [0, 0], "angular_velocity": 3}
    pin = {"kind": "pin", "a": "bar", "b": [0, 0]}
    given = scene({"mass": 4, "at": [1, 0]}, pin, driven_slider("1 + t/2") | {"b": "bar"})
    given["bodies"]["bar"] = bar
    found = answer(given)
    # angle = 18 times the integral of 1/(2 + 4 r^2) by t.
    compared(found, "bar.angle", lambda t: 18 * mp.quad(lambda u: 1 / (2 + 4 * (1 + u / 2) ** 2), [0, t]))


def test_a_slider_of_space_is_driven_along_its_direction() -> None:
    body = {"mass": 3, "moments": [1, 2, 3], "at": ["0.1", "0.2", "0.2"]}
    slider = driven_slider("0.3*(1 + t + t^2)", direction=[1, 2, 2]) | {"b": [0, 0, 0]}
    found = answer(scene(body, slider, gravity=(0, 0, -9)))
    compared(found, "s.drive", lambda t: 3 * (mp.mpf("0.6") + 6))


def test_a_slider_that_does_not_start_where_it_is_driven_is_refused() -> None:
    with pytest.raises(PlacesDisagree, match=r"be 1 m at the start") as refused:
        answer(scene(BOB, driven_slider("sin(t)")))
    assert refused.value.path == ("connections", 0, "drive")


@pytest.mark.parametrize("drive", ["sin(2*t)/2", "(1 - cos(3*t))/4", "t*sin(2*t)", "sin(t*t)"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_is_driven_twice_alike_goes_on_where_its_sine_or_cosine_vanishes(drive: str, dimension: int) -> None:
    """The second connection says no more than the first; a bob on a spring follows, and ends nothing."""
    more = [0] * (dimension - 2)
    slider: dict[str, Any] = {"kind": "slider", "a": "p", "b": [0, 0, *more], "drive": drive}
    if dimension == 3:
        slider["direction"] = [1, 0, 0]
    found = {
        "gravity": [0, *more, -9],
        "bodies": {"p": {"mass": 1, "at": [0, 0, *more]}, "bob": {"mass": 2, "at": [3, *more, -1]}},
        "connections": [
            {**slider, "name": "first"},
            {**slider, "name": "again"},
            {"kind": "spring", "a": "p", "b": "bob", "stiffness": 20},
        ],
    }
    solution = solve_scene(scene_from(found), [0.5, 2, 3], ("trajectory",))
    assert solution.events == ()
    assert solution.trajectory is not None
    column = solution.trajectory.columns["p.position"]
    names = {"sin": np.sin, "cos": np.cos}
    right = [eval(drive, {**names, "t": t}) for t in (0.5, 2, 3)]
    assert np.asarray(column.values)[:, 0] == pytest.approx(right, abs=column.error + 4e-16)


def test_two_that_are_driven_alike_have_nothing_to_do_with_one_another() -> None:
    parts = []
    for names in ("p", "pq"):
        bodies = {name: {"mass": 1, "at": [k, "-1"]} for k, name in enumerate(names)}
        rods = [
            {"kind": "rod", "name": f"r{name}", "a": name, "b": [f"{k} + sin(2*t)/10", 0]}
            for k, name in enumerate(names)
        ]
        found = {"gravity": [0, -9], "bodies": bodies, "connections": rods}
        solution = solve_scene(scene_from(found), [0.5, 2], ("trajectory",))
        assert solution.trajectory is not None
        parts.append(solution.trajectory.columns["p.position"])
    assert np.array_equal(parts[0].values, parts[1].values)
