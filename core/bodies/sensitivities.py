"""First derivatives of the inertia tensor with respect to each number that describes a body, vectorised.

About a fixed point c the moments S = integral of d d^T dm, d = r - c, are additive over the parts of a body. About the
centre of mass they are stationary in c (the first moment vanishes there). The derivatives about the fixed point at the
centre of mass are therefore those of the central moments. Every derivative is multiplied by the number itself: it is
the change for a relative uncertainty of one, and zero for a number that is zero.
"""

from __future__ import annotations

import copy
import math
from dataclasses import fields
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from core.arrays import Floats
from core.bodies.composite import Composite, moments_of
from core.bodies.exact import rotation
from core.bodies.mass_properties import MassProperties
from core.bodies.measured import InertiaTensor, PointMasses
from core.bodies.mesh import Mesh
from core.bodies.uniform import Uniform

STEP = Fraction(1, 2**30)
"""Relative step of the finite differences of solids, which are formed in rational arithmetic without cancellation."""

_UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


class _Units(NamedTuple):
    """Powers of two that bring masses and lengths near one."""

    mass: int
    length: int


def tensor_sensitivities(properties: MassProperties, exponent: int) -> Floats:
    """Return the change of the tensor about the point of rotation for each number that describes the body.

    To first order, for a relative uncertainty of one in that number alone.

    Parameters
    ----------
    properties : MassProperties
        If they are not derived from other numbers, the components of the tensor are the numbers.
    exponent : int
        The result is in units of 2^exponent kg m^2.

    Returns
    -------
    ndarray, shape (n, 3, 3)
        For n numbers, in body axes.
    """
    body, mass, center = properties.described_by, properties.mass, properties.center_of_mass
    if body is None or mass is None or center is None:
        return _of_components(np.ldexp(properties.inertia, -exponent))
    length = (exponent - math.frexp(mass)[1]) // 2
    about = np.ldexp(center, -length) if properties.about == "center-of-mass" else np.zeros(3)
    second = _of_moments(body, about, _Units(exponent - 2 * length, length))
    # The tensor is the trace times the unit tensor less the moments.
    changes, trace = -second, second[:, 0, 0] + second[:, 1, 1] + second[:, 2, 2]
    for k in range(3):
        changes[:, k, k] += trace
    return changes


def _of_components(tensor: Floats) -> Floats:
    rows = []
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
        if tensor[i, j]:
            row = np.zeros((3, 3))
            row[i, j] = row[j, i] = tensor[i, j]
            rows.append(row)
    return np.array(rows).reshape(-1, 3, 3)


def _of_moments(body: Any, about: Floats, units: _Units) -> Floats:
    """Return the changes of S about a point, shape (n, 3, 3), of a body that is described by n numbers.

    Parameters
    ----------
    body : Body
        Any kind except principal moments, which have no mass.
    about : ndarray, shape (3,)
        In the body's frame, in units of 2^units.length.
    units : Units
        The result is in kg m^2 divided by 2^(mass + 2 length).
    """
    if isinstance(body, PointMasses):
        return _of_points(body, about, units)
    if isinstance(body, Mesh):
        return _of_mesh(body, about, units)
    if isinstance(body, Uniform):
        return _of_solid(body, about, units)
    if isinstance(body, Composite):
        return np.concatenate([_of_part(part, about, units) for part in body.parts])
    return _of_tensor(body, about, units)


def _pair(u: Floats, v: Floats) -> Floats:
    """Return u v^T + v u^T along the last axes."""
    product: Floats = u[..., :, None] * v[..., None, :]
    return product + np.swapaxes(product, -1, -2)


def _of_points(body: PointMasses, about: Floats, units: _Units) -> Floats:
    r = np.ldexp(body.positions, -units.length)
    d = r - about
    m = np.ldexp(np.broadcast_to(np.asarray(body.masses, dtype=np.float64), len(r)), -units.mass)
    by_mass = np.einsum("n,ni,nj->nij", m, d, d)
    if np.ndim(body.masses) == 0:
        by_mass = by_mass.sum(axis=0, keepdims=True)
    by_place = np.zeros((len(r), 3, 3, 3))
    for j in range(3):
        weighted = m * r[:, j]
        for k in range(3):
            by_place[:, j, j, k] += weighted * d[:, k]
            by_place[:, j, k, j] += weighted * d[:, k]
    return np.concatenate([by_mass, by_place.reshape(-1, 3, 3)])


def _of_mesh(body: Mesh, about: Floats, units: _Units) -> Floats:
    r = np.ldexp(body.vertices, -units.length)
    corners = (r - about)[body.faces]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    gradient = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    six = np.einsum("fj,fj->f", a, gradient[:, 0])
    s = corners.sum(axis=1)
    # Means over a tetrahedron from the origin: 120 S = det (s s^T + a a^T + b b^T + c c^T), 6 V = det.
    q = 0.5 * _pair(s, s) + 0.5 * _pair(corners, corners).sum(axis=1)
    second = gradient[:, :, :, None, None] * q[:, None, None] / 120.0
    second += (six / 120.0)[:, None, None, None, None] * _pair(np.eye(3), (s[:, None] + corners)[:, :, None, :])
    corner = body.faces.ravel()
    at_corner = second.reshape(len(corner), 3, 3, 3)
    changes = np.zeros((len(r), 3, 3, 3))
    for j in range(3):
        for k, n in _UPPER:
            changes[:, j, k, n] = np.bincount(corner, at_corner[:, j, k, n], len(r))
            changes[:, j, n, k] = changes[:, j, k, n]
    volume = six.sum() / 6.0
    total = np.einsum("f,fkn->kn", six, q) / 120.0
    if body.mass is None:
        density = np.ldexp(float(body.density or 0.0), 3 * units.length - units.mass) * np.sign(volume)
    else:
        density = np.ldexp(body.mass, -units.mass) / volume
        by_volume = [np.bincount(corner, gradient[:, :, j].ravel(), len(r)) / 6.0 for j in range(3)]
        changes -= np.stack(by_volume, axis=1)[:, :, None, None] * (total / volume)
    changes *= density * r[:, :, None, None]
    return np.concatenate([density * total[None], changes.reshape(-1, 3, 3)])


def _of_solid(body: Uniform, about: Floats, units: _Units) -> Floats:
    kilogram, metre = Fraction(2) ** units.mass, Fraction(2) ** units.length
    point = [Fraction(float(x)) for x in about]

    def second(solid: Uniform) -> list[Fraction]:
        shape = solid.shape()
        mass = solid.weigh(shape) / kilogram
        d = [x / metre - c for x, c in zip(shape.center_of_mass, point, strict=True)]
        half = (shape.inertia[0][0] + shape.inertia[1][1] + shape.inertia[2][2]) / 2
        own = [((half if i == j else 0) - shape.inertia[i][j]) / metre**2 for i, j in _UPPER]
        return [mass * (x + d[i] * d[j]) for x, (i, j) in zip(own, _UPPER, strict=True)]

    given, rows = second(body), []
    for name in (field.name for field in fields(body) if field.name not in ("kind", "mass", "density")):
        value = getattr(body, name)
        for k in range(len(value) if isinstance(value, tuple) else 1):
            stretched = copy.copy(body)
            object.__setattr__(stretched, name, _stretched(value, k))
            rows.append([float((x - y) / STEP) for x, y in zip(second(stretched), given, strict=True)])
    return _symmetric([*rows, [float(x) for x in given]])


def _stretched(value: Any, k: int) -> Any:
    if isinstance(value, tuple):
        return tuple(Fraction(x) * (1 + STEP) if n == k else x for n, x in enumerate(value))
    return Fraction(value) * (1 + STEP)


def _symmetric(rows: list[list[float]]) -> Floats:
    xx, xy, xz, yy, yz, zz = np.array(rows).T
    return np.stack([np.stack(row, axis=-1) for row in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))], axis=-2)


def _of_tensor(body: InertiaTensor, about: Floats, units: _Units) -> Floats:
    scale = -units.mass - 2 * units.length
    rows = []
    for i, j in _UPPER:
        tensor = np.zeros((3, 3))
        tensor[i, j] = tensor[j, i] = np.ldexp(0.5 * body.tensor[i][j] + 0.5 * body.tensor[j][i], scale)
        rows.append(0.5 * np.trace(tensor) * np.eye(3) - tensor)
    if body.mass is not None and body.center_of_mass is not None:
        r, mass = np.ldexp(np.array(body.center_of_mass), -units.length), np.ldexp(body.mass, -units.mass)
        d = r - about
        rows += [mass * np.outer(d, d), *(mass * r[:, None, None] * _pair(np.eye(3), d[None, :]))]
    return np.array(rows)


def _of_part(part: Any, about: Floats, units: _Units) -> Floats:
    """Return the changes caused by a part's own numbers, its position and its attitude."""
    turn = np.array([[float(x) for x in row] for row in rotation(part.attitude)])
    place = np.ldexp(np.array(part.position), -units.length)
    own = _of_moments(part.body, turn.T @ (about - place), units)
    changes = [turn @ own @ turn.T]
    sign = -1.0 if part.hole else 1.0
    mass, first, second = _placed(part, turn, units)
    from_about = first + mass * (place - about)
    changes.append(place[:, None, None] * _pair(np.eye(3), from_about[None, :]))
    # A change of the quaternion rotates the part by the vector part of 2 dq q*/|q|^2, about its own origin.
    w, x, y, z = np.array(part.attitude) / np.linalg.norm(part.attitude)
    vectors = np.array([[-x, -y, -z], [w, z, -y], [-z, w, x], [y, -x, w]]) * 2.0 * np.array([[w], [x], [y], [z]])
    product = second + np.outer(first, place - about)
    turned = np.cross(vectors[:, None, :], product.T[None, :, :]).swapaxes(1, 2)
    changes.append(turned + turned.swapaxes(1, 2))
    return sign * np.concatenate(changes)


def _placed(part: Any, turn: Floats, units: _Units) -> tuple[float, Floats, Floats]:
    """Return a part's mass, first and second moments about its own origin, along the composite's axes."""
    mass, first, second = moments_of(part.body).within(units.mass, units.length)
    return mass, turn @ first, turn @ second @ turn.T
