"""Every mistake is recognised in random questions, no right answer is called one, and confusions are counted."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from random import Random
from typing import Any

import numpy as np
import pytest

from core.assessment.catalogue import MISTAKES
from core.assessment.figures import steps_of
from core.assessment.mistakes import Figure, WrongValues
from core.systems.budget import Budget
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from service.routes.assessments.route_source import graded_question

ROUTES = {route.path: route for route in questions()}
HANDLER = RequestHandler(ROUTES.values(), Budget(), Limits())
Question = dict[str, Any]

COMPARISON = {"kind": "relabs", "rtol": 1e-6}
EACH = 12
"""Random questions for each figure."""


def triaxial(chance: Random) -> Question:
    a, b = sorted(chance.uniform(1.0, 3.0) for _ in range(2))
    moments = [a, b, chance.uniform(b, a + b)]
    return {"kind": "principal-moments", "moments": chance.sample(moments, 3)}


def symmetric(chance: Random) -> Question:
    transverse = chance.uniform(1.0, 3.0)
    axial = transverse * chance.choice([chance.uniform(0.2, 0.9), chance.uniform(1.1, 1.9)])
    return {"kind": "principal-moments", "moments": [transverse, transverse, axial]}


def spin(chance: Random) -> list[float]:
    return [chance.choice([-1.0, 1.0]) * chance.uniform(0.5, 3.0) for _ in range(3)]


def points(chance: Random) -> Question:
    found = [[chance.uniform(-1.0, 2.0) for _ in range(3)] for _ in range(6)]
    return {"kind": "point-masses", "masses": chance.uniform(0.5, 2.0), "positions": [*found, found[0], found[1]]}


def tensor(chance: Random) -> Question:
    a, b, c = (chance.uniform(3.0, 4.0) for _ in range(3))
    x, y, z = (chance.uniform(0.2, 0.9) for _ in range(3))
    return {"kind": "inertia-tensor", "tensor": [[a, x, y], [x, b, z], [y, z, c]]}


def solid(chance: Random) -> Question:
    shape = chance.choice([{"kind": "ball"}, {"kind": "cylinder", "height": chance.uniform(0.5, 2.0)}])
    return {**shape, "radius": chance.uniform(0.5, 2.0), "mass": chance.uniform(1.0, 5.0)}


def shafts(chance: Random) -> Question:
    pair = lambda low, high: [chance.uniform(low, high), chance.uniform(low, high)]  # noqa: E731
    return {"masses": pair(1, 4), "radii": pair(0.1, 0.3), "slopes": pair(0.2, 1.4), "gravity": chance.uniform(5, 15)}


def rod(chance: Random) -> Question:
    radius = chance.uniform(0.5, 2.0)
    return {"hole_radius": radius, "length": chance.uniform(0.2, 1.6) * radius, "mass": 1.0, "gravity": 9.81}


def pulley(chance: Random) -> Question:
    """Two masses on a string over a disc, of which the moment of inertia is written as a formula."""
    radius = chance.uniform(0.1, 0.5)
    disc = {"mass": chance.uniform(1.0, 4.0), "radius": radius, "at": [0.0, 0.0]}
    return {
        "gravity": [0.0, -9.81],
        "let": {"I": f"{disc['mass']}*{radius}^2/2"},
        "bodies": {
            "a": {"mass": chance.uniform(1.0, 4.0), "at": [-radius, -1.0]},
            "b": {"mass": chance.uniform(1.0, 4.0), "at": [radius, -1.0]},
            "disc": disc | {"inertia": "I"},
        },
        "connections": [
            {"kind": "pin", "a": "disc", "b": [0.0, 0.0]},
            {"kind": "string", "name": "cord", "through": ["a", "disc", "b"], "sides": {"disc": ["left", "right"]}},
        ],
        "outputs": ["accelerations", "forces"],
    }


def motion(chance: Random) -> Question:
    return {"body": triaxial(chance), "angular_velocity": spin(chance), "times": [0.0, 0.5, 1.0]}


FIGURES: list[tuple[str, str, Callable[[Random], Question]]] = [
    *(
        (
            "/v1/rotation/precession",
            pointer,
            lambda chance: {"body": symmetric(chance), "angular_velocity": spin(chance)},
        )
        for pointer in ("/body_rate", "/space_rate", "/period", "/axis_to_angular_momentum", "/axis")
    ),
    *(
        (
            "/v1/rotation/precession",
            pointer,
            lambda chance: {"body": triaxial(chance), "angular_velocity": spin(chance)},
        )
        for pointer in ("/flip_interval", "/period", "/mean_precession_rate")
    ),
    ("/v1/rotation/precession", "/period", lambda chance: {"body": points(chance), "angular_velocity": spin(chance)}),
    ("/v1/rotation/precession", "/period", lambda chance: {"body": tensor(chance), "angular_velocity": spin(chance)}),
    *(
        ("/v1/rotation/wobble", pointer, lambda chance: {"period": chance.uniform(50.0, 900.0)})
        for pointer in ("/ellipticity", "/asymmetry", "/flattening")
    ),
    *(
        ("/v1/rotation/stability", pointer, lambda chance: {"body": triaxial(chance), "rate": chance.uniform(1.0, 3.0)})
        for pointer in ("/equilibria/0/stable", "/equilibria/1/stable", "/equilibria/1/eigenvalues")
    ),
    *(
        ("/v1/bodies/mass-properties", pointer, lambda chance: {"body": points(chance)})
        for pointer in (
            "/principal/moments",
            "/principal/axes",
            "/inertia/about_origin",
            "/inertia/about_center_of_mass",
        )
    ),
    ("/v1/bodies/mass-properties", "/principal/moments", lambda chance: {"body": solid(chance)}),
    *(
        ("/v1/scenes/unwinding-shafts", pointer, shafts)
        for pointer in ("/tension", "/accelerations", "/accelerations/0", "/string_acceleration")
    ),
    ("/v1/scenes/rod-in-hole", "/angular_velocity_at_horizontal", rod),
    *(
        ("/v1/scenes", pointer, pulley)
        for pointer in ("/forces/cord.1.tension/value", "/accelerations/a/linear/1", "/accelerations/disc/angular")
    ),
    ("/v1/rotation/trajectory", "/angular_velocity", motion),
    ("/v1/rotation/trajectory", "/angular_velocity", lambda chance: motion(chance) | {"body": symmetric(chance)}),
    ("/v1/rotation/trajectory", "/attitude", lambda chance: motion(chance) | {"attitude": [1.0, 0.2, 0.3, 0.4]}),
    (
        "/v1/rotation/trajectory",
        "/attitude/1",
        lambda chance: motion(chance) | {"attitude": [chance.random() + 0.1 for _ in range(4)]},
    ),
    (
        "/v1/rotation/trajectory",
        "/angular_velocity",
        lambda chance: motion(chance) | {"method": {"kind": "explicit-euler", "step": 0.25}},
    ),
]
NAMES = [f"{path} {pointer} {i}" for i, (path, pointer, _) in enumerate(FIGURES)]


@cache
def drawn(index: int) -> tuple[tuple[Question, WrongValues], ...]:
    """Return random questions about a figure, with what every mistake makes of it."""
    path, pointer, draw = FIGURES[index]
    chance, found = Random(NAMES[index]), []
    read = lambda body: HANDLER.read(ROUTES[path], body)  # noqa: E731
    for _ in range(EACH):
        request = draw(chance)
        graded = graded_question(ROUTES[path], read, request, Budget(), None)
        reference = graded.reference(steps_of(pointer))
        assert reference is not None
        figure = Figure(path.removeprefix("/v1/"), request, steps_of(pointer), reference, graded.evaluate)
        found.append((request, WrongValues(figure, MISTAKES)))
    return tuple(found)


def graded(index: int, request: Question, values: list[Any], unit: str) -> Iterator[dict[str, Any]]:
    path, pointer, _ = FIGURES[index]
    claims = [{"value": value.tolist() if isinstance(value, np.ndarray) else value} for value in values]
    with_units = [claim | ({"unit": unit} if unit != "1" else {}) for claim in claims]
    body = {
        "question": {"path": path, "request": request},
        "submissions": [{pointer: claim} for claim in with_units],
        "comparison": COMPARISON,
    }
    route = ROUTES["/v1/assessments"]
    answer = HANDLER.answer(route, HANDLER.read(route, json.dumps(body).encode()))
    for result in json.loads(written(answer))["results"]:
        assert result["format_errors"] == []
        yield result["tests"][0]


@pytest.mark.parametrize("index", range(len(FIGURES)), ids=NAMES)
def test_every_mistake_is_recognised_and_no_right_answer_is_called_one(index: int) -> None:
    for request, found in drawn(index):
        reference = found.figure.reference
        entries = found.entries
        tests = list(graded(index, request, [reference.value, *(wrong.value for _, wrong in entries)], reference.unit))
        assert tests[0]["verdict"] == "correct"
        assert tests[0]["matches"] == []
        for (mistake, wrong), test in zip(entries, tests[1:], strict=True):
            tags = {match["tag"] for match in test["matches"]}
            if test["verdict"] == "correct":
                # Nothing is wrong with what the mistake does not change.
                assert tags == set()
            else:
                assert mistake.tag in tags, (mistake.tag, wrong.value, reference.value)


def test_a_disc_without_inertia_is_a_massless_pulley() -> None:
    """Atwood's machine with a massless pulley has one tension on both sides, 2 m_a m_b g/(m_a + m_b)."""
    index = next(i for i, (_, pointer, _) in enumerate(FIGURES) if pointer == "/forces/cord.1.tension/value")
    for request, found in drawn(index):
        a, b = (request["bodies"][name]["mass"] for name in "ab")
        (wrong,) = [other.value for mistake, other in found.entries if mistake.tag == "inertia-left-out"]
        assert wrong == pytest.approx(2.0 * a * b * 9.81 / (a + b), rel=1e-12)


def test_every_entry_of_the_catalogue_is_met() -> None:
    met = {mistake.tag for i in range(len(FIGURES)) for _, found in drawn(i) for mistake, _ in found.entries}
    assert met == {mistake.tag for mistake in MISTAKES}


def test_tags_are_distinct_and_credits_are_shares() -> None:
    tags = [mistake.tag for mistake in MISTAKES]
    assert len(set(tags)) == len(tags)
    for mistake in MISTAKES:
        assert 0.0 <= mistake.credit < 1.0


def confusions() -> tuple[Counter[tuple[str, str]], int]:
    """Return how often two mistakes have the same value, by their tags, and the number of wrong values."""
    pairs: Counter[tuple[str, str]] = Counter()
    count = 0
    for index in range(len(FIGURES)):
        for request, found in drawn(index):
            reference = found.figure.reference
            values = [wrong.value for _, wrong in found.entries]
            for test in graded(index, request, values, reference.unit):
                tags = sorted(match["tag"] for match in test["matches"])
                count += test["verdict"] == "incorrect"
                pairs.update((one, other) for i, one in enumerate(tags) for other in tags[i + 1 :])
    return pairs, count


def test_confusions_are_those_that_are_one_mistake_in_other_words() -> None:
    pairs, count = confusions()
    assert count > 1000
    assert set(pairs) <= CONFUSED, set(pairs) - CONFUSED


CONFUSED = {
    # The flip interval is half of the period, and the axis ratio that the root of the moments gives nearly the root.
    ("factor-2", "period-for-flip-interval"),
    ("factor-half", "period-for-flip-interval"),
    ("ellipticity-root-of-moments", "root"),
}
"""Pairs of mistakes that may have the same value; both are then named."""
