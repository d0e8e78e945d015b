"""The equations of a scene as they are answered and documented."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field

from core.multibody.equations_answer import SceneEquations as Written
from core.multibody.equations_answer import WrittenFormula
from core.multibody.formulation.notation.plain import plain
from core.quantities import Unit
from service.schemas import View, fields_of

InSI = Annotated[float, Unit("in SI units and radians")]
"""A number whose unit follows from the formula in which it stands."""


class WrittenEquation(View):
    """A formula or an equation in three notations."""

    plain: str = Field(description="Text, as formulas of questions are; a prime is a derivative by time.")
    latex: str
    mathml: str


class ConservedQuantity(WrittenEquation):
    """A function of coordinates and rates that stays what it is."""

    name: str
    value: InSI
    error: InSI | None = Field(description="Bound of the error of the value; null beyond the range of doubles.")


class CoordinateAtStart(View):
    """A coordinate and its rate at the start."""

    value: InSI
    rate: InSI | None = Field(description="null of a coordinate whose equation is of the first order.")
    error: InSI | None = Field(description="Bound of the error of the value; null beyond the range of doubles.")
    rate_error: InSI | None = Field(description="Bound of the error of the rate; null where that is.")


class LinearPart(View):
    """M x'' + D x' + K x = b of a part whose equations are linear or of its small motions, in SI units and radians."""

    coordinates: list[str] = Field(description="x, or of small motions the deviations of these.")
    about: dict[str, InSI] = Field(description="Of small motions the place of rest; empty for linear equations.")
    mass: list[list[InSI]] = Field(description="M.")
    damping: list[list[InSI]] = Field(description="D, with gyroscopic terms.")
    stiffness: list[list[InSI]] = Field(description="K.")
    load: list[InSI] = Field(description="b.")


class SceneEquations(View):
    """The equations of motion of a scene, of the first of its phases, in coordinates that suffice."""

    coordinates: dict[str, str | None] = Field(
        description="Coordinates, each with its formula of columns; null for what no column shows: turns of balls, and "
        "the directions of strings that run onto turning discs."
    )
    start: dict[str, CoordinateAtStart] = Field(
        description="Coordinates and rates at the start: with the equations, all that the motion follows from."
    )
    why: list[str] = Field(description="Why these suffice, in sentences.")
    degrees_of_freedom: Annotated[int, Unit("1")]
    places: dict[str, str] = Field(description="Places and angles of bodies as formulas of the coordinates.")
    constants: dict[str, InSI] = Field(
        description="Numbers of many digits, which have names in the formulas, and names of `let` that laws use."
    )
    equations: list[WrittenEquation] = Field(
        description="Equations of motion, one for each coordinate, with multipliers lambda_1, ... of the constraints."
    )
    constraints: list[WrittenEquation] = Field(description="What the coordinates satisfy besides, in the same order.")
    forces: dict[str, WrittenEquation] = Field(
        description="Forces that are formulas of the question, and those of connections that follow from coordinates, "
        "rates and accelerations, by their names in `forces`."
    )
    lagrangian: WrittenEquation | None = Field(description="null unless its equations are these.")
    conserved: list[ConservedQuantity] = Field(description="As the equations show for every motion.")
    linear: list[LinearPart] = Field(
        description="Matrices of the parts with linear equations, or with a place of rest that is found near the start."
    )
    closed_form: dict[str, WrittenEquation] = Field(
        description="Coordinates as functions of t, where these are elementary, and angles of pendulums by Jacobi's "
        "functions sn(u, m) and am(u, m)."
    )


def equations_fields(found: Written) -> dict[str, Any]:
    """Return the fields of written equations, formulas as objects."""

    def shown(formulas: Mapping[str, WrittenFormula]) -> dict[str, Any]:
        return {name: _notations(one) for name, one in formulas.items()}

    return fields_of(found) | {
        "start": {name: fields_of(one) for name, one in found.start.items()},
        "places": {name: plain(node) for name, node in found.places.items()},
        "equations": [_notations(one) for one in found.equations],
        "constraints": [_notations(one) for one in found.constraints],
        "forces": shown(found.forces),
        "lagrangian": None if found.lagrangian is None else _notations(found.lagrangian),
        "conserved": [
            {"name": one.name, "value": one.value, "error": one.error} | _notations(one.formula)
            for one in found.conserved
        ],
        "linear": [fields_of(one) for one in found.linear],
        "closed_form": shown(found.closed_form),
    }


def _notations(one: WrittenFormula) -> dict[str, Any]:
    return {"plain": one.plain, "latex": one.latex, "mathml": one.mathml}
