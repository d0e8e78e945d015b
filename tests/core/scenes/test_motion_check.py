"""Motions of named scenes that do not keep their equation are refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.errors import SelfCheckFailed
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.motion import NamedSceneMotion, Samples
from core.scenes.motion_check import check_motion
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts

TIMES = np.array([0.0, 0.1, 0.25, 0.4])
SCENES = {
    "chain": ChainOnWedge((0.1, 0.2), (0.6, 0.9), 9.81, 2.0, 0.5, 1.1),
    "rod": RodInHole(1.0, 1.0, 1.0, 9.81, 0.4),
    "shafts": UnwindingShafts((2.0, 3.0), (0.1, 0.2), (0.6, 0.9), 9.81, positions=(5.0, 5.0)),
}


class Spoiled:
    """A motion whose samples are changed, or taken at other times."""

    def __init__(self, motion: NamedSceneMotion, change: Callable[[Any], Any], slower: float = 1.0) -> None:
        self.motion, self.change, self.slower = motion, change, slower
        self.model, self.equation, self.states = motion.model, motion.equation, motion.states

    def sample(self, times: Any) -> Samples:
        found = self.motion.sample(self.slower * times)
        return replace(found, values=self.change(found.values))


def rates(factor: float) -> Callable[[Mapping[str, Any]], Mapping[str, Any]]:
    names = ("velocity", "angular_velocity", "velocities", "spins")
    return lambda values: {name: factor * x if name in names else x for name, x in values.items()}


SPOILED: dict[str, Callable[[NamedSceneMotion], Spoiled]] = {
    "rates are too large by a millionth": lambda motion: Spoiled(motion, rates(1.0 + 1e-6)),
    "rates have the wrong sign": lambda motion: Spoiled(motion, rates(-1.0)),
    "the motion takes twice as long": lambda motion: Spoiled(motion, lambda values: values, 0.5),
    "everything is slower": lambda motion: Spoiled(motion, rates(1.0 - 1e-6), 1.0 - 1e-6),
}


@pytest.mark.parametrize("name", SCENES)
def test_right_motions_pass(name: str) -> None:
    motion = SCENES[name].motion_to(1.0)
    check_motion(motion, TIMES)
    if motion.valid_from < -TIMES.max():
        check_motion(motion, -TIMES)


@pytest.mark.parametrize("kind", SPOILED)
@pytest.mark.parametrize("name", SCENES)
def test_wrong_motions_are_refused(name: str, kind: str) -> None:
    with pytest.raises(SelfCheckFailed):
        check_motion(SPOILED[kind](SCENES[name].motion_to(1.0)), TIMES)  # type: ignore[arg-type]


@pytest.mark.parametrize("after", [1e-160, 1e-236, 1e-310])
@pytest.mark.parametrize("scene", SCENES)
def test_places_that_underflow_are_known_to_no_share_of_themselves(scene: str, after: float) -> None:
    """After 1e-236 s something has a velocity, and a place that no double has: the right motion was refused."""
    check_motion(SCENES[scene].motion_to(1.0), np.array([0.0, after]))
