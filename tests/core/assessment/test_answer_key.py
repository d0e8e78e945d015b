"""Answer keys: through JSON, a key grades as the question does that it was made of."""

from __future__ import annotations

import json
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.assessment.answer_key import AnswerKey, figures_within, key_of
from core.assessment.carried import CarriedStep
from core.assessment.catalogue import MISTAKES
from core.assessment.comparisons import Data, DecDig, Interval, RelAbs, SigFig
from core.assessment.figures import DESCRIBED
from core.assessment.graded_question import GradedQuestion
from core.assessment.grader import Grader, credited
from core.assessment.results import reference_views, submission_view
from core.assessment.terms import Terms
from tests.core.assessment.test_variants import REQUEST, Pendulum

PERIOD = 2.0 * pi * sqrt(1.0 / 9.81)
STEPS = {"/period": CarriedStep("1/f", {"f": "/frequency"})}
COMPARISONS = {"/period": SigFig(digits=3), "/frequency": Interval(0.4, 0.6), "/difference": DecDig(digits=1)}


def graders(reveal: bool = True, comparison: Any = None, uncertainty: float | None = None) -> tuple[Grader, AnswerKey]:
    terms = Terms(comparison, COMPARISONS, reveal, language="fr", steps=STEPS)
    catalogue = credited(MISTAKES, {"sign": 0.125})
    key = key_of(GradedQuestion(Pendulum(), REQUEST, uncertainty), terms, catalogue, ["/lengths/0"], [])
    graded = GradedQuestion(Pendulum(), REQUEST, uncertainty)
    return Grader(graded, terms, catalogue), AnswerKey(json.loads(json.dumps(key)))


ASKED, KEY = graders()
HIDDEN, HIDDEN_KEY = graders(reveal=False, comparison=Data(factor=2.0), uncertainty=1e-3)


def same(submission: Any, grader: Grader, key: AnswerKey) -> Any:
    own = submission_view(0, grader.judged(submission), grader.terms)
    (found,) = key.results([submission])
    assert json.dumps(found) == json.dumps(own)
    return found


@pytest.mark.parametrize(
    ("claim", "score"),
    [
        ({"/period": {"value": PERIOD, "unit": "s"}}, 1.0),
        ({"/period": {"value": PERIOD / 60.0, "unit": "min"}}, 1.0),
        ({"/period": {"value": -PERIOD, "unit": "s"}}, 0.125),
        ({"/period": {"value": PERIOD}}, 0.0),
        ({"/period": {"value": PERIOD, "unit": "m"}}, 0.0),
        ({"/period": {"formula": "2*pi*sqrt(length/gravity)"}}, 1.0),
        ({"/period": {"formula": "2*pi*sqrt(gravity/length)"}}, 0.0),
        ({"/frequency": {"value": 0.5, "unit": "s"}}, 1.0),
        ({"/difference": {"value": 1.04, "unit": "s"}}, 1.0),
        ({"/lengths": {"value": [1.0, 2.001], "unit": "s"}}, 1.0),
        ({"/lengths/0": {"value": 1.0, "unit": "s"}, "/lengths/1": {"value": 3.0, "unit": "s"}}, 0.5),
        ({"/frequency": {"value": 0.8, "unit": "s"}, "/period": {"value": 1.25, "unit": "s"}}, 0.5),
        ({"/nothing": {"value": 1.0}}, None),
        ({"/force": {"value": 1.0}}, None),
        ({"/period": {"formula": "2*"}}, None),
        ([], None),
    ],
)
def test_a_key_grades_as_its_question_does(claim: Any, score: float | None) -> None:
    found = same(claim, ASKED, KEY)
    assert found["score"] == score
    hidden = same(claim, HIDDEN, HIDDEN_KEY)
    assert not any(test["matches"] or "error" in test for test in hidden["tests"])


@given(
    st.floats(-10.0, 10.0),
    st.sampled_from(["/period", "/frequency", "/difference", "/lengths/1", "/nothing", "period"]),
    st.sampled_from([None, "s", "ms", "m", "deg", "kitten"]),
)
def test_whatever_is_submitted(value: float, pointer: str, unit: str | None) -> None:
    claim = {pointer: {"value": value} | ({"unit": unit} if unit else {})}
    same(claim, ASKED, KEY)
    same(claim, HIDDEN, HIDDEN_KEY)


def test_a_key_names_the_figure_in_an_object() -> None:
    for pointer, remedy in (("/force", "/force/value"), ("/lengths", None), ("/nothing", None)):
        found = same({pointer: {"formula": "1"}}, ASKED, KEY)
        (fault,) = found["format_errors"]
        assert ("remedy" in fault) == (remedy is not None)
        assert fault.get("remedy", "").endswith(remedy or "")


def test_references_are_written_with_their_bounds() -> None:
    grader, uncertain = graders(uncertainty=1e-3)
    key = uncertain.grader()
    submission = {"/period": {"value": 2.0, "unit": "s"}}
    grader.judged(submission)
    key.judged(submission)
    (found,) = [one for one in reference_views(key) if one["pointer"] == "/period"]
    assert found in reference_views(grader)
    assert found["value"] == PERIOD
    # Half of the relative uncertainty of the length, and half of that of gravity.
    assert found["inherited"] == pytest.approx(1e-3 * PERIOD, rel=1e-2)


def test_samples_are_not_guessed_and_no_method_is_looked_for() -> None:
    assert KEY.rotation() is None
    assert KEY.evaluate(REQUEST)(("period",)) is None
    (result,) = KEY.results([{"/lengths": {"value": [1.0], "times": [0.0], "unit": "s"}}])
    assert result["format_errors"][0]["detail"].endswith("the answer key has samples at other times")


def test_every_comparison_is_read_back() -> None:
    for comparison in (RelAbs(0.1, 0.2), SigFig(4), DecDig(-1), Interval(0.0, 1.0), Data(3.0)):
        _, key = graders(comparison=comparison)
        assert key.grader().terms.comparison == comparison


def test_the_figures_of_an_answer_are_its_leaves_and_small_arrays() -> None:
    answer = {
        "signature": {"version": 1.0},
        "period": 1.0,
        "errors": {"period": 1e-16},
        "symmetry": "triaxial",
        "flip": None,
        "axes": np.eye(3),
        "samples": np.zeros((100, 3)),
        "equilibria": [{"stable": True, "eigenvalues": [[0.0, 1.0]]}],
    }
    found = [*figures_within(answer)]
    assert {("period",), ("symmetry",), ("flip",), ("axes",), ("axes", 2), ("axes", 2, 1)} <= set(found)
    assert {("equilibria", 0, "stable"), ("equilibria", 0, "eigenvalues")} <= set(found)
    assert not [path for path in found if path[0] in ("samples", "signature", "errors")]


class Described(Pendulum):
    """The same, as a described scene."""

    subject = DESCRIBED


@pytest.mark.parametrize(("names", "score"), [(None, None), ({"l": ("length",), "g": ("gravity",)}, 1.0)])
def test_of_a_described_scene_a_key_has_variations_of_named_numbers(names: Any, score: float | None) -> None:
    key = key_of(GradedQuestion(Described(), REQUEST, None), Terms(None, {}, True, names), MISTAKES, [], [])
    formula = "2*pi*sqrt(l/g)" if names else "2*pi*sqrt(length/gravity)"
    (found,) = AnswerKey(json.loads(json.dumps(key))).results([{"/period": {"formula": formula}}])
    assert found["score"] == score
    assert found["feedback"] == (
        "Correct." if score else "A formula cannot be graded here. Give the number with its unit."
    )
