"""What is answered about the equations of a scene: formulas as text, as LaTeX and as MathML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.formulas import Node


@dataclass(frozen=True)
class WrittenFormula:
    """A formula or an equation.

    Attributes
    ----------
    plain : str
        Text in the grammar of formulas, with a prime for each derivative by time.
    latex, mathml : str
    sides : tuple of Node
        The formula, or both sides of the equation.
    """

    plain: str
    latex: str
    mathml: str
    sides: tuple[Node, ...]


@dataclass(frozen=True)
class ConservedQuantity:
    """A function of places and rates that stays what it is.

    Attributes
    ----------
    name : str
    formula : WrittenFormula
    value, error : float
        In SI units.
    """

    name: str
    formula: WrittenFormula
    value: float
    error: float | None


@dataclass(frozen=True)
class LinearEquations:
    """M x'' + D x' + K x = b of a part whose equations are linear, or of its small motions.

    Attributes
    ----------
    coordinates : tuple of str
        x, or of small motions the deviations of these.
    about : mapping of str to float
        Of small motions the place of rest; empty where the equations are linear.
    mass, damping, stiffness : tuple of tuple of float
    load : tuple of float
    """

    coordinates: tuple[str, ...]
    about: Mapping[str, float]
    mass: tuple[tuple[float, ...], ...]
    damping: tuple[tuple[float, ...], ...]
    stiffness: tuple[tuple[float, ...], ...]
    load: tuple[float, ...]


@dataclass(frozen=True)
class CoordinateAtStart:
    """A coordinate and its rate at the start.

    Attributes
    ----------
    value, rate : float
        In SI units; the rate is None of a coordinate whose equation is of the first order.
    error, rate_error : float or None
        Bounds; None beyond the range of doubles, and of a rate that is None.
    """

    value: float
    rate: float | None
    error: float | None
    rate_error: float | None


@dataclass(frozen=True)
class SceneEquations:
    """The equations of motion of a scene in the first of its phases.

    Attributes
    ----------
    coordinates : mapping of str to (str or None)
        Generalised coordinates, each with its formula of columns; None for what no column shows.
    start : mapping of str to CoordinateAtStart
        Where the motion begins: with the equations, all that it follows from.
    why : tuple of str
        Why these suffice, in sentences.
    degrees_of_freedom : int
    places : mapping of str to Node
        Columns of bodies as formulas of the coordinates.
    constants : mapping of str to float
        Numbers of many digits that have a name in the formulas, and those of `let`.
    equations : tuple of WrittenFormula
        As many as coordinates, with multipliers lambda_1, ... of the constraints.
    constraints : tuple of WrittenFormula
        What the coordinates have to satisfy besides.
    forces : mapping of str to WrittenFormula
        Forces that are formulas of the client's, and those of connections, as functions of coordinates, rates and
        accelerations.
    lagrangian : WrittenFormula or None
        None where other forces act than those with a potential.
    conserved : tuple of ConservedQuantity
    linear : tuple of LinearEquations
        Of the parts whose equations are linear, or that have a place of rest near the start.
    closed_form : mapping of str to WrittenFormula
        Coordinates as functions of the time, where these are elementary, and angles of pendulums by sn(u, m) and
        am(u, m) of Jacobi.
    """

    coordinates: Mapping[str, str | None]
    start: Mapping[str, CoordinateAtStart]
    why: tuple[str, ...]
    degrees_of_freedom: int
    places: Mapping[str, Node]
    constants: Mapping[str, float]
    equations: tuple[WrittenFormula, ...]
    constraints: tuple[WrittenFormula, ...]
    forces: Mapping[str, WrittenFormula]
    lagrangian: WrittenFormula | None
    conserved: tuple[ConservedQuantity, ...]
    linear: tuple[LinearEquations, ...]
    closed_form: Mapping[str, WrittenFormula]
