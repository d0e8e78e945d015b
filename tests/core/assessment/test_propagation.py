"""Propagated uncertainty, against derivatives worked out by hand."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.assessment.compare import Reference
from core.assessment.propagation import (
    HALF_ULP,
    MOST_CHANGED_NUMBERS,
    Propagation,
    changed,
    numbers_of,
    relative_uncertainties,
)
from core.errors import InvalidParameter, Path


def asking(function: Callable[[Any], Any]) -> Callable[[Any], Callable[[Path], Any]]:
    return lambda request: lambda path: function(request)


def inherited(function: Callable[[Any], Any], request: Any, given_: Any) -> float | None:
    reference = Reference(function(request))
    return Propagation(request, relative_uncertainties(request, given_), asking(function)).of(("x",), reference)


@settings(deadline=None)
@given(g=st.floats(1, 20), k=st.floats(0.1, 10), share=st.floats(1e-6, 1e-2))
def test_shares_of_a_root_of_a_product_are_halves(g: float, k: float, share: float) -> None:
    found = inherited(lambda r: sqrt(r["g"] * r["k"]), {"g": g, "k": k}, share)
    # (sqrt(1 - u) is farther away than sqrt(1 + u), to second order.)
    assert found == pytest.approx(2 * (1 - sqrt(1 - share)) * sqrt(g * k), rel=1e-9)


def test_single_numbers_may_be_uncertain() -> None:
    request = {"gravity": 9.81, "slopes": [0.5, 0.9]}
    found = inherited(lambda r: r["gravity"] * r["slopes"][0], request, {("gravity",): 1e-3})
    assert found == pytest.approx(9.81 * 0.5 * 1e-3, rel=1e-9)
    found = inherited(lambda r: sum(r["slopes"]), request, {("slopes",): 1e-3})
    assert found == pytest.approx(1.4e-3, rel=1e-9)
    with pytest.raises(InvalidParameter):
        relative_uncertainties(request, {("mass",): 1e-3})


def test_half_a_unit_in_the_last_place_is_seen_beyond_rounding() -> None:
    # 1/(a - b) with a and b nearly equal: 2e6 half units each.
    found = inherited(lambda r: 1.0 / (r["a"] - r["b"]), {"a": 1.000001, "b": 1.0}, None)
    assert found == pytest.approx(2e12 * HALF_ULP, rel=0.2)


def test_numbers_that_have_to_be_equal_are_changed_together() -> None:
    def symmetric(request: Any) -> float | None:
        a, b, c = request["moments"]
        return (c - a) / a if a == b else None

    # (c - a)/a: c/a relative, from c and from a = b.
    assert inherited(symmetric, {"moments": [1.0, 1.0, 2.0]}, 1e-6) == pytest.approx(4e-6, rel=1e-4)


def test_what_cannot_be_requested_is_not_known() -> None:
    assert Propagation({"a": 1.0}, {("a",): 1e-3}, asking(lambda r: None)).of(("x",), Reference(1.0)) is None


def test_many_numbers_are_changed_together_by_random_signs() -> None:
    request = {"masses": [1.0] * (2 * MOST_CHANGED_NUMBERS)}
    found = inherited(lambda r: sum(r["masses"]), request, 1e-3)
    worst, typical = 2 * MOST_CHANGED_NUMBERS * 1e-3, sqrt(2 * MOST_CHANGED_NUMBERS) * 1e-3
    assert found is not None
    assert typical < found < worst


def test_settings_and_zeros_are_no_uncertain_data() -> None:
    request = {"times": [1.0], "accuracy": 1e-3, "body": {"moments": [1, 0.0, True], "kind": "x"}, "round": 4}
    assert dict(numbers_of(request)) == {("body", "moments", 0): 1.0}
    # Where the question is answered, a number that no double is near is refused.
    assert dict(numbers_of({"mass": 10**400, "length": 2})) == {("length",): 2.0}


def test_a_request_is_copied_before_it_is_changed() -> None:
    request = {"a": [1.0, {"b": 2.0}]}
    assert changed(request, {("a", 1, "b"): 5.0}) == {"a": [1.0, {"b": 5.0}]}
    assert request == {"a": [1.0, {"b": 2.0}]}
