"""Motions that repeat, many periods after their start."""

from __future__ import annotations

from typing import Any

import mpmath
import pytest

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read


@pytest.mark.parametrize("strength", [4, 20, 30, 36, 40, 44])
@pytest.mark.parametrize("time", [7.3, 10.0, 3.1e3])
def test_a_place_after_up_to_1e25_periods_is_the_elliptic_function_within_its_error(strength: int, time: float) -> None:
    # Beyond 2^53 periods their number is no whole number in doubles; pairs still tell the phase.
    bob = {"mass": 2, "at": ["sin(2.5)", "-cos(2.5)"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    scene = {"gravity": [0, f"-1e{strength}"], "bodies": {"bob": bob}, "connections": [rod]}
    place = column(solve_scene(read(scene), [time], accuracy=0.5), "bob.position")
    with mpmath.workdps(80):
        # sin(theta/2) = k cd(omega t, k), with k the sine of half the amplitude
        k = mpmath.sin(mpmath.mpf("1.25"))
        half = mpmath.asin(
            k * mpmath.ellipfun("cd", mpmath.sqrt(mpmath.mpf(10) ** strength) * mpmath.mpf(time), m=k * k)
        )
        assert abs(mpmath.sin(2 * half) - place.values[0, 0]) <= place.error
    assert place.error < max(1e-14, 10.0 ** (strength / 2 - 26) * time)


def period(scene: dict[str, Any]) -> float:
    found = solve_scene(read(scene), [0.1]).period
    assert found is not None
    return found


@pytest.mark.parametrize("degrees", ["10", "45", "44.9999999", "45.0001", "60", "89", "120", "135", "-45", "170"])
def test_the_period_of_a_pendulum_is_the_elliptic_integral_at_every_angle(degrees: str) -> None:
    """At 45 degrees the path turns by a right angle from one turning point to the other."""
    angle = f"{degrees}*pi/180"
    bob = {"mass": 1, "at": [f"2*sin({angle})", f"-2*cos({angle})"]}
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    found = period({"gravity": [0, "-9.81"], "bodies": {"bob": bob}, "connections": [rod]})
    with mpmath.workdps(40):
        half = mpmath.mpf(degrees) * mpmath.pi / 360
        right = 4 * mpmath.sqrt(2 / mpmath.mpf("9.81")) * mpmath.ellipk(mpmath.sin(half) ** 2)
        assert abs(found - right) <= 3e-16 * right


@pytest.mark.parametrize("slope", ["0.3", "1", "1.0001", "2"])
def test_the_period_of_a_bead_on_a_parabola_is_the_integral_along_it(slope: str) -> None:
    """On y = x^2 / 2, whose slope is x, from rest: the time over the arc is an integral."""
    track = {"kind": "track", "place": "bead", "on": {"at": [0, 0], "curvature": 1}}
    bead = {"mass": 1, "at": [slope, f"{slope}^2/2"]}
    found = period({"gravity": [0, "-9.81"], "bodies": {"bead": bead}, "connections": [track]})
    with mpmath.workdps(30):
        a = mpmath.mpf(slope)

        def along(angle: mpmath.mpf) -> mpmath.mpf:
            # x = a sin(angle), and the speed is sqrt(g (a^2 - x^2)).
            return mpmath.sqrt((1 + (a * mpmath.sin(angle)) ** 2) / mpmath.mpf("9.81"))

        right = 4 * mpmath.quad(along, [0, mpmath.pi / 4, mpmath.pi / 2])
        assert abs(found - right) <= 3e-16 * right


@pytest.mark.parametrize("gravity", ["-9.81", "0"])
@pytest.mark.parametrize("heading", [("1", "0"), ("0", "1"), ("0.6", "0.8"), ("-sqrt(0.5)", "sqrt(0.5)")])
@pytest.mark.parametrize("kind", ["disc", "ellipsoid"])
def test_what_rolls_straight_on_has_no_period(gravity: str, heading: tuple[str, str], kind: str) -> None:
    """Its directions return at every turn, and the place does not."""
    x, y = heading
    size = {"radius": 0.5} if kind == "disc" else {"semi_axes": [0.5, 0.5, 0.2]}
    coin = {
        "mass": 1,
        "shape": {"kind": kind, **size},
        "at": [0, 0, 0.5],
        "axes": [[x, y, 0], [0, 0, 1], [y, f"-({x})", 0]],
        "velocity": [f"2*({x})", f"2*({y})", 0],
    }
    table = {"kind": "rolling", "place": "coin", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    scene = {"gravity": [0, 0, gravity], "bodies": {"coin": coin}, "connections": [table]}
    answer = solve_scene(read(scene), [0.0, 1.0, 1e3])
    assert (answer.period, [part.period for part in answer.model.apart]) == (None, [None])
    place = column(answer, "coin.position")
    with mpmath.workdps(30):
        way = [mpmath.sqrt(0.5) * s if "sqrt" in t else mpmath.mpf(t) for t, s in zip(heading, (-1, 1), strict=True)]
        for i, t in enumerate([0.0, 1.0, 1e3]):
            assert max(abs(2 * t * w - p) for w, p in zip(way, place.values[i], strict=False)) <= place.error + 1e-13


@pytest.mark.parametrize(("relation", "returns"), [("3*p.angle + w.angle", True), ("p.angle + 3*w.angle", False)])
def test_what_turns_over_returns_where_all_of_its_turns_are_whole(relation: str, returns: bool) -> None:
    """A pendulum that turns over drives a wheel by three turns, or by a third of one, in each of its own."""
    hanging = {"mass": 1, "inertia": 0.2, "at": [0, -1], "angle": 0, "velocity": [9, 0], "angular_velocity": 9}
    bodies = {
        "p": {**hanging, "places": {"top": [0, 1]}},
        "w": {"mass": 1, "inertia": 0.3, "at": [2, 0], "shape": {"kind": "disc", "radius": 0.5}},
    }
    connections = [
        {"kind": "pin", "a": "p.top", "b": [0, 0]},
        {"kind": "pin", "a": "w", "b": [2, 0]},
        {"kind": "relation", "of": relation, "equals": 0},
    ]
    scene = {"gravity": [0, "-9.81"], "bodies": bodies, "connections": connections}
    answer = solve_scene(read(scene), [0.0, 1.0])
    assert (answer.period is not None) is returns
    assert answer.model.apart[0].period == answer.period
    if answer.period is not None:
        with mpmath.workdps(30):
            # theta'^2 = 81 - 4 (g/I) sin^2(theta/2): half the angle is the amplitude of 9 t/2.
            inertia = 1 + mpmath.mpf("0.2") + 9 * mpmath.mpf("0.3")
            right = 4 * mpmath.ellipk(4 * mpmath.mpf("9.81") / (81 * inertia)) / 9
            assert abs(answer.period - right) <= 1e-15


def on_a_rail(x: str, pull: str, **more: Any) -> dict[str, Any]:
    rail = {"kind": "slider", "a": "bob", "b": [0, 0], "slope": 0}
    force = {"kind": "force", "name": "pull", "place": "bob", "force": [pull, 0]}
    return {"bodies": {"bob": {"mass": 1, "at": [x, 0], **more}}, "connections": [rail, force]}


@pytest.mark.parametrize("amplitude", ["1/10", "1", "10"])
def test_the_period_of_a_hardening_spring_is_the_elliptic_integral(amplitude: str) -> None:
    """Of x'' = -x - x^3 it is 4 K(m)/sqrt(1 + A^2) with m = A^2/(2 + 2 A^2)."""
    square = eval(amplitude) ** 2
    exact = 4 * mpmath.ellipk(square / (2 + 2 * square)) / mpmath.sqrt(1 + square)
    assert period(on_a_rail(amplitude, "-x - x^3")) == pytest.approx(float(exact), rel=1e-15)


def test_a_hardening_spring_is_where_the_elliptic_function_says_after_thousands_of_periods() -> None:
    """Of x'' = -x - x^3 from rest at 1 it is cn(sqrt(2) t) with the parameter 1/4."""
    place = column(solve_scene(read(on_a_rail("1", "-x - x^3")), [0.3, 1e4], accuracy=1e-6), "bob.position")
    with mpmath.workdps(30):
        for row, time in enumerate((0.3, 1e4)):
            exact = mpmath.ellipfun("cn", mpmath.sqrt(2) * mpmath.mpf(time), m=mpmath.mpf(1) / 4)
            assert abs(exact - place.values[row, 0]) <= place.error
    assert place.error < 1e-13


def test_a_morse_oscillator_has_the_period_of_its_energy() -> None:
    """Of the potential exp(-2x) - 2 exp(-x) it is 2 pi/sqrt(-2 E) (P. M. Morse, Physical Review 34 (1929), 57)."""
    energy = mpmath.exp(-1) - 2 * mpmath.exp(-mpmath.mpf(1) / 2)
    exact = 2 * mpmath.pi / mpmath.sqrt(-2 * energy)
    assert period(on_a_rail("1/2", "-2*(exp(-x) - exp(-2*x))")) == pytest.approx(float(exact), rel=1e-15)


@pytest.mark.parametrize("way", [["6/5", 0], ["18/25", "24/25"], ["18/25", 0, "24/25"]])
@pytest.mark.parametrize("speed", [0, 3])
def test_two_atoms_swing_however_they_lie_and_fly(way: list[Any], speed: float) -> None:
    """Lennard-Jones: the period is an integral over the distance, with the reduced mass 2/3."""
    bodies = {
        "one": {"mass": 1, "at": [1000, 0, 0][: len(way)], "velocity": [speed, 1, 2][: len(way)]},
        "two": {"mass": 2, "at": [f"1000 + {way[0]}", *way[1:]], "velocity": [speed, 1, 2][: len(way)]},
    }
    bond = {"kind": "spring", "a": "one", "b": "two", "law": "24/length^7 - 48/length^13"}
    with mpmath.workdps(30):

        def potential(r: Any) -> Any:
            return 4 * (r**-12 - r**-6)

        far = mpmath.mpf(6) / 5
        # Of x = r^-6 the potential is 4 (x^2 - x): both ends add up to one.
        near = (1 - far**-6) ** (-mpmath.mpf(1) / 6)

        def slowness(u: Any) -> Any:
            # r = middle + half sin u takes out the roots at both ends.
            r = (near + far) / 2 + (far - near) / 2 * mpmath.sin(u)
            return (far - near) / 2 * mpmath.cos(u) / mpmath.sqrt(3 * (potential(far) - potential(r)))

        exact = float(2 * mpmath.quad(slowness, [-mpmath.pi / 2, 0, mpmath.pi / 2], method="gauss-legendre"))
    found = solve_scene(read({"bodies": bodies, "connections": [bond]}), [0.25, 0.25 + 40 * exact])
    apart = column(found, "two.position").values - column(found, "one.position").values
    assert apart[0] == pytest.approx(apart[1], abs=1e-11)
    size = sum(x * x for x in apart[0]) ** 0.5
    assert float(near) < size < 1.2


@pytest.mark.parametrize(
    ("bodies", "connections"),
    [
        ({"bob": {"mass": 1, "at": [1, 0], "velocity": [0, 3]}}, ["-y", "x"]),
        ({"bob": {"mass": 1, "at": [1, 0], "velocity": [0, 3]}}, ["-vx/10", 0]),
        ({"bob": {"mass": 1, "at": [1, 0], "velocity": [0, 3]}}, ["sin(t)", 0]),
    ],
)
def test_what_gains_or_loses_with_each_round_has_no_period(bodies: dict[str, Any], connections: list[Any]) -> None:
    rod = {"kind": "rod", "a": "bob", "b": [0, 0]}
    force = {"kind": "force", "place": "bob", "force": connections}
    found = solve_scene(read({"bodies": bodies, "connections": [rod, force]}), [0.1])
    assert found.period is None
    assert found.model.name == "Taylor series"
