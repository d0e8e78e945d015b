"""Variants of a question, on one whose answer and whose conditions are known by hand: a pendulum of small amplitude."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

from core.assessment.graded_question import GradedQuestion
from core.assessment.variants import Constraint, Variants
from core.assessment.varied_input import VariedInput
from core.errors import InvalidParameter, NotApplicable, Path
from core.notices import Notice

REQUEST = {"length": 1, "gravity": 9.81, "lengths": [1.0, 2.0]}


class Pendulum:
    """Period 2 pi sqrt(l/g), the difference of two lengths, and the frequency, which long pendulums lack."""

    subject = "pendulum"
    outputs: frozenset[str] = frozenset()

    def answer(self, request: str) -> Mapping[str, Any]:
        given = json.loads(request)
        if given["length"] > 8.0:
            raise NotApplicable("too long")
        period = 2.0 * pi * sqrt(given["length"] / given["gravity"])
        frequency = 1.0 / period if given["length"] <= 4.0 else None
        one, other = given["lengths"]
        warnings = [Notice("heavy", "gravity is large")] if given["gravity"] > 10.0 else []
        figures = {"period": period, "frequency": frequency, "difference": other - one, "lengths": given["lengths"]}
        return figures | {"force": {"value": 1.0, "unit": "N", "parts": [1.0]}, "warnings": warnings}

    def errors(self, request: Any) -> None:
        return None

    def certified(self, request: Any) -> None:
        return None

    def takes(self, field: str) -> bool:
        return False

    def unit_of_answer(self, path: Path) -> str | None:
        return "s"

    def units_of_request(self, request: Any) -> Callable[[Path], str | None]:
        return lambda path: "m"

    def scales(self, answer: Mapping[str, Any], request: Any) -> Mapping[str, float]:
        return {}

    def rotation(self, request: Any) -> None:
        return None


def variants(vary: dict[Path, VariedInput], figures: tuple[str, ...] = ("period",), **more: Any) -> Variants:
    def ask(request: Any) -> GradedQuestion:
        return GradedQuestion(Pendulum(), request, more.get("uncertainty"))

    constraints = more.get("constraints", {})
    return Variants(
        REQUEST,
        vary,
        more.get("together", {}),
        ask,
        {name: (name,) for name in figures},
        constraints,
        {name: (name,) for name in constraints},
        more.get("max_condition"),
        more.get("uncertainty"),
        more.get("most_draws", 100),
        more.get("warnings", frozenset()),
    )


LENGTH = {("length",): VariedInput(min=0.5, max=4.0)}


def test_the_first_members_do_not_depend_on_the_count() -> None:
    few, many = variants(LENGTH).members(5, 3), variants(LENGTH).members(5, 10)
    assert [one.request for one in few] == [one.request for one in many[:3]]
    assert variants(LENGTH).members(6, 1)[0].request != few[0].request


def test_the_order_of_what_varies_does_not_matter() -> None:
    both = {**LENGTH, ("gravity",): VariedInput(min=1.0, max=10.0)}
    swapped = dict(reversed(both.items()))
    assert [one.request for one in variants(both).members(1, 5)] == [
        one.request for one in variants(swapped).members(1, 5)
    ]


def test_references_are_those_of_the_drawn_question() -> None:
    for member in variants(LENGTH).members(0, 20):
        right = 2.0 * pi * sqrt(member.request["length"] / 9.81)
        assert member.references["period"].value == right
        # The period goes with the square roots of length and gravity: two halves.
        assert member.conditions["period"] == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("uncertainty", [None, 1e-3])
def test_ill_conditioned_members_are_rejected(uncertainty: float | None) -> None:
    vary = {("lengths", 0): VariedInput(min=1.0, max=1.99)}
    found = variants(vary, ("difference",), max_condition=10.0, uncertainty=uncertainty)
    for member in found.members(3, 30):
        one, other = member.request["lengths"]
        # Of a difference: the sum of the magnitudes over the magnitude of the difference.
        assert member.conditions["difference"] == pytest.approx((one + other) / (other - one), rel=1e-6)
        assert member.conditions["difference"] <= 10.0
    assert found.rejected.keys() == {"condition"}


def test_refused_and_absent_draws_are_counted_apart() -> None:
    found = variants({("length",): VariedInput(min=1.0, max=16.0)}, ("frequency",))
    members = found.members(1, 30)
    assert all(member.request["length"] <= 4.0 for member in members)
    assert found.rejected.keys() == {"refused", "absent"}
    assert sum(found.rejected.values()) == sum(member.draws - 1 for member in members)


def test_members_have_no_warnings_of_another_kind() -> None:
    vary = {("gravity",): VariedInput(min=1.0, max=20.0)}
    found = variants(vary)
    assert all(member.request["gravity"] <= 10.0 for member in found.members(0, 20))
    assert found.rejected.keys() == {"warned"}
    found = variants(vary, warnings=frozenset({"heavy"}))
    assert any(member.request["gravity"] > 10.0 for member in found.members(0, 20))
    assert not found.rejected


def test_members_differ() -> None:
    vary = {("length",): VariedInput(values=(1.0, 2.0, 3.0))}
    found = variants(vary)
    assert sorted(member.request["length"] for member in found.members(0, 3)) == [1, 2, 3]
    assert set(found.rejected) <= {"repeated"}
    with pytest.raises(InvalidParameter, match=r"member 3 met them in none: repeated \(100\)"):
        variants(vary).members(0, 4)


def test_constraints_hold_in_every_member() -> None:
    bounds = Constraint(min=2.0, max=3.0, digits=2, within=2e-3, apart=0.02)
    found = variants(LENGTH, constraints={"period": bounds}, most_draws=1000).members(0, 5)
    periods = [member.references["period"].value for member in found]
    assert all(2.0 <= period <= 3.0 for period in periods)
    assert all(abs(period - round(period, 1)) <= 2e-3 * period for period in periods)
    assert all(abs(a - b) >= 0.02 * max(a, b) for i, a in enumerate(periods) for b in periods[:i])


def test_constraints_hold_for_every_entry_of_an_array() -> None:
    vary = {("lengths", 0): VariedInput(min=0.0, max=4.0)}
    found = variants(vary, ("lengths",), constraints={"lengths": Constraint(min=1.0, max=3.0)}).members(0, 10)
    assert all(1.0 <= member.request["lengths"][0] <= 3.0 for member in found)


def test_what_cannot_be_met_ends_after_the_stated_number_of_draws() -> None:
    found = variants(LENGTH, constraints={"period": Constraint(min=1e9)}, most_draws=17)
    with pytest.raises(InvalidParameter, match=r"17 draws; member 0 met them in none: period \(17\)") as caught:
        found.members(0, 1)
    assert caught.value.path == ("constraints",)


def test_numbers_that_move_together_are_equal() -> None:
    together = {("lengths", 0): [("lengths", 1), ("gravity",)]}
    found = variants({("lengths", 0): VariedInput(min=1.0, max=2.0)}, together=together)
    for member in found.members(0, 5):
        assert member.request["lengths"][0] == member.request["lengths"][1] == member.request["gravity"]


def test_whole_numbers_replace_integers_as_integers() -> None:
    (member,) = variants({("length",): VariedInput(min=1.0, max=3.0, step=1.0)}).members(0, 1)
    assert type(member.request["length"]) is int
    (member,) = variants({("gravity",): VariedInput(min=1.0, max=3.0, step=1.0)}).members(0, 1)
    assert type(member.request["gravity"]) is float


def test_a_constraint_requires_something() -> None:
    with pytest.raises(InvalidParameter, match="be given"):
        Constraint()
    with pytest.raises(InvalidParameter, match="at least min"):
        Constraint(min=2.0, max=1.0)


def test_arrays_of_other_shapes_are_apart() -> None:
    assert Constraint(apart=0.5).allows(np.zeros(2), [np.zeros(3)])
    assert not Constraint(apart=0.5).allows(np.zeros(2), [np.zeros(2)])
