"""Components of one force as one law: what they push across it is zero, whatever the axes."""

from __future__ import annotations

from typing import Any

import pytest

from core.multibody.language.reading import scene_from
from core.multibody.laws.merged import merged
from core.multibody.solve import solve_scene
from core.multibody.table.description import described

TRIPLES = [(3, 4, 5), (5, 12, 13), (8, 15, 17)]


def pressed(sides: tuple[int, int, int], size: str, let: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return a block on a smooth slope, whose weight is across it, with a force of a size away from the slope."""
    c, s, r = sides
    return {
        "gravity": [f"10*{s}/{r}", f"-10*{c}/{r}"],
        "let": let or {},
        "bodies": {"b": {"mass": 1, "at": [0, 0]}},
        "connections": [
            {"kind": "contact", "name": "face", "place": "b", "on": {"at": [0, 0], "slope": f"acos({c}/{r})"}},
            {"kind": "force", "place": "b", "force": [f"-{s}/{r}*({size})", f"({size})*{c}/{r}"]},
        ],
    }


@pytest.mark.parametrize("sides", TRIPLES)
@pytest.mark.parametrize(("size", "time", "away"), [("4*t", 2.5, 2.25), ("k*sin(t)", None, 0)])
def test_a_block_is_pulled_off_a_slope_as_off_a_floor(
    sides: tuple[int, int, int], size: str, time: float | None, away: float
) -> None:
    answer = solve_scene(scene_from(pressed(sides, size, {"k": 9})), [1.0, 4.0])
    assert answer.model.name == "rest"
    assert [event.kind for event in answer.events] == ([] if time is None else ["lift-off"])
    if time is not None:
        assert answer.events[0].time == pytest.approx(time, rel=1e-15)
    assert answer.trajectory is not None
    c, s, r = sides
    assert answer.trajectory.columns["b.position"].values[-1] == pytest.approx([-s / r * away, c / r * away], abs=1e-13)


def test_terms_are_split_from_their_factors_and_joined() -> None:
    """-2 f, f/4 + 3 and (3 - f) push as one law of f and one of a number."""
    forces = [["-2*sin(t)", "sin(t)/4 + 3"], ["3 - sin(t)", "0*t"]]
    connections = [{"kind": "force", "place": "b", "force": force} for force in forces]
    scene = {"gravity": [0, 0], "bodies": {"b": {"mass": 1, "at": [0, 0]}}, "connections": connections}
    found = merged(described(scene_from(scene)).measures.table.laws)
    assert [{i: float(x) for i, x in law.push.items()} for law in found] == [{0: -3.0, 1: 0.25}, {0: 3.0, 1: 3.0}]


def test_a_factor_without_a_value_is_left_to_the_start() -> None:
    connections = [{"kind": "force", "place": "b", "force": ["sin(t)/(k - k)", 0]}]
    scene = {"gravity": [0, 0], "let": {"k": 1}, "bodies": {"b": {"mass": 1, "at": [0, 0]}}, "connections": connections}
    laws = described(scene_from(scene)).measures.table.laws
    assert [law.root for law in merged(laws)] == [law.root for law in laws if law.push]
