"""What is proved about a rotation about a principal axis, by how the moments are ordered and by nothing else.

A centre of the linear equation proves nothing by itself; the energy-Casimir method does: on an extreme axis the energy
has a strict extremum among the angular velocities of the same |L|.

References
----------
J. E. Marsden, T. S. Ratiu, "Introduction to Mechanics and Symmetry", 2nd ed., sections 1.7 and 15.9. V. I. Arnold,
"Mathematical Methods of Classical Mechanics", section 29. R. N. Bracewell, O. K. Garriott, "Rotation of artificial
earth satellites", Nature 182 (1958) 760 (the major-axis rule).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Literal, NamedTuple

from core.notices import Notice

Kind = Literal["center", "saddle", "degenerate"]
Attitude = Literal["orbital", "unstable"]


class Verdict(NamedTuple):
    """What is proved about an equilibrium by how the moments are ordered; see `core.rotation.stability.Equilibrium`."""

    kind: Kind
    stable: bool
    linearly_stable: bool
    attitude: Attitude
    survives_dissipation: bool
    reason: str


def classify_equilibrium(ranks: Sequence[int], axis: int, turns: bool) -> Verdict:
    """Return what is proved about the rotation about a principal axis.

    Parameters
    ----------
    ranks : sequence of 3 int
        Of the moments in ascending order; equal moments have equal ranks: (0, 1, 2), (0, 0, 1), (0, 1, 1), (0, 0, 0).
    axis : int
        Which of the three, 0 for the least moment.
    turns : bool
        Whether the rate is not zero.
    """
    if not turns:
        return REST
    own, others = ranks[axis], [ranks[n] for n in range(3) if n != axis]
    survives = own == ranks[2]
    if ranks[0] == ranks[2]:
        return Verdict("degenerate", True, True, "orbital", True, _SPHERE)
    after = _DISSIPATION[survives]
    if own in others:
        return Verdict("degenerate", False, False, "unstable", survives, f"{_PLANE} {after}")
    if others[0] < own < others[1]:
        return Verdict("saddle", False, False, "unstable", False, f"{_SADDLE} {after}")
    size = "largest" if survives else "smallest"
    extremum = "least" if survives else "greatest"
    reason = _CENTER.format(size=size, extremum=extremum)
    return Verdict("center", True, True, "orbital", survives, f"{reason} {after}")


def drift(own: Fraction, low: Fraction, high: Fraction, rate: Fraction) -> Fraction:
    """Return the rate at which a spin about one of two equal moments drifts, per unit of disturbance (1/s)."""
    if (own == low) == (own == high):
        return Fraction(0)
    return abs(rate * ((high if own == low else low) - own)) / own


UNSTABLE_SPINS: Mapping[Kind, str] = {
    "saddle": "the spin lies along the middle axis, which is unstable: nothing accelerates, but the slightest "
    "disturbance grows exponentially and turns the body over",
    "degenerate": "the spin lies in the plane of two equal moments, which is unstable: nothing accelerates, but the "
    "slightest rate along the third axis makes the spin drift round the plane",
}
"""What a steady spin that is not stable is said to be, by its kind of equilibrium."""


def unstable_axis(why: str) -> Notice:
    """Return the warning about a spin that is unstable; its path leads from the question."""
    return Notice("unstable-axis", why, ("angular_velocity",))


def unstable_spin(apart: tuple[bool, bool], components: Sequence[float]) -> str | None:
    """Return why a steady spin is unstable, None where it is stable.

    Parameters
    ----------
    apart : tuple of 2 bool
        Whether the middle moment differs from the smallest, and the largest from the middle one.
    components : sequence of 3 float
        Of the spin along ascending principal axes; those that do not vanish lie along axes of equal moments.
    """
    axis = max(range(3), key=lambda k: abs(components[k]))
    verdict = classify_equilibrium((0, int(apart[0]), sum(apart)), axis, components[axis] != 0.0)
    return None if verdict.stable else UNSTABLE_SPINS[verdict.kind]


_CENTER = (
    "The moment is the {size}: a disturbance circles the axis (eigenvalues +-i times a rate). That is only linear; "
    "stability is proved by the energy-Casimir method, the energy being strictly {extremum} here for the given |L|. "
    "The attitude is stable as an orbit only."
)
_SADDLE = (
    "The moment lies between the other two: a disturbance grows exponentially, which the linearised equation "
    "proves also for the full one, and the body turns over again and again."
)
_PLANE = (
    "Two moments are equal and the spin lies in their plane, where every axis is an equilibrium: the three eigenvalues "
    "are zero but form a Jordan block, so that a rate along the third axis makes the spin drift round the plane "
    "linearly. It is unstable as a point, yet the motion is bounded: the ring of all such spins is stable."
)
_SPHERE = (
    "The three moments are equal: every angular velocity is constant, so that a disturbance neither grows nor decays "
    "(neutral: Lyapunov stable, not asymptotically). The attitude is stable as an orbit only. Dissipation has nothing "
    "to act upon, as the energy is the same on every axis."
)
_REST = (
    "Nothing turns: a small angular velocity stays small because its energy does, though the linearised equation is "
    "zero and says nothing. The attitude is unstable: the slightest rate carries it round."
)
_DISSIPATION = {
    True: "With energy lost inside at constant angular momentum the body ends here (major-axis rule).",
    False: "With energy lost inside at constant angular momentum the body leaves it for the axis of largest moment.",
}

REST = Verdict("degenerate", True, True, "unstable", False, _REST)
"""About the state of rest, which no axis has."""
