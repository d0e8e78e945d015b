"""A body of the catalogue in rational numbers, exactly as it is described: doubles or decimal strings in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import MISSING, fields
from typing import Any

from core.bodies import Body
from core.bodies.composite import Composite, Part
from core.bodies.exact_inertia import ExactInertia, symmetric, triple
from core.bodies.exact_mass import ExactMass
from core.bodies.measured import InertiaTensor, PointMasses, PrincipalMoments
from core.bodies.uniform import Uniform
from core.digits.exact_inputs import exact, exact_numbers, nearest
from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.quantities import members_of

UNIFORM: dict[str, type[Uniform]] = {
    member.kind: member  # type: ignore[attr-defined]
    for member in members_of(Body)
    if issubclass(member, Uniform) and member.mass_properties is Uniform.mass_properties
}
"""Solids whose shape is rational; a mesh is summed otherwise."""

MOST_PARTS = 100
"""Bodies of an exact composite: the denominators of their places and attitudes multiply."""


def exact_body(body: Mapping[str, Any]) -> ExactMass:
    """Return a body of the catalogue in rational numbers.

    Parameters
    ----------
    body : mapping
        The fields of a body, ``kind`` among them; every number may be a decimal string.

    Raises
    ------
    InvalidParameter
        For fields that the body does not have, or numbers that it refuses.
    UnphysicalInertia
        For a composite whose holes leave a negative principal moment.
    NotApplicable
        For meshes, and for solids whose mass is not rational because a density stands for it.
    BudgetExceeded
        For a composite of more than 100 bodies.
    """
    found = _any_body(body)
    # Refused here, where the body is at fault, if it cannot turn.
    assert found.of_motion
    return found


def _any_body(body: Mapping[str, Any]) -> ExactMass:
    kind = body.get("kind")
    given = {name: value for name, value in body.items() if name != "kind"}
    if kind == "principal-moments":
        return ExactMass(ExactInertia.of_moments(_only(given, "moments")).tensor, given_by="moments")
    if kind == "inertia-tensor":
        return _of_tensor(given)
    if kind == "point-masses":
        positions, about = _only(given, "positions", "masses", "about"), _about(given)
        if "masses" not in given:
            raise InvalidParameter("masses", "be given")
        return ExactMass.of_point_masses(given["masses"], positions, about)
    if isinstance(kind, str) and kind in UNIFORM:
        _solid_in_doubles(UNIFORM[kind], given).refuse_hole()
        return _solid(UNIFORM[kind], given)
    if kind == "composite":
        parts = _only(given, "parts", "about")
        # Its own checks, on the nearest doubles, which are what their messages quote.
        whole = Composite(tuple(_part_in_doubles(part, i) for i, part in enumerate(parts)), _about(given))
        if whole.count > MOST_PARTS:
            remedy = "leave out the digits, or give the body by its points or its tensor of inertia"
            raise BudgetExceeded("parts", whole.count, MOST_PARTS, path=("parts",), remedy=remedy)
        return ExactMass.together([_part(part, i) for i, part in enumerate(parts)], whole.about)
    raise _not_summed(kind)


def _not_summed(kind: object) -> NotApplicable:
    return NotApplicable(
        f"a body of kind {kind} is summed in fixed precision, which is no ground for proven digits",
        path=("kind",),
        remedy="give it by its tensor of inertia or its points, or leave out the digits",
    )


@contextmanager
def _within(*path: str | int) -> Iterator[None]:
    """Tell faults as seen from an enclosing object."""
    try:
        yield
    except InvalidParameter as fault:
        raise fault.inside(*path) from None
    except NotApplicable as fault:
        raise NotApplicable(fault.detail, path=(*path, *fault.path), remedy=fault.remedy) from None


def _only(given: Mapping[str, Any], first: str, *others: str) -> Any:
    """Return the field `first`, which must be there; besides it only `others` may be."""
    for name in given:
        if name not in (first, *others):
            raise InvalidParameter(name, f"be a field of this body: {', '.join((first, *others))}")
    if first not in given:
        raise InvalidParameter(first, "be given")
    return given[first]


def _about(given: Mapping[str, Any]) -> Any:
    about = given.get("about", "center-of-mass")
    if about not in ("center-of-mass", "origin"):
        raise InvalidParameter("about", 'be "center-of-mass" or "origin"')
    return about


def _of_tensor(given: Mapping[str, Any]) -> ExactMass:
    tensor = symmetric(_only(given, "tensor", "mass", "center_of_mass"))
    mass, center = given.get("mass"), given.get("center_of_mass")
    if mass is not None:
        mass = exact(mass, "mass")
        if mass <= 0:
            raise InvalidParameter("mass", "be greater than 0 kg")
    if center is not None:
        center = triple(exact_numbers(center, ("center_of_mass",), 3))
    return ExactMass(tensor, mass, center, given_by="tensor")


def _solid(kind: type[Uniform], given: Mapping[str, Any]) -> ExactMass:
    """Return a solid; one of negative mass or density is a hole."""
    _solid_in_doubles(kind, given)
    solid = kind(**{name: _exactly(value, (name,)) for name, value in given.items()})
    shape = solid.shape()
    if solid.mass is None and shape.pi_power:
        raise NotApplicable(
            "the mass of a round body of given density holds a power of pi",
            path=("density",),
            remedy="give its mass, as a decimal string if need be",
        )
    mass = solid.weigh(shape)
    x, y, z = (triple([mass * entry for entry in row]) for row in shape.inertia)
    return ExactMass((x, y, z), mass, triple(shape.center_of_mass))


def _solid_in_doubles(kind: type[Uniform], given: Mapping[str, Any]) -> Uniform:
    known = {entry.name: entry for entry in fields(kind) if entry.name != "kind"}
    for name in given:
        if name not in known:
            raise InvalidParameter(name, f"be a field of this body: {', '.join(known)}")
    for name, entry in known.items():
        if entry.default is MISSING and name not in given:
            raise InvalidParameter(name, "be given")
    return kind(**{name: _rounded(_exactly(value, (name,))) for name, value in given.items()})


def _part(part: Mapping[str, Any], i: int) -> ExactMass:
    body, path = part["body"], ("parts", i, "body")
    with _within(*path):
        uniform = UNIFORM.get(body.get("kind"))
        own = _any_body(body) if uniform is None else _solid(uniform, {n: v for n, v in body.items() if n != "kind"})
    for name, known in (("mass", own.mass), ("center_of_mass", own.center_of_mass)):
        if known is None:
            raise InvalidParameter(
                path,
                f"have a known {name} to be a part of a composite",
                remedy="give an inertia-tensor with mass and center_of_mass, or another kind of body",
            )
    attitude = exact_numbers(part.get("attitude", (1, 0, 0, 0)), ("parts", i, "attitude"), 4)
    position = exact_numbers(part.get("position", (0, 0, 0)), ("parts", i, "position"), 3)
    placed = own.placed(attitude, position)
    return placed.taken_away() if part.get("hole") else placed


def _part_in_doubles(part: Mapping[str, Any], i: int) -> Part:
    """Return a part of the nearest doubles, which only says whether it may be one."""
    with _within("parts", i):
        body = _only(part, "body", "position", "attitude", "hole")
        given = {name: _rounded(_exactly(part[name], (name,))) for name in ("position", "attitude") if name in part}
        with _within("body"):
            own = _in_doubles(body)
        return Part(own, **given, hole=part.get("hole", False))


def _in_doubles(body: Mapping[str, Any]) -> Any:
    kind = body.get("kind")
    given = {name: value for name, value in body.items() if name not in ("kind", "about", "parts")}
    if kind == "composite":
        parts = _only(body, "parts", "about", "kind")
        return Composite(tuple(_part_in_doubles(part, i) for i, part in enumerate(parts)), _about(body))
    if isinstance(kind, str) and kind in UNIFORM:
        return _solid_in_doubles(UNIFORM[kind], given)
    plain = {name: _rounded(_exactly(value, (name,))) for name, value in given.items()}
    try:
        if kind == "point-masses":
            positions = [list(point) for point in plain["positions"]]
            masses = plain["masses"]
            return PointMasses(list(masses) if isinstance(masses, tuple) else masses, positions, _about(body))
        if kind == "inertia-tensor":
            return InertiaTensor(**plain)
        if kind == "principal-moments":
            return PrincipalMoments(**plain)
    except (KeyError, TypeError) as fault:
        raise InvalidParameter((), f"have the fields of its kind: {fault}") from None
    raise _not_summed(kind)


def _exactly(value: Any, path: tuple[str | int, ...]) -> Any:
    if isinstance(value, (tuple, list)):
        return tuple(_exactly(entry, (*path, i)) for i, entry in enumerate(value))
    return value if value is None else exact(value, path)


def _rounded(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_rounded(entry) for entry in value)
    return None if value is None else nearest(value)
