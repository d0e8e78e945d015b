"""Laws that every body in the catalogue obeys, judged by quadrature, by meshes and by the laws themselves.

Nothing here repeats a formula of the solids: their moments are integrated numerically from cross-sections (mpmath, 30
digits) and approached by triangle meshes.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter

from core import bodies
from core.bodies import Body
from core.bodies.composite import Composite, Part
from core.bodies.mass_properties import MassProperties
from core.bodies.measured import InertiaTensor, PointMasses
from core.bodies.mesh import Mesh
from core.bodies.uniform import Uniform
from core.quantities import members_of
from tests.core.bodies.example_bodies import EXAMPLES

CONTEXT = mp.mp.clone()
CONTEXT.dps = 30

TETRAHEDRON: Any = {
    "vertices": [[0.1, 0.2, 0.3], [1.7, 0.1, 0.0], [0.2, 2.1, 0.4], [0.3, 0.4, 2.9]],
    "faces": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
}
SPECIMENS: dict[str, Any] = {
    "principal-moments": bodies.PrincipalMoments((3.1, 1.7, 2.3)),
    "inertia-tensor": InertiaTensor(
        ((3.0, -0.1, 0.3), (-0.1, 4.0, -0.7), (0.3, -0.7, 5.0)), mass=1.3, center_of_mass=(0.3, -1.1, 2.7)
    ),
    "point-masses": PointMasses([1.0, 2.5, 0.3, 0.7], [[0.1, 0.2, 0.3], [1.7, 0, 0], [0.2, 2.1, 0.4], [0.3, 0.4, 3]]),
    "ball": bodies.Ball(radius=0.7, density=3.3),
    "cuboid": bodies.Cuboid(edges=(0.3, 1.7, 2.9), density=3.3),
    "cylinder": bodies.Cylinder(radius=0.7, height=1.9, density=3.3),
    "rod": bodies.Rod(length=1.9, radius=0.1, density=3.3),
    "ellipsoid": bodies.Ellipsoid(semi_axes=(0.3, 1.7, 2.9), density=3.3),
    "cone": bodies.Cone(radius=0.7, height=1.9, density=3.3),
    "spherical-shell": bodies.SphericalShell(outer_radius=0.7, inner_radius=0.6, density=3.3),
    "cylindrical-shell": bodies.CylindricalShell(outer_radius=0.7, inner_radius=0.6, height=1.9, density=3.3),
    "disc": bodies.Disc(radius=0.7, thickness=0.1, density=3.3),
    "torus": bodies.Torus(ring_radius=1.1, tube_radius=0.3, density=3.3),
    "capsule": bodies.Capsule(radius=0.7, length=1.9, density=3.3),
    "hemisphere": bodies.Hemisphere(radius=0.7, density=3.3),
    "composite": Composite(
        (
            Part(bodies.Cuboid(edges=(1.0, 2.0, 3.0), mass=6.0), (1.0, 0.1, 0.0), (1.0, 0.2, -0.3, 0.4)),
            Part(bodies.Ball(radius=0.3, mass=-0.1), (1.1, 0.2, 0.3)),
        )
    ),
    "mesh": Mesh(**TETRAHEDRON, density=3.3),
}
WEIGHED = [kind for kind in SPECIMENS if kind != "principal-moments"]
UNIFORM = [kind for kind, body in SPECIMENS.items() if isinstance(body, Uniform)]

quaternions = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: sum(x * x for x in q) > 1e-3)
positions = st.tuples(*[st.floats(-100, 100)] * 3)


def exact(value: Any, tail: Any) -> np.ndarray:
    """Return value + tail as an array of fractions."""
    pairs = zip(np.ravel(value), np.ravel(tail), strict=True)
    return np.array([Fraction(float(v)) + Fraction(float(t)) for v, t in pairs]).reshape(np.shape(value))


def tensor(found: MassProperties) -> np.ndarray:
    return exact(found.inertia, found.inertia_tail)


def center(found: MassProperties) -> np.ndarray:
    return np.array(found.exact_center_of_mass)


def close(found: np.ndarray, true: np.ndarray, tolerance: float = 1e-29, size: Any = None) -> bool:
    size = max(abs(x) for x in np.ravel(true)) if size is None else size
    return all(abs(x) <= tolerance * size for x in np.ravel(found - true))


def test_every_kind_has_a_specimen() -> None:
    assert {member.kind for member in members_of(Body)} == set(SPECIMENS)
    assert all(type(SPECIMENS[member.kind]) is member for member in members_of(Body))


@pytest.mark.parametrize("body", [*SPECIMENS.values(), *EXAMPLES.values()], ids=lambda body: body.kind)
def test_mass_properties_are_those_of_matter(body: Any) -> None:
    found = body.mass_properties()
    assert found.validity.physical, found.validity.violations
    assert (np.diff(found.principal.moments) >= 0).all()
    axes = exact(found.principal.axes, found.principal.axes_tail)
    moments = exact(found.principal.moments, found.principal.moments_tail)
    assert close(axes @ np.diag(moments) @ axes.T, tensor(found))
    assert close(axes @ axes.T, np.eye(3, dtype=int) * Fraction(1))
    assert np.linalg.det(found.principal.axes) == pytest.approx(1.0)
    assert not found.inertia.flags.writeable


@pytest.mark.parametrize("kind", WEIGHED)
@settings(deadline=None, max_examples=15)
@given(attitude=quaternions, position=positions)
def test_covariance_under_rotation_and_displacement(
    kind: str, attitude: tuple[float, ...], position: tuple[float, ...]
) -> None:
    own = SPECIMENS[kind].mass_properties()
    moved = Composite((Part(SPECIMENS[kind], position, attitude),)).mass_properties()
    turn = np.column_stack([_turned(attitude, axis) for axis in np.eye(3)])
    assert moved.exact_mass == own.exact_mass
    assert close(tensor(moved), turn @ tensor(own) @ turn.T)
    place = turn @ center(own) + [Fraction(x) for x in position]
    assert close(center(moved), place, size=1 + max(abs(x) for x in position))
    assert close(
        exact(moved.principal.moments, moved.principal.moments_tail),
        exact(own.principal.moments, own.principal.moments_tail),
        1e-28,
    )


def _turned(q: Sequence[float], v: Any) -> list[Fraction]:
    """Return q v q*/|q|^2 by products of quaternions."""
    w, x, y, z = (Fraction(c) for c in q)
    n = w * w + x * x + y * y + z * z
    return [c / n for c in _product(_product((w, x, y, z), (0, *map(Fraction, v))), (w, -x, -y, -z))[1:]]


def _product(p: Sequence[Any], q: Sequence[Any]) -> tuple[Any, ...]:
    a, b, c, d = p
    e, f, g, h = q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


@pytest.mark.parametrize("kind", WEIGHED)
def test_two_bodies_and_their_dumbbell(kind: str) -> None:
    # Steiner read backwards: of two equal bodies at +-d the tensor about the middle exceeds the sum by 2 m (d^2 - d d).
    body = SPECIMENS[kind]
    own = body.mass_properties()
    d = np.array([Fraction(x) for x in (3.0, -5.0, 0.5)])
    pair = Composite((Part(body, (3.0, -5.0, 0.5)), Part(body, (-3.0, 5.0, -0.5)))).mass_properties()
    excess = tensor(pair) - 2 * tensor(own)
    assert close(excess, 2 * own.exact_mass * (np.eye(3, dtype=int) * (d @ d) - np.outer(d, d)), 1e-28)
    assert close(center(pair), center(own), size=6)


@pytest.mark.parametrize("kind", WEIGHED)
@settings(deadline=None, max_examples=10)
@given(point=positions)
def test_steiner_gives_back_what_it_took(kind: str, point: tuple[float, float, float]) -> None:
    # About any point the body is as heavy to turn as its centre of mass with all the mass, and the body about that.
    found = SPECIMENS[kind].mass_properties()
    about = exact(*found.inertia_about(point))
    lever = np.array([Fraction(x) for x in point]) - center(found)
    spin = np.array([Fraction(x) for x in (1, -2, 3)])
    crossed = np.array([spin[1] * lever[2] - spin[2] * lever[1], spin[2] * lever[0] - spin[0] * lever[2],
                        spin[0] * lever[1] - spin[1] * lever[0]])  # fmt: skip
    energy = spin @ tensor(found) @ spin + found.exact_mass * (crossed @ crossed)
    assert abs(spin @ about @ spin - energy) <= 1e-29 * energy


@pytest.mark.parametrize("kind", UNIFORM)
@pytest.mark.parametrize(("length", "weight"), [(200, 30), (-200, -30), (1, 0)])
def test_scaling_by_powers_of_two_is_exact(kind: str, length: int, weight: int) -> None:
    body = SPECIMENS[kind]
    own = body.mass_properties()
    grown = _scaled(body, length, math.ldexp(own.mass, weight)).mass_properties()
    weighed = dataclasses.replace(body, mass=own.mass, density=None).mass_properties()
    assert (grown.inertia == np.ldexp(weighed.inertia, 2 * length + weight)).all()
    assert (grown.inertia_tail == np.ldexp(weighed.inertia_tail, 2 * length + weight)).all()
    assert (grown.center_of_mass == np.ldexp(weighed.center_of_mass, length)).all()
    assert close(tensor(weighed), tensor(own), 1e-15)


def _scaled(body: Any, exponent: int, mass: float) -> Any:
    def grow(value: Any) -> Any:
        if isinstance(value, float):
            return math.ldexp(value, exponent)
        return np.ldexp(value, exponent) if isinstance(value, np.ndarray) else tuple(map(grow, value))

    keep = {"mass", "density", "kind", "faces"}
    dimensions = {f.name: grow(getattr(body, f.name)) for f in dataclasses.fields(body) if f.name not in keep}
    return dataclasses.replace(body, **dimensions, mass=mass, density=None)


def _whole(*parts: Part) -> MassProperties:
    return Composite(parts).mass_properties()


ASIDE = (0.0, 1.0, 0.0, 0.0)
"""Half a turn about x: what pointed up points down."""
SPLIT: dict[str, tuple[Any, tuple[Part, ...]]] = {
    "cuboid into two": (
        bodies.Cuboid(edges=(1.0, 2.0, 3.0), density=0.7),
        (
            Part(bodies.Cuboid(edges=(0.25, 2.0, 3.0), density=0.7), (-0.375, 0.0, 0.0)),
            Part(bodies.Cuboid(edges=(0.75, 2.0, 3.0), density=0.7), (0.125, 0.0, 0.0)),
        ),
    ),
    "cylinder into two": (
        bodies.Cylinder(radius=0.7, height=3.0, density=0.7),
        (
            Part(bodies.Rod(radius=0.7, length=1.0, density=0.7), (0.0, 0.0, -1.0)),
            Part(bodies.Disc(radius=0.7, thickness=2.0, density=0.7), (0.0, 0.0, 0.5)),
        ),
    ),
    "ball into half-balls": (
        bodies.Ball(radius=0.7, density=0.7),
        (
            Part(bodies.Hemisphere(radius=0.7, density=0.7)),
            Part(bodies.Hemisphere(radius=0.7, density=0.7), attitude=ASIDE),
        ),
    ),
    "capsule into cylinder and half-balls": (
        bodies.Capsule(radius=0.7, length=3.0, density=0.7),
        (
            Part(bodies.Cylinder(radius=0.7, height=3.0, density=0.7)),
            Part(bodies.Hemisphere(radius=0.7, density=0.7), (0.0, 0.0, 1.5)),
            Part(bodies.Hemisphere(radius=0.7, density=0.7), (0.0, 0.0, -1.5), ASIDE),
        ),
    ),
    "shell as a ball with a hole": (
        bodies.SphericalShell(outer_radius=0.7, inner_radius=0.3, density=0.7),
        (Part(bodies.Ball(radius=0.7, density=0.7)), Part(bodies.Ball(radius=0.3, density=-0.7))),
    ),
    "tube as a cylinder with a hole": (
        bodies.CylindricalShell(outer_radius=0.7, inner_radius=0.3, height=2.0, density=0.7),
        (
            Part(bodies.Cylinder(radius=0.7, height=2.0, density=0.7)),
            Part(bodies.Cylinder(radius=0.3, height=2.0, density=0.7), hole=True),
        ),
    ),
    "cone cut off and its tip": (
        bodies.Cone(radius=1.0, height=2.0, density=0.7),
        (
            Part(bodies.Cone(radius=1.0, height=2.0, density=0.7)),
            Part(bodies.Cone(radius=0.5, height=1.0, density=-0.7), (0.0, 0.0, 1.0)),
            Part(bodies.Cone(radius=0.5, height=1.0, density=0.7), (0.0, 0.0, 1.0)),
        ),
    ),
    "ball as an ellipsoid": (
        bodies.Ball(radius=0.7, density=0.7),
        (Part(bodies.Ellipsoid(semi_axes=(0.7, 0.7, 0.7), density=0.7)),),
    ),
}


@pytest.mark.parametrize(("body", "parts"), SPLIT.values(), ids=SPLIT.keys())
def test_a_body_is_the_sum_of_its_parts(body: Any, parts: tuple[Part, ...]) -> None:
    one, sum_of = body.mass_properties(), _whole(*parts)
    assert close(np.array([one.exact_mass]), np.array([sum_of.exact_mass]))
    assert close(tensor(one), tensor(sum_of))
    assert close(center(one), center(sum_of), size=1)


Profile = Callable[[Any], tuple[Any, Any]]
"""Squares of outer and inner radius of a cross-section at height z."""


def _profiles() -> dict[str, tuple[list[Any], Profile]]:
    """Return for each solid of revolution the pieces of its axis and its cross-section, from the specimens' sizes."""
    m = CONTEXT.mpf

    def inside(radius: float, z: Any, level: Any = 0) -> Any:
        return max(m(radius) ** 2 - (z - level) ** 2, m(0))

    def torus(z: Any) -> tuple[Any, Any]:
        half = CONTEXT.sqrt(inside(0.3, z))
        return (m(1.1) + half) ** 2, (m(1.1) - half) ** 2

    def capsule(z: Any) -> tuple[Any, Any]:
        return inside(0.7, max(abs(z) - m(1.9) / 2, m(0))), m(0)

    half = m(1.9) / 2
    return {
        "ball": ([-m(0.7), m(0.7)], lambda z: (inside(0.7, z), m(0))),
        "cylinder": ([-half, half], lambda z: (m(0.7) ** 2, m(0))),
        "rod": ([-half, half], lambda z: (m(0.1) ** 2, m(0))),
        "disc": ([-m(0.1) / 2, m(0.1) / 2], lambda z: (m(0.7) ** 2, m(0))),
        "cone": ([m(0), m(1.9)], lambda z: ((m(0.7) * (1 - z / m(1.9))) ** 2, m(0))),
        "spherical-shell": (
            [-m(0.7), -m(0.6), m(0.6), m(0.7)],
            lambda z: (inside(0.7, z), inside(0.6, z)),
        ),
        "cylindrical-shell": ([-half, half], lambda z: (m(0.7) ** 2, m(0.6) ** 2)),
        "torus": ([-m(0.3), m(0), m(0.3)], torus),
        "capsule": ([-half - m(0.7), -half, half, half + m(0.7)], capsule),
        "hemisphere": ([m(0), m(0.7)], lambda z: (inside(0.7, z), m(0))),
    }


PROFILES = _profiles()


@pytest.mark.parametrize("kind", PROFILES)
def test_solids_of_revolution_against_quadrature(kind: str) -> None:
    pieces, profile = PROFILES[kind]

    def integral(of: Callable[[Any, Any, Any], Any]) -> Any:
        return CONTEXT.quad(lambda z: CONTEXT.pi * of(*profile(z), z), pieces)

    mass = CONTEXT.mpf(3.3) * integral(lambda a, b, z: a - b)
    height = CONTEXT.mpf(3.3) * integral(lambda a, b, z: (a - b) * z) / mass
    axial = CONTEXT.mpf(3.3) * integral(lambda a, b, z: (a * a - b * b) / 2)
    across = axial / 2 + CONTEXT.mpf(3.3) * integral(lambda a, b, z: (a - b) * (z - height) ** 2)
    found = SPECIMENS[kind].mass_properties()
    for got, true in ((found.exact_mass, mass), (found.exact_center_of_mass[2], height)):
        assert abs(_mp(got) - true) < 1e-26 * (1 + abs(true))
    for got, true in zip(np.diag(tensor(found)), (across, across, axial), strict=True):
        assert abs(_mp(got) - true) < 1e-26 * true
    assert not (tensor(found) - np.diag(np.diag(tensor(found)))).any()


def _mp(number: Fraction) -> Any:
    return CONTEXT.mpf(number.numerator) / number.denominator


@pytest.mark.parametrize("kind", ["cuboid", "ellipsoid"])
def test_solids_without_an_axis_against_quadrature(kind: str) -> None:
    # Slices perpendicular to each axis; the size of a slice is all that differs.
    sizes = [CONTEXT.mpf(x) for x in (0.3, 1.7, 2.9)]
    second = []
    for k, size in enumerate(sizes):
        p, q = (s for j, s in enumerate(sizes) if j != k)
        if kind == "cuboid":
            mass = CONTEXT.mpf(3.3) * p * q * size
            second.append(CONTEXT.mpf(3.3) * CONTEXT.quad(lambda x, a=p * q: a * x * x, [-size / 2, size / 2]))
        else:
            slices = [-size, size]
            mass = CONTEXT.mpf(3.3) * CONTEXT.quad(
                lambda x, a=p * q, s=size: CONTEXT.pi * a * (1 - (x / s) ** 2), slices
            )
            second.append(
                CONTEXT.mpf(3.3)
                * CONTEXT.quad(lambda x, a=p * q, s=size: CONTEXT.pi * a * (1 - (x / s) ** 2) * x * x, slices)
            )
    found = SPECIMENS[kind].mass_properties()
    assert abs(_mp(found.exact_mass) - mass) < 1e-27 * mass
    for i, got in enumerate(np.diag(tensor(found))):
        true = sum(second) - second[i]
        assert abs(_mp(got) - true) < 1e-27 * true


def test_infinitely_thin_bodies_against_quadrature() -> None:
    # Over the curve or surface itself, mass 1: a rod along z, a disc of rings, a sphere of rings, a tube of rings.
    q, pi = CONTEXT.quad, CONTEXT.pi
    half = CONTEXT.mpf(1.9) / 2
    rod = q(lambda z: z * z, [-half, half]) / 1.9
    disc = q(lambda r: r**3, [0, CONTEXT.mpf(0.7)]) / q(lambda r: r, [0, CONTEXT.mpf(0.7)])
    sphere = q(lambda a: CONTEXT.sin(a) ** 3, [0, pi]) / 2 * CONTEXT.mpf(0.7) ** 2
    tube = CONTEXT.mpf(0.7) ** 2
    for body, true in (
        (bodies.Rod(length=1.9, mass=1.0), (rod, rod, 0)),
        (bodies.Disc(radius=0.7, mass=1.0), (disc / 2, disc / 2, disc)),
        (bodies.SphericalShell(outer_radius=0.7, inner_radius=0.7, mass=1.0), (sphere,) * 3),
        (
            bodies.CylindricalShell(outer_radius=0.7, inner_radius=0.7, height=1.9, mass=1.0),
            (tube / 2 + rod, tube / 2 + rod, tube),
        ),
    ):
        found = body.mass_properties()
        assert found.validity.physical
        for got, moment in zip(np.diag(tensor(found)), true, strict=True):
            # The quotient by the double 1.9 above is the only rounding at play.
            assert abs(_mp(got) - moment) <= 1e-26 * (abs(moment) + 1)


def _revolved(kind: str, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a mesh of a specimen: its profile in the (r, z) half-plane, turned about z in 2 n steps."""
    half_turn = np.linspace(-np.pi / 2, np.pi / 2, n + 1)
    arc = np.column_stack([np.cos(half_turn), np.sin(half_turn)])
    arc[[0, -1], 0] = 0.0
    upper, lower = arc[n // 2 :], arc[: n // 2 + 1]
    upper[0], lower[-1] = (1.0, 0.0), (1.0, 0.0)
    box = np.array([[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]])
    ring = np.linspace(0, 2 * np.pi, 2 * n, endpoint=False)
    profiles: dict[str, tuple[np.ndarray, bool]] = {
        "ball": (0.7 * arc, False),
        "ellipsoid": (arc, False),
        "cylinder": (box * [0.7, 0.95], False),
        "rod": (box * [0.1, 0.95], False),
        "disc": (box * [0.7, 0.05], False),
        "cone": (np.array([[0.0, 0.0], [0.7, 0.0], [0.0, 1.9]]), False),
        "hemisphere": (np.vstack([[[0.0, 0.0]], 0.7 * upper]), False),
        "capsule": (np.vstack([0.7 * lower - [0, 0.95], 0.7 * upper + [0, 0.95]]), False),
        "torus": (np.column_stack([1.1 + 0.3 * np.cos(ring), 0.3 * np.sin(ring)]), True),
        "cylindrical-shell": (np.array([[0.6, -0.95], [0.7, -0.95], [0.7, 0.95], [0.6, 0.95]]), True),
        "spherical-shell": (0.7 * arc, False),
    }
    profile, around = profiles[kind]
    vertices, faces = _turn_about_z(profile, around, 2 * n)
    if kind == "spherical-shell":
        hollow, inner = _turn_about_z(0.6 * arc, False, 2 * n)
        return np.vstack([vertices, hollow]), np.vstack([faces, inner[:, ::-1] + len(vertices)])
    return vertices * ([0.3, 1.7, 2.9] if kind == "ellipsoid" else 1.0), faces


def _turn_about_z(profile: np.ndarray, around: bool, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and faces; points on the axis are one vertex each."""
    angle = np.linspace(0, 2 * np.pi, steps, endpoint=False)
    vertices: list[list[float]] = []
    index = np.empty((len(profile), steps), dtype=int)
    for i, (r, z) in enumerate(profile):
        if r == 0.0:
            index[i] = len(vertices)
            vertices.append([0.0, 0.0, z])
        else:
            index[i] = len(vertices) + np.arange(steps)
            vertices += np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(steps, z)]).tolist()
    rows = np.vstack([index, index[:1]]) if around else index
    a, b = rows[:-1], rows[1:]
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    faces = np.vstack([np.stack([a, d, c], -1).reshape(-1, 3), np.stack([a, c, b], -1).reshape(-1, 3)])
    distinct = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return np.array(vertices), faces[distinct]


@pytest.mark.parametrize("kind", [kind for kind in UNIFORM if kind not in ("cuboid", "mesh")])
def test_meshes_converge_to_the_solid_with_second_order(kind: str) -> None:
    true = SPECIMENS[kind].mass_properties()
    coarse, fine = (Mesh(*_revolved(kind, n), density=3.3).mass_properties() for n in (24, 48))
    # A corner's chord replaces an arc, and its error goes with the square of the angle: halved, a quarter is left.
    for read in (lambda p: np.array([p.mass]), lambda p: np.diag(p.inertia)):
        errors = [np.abs(read(p) - read(true)) for p in (coarse, fine)]
        assert np.allclose(errors[0] / errors[1], 4.0, atol=0.1)
        extrapolated = (4 * read(fine) - read(coarse)) / 3
        assert np.allclose(extrapolated, read(true), rtol=2e-4)


def test_a_block_of_triangles_is_the_cuboid() -> None:
    edges = (0.3, 1.7, 2.9)
    corners = [[(n // 4 - 0.5) * edges[0], (n // 2 % 2 - 0.5) * edges[1], (n % 2 - 0.5) * edges[2]] for n in range(8)]
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]  # fmt: skip
    block, solid = Mesh(corners, faces, density=3.3).mass_properties(), SPECIMENS["cuboid"].mass_properties()
    assert close(np.array([block.exact_mass]), np.array([solid.exact_mass]))
    assert close(tensor(block), tensor(solid))


ADAPTER: TypeAdapter[Any] = TypeAdapter(Body)
PLAIN: dict[str, Any] = {"positions": SPECIMENS["point-masses"].positions.tolist()}


def _written(body: Any) -> Any:
    """Return a body as JSON would state it."""
    if isinstance(body, np.ndarray):
        return body.tolist()
    if dataclasses.is_dataclass(body):
        stated = {f.name: _written(getattr(body, f.name)) for f in dataclasses.fields(body)}
        return {name: value for name, value in stated.items() if value is not None}
    return [_written(entry) for entry in body] if isinstance(body, (tuple, list)) else body


@pytest.mark.parametrize("kind", SPECIMENS)
def test_the_wire_gives_the_same_body(kind: str) -> None:
    read = ADAPTER.validate_json(json.dumps(_written(SPECIMENS[kind])))
    assert type(read) is type(SPECIMENS[kind])
    here, there = SPECIMENS[kind].mass_properties(), read.mass_properties()
    assert (here.inertia == there.inertia).all()
    assert (here.inertia_tail == there.inertia_tail).all()


def test_every_kind_and_field_is_in_the_schema() -> None:
    definitions = ADAPTER.json_schema()["$defs"]
    for member in members_of(Body):
        stated = definitions[member.__name__]["properties"]
        assert stated["kind"]["const"] == member.kind
        assert set(stated) == {f.name for f in dataclasses.fields(member)}
