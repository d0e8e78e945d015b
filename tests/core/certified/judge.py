"""The double kernels compared with ball arithmetic: true errors in ulps, and whether a stated error was too small.

    python -m tests.core.certified.judge 20000

judges so many random and extreme motions after the named cases and writes the figures to benchmarks/results/judge.json.
Every motion is made from its number alone, so that any of them can be judged again.
"""

from __future__ import annotations

import json
import math
import statistics
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from random import Random

import numpy as np

from core.bodies.mass_properties import PrincipalInertia
from core.certified.free_rotation import CertifiedRotation
from core.errors import AccuracyUnreachable
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.free_rotation import FreeRotation
from tests.oracles.cases import ORDERS, Case, cases

TARGET = Path(__file__).parents[3] / "benchmarks" / "results" / "judge.json"
UNIT_ROUNDOFF = 2.0**-53
DIGITS = 40

OWN_ERROR = 4 * 0.51 * 10.0 ** (1 - DIGITS)
"""Error of the reference numerals, each 0.51 units of its last digit."""


@dataclass(frozen=True)
class Verdict:
    """Errors of one motion: of angular velocity relative to its largest norm, of attitude as the turn of a vector."""

    name: str
    family: str
    error: float
    stated: float
    attitude_error: float | None
    attitude_stated: float | None

    @property
    def caught(self) -> bool:
        """Whether an error is larger than what was stated."""
        pairs = ((self.error, self.stated), (self.attitude_error, self.attitude_stated))
        return any(e is not None and s is not None and e - OWN_ERROR > s for e, s in pairs)


def judged(case: Case, family: str = "named") -> Verdict | None:
    """Return the verdict on one motion, None where the double kernel refuses it."""
    inertia = PrincipalInertia.of(np.diag(np.array(case.moments)))
    motion = FreeRotation(inertia, np.array(case.angular_velocity))
    certified = CertifiedRotation.of_moments(case.moments, case.angular_velocity)
    times = np.array(case.times)
    rng = Random(case.name)
    start = [rng.gauss(0, 1) for _ in range(4)]
    try:
        got, stated = motion.sample(times), motion.error(times)
    except AccuracyUnreachable:
        return None
    rates, attitudes = certified.trajectory(case.times, DIGITS, start)
    largest = Fraction(certified.largest_rate(DIGITS))
    error = float(distance_of_rows(got, rates) / largest) if largest else float(distance_of_rows(got, rates))
    turning = FreeAttitude(motion, np.array(start))
    try:
        found, bound = turning.sample(times), turning.error(times)
    except AccuracyUnreachable:
        return Verdict(case.name, family, error, stated, None, None)
    # Twice the distance of two unit quaternions is the most that one of them turns a unit vector away from the other's.
    return Verdict(case.name, family, error, stated, 2 * float(distance_of_rows(found, attitudes)), bound)


def distance_of_rows(got: np.ndarray, want: list[list[str]]) -> Fraction:
    """Return the largest norm of the difference of rows, to 30 digits or so."""
    largest = Fraction(0)
    for row, numerals in zip(got, want, strict=True):
        square = sum(((Fraction(float(g)) - Fraction(w)) ** 2 for g, w in zip(row, numerals, strict=True)), Fraction(0))
        largest = max(largest, square)
    return _root(largest)


def _root(square: Fraction) -> Fraction:
    if square == 0:
        return square
    shift = 2 * max(0, 120 - (square.numerator.bit_length() - square.denominator.bit_length()) // 2)
    return Fraction(math.isqrt((square.numerator << 2 * shift) // square.denominator), 1 << shift)


def motions(count: int) -> Iterator[tuple[str, Case]]:
    """Yield the named cases, then `count` random and extreme ones, of each family in turn."""
    for case in cases():
        yield "named", case
    families = (
        _anything,
        _near_separatrix,
        _cancelling,
        _nearly_symmetric,
        _needle_or_lamina,
        _far_magnitudes,
        _long_horizon,
        _near_an_axis,
        _to_the_last_digit,
    )
    for number in range(count):
        family = families[number % len(families)]
        rng = Random(f"judge {number}")
        moments, rates, periods = family(rng)
        order = rng.choice(ORDERS)
        case = _at_times(rng, f"{family.__name__[1:]} {number}", _in(order, moments), _in(order, rates), periods)
        yield family.__name__[1:].replace("_", " "), case


State = tuple[list[float], list[float], float]


def _in(order: tuple[int, int, int], values: list[float]) -> tuple[float, float, float]:
    return values[order[0]], values[order[1]], values[order[2]]


def _at_times(
    rng: Random, name: str, moments: tuple[float, float, float], rates: tuple[float, float, float], periods: float
) -> Case:
    motion = FreeRotation(PrincipalInertia.of(np.diag(np.array(moments))), np.array(rates))
    try:
        unit = motion.period or 1.0 / max(motion.motion.p, motion.largest_norm)
    except AccuracyUnreachable:
        unit = 1.0 / max(map(abs, rates))
    times = [0.0, unit * periods, -unit * periods * rng.random(), unit * rng.uniform(-1, 1)]
    # At quarter periods, where near the separatrix everything happens, and a little beside them.
    quarter = motion.motion.p and 1.0 / motion.motion.p
    times += [(round(periods * rng.random() * 2) / 2 + 0.25 * rng.choice((0, 1))) * unit + quarter * rng.gauss(0, 2)]
    return Case(name, moments, rates, tuple(t for t in times if math.isfinite(t)))


def _body(rng: Random) -> list[float]:
    x, y, z = (10 ** rng.uniform(-1.5, 1.5) for _ in range(3))
    return [y + z, z + x, x + y]


def _rates(rng: Random) -> list[float]:
    return [rng.gauss(0, 1) for _ in range(3)]


def _anything(rng: Random) -> State:
    return _body(rng), _rates(rng), 10 ** rng.uniform(0, 3)


def _near_separatrix(rng: Random) -> State:
    """Next to the middle axis: m1 is about the square of the hair."""
    moments = sorted(_body(rng))
    hair = 10 ** rng.uniform(-149, 0)
    return moments, [hair * rng.gauss(0, 1), rng.choice((-1, 1)), hair * rng.gauss(0, 1)], 10 ** rng.uniform(0, 3)


def _cancelling(rng: Random) -> State:
    """On an exact separatrix but for a few ulps or a hair: (14, 21, 24) and (6, anything, 7)."""
    missed = rng.choice((0.0, 1e-16, 1e-12, 1e-8, 1e-4)) * rng.gauss(0, 1)
    scale = 2.0 ** rng.randint(-200, 200)
    rates = [6.0 * scale, rng.gauss(0, 5) * scale, 7.0 * (1 + missed) * scale]
    return [14.0, 21.0, 24.0], rates, 10 ** rng.uniform(0, 2)


def _nearly_symmetric(rng: Random) -> State:
    moment, other = 10 ** rng.uniform(-1, 1), 10 ** rng.uniform(-1, 1)
    return [moment, moment * (1 + 10 ** rng.uniform(-15.9, -1)), other], _rates(rng), 10 ** rng.uniform(0, 6)


def _needle_or_lamina(rng: Random) -> State:
    thin = 10 ** rng.uniform(-12, -1)
    moments = [thin, 1.0, 1.0 + thin * rng.choice((1.0, rng.random()))]
    rates = _rates(rng)
    rates[0] *= rng.choice((1.0, 1.0 / math.sqrt(thin), 1.0 / thin))
    return moments, rates, 10 ** rng.uniform(0, 3)


def _far_magnitudes(rng: Random) -> State:
    inertia, rate = 10 ** rng.uniform(-150, 150), 10 ** rng.uniform(-150, 150)
    return [x * inertia for x in _body(rng)], [x * rate for x in _rates(rng)], 10 ** rng.uniform(0, 3)


def _long_horizon(rng: Random) -> State:
    return _body(rng), _rates(rng), 10 ** rng.uniform(6, 9)


def _to_the_last_digit(rng: Random) -> State:
    """Times so long that the phase is barely resolved, in periods or, for nearly symmetric bodies, in turns."""
    moments, rates = (_body(rng), _rates(rng))
    periods = 2.0 ** rng.uniform(40, 48)
    if rng.random() < 0.5:
        difference = 10 ** rng.uniform(-14, -1)
        moments[1] = moments[0] * (1 + difference)
        periods *= difference / 16
    return moments, rates, periods


def _near_an_axis(rng: Random) -> State:
    rates = [10 ** rng.uniform(-160, -3) * rng.gauss(0, 1) for _ in range(3)]
    rates[rng.randrange(3)] = rng.choice((-1.0, 1.0)) * rng.uniform(0.5, 2)
    return _body(rng), rates, 10 ** rng.uniform(0, 4)


def report(verdicts: list[Verdict], refused: int) -> dict[str, object]:
    """Return worst and median errors in units of 2^-53, by family, and the least margin of the statements."""
    by_family: dict[str, list[Verdict]] = {}
    for verdict in verdicts:
        by_family.setdefault(verdict.family, []).append(verdict)

    def figures(group: list[Verdict]) -> dict[str, object]:
        worst = max(group, key=lambda v: v.error)
        turned = [v for v in group if v.attitude_error is not None]
        return {
            "motions": len(group),
            "angular velocity": {
                "worst": round(worst.error / UNIT_ROUNDOFF, 2),
                "in": worst.name,
                "median": round(statistics.median(v.error for v in group) / UNIT_ROUNDOFF, 2),
            },
            "attitude": {
                "worst": round(max((v.attitude_error or 0.0 for v in turned), default=0.0) / UNIT_ROUNDOFF, 2),
                "median": round(
                    statistics.median([v.attitude_error or 0.0 for v in turned] or [0.0]) / UNIT_ROUNDOFF, 2
                ),
            },
        }

    return {
        "unit": "2^-53 of the largest rate; of a turned unit vector",
        "refused": refused,
        "statements below the true error": [v.name for v in verdicts if v.caught],
        "stated over true error": {
            "angular velocity": tightness([(v.stated, v.error) for v in verdicts]),
            "attitude": tightness([(v.attitude_stated or 0.0, v.attitude_error or 0.0) for v in verdicts]),
        },
        "all": figures(verdicts),
        "families": {family: figures(group) for family, group in by_family.items()},
    }


def tightness(pairs: list[tuple[float, float]]) -> dict[str, float]:
    """Return how many times larger than the true errors the stated ones are, where there is an error to speak of."""
    ratios = sorted(stated / true for stated, true in pairs if true > UNIT_ROUNDOFF / 8)
    if not ratios:
        return {}
    ranks = {"least": 0.0, "median": 0.5, "95 %": 0.95}
    return {name: round(ratios[int(rank * (len(ratios) - 1))], 2) for name, rank in ranks.items()}


def main(count: int) -> None:
    """Judge, write and print."""
    found = [judged(case, family) for family, case in motions(count)]
    verdicts = [verdict for verdict in found if verdict is not None]
    result = report(verdicts, len(found) - len(verdicts))
    TARGET.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    sys.stdout.write(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
