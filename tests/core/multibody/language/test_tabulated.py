"""Functions by points in `let`: against scipy's natural spline, and motions whose forces they are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from flint import arb
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from core.balls import precision
from core.errors import InvalidParameter
from core.formulas import Node, value_of
from core.multibody.language.numerals import BALLS, Numerals
from core.multibody.language.reading import scene_from
from core.multibody.language.tabulated import MOST_POINTS, tabulated
from core.multibody.solve import solve_scene

POINTS = [[-1, "0.5"], [0, 2], ["0.25", "1/3"], [2, -4], [3, -4]]
HERE = ("let", "push")


def at(table: dict[str, Any], place: float) -> float:
    with precision(200):
        function = tabulated(table, Numerals.of({}, "decimals").number, HERE)
        return float(value_of(function.of(Node("name", "x")), {"x": arb(place)}, BALLS))


@pytest.mark.parametrize("place", [-1.0, -0.25, 0.0, 0.125, 0.25, 1.0, 2.0, 2.75, 3.0])
def test_between_points(place: float) -> None:
    x, y = [-1, 0, 0.25, 2, 3], [0.5, 2, 1 / 3, -4, -4]
    linear, cubic = (
        at({"points": POINTS, "interpolation": by, "outside": "constant"}, place) for by in ("linear", "cubic")
    )
    assert linear == pytest.approx(np.interp(place, x, y), abs=1e-15)
    assert cubic == pytest.approx(CubicSpline(x, y, bc_type="natural")(place), abs=1e-14)


def written(node: Node) -> str:
    if node.kind == "number":
        return f"{float(node.text):g}"
    parts = [written(inner) for inner in node.inner]
    return node.text or (f"({node.kind.join(parts)})" if node.kind in "+-*" else f"{node.kind}({', '.join(parts)})")


def test_pieces_are_written_without_zeros_and_ones() -> None:
    table = {"points": [[0, 3], [1, 4], [2, 4], [3, 0]], "outside": "constant"}
    with precision(200):
        function = tabulated(table, Numerals.of({}, "decimals").number, HERE)
        formula = written(function.of(Node("name", "t")))
    assert formula == "if((t-3), 0, if(t, if((t-1), if((t-2), (4+((t-2)*-4)), 4), (3+t)), 3))"


def test_outside_of_the_points() -> None:
    constant = {"points": POINTS, "outside": "constant"}
    assert (at(constant, -7.0), at(constant, 7.0)) == (0.5, -4.0)
    for place in (-1.5, 3.5):
        with pytest.raises(InvalidParameter, match="root"):
            at({"points": POINTS}, place)


@pytest.mark.parametrize(
    ("table", "pointer", "rule"),
    [
        ({"points": [[0, 0]]}, ("points",), f"2 to {MOST_POINTS} points"),
        ({"points": [[0, 0]] * (MOST_POINTS + 1)}, ("points",), "points"),
        ({"points": [[0, 0], [1]]}, ("points", 1), "two numbers"),
        ({"points": [[0, 0], [0, 1]]}, ("points", 1, 0), "greater than"),
        ({"points": [[0, 0], [1, "q"]]}, ("points", 1, 1), "known names"),
        ({"points": POINTS, "outside": "zero"}, ("outside",), "constant, end"),
        ({"points": POINTS, "interpolation": "cubical"}, ("interpolation",), "linear, cubic"),
        ({"points": POINTS, "interpolaton": "cubic"}, ("interpolaton",), "left out"),
    ],
)
def test_what_is_no_table_is_refused(table: dict[str, Any], pointer: tuple[Any, ...], rule: str) -> None:
    with pytest.raises(InvalidParameter, match=rule) as refused:
        Numerals.of({"push": table}, "decimals")
    assert refused.value.path == (*HERE, *pointer)


def pushed(table: dict[str, Any], formula: str, **more: Any) -> dict[str, Any]:
    force = {"kind": "force", "name": "motor", "place": "p", "force": [formula, 0]}
    body = {"mass": 1, "at": [0, 0], **more}
    return {"let": {"push": table}, "bodies": {"p": body}, "connections": [force]}


PULSE = [[0, 0], [1, 2], [2, 0]]


def test_a_force_by_points_changes_its_piece_at_each() -> None:
    """The impulse up to 1, 2 and 3 s is 1, 2 and 2; between corners the force is in proportion to the time."""
    scene = pushed({"points": PULSE, "outside": "constant"}, "push(t)")
    found = solve_scene(scene_from(scene), [1.0, 2.0, 3.0])
    assert [(event.kind, event.time) for event in found.events] == [("switch", 1.0), ("switch", 2.0)]
    assert found.trajectory is not None
    np.testing.assert_allclose(found.trajectory.columns["p.velocity"].values[:, 0], [1, 2, 2], atol=4e-15)
    np.testing.assert_allclose(found.trajectory.columns["p.position"].values[:, 0], [1 / 3, 2, 4], atol=4e-15)


def test_beyond_its_last_point_a_function_ends_the_motion() -> None:
    found = solve_scene(scene_from(pushed({"points": PULSE}, "push(t)")), [1.5, 3.0])
    assert found.problem is not None
    assert (found.problem.code, found.problem.time, found.problem.connections) == ("formula", 2.0, ("motor",))
    assert found.trajectory is not None
    assert found.trajectory.rows == (0,)
    with pytest.raises(InvalidParameter, match="have a value at the start") as refused:
        solve_scene(scene_from(pushed({"points": [[1, 0], [2, 1]]}, "push(t)")), [1.0])
    assert refused.value.path == ("connections", 0, "force", 0)


def test_a_spring_by_measured_points() -> None:
    """A spline of the place, in a name of `let` that is a formula itself, with a drag."""
    points = [[-2, -9], [-1, -2], [0, 0], [1, 3], [2, 8]]
    scene = pushed({"points": points, "interpolation": "cubic"}, "pull", at=["1.5", 0])
    scene["let"]["pull"] = "-push(x) - vx/4"
    found = solve_scene(scene_from(scene), [1.0, 2.0, 5.0])
    spline = CubicSpline(*np.array(points).T, bc_type="natural")
    exact = solve_ivp(
        lambda _, y: [y[1], -spline(y[0]) - y[1] / 4],
        (0, 5),
        [1.5, 0],
        "DOP853",
        [1.0, 2.0, 5.0],
        rtol=1e-12,
        atol=1e-13,
    )
    assert found.trajectory is not None
    np.testing.assert_allclose(found.trajectory.columns["p.position"].values[:, 0], exact.y[0], atol=1e-9)
    assert {event.kind for event in found.events} == {"switch"}


def test_a_name_of_a_table_is_a_function() -> None:
    with pytest.raises(InvalidParameter, match="one complete formula"):
        solve_scene(scene_from(pushed({"points": PULSE}, "push*t")), [1.0])
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(scene_from(pushed({"points": PULSE}, "psh(t)")), [1.0])
    assert refused.value.remedy is not None
    assert '"push"' in refused.value.remedy
