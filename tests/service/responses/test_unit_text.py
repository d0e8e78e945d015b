"""Units are written with a bar, and keep their meaning."""

from __future__ import annotations

import pytest

from core.assessment.units import base_powers
from service.responses.unit_text import unit_text


@pytest.mark.parametrize(
    ("declared", "drawn"),
    [
        ("rad s^-1", "rad/s"),
        ("rad/s", "rad/s"),
        ("m s^-2", "m/s^2"),
        ("s^-1", "1/s"),
        ("kg m^2 s^-1", "kg m^2/s"),
        ("kg m^-1 s^-2", "kg/(m s^2)"),
        ("kg m^2", "kg m^2"),
        ("1", "1"),
    ],
)
def test_what_divides_stands_behind_a_bar(declared: str, drawn: str) -> None:
    assert unit_text(declared) == drawn
    # A unit is read without brackets: what they hold divides one after another.
    assert base_powers(drawn.replace("(m s^2)", "m/s^2")) == base_powers(declared)
