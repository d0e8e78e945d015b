"""Kepler's problem: one point that an inverse square pulls or pushes, in closed form at any time.

With the universal variable s, ds = dt/r, distance and time are r = r_0 + eta_0 G_1 + zeta_0 G_2 and
t = r_0 G_1 + eta_0 G_2 + mu G_3 for ellipses, parabolas and hyperbolas alike, repelled and radial motions too. The
equation for s is solved by Newton's method, at last in balls; an ellipse is first taken back by whole periods.

References
----------
K. Stumpff, Himmelsmechanik I (1959). J. Wisdom, D. M. Hernandez, "Fast and accurate universal Kepler solvers", Monthly
Notices of the Royal Astronomical Society 453 (2015): the functions G_n.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from flint import arb, ctx

from core.arrays import Floats
from core.balls import Undetermined, precision, raised
from core.errors import AccuracyUnreachable
from core.multibody.algebra.directions import scalar_product
from core.multibody.algebra.polynomials import BITS, ONE, ZERO, Ball, Poly, entry, is_zero
from core.multibody.motion.motion import BallState, Motion, States, in_pairs
from core.multibody.table.table import Table

_SMALL = 2.0**-98
"""Bound of the error of a state as a share of its size: eight bits more than the rounding to pairs."""

_SOLVED = 0.625
"""Share of the bits that the last step of Newton's method leaves right: its square is far below rounding."""

_ENOUGH = 100
"""Bits to which the distance has to be known."""

_STUMPFF = [(1 / math.factorial(2 * k + 2), 1 / math.factorial(2 * k + 3)) for k in reversed(range(8))]


@dataclass(frozen=True)
class Kepler(Motion):
    """A point about a fixed centre.

    Attributes
    ----------
    table : Table
    places : tuple of int
        Coordinates of the point.
    lengths : tuple of int or None, int
        Distance, where it is a coordinate of its own, and one over the distance.
    centre : tuple of balls
    mu : ball
        Strength over mass (m^3/s^2), negative where the centre repels.
    """

    table: Table
    places: tuple[int, ...]
    lengths: tuple[int | None, int]
    centre: tuple[Ball, ...]
    mu: Ball
    name: str = "Kepler's problem"
    why: str = "a point and an inverse square of the distance from one centre: an ellipse, parabola or hyperbola"
    how: str = "closed form"

    @cached_property
    def start(self) -> tuple[list[Ball], list[Ball]]:
        """Place from the centre, and velocity."""
        q, v = self.table.q, self.table.v
        return [q[i] - c for i, c in zip(self.places, self.centre, strict=True)], [v[i] for i in self.places]

    @cached_property
    def constants(self) -> tuple[Ball, Ball, Ball]:
        """Distance, its product with its rate, and beta = 2 mu/r - v^2, which is positive for an ellipse."""
        place, rate = self.start
        distance = scalar_product(place, place).sqrt()
        beta = 2 * self.mu / distance - scalar_product(rate, rate)
        return distance, scalar_product(place, rate), ZERO if is_zero(beta) else beta

    @property
    def period(self) -> Ball | None:
        """The period in seconds."""
        if self.radial or not self.constants[2] > 0:
            return None
        return 2 * arb.pi() * self.mu / self.constants[2] ** 1.5

    @cached_property
    def radial(self) -> bool:
        """Whether the point moves along a line through the centre."""
        place, rate = self.start
        distance, product, _ = self.constants
        return bool(is_zero(scalar_product(rate, rate) * distance * distance - product * product)) and bool(
            all(is_zero(product * x - y * distance * distance) for x, y in zip(place, rate, strict=True))
        )

    def keeps_positive(self, length: Poly) -> bool:
        """Return that the distance is positive until the point falls into the centre."""
        return True

    def ended(self, end: float) -> tuple[float, float] | None:
        """Return the time before `end` at which the point falls into the centre, and its error; None without one."""
        reached = self.reach(end)
        return None if reached is None else (reached, 2.0**-52 * abs(reached))

    def reach(self, end: float) -> float | None:
        """Return the time before `end` at which the point falls into the centre; None if it does not."""
        if not self.radial or not self.mu > 0:
            return None
        with precision(BITS):
            fall = self._fall(1 if end > 0 else -1)
        return None if fall is None or abs(float(fall)) > abs(end) else float(fall)

    def _fall(self, way: int) -> Ball | None:
        distance, product, beta = self.constants
        mu = self.mu
        if beta > 0:
            a = mu / beta
            since = arb.atan2(product / (mu * a).sqrt(), 1 - distance / a)
            since = since if since > 0 else since + 2 * arb.pi()
            scale = (a * a * a / mu).sqrt()
            gone = scale * (since - since.sin())
            return 2 * arb.pi() * scale - gone if way > 0 else -gone
        if (product < 0) != (way > 0):
            return None
        if beta < 0:
            a = -mu / beta
            since = (1 + distance / a).acosh()
            return way * (a * a * a / mu).sqrt() * (since.sinh() - since)
        return way * (2 * raised(distance, 3) / (9 * mu)).sqrt()

    def states(self, times: Floats, *, finer: bool = False) -> States:
        """Return the states, right to the last bits of pairs.

        Raises
        ------
        AccuracyUnreachable
            At a time so far away that 320 bits do not tell the place.
        """
        with precision(BITS):
            found = [self._at(arb(float(t))) for t in times]
            if not all(state.q[self.lengths[1]].rel_accuracy_bits() > _ENOUGH for state in found):
                reason = "320 bits do not tell the place at this time"
                raise AccuracyUnreachable(None, np.inf, reason, path=("times",))
        q, v = in_pairs(found, len(self.table.names))
        size_q, size_v = np.abs(q[..., 0]), np.abs(v[..., 0])
        own = list(self.places)
        size_q[:, own] += np.linalg.norm(size_q[:, own], axis=1, keepdims=True)
        size_v[:, own] += np.linalg.norm(size_v[:, own], axis=1, keepdims=True)
        return States(q, v, _SMALL * size_q, _SMALL * size_v)

    def in_balls(self, times: Sequence[Ball]) -> list[BallState]:
        """Return the states, with Kepler's equation solved in an interval; it raises as `Motion.in_balls`."""
        # What is known of it at one precision is not known at a higher one.
        own = replace(self)
        return [own._at(time, proven=True) for time in times]

    def _at(self, time: Ball, *, proven: bool = False) -> BallState:
        """Return the state at a time."""
        distance, product, beta = self.constants
        period = self.period
        if period is not None:
            # Beside the nearest passage of the start, at most half a period away, the equation takes the fewest steps.
            time = time - period * (time / period + 0.5).mid().floor().mid()
        s = self._universal(time)
        s = self._enclosed(s.mid(), time) if proven else s
        g0, g1, g2, g3 = stumpff(beta, s)
        r = distance * g0 + product * g1 + self.mu * g2
        rate = (product * g0 + (self.mu - beta * distance) * g1) / r
        f, g = 1 - self.mu * g2 / distance, time - self.mu * g3
        df, dg = -self.mu * g1 / (r * distance), 1 - self.mu * g2 / r
        q, v = list(self.table.q), list(self.table.v)
        for i, c, x, u in zip(self.places, self.centre, *self.start, strict=True):
            q[i], v[i] = c + f * x + g * u, df * x + dg * u
        if self.lengths[0] is not None:
            q[self.lengths[0]], v[self.lengths[0]] = r, rate
        q[self.lengths[1]], v[self.lengths[1]] = 1 / r, -rate / (r * r)
        return BallState(q, v)

    def _enclosed(self, s: Ball, time: Ball) -> Ball:
        """Return an interval that holds the root of Kepler's equation, near s, by Newton's method in intervals."""
        left, slope = self._equation(s, time)
        around = s + arb(0, 1) * (2 * left / slope).abs_upper()
        found = s - left / self._equation(around, time)[1]
        if not around.contains(found):
            raise Undetermined
        return found

    def _equation(self, s: Ball, time: Ball) -> tuple[Ball, Ball]:
        """Return by how much the time of s is late, and its derivative, which is the distance."""
        distance, product, beta = self.constants
        g0, g1, g2, g3 = stumpff(beta, s)
        return (
            distance * g1 + product * g2 + self.mu * g3 - time,
            distance * g0 + product * g1 + self.mu * g2,
        )

    def _universal(self, time: Ball) -> Ball:
        """Return s at a time: by doubles in units of the start, then by Newton's method in balls."""
        distance, product, beta = self.constants
        unit = (raised(distance, 3) / abs(self.mu)).sqrt()
        speed = distance / unit
        sign = 1.0 if self.mu > 0 else -1.0
        scaled = (float(product / (distance * speed)), sign, float(beta / (speed * speed)), float(time / unit))
        if not all(map(math.isfinite, scaled)):
            raise AccuracyUnreachable(None, np.inf, "the motion leaves the range of doubles", path=("times",))
        s = arb(universal_in_doubles(*scaled)) * unit / distance
        for _ in range(12):
            left, slope = self._equation(s, time)
            step = left.mid() / slope.mid()
            s = (s - step).mid()
            if abs(step) <= arb(2) ** -int(_SOLVED * ctx.prec) * abs(s):
                # Newton's method squares the error, which is far below the last step now.
                return arb(s, abs(float(step)) * 2.0**-40) if abs(float(step)) > 0.0 else s
        raise AccuracyUnreachable(None, np.inf, "Kepler's equation is not solved in 320 bits", path=("times",))


def keplerian(table: Table) -> Kepler | None:
    """Return the motion of a part that is one point and an inverse square of its distance from a centre; else None."""
    inverse = [i for i, unit in enumerate(table.units) if unit == "1/m"]
    places = tuple(sorted({i for key in table.mass for i in key}))
    if len(inverse) != 1 or not places or table.stiffness or table.damping or table.gyration:
        return None
    w = inverse[0]
    mass = entry(table.mass, (places[0], places[0]))
    if set(table.load) != {w} or set(table.mass) != {(i, i) for i in places}:
        return None
    if not all(is_zero(table.mass[i, i] - mass) for i in places):
        return None
    measures = [row.measure for row in table.rows if row.measure is not None]
    product = [measure for measure in measures if any(w in key for key in measure)]
    if len(product) != 1 or len(measures) != len(table.rows):
        return None
    mu = table.load[w] / mass
    others = [i for i in range(len(table.names)) if i not in places and i != w]
    if not others and len(places) == len(measures) == 1:
        (x,) = places
        centre = _along_a_line(product[0], x, w)
        return None if centre is None else Kepler(table, places, (None, w), (centre,), mu)
    if len(others) != 1 or len(measures) != 2:
        return None
    (length,) = others
    form = measures[0] if measures[1] is product[0] else measures[1]
    around = _around(form, places, length)
    pair = min(length, w), max(length, w)
    if around is None or set(product[0]) != {pair, ()} or not is_zero(product[0][pair] + product[0][()]):
        return None
    return Kepler(table, places, (length, w), around, mu)


def _along_a_line(measure: Poly, x: int, w: int) -> Ball | None:
    """Return c where a measure is a multiple of +-(x - c) w - 1."""
    key = (min(x, w), max(x, w))
    if not set(measure) <= {key, (w,), ()} or key not in measure or () not in measure:
        return None
    if not is_zero(abs(measure[key]) - abs(measure[()])):
        return None
    return -entry(measure, (w,)) / measure[key]


def _around(measure: Poly, places: Sequence[int], length: int) -> tuple[Ball, ...] | None:
    """Return the centre about which a measure says that a length is the distance of the places."""
    lead = entry(measure, (length, length))
    allowed = {(length, length), (), *((i, i) for i in places), *((i,) for i in places)}
    if is_zero(lead) or not set(measure) <= allowed:
        return None
    if not all(is_zero(entry(measure, (i, i)) + lead) for i in places):
        return None
    centre = tuple(entry(measure, (i,)) / (2 * lead) for i in places)
    return centre if is_zero(entry(measure, ()) + lead * scalar_product(centre, centre)) else None


def stumpff(beta: Ball, s: Ball) -> tuple[Ball, Ball, Ball, Ball]:
    """Return G_0, G_1, G_2, G_3: G_n = sum of (-beta)^k s^(n + 2k)/(n + 2k)!."""
    x = beta * s * s
    # Down to here the differences below lose 35 of the 320 bits at most.
    if not abs(x) < 2.0**-32:
        if x > 0:
            root = beta.sqrt()
            sine, cosine = (root * s).sin_cos()
        else:
            root = (-beta).sqrt()
            sine, cosine = (root * s).sinh(), (root * s).cosh()
        g1 = sine / root
        return cosine, g1, (1 - cosine) / beta, (s - g1) / beta
    term, g2, g3, k, least = ONE, ZERO, ZERO, 2, arb(2) ** (-ctx.prec - 10)
    while True:
        g2, g3 = g2 + term, g3 + term / (k + 1)
        term = -term * x / ((k + 1) * (k + 2))
        k += 2
        # The sum is that of a series with alternating or positive terms that fall by more than a hundred each time.
        if is_zero(term) or abs(term) < least or k > ctx.prec:
            break
    rest = arb(0, 1) * 1024 * least
    g2, g3 = (g2 + rest) * s * s / 2, (g3 + rest) * s * s * s / 2
    return 1 - beta * g2, s - beta * g3, g2, g3


def universal_in_doubles(product: float, mu: float, beta: float, time: float) -> float:
    """Return s with t = G_1 + product G_2 + mu G_3, to some digits: r_0 and the magnitude of mu are one.

    The time grows with s everywhere, so that a bracket is found by doubling, and Newton's method stays inside it.
    """
    if time == 0.0:
        return 0.0

    def at(s: float) -> tuple[float, float]:
        x = beta * s * s
        if abs(x) < 0.1:
            c2 = c3 = 0.0
            for even, odd in _STUMPFF:
                c2, c3 = even - x * c2, odd - x * c3
            g2, g3 = c2 * s * s, c3 * s**3
            g0, g1 = 1.0 - beta * g2, s - beta * g3
        elif x > 0.0:
            root = math.sqrt(beta)
            g0, g1 = math.cos(root * s), math.sin(root * s) / root
            g2, g3 = (1.0 - g0) / beta, (s - g1) / beta
        else:
            root = math.sqrt(-beta)
            if abs(root * s) > 700.0:
                return math.copysign(math.inf, s), math.inf
            g0, g1 = math.cosh(root * s), math.sinh(root * s) / root
            g2, g3 = (1.0 - g0) / beta, (s - g1) / beta
        return g1 + product * g2 + mu * g3 - time, g0 + product * g1 + mu * g2

    near, far = 0.0, math.copysign(min(abs(time), 1.0), time)
    while at(far)[0] * time < 0.0:
        near, far = far, 2.0 * far
    low, high = min(near, far), max(near, far)
    s = 0.5 * (low + high)
    for _ in range(200):
        left, slope = at(s)
        if left > 0.0:
            high = s
        else:
            low = s
        step = left / slope if slope > 0.0 and math.isfinite(left) else math.inf
        new = s - step
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - s) <= 1e-12 * abs(s):
            return new
        s = new
    return s
