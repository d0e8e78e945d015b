"""Members that are followed together: each has the bits of its answer by itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from tests.core.multibody.members.scenes import Places, double_pendulum, many, sprung_pendulum, with_numbers

ANGLES: Places = (("let", "a"), ("let", "b"))
CASES: dict[str, tuple[Any, Places, Any, float, float]] = {
    # The last angles of which are so chaotic that doubles do not do.
    "angles": (double_pendulum(), ANGLES, [[0.5, 1.0], [-2.9, 0.25], [3.0, 3.1], [1.5, -1.5]], 6.0, 1e-11),
    "masses": (
        double_pendulum(),
        (("bodies", "one", "mass"), ("bodies", "two", "inertia")),
        [[0.5, 0.1], [7.0, 0.03], [1.0, 2.0]],
        1.5,
        1e-9,
    ),
    "spring": (
        sprung_pendulum(),
        (("connections", 2, "stiffness"), ("bodies", "two", "angular_velocity")),
        [[3.0, -0.5], [20.0, 0.7], [0.3, 2.0]],
        2.0,
        1e-9,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_a_member_has_the_bits_of_its_answer_by_itself(name: str) -> None:
    description, places, numbers, end, accuracy = CASES[name]
    times = np.array([0.0, end, end / 3.0, end / 3.0])
    seen = 0
    for some in many(description, places).answered(np.array(numbers), times, accuracy):
        for row, member in zip(some.rows.tolist(), some.members.tolist(), strict=True):
            scene = scene_from(with_numbers(description, places, numbers[member]))
            alone = solve_scene(scene, times, ["trajectory"], accuracy).trajectory
            assert alone is not None
            assert set(alone.columns) == set(some.motion.columns)
            assert alone.accuracy.error == some.motion.error[row]
            for column_name, column in alone.columns.items():
                own = some.motion.columns[column_name]
                assert np.array_equal(column.values, own.values[row])
                assert column.error == own.error[row]
                assert column.scale == some.motion.scales[own.unit][row]
            seen += 1
    assert seen == len(numbers)


def test_what_has_no_place_in_lanes_is_left_out() -> None:
    """A closed form, what decays, a member whose places contradict its connections, and one that cannot be."""
    pendulum = double_pendulum()
    del pendulum["bodies"]["two"], pendulum["connections"][1]
    times = np.array([1.0])
    assert not list(many(pendulum, ANGLES[:1]).answered(np.array([[0.5], [1.0]]), times, 1e-9))
    damped = double_pendulum()
    damped["connections"].append({"kind": "damper", "a": "two", "b": "one", "measure": "turn", "coefficient": 0.2})
    assert not list(many(damped, ANGLES).answered(np.array([[0.5, 1.0]]), times, 1e-9))
    moved = many(double_pendulum(), (("bodies", "one", "places", "top", 0), ("bodies", "one", "mass")))
    numbers = np.array([[-0.5, 1.0], [-0.4, 1.0], [-0.5, -1.0], [-0.5, 1e301], [-0.5, 2.0]])
    assert sorted(k for some in moved.answered(numbers, times, 1e-9) for k in some.members.tolist()) == [0, 4]


def test_scenes_of_other_kinds_are_not_followed_together() -> None:
    """Contacts, sketches, separate parts, what begins, ends or strikes, and strings; times before the start."""
    one = many(double_pendulum(), ANGLES)
    assert one.can_follow(np.array([0.0, 1.0]))
    assert not any(one.can_follow(np.array(times)) for times in ([], [0.0], [-1.0, 1.0]))
    apart = double_pendulum()
    apart["connections"].pop()
    sketch = double_pendulum() | {"assemble": "nearest"}
    strings = double_pendulum()
    strings["connections"][1] = {"kind": "string", "through": ["two.top", "one.end"], "length": 1}
    touching = with_connection(kind="contact", a="two.top", b={"point": [0, -9], "normal": [0, 1]})
    spring = {"kind": "torsion-spring", "a": "two", "b": "one", "stiffness": 3, "rest_angle": 0.2}
    ending, beginning = with_connection(**spring, until=0.5), with_connection(**spring, **{"from": 0.5})
    struck = with_connection(kind="impulse", place="two.end", impulse=[0, 1])
    for description in (apart, sketch, touching, ending, beginning, struck):
        assert not many(description, ANGLES).can_follow(np.array([1.0]))
    # That a string may become slack is seen in its set-up.
    assert not list(many(strings, ANGLES).answered(np.array([[0.5, 1.0]]), np.array([1.0]), 1e-9))


def with_connection(**connection: Any) -> Any:
    """Return a double pendulum with another connection."""
    description = double_pendulum()
    description["connections"].append(connection)
    return description
