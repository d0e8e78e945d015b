"""Free motions at and on both sides of every border between two models of a free rotation."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import nextafter, sqrt
from typing import NamedTuple

Triple = tuple[float, float, float]

DISTANCES = (1e-1, 1e-3, 1e-6, 1e-10, 1e-15, 1e-16, 1e-30, 1e-75, 1e-150, 1e-200, 1e-300, 0.0)
"""From a border that doubles can approach as near as they like."""
DIFFERENCES = (1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1e-15, 2.0**-52, 0.0)
"""Between two moments that are nearly equal, as a share."""
SUBNORMAL = 5e-324


class Motion(NamedTuple):
    """A body by its moments, and how it turns at t = 0."""

    name: str
    moments: Triple
    rates: Triple

    @property
    def question(self) -> dict[str, object]:
        body = {"kind": "principal-moments", "moments": list(self.moments)}
        return {"body": body, "angular_velocity": list(self.rates)}


def motions() -> Iterator[Motion]:
    """Yield every motion, the same in every run."""
    for family in (separatrix, symmetric, slender, magnitudes, subnormal, steady):
        yield from family()


def separatrix() -> Iterator[Motion]:
    """Next to the middle axis, and next to (6, anything, 7) on the exact separatrix of (14, 21, 24), on both sides."""
    for hair, (side, a, c) in product(DISTANCES, (("inside", 1.5, 0.5), ("outside", 0.7, -0.9))):
        yield Motion(f"{side} the separatrix by {hair:g}", (1.0, 2.0, 3.0), (a * hair, 1.3, c * hair))
    for k, missed in product((0, 60, 500, 1000), (-1e-1, -1e-8, -(2.0**-52), 0.0, 2.0**-52, 1e-8, 1e-1)):
        hair = 2.0**-k
        yield Motion(
            f"separatrix missed by {missed:g}, 2^-{k} beside the middle axis",
            (14.0, 24.0, 21.0),
            (6 * hair, 7 * hair * (1 + missed), -5.0),
        )
    for scale in (-500, 500):
        yield Motion(
            f"on the separatrix, 2^{scale}", (21.0, 14.0, 24.0), (5 * 2.0**scale, 6 * 2.0**scale, 7 * 2.0**scale)
        )


def symmetric() -> Iterator[Motion]:
    """Two moments that differ by less and less: tilted, in their plane and along the other axis."""
    states = {
        "tilted": (0.7, -0.4, 0.6),
        "nearly in the plane": (0.8, 0.6, 1e-12),
        "in the plane": (0.8, -0.6, 0.0),
        "nearly along the axis": (1e-12, -1e-14, 0.9),
        "along the axis": (0.0, 0.0, -0.9),
    }
    for share, (name, rates), third in product(DIFFERENCES, states.items(), (1.7, 0.4)):
        kind = "coin" if third > 1 else "cigar"
        yield Motion(f"{kind} but for {share:g}, {name}", (1.0, 1.0 + share, third), rates)
    for share in DIFFERENCES:
        yield Motion(f"sphere but for {share:g}", (1.0, 1.0 + share, 1.0 + share / 2), (0.7, -0.4, 0.6))


def slender() -> Iterator[Motion]:
    """Needles and laminae, an ulp beyond what matter can have on one side and within it on the other."""
    for thin in (1e-1, 1e-4, 1e-8, 1e-12, 1e-15, 1e-100, 1e-300):
        flat = 1.0 + thin
        tips = {"": flat, " less an ulp": nextafter(flat, 0.0), " and an ulp beyond": nextafter(flat, 2.0)}
        for name, last in tips.items():
            for state, rates in (("tumbling", (0.5, 0.8, -0.6)), ("spinning", (3 / sqrt(thin), 0.8, 0.6))):
                yield Motion(f"lamina of {thin:g}{name}, {state}", (thin, 1.0, last), rates)
        yield Motion(f"needle of {thin:g}", (1.0, thin, 1.0), (0.5, 40.0, 0.6))
        yield Motion(f"no body, of {thin:g}", (thin, thin * 2, 1.0), (0.5, 0.3, 0.6))


def magnitudes() -> Iterator[Motion]:
    for inertia, rate in product((1e-300, 1e-150, 1.0, 1e150, 1e300), (1e-300, 1e-150, 1.0, 1e150, 1e300)):
        moments = inertia, 2 * inertia, 2.5 * inertia
        yield Motion(f"moments {inertia:g}, rates {rate:g}", moments, (1.1 * rate, 0.3 * rate, -0.2 * rate))
        yield Motion(f"coin of {inertia:g}, rates {rate:g}", (inertia, inertia, 2 * inertia), (rate, 0.0, -0.2 * rate))


def subnormal() -> Iterator[Motion]:
    for k in range(3):
        rates = [0.3, -0.8, 0.5]
        rates[k] = SUBNORMAL
        yield Motion(f"component {k} subnormal", (1.0, 2.0, 2.5), (rates[0], rates[1], rates[2]))
    small = SUBNORMAL, -SUBNORMAL, 3 * SUBNORMAL
    yield Motion("all components subnormal", (1.0, 2.0, 2.5), small)
    yield Motion("all components subnormal, coin", (1.0, 1.0, 2.5), small)
    yield Motion("moments subnormal", (3 * SUBNORMAL, 5 * SUBNORMAL, 7 * SUBNORMAL), (0.3, -0.8, 0.5))
    yield Motion("one moment subnormal", (SUBNORMAL, 1.0, 1.0), (0.3, -0.8, 0.5))
    yield Motion("one moment and its rate subnormal", (SUBNORMAL, 1.0, 1.0), (SUBNORMAL, -0.8, 0.5))
    yield Motion("largest doubles", (1.7e308, 1.0e308, 1.2e308), (1.7e308, -1.0e308, 1.2e308))
    yield Motion("subnormal beside the largest", (1.0, 2.0, 2.5), (SUBNORMAL, -1.7e308, 1.0))


def steady() -> Iterator[Motion]:
    yield Motion("rest", (1.0, 2.0, 3.0), (0.0, -0.0, 0.0))
    yield Motion("sphere at rest", (1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    for k, rate in product(range(3), (1.0, -1e150, 1e-300, SUBNORMAL)):
        rates = [0.0, 0.0, 0.0]
        rates[k] = rate
        yield Motion(f"steady about axis {k} at {rate:g}", (1.0, 2.0, 3.0), (rates[0], rates[1], rates[2]))
        beside = [rate * 2.0**-600 if abs(rate) >= 1 else 0.0] * 3
        beside[k] = rate
        yield Motion(f"next to axis {k} at {rate:g}", (1.0, 2.0, 3.0), (beside[0], beside[1], beside[2]))
