"""Each form is compared up to what its figure does not determine, and up to nothing else."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.assessment.compare import Reference, compare, distance
from core.assessment.comparisons import Data, DecDig, Interval, RelAbs, SigFig
from core.errors import InvalidParameter

ordinary = st.floats(-1e3, 1e3)
unit_quaternion = st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1)


def number(value: float, **more: Any) -> Reference:
    return Reference(value, scale=abs(value), **more)


def turn(axis: Any, angle: float) -> np.ndarray:
    """Return a rotation matrix by Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def test_the_verdict_is_whether_the_error_is_within_the_tolerance() -> None:
    judged = compare(number(2.0), 2.01, RelAbs(rtol=1e-2, atol=0.0))
    assert judged.verdict == "correct"
    assert judged.absolute == pytest.approx(0.01)
    assert judged.relative == pytest.approx(0.005)
    assert judged.in_tolerances == pytest.approx(0.5)
    assert compare(number(2.0), 2.03, RelAbs(rtol=1e-2, atol=0.0)).verdict == "incorrect"


def test_nothing_is_accepted_for_something_small() -> None:
    assert compare(number(1e-9), 0.0).verdict == "incorrect"
    assert compare(Reference(0.0, scale=3.0), 1e-9).verdict == "correct"
    assert compare(Reference(0.0, scale=3.0), 1e-6).verdict == "incorrect"


@pytest.mark.parametrize("comparison", [RelAbs(rtol=1e-12, atol=0.0), SigFig(15), DecDig(15), Data(factor=0.5)])
def test_a_tolerance_finer_than_what_is_known_is_not_widened(comparison: Any) -> None:
    judged = compare(number(2.0, error=1e-9, inherited=1e-9), 2.0, comparison)
    assert judged.verdict == "not-gradable"
    assert judged.correct is None
    assert judged.tolerance is not None
    assert judged.tolerance < 2e-9


def test_nothing_can_be_graded_where_nothing_is_known() -> None:
    assert compare(number(2.0, inherited=None), 2.0).verdict == "not-gradable"


def test_a_figure_near_a_constant_is_judged_by_its_difference_from_it() -> None:
    ratio = number(1.00232829, sensitive="a/c - 1", offset=1.0)
    judged = compare(ratio, 1.00116)
    assert judged.verdict == "incorrect"
    assert judged.sensitive_error == pytest.approx(0.50178, rel=1e-4)
    assert compare(ratio, 1.00233).verdict == "correct"
    # A comparison that is given is applied as it stands, and the sensitive error is stated.
    assert compare(ratio, 1.00116, RelAbs()).verdict == "correct"
    assert compare(ratio, 1.00116, RelAbs()).sensitive_error == judged.sensitive_error


@given(angle=st.floats(-50, 50), turns=st.integers(-5, 5))
def test_angles_are_equal_modulo_turns(angle: float, turns: int) -> None:
    reference = Reference(angle, "rad", "angle", 1.0)
    assert distance(reference, angle + turns * 2 * math.pi) < 1e-12
    assert distance(reference, angle + math.pi) == pytest.approx(math.pi)


@given(q=unit_quaternion, size=st.floats(0.1, 10), sign=st.sampled_from([1.0, -1.0]))
def test_a_quaternion_of_any_length_and_sign_is_one_attitude(q: list[float], size: float, sign: float) -> None:
    right = np.array(q) / np.linalg.norm(q)
    assert distance(Reference(right, form="attitude"), sign * size * right) < 1e-15


@given(q=unit_quaternion, angle=st.floats(1e-6, math.pi))
def test_attitudes_are_apart_by_the_angle_between_them(q: list[float], angle: float) -> None:
    w, x, y, z = np.array(q) / np.linalg.norm(q)
    c, s = math.cos(angle / 2), math.sin(angle / 2)
    # The product with a turn about z, written out.
    turned = np.array([c * w - s * z, c * x + s * y, c * y - s * x, c * z + s * w])
    assert distance(Reference(np.array([w, x, y, z]), form="attitude"), turned) == pytest.approx(angle, rel=1e-9)


@given(
    axis=st.lists(st.floats(-1, 1), min_size=3, max_size=3),
    angle=st.floats(0, 6),
    signs=st.tuples(*[st.booleans()] * 3),
)
def test_principal_axes_are_known_up_to_sign(axis: list[float], angle: float, signs: tuple[bool, ...]) -> None:
    assume(np.linalg.norm(axis) > 0.1)
    right = turn(axis, angle)
    reference = Reference(right, form="axes", groups=((0,), (1,), (2,)))
    # The nine entries of the turn are rounded, so that it is orthonormal to some units of the last place.
    assert distance(reference, right * np.where(signs, 1.0, -1.0)) < 16 * np.finfo(float).eps
    assert distance(reference, right[:, [1, 0, 2]]) > 0.4


@given(angle=st.floats(0.1, 1.5))
def test_axes_of_equal_moments_are_known_up_to_rotation(angle: float) -> None:
    right = turn([1, 2, 3], 1.0)
    turned = right @ turn([0, 0, 1], angle)
    assert distance(Reference(right, form="axes", groups=((0, 1), (2,))), turned) < 1e-15
    assert distance(Reference(right, form="axes", groups=((0,), (1,), (2,))), turned) > 1e-3


@settings(derandomize=True)
@given(members=st.lists(st.tuples(ordinary, ordinary), min_size=1, max_size=5), data=st.data())
def test_sets_have_no_order(members: list[tuple[float, float]], data: Any) -> None:
    reference = Reference(np.array(members), form="set")
    order = data.draw(st.permutations(range(len(members))))
    assert distance(reference, np.array(members)[order]) == 0.0


def test_sets_are_paired_in_the_best_way() -> None:
    # Sorting would pair 1 with 0.9 and 1.1 with 3.
    assert distance(Reference(np.array([1.0, 1.1, 3.0]), form="set"), np.array([3.1, 1.1, 1.05])) == pytest.approx(0.1)


def test_directions_are_known_up_to_sign_and_length() -> None:
    reference = Reference(np.array([0.6, 0.0, 0.8]), form="direction", scale=1.0)
    assert distance(reference, np.array([-3.0, 0.0, -4.0])) < 1e-15
    assert distance(reference, np.array([0.8, 0.0, 0.6])) == pytest.approx(0.2)


def test_samples_are_as_wrong_as_the_worst_of_them() -> None:
    right = np.zeros((3, 3))
    wrong = right.copy()
    wrong[1] = [3.0, 4.0, 0.0]
    assert distance(Reference(right, form="samples", scale=1.0), wrong) == 5.0


@pytest.mark.parametrize(("right", "wrong"), [(True, False), ("center", "saddle")])
def test_choices_are_equal_or_not(right: Any, wrong: Any) -> None:
    assert compare(Reference(right, form="choice"), right).verdict == "correct"
    assert compare(Reference(right, form="choice"), wrong).verdict == "incorrect"


def test_a_figure_that_does_not_exist_is_claimed_by_null() -> None:
    assert compare(Reference(None, form="none"), None).verdict == "correct"
    assert compare(Reference(None, form="none"), 3.0).verdict == "incorrect"
    assert compare(number(3.0), None).verdict == "incorrect"


def test_limits_decide_whatever_the_distance() -> None:
    assert compare(number(2.0), 2.9, Interval(1.0, 3.0)).verdict == "correct"
    assert compare(number(2.0), 3.1, Interval(1.0, 3.0)).verdict == "incorrect"
    # Limits that exclude what is right are the course's mistake, not the student's.
    assert compare(number(2.0), 2.5, Interval(2.1, 3.0)).verdict == "not-gradable"
    # So are those that may exclude it, for all that is known.
    for limits in (Interval(1.95, 3.0), Interval(1.0, 2.05)):
        assert compare(number(2.0, inherited=0.1), 2.0, limits).verdict == "not-gradable"


@pytest.mark.parametrize(
    ("reference", "value"),
    [
        (number(1.0), np.zeros(3)),
        (number(1.0), "one"),
        (number(1.0), True),
        (Reference(np.ones(3), form="vector"), np.ones(4)),
        (Reference(np.ones(3), form="vector"), 1.0),
        (Reference(np.ones(3), form="direction"), np.zeros(3)),
        (Reference(np.ones(4), form="attitude"), np.zeros(4)),
        (Reference(np.eye(3), form="axes"), np.zeros((3, 3))),
        (Reference(np.zeros(9), form="set"), np.zeros(9)),
        (Reference(True, form="choice"), "yes"),
        (Reference("center", form="choice"), 1.0),
    ],
)
def test_values_of_another_form_are_refused(reference: Reference, value: Any) -> None:
    with pytest.raises(InvalidParameter) as fault:
        compare(reference, value)
    assert fault.value.rule


@given(right=st.floats(allow_nan=False, allow_infinity=False), value=st.floats(allow_nan=False, allow_infinity=False))
def test_no_error_is_infinite(right: float, value: float) -> None:
    judged = compare(Reference(right, scale=abs(right)), value)
    for figure in (judged.absolute, judged.relative, judged.in_tolerances, judged.tolerance):
        assert figure is None or math.isfinite(figure)


@pytest.mark.parametrize("size", [1e-200, 1e-160, 1.0, 1e160, 1e200])
def test_samples_are_as_wrong_at_any_magnitude(size: float) -> None:
    right = size * np.array([[1.0, 2.0, 2.0], [2.0, 1.0, -2.0]])
    reference = Reference(right, "rad s^-1", "samples", 3.0 * size)
    found = compare(reference, right + size * np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.4]]))
    assert found.verdict == "incorrect"
    assert found.absolute == pytest.approx(0.5 * size)
