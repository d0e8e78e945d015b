"""Models that claim more than the motion does are refused; so is a wrong angle of precession."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.core.multibody.audit.spoiled import Audited, answered, description_of

UNEVEN = ("physical-pendulum", "damped-oscillator", "two-masses-two-springs", "kepler-ellipse", "crank-slider")
UNIFORM = ("atwood-machine", "blocks-on-incline", "movable-wedge", "yo-yo")
PRECESSING = ("spherical-pendulum", "lagrange-top", "precessing-top", "ball-and-stick")


@cache
def right(scene: str) -> Audited:
    return answered(description_of(scene))


def claimed(one: Audited, model: str) -> Audited:
    """Return an answer all parts of which claim a model."""
    apart = tuple(replace(part, name=model) for part in one.answer.model.apart)
    return replace(one, answer=replace(one.answer, model=replace(one.answer.model, apart=apart)))


@pytest.mark.parametrize("scene", UNEVEN)
@pytest.mark.parametrize("model", ["rest", "constant acceleration"])
def test_what_moves_unevenly_is_neither_at_rest_nor_uniform(scene: str, model: str) -> None:
    one = right(scene)
    assert one.failure() is None
    assert claimed(one, model).failure() is not None


@pytest.mark.parametrize("scene", UNIFORM)
def test_what_is_accelerated_is_not_at_rest(scene: str) -> None:
    assert right(scene).failure() is None
    if not right(scene).answer.phases:
        assert claimed(right(scene), "rest").failure() is not None


def test_what_comes_to_rest_on_three_rough_places_is_known_to_rounding_of_its_speed() -> None:
    places = {"l": [-0.5, 0], "m": [0, 0], "r": [0.5, 0]}
    bar = {"mass": 1, "inertia": 0.1, "at": [0, 0], "velocity": [1, 0], "places": places}
    contacts = [{"kind": "contact", "place": f"b.{p}", "on": {"at": [0, 0]}, "friction": 0.3} for p in places]
    one = answered({"gravity": [0, -10], "bodies": {"b": bar}, "connections": contacts}, np.array([1.0]))
    assert one.failure() is None


def test_rates_that_vanish_are_known_beside_those_that_the_forces_would_make() -> None:
    """Two rods in line over a floor take each other's velocities to 1e-145 m/s."""
    stone = {"mass": 0.5, "at": ["0.56*0.6", "-0.56*0.8"], "velocity": ["-2*0.56*0.8", "-2*0.56*0.6"]}
    bar = {
        "mass": 3.72,
        "inertia": 0.1,
        "at": ["0.56*0.6+0.3*sqrt(2)/2", "-0.56*0.8+0.53-0.3*sqrt(2)/2"],
        "angle": "-acos(sqrt(2)/2)",
        "places": {"top": [-0.3, 0]},
    }
    corner = {"mass": 1.76, "at": ["0.56*0.6", "-0.56*0.8+0.53"]}
    connections = [
        {"kind": "rod", "a": "stone", "b": [0, 0]},
        {"kind": "rod", "a": "corner", "b": "stone"},
        {"kind": "contact", "place": "corner", "on": {"at": [0, "-0.56*0.8+0.53"]}},
        {"kind": "pin", "a": "bar.top", "b": "corner"},
    ]
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"stone": stone, "corner": corner, "bar": bar},
        "connections": connections,
    }
    assert answered(scene, np.zeros(0), ["accelerations", "forces", "energy"]).failure() is None


def test_a_wrong_angle_of_precession_is_refused() -> None:
    count = 0
    for scene in PRECESSING:
        one = right(scene)
        parts = one.answer.model.apart
        if not any(part.precession is not None for part in parts) or one.answer.period is None:
            continue
        assert one.failure() is None
        apart = tuple(
            part if part.precession is None else replace(part, precession=part.precession + 1e-6) for part in parts
        )
        spoiled = replace(one, answer=replace(one.answer, model=replace(one.answer.model, apart=apart)))
        assert spoiled.failure() is not None, scene
        count += 1
    assert count >= 1
