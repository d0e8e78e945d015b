"""Integrators at the extremes: what is said of their error is never below it, and plans have numbers."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest

from tests.extremes.asking import ask, certified
from tests.extremes.questions import LARGEST, MATRIX_OF_METHODS, MOTIONS, turn_of
from tests.extremes.test_rotation import OWN, TRAJECTORY, farthest

BODY = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}


@pytest.mark.parametrize("make", MATRIX_OF_METHODS, ids=lambda make: make(1.0)["kind"])
def test_no_integrator_is_said_to_be_better_than_it_is(make: Any) -> None:
    compared = 0
    for motion in MOTIONS[::4]:
        turn = turn_of(motion)
        question = motion.question | {"times": [turn, -2 * turn, 0.0]}
        found = ask(TRAJECTORY, question | {"method": make(turn)})
        if not found.answered:
            continue
        exact = certified(TRAJECTORY, question, 40).of()
        stated = found.answer["accuracy"]
        error = farthest(found.answer["angular_velocity"], exact["angular_velocity"], stated["largest_norm"])
        assert error <= stated["error"] + OWN, motion.name
        compared += 1
    assert compared > 40


@pytest.mark.parametrize("scale", [1e-140, 1.0, 1e100])
@pytest.mark.parametrize(("kind", "step"), [("explicit-euler", 4.0), ("runge-kutta-4", 8.0)])
def test_a_method_that_blows_up_is_stated_to_do_so_until_it_is_refused(scale: float, kind: str, step: float) -> None:
    """Its states reach 1e185 before they leave the range of doubles; no error in between is anything but a number."""
    stated, refused = [], 0
    for steps in range(1, 14):
        time = step * steps / scale
        method = {"kind": kind, "step": step / scale}
        question = {"body": BODY, "angular_velocity": [scale] * 3, "times": [0.0, time], "method": method}
        reply = ask(TRAJECTORY, question)
        alone = {"body": BODY, "angular_velocities": [[scale] * 3], "times": [0.0, time], "method": method}
        assert ask("/v1/rotation/ensemble", alone).answered == reply.answered
        if reply.answered:
            largest = max(abs(x) for x in reply.answer["angular_velocity"][1]) / scale
            stated.append(reply.answer["accuracy"]["error"])
            assert stated[-1] >= largest / 2 - 2
        else:
            refused += 1
            assert reply.problem is not None
            assert reply.problem.faults[0].pointer.startswith("/method")
    assert refused > 0
    assert max(stated) > 1e80


def test_the_error_of_a_run_that_nothing_can_judge_is_relative_to_what_is_certain() -> None:
    """The states of a needle's splitting grow to 1e295 while the phase of the closed form is lost."""
    body = {"kind": "principal-moments", "moments": [1e-300, 1.0, math.nextafter(1.0, 0.0)]}
    method = {"kind": "symmetric-splitting", "step": 0.0625}
    question = {"body": body, "angular_velocity": [0.5, 0.8, -0.6], "times": [0.0, 1.25, -2.5]}
    found = ask(TRAJECTORY, question | {"method": method}).of()
    exact = certified(TRAJECTORY, question, 20).of()
    wrong = abs(Fraction(found["angular_velocity"][1][0])) / max(
        abs(Fraction(row[0])) for row in exact["angular_velocity"]
    )
    assert wrong > 10**140
    assert found["accuracy"]["error"] >= wrong


@pytest.mark.parametrize(
    ("rates", "times", "method"),
    [
        ([0.0, 0.0, 0.0], {"start": 0.0, "stop": 1e10, "count": 1}, {"kind": "explicit-euler", "step": 1e-300}),
        ([LARGEST, LARGEST, 0.0], [0.0], {"kind": "lsoda", "tolerance": 1e-6}),
        ([0.0, 0.0, 0.0], [-LARGEST, LARGEST], {"kind": "lsoda", "tolerance": 1e-6}),
        ([LARGEST, LARGEST, 0.0], [0.0, LARGEST], {"kind": "runge-kutta-4", "step": 5e-324}),
    ],
)
def test_whatever_the_request_has_a_plan(rates: Any, times: Any, method: Any) -> None:
    motion = {"body": BODY, "angular_velocity": rates, "times": times}
    for path, asked in (
        (TRAJECTORY, motion | {"method": method}),
        ("/v1/work-precision", motion | {"methods": [method]}),
    ):
        ask("/v1/plan", {"path": path, "request": asked}).of()
