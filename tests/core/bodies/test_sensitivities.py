"""Sensitivities of tensors against differences of tensors formed in rational numbers, and of the bodies themselves."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from core.arrays import Floats
from core.bodies.composite import Composite, Part
from core.bodies.measured import InertiaTensor, PointMasses
from core.bodies.mesh import Mesh
from core.bodies.sensitivities import tensor_sensitivities
from core.bodies.solids import Ball, Cone, Cuboid, Torus
from tests.oracles.uncertain_bodies import FACES, KINDS, REGIMES, uncertain

STEP = Fraction(1, 10**12)


def assert_same_rows(found: Floats, expected: Floats, within: float) -> None:
    """Compare two lists of moves in whatever order they are; rows that vanish may be left out."""
    size = np.abs(expected).max()
    expected = expected[np.abs(expected).max(axis=(1, 2)) > within * size]
    found = found[np.abs(found).max(axis=(1, 2)) > within * size]
    assert len(found) == len(expected)
    distances = np.abs(found[:, None] - expected[None, :]).max(axis=(2, 3))
    assert distances.min(axis=0).max() <= within * size
    assert distances.min(axis=1).max() <= within * size


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("regime", REGIMES)
def test_moves_are_derivatives_of_the_tensor(kind: str, regime: str) -> None:
    case = uncertain(31, kind, regime)
    numbers = [Fraction(x) for x in case.numbers]
    before = case.tensor(numbers)
    exponent = int(np.frexp(float(before[2][2]))[1])
    expected = []
    for k, x in enumerate(numbers):
        after = case.tensor([*numbers[:k], x * (1 + STEP), *numbers[k + 1 :]])
        unit = STEP * Fraction(2) ** exponent
        expected.append(
            [[float((p - q) / unit) for p, q in zip(*rows, strict=True)] for rows in zip(after, before, strict=True)]
        )
    found = tensor_sensitivities(case.body(case.numbers).mass_properties(), exponent)
    assert_same_rows(found, np.array(expected), 1e-8)


def differences(body: Callable[[Any], Any], numbers: list[float], about_origin: bool = False) -> Floats:
    def tensor(x: list[float]) -> Floats:
        found = body(x).mass_properties()
        moved = found.inertia_about_origin if about_origin else found.inertia
        assert moved is not None
        return moved

    rows = []
    for k, x in enumerate(numbers):
        near = [tensor([*numbers[:k], x * (1 + h), *numbers[k + 1 :]]) for h in (1e-6, -1e-6)]
        rows.append((near[0] - near[1]) / 2e-6)
    return np.array(rows)


VERTICES = [0.3, 0.2, 0.4, 1.3, 0.1, 0.5, 0.4, 1.2, 0.3, 0.2, 0.4, 1.5]

BODIES: list[tuple[Callable[[Any], Any], list[float]]] = [
    (lambda x: Mesh(density=x[0], vertices=np.array(x[1:]).reshape(-1, 3), faces=FACES), [2.0, *VERTICES]),
    (lambda x: Torus(density=x[0], ring_radius=x[1], tube_radius=x[2]), [3.0, 2.0, 0.5]),
    (lambda x: PointMasses(x[0], np.array(x[1:]).reshape(-1, 3)), [2.0, *VERTICES]),
    (
        lambda x: Composite(
            (
                Part(Cuboid(density=x[0], edges=(x[1], x[2], x[3])), (x[4], x[5], x[6]), (x[7], x[8], x[9], x[10])),
                Part(Ball(mass=x[11], radius=x[12]), (x[13], x[14], x[15]), hole=True),
            )
        ),
        [5.0, 1.0, 2.0, 3.0, 0.4, 0.5, 0.6, 1.0, 0.2, -0.3, 0.1, 0.5, 0.2, 0.3, 0.4, 0.5],
    ),
    (
        lambda x: Composite(
            (
                Part(Composite((Part(Cone(mass=x[0], radius=x[1], height=x[2]), (x[3], 0.0, 0.0)),)), (0.0, x[4], 0.0)),
                Part(Ball(mass=-x[5], radius=x[6])),
                Part(
                    InertiaTensor(
                        ((x[7], 0.1 * x[8], 0.0), (0.1 * x[8], x[9], 0.0), (0.0, 0.0, x[10])),
                        x[11],
                        (x[12], x[13], 0.0),
                    )
                ),
            )
        ),
        [5.0, 1.0, 2.0, 0.3, 0.7, 0.2, 0.3, 1.0, 2.0, 1.5, 2.0, 3.0, 0.6, 0.8],
    ),
]


@pytest.mark.parametrize(("body", "numbers"), BODIES)
def test_moves_of_densities_holes_and_nested_parts(body: Callable[[Any], Any], numbers: list[float]) -> None:
    assert_same_rows(tensor_sensitivities(body(numbers).mass_properties(), 0), differences(body, numbers), 1e-7)


def test_a_pinned_body_moves_about_its_pin() -> None:
    def body(x: list[float]) -> PointMasses:
        return PointMasses(x[:4], np.array(x[4:]).reshape(-1, 3), about="origin")

    numbers = [1.0, 2.0, 0.5, 0.7, *VERTICES]
    assert_same_rows(
        tensor_sensitivities(body(numbers).mass_properties(), 0), differences(body, numbers, about_origin=True), 1e-7
    )
