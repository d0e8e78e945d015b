"""Motions in minimal coordinates, by d'Alembert's principle and Taylor series with 128 bits: no constraints, no tables.

A scene is the list of what has inertia, each as (inertia, function of the coordinates), and a potential. With the
derivatives x_q and x_qq of every such function, Lagrange's equations are

    sum m x_q (x_q . q'' + x_qq[q', q']) = -V_q.

The derivatives with respect to the coordinates are those of jets of second order, whose numbers are series in time.

References
----------
.. [1] H. Goldstein, C. Poole, J. Safko, Classical Mechanics, 3rd ed., section 1.4.
.. [2] A. Jorba, M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor
   methods, Experimental Mathematics 14 (2005) 99: order and step size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_series, ctx
from mpmath import mp, mpf

BITS, ORDER, TOLERANCE = 128, 30, arb("1e-24")


@dataclass(frozen=True)
class Jet:
    """A function of the coordinates with its first derivatives, and the second ones of pairs i <= j."""

    value: Any
    first: tuple[Any, ...]
    second: tuple[Any, ...]

    def __add__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value + exact(other), self.first, self.second)
        return Jet(
            self.value + other.value,
            tuple(a + b for a, b in zip(self.first, other.first, strict=True)),
            tuple(a + b for a, b in zip(self.second, other.second, strict=True)),
        )

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            factor = exact(other)
            return Jet(
                self.value * factor, tuple(a * factor for a in self.first), tuple(a * factor for a in self.second)
            )
        a, b, f, g = self.value, other.value, self.first, other.first
        second = (
            x * b + f[i] * g[j] + f[j] * g[i] + a * y
            for (i, j), x, y in zip(pairs(len(f)), self.second, other.second, strict=True)
        )
        return Jet(a * b, tuple(x * b + a * y for x, y in zip(f, g, strict=True)), tuple(second))

    def chained(self, value: Any, slope: Any, curvature: Any) -> Jet:
        f = self.first
        second = (slope * x + curvature * f[i] * f[j] for (i, j), x in zip(pairs(len(f)), self.second, strict=True))
        return Jet(value, tuple(slope * x for x in f), tuple(second))

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self) -> Jet:
        return self * -1

    def __sub__(self, other: Any) -> Jet:
        return self + -exact(other)

    def __rsub__(self, other: Any) -> Jet:
        return -self + other

    def __truediv__(self, other: Any) -> Jet:
        return self * (other.inverse() if isinstance(other, Jet) else 1 / exact(other))

    def __rtruediv__(self, other: Any) -> Jet:
        return self.inverse() * other

    def inverse(self) -> Jet:
        inverse = 1 / self.value
        square = inverse * inverse
        return self.chained(inverse, -square, 2 * square * inverse)


def pairs(count: int) -> list[tuple[int, int]]:
    return [(i, j) for i in range(count) for j in range(i, count)]


def exact(number: Any) -> Any:
    """Return what a number is written as, at the precision here: 0.1 is a tenth."""
    if isinstance(number, mpf):
        with mp.workdps(50):
            return arb(mp.nstr(number, 45))
    return arb(repr(number)) if isinstance(number, float) else arb(number) if isinstance(number, int) else number


def sin(x: Any) -> Any:
    if isinstance(x, Jet):
        s, c = x.value.sin(), x.value.cos()
        return x.chained(s, c, -s)
    return exact(x).sin()


def cos(x: Any) -> Any:
    if isinstance(x, Jet):
        s, c = x.value.sin(), x.value.cos()
        return x.chained(c, -s, -c)
    return exact(x).cos()


def sqrt(x: Any) -> Any:
    if isinstance(x, Jet):
        root = x.value.sqrt()
        inverse = 1 / root
        return x.chained(root, inverse / 2, -inverse * inverse * inverse / 4)
    return exact(x).sqrt()


Inertias = Callable[..., Iterable[tuple[Any, Any]]]


def motion(
    inertias: Inertias,
    potential: Callable[..., Any],
    start: Sequence[Any],
    rates: Sequence[Any],
    times: Iterable[float],
    driven: int = 0,
) -> list[tuple[list[Any], list[Any]]]:
    """Return coordinates and their rates at times >= 0 in rising order, as numbers of some 24 digits.

    Parameters
    ----------
    inertias : callable
        From the coordinates to (mass, Cartesian coordinate) and (moment of inertia, angle).
    potential : callable
        From the coordinates to the potential energy.
    driven : int
        How many of the first coordinates change at constant rates, whatever that takes.
    """
    before = ctx.prec, ctx.cap
    ctx.prec = BITS
    try:
        q, v = [exact(x) for x in start], [exact(x) for x in rates]
        now, found = arb(0), []
        series, reach = _step(inertias, potential, q, v, driven)
        for time in times:
            moment = arb(time)
            while now + reach < moment:
                q, v = _at(series, reach)
                now = (now + reach).mid()
                series, reach = _step(inertias, potential, q, v, driven)
            found.append(_at(series, moment - now))
        return found
    finally:
        ctx.prec, ctx.cap = before


def _step(inertias: Any, potential: Any, q: list[Any], v: list[Any], driven: int) -> tuple[list[Any], Any]:
    """Return the series of the coordinates at a place, and how far they hold."""
    places, rates = [arb_series([x]) for x in q], [arb_series([x]) for x in v]
    for order in range(1, ORDER + 1):
        ctx.cap = order
        gains = _accelerations(inertias, potential, places, rates, driven)
        ctx.cap = order + 1
        rates = [x + gain.integral() for x, gain in zip(v, gains, strict=True)]
        places = [x + rate.integral() for x, rate in zip(q, rates, strict=True)]
    size = max(abs(x) for x in [*q, *v, arb(1)])
    last = max((abs(s[n]) ** (arb(1) / n) for s in places for n in (ORDER - 1, ORDER) if s[n] != 0), default=arb(1))
    return places, ((TOLERANCE * size) ** (arb(1) / ORDER) / last).mid()


def _accelerations(inertias: Any, potential: Any, q: Sequence[Any], v: Sequence[Any], driven: int) -> list[Any]:
    count = len(q)
    jets = [
        Jet(x, tuple(arb_series([int(i == j)]) for j in range(count)), (arb_series([]),) * len(pairs(count)))
        for i, x in enumerate(q)
    ]
    free = range(driven, count)
    matrix = [[arb_series([]) for _ in free] for _ in free]
    energy = potential(*jets)
    load = [-energy.first[i] if isinstance(energy, Jet) else arb_series([]) for i in free]
    for inertia, x in inertias(*jets):
        bend = sum(
            (h * v[i] * v[j] * (1 if i == j else 2) for (i, j), h in zip(pairs(count), x.second, strict=True)),
            arb_series([]),
        )
        slopes = [x.first[i] * exact(inertia) for i in free]
        for i, slope in enumerate(slopes):
            load[i] -= slope * bend
            for j, k in enumerate(free):
                matrix[i][j] += slope * x.first[k]
    return [arb_series([])] * driven + _solved(matrix, load)


def _solved(matrix: list[list[Any]], load: list[Any]) -> list[Any]:
    """Eliminate without pivots: the matrix of inertia is positive definite."""
    count = len(load)
    for k in range(count):
        inverse = 1 / matrix[k][k]
        for i in range(k + 1, count):
            factor = matrix[i][k] * inverse
            load[i] -= factor * load[k]
            for j in range(k, count):
                matrix[i][j] -= factor * matrix[k][j]
    for k in reversed(range(count)):
        load[k] = (load[k] - sum((matrix[k][j] * load[j] for j in range(k + 1, count)), arb_series([]))) / matrix[k][k]
    return load


def _at(series: Sequence[Any], time: Any) -> tuple[list[Any], list[Any]]:
    ctx.cap = ORDER + 1
    q = [_summed(s, time, 0).mid() for s in series]
    v = [_summed(s, time, 1).mid() for s in series]
    return q, v


def _summed(series: Any, time: Any, derivative: int) -> Any:
    total = arb(0)
    for n in range(ORDER, derivative - 1, -1):
        total = total * time + series[n] * (n if derivative else 1)
    return total


def with_rates(
    places: Callable[..., Mapping[str, Any]], q: Sequence[Any], v: Sequence[Any]
) -> dict[str, tuple[list[float], list[float]]]:
    """Return named functions of the coordinates (numbers, or tuples of them) and their rates, as doubles."""
    before = ctx.prec, ctx.cap
    ctx.prec, ctx.cap = BITS, 2
    try:
        moved = places(*(arb_series([exact(x), exact(y)]) for x, y in zip(q, v, strict=True)))
        found = {}
        for name, value in moved.items():
            parts = value if isinstance(value, tuple) else (value,)
            series = [x if isinstance(x, arb_series) else arb_series([exact(x)]) for x in parts]
            found[name] = [float(x[0]) for x in series], [float(x[1]) for x in series]
        return found
    finally:
        ctx.prec, ctx.cap = before
