"""Linkages that are held redundantly, beyond places where some rows that were independent at the start depend."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.references.problems import BRICARD
from core.multibody.algebra.polynomials import ONE, ZERO
from core.multibody.motion.other_rows import rows_for
from core.multibody.solve import solve_scene
from core.multibody.table.table import Row, Table
from tests.benchmarks.test_references import RODS, chain, closed, energies
from tests.core.multibody.worked_examples import read


def places(scene: Any, times: list[float]) -> dict[str, Any]:
    answer = solve_scene(read(scene), times, ["trajectory"])
    assert answer.ended is None
    assert answer.trajectory is not None
    return {name: answer.trajectory.columns[f"{name}.position"] for name in RODS}


def test_bricard_s_linkage_passes_its_lowest_place_as_its_energy_says() -> None:
    """Its places are one smooth closed curve (Arponen, Piipponen, Tuomela 2007); at 1.248 s it passes the lowest."""
    found = places(BRICARD.scene, [2.0])
    x, _, z = found["ab"].values[0]
    last = math.atan2(-z, x)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    rest, others, time = energies(0.0, closed(0.0, np.zeros(4)))[1], np.zeros(4), 0.0
    for s, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        first = last * s * s
        others = closed(first, others)
        doubled, potential = energies(first, others)
        time += weight * 2 * abs(last) * s * math.sqrt(doubled / (2 * (rest - potential)))
    assert time == pytest.approx(2.0, abs=2e-5)
    _, joints, _ = chain([last, *closed(last, others)])
    for k, name in enumerate(RODS):
        assert (joints[k] + joints[k + 1]) / 2 == pytest.approx(found[name].values[0], abs=1e-9)


def test_it_returns_after_two_ways_down_and_two_ways_up() -> None:
    """It starts at rest, and by its symmetry does the way down and the way up in the same time, there and back."""
    quarter = 1.2479278784
    found = places(BRICARD.scene, [0.0, 2 * quarter, 4 * quarter])
    for name, column in found.items():
        start, there, back = column.values
        assert back == pytest.approx(start, abs=1e-8)
        assert np.linalg.norm(there - start) > 0.9 or name == "ef", "it turns back elsewhere"


@pytest.mark.parametrize("variant", ["moved", "reversed", "twin"])
def test_so_it_does_wherever_it_stands_and_however_it_is_listed(variant: str) -> None:
    scene = {**BRICARD.scene}
    away = 1000 if variant == "moved" else 0
    if variant == "reversed":
        scene["connections"] = scene["connections"][::-1]
        scene["bodies"] = dict(reversed(scene["bodies"].items()))
    if variant == "twin":
        scene["bodies"] = scene["bodies"] | {"bob": {"mass": 1, "at": [50, -1, 1]}}
        scene["connections"] = [*scene["connections"], {"kind": "rod", "a": "bob", "b": [50, 0, 0]}]
    if variant == "moved":
        bodies = {
            name: {**body, "at": [f"1000 + {body['at'][0]}", *body["at"][1:]]} for name, body in scene["bodies"].items()
        }
        connections = [
            {**one, "b": [one["b"][0] + 1000, *one["b"][1:]]} if isinstance(one["b"], list) else one
            for one in scene["connections"]
        ]
        scene = {**scene, "bodies": bodies, "connections": connections}
    found, known = places(scene, [2.0, 4.0]), places(BRICARD.scene, [2.0, 4.0])
    for name, column in known.items():
        off = np.abs(found[name].values - column.values - [away, 0, 0]).max()
        assert off <= 2 * (found[name].error + column.error) + away * 2.0**-52


def test_rows_are_independent_at_all_places_or_there_are_none() -> None:
    """Of x = 0, a x + b y = 0 and y = 0 with places (a, b), two are independent; which depends on a and b."""
    table = Table()
    for name in "xyab":
        table.coordinate(name, "1", ZERO)
    table.rows = [
        Row("first", None, {0: {(): ONE}}),
        Row("turning", None, {0: {(2,): ONE}, 1: {(3,): ONE}}),
        Row("last", None, {1: {(): ONE}}),
    ]
    along, across = np.array([0.0, 0, 1, 0]), np.array([0.0, 0, 0, 1])
    assert rows_for(table, 2, [along, across]) == [0, 2]
    table.rows = table.rows[:2]
    assert rows_for(table, 2, [across]) == [0, 1]
    assert rows_for(table, 2, [across, along]) is None
