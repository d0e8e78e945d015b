"""Lagrange's equations of a part in the variables of its chart, and what its motion conserves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from core.multibody.algebra.polynomials import Ball
from core.multibody.formulation.chart import Chart
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Term, Variable, added

ENERGY = "energy"
"""The name of a conserved energy, and how that of one body begins."""


@dataclass(frozen=True)
class Conserved:
    """A quantity that stays what it is.

    Attributes
    ----------
    name : str
    formula : Sum
        Of variables and their rates.
    """

    name: str
    formula: Sum


@dataclass(frozen=True)
class LagrangeEquations:
    """The equations of a part.

    Attributes
    ----------
    chart : Chart
    equations : mapping of str to Sum
        By variable: inertia less forces, which is zero.
    kinetic, potential : Sum
    multipliers : list of str
        Names of the multipliers of the rows that the chart has not solved.
    lagrangian : Sum or None
        None where Lagrange's equations of it are not all of the forces.
    conserved : list of Conserved
    """

    chart: Chart
    equations: Mapping[str, Sum]
    kinetic: Sum
    potential: Sum
    multipliers: list[str]
    lagrangian: Sum | None = None
    conserved: list[Conserved] = field(default_factory=list)


def lagrange_equations(chart: Chart, force_names: Sequence[str], multipliers: list[str]) -> LagrangeEquations:
    """Return the equations of a part.

    Parameters
    ----------
    chart : Chart
    force_names : sequence of str
        Symbols of the values of the laws of its table, in their order.
    multipliers : list of str
        Symbols of the multipliers of the rows of the chart.
    """
    table, places = chart.table, chart.places
    rates = [place.rate() for place in places]
    gains = [rate.rate() for rate in rates]
    count = len(places)
    forces: list[list[Sum]] = [[] for _ in range(count)]
    inertia: list[list[Sum]] = [[] for _ in range(count)]
    kinetic, potential = [], []
    for (i, j), x in table.mass.items():
        inertia[i].append(gains[j].times(x))
        if i != j:
            inertia[j].append(gains[i].times(x))
        kinetic.append((rates[i] * rates[j]).times(x / 2 if i == j else x))
    for i, x in table.load.items():
        forces[i].append(Sum.number(x))
        potential.append(places[i].times(-x))
    for (i, j), x in table.stiffness.items():
        forces[i].append(places[j].times(-x))
        potential.append((places[i] * places[j]).times(x / 2))
    for (i, j), x in table.damping.items():
        forces[i].append(rates[j].times(-x))
    for (i, j, k), x in table.gyration.items():
        forces[i].append((places[j] * rates[k]).times(x))
    for law, name in zip(table.acting, force_names, strict=True):
        for i, x in law.push.items():
            forces[i].append(Sum.variable(name).times(x))
    for row, name in zip(chart.rows, multipliers, strict=True):
        for line in (row.rates, row.drag):
            for i, poly in line.items():
                forces[i].append(Sum.of(poly, places) * Sum.variable(name))
    total = [added(one) - added(other) for one, other in zip(inertia, forces, strict=True)]
    equations = {
        name: added(
            place.derivative(Variable(name)) * one
            for place, one in zip(places, total, strict=True)
            if name in place.names()
        )
        for name in chart.variables
    }
    found = LagrangeEquations(chart, equations, added(kinetic), added(potential), multipliers)
    free = found if chart.rows else _with_lagrangian(found)
    free.conserved.extend(_conserved(free))
    return free


def _with_lagrangian(found: LagrangeEquations) -> LagrangeEquations:
    """Return the equations with their Lagrangian, if its equations are these."""
    lagrangian = found.kinetic - found.potential
    for name, equation in found.equations.items():
        momentum = lagrangian.derivative(Variable(name, 1))
        if equation - (momentum.rate() - lagrangian.derivative(Variable(name))):
            return found
    return LagrangeEquations(
        found.chart, found.equations, found.kinetic, found.potential, found.multipliers, lagrangian
    )


def _conserved(found: LagrangeEquations) -> list[Conserved]:
    """Return what is constant along every motion, as the equations themselves show."""
    kept = []
    power = added(Sum.variable(name, 1) * one for name, one in found.equations.items())
    momenta = {name: found.kinetic.derivative(Variable(name, 1)) for name in found.equations}
    energy = added(Sum.variable(name, 1) * one for name, one in momenta.items()) - found.kinetic + found.potential
    if energy and not power - energy.rate():
        driven = TIME in energy.names() or bool(energy - found.kinetic - found.potential)
        kept.append(Conserved("Jacobi integral" if driven else ENERGY, energy))
    for name, equation in found.equations.items():
        momentum = _integral(equation)
        if momentum:
            kept.append(Conserved(f"momentum of {name}", momentum))
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


def measures_of(chart: Chart) -> list[Sum]:
    """Return what the rows that are not solved hold at zero: their measures, and of others their rates."""
    return [chart.rates_of(row) if row.measure is None else Sum.of(row.measure, chart.places) for row in chart.rows]
