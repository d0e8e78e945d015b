"""Scenes at every extreme: samples in doubles against the same scene in 40 digits, and limits between neighbours."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest

from tests.extremes.asking import ROUTES, ask, certified
from tests.extremes.questions import CHAIN, QUESTIONS, ROD, SHAFTS, Asked
from tests.extremes.test_rotation import OWN, UNIT_ROUNDOFF, common

SCENES = tuple(
    path for path in QUESTIONS if path.startswith("/v1/scenes/") and path.replace("/v1/", "/v1/certified/") in ROUTES
)
FINE: dict[str, tuple[str, ...]] = {
    "/v1/scenes/unwinding-shafts": ("g 1e-300",),
    "/v1/scenes/chain-on-wedge": ("masses 0 and 0, density 0", "g 1e+300"),
    "/v1/scenes/rod-in-hole": ("rate -1e+150", "size 1e-300", "size 1e-150", "g 1e+300", "length 2.0", "angle 3.14"),
}
"""What is refused in doubles, by part of its name: beyond the last phase, beyond the range, or no rod at all."""


@pytest.mark.parametrize("path", SCENES)
def test_samples_and_figures_are_within_the_stated_error(path: str) -> None:
    compared, refused = 0, []
    for name, question in QUESTIONS[path]():
        found, exact = ask(path, question), certified(path, question, 40)
        if not found.answered:
            refused.append(name)
            continue
        if not exact.answered:
            # Numerals have ranges and precisions of their own, each told by name.
            assert exact.problem is not None
            assert exact.problem.faults[0].detail, name
            continue
        answer, true = found.answer, exact.answer
        stated = answer["accuracy"]["error"]
        samples, references = answer.pop("trajectory", {}), true.pop("trajectory", {})
        for where, figure, numeral in common(answer, true):
            if figure is None:
                assert numeral is None or "outside-double-range" in found.codes, (name, where)
            else:
                value = Fraction(numeral or "nan")
                assert abs(Fraction(figure) - value) <= stated * abs(value) + (value == 0) * OWN, (name, where)
        for column in samples.keys() - {"time"}:
            rows = [flat(row) for row in samples[column]]
            wanted = [[Fraction(x) for x in flat(row)] for row in references[column]]
            scale = max((abs(x) for row in wanted for x in row), default=Fraction(0))
            for row, want in zip(rows, wanted, strict=True):
                error = max(abs(Fraction(x) - y) for x, y in zip(row, want, strict=True))
                assert error <= stated * scale + (scale == 0) * OWN, (name, column)
                compared += 1
    assert compared > 400
    assert [name for name in refused if not any(part in name for part in FINE[path])] == []


def flat(row: Any) -> list[Any]:
    return row if isinstance(row, list) else [row]


def test_the_chain_s_tension_neither_underflows_nor_cancels() -> None:
    """T = g (sin a + sin b) (M1 + rho x)(M2 + rho (L - x))/M, though no two of its factors have a product in range."""
    path = "/v1/scenes/chain-on-wedge"
    long = CHAIN | {"length": 1e150, "position": 5e149, "gravity": 1e-300, "velocity": 0.0, "times": [0.0, 0.3]}
    tension = ask(path, long).of()["trajectory"]["apex_tension"]
    pulls = math.sin(0.6) + math.sin(0.8)
    assert tension[0] == pytest.approx(1e-300 * pulls * (0.25 * 1e150) * (0.25 / 0.5), rel=1e-14)
    # With all but a hair of a heavy chain on one side, the tension is the hair's weight and its end's.
    hair = CHAIN | {"linear_density": 1e8, "position": math.nextafter(2.0, 0.0), "velocity": 0.0, "times": [0.0]}
    answer = ask(path, hair).of()
    right = Fraction(1.2) + 10**8 * (2 - Fraction(math.nextafter(2.0, 0.0)))
    left = 1 + 10**8 * Fraction(math.nextafter(2.0, 0.0))
    whole = Fraction(9.81) * left * right / (1 + Fraction(1.2) + 2 * 10**8)
    assert answer["trajectory"]["apex_tension"][0] == pytest.approx(float(whole) * pulls, rel=1e-14)
    assert answer["accuracy"]["error"] <= 64 * UNIT_ROUNDOFF


@pytest.mark.parametrize(
    ("path", "question", "field", "values"),
    [
        ("/v1/scenes/chain-on-wedge", CHAIN, "linear_density", (1e-9, 1e-12, 1e-15, 1e-18, 1e-300, 0.0)),
        ("/v1/scenes/rod-in-hole", ROD, "length", (1e-5, 1e-7, 1e-9, 1e-12, 1e-300)),
        ("/v1/scenes/unwinding-shafts", SHAFTS, "restitution", (1e-9, 1e-12, 1e-15, 1e-300, 0.0)),
    ],
)
def test_limits_are_approached_and_met(path: str, question: Asked, field: str, values: tuple[float, ...]) -> None:
    """Samples converge to those of the limit, at least in proportion to the distance from it."""
    limit = ask(path, question | {field: values[-1]}).of()["trajectory"]
    for value in values[:-1]:
        near = ask(path, question | {field: value}).of()["trajectory"]
        for column in limit.keys() - {"time"}:
            scale = max(abs(x) for row in limit[column] for x in flat(row))
            for row, true in zip(near[column], limit[column], strict=True):
                away = max(abs(x - y) for x, y in zip(flat(row), flat(true), strict=True))
                assert away <= (20 * value + 1e-14) * scale, (value, column)


def test_a_rod_turns_over_or_swings_as_its_rate_says_on_both_sides() -> None:
    path = "/v1/scenes/rod-in-hole"
    questions = dict(QUESTIONS[path]())
    for k in (10, 30, 45):
        over, under = (ask(path, questions[f"turning over {way}by 2^-{k}"]).of() for way in ("", "not "))
        assert (over["model"]["regime"], under["model"]["regime"]) == ("rotation", "libration")
        # On its way up it loses the wall on either side, ever more nearly at one instant and place.
        assert over["ended"] == under["ended"] != "horizon"
        ends = [answer["events"][-1]["time"] for answer in (over, under)]
        assert ends[0] == pytest.approx(ends[1], abs=20 * 2.0**-k)
        for column in ("angle", "angular_velocity"):
            sides = [answer["trajectory"][column][0] for answer in (over, under)]
            assert sides[0] == pytest.approx(sides[1], rel=10 * 2.0**-k)
