"""The numbers that may be cited, against mpmath, which shares no code with the service.

References
----------
L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed., section 37: period and components of a free
asymmetrical top.
"""

from __future__ import annotations

import re
from pathlib import Path

import mpmath
from mpmath import mpf, sqrt

PAGE = Path(__file__).parents[2] / "docs" / "numbers.md"
SHOWN = re.findall(r"\| (-?\d+\.\d{20,}) (?:s|rad/s) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)

MOMENTS, START = (3, 2, 1), ("0.1", "2", "0.1")
"""Of the asymmetrical top."""


def top(time: int) -> list[mpmath.mpf]:
    """Return the period of the top and its angular velocity at a time, which circles the axis of the largest moment."""
    c, b, a = map(mpf, MOMENTS)
    z, y, x = map(mpf, START)
    double = a * x**2 + b * y**2 + c * z**2
    square = (a * x) ** 2 + (b * y) ** 2 + (c * z) ** 2
    assert square > b * double
    scale, rest = (c - b) * (square - double * a), double * c - square
    m, rate = (b - a) * rest / scale, sqrt(scale / (a * b * c))
    middle = sqrt(rest / (b * (c - b)))
    # In the order of the page the axes are left-handed, and time runs backwards.
    u = mpmath.ellipf(mpmath.asin(y / middle), m) - rate * time
    sn, cn, dn = (mpmath.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn"))
    largest, smallest = sqrt((square - double * a) / (c * (c - a))), sqrt(rest / (a * (c - a)))
    return [4 * mpmath.ellipk(m) / rate, largest * dn, middle * sn, smallest * cn]


def test_every_digit_of_the_page_is_right() -> None:
    with mpmath.workdps(36):
        depth = sqrt(mpf(3)) / 2
        rod = sqrt(2 * mpf("9.81") * depth * (1 - mpf(1) / 2) / (1 - mpf(1) / 6))
        period, *rates = top(10)
        right = [period, period / 2, *rates, sqrt(mpf(6)), rod]
        assert len(SHOWN) == len(right)
        for shown, value in zip(SHOWN, right, strict=True):
            unit = mpf(10) ** -len(shown.partition(".")[2])
            assert abs(mpf(shown) - value) <= unit, shown
