"""Balls and places on the faces, edges and corners of boxes in space, against closed forms and conserved quantities."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, read
from tests.oracles.plain_engine.comparison.comparing import compared

BALL = {"mass": 1, "shape": {"kind": "ball", "radius": 0.1}}
BOX = {"mass": 2, "shape": {"kind": "box", "width": 0.4, "height": 0.6, "depth": 0.2}, "at": [0, 0, 0]}
HELD = {"kind": "weld", "name": "weld", "a": "box", "b": [0, 0, 0]}
TURNED = [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]


def scene(
    ball: dict[str, Any], box: dict[str, Any], *more: dict[str, Any], gravity: float = 10, **contact: Any
) -> dict[str, Any]:
    touch = {"kind": "contact", "name": "c", "a": "ball", "b": "box"} | contact
    return {
        "gravity": [0, 0, -gravity],
        "bodies": {"ball": BALL | ball, "box": BOX | box},
        "connections": [touch, *more],
    }


@pytest.mark.parametrize("swap", [False, True])
def test_a_ball_bounces_on_a_box_that_is_held(swap: bool) -> None:
    ends = {"a": "box", "b": "ball"} if swap else {}
    answer = solve_scene(read(scene({"at": [0.1, 0.2, 0.65]}, {}, HELD, restitution=0.5, **ends)), [0.1, 0.7])
    assert [event.time for event in answer.events][:2] == pytest.approx([0.3, 0.6], rel=1e-14)
    assert answer.events[0].impulses["normal"] == pytest.approx(4.5, rel=1e-14)


@pytest.mark.parametrize("axes", [None, TURNED], ids=["along", "turned"])
def test_a_ball_that_slides_over_an_edge_leaves_it_where_gravity_no_longer_bends_its_way(axes: Any) -> None:
    """About the edge v^2 = v0^2 + 2 g r (1 - cos a) until v^2 = g r cos a: cos a = (2 + v0^2/(g r))/3 = 3/4."""
    at, moves = ([0.1, 0.1, 0.2], [0.5, 0, 0]) if axes is None else ([-0.02, 0.14, 0.2], [0.3, 0.4, 0])
    box = {} if axes is None else {"axes": axes}
    answer = solve_scene(read(scene({"at": at, "velocity": moves}, box, HELD)), [0.1, 0.5])
    (event,) = answer.events
    falls = mpmath.quad(
        lambda a: mpmath.mpf("0.1") / mpmath.sqrt(mpmath.mpf("0.25") + 2 * (1 - mpmath.cos(a))), [0, mpmath.acos(0.75)]
    )
    assert event.kind == "lift-off"
    assert event.time == pytest.approx(float(mpmath.mpf("0.2") + falls), rel=1e-12)


def test_a_ball_strikes_a_corner_along_the_line_to_its_centre() -> None:
    """It meets the corner (0.2, 0.3, 0.1) with its centre 0.1 (2, 1, 2)/3 beyond, and turns back along that line."""
    line = np.array([2, 1, 2]) / 3
    start = [f"0.2 + {2 * 0.2}/3", f"0.3 + {0.2}/3", f"0.1 + {2 * 0.2}/3"]
    ball = {"at": start, "velocity": [-2, -1, -2]}
    answer = solve_scene(read(scene(ball, {}, HELD, gravity=0, restitution=0.5)), [0.01, 0.1])
    assert answer.events[0].time == pytest.approx(0.1 / 3, rel=1e-13)
    assert column(answer, "ball.velocity").values[1] == pytest.approx(1.5 * line, rel=1e-13)


@pytest.mark.parametrize(
    ("at", "velocity"),
    [([0.05, 0.1, 0.5], [0.2, 0, -3]), ([0.24, 0.1, 0.5], [0, 0, -3]), ([0.24, 0.34, 0.5], [0, 0, -3])],
    ids=["face", "edge", "corner"],
)
def test_an_elastic_impact_keeps_momentum_spin_and_energy(at: list[float], velocity: list[float]) -> None:
    spins = {"angular_velocity": [0, 0, 0]}
    answer = solve_scene(read(scene({"at": at, "velocity": velocity}, spins, gravity=0, restitution=1)), [0.0, 0.3])
    assert [event.kind for event in answer.events] == ["touch"]
    moments = 2 / 12 * np.array([0.6**2 + 0.2**2, 0.4**2 + 0.2**2, 0.4**2 + 0.6**2])
    totals = []
    for row in (0, 1):
        v, u, w = (
            column(answer, name).values[row] for name in ("ball.velocity", "box.velocity", "box.angular_velocity")
        )
        r, s = (column(answer, name).values[row] for name in ("ball.position", "box.position"))
        energy = v @ v / 2 + u @ u + moments @ w**2 / 2
        totals.append((*(v + 2 * u), energy, *np.cross(r, v), *(2 * np.cross(s, u))))
    first, then = (np.array(total) for total in totals)
    assert then[:4] == pytest.approx(first[:4], abs=1e-12)
    # About the origin the spin of the box is what the ball has lost; in body axes its size is the same.
    lost = first[4:7] + first[7:] - then[4:7] - then[7:]
    spin = moments * column(answer, "box.angular_velocity").values[1]
    assert np.linalg.norm(spin) == pytest.approx(np.linalg.norm(lost), abs=1e-12)
    assert np.linalg.norm(lost) > 0.1


def test_both_engines_agree_about_a_ball_and_a_box() -> None:
    thrown = scene({"at": [0.24, 0.1, 0.5], "velocity": [0, 0.5, -3]}, {"angular_velocity": [0, 1, 2]}, restitution=0.5)
    verdict = compared(thrown, [0.0, 0.1, 0.25])
    assert verdict.differences == []
    assert not verdict.not_supported
    assert verdict.compared > 0


def test_friction_and_overlap_are_refused() -> None:
    with pytest.raises(InvalidParameter, match="between two round bodies"):
        solve_scene(read(scene({"at": [0, 0, 1]}, {}, friction=0.1)), [0.1])
    with pytest.raises(InvalidParameter, match="overlap"):
        solve_scene(read(scene({"at": [0, 0, 0.15]}, {})), [0.1])
