"""Wrong equilibria are refused: places off the balance or off what holds them, and modes that are not theirs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.multibody.answer import Equilibrium
from core.multibody.solve import solve_scene
from tests.core.multibody.audit.spoiled import Audited, answered, description_of
from tests.core.multibody.random_scenes import any_scene
from tests.core.multibody.relations.geometry import dimension
from tests.core.multibody.relations.geometry import moved as moved_as_a_whole
from tests.core.multibody.worked_examples import read

RESTING = (
    "bead-on-hoop", "bead-on-parabola", "bead-on-rotating-rod", "centrifugal-governor", "conical-pendulum",
    "coupled-pendulums", "damped-oscillator", "double-pendulum", "double-pendulum-of-points", "elastic-pendulum",
    "four-bar-linkage", "harmonic-ellipse", "inverted-pendulum-on-torsion-spring", "ladder-on-rails",
    "lagrange-points", "loaded-hoop", "physical-pendulum", "plank-on-two-strings", "rod-in-cylinder",
    "spherical-pendulum", "trammel",
)  # fmt: skip


@cache
def right(scene: str) -> Audited:
    return answered(description_of(scene), (), ("equilibria",))


def moved(by: float) -> Callable[[Equilibrium], Equilibrium]:
    def change(one: Equilibrium) -> Equilibrium:
        first = next(iter(one.positions))
        place = one.positions[first]
        return replace(one, positions={**one.positions, first: (place[0] + by, place[1] - by / 2.0, *place[2:])})

    return change


def turned(one: Equilibrium) -> Equilibrium:
    return replace(one, angles={name: angle + 1e-6 for name, angle in one.angles.items()})


def quicker(one: Equilibrium) -> Equilibrium:
    modes = tuple(
        mode._replace(frequency=mode.frequency * (1.0 + 1e-5), growth_rate=mode.growth_rate * (1.0 + 1e-5))
        for mode in one.modes
    )
    return replace(one, modes=modes)


SPOILED: dict[str, Callable[[Equilibrium], Equilibrium]] = {
    "a place is off by a millionth": moved(1e-6),
    "a place is off by a hundredth": moved(1e-2),
    "angles are off by a millionth": turned,
    "places are reflected": lambda one: replace(
        one, positions={name: tuple(-x - 0.1 for x in place) for name, place in one.positions.items()}
    ),
    "modes are too quick by a hundred thousandth": quicker,
    "modes that are stable grow": lambda one: replace(
        one, modes=tuple(mode._replace(frequency=mode.growth_rate, growth_rate=mode.frequency) for mode in one.modes)
    ),
    "a mode is missing": lambda one: replace(one, modes=one.modes[1:]),
    "a mode is listed twice": lambda one: replace(one, modes=(*one.modes, *one.modes[:1])),
    "stability is the opposite": lambda one: replace(one, stable=None if one.stable is None else not one.stable),
}


@pytest.mark.parametrize("scene", RESTING)
def test_right_equilibria_pass(scene: str) -> None:
    assert right(scene).answer.equilibria
    assert right(scene).failure() is None


@pytest.mark.parametrize("kind", SPOILED)
def test_wrong_equilibria_are_refused(kind: str) -> None:
    count = 0
    for scene in RESTING:
        one = right(scene)
        equilibria = one.answer.equilibria
        assert equilibria is not None
        spoiled = tuple(map(SPOILED[kind], equilibria))
        damped = scene in ("damped-oscillator", "lagrange-points")
        if spoiled == equilibria or (damped and "opposite" in kind):
            continue
        count += 1
        assert replace(one, answer=replace(one.answer, equilibria=spoiled)).failure() is not None, scene
    assert count >= (6 if "angles" in kind else 15)


@pytest.mark.parametrize("seed", range(0, 40, 5))
def test_equilibria_of_random_scenes_pass(seed: int) -> None:
    solve_scene(read(any_scene(seed)), np.zeros(0), ("equilibria",))


FAR = ("coupled-pendulums", "double-pendulum-of-points", "elastic-pendulum", "physical-pendulum", "spherical-pendulum")


SEEN = {
    "1e3": ("modes that are stable grow", "modes are too quick by a hundred thousandth"),
    "-1e6": ("modes that are stable grow",),
    "1e8": (),
}
"""What is wrong with answers so far away by more than coordinates are rounded."""


@pytest.mark.parametrize("by", SEEN)
@pytest.mark.parametrize("scene", FAR)
def test_equilibria_far_from_the_origin_pass_and_wrong_ones_are_refused(scene: str, by: str) -> None:
    """Lengths decide by how much places are changed, and not coordinates."""
    description = description_of(scene)
    transformed = moved_as_a_whole(description, [by, "0.25", "0.5"][: dimension(description)])
    assert transformed is not None
    one = answered(transformed.request, (), ("equilibria",))
    assert one.failure() is None
    for kind in SEEN[by]:
        spoiled = tuple(map(SPOILED[kind], one.answer.equilibria or ()))
        assert replace(one, answer=replace(one.answer, equilibria=spoiled)).failure() is not None


@pytest.mark.parametrize("length", [1e4, 1e6])
def test_lengths_of_a_million_beside_those_of_one_pass(length: float) -> None:
    """Pendulums on rods of a million metres with a spring of one, and pendulums of a metre on a spring of a million."""
    long = description_of("coupled-pendulums")
    long["bodies"]["left"]["at"], long["bodies"]["right"]["at"] = [length + 0.6, -0.8], [length + 1.0, -1.0]
    apart = description_of("coupled-pendulums")
    apart["bodies"]["right"]["at"] = [length + 1.0, -1.0]
    apart["connections"][1]["b"] = [length + 1.0, 0]
    apart["connections"][2]["rest_length"] = length
    for scene in (long, apart):
        one = answered(scene, (), ("equilibria",))
        assert one.answer.equilibria
        assert one.failure() is None


def test_the_period_of_a_top_passes_without_accelerations() -> None:
    # How fast its velocity changes after the period is not known then.
    assert right("lagrange-top").answer.period is not None
    assert right("lagrange-top").failure() is None


def test_whole_turns_of_welded_bodies_do_not_matter() -> None:
    places = {"top": [-0.5, 0], "end": [0.5, 0]}
    scene = {
        "gravity": [0, -10],
        "bodies": {
            "rod": {"mass": 1, "inertia": 0.1, "at": [0, -0.5], "angle": "-(pi/2)", "places": places},
            "lump": {"mass": 1, "inertia": 0.01, "at": [0, -1], "angle": "pi/3"},
        },
        "connections": [
            {"kind": "pin", "a": "rod.top", "b": [0, 0]},
            {"kind": "weld", "a": "lump", "b": "rod.end"},
        ],
    }
    one = answered(scene, (), ("equilibria",))
    assert len(one.answer.equilibria or ()) == 2
    assert one.failure() is None


def test_an_attitude_in_the_origin_is_known_to_rounding() -> None:
    axes = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    scene = {
        "gravity": [0, 0, -10],
        "bodies": {
            "slide": {"mass": 1, "moments": ["1/12", "1/12", "1/100"], "at": [0, 0, 0], "axes": axes},
        },
        "connections": [{"kind": "slider", "a": "slide", "b": [0, 0, 0], "direction": [0, 0, 1]}],
    }
    assert answered(scene, (), ("accelerations",)).failure() is None


def test_springs_that_twist_have_each_place_once_with_its_whole_turns() -> None:
    places = {"top": [-0.5, 0], "end": [0.5, 0]}
    one = {"mass": 1, "inertia": "1/12", "at": [0.4, -0.3], "angle": "-(atan(3/4))", "places": places}
    connections = [
        {"kind": "pin", "a": "one.top", "b": [0, 0]},
        {"kind": "pin", "a": "two.top", "b": "one.end"},
        {"kind": "torsion-spring", "a": "two", "b": "one", "stiffness": 5},
    ]
    bodies = {"one": one, "two": {**one, "angle": "-(atan(3/4)) + pi"}}
    found = answered({"gravity": [0, -9.81], "bodies": bodies, "connections": connections}, (), ("equilibria",))
    assert found.failure() is None
    # The spring is relaxed by half a turn: both rods hang or stand folded, or the knee is bent to either side.
    twists = sorted(round(place.angles["two"] - place.angles["one"], 3) for place in found.answer.equilibria or ())
    assert len(twists) == 4
    assert twists[1:3] == [round(np.pi, 3)] * 2
    assert twists[0] + twists[3] == pytest.approx(2.0 * np.pi, abs=2e-3)


def test_a_string_whose_course_doubles_do_not_resolve_is_not_compared() -> None:
    yoyo = {"mass": 0.1, "radius": 0.01, "inertia": 4e-5, "at": [0.01, -0.5]}
    string = {"kind": "string", "through": [[0, -1e300], "yo-yo"], "sides": {"yo-yo": "left"}}
    scene = {"gravity": [0, -9.81], "bodies": {"yo-yo": yoyo}, "connections": [string]}
    assert answered(scene, np.array([1.0]), ("accelerations", "trajectory")).failure() is None
