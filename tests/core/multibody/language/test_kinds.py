"""A kind of connection is one class with its forms: every kind of the catalogue has them, and one from outside works.

The kind that is added here is a balance: the sum of the heights of two places stays as it is at the start. Two masses
on it are an Atwood machine (G. Atwood, "A Treatise on the Rectilinear Motion and Rotation of Bodies" (1784)): they
accelerate at (m1 - m2) g/(m1 + m2), and the balance carries 2 m1 m2 g/(m1 + m2) at each.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

from core.errors import InvalidParameter, Path, SelfCheckFailed
from core.multibody.algebra.polynomials import ONE, Ball, combined, constant, evaluated
from core.multibody.audit.bodies import Reader
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.placement import Motion, Numbers, Place, Placement
from core.multibody.language.connection import TwoEnded
from core.multibody.language.kinds import KINDS
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from core.multibody.table.measures import Measures
from core.multibody.table.rows import add_rows


@dataclass(frozen=True)
class Balance(TwoEnded):
    """The sum of the heights of two places of the plane stays as it is at the start; the force lifts both."""

    a: str
    b: str
    name: str | None = None
    kind: ClassVar[str] = "balance"


def hold_heights(connection: Balance, measures: Measures, name: str, path: Path, sign: Ball) -> None:
    a = measures.coordinates.point(connection.a, (*path, "a"))
    b = measures.coordinates.point(connection.b, (*path, "b"))
    heights = combined((ONE, a.at[1]), (sign, b.at[1]))
    row = measures.hold(name, combined((ONE, heights), (-evaluated(heights, measures.table.q), constant(ONE))))
    measures.force(f"{name}.force", [(row, constant(ONE))])


@add_rows.register
def balance(connection: Balance, measures: Measures, name: str, path: Path) -> None:
    hold_heights(connection, measures, name, path, ONE)


@dataclass(frozen=True)
class BalanceDefinition(Definition):
    """Its definition for the audit, which shares nothing with the rows."""

    kind: ClassVar[str] = "balance"
    a: Place
    b: Place
    total: float

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        return {"heights": self.a.at(placement)[..., 1] + self.b.at(placement)[..., 1] - self.total}

    def efforts(self, placement: Placement, motion: Motion) -> Mapping[str, Numbers]:
        rates = self.a.velocity(placement, motion) + self.b.velocity(placement, motion)
        return {f"{self.name}.force": rates[..., 1]}


@definition_of.register
def balance_definition(connection: Balance, reader: Reader, name: str, path: Path) -> Definition:
    a, b = reader.place(connection.a, (*path, "a")), reader.place(connection.b, (*path, "b"))
    total = float(a.at(reader.start)[1] + b.at(reader.start)[1])
    return BalanceDefinition(name, (*a.bodies, *b.bodies), a, b, total)


@dataclass(frozen=True)
class WrongBalance(Balance):
    """The same by its definition, with rows that hold the difference of the heights instead."""

    kind: ClassVar[str] = "wrong-balance"


@add_rows.register
def wrong_balance(connection: WrongBalance, measures: Measures, name: str, path: Path) -> None:
    hold_heights(connection, measures, name, path, -ONE)


def described_with(kind: str) -> dict[str, Any]:
    return {
        "gravity": [0, -10],
        "bodies": {"heavy": {"mass": 3, "at": [0, 0]}, "light": {"mass": 1, "at": [1, 0.5]}},
        "connections": [
            {"kind": "track", "place": "heavy", "on": {"at": [0, 0], "slope": {"degrees": 90}}},
            {"kind": "track", "place": "light", "on": {"at": [1, 0], "slope": {"degrees": 90}}},
            {"kind": kind, "a": "heavy", "b": "light", "name": "beam"},
        ],
    }


KINDS_WITH_BALANCES = {**KINDS, "balance": Balance, "wrong-balance": WrongBalance}


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.kind)
def test_every_kind_has_its_forms(kind: type) -> None:
    for function in (add_rows, definition_of):
        assert function.dispatch(kind) is not function.dispatch(object)


def test_a_kind_from_outside_moves_as_its_textbook_says() -> None:
    scene = scene_from(described_with("balance"), KINDS_WITH_BALANCES)
    times = np.array([0.0, 0.25, 0.5])
    answer = solve_scene(scene, times, ("accelerations", "forces", "trajectory", "forces-in-time"))
    assert answer.accelerations is not None
    assert answer.forces is not None
    assert answer.trajectory is not None
    np.testing.assert_allclose(answer.accelerations["heavy"].linear, [0.0, -5.0], atol=1e-14)
    assert answer.forces["beam.force"].value == pytest.approx(15.0, rel=1e-14)
    columns = answer.trajectory.columns
    np.testing.assert_allclose(columns["heavy.position"].values[:, 1], -2.5 * times**2, atol=1e-14)
    np.testing.assert_allclose(columns["light.position"].values[:, 1], 0.5 + 2.5 * times**2, atol=1e-14)
    np.testing.assert_allclose(columns["beam.force"].values, 15.0, rtol=1e-14)


def test_the_audit_refuses_a_kind_whose_rows_are_not_its_definition() -> None:
    scene = scene_from(described_with("wrong-balance"), KINDS_WITH_BALANCES)
    with pytest.raises(SelfCheckFailed, match="beam"):
        solve_scene(scene, np.array([0.0, 0.5]), ("forces", "trajectory", "forces-in-time"))


def test_a_kind_that_is_not_in_the_catalogue_is_refused() -> None:
    with pytest.raises(InvalidParameter, match="be one of pin"):
        scene_from(described_with("balance"))
