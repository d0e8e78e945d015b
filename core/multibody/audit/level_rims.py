"""Rims of discs and cylinders that start level on a plane: they touch it by four places, one of which is the lowest.

With nu the components of the normal along the body axes, the lowest point of a rim about the third axis is at
-(nu_1, nu_2)/|(nu_1, nu_2)| radii: it is on the first or the second axis where nu_1 nu_2 = 0. Where the body turns
about a level axis at the start, that axis and the one across take the place of the first two.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from core.multibody.audit.bodies import Outline, RigidBody
from core.multibody.audit.definition import Definition
from core.multibody.audit.placement import Numbers, Place, Placement, Undefined
from core.multibody.audit.surfaces import Face, Tip

LEVEL = 1e-9
"""Sine of an angle below which a rim is meant to be level: attitudes are rounded."""
QUARTERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
"""Where its places are, in radii along its two diameters."""


@dataclass(frozen=True)
class LevelRim(Definition):
    """The rims of a body of which one of two diameters stays along a face.

    Attributes
    ----------
    tips : tuple of Tip
        The places that touch.
    diameter : tuple of float
        Components of the first of them along the first two body axes; the other is at a right angle to it.
    """

    kind: ClassVar[str] = "contact"
    tips: tuple[Tip, ...]
    face: Face
    radius: float
    diameter: tuple[float, float]

    @property
    def reach(self) -> float:
        """See `Definition.reach`."""
        return self.radius

    @property
    def holds(self) -> bool:
        """See `Definition.holds`: that a diameter stays level follows from the rest, and no force does it."""
        return False

    def held(self, placement: Placement) -> Mapping[str, Numbers]:
        """See `Definition.held`."""
        axes = placement[self.bodies[0]].rotation
        if axes is None:
            raise Undefined("a rim whose attitude is not known")
        leaning = (np.swapaxes(axes, -1, -2) @ self.face.normal_in(placement)[..., None])[..., 0]
        (c, s), x, y = self.diameter, leaning[..., 0], leaning[..., 1]
        return {"lowest place": self.radius * (c * x + s * y) * (c * y - s * x)}


@dataclass(frozen=True)
class ContactOfLevelRims(Definition):
    """A contact by places of level rims, and what makes one of them the lowest."""

    kind: ClassVar[str] = "contact"
    places_touch: Definition
    rim: LevelRim

    @property
    def members(self) -> tuple[Definition, ...]:
        """See `Definition.members`."""
        return (*self.places_touch.members, self.rim)


def level_rim(
    outline: Outline[Place], face: Face, name: str, bodies: Mapping[str, RigidBody], answered: Collection[str] | None
) -> LevelRim | None:
    """Return the rims of an outline that start level on a face; None where there are none.

    Parameters
    ----------
    answered : collection of str, or None
        Contacts of which the answer has states. Beside `LEVEL` these say what a rim was taken for, which rounding may
        decide; None where there is no answer.
    """
    body = outline.corners[0].body
    if body is None or not outline.semi_axes or outline.semi_axes[2]:
        return None
    start = {own: one.start for own, one in bodies.items()}
    axes, radius, turns = start[body].rotation, outline.semi_axes[0], bodies[body].angular_velocity
    if axes is None:
        return None
    leaning = np.abs(axes.T @ face.normal_in(start))[:2].max()
    places = f"{name}.{len(outline.corners) * len(QUARTERS)}"
    if not leaning < LEVEL if answered is None else not (leaning < 2.0 * LEVEL and places in answered):
        return None
    moves = bodies[body].velocity
    along = np.array([1.0, 0.0, 0.0])
    if turns is not None and np.any(turns[:2]):
        along = turns
    elif moves is not None and np.linalg.norm((axes.T @ moves)[:2]) > LEVEL * np.linalg.norm(moves):
        along = axes.T @ moves
    c, s = along[:2] / np.linalg.norm(along[:2])
    sides = [(radius * (c * x - s * y), radius * (s * x + c * y)) for x, y in QUARTERS]
    tips = [
        Tip(Place(body, (corner.offset[0] + x, corner.offset[1] + y, corner.offset[2])))
        for corner in outline.corners
        for x, y in sides
    ]
    return LevelRim(name, (body, *face.at.bodies), tuple(tips), face, radius, (float(c), float(s)))
