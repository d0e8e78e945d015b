"""Stated errors of the figures of a precession against proven digits, for given and for derived moments."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal, localcontext
from typing import Any

import numpy as np
import pytest

from core.bodies.composite import Composite, Part
from core.bodies.exact_bodies import exact_body
from core.bodies.measured import InertiaTensor, PrincipalMoments
from core.bodies.solids import Cuboid, Cylinder
from core.certified.free_rotation import CertifiedRotation
from core.certified.precession import certified_precession
from core.rotation.precession.precession import FIGURES, precession

DIGITS = 45
Start = tuple[float, float, float]
RANDOM = np.random.default_rng(29)


@pytest.fixture(autouse=True)
def _in_many_digits() -> Iterator[None]:
    with localcontext(prec=60):
        yield


def start() -> Start:
    x, y, z = RANDOM.normal(size=3).tolist()
    return x, y, z


def turned(moments: list[float]) -> list[list[float]]:
    """Return a tensor with about these moments, in axes turned at random."""
    axes, _ = np.linalg.qr(RANDOM.normal(size=(3, 3)))
    tensor = (axes * moments) @ axes.T
    found: list[list[float]] = ((tensor + tensor.T) / 2).tolist()
    return found


def physical() -> list[float]:
    """Return three moments of a body of matter."""
    a, b, c = RANDOM.uniform(0.1, 1.0, size=3).tolist()
    return [b + c, c + a, a + b]


def given() -> tuple[Any, dict[str, Any]]:
    moments = physical()
    return PrincipalMoments((moments[0], moments[1], moments[2])), {"kind": "principal-moments", "moments": moments}


def coin() -> tuple[Any, dict[str, Any]]:
    a, c = sorted(RANDOM.uniform(0.6, 1.0, size=2).tolist())
    return PrincipalMoments((a, a, c)), {"kind": "principal-moments", "moments": [a, a, c]}


def derived() -> tuple[Any, dict[str, Any]]:
    tensor = turned(physical())
    return InertiaTensor(tuple(map(tuple, tensor))), {"kind": "inertia-tensor", "tensor": tensor}


def nearly_equal() -> tuple[Any, dict[str, Any]]:
    a, _, c = physical()
    tensor = turned([a, a * (1.0 + 1e-9), a + c / 2])
    return InertiaTensor(tuple(map(tuple, tensor))), {"kind": "inertia-tensor", "tensor": tensor}


def two_solids() -> tuple[Any, dict[str, Any]]:
    mass, size, radius, place = RANDOM.uniform(0.5, 2.0, size=4).tolist()
    attitude = tuple(RANDOM.normal(size=4).tolist())
    position = (place, 0.3, -0.2)
    body = Composite(
        (
            Part(Cuboid(edges=(size, 1.0, 0.4), mass=mass)),
            Part(Cylinder(radius=radius, height=0.7, mass=1.0), position, attitude),
        )
    )
    return body, {
        "kind": "composite",
        "parts": [
            {"body": {"kind": "cuboid", "edges": [size, 1.0, 0.4], "mass": mass}},
            {
                "body": {"kind": "cylinder", "radius": radius, "height": 0.7, "mass": 1.0},
                "position": list(position),
                "attitude": list(attitude),
            },
        ],
    }


FAMILIES = {"given": given, "coin": coin, "derived": derived, "nearly equal": nearly_equal, "two solids": two_solids}


def compared(body: Any, fields: dict[str, Any], spin: Start) -> list[tuple[str, Decimal, Decimal, float]]:
    """Return name, true and stated error of every figure, and its value."""
    found = precession(body.mass_properties(), spin)
    rotation = CertifiedRotation.of(exact_body(fields).of_motion, spin)
    proven = certified_precession(rotation, DIGITS)
    assert set(found.errors) == {"axis", "middle_axis_tilt", *FIGURES}
    compared = []
    for name, error in found.errors.items():
        value, exact = getattr(found, name), getattr(proven, name)
        if value is None:
            assert error is None, name
        elif exact is not None and name == "axis":
            wrong = sum(
                ((Decimal(x) - Decimal(y)) ** 2 for x, y in zip(exact, value.tolist(), strict=True)), Decimal(0)
            )
            compared.append((name, wrong.sqrt(), Decimal(error), 1.0))
        elif exact is not None and name == "middle_axis_tilt":
            for x, y, e in zip(exact, value, error, strict=True):
                compared.append((name, abs(Decimal(x) - Decimal(y)), Decimal(e), y))
        elif exact is not None:
            compared.append((name, abs(Decimal(exact) - Decimal(value)), Decimal(error), value))
    return compared


@pytest.mark.parametrize("family", FAMILIES)
def test_no_error_is_smaller_than_the_true_one(family: str) -> None:
    figures = [one for _ in range(12) for one in compared(*FAMILIES[family](), start())]
    assert len(figures) > 40
    for name, wrong, stated, value in figures:
        assert wrong <= stated, (name, wrong, stated)
        assert stated <= Decimal("3.34e-16") * abs(Decimal(value)) or name == "axis", (name, stated, value)


@pytest.mark.parametrize("near", [1e-3, 1e-6, 1e-10, 1e-13])
def test_beside_the_separatrix_of_a_turned_body(near: float) -> None:
    for _ in range(4):
        body, fields = derived()
        axis = body.mass_properties().principal_of_motion.axes[:, 1]
        x, y, z = (axis + near * RANDOM.normal(size=3)).tolist()
        for name, wrong, stated, _ in compared(body, fields, (x, y, z)):
            assert wrong <= stated, (name, wrong, stated)


def test_a_body_at_rest_has_no_errors() -> None:
    found = precession(PrincipalMoments((1.0, 2.0, 2.5)).mass_properties(), (0.0, 0.0, 0.0))
    assert set(found.errors.values()) == {None}
