"""Torque-free motions on which every regime of the closed form, and every border between them, is judged.

The list is the same in every run: all that is random comes from named seeds.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import chain
from math import sqrt, ulp
from random import Random
from typing import NamedTuple

from mpmath import mp

from .free_rotation import free_motion
from .motion import Constant, Moving

Triple = tuple[float, float, float]

ORDERS = ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0))

# The 300 points of a T-shaped handle: principal moments about the origin and about the centre of mass.
T_HANDLE_ORIGIN: Triple = (837.195503014, 714.008200689, 437.685185185)
T_HANDLE: Triple = (795.792181070, 713.509259259, 395.782921811)


class Case(NamedTuple):
    """A motion and the times at which it is looked at."""

    name: str
    moments: Triple
    angular_velocity: Triple
    times: tuple[float, ...]


@cache
def cases(extra: int = 0) -> tuple[Case, ...]:
    """Return the default cases, and after them `extra` random ones."""
    families = (
        _axis_orders,
        _drawn_by_lot,
        _near_symmetric,
        _near_separatrix,
        _near_separatrix_by_cancellation,
        _on_separatrix,
        _needles_and_laminae,
        _magnitudes,
        _horizons,
        _principal_and_nearly,
        _equal_moments,
        _t_handle,
    )
    return tuple(chain(*(family() for family in families), _drawn_by_lot(40, 40 + extra)))


def _case(name: str, moments: Triple, rates: Triple, horizon: float = 3.0) -> Case:
    """Look at a motion over a horizon of so many periods: at its end, about two far flips, and early; unordered."""
    motion = free_motion(moments, rates, digits=20)
    rng = Random(name)
    if isinstance(motion, Constant):
        unit = float(1 / motion.largest_rate) if motion.largest_rate else 1.0
        far = horizon * unit * rng.random(), -horizon * unit * rng.random()
    else:
        unit = float(motion.period or 1 / motion.p)
        far = (
            _about_a_flip(motion, horizon * unit * rng.random(), rng.uniform(-2, 2)),
            _about_a_flip(motion, -horizon * unit * rng.random(), rng.uniform(-2, 2)),
        )
    return Case(name, moments, rates, (far[0], -unit * rng.random(), 0.0, horizon * unit, far[1], unit * rng.random()))


@mp.workdps(30)
def _about_a_flip(motion: Moving, time: float, offset: float) -> float:
    """Return the time of the flip nearest to `time`, and so much phase later.

    Near the saddle the body spends nearly all its time on the middle axis; by chance no sample would see it flip.
    """
    first = -motion.polhode.direction * motion.start / motion.p
    if motion.period is None:
        return float(first + offset / motion.p)
    interval = motion.period / 2
    return float(first + mp.nint((time - first) / interval) * interval + offset / motion.p)


def _permuted(order: tuple[int, int, int], moments: Triple, rates: Triple) -> tuple[Triple, Triple]:
    i, j, k = order
    return (moments[i], moments[j], moments[k]), (rates[i], rates[j], rates[k])


def _scaled(vector: Triple, factor: float) -> Triple:
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _axis_orders() -> Iterator[Case]:
    for order in ORDERS:
        for circled, rates in (("least", (-1.1, 0.3, 0.2)), ("greatest", (0.3, -0.2, 0.9))):
            label = "".join("ABC"[i] for i in order)
            yield _case(f"order {label} about the {circled}", *_permuted(order, (1.0, 2.0, 3.0), rates))
    yield _case("no body at all", (2.0, 1.0, 0.5), (0.4, 1.0, 0.7))
    yield _case("the flipping example", (1.0, 2.0, 3.0), (0.1, 1.0, 0.1), 1000)


def _drawn_by_lot(start: int = 0, stop: int = 40) -> Iterator[Case]:
    """Any body, any start, any size, any horizon."""
    for seed in range(start, stop):
        name = f"lot {seed}"
        rng = Random(name)
        moments = _any_moments(rng)
        rates = _any_rates(rng, moments)
        moments = _scaled(moments, 10 ** rng.uniform(-30, 30))
        rates = _scaled(rates, 10 ** rng.uniform(-30, 30))
        yield _case(name, *_permuted(rng.choice(ORDERS), moments, rates), 10 ** rng.uniform(0, 9))


def _any_moments(rng: Random) -> Triple:
    """Return the moments of a box, of any proportions or with two nearly equal edges."""
    x, y, z = (10 ** rng.uniform(-2, 2) for _ in range(3))
    if rng.random() < 0.3:
        y = x * (1 + 10 ** rng.uniform(-15, -2))
    return y + z, z + x, x + y


def _any_rates(rng: Random, moments: Triple) -> Triple:
    """Return any rates, or some near an axis, or some near the separatrix."""
    x, y, z = (rng.gauss(0, 1) for _ in range(3))
    kind = rng.choice(("any", "axis", "separatrix"))
    if kind == "axis":
        small = 10 ** rng.uniform(-20, -1)
        x, y, z = rng.sample((x, y * small, z * small), 3)
    elif kind == "separatrix":
        a, b, c = sorted(range(3), key=lambda i: moments[i])
        small = 10 ** rng.uniform(-40, 0)
        rates = [0.0, 0.0, 0.0]
        rates[a] = small * sqrt(moments[c] * (moments[c] - moments[b]))
        rates[c] = small * sqrt(moments[a] * (moments[b] - moments[a])) * (1 + x * 10 ** rng.uniform(-16, -2))
        rates[b] = y * moments[b]
        x, y, z = (rng.choice((-1, 1)) * rate for rate in rates)
    return x, y, z


def _near_symmetric() -> Iterator[Case]:
    for exponent in (6, 8, 10, 12, 14, 16):
        # The last differs by one unit in the last place.
        above = 1 + (10.0**-exponent if exponent < 16 else ulp(1.0))
        for pair, moments in (("lower", (1.0, above, 1.7)), ("upper", (above, 0.4, 1.0))):
            for kind, rates in (("tilted", (0.7, -0.4, 0.6)), ("in the plane", (0.8, 0.6, 1e-9))):
                if pair == "upper":
                    rates = rates[1], rates[2], rates[0]
                horizon = 10.0 ** (exponent / 2) if kind == "tilted" else 3
                yield _case(f"{pair} pair within 1e-{exponent}, {kind}", moments, rates, horizon)


def _near_separatrix() -> Iterator[Case]:
    """Start on the middle axis but for a hair, so that m1 is about the square of the hair."""
    for i, exponent in enumerate((3, 6, 10, 16, 30, 60, 100, 150, 200, 300)):
        hair = 10.0 ** (-exponent / 2)
        for circled, (a, c) in (("least", (1.5, 0.5)), ("greatest", (0.7, -0.9))):
            state = _permuted(ORDERS[i % 6], (1.0, 2.0, 3.0), (a * hair, 1.3, c * hair))
            yield _case(f"saddle, m1 about 1e-{exponent}, {circled}", *state, 10.0 ** (i % 4))
    yield _case("saddle, the hair and a cancellation", (1.0, 2.0, 3.0), (1e-8, 1.0, 1.001e-8), 10)


def _near_separatrix_by_cancellation() -> Iterator[Case]:
    """Start next to an exact point of the separatrix of (14, 21, 24), which is (6, anything, 7)."""
    for i, delta in enumerate((1e-3, 1e-6, 1e-9, 1e-12, 1e-14, ulp(1.0))):
        for sign in (1, -1):
            rates = (6.0, (-1) ** i * 5.0, 7 * (1 + sign * delta))
            state = _permuted(ORDERS[i], (14.0, 21.0, 24.0), rates)
            yield _case(f"separatrix missed by {sign * delta:.0e}", *state, 5)
    for k in (50, 300):
        rates = (6 * 2.0**-k, 1.0, 7 * 2.0**-k * (1 + 2.0**-50))
        yield _case(f"separatrix missed by a hair of 2**-{k}", (14.0, 21.0, 24.0), rates)


def _on_separatrix() -> Iterator[Case]:
    for i, (order, middle) in enumerate(zip(ORDERS, (0.0, 1.0, -3.7, 1e-9, 1e5, -0.3), strict=True)):
        rates = ((-1) ** i * 6.0, middle, (-1) ** (i // 2) * 7.0)
        moments, rates = _permuted(order, (14.0, 21.0, 24.0), rates)
        yield _case(f"separatrix, order {order}", moments, rates, 4)
        k = 40 * i + 1
        yield _case(f"separatrix scaled by 2**{k}", _scaled(moments, 2.0**k), _scaled(rates, 2.0 ** (-2 * k)), 40)
    yield _case("another separatrix", (9.0, 10.0, 18.0), (4.0, -2.0, 1.0))
    yield _case("separatrix of no body", (1.0, 9.0, 5.0), (3.0, -1.0, 0.4))
    yield _case("separatrix left by a hair", (14.0, 21.0, 24.0), (6 * 2.0**-400, 1.0, 7 * 2.0**-400), 600)


def _needles_and_laminae() -> Iterator[Case]:
    for i, ratio in enumerate((1e3, 1e6, 1e9, 1e12)):
        thin = 1 / ratio
        for body, moments in (("needle", (thin, 1.0, 1 + 0.3 * thin)), ("lamina", (thin, 1.0, 1 + thin))):
            for kind, rates in (("tumbling", (0.5, 0.8, -0.6)), ("spinning", (30 * sqrt(ratio), 0.8, 0.6))):
                state = _permuted(ORDERS[-i], moments, rates)
                yield _case(f"{body} of ratio {ratio:.0e}, {kind}", *state, 10.0**i)


def _magnitudes() -> Iterator[Case]:
    for inertia in (1e-150, 1e-120, 1.0, 1e120, 1e150):
        for rate in (1e-150, 1.0, 1e150):
            for kind, rates in (("least", (1.1, 0.3, -0.2)), ("greatest", (0.3, -0.2, 0.9))):
                if (kind == "least") == (rate == 1.0):
                    moments = _scaled((1.0, 2.0, 2.5), inertia)
                    yield _case(f"moments {inertia:.0e}, rates {rate:.0e}", moments, _scaled(rates, rate), 100)


def _horizons() -> Iterator[Case]:
    for i in range(10):
        state = _permuted(ORDERS[i % 6], (2.0, 3.1, 4.3), (0.7, 0.9, (-1) ** i * 0.4))
        yield _case(f"{10**i:.0e} periods", *state, 10.0**i)
        yield _case(f"{10**i:.0e} flips of a T-handle", T_HANDLE, (1.0, 10.0, 1.0), 10.0**i)


def _principal_and_nearly() -> Iterator[Case]:
    moments = (3.0, 1.0, 2.0)
    for axis, name in enumerate(("greatest", "least", "middle")):
        for perturbation in (0.0, 1e-8, 1e-150):
            rates = [perturbation, -0.7 * perturbation, 0.4 * perturbation]
            rates[axis] = (-1) ** axis * 2.5
            x, y, z = rates
            yield _case(f"{name} axis missed by {perturbation:.0e}", moments, (x, y, z), 1e4)


def _equal_moments() -> Iterator[Case]:
    for order in ORDERS[::2]:
        for body, moments in (("coin", (1.0, 1.0, 2.0)), ("cigar", (2.0, 2.0, 0.3))):
            for kind, rates in (("tilted", (0.3, -0.8, 0.5)), ("in the plane", (0.3, -0.8, 0.0))):
                yield _case(f"{body} {kind}, order {order}", *_permuted(order, moments, rates), 1e6)
    yield _case("symmetric, backwards", (2.0, 2.0, 0.3), (0.3, -0.8, -0.5), 1e9)
    yield _case("sphere", (0.7, 0.7, 0.7), (0.3, -0.8, 0.5), 1e9)
    yield _case("sphere at rest", (0.7, 0.7, 0.7), (0.0, 0.0, 0.0))
    yield _case("rest", (1.0, 2.0, 3.0), (0.0, 0.0, -0.0))


def _t_handle() -> Iterator[Case]:
    yield _case("T-handle about the origin", T_HANDLE_ORIGIN, (1.0, 10.0, 1.0), 20)
    yield _case("T-handle", T_HANDLE, (1.0, 10.0, 1.0), 20)
    yield _case("T-handle, a slow flip", T_HANDLE, (0.01, 10.0, 0.0), 20)
