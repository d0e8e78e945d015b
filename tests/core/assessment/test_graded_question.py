"""References of a question that is answered without the service: errors, inherited errors, number of answers."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi, sqrt
from typing import Any

import mpmath
import numpy as np
import pytest

from core.assessment.graded_question import GradedQuestion
from core.errors import MechanicsError
from tests.core.assessment.pendulum import REQUEST, Pendulum

PERIOD = 2.0 * pi * sqrt(0.5 / 9.81)


def test_a_reference_inherits_what_its_numbers_leave_open() -> None:
    # The period is proportional to the root of length over gravity: half of each relative uncertainty.
    reference = GradedQuestion(Pendulum(), REQUEST, {("gravity",): 1e-3}).reference(("period",))
    assert reference is not None
    assert reference.value == pytest.approx(PERIOD, rel=1e-15)
    assert (reference.unit, reference.form) == ("s", "number")
    assert reference.inherited == pytest.approx(0.5e-3 * PERIOD, rel=1e-3)
    assert 0.0 < reference.error < 1e-13
    both = GradedQuestion(Pendulum(), REQUEST, 1e-3).reference(("period",))
    assert both is not None
    assert both.inherited == pytest.approx(1e-3 * PERIOD, rel=1e-3)


def test_figures_that_do_not_exist_and_paths_that_lead_nowhere() -> None:
    graded = GradedQuestion(Pendulum(), REQUEST, None)
    none = graded.reference(("flip",))
    assert none is not None
    assert none.form == "none"
    assert graded.reference(("nothing",)) is None
    kind = graded.reference(("kind",))
    assert kind is not None
    assert (kind.value, kind.form) == ("center", "choice")


def test_a_question_is_asked_once_for_each_change() -> None:
    source = Pendulum()
    graded = GradedQuestion(source, REQUEST, None)
    assert graded.answer["stable"] is True
    graded.reference(("period",))
    once = source.answered
    graded.reference(("period",))
    graded.reference(("rate",))
    assert source.answered == once
    assert graded.evaluate({**REQUEST, "length": 2.0})(("period",)) == pytest.approx(2.0 * PERIOD)
    assert graded.evaluate({**REQUEST, "length": -2.0})(("period",)) is None
    assert source.answered == once + 2


def test_samples_at_other_times() -> None:
    graded = GradedQuestion(Pendulum(), REQUEST, None)
    times = np.array([0.0, PERIOD / 2, PERIOD])
    column = graded.samples(("angle",), times)
    assert column is not None
    np.testing.assert_allclose(column.value, [1.0, -1.0, 1.0], atol=1e-15)
    assert graded.samples(("period",), times) is None
    with pytest.raises(MechanicsError):
        graded.samples(("angle",), -times)


def test_variations_move_every_parameter_and_keep_the_law() -> None:
    graded = GradedQuestion(Pendulum(), REQUEST, None)
    parameters = graded.parameters({"l": ("length",), "g": ("gravity",)})
    assert parameters["l"] == (("length",), 0.5, "m")
    first, *varied = graded.variations(("period",), parameters)
    assert first.parameters == {"l": 0.5, "g": 9.81}
    assert len(varied) == 20
    for one in varied:
        assert one.figure == pytest.approx(2.0 * pi * sqrt(one.parameters["l"] / one.parameters["g"]))
    assert len({one.parameters["g"] for one in varied}) == 20
    assert set(graded.parameters(None)) == {"length", "gravity"}


def test_a_figure_with_proven_digits_is_known_to_its_last_ones() -> None:
    graded = GradedQuestion(Pendulum(), REQUEST, None)
    period, rate = graded.reference(("period",)), graded.reference(("rate",))
    assert period is not None
    assert rate is not None
    with mpmath.workdps(40):
        true = 2 * mpmath.pi * mpmath.sqrt(mpmath.mpf(0.5) / mpmath.mpf(9.81))
        missed = float(abs(true - mpmath.mpf(period.value)))
    assert period.how == "ball arithmetic"
    assert missed <= period.error <= missed + 1e-15
    # Of the rate there are no proven digits, nor of a question that is not answered in them.
    assert rate.how.startswith("estimate")
    other = GradedQuestion(Pendulum(), {**REQUEST, "length": 0.6}, None).reference(("period",))
    assert other is not None
    assert other.how.startswith("estimate")
    assert other.error > period.error


def test_the_errors_of_figures_are_those_that_the_source_bounds() -> None:
    graded = GradedQuestion(Pendulum(), {**REQUEST, "length": 0.25}, None)
    rate, period = graded.reference(("rate",)), graded.reference(("period",))
    assert rate is not None
    assert period is not None
    assert (rate.error, rate.how) == (1e-6, "a bound")
    assert period.how.startswith("estimate")


class Bounded(Pendulum):
    """Answers with figures whose bounds stand in every form that answers have."""

    def answer(self, request: str) -> Mapping[str, Any]:
        return super().answer(request) | {
            "extremes": [
                {"least": -1.0, "largest": 2.0, "error": 1e-12, "errors": {"least_time": 1e-6}, "least_time": 3.0}
            ],
            "equilibria": [{"positions": {"bob": (0.3, -0.4)}, "errors": {"positions": {"bob": 1e-13}}}],
            "solutions": [{"values": {"/let/x": 1.5}, "errors": {"/let/x": 1e-9}}],
            "events": [{"kind": "touch", "time": 0.5, "error": 1e-14, "errors": {"energy_loss": None}}],
        }


@pytest.mark.parametrize(
    ("path", "error"),
    [
        (("extremes", 0, "least"), 1e-12),
        (("extremes", 0, "largest"), 1e-12),
        (("extremes", 0, "least_time"), 1e-6),
        (("equilibria", 0, "positions", "bob", 1), 1e-13),
        (("events", 0, "time"), 1e-14),
        (("solutions", 0, "values", "/let/x"), 1e-9),
    ],
)
def test_bounds_are_found_beside_figures_and_in_the_objects_around_them(path: Any, error: float) -> None:
    reference = GradedQuestion(Bounded(), REQUEST, {}).reference(path)
    assert reference is not None
    assert (reference.error, reference.how) == (error, "bound that the answer states")
