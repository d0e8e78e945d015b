"""Forces of connections as formulas of coordinates, rates and accelerations, where multipliers can be solved for.

The equations of the table as described are linear in its multipliers. One that stands somewhere with a constant factor
is solved for; of one that stands alone in several equations, the squares of its factors may add up to a constant, as
those of the components of a rod do. What is left is not answered: its factors are functions of the place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.formulation.trigonometric_sums import Sum, added
from core.multibody.table.connection_effects import Force
from core.multibody.table.table import Table

Equation = tuple[dict[int, Sum], Sum]
"""Factors of multipliers by their rows, and what the products add up to."""


def constraint_forces(table: Table, forces: Sequence[Force], places: Sequence[Sum]) -> dict[str, Sum]:
    """Return those forces of connections that follow from the motion alone, by their names.

    Parameters
    ----------
    table : Table
        As described; without laws.
    forces : sequence of Force
    places : sequence of Sum
        Every coordinate of the table.
    """
    known = _multipliers(_balances(table, places))
    rates = [place.rate() for place in places]
    found = {}
    for force in forces:
        if any(row not in known for row, _ in force.terms) or force.of_laws:
            continue
        parts = [Sum.of(poly, places) * known[row] for row, poly in force.terms]
        parts.append(Sum.of(force.of_state, places))
        parts += [rates[j].times(x) for j, x in force.of_rates.items()]
        parts += [(rates[j] * rates[j]).times(x) for j, x in force.of_squares.items()]
        found[force.name] = added(parts)
    return found


def _balances(table: Table, places: Sequence[Sum]) -> list[Equation]:
    """Return the equation of motion of every coordinate, with the forces of the rows on the left."""
    rates = [place.rate() for place in places]
    gains = [rate.rate() for rate in rates]
    right: list[list[Sum]] = [[] for _ in places]
    for (i, j), x in table.mass.items():
        right[i].append(gains[j].times(x))
        if i != j:
            right[j].append(gains[i].times(x))
    for i, x in table.load.items():
        right[i].append(Sum.number(-x))
    for (i, j), x in table.stiffness.items():
        right[i].append(places[j].times(x))
    for (i, j), x in table.damping.items():
        right[i].append(rates[j].times(x))
    for (i, j, k), x in table.gyration.items():
        right[i].append((places[j] * rates[k]).times(-x))
    left: list[dict[int, Sum]] = [{} for _ in places]
    for number, row in enumerate(table.rows):
        for line in (row.rates, row.drag):
            for i, poly in line.items():
                left[i][number] = left[i].get(number, Sum()) + Sum.of(poly, places)
    return [({r: x for r, x in line.items() if x}, added(one)) for line, one in zip(left, right, strict=True)]


def _multipliers(equations: list[Equation]) -> dict[int, Sum]:
    """Return the multipliers that equations say."""
    solved: list[tuple[int, dict[int, Sum], Sum]] = []
    compared: set[int] = set()
    while True:
        equations = [one for one in equations if one[0]]
        row = next((r for line, _ in equations if len(line) == 1 for r in line if r not in compared), None)
        found = None if row is not None else _constant_pivot(equations) or _alone(equations)
        if row is None and found is None:
            row = next((r for line, _ in equations for r in line if r not in compared), None)
        if found is not None:
            solved.append(found)
            equations = [_without(one, *found) for one in equations]
        elif row is not None:
            compared.add(row)
            equations = _compared(equations, row)
        else:
            break
    known: dict[int, Sum] = {}
    for row, others, value in reversed(solved):
        if all(r in known for r in others):
            known[row] = value - added(x * known[r] for r, x in others.items())
    return known


def _constant_pivot(equations: Sequence[Equation]) -> tuple[int, dict[int, Sum], Sum] | None:
    """Return a multiplier with a constant factor, as value less the products of other multipliers."""
    for line, value in sorted(equations, key=lambda one: len(one[0])):
        for row, factor in line.items():
            lead = factor.constant()
            if lead is not None and not is_zero(lead):
                return row, {r: x.times(1 / lead) for r, x in line.items() if r != row}, value.times(1 / lead)
    return None


def _alone(equations: Sequence[Equation]) -> tuple[int, dict[int, Sum], Sum] | None:
    """Return a multiplier that stands alone in equations in which the squares of its factors add up to a constant."""
    single: dict[int, list[tuple[Sum, Sum]]] = {}
    for line, value in equations:
        if len(line) == 1:
            row, factor = next(iter(line.items()))
            single.setdefault(row, []).append((factor, value))
    for row, own in single.items():
        square = added(factor * factor for factor, _ in own).constant()
        if square is not None and not is_zero(square):
            return row, {}, added(factor * value for factor, value in own).times(1 / square)
    return None


def _compared(equations: Sequence[Equation], row: int) -> list[Equation]:
    """Return equations of which one alone has a multiplier, of those whose factors of it are in constant proportion.

    So the length of a part of a string and the place of its end bring the same force.
    """
    kept: list[Equation] = []
    found: list[Equation] = []
    for line, value in sorted(equations, key=lambda one: len(one[0])):
        ratios = [(one, _ratio(line[row], one[0][row])) for one in kept] if row in line else []
        pivot = next(((one, ratio) for one, ratio in ratios if ratio is not None), None)
        if pivot is None:
            found.append((line, value))
            if row in line:
                kept.append((line, value))
            continue
        (other, right), ratio = pivot
        left = {r: line.get(r, Sum()) - other.get(r, Sum()).times(ratio) for r in {**line, **other}}
        found.append(({r: x for r, x in left.items() if x}, value - right.times(ratio)))
    return found


def _ratio(first: Sum, second: Sum) -> Ball | None:
    """Return the constant by which one sum is a multiple of another, None without one."""
    lead = next(iter(second.terms))
    if lead not in first.terms:
        return None
    ratio = first.terms[lead] / second.terms[lead]
    return None if first - second.times(ratio) else ratio


def _without(equation: Equation, row: int, others: Mapping[int, Sum], value: Sum) -> Equation:
    """Return an equation with a multiplier replaced."""
    line, right = equation
    if row not in line:
        return equation
    factor = line[row]
    left = {r: x for r, x in line.items() if r != row}
    for r, x in others.items():
        left[r] = left.get(r, Sum()) - factor * x
    return {r: x for r, x in left.items() if x}, right - factor * value
