"""Several questions about scenes full of exact coincidences: answered together as alone, and as samples show."""

from __future__ import annotations

import itertools
from random import Random
from typing import Any

import numpy as np
import pytest

from core.multibody.answer import SceneSolution
from core.multibody.language.numerals import Numerals
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from tests.core.multibody.worked_examples import read

SCENES = 16
DIRECTIONS = [("3/5", "-4/5"), ("-4/5", "-3/5"), ("0", "-1"), ("1", "0"), ("sqrt(2)/2", "-sqrt(2)/2")]
VALUES = ["0", "1", "-1", "1/2", "-4/5", "sqrt(2)/2"]


def part(random: Random, at: int, bodies: dict[str, Any], connections: list[Any]) -> None:
    """Add bodies of equal masses at equal heights, at right or Pythagorean angles, often at rest."""
    name, (x, y), speed = f"b{at}", random.choice(DIRECTIONS), random.choice(["0", "0", "1", "-1", "2"])
    rebound = random.choice(["0", "1/2", "1"])
    floor: dict[str, Any] = {"kind": "contact", "place": name, "on": {"at": ["0", "0"]}, "restitution": rebound}
    around = {"mass": 1, "at": [f"{at} + {x}", y], "velocity": [f"-({speed})*({y})", f"({speed})*({x})"]}
    kind = random.choice(["swing", "ball", "string", "spring", "weights", "pair", "loop"])
    if kind == "swing":
        bodies[name] = around
        connections.append({"kind": "rod", "a": name, "b": [at, 0]})
        if not x.startswith(("-", "0")):
            connections.append(floor | {"on": {"at": [at, 0], "slope": {"degrees": -90}}})
    elif kind == "ball":
        bodies[name] = {"mass": 1, "at": [at, random.choice(["1", "5/4"])], "velocity": ["1", speed]}
        connections.append(floor)
    elif kind == "string":
        bodies[name] = around
        length = random.choice(["1", "3/2"])
        connections.append({"kind": "string", "through": [name, [at, 0]], "length": length, "restitution": rebound})
    elif kind == "spring":
        bodies[name] = {"mass": 1, "at": [f"{at} + 1", "0"], "velocity": [speed, "0"]}
        connections.append(floor | {"friction": random.choice(["0", "1/4"])})
        connections.append({"kind": "spring", "a": name, "b": [at, 0], "stiffness": 4, "rest_length": "1/2"})
    elif kind == "weights":
        left, right = [f"{at} - 1/2", "0"], [f"{at} + 1/2", "0"]
        bodies[name] = {"mass": random.choice([1, 2]), "at": [left[0], "-1"]}
        bodies[f"{name}r"] = {"mass": 1, "at": [right[0], "-1"]}
        connections.append({"kind": "string", "through": [name, left, right, f"{name}r"], "restitution": rebound})
        connections.append(floor | {"on": {"at": ["0", random.choice(["-1", "-6/5", "-2"])]}})
    elif kind == "pair":
        bodies[name] = {"mass": 1, "at": [at, "1"], "velocity": ["0", speed]}
        bodies[f"{name}r"] = {"mass": 1, "at": [f"{at} + 1", "1"], "velocity": ["0", "1"]}
        length = random.choice(["sqrt(2)", "5/4"])
        connections.append({"kind": "string", "through": [name, f"{name}r"], "length": length, "restitution": rebound})
    else:
        bodies[name] = {"mass": 1, "at": [at, "-1"], "velocity": [random.choice(["2", "sqrt(20)", "5"]), "0"]}
        connections.append(floor | {"on": {"at": [at, 0], "radius": "-1"}})


def drawn(seed: int) -> tuple[Any, list[When], float]:
    """Return a scene, searches for values that it has at the start or as exactly later, and a last time."""
    random = Random(seed)
    bodies: dict[str, Any] = {}
    connections: list[Any] = []
    for k in range(random.choice([1, 2])):
        part(random, 6 * k, bodies, connections)
    own = [
        (f"{name}.position.{axis}", str(one["at"][i])) for name, one in bodies.items() for i, axis in enumerate("xy")
    ]
    chosen = random.sample(own, 2)
    searches = [When(name, random.choice([start, *VALUES[:2], random.choice(VALUES)])) for name, start in chosen]
    scene = {"gravity": [0, random.choice([0, -10])], "bodies": bodies, "connections": connections}
    return read(scene), searches, random.choice([1.0, 2.0])


def taken(answer: SceneSolution, name: str) -> list[tuple[float, float]]:
    return [(one.time, one.error) for one in answer.occurrences or () if one.quantity == name]


def alike(some: list[tuple[float, float]], others: list[tuple[float, float]]) -> bool:
    return len(some) == len(others) and all(abs(s - t) <= a + b for (s, a), (t, b) in zip(some, others, strict=True))


@pytest.mark.parametrize("seed", range(SCENES))
def test_what_is_asked_together_is_answered_as_alone_and_as_samples_show(seed: int) -> None:
    scene, searches, end = drawn(seed)
    times = np.linspace(0.0, end, 201)
    extremes = [ExtremesOf(search.quantity) for search in searches]
    together = solve_scene(scene, times, ["trajectory", *searches, *extremes])
    assert together.trajectory is not None
    shown = times[: len(next(iter(together.trajectory.columns.values())).values)]
    for k, search in enumerate(searches):
        alone = solve_scene(scene, [end], [search, extremes[k]])
        assert alike(taken(together, search.quantity), taken(alone, search.quantity))
        column = together.trajectory.columns[search.quantity.rpartition(".")[0]]
        value = column.values[:, "xy".index(search.quantity[-1])]
        own = next(one for one in together.extremes or () if one.quantity == search.quantity)
        within = value[shown <= own.until]
        known = own.error + column.error
        assert own.least - known <= within.min()
        assert within.max() <= own.largest + known
        rest = value - float(Numerals.of({}).number(search.equals, ()))
        sure = np.flatnonzero(np.abs(rest) > 4.0 * column.error)
        found = taken(together, search.quantity)
        for before, after in itertools.pairwise(sure):
            if rest[before] * rest[after] < 0.0:
                assert any(shown[before] - error <= time <= shown[after] + error for time, error in found)
