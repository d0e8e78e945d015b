"""Places of rest, their small motions and the errors of both, against closed forms in mpmath."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mpmath import mpf

from core.multibody.answer import Equilibrium
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import points, read

with mpmath.workdps(60):
    G = mpf("9.81")


@pytest.fixture(autouse=True)
def _in_many_digits() -> Iterator[None]:
    with mpmath.workdps(60):
        yield


def found(scene: dict[str, Any]) -> tuple[Equilibrium, ...]:
    places = solve_scene(read(scene), outputs=("equilibria",)).equilibria
    assert places is not None
    return places


def bead(rate: str, at: tuple[float, float] = (0.6, -0.8)) -> dict[str, Any]:
    return {
        "gravity": [0, -9.81],
        "bodies": {"bead": {"mass": 0.1, "at": list(at)}},
        "connections": [{"kind": "rod", "a": "bead", "b": [0, 0]}, {"kind": "spinning-frame", "rate": rate}],
    }


def check(one: Equilibrium, body: str, place: tuple[Any, ...], square: Any, widest: float = 1e-15) -> None:
    """Hold a place and the square of its only mode, negative where it grows, against their stated errors."""
    wrong = mpmath.norm([mpf(x) - y for x, y in zip(one.positions[body], place, strict=True)])
    assert wrong <= one.errors.positions[body] <= widest * max(1.0, float(mpmath.norm(place)))
    (mode,) = one.modes
    assert mode.errors is not None
    for value, error, exact in (
        (mode.frequency, mode.errors.frequency, mpmath.sqrt(max(square, 0))),
        (mode.growth_rate, mode.errors.growth_rate, mpmath.sqrt(max(-square, 0))),
    ):
        assert error is not None
        assert abs(mpf(value) - exact) <= error <= widest * max(1.0, float(exact))


@settings(max_examples=10)
@given(st.integers(1, 19).map(lambda n: f"{n}e-{n}"), st.sampled_from([(0.6, -0.8), (0, -1)]))
@example("1e-20", (0, -1))
@example("1e-5", (0.6, -0.8))
def test_a_bead_just_above_its_critical_rate_has_four_places(above: str, start: tuple[float, float]) -> None:
    """cos(theta) = g/(R Omega^2): at 1e-20 above the tilted places are 2e-10 from the lowest one, which is unstable."""
    square = G * (1 + mpf(above)) ** 2
    c = G / square
    s = mpmath.sqrt(1 - c**2)
    places = found(bead(f"sqrt(9.81)*(1 + {above})", start))
    assert len(places) == 4
    right = next(one for one in places if one.positions["bead"][0] > 0)
    left = next(one for one in places if one.positions["bead"][0] < 0)
    below, top = sorted(
        (one for one in places if one.positions["bead"][0] == 0), key=lambda one: one.positions["bead"][1]
    )
    check(right, "bead", (s, -c), square * s**2)
    check(left, "bead", (-s, -c), square * s**2)
    check(below, "bead", (mpf(0), mpf(-1)), G - square)
    check(top, "bead", (mpf(0), mpf(1)), -G - square)
    assert [one.stable for one in (right, left, below, top)] == [True, True, False, False]


def test_a_bead_at_its_critical_rate_has_a_place_that_small_motions_do_not_decide() -> None:
    """The lowest place is a triple solution: Newton's method comes to it slowly, and what is left is stated."""
    places = found(bead("sqrt(9.81)"))
    assert len(places) == 2
    (below,) = (one for one in places if one.positions["bead"][1] < 0)
    check(below, "bead", (mpf(0), mpf(-1)), mpf(0), 1e-9)
    assert below.errors.positions["bead"] < 1e-20
    assert below.stable is None


def test_a_rod_at_the_critical_stiffness_of_its_torsion_spring() -> None:
    rod = {"mass": 1, "inertia": "1/12", "at": ["0.5*sin(0.1)", "0.5*cos(0.1)"], "angle": "pi/2 - 0.1"}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"rod": {**rod, "places": {"foot": [-0.5, 0]}}},
        "connections": [
            {"kind": "pin", "a": "rod.foot", "b": [0, 0]},
            {"kind": "torsion-spring", "a": "rod", "stiffness": "9.81/2", "rest_angle": "pi/2"},
        ],
    }
    (one,) = found(scene)
    assert abs(mpf(one.angles["rod"]) - mpmath.pi / 2) <= one.errors.angles["rod"] < 1e-15
    assert one.stable is None


@pytest.mark.parametrize("length", ["1", "1e3", "1e6", "1e9", "1e-6"])
def test_places_of_a_double_pendulum_of_any_length(length: str) -> None:
    """The four places are exact: forces of 2e-9 of 20 N were left at some of long strings."""
    size = float(length)
    places = found(points((1, 1), ("0.3", "0.2"), (2, 1)) | {"bodies": _bobs(length)})
    assert len(places) == 4
    for one in places:
        assert one.residual < 1e-80
        for name, reach in (("p0", {size}), ("p1", {0.0, 2 * size})):
            x, y = one.positions[name]
            assert (x, abs(y) in reach) == (0.0, True)


def _bobs(length: str) -> dict[str, Any]:
    return {
        "p0": {"mass": 2, "at": [f"0.6*{length}", f"-0.8*{length}"]},
        "p1": {"mass": 1, "at": [f"1.4*{length}", f"-1.4*{length}"]},
    }


def test_a_wheel_rests_at_any_angle() -> None:
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"wheel": {"mass": 2, "inertia": 1, "at": [0, 0]}},
        "connections": [{"kind": "pin", "a": "wheel", "b": [0, 0]}],
    }
    places = found(scene)
    assert places
    assert {one.positions["wheel"] for one in places} == {(0.0, 0.0)}
    assert {one.stable for one in places} == {None}


def test_damped_and_gyroscopic_modes_have_errors() -> None:
    """q'' + 2 d q' + w^2 q = 0 of a block on a spring: the root is -d + i sqrt(w^2 - d^2)."""
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"block": {"mass": 2, "at": [0.3, 0]}},
        "connections": [
            {"kind": "track", "place": "block", "on": {"at": [0, 0]}},
            {"kind": "spring", "a": [-1, 0], "b": "block", "stiffness": 7, "rest_length": 1},
            {"kind": "damper", "a": [-1, 0], "b": "block", "coefficient": 3},
        ],
    }
    one = next(place for place in found(scene) if abs(place.positions["block"][0]) < 0.5)
    assert one.stable is True
    (mode,) = one.modes
    assert mode.errors is not None
    assert mode.errors.frequency is not None
    assert mode.errors.growth_rate is not None
    assert abs(mpf(mode.growth_rate) + mpf(3) / 4) <= mode.errors.growth_rate < 1e-15
    assert abs(mpf(mode.frequency) - mpmath.sqrt(mpf(7) / 2 - mpf(9) / 16)) <= mode.errors.frequency < 1e-15
