"""Variants of a question: its numbers drawn anew, reproducibly, until what is required of the answer holds.

Each member has a generator of its own, the member's child of the seed (numpy's ``SeedSequence.spawn``). So the first
members are the same however many there are. A draw is rejected if the question is refused with it, if a figure that is
wanted does not exist, if the answer has a warning of another kind than the question as it is, if a constraint is not
met, or if an earlier member has the same request.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from core.assessment.compare import Reference
from core.assessment.figures import value_at
from core.assessment.graded_question import GradedQuestion
from core.assessment.propagation import HALF_ULP, at, changed
from core.assessment.varied_input import Digits, End, VariedInput, rounded
from core.errors import InvalidParameter, MechanicsError, Path
from core.quantities import Quantity, check

Share = Annotated[float, Quantity("1", above=0, below=1)]

REFUSED, WARNED, ABSENT, CONDITION, REPEATED = "refused", "warned", "absent", "condition", "repeated"
"""Reasons for which draws are rejected, beside the pointers of figures that meet no constraint."""

MOST_EXACT = 2.0**53


@dataclass(frozen=True)
class Constraint:
    """What is required of a figure of the answer; of an array, of each of its entries.

    Attributes
    ----------
    min, max : float, optional
        Least and largest value, in the figure's unit.
    digits : int, optional
        The figure is near a number of so many significant digits.
    within : float
        How near, relatively.
    apart : float, optional
        Least difference from the figure of any other member, relative to the larger.
    """

    min: End | None = None
    max: End | None = None
    digits: Digits | None = None
    within: Share = 1e-3
    apart: Share | None = None

    def __post_init__(self) -> None:
        check(self)
        if self.min is not None and self.max is not None and self.min > self.max:
            raise InvalidParameter("max", "be at least min")
        if all(one is None for one in (self.min, self.max, self.digits, self.apart)):
            raise InvalidParameter("min", "be given, or max, digits or apart")

    def allows(self, value: Any, others: Sequence[Any]) -> bool:
        """Return whether a figure, a number or an array, meets the constraint beside those of other members."""
        entries = np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel()
        if self.min is not None and not (entries >= self.min).all():
            return False
        if self.max is not None and not (entries <= self.max).all():
            return False
        if self.digits is not None:
            near = np.array([rounded(entry, self.digits) for entry in entries.tolist()])
            if not (np.abs(entries - near) <= self.within * np.abs(entries)).all():
                return False
        return self.apart is None or all(_difference(value, other) >= self.apart for other in others)


@dataclass(frozen=True, eq=False)
class Member:
    """One variant.

    Attributes
    ----------
    request : Any
        The question.
    references : dict of str to Reference
        Of the figures that are wanted, by pointer.
    conditions : dict of str to (float or None)
        How many times the relative uncertainty of the question's numbers the relative uncertainty of the figure is:
        first order, worst case. None where a figure has no relative error.
    draws : int
        That it took.
    """

    request: Any
    references: Mapping[str, Reference]
    conditions: Mapping[str, float | None]
    draws: int


@dataclass(eq=False)
class Variants:
    """Draws members.

    Parameters
    ----------
    request : Any
        The question that is varied.
    vary : mapping of path to VariedInput
        By place in the request.
    together : mapping of path to sequence of path
        Places that are given the same value.
    ask : callable
        From a request to the question with its answer; asking raises `MechanicsError` for what is refused.
    figures : mapping of str to path
        That are wanted, by pointer.
    constraints : mapping of str to Constraint
        By pointer.
    constrained : mapping of str to path
        The same figures' paths.
    max_condition : float or None
        Largest condition of any figure that is wanted.
    uncertainty : float or None
        Relative, of the question's numbers, by which the references are propagated; half an ulp if None.
    most_draws : int
        For one member.
    warnings : frozenset of str
        Codes of warnings that answers may have.
    required : bool
        Whether draws are rejected for which a figure that is wanted does not exist; otherwise it is left out.

    Attributes
    ----------
    rejected : Counter of str
        How many draws were rejected, by reason.
    """

    request: Any
    vary: Mapping[Path, VariedInput]
    together: Mapping[Path, Sequence[Path]]
    ask: Callable[[Any], GradedQuestion]
    figures: Mapping[str, Path]
    constraints: Mapping[str, Constraint]
    constrained: Mapping[str, Path]
    max_condition: float | None
    uncertainty: float | None
    most_draws: int
    warnings: frozenset[str] = frozenset()
    required: bool = True
    rejected: Counter[str] = field(default_factory=Counter, init=False)

    def members(self, seed: int, count: int) -> list[Member]:
        """Return so many members.

        Raises
        ------
        InvalidParameter
            If none is found for a member in `most_draws` draws.
        """
        found: list[Member] = []
        seen: list[Any] = []
        values: dict[str, list[Any]] = {pointer: [] for pointer in self.constrained}
        for child in np.random.SeedSequence(seed).spawn(count):
            found.append(self._member(np.random.Generator(np.random.PCG64(child)), seen, values))
            seen.append(found[-1].request)
        return found

    def _member(self, chance: np.random.Generator, seen: Sequence[Any], values: Mapping[str, list[Any]]) -> Member:
        reasons = Counter[str]()
        for draw in range(1, self.most_draws + 1):
            request = self.drawn(chance)
            found = REPEATED if request in seen else self._tried(request, values, draw)
            if isinstance(found, Member):
                return found
            reasons[found] += 1
            self.rejected[found] += 1
        counts = ", ".join(f"{reason} ({count})" for reason, count in sorted(reasons.items()))
        remedy = "widen the ranges, relax the constraints or allow more draws"
        rule = f"be met in {self.most_draws} draws; member {len(seen)} met them in none: {counts}"
        raise InvalidParameter("constraints", rule, remedy=remedy)

    def drawn(self, chance: np.random.Generator) -> Any:
        """Return the request with numbers drawn anew; the order in which they stand in `vary` does not matter."""
        changes: dict[Path, Any] = {}
        for path, variation in sorted(self.vary.items(), key=lambda entry: str(entry[0])):
            value = variation.draw(float(chance.random()))
            changes |= dict.fromkeys((path, *self.together.get(path, ())), value)
        return changed(self.request, {path: _as_was(value, at(self.request, path)) for path, value in changes.items()})

    def _tried(self, request: Any, values: Mapping[str, list[Any]], draw: int) -> Member | str:
        """Return a member, or the reason for which there is none."""
        question = self.ask(request)
        try:
            answer = question.answer
        except MechanicsError:
            return REFUSED
        if not {notice.code for notice in answer.get("warnings", ())} <= self.warnings:
            return WARNED
        here = {pointer: value_at(answer, path) for pointer, path in self.constrained.items()}
        for pointer, value in here.items():
            if not isinstance(value, (float, np.ndarray)):
                return ABSENT
            if not self.constraints[pointer].allows(value, values[pointer]):
                return pointer
        references: dict[str, Reference] = {}
        for pointer, path in self.figures.items():
            reference = question.reference(path)
            if reference is not None and reference.form != "none":
                references[pointer] = reference
            elif self.required:
                return ABSENT
        conditions = {pointer: self._condition(reference) for pointer, reference in references.items()}
        if self.max_condition is not None:
            for pointer, condition in conditions.items():
                if references[pointer].form != "choice" and (condition is None or condition > self.max_condition):
                    return CONDITION
        for pointer, value in here.items():
            values[pointer].append(value)
        return Member(request, references, conditions, draw)

    def _condition(self, reference: Reference) -> float | None:
        share = HALF_ULP if self.uncertainty is None else self.uncertainty
        if reference.inherited == 0.0:
            return 0.0
        if reference.inherited is None or not reference.magnitude > 0.0 or not share > 0.0:
            return None
        condition = reference.inherited / reference.magnitude / share
        return condition if np.isfinite(condition) else None


def _difference(value: Any, other: Any) -> float:
    """Return the largest difference of any entry, relative to the largest magnitude; infinite for other shapes."""
    one, two = np.asarray(value), np.asarray(other)
    if one.shape != two.shape:
        return np.inf
    size = max(float(np.abs(one).max(initial=0.0)), float(np.abs(two).max(initial=0.0)))
    with np.errstate(over="ignore"):
        return float(np.abs(one - two).max(initial=0.0)) / size if size > 0.0 else 0.0


def _as_was(value: Any, before: Any) -> Any:
    """Return a whole number as an integer if an integer stood in its place, as the service requires for counts."""
    if type(value) is float and type(before) is int and value.is_integer() and abs(value) < MOST_EXACT:
        return int(value)
    return value
