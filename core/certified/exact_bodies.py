"""The inertia of a body of the catalogue, exactly as it is described: doubles or decimal strings in, fractions out."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from core.bodies import Body
from core.bodies.uniform import Uniform
from core.certified.exact_inertia import ExactInertia, Matrix, Vector
from core.certified.exact_inputs import exact
from core.errors import InvalidParameter, NotApplicable
from core.quantities import members_of

UNIFORM: dict[str, type[Uniform]] = {
    member.kind: member  # type: ignore[attr-defined]
    for member in members_of(Body)
    if issubclass(member, Uniform) and member.mass_properties is Uniform.mass_properties
}
"""Solids whose shape is rational; a mesh is summed otherwise."""


def exact_body(body: Mapping[str, Any]) -> ExactInertia:
    """Return the inertia of a body about the point about which it turns.

    Parameters
    ----------
    body : mapping
        The fields of a body of the catalogue, ``kind`` among them; every number may be a decimal string.

    Raises
    ------
    InvalidParameter
        For fields that the body does not have, or numbers that it refuses.
    NotApplicable
        For composites and meshes, and for solids whose mass is not rational because a density stands for it.
    """
    kind = body.get("kind")
    fields = {name: value for name, value in body.items() if name != "kind"}
    if kind == "principal-moments":
        return ExactInertia.of_moments(_only(fields, "moments"))
    if kind == "inertia-tensor":
        return ExactInertia.of_tensor(_only(fields, "tensor", "mass", "center_of_mass"))
    if kind == "point-masses":
        positions, about = _only(fields, "positions", "masses", "about"), fields.get("about", "center-of-mass")
        if about not in ("center-of-mass", "origin"):
            raise InvalidParameter("about", 'be "center-of-mass" or "origin"')
        if "masses" not in fields:
            raise InvalidParameter("masses", "be given")
        return ExactInertia.of_point_masses(fields["masses"], positions, about_origin=about == "origin")
    if isinstance(kind, str) and kind in UNIFORM:
        return _solid(UNIFORM[kind], fields)
    raise NotApplicable(
        f"a body of kind {kind} is summed in fixed precision, which is no ground for proven digits",
        path=("kind",),
        remedy="give it by its tensor of inertia or its points, or leave out the digits",
    )


def _only(fields: Mapping[str, Any], first: str, *others: str) -> Any:
    """Return the field `first`, which must be there; besides it only `others` may be."""
    for name in fields:
        if name not in (first, *others):
            raise InvalidParameter(name, f"be a field of this body: {', '.join((first, *others))}")
    if first not in fields:
        raise InvalidParameter(first, "be given")
    return fields[first]


def _solid(kind: type[Uniform], fields: Mapping[str, Any]) -> ExactInertia:
    numbers = {name: _exactly(value, (name,)) for name, value in fields.items()}
    try:
        # Its own checks, on the nearest doubles, which are what their messages quote.
        kind(**{name: _rounded(value) for name, value in numbers.items()}).refuse_hole()
        solid = kind(**numbers)
    except TypeError as fault:
        raise InvalidParameter((), f"have the fields of its kind: {fault}") from None
    shape = solid.shape()
    if solid.mass is None and shape.pi_power:
        raise NotApplicable(
            "the mass of a round body of given density holds a power of pi",
            path=("density",),
            remedy="give its mass, as a decimal string if need be",
        )
    mass = solid.weigh(shape)
    x, y, z = (_row([mass * entry for entry in row]) for row in shape.inertia)
    tensor: Matrix = (x, y, z)
    return ExactInertia(tensor)


def _row(entries: list[Fraction]) -> Vector:
    x, y, z = entries
    return x, y, z


def _exactly(value: Any, path: tuple[str | int, ...]) -> Any:
    if isinstance(value, (tuple, list)):
        return tuple(_exactly(entry, (*path, i)) for i, entry in enumerate(value))
    return value if value is None else exact(value, path)


def _rounded(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_rounded(entry) for entry in value)
    if value is None:
        return None
    try:
        return float(value)
    except OverflowError:
        return float("inf")
