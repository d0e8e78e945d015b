"""Formulas are right if they agree everywhere, and it is said why they are not."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import pytest

from core.assessment.compare import Reference
from core.assessment.judged_formulas import AT_ONE_PLACE, ENOUGH, judge_formula
from core.formulas import Formula

UNITS = {"g": "m s^-2", "l": "m", "m": "kg"}


@dataclass(frozen=True)
class Pendulum:
    """A small pendulum: its rate is sqrt(g/l)."""

    parameters: dict[str, float]

    @property
    def figure(self) -> float:
        return sqrt(self.parameters["g"] / self.parameters["l"])


VARIED = [Pendulum({"g": 9.81 + 0.1 * k, "l": 9.81 + 0.07 * k * k, "m": 1.0 + 0.3 * k}) for k in range(ENOUGH + 5)]


def judged(text: str, count: int = ENOUGH + 5) -> tuple[str, str]:
    reference = Reference(1.0, "rad s^-1", scale=1.0)
    found = judge_formula(Formula.read(text, UNITS), VARIED[:count], UNITS, reference)
    return found.judgement.verdict, found.why


@pytest.mark.parametrize("text", ["sqrt(g/l)", "(g/l)^0.5", "g^(1/2)/sqrt(l)", "m*sqrt(g/l)/m", "sqrt(g)*l^-0.5"])
def test_what_agrees_everywhere_is_right(text: str) -> None:
    assert judged(text) == ("correct", "")


def test_what_agrees_at_one_place_is_wrong() -> None:
    # There g = l in numbers, and any power of g/l is 1.
    verdict, why = judged("(g/l)^(3/2)")
    assert (verdict, why) == ("incorrect", "dimension")
    assert judged("sqrt(g/l) * 1.000001")[0] == "incorrect"


def test_agreement_at_the_given_parameters_alone_is_said() -> None:
    # m = 1 kg here: a ratio to another mass that is 1, too, agrees at this place only.
    reference = Reference(1.0, "rad s^-1", scale=1.0)
    units = UNITS | {"M": "kg"}
    varied = [Pendulum(one.parameters | {"M": 1.0 + 0.1 * k}) for k, one in enumerate(VARIED)]
    found = judge_formula(Formula.read("sqrt(g/l)*m/M", units), varied, units, reference)
    assert (found.judgement.verdict, found.why) == ("incorrect", AT_ONE_PLACE)
    assert found.value is None


def test_dimensions_explain_what_is_wrong() -> None:
    assert judged("sqrt(g)")[1] == "dimension"
    assert judged("1 - sqrt(l^2 - 1)")[1] == "dimension-terms"
    assert judged("sin(l)")[1] == "dimension-function"
    assert judged("2^l")[1] == "dimension-exponent"
    assert judged("2*sqrt(g/l)") == ("incorrect", "")


def test_a_constant_with_a_hidden_unit_may_be_right() -> None:
    reference = Reference(2.0, "N", scale=2.0)

    class Fixed(Pendulum):
        figure = 2.0  # type: ignore[assignment]

    found = judge_formula(Formula.read("2", UNITS), [Fixed(one.parameters) for one in VARIED], UNITS, reference)
    assert found.judgement.verdict == "correct"


def test_a_formula_without_a_value_is_wrong() -> None:
    assert judged("sqrt(g/l)/(l-9.81)")[0] == "incorrect"


def test_too_few_questions_decide_nothing() -> None:
    assert judged("sqrt(g/l)", ENOUGH)[0] == "not-gradable"
