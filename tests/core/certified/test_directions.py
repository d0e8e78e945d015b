"""The sense of an axis that has none of its own."""

from __future__ import annotations

import pytest
from flint import arb
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.balls import Undetermined, precision
from core.certified.directions import TIE_BITS, floor_of_directions, oriented
from core.digits.decimals import FLOOR_IN_DIGITS
from tests.drawn import draws

component = st.integers(-5, 5)


def balls(vector) -> tuple[arb, arb, arb]:
    return tuple(arb(x) for x in vector)


@settings(deadline=None, derandomize=True, max_examples=draws(300))
@given(st.tuples(component, component, component))
def test_the_nearest_body_axis_decides_and_of_equal_ones_the_first(vector) -> None:
    assume(any(vector))
    with precision(TIE_BITS):
        found = [int(float(x)) for x in oriented(balls(vector))]
        opposite = [int(float(x)) for x in oriented(balls([-x for x in vector]))]
    assert found == opposite
    assert found in (list(vector), [-x for x in vector])
    sizes = [abs(x) for x in vector]
    assert found[sizes.index(max(sizes))] > 0


def test_more_bits_distinguish_a_tie_from_a_difference() -> None:
    tie = arb("0.5 +/- 1e-30"), arb("-0.5 +/- 1e-30"), arb(0)
    with precision(64), pytest.raises(Undetermined):
        oriented(tie)
    # With all the bits that there are, what does not differ is taken as equal, and the first axis counts.
    with precision(TIE_BITS):
        assert float(oriented(tie)[0]) == 0.5
    with precision(64):
        assert float(oriented((arb("0.5 +/- 1e-30"), arb("-0.6 +/- 1e-30"), arb(0)))[1]) == pytest.approx(0.6)


@pytest.mark.parametrize("radius", [1, 0.1])
def test_a_sign_in_doubt_is_left_open(radius: float) -> None:
    with precision(TIE_BITS), pytest.raises(Undetermined):
        oriented((arb(0, radius), arb(0), arb(0)))


def test_the_floor_of_a_unit_vector_is_a_multiple_of_the_digits() -> None:
    assert floor_of_directions(16) == -16 * FLOOR_IN_DIGITS
