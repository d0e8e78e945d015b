"""Euler's equations of a body about a point, beside which its three axes have too many coordinates to be read."""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.algebra.polynomials import ONE, Ball, is_zero
from core.multibody.formulation.conserved import ENERGY, Conserved
from core.multibody.formulation.trigonometric_sums import Sum, added
from core.multibody.motion.turning_body import TurningBody

Vector = list[Sum]


def euler_equations(body: TurningBody, rates: Sequence[str], down: Sequence[str]) -> dict[str, Sum]:
    """Return what is zero, by the variable whose equation it is: J w' - (J w) x w - c x g, and g' - g x w.

    Parameters
    ----------
    body : TurningBody
    rates : three names
        Components of the angular velocity along the axes of the body.
    down : three names
        Those of the direction of gravity; they have equations where gravity turns the body.
    """
    w = [Sum.variable(name) for name in rates]
    g = [Sum.variable(name) for name in down]
    inertia = _times(body.tensor, [Sum.variable(name, 1) for name in rates])
    gyroscopic = _cross(_times(body.tensor, w), w)
    moment = _cross([Sum.number(x) for x in body.arm], g) if body.arm is not None else None
    found = {}
    for k, name in enumerate(rates):
        found[name] = inertia[k] - gyroscopic[k] - (moment[k] if moment is not None else Sum())
    if body.arm is not None:
        turning = _cross(g, w)
        for k, name in enumerate(down):
            found[name] = Sum.variable(name, 1) - turning[k]
    return found


def conserved_of_body(body: TurningBody, name: str, rates: Sequence[str], down: Sequence[str]) -> list[Conserved]:
    """Return energy, and the angular momentum that gravity does not change: its square, or its vertical component."""
    w = [Sum.variable(name) for name in rates]
    momentum = _times(body.tensor, w)
    energy = _dot(momentum, w).times(ONE / 2)
    if body.arm is None:
        square = _dot(momentum, momentum)
        return [Conserved(ENERGY, name, energy), Conserved("square of the angular momentum", name, square)]
    g = [Sum.variable(name) for name in down]
    fall = added(one.times(x) for one, x in zip(g, body.arm, strict=True))
    along = _dot(momentum, g)
    return [Conserved(ENERGY, name, energy - fall), Conserved("angular momentum along gravity", name, along)]


def _times(matrix: Sequence[Sequence[Ball]], vector: Vector) -> Vector:
    return [added(x.times(a) for a, x in zip(row, vector, strict=True) if not is_zero(a)) for row in matrix]


def _cross(a: Vector, b: Vector) -> Vector:
    return [a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3)]


def _dot(a: Vector, b: Vector) -> Sum:
    return added(x * y for x, y in zip(a, b, strict=True))
