"""Names that nothing has yet."""

from __future__ import annotations

import pytest

from core.multibody.formulation.unused_names import unused


@pytest.mark.parametrize(
    ("taken", "alone", "numbered"),
    [
        (set(), "x", "x1"),
        ({"x"}, "x2", "x1"),
        ({"x1"}, "x", "x2"),
        ({"x", "x1", "x2", "x4"}, "x3", "x3"),
    ],
)
def test_names_are_the_first_that_nothing_has(taken: set[str], alone: str, numbered: str) -> None:
    assert unused("x", taken) == alone
    assert unused("x", taken, first="1") == numbered
