"""Mass, centre of mass and inertia of a body; its principal moments and axes; whether they are physically possible."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal

import numpy as np

from core.arrays import Floats
from core.bodies.exact import (
    Matrix,
    Vector,
    exact_matrix,
    exact_vector,
    parallel_axis,
    size_pair,
    tensor_pairs,
    vector_pairs,
)
from core.bodies.principal_inertia import GIVEN, ROUNDED_ONCE, ZEROS, PrincipalInertia, Rounding, Symmetry, summed
from core.bodies.validity import Condition, Validity, moments_of_matter
from core.errors import NotApplicable
from core.notices import Notice

__all__ = ["Condition", "MassProperties", "PrincipalInertia", "Symmetry", "Validity"]

About = Literal["center-of-mass", "origin"]


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Mass, centre of mass and inertia of a body.

    A derived number is stored as an unevaluated sum of two doubles, value and tail, accurate to about 1e-30, so its
    rounding does not add to the error of a motion. Off-diagonal components are I_xy = -(integral of x y dm).

    Attributes
    ----------
    inertia, inertia_tail : ndarray, shape (3, 3)
        Tensor of inertia about the centre of mass, in body axes (kg m^2).
    mass, mass_tail : float
        Total mass (kg); `mass` is None if the body was given by its moments alone.
    center_of_mass, center_of_mass_tail : ndarray, shape (3,), or None
        In the frame in which the body was given (m).
    about : {"center-of-mass", "origin"}
        The point about which the body turns: the origin for a body that is pinned there.
    warnings : tuple of Notice
        Warnings about the body; paths are relative to it.
    conditions : tuple of Condition
        Conditions of the validity report other than those of the moments.
    described_by : Body, optional
        The body that these are derived from; without one, the components of the tensor are the inputs.
    rounding : Rounding
        What is known of the components of the tensor.
    unrounded : matrix of Fraction, optional
        The tensor before it was rounded, where it is exact.
    mass_error, center_of_mass_error : float
        What the mass and each coordinate of the centre of mass may be wrong by, beside their rounding to two doubles
        (kg, m).
    """

    inertia: Floats
    inertia_tail: Floats
    mass: float | None = None
    center_of_mass: Floats | None = None
    mass_tail: float = 0.0
    center_of_mass_tail: Floats | None = None
    about: About = "center-of-mass"
    warnings: tuple[Notice, ...] = ()
    conditions: tuple[Condition, ...] = ()
    described_by: Any = None
    rounding: Rounding = GIVEN
    unrounded: Matrix | None = None
    mass_error: float = 0.0
    center_of_mass_error: float = 0.0

    def __post_init__(self) -> None:
        self.inertia.setflags(write=False)
        self.inertia_tail.setflags(write=False)
        if self.center_of_mass is not None:
            self.center_of_mass.setflags(write=False)
        if self.center_of_mass_tail is not None:
            self.center_of_mass_tail.setflags(write=False)

    @classmethod
    def from_exact(
        cls,
        mass: Fraction,
        center_of_mass: Vector,
        inertia: Matrix,
        *,
        warnings: tuple[Notice, ...] = (),
        conditions: tuple[Condition, ...] = (),
        rounding: Rounding = ROUNDED_ONCE,
    ) -> MassProperties:
        """Round rational mass properties once, to a pair of doubles each.

        Parameters
        ----------
        rounding : Rounding, optional
            What is known of the rational numbers, where they are not exact.

        Raises
        ------
        InvalidParameter
            If one lies outside the range of doubles.
        """
        m, m_tail = size_pair(mass)
        c, c_tail = vector_pairs(center_of_mass)
        i, i_tail = tensor_pairs(inertia)
        return cls(
            i, i_tail, m, c, m_tail, c_tail, warnings=warnings, conditions=conditions,
            rounding=_after(inertia, i, i_tail, rounding), unrounded=inertia if rounding.exact_zeros else None,
        )  # fmt: skip

    @property
    def exact_mass(self) -> Fraction:
        """The mass, both parts."""
        if self.mass is None:
            raise NotApplicable("the mass of this body is not known", remedy="state its mass")
        return Fraction(self.mass) + Fraction(self.mass_tail)

    @property
    def exact_center_of_mass(self) -> Vector:
        """The centre of mass, both parts."""
        if self.center_of_mass is None:
            raise NotApplicable("the centre of mass of this body is not known", remedy="state its center_of_mass")
        return exact_vector(self.center_of_mass, self.center_of_mass_tail)

    @property
    def exact_inertia(self) -> Matrix:
        """The tensor about the centre of mass, both parts."""
        return exact_matrix(self.inertia, self.inertia_tail)

    @cached_property
    def principal(self) -> PrincipalInertia:
        """Principal inertia about the centre of mass."""
        return PrincipalInertia.of(self.inertia, self.inertia_tail, self.rounding, self.unrounded)

    def inertia_about(self, point: Sequence[float] | Floats) -> tuple[Floats, Floats]:
        """Return the tensor about another point, in body axes, as value and tail, each of shape (3, 3).

        By the parallel-axis theorem (Steiner): I + m (d.d 1 - d d^T), d from the centre of mass to the point.

        Raises
        ------
        NotApplicable
            If mass or centre of mass is not known.
        """
        center = self.exact_center_of_mass
        d = [Fraction(float(p)) - c for p, c in zip(point, center, strict=True)]
        return tensor_pairs(parallel_axis(self.exact_mass, d, self.exact_inertia))

    @cached_property
    def about_origin(self) -> tuple[Floats, Floats] | None:
        """The tensor about the origin as value and tail, or None where mass or centre of mass is not known."""
        if self.mass is None or self.center_of_mass is None:
            return None
        return self.inertia_about((0.0, 0.0, 0.0))

    @property
    def inertia_about_origin(self) -> Floats | None:
        """The tensor about the origin, shape (3, 3), rounded."""
        return None if self.about_origin is None else self.about_origin[0]

    @cached_property
    def principal_about_origin(self) -> PrincipalInertia | None:
        """Principal inertia about the origin, or None where mass or centre of mass is not known."""
        if self.about_origin is None or self.center_of_mass is None:
            return None
        # Along one axis of the centre of mass nothing is added to a product of inertia, and only sums to a moment.
        along_one = np.count_nonzero(self.center_of_mass) <= 1 and self.rounding.exact_zeros
        return PrincipalInertia.of(*self.about_origin, ROUNDED_ONCE if along_one else summed(1))

    @property
    def principal_of_motion(self) -> PrincipalInertia:
        """Principal inertia about the point about which the body turns."""
        if self.about == "origin" and self.principal_about_origin is not None:
            return self.principal_about_origin
        return self.principal

    @property
    def symmetry(self) -> Symmetry:
        """Symmetry class of the principal moments about the centre of mass."""
        return self.principal.symmetry

    @cached_property
    def validity(self) -> Validity:
        """The validity report."""
        mass: tuple[Condition, ...] = ()
        if self.mass is not None:
            mass = (Condition("positive-mass", self.mass > 0.0, f"the mass is {self.mass:.6g} kg"),)
        return Validity.of(self.principal, (*mass, *self.conditions))

    def with_warnings(self, warnings: tuple[Notice, ...], conditions: tuple[Condition, ...] = ()) -> MassProperties:
        """Return a copy with further warnings and conditions."""
        return replace(self, warnings=(*self.warnings, *warnings), conditions=(*self.conditions, *conditions))

    def with_validity_warning(self, field: str) -> MassProperties:
        """Return a copy, with a warning at `field` if no distribution of positive mass has these moments."""
        if moments_of_matter(self.principal):
            return self
        failed = "; ".join(condition.detail for condition in self.validity.violations)
        notice = Notice(
            "unphysical-inertia",
            f"no real body has these moments of inertia, which violate {failed}; "
            "the equations of motion can still be solved",
            (field,),
        )
        return self.with_warnings((notice,))


def _after(exact: Matrix, value: Floats, tail: Floats, rounding: Rounding) -> Rounding:
    """Return what is known of a tensor that was rounded to pairs.

    Different moments may have become equal by it, and a product of inertia zero that is below every double.
    """
    for j, k in ((0, 1), (1, 2), (2, 0)):
        equal = value[j, j] == value[k, k] and tail[j, j] == tail[k, k] and exact[j][j] != exact[k][k]
        if rounding.exact_zeros and (equal or (value[j, k] == 0.0 and exact[j][k] != 0)):
            return summed(1)
    return rounding


def diagonal(moments: Sequence[float]) -> MassProperties:
    """Return mass properties of which only principal moments are known, in body axes as given, shape (3,)."""
    a, b, c = map(float, moments)
    inertia = np.zeros((3, 3))
    inertia[0, 0], inertia[1, 1], inertia[2, 2] = a, b, c
    properties = MassProperties(inertia, ZEROS)
    # Where `principal` would keep what it finds.
    properties.__dict__["principal"] = PrincipalInertia.along_body_axes((a, b, c))
    return properties
