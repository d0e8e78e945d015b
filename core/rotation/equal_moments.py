"""Warnings about nearly equal principal moments: one rule for all answers.

`PrincipalInertia.apart` decides which moments differ. Moments that were given, or rounded once, differ unless they are
identical; derived moments differ if their difference exceeds the resolution of the derivation. All motions depend on
these differences: samples, attitude, regime, period, flips and polhodes. If moments differ by less than 16 units in the
last place of the largest, half a unit in a moment may change all of this; the answer has a warning.

What is a class and no motion goes by moments that are equal to within those 16 units: the symmetry of a body, the
figures that only symmetric bodies have, and, where the moments were derived, the kinds of equilibria and whether there
is a middle axis to flip about, unless the motion shows that there is. A warning says so where they differ.
"""

from __future__ import annotations

from fractions import Fraction

from core.arrays import Floats
from core.bodies.exact import exact_vector, vector_pairs
from core.bodies.principal_inertia import PrincipalInertia
from core.notices import Notice

NEARLY_EQUAL = Notice(
    "moments-nearly-equal",
    "two moments differ by less than 16 units in the last place of the largest; the difference is taken as given, and "
    "half a unit in a moment may change the whole motion",
    ("body",),
)


def equal_within_rounding(which: str, what: str) -> Notice:
    """Return the warning that moments which differ are treated as equal for some statement."""
    detail = f"{which} differ by less than 16 units in the last place of the largest and are taken as equal for {what}"
    return Notice("moments-equal-within-rounding", detail, ("body",))


def curve_notices(inertia: PrincipalInertia) -> tuple[Notice, ...]:
    """Return the warnings about curves on the energy ellipsoid of a body, which use the moments as given.

    The warnings of a motion are `TorqueFree.moment_notices`.
    """
    return (NEARLY_EQUAL,) if inertia.nearly_equal else ()


def moments_of_kinds(inertia: PrincipalInertia) -> tuple[tuple[Floats, Floats], tuple[Notice, ...]]:
    """Return the moments that determine the kinds of equilibria, with their tails, and the warnings about them.

    Moments with exact axes are used as they are. Derived moments are affected by the rounding of the doubles that they
    were derived from, which determines the sign of a smaller difference.
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
    # The rounding between the equal moments of a rotated solid needs no warning.
    notices = (equal_within_rounding("moments", "the kinds of equilibria"),) if inertia.nearly_equal else ()
    return vector_pairs(merged), notices
