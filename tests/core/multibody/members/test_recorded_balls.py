"""Balls that record what is done with them: repeated with other numbers it gives the same bits, or is refused."""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb, arb_mat

from core.balls import precision
from core.multibody.algebra.rank import Elimination
from core.multibody.algebra.square_systems import inverse, solved, times_inverse
from core.multibody.equations.packed import exponent, largest_exponent, pair
from core.multibody.members.plan import Template
from core.multibody.members.recorded_balls import NotRecorded, Record, Varied, recording

BITS = 320


def computed(x, y):
    """Some of what a set-up does."""
    sine, cosine = (x / 3).sin_cos()
    first, second = solved([[x, y], [arb(1), cosine]], [sine, x * y - 2])
    third, fourth = times_inverse(inverse([[x, arb(2)], [y, first]]), [second, abs(y) ** 2])
    lines = Elimination()
    lines.add({0: x, 1: third, 2: arb(1)}, fourth)
    lines.add({0: y, 1: sine}, first.max(second))
    return lines.solution(range(3))


def test_the_record_repeats_to_the_bit() -> None:
    with precision(BITS):
        record = Record(2)
        found = computed(*record.begun([arb("1.3"), arb("-0.7")]))
        record.complete = True
        table = Template.of(np.array([[pair(x, 3), (1.0, 0.0)] for x in found], dtype=float), record)
        repeat = record.repeated()
        for numbers in (("1.3", "-0.7"), ("1.31", "-0.72")):
            balls = [arb(x) for x in numbers]
            again = repeat(*balls)
            assert again is not None
            filled = table.filled(np.array([again[0]]))[0]
            assert filled.tolist() == [[list(pair(x, 3)), [1.0, 0.0]] for x in computed(*balls)]


def test_another_decision_is_no_repetition() -> None:
    def decided(x, y):
        return x - y if x > y else y - x

    with precision(BITS):
        record = Record(2)
        decided(*record.begun([arb(2), arb(1)]))
        repeat = record.repeated()
        assert repeat(arb(3), arb(1)) == ((), ())
        assert repeat(arb(1), arb(3)) is None


def test_what_cancels_in_one_member_only_is_another_decision() -> None:
    with precision(BITS):
        record = Record(2)
        x, y = record.begun([arb(2), arb("0.1")])
        assert 0 not in x - 20 * y + arb("0.5")
        repeat = record.repeated()
        assert repeat(arb(2), arb("0.2")) is not None
        assert repeat(arb(2), arb("0.125")) is None


def test_members_are_told_apart_by_exponents() -> None:
    with precision(BITS):
        record = Record(2)
        x, y = record.begun([arb(3), arb(5)])
        assert (exponent(x), largest_exponent([x, y])) == (2, 3)
        repeat = record.repeated()
        assert [repeat(arb(a), arb(5))[1] for a in (2, 3, 1, 9)] == [(2, 3), (2, 3), (1, 3), (4, 4)]


def test_a_number_of_a_member_decides_nothing_as_a_double() -> None:
    """What would be the same for all members otherwise: numbers of the table before its set-up is complete."""
    with precision(BITS):
        record = Record(1)
        (x,) = record.begun([arb(3)])
        high, _ = pair(x, 0)
        with pytest.raises(NotRecorded):
            float(high)
        with pytest.raises(TypeError):
            high + 1.0
        with precision(BITS + 1), pytest.raises(NotRecorded):
            x + 1
        # A double that is decided by is that of one member alone.
        assert float(x) == 3.0
        assert record.repeated()(arb(4)) is None


def test_what_a_stand_in_cannot_do_is_not_recorded_and_other_faults_are_not_hidden() -> None:
    with precision(BITS):
        record = Record(1)
        (x,) = record.begun([arb(3)])
        high, _ = pair(x, 0)
        for doing in (
            lambda: arb_mat([[x]]),
            lambda: x.str(radius=False),
            lambda: high + 1.0,
            lambda: float(Varied()),
            lambda: Varied() < 1.0,
            lambda: np.array([x, 1.0], dtype=float) + high,
        ):
            with pytest.raises(NotRecorded), recording():
                doing()
    for fault in (lambda: len(1.0), lambda: x.no_function_of_balls, lambda: float("three")):
        with pytest.raises((TypeError, AttributeError, ValueError)), recording():
            fault()
