"""Bodies as lists of numbers, with their tensors in rational arithmetic, so that every number can be moved alone.

The tensors are formed here from sums over points and tetrahedra and the parallel-axis theorem, not by the code that is
tested; what a solid weighs and how it resists turning is its own formula, taken at rational dimensions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from core.bodies.composite import Composite, Part
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.mesh import Mesh
from core.bodies.solids import Cone, Cuboid, Cylinder, Ellipsoid

Numbers = Sequence[Any]
Matrix = list[list[Fraction]]
UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


@dataclass(frozen=True)
class Uncertain:
    """A body described by numbers, how it turns at the start, and until when.

    Attributes
    ----------
    kind, regime : str
    numbers : tuple of float
        Of the body.
    body : callable
        From the numbers to a body of the catalogue.
    tensor : callable
        From rational numbers to the tensor about the centre of mass.
    start : tuple of 3 floats
        rad/s.
    horizon : float
        s.
    """

    kind: str
    regime: str
    numbers: tuple[float, ...]
    body: Callable[[Numbers], Any]
    tensor: Callable[[Numbers], Matrix]
    start: tuple[float, float, float]
    horizon: float


def _tensor_of(second: Matrix) -> Matrix:
    trace = second[0][0] + second[1][1] + second[2][2]
    return [[(trace if i == j else 0) - second[i][j] for j in range(3)] for i in range(3)]


def _outer(m: Fraction, u: Numbers, v: Numbers) -> Matrix:
    return [[m * a * b for b in v] for a in u]


def _sum(matrices: list[Matrix]) -> Matrix:
    return [[sum((x[i][j] for x in matrices), Fraction(0)) for j in range(3)] for i in range(3)]


def _central(mass: Fraction, first: Numbers, second: Matrix) -> Matrix:
    return _tensor_of(_sum([second, _outer(-1 / mass, first, first)]))


def of_moments(x: Numbers) -> Matrix:
    return [[x[i] if i == j else Fraction(0) for j in range(3)] for i in range(3)]


def _symmetric(x: Numbers) -> Matrix:
    return [[x[UPPER.index((min(i, j), max(i, j)))] for j in range(3)] for i in range(3)]


def _rows(x: Numbers) -> list[Numbers]:
    return [x[k : k + 3] for k in range(0, len(x), 3)]


def of_points(x: Numbers) -> Matrix:
    n = len(x) // 4
    places = list(zip(x[:n], _rows(x[n:]), strict=True))
    first = [sum((m * r[k] for m, r in places), Fraction(0)) for k in range(3)]
    return _central(sum(x[:n], Fraction(0)), first, _sum([_outer(m, r, r) for m, r in places]))


def _mesh_moments(mass: Fraction, vertices: list[Numbers], faces: Numbers) -> tuple[Fraction, Numbers, Matrix]:
    volume, first, seconds = Fraction(0), [Fraction(0)] * 3, []
    for face in faces:
        a, b, c = (vertices[k] for k in face)
        six = a[0] * (b[1] * c[2] - b[2] * c[1])
        six += a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        volume += six / 6
        s = [p + q + r for p, q, r in zip(a, b, c, strict=True)]
        first = [f + six * p / 24 for f, p in zip(first, s, strict=True)]
        seconds += [_outer(six / 120, v, v) for v in (s, a, b, c)]
    over = mass / volume
    return mass, [over * f for f in first], [[over * y for y in row] for row in _sum(seconds)]


FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def _of_mesh(x: Numbers) -> Matrix:
    return _central(*_mesh_moments(x[0], _rows(x[1:]), FACES))


def _solid(kind: Any, *names: str, size: int = 1) -> tuple[Callable[[Numbers], Any], Callable[[Numbers], Matrix]]:
    def made(x: Numbers) -> Any:
        sizes = {names[0]: tuple(x[1:])} if size > 1 else dict(zip(names, x[1:], strict=True))
        return kind(mass=x[0], **sizes)

    def tensor(x: Numbers) -> Matrix:
        return [[x[0] * entry for entry in row] for row in made(x).shape().inertia]

    return made, tensor


SOLIDS = (
    (3, *_solid(Cuboid, "edges", size=3)),
    (3, *_solid(Ellipsoid, "semi_axes", size=3)),
    (2, *_solid(Cylinder, "radius", "height")),
    (2, *_solid(Cone, "radius", "height")),
)


def _two_parts(x: Numbers) -> Composite:
    return Composite(
        (
            Part(Cuboid(mass=x[0], edges=tuple(x[1:4])), tuple(x[4:7]), tuple(x[7:11])),
            Part(Cone(mass=x[11], radius=x[12], height=x[13]), tuple(x[14:17])),
        )
    )


def _turn(q: Numbers) -> Matrix:
    w, x, y, z = q
    n = w * w + x * x + y * y + z * z
    return [
        [1 - 2 * (y * y + z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n],
        [2 * (x * y + w * z) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - w * x) / n],
        [2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, 1 - 2 * (x * x + y * y) / n],
    ]


def _of_parts(x: Numbers) -> Matrix:
    masses, firsts, seconds = [x[0], x[11]], [], []
    a, b, c = x[1:4]
    own = [x[0] * e * e / 12 for e in (a, b, c)]
    turn = _turn(x[7:11])
    seconds.append([[sum(turn[i][k] * own[k] * turn[j][k] for k in range(3)) for j in range(3)] for i in range(3)])
    seconds.append(_outer(x[0], x[4:7], x[4:7]))
    firsts.append([x[0] * p for p in x[4:7]])
    m, r, h = x[11:14]
    # A cone about its own centre of mass, at h/4: second moments 3/20 m r^2 across, 3/80 m h^2 along.
    across, along = Fraction(3, 20) * m * r * r, Fraction(3, 80) * m * h * h
    seconds.append([[across, 0, 0], [0, across, 0], [0, 0, along]])
    center = [x[14], x[15], x[16] + h / 4]
    seconds.append(_outer(m, center, center))
    firsts.append([m * p for p in center])
    first = [firsts[0][k] + firsts[1][k] for k in range(3)]
    return _central(sum(masses, Fraction(0)), first, _sum(seconds))


def _shape(random: np.random.Generator, kind: str) -> tuple[list[float], Any, Any]:
    def size(n: int) -> list[float]:
        return np.exp(random.normal(0.0, 0.5, n)).tolist()

    def place(n: int) -> list[float]:
        return random.normal(0.0, 1.0, n).tolist()

    if kind == "principal moments":
        a, b, c = size(3)
        return [b + c, c + a, a + b], lambda x: PrincipalMoments(tuple(x)), of_moments
    if kind == "tensor":
        frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
        a, b, c = size(3)
        t = frame @ np.diag([b + c, c + a, a + b]) @ frame.T
        numbers = [float(t[i, j]) for i, j in UPPER]
        return numbers, lambda x: InertiaTensor(tuple(map(tuple, _symmetric(x)))), _symmetric
    if kind == "point masses":
        n = int(random.integers(4, 8))
        return (
            [*size(n), *place(3 * n)],
            lambda x: PointMasses(list(x[: len(x) // 4]), _rows(x[len(x) // 4 :])),
            of_points,
        )
    if kind == "solid":
        n, made, tensor = SOLIDS[int(random.integers(len(SOLIDS)))]
        return size(1 + n), made, tensor
    if kind == "composite":
        return [*size(4), *place(7), *size(3), *place(3)], _two_parts, _of_parts
    base = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + random.normal(0.0, 0.2, (4, 3)) + place(3)
    return [*size(1), *base.ravel().tolist()], lambda x: Mesh(mass=x[0], vertices=_rows(x[1:]), faces=FACES), _of_mesh


KINDS = ("principal moments", "tensor", "point masses", "solid", "composite", "mesh")
REGIMES = ("ordinary", "near separatrix", "near symmetric", "far horizon", "magnitudes")


def uncertain(seed: int, kind: str, regime: str) -> Uncertain:
    """Return a random body and start of a kind and regime."""
    random = np.random.default_rng(seed)
    numbers, body, tensor = _shape(random, kind)
    if regime == "near symmetric":
        if kind == "principal moments":
            numbers[1] = numbers[0] * (1 + 10.0 ** random.uniform(-9, -2))
        elif kind == "tensor":
            frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
            t = frame @ np.diag([1.0, 1.0 + 10.0 ** random.uniform(-7, -2), random.uniform(0.3, 1.7)]) @ frame.T
            numbers = [float(t[i, j]) for i, j in UPPER]
        elif kind == "solid":
            numbers, body, tensor = [*np.exp(random.normal(0, 0.5, 3)).tolist()], *SOLIDS[2][1:]
        elif kind == "point masses":
            numbers = [1.0, 1.0, 1.0, 1.0, 1.0, 0, 0, 0, 1.0, 0, -1.0, 0, 0, 0, -1.0, 0.5 * (random.random() > 0.5)]
            numbers = [x * (1 + 1e-4 * random.normal()) for x in numbers]
    if regime == "magnitudes":
        numbers = _scaled(kind, numbers, 10.0 ** random.uniform(-60, 60), 10.0 ** random.uniform(-30, 30))
    inertia = np.array([[float(y) for y in row] for row in tensor([Fraction(x) for x in numbers])])
    moments, axes = np.linalg.eigh(inertia)
    w = random.normal(size=3)
    if regime == "near separatrix":
        A, B, C = moments
        # C (C-B) w_C^2 = A (B-A) w_A^2, nearly.
        w[2] = w[0] * math.sqrt(A * (B - A) / (C * (C - B))) if C - B > 1e-6 * C else w[2]
        w[2] *= 1 + 10.0 ** random.uniform(-8, -1)
    w = axes @ w
    spin = 10.0 ** random.uniform(-50, 50) if regime == "magnitudes" else 1.0
    w = w * spin
    turns = 10.0 ** (random.uniform(3, 9) if regime == "far horizon" else random.uniform(-1.5, 2))
    return Uncertain(kind, regime, tuple(numbers), body, tensor, tuple(w.tolist()), float(turns / np.linalg.norm(w)))


def _scaled(kind: str, numbers: list[float], mass: float, length: float) -> list[float]:
    if kind in ("principal moments", "tensor"):
        return [x * mass * length * length for x in numbers]
    if kind == "point masses":
        n = len(numbers) // 4
        return [x * (mass if k < n else length) for k, x in enumerate(numbers)]
    if kind == "composite":
        return [x * (mass if k in (0, 11) else 1.0 if 7 <= k < 11 else length) for k, x in enumerate(numbers)]
    return [x * (mass if k == 0 else length) for k, x in enumerate(numbers)]
