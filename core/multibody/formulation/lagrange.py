"""Lagrange's equations of a part in the variables of its chart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from core.multibody.formulation.chart import Chart
from core.multibody.formulation.trigonometric_sums import Sum, Variable, added


@dataclass(frozen=True)
class LagrangeEquations:
    """The equations of a part.

    Attributes
    ----------
    equations : mapping of str to Sum
        By variable: inertia less forces, which is zero.
    kinetic, potential : Sum
    multiplier_power : Sum
        What the multipliers give of power along their rows, which is zero of every motion that satisfies these.
    lagrangian : Sum or None
        None where Lagrange's equations of it are not all of the forces.
    """

    equations: Mapping[str, Sum]
    kinetic: Sum
    potential: Sum
    multiplier_power: Sum
    lagrangian: Sum | None


def lagrange_equations(chart: Chart, force_names: Sequence[str], multipliers: Sequence[str]) -> LagrangeEquations:
    """Return the equations of a part.

    Parameters
    ----------
    chart : Chart
    force_names : sequence of str
        Symbols of the values of the laws of its table, in their order.
    multipliers : sequence of str
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
            forces[i].append(Sum.variable(name).times(x / law.scale))
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
    moving, resting = added(kinetic), added(potential)
    lagrangian = None if chart.rows else _lagrangian(moving, resting, equations)
    idle = added(chart.rates_of(row) * Sum.variable(name) for row, name in zip(chart.rows, multipliers, strict=True))
    return LagrangeEquations(equations, moving, resting, idle, lagrangian)


def _lagrangian(kinetic: Sum, potential: Sum, equations: Mapping[str, Sum]) -> Sum | None:
    """Return the Lagrangian of equations, None where its equations are not these."""
    lagrangian = kinetic - potential
    for name, equation in equations.items():
        momentum = lagrangian.derivative(Variable(name, 1))
        if equation - (momentum.rate() - lagrangian.derivative(Variable(name))):
            return None
    return lagrangian


def measures_of(chart: Chart) -> list[Sum]:
    """Return what the rows that are not solved hold at zero: their measures, and of others their rates."""
    return [chart.rates_of(row) if row.measure is None else Sum.of(row.measure, chart.places) for row in chart.rows]
