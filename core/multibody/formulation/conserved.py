"""What a motion conserves, as its equations themselves show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import permutations

from core.multibody.algebra.polynomials import Ball
from core.multibody.formulation.lagrange import LagrangeEquations
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Term, Variable, added

_AXES = (["x"], ["y"], ["z"])

ENERGY = "energy"
"""The kind of a conserved energy, the sum of the kinetic and the potential one."""


@dataclass(frozen=True)
class Conserved:
    """A quantity that stays what it is.

    Attributes
    ----------
    kind : str
    of : str
        The body or coordinates that it belongs to; empty of the whole scene.
    formula : Sum
        Of variables and their rates.
    """

    kind: str
    of: str
    formula: Sum

    @property
    def name(self) -> str:
        """The name in an answer."""
        return f"{self.kind} of {self.of}" if self.of else self.kind


def energy_of_part(found: LagrangeEquations) -> list[Conserved]:
    """Return the energy, or Jacobi's integral, where it is constant along every motion that satisfies the rows."""
    # What holds a row does no work along it; of a row that is driven, or that rubs, some of its power is left.
    power = added([*(Sum.variable(name, 1) * one for name, one in found.equations.items()), found.multiplier_power])
    momenta = {name: found.kinetic.derivative(Variable(name, 1)) for name in found.equations}
    energy = added(Sum.variable(name, 1) * one for name, one in momenta.items()) - found.kinetic + found.potential
    if energy and not power - energy.rate():
        driven = TIME in energy.names() or bool(energy - found.kinetic - found.potential)
        return [Conserved("Jacobi integral" if driven else ENERGY, ", ".join(found.equations), energy)]
    return []


@dataclass(frozen=True)
class _Combination:
    """A combination of equations: what it is the derivative by time of, and what of it is left beside that.

    Attributes
    ----------
    kind : str
    of : tuple of str
        The variables whose equations it contains.
    integral, left : Sum
    """

    kind: str
    of: tuple[str, ...]
    integral: Sum
    left: Sum

    @classmethod
    def of_equation(cls, kind: str, of: tuple[str, ...], equation: Sum) -> _Combination:
        """Take an equation of motion, or one times a place, apart."""
        names = [variable.name for term in equation.terms for variable, _ in term.factors if variable.order == 2]
        first = added(equation.derivative(Variable(name, 2)) * Sum.variable(name, 1) for name in dict.fromkeys(names))
        rest = (equation - first.rate()).terms
        # What is left of a motion with gyroscopic forces is a rate times a function of its variable alone.
        parts = {term: _of_one(term, value) for term, value in rest.items()}
        integral = added([first, *(part for part in parts.values() if part is not None)])
        return cls(kind, of, integral, Sum({term: rest[term] for term, part in parts.items() if part is None}))

    def without(self, term: Term, other: _Combination) -> _Combination:
        """Add the multiple of another that takes a term from what is left."""
        factor = -self.left.terms[term] / other.left.terms[term]
        left = dict((self.left + other.left.times(factor)).terms)
        left.pop(term, None)
        integral = self.integral + other.integral.times(factor)
        return _Combination(self.kind, tuple(dict.fromkeys((*other.of, *self.of))), integral, Sum(left))


def momenta(equations: Mapping[str, Sum]) -> list[Conserved]:
    """Return the combinations of equations that are derivatives by time, as far as their factors are simple.

    These are numbers, as for a momentum along a line, and places along another axis of the same body, as for an angular
    momentum. Whatever is left beside derivatives, such as what bodies do to one another, is eliminated.
    """
    pending = [_Combination.of_equation("momentum", (name,), equation) for name, equation in equations.items()]
    turning = {name for one in equations.values() for name in one.in_waves()}
    places = [name.split(".") for name in reversed([*equations]) if name not in turning]
    along = [(body, ".".join((body, *axis))) for body, *axis in places if axis in _AXES]
    for (body, x), (other, y) in permutations(along, 2):
        if body == other:
            pending.append(_Combination.of_equation("angular momentum", (y,), Sum.variable(x) * equations[y]))
    kept = []
    while pending:
        one, *pending = pending
        if one.left:
            term = next(iter(one.left.terms))
            pending = [other.without(term, one) if term in other.left.terms else other for other in pending]
        elif one.integral:
            kept.append(Conserved(one.kind, ", ".join(sorted(one.of, key=[*equations].index)), one.integral))
    return kept


def _of_one(term: Term, value: Ball) -> Sum | None:
    """Return the integral by time of a rate times a function of its own variable, None of what is another."""
    rates = [(variable, power) for variable, power in term.factors if variable.order == 1]
    if len(rates) != 1 or rates[0][1] != 1:
        return None
    name = rates[0][0].name
    others = [(variable, power) for variable, power in term.factors if variable != rates[0][0]]
    if term.function:
        if others or [at for at, _ in term.wave] != [name]:
            return None
        factor = value / term.wave[0][1]
        turned = ("sin", factor) if term.function == "cos" else ("cos", -factor)
        return Sum({Term((), turned[0], term.wave): turned[1]})
    if any(variable != Variable(name) for variable, _ in others):
        return None
    power = others[0][1] if others else 0
    if power == -1:
        return None
    return Sum({Term(((Variable(name), power + 1),)): value / (power + 1)})
