"""LSODA, from SciPy: multistep methods that switch between stiff and non-stiff by themselves.

References
----------
L. Petzold, "Automatic selection of methods for solving stiff and nonstiff systems of ordinary differential equations",
SIAM Journal on Scientific and Statistical Computing 4 (1983) 136.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from core.systems.methods.from_scipy import FromSciPy
from core.systems.methods.method import Family


@dataclass(frozen=True)
class Lsoda(FromSciPy):
    """LSODA: Adams' methods of orders 1 to 12, or backward differentiation of orders 1 to 5 where the motion is stiff.

    Parameters
    ----------
    tolerance : float
        Largest estimated error of a step, relative to the largest component of the initial state and to each
        component, whichever is more.
    """

    kind: Literal["lsoda"] = "lsoda"

    solver: ClassVar[str] = "LSODA"
    order: ClassVar[None] = None
    family: ClassVar[Family] = "implicit"
    between_steps: ClassVar[str] = (
        "By the polynomial of the current order that the multistep method itself carries from step to step."
    )
    when_to_use: ClassVar[str] = (
        "To compare with what scipy.integrate.odeint gives, or for a motion that may turn stiff on its way."
    )
