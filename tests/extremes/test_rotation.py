"""Free motions at every border against two references that share nothing with the double kernels.

Ball arithmetic (certified answers) judges every motion; the closed form in 60 digits of mpmath (`tests.oracles`) judges
the step from one side of a border to the other. `tests/core/certified/judge.py` does so for a
hundred thousand random motions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from tests.extremes.asking import Asked, ask, certified
from tests.extremes.motions import Motion, motions
from tests.extremes.questions import MOTIONS, STARTS, turn_of
from tests.oracles.free_rotation import free_motion

UNIT_ROUNDOFF = 2.0**-53
TRAJECTORY, PRECESSION, STABILITY = "/v1/rotation/trajectory", "/v1/rotation/precession", "/v1/rotation/stability"
OWN = 1e-38
"""Error of a reference of 40 digits."""
NEAR_EQUAL = {"moments-equal-within-rounding", "moments-nearly-equal"}
UNRESOLVED = {
    "2^-1000 beside the middle axis": "the start differs from a rotation about the middle axis by less",
    "separatrix by 1e-300": "the start differs from a rotation about the middle axis by less",
    "subnormal beside the largest": "the start differs from a rotation about the middle axis by less",
    "no body, of": "a time lies beyond 2^48 periods",
    "lamina of 1e-": "a time lies beyond 2^48 periods",
    "one moment and its rate subnormal": "moments and rates lie too far apart",
}
"""The only motions that are refused, by part of their names, and why."""


def times_of(motion: Motion) -> list[float]:
    turn = turn_of(motion)
    far = [1e3 * turn, -1e9 * turn] if turn < 1e290 else []
    return [0.0, turn, -3 * turn, turn, *far]


def asked_both_ways(path: str, question: Asked, **only_in_doubles: Any) -> tuple[Any, Any]:
    """Return the answers in doubles and in 40 digits, either None where it is refused."""
    found, exact = ask(path, question | only_in_doubles), certified(path, question, 40)
    return found, exact


def farthest(rows: list[list[float]], numerals: list[list[str]], norm: float | None = None) -> float:
    """Return the largest distance of rows over a norm, which by default is the largest of the exact ones."""
    exact = [[Fraction(x) for x in row] for row in numerals]
    largest = max(sum(x * x for x in row) for row in exact)
    if norm is not None:
        # That of the whole motion is not below that of any sample, by more than its rounding.
        assert Fraction(norm) ** 2 * (1 + Fraction(1, 10**15)) >= largest
        largest = Fraction(norm) ** 2
    worst = max(
        sum((Fraction(g) - x) ** 2 for g, x in zip(row, true, strict=True))
        for row, true in zip(rows, exact, strict=True)
    )
    if not largest:
        return float(worst)
    # Roots of integers, as a state that blew up may be farther off than the square of a double says.
    return math.isqrt((worst * 2**400 / largest).__floor__()) / 2**200


def test_every_motion_is_within_its_stated_error_or_refused_for_a_known_reason() -> None:
    worst = {"angular velocity": (0.0, ""), "attitude": (0.0, "")}
    for motion in MOTIONS:
        question = motion.question | {"times": times_of(motion), "attitude": [1.0, 2.0, 0.5, 0.0]}
        found, exact = asked_both_ways(TRAJECTORY, question, accuracy=0.9)
        if not found.answered:
            reasons = [why for part, why in UNRESOLVED.items() if part in motion.name]
            assert any(why in found.problem.detail for why in reasons), (motion.name, found.problem.detail)
            continue
        answer, true = found.of(), exact.of()
        assert answer["model"]["regime"] == true["model"]["regime"], motion.name
        error = farthest(answer["angular_velocity"], true["angular_velocity"])
        assert error <= answer["accuracy"]["error"] + OWN, motion.name
        # Twice the distance of quaternions is the most that a turned unit vector is off.
        turned = 2 * farthest(answer["attitude"], true["attitude"])
        assert turned <= answer["accuracy"]["attitude_error"] + OWN, motion.name
        worst = {
            "angular velocity": max(worst["angular velocity"], (error / UNIT_ROUNDOFF, motion.name)),
            "attitude": max(worst["attitude"], (turned / UNIT_ROUNDOFF, motion.name)),
        }
        for figure in ("period", "flip_interval", "energy", "angular_momentum"):
            assert is_right(answer[figure], true[figure], 4, found.codes, "out-of-range"), (motion.name, figure)
    # Seen: 3.0 and 9.6.
    assert worst["angular velocity"][0] <= 5, worst
    assert worst["attitude"][0] <= 12, worst


def is_right(figure: Any, numeral: str | None, ulps: float, codes: set[str], excuse: str) -> bool:
    """Return whether a figure is right to so many units of 2^-53; null only if it is said to be."""
    if figure is None:
        return numeral is None or excuse in codes
    true = Fraction(numeral or "nan")
    return Fraction(figure) == true if true == 0 else abs(Fraction(figure) / true - 1) <= ulps * UNIT_ROUNDOFF


@pytest.mark.parametrize("order", [(1, 2, 0), (2, 1, 0), (0, 2, 1)])
def test_the_order_of_the_axes_changes_no_digit(order: tuple[int, int, int]) -> None:
    sign = np.linalg.det(np.eye(3)[list(order)])
    for motion in MOTIONS[::3]:
        question = motion.question | {"times": times_of(motion)[:4]}
        mirrored = {
            "body": {"kind": "principal-moments", "moments": [motion.moments[k] for k in order]},
            "angular_velocity": [motion.rates[k] for k in order],
            # Exchanging two axes mirrors the motion: it runs backwards.
            "times": [sign * t for t in question["times"]],  # type: ignore[attr-defined]
        }
        one, other = ask(TRAJECTORY, question), ask(TRAJECTORY, mirrored)
        assert one.answered == other.answered, motion.name
        if one.answered:
            rows = np.array(one.answer["angular_velocity"])[:, list(order)]
            assert np.array_equal(rows, np.array(other.answer["angular_velocity"])), motion.name
            assert one.answer["period"] == other.answer["period"]


def borders() -> Iterator[tuple[Motion, Motion]]:
    """Yield neighbours on the way to a border and across it."""
    families: dict[str, list[Motion]] = {}
    for motion in motions():
        if "separatrix" in motion.name and "2^-" in motion.name:
            families.setdefault(motion.name.split(", ")[1], []).append(motion)
        elif " but for " in motion.name:
            kind, state = motion.name.split(" but for ")[0], motion.name.rsplit(", ", 1)[-1]
            families.setdefault(f"{kind} {state if ',' in motion.name else ''}", []).append(motion)
        elif motion.name.startswith("lamina of 0.1"):
            families.setdefault(motion.name.rsplit(", ", 1)[-1], []).append(motion)
    for family in families.values():
        yield from pairwise(family)


def test_answers_change_across_every_border_by_as_much_as_the_motions_do() -> None:
    compared = 0
    for one, other in borders():
        turn = turn_of(one)
        question: Asked = {"times": [turn, -7 * turn, 40 * turn]}
        here, there = ask(TRAJECTORY, one.question | question), ask(TRAJECTORY, other.question | question)
        if not (here.answered and there.answered):
            continue
        references = []
        for motion in (one, other):
            exact = free_motion(motion.moments, motion.rates, question["times"], digits=50)
            references.append([exact.angular_velocity(Fraction(t)) for t in question["times"]])
            scale = float(exact.largest_rate)
        rows = zip(here.answer["angular_velocity"], there.answer["angular_velocity"], *references, strict=True)
        stated = here.answer["accuracy"]["error"] + there.answer["accuracy"]["error"]
        for a, b, true_a, true_b in rows:
            step = [Fraction(x) - Fraction(y) for x, y in zip(a, b, strict=True)]
            true = [x - y for x, y in zip(true_a, true_b, strict=True)]
            missed = math.hypot(*(float(float_of(s) - t) for s, t in zip(step, true, strict=True)))
            assert missed <= stated * scale * (1 + 1e-12), (one.name, other.name)
            compared += 1
    assert compared > 250


def float_of(fraction: Fraction) -> Any:
    """Return a fraction as a number of the reference's precision."""
    from tests.oracles.motion import real

    return real(fraction)


def test_angular_momentum_stays_in_space() -> None:
    """R(t) I w(t) is constant: angular velocity and attitude, computed apart, agree."""
    for motion in MOTIONS:
        turn = turn_of(motion)
        question = motion.question | {"times": [0.0, turn, -5 * turn, 300 * turn], "attitude": [0.5, -0.5, 0.5, 0.5]}
        reply = ask(TRAJECTORY, question)
        if not reply.answered or not any(motion.rates):
            continue
        moments, rates = np.array(motion.moments), np.array(reply.answer["angular_velocity"])
        if not (1e-140 < moments.max() < 1e140 and 1e-140 < np.abs(rates).max() < 1e140):
            continue
        momentum = moments * rates
        q = np.array(reply.answer["attitude"])
        w, v = q[:, :1], q[:, 1:]
        turned = momentum + 2 * np.cross(v, np.cross(v, momentum) + w * momentum)
        size = float(np.linalg.norm(momentum, axis=1).max())
        # A lamina's or needle's rate is large where it counts for little momentum.
        weight = moments.max() * float(np.linalg.norm(rates, axis=1).max()) / size
        allowed = reply.answer["accuracy"]["attitude_error"] + 2 * weight * reply.answer["accuracy"]["error"] + 1e-15
        assert np.linalg.norm(turned - turned[0], axis=1).max() <= 2 * allowed * size, motion.name


@pytest.mark.parametrize("path", [PRECESSION, STABILITY])
def test_rates_and_eigenvalues_are_right_to_four_units(path: str) -> None:
    compared = 0
    for motion in MOTIONS:
        question = motion.question if path == PRECESSION else {
            "body": motion.question["body"],
            "rate": max(motion.rates, key=abs),
        }  # fmt: skip
        found, exact = asked_both_ways(path, question)
        assert found.answered == exact.answered or "start differs" in found.problem.detail, motion.name
        if not (found.answered and exact.answered) or found.codes & NEAR_EQUAL:
            # What takes two moments as equal is another body's answer; it says so.
            continue
        for where, figure, numeral in common(found.answer, exact.answer):
            assert is_right(figure, numeral, 4, found.codes, "out-of-range"), (motion.name, where, figure, numeral)
            compared += 1
    assert compared > 500


def common(answer: Any, exact: Any, where: str = "") -> Iterator[tuple[str, Any, str | None]]:
    """Yield the numbers that both answers have, and the numerals that say what they are."""
    if isinstance(exact, dict) and isinstance(answer, dict):
        for name in sorted((exact.keys() & answer.keys()) - {"accuracy", "warnings", "signature", "absent", "work"}):
            yield from common(answer[name], exact[name], f"{where}/{name}")
    elif isinstance(exact, list) and isinstance(answer, list):
        for k, (one, other) in enumerate(zip(answer, exact, strict=False)):
            yield from common(one, other, f"{where}/{k}")
    elif isinstance(exact, str) and not isinstance(answer, str):
        yield where, answer, exact


def test_members_of_an_ensemble_are_the_motions_alone() -> None:
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
    times = [0.3, -1e6, 0.3]
    many = ask("/v1/rotation/ensemble", {"body": body, "angular_velocities": STARTS, "times": times}).of()
    for start, samples, member in zip(STARTS, many["angular_velocity"], many["members"], strict=True):
        alone = ask(TRAJECTORY, {"body": body, "angular_velocity": start, "times": times}).of()
        assert samples == alone["angular_velocity"]
        assert (member["period"], member["model"]) == (alone["period"], alone["model"])
        assert member["accuracy"]["error"] == alone["accuracy"]["error"]
    assert many["error"] == max(member["accuracy"]["error"] for member in many["members"])


def test_a_period_beyond_doubles_is_null_and_said_to_be() -> None:
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]}
    start = [5e-324, -5e-324, 1.5e-323]
    many = ask("/v1/rotation/ensemble", {"body": body, "angular_velocities": [start], "times": [1.0]})
    assert many.of()["members"][0]["period"] is None
    assert "out-of-range" in many.codes
    flip = ask(STABILITY, {"body": body, "rate": 5e-324, "disturbance": [5e-324, 0.0]}).of()["flip"]
    assert flip["interval"] is None
    assert "only after a time beyond double precision" in flip["reason"]


@pytest.mark.parametrize("digits", [3, 9, "meaningful"])
def test_rounded_extremes_stay_within_what_is_then_stated(digits: Any) -> None:
    for motion in MOTIONS[::2]:
        question = motion.question | {"times": times_of(motion)[:4]}
        found, exact = ask(TRAJECTORY, question | {"round": digits}), certified(TRAJECTORY, question, 40)
        if found.answered:
            error = farthest(found.answer["angular_velocity"], exact.of()["angular_velocity"])
            assert error <= found.answer["accuracy"]["error"] + OWN, motion.name
