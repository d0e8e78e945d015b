"""What is said of bodies of which two principal moments are nearly equal: one rule for every answer about them.

Which moments differ is decided in `PrincipalInertia.apart`: those that were given, or rounded once, unless they are the
same; derived ones beyond the resolution of deriving them. Every motion is that of the moments so told apart: samples,
attitude, regime, period, flips and polhodes. Where they differ by less than 16 units in the last place of the largest,
half a unit in a moment may change all of that, and a warning says so.

What is a class and no motion (the symmetry of a body, the figures that only symmetric bodies have, and the kinds of
equilibria of a body whose moments were derived) goes by moments that are equal to within those 16 units, and a warning
says so where they differ.
"""

from __future__ import annotations

from fractions import Fraction

from core.bodies.exact import exact_vector, vector_pairs
from core.bodies.principal_inertia import PrincipalInertia
from core.notices import Notice
from core.systems.system import Floats

NEARLY_EQUAL = Notice(
    "moments-nearly-equal",
    "two moments differ by less than 16 units in the last place of the largest; the difference is taken as given, and "
    "half a unit in a moment may change the whole motion",
    ("body",),
)


def equal_within_rounding(which: str, what: str) -> Notice:
    """Return the warning that some moments, though not the same, are taken as equal for some statement."""
    detail = f"{which} differ by less than 16 units in the last place of the largest and are taken as equal for {what}"
    return Notice("moments-equal-within-rounding", detail, ("body",))


def curve_notices(inertia: PrincipalInertia) -> tuple[Notice, ...]:
    """Return what is to be said of curves on the energy ellipsoid of a body, which are those of the moments as given.

    A motion has its own: `TorqueFree.moment_notices`.
    """
    return (NEARLY_EQUAL,) if inertia.nearly_equal else ()


def moments_of_kinds(inertia: PrincipalInertia) -> tuple[tuple[Floats, Floats], tuple[Notice, ...]]:
    """Return the moments by which the kinds of equilibria are told, with their tails, and what is to be said of them.

    Those that are the body's own along its axes differ if they differ. Derived ones carry the rounding of the numbers
    they were derived from, which are doubles, and the sign of a smaller difference would be that of rounding.
    """
    given = inertia.moments, inertia.moments_tail
    low, middle, high = exact = exact_vector(*given)
    if inertia.rounding.exact_zeros:
        return given, (NEARLY_EQUAL,) if inertia.nearly_equal else ()
    symmetry = inertia.symmetry
    if symmetry == "spherical":
        merged = [sum(exact, Fraction(0)) / 3] * 3
    elif symmetry == "oblate":
        merged = [(low + middle) / 2] * 2 + [high]
    elif symmetry in ("prolate", "linear"):
        merged = [low] + [(middle + high) / 2] * 2
    else:
        return given, ()
    # What is left between the equal moments of a turned solid is not worth a word.
    notices = (equal_within_rounding("moments", "the kinds of equilibria"),) if inertia.nearly_equal else ()
    return vector_pairs(merged), notices
