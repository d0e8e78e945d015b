from __future__ import annotations

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.multibody.solve import solve_scene
from tests.core.multibody.worked_examples import column, force, linear, read


def two(connection, **bodies):
    given = {"a": {"mass": 2, "at": [0, 0]}, "b": {"mass": 3, "at": [0, 2]}} | bodies
    return read({"bodies": given, "connections": [connection]})


def test_gravitation_is_the_product_of_the_masses_over_the_square():
    answer = solve_scene(two({"kind": "gravitation", "name": "g", "a": "a", "b": "b"}))
    assert force(answer, "g.force") == pytest.approx(6.6743e-11 * 6 / 4, rel=1e-15)
    assert linear(answer, "a") == pytest.approx((0, 6.6743e-11 * 3 / 4), rel=1e-15)
    assert answer.energy.potential == pytest.approx(-6.6743e-11 * 6 / 2, rel=1e-15)
    assert answer.energy.conserved


def test_a_negative_strength_repels():
    answer = solve_scene(two({"kind": "inverse-square", "name": "g", "a": "a", "b": "b", "strength": -8}))
    assert force(answer, "g.force") == -2
    assert linear(answer, "b") == pytest.approx((0, 2 / 3), rel=1e-15)


def test_two_attractions_of_one_pair_add_up():
    scene = {
        "bodies": {"a": {"mass": 2, "at": [0, 0]}, "b": {"mass": 3, "at": [0, 2]}},
        "connections": [
            {"kind": "gravitation", "name": "g", "a": "a", "b": "b", "constant": 2},
            {"kind": "inverse-square", "name": "c", "a": "b", "b": "a", "strength": -4},
        ],
    }
    answer = solve_scene(read(scene), [0.5])
    assert linear(answer, "a") == pytest.approx((0, (12 - 4) / 4 / 2), rel=1e-15)
    one = solve_scene(two({"kind": "inverse-square", "a": "a", "b": "b", "strength": 8}), [0.5])
    np.testing.assert_allclose(column(answer, "a.position").values, column(one, "a.position").values, rtol=1e-15)


def test_a_body_pulled_at_a_place_off_its_centre_turns():
    body = {"mass": 1, "inertia": 0.5, "at": [0, 0], "places": {"end": [1, 0]}}
    connection = {"kind": "inverse-square", "a": "p.end", "b": [1, 2], "strength": 4}
    answer = solve_scene(
        read({"bodies": {"p": body}, "connections": [connection]}),
        [1.0],
        ["accelerations", "energy", "trajectory", "energy-in-time"],
    )
    assert answer.accelerations["p"].linear == pytest.approx((0, 1), abs=1e-15)
    assert answer.accelerations["p"].angular == pytest.approx(2, rel=1e-15)
    energy = column(answer, "energy.kinetic").values + column(answer, "energy.potential").values
    assert energy == pytest.approx(answer.energy.total, rel=1e-13)


@pytest.mark.parametrize(
    ("connection", "path"),
    [
        ({"kind": "gravitation", "a": "a", "b": [0, 1]}, ("connections", 0, "b")),
        ({"kind": "gravitation", "a": "a", "b": "light"}, ("connections", 0, "b")),
        ({"kind": "gravitation", "a": "a", "b": "b", "constant": 0}, ("connections", 0, "constant")),
        ({"kind": "gravitation", "a": "a", "b": "a"}, ("connections", 0)),
        ({"kind": "inverse-square", "a": "a", "b": "b", "strength": 0}, ("connections", 0, "strength")),
        ({"kind": "inverse-square", "a": "a", "b": [0, 0], "strength": 1}, ("connections", 0)),
        ({"kind": "inverse-square", "a": [0, 0], "b": [1, 0], "strength": 1}, ("connections", 0)),
    ],
)
def test_what_cannot_attract_is_refused_with_its_path(connection, path):
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(two(connection, light={"mass": 0, "at": [5, 5]}))
    assert fault.value.path == path


def test_what_comes_too_close_ends_with_where_and_when():
    """Three equal masses at rest fall into their centre at pi/2 sqrt(r^3/2 mu), mu = 1/sqrt(3)."""
    bodies = {name: {"mass": 1, "at": {"polar": [1, {"degrees": 120 * i}]}} for i, name in enumerate("abc")}
    pairs = [{"kind": "gravitation", "a": a, "b": b, "constant": 1} for a, b in ("ab", "bc", "ca")]
    scene = read({"bodies": bodies, "connections": pairs})
    # Each is drawn by 1/(sqrt(3) r^2) towards the centre.
    fall = np.pi / 2 / np.sqrt(2 / np.sqrt(3))
    early = solve_scene(scene, [1.4, 2.0])
    assert early.problem is not None
    assert early.problem.code == early.ended.kind == "lost-event"
    assert "m of one another" in early.problem.explanation
    assert early.ended.time == pytest.approx(fall, abs=early.ended.error)
    assert early.trajectory.time.tolist() == [1.4]
    out_of_reach = {"kind": "contact", "name": "floor", "place": "a", "on": {"at": [0, -1000]}}
    with_contact = solve_scene(read({"bodies": bodies, "connections": [*pairs, out_of_reach]}), [1.4, 2.0])
    assert with_contact.ended.kind == "lost-event"
    assert abs(with_contact.ended.time - early.ended.time) <= with_contact.ended.error + early.ended.error
    central = {
        "bodies": {"a": {"mass": 1, "at": [1, 0]}},
        "connections": [{"kind": "inverse-square", "a": "a", "b": [0, 0], "strength": "1/sqrt(3)"}],
    }
    place, alone = column(early, "a.position"), column(solve_scene(read(central), [1.4]), "a.position")
    assert place.values == pytest.approx(alone.values, abs=place.error + alone.error)
