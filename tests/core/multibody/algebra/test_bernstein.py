"""Signs of polynomials with a band of error, against exact isolation of their roots by python-flint."""

from __future__ import annotations

import numpy as np
import pytest
from flint import fmpq, fmpz_poly

from core.arrays import Floats
from core.multibody.algebra.bernstein import MOST_SEGMENTS, Sign, decided, zero_between

ORDER = 20
GRIDS = (4099, 4099, 4099, 4096)
"""Planted roots are whole multiples of an inverse, so that coefficients are exact as pairs; some where halves meet."""
BANDS = (0.0, 2.0**-90, 2.0**-60, 2.0**-40)


def planted(random: np.random.Generator) -> fmpz_poly:
    """Return a polynomial with single, double, nearly double and clustered roots, inside of [0, 1] and outside."""
    roots: list[int] = []
    grid = int(random.choice(GRIDS))
    while len(roots) < 6:
        at = int(random.integers(-grid // 4, grid + grid // 4))
        kind = random.integers(4)
        roots += ([at], [at, at], [at, at + 1], [at, at + 1, at + 2])[kind]
    total = fmpz_poly([int(random.choice([-1, 1]))])
    for root in roots[:6]:
        total *= fmpz_poly([-root, grid])
    # A factor without real roots: (a t - b)^2 + c.
    a, b, c = (int(x) for x in random.integers(1, 20, 3))
    return total * fmpz_poly([b * b + c, -2 * a * b, a * a])


def coefficients(exact: fmpz_poly) -> Floats:
    found = np.zeros((ORDER + 1, 2))
    for k, x in enumerate(exact.coeffs()):
        high = float(int(x))
        low = float(int(x) - int(high))
        assert int(high) + int(low) == int(x)
        found[k] = high, low
    return found


def segments(values: Floats, band: Floats, left_out: float = 0.0) -> list[tuple[float, float, Sign]]:
    ends, signs = np.empty(MOST_SEGMENTS), np.empty(MOST_SEGMENTS, dtype=np.int64)
    count = decided(values, band, left_out, ORDER + 1, 1.0, ends, signs, False)
    starts = [0.0, *ends[: count - 1]]
    return [(a, b, Sign(s)) for a, b, s in zip(starts, ends[:count], signs[:count], strict=True)]


def exactly(exact: fmpz_poly, time: float) -> fmpq:
    p, q = time.as_integer_ratio()
    total, at = fmpq(0), fmpq(p, q)
    for x in reversed(exact.coeffs()):
        total = total * at + fmpq(x)
    return total


def require_right(exact: fmpz_poly, share: float) -> None:
    """Raise `AssertionError` where a segment is not what the exact polynomial is there."""
    values = coefficients(exact)
    band = share * np.abs(values[:, 0])
    most = fmpq(*float(6.0 * (band.sum() + 2.0**-96 * np.abs(values[:, 0]).sum())).as_integer_ratio())
    roots = [
        (float(root.real.mid()), float(root.real.rad()), count)
        for root, count in exact.complex_roots()
        if root.imag.contains(0) and not root.imag > 0
    ]
    found = segments(values, band)
    assert found[-1][1] == 1.0
    for start, end, sign in found:
        inside = sum(n for x, r, n in roots if start + r < x < end - r)
        around = sum(n for x, r, n in roots if start - r <= x <= end + r)
        ends = [exactly(exact, x) for x in (start, end)]
        if sign in (Sign.POSITIVE, Sign.NEGATIVE):
            assert inside == 0
            assert all(int(sign) * x > 0 for x in ends)
        elif sign in (Sign.FALLING, Sign.RISING):
            falls = sign is Sign.FALLING
            assert (ends[0] > 0) == falls
            assert (ends[1] < 0) == falls
            assert inside % 2 == 1 or around % 2 == 1
            zero = zero_between(values, start, end)
            assert min(abs(zero[0] - x) - r for x, r, n in roots if n % 2) <= 1e-9
        else:
            assert sign is Sign.UNDECIDED
            # Beside a zero where halves meet the doubles end before the band does.
            narrow = end - start <= 2.0**-51
            assert narrow or all(abs(exactly(exact, x)) <= most for x in (start, 0.5 * (start + end), end))


@pytest.mark.parametrize("share", BANDS)
def test_signs_of_polynomials_with_planted_roots(share: float) -> None:
    random = np.random.default_rng(20)
    for _ in range(250):
        require_right(planted(random), share)


def test_what_is_left_out_is_left_open_and_nothing_else() -> None:
    """exp(t) - 1.5 up to the twentieth power, with a remainder of 1e-19."""
    values = np.zeros((ORDER + 1, 2))
    factor = 1.0
    for k in range(ORDER + 1):
        values[k, 0] = factor
        factor /= k + 1
    values[0, 0] -= 1.5
    ((start, end, sign),) = segments(values, np.zeros(ORDER + 1), 1e-19)
    assert sign is Sign.RISING
    assert zero_between(values, start, end)[0] == pytest.approx(np.log(1.5), rel=4e-16)
    # A touch that is shallower than what is left out is open; deeper, it is decided.
    touch = np.zeros((ORDER + 1, 2))
    touch[:3, 0] = 0.25 + 1e-12, -1.0, 1.0
    assert Sign.OPEN in {sign for *_, sign in segments(touch, np.zeros(ORDER + 1), 1e-3)}
    assert {sign for *_, sign in segments(touch, np.zeros(ORDER + 1), 1e-14)} == {Sign.POSITIVE}


def test_a_touch_within_the_band_is_undecided_and_a_deeper_one_a_fall() -> None:
    band = np.zeros(ORDER + 1)
    band[0] = 1e-20
    touch = np.zeros((ORDER + 1, 2))
    for depth, expected in (
        (0.5e-20, Sign.UNDECIDED),
        (-0.5e-20, Sign.UNDECIDED),
        (2e-19, Sign.FALLING),
        (-2e-19, None),
    ):
        touch[:3, 0], touch[0, 1] = (0.25, -1.0, 1.0), -depth
        signs = [sign for *_, sign in segments(touch, band)]
        assert signs[0] is Sign.POSITIVE
        assert signs[-1] is Sign.POSITIVE
        assert (expected in signs) if expected is not None else set(signs) == {Sign.POSITIVE}


def test_ten_zeros_within_a_hundredth_of_a_piece() -> None:
    exact = fmpz_poly([1])
    for k in range(10):
        exact *= fmpz_poly([-(510 + k), 1000])
    values = np.zeros((ORDER + 1, 2))
    for k, x in enumerate(exact.coeffs()):
        values[k, 0] = float(int(x))
        values[k, 1] = float(int(x) - int(values[k, 0]))
    crossings = [one for one in segments(values, np.zeros(ORDER + 1)) if one[2] in (Sign.FALLING, Sign.RISING)]
    assert len(crossings) == 10
    # Terms of 1e30, to 2^-104, and slopes of 1e7.
    for k, (start, end, _) in enumerate(crossings):
        assert zero_between(values, start, end)[0] == pytest.approx(0.51 + k / 1000, abs=1e-9)
