"""Wrong ranges of rest are refused; the least squares without negative shares, by an exhaustive search."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from core.multibody.answer import RestRange
from core.multibody.audit.rest import audited_range, nonnegative
from core.multibody.language.scene import Scene
from core.multibody.statics.thresholds import RestOf, range_of_rest
from tests.core.multibody.worked_examples import read

FLOOR = {"kind": "contact", "name": "floor", "on": {"at": [0, 0]}}
BLOCK: dict[str, Any] = {
    "gravity": [0, -10],
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {**FLOOR, "place": "block", "friction": 0.5},
        {"kind": "force", "place": "block", "force": [6, 0]},
    ],
}
LADDER: dict[str, Any] = {
    "gravity": [0, -10],
    "let": {"h": 4},
    "bodies": {
        "ladder": {
            "mass": 3, "inertia": 1, "at": [1.5, "h/2"], "places": {"foot": [1.5, "-h/2"], "top": [-1.5, "h/2"]}
        }
    },
    "connections": [
        {**FLOOR, "place": "ladder.foot", "friction": 0.4},
        {"kind": "contact", "name": "wall", "place": "ladder.top", "on": {"at": [0, 0], "slope": {"degrees": -90}}},
    ],
}  # fmt: skip
TABLE: dict[str, Any] = {
    "gravity": [0, 0, -10],
    "bodies": {"block": {"mass": 2, "at": [0, 0, 0]}},
    "connections": [
        {"kind": "contact", "place": "block", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "friction": 0.5},
        {"kind": "force", "place": "block", "force": [3, 4, 0]},
    ],
}
STRING: dict[str, Any] = {
    "gravity": [0, -10],
    "bodies": {"weight": {"mass": 1, "at": [1, -1]}, "block": {"mass": 4, "at": [-1, 0]}},
    "connections": [
        {**FLOOR, "place": "block", "friction": 0.5},
        {"kind": "string", "through": ["block", [1, 0], "weight"]},
    ],
}
ASKED = {
    "force": (BLOCK, "/connections/1/force/0", [-30, 30]),
    "friction": (BLOCK, "/connections/0/friction", [0.1, 1]),
    "friction of a ladder": (LADDER, "/connections/0/friction", [0.01, 1]),
    "height of a ladder": (LADDER, "/let/h", [1, 6]),
    "force in space": (TABLE, "/connections/1/force/0", [-30, 30]),
    "weight on a string": (STRING, "/bodies/weight/mass", [0.5, 3]),
}


@cache
def found(name: str) -> tuple[Scene, RestRange]:
    description, vary, between = ASKED[name]
    scene = read(description)
    return scene, range_of_rest(scene, RestOf(vary, between))


@pytest.mark.parametrize("name", ASKED)
def test_right_ranges_pass(name: str) -> None:
    scene, answer = found(name)
    assert answer.lower is not None
    assert audited_range(scene, answer) is None


@pytest.mark.parametrize("share", [-1e-2, -2e-3, 2e-3, 1e-2])
@pytest.mark.parametrize("name", ASKED)
def test_ends_that_are_off_are_refused(name: str, share: float) -> None:
    scene, answer = found(name)
    count = 0
    for side in ("lower", "upper"):
        end = getattr(answer, side)
        assert end is not None
        if end.beyond is not None:
            count += 1
            wrong = replace(end, value=end.value + share * max(abs(end.value), abs(end.value - answer.written)))
            assert audited_range(scene, replace(answer, **{side: wrong})) is not None
    assert count


def test_rest_that_is_denied_is_refused() -> None:
    for name in ASKED:
        scene, answer = found(name)
        denied = replace(answer, lower=None, upper=None, reason="it does not rest")
        assert audited_range(scene, denied) is not None


def test_what_moves_or_slides_has_no_range() -> None:
    moving = {**BLOCK, "bodies": {"block": {"mass": 2, "at": [0, 0], "velocity": [1, 0]}}}
    sliding = {**BLOCK, "connections": [{**FLOOR, "place": "block", "friction": 0.2}, BLOCK["connections"][1]]}
    for description in (moving, sliding):
        scene = read(description)
        answer = range_of_rest(scene, RestOf("/connections/0/friction", [0.1, 0.25 if description is sliding else 1]))
        assert answer.lower is None
        assert audited_range(scene, answer) is None


def test_nearest_nonnegative_sum_by_all_subsets() -> None:
    rng = np.random.default_rng(3)
    for _ in range(40):
        lines, goal = rng.normal(size=(3, 5)), rng.normal(size=3)
        least = float(np.linalg.norm(goal))
        for size in range(1, 4):
            for own in combinations(range(5), size):
                shares, *_ = np.linalg.lstsq(lines[:, own], goal, rcond=None)
                if (shares >= 0.0).all():
                    least = min(least, float(np.linalg.norm(goal - lines[:, own] @ shares)))
        assert nonnegative(lines, goal) == pytest.approx(least, abs=1e-8)
