"""The catalogue of methods: one file and one line each."""

from __future__ import annotations

from typing import Annotated

from core.integration.methods.closed_form import ClosedFormEvaluation
from core.integration.methods.discrete_moser_veselov import DiscreteMoserVeselov
from core.integration.methods.dormand_prince_853 import DormandPrince853
from core.integration.methods.explicit_euler import ExplicitEuler
from core.integration.methods.implicit_midpoint import ImplicitMidpoint
from core.integration.methods.lsoda import Lsoda
from core.integration.methods.radau import Radau
from core.integration.methods.runge_kutta_4 import RungeKutta4
from core.integration.methods.symmetric_splitting import SymmetricSplitting
from core.quantities import TaggedBy

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
