"""An exam of 85 answers as students type them, in four locales, with the verdict of each decided by hand.

The references are closed forms: the coin of moments 1, 1, 2 and angular velocity (1, 1, 1) has the body rate
(2 - 1)/1 x 1 = 1 rad/s, the period 2 pi s and the angle atan(sqrt(2)/2) = 35.264 degrees to its angular momentum; a
cuboid of 6 kg with edges 1, 2, 3 m has the moments 2.5, 5, 6.5 kg m^2; Atwood's machine with 1 kg and 3 kg has the
acceleration g/2 and the tension 2 m M g/(m + M) = 14.715 N; a rod of 1 m in a hole of 1 m radius passes the horizontal
with sqrt(2 g k (1 - 1/2)/(1 - 1/6)), k = sqrt(3)/2, which is 3.1929 rad/s.
"""

from __future__ import annotations

from typing import Any, get_args

import pytest

from core.assessment.typed_number import Locale
from core.errors import InvalidParameter, pointer_of
from tests.service.test_assessments import COIN, ROD, handled

CUBOID = {
    "path": "/v1/bodies/mass-properties",
    "request": {"body": {"kind": "cuboid", "edges": [1, 2, 3], "mass": 6}},
}
ATWOOD = {
    "path": "/v1/scenes",
    "request": {
        "gravity": [0, -9.81],
        "bodies": {"light": {"mass": 1, "at": [-0.1, -0.5]}, "heavy": {"mass": 3, "at": [0.1, -0.5]}},
        "connections": [{"kind": "string", "name": "cord", "through": ["light", [-0.1, 0], [0.1, 0], "heavy"]}],
    },
}
NAMES = {"m": "/bodies/light/mass", "M": "/bodies/heavy/mass", "minus_g": "/gravity/1"}
TENSION, IN_TIME = "/forces/cord.tension/value", "/trajectory/columns/cord.tension/values"
HORIZONTAL, MOMENTS, CONE = "/angular_velocity_at_horizontal", "/principal/moments", "/axis_to_angular_momentum"

RIGHT, WRONG, NO_UNIT, OTHER_UNIT, UNREADABLE = "correct", "incorrect", "missing-unit", "wrong-unit", "unreadable"

EXAM: list[tuple[Locale, Any, str, Any, str]] = [
    # Germany
    ("de", COIN, "/period", "6,28 s", RIGHT),
    # A point before three digits is a decimal mark to some and groups thousands to others.
    ("de", COIN, "/period", "6.280 ms", UNREADABLE),
    ("de", COIN, "/period", "6,28\u202fs", RIGHT),
    ("de", COIN, "/period", "2π s", RIGHT),
    ("de", COIN, "/period", "2·π s", RIGHT),
    ("de", COIN, "/period", "3,14 s", WRONG),
    ("de", COIN, "/period", "6,28", NO_UNIT),
    ("de", COIN, "/period", "2π", NO_UNIT),
    ("de", COIN, "/period", "6,28 m", OTHER_UNIT),
    ("de", COIN, "/period", "6,2,8 s", UNREADABLE),
    ("de", COIN, CONE, "35,26°", RIGHT),
    ("de", COIN, CONE, "0,6155", RIGHT),
    ("de", COIN, CONE, "54,7°", WRONG),
    ("de", ATWOOD, TENSION, "1,47·10¹ N", RIGHT),
    ("de", ATWOOD, TENSION, "-2*minus_g*m*M/(m + M)", RIGHT),
    ("de", ATWOOD, TENSION, "-minus_g*m*M/(m + M)", WRONG),
    ("de", ATWOOD, TENSION, "2*g*m*M/(m + M)", UNREADABLE),
    ("de", COIN, "/period", "T = 6,28 Sekunden", RIGHT),
    ("de", COIN, CONE, "35,26 Grad", RIGHT),
    ("de", COIN, CONE, "35° 16′", RIGHT),
    ("de", COIN, "/body_rate", "57,3 Grad/s", RIGHT),
    ("de", COIN, "/body_rate", "9,549 U/min", RIGHT),
    ("de", COIN, "/tumbles", "nein", RIGHT),
    ("de", CUBOID, MOMENTS, "(2,5; 5; 6,5) kgm²", RIGHT),
    ("de", ATWOOD, IN_TIME, {"text": "[14,7; 14,7; 14,7] N", "times": [0.0, 0.1, 0.2]}, RIGHT),
    ("de", COIN, "/period", "6,28 + - 0,01 s", UNREADABLE),
    ("de", COIN, "/period", "1,745·10-3 h", UNREADABLE),
    ("de", COIN, "/body_rate", "60/min", RIGHT),
    ("de", COIN, "/body_rate", "1,0/s", RIGHT),
    ("de", ATWOOD, TENSION, "1,5·g", UNREADABLE),
    ("de", COIN, "/period", "rund 6,28 s", RIGHT),
    ("de", CUBOID, MOMENTS, "2,5 kgm²; 5 kgm²; 6,5 kgm²", RIGHT),
    # Britain and the United States
    ("en", COIN, "/period", "6.28 s", RIGHT),
    ("en", COIN, "/period", "6,283 ms", RIGHT),
    ("en", COIN, "/period", "6.283e0 s", RIGHT),
    ("en", COIN, "/period", "628x10^-2 s", RIGHT),
    ("en", COIN, "/period", "−6.28 s", WRONG),
    ("en", COIN, "/body_rate", "1 rad/s", RIGHT),
    ("en", COIN, "/body_rate", "9.549 rpm", RIGHT),
    ("en", COIN, "/body_rate", "1 Hz", WRONG),
    ("en", ROD, HORIZONTAL, "3.19 rad/s", RIGHT),
    ("en", ROD, HORIZONTAL, "182.9 deg/s", RIGHT),
    ("en", ROD, HORIZONTAL, "2.80 rad/s", WRONG),
    ("en", ROD, HORIZONTAL, "sqrt(2*gravity*sqrt(3)/2*(1 - 1/2)/(1 - 1/6)) rad/s", WRONG),
    ("en", CUBOID, MOMENTS, "[2.5, 5, 6.5] kg m^2", RIGHT),
    ("en", CUBOID, MOMENTS, "[2.5, 5, 6.0] kg m^2", WRONG),
    ("en", CUBOID, MOMENTS, "(2.5, 5, 6.5) kg m2", RIGHT),
    ("en", COIN, CONE, "atan(1/√2)", RIGHT),
    ("en", COIN, "/period", "6.28 ± 0.01 s", UNREADABLE),
    ("en", ATWOOD, TENSION, "-2 m M minus_g/(m + M)", UNREADABLE),
    ("en", COIN, "/period", "6.28*s", RIGHT),
    ("en", COIN, "/body_rate", "1/2π Hz", UNREADABLE),
    ("en", COIN, "/body_rate", "1/(2π) Hz", RIGHT),
    ("en", COIN, "/period", "6 s 280 ms", UNREADABLE),
    ("en", COIN, CONE, "tan^-1(1/sqrt(2))", RIGHT),
    ("en", CUBOID, MOMENTS, "2.5, 5, 6.5 kg m^2", RIGHT),
    ("en", CUBOID, MOMENTS, "[5/2, 5, 13/2] kg m^2", RIGHT),
    ("en", CUBOID, MOMENTS, "[2.5 5 7.5] kg m^2", WRONG),
    ("en", ATWOOD, TENSION, "m*(-minus_g) + -m*minus_g*(M - m)/(m + M)", RIGHT),
    ("en", ATWOOD, "/accelerations/light/linear/1", "4.905 ms⁻²", RIGHT),
    # France
    ("fr", CUBOID, MOMENTS, "[2,5; 5; 6,5] kg·m²", RIGHT),
    ("fr", CUBOID, MOMENTS, "[5; 10; 13] kg·m²", WRONG),
    ("fr", CUBOID, MOMENTS, "[2,5; 5] kg·m²", UNREADABLE),
    ("fr", ATWOOD, TENSION, "14,7 N", RIGHT),
    ("fr", ATWOOD, TENSION, "14 715 mN", RIGHT),
    ("fr", ATWOOD, TENSION, "29,43 N", WRONG),
    ("fr", ATWOOD, IN_TIME, {"value": [14.7, 14.7, 14.7], "times": [0.0, 0.1, 0.2], "unit": "N"}, RIGHT),
    ("fr", ATWOOD, IN_TIME, {"value": [9.81, 9.81, 9.81], "times": [0.0, 0.1, 0.2], "unit": "N"}, WRONG),
    ("fr", ATWOOD, IN_TIME, {"value": [14.7, 14.7], "times": [0.0, 0.1, 0.2], "unit": "N"}, UNREADABLE),
    ("fr", COIN, "/body_rate", "9,549 tr/min", RIGHT),
    ("fr", COIN, "/body_rate", "1 rad.s-1", RIGHT),
    ("fr", COIN, "/tumbles", "oui", WRONG),
    ("fr", ATWOOD, TENSION, "1,47.10¹ N", RIGHT),
    ("fr", COIN, "/period", "2.10^0 s", WRONG),
    ("fr", COIN, CONE, "Arctan(1/√2)", RIGHT),
    ("fr", CUBOID, MOMENTS, "2,5 kg.m², 5 kg.m², 6,5 kg.m²", RIGHT),
    # Spain
    ("es", COIN, "/period", "6'28 s", RIGHT),
    ("es", ATWOOD, TENSION, "1,5 kp", RIGHT),
    ("es", COIN, CONE, "arctg(1/√2)", RIGHT),
    ("es", COIN, "/tumbles", "falsa", RIGHT),
    ("es", COIN, "/period", "T = 6,28 segundos", RIGHT),
    ("es", COIN, CONE, "35,26 grados", RIGHT),
    ("es", COIN, "/body_rate", "9,549 vueltas por minuto", RIGHT),
    ("es", ATWOOD, TENSION, "14.715 N", UNREADABLE),
    ("es", ATWOOD, TENSION, "1.471,5 cN", RIGHT),
]


@pytest.mark.parametrize(("locale", "question", "pointer", "answer", "verdict"), EXAM)
def test_every_answer_has_the_verdict_of_the_examiner(
    locale: Locale, question: Any, pointer: str, answer: Any, verdict: str
) -> None:
    claim = {"text": answer} if isinstance(answer, str) else answer
    names = {"names": NAMES} if question is ATWOOD else {}
    (result,) = handled(question, {pointer: claim}, locale=locale, language=locale, **names)["results"]
    given = result["tests"][0]["verdict"] if result["tests"] else "unreadable"
    assert given == verdict
    assert (result["score"] == 1.0) == (verdict == RIGHT)


def test_the_exam_has_answers_in_every_locale_right_and_wrong() -> None:
    assert len(EXAM) == 85
    assert {entry[0] for entry in EXAM} == set(get_args(Locale))
    assert 35 < sum(entry[-1] == RIGHT for entry in EXAM) < 65


@pytest.mark.parametrize(
    ("language", "feedback"),
    [
        ("de", "Um den Faktor 2 zu groß."),
        ("en", "Too large by a factor of 2."),
        ("es", "Demasiado grande por un factor de 2."),
        ("fr", "Trop grand d'un facteur 2."),
    ],
)
def test_feedback_is_in_the_language_of_the_course(language: str, feedback: str) -> None:
    answer = handled(ATWOOD, {TENSION: {"value": 29.43, "unit": "N"}}, language=language)
    assert answer["results"][0]["feedback"] == feedback


def test_a_wrong_dimension_of_a_formula_about_a_described_scene_is_named() -> None:
    (result,) = handled(ATWOOD, {TENSION: {"formula": "2*m*M/(m + M)"}}, names=NAMES)["results"]
    assert result["feedback"].startswith("Check the dimensions")


def test_a_later_part_of_a_question_is_judged_from_the_earlier_one() -> None:
    """A student who forgets the factor 2 in the tension and goes on correctly loses the credit of the tension only."""
    steps = {"/accelerations/light/linear/1": {"formula": "T/m + minus_g", "earlier": {"T": TENSION}}}
    submission = {TENSION: {"text": "7.3575 N"}, "/accelerations/light/linear/1": {"text": "-2.45 m/s^2"}}
    asked: Any = {"names": NAMES, "comparison": {"kind": "relabs", "rtol": 0.01}}
    (result,) = handled(ATWOOD, submission, steps=steps, **asked)["results"]
    assert [test["verdict"] for test in result["tests"]] == ["incorrect", "carried"]
    assert result["score"] == 0.5
    (without,) = handled(ATWOOD, submission, **asked)["results"]
    assert [test["verdict"] for test in without["tests"]] == ["incorrect", "incorrect"]


@pytest.mark.parametrize(
    ("tension", "light", "heavy", "verdicts"),
    [
        # Half of the tension: (7.3575 - 9.81) m/s^2, and the other mass the opposite.
        ("7,3575 N", "-2,4525 m/s²", "2,4525 m/s²", ["incorrect", "carried", "carried"]),
        ("7357,5 mN", "-2,4525 m/s²", "-2,4525 m/s²", ["incorrect", "carried", "incorrect"]),
        ("-minus_g*m*M/(m + M)", "-2,4525 m/s²", "4,905 m/s²", ["incorrect", "carried", "incorrect"]),
        ("7,3575", "-2,4525 m/s²", "2,4525 m/s²", ["missing-unit", "carried", "carried"]),
        ("14,715", "4,905 m/s²", "-4,905 m/s²", ["missing-unit", "correct", "correct"]),
        ("7,3575 kg", "-2,4525 m/s²", "2,4525 m/s²", ["wrong-unit", "incorrect", "carried"]),
        ("7,3575 N", "-2,4525", "2,4525 m/s²", ["incorrect", "missing-unit", "carried"]),
        ("0 N", "-9,81 m/s²", "9,81 m/s²", ["incorrect", "carried", "carried"]),
        ("29,43 N", "4,905 m/s²", "-4,905 m/s²", ["incorrect", "correct", "correct"]),
    ],
)
def test_errors_are_carried_through_a_chain_of_answers(
    tension: str, light: str, heavy: str, verdicts: list[str]
) -> None:
    one, other = "/accelerations/light/linear/1", "/accelerations/heavy/linear/1"
    steps = {
        one: {"formula": "T/m + minus_g", "earlier": {"T": TENSION}},
        other: {"formula": "-a", "earlier": {"a": one}},
    }
    submission = {TENSION: {"text": tension}, one: {"text": light}, other: {"text": heavy}}
    (result,) = handled(ATWOOD, submission, steps=steps, names=NAMES, locale="de")["results"]
    assert [test["verdict"] for test in result["tests"]] == verdicts


@pytest.mark.parametrize(
    ("pointer", "step", "place"),
    [
        ("/accelerations/light/linear/1", {"formula": "2*T/m", "earlier": {"T": TENSION}}, "/formula"),
        ("/accelerations/light/linear/1", {"formula": "T/", "earlier": {"T": TENSION}}, "/formula"),
        ("/accelerations/light/linear/1", {"formula": "T/q", "earlier": {"T": TENSION}}, "/formula"),
        ("/accelerations/light/linear/1", {"formula": "T/m", "earlier": {"T": "/forces/none"}}, "/earlier/T"),
        ("/accelerations/light/linear/1", {"formula": "T/m", "earlier": {"m": TENSION}}, "/earlier/m"),
        (TENSION, {"formula": "T", "earlier": {"T": TENSION}}, "/earlier/T"),
        ("/forces/none", {"formula": "T", "earlier": {"T": TENSION}}, ""),
    ],
)
def test_a_step_that_does_not_give_the_right_answer_is_refused(pointer: str, step: Any, place: str) -> None:
    with pytest.raises(InvalidParameter) as refused:
        handled(ATWOOD, {TENSION: {"text": "14.7 N"}}, names=NAMES, steps={pointer: step})
    assert pointer_of(refused.value.path) == "/steps/" + pointer.replace("/", "~1") + place
