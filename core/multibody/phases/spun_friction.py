"""Friction in a plane that spins about its vertical: what bears Coriolis' force, across the plane, rubs as well."""

from __future__ import annotations

from core.errors import NotApplicable
from core.multibody.algebra.polynomials import Ball, LinearForm, Poly, combined
from core.multibody.contacts.complementarity import Decided
from core.multibody.table.description import Described


def require_pressed_in_plane(base: Described, decided: Decided) -> None:
    """Raise where something slides that Coriolis' force presses across the plane.

    The force is 2 m times the rate of the frame times the horizontal velocity. What is borne across the plane adds to
    the normal force by the root of the sum of their squares, which no table of quadratics has. What sticks has no
    velocity, and what slides along the vertical none that counts.

    Raises
    ------
    NotApplicable
    """
    across = base.measures.pressed_by
    if across is None:
        return
    for one, state in zip(decided.unilateral, decided.states, strict=True):
        if state.sense and one.slip is not None and _is_horizontal(base, one.slip, across):
            raise NotApplicable(
                f'"{one.name}" slides in a plane that spins about its vertical: the reaction to Coriolis\' force '
                "across the plane rubs as well, and is not answered",
                path=(*base.paths[one.name], "friction"),
                remedy="leave the friction out, or ask for earlier times or thresholds of rest, where it sticks",
            )


def _is_horizontal(base: Described, slip: LinearForm, across: list[Ball]) -> bool:
    """Return whether a rate of slip contains a horizontal velocity."""
    nothing: Poly = {}
    return any(
        combined(*((x, slip.get(i, nothing)) for x, i in zip(across, frame.position, strict=True)))
        for frame in base.measures.coordinates.frames.values()
    )
