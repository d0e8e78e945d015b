"""When a motion is stiff: what decays fast limits the steps of its Taylor series; and its steps by collocation."""

from __future__ import annotations

import numpy as np

from core.arrays import Floats, Integers
from core.compiled import kernel
from core.double_double import dd_add, dd_mul
from core.multibody.equations.packed import FORCES, Packed, Units, state, two_to
from core.multibody.motion.collocation import advance_collocated, linearised_at
from core.multibody.motion.radau import radau
from core.multibody.motion.run import GivenUp, Run, run_by
from core.multibody.table.table import Table

LONGEST = 10.0
"""Power of e by which what limits the steps of a series decays in a step at most: where next to nothing is left."""
DEAREST = 4.0
"""Steps of a series that take as long as one of collocation."""
PER_STEP = 2.0
"""Angle by which what has not decayed turns, or power of e by which it decays, in a step of collocation."""
LIMITING = 1.0
"""Power of e by which what limits the steps of a series decays in a step at least: those of order 24 to 32 take two."""
DECAYED = 48.0
"""Power of e by which decays what need not be followed any longer: 2^-70."""
LARGEST = 400
"""Coordinates and rows up to which it is asked: the eigenvalues of more take seconds."""
AT_ONCE = 64
"""Steps for which there is room at once."""
FIRST = 2.0**-4
"""Share of the unit of time with which the first step is tried."""

PIECE, BEYOND = 0.5, 0.125
"""Share of a step that is a piece of a search, on which powers of time differ by no more than the motion itself, and by
how much a piece may reach beyond the end of a step, where its polynomial is a thousand times less exact."""

METHODS = {"doubles": (9, 2.0**-54), "reference": (11, 2.0**-66), "check": (13, 2.0**-78), "fine": (14, 2.0**-84)}
"""Stages and tolerances: all are in pairs of doubles, and named after the kinds of series that they replace."""


def dissipates(table: Packed) -> bool:
    """Return whether anything may decay: there are dampers, formulas or friction.

    Friction that turns with its slip is not followed by collocation: its lines depend on rates.
    """
    return not len(table.slides.at) and bool(len(table.damp) or len(table.laws.push) or not np.all(table.binds))


def rates_of_decay(table: Packed, q: Floats, v: Floats) -> Floats | None:
    """Return the eigenvalues of the motion beside a state of shape (n, 2), as rows (real part, size).

    They are those of the linearised equation for frozen coefficients; None where it is singular.
    """
    n, size = len(table.load), len(table.load) + len(table.rate)
    if size > LARGEST:
        return None
    at = linearised_at(table, q, v)
    try:
        gains = -np.linalg.solve(at.mass, np.concatenate([at.stiffness, at.damping], axis=1))[:n]
    except np.linalg.LinAlgError:
        return None
    if not np.isfinite(gains).all():
        return None
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:], matrix[n:] = np.eye(n), gains
    found = np.linalg.eigvals(matrix)
    return np.stack([found.real, np.abs(found)], axis=1)


def limiting_decay(rates: Floats | None, time: float, steps: float | None = None) -> float | None:
    """Return how fast decays what limits the steps of a series, per unit of time; None where the motion is not stiff.

    Parameters
    ----------
    rates : ndarray, shape (k, 2), or None
        Of `rates_of_decay`.
    time : float
        Duration of the whole motion.
    steps : float, optional
        How many steps of a series it would take; if omitted, as many as the fastest decay needs at least.
    """
    if rates is None:
        return None
    decays = np.maximum(-rates[:, 0], 0.0)
    powers = float(np.max(decays, initial=0.0)) * time
    steps = powers / LONGEST if steps is None else steps
    if powers <= LIMITING * steps:
        return None
    # What grows or persists is followed for the whole time, what decays until nothing is left of it.
    lasting = np.minimum(time, DECAYED / np.maximum(decays, DECAYED / time))
    if DEAREST * float(np.max(rates[:, 1] * lasting, initial=0.0)) / PER_STEP > steps:
        return None
    return float(np.max(decays))


def collocated(table: Table, arrays: Packed, units: Units, kind: str, end: float, since: Run | None = None) -> Run:
    """Take steps by collocation to a time after the start, in the units of the arrays, or on from a run.

    Raises
    ------
    BudgetExceeded
        Where more steps would be needed than one part may take.
    AccuracyUnreachable
        Where the motion leaves the range of doubles.
    GivenUp
        Where steps become too short, as at a singular place.
    """
    stages, tolerance = METHODS[kind]
    method = radau(stages)
    (q, v), clock, before = state(table, units), np.zeros(2), 0
    largest, first = np.zeros((FORCES + 2, 2)), FIRST
    if since is not None:
        last = since.series[-1]
        q, v, clock, before = last[:, 0].copy(), last[:, 1].copy(), since.starts[-2].copy(), len(since.series) - 1
        for power in range(2):
            np.maximum.at(largest[:, power], arrays.group, np.abs(since.series[:, :, power, 0]).max(axis=0))
        if before:
            first = float(since.starts[-2, 0] - since.starts[-3, 0])

    def steps(clock: Floats, starts: Floats, series: Floats) -> tuple[int, int]:
        nonlocal first
        ended, count, first = advance_collocated(
            arrays, method, q, v, clock, end, tolerance, largest, first, starts, series
        )
        return ended, count

    found = run_by(steps, (q.copy(), v.copy()), (len(q), stages + 2, 2), AT_ONCE, clock, before)
    if found.singular:
        raise GivenUp
    return found


def pieces_of_steps(
    run: Run, group: Integers, units: Units, times: Floats, reach: Floats, order: int
) -> tuple[tuple[Floats, Floats], Floats, Floats]:
    """Return the polynomials of a run about times after the start, as `Motion.steps_about` does."""
    scaled = np.asarray(times, dtype=np.float64) * two_to(-units.time)
    which, count, n = run.which(scaled), len(times), run.series.shape[1]
    long = np.diff(run.starts[:, 0])[which]
    rest = run.starts[which + 1, 0] - scaled
    natural = np.minimum(PIECE * long, np.maximum(rest, BEYOND * long)) * two_to(units.time)
    exponents = np.where(natural < reach, np.floor(np.log2(natural)), np.ceil(np.log2(reach)))
    lengths = np.exp2(exponents)
    series = np.zeros((count, n, order + 1, 2))
    paired = np.zeros((count, 2))
    paired[:, 0] = scaled
    shift_steps(run.starts, run.series, paired, which, series)
    powers = (lengths * two_to(-units.time))[:, None] ** np.arange(order + 1)
    series *= powers[:, None, :, None] * units.up[:, None, None]
    sizes = np.zeros(series.shape[:-1])
    for g in np.unique(group):
        own = group == g
        largest = np.max(np.abs(series[..., 0])[:, own], axis=1, keepdims=True)
        # Of what is even in time every other power is rounding: a power is at least as large as later ones.
        sizes[:, own] = np.maximum.accumulate(largest[..., ::-1], axis=-1)[..., ::-1]
    return (lengths, natural), series, sizes


@kernel()
def shift_steps(starts: Floats, series: Floats, times: Floats, which: Integers, out: Floats) -> None:
    """Fill in the series of the steps `which` about times, pairs of shape (t, 2), into `out` of shape (t, n, k, 2)."""
    last = series.shape[2] - 1
    for s in range(times.shape[0]):
        step = which[s]
        hh, hl = dd_add(times[s, 0], times[s, 1], -starts[step, 0], -starts[step, 1])
        for i in range(series.shape[1]):
            c = out[s, i]
            c[: last + 1] = series[step, i]
            # Horner's rule, again and again: the remainders are the coefficients.
            for k in range(last):
                for j in range(last - 1, k - 1, -1):
                    ph, pl = dd_mul(c[j + 1, 0], c[j + 1, 1], hh, hl)
                    c[j, 0], c[j, 1] = dd_add(c[j, 0], c[j, 1], ph, pl)
