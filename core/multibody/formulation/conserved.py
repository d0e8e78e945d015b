"""What a motion conserves, as its equations themselves show."""

from __future__ import annotations

from dataclasses import dataclass

from core.multibody.algebra.polynomials import Ball
from core.multibody.formulation.lagrange import LagrangeEquations
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Term, Variable, added

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


def conserved_of_part(found: LagrangeEquations) -> list[Conserved]:
    """Return what is constant along every motion of a part that satisfies its rows."""
    kept = []
    # What holds a row does no work along it; of a row that is driven, or that rubs, some of its power is left.
    power = added([*(Sum.variable(name, 1) * one for name, one in found.equations.items()), found.multiplier_power])
    momenta = {name: found.kinetic.derivative(Variable(name, 1)) for name in found.equations}
    energy = added(Sum.variable(name, 1) * one for name, one in momenta.items()) - found.kinetic + found.potential
    if energy and not power - energy.rate():
        driven = TIME in energy.names() or bool(energy - found.kinetic - found.potential)
        kept.append(Conserved("Jacobi integral" if driven else ENERGY, ", ".join(found.equations), energy))
    for name, equation in found.equations.items():
        momentum = _integral(equation)
        if momentum:
            kept.append(Conserved("momentum", name, momentum))
    return kept


def _integral(equation: Sum) -> Sum | None:
    """Return the function of places and rates of which an equation is the derivative by time, None without one."""
    names = [variable.name for term in equation.terms for variable, _ in term.factors if variable.order == 2]
    first = added(equation.derivative(Variable(name, 2)) * Sum.variable(name, 1) for name in dict.fromkeys(names))
    rest = equation - first.rate()
    # What is left of a motion with gyroscopic forces is a rate times a function of its variable alone.
    parts = [first]
    for term, value in rest.terms.items():
        part = _of_one(term, value)
        if part is None:
            return None
        parts.append(part)
    return added(parts)


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
