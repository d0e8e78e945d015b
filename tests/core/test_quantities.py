"""The checks that every dataclass compiles from its annotations, against a plain reading of the same annotations."""

from __future__ import annotations

import dataclasses
import importlib
import math
import pkgutil
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from numbers import Rational, Real
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import core
from core.errors import InvalidParameter
from core.quantities import Quantity, check
from core.rows import Rows
from tests.drawn import draws

Fault = tuple[tuple[str | int, ...], str]


def marks_in(hint: Any) -> list[Any]:
    """Return every quantity that an annotation mentions, at any depth."""
    own = [mark for mark in getattr(hint, "__metadata__", ()) if isinstance(mark, (Quantity, Rows))]
    return own + [mark for arg in get_args(hint) if arg is not ... for mark in marks_in(arg)]


def carriers() -> list[type]:
    """Return every dataclass of core of which a field carries a quantity."""
    found = {}
    for module in pkgutil.walk_packages(core.__path__, "core."):
        for owner in vars(importlib.import_module(module.name)).values():
            if isinstance(owner, type) and dataclasses.is_dataclass(owner) and owner.__module__.startswith("core."):
                hints = get_type_hints(owner, include_extras=True)
                if any(marks_in(hints[field.name]) for field in dataclasses.fields(owner)):
                    found[f"{owner.__module__}.{owner.__qualname__}"] = owner
    return [found[name] for name in sorted(found)]


CARRIERS = carriers()


def fault_of_number(quantity: Quantity, value: Any) -> str | None:
    """Return the rule that a value breaks, by the definition of `Quantity`, condition by condition."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return "be a number"
    if isinstance(value, Rational) and abs(value) >= 2**1024 - 2**970:
        return "be within the range of doubles"
    if not math.isfinite(value):
        return "be finite"
    unit = "" if quantity.unit == "1" else f" {quantity.unit}"
    number = float(value)
    for broken, rule in (
        (not number > quantity.above, f"be greater than {quantity.above:g}{unit}"),
        (not number >= quantity.at_least, f"be at least {quantity.at_least:g}{unit}"),
        (not number <= quantity.at_most, f"be at most {quantity.at_most:g}{unit}"),
        (not number < quantity.below, f"be less than {quantity.below:g}{unit}"),
    ):
        if broken:
            return rule
    return None


def fault_of_rows(rows: Rows, value: Any) -> Fault | None:
    """Return the first fault of a list of rows: first its form, then its entries' types, then their ranges."""
    if isinstance(value, np.ndarray):
        return None
    if not isinstance(value, (list, tuple)):
        return (), "be a list"
    if not rows.at_least <= len(value) <= rows.at_most:
        return (), f"have from {rows.at_least} to {rows.at_most} entries, not {len(value)}"
    entries: list[tuple[tuple[int, ...], Any]] = []
    for i, row in enumerate(value):
        if rows.width == 0:
            entries.append(((i,), row))
        elif type(row) not in (list, tuple) or len(row) != rows.width:
            return (i,), f"be a list of {rows.width} numbers"
        else:
            entries += [((i, j), entry) for j, entry in enumerate(row)]
    kinds = (int,) if rows.whole else (int, float)
    for place, entry in entries:
        if type(entry) not in kinds:
            return place, "be a whole number" if rows.whole else "be a number"
    for place, entry in entries:
        if type(entry) is int and abs(entry) > (2**63 - 1 if rows.whole else 2**1023):
            return place, f"be within the range of {'64-bit integers' if rows.whole else 'doubles'}"
    for place, entry in entries:
        rule = fault_of_number(rows.quantity, entry)
        if rule is not None:
            return place, rule
    return None


def fault_of(hint: Any, value: Any) -> Fault | None:
    """Return the path and the rule of the first fault of a value, walking the annotation anew."""
    origin, args = get_origin(hint), get_args(hint)
    if origin is Annotated:
        for mark in hint.__metadata__:
            if isinstance(mark, Rows):
                return fault_of_rows(mark, value)
            if isinstance(mark, Quantity):
                rule = fault_of_number(mark, value)
                return None if rule is None else ((), rule)
    elif origin is tuple:
        if not isinstance(value, (tuple, list)):
            return (), "be a list"
        each = [args[0]] * len(value) if args[-1] is ... else list(args)
        if len(each) != len(value):
            return (), f"have {len(each)} entries, not {len(value)}"
        for i, (inner, entry) in enumerate(zip(each, value, strict=True)):
            fault = fault_of(inner, entry)
            if fault is not None:
                return (i, *fault[0]), fault[1]
    elif origin in (Union, UnionType) and NoneType in args and len(args) == 2 and value is not None:
        return fault_of(next(arg for arg in args if arg is not NoneType), value)
    return None


ODD = st.sampled_from(
    [None, True, False, "1", b"1", [], {}, 1j, math.nan, math.inf, -math.inf, 10**400, -(10**400), Decimal("1.5"),
     Fraction(1, 3), Fraction(10) ** 400, np.float64(0.5), np.float32(2.0), np.int64(3), -0.0, 5e-324, 1.7e308]
)  # fmt: skip


def numbers(quantity: Quantity) -> st.SearchStrategy[Any]:
    """Draw numbers inside, outside and at the ends of a range, and things that are none."""
    ends = [float(end) for end in quantity.limits.values()]
    around = [x for end in ends for x in (end, math.nextafter(end, math.inf), math.nextafter(end, -math.inf))]
    return st.one_of(st.floats(-10, 10), st.floats(), st.integers(-5, 5), ODD, st.sampled_from([0.5, *around]))


def good_numbers(quantity: Quantity) -> st.SearchStrategy[float]:
    """Draw doubles inside a range."""
    low = max(quantity.above, quantity.at_least, -100.0)
    return st.floats(low, min(quantity.below, quantity.at_most, low + 100.0)).filter(quantity.test)


def values(hint: Any, good: bool) -> st.SearchStrategy[Any]:
    """Draw values for an annotation: admissible ones, or all sorts."""
    origin, args = get_origin(hint), get_args(hint)
    if origin is Annotated and marks_in(hint):
        (mark,) = [mark for mark in hint.__metadata__ if isinstance(mark, (Quantity, Rows))]
        if isinstance(mark, Quantity):
            return good_numbers(mark) if good else numbers(mark)
        entry = st.integers(0, 9) if mark.whole else good_numbers(mark.quantity)
        if not good:
            entry = st.one_of(entry, st.integers(), ODD)
        row = st.lists(entry, min_size=mark.width, max_size=mark.width) if mark.width else entry
        if not good:
            row = st.one_of(row, row, ODD, st.lists(entry, max_size=4))
        listed = st.lists(row, min_size=mark.at_least if good else 0, max_size=mark.at_least + 3)
        return listed if good else st.one_of(listed, listed, ODD)
    if origin is tuple:
        each = [values(arg, good) for arg in args if arg is not ...]
        exact = st.lists(each[0], max_size=4).map(tuple) if args[-1] is ... else st.tuples(*each)
        if good:
            return exact
        return st.one_of(
            exact, exact, exact.map(list), exact.map(lambda x: x[:-1]), exact.map(lambda x: (*x, 1.0)), ODD
        )
    if origin in (Union, UnionType):
        return st.one_of(*(st.none() if arg is NoneType else values(arg, good) for arg in args))
    return ODD


def unchecked(owner: type, fields: dict[str, Any]) -> Any:
    """Return an instance that nobody has looked at."""
    instance = object.__new__(owner)
    for name, value in fields.items():
        object.__setattr__(instance, name, value)
    return instance


def told(judge: Callable[[], Any]) -> Fault | None:
    """Return the fault that is raised, if any."""
    try:
        judge()
    except InvalidParameter as fault:
        return fault.path, fault.rule
    return None


def test_every_kind_of_carrier_is_found() -> None:
    names = {owner.__name__ for owner in CARRIERS}
    assert {"PrincipalMoments", "InertiaTensor", "Ball", "Part", "Measure", "Flip", "RodInHole"} <= names
    assert len(CARRIERS) >= 25


@pytest.mark.parametrize("owner", CARRIERS, ids=lambda owner: owner.__name__)
@settings(deadline=None, max_examples=30, derandomize=True)
@given(data=st.data())
def test_the_compiled_check_is_the_plain_one(owner: type, data: st.DataObject) -> None:
    hints = get_type_hints(owner, include_extras=True)
    hints = {field.name: hints[field.name] for field in dataclasses.fields(owner)}
    # Mostly one field at fault, so that every field's check is reached.
    spoilt = data.draw(st.sampled_from([None, *hints]))
    fields = {name: data.draw(values(hint, name != spoilt), label=name) for name, hint in hints.items()}
    wanted = None
    for name, hint in hints.items():
        fault = fault_of(hint, fields[name])
        if fault is not None:
            wanted = ((name, *fault[0]), fault[1])
            break
    assert told(lambda: check(unchecked(owner, fields))) == wanted
    if spoilt is None:
        assert wanted is None


@settings(deadline=None, max_examples=draws(400), derandomize=True)
@given(data=st.data())
def test_ranges_are_enforced_at_their_ends(data: st.DataObject) -> None:
    end = st.floats(-5, 5)
    quantity = Quantity(
        data.draw(st.sampled_from(["1", "m"])),
        above=data.draw(st.one_of(st.just(-math.inf), end)),
        at_least=data.draw(st.one_of(st.just(-math.inf), end)),
        at_most=data.draw(st.one_of(st.just(math.inf), end)),
        below=data.draw(st.one_of(st.just(math.inf), end)),
    )
    value = data.draw(numbers(quantity))
    rule = fault_of_number(quantity, value)
    assert told(lambda: quantity.check(("x",), value)) == (None if rule is None else (("x",), rule))
    # The quick test is about doubles alone, and right about those.
    assert quantity.test(value) is (type(value) is float and rule is None)


@settings(deadline=None, max_examples=draws(400), derandomize=True)
@given(data=st.data())
def test_rows_are_read_or_refused_at_their_first_fault(data: st.DataObject) -> None:
    whole = data.draw(st.booleans())
    quantity = Quantity("1", at_least=0.0) if whole else Quantity("m", at_most=50.0)
    rows = Rows(data.draw(st.integers(0, 3)), quantity, at_least=data.draw(st.integers(0, 2)), at_most=4, whole=whole)
    value = data.draw(values(Annotated[Any, rows], data.draw(st.booleans())))
    wanted = fault_of_rows(rows, value)
    assert told(lambda: rows.read((), value)) == wanted
    if wanted is None:
        array = rows.read((), value)
        assert array.shape == ((len(value), rows.width) if rows.width else (len(value),))
        assert array.tolist() == [list(row) if rows.width else row for row in value]
        assert not array.flags.writeable


def test_an_angle_out_of_range_is_reported_to_be_in_radians() -> None:
    slope = Quantity("rad", at_least=0, at_most=math.pi / 2)
    for value in (30.0, -1.0):
        with pytest.raises(InvalidParameter) as caught:
            slope.check(("slope",), value)
        assert caught.value.remedy == "angles are in radians: 30 degrees is 0.5236"
    assert round(math.radians(30), 4) == 0.5236
    with pytest.raises(InvalidParameter) as caught:
        Quantity("m", at_least=0).check(("length",), -1.0)
    assert caught.value.remedy is None
