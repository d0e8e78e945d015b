"""Radau IIA of order five, from SciPy: an implicit Runge-Kutta method for stiff motions.

References
----------
E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, section IV.8.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from core.systems.methods.from_scipy import FromSciPy
from core.systems.methods.method import Family


@dataclass(frozen=True)
class Radau(FromSciPy):
    """Radau IIA with three stages; samples inside a step come from an interpolant of order three.

    Parameters
    ----------
    tolerance : float
        Largest estimated error of a step, relative to the largest component of the initial state and to each
        component, whichever is more.
    """

    kind: Literal["radau"] = "radau"

    solver: ClassVar[str] = "Radau"
    order: ClassVar[int] = 5
    family: ClassVar[Family] = "implicit"
    between_steps: ClassVar[str] = "By the method's own collocation polynomial, an interpolant of order three."
    when_to_use: ClassVar[str] = (
        "For stiff motions, where explicit methods would need steps far shorter than anything that is seen; a free "
        "body is not one."
    )
