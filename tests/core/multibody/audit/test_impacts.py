"""Wrong impacts are refused: impulses, losses of energy, and rates of gaps that are not those of the restitution."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from core.systems.trajectory import MotionEvent
from tests.core.multibody import contact_judge
from tests.core.multibody.audit.spoiled import Audited, another, answered, description_of
from tests.core.multibody.worked_examples import read

STRUCK = ("dumbbell-dropped", "ball-on-ball-dropped", "spinning-disc-bounces", "cradle-of-two", "weight-lands")
TIMES = np.linspace(0.0, 2.0, 5)


@cache
def right(scene: str) -> Audited:
    return answered(description_of(scene), TIMES)


def with_events(one: Audited, change: Callable[[MotionEvent], MotionEvent]) -> Audited:
    """Return an answer all impacts of which are changed."""
    events = tuple(change(event) if event.impulses else event for event in one.answer.events)
    return replace(one, answer=replace(one.answer, events=events))


def scaled(name: str, factor: float) -> Callable[[MotionEvent], MotionEvent]:
    def change(event: MotionEvent) -> MotionEvent:
        impulses = {key: value * factor if key == name else value for key, value in event.impulses.items()}
        return replace(event, impulses=impulses)

    return change


SPOILED: dict[str, Callable[[MotionEvent], MotionEvent]] = {
    "impulses are too large": scaled("normal", 1.0 + 1e-5),
    "impulses have the wrong sign": scaled("normal", -1.0),
    "nothing is pushed": scaled("normal", 0.0),
    "energy is lost twice": lambda event: replace(event, energy_loss=2.0 * event.energy_loss + 1e-3),
    "rates are those of another impact": lambda event: replace(
        event,
        rates={
            key: replace(rate, after=rate.after + 1e-4 * max(1.0, abs(rate.before)))
            for key, rate in event.rates.items()
        },
    ),
    "energy is gained": lambda event: replace(event, energy_loss=-event.energy_loss - 1e-3),
}


@pytest.mark.parametrize("kind", SPOILED)
def test_a_wrong_impact_is_refused(kind: str) -> None:
    for scene in STRUCK:
        one = right(scene)
        assert any(event.impulses for event in one.answer.events), scene
        assert one.failure() is None, scene
        assert with_events(one, SPOILED[kind]).failure() is not None, scene


def test_another_restitution_is_refused() -> None:
    description: dict[str, Any] = {
        "gravity": [0, -10],
        "bodies": {"ball": {"mass": 1, "at": [0, 1.25]}},
        "connections": [{"kind": "contact", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.75}],
    }
    other = another(description, "restitution")
    assert other is not None
    one, wrong = answered(description, [0.0, 0.3, 0.7]), answered(other, [0.0, 0.3, 0.7])
    assert one.failure() is None
    failure = Audited(one.scene, wrong.answer, wrong.sampler, one.times).failure()
    assert failure is not None
    assert failure.law == "restitution"


@pytest.mark.parametrize("seed", [265, 560, 6443])
def test_bodies_that_spin_quickly_after_an_impact_pass(seed: int) -> None:
    # Their attitudes turn between the samples by more than the size of the scene and its speed say.
    horizon = float(np.random.default_rng(seed).choice([0.5, 2.0, 10.0]))
    solve_scene(read(contact_judge.any_scene(seed)), np.linspace(0.0, horizon, 21), accuracy=1e-6)


def test_each_of_eight_impacts_is_compared() -> None:
    description: dict[str, Any] = {
        "gravity": [0, -10],
        "bodies": {"ball": {"mass": 1, "at": [0, 1.25]}},
        "connections": [{"kind": "contact", "place": "ball", "on": {"at": [0, 0]}, "restitution": 1}],
    }
    one = answered(description, [0.0, 8.0])
    struck = [k for k, event in enumerate(one.answer.events) if event.impulses]
    assert len(struck) == 8
    for wrong in struck:
        events = tuple(
            replace(event, energy_loss=1e-3) if k == wrong else event for k, event in enumerate(one.answer.events)
        )
        assert replace(one, answer=replace(one.answer, events=events)).failure() is not None


def test_another_tangential_restitution_is_refused() -> None:
    def bouncing(share: float) -> dict[str, Any]:
        ball = {"mass": 1, "radius": 0.1, "inertia": 0.004, "at": [0, 0.5], "velocity": [1, 0], "angular_velocity": 0}
        floor = {"kind": "contact", "place": "ball", "on": {"at": [0, 0]}, "restitution": 0.75, "friction": 3}
        floor["tangential_restitution"] = share
        return {"gravity": [0, -10], "bodies": {"ball": ball}, "connections": [floor]}

    one, wrong = (answered(bouncing(share), [0.0, 0.3, 0.5]) for share in (0.5, 0.5001))
    assert one.failure() is None
    failure = Audited(one.scene, wrong.answer, wrong.sampler, one.times).failure()
    assert failure is not None
    assert failure.law == "tangential restitution"


def test_an_impact_by_which_something_begins_to_strike_is_no_single_one() -> None:
    """A level bar: its left end strikes, a contact of the right one begins and strikes, and the left end once more."""
    bar = {"mass": 1, "inertia": "1/3", "at": [0, "0.2"], "places": {"l": [-1, 0], "r": [1, 0]}}
    floor = {"at": [0, 0]}
    left = {"kind": "contact", "name": "left", "place": "bar.l", "on": floor}
    right = {"kind": "contact", "name": "right", "place": "bar.r", "on": floor, "from": {"event": {"name": "left"}}}
    scene = {"gravity": [0, -10], "bodies": {"bar": bar}, "connections": [left, right], "impacts": "stronge"}
    answer = solve_scene(scene_from(scene), [0.1, 0.3], ("trajectory",))
    assert [(event.kind, event.name) for event in answer.events] == [
        ("touch", "left"),
        ("begin", "right"),
        ("touch", "right"),
        ("touch", "left"),
    ]
    assert answer.trajectory is not None
    assert not answer.trajectory.columns["bar.velocity"].values[1].any()
