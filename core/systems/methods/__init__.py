"""The catalogue of methods: one file and one line each."""

from __future__ import annotations

from typing import Annotated

from core.quantities import TaggedBy
from core.systems.methods.closed_form import ClosedFormEvaluation
from core.systems.methods.discrete_moser_veselov import DiscreteMoserVeselov
from core.systems.methods.dormand_prince_853 import DormandPrince853
from core.systems.methods.explicit_euler import ExplicitEuler
from core.systems.methods.implicit_midpoint import ImplicitMidpoint
from core.systems.methods.lsoda import Lsoda
from core.systems.methods.radau import Radau
from core.systems.methods.runge_kutta_4 import RungeKutta4
from core.systems.methods.symmetric_splitting import SymmetricSplitting

__all__ = [
    "ClosedFormEvaluation",
    "DiscreteMoserVeselov",
    "DormandPrince853",
    "ExplicitEuler",
    "ImplicitMidpoint",
    "Lsoda",
    "Method",
    "Radau",
    "RungeKutta4",
    "SymmetricSplitting",
]

Method = Annotated[
    ClosedFormEvaluation
    | ExplicitEuler
    | RungeKutta4
    | ImplicitMidpoint
    | SymmetricSplitting
    | DiscreteMoserVeselov
    | DormandPrince853
    | Lsoda
    | Radau,
    TaggedBy("kind"),
]
