"""Masses and tensors of inertia of described bodies, read and checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flint import arb, fmpq

from core.balls import as_text
from core.bodies import Body
from core.errors import InvalidParameter, Path
from core.multibody.algebra.polynomials import ZERO, Ball, is_zero
from core.multibody.language.body import SceneBody
from core.multibody.language.numerals import LARGEST, LEAST, Numerals
from core.multibody.language.shapes import shape_of
from core.quantities import members_of

ROUNDED = 2.0**-48
"""What rounding the entries of a tensor to doubles may add to its moments, with a factor of ten, as a share of its
trace."""


def inertia_of(name: str, body: SceneBody, numerals: Numerals, dimension: int) -> tuple[Ball, Any]:
    """Return mass, and in the plane the inertia, in space the tensor as three rows; None for a particle."""
    path: Path = ("bodies", name)
    wrong = ("moments", "tensor", "axes", "body") if dimension == 2 else ("inertia", "angle")
    for entry in wrong:
        if getattr(body, entry) is not None:
            where = "space" if dimension == 2 else "the plane"
            raise InvalidParameter((*path, entry), f"be left out: it belongs to bodies in {where}")
    if body.body is not None:
        for entry in ("mass", "moments", "tensor"):
            if getattr(body, entry) is not None:
                raise InvalidParameter((*path, entry), "be left out where the body is given")
        return _catalogued(body.body, (*path, "body"))
    if body.mass is None:
        raise InvalidParameter((*path, "mass"), "be given")
    mass = numerals.number(body.mass, (*path, "mass"))
    if mass < 0:
        raise InvalidParameter((*path, "mass"), "be at least 0 kg")
    if body.inertia is not None:
        inertia = numerals.number(body.inertia, (*path, "inertia"))
        if inertia < 0:
            raise InvalidParameter((*path, "inertia"), "be at least 0 kg m^2")
        return mass, inertia
    if body.moments is not None and body.tensor is not None:
        raise InvalidParameter((*path, "tensor"), "be left out where moments are given")
    if body.moments is not None:
        moments = numerals.vector(body.moments, (*path, "moments"), 3)
        tensor = [[moments[i] if i == j else ZERO for j in range(3)] for i in range(3)]
    elif body.tensor is not None:
        rows = three_vectors(body.tensor, (*path, "tensor"))
        tensor = [list(numerals.vector(row, (*path, "tensor", i), 3)) for i, row in enumerate(rows)]
        for i in range(3):
            for j in range(i):
                if not is_zero(tensor[i][j] - tensor[j][i]):
                    raise InvalidParameter((*path, "tensor"), "be symmetric")
    elif body.shape is not None:
        return mass, _of_shape(name, mass, body.shape, numerals, dimension)
    else:
        return mass, None
    _check_matter(tensor, (*path, "moments" if body.moments is not None else "tensor"))
    return mass, tensor


def _of_shape(name: str, mass: Ball, written: Mapping[str, Any], numerals: Numerals, dimension: int) -> Any:
    """Return the inertia of a homogeneous solid of a shape, as three rows in space."""
    path = ("bodies", name, "shape")
    shape = shape_of(written, numerals, path, dimension)
    if not shape.centred:
        raise InvalidParameter(
            path,
            "have its centroid at the centre of mass where no inertia is given: that of a homogeneous solid is meant",
            remedy=f"move it by {[-float(x) for x in shape.centroid]}, or give the inertia",
        )
    own = [mass * x for x in shape.moments]
    for x in own:
        if x > LARGEST or 0 < x < LEAST:
            raise InvalidParameter(
                path,
                f"give the body an inertia between 1e-300 and 1e300 kg m^2, unlike {as_text(x, 3)}",
                remedy="describe the scene in other units",
            )
    return own[0] if dimension == 2 else [[own[i] if i == j else ZERO for j in range(3)] for i in range(3)]


def _catalogued(body: Any, path: Path) -> tuple[Ball, Any]:
    if not isinstance(body, members_of(Body)):
        raise InvalidParameter(path, "be a body of the catalogue")
    given: Any = body
    properties = given.mass_properties()
    exact = properties.exact_inertia
    tensor = [[arb(fmpq(x.numerator, x.denominator)) for x in row] for row in exact]
    mass = properties.exact_mass
    return arb(fmpq(mass.numerator, mass.denominator)), tensor


def _check_matter(tensor: Any, path: Path) -> None:
    """Raise unless the integrals of the squares of body coordinates can be those of matter, about any axes.

    They are the matrix trace/2 - J, of which no principal value may be negative: then no principal moment is negative
    or exceeds the sum of the other two. A tensor off its axes is known to the rounding of its entries.
    """
    if any(tensor[i][i] < 0 for i in range(3)):
        raise InvalidParameter(path, "be at least 0 kg m^2")
    trace = tensor[0][0] + tensor[1][1] + tensor[2][2]
    diagonal = all(is_zero(tensor[i][j]) for i in range(3) for j in range(i))
    half = trace / 2 if diagonal else trace * (0.5 + ROUNDED)
    (a, d, e), (_, b, f), (_, _, c) = [[(half if i == j else ZERO) - tensor[i][j] for j in range(3)] for i in range(3)]
    minors = (a * b - d * d, b * c - f * f, c * a - e * e)
    determinant = a * minors[1] - d * (d * c - e * f) + e * (d * f - e * b)
    if any(x < 0 for x in (a, b, c, *minors, determinant)):
        raise InvalidParameter(path, "be moments of matter: no principal moment exceeds the sum of the other two")


def symmetry_axes(tensor: Any) -> list[int]:
    """Return the body axes about which the tensor is symmetric."""
    if any(not is_zero(tensor[i][j]) for i in range(3) for j in range(i)):
        return []
    return [k for k in range(3) if is_zero(tensor[(k + 1) % 3][(k + 1) % 3] - tensor[(k + 2) % 3][(k + 2) % 3])]


def three_vectors(rows: Any, path: Path) -> Sequence[Any]:
    """Return three rows, or raise `InvalidParameter`."""
    if isinstance(rows, (str, Mapping)) or not isinstance(rows, Sequence) or len(rows) != 3:
        raise InvalidParameter(path, "be three vectors")
    return rows
