"""Faults of several parts of a description: all of them are said, each at its place."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InvalidParameter, SlackAtStart
from core.multibody.language.faults_of_parts import FaultsOfParts
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene

BODY = {"mass": 1, "at": [0, -1]}


def places_of_faults(description: dict[str, Any]) -> list[str]:
    with pytest.raises(InvalidParameter) as found:
        solve_scene(scene_from(description))
    assert all(not fault.further for fault in found.value.further)
    return ["/".join(map(str, fault.path)) for fault in (found.value, *found.value.further)]


def test_unknown_fields_and_kinds_of_several_bodies_and_connections() -> None:
    bodies = {"p": {"mas": 1, "at": [0, 0]}, "q": BODY, "r": {"mass": 1}}
    connections = [{"kind": "glue"}, {"kind": "rod", "a": "q", "b": [0, 0]}, {"kind": "rod", "a": "q"}]
    found = places_of_faults({"bodies": bodies, "connections": connections})
    assert found == ["bodies/p/mas", "bodies/r/at", "connections/0/kind", "connections/2/b"]


def test_numbers_of_several_bodies() -> None:
    bodies = {"p": {"mass": -1, "at": [0, 0]}, "q": BODY, "r": {"mass": 1, "at": [0]}}
    assert places_of_faults({"bodies": bodies}) == ["bodies/p/mass", "bodies/r/at"]


def test_places_of_several_connections() -> None:
    connections = [
        {"kind": "rod", "a": "nobody", "b": [0, 0]},
        {"kind": "rod", "a": "p", "b": [0, 0]},
        {"kind": "spring", "a": "p", "b": [0, 1], "stiffness": "stiff"},
    ]
    found = places_of_faults({"bodies": {"p": BODY}, "connections": connections})
    assert found == ["connections/0/a", "connections/2/stiffness"]


def test_one_fault_stands_alone_and_none_is_nothing() -> None:
    faults = FaultsOfParts()
    faults.raised()
    with faults.part():
        raise InvalidParameter("mass", "be given")
    with pytest.raises(InvalidParameter, match="mass must be given") as found:
        faults.raised()
    assert found.value.further == ()


def test_seen_from_outside_every_path_is_longer() -> None:
    fault = InvalidParameter("a", "be given", further=[InvalidParameter("b", "be given")]).inside("request")
    assert [one.path for one in (fault, *fault.further)] == [("request", "a"), ("request", "b")]


def test_a_slack_string_is_no_fault_of_the_description() -> None:
    faults = FaultsOfParts()
    with pytest.raises(SlackAtStart), faults.part():
        raise SlackAtStart("length", "be shorter")
    faults.raised()
