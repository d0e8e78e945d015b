"""Every pass on a table made for it."""

from __future__ import annotations

import re
from dataclasses import fields

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.multibody.algebra.polynomials import BITS, Poly, evaluated
from core.multibody.answer import SceneSolution
from core.multibody.language.scene import Scene
from core.multibody.reduction.passes import reduced
from core.multibody.solve import solve_scene
from core.multibody.table.table import Row, Table
from tests.core.multibody.relations.sources import catalogue
from tests.core.multibody.worked_examples import read

ONE, ZERO = arb(1), arb(0)


def table(values: list[float], units: str, masses: list[float]) -> Table:
    names = {"m": "m", "r": "rad", "1": "1", "s": "s"}
    made = Table()
    for i, (value, unit) in enumerate(zip(values, units, strict=True)):
        made.coordinate(f"b.q{i}", names[unit], arb(value))
    for i, mass in enumerate(masses):
        if mass:
            made.add_mass(i, i, arb(mass))
    return made


def test_linear_measures_give_coordinates_away_and_mass_follows() -> None:
    made = table([1, 2], "mm", [3, 5])
    made.rows.append(Row.held("c", {(1,): ONE, (0,): arb(-2)}))
    small = reduced(made, pinning=False)
    (mass,) = small.table.mass.values()
    # q1 = 2 q0: 3 + 4*5 in terms of q0, a quarter of it in terms of q1.
    assert mass in (23, arb(23) / 4)
    assert small.table.rows == []


def test_rates_in_constant_proportion_are_a_measure() -> None:
    made = table([0.5, 7], "rm", [1, 1])
    made.rows.append(Row("c", None, {0: {(): arb(2)}, 1: {(): ONE}}))
    small = reduced(made, pinning=False)
    assert len(small.table.names) == 1
    whole = [evaluated(expression, small.table.q) for expression in small.expressions]
    assert whole == [0.5, 7]


def test_difference_of_squares_is_the_factor_that_vanishes() -> None:
    made = table([3, -3], "mm", [0, 1])
    made.rows.append(Row.held("c", {(0, 0): ONE, (1, 1): -ONE}))
    small = reduced(made, pinning=False)
    assert "c: a product of which one factor vanishes" in small.steps
    assert len(small.table.names) == 1


def test_two_circles_leave_a_linear_measure() -> None:
    made = table([0.6, 0.8], "mm", [1, 1])
    first: Poly = {(0, 0): ONE, (1, 1): ONE, (): -ONE}
    second: Poly = {(0, 0): ONE, (1, 1): ONE, (0,): arb(-2), (): arb("0.2")}
    with precision(BITS):
        made.q = [arb(6) / 10, arb(8) / 10]
        second[()] = arb(2) / 10
        made.rows += [Row.held("c", first), Row.held("d", second)]
        small = reduced(made, pinning=False)
    assert "d: linear beside other measures" in small.steps
    assert small.table.names == []


def test_repeated_measures_are_dropped() -> None:
    made = table([1, 0], "11", [1, 1])
    circle: Poly = {(0, 0): ONE, (1, 1): ONE, (): -ONE}
    made.rows += [Row.held("c", circle), Row.held("d", {key: 2 * x for key, x in circle.items()})]
    small = reduced(made, pinning=False)
    assert [row.name for row in small.table.rows] == ["c"]


def test_of_measures_that_depend_on_one_another_those_that_determine_the_rest_well_are_left() -> None:
    made = table([1, 1], "11", [1, 1])
    first: Poly = {(0, 0): ONE, (): -ONE}
    second: Poly = {(1, 1): ONE, (): -ONE}
    with precision(BITS):
        nearly = {key: first.get(key, ZERO) + arb("1e-30") * second.get(key, ZERO) for key in (*first, (1, 1))}
        made.rows += [Row.held(name, measure) for name, measure in (("a", first), ("b", nearly), ("c", second))]
        small = reduced(made, pinning=False)
    # From a and b alone, c would follow with weights of 1e30.
    assert next(step.partition(":")[0] for step in small.steps if "follows" in step) in ("a", "b")


def test_what_hangs_straight_is_pinned_for_the_motion_only() -> None:
    made = table([0, -1], "mm", [1, 1])
    made.add_load(1, arb(-10))
    made.rows.append(Row.held("c", {(0, 0): ONE, (1, 1): ONE, (): -ONE}))
    assert reduced(made, pinning=False).pinned == []
    small = reduced(made, pinning=True)
    assert "b.q0" in small.pinned
    assert len(small.table.names) == 0


def test_what_is_pushed_or_moves_is_not_pinned() -> None:
    made = table([0, -1], "mm", [1, 1])
    made.add_load(0, arb("0.001"))
    made.rows.append(Row.held("c", {(0, 0): ONE, (1, 1): ONE, (): -ONE}))
    assert reduced(made, pinning=True).pinned == []
    made.load = {}
    made.v = [arb("0.001"), ZERO]
    assert reduced(made, pinning=True).pinned == []


def test_the_table_itself_is_left_as_it_was() -> None:
    made = table([1, 2], "mm", [3, 5])
    made.rows.append(Row.held("c", {(1,): ONE, (0,): arb(-2)}))
    reduced(made, pinning=True)
    assert len(made.rows) == 1
    assert made.names == ["b.q0", "b.q1"]


def stays(answer: SceneSolution, name: str) -> bool:
    """Return whether a coordinate of a body has one value at all times of an answer."""
    assert answer.trajectory is not None
    body, _, part = name.partition(".")
    if part == "angle":
        values = np.asarray(answer.trajectory.columns[name].values)
    elif part in ("x", "y", "z"):
        values = np.asarray(answer.trajectory.columns[f"{body}.position"].values)[:, "xyz".index(part)]
    else:
        return True
    return bool(np.all(np.abs(values - values[0]) <= 1e-12 * np.max(np.abs(values))))


LANGUAGE = {entry.name for entry in fields(Scene)}
STILL = (
    *("asymmetric-top", "atwood-machine", "ball-in-bowl", "ball-on-ball-dropped", "blocks-on-incline"),
    *("damped-oscillator", "disc-leaves-cylinder", "dumbbell-dropped-in-space", "four-legged-table", "massive-pulley"),
    *("sphere-on-turntable", "swinging-atwood-machine", "weight-lands", "weight-under-table", "yo-yo"),
)
"""Worked scenes in which something is said never to move."""


@pytest.mark.parametrize("name", STILL)
def test_what_is_said_never_to_move_does_not(name: str) -> None:
    scene = {key: value for key, value in catalogue()[name].items() if key in LANGUAGE}
    answer = solve_scene(read(scene), np.linspace(0.0, 0.5, 9), ("trajectory",))
    said = [text for text in answer.model.noticed if "constant throughout" in text or "at rest" in text]
    assert said
    for text in said:
        names = re.findall(r"[\w-]+\.[\w.']+", text.partition(":")[2])
        assert names
        assert all(stays(answer, name) for name in names), text


def test_a_wheel_in_oblique_space_is_said_to_stay_by_the_names_of_the_description() -> None:
    body = {"mass": 1, "moments": [0.1, 0.2, 0.3], "at": [0, 0, 0], "places": {"p": [0.5, 0, 0]}}
    body |= {"axes": [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]}
    pin = {"kind": "pin", "a": "b.p", "b": [0.3, 0.4, 0]}
    scene = {"gravity": [0, 0, -10], "bodies": {"b": body}, "connections": [pin]}
    answer = solve_scene(read(scene), [0.5], ("trajectory",))
    assert answer.model.name == "one period"
    assert not any("'" in text for text in answer.model.noticed)
