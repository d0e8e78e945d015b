"""Two answers about one motion agree within what both state: scenes turned, moved, mirrored, written in another way."""

from __future__ import annotations

import copy
from collections.abc import Mapping

import pytest

from tests.core.multibody.relations.hard_scenes import hard_scenes
from tests.core.multibody.relations.numbers import Json
from tests.core.multibody.relations.relations import MOVED_A_LITTLE, NAMES, RELATIONS, checked, checked_by_digits
from tests.core.multibody.relations.sources import catalogue, random_scene, without_search
from tests.drawn import draws

SLOW = ("block whose string reaches its pulley", "two stones on humps with a string")
"""Scenes that take seconds: their motion ends where a search does not see it, or nothing moves what is searched."""
HARD = {name: without_search(scene) for name, scene in hard_scenes().items() if name not in SLOW}
CATALOGUE = {name: without_search(scene) for name, scene in catalogue().items()}
SEARCHED = 4
"""Of so many random scenes one is searched for a speed too."""
SEEDS = draws(150)
FAR = "moved far"
"""The relation that has tests of its own; the others take turns."""
IN_TURN = [name for name in NAMES if name != FAR]
KNOWN: dict[tuple[str, str], str] = {}
"""Scenes whose answers are known to differ by a relation, and what is wrong."""


def marked(scene: str, relation: str) -> object:
    """Return a scene and a relation as a parameter, which is expected to fail where that is known."""
    reason = KNOWN.get((scene, relation))
    marks = [] if reason is None else [pytest.mark.xfail(strict=True, reason=reason)]
    return pytest.param(scene, relation, marks=marks, id=f"{scene}, {relation}")


def in_turn(scenes: Mapping[str, Json], count: int) -> list[object]:
    """Return scenes with so many relations each that say something about them; all relations take turns."""
    names, found, first = [name for name in RELATIONS if name != FAR], [], 0
    for scene, request in scenes.items():
        order = [names[(first + i) % len(names)] for i in range(len(names))]
        chosen = [name for name in order if RELATIONS[name](copy.deepcopy(request)) is not None][:count]
        found += [marked(scene, name) for name in chosen]
        first += count
    return found


def of_seed(seed: int) -> object:
    """Return a random scene and a relation; the relations take turns."""
    relation = IN_TURN[(seed + seed // len(IN_TURN)) % len(IN_TURN)]
    return marked(str(seed), relation)


@pytest.mark.parametrize(("seed", "relation"), [of_seed(seed) for seed in range(SEEDS)])
def test_random_scenes(seed: str, relation: str) -> None:
    request = random_scene(int(seed))
    assert not checked(without_search(request) if int(seed) % SEARCHED else request, relation, int(seed))


@pytest.mark.parametrize("seed", [12342, 22017])
def test_moments_that_are_equal_no_more(seed: int) -> None:
    assert not checked(without_search(random_scene(seed)), MOVED_A_LITTLE, seed)


@pytest.mark.parametrize("seed", range(300, 309))
def test_samples_have_their_proven_digits(seed: int) -> None:
    assert not checked_by_digits(random_scene(seed))


@pytest.mark.parametrize(("scene", "relation"), in_turn(HARD, 3))
def test_hard_scenes(scene: str, relation: str) -> None:
    assert not checked(HARD[scene], relation)


@pytest.mark.parametrize(("scene", "relation"), in_turn(CATALOGUE, 1))
def test_the_catalogue(scene: str, relation: str) -> None:
    assert not checked(CATALOGUE[scene], relation)


@pytest.mark.parametrize("scene", ["breaking-string", "pendulum-on-a-nail"])
def test_occasions_name_what_is_renamed(scene: str) -> None:
    assert not checked(CATALOGUE[scene], "renamed")


EVERY = {**CATALOGUE, **HARD}
ALSO_FAR = ["rocking-block", "loop and a mass that is attracted"]


@pytest.mark.parametrize("scene", [name for k, name in enumerate(EVERY) if k % 8 == 3] + ALSO_FAR)
def test_a_thousand_kilometres_away(scene: str) -> None:
    assert not checked(EVERY[scene], FAR)


@pytest.mark.parametrize("seed", [3, 278, *range(7, draws(150), 25)])
def test_random_scenes_a_thousand_kilometres_away(seed: int) -> None:
    """Of the first two, bounces were summed up later there: squares of coordinates were wide."""
    assert not checked(without_search(random_scene(seed)), FAR)
