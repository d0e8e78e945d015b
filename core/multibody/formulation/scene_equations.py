"""The equations of a scene in writing: each of its parts in the variables of its chart, and what they say together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce

from core.errors import BudgetExceeded
from core.formulas import Node
from core.multibody.algebra.directions import scalar_product
from core.multibody.algebra.doubles import error_in_doubles, in_doubles
from core.multibody.algebra.polynomials import Ball, is_zero
from core.multibody.equations.dynamics import kinetic, potential
from core.multibody.equations_answer import ConservedQuantity, CoordinateAtStart, LinearEquations, SceneEquations
from core.multibody.formulation.body_angles import angle_of_body
from core.multibody.formulation.chart import Chart
from core.multibody.formulation.closed_forms import closed_forms
from core.multibody.formulation.conserved import ENERGY, Conserved, energy_of_part, momenta
from core.multibody.formulation.constants import Constants
from core.multibody.formulation.constraint_forces import constraint_forces
from core.multibody.formulation.euler import conserved_of_body, euler_equations
from core.multibody.formulation.formula_nodes import node_of_sum, node_of_terms, require_doubles
from core.multibody.formulation.lagrange import lagrange_equations, measures_of
from core.multibody.formulation.law_forces import MULTIPLIER, constants_of, force_symbols, law_nodes, law_sums
from core.multibody.formulation.linear_equations import linear_equations
from core.multibody.formulation.self_check import check_chart, check_formula
from core.multibody.formulation.sides import Sides, equation_sides
from core.multibody.formulation.symbols import columns_of, coordinates_of, symbols_of
from core.multibody.formulation.trigonometric_sums import Sum, added
from core.multibody.motion.modelling import Modelled, Piece
from core.multibody.motion.motion import Motion
from core.multibody.motion.turning_body import TurningBody, turning_body
from core.multibody.start import NumberKind, energy_of
from core.multibody.table.table import Table

MOST_COORDINATES = 24
"""Coordinates of the tables of the parts together: the equations of twelve links, or of a bicycle, nobody reads."""


@dataclass
class _Written:
    """What is gathered from the parts of a scene."""

    coordinates: dict[str, Node | None] = field(default_factory=dict)
    why: list[str] = field(default_factory=list)
    equations: list[Sides] = field(default_factory=list)
    constraints: list[Sides] = field(default_factory=list)
    forces: dict[str, Node] = field(default_factory=dict)
    lagrangian: list[Sum] | None = field(default_factory=list)
    conserved: list[tuple[Conserved, Ball]] = field(default_factory=list)
    motion: dict[str, Sum] = field(default_factory=dict)
    smooth: list[tuple[Mapping[str, Sum], Mapping[str, Ball]]] = field(default_factory=list)
    linear: list[LinearEquations] = field(default_factory=list)
    closed: dict[str, Node] = field(default_factory=dict)
    numbers: dict[str, Ball] = field(default_factory=dict)
    places: dict[int, Sum] = field(default_factory=dict)
    start: dict[str, Ball] = field(default_factory=dict)
    rates: dict[str, Ball] = field(default_factory=dict)
    multipliers: int = 0


def equations_of(found: Modelled, reserved: Sequence[str] = ()) -> SceneEquations:
    """Return the equations of a scene; the precision of balls is the caller's.

    Parameters
    ----------
    found : Modelled
    reserved : sequence of str
        Names that constants must not have.

    Raises
    ------
    BudgetExceeded
        For a scene with more coordinates than can be read.
    NotApplicable
        Where numbers of the equations leave the range of doubles.
    """
    moving = [(piece, motion) for piece, motion in found.moving if not _rests(motion)]
    count = sum(len(piece.table.names) for piece, _ in moving)
    if count > MOST_COORDINATES:
        remedy = "leave the equations out, or ask about a part of the scene"
        raise BudgetExceeded("coordinates of written equations", count, MOST_COORDINATES, remedy=remedy)
    reduced = found.whole.reduced
    coordinates = found.described.measures.coordinates
    columns = columns_of(reduced, found.described.scene.bodies, coordinates.dimension)
    symbols = symbols_of(reduced.table.names)
    directed = [name for name, frame in coordinates.frames.items() if frame.direction is not None]
    given = {name: coordinates.start_angle(name) for name in directed}
    written = _Written()
    # What rests stays where it is.
    for i, place in enumerate(reduced.table.q):
        written.places[i] = Sum.number(place)
    for piece, motion in moving:
        own = {k: columns[i] for k, i in enumerate(piece.indices) if i in columns}
        body = turning_body(piece.table)
        if body is None:
            _write_part(written, piece, motion, [symbols[i] for i in piece.indices], own, given)
        else:
            _write_body(written, body, symbols[piece.indices[0]].partition(".")[0], piece)
    # The angular momentum of a body may be one of parts that are apart.
    written.conserved += [(one, one.formula.value(written.start, written.rates)) for one in momenta(written.motion)]
    if any(row.slide is not None for row in found.described.measures.table.rows):
        written.why.append("friction that turns with the slip is written with the direction that it starts with")
    conserved = _with_one_energy(found, written.conserved, len(moving))
    constants = Constants([*reserved, *written.numbers])
    places = _places(found, written)
    held = _forces(found, written.places)
    written.forces |= {name: node_of_sum(total) for name, total in held.items()}
    lengths, tensions = _kept_positive(found, written.places, held)
    for equations, start in written.smooth:
        written.linear += linear_equations(equations, start, lengths, tensions)
    lagrangian = written.lagrangian if moving else None
    shown = SceneEquations(
        coordinates={
            name: None if node is None else constants.plain(node) for name, node in written.coordinates.items()
        },
        start={name: _at_start(written, name) for name in written.coordinates},
        why=tuple(dict.fromkeys([*reduced.steps, *written.why])),
        degrees_of_freedom=sum(piece.freedom for piece, _ in moving),
        places={name: constants.named(node) for name, node in places.items()},
        constants={},
        equations=tuple(constants.equation(*sides) for sides in written.equations),
        constraints=tuple(constants.equation(*sides) for sides in written.constraints),
        forces={name: constants.formula(node) for name, node in written.forces.items()},
        lagrangian=None if not lagrangian else constants.formula(node_of_sum(added(lagrangian))),
        conserved=tuple(
            ConservedQuantity(
                one.name, constants.formula(node_of_sum(one.formula)), in_doubles(value), error_in_doubles(value)
            )
            for one, value in conserved
        ),
        linear=tuple(written.linear),
        closed_form={name: constants.formula(node) for name, node in written.closed.items()},
    )
    # All constants are known when everything is written.
    given = {name: in_doubles(value) for name, value in written.numbers.items()}
    shown = replace(shown, constants=constants.values(given))
    for one in shown.linear:
        matrices = (*one.mass, *one.damping, *one.stiffness)
        require_doubles([*one.about.values(), *one.load, *(entry for row in matrices for entry in row)])
    begun = [x for one in shown.start.values() for x in (one.value, one.rate) if x is not None]
    require_doubles([*shown.constants.values(), *begun, *(one.value for one in shown.conserved)])
    return shown


def _at_start(written: _Written, name: str) -> CoordinateAtStart:
    value, rate = written.start[name], written.rates.get(name)
    return CoordinateAtStart(
        in_doubles(value),
        None if rate is None else in_doubles(rate),
        error_in_doubles(value),
        None if rate is None else error_in_doubles(rate),
    )


def _with_one_energy(
    found: Modelled, conserved: list[tuple[Conserved, Ball]], parts: int
) -> list[tuple[Conserved, Ball]]:
    """Return what is conserved with the energies of all parts as that of the scene, where none is missing."""
    own = [(one, value) for one, value in conserved if one.kind == ENERGY]
    others = [(one, value) for one, value in conserved if one.kind != ENERGY]
    if not own or len(own) < parts:
        return conserved
    total = energy_of(found.described, NumberKind(lambda value: value, None)).total
    # What rests, spins steadily, or is a spring's energy at its length of zero is a constant.
    rest = Sum.number(total - sum((value for _, value in own), total * 0))
    return [(Conserved(ENERGY, "", added([*(one.formula for one, _ in own), rest])), total), *others]


def _rests(motion: Motion) -> bool:
    return not motion.moves


def _write_part(
    written: _Written,
    piece: Piece,
    motion: Motion,
    symbols: list[str],
    columns: Mapping[int, Node],
    given: Mapping[str, Ball],
) -> None:
    """Write a part in the variables of its chart."""
    # Rows that follow from others have no multipliers of their own.
    table = replace(piece.table, rows=[piece.table.rows[r] for r in piece.chosen])
    chart = Chart.of(table, symbols, written.coordinates, given)
    names = force_symbols(piece.table.acting, written.forces)
    multipliers = [f"{MULTIPLIER}{written.multipliers + k + 1}" for k in range(len(chart.rows))]
    written.multipliers += len(multipliers)
    check_chart(chart)
    found = lagrange_equations(chart, names, multipliers)
    written.coordinates |= coordinates_of(chart, columns)
    written.why += chart.steps
    written.equations += equation_sides(found.equations)
    written.constraints += [(node_of_sum(one), Node("number", "0")) for one in measures_of(chart)]
    written.forces |= law_nodes(chart, names)
    for law in piece.table.acting:
        written.numbers |= constants_of(law)
    if found.lagrangian is None:
        written.lagrangian = None
    elif written.lagrangian is not None:
        written.lagrangian.append(found.lagrangian)
    _conserve(written, energy_of_part(found), piece.table, chart.start, chart.rates)
    if not any(row.slide is not None for row in table.rows):
        # Others are written with the direction of friction at the start, and hold then alone.
        # What a law conserves shows where it is written out.
        sums = law_sums(chart, names)
        written.motion |= {
            name: reduce(lambda left, law: left.replaced(*law), sums.items(), one)
            for name, one in found.equations.items()
        }
    if not multipliers and not piece.table.acting:
        written.smooth.append((found.equations, chart.start))
    written.start |= chart.start
    written.rates |= chart.rates
    written.closed |= closed_forms(chart, motion, found.equations)
    for k, i in enumerate(piece.indices):
        written.places[i] = chart.places[k]


def _write_body(written: _Written, body: TurningBody, name: str, piece: Piece) -> None:
    """Write Euler's equations of a body."""
    rates = [f"{name}.omega_{k}" for k in (1, 2, 3)]
    down = [f"{name}.gamma_{k}" for k in (1, 2, 3)]
    for rate, end in zip(rates, "xyz", strict=True):
        written.coordinates[rate] = Node("name", f"{name}.angular_velocity.{end}")
    start = dict(zip(rates, body.angular_velocity, strict=True))
    if body.arm is not None:
        for k, axis in enumerate(body.axes):
            own = [(x, Node("name", f"{name}.axis{k + 1}.{end}")) for x, end in zip(body.pull, "xyz", strict=True)]
            written.coordinates[down[k]] = node_of_terms([(x, [column]) for x, column in own if not is_zero(x)])
            start[down[k]] = scalar_product(body.pull, axis)
    written.why.append(
        f"{name}: a body about a point has three rates of turn along its axes"
        + (", and three components of the vertical" if body.arm is not None else "")
    )
    written.equations += equation_sides(euler_equations(body, rates, down), order=1)
    written.lagrangian = None
    written.start |= start
    _conserve(written, conserved_of_body(body, name, rates, down), piece.table, start, {})
    for i in piece.indices:
        del written.places[i]


def _conserve(
    written: _Written,
    conserved: Sequence[Conserved],
    table: Table,
    start: Mapping[str, Ball],
    rates: Mapping[str, Ball],
) -> None:
    """Write what a part conserves with its values at the start, of which the energy is that of its table."""
    for one in conserved:
        if one.kind == ENERGY:
            check_formula(ENERGY, one.of, one.formula, kinetic(table) + potential(table), start, rates)
        written.conserved.append((one, one.formula.value(start, rates)))


def _kept_positive(
    found: Modelled, places: Mapping[int, Sum], forces: Mapping[str, Sum]
) -> tuple[list[Sum], list[Sum]]:
    """Return lengths that are positive and tensions that are not negative, as far as they are written."""
    measures, expressions = found.described.measures, found.whole.reduced.expressions
    lengths: list[Sum] = []
    tensions: list[Sum] = []
    for limit in measures.limits:
        if limit.length is not None:
            own = {i: expressions[i] for key in limit.length for i in key}
            if all(key[0] in places for expression in own.values() for key in expression if key):
                lengths.append(Sum.of(limit.length, {i: _substituted(one, places) for i, one in own.items()}))
        if limit.force is not None:
            tensions += filter(None, [forces.get(measures.forces[limit.force].name)])
    return lengths, tensions


def _forces(found: Modelled, places: Mapping[int, Sum]) -> dict[str, Sum]:
    """Return the forces of connections, as far as they follow from the motion."""
    measures, expressions = found.described.measures, found.whole.reduced.expressions
    turning = any(row.slide is not None for row in measures.table.rows)
    if turning or measures.table.acting or len(places) < len(found.whole.reduced.table.names):
        return {}
    own = [_substituted(expression, places) for expression in expressions]
    return constraint_forces(measures.table, measures.forces, own)


def _places(found: Modelled, written: _Written) -> dict[str, Node]:
    """Return the columns of bodies as formulas of the coordinates, which have the values and rates of the start."""
    table, answer = found.described.measures.table, dict[str, Node]()
    sums: dict[int, Sum] = {}
    for i, expression in enumerate(found.whole.reduced.expressions):
        # A clock is no column, and one that nothing reads is not written.
        if table.units[i] != "s" and all(key[0] in written.places for key in expression if key):
            sums[i] = _substituted(expression, written.places)
            check_formula("place", table.names[i], sums[i], table.q[i], written.start, written.rates)
            check_formula("velocity", table.names[i], sums[i].rate(), table.v[i], written.start, written.rates)
    for name, frame in found.described.measures.coordinates.frames.items():
        own = [(f"{name}.{axis}", i) for axis, i in zip("xyz", frame.position, strict=False)]
        if frame.axis is not None:
            own += [(f"{name}.axis.{axis}", i) for axis, i in zip("xyz", frame.axis[1], strict=True)]
        if frame.turn is not None:
            own.append((f"{name}.angle", frame.turn))
        for column, i in own:
            if i in sums:
                answer[column] = node_of_sum(sums[i])
        if frame.turn is None and frame.direction is not None:
            cosine, sine = (sums[i] for i in frame.direction)
            given = found.described.measures.coordinates.start_angle(name)
            answer[f"{name}.angle"] = angle_of_body(cosine, sine, given, written.start)
    return answer


def _substituted(expression: Mapping[tuple[int, ...], Ball], places: Mapping[int, Sum]) -> Sum:
    return added(places[key[0]].times(value) if key else Sum.number(value) for key, value in expression.items())
