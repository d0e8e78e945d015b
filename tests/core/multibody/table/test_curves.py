"""Beads on surfaces and curves by formula, against closed forms."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.answer import SceneSolution
from core.multibody.language.reading import scene_from
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene

G = 10.0
TIMES = np.array([0.0, 0.3, 1.0])


def solved(at: Sequence[Any], on: dict[str, Any], **body: Any) -> SceneSolution:
    track = {"kind": "track", "name": "wire", "place": "bead", "on": on}
    gravity = [*[0] * (len(at) - 1), -G]
    scene = {"gravity": gravity, "bodies": {"bead": {"mass": 2, "at": at, **body}}, "connections": [track]}
    return solve_scene(scene_from(scene), TIMES, ("accelerations", "forces", "trajectory", "forces-in-time"))


def columns(found: SceneSolution, *names: str) -> list[Any]:
    assert found.trajectory is not None
    return [found.trajectory.columns[name].values for name in names]


@pytest.mark.parametrize("angle", ["1/100", "1", "5/2"])
def test_a_cycloid_has_one_period_whatever_the_amplitude(angle: str) -> None:
    """Of x = u + sin u, y = -cos u the arc 4 sin(u/2) swings harmonically with sqrt(g)/2 (Huygens 1673)."""
    found = solved([f"{angle} + sin({angle})", f"-cos({angle})"], {"curve": ["u + sin(u)", "-cos(u)"]})
    assert found.period == pytest.approx(4 * np.pi / np.sqrt(G), rel=1e-15)
    assert found.model.name == "one period"
    arc = 4 * np.sin(eval(angle) / 2) * np.cos(np.sqrt(G) / 2 * TIMES)
    (place,) = columns(found, "bead.position")
    np.testing.assert_allclose(place[:, 1], -np.cos(2 * np.arcsin(arc / 4)), atol=1e-13)


def test_a_bead_slides_along_a_helix() -> None:
    """With a rise of 3/4 m by a radian at a radius of 1 m its angle has -(3/4) g/(1 + 9/16) = -4.8 rad/s^2."""
    found = solved([1, 0, 0], {"curve": ["cos(u)", "sin(u)", "3*u/4"]})
    u, rate = -2.4 * TIMES**2, -4.8 * TIMES
    place, x, y, z = columns(found, "bead.position", "wire.x", "wire.y", "wire.z")
    np.testing.assert_allclose(place, np.stack([np.cos(u), np.sin(u), 0.75 * u], axis=1), atol=1e-13)
    pull = [2 * (-4.8 * -np.sin(u) - rate**2 * np.cos(u)), 2 * (-4.8 * np.cos(u) - rate**2 * np.sin(u))]
    np.testing.assert_allclose([x, y], pull, atol=1e-11)
    np.testing.assert_allclose(z, 2 * (G - 0.75 * 4.8), atol=1e-11)


def test_a_bead_circles_in_a_paraboloid() -> None:
    """On z = x^2 + y^2 a circle is kept at sqrt(2 g) rad/s, whatever its radius, by the force m g (-2x, -2y, 1)."""
    rate = np.sqrt(2 * G)
    found = solved([1.5, 0, 2.25], {"surface": "z - x^2 - y^2"}, velocity=[0, "3*sqrt(20)/2", 0])
    place, x, z = columns(found, "bead.position", "wire.x", "wire.z")
    circle = [1.5 * np.cos(rate * TIMES), 1.5 * np.sin(rate * TIMES), np.full(3, 2.25)]
    np.testing.assert_allclose(place, np.transpose(circle), atol=1e-12)
    np.testing.assert_allclose(x, -4 * G * place[:, 0], atol=1e-10)
    np.testing.assert_allclose(z, 2 * G, atol=1e-11)


@pytest.mark.parametrize(
    "on", [{"surface": "y - x^2"}, {"curve": ["u", "u^2"]}, {"curve": ["2*u", "4*u^2"], "start": 2}]
)
def test_a_parabola_is_that_of_the_language(on: dict[str, Any]) -> None:
    known = solved([1, 1], {"at": [0, 0], "curvature": 2})
    found = solved([1, 1], on)
    for name in ("bead.position", "wire.x", "wire.y"):
        np.testing.assert_allclose(*(columns(one, name)[0] for one in (found, known)), atol=1e-12)


@pytest.mark.parametrize("on", [{"surface": "y - sin(3*t)/5 - x"}, {"curve": ["u", "u + sin(3*t)/5"]}])
def test_a_wire_that_shakes_carries_its_bead(on: dict[str, Any]) -> None:
    """Along the slope of 45 degrees acts -(g + y'')/2 of the wire: x'' = -5 + 0.9 sin(3t), x'(0) = -0.3."""
    found = solved([0, 0], on)
    (place,) = columns(found, "bead.position")
    x = -2.5 * TIMES**2 - np.sin(3 * TIMES) / 10
    np.testing.assert_allclose(place[:, 0], x, atol=1e-13)
    np.testing.assert_allclose(place[:, 1], x + np.sin(3 * TIMES) / 5, atol=1e-13)


def test_start_chooses_among_parameters_of_one_place() -> None:
    """Where a figure eight crosses itself the bead starts along the branch of the parameter that is nearest."""
    for start, side in (("pi/2", -1), ("3*pi/2", 1)):
        found = solved([0, 0], {"curve": ["cos(u)", "sin(2*u)/2"], "start": start})
        assert found.accelerations is not None
        assert found.accelerations["bead"].linear[0] == pytest.approx(side * G / 2)


def test_digits_are_proven_where_the_parameter_is_a_double() -> None:
    """The bead on the cycloid of the arc 4 sin(u/2), after one second from u = 5/2."""
    track = {"kind": "track", "place": "bead", "on": {"curve": ["u + sin(u)", "-cos(u)"]}}
    bodies = {"bead": {"mass": 2, "at": ["5/2 + sin(5/2)", "-cos(5/2)"]}}
    scene = scene_from({"gravity": [0, -10], "bodies": bodies, "connections": [track]})
    found = proven_answer(scene, 20, [Fraction(1)], ["trajectory"])
    with mpmath.workdps(40):
        arc = mpmath.sin(mpmath.mpf(5) / 4) * mpmath.cos(mpmath.sqrt(10) / 2)
        height = 2 * arc**2 - 1
        assert found.columns is not None
        assert abs(mpmath.mpf(found.columns["bead.position"].values[0][1]) - height) < mpmath.mpf(10) ** -18


@pytest.mark.parametrize("gravity", [0, -1])
@pytest.mark.parametrize("speed", [3, -4])
@pytest.mark.parametrize(("height", "x"), [("sin(u)", 0), ("sin(2*u)/2", 0), ("sin(u)", 1000)])
@pytest.mark.parametrize("alone", [True, False])
def test_what_goes_round_a_closed_curve_repeats(height: str, x: int, speed: int, gravity: int, alone: bool) -> None:
    """The period is the integral of ds/v round the curve, with v^2 = v_0^2 - 2 g y, by the trapezoidal rule.

    That converges exponentially for what is periodic.
    """
    bodies = {"bead": {"mass": 2, "at": [x + 1, 0], "velocity": [0, speed]}}
    if not alone:
        bodies["rest"] = {"mass": 1, "at": [5, 5]}
    connections = [{"kind": "track", "place": "bead", "on": {"curve": [f"{x} + cos(u)", height]}}]
    if not alone:
        connections.append({"kind": "pin", "a": "rest", "b": [5, 5]})
    scene = {"gravity": [0, gravity], "bodies": bodies, "connections": connections}
    u = 2 * np.pi * np.arange(400) / 400
    if height == "sin(u)":
        y, slope = np.sin(u), np.ones(400)
    else:
        y, slope = np.sin(2 * u) / 2, np.hypot(np.sin(u), np.cos(2 * u))
    expected = 2 * np.pi * np.mean(slope / np.sqrt(speed**2 + 2 * gravity * y))
    answer = solve_scene(scene_from(scene), [7.0], ["trajectory"])
    assert answer.period == pytest.approx(expected, rel=1e-13)


def test_what_goes_on_along_an_open_curve_does_not_repeat() -> None:
    bead = {"mass": 2, "at": [0, -1], "velocity": [9, 0]}
    track = {"kind": "track", "place": "bead", "on": {"curve": ["2*u + sin(u)", "-cos(u)"]}}
    scene = {"gravity": [0, -1], "bodies": {"bead": bead}, "connections": [track]}
    assert solve_scene(scene_from(scene), [7.0], ["trajectory"]).period is None


def test_where_a_curve_loses_its_direction_the_motion_ends() -> None:
    """By u^3 a parabola has none at u = 0, which the bead reaches."""
    found = solved([1, 1], {"curve": ["u^3", "u^6"], "start": 2})
    assert found.ended is not None
    assert found.ended.kind == "singular"


@pytest.mark.parametrize(
    ("at", "on", "pointer", "rule"),
    [
        ([1, 1], {"surface": "y - x^3/2"}, ("surface",), "be zero where the place starts"),
        ([1, 1], {"surface": "3"}, ("surface",), "be a formula of x, y"),
        ([1, 1], {"surface": "y - v"}, ("surface",), "known names"),
        ([1, 1], {"surface": "y - x", "at": [0, 0]}, (), "nothing beside surface"),
        ([1, 1], {"curve": ["u", "u^3/2"]}, ("curve",), "pass through the place"),
        ([0, 0], {"curve": ["u^3", "u^2"]}, ("curve",), "in a direction"),
        ([1, 1], {"curve": ["u"]}, ("curve",), "a list of 2 formulas"),
        ([1, 1], {"curve": [1, "2"]}, ("curve",), "have formulas of u"),
        ([1, 1], {"curve": ["u", "bead.x"]}, ("curve", 1), "known names"),
        ([1, 1], {"curve": ["u", "u"], "slope": 1}, (), "nothing beside curve and start"),
    ],
)
def test_what_is_no_track_is_refused(at: list[Any], on: dict[str, Any], pointer: tuple[Any, ...], rule: str) -> None:
    with pytest.raises(InvalidParameter, match=rule) as refused:
        solved(at, on)
    assert refused.value.path == ("connections", 0, "on", *pointer)


@pytest.mark.parametrize("formula", ["x*y", "-3*x*y"])
@pytest.mark.parametrize("space", [False, True])
def test_a_motion_ends_where_branches_of_its_surface_cross(formula: str, space: bool) -> None:
    # It falls along x = 0 from y = 1, to y = 0 in sqrt(2/g).
    rest = [0] if space else []
    bead = {"mass": 1, "at": [0, 1, *rest]}
    track = {"kind": "track", "place": "a", "on": {"surface": formula}}
    scene = {"bodies": {"a": bead}, "gravity": [0, -9.81, *rest], "connections": [track]}
    answer = solve_scene(scene_from(scene), [0.0, 1.0])
    end = answer.ended
    assert end is not None
    assert end.kind == "singular"
    assert abs(end.time - math.sqrt(2 / 9.81)) <= end.error


@pytest.mark.parametrize(
    ("formula", "at", "velocity", "gravity", "end"),
    [
        # z = 0 beside x = 0 and y = 0, beside the cone x y + z^2 = 0, whose apex the second one passes by.
        ("x*y*z", [1, 2, 0], [-1, 0, 0], 0, 1.0),
        ("x*y*z + z*z*z", [1, 1, 0], [-1, 0, 0], 0, 1.0),
        ("x*y + z*z", [0, 1, 0], [0, 0, 0], 2, 1.0),
        ("y*(y - x*x)", [-1, 0], [1, 0], 0, 1.0),
    ],
)
def test_a_motion_ends_where_its_surface_has_no_normal(
    formula: str, at: list[int], velocity: list[int], gravity: int, end: float
) -> None:
    track = {"kind": "track", "place": "a", "on": {"surface": formula}}
    body = {"mass": 1, "at": at, "velocity": velocity}
    down = [0, -gravity, 0][: len(at)]
    answer = solve_scene(scene_from({"bodies": {"a": body}, "gravity": down, "connections": [track]}), [0.0, 2.0])
    assert answer.ended is not None
    assert answer.ended.kind == "singular"
    assert abs(answer.ended.time - end) <= answer.ended.error


@pytest.mark.parametrize(
    ("formulas", "velocity", "end"),
    [
        # y = 0 beside x = 1/t, x = 1 + 1/t and x = 4/t.
        (["y*x*t - y"], [1, 0], math.sqrt(2) - 1),
        (["y*x*t - y*t - y"], [1, 0], (math.sqrt(5) - 1) / 2),
        (["y*x*x*t - 4*y*x + y*y*t"], [1, 0], math.sqrt(5) - 1),
        # Of two surfaces that hold two coordinates, the determinant is x^2 - t^2.
        (["y*x - z*t", "z*x - y*t"], [-0.5, 0, 0], 4 / 3),
    ],
)
def test_a_motion_ends_where_what_holds_it_is_crossed_in_time(
    formulas: list[str], velocity: list[float], end: float
) -> None:
    body = {"mass": 1, "at": [2, 0, 0][: len(velocity)], "velocity": velocity}
    tracks = [{"kind": "track", "place": "a", "on": {"surface": formula}} for formula in formulas]
    scene = {"bodies": {"a": body}, "gravity": [0] * len(velocity), "connections": tracks}
    answer = solve_scene(scene_from(scene), [0.0, 2.0])
    assert answer.ended is not None
    assert answer.ended.kind == "singular"
    assert abs(answer.ended.time - end) <= answer.ended.error


@pytest.mark.parametrize("seed", range(6))
def test_a_motion_ends_where_its_plane_meets_others(seed: int) -> None:
    # On the plane n x = d its acceleration is g - (g n) n / n^2; m x = e is where a quadratic of time vanishes.
    random = np.random.default_rng(seed)
    dimension = 2 + seed % 2
    at, *planes = random.integers(-4, 5, (4, dimension))
    gravity = random.integers(-9, 10, dimension)
    own, others = planes[0], [plane for plane in planes[1:] if np.linalg.matrix_rank([plane, planes[0]]) == 2]
    axes = "xyz"[:dimension]

    def plane(normal: Any, offset: int) -> str:
        terms = " + ".join(f"({n})*{x}" for n, x in zip(normal, axes, strict=True))
        return f"({terms} - ({offset}))"

    offsets = [int(other @ at) + int(random.integers(1, 5)) for other in others]
    formula = "*".join([plane(own, int(own @ at)), *map(plane, others, offsets)])
    gain = gravity - (gravity @ own) / (own @ own) * own
    times = [math.sqrt(way) for n, e in zip(others, offsets, strict=True) if (way := 2 * (e - n @ at) / (n @ gain)) > 0]
    track = {"kind": "track", "place": "a", "on": {"surface": formula}}
    bodies = {"a": {"mass": 1, "at": at.tolist()}}
    scene = {"bodies": bodies, "gravity": gravity.tolist(), "connections": [track]}
    answer = solve_scene(scene_from(scene), [0.0, 100.0])
    assert times
    assert answer.ended is not None
    assert answer.ended.kind == "singular"
    assert abs(answer.ended.time - min(times)) <= answer.ended.error + 1e-15 * min(times)


@pytest.mark.parametrize(
    ("formula", "rule"), [("0*x", "change with x or y"), ("x-x", "change with x or y"), ("x*y", "singular place")]
)
def test_a_surface_without_a_gradient_at_the_start_is_refused(formula: str, rule: str) -> None:
    track = {"kind": "track", "place": "a", "on": {"surface": formula}}
    scene = {"bodies": {"a": {"mass": 1, "at": [0, 0]}}, "gravity": [0, -9.81], "connections": [track]}
    with pytest.raises(InvalidParameter, match=rule):
        solve_scene(scene_from(scene), [0.0, 1.0])
