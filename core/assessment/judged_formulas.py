"""A formula compared with a figure: at the question's parameters and at variations of them, and by its dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol

from core.assessment.compare import Judgement, Reference, compare
from core.assessment.comparisons import RelAbs
from core.assessment.formulas import DimensionFault, Powers, Undefined, dimensions, value_in_doubles
from core.assessment.units import base_powers
from core.formulas import Formula

FORMULA = RelAbs(rtol=1e-8)
"""How far a formula may be from the figure: rounding, also of an ill-conditioned one, and no rounded constant."""

ENOUGH = 10
"""Variations without which a formula is not judged."""


class Varied(Protocol):
    """Parameters by name, and the figure that belongs to them."""

    @property
    def parameters(self) -> Mapping[str, float]:
        """By name."""

    @property
    def figure(self) -> float:
        """In the unit of the reference."""


@dataclass(frozen=True)
class JudgedFormula:
    """What becomes of a formula.

    Attributes
    ----------
    judgement : Judgement
        With the error at the question's own parameters.
    why : str
        Key of the feedback on what is wrong; empty if nothing is known of it.
    value : float or None
        At the question's own parameters; None where the formula has none.
    at_one_place : bool
        Whether it agrees there and at no more than some variations, whatever else is known of it.
    """

    judgement: Judgement
    why: str = ""
    value: float | None = None
    at_one_place: bool = False


def judge_formula(
    formula: Formula,
    variations: Sequence[Varied],
    units: Mapping[str, str],
    reference: Reference,
    times: float = 1.0,
) -> JudgedFormula:
    """Judge a formula.

    Parameters
    ----------
    formula : Formula
    variations : sequence
        The question itself, then changed ones.
    units : mapping of str to str
        Of the parameters.
    reference : Reference
        At the question's own parameters.
    times : float
        What one unit of the formula's value is in the unit of the reference.
    """
    if len(variations) <= ENOUGH:
        return JudgedFormula(Judgement("not-gradable"), NOT_JUDGED)
    try:
        values = [times * value_in_doubles(formula, one.parameters) for one in variations]
    except Undefined:
        return JudgedFormula(Judgement("incorrect"), UNDEFINED)
    # Formula and reference have the same numbers: how uncertain these are is no difference between the two.
    own = compare(replace(reference, inherited=0.0), values[0], FORMULA)
    if own.verdict == "not-gradable":
        return JudgedFormula(own)
    at_one_place = own.verdict == "correct"
    if at_one_place:
        if all(_agrees(value, one, reference) for value, one in zip(values, variations, strict=True)):
            return JudgedFormula(own, value=values[0])
        own = replace(own, verdict="incorrect")
    # Dimensions explain what is wrong; a constant with a hidden unit may be right.
    why = _dimensional_fault(formula, units, reference.unit) or (AT_ONE_PLACE if at_one_place else "")
    return JudgedFormula(own, why, None if at_one_place else values[0], at_one_place)


UNDEFINED = "formula-undefined"
NOT_JUDGED = "formula-not-judged"
AT_ONE_PLACE = "formula-at-one-place"
"""Keys of feedback."""


def _agrees(value: float, one: Varied, reference: Reference) -> bool:
    varied = Reference(one.figure, reference.unit, reference.form, abs(one.figure) or reference.scale)
    return compare(varied, value, FORMULA).verdict == "correct"


def _dimensional_fault(formula: Formula, units: Mapping[str, str], unit: str) -> str:
    """Return the key of what is wrong with the dimensions of a formula; empty if nothing is, or units are not known."""
    known: dict[str, Powers] = {}
    for name in formula.names:
        powers = base_powers(units[name])
        if powers is None:
            return ""
        known[name] = {base: Fraction(power) for base, power in powers.items()}
    wanted = base_powers(unit)
    try:
        found = dimensions(formula, known)
    except DimensionFault as fault:
        return fault.key
    if wanted is not None and found != {base: Fraction(power) for base, power in wanted.items()}:
        return "dimension"
    return ""
