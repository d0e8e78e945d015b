"""LSODA, from SciPy: multistep methods that switch between stiff and non-stiff by themselves.

References
----------
L. Petzold, "Automatic selection of methods for solving stiff and nonstiff systems of ordinary differential equations",
SIAM Journal on Scientific and Statistical Computing 4 (1983) 136.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from core.quantities import check
from core.systems.methods.from_scipy import FromSciPy, SciPyTolerance
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

    tolerance: SciPyTolerance
    kind: Literal["lsoda"] = "lsoda"

    order: ClassVar[None] = None
    family: ClassVar[Family] = "implicit"
    between_steps: ClassVar[str] = (
        "By the polynomial of the current order that the multistep method itself carries from step to step."
    )
    when_to_use: ClassVar[str] = (
        "To compare with what scipy.integrate.odeint gives, or for a motion that may turn stiff on its way."
    )

    def __post_init__(self) -> None:
        check(self)

    def _solver(self) -> Any:
        from scipy.integrate import LSODA

        return LSODA
