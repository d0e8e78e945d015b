"""Right answers, and ways to spoil them: each is a fault that a solver may have."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import core.multibody.solve as solving
from core.multibody.answer import SceneSolution
from core.multibody.audit.audit import audited
from core.multibody.audit.failure import Failure, Verdict
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.systems.trajectory import Column

FOLDER = Path(__file__).parents[4] / "examples" / "scenes"
DESCRIBED = ("gravity", "bodies", "connections", "let", "numbers", "assemble")
OUTPUTS = ("accelerations", "forces", "energy", "trajectory", "forces-in-time")
SLOW = {"ball-in-bowl", "foucault-pendulum", "painleve-chalk"}
"""Motions that take long, and one that is none."""
TIMES = np.array([0.0, 0.13, 0.31, 0.5])

Columns = Mapping[str, Column]
Change = Callable[[Columns], Columns]


@dataclass(frozen=True)
class Audited:
    """An answer with all that its audit sees."""

    scene: Scene
    answer: SceneSolution
    sampler: Callable[[Any, bool], Columns]
    times: Any

    def failure(self) -> Failure | None:
        """Return what the audit finds."""
        return audited(self.scene, self.answer, self.sampler, self.times).failure

    def with_columns(self, change: Change) -> Audited:
        """Return the answer with a motion whose columns are changed, where they are answered and between."""
        motion = self.answer.trajectory
        assert motion is not None
        answer = replace(self.answer, trajectory=replace(motion, columns=change(motion.columns)))
        return replace(self, answer=answer, sampler=lambda times, forces: change(self.sampler(times, forces)))


def description_of(name: str) -> dict[str, Any]:
    """Return the description of a worked scene."""
    request = json.loads((FOLDER / f"{name}.json").read_text())
    return {key: request[key] for key in DESCRIBED if key in request}


def answered(description: dict[str, Any], times: Any = TIMES, outputs: Any = OUTPUTS) -> Audited:
    """Return the answer to a scene, unaudited, and its motion."""
    scene, kept = scene_from(description), []

    def keep(part: Scene, answer: SceneSolution, sampler: Any, asked: Any) -> Verdict:
        kept.append(Audited(part, answer, sampler, asked))
        return Verdict()

    own, solving.audited = solving.audited, keep
    try:
        solving.solve_scene(scene, times, outputs)
    finally:
        solving.audited = own
    return kept[0]


def worked() -> dict[str, dict[str, Any]]:
    """Return the descriptions of the worked scenes by name."""
    return {path.stem: description_of(path.stem) for path in sorted(FOLDER.glob("*.json")) if path.stem not in SLOW}


def _column(column: Column, values: Any) -> Column:
    return replace(column, values=values)


def _each(suffix: str, change: Callable[[Any], Any], first: bool = True) -> Change:
    """Return a change of the first column, or of all, with a suffix whose values are not all zero."""

    def changed(columns: Columns) -> Columns:
        found = dict(columns)
        names = [name for name in columns if name.endswith(suffix)]
        for name in names[:1] if first else names:
            found[name] = _column(columns[name], change(columns[name].values))
        return found

    return changed


def _forces(columns: Columns, *endings: str) -> list[str]:
    return [
        name
        for name, one in columns.items()
        if one.unit in ("N", "N m") and name.endswith(endings) and np.max(np.abs(one.values)) > 1e-3
    ]


def _of_forces(change: Callable[[Any], Any], *endings: str) -> Change:
    def changed(columns: Columns) -> Columns:
        found = dict(columns)
        for name in _forces(columns, *endings)[:1]:
            found[name] = _column(columns[name], change(columns[name].values))
        return found

    return changed


def _tilted(values: Any) -> Any:
    half = 5e-7
    w, x, y, z = values.T
    return np.stack([w - half * x, x + half * w, y + half * z, z - half * y], axis=1)


ANY = (".normal", ".tension", ".force", ".torque", ".friction", ".x", ".y", ".z", ".1", ".2")

COLUMNS: dict[str, Change] = {
    "a place is off by a millionth": _each(".position", lambda x: x + 1e-6),
    "all places are off by a millionth along the first axis": _each(
        ".position", lambda x: x + 1e-6 * np.eye(x.shape[1])[0], first=False
    ),
    "places are too far out by a millionth": _each(".position", lambda x: x * (1.0 + 1e-6), first=False),
    "places are reflected": _each(".position", lambda x: -x, first=False),
    "velocities are too large by a millionth": _each(".velocity", lambda x: x * (1.0 + 1e-6), first=False),
    "velocities have the wrong sign": _each(".velocity", lambda x: -x, first=False),
    "a velocity is off by a millionth": _each(".velocity", lambda x: x + 1e-6),
    "a body does not move": _each(".velocity", lambda x: 0.0 * x),
    "velocities are halved": _each(".velocity", lambda x: 0.5 * x, first=False),
    "components of velocities are exchanged": _each(".velocity", lambda x: x[:, ::-1], first=False),
    "an angle is off by a millionth": _each(".angle", lambda x: x + 1e-6),
    "an angle has the wrong sign": _each(".angle", lambda x: -x),
    "an angle is off by a hundredth of itself": _each(".angle", lambda x: 1.01 * x),
    "a spin is too large by a millionth": _each(".angular_velocity", lambda x: x * (1.0 + 1e-6)),
    "a spin has the wrong sign": _each(".angular_velocity", lambda x: -x),
    "nothing spins": _each(".angular_velocity", lambda x: 0.0 * x, first=False),
    "an attitude is off by a millionth": _each(".attitude", _tilted),
    "an attitude is the inverse one": _each(".attitude", lambda x: x * np.array([1.0, -1.0, -1.0, -1.0])),
    "an axis is off by a millionth": _each(".axis", lambda x: x + 1e-6 * np.roll(x, 1, axis=1)),
    "a force is too large by a millionth": _of_forces(lambda x: x * (1.0 + 1e-6), *ANY),
    "a force is off by a millionth": _of_forces(lambda x: x + 1e-6, *ANY),
    "a force has the wrong sign": _of_forces(lambda x: -x, *ANY),
    "a force is missing": _of_forces(lambda x: 0.0 * x, *ANY),
    "a tension pushes": _of_forces(lambda x: -x, ".tension"),
    "a normal force pulls": _of_forces(lambda x: -x, ".normal"),
    "a normal force is halved": _of_forces(lambda x: 0.5 * x, ".normal"),
    "friction has the wrong sign": _of_forces(lambda x: -x, ".friction", ".friction.x"),
    "friction is doubled": _of_forces(lambda x: 2.0 * x, ".friction", ".friction.x"),
    "friction is missing": _of_forces(lambda x: 0.0 * x, ".friction", ".friction.x"),
}
"""What may be wrong with the columns of a motion."""


def _later(self: Audited, shift: Callable[[Any], Any]) -> Audited:
    """Return an answer whose motion is that of other times."""
    motion = self.answer.trajectory
    assert motion is not None
    trajectory = replace(motion, columns=self.sampler(shift(motion.time), True))
    return replace(
        self,
        answer=replace(self.answer, trajectory=trajectory),
        sampler=lambda times, forces: self.sampler(shift(np.asarray(times)), forces),
    )


def _with_figures(self: Audited, name: str, change: Callable[[Any], Any]) -> Audited:
    given = getattr(self.answer, name)
    if not given:
        return self
    first = next(iter(given))
    return replace(self, answer=replace(self.answer, **{name: {**given, first: change(given[first])}}))


def _with_energy(self: Audited, name: str) -> Audited:
    energy = self.answer.energy
    assert energy is not None
    return replace(
        self, answer=replace(self.answer, energy=replace(energy, **{name: getattr(energy, name) * 1.001 + 1e-3}))
    )


def _with_period(self: Audited, factor: float) -> Audited:
    period = self.answer.period
    return self if period is None else replace(self, answer=replace(self.answer, period=factor * period))


def _turned_faster(self: Audited) -> Audited:
    given = self.answer.accelerations
    assert given is not None
    found = {
        name: one if one.angular is None or isinstance(one.angular, tuple) else replace(one, angular=one.angular + 1e-6)
        for name, one in given.items()
    }
    return replace(self, answer=replace(self.answer, accelerations=found))


MOTIONS: dict[str, Callable[[Audited], Audited]] = {
    "nothing moves": lambda one: _later(one, lambda t: 0.0 * t),
    "the motion is too fast by a millionth": lambda one: _later(one, lambda t: t * (1.0 + 1e-6)),
    "the motion takes twice as long": lambda one: _later(one, lambda t: 0.5 * t),
    "the motion began a microsecond before": lambda one: _later(one, lambda t: t + 1e-6),
    "an acceleration at the start is off": lambda one: _with_figures(
        one, "accelerations", lambda x: replace(x, linear=(x.linear[0] + 1e-6, *x.linear[1:]))
    ),
    "an acceleration at the start has the wrong sign": lambda one: _with_figures(
        one, "accelerations", lambda x: replace(x, linear=tuple(-y for y in x.linear))
    ),
    "an angular acceleration at the start is off": _turned_faster,
    "a force at the start is off": lambda one: _with_figures(
        one, "forces", lambda x: x if x.value is None else replace(x, value=x.value + 1e-6)
    ),
    "the period is twice as long": lambda one: _with_period(one, 2.0),
    "the period is three times as long": lambda one: _with_period(one, 3.0),
    "the period is half as long": lambda one: _with_period(one, 0.5),
    "the period is off by a millionth": lambda one: _with_period(one, 1.0 + 1e-6),
    "the kinetic energy at the start is off": lambda one: _with_energy(one, "kinetic"),
    "the potential energy at the start is off": lambda one: _with_energy(one, "potential"),
}
"""What may be wrong with a motion, or with what is answered about its start."""


def _numbers(value: Any, key: str) -> Iterator[tuple[Any, Any]]:
    """Yield the places of the plain numbers that stand under a key, at any depth."""
    if isinstance(value, dict):
        for name, entry in value.items():
            if name == key and isinstance(entry, (int, float)) and entry:
                yield value, name
            elif name == key and isinstance(entry, list):
                yield from ((entry, i) for i, x in enumerate(entry) if isinstance(x, (int, float)) and x)
            else:
                yield from _numbers(entry, key)
    elif isinstance(value, list):
        for entry in value:
            yield from _numbers(entry, key)


OF_OTHERS = (
    "gravity", "mass", "inertia", "moments", "stiffness", "rest_length", "coefficient", "friction", "force", "torque",
    "rate", "constant", "strength", "density",
)  # fmt: skip
"""Numbers of a description: the answer is that to a scene in which one of them is larger by a thousandth."""


def another(description: dict[str, Any], key: str) -> dict[str, Any] | None:
    """Return a description in which one number is larger by a thousandth, None where it has no such number."""
    other = copy.deepcopy(description)
    for holder, name in _numbers(other, key):
        holder[name] = holder[name] * 1.001
        return other
    return None
