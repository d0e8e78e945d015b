import pytest
from flint import arb, ctx

from core.balls import Undetermined
from core.digits.adaptive_precision import (
    MOST_BITS,
    bits_for,
    check_digits,
    each_determined,
    until_determined,
    working_bits,
)
from core.digits.decimals import decimal
from core.errors import BudgetExceeded, InvalidParameter


@pytest.mark.parametrize("digits", [15, 1001, 0, -20, 20.0, "20", True, None])
def test_digits_are_sixteen_to_a_thousand(digits):
    with pytest.raises(InvalidParameter) as caught:
        check_digits(digits)
    assert caught.value.path == ("digits",)


def test_printing_is_counted():
    assert check_digits(1000, 3000) == 1000
    with pytest.raises(BudgetExceeded) as caught:
        check_digits(1000, 3001)
    assert (caught.value.needed, caught.value.limit) == (3_001_000, 3_000_000)


def test_precision_is_raised_until_a_cancellation_is_overcome():
    def small() -> str:
        return decimal((1 + arb(10) ** -200) ** 2 - 1 - 2 * arb(10) ** -200, 20)

    before = ctx.prec
    assert until_determined(small, bits_for(20)) == "1.0000000000000000000e-400"
    assert ctx.prec == before


def test_a_hidden_zero_is_refused_with_the_limit():
    with pytest.raises(BudgetExceeded) as caught:
        until_determined(lambda: decimal(arb(2).sqrt() ** 2 - 2, 20), bits_for(20))
    assert caught.value.limit == MOST_BITS


def test_only_what_is_in_doubt_is_evaluated_again():
    asked: list[tuple[int, int]] = []

    def set_up():
        def one(i: int) -> str:
            asked.append((i, working_bits()))
            return decimal((1 + arb(10) ** -(10 * i)) - 1, 16)

        return one

    found = each_determined(set_up, 10, 128)
    assert [float(x) for x in found] == [float(f"1e-{10 * i}") for i in range(10)]
    assert [i for i, bits in asked if bits == 128] == list(range(10))
    later = [i for i, bits in asked if bits > 128]
    assert later
    # 128 bits are 38 digits: the 16 that are printed, two to spare, and 20 that cancel.
    assert min(later) == 3


def test_a_set_up_in_doubt_is_raised_too():
    def set_up():
        if working_bits() < 1000:
            raise Undetermined
        return lambda i: i

    assert each_determined(set_up, 3, 100) == [0, 1, 2]
