"""Discs, cylinders, ellipsoids and eccentric balls on planes, against closed forms and another formulation."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read
from tests.oracles.bodies_on_planes import GRAVITY, BodyOnPlane, ellipsoid

PLANE = {"at": [0, 0, 0], "normal": [0, 0, 1]}


def scene(body: dict[str, Any], **connection: Any) -> dict[str, Any]:
    kind = {"name": "floor", "place": "body", "on": PLANE} | connection
    return {"gravity": [0, 0, -GRAVITY], "bodies": {"body": body}, "connections": [kind]}


def leaning(shape: dict[str, Any], angle: str, **more: Any) -> dict[str, Any]:
    """Return a disc of radius 0.5 whose axis points up by an angle, with its first axis level, above the origin."""
    axes = [["1", "0", "0"], ["0", f"-sin({angle})", f"cos({angle})"], ["0", f"-cos({angle})", f"-sin({angle})"]]
    return {"mass": 2, "shape": shape, "at": [0, 0, f"0.5*cos({angle})"], "axes": axes} | more


DISC = {"kind": "disc", "radius": 0.5}


@pytest.mark.parametrize("moments", [None, [0.25, 0.25, 0.5]], ids=["disc", "hoop"])
@pytest.mark.parametrize("contact", [{"kind": "rolling"}, {"kind": "contact", "friction": 2}], ids=["held", "sticks"])
def test_a_leaning_disc_rolls_steadily_around_a_circle(moments: list[float] | None, contact: dict[str, Any]) -> None:
    """The balance of momentum and spin about the centre, with the axis at the angle c from the vertical.

    (I_a + m R^2) W s sin c - I_t W^2 sin c cos c + m g R cos c = 0 for the precession W and the spin s about the axis;
    the centre moves at R s (E. J. Routh, "Advanced dynamics of a system of rigid bodies", article 244).
    """
    m, r, turning = 2.0, 0.5, 4.0
    across, about = (0.125, 0.25) if moments is None else (0.25, 0.5)
    angle = math.pi / 2 + 0.3
    sine, cosine = math.sin(angle), math.cos(angle)
    spin = (across * turning**2 * sine * cosine - m * GRAVITY * r * cosine) / ((about + m * r * r) * turning * sine)
    # The vertical is sin c e2 + cos c e3 in body axes at the start.
    # To the last digit, or it slips for a moment.
    rolls = [f"-0.5*({spin!r})", 0, 0]
    body = leaning(DISC, "0.3", angular_velocity=[0, turning * sine, spin], velocity=rolls)
    body |= {} if moments is None else {"moments": moments}
    answer = solve_scene(read(scene(body, **contact)), [0.0, 1.3], ["trajectory", "forces-in-time"])
    place, speed = column(answer, "body.position"), column(answer, "body.velocity")
    # The centre of the circle: v = W x (C - Q) with v = -R s e1.
    middle = np.array([0.0, -r * spin / turning])
    start = place.values[0][:2] - middle
    if contact["kind"] == "contact":
        assert answer.phases[-1].states == {"floor": "stick"}
    turned = turning * 1.3
    arm = np.array([[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]]) @ start
    assert place.values[1][:2] == pytest.approx(middle + arm, abs=1e-12)
    assert place.values[1][2] == pytest.approx(r * sine, abs=1e-13)
    assert speed.values[1][:2] == pytest.approx(turning * np.array([-arm[1], arm[0]]), abs=1e-12)
    assert column(answer, "floor.normal").values == pytest.approx(m * GRAVITY, rel=1e-13)
    friction = [column(answer, f"floor.friction.{x}").values[1] for x in "xy"]
    assert friction == pytest.approx(-m * turning**2 * arm, rel=1e-11)


@pytest.mark.parametrize(("moments", "spin"), [(None, 4.0), ([0.25, 0.25, 0.5], 4.0), (None, 1.5)])
def test_an_upright_disc_wobbles_at_the_rate_of_small_motions(moments: list[float] | None, spin: float) -> None:
    """Its lean obeys (I_t + m R^2) x'' = m g R x - G (x - x_0) with G = I_a (I_a + m R^2) s^2/I_t, from rest at x_0.

    The second term is that of the turning of its plane, I_t W = I_a s (x - x_0): below a critical spin it falls.
    """
    m, r, lean, times = 2.0, 0.5, 1e-4, [0.3, 0.6]
    across, about = (0.125, 0.25) if moments is None else (0.25, 0.5)
    body = leaning(DISC, "1e-4", angular_velocity=[0, 0, spin]) | ({} if moments is None else {"moments": moments})
    answer = solve_scene(read(scene(body, kind="rolling")), times, ["trajectory"])
    heights = column(answer, "body.position").values[:, 2]
    gyroscopic = about * (about + m * r * r) * spin**2 / across
    stiffness = gyroscopic - m * GRAVITY * r
    rate = np.emath.sqrt(stiffness / (across + m * r * r))
    middle = gyroscopic / stiffness
    expected = [middle + (1 - middle) * np.cos(rate * time).real for time in times]
    assert np.arccos(heights / r) / lean == pytest.approx(expected, rel=1e-6)


def test_a_disc_falls_on_a_smooth_plane_until_it_lies_flat() -> None:
    """Its centre falls straight down, with the energy (m R^2 sin^2 x + I_t) x'^2/2 + m g R cos x for the lean x."""
    answer = solve_scene(read(scene(leaning(DISC, "0.3"), kind="contact")), [0.0, 1.0], ["trajectory"])
    (event,) = answer.events
    m, r, across = 2, mpmath.mpf("0.5"), mpmath.mpf("0.125")

    def slowness(s: Any) -> Any:
        x = mpmath.mpf("0.3") + s**2
        # cos 0.3 - cos x as a product, which does not cancel.
        fall = 4 * m * mpmath.mpf("9.81") * r * mpmath.sin(s**2 / 2) * mpmath.sin((x + mpmath.mpf("0.3")) / 2)
        return 2 * s * mpmath.sqrt((m * r**2 * mpmath.sin(x) ** 2 + across) / fall)

    with mpmath.workdps(30):
        time = mpmath.quad(slowness, mpmath.linspace(mpmath.mpf(10) ** -25, mpmath.sqrt(mpmath.pi / 2 - 0.3), 9))
    assert (event.kind, event.name) == ("singular", "floor")
    assert event.time == pytest.approx(float(time), rel=1e-13)


RATTLEBACK = {
    "mass": 1,
    "tensor": [["0.0006", "-0.0004", 0], ["-0.0004", "0.005", 0], [0, 0, "0.0055"]],
    "shape": {"kind": "ellipsoid", "semi_axes": ["0.05", "0.2", "0.03"]},
    "at": [0, 0, "0.03"],
}
EGG = {
    "mass": 2,
    "moments": ["0.01", "0.02", "0.015"],
    "shape": {"kind": "ellipsoid", "semi_axes": [0.1, 0.12, 0.15], "at": [0.01, 0, -0.02]},
    "at": [0.3, 0, 0.17],
}
LOADED = {
    "mass": 1,
    "moments": ["0.004", "0.005", "0.0041"],
    "shape": {"kind": "ball", "radius": 0.1, "at": [0, 0.01, 0.02]},
    "at": [0.1, 0.2, "0.08"],
}
ON_PLANES = {
    "rattleback": (RATTLEBACK, (0.05, 0.2, 0.03), (0.0, 0.0, 0.0)),
    "egg": (EGG, (0.1, 0.12, 0.15), (0.01, 0.0, -0.02)),
    "loaded ball": (LOADED, (0.1, 0.1, 0.1), (0.0, 0.01, 0.02)),
}


def oracle(name: str) -> tuple[dict[str, Any], BodyOnPlane]:
    body, semi_axes, at = ON_PLANES[name]
    tensor = body.get("tensor", np.diag([float(x) for x in body.get("moments", ())]))
    return body, BodyOnPlane(float(body["mass"]), np.array(tensor, dtype=float), ellipsoid(semi_axes, at))


@pytest.mark.parametrize("name", ON_PLANES)
@pytest.mark.parametrize(
    "connection", [{"kind": "rolling"}, {"kind": "contact", "friction": 5}], ids=["held", "sticks"]
)
def test_what_rolls_agrees_with_its_equations_in_body_axes(name: str, connection: dict[str, Any]) -> None:
    body, other = oracle(name)
    omega = [0.3, 0.2, -5.0]
    arm, _ = other.surface(np.array([0.0, 0.0, 1.0]))
    moving = body | {"angular_velocity": omega, "velocity": np.cross(arm, omega).tolist()}
    answer = solve_scene(read(scene(moving, **connection)), [0.0, 1.5], ["trajectory"])
    _, expected = other.rolls(np.array([0.0, 0.0, 1.0]), np.array(omega), 1.5)
    assert column(answer, "body.angular_velocity").values[1] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("name", ON_PLANES)
def test_what_slips_agrees_with_its_equations_in_body_axes(name: str) -> None:
    body, other = oracle(name)
    omega, mu, end = [1.0, 2.0, -10.0], 0.2, 0.02
    arm, _ = other.surface(np.array([0.0, 0.0, 1.0]))
    # The lowest point keeps its height.
    velocity = np.array([1.0, 0.5, -(omega[0] * arm[1] - omega[1] * arm[0])])
    moving = body | {"angular_velocity": omega, "velocity": velocity.tolist()}
    answer = solve_scene(read(scene(moving, kind="contact", friction=mu)), [0.0, end], ["trajectory"])
    assert [phase.states for phase in answer.phases] == [{"floor": "slide"}]
    _, expected = other.slips(np.array([0.0, 0.0, 1.0]), np.array(omega), velocity, mu, end)
    assert column(answer, "body.angular_velocity").values[1] == pytest.approx(expected, abs=1e-9)


def test_a_rattleback_reverses_its_spin() -> None:
    """Spun in the sense that its oblique inertia does not favour, it rattles, stops and turns back."""
    times = np.linspace(0.0, 12.0, 241).tolist()
    both = []
    for spin in (5, -5):
        answer = solve_scene(
            read(scene(RATTLEBACK | {"angular_velocity": ["0.01", "0.01", spin]}, kind="rolling")),
            times,
            ["trajectory"],
        )
        values = column(answer, "body.angular_velocity").values[:, 2]
        both.append(bool((values * spin).min() < 0.0))
    assert sorted(both) == [False, True]


@pytest.mark.parametrize("rate", [0, 1.5])
def test_an_ellipsoid_with_equal_axes_is_a_ball_on_a_turntable(rate: float) -> None:
    """A homogeneous ball on a turntable circles at 2/7 of the rate of the table (K. Weltner, Am. J. Phys. 47, 1979)."""
    plane = PLANE | {"rate": rate}
    ball = {"mass": 1, "at": [1, 0, 0.1], "velocity": [0.3, 0.5, 0], "shape": {"kind": "ball", "radius": 0.1}}
    nearly = ball | {"shape": {"kind": "ellipsoid", "semi_axes": ["0.1", "0.1", "0.1 + 1e-60"]}}
    one, other = (
        solve_scene(read(scene(body, kind="rolling", on=plane)), [0.7], ["trajectory", "forces-in-time"])
        for body in (ball, nearly)
    )
    for name in ("body.position", "floor.normal", "floor.friction.x", "floor.friction.y"):
        first, second = column(one, name), column(other, name)
        assert first.values == pytest.approx(second.values, abs=first.error + second.error)


def test_a_cylinder_on_its_side_slides_until_it_rolls() -> None:
    """A homogeneous cylinder keeps two thirds of its speed, from v/(3 mu g) on; both rims carry half of its weight."""
    side = [["1", "0", "0"], ["0", "0", "1"], ["0", "-1", "0"]]
    shape = {"kind": "cylinder", "radius": 0.1, "height": 0.3}
    body = {"mass": 1, "shape": shape, "at": [0, 0, 0.1], "axes": side, "velocity": [1, 0, 0]}
    answer = solve_scene(read(scene(body, kind="contact", friction=0.3)), [0.05, 0.5], ["trajectory", "forces-in-time"])
    assert [(event.kind, event.name) for event in answer.events] == [("roll", "floor.1"), ("roll", "floor.2")]
    assert answer.events[0].time == pytest.approx(1 / (3 * 0.3 * GRAVITY), rel=1e-13)
    assert column(answer, "body.velocity").values[1] == pytest.approx([2 / 3, 0, 0], abs=1e-13)
    assert column(answer, "body.angular_velocity").values[1] == pytest.approx([0, 0, -20 / 3], abs=1e-12)
    for name in ("floor.1.normal", "floor.2.normal"):
        assert column(answer, name).values == pytest.approx(GRAVITY / 2, rel=1e-13)


def test_a_tossed_coin_strikes_the_floor_with_its_rim() -> None:
    """A free coin turns uniformly about a level diameter; its rim strikes when the centre is at R |sin| of its lean."""
    body = leaning(DISC, "0", at=[0, 0, 1], angular_velocity=[2, 0, 0])
    answer = solve_scene(read(scene(body, kind="contact", restitution=0.5)), [0.0, 0.4], ["trajectory"])
    time = mpmath.findroot(lambda t: 1 - mpmath.mpf("9.81") / 2 * t**2 - 0.5 * mpmath.cos(2 * t), 0.35)
    assert (answer.events[0].kind, answer.events[0].name) == ("touch", "floor")
    assert answer.events[0].time == pytest.approx(float(time), rel=1e-14)


def test_what_lies_flat_does_not_roll() -> None:
    flat = {"mass": 1, "shape": DISC, "at": [0, 0, 0]}
    with pytest.raises(InvalidParameter, match="level rim"):
        solve_scene(read(scene(flat, kind="rolling")), [1.0], ["trajectory"])


@pytest.mark.parametrize("kind", ["cylinder", "box", "capsule"])
def test_what_touches_at_several_places_is_no_rolling(kind: str) -> None:
    sizes = {"cylinder": ("radius", "height"), "box": ("width", "height", "depth"), "capsule": ("radius", "length")}
    body = {"mass": 1, "at": [0, 0, 1], "shape": {"kind": kind} | {size: 1 for size in sizes[kind]}}
    with pytest.raises(InvalidParameter, match="several places"):
        solve_scene(read(scene(body, kind="rolling")), [1.0], ["trajectory"])


@pytest.mark.parametrize(
    "shape", [{"kind": "disc", "radius": 0.5}, {"kind": "ellipsoid", "semi_axes": [0.5, 0.5, 0.2]}]
)
@pytest.mark.parametrize("heading", [0.5, 1.0, 2.5, -0.3])
def test_axes_in_the_decimals_of_doubles_are_those_that_they_round(shape: dict[str, Any], heading: float) -> None:
    """What is upright to rounding only rolls straight on, by Euler's equations of what is exactly so."""
    x, y = math.cos(heading), math.sin(heading)
    body = {
        "mass": 2,
        "shape": shape,
        "at": [0, 0, 0.5],
        "axes": [[x, y, 0], [0, 0, 1], [y, -x, 0]],
        "velocity": [3 * x, 3 * y, 0],
    }
    place = column(solve_scene(read(scene(body, kind="rolling")), [0.0, 2.0]), "body.position")
    assert np.abs(place.values[1] - [6 * x, 6 * y, 0.5]).max() <= place.error + 1e-14
