"""Wrong digits are withheld: every number of an answer in digits is held against the description."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest

from core.balls import precision
from core.digits.adaptive_precision import bits_for
from core.digits.exact_inputs import enclosed
from core.multibody.language.scene import Scene
from core.multibody.proven.audited_digits import Digits, Moving, audited_digits
from core.multibody.proven.part_proof import PartProof, ProvenAnswer, ProvenColumn
from core.multibody.proven.proven_answer import proven_answer
from tests.core.multibody.audit.spoiled import description_of
from tests.core.multibody.worked_examples import read

SCENES = ("simple-pendulum", "two-masses-two-springs", "physical-pendulum", "atwood-machine", "asymmetric-top")
TIMES = tuple(Fraction(k, 5) for k in range(16))
DIGITS = 18

Spoil = Callable[[ProvenAnswer, Moving], tuple[ProvenAnswer, Moving]]


def _of_columns(end: str, change: Callable[[Any], Any]) -> Spoil:
    def changed(found: Digits) -> Digits:
        return {
            name: ProvenColumn(change(np.array(column.values, dtype=float)).tolist(), column.unit)
            if name.endswith(end)
            else column
            for name, column in found.items()
        }

    return lambda answer, moving: (
        replace(answer, columns=changed(answer.columns or {})),
        lambda times: changed(moving(times)),
    )


def _slower(answer: ProvenAnswer, moving: Moving) -> tuple[ProvenAnswer, Moving]:
    columns = moving([enclosed(TIMES[row] / 2) for row in answer.rows or ()])
    return replace(answer, columns=columns), lambda times: moving([time / 2 for time in times])


def _of_figures(name: str, change: Callable[[Any], Any]) -> Spoil:
    return lambda answer, moving: (
        replace(answer, **{name: {key: change(one) for key, one in getattr(answer, name).items()}}),
        moving,
    )


SPOILED: dict[str, Spoil] = {
    "places are off by a millionth": _of_columns(".position", lambda x: x * (1.0 + 1e-6)),
    "velocities are off by a millionth": _of_columns(".velocity", lambda x: x * (1.0 + 1e-6)),
    "velocities have the wrong sign": _of_columns(".velocity", lambda x: -x),
    "nothing moves": _of_columns(".velocity", lambda x: 0.0 * x),
    "the motion takes twice as long": _slower,
    "accelerations are off": _of_figures(
        "accelerations", lambda one: replace(one, linear=(float(one.linear[0]) + 1e-6, *one.linear[1:]))
    ),
    "forces are off": _of_figures("forces", lambda one: replace(one, value=float(one.value) + 1e-6)),
    "the energy is off": lambda answer, moving: (
        replace(answer, energy=replace(answer.energy, kinetic=float(answer.energy.kinetic) + 1e-6)),  # type: ignore[type-var, union-attr]
        moving,
    ),
}


@cache
def right(name: str) -> tuple[Scene, ProvenAnswer, Moving]:
    """Return a worked scene, its answer in digits, and its motion."""
    scene = read(description_of(name))
    answer, bits = proven_answer(scene, DIGITS, TIMES), bits_for(DIGITS) + 100
    with precision(bits):
        return scene, answer, PartProof(scene, DIGITS, bits).columns


def differs(one: ProvenAnswer, other: ProvenAnswer) -> bool:
    """Return whether two answers have other numbers."""
    for first, second in ((one.accelerations, other.accelerations), (one.forces, other.forces)):
        if first != second:
            return True
    assert one.columns is not None
    assert other.columns is not None
    values = [
        [np.array(column.values, dtype=float) for column in each.values()] for each in (one.columns, other.columns)
    ]
    return one.energy != other.energy or any(np.abs(x - y).max() > 1e-9 for x, y in zip(*values, strict=True))


@pytest.mark.parametrize("kind", SPOILED)
def test_wrong_digits_are_found(kind: str) -> None:
    count, moments = 0, np.array([float(time) for time in TIMES])
    for name in SCENES:
        scene, answer, moving = right(name)
        with precision(bits_for(DIGITS) + 100):
            spoiled = SPOILED[kind](answer, moving)
            if differs(answer, spoiled[0]):
                count += 1
                assert audited_digits(scene, *spoiled, moments) is not None, name
    assert count >= 3


def test_answers_without_times_are_held_against_the_description() -> None:
    scene = read(description_of("physical-pendulum"))
    found = proven_answer(scene, DIGITS, outputs=("accelerations", "forces"))
    wrong, _ = SPOILED["accelerations are off"](found, dict)
    with precision(bits_for(DIGITS) + 100):
        moving = PartProof(scene, DIGITS, bits_for(DIGITS) + 100).columns
        assert audited_digits(scene, wrong, moving, np.zeros(0)) is not None
