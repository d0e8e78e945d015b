"""Submissions graded without the service: verdicts, scores, units, and claims that cannot be read."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import pytest

from core.assessment.carried import CarriedStep
from core.assessment.catalogue import MISTAKES
from core.assessment.comparisons import SigFig
from core.assessment.graded_question import GradedQuestion
from core.assessment.grader import Grader, credited
from core.assessment.judged_claims import JudgedClaim, explained, text
from core.assessment.terms import Terms
from tests.core.assessment.pendulum import REQUEST, Pendulum
from tests.core.assessment.test_graded_question import PERIOD

STEPS = {"/period": CarriedStep("2*pi/w", {"w": "/rate"}, credit=0.75)}


def grader(*, reveal: bool = True, **credits: float) -> Grader:
    graded = GradedQuestion(Pendulum(), REQUEST, None)
    terms = Terms(None, {"/rate": SigFig(4)}, reveal, {"l": ("length",)}, steps=STEPS)
    return Grader(graded, terms, credited(MISTAKES, credits))


def judged(claim: Any, pointer: str = "/period", **more: Any) -> JudgedClaim:
    found = grader(**more).judged({pointer: claim})
    assert not found.faults
    (one,) = found.claims
    return one


@pytest.mark.parametrize(
    ("claim", "verdict", "score", "tags"),
    [
        ({"value": PERIOD, "unit": "s"}, "correct", 1.0, []),
        ({"value": 1e3 * PERIOD, "unit": "ms"}, "correct", 1.0, []),
        ({"value": 2.0 * PERIOD, "unit": "s"}, "incorrect", 0.0, ["factor-2"]),
        ({"value": -PERIOD, "unit": "s"}, "incorrect", 0.5, ["sign"]),
        ({"value": 7.0 * PERIOD, "unit": "s"}, "incorrect", 0.0, []),
        ({"value": PERIOD}, "missing-unit", 0.0, []),
        ({"value": PERIOD, "unit": "kg"}, "wrong-unit", 0.0, []),
        ({"formula": "2*pi*sqrt(l/9.81)"}, "correct", 1.0, []),
        ({"formula": "2*pi*sqrt(l*9.81)"}, "incorrect", 0.0, []),
        ({"value": None}, "incorrect", 0.0, []),
    ],
)
def test_verdicts(claim: Any, verdict: str, score: float, tags: list[str]) -> None:
    one = judged(claim)
    assert (one.judgement.verdict, one.score) == (verdict, score)
    assert [mistake.tag for mistake in one.mistakes] == tags


def test_credits_of_the_course_and_comparisons_of_single_figures() -> None:
    assert judged({"value": -PERIOD, "unit": "s"}, sign=0.75).score == 0.75
    assert judged({"value": 4.4294, "unit": "rad/s"}, "/rate").judgement.verdict == "correct"
    assert judged({"value": 4.44, "unit": "rad/s"}, "/rate").judgement.verdict == "incorrect"


def test_without_reveal_no_mistake_is_named() -> None:
    one = judged({"value": -PERIOD, "unit": "s"}, reveal=False)
    assert one.mistakes == ()
    assert one.score == 0.0
    assert text(one.sentences, "en") == "Not correct."


@pytest.mark.parametrize(
    ("submission", "path"),
    [
        (3, ()),
        ({}, ()),
        ({"period": {"value": 1.0}}, ("period",)),
        ({"/nothing": {"value": 1.0}}, ("/nothing",)),
        ({"/period": {"value": "long", "unit": "s"}}, ("/period", "value")),
        ({"/kind": {"formula": "l"}}, ("/kind", "formula")),
        ({"/period": {"formula": "m"}}, ("/period", "formula")),
        ({"/angle": {"value": [1.0], "times": [-1.0]}}, ("/angle", "times")),
        ({"/period": {"value": [1.0], "times": [1.0]}}, ("/period", "times")),
        ({"/" + "x" * 300: {"value": 1.0}}, ()),
    ],
    ids=lambda entry: str(entry)[:30],
)
def test_what_cannot_be_read_has_a_place_and_spoils_nothing(submission: Any, path: tuple[str | int, ...]) -> None:
    found = grader().judged(submission)
    assert found.claims == []
    assert [fault.path for fault in found.faults] == [path]


def test_when_a_motion_can_be_answered_is_not_said_without_reveal() -> None:
    claim = {"/angle": {"value": [1.0], "times": [-1.0]}}
    assert "after the start" in grader().judged(claim).faults[0].rule
    assert "after the start" not in grader(reveal=False).judged(claim).faults[0].rule


@pytest.mark.parametrize(
    ("pointer", "remedy"),
    [
        ("/force", "an object stands there; name its figure: /force/value"),
        ("/mass", "an object stands there; name its figure: /mass/own or /mass/parts or /mass/total"),
        ("/nothing", None),
        ("/frce/value", None),
        ("/force/valu", 'did you mean "/force/value"?'),
        ("/nothing/deeper", None),
        ("/force/parts/5", None),
    ],
)
def test_a_pointer_that_stops_at_an_object_is_answered_with_the_figures_in_it(pointer: str, remedy: str | None) -> None:
    found = grader().judged({pointer: {"value": 1.0, "unit": "N"}})
    assert [fault.remedy for fault in found.faults] == [remedy]
    # The staff has to mend it: to who answered it is no fault of the entry.
    assert found.feedback("en").startswith("This cannot be graded")


def test_mistakes_that_give_the_same_value_are_numbered() -> None:
    catalogue = {one.tag: one for one in MISTAKES}
    two, half = catalogue["factor-2"], catalogue["factor-half"]
    assert explained(()) == ()
    assert text(explained((two,)), "en") == "Too large by a factor of 2."
    assert text(explained((two, half)), "de") == (
        "Jeder der folgenden Fehler führt auf diesen Wert. (1) Um den Faktor 2 zu groß. (2) Um den Faktor 2 zu klein."
    )


def test_a_name_that_does_not_exist_is_named() -> None:
    found = grader().judged({"/period": {"formula": "2*pi*sqrt(l_0/9.81)"}})
    assert found.feedback("en") == (
        'The problem has no quantity called "l_0": numbering starts at 1. Its names are: l.'
    )
    assert "„m“" in grader().judged({"/period": {"formula": "m"}}).feedback("de")


@pytest.mark.parametrize(
    ("rate", "period", "verdict", "score"),
    [
        (4.0, 2.0 * pi / 4.0, "carried", 0.5 * 0.75),
        (4.0, 2.0 * pi / 4.2, "incorrect", 0.0),
        (sqrt(9.81 / 0.5), 2.0 * pi / 4.0, "incorrect", 0.5),
        (4.0, PERIOD, "correct", 0.5),
    ],
)
def test_a_later_answer_is_judged_from_the_earlier_one(rate: float, period: float, verdict: str, score: float) -> None:
    found = grader().judged({"/period": {"value": period, "unit": "s"}, "/rate": {"value": rate, "unit": "rad/s"}})
    own = found.claims[0]
    assert own.judgement.verdict == verdict
    assert sum(one.score or 0.0 for one in found.claims) / 2.0 == pytest.approx(score)
    assert (text(own.sentences, "en") == "Not the expected value, but consistent with your earlier result.") == (
        verdict == "carried"
    )


def test_a_step_carries_no_error_of_an_answer_that_has_no_unit_or_is_not_there() -> None:
    period = {"/period": {"value": 2.0 * pi / 4.0, "unit": "s"}}
    for other in ({}, {"/rate": {"value": 4.0, "unit": "kg"}}):
        assert grader().judged(period | other).claims[0].judgement.verdict == "incorrect"
