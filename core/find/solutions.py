"""What is found: solutions, ranges and families of inputs, and how completely."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from core.find.figures import Value
from core.notices import Notice

Kind = Literal["root", "extreme", "border", "jump"]


@dataclass(frozen=True)
class Solution:
    """Inputs with which the conditions hold.

    Attributes
    ----------
    inputs : tuple of float
        In the order in which they are varied.
    errors : tuple of float
        Bounds of their distances from the true ones.
    kind : {"root", "extreme", "border", "jump"}
        root: the figure takes the value; extreme: it is least or largest; border: what it says changes, or it comes or
        goes; jump: it leaps.
    multiplicity : int
        Of a root: 2 where the figure touches the value, 3 where it passes it without a slope; 1 for others.
    figures : tuple or None
        Of the answer with these inputs, one for each condition; None at borders and jumps.
    figure_errors : tuple of float or None
        Bounds of theirs.
    below, above : number, word, truth value or None
        The figure just below and just above a border or a jump.
    """

    inputs: tuple[float, ...]
    errors: tuple[float, ...]
    kind: Kind
    multiplicity: int = 1
    figures: tuple[Value, ...] | None = None
    figure_errors: tuple[float, ...] | None = None
    below: Value | None = None
    above: Value | None = None


@dataclass(frozen=True)
class Family:
    """Inputs that are not isolated: with all of them the conditions hold.

    Attributes
    ----------
    least, most : tuple of float
        Ends of a range of one input; of several, the solution that was found, twice.
    direction : tuple of float or None
        Of several inputs, in which they can change together to first order, as shares of their ranges.
    """

    least: tuple[float, ...]
    most: tuple[float, ...]
    direction: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Nearest:
    """Inputs with which the conditions are missed by least.

    Attributes
    ----------
    inputs : tuple of float
    figures : tuple
    figure_errors : tuple of float
    """

    inputs: tuple[float, ...]
    figures: tuple[Value, ...]
    figure_errors: tuple[float, ...]


@dataclass
class Findings:
    """All that is found.

    Attributes
    ----------
    solutions : list of Solution
        In ascending order of their inputs.
    ranges : list of (float, float), or None
        In which a condition on what is not a continuous number holds.
    families : list of Family
    nearest : Nearest or None
        Where there is no solution.
    complete : bool
        Whether it is proven that there are no others in the range.
    resolution : tuple of float or None
        By input, the width below which others may have been missed; None where it is complete.
    notices : list of Notice
    """

    solutions: list[Solution] = field(default_factory=list)
    ranges: list[tuple[float, float]] | None = None
    families: list[Family] = field(default_factory=list)
    nearest: Nearest | None = None
    complete: bool = False
    resolution: tuple[float, ...] | None = None
    notices: list[Notice] = field(default_factory=list)
