"""The table of quadratics that every scene becomes, in balls.

    M q'' = b - K q - D q' + B(q, q') + G f(q, q') + (W(q) + X(q))^T lambda,     W(q) q' = r,

with constant M, b, K, D, B, G and with W and X affine in q; X is friction, and f are the values of formulas. A row is
either a measure that stays zero, a polynomial of degree two at most whose gradient is its line of W, or a rate row that
is the derivative of nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from core.multibody.algebra.polynomials import (
    ONE,
    ZERO,
    Ball,
    LinearForm,
    Poly,
    add_term,
    combined,
    degree,
    evaluated,
    gradient,
    is_zero,
    substituted,
    variables,
)
from core.multibody.algebra.rank import independent
from core.multibody.laws.law import Law
from core.multibody.laws.merged import merged
from core.multibody.laws.series import values_at


@dataclass
class Row:
    """A measure that stays zero, or a combination of rates that stays at `rate`.

    Attributes
    ----------
    name : str
        The connection or body to which it belongs.
    measure : polynomial or None
        None for a rate row.
    rates : LinearForm
        Its line of W.
    rate : ball
        The right-hand side r.
    drag : LinearForm
        Its line of X: where its multiplier pushes beside the line of W. That of a sliding contact is -sigma mu times
        the rate of slip.
    slide : (ball, line, line) or None
        In space, of friction that turns with the slip: -mu and two constant lines along which the slip has the
        components s. The drag is -mu (s/|s|) times these lines, and stands in `drag` for the present state.
    begins : int or None
        Power of time with which such a slip begins from rest, where that is known better than from the state.
    """

    name: str
    measure: Poly | None
    rates: LinearForm
    rate: Ball = ZERO
    drag: LinearForm = field(default_factory=dict)
    slide: tuple[Ball, LinearForm, LinearForm] | None = None
    begins: int | None = None

    @classmethod
    def held(cls, name: str, measure: Poly) -> Row:
        """Return the row of a measure that stays zero."""
        return cls(name, measure, gradient(measure))

    @property
    def constant(self) -> bool:
        """Whether the lines of W and X do not depend on the coordinates."""
        return all(degree(poly) <= 0 for part in (self.rates, self.drag) for poly in part.values())

    def coordinates(self) -> set[int]:
        """Return the coordinates that occur in the lines of W and X."""
        return {*self.rates, *self.drag, *variables(self.rates.values()), *variables(self.drag.values())}

    def line(self, q: Sequence[Ball]) -> dict[int, Ball]:
        """Return the line of W at a state."""
        found = {j: evaluated(poly, q) for j, poly in self.rates.items()}
        return {j: value for j, value in found.items() if not is_zero(value)}

    def pushed(self, q: Sequence[Ball]) -> dict[int, Ball]:
        """Return the line of W + X at a state: the force of a multiplier one."""
        found = {j: evaluated(poly, q) for j, poly in self.rates.items()}
        for j, poly in self.drag.items():
            found[j] = found.get(j, ZERO) + evaluated(poly, q)
        return {j: value for j, value in found.items() if not is_zero(value)}

    def along(self, expressions: Sequence[Poly]) -> Row:
        """Return the row in other coordinates, of which the present ones are affine functions."""
        drag = _along(self.drag, expressions)
        if self.measure is not None:
            measure = substituted(self.measure, expressions)
            return Row(self.name, measure, gradient(measure), ZERO, drag)
        return Row(self.name, None, _along(self.rates, expressions), self.rate, drag)


def _along(line: LinearForm, expressions: Sequence[Poly]) -> LinearForm:
    """Return a line of W or X in other coordinates."""
    found: LinearForm = {}
    for j, poly in line.items():
        changed = substituted(poly, expressions)
        for key, value in expressions[j].items():
            if key:
                into = found.setdefault(key[0], {})
                for monomial, factor in changed.items():
                    into[monomial] = into.get(monomial, ZERO) + value * factor
    cleaned = {j: {key: x for key, x in poly.items() if ZERO not in x} for j, poly in found.items()}
    return {j: poly for j, poly in cleaned.items() if poly}


@dataclass(frozen=True)
class Following:
    """Coordinates that are a function of a polynomial of others, which a rate row ties to that.

    Attributes
    ----------
    indices : tuple of int
    function : callable
        From the value of the polynomial to those of the coordinates.
    argument : polynomial
    row : Row
    """

    indices: tuple[int, ...]
    function: Callable[[Ball], Sequence[Ball]]
    argument: Poly
    row: Row


@dataclass
class Table:
    """The numbers of a scene.

    Attributes
    ----------
    names, units : list of str
        Of the coordinates; units are "m", "1", "rad", "1/m" or "s".
    mass : dict
        Upper triangle of M.
    load, stiffness, damping, gyration : dict
        b by i; K by (i, j); D by (i, j), both with every entry; B by (i, j, k): its product with q_j q_k'.
    rows : list of Row
    laws : list of Law
        Formulas whose values push coordinates.
    q, v : list of balls
        Coordinates and rates at the start.
    timed : dict of int to callable
        Coordinates of which the time alone decides, so that no assembly moves them; each with the
        function that it is of coordinates before it.
    follows : list of Following
        Coordinates that are functions of others, each of those before it.
    twins : list of (int, int)
        Coordinates that are the same function of time as others before them.
    places : list of vectors
        Centres and rims of bodies at the start, and places of the ground (m), as far as they are read.
    """

    names: list[str] = field(default_factory=list)
    units: list[str] = field(default_factory=list)
    mass: dict[tuple[int, int], Ball] = field(default_factory=dict)
    load: dict[int, Ball] = field(default_factory=dict)
    stiffness: dict[tuple[int, int], Ball] = field(default_factory=dict)
    damping: dict[tuple[int, int], Ball] = field(default_factory=dict)
    gyration: dict[tuple[int, int, int], Ball] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    laws: list[Law] = field(default_factory=list)
    q: list[Ball] = field(default_factory=list)
    v: list[Ball] = field(default_factory=list)
    timed: dict[int, Callable[[Sequence[Ball]], Ball]] = field(default_factory=dict)
    follows: list[Following] = field(default_factory=list)
    twins: list[tuple[int, int]] = field(default_factory=list)
    places: list[Sequence[Ball]] = field(default_factory=list)

    def independent_rows(self) -> list[int]:
        """Return the numbers of rows on which all others depend at the start, in order."""
        return independent(row.line(self.q) for row in self.rows)

    def coordinate(self, name: str, unit: str, value: Ball) -> int:
        """Add a coordinate and return its number."""
        self.names.append(name)
        self.units.append(unit)
        self.q.append(value)
        self.v.append(ZERO)
        return len(self.names) - 1

    def follow_time(self) -> None:
        """Give coordinates of which the time alone decides the values of its present one."""
        for i, value in self.timed.items():
            self.q[i] = value(self.q)

    def add_mass(self, i: int, j: int, value: Ball) -> None:
        """Add to M, on both sides of its diagonal."""
        add_term(self.mass, (min(i, j), max(i, j)), value)

    def add_load(self, i: int, value: Ball) -> None:
        """Add to b."""
        add_term(self.load, i, value)

    def add_stiffness(self, i: int, j: int, value: Ball) -> None:
        """Add to one entry of K."""
        add_term(self.stiffness, (i, j), value)

    def add_damping(self, i: int, j: int, value: Ball) -> None:
        """Add to one entry of D."""
        add_term(self.damping, (i, j), value)

    def add_gyration(self, i: int, j: int, k: int, value: Ball) -> None:
        """Add to one entry of B."""
        add_term(self.gyration, (i, j, k), value)

    @property
    def clocks(self) -> list[int]:
        """The coordinates that are a time."""
        return [i for i, unit in enumerate(self.units) if unit == "s"]

    @property
    def acting(self) -> list[Law]:
        """The laws whose forces are no entries of D."""
        return [law for law in self.laws if not law.in_table]

    @property
    def potential_load(self) -> dict[int, Ball]:
        """The loads that have a potential: without those of formulas that are constant on their piece."""
        constant = [law for law in self.laws if law.in_table and not law.inputs]
        if not constant:
            return self.load
        found = dict(self.load)
        for law, value in zip(constant, values_at(constant, self.q, self.v), strict=True):
            for i, factor in law.push.items():
                add_term(found, i, -factor * value)
        return found

    def forces(self) -> list[Ball]:
        """Return b - K q - D q' + B(q, q') + G f(q, q') at the start."""
        q, v = self.q, self.v
        total = [ZERO] * len(q)
        for i, value in self.load.items():
            total[i] = total[i] + value
        for (i, j), value in self.stiffness.items():
            total[i] = total[i] - value * q[j]
        for (i, j), value in self.damping.items():
            total[i] = total[i] - value * v[j]
        for (i, j, k), value in self.gyration.items():
            total[i] = total[i] + value * q[j] * v[k]
        acting = self.acting
        for law, force in zip(acting, values_at(acting, q, v), strict=True):
            for i, factor in law.push.items():
                total[i] = total[i] + factor * force
        return total

    def slip_of(self, row: Row) -> tuple[Ball, Ball]:
        """Return the two components of the slip of a row whose friction turns with it."""
        assert row.slide is not None
        found = []
        for line in row.slide[1:]:
            found.append(sum((evaluated(poly, self.q) * self.v[j] for j, poly in line.items()), ZERO))
        return found[0], found[1]

    def oriented(self) -> Table:
        """Return the table with all friction against the present slip; where that is zero, as it stands."""
        if all(row.slide is None for row in self.rows):
            return self
        rows = []
        for row in self.rows:
            if row.slide is not None:
                x, y = self.slip_of(row)
                square = x * x + y * y
                if square > 0:
                    factor, along, across = row.slide
                    c, s = (factor * z / square.sqrt() for z in (x, y))
                    drag = {j: combined((c, along.get(j, {})), (s, across.get(j, {}))) for j in {*along, *across}}
                    row = replace(row, drag={j: poly for j, poly in drag.items() if poly})
            rows.append(row)
        return replace(self, rows=rows)

    def inertial(self, acceleration: Sequence[Ball]) -> list[Ball]:
        """Return M times an acceleration."""
        total = [ZERO] * len(acceleration)
        for (i, j), value in self.mass.items():
            total[i] = total[i] + value * acceleration[j]
            if i != j:
                total[j] = total[j] + value * acceleration[i]
        return total

    def convective(self, row: Row) -> Ball:
        """Return -(dW/dt) q' of a row at the start: what W q'' has to be."""
        total = ZERO
        for j, poly in row.rates.items():
            for key, value in poly.items():
                if key:
                    total = total - value * self.v[key[0]] * self.v[j]
        return total

    def changed(self, expressions: Sequence[Poly], fresh: Sequence[int]) -> Table:
        """Return the table in fewer coordinates.

        Parameters
        ----------
        expressions : sequence of affine polynomials
            Every present coordinate in terms of the new ones.
        fresh : sequence of int
            The present number of each new coordinate.
        """
        new = Table([self.names[i] for i in fresh], [self.units[i] for i in fresh])
        new.q, new.v = [self.q[i] for i in fresh], [self.v[i] for i in fresh]
        slopes = [[(key[0], value) for key, value in expression.items() if key] for expression in expressions]
        offsets = [expression.get((), ZERO) for expression in expressions]
        mass = new.mass
        # Of a chain of n bodies these are of the order of n^3 terms.
        for (i, j), value in self.mass.items():
            for a, x in slopes[i]:
                scaled = value * x
                # The upper triangle stands for both sides: of a square each product is met twice and counts once.
                for b, y in slopes[j] if i != j else [one for one in slopes[i] if one[0] >= a]:
                    term = scaled * y
                    if i != j and a == b:
                        term = 2 * term
                    at = (a, b) if a <= b else (b, a)
                    old = mass.get(at)
                    mass[at] = term if old is None else old + term
        for i, value in self.load.items():
            for a, x in slopes[i]:
                new.add_load(a, value * x)
        for (i, j), value in self.stiffness.items():
            for a, x in slopes[i]:
                if offsets[j] != 0:
                    new.add_load(a, -value * x * offsets[j])
                for b, y in slopes[j]:
                    new.add_stiffness(a, b, value * x * y)
        for (i, j), value in self.damping.items():
            for a, x in slopes[i]:
                for b, y in slopes[j]:
                    new.add_damping(a, b, value * x * y)
        for (i, j, k), value in self.gyration.items():
            for a, x in slopes[i]:
                for c, z in slopes[k]:
                    if offsets[j] != 0:
                        new.add_damping(a, c, -value * x * z * offsets[j])
                    for b, y in slopes[j]:
                        new.add_gyration(a, b, c, value * x * y * z)
        for part in (new.mass, new.load, new.stiffness, new.damping, new.gyration):
            clean: dict[object, Ball] = part  # type: ignore[assignment]
            for key in [key for key, value in clean.items() if ZERO in value]:
                del clean[key]
        new.rows = [row.along(expressions) for row in self.rows]
        new.laws = merged(law.along(expressions) for law in self.acting)
        return new


def identity(count: int) -> list[Poly]:
    """Return the expressions that change nothing."""
    return [{(i,): ONE} for i in range(count)]
