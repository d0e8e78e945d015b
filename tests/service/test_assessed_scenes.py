"""Assessments of described scenes: what a student finds about any worked scene can be graded."""

from __future__ import annotations

import json
from math import atan, cos, degrees, radians, sin, sqrt
from pathlib import Path
from typing import Any

import pytest

from service.responses.json_rows import written
from tests.drawn import sampled
from tests.service.test_assessments import HANDLER, ROUTES, handled

SCENES = {file.stem: file for file in (Path(__file__).parents[2] / "examples" / "scenes").glob("*.json")}
UNIT = "m/s^2"


def question_of(name: str) -> Any:
    """Return the question about the start of a worked scene."""
    request = json.loads(SCENES[name].read_text(encoding="utf-8"))
    kept = {key: request[key] for key in ("gravity", "bodies", "connections", "let") if key in request}
    return {"path": "/v1/scenes", "request": kept | {"outputs": ["accelerations", "forces"]}}


def answer_to(question: Any) -> Any:
    route = ROUTES[question["path"]]
    return json.loads(written(HANDLER.answer(route, HANDLER.read(route, json.dumps(question["request"]).encode()))))


@pytest.mark.parametrize("name", sampled(sorted(SCENES), __name__))
def test_figures_at_the_start_are_gradable(name: str) -> None:
    question = question_of(name)
    answer = answer_to(question)
    claims: dict[str, Any] = {
        f"/forces/{force}/value": {"value": found["value"], "unit": found["unit"]}
        for force, found in answer["forces"].items()
        if found["determined"]
    }
    for body, found in answer["accelerations"].items():
        for k, value in enumerate(found["linear"] or ()):
            claims[f"/accelerations/{body}/linear/{k}"] = {"value": value, "unit": UNIT}
    chosen = dict(list(claims.items())[-6:])
    (result,) = handled(question, chosen)["results"]
    assert [test["verdict"] for test in result["tests"]] == ["correct"] * len(chosen)


def test_numbers_that_belong_together_change_together() -> None:
    """The slope of a wedge, and the direction of the block on it, are one angle: A = m g sin cos / (M + m sin^2)."""
    share, m, mass, slope = 1e-3, 1.0, 3.0, radians(30)
    question = question_of("movable-wedge")
    claim = {"/accelerations/wedge/linear/0": {"value": 1, "unit": UNIT}}
    answer = handled(question, claim, input_uncertainty=share)
    (reference,) = answer["reference"]
    s, c = sin(slope), cos(slope)
    size = m * 9.81 * s * c / (mass + m * s * s)
    assert abs(reference["value"]) == pytest.approx(size, rel=1e-14)
    by_masses = 2 * mass / (mass + m * s * s)
    by_angle = slope * (c / s - s / c - 2 * m * s * c / (mass + m * s * s))
    assert reference["inherited"] == pytest.approx(size * share * (1 + by_masses + abs(by_angle)), rel=1e-4)


def test_a_number_that_is_equal_by_chance_keeps_its_own_effect() -> None:
    """With a block of 30 kg, too, on a slope of 30 degrees, its mass changes alone."""
    question = question_of("movable-wedge")
    question["request"]["bodies"]["block"]["mass"] = 30
    claim = {"/accelerations/wedge/linear/0": {"value": 1, "unit": UNIT}}
    share, m, mass, slope = 1e-3, 30.0, 3.0, radians(30)
    (reference,) = handled(question, claim, input_uncertainty=share)["reference"]
    s, c = sin(slope), cos(slope)
    by_masses = 2 * mass / (mass + m * s * s)
    by_angle = abs(slope * (c / s - s / c - 2 * m * s * c / (mass + m * s * s)))
    size = m * 9.81 * s * c / (mass + m * s * s)
    assert reference["inherited"] == pytest.approx(size * share * (1 + by_masses + by_angle), rel=1e-4)


SWINGING = {
    "gravity": [0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8]}},
    "connections": [{"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]}],
}
OSCILLATOR = {
    "gravity": [0, -9.81],
    "bodies": {"block": {"mass": 1, "at": [0.9, 0]}},
    "connections": [
        {"kind": "track", "place": "block", "on": {"at": [0, 0]}},
        {"kind": "spring", "a": [-1, 0], "b": "block", "stiffness": 1, "rest_length": 1},
    ],
    "times": [1],
}


@pytest.mark.parametrize("outputs", [None, ["forces"], ["forces", "trajectory"], ["trajectory", "forces-in-time"]])
def test_forces_in_time_are_graded_at_times_of_the_claim(outputs: list[str] | None) -> None:
    times = [0.25, 0.5, 1.0]
    asked = SWINGING | {"times": times, "outputs": ["forces-in-time"]}
    column = answer_to({"path": "/v1/scenes", "request": asked})["trajectory"]["columns"]["rod.force"]
    request = SWINGING | ({} if outputs is None else {"outputs": outputs})
    if outputs is not None and outputs != ["forces"]:
        request |= {"times": [0.1]}
    claim = {"value": column["values"], "unit": "N", "times": times}
    wrong = claim | {"value": [2 * x for x in column["values"]]}
    right, other = handled({"path": "/v1/scenes", "request": request}, *({FORCE: one} for one in (claim, wrong)))[
        "results"
    ]
    assert right["tests"][0]["verdict"] == "correct"
    assert other["tests"][0]["verdict"] == "incorrect"


FORCE = "/trajectory/columns/rod.force/values"


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        ({"formula": "2*pi", "unit": "s"}, "correct"),
        ({"formula": "2000*pi", "unit": "ms"}, "correct"),
        ({"text": "2*pi s"}, "correct"),
        ({"formula": "pi/30", "unit": "min"}, "correct"),
        ({"formula": "2*pi*sqrt(m/k)", "unit": "s"}, "correct"),
        ({"formula": "2000*pi*sqrt(m/k)", "unit": "ms"}, "correct"),
        ({"formula": "2*pi*sqrt(m/k)"}, "correct"),
        ({"formula": "2*pi*sqrt(m/k)", "unit": "ms"}, "incorrect"),
        ({"formula": "2*pi*sqrt(m/k)", "unit": "m"}, "wrong-unit"),
        ({"formula": "pi", "unit": "s"}, "incorrect"),
        ({"formula": "2*pi", "unit": "kg"}, "wrong-unit"),
        ({"formula": "2*pi"}, "missing-unit"),
    ],
)
def test_a_unit_beside_a_formula_counts(claim: dict[str, str], verdict: str) -> None:
    """A constant with its unit is a number; a formula with names has the value in the unit beside it."""
    names = {"m": "/bodies/block/mass", "k": "/connections/1/stiffness"}
    question = {"path": "/v1/scenes", "request": OSCILLATOR}
    (result,) = handled(question, {"/period": claim}, names=names)["results"]
    assert [test["verdict"] for test in result["tests"]] == [verdict]


def test_a_reference_has_the_error_that_stands_beside_it() -> None:
    question = {"path": "/v1/scenes", "request": OSCILLATOR}
    answer = handled(question, {"/period": {"value": 6.283, "unit": "s"}})
    assert answer["reference"][0]["error"] == answer_to(question)["errors"]["period"]


def test_equations_that_the_question_asks_for_are_shown_with_the_reference() -> None:
    """As part of the feedback: not where the reference is hidden, nor where nobody asked."""
    question = question_of("simple-pendulum")
    claim = {"/accelerations/bob/linear/0": {"value": 1, "unit": UNIT}}
    assert "equations" not in handled(question, claim)
    question["request"]["outputs"].append("equations")
    shown = handled(question, claim)["equations"]["equations"]
    assert [one["plain"] for one in shown] == ["bob.theta'' = -9.81*sin(bob.theta)"]
    assert "equations" not in handled(question, claim, reveal=False)


SLIDING: Any = {
    "gravity": [0, -9.81],
    "let": {"a": {"degrees": 10}},
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {"kind": "contact", "place": "block", "on": {"at": [0, 0], "slope": "a"}, "friction": 0.7},
    ],
    "outputs": [{"thresholds": {"vary": "/let/a/degrees", "between": [0, 60]}}],
}
SEARCHED: Any = {
    "gravity": [0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": [0, -1], "velocity": [1, 0]}},
    "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    "times": [0, 1, 2],
    "outputs": [{"extremes": "bob.position.x"}, {"when": {"quantity": "bob.position.x", "equals": 0.1, "nth": 1}}],
}


def verdict_of(question: Any, pointer: str, value: float, unit: str) -> str:
    (result,) = handled(question, {pointer: {"value": value, "unit": unit}})["results"]
    verdict: str = result["tests"][0]["verdict"]
    return verdict


def test_a_threshold_is_claimed_in_the_unit_that_it_states() -> None:
    """A block begins to slide at the slope whose tangent is the coefficient of friction."""
    question = {"path": "/v1/scenes", "request": SLIDING}
    assert answer_to(question)["thresholds"][0]["unit"] == "deg"
    upper = "/thresholds/0/upper/value"
    assert verdict_of(question, upper, atan(0.7), "rad") == "correct"
    assert verdict_of(question, upper, degrees(atan(0.7)), "deg") == "correct"
    assert verdict_of(question, upper, atan(0.7), "m") == "wrong-unit"


def test_times_of_searches_are_claimed_in_seconds() -> None:
    question = {"path": "/v1/scenes", "request": SEARCHED}
    answer = answer_to(question)
    for pointer, value in (
        ("/extremes/0/largest_time", answer["extremes"][0]["largest_time"]),
        ("/occurrences/0/time", answer["occurrences"][0]["time"]),
    ):
        assert verdict_of(question, pointer, value, "s") == "correct"
        assert verdict_of(question, pointer, value, "m") == "wrong-unit"


def test_a_found_input_is_claimed_in_the_unit_in_which_it_is_written() -> None:
    """A pendulum that starts at its lowest place with v turns back at the height v^2 / (2 g)."""
    request = SEARCHED | {"outputs": [{"extremes": "bob.position.x"}]}
    backwards = {
        "question": {"path": "/v1/scenes", "request": request},
        "vary": {"pointer": "/bodies/bob/velocity/0", "between": [0.5, 1.5]},
        "until": {"figure": "/extremes/0/largest", "equals": 0.25},
    }
    question = {"path": "/v1/find", "request": backwards}
    answer = answer_to(question)
    assert (answer["units"], answer["figure_units"]) == ({"/bodies/bob/velocity/0": "m/s"}, ["m"])
    speed = sqrt(2 * 9.81 * (1 - sqrt(1 - 0.25**2)))
    pointer = "/solutions/0/values/~1bodies~1bob~1velocity~10"
    assert verdict_of(question, pointer, 3.6 * speed, "km/h") == "correct"
    assert verdict_of(question, pointer, speed, "m") == "wrong-unit"
    assert verdict_of(question, "/solutions/0/figure", 25, "cm") == "correct"


@pytest.mark.parametrize(
    ("locale", "text", "verdict"),
    [
        ("de", "stabil", "correct"),
        ("de", "labil", "incorrect"),
        ("en", "Stable", "correct"),
        ("en", "unstable", "incorrect"),
        ("fr", "instable", "incorrect"),
        ("es", "estable", "correct"),
        ("es", "inestable", "incorrect"),
    ],
)
def test_an_equilibrium_is_stable_in_every_language(locale: str, text: str, verdict: str) -> None:
    """A pendulum hangs in the first of its equilibria."""
    request = {key: SEARCHED[key] for key in ("gravity", "bodies", "connections")} | {"outputs": ["equilibria"]}
    hanging = {"path": "/v1/scenes", "request": request}
    places = [one["positions"]["bob"][1] for one in answer_to(hanging)["equilibria"]]
    claim = {f"/equilibria/{places.index(min(places))}/stable": {"text": text}}
    (result,) = handled(hanging, claim, locale=locale)["results"]
    assert result["tests"][0]["verdict"] == verdict


def test_words_for_a_number_are_answered_without_names_of_the_problem() -> None:
    question = {"path": "/v1/scenes", "request": SEARCHED}
    (result,) = handled(question, {"/extremes/0/largest": {"text": "keine Ahnung"}}, locale="de")["results"]
    (fault,) = result["format_errors"]
    assert "remedy" not in fault
    assert "bob" not in result["feedback"]
