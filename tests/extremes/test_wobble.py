"""The wobble from the roundest to the flattest body that doubles tell apart, by mpmath at 50 digits."""

from __future__ import annotations

import mpmath
import pytest

from core.rotation.wobble import SOLAR_DAY_IN_ROTATIONS
from tests.extremes.asking import ask
from tests.extremes.questions import QUESTIONS

PATH = "/v1/rotation/wobble"


def test_figures_are_right_to_a_few_ulps_or_refused() -> None:
    """e = 1/rotations and a/c = sqrt((1 + e)/(1 - e)), either way round."""
    answered = 0
    with mpmath.workdps(400):
        for name, question in QUESTIONS[PATH]():
            reply = ask(PATH, question)
            if not reply.answered:
                continue
            unit = mpmath.mpf(SOLAR_DAY_IN_ROTATIONS) if question["day"] == "solar" else 1
            if "period" in question:
                e = 1 / (mpmath.mpf(question["period"]) * unit)
                ratio = mpmath.sqrt((1 + e) / (1 - e))
            else:
                ratio = mpmath.mpf(question["ellipticity"])
                e = (ratio**2 - 1) / (ratio**2 + 1)
            wanted = {"asymmetry": e, "rotations": 1 / e, "ellipticity": ratio, "flattening": 1 - 1 / ratio}
            for figure, value in wanted.items():
                assert abs(reply.answer[figure] / value - 1) <= 4 * 2.0**-53, (name, figure)
            assert reply.answer["period"] == pytest.approx(float(1 / e / unit), rel=1e-15)
            answered += 1
    assert answered >= 14


def test_a_period_whose_rotations_no_double_holds_is_refused() -> None:
    reply = ask(PATH, {"period": 1.7976931348623157e308, "day": "solar"})
    assert reply.problem is not None
    assert reply.problem.faults[0].pointer == "/period"
