"""Varied inputs: their numbers are those that variants draw, and what contradicts itself is refused."""

from __future__ import annotations

from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtri

from core.assessment.varied_input import VariedInput
from core.errors import InvalidParameter
from core.studies.study_input import StudyInput

CHANCES = np.append(np.random.default_rng(3).random(200), [0.0, 1.0 - 2.0**-53])


@pytest.mark.parametrize(
    "settings_",
    [
        {"min": 1.0, "max": 2.0},
        {"min": -1e308, "max": 1e308},
        {"min": 1e-3, "max": 1e9, "distribution": "log-uniform"},
        {"min": 0.0, "max": 1.0, "step": 0.1},
        {"min": 1.0, "max": 50.0, "digits": 2, "distribution": "log-uniform"},
    ],
)
def test_numbers_are_those_that_a_variant_draws_to_the_bit(settings_: Any) -> None:
    numbers = StudyInput(pointer="/a", **settings_).numbers(CHANCES)
    assert numbers.tolist() == [VariedInput(**settings_).draw(chance) for chance in CHANCES.tolist()]


def test_values_are_drawn_as_a_variant_draws_them() -> None:
    entry = StudyInput(pointer="/a", values=(3.0, 4.0, 5.0))
    drawn = [entry.value(number) for number in entry.numbers(CHANCES).tolist()]
    assert drawn == [VariedInput(values=(3.0, 4.0, 5.0)).draw(chance) for chance in CHANCES.tolist()]


@given(st.floats(2.0**-53, 1.0 - 2.0**-53), st.floats(-1e3, 1e3), st.floats(1e-3, 1e3))
@settings(deadline=None)
def test_normal_numbers_are_quantiles(chance: float, mean: float, deviation: float) -> None:
    """Against Cephes' inverse in SciPy; that of the standard library is Wichura's AS 241."""
    entry = StudyInput(pointer="/a", distribution="normal", mean=mean, deviation=deviation)
    expected = mean + deviation * float(ndtri(chance))
    assert entry.numbers(np.array([chance]))[0] == pytest.approx(expected, rel=1e-12, abs=1e-12 * deviation)


def test_a_chance_of_zero_has_a_normal_number() -> None:
    entry = StudyInput(pointer="/a", distribution="normal", mean=0.0, deviation=1.0)
    assert -8.5 < entry.numbers(np.array([0.0]))[0] < -8.0


def test_levels_include_both_ends_of_a_range() -> None:
    entry = StudyInput(pointer="/a", min=0.1, max=0.7, count=4)
    levels = entry.numbers(entry.chances_of_levels(np.arange(4)))
    assert levels[[0, -1]].tolist() == [0.1, 0.7]
    assert levels == pytest.approx([0.1, 0.3, 0.5, 0.7])
    decades = StudyInput(pointer="/a", min=1.0, max=1000.0, count=4, distribution="log-uniform")
    assert decades.numbers(decades.chances_of_levels(np.arange(4))) == pytest.approx([1.0, 10.0, 100.0, 1000.0])


def test_levels_of_a_normal_distribution_are_its_quantiles() -> None:
    entry = StudyInput(pointer="/a", distribution="normal", mean=5.0, deviation=2.0, count=3)
    expected = [NormalDist(5.0, 2.0).inv_cdf(p) for p in (1 / 6, 3 / 6, 5 / 6)]
    assert entry.numbers(entry.chances_of_levels(np.arange(3))) == pytest.approx(expected)


def test_values_may_be_anything() -> None:
    entry = StudyInput(pointer="/method", values=({"kind": "a"}, None, "b", 2))
    numbers = entry.numbers(entry.chances_of_levels(np.arange(4)))
    assert [entry.value(number) for number in numbers.tolist()] == [{"kind": "a"}, None, "b", 2]


@pytest.mark.parametrize(
    ("given_", "path"),
    [
        ({"pointer": "a", "min": 0.0, "max": 1.0}, ("pointer",)),
        ({"min": 0.0, "max": 1.0}, ("pointer",)),
        ({"pointer": "/a"}, ("min",)),
        ({"pointer": "/a", "min": 1.0, "max": 1.0}, ("max",)),
        ({"pointer": "/a", "min": 0.0, "max": 1.0, "mean": 2.0}, ("mean",)),
        ({"pointer": "/a", "distribution": "normal", "mean": 2.0}, ("deviation",)),
        ({"pointer": "/a", "distribution": "normal", "mean": 2.0, "deviation": 1.0, "min": 0.0}, ("min",)),
        ({"pointer": "/a", "distribution": "normal", "mean": 2.0, "deviation": 0.0}, ("deviation",)),
        ({"pointer": "/a", "distribution": "normal", "mean": 1e308, "deviation": 1e307}, ("deviation",)),
        ({"pointer": "/a", "values": ()}, ("values",)),
        ({"pointer": "/a", "values": (1.0, 10**400)}, ("values", 1)),
        ({"pointer": "/a", "values": ({"b": [0.0, [float("inf")]]},)}, ("values", 0)),
        ({"pointer": "/a", "values": (float("nan"),)}, ("values", 0)),
        ({"pointer": "/a", "values": (1.0,), "count": 3}, ("count",)),
        ({"pointer": "/a", "values": (1.0,), "also": ("/b",) * 21}, ("also",)),
    ],
)
def test_contradictions_are_refused_where_they_are(given_: Any, path: Any) -> None:
    with pytest.raises(InvalidParameter) as fault:
        StudyInput(**given_)
    assert fault.value.path == path
