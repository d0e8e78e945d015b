"""Coordinates of a part in terms of as few variables as its rows allow: angles on circles, lengths, what is left.

Rows are solved one at a time. A measure in which a coordinate is linear gives that coordinate; a circle or sphere gives
its angles, also one about a moving centre and one whose radius is a coordinate; a product that is constant gives an
inverse; rates in constant proportion are integrated. What remains is held by multipliers.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from flint import arb

from core.multibody.algebra.directions import polar_angle
from core.multibody.algebra.polynomials import ONE, ZERO, Ball, Poly, combined, degree, entry, evaluated, is_zero
from core.multibody.formulation.circles import circle_of, neighbours
from core.multibody.formulation.trigonometric_sums import TIME, Sum, Term, Variable, added
from core.multibody.formulation.unused_names import unused
from core.multibody.table.table import Row, Table

HORIZONTAL = 0.99
"""Cosine of the angle from a pole beyond which another axis is taken: longitudes lose their meaning there."""

DIRECTION = ("cos", "sin")
"""Ends of the names of coordinates that are cosine and sine of the angle of a body."""


@dataclass
class Round:
    """Coordinates on a circle or sphere.

    Attributes
    ----------
    arms : list of affine polynomials
        The vector from its centre, in the coordinates of the table.
    radius : affine polynomial
    angles : list of str
        The variables: of a circle one; of a sphere the angle from the pole and that about it.
    heading : bool
        Whether angles count from the first axis, as those of bodies do; else from downwards.
    """

    arms: list[Poly]
    radius: Poly
    angles: list[str]
    heading: bool


@dataclass
class Chart:
    """The coordinates of a table in terms of variables.

    Attributes
    ----------
    table : Table
    symbols : list of str
        Names of its coordinates as variables.
    places : list of Sum
        Every coordinate.
    start, rates : dict of str to ball
        Of every variable; the time is zero.
    rows : list of Row
        Those that are not solved.
    rounds : list of Round
    steps : list of str
        Why the variables suffice, in sentences.
    taken : collection of str
        Names of the variables of other tables.
    given : mapping of str to ball
        The angles of bodies of the plane at the start, with their whole turns (rad).
    """

    table: Table
    symbols: list[str]
    places: list[Sum] = field(default_factory=list)
    start: dict[str, Ball] = field(default_factory=dict)
    rates: dict[str, Ball] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    rounds: list[Round] = field(default_factory=list)
    steps: list[str] = field(default_factory=list)
    taken: Collection[str] = ()
    given: Mapping[str, Ball] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        table: Table,
        symbols: list[str],
        taken: Collection[str] = (),
        given: Mapping[str, Ball] | None = None,
    ) -> Chart:
        """Return the chart of a table, with no variables of names that are taken."""
        places = [Sum.variable(name) for name in symbols]
        chart = cls(table, symbols, places, rows=list(table.rows), taken=frozenset(taken), given=given or {})
        for name, place, rate in zip(symbols, table.q, table.v, strict=True):
            chart.start[name], chart.rates[name] = place, rate
        chart.start[TIME] = ZERO
        while any(chart._solves(row) for row in chart.rows):
            pass
        return chart

    @property
    def variables(self) -> list[str]:
        """The names of the variables, the time apart, in the order of the coordinates that they stand for."""
        seen = [name for place in self.places for name in sorted(place.names())]
        return [name for name in dict.fromkeys(seen) if name != TIME]

    def _solves(self, row: Row) -> bool:
        """Solve a row where that is possible, and return whether it was."""
        if row.drag or row.slide is not None:
            return False
        if row.measure is None:
            solved = self._integrates(row)
        else:
            value = Sum.of(row.measure, self.places)
            solved = not value or self._gives(row, value) or self._goes_round(row, row.measure) or self._divides(row)
        if solved:
            self.rows = [one for one in self.rows if one is not row]
        return solved

    def _free(self, i: int) -> bool:
        """Return whether a coordinate of the table is still a variable of its own."""
        return self.places[i] == Sum.variable(self.symbols[i])

    def _admit(self, name: str, value: Sum) -> bool:
        return all(place.admits(name, value) for place in self.places)

    def _replaces(self, name: str, value: Sum) -> bool:
        """Replace a variable where all places admit that, and return whether they do."""
        if not self._admit(name, value):
            return False
        self.places = [place.replaced(name, value) if name in place.names() else place for place in self.places]
        del self.start[name], self.rates[name]
        return True

    def _gives(self, row: Row, value: Sum) -> bool:
        """Solve a measure for a variable in which it is linear."""
        for i in sorted({i for key in row.measure or {} for i in key}, reverse=True):
            name = self.symbols[i]
            alone = Term(((Variable(name), 1),))
            if not self._free(i) or alone not in value.terms:
                continue
            rest = value - Sum({alone: value.terms[alone]})
            if name in rest.names() or not self._replaces(name, rest.times(-1 / value.terms[alone])):
                continue
            self.steps.append(f"{row.name}: {name} follows from the others")
            return True
        return False

    def _goes_round(self, row: Row, measure: Poly) -> bool:
        """Solve a circle or sphere for its angles."""
        if degree(measure) != 2:
            return False
        squares: dict[float, list[int]] = {}
        for key, value in measure.items():
            if len(key) == 2 and key[0] == key[1] and self._free(key[0]) and self._may_turn(key[0]):
                squares.setdefault(float(value), []).append(key[0])
        for among in sorted(squares.values(), key=len, reverse=True):
            for chosen in neighbours(among):
                found = None if self._ties(row, chosen) else circle_of(measure, chosen)
                if found is not None and self._is_apart(*found, chosen) and self._has_radius(found[1], chosen):
                    self._take_angles(row, chosen, *found)
                    return True
        return False

    def _may_turn(self, i: int) -> bool:
        """Return whether a coordinate can be replaced by a sum with sines."""
        return self._admit(self.symbols[i], Sum.sine(self.symbols[i]))

    def _ties(self, row: Row, chosen: list[int]) -> bool:
        """Return whether another measure holds an axis to others, as those of a body, whose angles say little."""
        others = [key for one in self.rows if one is not row for key in one.measure or {} if len(key) == 2]
        return len(chosen) == 3 and any(len(set(key) & set(chosen)) == 1 for key in others)

    def _is_apart(self, arms: list[Poly], radius: Poly, chosen: list[int]) -> bool:
        """Return whether neither the centre nor the radius follows, by rows before, what is to go round."""
        own = {self.symbols[i] for i in chosen}
        others = {i for form in (*arms, radius) for key in form for i in key} - set(chosen)
        return not any(own & self.places[i].names() for i in others)

    def _has_radius(self, radius: Poly, chosen: list[int]) -> bool:
        inside = {i for key in radius for i in key}
        return not inside & set(chosen) and not is_zero(evaluated(radius, self.table.q))

    def _take_angles(self, row: Row, chosen: list[int], arms: list[Poly], radius: Poly) -> None:
        table = self.table
        if evaluated(radius, table.q) < 0:
            radius = combined((-ONE, radius))
        size = evaluated(radius, table.q)
        u = [evaluated(arm, table.q) for arm in arms]
        du = [sum((x * table.v[key[0]] for key, x in arm.items() if key), ZERO) for arm in arms]
        heading = all(table.units[i] == "1" for i in chosen)
        if len(chosen) == 3:
            pole = 2 if abs(float(u[2] / size)) < HORIZONTAL else min(range(3), key=lambda k: abs(float(u[k])))
            order = [(pole + 1) % 3, (pole + 2) % 3, pole]
            chosen, arms = [chosen[k] for k in order], [arms[k] for k in order]
            u, du = [u[k] for k in order], [du[k] for k in order]
        stem, _, end = self.symbols[chosen[0]].rpartition(".")
        is_angle = tuple(self.symbols[i].rpartition(".")[2] for i in chosen) == DIRECTION and self._heads(stem, u)
        new = self._angle_of_body(stem) if is_angle else self._new(f"{stem or end}.theta")
        length = Sum.of(radius, self.places)
        cosine, sine = Sum.cosine(new), Sum.sine(new)
        names = [new]
        if len(chosen) == 2:
            if heading:
                ways, angle = [cosine, sine], polar_angle(u[0], u[1])
            else:
                ways, angle = [sine, cosine.times(-ONE)], polar_angle(-u[1], u[0])
            turning = (u[0] * du[1] - u[1] * du[0]) / (size * size)
            # An angle that is a coordinate, too, has its turns.
            self.start.setdefault(new, self.given[stem] if is_angle else angle)
            self.rates[new] = turning
        else:
            about = self._new(f"{stem or end}.phi", taken=new)
            sign = ONE if heading else -ONE
            ways = [sine * Sum.cosine(about), sine * Sum.sine(about), cosine.times(sign)]
            flat = (u[0] * u[0] + u[1] * u[1]).sqrt()
            rise = sign * (u[0] * u[0] + u[1] * u[1]) * du[2] - sign * u[2] * (u[0] * du[0] + u[1] * du[1])
            self.start[new], self.rates[new] = arb.atan2(flat, sign * u[2]), -rise / (flat * size * size)
            self.start[about] = polar_angle(u[0], u[1])
            self.rates[about] = (u[0] * du[1] - u[1] * du[0]) / (flat * flat)
            names.append(about)
        for i, arm, way in zip(chosen, arms, ways, strict=True):
            centre = Sum.of(combined((ONE, arm), (-ONE, {(i,): ONE})), self.places)
            replaced = self._replaces(self.symbols[i], length * way - centre)
            assert replaced, "what goes round admits sines"
        self.rounds.append(Round(arms, radius, names, heading))
        held = " and ".join(self.symbols[i] for i in chosen)
        enough = "circle: an angle suffices" if len(chosen) == 2 else "sphere: two angles suffice"
        self.steps.append(f"{row.name}: {held} lie on a {enough}")

    def _heads(self, body: str, direction: list[Ball]) -> bool:
        """Return whether a direction is that of a body at the start, and no sum of directions."""
        if body not in self.given:
            return False
        sine, cosine = self.given[body].sin_cos()
        return is_zero(direction[0] - cosine) and is_zero(direction[1] - sine)

    def _angle_of_body(self, body: str) -> str:
        """Return the name of the angle of a body: that of the coordinate which is this angle, if there is one."""
        name = f"{body}.angle"
        own = name in self.symbols and self._free(self.symbols.index(name))
        return name if own and is_zero(self.start[name] - self.given[body]) else self._new(name)

    def _new(self, name: str, taken: str = "") -> str:
        """Return a name that no variable has."""
        return unused(name, {*self.symbols, *self.start, *self.taken, taken})

    def _divides(self, row: Row) -> bool:
        """Solve a product that is constant for one of its factors."""
        measure = row.measure or {}
        product = next((key for key in measure if len(key) == 2 and key[0] != key[1]), None)
        if product is None or set(measure) != {product, ()}:
            return False
        for i, j in sorted((product, product[::-1]), key=lambda pair: self.table.units[pair[0]] != "1/m"):
            inverse = self.places[j].inverse()
            if inverse is None or not self._free(i) or self.symbols[i] in inverse.names():
                continue
            if self._replaces(self.symbols[i], inverse.times(-measure[()] / measure[product])):
                return True
        return False

    def _integrates(self, row: Row) -> bool:
        """Solve rates in constant proportion for a variable."""
        value = self.rates_of(row)
        if not value:
            return True
        known = _proportions(value)
        if known is None:
            return False
        factors, constant = known
        waves = {name for place in self.places for name in place.in_waves()}
        units = dict(zip(self.symbols, self.table.units, strict=True))
        for name in sorted(factors, key=lambda one: (units.get(one) != "s", one in waves, one not in units)):
            lead = factors[name]
            slopes = {other: -x / lead for other, x in factors.items() if other != name}
            # Of the times themselves the sum is -constant / lead.
            offset = self.start[name] - sum((x * self.start[other] for other, x in slopes.items()), ZERO)
            parts = [Sum.variable(other).times(x) for other, x in slopes.items()]
            if self._replaces(name, added([*parts, Sum.variable(TIME).times(-constant / lead), Sum.number(offset)])):
                if units.get(name) != "s":
                    self.steps.append(f"{row.name}: {name} goes in constant proportion with the others")
                return True
        return False

    def rates_of(self, row: Row) -> Sum:
        """Return what a row says of the rates, which is zero."""
        parts = [Sum.of(poly, self.places) * self.places[j].rate() for j, poly in row.rates.items()]
        return added([*parts, Sum.number(-row.rate)])


def _proportions(value: Sum) -> tuple[dict[str, Ball], Ball] | None:
    """Return constants in the proportion of which rates, and a constant, add up to zero; None where they are not."""
    names = [variable.name for term in value.terms for variable, _ in term.factors if variable.order == 1]
    slopes = {name: value.derivative(Variable(name, 1)) for name in dict.fromkeys(names)}
    rest = value - added(slope * Sum.variable(name, 1) for name, slope in slopes.items())
    if not slopes:
        return None
    base = next(iter(slopes.values()))
    lead = next(iter(base.terms))
    factors = {name: entry(dict(slope.terms), lead) / base.terms[lead] for name, slope in slopes.items()}
    constant = entry(dict(rest.terms), lead) / base.terms[lead]
    if any(slope - base.times(factors[name]) for name, slope in slopes.items()) or rest - base.times(constant):
        return None
    return factors, constant
