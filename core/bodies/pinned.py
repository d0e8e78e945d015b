"""What is to be said of a body that is held at a point other than its centre of mass."""

from __future__ import annotations

import math

from core.bodies.mass_properties import MassProperties
from core.notices import Notice

AT_THE_ORIGIN = 2.0**-48
"""Distance of the centre of mass from the origin, over the radius of gyration, that rounding explains."""


def pinned_notices(body: MassProperties) -> tuple[Notice, ...]:
    """Return what is to be said of a body that is held at a point other than its centre of mass; paths lead from it."""
    if body.about != "origin" or body.mass is None or body.center_of_mass is None:
        return ()
    distance = math.hypot(*(float(x) for x in body.center_of_mass))
    gyration = math.sqrt(float(body.principal_of_motion.moments[2])) / math.sqrt(body.mass)
    return () if distance <= AT_THE_ORIGIN * gyration else (not_free(distance),)


def not_free(distance: float) -> Notice:
    """Return the warning about a body that is held at so many metres from its centre of mass; its path leads from it.

    Euler's equations hold about the pin, and the pin's force has no torque about it; any uniform field has one, as its
    resultant acts at the centre of mass (H. Goldstein, C. Poole, J. Safko, "Classical Mechanics", 3rd ed., sections 1.2
    and 5.7).
    """
    detail = (
        f"the body is held at the origin, {distance:.6g} m from its centre of mass: it turns as answered only without "
        "gravity and in a smooth pivot that does not accelerate. A body that floats or is thrown turns about its "
        'centre of mass: leave out about, or give "center-of-mass"'
    )
    return Notice("not-free", detail, ("about",))
