"""The audit of many members at once finds what a member does wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.arrays import Floats
from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.audit.definitions import Description, description_of
from core.multibody.language.reading import scene_from
from core.multibody.members.follow import Followed, followed
from core.multibody.members.member_audit import keep_the_laws, sets_of, windows_of
from core.multibody.members.plan import Plans
from core.multibody.members.recorded_balls import Varied
from tests.core.multibody.members.scenes import Places, double_pendulum, with_numbers

PLACES = (("let", "a"), ("let", "b"))
NUMBERS = np.array([[0.5, 1.0], [0.6, 1.0], [0.7, 1.25]])


@pytest.fixture(scope="module")
def found() -> Followed:
    scene = scene_from(with_numbers(double_pendulum(), PLACES, [Varied(), Varied()]))
    with precision(BITS):
        (only,) = followed(Plans(scene, PLACES), NUMBERS, np.array([2.0]), 1e-9)
    return only


def kept(found: Followed, changes: dict[str, float]) -> bool:
    """Return whether the members keep the laws if the second one's columns are larger by shares of themselves."""
    columns = dict(found.checked)
    for name, share in changes.items():
        values = columns[name].values.copy()
        values[1] *= 1.0 + share
        columns[name] = replace(columns[name], values=values)
    return all(
        keep_the_laws(description, {name: one.of(rows) for name, one in columns.items()}, found.windows.at(rows))
        for rows, description in sets_of(described(NUMBERS), found.error)
    )


def test_members_that_are_right_keep_the_laws(found: Followed) -> None:
    assert len(found.members) == 3
    assert kept(found, {})


@pytest.mark.parametrize(
    "names",
    [
        ("one.position",),
        ("two.angle",),
        ("one.velocity",),
        ("two.angular_velocity",),
        # All rates alike: connections and kinematics apart, the energy is another.
        ("one.velocity", "two.velocity", "one.angular_velocity", "two.angular_velocity"),
    ],
)
def test_a_member_that_is_wrong_is_found(found: Followed, names: tuple[str, ...]) -> None:
    assert not kept(found, dict.fromkeys(names, 1e-8))


def test_a_member_that_begins_elsewhere_is_found(found: Followed) -> None:
    for k in range(NUMBERS.shape[1]):
        numbers = NUMBERS.copy()
        numbers[1, k] += 1e-9
        ((rows, description),) = sets_of(described(numbers), found.error)
        columns = {name: one.of(rows) for name, one in found.checked.items()}
        assert not keep_the_laws(description, columns, found.windows.at(rows))


def test_members_are_in_sets_by_what_their_descriptions_say() -> None:
    """Springs that do not say how long or how far turned they are at rest are so at the start."""
    own = double_pendulum()
    assert sets(own) == [3]
    own["connections"].append({"kind": "torsion-spring", "a": "two", "b": "one", "stiffness": 3})
    assert sets(own) == [1, 1, 1]
    own["connections"][-1]["rest_angle"] = 0.5
    assert sets(own) == [3]
    own["connections"][-1] = {"kind": "spring", "a": "two.end", "b": [3, 0], "stiffness": 3}
    assert sets(own) == [1, 1, 1]
    own["connections"][-1]["rest_length"] = 1.0
    assert sets(own) == [3]
    assert sets(own, (("bodies", "one", "mass"), ("let", "b"))) == [1, 1, 1]


def sets(description: dict[str, Any], places: Places = PLACES) -> list[int]:
    """Return how many members are audited together."""
    return [len(rows) for rows, _ in sets_of(described(NUMBERS, description, places), np.zeros(len(NUMBERS)))]


def described(numbers: Floats, description: dict[str, Any] | None = None, places: Places = PLACES) -> list[Description]:
    """Return what members are, of double pendulums unless others are given."""
    own = double_pendulum() if description is None else description
    return [description_of(scene_from(with_numbers(own, places, row))) for row in numbers.tolist()]


def test_windows_depend_on_the_member_alone() -> None:
    one = windows_of(NUMBERS, np.array([0.25, 0.5, 0.25]), 10.0)
    other = windows_of(NUMBERS[1:2], np.array([0.5]), 10.0)
    assert one.times[1].tolist() == other.times[0].tolist()
    assert (one.times >= 0.0).all()
    assert (one.times <= 10.0).all()
    assert len(set(one.times[:, 1].tolist())) == 3
