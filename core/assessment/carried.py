"""Carried errors: a later answer that is wrong only because an earlier one is.

The course states how a figure follows from earlier figures of the same submission, as a formula. A wrong answer is then
compared with the value of the formula at the student's own earlier answers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Annotated

from core.assessment.compare import Reference, compare, distance
from core.assessment.comparisons import Comparison, Interval
from core.assessment.figures import steps_of
from core.assessment.formulas import Undefined, value_in_doubles
from core.assessment.judged_formulas import FORMULA
from core.errors import InvalidParameter, Path
from core.formulas import Formula, is_name
from core.quantities import Quantity, check

MOST_EARLIER = 10
"""Earlier answers that one answer follows from."""

Share = Annotated[float, Quantity("1", at_least=0, at_most=1)]


@dataclass(frozen=True)
class CarriedStep:
    """How a figure follows from earlier figures.

    Attributes
    ----------
    formula : str
        The figure, in the names of `earlier` and in those of the question's numbers.
    earlier : dict of str to str
        Pointers into the answer, by the name that each figure has in the formula.
    credit : float
        Share of the score for an answer that follows from wrong earlier ones.
    """

    formula: str
    earlier: dict[str, str]
    credit: Share = 1.0

    def __post_init__(self) -> None:
        check(self)
        if not 0 < len(self.earlier) <= MOST_EARLIER:
            raise InvalidParameter("earlier", f"have 1 to {MOST_EARLIER} entries")
        for name in self.earlier:
            if not is_name(name):
                raise InvalidParameter("earlier", "have names of letters, digits and _ that are no functions")

    def value(self, parameters: Mapping[str, float], earlier: Mapping[str, float]) -> float | None:
        """Return the value of the formula, None where it has none.

        Parameters
        ----------
        parameters : mapping of str to float
            Of the question, by name.
        earlier : mapping of str to float
            By pointer, in SI units.

        Raises
        ------
        InvalidParameter
            For a formula that cannot be read.
        """
        values = {**parameters, **{name: earlier[pointer] for name, pointer in self.earlier.items()}}
        try:
            return value_in_doubles(Formula.read(self.formula, values), values)
        except Undefined:
            return None


def follows(
    step: CarriedStep,
    value: float,
    reference: Reference,
    comparison: Comparison | None,
    parameters: Mapping[str, float],
    earlier: Mapping[str, float],
) -> bool:
    """Return whether a value is what follows from earlier ones, by the comparison that the figure has.

    Limits of an interval say nothing of how near two values are: the default comparison stands in for them.
    """
    expected = step.value(parameters, earlier)
    if expected is None:
        return False
    near = None if isinstance(comparison, Interval) else comparison
    own = replace(reference, value=expected, scale=abs(expected) or reference.scale)
    return compare(own, value, near).verdict == "correct"


def checked_steps(
    steps: Mapping[str, CarriedStep], parameters: Mapping[str, float], reference: Callable[[Path], Reference | None]
) -> None:
    """Refuse steps that name no numbers of the answer, or whose formula does not give the right value from right ones.

    Raises
    ------
    InvalidParameter
        With the path from the mapping of steps.
    """

    def number(pointer: str, place: Path) -> Reference:
        try:
            found = reference(steps_of(pointer))
        except InvalidParameter as fault:
            raise InvalidParameter(place, fault.rule, remedy=fault.remedy) from None
        if found is None or found.form not in ("number", "angle"):
            raise InvalidParameter(place, "lead to a number of the answer")
        return found

    for pointer, step in steps.items():
        right = number(pointer, (pointer,))
        earlier: dict[str, float] = {}
        for name, source in step.earlier.items():
            if name in parameters:
                raise InvalidParameter((pointer, "earlier", name), "differ from the names of the question's numbers")
            if source == pointer:
                raise InvalidParameter((pointer, "earlier", name), "lead to another figure than the one that follows")
            earlier[source] = number(source, (pointer, "earlier", name)).value
        try:
            found = step.value(parameters, earlier)
        except InvalidParameter as fault:
            raise InvalidParameter((pointer, "formula"), fault.rule, remedy=fault.remedy) from None
        if found is None or distance(right, found) > FORMULA.rtol * right.magnitude + right.error:
            shown = "no value" if found is None else f"{found:.9g}"
            remedy = f"with the right earlier values it gives {shown}, and the answer has {right.value:.9g}"
            raise InvalidParameter((pointer, "formula"), "give the figure of the answer", remedy=remedy)
