"""What is redundant, by counting: Maxwell's rule for frames, and tables on legs.

References
----------
J. C. Maxwell, "On the calculation of the equilibrium and stiffness of frames", Philosophical Magazine 27 (1864).
"""

from __future__ import annotations

from typing import Any

from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import read


def frame(rods: list[tuple[Any, Any]]) -> Any:
    """Return three points on rods to one another and to two points of the ground."""
    places = {"p": [1, 0], "q": [0, 1], "r": [1, 1]}
    bodies = {name: {"mass": 1, "at": at} for name, at in places.items()}
    connections = [{"kind": "rod", "name": f"r{i}", "a": a, "b": b} for i, (a, b) in enumerate(rods)]
    return read({"gravity": [0, -9.81], "bodies": bodies, "connections": connections})


SIX = [("p", [0, 0]), ("q", [0, 0]), ("p", "q"), ("p", "r"), ("q", "r"), ("p", [2, -1])]


def test_a_frame_with_as_many_rods_as_coordinates_has_none() -> None:
    model = solve_scene(frame(SIX)).model
    assert model.mobility == 0
    assert model.redundant == {}


def test_one_rod_more_is_redundant_with_those_of_its_state_of_self_stress() -> None:
    """Two more points of the ground close a triangle with p: of three rods at one point one is redundant."""
    answer = solve_scene(frame([*SIX, ("p", [2, 1])]))
    assert answer.model.mobility == 0
    assert len(answer.model.redundant) == 1
    (name, others), *_ = answer.model.redundant.items()
    assert {name, *others} == {"r0", "r5", "r6"}
    assert answer.forces is not None
    undetermined = {force.removesuffix(".force") for force, one in answer.forces.items() if not one.determined}
    assert undetermined == {name, *others}


def test_parts_that_are_apart_have_theirs_together() -> None:
    bodies = {name: {"mass": 1, "at": [x, 0]} for name, x in (("a", 0), ("b", 9))}
    tracks = [
        {"kind": "track", "name": f"{name}{k}", "place": name, "on": {"at": [0, 0]}} for name in bodies for k in (1, 2)
    ]
    model = solve_scene(read({"gravity": [0, -9.81], "bodies": bodies, "connections": tracks})).model
    assert model.mobility == 2
    assert {frozenset((name, *others)) for name, others in model.redundant.items()} == {
        frozenset(("a1", "a2")),
        frozenset(("b1", "b2")),
    }


def test_a_force_that_is_zero_at_the_start_alone_is_shared_later() -> None:
    """A bead passes the lowest place of two equal parabolas: their pushes across the slope are zero only there."""
    wires = [{"kind": "track", "name": f"w{k}", "place": "b", "on": {"at": [0, 0], "curvature": 1}} for k in (1, 2)]
    bodies = {"b": {"mass": 1, "at": [0, 0], "velocity": [1, 0]}}
    scene = read({"gravity": [0, -10], "bodies": bodies, "connections": wires})
    answer = solve_scene(scene, [0.1, 0.3], ("trajectory", "forces-in-time"))
    assert answer.trajectory is not None
    assert not any("w" in name.split(".")[0] for name in answer.trajectory.columns)
