"""Every quantity that can be searched, by its curve, against the column of the answer."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.equations.dynamics import forces_at_start, multipliers_at_start
from core.multibody.motion.modelling import modelled
from core.multibody.search.first_of_motion import Expansions
from core.multibody.trajectory.columns import COLUMNS_OF_STATES, Columns
from core.multibody.trajectory.occurrences import component
from core.multibody.trajectory.quantities import sought_in
from core.systems.trajectory import Column
from tests.core.multibody.worked_examples import read

SCENES = Path(__file__).parents[4] / "examples" / "scenes"
NAMES = (
    "physical-pendulum",
    "massive-pulley",
    "asymmetric-top",
    "lagrange-top",
    "kepler-ellipse",
    "double-pendulum",
    "elastic-pendulum",
    "sphere-on-turntable",
)
TIME = 0.3
STEP = 2.0**-14
"""Of central differences (s): what they leave out is a share of 1e-8 of what changes within a second."""


@pytest.fixture(autouse=True)
def exact_numbers() -> Iterator[None]:
    with precision(BITS):
        yield


class Answered:
    """A worked scene without what is requested of it, its quantities and their columns."""

    def __init__(self, name: str) -> None:
        stated = json.loads((SCENES / f"{name}.json").read_text())
        scene = {key: value for key, value in stated.items() if key in ("gravity", "let", "bodies", "connections")}
        self.found = modelled(read(scene))
        self.whole = self.found.whole
        measures = self.found.described.measures
        forces = forces_at_start(measures, multipliers_at_start(measures, self.whole.acceleration))
        self.determined = [force.value is not None for force in forces]
        self.sought = sought_in(self.whole, self.determined)
        self.expansions = Expansions.of([(self.whole, "fine")])

    def columns(self, times: np.ndarray) -> dict[str, Column]:
        made = Columns(self.whole, times, self.whole.states(times), "closed form")
        return {k: v for group in COLUMNS_OF_STATES for k, v in made.group(group, self.determined).items()}

    def quantities(self) -> list[str]:
        found = []
        for name, column in self.columns(np.array([TIME])).items():
            if column.values.ndim == 1:
                found.append(name)
            else:
                letters = "wxyz" if column.values.shape[1] == 4 else "xyz"[: column.values.shape[1]]
                found.extend(f"{name}.{part}" for part in (*letters, "length"))
        return found


@pytest.mark.parametrize("name", NAMES)
def test_curves_vanish_at_the_value_of_the_column_and_change_with_it(name: str) -> None:
    answered = Answered(name)
    columns = answered.columns(np.array([TIME - STEP, TIME, TIME + STEP]))
    for quantity in answered.quantities():
        sought, column = answered.sought(quantity), component(columns, quantity)
        assert sought is not None, quantity
        assert column is not None
        before, value, after = column.values.tolist()
        motion = (answered.expansions.forces if sought.of_forces else answered.expansions.places)[0]
        pieces = motion(np.array([TIME]), np.array([1.0]))
        curve = sought.less(arb(value))(pieces)
        here, rate = curve.values[0, 0, 0], curve.values[0, 1, 0] / pieces.lengths[0]
        assert sought.has(value, value), quantity
        # To the rounding of the terms, of the column and of the value.
        size = curve.sizes[0, 0] + column.error + abs(value)
        assert abs(here) <= 1e-13 * size, quantity
        # Where the quantity changes, so does its curve: with slopes in proportion to those of the turning curves.
        turning = [abs(one(pieces).values[0, 0, 0]) for one in sought.turning()]
        slope = (after - before) / (2 * STEP)
        least = 1e-6 * (abs(slope) + size)
        assert (abs(slope) <= least) or (abs(rate) > 0.0 and max(turning) > 0.0), quantity
        apart = sought.less(arb(value + 0.125))(pieces).values[0, 0, 0]
        assert abs(apart) > 1e-6, quantity


def test_derivatives_of_polynomial_quantities_are_differences_of_columns() -> None:
    answered = Answered("elastic-pendulum")
    columns = answered.columns(np.array([TIME - STEP, TIME + STEP]))
    for quantity in answered.quantities():
        sought, column = answered.sought(quantity), component(columns, quantity)
        assert sought is not None
        assert column is not None
        if sought.ambiguous:
            continue
        motion = (answered.expansions.forces if sought.of_forces else answered.expansions.places)[0]
        pieces = motion(np.array([TIME]), np.array([1.0]))
        (turning,) = sought.turning()
        slope = (column.values[1] - column.values[0]) / (2 * STEP)
        size = 1.0 + abs(column.values[0])
        assert turning(pieces).values[0, 0, 0] == pytest.approx(slope, rel=1e-5, abs=1e-5 * size), quantity


def test_what_is_no_quantity_is_none() -> None:
    sought = Answered("asymmetric-top").sought
    for name in ("", "nothing", "energy", "energy.kinetic.x"):
        assert sought(name) is None
    (body,) = Answered("asymmetric-top").whole.measures.coordinates.frames
    assert sought(f"{body}.position") is None
    assert sought(f"{body}.position.w") is None
    assert sought(f"{body}.attitude.w") is not None


@pytest.mark.parametrize(("value", "signs"), [(0.25, (True, False)), (-0.25, (False, True))])
def test_a_component_of_a_quaternion_has_the_sign_of_the_value(value: float, signs: tuple[bool, bool]) -> None:
    top = Answered("asymmetric-top")
    (body,) = top.whole.measures.coordinates.frames
    part = top.sought(f"{body}.attitude.x")
    assert part is not None
    assert (part.has(0.25, value), part.has(-0.25, value)) == signs


def test_an_angle_half_a_turn_away_is_another_one() -> None:
    pendulum = Answered("physical-pendulum")
    (body,) = pendulum.whole.measures.coordinates.frames
    angle = pendulum.sought(f"{body}.angle")
    assert angle is not None
    assert angle.has(20.0, 20.0 + 1e-9)
    assert not angle.has(20.0, 20.0 + np.pi)
    assert not angle.has(20.0, 20.0 - 2 * np.pi)
